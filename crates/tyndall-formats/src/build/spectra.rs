//! Spectra: numbers, colours, black bodies, samples, names and files, each by what it measures.

use std::{fs::File, io::Read, path::Path};

use tyndall::spectrum::{Blackbody, Role, Sampled, Spectrum, blackbody, glass::Glass};
use tyndall_optics::spectra;

use super::Builder;
use crate::{
    desc::{EmissionDesc, Magnitude, SpectrumDesc},
    error::SceneError,
    source::{Span, Spanned},
};

/// The longest spectrum file that is read \[bytes\].
const MAX_SPECTRUM_BYTES: u64 = 1 << 22;

/// What a spectrum measures, which says what an RGB triple becomes.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Measure {
    /// A share of light, 0 to 1.
    Share,
    /// A coefficient, at least 0.
    Coefficient,
    /// Any number: a height, a mean cosine.
    Number,
    /// An index of refraction, at least 0. In `rgb` mode those that are known by name are seen under equal energy, and those
    /// that are written down under D65, both as in Mitsuba.
    Index,
}

/// Values at wavelengths [nm].
struct Table {
    lambda: Vec<f32>,
    values: Vec<f32>,
}

impl Builder<'_> {
    /// A reflectance, a coefficient, an index.
    pub(super) fn spectrum(&mut self, desc: &Spanned<SpectrumDesc>, measure: Measure) -> Option<Spectrum> {
        let span = desc.span;
        match &desc.value {
            SpectrumDesc::Constant(v) => {
                self.check(&[*v], measure, span)?;
                Some(Spectrum::constant(*v as f32))
            }
            SpectrumDesc::Rgb(rgb) => {
                self.check(rgb, measure, span)?;
                let rgb = rgb.map(|v| v as f32);
                Some(if measure == Measure::Share { Spectrum::albedo_rgb(rgb) } else { Spectrum::unbounded_rgb(rgb) })
            }
            // A black body as a filter is its shape, 1 where it is brightest (as in pbrt).
            SpectrumDesc::Blackbody { kelvin } => Some(filter_of(*kelvin)),
            other => {
                let table = self.table(other, span)?;
                let values: Vec<_> = table.values.iter().map(|v| f64::from(*v)).collect();
                self.check(&values, measure, span)?;
                let is_known = matches!(other, SpectrumDesc::Named(_));
                let role = if measure == Measure::Index && is_known { Role::Illuminant } else { Role::Reflectance };
                self.sampled(&table, role, span).map(Spectrum::Sampled)
            }
        }
    }

    /// Light: radiance, intensity, irradiance.
    pub(super) fn emission(&mut self, desc: &EmissionDesc) -> Option<Spectrum> {
        let span = desc.spectrum.span;
        if !desc.scale.is_finite() || desc.scale < 0.0 {
            return self.fail(SceneError::at(span, format!("light cannot be scaled by {}", desc.scale)));
        }
        let unit_luminance = desc.magnitude == Magnitude::UnitLuminance;
        let spectrum = match &desc.spectrum.value {
            // A flat spectrum of light is white by definition of the film: (v, v, v).
            SpectrumDesc::Constant(v) => {
                self.check(&[*v], Measure::Coefficient, span)?;
                Spectrum::illuminant_rgb([*v as f32; 3])
            }
            SpectrumDesc::Rgb(rgb) => {
                self.check(rgb, Measure::Coefficient, span)?;
                Spectrum::illuminant_rgb(rgb.map(|v| v as f32))
            }
            SpectrumDesc::Blackbody { kelvin } => {
                let size = if unit_luminance { 1.0 } else { blackbody::luminance(*kelvin) };
                Spectrum::blackbody(*kelvin as f32).scaled(size as f32)
            }
            // D65 is the light that colours are seen under: it is at hand in full.
            SpectrumDesc::Named(name) if name == "stdillum-D65" => Spectrum::illuminant_rgb([1.0; 3]),
            other => {
                let table = self.table(other, span)?;
                let mut sampled = Spectrum::Sampled(self.sampled(&table, Role::Illuminant, span)?);
                let luminance = sampled.luminance();
                let relative = unit_luminance || matches!(other, SpectrumDesc::Named(_));
                if relative && luminance > 0.0 {
                    sampled = sampled.scaled(1.0 / luminance);
                }
                sampled
            }
        };
        Some(spectrum.scaled(desc.scale as f32))
    }

    /// The values of a spectrum that is a table: written down, known by name, or in a file.
    fn table(&mut self, desc: &SpectrumDesc, span: Span) -> Option<Table> {
        match desc {
            SpectrumDesc::Samples { lambda, values } => Some(Table { lambda: single(lambda), values: single(values) }),
            SpectrumDesc::Named(name) => match named(name) {
                Some(table) => Some(table),
                None => {
                    self.fail(SceneError::at(span, format!("no spectrum is called \"{name}\"")).suggest(name, names()))
                }
            },
            SpectrumDesc::File(path) => {
                match read_spectrum(path) {
                    Ok(table) => Some(table),
                    Err(problem) => self.fail(SceneError::at(span, format!("{}: {problem}", path.display())).help(
                        "a spectrum file holds a wavelength in nm and a value on each line, and comments after #",
                    )),
                }
            }
            SpectrumDesc::Constant(_) | SpectrumDesc::Rgb(_) | SpectrumDesc::Blackbody { .. } => None,
        }
    }

    fn sampled(&mut self, table: &Table, role: Role, span: Span) -> Option<Sampled> {
        match Sampled::new(&table.lambda, &table.values, role) {
            Ok(s) => Some(s),
            Err(e) => self.fail(SceneError::at(span, e.to_string())),
        }
    }

    fn check(&mut self, values: &[f64], measure: Measure, span: Span) -> Option<()> {
        let any = f64::from(f32::MAX);
        let range = match measure {
            Measure::Share => 0.0..=1.0,
            Measure::Coefficient | Measure::Index => 0.0..=any,
            Measure::Number => -any..=any,
        };
        match values.iter().find(|v| !range.contains(v)) {
            None => Some(()),
            Some(v) if measure == Measure::Share => self.fail(
                SceneError::at(span, format!("{v} is not between 0 and 1"))
                    .help("a surface cannot reflect more light than it gets"),
            ),
            Some(v) if measure == Measure::Number => self.fail(SceneError::at(span, format!("{v} is not finite"))),
            Some(v) => self.fail(SceneError::at(span, format!("{v} is negative or not finite"))),
        }
    }
}

/// The luminance of a light whose spectrum is a table, as it is written.
pub(crate) fn table_luminance(desc: &SpectrumDesc) -> Option<f32> {
    let table = match desc {
        SpectrumDesc::Samples { lambda, values } => Table { lambda: single(lambda), values: single(values) },
        SpectrumDesc::Named(name) => named(name)?,
        SpectrumDesc::File(path) => read_spectrum(path).ok()?,
        SpectrumDesc::Constant(_) | SpectrumDesc::Rgb(_) | SpectrumDesc::Blackbody { .. } => return None,
    };
    Sampled::new(&table.lambda, &table.values, Role::Illuminant).ok().map(|s| Spectrum::Sampled(s).luminance())
}

/// Measured data of a name as wavelengths \[nm\] and values.
pub(crate) fn named_samples(name: &str) -> Option<(Vec<f64>, Vec<f64>)> {
    let double = |values: Vec<f32>| values.into_iter().map(f64::from).collect();
    named(name).map(|table| (double(table.lambda), double(table.values)))
}

/// Planck's law divided by its maximum.
fn filter_of(kelvin: f64) -> Spectrum {
    // Wien's displacement law [nm·K].
    let body = Blackbody::new(kelvin as f32);
    let peak = body.at((2.897_771_955e6 / kelvin) as f32);
    let (lambda, values) = (360..=830).map(|l| (l as f32, body.at(l as f32) / peak)).unzip::<_, _, Vec<_>, Vec<_>>();
    Sampled::new(&lambda, &values, Role::Reflectance).map_or(Spectrum::Constant(0.0), Spectrum::Sampled)
}

/// Measured spectra, and glasses, which have a formula.
fn named(name: &str) -> Option<Table> {
    if let Some(table) = spectra::named(name) {
        return Some(Table { lambda: table.lambda.clone(), values: table.values.clone() });
    }
    let glass = name.starts_with("glass-").then(|| Glass::named(name)).flatten()?;
    let lambda: Vec<f32> = (359..=831).map(|l| l as f32).collect();
    Some(Table { values: lambda.iter().map(|l| glass.eta(*l)).collect(), lambda })
}

/// The names in pbrt's spelling.
fn names() -> Vec<&'static str> {
    let glasses = [
        "glass-BK7",
        "glass-BAF10",
        "glass-FK51A",
        "glass-LASF9",
        "glass-F5",
        "glass-F10",
        "glass-F11",
        "stdillum-D65",
    ];
    spectra::names().chain(glasses).collect()
}

/// A spectrum file: pairs of wavelength [nm] and value, with comments from `#` to the end of the line.
fn read_spectrum(path: &Path) -> Result<Table, String> {
    if path.metadata().is_ok_and(|m| !m.is_file()) {
        return Err("is not a file".into());
    }
    let file = File::open(path).map_err(|e| format!("cannot be read: {e}"))?;
    let mut text = String::new();
    file.take(MAX_SPECTRUM_BYTES + 1).read_to_string(&mut text).map_err(|e| format!("cannot be read: {e}"))?;
    if text.len() as u64 > MAX_SPECTRUM_BYTES {
        return Err(format!("is longer than {MAX_SPECTRUM_BYTES} bytes"));
    }
    parse_spectrum(&text)
}

fn parse_spectrum(text: &str) -> Result<Table, String> {
    let mut table = Table { lambda: Vec::new(), values: Vec::new() };
    for (i, line) in text.lines().enumerate() {
        let words = line.split('#').next().unwrap_or("").split_whitespace();
        for word in words {
            let number = word.parse::<f32>().ok().filter(|v| v.is_finite());
            let number = number.ok_or_else(|| format!("line {}: \"{word}\" is not a number", i + 1))?;
            if table.lambda.len() == table.values.len() { table.lambda.push(number) } else { table.values.push(number) }
        }
    }
    match (table.lambda.len(), table.values.len()) {
        (0, _) => Err("holds no number".into()),
        (lambdas, values) if lambdas > values => Err("ends with a wavelength without a value".into()),
        _ => Ok(table),
    }
}

fn single(values: &[f64]) -> Vec<f32> {
    values.iter().map(|v| *v as f32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spectrum_file_holds_pairs_and_comments() {
        let table = parse_spectrum("# gold\n400 1.5 # violet\n\n 500.5\t2e-1\n600 3").unwrap();
        assert_eq!((table.lambda, table.values), (vec![400.0, 500.5, 600.0], vec![1.5, 0.2, 3.0]));
        for (text, problem) in [
            ("", "holds no number"),
            ("400 1 500", "ends with a wavelength without a value"),
            ("400 1\n500 red", "line 2: \"red\" is not a number"),
            ("400 inf", "line 1: \"inf\" is not a number"),
        ] {
            assert_eq!(parse_spectrum(text).err().as_deref(), Some(problem));
        }
    }

    fn built(world: &str) -> Result<tyndall::scene::Scene, String> {
        let (desc, sources) =
            crate::pbrt::parse(Path::new("scene.pbrt"), &format!("WorldBegin {world}")).map_err(|e| e.to_string())?;
        let scene = super::super::build(&desc, sources, tyndall::spectrum::ColorMode::Rgb);
        scene.map(|(scene, _)| scene).map_err(|e| e.to_string())
    }

    /// What Mitsuba 3.9.1 makes of its gold in RGB (`spectrum_list_to_srgb` of `data/ior/Au.*.spd`, 1000 steps over its 5 nm
    /// observer; ours is exact over 1 nm).
    #[test]
    fn gold_has_the_indices_that_mitsuba_sees() {
        let scene =
            built(r#"Material "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k" Shape "sphere""#)
                .unwrap();
        assert_indices(&scene, [[0.143_037, 0.375_306, 1.442_04], [3.982_99, 2.385_56, 1.603_36]], 1e-3);
    }

    fn assert_indices(scene: &tyndall::scene::Scene, expected: [[f32; 3]; 2], tolerance: f32) {
        let metal = scene.materials.iter().find_map(|m| match m {
            tyndall::material::Material::Conductor { metal: tyndall::material::Metal::Index { eta, k }, .. } => {
                Some([eta, k].map(|part| part.constant().unwrap().rgb()))
            }
            _ => None,
        });
        for (found, expected) in metal.unwrap().iter().zip(&expected) {
            let greatest = expected.iter().fold(0.0, |most, v| f32::max(most, *v));
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() < tolerance * greatest, "{found} {expected}");
            }
        }
    }

    /// What Mitsuba 3.9.1 makes in RGB of the gold of its `bsdf_blendbsdf` scene, which is written down.
    #[test]
    fn indices_that_are_written_down_are_seen_under_d65() {
        let scene = built(
            r#"Material "conductor" "spectrum eta" [300 1.8 400 1.65 500 0.9 600 0.2 700 0.16 800 0.18]
               "spectrum k" [300 1.92 400 1.95 500 1.95 600 2.97 700 3.8 800 5.12] Shape "sphere""#,
        );
        let expected = [[0.0452341, 0.585709, 1.33692], [3.38869, 2.34904, 1.87516]];
        assert_indices(&scene.unwrap(), expected, 2e-3);
    }

    /// pbrt divides every spectrum of light but RGB by its luminance, so that `scale` is the luminance.
    #[test]
    fn a_light_of_a_named_spectrum_is_as_bright_as_its_scale_says() {
        for name in ["stdillum-A", "stdillum-F11", "stdillum-D65", "illum-acesD60", "glass-BK7"] {
            let scene = built(&format!(r#"LightSource "point" "spectrum I" "{name}" "float scale" 3"#)).unwrap();
            let tyndall::light::Light::Point(light) = &scene.lights.lights[0] else { panic!() };
            assert!((light.intensity.luminance() - 3.0).abs() < 1e-3, "{name}: {}", light.intensity.luminance());
        }
    }

    #[test]
    fn names_that_are_near_are_suggested() {
        let error = built(r#"Material "conductor" "spectrum eta" "metal-Gold-eta" Shape "sphere""#).err().unwrap();
        assert!(error.contains("no spectrum is called \"metal-Gold-eta\""), "{error}");
        let error = built(r#"LightSource "point" "spectrum I" "stdilum-A""#).err().unwrap();
        assert!(error.contains("stdillum-A"), "{error}");
    }
}
