//! A sky that is seen through a rectangular opening only: pbrt's `infinite` with a `portal`.
//!
//! The sky is held on a rectified image: in the frame of the opening, whose normal looks out at it, the direction
//! `(x, y, z)`, z > 0, lies at `u = ½ + atan(x/z)/π`, `v = ½ + atan(y/z)/π`. On this image the opening is a rectangle with
//! sides along u and v, seen from anywhere, so that what can be seen is sampled exactly in proportion to its light:
//!
//! `p(ω) = f(u, v) / ∫_window f · du dv/dω`, `dω/du dv = π² (1 − x²)(1 − y²) / z`, `f` luminance × that.
//!
//! Light comes through the opening and nowhere else: a ray sees the sky if it would pass the rectangle on its way. From
//! the outer side nothing is seen.
//!
//! Source: Bitterli, Novák and Jarosz 2015, "Portal-masked environment map sampling"; Pharr et al. 2023, § 12.5.3.

use std::f32::consts::PI;

use super::{LightSample, SkyError, SkyImage, Target, environment::equal_area_square};
use crate::{
    math::{Frame, Transform, Vec2, Vec3},
    sampling::windowed2d::{Window, Windowed2d},
    spectrum::{Lanes, Wavelengths, srgb},
};

/// Cosine by which sides may miss being parallel or square.
const CROOKED: f32 = 1e-3;

/// A sky behind an opening.
#[derive(Debug, Clone)]
pub struct Portal {
    /// Two opposite corners of the opening [length].
    corners: [Vec3; 2],
    /// Along its sides, and out.
    frame: Frame,
    /// Radiance on the rectified image.
    image: SkyImage,
    distribution: Windowed2d,
    /// Mean luminance of the sky on its side [W·m⁻²·sr⁻¹].
    mean_luminance: f32,
}

impl Portal {
    /// An opening with the corners `p`, in order round it, before a sky on an equal-area octahedral square, which
    /// `to_world` turns into the world. The sky is on the side of `(p₃ − p₀) × (p₁ − p₀)`.
    ///
    /// # Errors
    /// The corners are not those of a rectangle, or there is no light behind it.
    pub fn new(p: [Vec3; 4], to_world: &Transform, sky: &SkyImage) -> Result<Self, PortalError> {
        let sides = [(0, 3), (0, 1), (1, 2), (3, 2)].map(|(a, b): (usize, usize)| (p[b] - p[a]).normalize_or_zero());
        let [along, up, along_top, up_far] = [sides[0], sides[1], sides[2], sides[3]];
        let parallel = along.dot(along_top) > 1.0 - CROOKED && up.dot(up_far) > 1.0 - CROOKED;
        if !parallel || along.dot(up).abs() > CROOKED {
            return Err(PortalError::NoRectangle);
        }
        let n = along.cross(up).normalize();
        let frame = Frame { s: along, t: n.cross(along), n };
        let (width, height) = (sky.width, sky.height);
        let middles = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
        let middles =
            middles.map(|[x, y]| Vec2::new((x as f32 + 0.5) / width as f32, (y as f32 + 0.5) / height as f32));
        let mut pixels = Vec::with_capacity(sky.pixels.len());
        let mut weights = Vec::with_capacity(sky.pixels.len());
        let mut solid_angle = 0.0;
        for uv in middles {
            let (local, jacobian) = direction(uv);
            let out = to_world.inverse.transform_vector3(frame.to_world(local)).normalize();
            let rgb = sky.octahedral(equal_area_square(out));
            pixels.push(rgb);
            weights.push(srgb::luminance(rgb) * jacobian);
            solid_angle += f64::from(jacobian);
        }
        let total: f64 = weights.iter().map(|w| f64::from(*w)).sum();
        if total.is_nan() || total <= 0.0 {
            return Err(SkyError::Black.into());
        }
        let image = SkyImage::new(width, height, &pixels, 1.0)?;
        let distribution = Windowed2d::new(weights, width as usize).ok_or(SkyError::Black)?;
        let mean_luminance = (total / solid_angle) as f32;
        Ok(Self { corners: [p[0], p[2]], frame, image, distribution, mean_luminance })
    }

    /// What of the image the opening shows at a point; `None` from its outer side.
    #[inline]
    fn window(&self, from: Vec3) -> Option<Window> {
        let [a, b] = self.corners.map(|corner| place(self.frame.to_local(corner - from)));
        let (a, b) = (a?, b?);
        Some(Window { min: a.min(b), max: a.max(b) })
    }

    /// A bright direction through the opening.
    #[inline]
    pub fn sample(&self, from: Vec3, u: Vec2, wavelengths: &Wavelengths) -> Option<LightSample> {
        let (uv, pdf_uv) = self.distribution.sample(u, &self.window(from)?)?;
        let (local, jacobian) = direction(uv);
        let pdf = pdf_uv / jacobian;
        (pdf > 0.0 && pdf.is_finite()).then(|| LightSample {
            dir: self.frame.to_world(local).normalize(),
            li: self.image.radiance(uv, wavelengths),
            pdf,
            dirac: false,
            target: Target::Infinity,
        })
    }

    /// Density of [`Self::sample`] [1/sr].
    #[inline]
    pub fn pdf(&self, from: Vec3, dir: Vec3) -> f32 {
        let (Some(window), Some(uv)) = (self.window(from), place(self.frame.to_local(dir))) else { return 0.0 };
        let (_, jacobian) = direction(uv);
        self.distribution.pdf(uv, &window) / jacobian
    }

    /// Radiance that comes to `from` out of a direction [W·m⁻²·sr⁻¹].
    #[inline]
    pub fn le(&self, from: Vec3, dir: Vec3, wavelengths: &Wavelengths) -> Lanes {
        match (self.window(from), place(self.frame.to_local(dir))) {
            (Some(window), Some(uv)) if window.holds(uv) => self.image.radiance(uv, wavelengths),
            _ => Lanes::ZERO,
        }
    }

    /// A guess at the irradiance made at `p` [W·m⁻²]: zero only on the outer side.
    #[inline]
    pub fn importance(&self, p: Vec3) -> f32 {
        let Some(Window { min, max }) = self.window(p) else { return 0.0 };
        let (size, middle) = (max - min, 0.5 * (min + max));
        let (_, jacobian) = direction(middle);
        self.mean_luminance * (size.x * size.y * jacobian).clamp(f32::MIN_POSITIVE, PI)
    }

    /// That guess where the whole sky is seen [W·m⁻²].
    pub(crate) fn importance_at_large(&self) -> f32 {
        self.mean_luminance * PI
    }
}

/// The place on the image of a direction of the opening's space, which need not be a unit vector.
#[inline]
fn place(d: Vec3) -> Option<Vec2> {
    (d.z > 0.0).then(|| Vec2::new(d.x.atan2(d.z), d.y.atan2(d.z)) / PI + 0.5)
}

/// The direction of a place on the image, and the solid angle of a unit of its area [sr].
#[inline]
fn direction(uv: Vec2) -> (Vec3, f32) {
    // Tangents of (−π/2, π/2), as quotients, so that none is infinite.
    let ((sx, cx), (sy, cy)) = ((PI * (uv.x - 0.5)).sin_cos(), (PI * (uv.y - 0.5)).sin_cos());
    let d = Vec3::new(sx * cy, sy * cx, cx * cy);
    // (1 − x²)(1 − y²)/z is cos α cos β / ℓ³ with the length ℓ of d: no difference of near equals.
    let l = d.length().max(f32::MIN_POSITIVE);
    (d / l, PI * PI * (cx * cy).max(0.0) / (l * l * l))
}

/// An opening that cannot be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum PortalError {
    /// Sides are not parallel, or not at right angles.
    #[error("the corners of the portal are not those of a rectangle, in order round it")]
    NoRectangle,
    /// The sky cannot be used.
    #[error(transparent)]
    Sky(#[from] SkyError),
}
