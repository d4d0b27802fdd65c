//! `MakeNamedMedium`.

use std::borrow::Cow;

use super::Reader;
use super::params::Params;
use super::parser::Statement;
use crate::desc::{Coefficients, MediumDesc, PhaseDesc, SpectrumDesc};
use crate::error::SceneError;
use crate::source::Spanned;
use tyndall_optics::{
    measured::{self, Source},
    recipe::{self, Recipe},
};

const LATER_MEDIA: [&str; 4] = ["cloud", "nanovdb", "rgbgrid", "uniformgrid"];

impl Reader {
    pub(super) fn named_medium(&mut self, mut s: Statement<'_>) {
        let name = s.names[0].clone();
        let defaults = self.state.now.defaults.medium.clone();
        let mut p = self.params("medium", &mut s, &defaults);
        let mut is_known = true;
        let mut mixed = None;
        match p.string_opt("type") {
            Some(kind) if kind.value == "homogeneous" => {}
            Some(kind) => {
                if let Some(recipe) = recipe_named(&kind.value) {
                    mixed = Some(mixture(&mut p, kind, recipe));
                } else {
                    let known: Vec<_> = ["homogeneous"].into_iter().chain(RECIPES).collect();
                    self.unknown_kind("medium", &kind.map(Cow::Owned), &known, &LATER_MEDIA);
                    // Its parameters belong to another kind: a clear medium has its name.
                    p = Params::new(String::new(), name.span, Vec::new(), &[], &self.dir);
                    is_known = false;
                }
            }
            None => p.error(
                SceneError::at(name.span, "a medium needs \"string type\"").help("\"string type\" \"homogeneous\""),
            ),
        }
        let (coefficients, phase) = match mixed {
            Some(mixed) => (mixed, PhaseDesc::Isotropic),
            None => (coefficients(&mut p), phase_or_table(&mut p)),
        };
        let concentration = concentration(&mut p, &coefficients);
        let desc = MediumDesc {
            span: s.whole,
            name: Some(name.value.to_string()),
            coefficients,
            scale: p.not_negative("scale", if is_known { 1.0 } else { 0.0 }).map(|scale| scale * concentration),
            phase,
            emission: p.emission_opt("Le", "Lescale"),
        };
        self.finish_params(p);
        self.checked(|r| r.media.define(&name.value, s.whole, desc).map(drop));
    }
}

/// The recipes that are types of media. A `cloud` is pbrt's own word for something else: droplets are `fog` here.
const RECIPES: [&str; 5] = ["fog", "ink", "milk", "sea", "smoke"];

fn recipe_named(kind: &str) -> Option<&'static Recipe> {
    RECIPES.contains(&kind).then(|| recipe::named(kind)).flatten()
}

/// tyndall's own: a medium by what is in it.
fn mixture(p: &mut Params, name: Spanned<String>, recipe: &'static Recipe) -> Coefficients {
    let value = |parameter: &recipe::Parameter| {
        let [least, most] = parameter.range;
        let range = format!("between {least} and {most}: {}", parameter.about);
        p.float_in(parameter.name, parameter.default, &range, |v| (least..=most).contains(&v)).value
    };
    Coefficients::Recipe { name, values: recipe.parameters.iter().map(value).collect() }
}

/// tyndall's own: how much of a measured medium is in clear water, in [0, 1]. Coefficients are proportional to it, which is how
/// Narasimhan 2006 measured: media by dilution only.
fn concentration(p: &mut Params, coefficients: &Coefficients) -> f64 {
    let by_dilution = match coefficients {
        Coefficients::Preset { name, .. } => {
            measured::named(&name.value).is_none_or(|m| m.source == Source::Narasimhan2006)
        }
        _ => false,
    };
    if p.has("concentration") && !by_dilution {
        p.error(
            SceneError::at(p.span, "only media that were measured by dilution have a \"concentration\"")
                .help("those are the presets of Narasimhan 2006; \"scale\" is a factor on any coefficients"),
        );
    }
    p.float_in("concentration", 1.0, "between 0 and 1", |c| (0.0..=1.0).contains(&c)).value
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
        if !reduced.value && (p.has("g") || p.has("phase")) {
            p.error(
                SceneError::at(reduced.span, "full scattering comes with its own mean cosine")
                    .help("leave out \"g\", or \"bool reduced\" false"),
            );
        }
        return Coefficients::Preset { name: preset, reduced: reduced.value };
    }
    let [sigma_a, sigma_s] = given.map(|s| s.unwrap_or(Spanned::new(SpectrumDesc::Constant(1.0), p.span)));
    Coefficients::AbsorptionScattering { sigma_a, sigma_s }
}

/// tyndall's own: `"float phase"`, relative values at regularly spaced cosines, from straight back to straight on.
fn phase_or_table(p: &mut Params) -> PhaseDesc {
    let has_g = p.has("g");
    let phase = phase(p);
    let Some(values) = p.any_floats("phase") else { return phase };
    if has_g {
        p.error(
            SceneError::at(values.span, "a medium has either a table of its phase function or a mean cosine")
                .help("leave out \"g\""),
        );
    }
    PhaseDesc::Tabulated { values }
}

pub(super) fn phase(p: &mut Params) -> PhaseDesc {
    let g = p.float_in("g", 0.0, "between -1 and 1, both excluded", |g| g.abs() < 1.0);
    if g.value == 0.0 { PhaseDesc::Isotropic } else { PhaseDesc::HenyeyGreenstein { g } }
}
