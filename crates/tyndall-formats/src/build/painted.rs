//! Colours that meshes bring along, for the textures that show them.

use std::sync::Arc;

use glam::DAffine3;
use tyndall::{
    shape::{Geometry, ObjectId, Shape},
    texture::attribute::{Coat, Colours, Painted},
};

use super::Builder;
use crate::{desc::TextureKind, mesh::TriangleMesh};

/// Objects that have colours of their own.
pub(super) type Painting = Vec<(u32, Colours)>;

impl Builder<'_> {
    /// Takes the colours of the mesh that becomes `object`, if any texture shows them.
    pub(super) fn keep_colours(&self, mesh: &mut TriangleMesh, object: u32, painting: &mut Painting) {
        let is_shown = |faces| {
            let shows =
                |kind: &TextureKind| matches!(kind, TextureKind::Attribute { of_faces, .. } if *of_faces == faces);
            self.desc.textures.iter().any(|texture| shows(&texture.kind))
        };
        let at_vertices = mesh.colours.take().filter(|_| is_shown(false)).map(Colours::AtVertices);
        let of_faces = mesh.face_colours.take().filter(|_| is_shown(true)).map(Colours::OfFaces);
        painting.extend(at_vertices.into_iter().chain(of_faces).map(|colours| (object, colours)));
    }

    /// Puts them where textures find them.
    pub(super) fn paint(&mut self, geometry: &Geometry, painting: Painting) {
        let to_group = || self.desc.instances.iter().map(|i| DAffine3::from_mat4(i.to_world.inverse())).collect();
        let mut painted = [0; 2].map(|_| Painted { to_group: to_group(), ..Painted::default() });
        for (object, colours) in painting {
            let Shape::Mesh(mesh) = geometry.shape(ObjectId(object)) else { continue };
            let of_faces = matches!(colours, Colours::OfFaces(_));
            let coat = Coat { positions: mesh.positions.clone(), indices: mesh.indices.clone(), colours };
            painted[usize::from(of_faces)].meshes.insert(object, coat);
        }
        self.painted = painted.map(Arc::new);
    }
}
