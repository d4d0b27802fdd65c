//! PLY (Turk, "The PLY polygon file format", 1994): ascii, binary little-endian and binary big-endian.
//!
//! Read are the vertex properties `x y z`, `nx ny nz`, and texture coordinates under any of the names that programs
//! write (`u v`, `s t`, `texture_u texture_v`, `texture_s texture_t`), in any order and of any number type; the face lists
//! `vertex_indices` or `vertex_index`, whose polygons become fans of triangles; and colours of vertices and of faces, `r g b`,
//! `red green blue` or `color_0 color_1 color_2`, as the numbers that they are. All else is stepped over.

use std::fmt::{self, Formatter};
use std::io::{self, Write};
use std::ops::Range;
use std::path::Path;

use serde::de::{DeserializeSeed, Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde_ply::{DeserializeError, ElementDef, PlyFormat, PlyHeader, PlyReader, PropertyType, ScalarType};
use tyndall::math::{Vec2, Vec3};

use super::{MeshError, TriangleMesh, fan, ply_binary::read_elements, read_with};

/// Reads a PLY file.
///
/// # Errors
/// The file cannot be read, or is no proper PLY file.
pub fn read_ply(path: &Path) -> Result<TriangleMesh, MeshError> {
    read_with(path, parse_ply)
}

/// Reads a PLY file that is already in memory.
///
/// # Errors
/// As [`read_ply`]; what is wrong, not where the bytes came from.
pub fn parse_ply(mut bytes: Vec<u8>) -> Result<TriangleMesh, String> {
    // The last number of an ascii file may lack the white space that ends it.
    bytes.push(b'\n');
    let length = bytes.len();
    let mut reader = PlyReader::from_reader(bytes.as_slice()).map_err(|error| explain(&error))?;
    check_counts(reader.header(), length)?;
    for ElementDef { name, properties, .. } in &reader.header().elem_defs {
        let has = |axis: usize| properties.iter().any(|p| Column::of(name, &p.name) == Column::Number(axis));
        if name == "vertex" && !(0..3).all(has) {
            return Err("element `vertex` lacks one of the properties x, y and z".into());
        }
    }
    if reader.header().format != PlyFormat::Ascii {
        return read_elements(reader.header(), body(&bytes))?.checked();
    }

    let mut mesh = TriangleMesh::default();
    let (mut normals, mut uvs) = (Vec::new(), Vec::new());
    let (mut colours, mut face_colours) = (Vec::new(), Vec::new());
    let mut file = &mut reader;
    while let Some(ElementDef { name, properties, .. }) = file.current_element().cloned() {
        let columns: Vec<_> = properties.iter().map(|property| Column::of(&name, &property.name)).collect();
        let has = |numbers: Range<usize>| numbers.into_iter().all(|i| columns.contains(&Column::Number(i)));
        let (has_normals, has_uvs, has_colours) = (has(3..6), has(6..8), has(8..11));
        let mut each = |row: &Row| {
            let [x, y, z, nx, ny, nz, u, v, r, g, b] = row.numbers;
            if name == "vertex" {
                mesh.positions.push(Vec3::new(x, y, z));
            }
            if has_normals {
                normals.push(Vec3::new(nx, ny, nz));
            }
            if has_uvs {
                uvs.push(Vec2::new(u, v));
            }
            if has_colours && name == "vertex" {
                colours.push([r, g, b]);
            }
            fan(&row.corners, &mut mesh.indices);
            if has_colours && name == "face" {
                face_colours.resize(mesh.indices.len(), [r, g, b]);
            }
        };
        file.next_value_seed(Rows { columns: &columns, each: &mut each })
            .map_err(|error| format!("element `{name}`: {}", explain(&error)))?;
    }
    mesh.normals = (!normals.is_empty()).then_some(normals);
    mesh.uvs = (!uvs.is_empty()).then_some(uvs);
    mesh.colours = (!colours.is_empty()).then_some(colours);
    mesh.face_colours = (!face_colours.is_empty()).then_some(face_colours);
    mesh.checked()
}

/// What follows the header.
fn body(bytes: &[u8]) -> &[u8] {
    let mut rest = bytes;
    while let Some(end) = rest.iter().position(|&byte| byte == b'\n') {
        let line = rest[..end].trim_ascii();
        rest = &rest[end + 1..];
        if line == b"end_header" {
            return rest;
        }
    }
    &[]
}

/// Writes a mesh as binary little-endian PLY.
///
/// # Errors
/// The bytes cannot be written.
pub fn write_ply(mesh: &TriangleMesh, out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "ply\nformat binary_little_endian 1.0\nelement vertex {}", mesh.positions.len())?;
    let columns = [("x y z", true), ("nx ny nz", mesh.normals.is_some()), ("u v", mesh.uvs.is_some())];
    for name in columns.iter().filter(|(_, present)| *present).flat_map(|(names, _)| names.split(' ')) {
        writeln!(out, "property float {name}")?;
    }
    writeln!(out, "element face {}\nproperty list uchar uint vertex_indices\nend_header", mesh.indices.len())?;
    for (i, p) in mesh.positions.iter().enumerate() {
        let normal = mesh.normals.iter().flat_map(|normals| normals[i].to_array());
        let uv = mesh.uvs.iter().flat_map(|uvs| uvs[i].to_array());
        for value in p.to_array().into_iter().chain(normal).chain(uv) {
            out.write_all(&value.to_le_bytes())?;
        }
    }
    for triangle in &mesh.indices {
        out.write_all(&[3])?;
        for index in triangle {
            out.write_all(&index.to_le_bytes())?;
        }
    }
    Ok(())
}

/// Refuses a header that promises more rows than a file of this length can hold.
fn check_counts(header: &PlyHeader, length: usize) -> Result<(), String> {
    let mut needed = 0usize;
    for element in &header.elem_defs {
        let row: usize = element.properties.iter().map(|p| least_bytes(&p.property_type, header.format)).sum();
        if row == 0 && element.count > 0 {
            return Err(format!("element `{}` has rows but no properties", element.name));
        }
        needed = needed.saturating_add(row.saturating_mul(element.count));
        if needed > length {
            let ElementDef { name, count, .. } = element;
            return Err(format!("the header promises {count} rows of `{name}`, more than the file can hold"));
        }
    }
    Ok(())
}

/// The fewest bytes that a value of this property takes: an empty list, a number of one digit with the white space
/// behind it.
fn least_bytes(property: &PropertyType, format: PlyFormat) -> usize {
    let (PropertyType::Scalar(stored) | PropertyType::List { count_type: stored, .. }) = property;
    match (format, stored) {
        (PlyFormat::Ascii, _) | (_, ScalarType::I16 | ScalarType::U16) => 2,
        (_, ScalarType::I8 | ScalarType::U8) => 1,
        (_, ScalarType::I32 | ScalarType::U32 | ScalarType::F32) => 4,
        (_, ScalarType::F64) => 8,
    }
}

/// The crate's message without its preamble.
fn explain(error: &DeserializeError) -> String {
    match error.0.kind() {
        io::ErrorKind::UnexpectedEof => "the file ends too early".into(),
        _ => error.0.to_string(),
    }
}

/// What a property of the file is to the mesh.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Column {
    /// 0–2 position, 3–5 normal, 6–7 texture coordinates, 8–10 colour of a vertex or a face.
    Number(usize),
    /// The list of the corners of a face.
    Corners,
    Other,
}

impl Column {
    pub(super) fn of(element: &str, property: &str) -> Self {
        match (element, property) {
            ("vertex", "x") => Self::Number(0),
            ("vertex", "y") => Self::Number(1),
            ("vertex", "z") => Self::Number(2),
            ("vertex", "nx") => Self::Number(3),
            ("vertex", "ny") => Self::Number(4),
            ("vertex", "nz") => Self::Number(5),
            ("vertex", "u" | "s" | "texture_u" | "texture_s") => Self::Number(6),
            ("vertex", "v" | "t" | "texture_v" | "texture_t") => Self::Number(7),
            ("vertex" | "face", "r" | "red" | "color_0") => Self::Number(8),
            ("vertex" | "face", "g" | "green" | "color_1") => Self::Number(9),
            ("vertex" | "face", "b" | "blue" | "color_2") => Self::Number(10),
            ("face", "vertex_indices" | "vertex_index") => Self::Corners,
            _ => Self::Other,
        }
    }
}

/// One row of any element; what its element lacks stays empty.
#[derive(Default)]
struct Row {
    numbers: [f32; 11],
    corners: Vec<u32>,
}

/// Reads all rows of an element, each handed to `each`.
struct Rows<'a> {
    columns: &'a [Column],
    each: &'a mut dyn FnMut(&Row),
}

impl<'de> DeserializeSeed<'de> for Rows<'_> {
    type Value = ();
    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_seq(self)
    }
}

impl<'de> Visitor<'de> for Rows<'_> {
    type Value = ();
    fn expecting(&self, f: &mut Formatter) -> fmt::Result {
        f.write_str("rows")
    }
    fn visit_seq<A: SeqAccess<'de>>(self, mut rows: A) -> Result<(), A::Error> {
        let mut row = Row::default();
        while rows.next_element_seed(OneRow { columns: self.columns, row: &mut row })?.is_some() {
            (self.each)(&row);
        }
        Ok(())
    }
}

struct OneRow<'a> {
    columns: &'a [Column],
    row: &'a mut Row,
}

impl<'de> DeserializeSeed<'de> for OneRow<'_> {
    type Value = ();
    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for OneRow<'_> {
    type Value = ();
    fn expecting(&self, f: &mut Formatter) -> fmt::Result {
        f.write_str("a row")
    }
    fn visit_map<A: MapAccess<'de>>(self, mut row: A) -> Result<(), A::Error> {
        for column in self.columns {
            match column {
                Column::Number(i) => self.row.numbers[*i] = row.next_value()?,
                Column::Corners => row.next_value_seed(Corners(&mut self.row.corners))?,
                Column::Other => drop(row.next_value::<IgnoredAny>()?),
            }
        }
        Ok(())
    }
}

/// Reads a list of vertex indices into a buffer that is used again for every face.
struct Corners<'a>(&'a mut Vec<u32>);

impl<'de> DeserializeSeed<'de> for Corners<'_> {
    type Value = ();
    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_seq(self)
    }
}

impl<'de> Visitor<'de> for Corners<'_> {
    type Value = ();
    fn expecting(&self, f: &mut Formatter) -> fmt::Result {
        f.write_str("a list of vertex indices")
    }
    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<(), A::Error> {
        self.0.clear();
        while let Some(index) = list.next_element()? {
            self.0.push(index);
        }
        Ok(())
    }
}
