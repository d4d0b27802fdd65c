//! Mitsuba's `.serialized` meshes, versions 3 and 4: several meshes in one file, each deflated.
//!
//! | bytes | content, little-endian |
//! |---|---|
//! | 2, 2 | `0x041C`, version |
//! | deflated | `u32` flags; version 4: a name that ends with 0; `u64` number of vertices, of triangles; positions; if flagged normals, texture coordinates, colours; three `u32` a triangle |
//! | … | further meshes, each with its header |
//! | 8 or 4 each, 4 | the place of each mesh (`u64` in version 4, `u32` in version 3), their number |
//!
//! Numbers are in single precision, or in double if flagged. Source: Mitsuba 3, the page of its shape `serialized`.

use std::io::Read;
use std::path::Path;

use flate2::read::ZlibDecoder;
use tyndall::math::{Vec2, Vec3};

use super::{MeshError, TriangleMesh, read_with};

const MAGIC: u16 = 0x041C;
const HAS_NORMALS: u32 = 0x1;
const HAS_UVS: u32 = 0x2;
const HAS_COLOURS: u32 = 0x8;
const IS_FACETED: u32 = 0x10;
const DOUBLE: u32 = 0x2000;

/// The longest name of a mesh that is read over \[bytes\].
const MAX_NAME: usize = 1 << 16;

/// Reads one mesh of a file, counted from 0.
///
/// # Errors
/// The file cannot be read, is no such file, or has no such mesh.
pub fn read_serialized(path: &Path, index: u32) -> Result<TriangleMesh, MeshError> {
    read_with(path, |bytes| parse_serialized(&bytes, index))
}

/// Reads one mesh of a file that is already in memory.
///
/// # Errors
/// As [`read_serialized`]; what is wrong, not where the bytes came from.
pub fn parse_serialized(bytes: &[u8], index: u32) -> Result<TriangleMesh, String> {
    let version = header(bytes, 0)?;
    let start = if index == 0 { 0 } else { place(bytes, version, index)? };
    header(bytes, start)?;
    let deflated = bytes.get(start + 4..).ok_or("ends in a header")?;
    Body { stream: ZlibDecoder::new(deflated), double: false }.mesh(version)
}

/// The version, if a header stands there.
fn header(bytes: &[u8], at: usize) -> Result<u16, String> {
    match bytes.get(at..at.saturating_add(4)) {
        Some(&[a, b, c, d]) if u16::from_le_bytes([a, b]) == MAGIC => match u16::from_le_bytes([c, d]) {
            version @ (3 | 4) => Ok(version),
            version => Err(format!("is a serialized mesh of version {version}; versions 3 and 4 are read")),
        },
        _ => Err("is no serialized mesh".into()),
    }
}

/// Where a mesh starts, by the list at the end of the file.
fn place(bytes: &[u8], version: u16, index: u32) -> Result<usize, String> {
    let each = if version == 4 { 8 } else { 4 };
    let list_end = bytes.len().checked_sub(4).ok_or("has no list of its meshes")?;
    let count = bytes[list_end..].iter().rev().fold(0u64, |n, byte| n << 8 | u64::from(*byte));
    if u64::from(index) >= count {
        return Err(format!("has {count} meshes, counted from 0, and no number {index}"));
    }
    let back = (count - u64::from(index)).checked_mul(each).and_then(|back| usize::try_from(back).ok());
    let at = back.and_then(|back| list_end.checked_sub(back)).ok_or("has no list of its meshes")?;
    let start = bytes[at..at + each as usize].iter().rev().fold(0u64, |n, byte| n << 8 | u64::from(*byte));
    usize::try_from(start).map_err(|_| "names a mesh beyond its end".into())
}

/// The deflated part of a mesh.
struct Body<'a> {
    stream: ZlibDecoder<&'a [u8]>,
    double: bool,
}

impl Body<'_> {
    fn mesh(mut self, version: u16) -> Result<TriangleMesh, String> {
        let flags = u32::from_le_bytes(self.array()?);
        self.double = flags & DOUBLE != 0;
        if version == 4 {
            self.skip_name()?;
        }
        let vertices = u64::from_le_bytes(self.array()?);
        let triangles = u64::from_le_bytes(self.array()?);
        if vertices > u64::from(u32::MAX) || triangles > u64::from(u32::MAX) {
            return Err(format!("claims {vertices} vertices and {triangles} triangles, more than 2³² − 1"));
        }
        let positions = self.tuples::<3>(vertices)?;
        let normals = if flags & HAS_NORMALS == 0 { None } else { Some(self.tuples::<3>(vertices)?) };
        let uvs = if flags & HAS_UVS == 0 { None } else { Some(self.tuples::<2>(vertices)?) };
        if flags & HAS_COLOURS != 0 {
            self.tuples::<3>(vertices)?;
        }
        // Grows with what the stream holds, whatever the header promises.
        let mut indices = Vec::new();
        for _ in 0..triangles {
            let corners: [u8; 12] = self.array()?;
            let (corners, _) = corners.as_chunks::<4>();
            indices.push([0, 1, 2].map(|i| u32::from_le_bytes(corners[i])));
        }
        let mesh = TriangleMesh {
            positions: positions.into_iter().map(Vec3::from_array).collect(),
            indices,
            normals: normals.map(|n| n.into_iter().map(Vec3::from_array).collect()),
            uvs: uvs.map(|uv| uv.into_iter().map(Vec2::from_array).collect()),
            ..TriangleMesh::default()
        }
        .checked()?;
        Ok(if flags & IS_FACETED == 0 { mesh } else { faceted(&mesh) })
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let mut bytes = [0; N];
        self.stream.read_exact(&mut bytes).map_err(|error| format!("breaks off within a mesh: {error}"))?;
        Ok(bytes)
    }

    fn skip_name(&mut self) -> Result<(), String> {
        for _ in 0..MAX_NAME {
            if self.array()? == [0u8] {
                return Ok(());
            }
        }
        Err(format!("has a mesh whose name is longer than {MAX_NAME} bytes"))
    }

    fn tuples<const N: usize>(&mut self, count: u64) -> Result<Vec<[f32; N]>, String> {
        let mut tuples = Vec::new();
        for _ in 0..count {
            let mut tuple = [0.0; N];
            for number in &mut tuple {
                *number = if self.double {
                    f64::from_le_bytes(self.array()?) as f32
                } else {
                    f32::from_le_bytes(self.array()?)
                };
            }
            tuples.push(tuple);
        }
        Ok(tuples)
    }
}

/// The same triangles with corners of their own, so that normals that are averaged at the corners are those of the faces.
fn faceted(mesh: &TriangleMesh) -> TriangleMesh {
    let corners = || mesh.indices.iter().flatten().map(|&corner| corner as usize);
    let count = mesh.indices.len() as u32;
    TriangleMesh {
        positions: corners().map(|corner| mesh.positions[corner]).collect(),
        indices: (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        normals: None,
        uvs: mesh.uvs.as_ref().map(|uvs| corners().map(|corner| uvs[corner]).collect()),
        ..TriangleMesh::default()
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use flate2::{Compression, write::ZlibEncoder};

    use super::*;

    /// A triangle at height `z` with a normal at each corner.
    fn triangle(version: u16, double: bool, z: f32) -> Vec<u8> {
        let mut body = (HAS_NORMALS | if double { DOUBLE } else { 0x1000 }).to_le_bytes().to_vec();
        if version == 4 {
            body.extend(b"a name\0");
        }
        body.extend([3u64, 1].into_iter().flat_map(u64::to_le_bytes));
        for v in [0.0, 0.0, z, 1.0, 0.0, z, 0.0, 1.0, z, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0f32] {
            if double { body.extend(f64::from(v).to_le_bytes()) } else { body.extend(v.to_le_bytes()) }
        }
        body.extend([0u32, 1, 2].into_iter().flat_map(u32::to_le_bytes));
        let mut bytes = [MAGIC.to_le_bytes(), version.to_le_bytes()].concat();
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
        encoder.write_all(&body).unwrap();
        bytes.extend(encoder.finish().unwrap());
        bytes
    }

    /// Two meshes and the list of where they are.
    fn file(version: u16) -> Vec<u8> {
        let mut bytes = triangle(version, false, 5.0);
        let second = bytes.len() as u64;
        bytes.extend(triangle(version, true, 7.0));
        for place in [0, second] {
            if version == 4 { bytes.extend(place.to_le_bytes()) } else { bytes.extend((place as u32).to_le_bytes()) }
        }
        bytes.extend(2u32.to_le_bytes());
        bytes
    }

    #[test]
    fn each_mesh_of_a_file_is_found_by_its_number_in_both_versions() {
        for version in [3, 4] {
            for (index, z) in [(0, 5.0), (1, 7.0)] {
                let mesh = parse_serialized(&file(version), index).unwrap();
                assert_eq!(mesh.positions, [Vec3::new(0.0, 0.0, z), Vec3::new(1.0, 0.0, z), Vec3::new(0.0, 1.0, z)]);
                assert_eq!((mesh.indices, mesh.uvs), (vec![[0, 1, 2]], None));
                assert_eq!(mesh.normals, Some(vec![Vec3::Z; 3]));
            }
            let missing = parse_serialized(&file(version), 2).unwrap_err();
            assert_eq!(missing, "has 2 meshes, counted from 0, and no number 2");
        }
    }

    #[test]
    fn a_mesh_flagged_as_faceted_has_corners_for_each_face_and_no_normals() {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        let indices = vec![[0, 1, 2], [0, 3, 1]];
        let mesh = TriangleMesh { positions, indices, normals: Some(vec![Vec3::Z; 4]), ..Default::default() };
        let faceted = faceted(&mesh);
        assert_eq!(faceted.positions, [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ZERO, Vec3::Z, Vec3::X]);
        assert_eq!((faceted.indices, faceted.normals), (vec![[0, 1, 2], [3, 4, 5]], None));
    }

    /// Every cut and every changed byte of a good file is an error or a mesh, and never a panic; a header that promises 2⁶⁰
    /// vertices ends with its stream.
    #[test]
    fn broken_files_are_survived() {
        let good = file(4);
        for end in 0..good.len() {
            let _ = parse_serialized(&good[..end], 0);
            let _ = parse_serialized(&good[..end], 1);
        }
        for at in 0..good.len() {
            let mut bad = good.clone();
            bad[at] ^= 0xFF;
            let _ = parse_serialized(&bad, 1);
        }
        let mut encoder = ZlibEncoder::new([0x1C, 0x04, 3, 0].to_vec(), Compression::default());
        encoder.write_all(&0u32.to_le_bytes()).unwrap();
        encoder.write_all(&[1u64 << 31, 1 << 31].map(u64::to_le_bytes).concat()).unwrap();
        let error = parse_serialized(&encoder.finish().unwrap(), 0).unwrap_err();
        assert!(error.starts_with("breaks off within a mesh"), "{error}");
        assert_eq!(
            parse_serialized(b"\x1c\x04\x05\x00", 0).unwrap_err(),
            "is a serialized mesh of version 5; versions 3 and 4 are read"
        );
    }
}
