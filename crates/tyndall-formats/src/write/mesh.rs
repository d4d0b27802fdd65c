//! Meshes that the language cannot say in words: PLY files beside the scene.

use crate::build::triangles::{is_against_normals, triangles_of, with_normals_along_winding};
use crate::desc::{FileRef, ShapeDesc, ShapeKind};
use crate::error::SceneError;
use tyndall::shape::Mesh;

use crate::mesh::{TriangleMesh, read_ply, write_ply};

use super::{Draft, Language};

impl Draft<'_> {
    /// The name of a PLY file with the triangles of a shape as they are, normals and texture coordinates included. `None` if
    /// the mesh cannot be read, which is reported.
    pub(super) fn mesh(&mut self, shape: &ShapeDesc) -> Option<String> {
        let mesh = match triangles_of(&shape.kind)? {
            Ok(mesh) => mesh,
            Err(error) => {
                self.errors.push(SceneError::at(shape.span, error.to_string()));
                return None;
            }
        };
        Some(self.mesh_file(shape, mesh))
    }

    /// The name of a PLY file with these triangles, which are those of a shape.
    pub(super) fn mesh_file(&mut self, shape: &ShapeDesc, mesh: Mesh) -> String {
        let mesh = if self.language == Language::Pbrt { with_normals_along_winding(mesh) } else { mesh };
        let some = |present: bool| present.then_some(());
        let triangles = TriangleMesh {
            positions: mesh.positions,
            indices: mesh.indices,
            normals: some(!mesh.normals.is_empty()).map(|()| mesh.normals),
            uvs: some(!mesh.uvs.is_empty()).map(|()| mesh.uvs),
            ..TriangleMesh::default()
        };
        let mut bytes = Vec::new();
        // Writing to memory cannot fail.
        let _ = write_ply(&triangles, &mut bytes);
        self.file_beside(shape.span, wanted(shape), "ply", bytes)
    }
}

/// What the mesh of a shape would be called: as its file, or as the shape.
pub(super) fn wanted(shape: &ShapeDesc) -> &str {
    let file = match &shape.kind {
        ShapeKind::Ply { path, .. } | ShapeKind::Obj { path, .. } | ShapeKind::Serialized { path, .. } => {
            path.value.file_stem().and_then(|stem| stem.to_str())
        }
        _ => None,
    };
    file.or(shape.name.as_deref()).unwrap_or("mesh")
}

/// Whether triangles of a shape from a file have normals against their winding.
pub(super) fn has_normals_against_winding(kind: &ShapeKind) -> bool {
    let Some(Ok(mesh)) = triangles_of(kind) else { return false };
    mesh.indices.iter().any(|corners| is_against_normals(&mesh, *corners))
}

/// Whether a shape is placed without scaling it.
pub(super) fn keeps_lengths(shape: &ShapeDesc) -> bool {
    let axes = [shape.to_world.x_axis, shape.to_world.y_axis, shape.to_world.z_axis];
    let rounding = f64::from(f32::EPSILON);
    axes.iter()
        .enumerate()
        .all(|(i, a)| (a.length() - 1.0).abs() < rounding && axes[..i].iter().all(|b| a.dot(*b).abs() < rounding))
}

/// Whether a PLY file has normals. `None` if it cannot be read: whoever renders the scene is told.
pub(super) fn has_normals(path: &FileRef) -> Option<bool> {
    read_ply(&path.value).ok().map(|mesh| mesh.normals.is_some())
}
