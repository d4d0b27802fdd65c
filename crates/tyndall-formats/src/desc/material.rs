//! What surfaces are made of.

use tyndall::relief::Rule;

use super::{FileRef, HairDesc, MaterialId, PrincipledDesc, PrincipledThinDesc, Span, Spanned, SpectrumDesc, Varying};

/// A material.
#[derive(Clone, Debug, PartialEq)]
pub struct MaterialDesc {
    /// The words that made it.
    pub span: Span,
    /// Its name, if it has one.
    pub name: Option<String>,
    /// The model.
    pub kind: MaterialKind,
    /// Whether a model that reflects only does so on both sides. pbrt: always; Mitsuba: if wrapped in `twosided`.
    /// Without it the side that the normal points away from is black. Models that transmit have two sides anyway.
    pub two_sided: bool,
}

/// The model of a material.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialKind {
    /// Lambert's law.
    Diffuse {
        /// Reflectance, in [0, 1].
        reflectance: Spanned<Varying>,
    },
    /// A metal.
    Conductor {
        /// How it reflects.
        optics: ConductorOptics,
        /// Roughness.
        roughness: RoughnessDesc,
        /// Factor on what is reflected, if not 1.
        tint: Option<Spanned<Varying>>,
    },
    /// Glass, water, the skin of milk.
    Dielectric {
        /// Refractive index of the inside relative to the outside.
        eta: Spanned<SpectrumDesc>,
        /// Roughness.
        roughness: RoughnessDesc,
        /// Factor on what is reflected, if not 1.
        reflection_tint: Option<Spanned<Varying>>,
        /// Factor on what is transmitted, if not 1.
        transmission_tint: Option<Spanned<Varying>>,
    },
    /// A thin sheet of a dielectric, with both of its faces: a window pane.
    ThinDielectric {
        /// Refractive index of the sheet relative to its surroundings.
        eta: Spanned<SpectrumDesc>,
        /// Factor on what is reflected, if not 1.
        reflection_tint: Option<Spanned<Varying>>,
        /// Factor on what is transmitted, if not 1.
        transmission_tint: Option<Spanned<Varying>>,
    },
    /// Lambert's law on both sides of a thin sheet (pbrt).
    DiffuseTransmission {
        /// Reflectance, in [0, 1].
        reflectance: Spanned<Varying>,
        /// Transmittance, in [0, 1].
        transmittance: Spanned<Varying>,
        /// Factor on both, at least 0; each is held in [0, 1] after it.
        scale: f64,
    },
    /// A diffuse base under a smooth coat (Mitsuba).
    Plastic {
        /// Refractive index of the coat relative to the outside.
        eta: Spanned<SpectrumDesc>,
        /// Reflectance of the base, in [0, 1].
        reflectance: Spanned<Varying>,
        /// Whether light between base and coat deepens the colour.
        nonlinear: bool,
        /// Roughness of the coat, the same everywhere and in all directions; `None` where it is smooth.
        roughness: Option<RoughnessDesc>,
        /// Factor on what the coat reflects, if not 1.
        tint: Option<Spanned<Varying>>,
    },
    /// Burley's model of solids (Mitsuba).
    Principled(Box<PrincipledDesc>),
    /// Burley's model of sheets (Mitsuba).
    PrincipledThin(Box<PrincipledThinDesc>),
    /// A base under a coat of a dielectric (pbrt).
    Coated(Box<CoatedDesc>),
    /// A fibre of hair.
    Hair(Box<HairDesc>),
    /// A material as it was measured, in a file of RGL's.
    Measured {
        /// The file.
        path: FileRef,
    },
    /// No surface at all: a boundary of media that light passes unchanged.
    Interface,
    /// Two materials mixed.
    Mix {
        /// They; not this one again.
        of: [Spanned<MaterialId>; 2],
        /// How much of the second, in [0, 1].
        amount: Spanned<Varying>,
    },
    /// A material with holes: an [`Self::Interface`] where it is not there (Mitsuba).
    Mask {
        /// What there is.
        of: Spanned<MaterialId>,
        /// How much of it, in [0, 1].
        opacity: Spanned<Varying>,
    },
    /// Another material on each face (Mitsuba).
    TwoFaced {
        /// On the side of the normal, and on the other one.
        of: [Spanned<MaterialId>; 2],
    },
    /// A material shaded as if its surface were uneven.
    Embossed {
        /// It; neither this one nor one that is embossed is part of it.
        of: Spanned<MaterialId>,
        /// How uneven.
        map: ReliefMap,
        /// What is done where that would turn light round.
        rule: Rule,
    },
}

/// How uneven a surface is.
#[derive(Clone, Debug, PartialEq)]
pub enum ReliefMap {
    /// By heights along the normal, in scene units.
    Heights {
        /// They.
        texture: Spanned<Varying>,
        /// A factor on them.
        scale: f64,
    },
    /// By normals `n` in the shading frame, as the colours `(n + 1)/2`.
    Normals(Spanned<Varying>),
}

/// A base under a coat.
#[derive(Clone, Debug, PartialEq)]
pub struct CoatedDesc {
    /// Refractive index of the coat relative to the outside.
    pub eta: Spanned<SpectrumDesc>,
    /// Roughness of its surface.
    pub roughness: RoughnessDesc,
    /// Its thickness in mean free paths, at least 0.
    pub thickness: Spanned<Varying>,
    /// The share of what it extinguishes that it scatters, in [0, 1].
    pub albedo: Spanned<Varying>,
    /// The mean cosine of that scattering, held in [−1, 1].
    pub g: Spanned<Varying>,
    /// What is under it.
    pub base: BaseDesc,
    /// Scatterings between the way in and the way out after which light is lost.
    pub max_depth: u16,
    /// Random walks of one evaluation, at least 1.
    pub walks: u16,
}

/// What is under a coat.
#[derive(Clone, Debug, PartialEq)]
pub enum BaseDesc {
    /// Lambert's law with this reflectance, in [0, 1].
    Diffuse(Spanned<Varying>),
    /// A metal.
    Conductor {
        /// How it reflects without the coat.
        optics: ConductorOptics,
        /// Roughness.
        roughness: RoughnessDesc,
    },
}

/// How a metal reflects.
#[derive(Clone, Debug, PartialEq)]
pub enum ConductorOptics {
    /// By Fresnel's equations for the complex index eta + i·k, relative to vacuum.
    EtaK {
        /// Real part.
        eta: Spanned<Varying>,
        /// Imaginary part.
        k: Spanned<Varying>,
    },
    /// By Fresnel's equations for the index (eta = 1) that gives this reflectance at normal incidence (pbrt).
    Reflectance(Spanned<Varying>),
    /// As a perfect mirror, at every angle (Mitsuba's material `none`).
    Mirror,
}

/// Roughness in the user's measure.
#[derive(Clone, Debug, PartialEq)]
pub struct RoughnessDesc {
    /// Along the first tangent, at least 0: 0 is smooth.
    pub u: Spanned<Varying>,
    /// Along the second tangent.
    pub v: Spanned<Varying>,
    /// Whether `u` and `v` are perceived roughness, whose square root is the α of the model (pbrt), or α itself.
    pub remap: bool,
    /// The distribution of normals.
    pub distribution: MicrofacetKind,
    /// How masking and shadowing depend on each other.
    pub shadowing: ShadowingKind,
}

/// A distribution of microscopic normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MicrofacetKind {
    /// Trowbridge and Reitz, known as GGX.
    Ggx,
    /// Beckmann and Spizzichino.
    Beckmann,
}

/// How microscopic masking and shadowing depend on each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShadowingKind {
    /// By the height of a facet (pbrt).
    Correlated,
    /// Not at all (Mitsuba).
    Separable,
}

impl RoughnessDesc {
    /// No roughness; `span` is where the file might have said otherwise.
    pub fn smooth(span: Span) -> Self {
        let none = Spanned::new(Varying::constant(0.0), span);
        let (distribution, shadowing) = (MicrofacetKind::Ggx, ShadowingKind::Correlated);
        Self { u: none.clone(), v: none, remap: false, distribution, shadowing }
    }

    /// The model's α along the two tangents, where it is the same everywhere.
    pub fn alpha(&self) -> Option<[f64; 2]> {
        let (u, v) = self.u.value.number().zip(self.v.value.number())?;
        Some(if self.remap { [u.sqrt(), v.sqrt()] } else { [u, v] })
    }
}
