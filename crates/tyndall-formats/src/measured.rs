//! RGL's files of measured materials (`.bsdf`): blocks of numbers by name.
//!
//! | bytes | content, little-endian |
//! |---|---|
//! | 12, 2, 4 | `tensor_file` and a zero, version 1.0, number of blocks |
//! | 2, n, 2, 1, 8 | of each block: length of its name, name, number of dimensions, type, place in the file |
//! | 8 each | its dimensions |
//!
//! Blocks that are read are `theta_i`, `phi_i`, `ndf`, `sigma`, `vndf`, `luminance`, `jacobian`, and `spectra` with
//! `wavelengths`, or `rgb`. Their numbers are in single precision (type 10), the flag `jacobian` is a byte (type 1).
//! Nothing is taken from the file that is not there: the memory is never more than a few times its size.
//!
//! Source: the readers of Mitsuba 3 and pbrt-v4; <https://rgl.epfl.ch/materials>.

use std::collections::HashMap;
use std::path::Path;

use tyndall::bsdf::measured::{Block, Channels, Parts};

/// The most blocks of a file, and the most dimensions of a block.
const MOST: usize = 64;
const BYTES: u8 = 1;
const SINGLE: u8 = 10;

/// A block that stands in the file.
struct Entry<'a> {
    kind: u8,
    shape: Vec<usize>,
    /// All of the file from its first number on.
    data: &'a [u8],
}

/// Reads the parts of a material.
///
/// # Errors
/// What is wrong with the file, in words.
pub fn read(path: &Path) -> Result<Parts, String> {
    parse(&std::fs::read(path).map_err(|error| error.to_string())?)
}

/// Reads the parts of a material that is in memory.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8]) -> Result<Parts, String> {
    let entries = entries(bytes)?;
    let block =
        |name: &str| entries.get(name).ok_or_else(|| format!("has no block \"{name}\"")).and_then(|e| e.block(name));
    let list = |name: &str| match block(name)? {
        Block { shape, values } if shape.len() == 1 => Ok(values),
        _ => Err(format!("its block \"{name}\" is no list")),
    };
    let (spectra, channels) = if entries.contains_key("wavelengths") {
        (block("spectra")?, Channels::Wavelengths(list("wavelengths")?))
    } else {
        (block("rgb")?, Channels::Rgb)
    };
    let jacobian = entries.get("jacobian").filter(|e| e.kind == BYTES).and_then(|e| e.data.first());
    Ok(Parts {
        theta: list("theta_i")?,
        phi: list("phi_i")?,
        normals: block("ndf")?,
        area: block("sigma")?,
        visible: block("vndf")?,
        luminance: block("luminance")?,
        spectra,
        channels,
        jacobian: *jacobian.ok_or("has no byte \"jacobian\"")? != 0,
    })
}

/// All blocks by name.
fn entries(bytes: &[u8]) -> Result<HashMap<String, Entry<'_>>, String> {
    let mut rest = bytes.strip_prefix(b"tensor_file\0").ok_or("is no file of a measured material")?;
    let [major, _] = array(&mut rest)?;
    let count = u32::from_le_bytes(array(&mut rest)?) as usize;
    if major != 1 || count > MOST {
        return Err(format!("is of version {major} with {count} blocks; version 1 with at most {MOST} is read"));
    }
    let mut entries = HashMap::new();
    for _ in 0..count {
        let length = u16::from_le_bytes(array(&mut rest)?) as usize;
        let (name, after) = rest.split_at_checked(length).ok_or("ends in a name")?;
        rest = after;
        let dimensions = u16::from_le_bytes(array(&mut rest)?) as usize;
        let [kind] = array(&mut rest)?;
        let place = usize::try_from(u64::from_le_bytes(array(&mut rest)?)).ok();
        if dimensions > MOST {
            return Err(format!("has a block of {dimensions} dimensions"));
        }
        let size = |rest: &mut &[u8]| usize::try_from(u64::from_le_bytes(array(rest)?)).map_err(|e| e.to_string());
        let shape = (0..dimensions).map(|_| size(&mut rest)).collect::<Result<Vec<_>, _>>()?;
        let data = place.and_then(|at| bytes.get(at..)).ok_or("has a block beyond its end")?;
        entries.insert(String::from_utf8_lossy(name).into_owned(), Entry { kind, shape, data });
    }
    Ok(entries)
}

impl Entry<'_> {
    /// Its numbers, if they are in single precision and all there.
    fn block(&self, name: &str) -> Result<Block, String> {
        if self.kind != SINGLE {
            return Err(format!("its block \"{name}\" is not in single precision"));
        }
        let count = self.shape.iter().try_fold(4usize, |size, &n| size.checked_mul(n));
        let bytes = count.and_then(|count| self.data.get(..count)).ok_or(format!("its block \"{name}\" is cut off"))?;
        let values = bytes.as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b)).collect();
        Ok(Block { shape: self.shape.clone(), values })
    }
}

fn array<const N: usize>(rest: &mut &[u8]) -> Result<[u8; N], String> {
    let (array, after) = rest.split_first_chunk::<N>().ok_or("ends in its list of blocks")?;
    *rest = after;
    Ok(*array)
}

#[cfg(test)]
mod tests {
    use tyndall::{bsdf::measured::Tables, spectrum::ColorMode};

    use super::*;

    fn file(blocks: &[(&str, u8, &[usize], Vec<u8>)]) -> Vec<u8> {
        let head: usize =
            18 + blocks.iter().map(|(name, _, shape, _)| 13 + name.len() + 8 * shape.len()).sum::<usize>();
        let mut bytes = b"tensor_file\0\x01\x00".to_vec();
        bytes.extend((blocks.len() as u32).to_le_bytes());
        let mut place = head;
        for (name, kind, shape, data) in blocks {
            bytes.extend((name.len() as u16).to_le_bytes());
            bytes.extend(name.as_bytes());
            bytes.extend((shape.len() as u16).to_le_bytes());
            bytes.push(*kind);
            bytes.extend((place as u64).to_le_bytes());
            shape.iter().for_each(|n| bytes.extend((*n as u64).to_le_bytes()));
            place += data.len();
        }
        for (_, _, _, data) in blocks {
            bytes.extend(data);
        }
        bytes
    }

    fn singles(values: &[f32]) -> Vec<u8> {
        values.iter().flat_map(|v| v.to_le_bytes()).collect()
    }

    fn small() -> Vec<u8> {
        let four = singles(&[1.0, 2.0, 3.0, 4.0]);
        file(&[
            ("theta_i", SINGLE, &[1], singles(&[0.0])),
            ("phi_i", SINGLE, &[1], singles(&[0.5])),
            ("ndf", SINGLE, &[2, 2], four.clone()),
            ("sigma", SINGLE, &[2, 2], four.clone()),
            ("vndf", SINGLE, &[1, 1, 2, 2], four.clone()),
            ("luminance", SINGLE, &[1, 1, 2, 2], four.clone()),
            ("rgb", SINGLE, &[1, 1, 3, 2, 2], four.repeat(3)),
            ("jacobian", BYTES, &[1], vec![1]),
        ])
    }

    #[test]
    fn a_file_has_its_blocks() {
        let parts = parse(&small()).unwrap();
        assert_eq!((parts.theta, parts.phi, parts.jacobian), (vec![0.0], vec![0.5], true));
        assert_eq!(parts.visible, Block { shape: vec![1, 1, 2, 2], values: vec![1.0, 2.0, 3.0, 4.0] });
        assert_eq!((parts.channels, parts.spectra.values.len()), (Channels::Rgb, 12));
    }

    /// Every cut and every changed byte gives parts or an error, and at once.
    #[test]
    fn hostile_files_are_survived() {
        let whole = small();
        for end in 0..whole.len() {
            assert!(parse(&whole[..end]).is_err(), "cut at {end}");
        }
        for at in 0..whole.len() {
            for byte in [0, 1, 10, 127, 255] {
                let mut changed = whole.clone();
                changed[at] = byte;
                let _ = parse(&changed).map(|parts| Tables::new(parts, ColorMode::Rgb));
            }
        }
        let large = file(&[("theta_i", SINGLE, &[usize::MAX, usize::MAX], Vec::new())]);
        assert!(parse(&large).is_err());
    }
}
