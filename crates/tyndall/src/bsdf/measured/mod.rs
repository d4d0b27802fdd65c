//! A measured surface: the BRDFs of RGL's database, isotropic or not, in RGB or at many wavelengths.
//!
//! What was measured is a product, of which each factor is a table that is linear between its samples:
//!
//! ```text
//! f cos θi = S(s; o, λ) · D(u_m) / (4 σ(u_o))        m = (o + i)/|o + i|,   s = V⁻¹(u_m; o)
//! p(i)     = L(s; o) · p_V(u_m; o) / (4 (o·m) · 2π² √(2θm/π) sin θm)
//! u(w)     = (√(2θ/π), (φ + π)/2π)
//! ```
//!
//! `D` are the facets' normals, `σ` is their projected area, and `V` the warp of the unit square to the normals that are
//! visible from `o`: where the material was measured, in the adapted places `s`, are the values `S`. `L` is the density of
//! its luminance in `s`. A direction is drawn by `L`, then by `V`, and mirrored in the normal; the weight is what is left of
//! the product. For an isotropic material φm counts from φo. Files without the flag of the Jacobian have the factor of
//! `D/(4σ)` in their values. One whose tables cover a half or a quarter of the azimuths is symmetric in as many planes.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `tables` | [`Tables`] of the material | |
//! | `channels` | the channels or wavelengths of the lanes: what the tables have as their third parameter \[1 or nm\] | |
//! | `sides` | which sides reflect | |
//!
//! Source: Dupuy and Jakob 2018, "An adaptive parameterization for efficient material acquisition and rendering".

mod grid;
mod tables;

pub use grid::{Block, Grid, GridError};
pub use tables::{Channels, Parts, Tables, TablesError};

use super::{BsdfSample, ScatterKind, Sides, seen_from};
use crate::math::{Vec2, Vec3, fast::sin_cos_turn};
use crate::spectrum::{Lanes, Wavelengths};
use std::f32::consts::{FRAC_2_PI, FRAC_PI_2, PI};

/// The least Jacobian of the map of normals to the unit square: it is singular at the pole.
const LEAST_JACOBIAN: f32 = 1e-6;

/// A measured surface at the wavelengths of a path.
#[derive(Debug, Clone, Copy)]
pub struct Measured<'a> {
    /// The material.
    pub tables: &'a Tables,
    /// Of each lane, the channel \[1\] or the wavelength [nm].
    pub channels: [f32; 4],
    /// Which sides reflect; the other is black.
    pub sides: Sides,
}

/// Tables are compared by where they are: they are large.
impl PartialEq for Measured<'_> {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.tables, other.tables) && self.channels == other.channels && self.sides == other.sides
    }
}

/// A direction from which the surface is seen.
struct View {
    wo: Vec3,
    /// Azimuth and polar angle: the parameters of the tables [rad].
    angles: [f32; 2],
}

/// A facet in the coordinates of the tables.
struct Normal {
    m: Vec3,
    at: Vec2,
    /// `o·m`.
    cos: f32,
}

impl<'a> Measured<'a> {
    /// At the wavelengths of a path, on both sides.
    pub fn new(tables: &'a Tables, wavelengths: &Wavelengths) -> Self {
        let channels = match wavelengths {
            Wavelengths::Rgb => [0.0, 1.0, 2.0, 1.0],
            Wavelengths::Mono => [0.0; 4],
            Wavelengths::Spectral { lambda, .. } => *lambda,
        };
        Self { tables, channels, sides: Sides::Both }
    }

    /// `f·|cos θi|` [1/sr] on the side of `wo`.
    #[inline(never)]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Lanes {
        if !self.sides.reflect(wo, wi) {
            return Lanes::ZERO;
        }
        let (view, wi, _) = self.view(seen_from(wo, wo), seen_from(wo, wi));
        let Some(normal) = self.normal(&view, wi) else { return Lanes::ZERO };
        let (s, _) = self.tables.visible.invert(&self.tables.visible.blend(&view.angles), normal.at);
        self.value(&view, &normal, s)
    }

    /// The density [1/sr] of [`Self::sample`].
    #[inline(never)]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if !self.sides.reflect(wo, wi) {
            return 0.0;
        }
        let (view, wi, _) = self.view(seen_from(wo, wo), seen_from(wo, wi));
        let Some(normal) = self.normal(&view, wi) else { return 0.0 };
        let Tables { visible, luminance, .. } = self.tables;
        let (s, p_visible) = visible.invert(&visible.blend(&view.angles), normal.at);
        p_visible * luminance.eval(&luminance.blend(&view.angles), s) / normal.jacobian()
    }

    /// The mirror image in a facet where the surface is bright; `None` when it points below the surface.
    #[inline(never)]
    pub fn sample(&self, wo: Vec3, u: Vec2) -> Option<BsdfSample> {
        if !self.sides.answer(wo) {
            return None;
        }
        let (view, _, mirror) = self.view(seen_from(wo, wo), Vec3::Z);
        let Tables { visible, luminance, .. } = self.tables;
        let (s, p_bright) = luminance.sample(&luminance.blend(&view.angles), u);
        let (at, p_visible) = visible.sample(&visible.blend(&view.angles), s);
        let (sin_theta, cos_theta) = libm::sincosf(at.x * at.x * FRAC_PI_2);
        let from = if self.tables.isotropic { view.angles[0] / (2.0 * PI) } else { 0.0 };
        let (sin_phi, cos_phi) = sin_cos_turn((at.y + 0.5 + from).rem_euclid(1.0));
        let m = Vec3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta);
        let normal = Normal { m, at, cos: view.wo.dot(m) };
        let wi = 2.0 * normal.cos * m - view.wo;
        let pdf = p_bright * p_visible / normal.jacobian();
        (wi.z > 0.0 && normal.cos > 0.0 && pdf > 0.0 && pdf.is_finite()).then(|| BsdfSample {
            wi: seen_from(wo, wi * mirror),
            weight: self.value(&view, &normal, s) / pdf,
            pdf,
            kind: ScatterKind::Reflection,
            specular: false,
            eta: 1.0,
        })
    }

    /// The value for a facet in its adapted place.
    fn value(&self, view: &View, normal: &Normal, s: Vec2) -> Lanes {
        let tables = self.tables;
        let [phi, theta] = view.angles;
        let spectrum = self.channels.map(|c| tables.spectra.eval(&tables.spectra.blend(&[phi, theta, c]), s).max(0.0));
        if !tables.jacobian {
            return Lanes::new(spectrum);
        }
        let none = tables.normals.blend(&[]);
        let area = tables.area.eval(&none, square(theta, phi));
        let facets = tables.normals.eval(&none, normal.at);
        if area > 0.0 { Lanes::new(spectrum) * (facets.max(0.0) / (4.0 * area)) } else { Lanes::ZERO }
    }

    /// Both directions where the tables have them, and the signs of x and y that bring them back.
    fn view(&self, wo: Vec3, wi: Vec3) -> (View, Vec3, Vec3) {
        let opposite = |x: f32| -(1f32.copysign(x));
        let mirror = match self.tables.symmetry {
            1 => Vec3::ONE,
            2 => {
                let turn = opposite(wo.y);
                Vec3::new(turn, turn, 1.0)
            }
            _ => Vec3::new(opposite(wo.x), opposite(wo.y), 1.0),
        };
        let (wo, wi) = (wo * mirror, wi * mirror);
        (View { wo, angles: [libm::atan2f(wo.y, wo.x), polar(wo)] }, wi, mirror)
    }

    /// The facet that takes the view to `wi`.
    fn normal(&self, view: &View, wi: Vec3) -> Option<Normal> {
        let m = (view.wo + wi).try_normalize()?;
        let phi = libm::atan2f(m.y, m.x) - if self.tables.isotropic { view.angles[0] } else { 0.0 };
        let at = square(polar(m), phi);
        Some(Normal { m, at: Vec2::new(at.x, at.y - at.y.floor()), cos: view.wo.dot(m) })
    }
}

impl Normal {
    /// `|di/du_m|`.
    fn jacobian(&self) -> f32 {
        let sin = libm::sqrtf(self.m.x * self.m.x + self.m.y * self.m.y);
        4.0 * self.cos * (2.0 * PI * PI * self.at.x * sin).max(LEAST_JACOBIAN)
    }
}

/// The angle to the pole, without losing small ones.
fn polar(w: Vec3) -> f32 {
    2.0 * libm::asinf((0.5 * (w - Vec3::Z).length()).min(1.0))
}

/// Angles to the unit square.
fn square(theta: f32, phi: f32) -> Vec2 {
    Vec2::new((theta * FRAC_2_PI).max(0.0).sqrt(), (phi + PI) / (2.0 * PI))
}
