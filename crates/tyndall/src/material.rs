//! What a surface is made of, as the scene has it: spectra that become a [`Bsdf`] at the wavelengths of a path.

mod coated;
mod hair;
mod principled;

pub use coated::{CoatedBase, CoatedMaterial};
pub use hair::{HairColour, HairTextures, Pigments};
pub use principled::{BurleyTextures, PrincipledTextures, ThinTextures};

use std::sync::Arc;

use crate::{
    bsdf::{
        Bsdf, Diffuse, Plastic, RoughCoat, RoughPlastic, Sides, index_of_reflectance,
        measured::{Measured, Tables},
        microfacet::{Distribution, Shadowing},
    },
    relief::Relief,
    scene::MaterialId,
    spectrum::{Lanes, Sampled, Spectrum, Wavelengths, glass::Glass},
    texture::{Texture, TexturePoint},
};

/// A surface's material. Some are made of others: [`crate::scene::Scene::meet`] finds which of them a path meets.
#[derive(Debug, Clone)]
pub enum Material {
    /// Lambertian.
    Diffuse {
        /// Reflectance, 0 to 1 [1].
        reflectance: Texture,
        /// The sides that reflect.
        sides: Sides,
    },
    /// Metal.
    Conductor {
        /// How it reflects.
        metal: Metal,
        /// Its microfacets, where it is rough.
        alpha: Roughness,
        /// A factor on what is reflected [1].
        tint: Texture,
        /// The sides that reflect.
        sides: Sides,
    },
    /// A boundary between two transparent media.
    Dielectric {
        /// Index of the inside over that of the outside [1].
        eta: Index,
        /// Its microfacets, where it is rough.
        alpha: Roughness,
        /// A factor on what is reflected [1].
        reflection_tint: Texture,
        /// A factor on what is transmitted [1].
        transmission_tint: Texture,
    },
    /// A thin sheet of a transparent medium.
    ThinDielectric {
        /// Index of the sheet over that of its surroundings [1].
        eta: Index,
        /// A factor on what is reflected [1].
        reflection_tint: Texture,
        /// A factor on what is transmitted [1].
        transmission_tint: Texture,
    },
    /// Lambertian on both sides of a thin sheet.
    DiffuseTransmission {
        /// Reflectance [1].
        reflectance: Texture,
        /// Transmittance [1].
        transmittance: Texture,
        /// A factor on both [1], after which each is held in 0 to 1.
        scale: f32,
    },
    /// A diffuse base under a smooth coat.
    Plastic {
        /// Index of the coat over that of the outside [1].
        eta: f32,
        /// Its [`internal_reflectance`](crate::bsdf::internal_reflectance) [1].
        internal: f32,
        /// Reflectance of the base [1].
        reflectance: Texture,
        /// Whether light between base and coat deepens the colour, or keeps its hue.
        nonlinear: bool,
        /// A factor on what the coat reflects [1].
        tint: Texture,
        /// The sides that reflect.
        sides: Sides,
    },
    /// A diffuse base under a rough coat.
    RoughPlastic {
        /// The coat.
        coat: Arc<RoughCoat>,
        /// Reflectance of the base [1].
        reflectance: Texture,
        /// Whether light between base and coat deepens the colour, or keeps its hue.
        nonlinear: bool,
        /// A factor on what the coat reflects [1].
        tint: Texture,
        /// The sides that reflect.
        sides: Sides,
    },
    /// Burley's model of solids.
    Principled(Box<PrincipledTextures>),
    /// Burley's model of sheets.
    PrincipledThin(Box<ThinTextures>),
    /// A base under a coat, rough or smooth, clear or cloudy.
    Coated(Box<CoatedMaterial>),
    /// A fibre of hair.
    Hair(Box<HairTextures>),
    /// As it was measured.
    Measured {
        /// What was.
        tables: Arc<Tables>,
        /// The sides that reflect.
        sides: Sides,
    },
    /// No material: light passes, and may enter another medium.
    Null,
    /// No surface either: light passes and stays in its medium, and nothing shines (pbrt's `alpha`).
    Hole,
    /// One material or the other, by chance at every meeting.
    Mix {
        /// Other materials of the scene; none may contain this one.
        of: [MaterialId; 2],
        /// The share of the second, 0 to 1 [1].
        amount: Texture,
    },
    /// Another material on each face.
    TwoFaced {
        /// On the side of the normal; it does not contain this one.
        outside: MaterialId,
        /// On the other side.
        inside: MaterialId,
    },
    /// Another material, shaded as if the surface were uneven.
    Embossed {
        /// It; neither this one nor one that is embossed is part of it.
        of: MaterialId,
        /// How uneven.
        relief: Box<Relief>,
    },
}

/// The microfacets of a rough surface.
#[derive(Debug, Clone)]
pub struct Roughness {
    /// Roughness α along the tangent [1].
    pub u: Texture,
    /// Across.
    pub v: Texture,
    /// Whether α is the square root of the textures' values (pbrt's `remaproughness`), or the value.
    pub remap: bool,
    /// The law of the slopes.
    pub distribution: Distribution,
    /// How masking and shadowing depend on each other.
    pub shadowing: Shadowing,
}

impl Roughness {
    /// The same α everywhere.
    pub fn constant([u, v]: [f32; 2]) -> Self {
        Self {
            u: u.into(),
            v: v.into(),
            remap: false,
            distribution: Distribution::default(),
            shadowing: Shadowing::default(),
        }
    }

    #[inline]
    fn at(&self, at: &TexturePoint) -> [f32; 2] {
        [&self.u, &self.v].map(|texture| {
            let value = texture.scalar(at).max(0.0);
            if self.remap { value.sqrt() } else { value }
        })
    }

    /// The same model with microfacets after these laws.
    #[inline]
    fn shape<'s>(&self, bsdf: Bsdf<'s>) -> Bsdf<'s> {
        bsdf.distributed(self.distribution, self.shadowing)
    }
}

/// How a metal reflects.
#[derive(Debug, Clone)]
pub enum Metal {
    /// By its complex index `eta + i·k` [1].
    Index {
        /// Real part [1].
        eta: Box<Texture>,
        /// Imaginary part [1].
        k: Box<Texture>,
    },
    /// By its reflectance at normal incidence, 0 to 1 [1].
    Reflectance(Texture),
    /// All light, at every angle.
    Mirror,
}

/// A relative index of refraction.
#[derive(Debug, Clone)]
pub enum Index {
    /// The same at every wavelength [1].
    Constant(f32),
    /// Another at every wavelength: light disperses.
    Glass(Glass),
    /// The same by a table; 1 where the table has nothing.
    Table(Sampled),
}

impl Metal {
    /// Its complex index, real and imaginary part [1].
    #[inline]
    fn index(&self, at: &TexturePoint, wavelengths: &Wavelengths) -> [Lanes; 2] {
        match self {
            Self::Index { eta, k } => [eta.eval(at, wavelengths), k.eval(at, wavelengths)],
            Self::Reflectance(r) => index_of_reflectance(r.eval(at, wavelengths)),
            // |1 − ik| = |1 + ik|: a purely imaginary index reflects all.
            Self::Mirror => [Lanes::ZERO, Lanes::ONE],
        }
    }
}

impl Material {
    /// The BSDF in the lanes of a path, whose lane `hero` decides where wavelengths part.
    #[inline]
    pub fn bsdf(&self, at: &TexturePoint, wavelengths: &Wavelengths, hero: usize) -> Bsdf<'_> {
        match self {
            Self::Diffuse { reflectance, sides } => {
                Bsdf::Diffuse(Diffuse { reflectance: share(reflectance, at, wavelengths), sides: *sides })
            }
            Self::Conductor { metal, alpha, tint, sides } => {
                let [x, y] = alpha.at(at);
                let [eta, k] = metal.index(at, wavelengths);
                let bsdf = Bsdf::conductor(eta, k, x, y);
                alpha.shape(bsdf).tinted(tint.eval(at, wavelengths), Lanes::ONE).on(*sides)
            }
            Self::Dielectric { eta, .. } => self.bsdf_between(eta.at(wavelengths, hero), at, wavelengths),
            Self::ThinDielectric { eta, reflection_tint, transmission_tint } => {
                Bsdf::thin_dielectric(eta.lanes(wavelengths))
                    .tinted(reflection_tint.eval(at, wavelengths), transmission_tint.eval(at, wavelengths))
            }
            Self::DiffuseTransmission { reflectance, transmittance, scale } => {
                let scaled = |s: &Texture| s.eval(at, wavelengths).map(|v| (v * scale).clamp(0.0, 1.0));
                Bsdf::diffuse_transmission(scaled(reflectance), scaled(transmittance))
            }
            Self::Plastic { eta, internal, reflectance, nonlinear, tint, sides } => {
                Bsdf::Plastic(Plastic::new(*eta, *internal, share(reflectance, at, wavelengths), *nonlinear))
                    .tinted(tint.eval(at, wavelengths), Lanes::ONE)
                    .on(*sides)
            }
            Self::RoughPlastic { coat, reflectance, nonlinear, tint, sides } => {
                Bsdf::RoughPlastic(RoughPlastic::new(coat, share(reflectance, at, wavelengths), *nonlinear))
                    .tinted(tint.eval(at, wavelengths), Lanes::ONE)
                    .on(*sides)
            }
            Self::Principled(textures) => textures.bsdf(at, wavelengths),
            Self::PrincipledThin(textures) => textures.bsdf(at, wavelengths),
            Self::Coated(coated) => coated.bsdf(at, wavelengths, hero),
            Self::Hair(textures) => textures.bsdf(at, wavelengths),
            Self::Measured { tables, sides } => Bsdf::Measured(Measured::new(tables, wavelengths)).on(*sides),
            // What is made of others has none of its own: see [`crate::scene::Scene::meet`].
            Self::Null | Self::Hole | Self::Mix { .. } | Self::TwoFaced { .. } | Self::Embossed { .. } => Bsdf::Null,
        }
    }

    /// The BSDF of the boundary between two bodies, `eta` the index inside over that outside: with the roughness and the
    /// tints of a dielectric, or smooth and clear.
    #[inline]
    pub fn bsdf_between(&self, eta: f32, at: &TexturePoint, wavelengths: &Wavelengths) -> Bsdf<'_> {
        let Self::Dielectric { alpha, reflection_tint, transmission_tint, .. } = self else {
            return Bsdf::dielectric(eta, 0.0, 0.0);
        };
        let [x, y] = alpha.at(at);
        alpha
            .shape(Bsdf::dielectric(eta, x, y))
            .tinted(reflection_tint.eval(at, wavelengths), transmission_tint.eval(at, wavelengths))
    }

    /// The index of a dielectric.
    pub fn index(&self) -> Option<&Index> {
        match self {
            Self::Dielectric { eta, .. } => Some(eta),
            _ => None,
        }
    }

    /// The index of a clear and smooth dielectric, if this is one, the same everywhere and at every wavelength \[1\].
    pub fn polished(&self) -> Option<f32> {
        let Self::Dielectric { eta: Index::Constant(eta), alpha, reflection_tint, transmission_tint } = self else {
            return None;
        };
        let number = |texture: &Texture| match texture.constant() {
            Some(Spectrum::Constant(value)) => Some(*value),
            _ => None,
        };
        let smooth = [&alpha.u, &alpha.v].map(|a| number(a).is_some_and(|a| a <= 0.0));
        let clear = [reflection_tint, transmission_tint].map(|tint| number(tint) == Some(1.0));
        (smooth == [true; 2] && clear == [true; 2]).then_some(*eta)
    }

    /// Whether wavelengths part here, so that a path can go on with one only.
    #[inline]
    pub fn disperses(&self) -> bool {
        match self {
            Self::Dielectric { eta, .. } => eta.disperses(),
            Self::Coated(coated) => coated.eta.disperses(),
            _ => false,
        }
    }
}

/// What a texture reflects, held in 0 to 1: textures that are scaled can have more.
#[inline]
fn share(texture: &Texture, at: &TexturePoint, wavelengths: &Wavelengths) -> Lanes {
    texture.eval(at, wavelengths).clamp(0.0, 1.0)
}

impl Index {
    /// Whether wavelengths differ.
    #[inline]
    pub fn disperses(&self) -> bool {
        matches!(self, Self::Glass(_) | Self::Table(_))
    }

    /// Its value [1] at the wavelength of a lane.
    #[inline]
    pub fn at(&self, wavelengths: &Wavelengths, hero: usize) -> f32 {
        match self {
            Self::Constant(eta) => *eta,
            Self::Glass(glass) => glass.eta(wavelengths.hero(hero)),
            Self::Table(table) => match table.at(wavelengths.hero(hero)) {
                0.0 => 1.0,
                eta => eta,
            },
        }
    }

    /// The index in every lane, where nothing bends and wavelengths go on together.
    #[inline]
    fn lanes(&self, wavelengths: &Wavelengths) -> Lanes {
        Lanes::new(std::array::from_fn(|lane| self.at(wavelengths, lane)))
    }
}
