//! `<medium type="homogeneous">` and `<phase>`.

use super::number::list;
use super::object::{Measure, Object};
use super::scene::Builder;
use super::tree::Element;
use super::words;
use crate::desc::{Coefficients, MediumDesc, PhaseDesc, SpectrumDesc};
use crate::error::SceneError;
use crate::source::Spanned;

/// The deepest nesting of phase functions in phase functions.
const MAX_DEPTH: u32 = 5;

impl<'t> Builder<'t> {
    pub(super) fn medium(&mut self, element: &'t Element) -> Option<MediumDesc> {
        words::plugin(element, &mut self.report)?;
        let mut object = self.object(element);
        let phase = object.only("phase", &mut self.report).and_then(|phase| self.phase(phase.element, 0));
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
            name: element.id(),
            coefficients,
            scale: scale.unwrap_or(Spanned::new(1.0, element.span)),
            phase,
            emission: None,
        })
    }

    fn phase(&mut self, element: &'t Element, depth: u32) -> Option<PhaseDesc> {
        let plugin = words::plugin(element, &mut self.report)?;
        let mut object = self.object(element);
        let phase = match plugin {
            "hg" => {
                let g = object.float("g", |g| g > -1.0 && g < 1.0, "greater than -1 and less than 1", &mut self.report);
                // Mitsuba's default.
                PhaseDesc::HenyeyGreenstein { g: g.unwrap_or(Spanned::new(0.8, element.span)) }
            }
            "rayleigh" => PhaseDesc::Rayleigh,
            "tabphase" => self.table(&mut object)?,
            "blendphase" => self.blend(&mut object, depth)?,
            _ => PhaseDesc::Isotropic,
        };
        object.finish(&mut self.report);
        Some(phase)
    }

    fn table(&mut self, object: &mut Object<'t>) -> Option<PhaseDesc> {
        let Some(text) = object.string("values", &mut self.report) else {
            let error = SceneError::at(object.element.span, "\"tabphase\" lacks its \"values\"");
            self.report.errors.push(error.help("from straight back to straight on, at regular cosines"));
            return None;
        };
        let values = self.report.errors.ok(list(text.value, text.span))?;
        Some(PhaseDesc::Tabulated { values: Spanned::new(values, text.span) })
    }

    fn blend(&mut self, object: &mut Object<'t>, depth: u32) -> Option<PhaseDesc> {
        let span = object.element.span;
        let parts = object.nested("phase");
        let given = object.has("weight");
        let weight = object.volume("weight", Measure::Part, 0.5, &mut self.report);
        let error = match (&parts[..], &weight.value) {
            _ if depth == MAX_DEPTH => {
                SceneError::at(span, format!("phase functions are blended more than {MAX_DEPTH} deep"))
            }
            _ if !given => SceneError::at(span, "\"blendphase\" lacks a \"weight\"")
                .help("0 is the first phase function alone, 1 the second"),
            ([first, second], SpectrumDesc::Constant(share)) => {
                let [first, second] = [first, second].map(|part| self.phase(part.element, depth + 1));
                let weight = Spanned::new(*share, weight.span);
                return Some(PhaseDesc::Blend { of: Box::new([first?, second?]), weight });
            }
            ([_, _], _) => SceneError::at(weight.span, "the weight of a \"blendphase\" is one number"),
            _ => SceneError::at(span, format!("\"blendphase\" is made of 2 <phase>, not of {}", parts.len())),
        };
        self.report.errors.push(error);
        None
    }
}
