//! `aovs` of the integrator `aov`: `name:kind, name:kind, …`, as layers of the film.

use tyndall::{
    feature::{Facing, Feature, Space},
    film::{Average, LayerKind, Recorded},
};

use super::object::{Object, Report};
use crate::desc::Ignored;
use crate::error::SceneError;

/// The most layers of an image: each costs more memory than the light itself.
const MOST_LAYERS: usize = 32;

/// The kinds that are known, with the endings of their channels.
const KINDS: [(&str, Feature, &[&str]); 9] = [
    ("albedo", Feature::Albedo, &["R", "G", "B"]),
    ("depth", Feature::Depth, &["T"]),
    ("position", Feature::Position(Space::World), &["X", "Y", "Z"]),
    ("uv", Feature::Uv, &["U", "V"]),
    ("geo_normal", Feature::GeometricNormal(Space::World, Facing::Outward), &["X", "Y", "Z"]),
    ("sh_normal", Feature::ShadingNormal(Space::World, Facing::Outward), &["X", "Y", "Z"]),
    ("dp_du", Feature::DpDu, &["X", "Y", "Z"]),
    ("prim_index", Feature::Primitive, &["I"]),
    ("shape_index", Feature::Object, &["I"]),
];
/// Kinds of Mitsuba that are not known yet.
const LATER: [&str; 3] = ["dp_dv", "duv_dx", "duv_dy"];

/// The layers that the object asks for.
pub(super) fn layers(object: &mut Object, report: &mut Report) -> Vec<LayerKind> {
    let mut layers: Vec<LayerKind> = Vec::new();
    let Some(list) = object.string("aovs", report) else {
        report.errors.push(SceneError::at(object.element.span, "the integrator \"aov\" lacks \"aovs\""));
        return layers;
    };
    for item in list.value.split(',').map(str::trim).filter(|item| !item.is_empty()) {
        let error = |message: String| SceneError::at(list.span, message);
        let Some((name, kind)) = item.split_once(':').map(|(name, kind)| (name.trim(), kind.trim())) else {
            report.errors.push(error(format!("\"{item}\" is no layer")).help("write name:kind, as in dd:depth"));
            continue;
        };
        let taken = layers.iter().any(|layer| layer.channels[0].rsplit_once('.').is_some_and(|(n, _)| n == name));
        if name.is_empty() || name == "stderr" || taken || layers.len() >= MOST_LAYERS {
            let message = format!("a layer cannot be called \"{name}\"");
            let help = format!("up to {MOST_LAYERS} layers have names of their own; `stderr` is the standard error's");
            report.errors.push(error(message).help(help));
            return layers;
        }
        match layer(name, kind) {
            Some(layer) => {
                let here = |reason| Ignored { span: list.span, reason };
                report.ignored.extend(difference(layer.recorded).map(here));
                layers.push(layer);
            }
            None if LATER.contains(&kind) => {
                let message = format!("layers of \"{kind}\" are not known yet");
                report.errors.push(SceneError::not_yet(list.span, message).help("leave it out"));
            }
            None => {
                let known = KINDS.iter().map(|(known, ..)| *known).chain(LATER);
                report.errors.push(error(format!("there is no layer of \"{kind}\"")).suggest(kind, known));
            }
        }
    }
    layers
}

/// What Mitsuba's numbers are that ours are not.
fn difference(recorded: Recorded) -> Option<&'static str> {
    match recorded {
        Recorded::Surface(Feature::Depth) => {
            Some("depth is the distance from the eye, not from the near clipping plane")
        }
        Recorded::Surface(Feature::Primitive | Feature::Object) => {
            Some("indices are those of tyndall: shapes as the file has them, rectangles and cubes in triangles")
        }
        _ => None,
    }
}

/// A layer as `aovs` writes it, if there is a word for it.
pub(crate) fn word(layer: &LayerKind) -> Option<String> {
    let (name, _) = layer.channels.first()?.rsplit_once('.')?;
    let (kind, ..) = KINDS.into_iter().find(|(kind, ..)| self::layer(name, kind).as_ref() == Some(layer))?;
    Some(format!("{name}:{kind}"))
}

/// The layer `name` of a known kind, averaged over all samples as in Mitsuba.
pub(super) fn layer(name: &str, kind: &str) -> Option<LayerKind> {
    let (_, feature, endings) = KINDS.into_iter().find(|(known, ..)| *known == kind)?;
    let channels = endings.iter().map(|ending| format!("{name}.{ending}")).collect();
    Some(LayerKind { recorded: Recorded::Surface(feature), channels, average: Average::Samples })
}
