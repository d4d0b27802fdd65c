//! `MakeNamedMedium`.

use std::borrow::Cow;

use super::Reader;
use super::params::Params;
use super::parser::Statement;
use crate::desc::{Coefficients, MediumDesc, PhaseDesc, SpectrumDesc};
use crate::error::SceneError;

const LATER_MEDIA: [&str; 4] = ["cloud", "nanovdb", "rgbgrid", "uniformgrid"];

impl Reader {
    pub(super) fn named_medium(&mut self, mut s: Statement<'_>) {
        let name = s.names[0].clone();
        let defaults = self.state.now.defaults.medium.clone();
        let mut p = self.params("medium", &mut s, &defaults);
        let mut is_known = true;
        match p.string_opt("type") {
            Some(kind) if kind.value != "homogeneous" => {
                self.unknown_kind("medium", &kind.map(Cow::Owned), &["homogeneous"], &LATER_MEDIA);
                // Its parameters belong to another kind: a clear medium has its name.
                p = Params::new(String::new(), name.span, Vec::new(), &[], &self.dir);
                is_known = false;
            }
            Some(_) => {}
            None => p.error(
                SceneError::at(name.span, "a medium needs \"string type\"").help("\"string type\" \"homogeneous\""),
            ),
        }
        let desc = MediumDesc {
            span: s.whole,
            name: Some(name.value.to_string()),
            coefficients: coefficients(&mut p),
            scale: p.not_negative("scale", if is_known { 1.0 } else { 0.0 }),
            phase: phase(&mut p),
            emission: p.emission_opt("Le", "Lescale"),
        };
        self.finish_params(p);
        self.checked(|r| r.media.define(&name.value, s.whole, desc).map(drop));
    }
}

fn coefficients(p: &mut Params) -> Coefficients {
    let preset = p.string_opt("preset");
    // tyndall's own: pbrt has the reduced coefficients only.
    let reduced = p.boolean("reduced", true);
    let given = [p.spectrum_opt("sigma_a"), p.spectrum_opt("sigma_s")];
    if let Some(preset) = preset {
        for sigma in given.into_iter().flatten() {
            p.error(
                SceneError::at(sigma.span, "a medium has either a preset or coefficients")
                    .help("leave out one of them; \"scale\" is a factor on either")
                    .related(preset.span, "the preset"),
            );
        }
        if !reduced.value && p.has("g") {
            p.error(
                SceneError::at(reduced.span, "full scattering comes with its own mean cosine")
                    .help("leave out \"g\", or \"bool reduced\" false"),
            );
        }
        return Coefficients::Preset { name: preset, reduced: reduced.value };
    }
    let [sigma_a, sigma_s] =
        given.map(|s| s.unwrap_or(crate::source::Spanned::new(SpectrumDesc::Constant(1.0), p.span)));
    Coefficients::AbsorptionScattering { sigma_a, sigma_s }
}

pub(super) fn phase(p: &mut Params) -> PhaseDesc {
    let g = p.float_in("g", 0.0, "between -1 and 1, both excluded", |g| g.abs() < 1.0);
    if g.value == 0.0 { PhaseDesc::Isotropic } else { PhaseDesc::HenyeyGreenstein { g } }
}
