//! Triangle meshes and strands as they stand in files: PLY, OBJ and Mitsuba's serialized; cyHair and lines of points.
//!
//! A file is read whole, and nothing is allocated that its own bytes could not fill, so that a header which promises
//! 10¹² vertices is an error and not an exhausted machine. What a reader returns has passed [`TriangleMesh::checked`].

mod displace;
mod normals;
mod obj;
mod ply;
mod ply_binary;
mod serialized;
mod strands;
mod subdivide;

use std::path::{Path, PathBuf};

use tyndall::math::{Vec2, Vec3};

use crate::gzip;

pub use displace::displace;
pub use obj::{parse_obj, read_obj};
pub use ply::{parse_ply, read_ply, write_ply};
pub use serialized::{parse_serialized, read_serialized};
pub use strands::{Strand, parse_hair, parse_strands, read_strands};
pub use subdivide::subdivide;

/// The longest mesh that a compressed file may hold \[bytes\]: some 50 million triangles.
const MAX_INFLATED_BYTES: u64 = 1 << 31;

/// Triangles over shared vertices, in the file's own frame and winding.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TriangleMesh {
    /// Where each vertex is \[length\].
    pub positions: Vec<Vec3>,
    /// The three vertices of each triangle, counter-clockwise as seen from outside.
    pub indices: Vec<[u32; 3]>,
    /// Shading normal of each vertex; not normalised.
    pub normals: Option<Vec<Vec3>>,
    /// Texture coordinates of each vertex, as the file has them.
    pub uvs: Option<Vec<Vec2>>,
    /// Colour of each vertex.
    pub colours: Option<Vec<[f32; 3]>>,
    /// Colour of each triangle.
    pub face_colours: Option<Vec<[f32; 3]>>,
}

/// Why a mesh file could not be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}: {problem}", path.display())]
pub struct MeshError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it.
    pub problem: String,
}

impl TriangleMesh {
    /// This mesh, if a renderer can take it: it has triangles, every index has its vertex, every number is finite, and
    /// normals and texture coordinates, if any, are as many as the vertices.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn checked(self) -> Result<Self, String> {
        let vertices = self.positions.len();
        if self.indices.is_empty() {
            return Err("has no triangles".into());
        }
        if let Some(i) = self.positions.iter().position(|p| !p.is_finite()) {
            return Err(format!("the position of vertex {i} is {}", self.positions[i]));
        }
        if let Some(i) = self.indices.iter().flatten().find(|&&i| i as usize >= vertices) {
            return Err(format!("a face uses vertex {i}, but there are {vertices} (counted from 0)"));
        }
        let normals = self.normals.as_deref().unwrap_or_default();
        let uvs = self.uvs.as_deref().unwrap_or_default();
        if let Some(i) = normals.iter().position(|n| !n.is_finite()) {
            return Err(format!("the normal of vertex {i} is {}", normals[i]));
        }
        if let Some(i) = uvs.iter().position(|uv| !uv.is_finite()) {
            return Err(format!("the texture coordinates of vertex {i} are {}", uvs[i]));
        }
        let (triangles, len) = (self.indices.len(), |list: &Option<Vec<[f32; 3]>>| list.as_ref().map(Vec::len));
        for (found, count, what) in [
            (self.normals.as_ref().map(Vec::len), vertices, "vertices but {} normals"),
            (self.uvs.as_ref().map(Vec::len), vertices, "vertices but {} uvs"),
            (len(&self.colours), vertices, "vertices but {} colours"),
            (len(&self.face_colours), triangles, "triangles but {} colours"),
        ] {
            if let Some(found) = found.filter(|found| *found != count) {
                return Err(format!("has {count} {}", what.replace("{}", &found.to_string())));
            }
        }
        Ok(self)
    }
}

/// Reads a whole file and hands its bytes to `parse`; either may find it at fault.
fn read_with<T>(path: &Path, parse: impl FnOnce(Vec<u8>) -> Result<T, String>) -> Result<T, MeshError> {
    std::fs::read(path)
        .map_err(|error| error.to_string())
        .and_then(|bytes| if gzip::is_gzip(path) { gzip::inflate(&bytes, MAX_INFLATED_BYTES) } else { Ok(bytes) })
        .and_then(parse)
        .map_err(|problem| MeshError { path: path.to_owned(), problem })
}

/// Splits a polygon into the fan of triangles around its first corner; fewer than three corners are none.
fn fan(polygon: &[u32], triangles: &mut Vec<[u32; 3]>) {
    let Some((&first, rest)) = polygon.split_first() else { return };
    triangles.extend(rest.windows(2).map(|side| [first, side[0], side[1]]));
}

#[cfg(test)]
mod tests;
