//! Spectra, and what may be a texture.

use super::Pen;
use super::element::Element;
use crate::build::spectra::{named_samples, table_luminance};
use crate::desc::{EmissionDesc, Magnitude, Span, Spanned, SpectrumDesc, TextureKind, Varying};
use crate::mitsuba::Answer;
use crate::write::number::{as_single, double};

impl Pen<'_, '_> {
    /// A spectrum that is no light, if there is a word for it.
    pub(super) fn spectrum(&mut self, name: &str, spectrum: &SpectrumDesc, span: Span) -> Option<Element> {
        let what = match spectrum {
            SpectrumDesc::Constant(v) => return Some(Element::parameter("float", name, &double(*v))),
            SpectrumDesc::Rgb(rgb) => return Some(colour(name, *rgb)),
            SpectrumDesc::Samples { lambda, values } if lambda.len() > 1 => return Some(samples(name, lambda, values)),
            SpectrumDesc::Samples { .. } => "a spectrum of one wavelength",
            SpectrumDesc::File(path) => {
                let file = self.draft.relative(path, span);
                return Some(Element::new("spectrum").with("name", name).with("filename", &file));
            }
            SpectrumDesc::Named(_) => "a spectrum by this name",
            SpectrumDesc::Blackbody { .. } => "a black body that filters light",
        };
        self.lacks(span, what);
        None
    }

    /// A number, a colour, or a texture, where a colour is asked for.
    pub(super) fn varying(&mut self, name: &str, value: &Spanned<Varying>) -> Option<Element> {
        self.answering(name, value, Answer::Colour)
    }

    /// The same where one number is asked for.
    pub(super) fn varying_number(&mut self, name: &str, value: &Spanned<Varying>) -> Option<Element> {
        self.answering(name, value, Answer::Number)
    }

    /// The same for what is asked for.
    pub(super) fn answering(&mut self, name: &str, value: &Spanned<Varying>, answer: Answer) -> Option<Element> {
        match &value.value {
            Varying::Everywhere(spectrum) => self.spectrum(name, spectrum, value.span),
            Varying::Texture(id) => {
                // A texture that is the same everywhere is its value.
                if let Some(TextureKind::Plain(inner)) = self.draft.desc.texture(*id).map(|t| &t.kind) {
                    return self.answering(name, inner, answer);
                }
                self.texture(name, *id, answer)
            }
        }
    }

    /// As [`Self::varying`], unless it is the number that Mitsuba takes anyway.
    pub(super) fn varying_unless(&mut self, element: &mut Element, name: &str, value: &Spanned<Varying>, default: f64) {
        if value.value.number() != Some(default) {
            element.extend(self.varying(name, value));
        }
    }

    /// As [`Self::varying_number`], unless it is the number that Mitsuba takes anyway.
    pub(super) fn number_unless(&mut self, element: &mut Element, name: &str, value: &Spanned<Varying>, default: f64) {
        if value.value.number() != Some(default) {
            element.extend(self.varying_number(name, value));
        }
    }

    /// Light: the factor is in the numbers, as Mitsuba has none.
    pub(super) fn light_spectrum(&mut self, name: &str, light: &EmissionDesc) -> Option<Element> {
        let span = light.spectrum.span;
        let relative = light.magnitude == Magnitude::UnitLuminance;
        match &light.spectrum.value {
            SpectrumDesc::Constant(v) => Some(scaled_colour(name, [*v; 3], light.scale)),
            SpectrumDesc::Rgb(rgb) => Some(scaled_colour(name, *rgb, light.scale)),
            SpectrumDesc::Named(word) if word == "stdillum-D65" => Some(scaled_colour(name, [1.0; 3], light.scale)),
            SpectrumDesc::Blackbody { kelvin } => Some(self.black_body(name, *kelvin, light, span)),
            SpectrumDesc::File(path) if !relative && light.scale == 1.0 => {
                let file = self.draft.relative(path, span);
                Some(Element::new("spectrum").with("name", name).with("filename", &file))
            }
            SpectrumDesc::File(_) => {
                self.lacks(span, "a spectrum of light from a file, times a factor");
                None
            }
            SpectrumDesc::Named(word) => {
                if let Some((lambda, values)) = named_samples(word) {
                    return self.table(name, &lambda, &values, true, light);
                }
                self.lacks(span, "a spectrum by this name");
                None
            }
            SpectrumDesc::Samples { lambda, values } => self.table(name, lambda, values, relative, light),
        }
    }

    /// Mitsuba's black bodies are as bright as they are.
    fn black_body(&mut self, name: &str, kelvin: f64, light: &EmissionDesc, span: Span) -> Element {
        let own = tyndall::spectrum::blackbody::luminance(kelvin);
        let wanted = if light.magnitude == Magnitude::UnitLuminance { light.scale } else { own * light.scale };
        if wanted as f32 == own as f32 {
            let temperature = Element::parameter("float", "temperature", &double(kelvin));
            return Element::plugin("spectrum", "blackbody").with("name", name).around(temperature);
        }
        let message = "Mitsuba's black bodies cannot be scaled: this one is written as its colour";
        self.draft.differs(span, message);
        let rgb = tyndall::spectrum::Spectrum::blackbody(kelvin as f32).scaled(wanted as f32).rgb();
        colour(name, rgb.map(f64::from))
    }

    /// Values times what makes them as bright as is meant.
    fn table(
        &mut self,
        name: &str,
        lambda: &[f64],
        values: &[f64],
        relative: bool,
        light: &EmissionDesc,
    ) -> Option<Element> {
        if lambda.len() < 2 {
            self.lacks(light.spectrum.span, "a spectrum of one wavelength");
            return None;
        }
        let luminance = table_luminance(&light.spectrum.value).map_or(0.0, f64::from);
        let factor = if relative && luminance > 0.0 { light.scale / luminance } else { light.scale };
        let values: Vec<_> = values.iter().map(|v| v * factor).collect();
        Some(samples(name, lambda, &values))
    }
}

/// A colour; a grey one is one number.
pub(super) fn colour(name: &str, rgb: [f64; 3]) -> Element {
    let [r, g, b] = rgb;
    let element = Element::new("rgb").with("name", name);
    if r == g && g == b { element.number("value", r) } else { element.numbers("value", &rgb) }
}

fn samples(name: &str, lambda: &[f64], values: &[f64]) -> Element {
    let pairs: Vec<_> = lambda.iter().zip(values).map(|(l, v)| format!("{}:{}", double(*l), double(*v))).collect();
    Element::new("spectrum").with("name", name).with("value", &pairs.join(", "))
}

/// A colour times a factor.
fn scaled_colour(name: &str, rgb: [f64; 3], scale: f64) -> Element {
    // The renderer multiplies in single precision.
    let product = |v: f64| as_single(f64::from(v as f32 * scale as f32));
    colour(name, if scale == 1.0 { rgb } else { rgb.map(product) })
}
