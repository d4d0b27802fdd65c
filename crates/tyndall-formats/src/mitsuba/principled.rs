//! `<bsdf type="principled">` and `<bsdf type="principledthin">`.

use super::number::number;
use super::object::{Measure, Object, Report};
use super::scene::Builder;
use super::tree::Element;
use crate::desc::{BurleyDesc, MaterialKind, PrincipledDesc, PrincipledThinDesc, Varying};
use crate::error::SceneError;
use crate::source::Spanned;

/// Where light passes the index is not 1, for it must bend: closer than this, it is one more by this (as in Mitsuba).
const LEAST_STEP: f64 = 1e-3;

impl<'t> Builder<'t> {
    pub(super) fn principled(&mut self, object: &mut Object<'t>) -> MaterialKind {
        MaterialKind::Principled(Box::new(PrincipledDesc {
            burley: self.burley(object),
            metallic: self.part_or(object, "metallic", 0.0),
            clearcoat: self.part_or(object, "clearcoat", 0.0),
            clearcoat_gloss: self.part_or(object, "clearcoat_gloss", 0.0),
            eta: index(object, &mut self.report),
            rates: [
                rate(object, "diffuse_reflectance_sampling_rate", &mut self.report),
                rate(object, "main_specular_sampling_rate", &mut self.report),
                rate(object, "clearcoat_sampling_rate", &mut self.report),
            ],
        }))
    }

    pub(super) fn principled_thin(&mut self, object: &mut Object<'t>) -> MaterialKind {
        MaterialKind::PrincipledThin(Box::new(PrincipledThinDesc {
            burley: self.burley(object),
            eta: self.number_or(object, "eta", Measure::Amount, 1.5),
            diff_trans: self.number_or(object, "diff_trans", Measure::Amount, 0.0),
            rates: [
                [
                    rate(object, "diffuse_reflectance_sampling_rate", &mut self.report),
                    rate(object, "specular_reflectance_sampling_rate", &mut self.report),
                ],
                [
                    rate(object, "diffuse_transmittance_sampling_rate", &mut self.report),
                    rate(object, "specular_transmittance_sampling_rate", &mut self.report),
                ],
            ],
        }))
    }

    fn burley(&mut self, object: &mut Object<'t>) -> BurleyDesc {
        BurleyDesc {
            base_color: self.varying_or(object, "base_color", Measure::Part, 0.5),
            roughness: self.part_or(object, "roughness", 0.5),
            anisotropic: self.part_or(object, "anisotropic", 0.0),
            spec_trans: self.part_or(object, "spec_trans", 0.0),
            spec_tint: self.part_or(object, "spec_tint", 0.0),
            sheen: self.part_or(object, "sheen", 0.0),
            sheen_tint: self.part_or(object, "sheen_tint", 0.0),
            flatness: self.part_or(object, "flatness", 0.0),
        }
    }

    fn part_or(&mut self, object: &mut Object<'t>, name: &'static str, default: f64) -> Spanned<Varying> {
        self.number_or(object, name, Measure::Part, default)
    }
}

/// Whether a `principled` has glass in it: whether `spec_trans` is anything but 0.
pub(super) fn is_clear(element: &Element) -> bool {
    let given = element.children.iter().find(|child| child.attribute("name").is_some_and(|n| n.value == "spec_trans"));
    given.is_some_and(|given| number(given.text("value"), given.span).ok() != Some(0.0))
}

/// `eta`, or what `specular` says about it: `r₀ = 0.08 specular` at normal incidence.
fn index(object: &mut Object, report: &mut Report) -> f64 {
    let eta = object.float("eta", |eta| eta > 0.0, "greater than 0", report);
    let specular = object.float("specular", |s| (0.0..=1.0).contains(&s), "in [0, 1]", report);
    if let (Some(eta), Some(specular)) = (&eta, &specular) {
        let error = SceneError::at(specular.span, "\"specular\" and \"eta\" say the same: give one of them");
        report.errors.push(error.related(eta.span, "the other"));
    }
    let eta =
        eta.map_or_else(|| 2.0 / (1.0 - (0.08 * specular.map_or(0.5, |s| s.value)).sqrt()) - 1.0, |eta| eta.value);
    if is_clear(object.element) && (eta - 1.0).abs() < LEAST_STEP { 1.0 + LEAST_STEP } else { eta }
}

fn rate(object: &mut Object, name: &'static str, report: &mut Report) -> f64 {
    object.float(name, |rate| rate >= 0.0, "at least 0", report).map_or(1.0, |rate| rate.value)
}
