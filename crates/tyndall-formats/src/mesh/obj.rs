//! Wavefront OBJ: vertices, texture coordinates, normals and faces; polygons become fans of triangles.
//!
//! Groups and materials are read over: a scene file gives one material to the whole mesh. Normals (and texture
//! coordinates) are used only if every corner of every face has one, because a mesh has them for all of its vertices or
//! for none.

use std::path::Path;

use tobj::LoadOptions;
use tyndall::math::{Vec2, Vec3};

use super::{MeshError, TriangleMesh, read_with};

const OPTIONS: LoadOptions =
    LoadOptions { single_index: true, triangulate: true, ignore_points: true, ignore_lines: true };

/// Reads an OBJ file.
///
/// # Errors
/// The file cannot be read, or is no proper OBJ file: the error names the line.
pub fn read_obj(path: &Path) -> Result<TriangleMesh, MeshError> {
    read_with(path, |bytes| parse_obj(&String::from_utf8_lossy(&bytes)))
}

/// Reads an OBJ file that is already in memory.
///
/// # Errors
/// As [`read_obj`]; what is wrong, not where the bytes came from.
pub fn parse_obj(text: &str) -> Result<TriangleMesh, String> {
    check_faces(text)?;
    let mut rest = text.as_bytes();
    let (models, _) = tobj::load_obj_buf(&mut rest, &OPTIONS, |_| Ok(Default::default())).map_err(|error| {
        let read = text.len() - rest.len();
        format!("line {}: {error}", text.get(..read).unwrap_or(text).lines().count())
    })?;

    let mut mesh = TriangleMesh::default();
    let (mut normals, mut uvs) = (Vec::new(), Vec::new());
    for part in models.into_iter().map(|model| model.mesh) {
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(part.positions.chunks_exact(3).map(Vec3::from_slice));
        mesh.indices.extend(part.indices.chunks_exact(3).map(|t| [first + t[0], first + t[1], first + t[2]]));
        normals.extend(part.normals.chunks_exact(3).map(Vec3::from_slice));
        uvs.extend(part.texcoords.chunks_exact(2).map(Vec2::from_slice));
    }
    mesh.normals = (!normals.is_empty() && normals.len() == mesh.positions.len()).then_some(normals);
    mesh.uvs = (!uvs.is_empty() && uvs.len() == mesh.positions.len()).then_some(uvs);
    mesh.checked()
}

/// Refuses faces that use a vertex, texture coordinate or normal that the file does not have. `tobj` would notice too,
/// but without the line, and its arithmetic overflows on indices near the limit of the machine.
fn check_faces(text: &str) -> Result<(), String> {
    const KINDS: [(&str, &str); 3] = [("v", "vertex"), ("vt", "texture coordinate"), ("vn", "normal")];
    let total = KINDS.map(|(word, _)| text.lines().map(|line| i64::from(first_word(line) == word)).sum::<i64>());
    let mut so_far = [0; 3];
    for (number, line) in text.lines().enumerate() {
        if let Some(kind) = KINDS.iter().position(|(word, _)| *word == first_word(line)) {
            so_far[kind] += 1;
        }
        if !matches!(first_word(line), "f" | "l") {
            continue;
        }
        for corner in line.split_whitespace().skip(1) {
            for (kind, index) in corner.split('/').enumerate().filter(|(_, index)| !index.is_empty()) {
                let (Some((_, what)), Ok(i)) = (KINDS.get(kind), index.parse::<i64>()) else {
                    return Err(format!("line {}: `{corner}` is no corner of a face", number + 1));
                };
                if i == 0 || i > total[kind] || i < -so_far[kind] {
                    let count = total[kind];
                    return Err(format!("line {}: there is no {what} {i} among {count} (counted from 1)", number + 1));
                }
            }
        }
    }
    Ok(())
}

fn first_word(line: &str) -> &str {
    line.split_whitespace().next().unwrap_or_default()
}
