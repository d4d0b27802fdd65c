//! Lights.

use glam::DMat4;

use super::{FileRef, MediumId, Span, Spanned, SpectrumDesc};

/// A quantity of light: a spectrum times a factor.
#[derive(Clone, Debug, PartialEq)]
pub struct EmissionDesc {
    /// Its colour and, by [`EmissionDesc::magnitude`], its size.
    pub spectrum: Spanned<SpectrumDesc>,
    /// Factor.
    pub scale: f64,
    /// What the spectrum's own size means.
    pub magnitude: Magnitude,
}

/// What the size of a spectrum of light means. An RGB triple is the same in both: (1, 1, 1) has luminance 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Magnitude {
    /// It is the light's.
    AsWritten,
    /// Only its colour counts: it is divided by its luminance, so that [`EmissionDesc::scale`] is the luminance (pbrt-v4, for
    /// every spectrum except RGB).
    UnitLuminance,
}

/// Light that a surface emits, on the side that its normal points to.
#[derive(Clone, Debug, PartialEq)]
pub struct AreaLightDesc {
    /// The words that made it.
    pub span: Span,
    /// Radiance \[W·m⁻²·sr⁻¹\].
    pub radiance: EmissionDesc,
    /// Whether the other side emits as well.
    pub two_sided: bool,
}

/// A light that is not a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct LightDesc {
    /// The words that made it.
    pub span: Span,
    /// What kind.
    pub kind: LightKind,
    /// The light's own space to world. A light sits at the origin of its space and shines along +z: the position is the
    /// image of the origin, the direction the image of +z, normalised. pbrt's `from` and `to` are part of it.
    pub to_world: DMat4,
    /// The medium that it is in, if the file says.
    pub medium: Option<Spanned<MediumId>>,
}

/// What kind of light.
#[derive(Clone, Debug, PartialEq)]
pub enum LightKind {
    /// A point that shines in all directions.
    Point {
        /// Radiant intensity \[W/sr\].
        intensity: EmissionDesc,
    },
    /// A point that shines into a cone.
    Spot {
        /// Radiant intensity along the axis \[W/sr\].
        intensity: EmissionDesc,
        /// Angle from the axis beyond which it is dark \[degrees\].
        cutoff: f64,
        /// Angle from the axis within which it is full \[degrees\].
        beam: f64,
        /// In between.
        falloff: SpotFalloff,
    },
    /// Parallel light.
    Distant {
        /// Irradiance on a surface that it meets squarely \[W/m²\].
        irradiance: EmissionDesc,
    },
    /// The same from every direction.
    Constant {
        /// Radiance \[W·m⁻²·sr⁻¹\].
        radiance: EmissionDesc,
    },
    /// An image around the scene.
    Environment {
        /// The image: linear radiance \[W·m⁻²·sr⁻¹\], or sRGB codes if the format has 8 bits.
        path: FileRef,
        /// Factor.
        scale: f64,
        /// Which pixel shows which direction.
        mapping: EnvironmentMapping,
    },
}

/// How a spot fades between beam and cutoff.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpotFalloff {
    /// pbrt: the smooth step `t²(3 − 2t)` of the cosine, t from 0 at the cutoff to 1 at the beam.
    SmoothCosine,
    /// Mitsuba: linear in the angle.
    LinearAngle,
}

/// Which pixel of an environment image shows which direction ω, in the light's own space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EnvironmentMapping {
    /// pbrt: a square image, equal-area octahedral (Clarberg 2008), +z in the middle.
    EqualAreaOctahedral,
    /// Mitsuba: longitude by latitude, +y up: `u = atan2(ωx, −ωz) / 2π`, `v = acos(ωy) / π`, v from the top.
    LatitudeLongitude,
}
