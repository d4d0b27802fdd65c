//! `<bsdf type="hair">`.

use super::bsdf::relative_index;

use super::object::{Measure, Object};
use super::scene::Builder;
use crate::desc::{HairColourDesc, HairDesc, MaterialKind, SpectrumDesc, Varying};
use crate::error::SceneError;
use crate::source::Spanned;

impl<'t> Builder<'t> {
    pub(super) fn hair(&mut self, object: &mut Object<'t>) -> MaterialKind {
        let at = object.element.span;
        let eta = relative_index(object, "amber", &mut self.report).map(Varying::Everywhere);
        let constant = |value: f64| Spanned::new(Varying::constant(value), at);
        let mut number = |name, default| {
            let found = object.float(name, |v| v >= 0.0, "at least 0", &mut self.report);
            found.map_or_else(|| constant(default), |found| found.map(Varying::constant))
        };
        let (beta_m, beta_n) = (number("longitudinal_roughness", 0.3), number("azimuthal_roughness", 0.3));
        let alpha = object.float("scale_tilt", |_| true, "", &mut self.report);
        let alpha = alpha.map_or_else(|| constant(2.0), |found| found.map(Varying::constant));
        let scale = object.float("scale", |v| v >= 0.0, "at least 0", &mut self.report);
        let pigments =
            ["eumelanin", "pheomelanin"].map(|name| object.float(name, |v| v >= 0.0, "at least 0", &mut self.report));
        let sigma_a = self.varying(object, "sigma_a", Measure::Amount);
        let colour = match sigma_a {
            None => {
                let [brown, red] = pigments;
                let of = |found: Option<Spanned<f64>>, default| {
                    found.map_or_else(|| constant(default), |found| found.map(Varying::constant))
                };
                HairColourDesc::Pigments { eumelanin: of(brown, 1.3), pheomelanin: of(red, 0.2) }
            }
            Some(mut sigma_a) => {
                if let Some(pigment) = pigments.into_iter().flatten().next() {
                    let error = SceneError::at(pigment.span, "hair has either a \"sigma_a\" or pigments");
                    self.report.errors.push(error.related(sigma_a.span, "the \"sigma_a\""));
                }
                let scale_value = scale.map_or(1.0, |scale| scale.value);
                match &mut sigma_a.value {
                    Varying::Everywhere(SpectrumDesc::Constant(v)) => *v *= scale_value,
                    Varying::Everywhere(SpectrumDesc::Rgb(rgb)) => *rgb = rgb.map(|v| v * scale_value),
                    _ => {
                        if let Some(scale) = scale.filter(|scale| scale.value != 1.0) {
                            let error =
                                SceneError::not_yet(scale.span, "only a constant \"sigma_a\" can be scaled yet");
                            self.report.errors.push(error.help("scale its values"));
                        }
                    }
                }
                HairColourDesc::SigmaA(sigma_a)
            }
        };
        MaterialKind::Hair(Box::new(HairDesc { colour, eta, beta_m, beta_n, alpha }))
    }
}
