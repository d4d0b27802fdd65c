//! Lights.

use glam::DMat4;

use super::{FileRef, FovAxis, MediumId, Span, Spanned, SpectrumDesc, Varying};

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
    /// Radiance \[W·m⁻²·sr⁻¹\]; of a light that is [`Spread::Straight`], exitance \[W·m⁻²\].
    pub radiance: EmissionDesc,
    /// A factor on it that varies over the surface, if one does.
    pub pattern: Option<Spanned<Varying>>,
    /// What each face of a mesh, or all of another shape, emits where radiance and pattern have luminance 1, if the file
    /// says so \[W\] (pbrt).
    pub power: Option<f64>,
    /// Whether the other side emits as well.
    pub two_sided: bool,
    /// Into which directions.
    pub spread: Spread,
    /// What layers of light call it, beside the name of its shape.
    pub name: Option<String>,
}

/// Into which directions a surface emits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spread {
    /// All, with the same radiance.
    Diffuse,
    /// Its normal only.
    Straight,
}

/// A light that is not a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct LightDesc {
    /// The words that made it.
    pub span: Span,
    /// What layers of light call it; several may have one name.
    pub name: Option<String>,
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
        /// A picture in front of it, which the cone of the cutoff touches at the middles of its sides, if there is one.
        slide: Option<Spanned<Varying>>,
    },
    /// A point whose intensity in each direction is in a picture.
    Goniometric {
        /// Radiant intensity \[W/sr\] where the picture is 1.
        intensity: EmissionDesc,
        /// A square picture of all directions, equal-area octahedral, +z in the middle; the mean of its channels counts.
        path: FileRef,
        /// What it emits where the intensity has luminance 1, if the file says so \[W\].
        power: Option<f64>,
    },
    /// A point that projects a picture, upright for one who looks along +z with +x to the right.
    Projector {
        /// What a clear slide gives: radiant intensity \[W/sr\] or irradiance \[W/m²\], as `even` says.
        emission: EmissionDesc,
        /// The slide; clear without one. Its `(u, v)` runs to +x and +y, from 0 to 1.
        slide: Option<Spanned<Varying>>,
        /// Field of view \[degrees\], in (0, 180).
        fov: Spanned<f64>,
        /// The side of the picture that it spans.
        axis: FovAxis,
        /// What it emits where the emission has luminance 1, if the file says so \[W\].
        power: Option<f64>,
        /// What is even behind a clear slide.
        even: Evenness,
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
        /// Illuminance \[lx\] of the image's own upper half (+z), as pbrt reckons it, if the file says so.
        illuminance: Option<f64>,
        /// Which pixel shows which direction.
        mapping: EnvironmentMapping,
    },
    /// The sky behind a rectangle, through which alone it is seen (pbrt).
    Portal {
        /// The corners in the world, in order round it: the sky is on the side of `(p₃ − p₀) × (p₁ − p₀)`.
        corners: Spanned<[[f64; 3]; 4]>,
        /// The radiance of the sky \[W·m⁻²·sr⁻¹\]; or a factor on that of its image.
        radiance: EmissionDesc,
        /// An image of it: equal-area octahedral, +z in the middle.
        path: Option<FileRef>,
        /// As in [`LightKind::Environment`].
        illuminance: Option<f64>,
    },
}

/// What is even where the slide of a projector is clear.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Evenness {
    /// pbrt: intensity.
    Intensity,
    /// Mitsuba: irradiance on a wall square to the axis; what is given is that at distance 1, over π.
    Irradiance,
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
