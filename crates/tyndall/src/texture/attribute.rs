//! Colours that a mesh has at its vertices or faces (Mitsuba's mesh attributes).
//!
//! At a vertex they are interpolated over the triangle by the areas of its parts; a face has one colour. One texture can be
//! on many meshes, each with its own colours; on what has none it is black.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DAffine3;

use super::TexturePoint;
use crate::math::Vec3;

/// The colours of meshes as a texture.
#[derive(Debug, Clone)]
pub struct Attribute {
    /// They; many textures may show them.
    pub painted: Arc<Painted>,
    /// A factor on them \[1\].
    pub scale: f32,
    /// The greatest value, for what must be a share of light \[1\].
    pub most: f32,
}

/// The meshes of a scene that have colours of one name.
#[derive(Debug, Default)]
pub struct Painted {
    /// By object.
    pub meshes: HashMap<u32, Coat>,
    /// By instance: from the world to the space of its group.
    pub to_group: Vec<DAffine3>,
}

/// The colours of a mesh.
#[derive(Debug, Clone)]
pub struct Coat {
    /// Its vertices, in the world or in its group [length].
    pub positions: Vec<Vec3>,
    /// Three vertices a triangle.
    pub indices: Vec<[u32; 3]>,
    /// Linear sRGB.
    pub colours: Colours,
}

/// Where the colours of a mesh are.
#[derive(Debug, Clone)]
pub enum Colours {
    /// One a vertex.
    AtVertices(Vec<[f32; 3]>),
    /// One a triangle.
    OfFaces(Vec<[f32; 3]>),
}

impl Attribute {
    /// Linear sRGB at a point.
    pub fn rgb(&self, at: &TexturePoint) -> [f32; 3] {
        let colour = self.painted.at(at).unwrap_or_default();
        (colour * self.scale).clamp(Vec3::ZERO, Vec3::splat(self.most)).to_array()
    }
}

impl Painted {
    fn at(&self, at: &TexturePoint) -> Option<Vec3> {
        let part = at.part?;
        let coat = self.meshes.get(&part.object)?;
        match &coat.colours {
            Colours::OfFaces(colours) => colours.get(part.prim as usize).copied().map(Vec3::from_array),
            Colours::AtVertices(colours) => {
                let corners = *coat.indices.get(part.prim as usize)?;
                let [c0, c1, c2] = corners.map(|i| colours.get(i as usize).copied().map(Vec3::from_array));
                let p = at.p.as_dvec3();
                let p = self.to_group.get(part.instance as usize).map_or(p, |map| map.transform_point3(p));
                let [p0, p1, p2] = corners.map(|i| coat.positions[i as usize].as_dvec3());
                let (e1, e2, e) = (p1 - p0, p2 - p0, p - p0);
                // The least squares of e = b₁ e₁ + b₂ e₂.
                let normal = e1.cross(e2);
                let square = normal.length_squared();
                let [b1, b2] = [e.cross(e2), e1.cross(e)].map(|n| (n.dot(normal) / square) as f32);
                let b1 = if square > 0.0 { b1 } else { 0.0 };
                let b2 = if square > 0.0 { b2 } else { 0.0 };
                Some(c0? * (1.0 - b1 - b2) + c1? * b1 + c2? * b2)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Ray, Transform};
    use crate::shape::{GeometryBuilder, Mesh};
    use glam::{DAffine3, DVec3};

    /// At the corners their colours, in the middle the mean; seen through an instance, and by faces.
    #[test]
    fn colours_are_interpolated_between_vertices() {
        let positions = vec![Vec3::ZERO, Vec3::X * 3.0, Vec3::new(0.0, 3.0, 1.0), Vec3::new(3.0, 3.0, 1.0)];
        let indices = vec![[0, 1, 2], [1, 3, 2]];
        let map = DAffine3::from_scale(DVec3::new(-2.0, 1.0, 1.0)) * DAffine3::from_translation(DVec3::X);
        let mesh = Mesh { positions: positions.clone(), indices: indices.clone(), ..Mesh::default() };
        let mut builder = GeometryBuilder::new();
        let group = builder.begin_group();
        builder.add_mesh(mesh, &Transform::IDENTITY, false).unwrap();
        builder.end_group();
        builder.add_instance(group, &Transform::new(map.into()).unwrap()).unwrap();
        let geometry = builder.build().unwrap();
        let at = |p: DVec3| {
            let p = map.transform_point3(p).as_vec3();
            let ray = Ray::new(p + Vec3::Z, -Vec3::Z);
            TexturePoint::from(&geometry.interaction(&ray, &geometry.intersect(&ray, 10.0).unwrap()))
        };
        let attribute = |colours| Attribute {
            painted: Arc::new(Painted {
                meshes: HashMap::from([(0, Coat { positions: positions.clone(), indices: indices.clone(), colours })]),
                to_group: vec![map.inverse()],
            }),
            scale: 0.5,
            most: 1.0,
        };
        let near = |found: [f32; 3], expected: [f32; 3]| {
            assert!((Vec3::from_array(found) - Vec3::from_array(expected)).length() < 1e-5, "{found:?} {expected:?}");
        };
        let corners = vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [4.0, 0.0, 0.0]];
        let smooth = attribute(Colours::AtVertices(corners));
        near(smooth.rgb(&at(DVec3::new(1.0, 1.0, 1.0 / 3.0))), [0.5 / 3.0; 3]);
        near(smooth.rgb(&at(DVec3::new(0.6, 0.3, 0.1))), [0.35, 0.1, 0.05]);
        let flat = attribute(Colours::OfFaces(vec![[0.2, 0.4, 0.6], [0.8; 3]]));
        near(flat.rgb(&at(DVec3::new(1.0, 1.0, 1.0 / 3.0))), [0.1, 0.2, 0.3]);
        near(flat.rgb(&at(DVec3::new(2.0, 2.0, 2.0 / 3.0))), [0.4; 3]);
    }
}
