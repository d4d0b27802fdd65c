//! The material `subsurface`: a dielectric boundary, and the medium inside of every shape that has it.
//!
//! pbrt says the medium in one of four ways, and so do we: a `name`; `sigma_a` and `sigma_s` [1/mm]; `reflectance` and a mean
//! free path `mfp` [mm, by default 1]; or nothing, which means σ_a = (0.0011, 0.0024, 0.014), σ_s = (2.55, 3.21, 3.77)
//! [1/mm]. `scale` is a factor on the coefficients, or on `mfp`.
//!
//! pbrt guesses where light leaves from a diffusion profile. Here the light is followed through the medium, so the albedo for
//! a `reflectance` is that of real transport (`tyndall_optics::half_space`), and the shape must be closed.

use std::collections::HashMap;

use super::Reader;
use super::materials::rough;
use super::params::Params;
use crate::desc::{
    Coefficients, MaterialDesc, MaterialId, MaterialKind, MediumDesc, MediumId, MediumInterface, PhaseDesc, ShapeDesc,
    SpectrumDesc,
};
use crate::error::{ErrorList, SceneError};
use crate::source::{Span, Spanned};

/// Which materials have which medium inside.
#[derive(Debug, Default)]
pub(super) struct Fillings {
    /// Of the material that is being read.
    latest: Option<MediumId>,
    media: HashMap<MaterialId, MediumId>,
}

impl Fillings {
    /// Gives the medium that was read last, if any, to its material.
    pub(super) fn settle(&mut self, material: MaterialId) {
        if let Some(medium) = self.latest.take() {
            self.media.insert(material, medium);
        }
    }

    /// Puts the media inside of the shapes; what is outside stays what `MediumInterface` says.
    pub(super) fn fill<'a>(&self, shapes: impl Iterator<Item = &'a mut ShapeDesc>) {
        for shape in shapes {
            if let Some(&medium) = self.media.get(&shape.material.value) {
                let (span, outside) = shape.interface.map_or((shape.material.span, None), |i| (i.span, i.outside));
                shape.interface = Some(MediumInterface { span, inside: Some(medium), outside });
            }
        }
    }

    /// A mixture has no inside.
    pub(super) fn check_mixtures(&self, materials: &[MaterialDesc], errors: &mut ErrorList) {
        for material in materials {
            if let MaterialKind::Mix { of, .. } = &material.kind
                && let Some(part) = of.iter().find(|part| self.media.contains_key(&part.value))
            {
                errors.push(
                    SceneError::not_yet(part.span, "a mixture with the material \"subsurface\" is not supported yet")
                        .help("use \"subsurface\" alone")
                        .related(material.span, "the mixture"),
                );
            }
        }
    }
}

impl Reader {
    pub(super) fn subsurface(&mut self, span: Span, p: &mut Params) -> MaterialKind {
        let eta = p.positive("eta", 1.33);
        let (coefficients, scale) = coefficients(p, eta.value);
        let phase = match &coefficients {
            Coefficients::Preset { .. } => {
                p.ignore(
                    "g",
                    "measured coefficients are reduced ones, of a medium that scatters in all directions alike",
                );
                PhaseDesc::Isotropic
            }
            _ => super::media::phase(p),
        };
        let medium = MediumDesc { span, name: None, coefficients, scale, phase, emission: None };
        self.fillings.latest = Some(MediumId(self.media.push(span, medium)));
        MaterialKind::Dielectric {
            eta: eta.map(SpectrumDesc::Constant),
            roughness: rough(p, &self.textures),
            reflection_tint: None,
            transmission_tint: None,
        }
    }
}

/// The medium, and the factor on its coefficients.
fn coefficients(p: &mut Params, eta: f64) -> (Coefficients, Spanned<f64>) {
    for word in ["sigma_a", "sigma_s", "reflectance", "mfp"] {
        p.texture_later(word, "light is followed through the medium inside, which is the same everywhere");
    }
    let name = p.string_opt("name");
    let [sigma_a, sigma_s] = [p.spectrum_opt("sigma_a"), p.spectrum_opt("sigma_s")];
    let [reflectance, mfp] = [p.spectrum_opt("reflectance"), p.spectrum_opt("mfp")];
    let given = [
        name.as_ref().map(|n| n.span),
        sigma_a.as_ref().or(sigma_s.as_ref()).map(|s| s.span),
        reflectance.as_ref().or(mfp.as_ref()).map(|s| s.span),
    ];
    if let [first, second, ..] = given.into_iter().flatten().collect::<Vec<_>>()[..] {
        p.error(
            SceneError::at(second, "the medium is given in two ways")
                .help("give one of \"name\", \"sigma_a\" and \"sigma_s\", or \"reflectance\" and \"mfp\"")
                .related(first, "already given here"),
        );
    }
    let lone = match (&sigma_a, &sigma_s, &reflectance, &mfp) {
        (Some(lone), None, ..) => Some((lone.span, "\"sigma_a\" needs \"sigma_s\"")),
        (None, Some(lone), ..) => Some((lone.span, "\"sigma_s\" needs \"sigma_a\"")),
        (.., None, Some(lone)) => Some((lone.span, "\"mfp\" needs \"reflectance\"")),
        _ => None,
    };
    if let Some((span, message)) = lone {
        p.error(SceneError::at(span, message).help("give both of them"));
    }
    if let Some(reflectance) = reflectance {
        let mfp = mfp.unwrap_or(Spanned::new(SpectrumDesc::Constant(1.0), p.span));
        let coefficients = Coefficients::Reflectance { reflectance, mfp, eta };
        return (coefficients, p.positive("scale", 1.0).map(|scale| 1.0 / scale));
    }
    let coefficients = match (name, sigma_a, sigma_s) {
        (Some(name), ..) => Coefficients::Preset { name, reduced: true },
        (None, Some(sigma_a), Some(sigma_s)) => Coefficients::PerMillimetre { sigma_a, sigma_s },
        _ => {
            let rgb = |rgb| Spanned::new(SpectrumDesc::Rgb(rgb), p.span);
            Coefficients::PerMillimetre { sigma_a: rgb([0.0011, 0.0024, 0.014]), sigma_s: rgb([2.55, 3.21, 3.77]) }
        }
    };
    (coefficients, p.not_negative("scale", 1.0))
}
