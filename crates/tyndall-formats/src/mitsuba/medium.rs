//! `<medium type="homogeneous">` and `<phase>`.

use super::object::Measure;
use super::scene::Builder;
use super::tree::Element;
use super::words;
use crate::desc::{Coefficients, MediumDesc, PhaseDesc};
use crate::source::Spanned;

impl<'t> Builder<'t> {
    pub(super) fn medium(&mut self, element: &'t Element) -> Option<MediumDesc> {
        words::plugin(element, &mut self.report)?;
        let mut object = self.object(element);
        let phase = object.only("phase", &mut self.report).and_then(|phase| self.phase(phase.element));
        let phase = phase.unwrap_or(PhaseDesc::Isotropic);
        let report = &mut self.report;
        let coefficients = Coefficients::ExtinctionAlbedo {
            sigma_t: object.volume("sigma_t", Measure::Amount, 1.0, report),
            albedo: object.volume("albedo", Measure::Part, 0.75, report),
        };
        let scale = object.float("scale", |scale| scale >= 0.0, "at least 0", report);
        object.ignore(&["sample_emitters"], "lights are sampled wherever that helps", report);
        object.ignore(&["has_spectral_extinction"], "whether extinction has a colour is seen from its values", report);
        object.finish(report);
        Some(MediumDesc {
            span: element.span,
            name: element.attribute("id").map(|id| id.value.clone()),
            coefficients,
            scale: scale.unwrap_or(Spanned::new(1.0, element.span)),
            phase,
            emission: None,
        })
    }

    fn phase(&mut self, element: &'t Element) -> Option<PhaseDesc> {
        let plugin = words::plugin(element, &mut self.report)?;
        let mut object = self.object(element);
        let phase = match plugin {
            "hg" => {
                let g = object.float("g", |g| g > -1.0 && g < 1.0, "greater than -1 and less than 1", &mut self.report);
                // Mitsuba's default.
                PhaseDesc::HenyeyGreenstein { g: g.unwrap_or(Spanned::new(0.8, element.span)) }
            }
            "rayleigh" => PhaseDesc::Rayleigh,
            _ => PhaseDesc::Isotropic,
        };
        object.finish(&mut self.report);
        Some(phase)
    }
}
