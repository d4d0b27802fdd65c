//! The plugins of Mitsuba 3.9: those that are read here, and those that are not known yet.

use super::object::Report;
use super::tree::Element;
use crate::error::SceneError;

struct Plugins {
    tag: &'static str,
    known: &'static [&'static str],
    later: &'static [&'static str],
}

const PLUGINS: &[Plugins] = &[
    Plugins {
        tag: "bsdf",
        known: &[
            "diffuse",
            "twosided",
            "dielectric",
            "roughdielectric",
            "thindielectric",
            "conductor",
            "roughconductor",
            "null",
            "plastic",
            "roughplastic",
            "measured",
            "principled",
            "principledthin",
            "blendbsdf",
            "mask",
            "bumpmap",
            "normalmap",
            "hair",
        ],
        later: &["circular", "measured_polarized", "polarizer", "pplastic", "retarder"],
    },
    Plugins {
        tag: "emitter",
        known: &["area", "constant", "directional", "directionalarea", "envmap", "point", "projector", "spot"],
        later: &["sunsky", "timed_sunsky"],
    },
    Plugins { tag: "film", known: &["hdrfilm"], later: &["specfilm"] },
    Plugins {
        tag: "integrator",
        known: &[
            "path",
            "volpath",
            "volpathmis",
            "direct",
            "ptracer",
            "moment",
            "prb",
            "prb_basic",
            "prb_projective",
            "prbvolpath",
            "direct_projective",
            "aov",
            "depth",
        ],
        later: &["stokes"],
    },
    Plugins { tag: "medium", known: &["homogeneous"], later: &["heterogeneous"] },
    Plugins { tag: "phase", known: &["isotropic", "hg", "rayleigh", "tabphase", "blendphase"], later: &["sggx"] },
    Plugins { tag: "rfilter", known: &["box", "tent", "gaussian", "mitchell", "catmullrom", "lanczos"], later: &[] },
    Plugins {
        tag: "sampler",
        known: &["independent", "stratified", "multijitter", "orthogonal", "ldsampler"],
        later: &[],
    },
    Plugins {
        tag: "sensor",
        known: &["perspective", "thinlens", "orthographic", "irradiancemeter", "radiancemeter", "distant", "batch"],
        later: &[],
    },
    Plugins {
        tag: "shape",
        known: &[
            "sphere",
            "rectangle",
            "cube",
            "disk",
            "cylinder",
            "obj",
            "ply",
            "serialized",
            "bsplinecurve",
            "linearcurve",
            "shapegroup",
            "instance",
        ],
        later: &["ellipsoids", "ellipsoidsmesh", "merge", "sdfgrid"],
    },
    Plugins { tag: "texture", known: &["bitmap", "checkerboard", "mesh_attribute"], later: &["volume"] },
    Plugins { tag: "volume", known: &["constvolume"], later: &["gridvolume"] },
];

/// What to do without Mitsuba's spectral film.
const SPECFILM: &str = "its channels are weighed by any responses (\"srf\"), and only bands of equal width are recorded yet: \
                        the film \"spectral\" of pbrt's language has them, \"hdrfilm\" has the colours";

/// Whether an element is an object: something with plugins.
pub(super) fn is_object(tag: &str) -> bool {
    PLUGINS.iter().any(|plugins| plugins.tag == tag)
}

/// The plugin of an object, or an error that says whether the word is wrong or only not known yet. The parameters of an
/// unknown plugin cannot be checked, but the plugins inside it can.
pub(super) fn plugin(element: &Element, report: &mut Report) -> Option<&'static str> {
    let word = element.attribute("type")?;
    let Plugins { tag, known, later } = PLUGINS.iter().find(|plugins| plugins.tag == element.tag)?;
    if let Some(plugin) = known.iter().find(|plugin| **plugin == word.value) {
        return Some(plugin);
    }
    report.errors.push(if later.contains(&word.value.as_str()) {
        let error = SceneError::not_yet(word.span, format!("the {tag} \"{}\" is not known yet", word.value));
        let known: Vec<_> = known.iter().map(|known| format!("\"{known}\"")).collect();
        match &*word.value {
            "specfilm" => error.help(SPECFILM),
            _ if known.is_empty() => error,
            _ => error.help(format!("known are {}", known.join(", "))),
        }
    } else {
        let error = SceneError::at(word.span, format!("there is no {tag} \"{}\"", word.value));
        error.suggest(&word.value, known.iter().chain(*later).copied())
    });
    for inside in element.children.iter().filter(|child| is_object(child.tag)) {
        plugin(inside, report);
    }
    None
}
