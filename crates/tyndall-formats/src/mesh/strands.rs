//! Strands of hair in files.
//!
//! - cyHair's `.hair` (Yuksel, <http://www.cemyuksel.com/research/hairmodels/>), binary and little-endian: 128 bytes of header
//!   (`HAIR`, number of strands, number of points, which arrays there are, segments of a strand, thickness, transparency,
//!   colour, 88 bytes of text), then the arrays: segments of each strand (16 bits), points, thicknesses, transparencies,
//!   colours (32-bit floats). A thickness is a width. Transparency and colour are left unread: the material says them.
//! - Mitsuba's text: `x y z radius` on each line, and an empty line between strands.
//!
//! Of both a strand is points with a radius: finite, not negative, and not 0 all along.

use std::path::Path;

use tyndall::{math::Vec3, shape::Knot};

use super::{MeshError, read_with};

/// Points with a radius, from root to tip.
pub type Strand = Vec<Knot>;

const HEADER: usize = 128;

/// Reads a file of strands: cyHair's, or text, by its name.
///
/// # Errors
/// The file cannot be read, or what is wrong with it.
pub fn read_strands(path: &Path) -> Result<Vec<Strand>, MeshError> {
    let is_hair = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("hair"));
    read_with(path, |bytes| if is_hair { parse_hair(&bytes) } else { parse_strands(&bytes) })
}

/// The strands of a `.hair` file.
///
/// # Errors
/// What is wrong with it.
pub fn parse_hair(bytes: &[u8]) -> Result<Vec<Strand>, String> {
    if !bytes.starts_with(b"HAIR") {
        return Err("does not begin with \"HAIR\"".into());
    }
    let Some((header, mut rest)) = bytes.split_at_checked(HEADER) else {
        return Err(format!("ends within its header of {HEADER} bytes"));
    };
    let word = |at: usize| <[u8; 4]>::try_from(&header[at..at + 4]).unwrap_or_default();
    let [strands, points, arrays, segments] = [4, 8, 12, 16].map(|at| u32::from_le_bytes(word(at)) as usize);
    let thickness = f32::from_le_bytes(word(20));
    if arrays & 2 == 0 {
        return Err("has no points".into());
    }
    let mut take = |what: &str, count: usize, size: usize| {
        let split = count.checked_mul(size).and_then(|length| rest.split_at_checked(length));
        let Some((array, left)) = split else {
            return Err(format!("promises {count} {what} and has bytes for {}", rest.len() / size));
        };
        rest = left;
        Ok(array)
    };
    let given = if arrays & 1 != 0 { Some(take("strands", strands, 2)?) } else { None };
    let floats = |bytes: &[u8]| bytes.as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b)).collect::<Vec<_>>();
    let positions = floats(take("points", points, 12)?);
    // Only now it is known that there are so many points, and so no more strands.
    let lengths: Vec<usize> = match given {
        Some(bytes) => bytes.as_chunks::<2>().0.iter().map(|b| u16::from_le_bytes(*b).into()).collect(),
        None if strands <= points => vec![segments; strands],
        None => return Err(format!("promises {strands} strands of {points} points in all")),
    };
    let widths = if arrays & 4 != 0 { Some(floats(take("thicknesses", points, 4)?)) } else { None };
    let needed = lengths.iter().try_fold(0usize, |sum, length| sum.checked_add(length.checked_add(1)?));
    if needed != Some(points) {
        return Err(format!("has {points} points, but its strands do not take as many"));
    }
    let mut knots = positions.as_chunks::<3>().0.iter().enumerate().map(|(i, p)| {
        let width = widths.as_ref().map_or(thickness, |widths| widths[i]);
        Knot { p: Vec3::from_array(*p), radius: 0.5 * width }
    });
    checked(lengths.iter().map(|length| knots.by_ref().take(length + 1).collect()).collect())
}

/// The strands of a text.
///
/// # Errors
/// What is wrong with it, and on which line.
pub fn parse_strands(bytes: &[u8]) -> Result<Vec<Strand>, String> {
    let text = std::str::from_utf8(bytes).map_err(|_| "is not text")?;
    let mut strands = vec![Strand::new()];
    for (i, line) in text.lines().enumerate() {
        let numbers: Result<Vec<f32>, _> = line.split_whitespace().map(str::parse).collect();
        match numbers.as_deref() {
            Ok([]) => strands.push(Strand::new()),
            Ok(&[x, y, z, radius]) => {
                if let Some(strand) = strands.last_mut() {
                    strand.push(Knot { p: Vec3::new(x, y, z), radius });
                }
            }
            _ => return Err(format!("line {} is not \"x y z radius\"", i + 1)),
        }
    }
    strands.retain(|strand| !strand.is_empty());
    checked(strands)
}

fn checked(strands: Vec<Strand>) -> Result<Vec<Strand>, String> {
    if strands.is_empty() {
        return Err("has no strands".into());
    }
    for (number, strand) in strands.iter().enumerate() {
        if let Some(i) = strand.iter().position(|knot| !knot.p.is_finite() || !knot.radius.is_finite()) {
            return Err(format!("point {i} of strand {number} is not finite"));
        }
        if let Some(i) = strand.iter().position(|knot| knot.radius < 0.0) {
            return Err(format!("the width at point {i} of strand {number} is negative"));
        }
        if strand.iter().all(|knot| knot.radius == 0.0) {
            return Err(format!("strand {number} has no width"));
        }
    }
    Ok(strands)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Two strands, of 1 and of 2 segments, with a width at each of the 5 points.
    fn hair(width: f32, x: f32) -> Vec<u8> {
        let mut bytes = b"HAIR".to_vec();
        for n in [2u32, 5, 1 | 2 | 4, 0] {
            bytes.extend(n.to_le_bytes());
        }
        bytes.resize(HEADER, 0);
        for n in [1u16, 2] {
            bytes.extend(n.to_le_bytes());
        }
        (0..15).for_each(|i| bytes.extend((if i == 3 { x } else { i as f32 }).to_le_bytes()));
        (0..5).for_each(|_| bytes.extend(width.to_le_bytes()));
        bytes
    }

    #[test]
    fn a_hair_file_has_the_strands_that_it_says() {
        let strands = parse_hair(&hair(0.5, 3.0)).unwrap();
        assert_eq!(strands.iter().map(Vec::len).collect::<Vec<_>>(), [2, 3]);
        assert_eq!(strands[1][0], Knot { p: Vec3::new(6.0, 7.0, 8.0), radius: 0.25 });
        let text = "0 1 2 0.25\n3 4 5 0.25\n\n6 7 8 .25\n9 10 11 .25\n12 13 14 .25\n\n";
        assert_eq!(parse_strands(text.as_bytes()).unwrap(), strands);
    }

    #[test]
    fn a_broken_file_of_strands_is_told_what_is_wrong() {
        let whole = hair(0.5, 3.0);
        let with = |at: usize, value: u32| {
            let mut bytes = whole.clone();
            bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
            bytes
        };
        for (bytes, problem) in [
            (b"HEAR".to_vec(), "does not begin"),
            (whole[..100].to_vec(), "ends within its header"),
            (whole[..HEADER + 50].to_vec(), "promises 5 points and has bytes for 3"),
            (whole[..whole.len() - 1].to_vec(), "promises 5 thicknesses and has bytes for 4"),
            (with(4, u32::MAX), "promises 4294967295 strands"),
            (with(8, u32::MAX), "promises 4294967295 points"),
            (with(12, 2), "do not take as many"),
            (with(12, 1), "has no points"),
            (hair(0.0, 3.0), "strand 0 has no width"),
            (hair(-1.0, 3.0), "the width at point 0 of strand 0 is negative"),
            (hair(f32::NAN, 3.0), "point 0 of strand 0 is not finite"),
            (hair(1.0, f32::NAN), "point 1 of strand 0 is not finite"),
        ] {
            let found = parse_hair(&bytes).unwrap_err();
            assert!(found.contains(problem), "{found}, not {problem}");
        }
        for (text, problem) in [
            ("", "has no strands"),
            ("1 2 3", "line 1 is not"),
            ("1 2 3 4\n\n1 2 x 4", "line 3 is not"),
            ("1 2 inf 4", "not finite"),
            ("1 2 3 0\n1 2 4 0", "no width"),
        ] {
            assert!(parse_strands(text.as_bytes()).unwrap_err().contains(problem), "{text}");
        }
    }

    proptest! {
        #[test]
        fn no_bytes_make_the_reader_panic(mut bytes in prop::collection::vec(any::<u8>(), 0..300)) {
            let _ = parse_strands(&bytes);
            bytes.splice(0..0, *b"HAIR");
            let _ = parse_hair(&bytes);
        }
    }
}
