//! The rows of a binary PLY file, read in place: a mesh of ten million triangles is a quarter of a gigabyte of them.

use serde_ply::{ElementDef, PlyFormat, PlyHeader, PropertyType, ScalarType};
use tyndall::math::{Vec2, Vec3};

use super::{TriangleMesh, fan, ply::Column};

const TOO_SHORT: &str = "the file ends too early";

/// The elements that a header promises, out of the bytes behind it. The counts have been checked against the length of
/// the file.
pub(super) fn read_elements(header: &PlyHeader, rest: &[u8]) -> Result<TriangleMesh, String> {
    let mut mesh = TriangleMesh::default();
    let mut bytes = Bytes { rest, big_endian: header.format == PlyFormat::BinaryBigEndian };
    for element in &header.elem_defs {
        let has_lists = element.properties.iter().any(|p| matches!(p.property_type, PropertyType::List { .. }));
        if element.name == "vertex" {
            read_vertices(element, &mut bytes, &mut mesh)
        } else if has_lists || element.name == "face" {
            read_faces(element, &mut bytes, &mut mesh)
        } else {
            let row: usize = element.properties.iter().map(|p| stored(&p.property_type).size()).sum();
            bytes.take(row.saturating_mul(element.count)).map(drop)
        }
        .map_err(|problem| format!("element `{}`: {problem}", element.name))?;
    }
    Ok(mesh)
}

fn read_vertices(element: &ElementDef, bytes: &mut Bytes, mesh: &mut TriangleMesh) -> Result<(), String> {
    let columns = columns(element);
    let has = |numbers| has(&columns, numbers);
    let (has_normals, has_uvs, has_colours) = (has(3..6), has(6..8), has(8..11));
    mesh.positions.reserve_exact(element.count);
    let normals = has_normals.then(|| mesh.normals.get_or_insert_default());
    let uvs = has_uvs.then(|| mesh.uvs.get_or_insert_default());
    let colours = has_colours.then(|| mesh.colours.get_or_insert_default());
    let (mut normals, mut uvs, mut colours) = (normals, uvs, colours);
    let mut row = [0.0; 11];
    for _ in 0..element.count {
        for (property, column) in &columns {
            match (property, column) {
                (PropertyType::Scalar(scalar), Column::Number(i)) => row[*i] = bytes.number(*scalar)?,
                _ => bytes.skip(property)?,
            }
        }
        let [x, y, z, nx, ny, nz, u, v, r, g, b] = row;
        mesh.positions.push(Vec3::new(x, y, z));
        if let Some(normals) = &mut normals {
            normals.push(Vec3::new(nx, ny, nz));
        }
        if let Some(uvs) = &mut uvs {
            uvs.push(Vec2::new(u, v));
        }
        if let Some(colours) = &mut colours {
            colours.push([r, g, b]);
        }
    }
    Ok(())
}

fn read_faces(element: &ElementDef, bytes: &mut Bytes, mesh: &mut TriangleMesh) -> Result<(), String> {
    let columns = columns(element);
    if columns.iter().any(|(_, column)| *column == Column::Corners) {
        mesh.indices.reserve(element.count);
    }
    let has_colours = has(&columns, 8..11);
    let (mut corners, mut row) = (Vec::new(), [0.0; 11]);
    for _ in 0..element.count {
        for (property, column) in &columns {
            match (property, column) {
                (PropertyType::List { count_type, data_type }, Column::Corners) => {
                    let count = bytes.index(*count_type)?;
                    if count == 3
                        && let Some(triangle) = bytes.triangle(*data_type)
                    {
                        mesh.indices.push(triangle);
                        continue;
                    }
                    corners.clear();
                    for _ in 0..count {
                        corners.push(bytes.index(*data_type)?);
                    }
                    fan(&corners, &mut mesh.indices);
                }
                (PropertyType::Scalar(scalar), Column::Number(i)) => row[*i] = bytes.number(*scalar)?,
                _ => bytes.skip(property)?,
            }
        }
        if has_colours {
            let [.., r, g, b] = row;
            mesh.face_colours.get_or_insert_default().resize(mesh.indices.len(), [r, g, b]);
        }
    }
    Ok(())
}

fn has(columns: &[(PropertyType, Column)], numbers: std::ops::Range<usize>) -> bool {
    numbers.into_iter().all(|i| columns.iter().any(|(_, column)| *column == Column::Number(i)))
}

fn columns(element: &ElementDef) -> Vec<(PropertyType, Column)> {
    element.properties.iter().map(|p| (p.property_type.clone(), Column::of(&element.name, &p.name))).collect()
}

/// What a property stores first: the number itself, or how long the list is.
fn stored(property: &PropertyType) -> ScalarType {
    let (PropertyType::Scalar(stored) | PropertyType::List { count_type: stored, .. }) = property;
    *stored
}

trait Size {
    fn size(self) -> usize;
}

impl Size for ScalarType {
    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

/// What has not been read yet.
struct Bytes<'a> {
    rest: &'a [u8],
    big_endian: bool,
}

impl<'a> Bytes<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], String> {
        let (taken, rest) = self.rest.split_at_checked(count).ok_or(TOO_SHORT)?;
        self.rest = rest;
        Ok(taken)
    }

    #[inline]
    fn array<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let (taken, rest) = self.rest.split_first_chunk::<N>().ok_or(TOO_SHORT)?;
        self.rest = rest;
        let mut bytes = *taken;
        if self.big_endian {
            bytes.reverse();
        }
        Ok(bytes)
    }

    #[inline]
    fn number(&mut self, scalar: ScalarType) -> Result<f32, String> {
        Ok(match scalar {
            ScalarType::F32 => f32::from_le_bytes(self.array()?),
            ScalarType::F64 => f64::from_le_bytes(self.array()?) as f32,
            integer => self.integer(integer)? as f32,
        })
    }

    /// A vertex, or a length.
    #[inline]
    fn index(&mut self, scalar: ScalarType) -> Result<u32, String> {
        let value = self.integer(scalar)?;
        u32::try_from(value).map_err(|_| format!("{value} is no index"))
    }

    #[inline]
    fn integer(&mut self, scalar: ScalarType) -> Result<i64, String> {
        Ok(match scalar {
            ScalarType::I8 => i8::from_le_bytes(self.array()?).into(),
            ScalarType::U8 => u8::from_le_bytes(self.array()?).into(),
            ScalarType::I16 => i16::from_le_bytes(self.array()?).into(),
            ScalarType::U16 => u16::from_le_bytes(self.array()?).into(),
            ScalarType::I32 => i32::from_le_bytes(self.array()?).into(),
            ScalarType::U32 => u32::from_le_bytes(self.array()?).into(),
            ScalarType::F32 | ScalarType::F64 => return Err("a list of indices must hold integers".into()),
        })
    }

    /// Three vertices at once, if they stand there as most programs write them; else nothing is taken.
    #[inline]
    fn triangle(&mut self, scalar: ScalarType) -> Option<[u32; 3]> {
        let limit = match scalar {
            ScalarType::I32 => i32::MAX as u32,
            ScalarType::U32 => u32::MAX,
            _ => return None,
        };
        let (taken, rest) = self.rest.split_first_chunk::<12>()?;
        let (corners, _) = taken.as_chunks::<4>();
        let read = if self.big_endian { u32::from_be_bytes } else { u32::from_le_bytes };
        let triangle = [0, 1, 2].map(|i| read(corners[i]));
        if triangle.iter().any(|&corner| corner > limit) {
            return None;
        }
        self.rest = rest;
        Some(triangle)
    }

    fn skip(&mut self, property: &PropertyType) -> Result<(), String> {
        let size = match property {
            PropertyType::Scalar(scalar) => scalar.size(),
            PropertyType::List { count_type, data_type } => {
                (self.index(*count_type)? as usize).saturating_mul(data_type.size())
            }
        };
        self.take(size).map(drop)
    }
}
