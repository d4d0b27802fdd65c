//! `<rgb>`, `<spectrum>`, and numbers where a spectrum is asked for.
//!
//! | written | is |
//! |---|---|
//! | `<spectrum value="0.5"/>` | the same at every wavelength; as light, equal energy and not white |
//! | `<spectrum value="400:0.1, 700:0.3"/>` | linear between, nothing outside |
//! | `<spectrum filename="gold.spd"/>` | the same, from a file of pairs |
//! | `<spectrum type="blackbody">` | Planck's law in W·m⁻²·sr⁻¹·nm⁻¹ at `temperature` \[K\], light only |
//! | `<spectrum type="d65">` | white light: `scale` times `color` |
//! | `<spectrum type="regular">`, `"irregular"` | `values` apart evenly, or at `wavelengths` |
//! | `<spectrum type="srgb">` | `color`, as `<rgb>` |

use super::number::{list, number, one_or_three};
use super::object::{Ids, Measure, Object, Report, must_be};
use super::tree::Element;
use crate::desc::{EmissionDesc, Magnitude, SpectrumDesc};
use crate::error::SceneError;
use crate::source::{Span, Spanned};

/// The spectra with a `type` that are known.
const TYPES: [&str; 5] = ["blackbody", "d65", "irregular", "regular", "srgb"];

impl<'t> Object<'t> {
    /// A spectrum, if it is given.
    pub(super) fn spectrum(
        &mut self,
        name: &'static str,
        measure: Measure,
        report: &mut Report,
    ) -> Option<Spanned<SpectrumDesc>> {
        let element = self.parameter(name, &["rgb", "float", "integer", "spectrum"], report)?;
        self.spectrum_of(element, name, measure, report)
    }

    /// A spectrum that may stand inside of a `<volume type="constvolume">`, or a constant one.
    pub(super) fn volume(
        &mut self,
        name: &'static str,
        measure: Measure,
        default: f64,
        report: &mut Report,
    ) -> Spanned<SpectrumDesc> {
        let default = Spanned::new(SpectrumDesc::Constant(default), self.element.span);
        let Some(element) = self.parameter(name, &["rgb", "float", "integer", "spectrum", "volume"], report) else {
            return default;
        };
        let found = if element.tag == "volume" {
            super::words::plugin(element, report).and_then(|_| {
                let mut volume = Object::new(element, &Ids::new(), self.files, report);
                let value = volume.spectrum("value", measure, report);
                volume.ignore(&["to_world"], "it is the same everywhere", report);
                volume.finish(report);
                value
            })
        } else {
            self.spectrum_of(element, name, measure, report)
        };
        found.unwrap_or(default)
    }

    /// Light; white of radiance 1 if the file says nothing.
    pub(super) fn light(&mut self, name: &'static str, report: &mut Report) -> EmissionDesc {
        let white = Spanned::new(SpectrumDesc::Rgb([1.0; 3]), self.element.span);
        let spectrum = self.spectrum(name, Measure::Light, report).unwrap_or(white);
        EmissionDesc { spectrum, scale: 1.0, magnitude: Magnitude::AsWritten }
    }

    fn spectrum_of(
        &mut self,
        element: &'t Element,
        name: &str,
        measure: Measure,
        report: &mut Report,
    ) -> Option<Spanned<SpectrumDesc>> {
        let (text, span) = (element.text("value"), element.span_of("value"));
        let spectrum = match element.tag {
            "rgb" => one_or_three(text, span).map(SpectrumDesc::Rgb),
            "spectrum" => return self.spectrum_element(element, name, measure, report),
            _ => number(text, span)
                .map(|v| if measure == Measure::Light { SpectrumDesc::Rgb([v; 3]) } else { SpectrumDesc::Constant(v) }),
        };
        let spectrum = spectrum.and_then(|spectrum| checked(spectrum, name, measure, text, span));
        Some(Spanned::new(report.errors.ok(spectrum)?, span))
    }

    /// A `<spectrum>`: by `value`, by `filename`, or by `type`.
    fn spectrum_element(
        &mut self,
        element: &'t Element,
        name: &str,
        measure: Measure,
        report: &mut Report,
    ) -> Option<Spanned<SpectrumDesc>> {
        match (element.attribute("value"), element.attribute("filename"), element.attribute("type")) {
            (Some(value), None, None) => {
                let spectrum = pairs(&value.value, value.span, measure)
                    .and_then(|spectrum| checked(spectrum, name, measure, &value.value, value.span));
                Some(Spanned::new(report.errors.ok(spectrum)?, value.span))
            }
            (None, Some(file), None) => {
                let path = self.files.resolve(Spanned::new(&file.value, file.span));
                Some(path.map(SpectrumDesc::File))
            }
            (None, None, Some(kind)) => {
                let mut object = Object::new(element, &Ids::new(), self.files, report);
                let found = typed(&mut object, &kind.value, name, measure, report);
                object.finish(report);
                Some(Spanned::new(found?, element.span))
            }
            _ => {
                let error =
                    SceneError::at(element.span, "a <spectrum> has one of \"value\", \"filename\" and \"type\"");
                report.errors.push(error);
                None
            }
        }
    }
}

/// A spectrum with parameters of its own.
fn typed(object: &mut Object, kind: &str, name: &str, measure: Measure, report: &mut Report) -> Option<SpectrumDesc> {
    let span = object.element.span_of("type");
    match kind {
        "blackbody" if measure == Measure::Light => {
            object.not_yet(&["wavelength_min", "wavelength_max"], report);
            let Some(kelvin) = object.float("temperature", |t| t > 0.0, "greater than 0", report) else {
                report.errors.push(SceneError::at(span, "a black body needs a \"temperature\" in kelvin"));
                return None;
            };
            Some(SpectrumDesc::Blackbody { kelvin: kelvin.value })
        }
        "d65" if measure == Measure::Light => {
            let scale = object.float("scale", |s| s >= 0.0, "at least 0", report).map_or(1.0, |s| s.value);
            let colour = object.spectrum("color", Measure::Light, report).map(|c| c.value);
            if let SpectrumDesc::Rgb(rgb) = colour.unwrap_or(SpectrumDesc::Rgb([1.0; 3])) {
                return Some(SpectrumDesc::Rgb(rgb.map(|c| c * scale)));
            }
            report.errors.push(SceneError::at(span, "the colour of \"d65\" is an <rgb>"));
            None
        }
        "srgb" => Some(object.spectrum("color", measure, report)?.value),
        "regular" | "irregular" => {
            let values = object.string("values", report).and_then(|v| report.errors.ok(list(v.value, v.span)))?;
            let lambda = if kind == "irregular" {
                object.string("wavelengths", report).and_then(|v| report.errors.ok(list(v.value, v.span)))?
            } else {
                let least = object.float("wavelength_min", |l| l > 0.0, "greater than 0", report)?.value;
                let most = object.float("wavelength_max", |l| l > least, "greater than the least", report)?.value;
                let step = (most - least) / (values.len().max(2) - 1) as f64;
                (0..values.len()).map(|i| least + i as f64 * step).collect()
            };
            let spectrum = samples(lambda, values, span).and_then(|s| checked(s, name, measure, kind, span));
            report.errors.ok(spectrum)
        }
        "blackbody" | "d65" => {
            report
                .errors
                .push(SceneError::at(span, format!("the spectrum \"{kind}\" is a light, and \"{name}\" is not")));
            None
        }
        _ => {
            let error = SceneError::at(span, format!("the spectrum \"{kind}\" is not known"));
            report.errors.push(error.suggest(kind, TYPES));
            None
        }
    }
}

/// `0.5`, or `400:0.1, 700:0.3`.
fn pairs(text: &str, span: Span, measure: Measure) -> Result<SpectrumDesc, SceneError> {
    if !text.contains(':') {
        let v = number(text, span)?;
        // Mitsuba: as light it is equal energy, which is not the white of sRGB.
        let (lambda, values) = (vec![360.0, 830.0], vec![v, v]);
        return Ok(if measure == Measure::Light {
            SpectrumDesc::Samples { lambda, values }
        } else {
            SpectrumDesc::Constant(v)
        });
    }
    let (mut lambda, mut values) = (Vec::new(), Vec::new());
    for word in text.split(|c: char| c == ',' || c.is_whitespace()).filter(|word| !word.is_empty()) {
        let Some((l, v)) = word.split_once(':') else {
            return Err(SceneError::at(span, format!("\"{word}\" is no pair of a wavelength and a value"))
                .help("write wavelength:value, such as \"400:0.1, 700:0.3\""));
        };
        lambda.push(number(l, span)?);
        values.push(number(v, span)?);
    }
    samples(lambda, values, span)
}

fn samples(lambda: Vec<f64>, values: Vec<f64>, span: Span) -> Result<SpectrumDesc, SceneError> {
    let message = if lambda.len() < 2 {
        "a spectrum has at least two pairs"
    } else if lambda.len() != values.len() {
        "there are not as many values as wavelengths"
    } else if lambda[0] <= 0.0 || lambda.windows(2).any(|w| w[0] >= w[1]) {
        "wavelengths in nm are positive and increase"
    } else {
        return Ok(SpectrumDesc::Samples { lambda, values });
    };
    Err(SceneError::at(span, message))
}

/// The spectrum, if its numbers can be what it measures.
fn checked(
    spectrum: SpectrumDesc,
    name: &str,
    measure: Measure,
    text: &str,
    span: Span,
) -> Result<SpectrumDesc, SceneError> {
    let numbers = match &spectrum {
        SpectrumDesc::Constant(v) => std::slice::from_ref(v),
        SpectrumDesc::Rgb(rgb) => rgb,
        SpectrumDesc::Samples { values, .. } => values,
        _ => &[],
    };
    match measure {
        Measure::Part if numbers.iter().any(|c| !(0.0..=1.0).contains(c)) => {
            Err(must_be(name, "in [0, 1]", text, span))
        }
        _ if numbers.iter().any(|&c| c < 0.0) => Err(must_be(name, "at least 0", text, span)),
        _ => Ok(spectrum),
    }
}
