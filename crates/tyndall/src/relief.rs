//! Relief: surfaces that are shaded as if they were uneven. Bump maps say how high, normal maps say how steep.
//!
//! With the unit shading normal `n` and heights `h(u, v)` along it,
//!
//! `n′ ∝ (∂p/∂u + h_u n) × (∂p/∂v + h_v n)`,
//!
//! turned to the side of the true normal. A normal map has `n′` itself, in the shading frame (s along ∂p/∂u, t = n × s), as
//! the colour `(n′ + 1)/2`. Only the frame of the BSDF changes: which side of a surface is inside is for the true normal.
//!
//! The two scene languages differ in the rest ([`Rule`]):
//!
//! | | Mitsuba 3.9 | pbrt-v4 |
//! |---|---|---|
//! | tangents | without their parts along `n` | as they are, with `h ∂n/∂u` added; on meshes with normals `∂p/∂u` at right angles to `n`, and `n × ∂p/∂u` |
//! | `n′` faces away from the viewer | its tangential part is turned round (Schüßler et al. 2017), unless the file says no: then the BSDF is seen from its other side, which is black within `twosided` and at a boundary | the BSDF is seen from its other side; that of a boundary as if it were even |
//! | light through the relief | times `2 / (1 + √(1 + α² tan² θ_i))`, `α² = min(tan² θ_n′ / 8, 1)`, θ from `n` (Estevez, Lecocq and Stellmann 2019), unless the file says no | unchanged |
//! | a direction on different sides of `n` and `n′` | black | as the BSDF says; at a boundary black, or by the even surface if it is clear |
//!
//! Where a boundary is shaded by its true normal anyway (see [`crate::path::Vertex::surface`]) it has no relief.

use crate::{
    math::{Frame, Vec3},
    shape::{Geometry, Interaction},
    texture::{Texture, TexturePoint},
};

/// The relief of a material.
#[derive(Debug, Clone)]
pub struct Relief {
    /// What it is.
    pub map: Map,
    /// What is done where it would turn light round.
    pub rule: Rule,
}

/// A relief by its heights or by its normals.
#[derive(Debug, Clone)]
pub enum Map {
    /// A bump map.
    Heights {
        /// Height along the normal [length].
        texture: Texture,
        /// A factor on it \[1\].
        scale: f32,
    },
    /// A normal map: a texture of the colours `(n′ + 1)/2`.
    Normals(Texture),
}

/// Whose relief it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rule {
    /// Mitsuba's.
    Mitsuba {
        /// Whether normals that face away from the viewer are turned.
        flips: bool,
        /// Whether the relief shadows itself.
        shadows: bool,
        /// Whether the back has the mirror image of the relief of the front, so that what is high on one is high on the
        /// other (`twosided` around the relief); else what is high on the front is deep on the back.
        mirrored: bool,
    },
    /// pbrt's.
    Pbrt,
}

/// A frame for shading, and how the relief shadows itself there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Embossed {
    /// The local space of the BSDF.
    pub(crate) frame: Frame,
    /// Of a relief that is Mitsuba's: α² of its shadowing \[1\].
    pub(crate) shadowing: Option<f32>,
}

impl Relief {
    /// Whether the back has the mirror image of the relief of the front.
    pub(crate) fn is_mirrored(&self) -> bool {
        matches!(self.rule, Rule::Mitsuba { mirrored: true, .. })
    }

    /// The shading at `hit` seen from `wo`, given the shading of the even surface.
    pub(crate) fn emboss(&self, geometry: &Geometry, hit: &Interaction, even: &Frame, wo: Vec3) -> Embossed {
        let n = match &self.map {
            Map::Heights { texture, scale } => self.steep(geometry, hit, even, texture, *scale),
            Map::Normals(texture) => Vec3::from_array(texture.rgb(&hit.into())) * 2.0 - 1.0,
        };
        match self.rule {
            Rule::Pbrt => Embossed { frame: about(even, n), shadowing: None },
            Rule::Mitsuba { flips, shadows, mirrored } => {
                let n = facing(n, even.to_local(wo), flips, mirrored);
                let tan2 = n.truncate().length_squared() / (n.z * n.z);
                let shadowing = if shadows { (0.125 * tan2).min(1.0) } else { 0.0 };
                Embossed { frame: about(even, n), shadowing: Some(shadowing) }
            }
        }
    }

    /// The normal of a surface with these heights, in the frame of the even one.
    fn steep(&self, geometry: &Geometry, hit: &Interaction, even: &Frame, texture: &Texture, scale: f32) -> Vec3 {
        let derivatives = geometry.derivatives(hit);
        let n = even.n;
        let [mut du, mut dv] = derivatives.dp;
        let at = TexturePoint::from(hit);
        let mut lift = [Vec3::ZERO; 2];
        if self.rule == Rule::Pbrt {
            if derivatives.is_smooth_mesh {
                du = even.s * du.reject_from_normalized(n).length();
                dv = n.cross(du);
            }
            lift = derivatives.dn.map(|d| d * (scale * texture.scalar(&at)));
        } else {
            (du, dv) = (du.reject_from_normalized(n), dv.reject_from_normalized(n));
        }
        let slope = texture.gradient(&at, [du, dv]) * scale;
        let normal = (du + n * slope.x + lift[0]).cross(dv + n * slope.y + lift[1]);
        // Parameters that run the other way round.
        let normal = if normal.dot(hit.ng) < 0.0 { -normal } else { normal };
        even.to_local(normal)
    }
}

/// Mitsuba's care for normals that face away from `wo`; all in the frame of the even surface.
fn facing(n: Vec3, wo: Vec3, flips: bool, mirrored: bool) -> Vec3 {
    let back = mirrored && wo.z < 0.0;
    let wo = if back { Vec3::new(wo.x, wo.y, -wo.z) } else { wo };
    let turned = Vec3::new(-n.x, -n.y, n.z);
    let n = if flips && wo.z * wo.dot(n) <= 0.0 { turned } else { n };
    // Seen in the mirror and from behind.
    if back { Vec3::new(-n.x, -n.y, n.z) } else { n }
}

/// A frame around `n`, given in the frame `even` and not unit, with its s along the other's.
fn about(even: &Frame, n: Vec3) -> Frame {
    let n = n.try_normalize().unwrap_or(Vec3::Z);
    match (Vec3::X - n * n.x).try_normalize() {
        Some(s) => Frame { s: even.to_world(s), t: even.to_world(n.cross(s)), n: even.to_world(n) },
        None => Frame::around(even.to_world(n)),
    }
}

/// The share of the light along a direction that a relief lets through, by the cosine of its angle from the even normal and
/// the α² of its shadowing \[1\].
#[inline]
pub(crate) fn unshadowed(alpha2: f32, cos_theta: f32) -> f32 {
    let cos2 = cos_theta * cos_theta;
    if cos2 == 0.0 {
        return if alpha2 == 0.0 { 1.0 } else { 0.0 };
    }
    2.0 / (1.0 + (1.0 + alpha2 * (1.0 - cos2).max(0.0) / cos2).sqrt())
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::math::{Ray, Transform, Vec2};
    use crate::shape::{GeometryBuilder, Mesh};
    use crate::texture::{Grey, ImageTexture, Interpolation, Mapping2, Picture, Wrap};

    const EVEN: Rule = Rule::Mitsuba { flips: true, shadows: true, mirrored: false };

    /// The square [0, 2] × [0, 4] at z = 0 with u along x and v along y.
    fn square(transform: &Transform) -> Geometry {
        let mesh = Mesh {
            positions: vec![Vec3::ZERO, Vec3::X * 2.0, Vec3::new(2.0, 4.0, 0.0), Vec3::Y * 4.0],
            indices: vec![[0, 1, 2], [0, 2, 3]],
            uvs: vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y],
            ..Mesh::default()
        };
        let mut builder = GeometryBuilder::new();
        builder.add_mesh(mesh, transform, false).unwrap();
        builder.build().unwrap()
    }

    fn picture(pixels: Vec<[f32; 3]>) -> Texture {
        Texture::Image(ImageTexture {
            picture: Arc::new(Picture { width: 2, height: pixels.len() as u32 / 2, pixels }),
            mapping: Mapping2::UV,
            wrap: Wrap::Clamp,
            interpolation: Interpolation::Bilinear,
            scale: 1.0,
            invert: false,
            grey: Grey::Mean,
            least: f32::MIN,
            most: f32::MAX,
        })
    }

    fn embossed(relief: &Relief, transform: &Transform, p: Vec3, wo: Vec3) -> Embossed {
        let geometry = square(transform);
        let ray = Ray::new(p + wo, -wo);
        let hit = geometry.interaction(&ray, &geometry.intersect(&ray, 10.0).unwrap());
        relief.emboss(&geometry, &hit, &hit.shading_frame(), wo)
    }

    /// Heights 0 to 1 between the centres of two pixels, u = 1/4 to 3/4, x = 0.5 to 1.5: a slope of 1, and `n′ ∝ (−1, 0, 1)`.
    /// Times a scale of 3, ∝ (−3, 0, 1). Along v nothing changes. Mirrored in z, what rises towards the viewer is the same.
    #[test]
    fn a_slope_of_one_leans_half_a_right_angle() {
        let mirror = Transform::new(glam::DMat4::from_scale(glam::DVec3::new(1.0, 1.0, -1.0))).unwrap();
        for rule in [EVEN, Rule::Pbrt] {
            for scale in [1.0, 3.0] {
                let texture = picture(vec![[0.0; 3], [1.0; 3], [0.0; 3], [1.0; 3]]);
                let relief = Relief { map: Map::Heights { texture, scale }, rule };
                let p = Vec3::new(1.0, 2.0, 0.0);
                let at = embossed(&relief, &Transform::IDENTITY, p, Vec3::Z);
                let expected = Vec3::new(-scale, 0.0, 1.0).normalize();
                assert!((at.frame.n - expected).length() < 1e-5, "{rule:?}: {}", at.frame.n);
                assert!((at.frame.s.cross(at.frame.t) - at.frame.n).length() < 1e-5);
                assert_eq!(at.shadowing, (rule == EVEN).then_some((0.125 * scale * scale).min(1.0)));
                let at = embossed(&relief, &mirror, p, Vec3::Z);
                // The outside is below now: heights grow away from the viewer.
                assert!((at.frame.n + Vec3::new(scale, 0.0, 1.0).normalize()).length() < 1e-5, "{}", at.frame.n);
            }
        }
    }

    /// The colour (1, 1/2, 1) is the direction (1, 0, 1), that is along u; (1/2, 1, 1) leans along v.
    #[test]
    fn a_normal_map_is_its_colours() {
        for (colour, direction) in
            [([1.0, 0.5, 1.0], Vec3::new(1.0, 0.0, 1.0)), ([0.5, 1.0, 1.0], Vec3::new(0.0, 1.0, 1.0))]
        {
            for rule in [EVEN, Rule::Pbrt] {
                let relief = Relief { map: Map::Normals(picture(vec![colour; 4])), rule };
                let at = embossed(&relief, &Transform::IDENTITY, Vec3::new(0.3, 0.7, 0.0), Vec3::Z);
                assert!((at.frame.n - direction.normalize()).length() < 1e-6, "{rule:?}: {}", at.frame.n);
            }
        }
    }

    /// Seen from low on the side that it leans away from, the normal is turned to the viewer; from behind, what `twosided`
    /// mirrors leans the same way, and what it does not the other way.
    #[test]
    fn normals_that_face_away_are_turned_round() {
        let n = Vec3::new(-0.9, 0.0, 0.5);
        let low = Vec3::new(1.0, 0.0, 0.2);
        assert_eq!(facing(n, low, true, false), Vec3::new(0.9, 0.0, 0.5));
        assert_eq!(facing(n, low, false, false), n);
        let behind = Vec3::new(0.0, 0.0, -1.0);
        assert_eq!(facing(n, behind, true, false), n);
        assert_eq!(facing(n, behind, true, true), Vec3::new(0.9, 0.0, 0.5));
    }

    /// α² = 1 at 45°: 2/(1 + √2). Straight down all passes, and at the horizon nothing.
    #[test]
    fn shadowing_grows_towards_the_horizon() {
        assert!((unshadowed(1.0, 0.5f32.sqrt()) - 0.828_427).abs() < 1e-5);
        assert_eq!([unshadowed(1.0, 1.0), unshadowed(0.0, 0.1), unshadowed(1.0, 0.0)], [1.0, 1.0, 0.0]);
    }
}
