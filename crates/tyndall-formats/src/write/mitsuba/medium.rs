//! Media.

use super::Pen;
use super::element::Element;
use super::spectrum::colour;
use crate::build::media::{channels, numbers_of, per_unit};
use crate::desc::{Coefficients, MediumDesc, PhaseDesc, SpectrumDesc};
use crate::write::number::{double, shortest};

impl Pen<'_, '_> {
    pub(super) fn medium(&mut self, index: usize, medium: &MediumDesc) -> Element {
        let mut element = Element::plugin("medium", "homogeneous").with("id", &self.media[index]);
        let mut g = None;
        match &medium.coefficients {
            Coefficients::ExtinctionAlbedo { sigma_t, albedo } => {
                for (name, value, default) in [("sigma_t", sigma_t, 1.0), ("albedo", albedo, 0.75)] {
                    if value.value != SpectrumDesc::Constant(default) {
                        element.extend(self.spectrum(name, &value.value, value.span));
                    }
                }
            }
            Coefficients::AbsorptionScattering { sigma_a, sigma_s } => {
                match channels(&sigma_a.value).zip(channels(&sigma_s.value)) {
                    Some((a, s)) => coefficients(&mut element, [a, s]),
                    None => self.lacks(sigma_a.span, "absorption and scattering by wavelength"),
                }
            }
            Coefficients::PerMillimetre { sigma_a, sigma_s } => {
                let unit = self.draft.desc.options.unit.value;
                match per_unit(&sigma_a.value, unit).zip(per_unit(&sigma_s.value, unit)) {
                    Some((a, s)) => coefficients(&mut element, [a, s]),
                    None => self.lacks(sigma_a.span, "absorption and scattering by wavelength"),
                }
            }
            Coefficients::Reflectance { reflectance, .. } => {
                self.lacks(reflectance.span, "a medium by the reflectance of its surface");
            }
            Coefficients::Recipe { name, .. } => self.lacks(name.span, "a medium by its recipe"),
            Coefficients::Preset { name, reduced } => {
                match numbers_of(&name.value, *reduced, self.draft.desc.options.unit.value.millimetres()) {
                    Some(numbers) => {
                        coefficients(&mut element, numbers.sigma.map(|sigma| sigma.map(f64::from)));
                        g = numbers.g;
                    }
                    None => self.lacks(name.span, "a measured medium of this name"),
                }
            }
        }
        element.float_unless("scale", medium.scale.value, 1.0);
        element.extend(match (g, &medium.phase) {
            (Some(g), _) => Some(henyey_greenstein(g)),
            (None, PhaseDesc::Isotropic) => None,
            (None, phase) => Some(phase_function(phase)),
        });
        if let Some(light) = &medium.emission {
            self.lacks(light.spectrum.span, "a medium that emits light");
        }
        element
    }
}

fn phase_function(phase: &PhaseDesc) -> Element {
    match phase {
        PhaseDesc::Isotropic => Element::plugin("phase", "isotropic"),
        PhaseDesc::HenyeyGreenstein { g } => henyey_greenstein(g.value),
        PhaseDesc::Rayleigh => Element::plugin("phase", "rayleigh"),
        PhaseDesc::Tabulated { values } => {
            let values = values.value.iter().map(|v| double(*v)).collect::<Vec<_>>().join(" ");
            Element::plugin("phase", "tabphase").around(Element::parameter("string", "values", &values))
        }
        PhaseDesc::Blend { of, weight } => {
            let [first, second] = &**of;
            let weight = Element::parameter("float", "weight", &double(weight.value));
            let element = Element::plugin("phase", "blendphase").around(weight);
            element.around(phase_function(first)).around(phase_function(second))
        }
    }
}

fn henyey_greenstein(g: f64) -> Element {
    Element::plugin("phase", "hg").around(Element::parameter("float", "g", &double(g)))
}

/// Extinction and albedo whose parts are these in single precision, with as few digits as that takes.
fn coefficients(element: &mut Element, [sigma_a, sigma_s]: [[f64; 3]; 2]) {
    let pairs: [_; 3] = std::array::from_fn(|c| extinction_and_albedo(sigma_a[c], sigma_s[c]));
    element.push(colour("sigma_t", pairs.map(|pair| pair[0])));
    element.push(colour("albedo", pairs.map(|pair| pair[1])));
}

fn extinction_and_albedo(a: f64, s: f64) -> [f64; 2] {
    // The same for all that are the same to the renderer.
    let [a, s] = [a, s].map(|v| f64::from(v as f32));
    let sum = a + s;
    if sum <= 0.0 {
        return [0.0, 0.0];
    }
    let is_right = |t: f64, albedo: f64| (t * albedo) as f32 == s as f32 && (t * (1.0 - albedo)) as f32 == a as f32;
    let albedo = s / sum;
    let t = shortest(sum, |t| is_right(t, albedo));
    [t, shortest(albedo, |albedo| (0.0..=1.0).contains(&albedo) && is_right(t, albedo))]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn coefficients_are_as_short_as_they_were() {
        assert_eq!(extinction_and_albedo(0.1, 0.9), [1.0, 0.9]);
        assert_eq!(extinction_and_albedo(0.0, 2.5), [2.5, 1.0]);
        assert_eq!(extinction_and_albedo(2.5, 0.0), [2.5, 0.0]);
        assert_eq!(extinction_and_albedo(0.0, 0.0), [0.0, 0.0]);
    }

    proptest! {
        #[test]
        fn coefficients_keep_their_bits(a in 1e-6f32..1e3, s in 1e-6f32..1e3) {
            let [t, albedo] = extinction_and_albedo(f64::from(a), f64::from(s));
            prop_assert_eq!(((t * (1.0 - albedo)) as f32, (t * albedo) as f32), (a, s));
        }
    }
}
