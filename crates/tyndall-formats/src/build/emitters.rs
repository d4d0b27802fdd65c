//! The lights that shapes are.

use std::f64::consts::PI;

use tyndall::{
    light::{AreaLight, Beam, Coordinates, EmitterShape, Light, LightId, Pattern, Revolved},
    math::{Vec2, Vec3},
    scene::Emission,
    shape::{Geometry, Hit, Mesh, ObjectId, Shape, Turn},
    spectrum::{Spectrum, Wavelengths, srgb},
    texture::{Part, Texture, TexturePoint},
};

use super::{Builder, spectra::Measure};
use crate::{
    desc::{AreaLightDesc, Spread, Varying},
    error::SceneError,
    source::Spanned,
};

/// Points a side by which the light of a patterned surface is summed up, of a shape and of one triangle of many.
const FINENESS: [u32; 2] = [32, 4];
/// The least part of its light that a dark piece of a patterned surface counts as: a guess may have missed a bright spot.
const LEAST: f32 = 1e-4;
/// The most points a side by which a picture is summed up.
const FINEST: u32 = 2048;

/// An object that shines.
pub(super) struct Shining<'a> {
    pub(super) object: ObjectId,
    pub(super) light: &'a AreaLightDesc,
    /// How much of it is there, if not all.
    pub(super) opacity: Option<&'a Spanned<Varying>>,
    /// Whether each of its triangles is a light of its own in the scene's language.
    pub(super) by_face: bool,
}

/// The light of an object, before it is divided among its pieces.
struct Emitted {
    radiance: Spectrum,
    texture: Option<Texture>,
    /// How much is there where a texture says so; else all or a constant part of it.
    opacity: Result<f32, Texture>,
}

impl Builder<'_> {
    /// The lights of a shining object, added to `lights`.
    pub(super) fn emitters(
        &mut self,
        geometry: &Geometry,
        shining: &Shining,
        lights: &mut Vec<Light>,
    ) -> Option<Emission> {
        let desc = shining.light;
        let mut radiance = self.emission(&desc.radiance)?;
        let texture = match &desc.pattern {
            None => None,
            Some(pattern) => Some(self.texture(pattern, Measure::Coefficient)?),
        };
        if radiance.is_zero() {
            return Some(Emission::None);
        }
        let opacity = match shining.opacity.map(|opacity| (opacity, opacity.value.number())) {
            None => Ok(1.0),
            Some((_, Some(opacity))) => Ok(opacity as f32),
            Some((opacity, None)) => Err(self.texture(opacity, Measure::Share)?),
        };
        let pieces = pieces(geometry, shining.object);
        if desc.spread == Spread::Straight {
            return self.beams(geometry, shining, &pieces, &radiance, lights);
        }
        let pieces = match geometry.shape(shining.object) {
            // Textures know triangles, and no parallelograms.
            Shape::Mesh(mesh) if texture.is_some() || opacity.is_err() => triangles(mesh),
            _ => pieces,
        };
        let area: f64 = pieces.shapes().iter().map(|piece| f64::from(piece.area())).sum();
        if let Some(power) = desc.power {
            let mean = match &texture {
                Some(texture) => mean_luminance(texture, self.picture_size(desc.pattern.as_ref())),
                None => 1.0,
            };
            let of_unit = PI * mean * if desc.two_sided { 2.0 } else { 1.0 };
            // Of a face by its own area, below; of a whole by the whole area.
            let by = if shining.by_face { of_unit } else { of_unit * area };
            let factor = power / by;
            if !factor.is_finite() {
                return self.fail(SceneError::at(desc.span, "what is black or has no area has no power"));
            }
            radiance = radiance.scaled(factor as f32);
        }
        let emitted = Emitted { radiance, texture, opacity };
        let first = LightId(lights.len() as u32);
        let each = matches!(pieces, Pieces::Each(_));
        for (prim, shape) in pieces.shapes().iter().enumerate() {
            let mut share = 1.0;
            if desc.power.is_some() && shining.by_face {
                // A parallelogram is two faces.
                let faces = if matches!(shape, EmitterShape::Parallelogram { .. }) { 2.0 } else { 1.0 };
                share = faces / shape.area();
            }
            let part = Part { object: shining.object.0, prim: prim as u32, instance: Hit::NO_INSTANCE };
            let lies = || (coordinates(geometry.shape(shining.object), part.prim), part);
            let fineness = FINENESS[usize::from(each)];
            lights.push(Light::Area(emitted.of(*shape, share, desc.two_sided, lies, fineness)));
        }
        Some(if each { Emission::EachPrimitive(first) } else { Emission::Whole(first) })
    }

    /// Flat pieces that shine straight ahead.
    fn beams(
        &mut self,
        geometry: &Geometry,
        shining: &Shining,
        pieces: &Pieces,
        exitance: &Spectrum,
        lights: &mut Vec<Light>,
    ) -> Option<Emission> {
        let faceted = !matches!(geometry.shape(shining.object), Shape::Mesh(mesh) if !mesh.normals.is_empty());
        let shapes = pieces.shapes();
        let curved = |shape: &EmitterShape| {
            matches!(shape, EmitterShape::Sphere { .. } | EmitterShape::Patch(_) | EmitterShape::Revolved(_))
        };
        if !faceted || shapes.iter().any(curved) {
            let error = SceneError::not_yet(shining.light.span, "only flat faces can shine straight ahead yet");
            return self.fail(error.help("use a rectangle, a disk, or a mesh with \"face_normals\""));
        }
        if let Some(pattern) = &shining.light.pattern {
            return self.fail(SceneError::not_yet(pattern.span, "light straight ahead has no texture yet"));
        }
        let (exitance, luminance) = (exitance.clone(), exitance.luminance());
        let beam = |shape: &EmitterShape| Light::Beam(Beam { shape: *shape, exitance: exitance.clone(), luminance });
        lights.extend(shapes.iter().map(beam));
        Some(Emission::None)
    }
}

impl Emitted {
    /// The light of a piece that has a `share` of the radiance.
    fn of(
        &self,
        shape: EmitterShape,
        share: f32,
        two_sided: bool,
        lies: impl FnOnce() -> (Coordinates, Part),
        fineness: u32,
    ) -> AreaLight {
        let radiance = self.radiance.clone().scaled(share);
        let mut luminance = radiance.luminance();
        let opacity = *self.opacity.as_ref().unwrap_or(&1.0);
        let varies = self.texture.is_some() || self.opacity.is_err();
        let pattern = varies.then(|| {
            let (coordinates, part) = lies();
            Box::new(Pattern {
                texture: self.texture.clone().unwrap_or_else(|| 1.0.into()),
                opacity: self.opacity.as_ref().err().cloned().unwrap_or_else(|| 1.0.into()),
                coordinates,
                part: Some(part),
            })
        });
        if let Some(pattern) = &pattern {
            let mean = pattern.mean_luminance(&radiance, &shape, fineness) as f32;
            luminance = mean.max(LEAST * luminance);
        }
        AreaLight { shape, radiance, luminance, two_sided, opacity, pattern }
    }
}

/// The surface of an object, as it can be sampled.
pub(super) enum Pieces {
    /// All of it at once.
    Whole(EmitterShape),
    /// A piece for each primitive.
    Each(Vec<EmitterShape>),
}

impl Pieces {
    /// In order.
    pub(super) fn shapes(&self) -> &[EmitterShape] {
        match self {
            Self::Whole(shape) => std::slice::from_ref(shape),
            Self::Each(shapes) => shapes,
        }
    }
}

/// The surface of an object.
pub(super) fn pieces(geometry: &Geometry, object: ObjectId) -> Pieces {
    Pieces::Whole(match geometry.shape(object) {
        Shape::Sphere(sphere) => match sphere.round() {
            Some((centre, radius)) => EmitterShape::Sphere { centre, radius, inward: sphere.reversed },
            None => EmitterShape::Revolved(Revolved::sphere(sphere)),
        },
        Shape::Disk(disk) => match disk.radius().filter(|_| disk.turn == Turn::FULL) {
            Some(radius) => {
                EmitterShape::Disk { centre: disk.centre, ng: disk.normal(), radius, inner: disk.inner * radius }
            }
            None => EmitterShape::Revolved(Revolved::disk(disk)),
        },
        Shape::Cylinder(cylinder) => EmitterShape::Revolved(Revolved::cylinder(cylinder)),
        Shape::Patch(patch) => EmitterShape::Patch(*patch),
        // Strands do not shine.
        Shape::Curves(_) => return Pieces::Each(Vec::new()),
        Shape::Mesh(mesh) => match as_parallelogram(mesh) {
            Some(parallelogram) => parallelogram,
            None => return triangles(mesh),
        },
    })
}

fn triangles(mesh: &Mesh) -> Pieces {
    let prims = 0..mesh.indices.len() as u32;
    Pieces::Each(prims.map(|prim| triangle(mesh.triangle(prim), mesh.reversed)).collect())
}

/// Where a piece lies on textures.
fn coordinates(whole: &Shape, prim: u32) -> Coordinates {
    match whole {
        Shape::Mesh(mesh) => Coordinates::Flat(mesh.corner_uvs(prim)),
        shape => Coordinates::Of(Box::new(shape.clone())),
    }
}

/// The mean of a picture's luminance, by the middles of its pixels.
fn mean_luminance(texture: &Texture, size: [u32; 2]) -> f64 {
    let [columns, rows] = size.map(|side| side.clamp(1, FINEST));
    let middle = |i: u32, n: u32| (i as f32 + 0.5) / n as f32;
    let places = (0..rows).flat_map(|j| (0..columns).map(move |i| Vec2::new(middle(i, columns), middle(j, rows))));
    let luminance = |uv: Vec2| {
        let lanes =
            texture.eval(&TexturePoint { p: Vec3::ZERO, uv: uv.into(), n: Vec3::Z, part: None }, &Wavelengths::Rgb);
        f64::from(srgb::luminance([0, 1, 2].map(|lane| lanes.lane(lane))))
    };
    places.map(luminance).sum::<f64>() / (f64::from(columns) * f64::from(rows))
}

fn triangle([a, b, c]: [Vec3; 3], reversed: bool) -> EmitterShape {
    let (e1, e2) = (b - a, c - a);
    let ng = unit_normal(e1, e2);
    EmitterShape::Triangle { a, e1, e2, ng: if reversed { -ng } else { ng } }
}

/// In double precision: thin triangles have normals too.
fn unit_normal(e1: Vec3, e2: Vec3) -> Vec3 {
    e1.as_dvec3().cross(e2.as_dvec3()).normalize_or_zero().as_vec3()
}

/// Two triangles that make a parallelogram, as one emitter: it can be sampled by solid angle.
fn as_parallelogram(mesh: &Mesh) -> Option<EmitterShape> {
    if mesh.indices.len() != 2 {
        return None;
    }
    let [first, second] = [mesh.triangle(0), mesh.triangle(1)];
    // Turn the first triangle until its corner 0 is the one that the second does not have.
    let turn = (0..3).find(|i| !second.contains(&first[*i]))?;
    let [a, b, c] = [first[turn], first[(turn + 1) % 3], first[(turn + 2) % 3]];
    let far = second.into_iter().find(|p| *p != b && *p != c)?;
    let (e1, e2) = (b - a, c - a);
    let size = (b - a).length() + (c - a).length() + a.length();
    let ng = unit_normal(e1, e2);
    let same_side = unit_normal(second[1] - second[0], second[2] - second[0]).dot(ng) > 0.999;
    let closes = (b + e2 - far).length() <= 4.0 * f32::EPSILON * size;
    (closes && same_side && second.contains(&b) && second.contains(&c)).then(|| EmitterShape::Parallelogram {
        a,
        e1,
        e2,
        ng: if mesh.reversed { -ng } else { ng },
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::triangles::rectangle;

    #[test]
    fn a_rectangle_is_one_emitter_that_shines_along_z() {
        let Some(EmitterShape::Parallelogram { e1, e2, ng, .. }) = as_parallelogram(&rectangle()) else { panic!() };
        assert_eq!((e1.cross(e2).length(), ng), (4.0, Vec3::Z));
        let mut bent = rectangle();
        bent.positions[3] = Vec3::new(-1.5, 1.0, 0.0);
        assert!(as_parallelogram(&bent).is_none());
    }
}
