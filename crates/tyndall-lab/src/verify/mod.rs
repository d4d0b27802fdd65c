//! The program against numbers that others computed or published.
//!
//! An oracle is a table with its source, and a row of code that measures each of its figures. A figure `x ± s` against an
//! expected `e ± u` gives `z = (x − e)/√(s² + u² + ρ²)`, with `ρ` the rounding of single precision, `10⁻⁶·e`. Figures that are
//! measured together make an [`Experiment`]; [`judge`] says what all of them say together. What a table must be able to see
//! it declares as [`Fault`]s, and the tests put them in.
//!
//! To add one: a table in `data`, a function that sets up the experiment of a row and names its figures, a row of
//! [`ORACLES`].

mod balls;
mod defect;
mod experiment;
mod growth;
mod half_spaces;
mod images;
mod judge;
mod late;
mod layers;
mod points;
mod published;
mod surfaces;
pub(crate) mod table;
mod walks;

pub use defect::{Defect, Fault};
pub use experiment::{Check, Effort, Experiment, REPLICATES};
pub use judge::{FamilyJudgement, Judgement, Together, judge};

use crate::world::SetupError;
use Fault::{Absorption, Fresnel, Index, MeanCosine, PhaseNormalisation, Reflectance, Scattering};

/// A table and how its figures are measured.
#[derive(Debug, Clone, Copy)]
pub struct Oracle {
    /// Its name.
    pub name: &'static str,
    /// What it holds.
    pub about: &'static str,
    /// Who made it.
    pub source: &'static str,
    /// What must not escape it.
    pub sees: &'static [Fault],
    measure: fn(&'static str, Effort) -> Result<Vec<Experiment>, SetupError>,
}

impl Oracle {
    /// Measures its figures.
    ///
    /// # Errors
    /// The table holds an experiment that cannot be set up.
    pub fn measure(&self, effort: Effort) -> Result<Vec<Experiment>, SetupError> {
        (self.measure)(self.name, effort)
    }
}

/// All tables: first those of the instruments, then those of the image renderer.
pub const ORACLES: &[Oracle] = &[
    Oracle {
        name: "slabs",
        about: "reflectance and transmittance of slabs and half-spaces, collimated and diffuse",
        source: "adding-doubling (iadpython, Prahl 2023)",
        sees: &[Scattering, Absorption, PhaseNormalisation, MeanCosine, Index],
        measure: layers::slabs,
    },
    Oracle {
        name: "half-space",
        about: "albedo of an isotropic half-space: all orders, the first, the second",
        source: "Chandrasekhar 1960, d'Eon 2016; closed forms",
        sees: &[Scattering, PhaseNormalisation],
        measure: half_spaces::albedos,
    },
    Oracle {
        name: "h-function",
        about: "Chandrasekhar's H by angle, from albedos of half-spaces",
        source: "Chandrasekhar 1960; closed form, 30 digits",
        sees: &[Scattering, PhaseNormalisation],
        measure: half_spaces::h_function,
    },
    Oracle {
        name: "h-moments",
        about: "moments of H, from albedos of half-spaces in light of three distributions",
        source: "Chandrasekhar 1960; numerical, residual 5·10⁻¹⁵",
        sees: &[Scattering, PhaseNormalisation],
        measure: half_spaces::h_moments,
    },
    Oracle {
        name: "printed",
        about: "reflectances, transmittances and H as they are printed",
        source: "van de Hulst 1980, Giovanelli 1955, Prahl 1989, MCML, d'Eon 2016",
        sees: &[Scattering, PhaseNormalisation],
        measure: published::printed,
    },
    Oracle {
        name: "mcml-totals",
        about: "diffuse reflectance and transmittance of tissue, marble and milk",
        source: "adding-doubling, on the cases of MCML 1.2 (Wang, Jacques and Zheng 1995)",
        sees: &[Scattering, Absorption, PhaseNormalisation, MeanCosine],
        measure: layers::mcml_totals,
    },
    Oracle {
        name: "mcml-angle",
        about: "van de Hulst's slab by exit angle",
        source: "adding-doubling; MCML 1.2",
        sees: &[Scattering, Absorption, PhaseNormalisation, MeanCosine],
        measure: layers::by_angle,
    },
    Oracle {
        name: "mcml-radius",
        about: "reflectance by radius of marble, milk, tissue and others",
        source: "MCML 1.2, 10⁶ to 2·10⁷ photons",
        sees: &[Scattering, PhaseNormalisation, MeanCosine],
        measure: layers::by_radius,
    },
    Oracle {
        name: "points",
        about: "fluence around a point source",
        source: "d'Eon's Monte Carlo; exact where scattering is isotropic (Davison 1947)",
        sees: &[Scattering, Absorption, PhaseNormalisation],
        measure: points::fluence,
    },
    Oracle {
        name: "point-moments",
        about: "moments of the fluence around a point source",
        source: "exact (Case, de Hoffmann and Placzek 1953)",
        sees: &[Scattering, Absorption, PhaseNormalisation],
        measure: points::moments,
    },
    Oracle {
        name: "point-decay",
        about: "relaxation length of the fluence far from a point source",
        source: "exact: c ν0 artanh(1/ν0) = 1 (Case and Zweifel 1967)",
        sees: &[PhaseNormalisation],
        measure: growth::decay,
    },
    Oracle {
        name: "walks",
        about: "moments of the place after 1 to 1000 free flights",
        source: "exact",
        sees: &[Scattering, PhaseNormalisation, MeanCosine],
        measure: walks::moments,
    },
    Oracle {
        name: "balls",
        about: "escape from and absorption in a scattering ball",
        source: "integral equation; Case, de Hoffmann and Placzek 1953",
        sees: &[Scattering, Absorption, PhaseNormalisation],
        measure: balls::balance,
    },
    Oracle {
        name: "criticality",
        about: "critical albedo of slabs and balls, from the growth of successive orders",
        source: "integral equation; Sood, Forster and Parsons 2003",
        sees: &[Scattering, PhaseNormalisation],
        measure: growth::criticality,
    },
    Oracle {
        name: "mean-ways",
        about: "mean way of diffuse light in bodies that scatter anyhow",
        source: "4V/S, exact (Dirac 1943; Blanco and Fournier 2003)",
        sees: &[PhaseNormalisation, Index],
        measure: surfaces::mean_ways,
    },
    Oracle {
        name: "fresnel",
        about: "hemispherical averages of Fresnel's reflectance, from outside and inside",
        source: "quadrature, all digits",
        sees: &[Index, Fresnel],
        measure: surfaces::fresnel,
    },
    Oracle {
        name: "grains",
        about: "albedo and mean cosine of a smooth ball of glass",
        source: "ray optics, quadrature",
        sees: &[Absorption, Index, Fresnel],
        measure: surfaces::grains,
    },
    Oracle {
        name: "image-furnace",
        about: "bodies that absorb nothing, or glow as the sky does, under a uniform sky",
        source: "exact: radiance 1 along every path",
        sees: &[PhaseNormalisation, Fresnel],
        measure: images::media::furnace,
    },
    Oracle {
        name: "image-beer",
        about: "a slab that absorbs, before a sky, and one that glows",
        source: "exact: exp(−τ) and 1 − exp(−τ) (Beer, Lambert, Kirchhoff)",
        sees: &[Absorption],
        measure: images::media::beer,
    },
    Oracle {
        name: "image-slabs",
        about: "slabs lit by half a sky, seen along their normal",
        source: "adding-doubling (iadpython, Prahl 2023), by reciprocity",
        sees: &[Scattering, Absorption, PhaseNormalisation, MeanCosine, Index],
        measure: images::media::slabs,
    },
    Oracle {
        name: "image-single",
        about: "once scattered light of a slab under a distant light",
        source: "closed form (Chandrasekhar 1960, § 17)",
        sees: &[Scattering, PhaseNormalisation],
        measure: images::media::single,
    },
    Oracle {
        name: "image-radiance",
        about: "radiance of slabs by angle and azimuth under a distant light",
        source: "discrete ordinates (PythonicDISORT 1.8)",
        sees: &[Scattering, PhaseNormalisation, MeanCosine],
        measure: images::media::radiance,
    },
    Oracle {
        name: "image-brdf",
        about: "BRDF of an isotropic half-space: all orders, the first, the second",
        source: "Chandrasekhar 1960, d'Eon 2016; closed forms",
        sees: &[Scattering, PhaseNormalisation],
        measure: images::media::brdf,
    },
    Oracle {
        name: "image-balls",
        about: "scattering balls before a uniform sky, by an orthographic camera",
        source: "integral equation; Case, de Hoffmann and Placzek 1953",
        sees: &[Absorption, PhaseNormalisation],
        measure: images::media::balls,
    },
    Oracle {
        name: "image-enclosure",
        about: "closed bodies, facing plates, and a point light in a sphere",
        source: "closed forms",
        sees: &[Reflectance],
        measure: images::surfaces::enclosures,
    },
    Oracle {
        name: "image-floor",
        about: "a floor under shining balls, disks and rectangles",
        source: "closed forms (Lambert 1760; Howell's catalogue)",
        sees: &[Reflectance],
        measure: images::surfaces::floors,
    },
    Oracle {
        name: "image-pane",
        about: "what a pane of glass reflects and passes by angle",
        source: "closed form: 2F/(1 + F), Fresnel 1823",
        sees: &[Index, Fresnel],
        measure: images::surfaces::panes,
    },
    Oracle {
        name: "image-fibre",
        about: "albedo of a fibre of hair by inclination and absorption",
        source: "ray optics, quadrature (Marschner 2003, Chiang 2016)",
        sees: &[Absorption, Index],
        measure: images::fibres::albedos,
    },
    Oracle {
        name: "image-agreement",
        about: "rooms without a closed form, by all integrators",
        source: "volpath, with many samples",
        sees: &[],
        measure: images::surfaces::agreement,
    },
];
