//! `Option`, `Sampler` and `Integrator`, and the settings of the scene as they come in.

use tyndall::integrator::Counted;

use super::Reader;
use super::params::quote;
use super::parser::Statement;
use crate::desc::{CameraDesc, CameraKind, FilmDesc, FilterDesc, IntegratorDesc, LengthUnit, Options, SamplerDesc};
use crate::error::{ErrorList, SceneError};
use crate::source::{Span, Spanned};

/// Settings that the file has made so far.
#[derive(Debug, Default)]
pub(super) struct Settings {
    /// Where the world begins.
    pub(super) world: Option<Span>,
    pub(super) camera: Option<CameraDesc>,
    /// Time that the shutter is open, which is a factor on the image.
    pub(super) shutter: Option<f64>,
    pub(super) film: Option<FilmDesc>,
    pub(super) filter: Option<FilterDesc>,
    sampler: Option<SamplerDesc>,
    integrator: Option<IntegratorDesc>,
    unit: Option<Spanned<LengthUnit>>,
    seed: Option<Spanned<u64>>,
    /// Factor on the longest edges of displaced meshes.
    pub(super) displacement_edge_scale: Option<f64>,
}

/// Settings with pbrt's defaults in place of what the file leaves out.
#[derive(Debug)]
pub(super) struct AllSettings {
    pub(super) options: Options,
    pub(super) camera: CameraDesc,
    pub(super) film: FilmDesc,
    pub(super) sampler: SamplerDesc,
    pub(super) integrator: IntegratorDesc,
}

impl Settings {
    pub(super) fn finish(self, start: Span, errors: &mut ErrorList) -> AllSettings {
        if self.world.is_none() {
            errors.push(
                SceneError::at(start, "the scene has no WorldBegin")
                    .help("write WorldBegin between the camera and the first shape"),
            );
        }
        let mut film = self.film.unwrap_or_else(|| FilmDesc::pbrt_default(start));
        film.filter = self.filter.unwrap_or(film.filter);
        film.exposure *= self.shutter.unwrap_or(1.0);
        let mut camera = self.camera.unwrap_or_else(|| CameraDesc::pbrt_default(start));
        // Where a scene does not say its unit, pbrt takes it for a metre as far as lenses are concerned.
        if let (CameraKind::Realistic(realistic), Some(unit)) = (&mut camera.kind, &self.unit) {
            realistic.millimetre = 1.0 / unit.value.millimetres();
        }
        let named = |name: &str| Spanned::new(name.to_string(), start);
        AllSettings {
            options: Options {
                unit: self.unit.unwrap_or(Spanned::new(LengthUnit::Millimetre, start)),
                seed: self.seed,
            },
            camera,
            film,
            sampler: self.sampler.unwrap_or_else(|| SamplerDesc {
                kind: named("zsobol"),
                spp: Spanned::new(16, start),
                seed: None,
            }),
            integrator: self.integrator.unwrap_or_else(|| IntegratorDesc {
                name: named("volpath"),
                max_depth: None,
                counted: Counted::Scatterings,
                explicit_grains: None,
                rr_depth: None,
                hide_emitters: false,
                layers: Vec::new(),
            }),
        }
    }
}

/// Options of pbrt that change nothing here.
const IGNORED_OPTIONS: [(&str, &str); 6] = [
    ("disabletexturefiltering", "textures are looked up at points: the samples of a pixel filter them"),
    ("msereferenceimage", "`tyndall compare` takes the difference of two images"),
    ("msereferenceout", "`tyndall compare` takes the difference of two images"),
    ("pixelstats", "statistics are asked for on the command line"),
    ("rendercoordsys", "all spaces are one: tyndall's error bounds do not need a camera-relative space"),
    ("wavefront", "tyndall has one way to run"),
];

/// Options of pbrt that would change the image.
const LATER_OPTIONS: [&str; 3] = ["disablepixeljitter", "disablewavelengthjitter", "forcediffuse"];

/// Samplers of pbrt. tyndall has its own.
const SAMPLERS: [&str; 7] = ["halton", "independent", "paddedsobol", "pmj02bn", "sobol", "stratified", "zsobol"];

/// Integrators of pbrt, with what is different here: tyndall has one for all light, by light sampling and directions at
/// once, through surfaces and media alike.
const INTEGRATORS: [(&str, Option<&str>); 9] = [
    ("path", None),
    ("volpath", None),
    ("simplepath", None),
    ("simplevolpath", None),
    ("randomwalk", Some("lights are sampled too: the same image with less noise")),
    ("lightpath", Some("paths start at the camera: mirrors and glass are seen too")),
    ("bdpt", Some("paths start at the camera only: the same image, caustics with more noise")),
    ("mlt", Some("samples are independent: the same image, caustics with more noise")),
    ("sppm", Some("no photons are gathered: the same image without their blur, caustics with more noise")),
];
/// Integrators of pbrt that make another image, with what to do instead.
const OTHER_INTEGRATORS: [(&str, &str); 3] = [
    (
        "ambientocclusion",
        "give all shapes a white diffuse material under a constant infinite light of 1, with \"volpath\"",
    ),
    ("function", "it renders no scene, but draws a function over the pixel"),
    ("simplebdpt", "use \"volpath\""),
];

impl Reader {
    pub(super) fn option(&mut self, s: &Statement<'_>) {
        // "string unit" and "unit" are both in use; pbrt takes no notice of case and underlines.
        let name = &s.names[0];
        let word = name.value.split_ascii_whitespace().next_back().unwrap_or("").replace('_', "").to_lowercase();
        match &*word {
            "unit" => self.unit(s),
            "seed" => match s.numbers.first() {
                Some(&seed) if seed >= 0.0 && seed.fract() == 0.0 && seed < 2f64.powi(53) => {
                    self.settings.seed = Some(Spanned::new(seed as u64, s.whole));
                }
                _ => self.errors.push(SceneError::at(s.whole, "the seed must be an integer of at least 0")),
            },
            "displacementedgescale" => match s.numbers.first() {
                Some(&scale) if scale > 0.0 && scale.is_finite() => {
                    self.settings.displacement_edge_scale = Some(scale);
                }
                _ => self.errors.push(SceneError::at(s.whole, "the scale of edges must be greater than 0")),
            },
            _ if LATER_OPTIONS.contains(&&*word) => {
                // What is switched off changes nothing.
                if s.names.get(1).is_some_and(|v| v.value == "false") {
                    return self.ignore(s.whole, "it is off anyway");
                }
                let message = format!("the option {} is not supported yet", quote(&word));
                self.errors.push(SceneError::not_yet(s.whole, message).help("leave it out"));
            }
            _ => {
                if let Some((_, reason)) = IGNORED_OPTIONS.into_iter().find(|(known, _)| *known == word) {
                    return self.ignore(s.whole, reason);
                }
                let known = ["unit", "seed"].into_iter().chain(IGNORED_OPTIONS.map(|o| o.0)).chain(LATER_OPTIONS);
                let error = SceneError::at(name.span, format!("there is no option {}", quote(&name.value)));
                self.errors.push(error.suggest(&word, known));
            }
        }
    }

    fn unit(&mut self, s: &Statement<'_>) {
        let word = s.names.get(1).map_or("", |v| &v.value);
        if let Some(unit) = LengthUnit::parse(word) {
            self.settings.unit = Some(Spanned::new(unit, s.whole));
            return;
        }
        let known = LengthUnit::ALL.map(|u| quote(u.0)).join(", ");
        let error = SceneError::at(s.whole, format!("there is no unit of length {}", quote(word)));
        self.errors.push(error.help(format!("known are {known}")));
    }

    pub(super) fn sampler(&mut self, mut s: Statement<'_>) {
        let name = s.names[0].clone();
        if !SAMPLERS.contains(&&*name.value) {
            return self.unknown_kind("sampler", &name, &SAMPLERS, &[]);
        }
        let mut p = self.params("sampler", &mut s, &[]);
        let spp = if name.value == "stratified" {
            let (x, y) = (p.count("xsamples", 4, 1), p.count("ysamples", 4, 1));
            p.ignore("jitter", "samples are always jittered");
            x.map(|x| x.saturating_mul(y.value))
        } else {
            p.count("pixelsamples", 16, 1)
        };
        let seed = p.count_opt("seed", 0).map(|seed| seed.map(u64::from));
        p.ignore("randomization", "tyndall has its own sampler");
        self.finish_params(p);
        self.settings.sampler = Some(SamplerDesc { kind: name.map(Into::into), spp, seed });
    }

    pub(super) fn integrator(&mut self, mut s: Statement<'_>) {
        let name = s.names[0].clone();
        if let Some((word, advice)) = OTHER_INTEGRATORS.into_iter().find(|(word, _)| *word == name.value) {
            let message = format!("the integrator {} is not known here", quote(word));
            return self.errors.push(SceneError::not_yet(name.span, message).help(advice));
        }
        let Some((_, difference)) = INTEGRATORS.into_iter().find(|(word, _)| *word == name.value) else {
            return self.unknown_kind("integrator", &name, &INTEGRATORS.map(|i| i.0), &[]);
        };
        if let Some(difference) = difference {
            self.ignore(name.span, difference);
        }
        let mut p = self.params("integrator", &mut s, &[]);
        let max_depth = p.count_opt("maxdepth", 0);
        // tyndall's own.
        let explicit_grains = p.count_opt("explicitgrains", 0);
        p.ignore("lightsampler", "tyndall chooses lights in its own way");
        if p.boolean("regularize", false).value {
            p.error(
                SceneError::at(p.span, "regularised paths are not supported: they change the image")
                    .help("leave out \"bool regularize\""),
            );
        }
        let machinery: &[&str] = match &*name.value {
            "bdpt" => &["visualizestrategies", "visualizeweights"],
            "mlt" => &["bootstrapsamples", "chains", "mutationsperpixel", "largestepprobability", "sigma"],
            "sppm" => &["photonsperiteration", "radius", "seed"],
            _ => &[],
        };
        for word in machinery {
            p.ignore(word, "it belongs to an integrator that is not used here");
        }
        p.ignore("samplelights", "light sampling never changes the mean");
        p.ignore("samplebsdf", "how directions are sampled never changes the mean");
        self.finish_params(p);
        self.settings.integrator = Some(IntegratorDesc {
            name: name.map(Into::into),
            max_depth,
            counted: Counted::Scatterings,
            explicit_grains,
            rr_depth: None,
            hide_emitters: false,
            layers: Vec::new(),
        });
    }
}
