//! `<integrator>`: what makes the same image is mapped to ours, with a note where something is different.

use tyndall::{film::LayerKind, integrator::Counted};

use super::aov;
use super::object::{Object, Report};
use super::scene::Builder;
use super::tree::Element;
use super::words;
use crate::desc::{Ignored, IntegratorDesc, MaterialDesc, MaterialKind};
use crate::error::SceneError;
use crate::source::Spanned;

/// Integrators that work in another way and make the same image.
const DIFFERENT: [(&str, &str); 8] = [
    ("depth", "the distance is the layer `depth.T` of the image, beside the light"),
    ("ptracer", "paths start at the camera, not at the lights: the same image"),
    ("prb", NO_DERIVATIVES),
    ("prb_basic", NO_DERIVATIVES),
    ("prb_projective", NO_DERIVATIVES),
    ("prbvolpath", NO_DERIVATIVES),
    ("direct_projective", NO_DERIVATIVES),
    ("moment", "the image has the standard error of every pixel anyway"),
];
const NO_DERIVATIVES: &str = "derivatives are not taken: the image is the same";

pub(super) fn integrator<'t>(builder: &mut Builder<'t>, element: &'t Element) -> Option<IntegratorDesc> {
    let name = words::plugin(element, &mut builder.report)?;
    if let Some((_, reason)) = DIFFERENT.into_iter().find(|(word, _)| *word == name) {
        builder.report.ignored.push(Ignored { span: element.span_of("type"), reason });
    }
    let mut object = builder.object(element);
    match name {
        "moment" => return inner(builder, object, Vec::new()),
        "aov" => {
            let layers = aov::layers(&mut object, &mut builder.report);
            return inner(builder, object, layers);
        }
        _ => {}
    }
    let layers = if name == "depth" { vec![aov::layer("depth", "depth")?] } else { Vec::new() };
    let report = &mut builder.report;
    let hide_emitters = object.flag("hide_emitters", false, report);
    let (max_depth, rr_depth) = if name.starts_with("direct") {
        let samples = ["shading_samples", "emitter_samples", "bsdf_samples"];
        object.ignore(&samples, "each sample of a pixel takes one of a light and one of the surface", report);
        (Some(Spanned::new(1, element.span_of("type"))), None)
    } else {
        depths(&mut object, report)
    };
    // tyndall's own.
    let explicit_grains = object.integer("explicit_grains", 0, report);
    let explicit_grains = explicit_grains.map(|grains| grains.map(|n| u32::try_from(n).unwrap_or(u32::MAX)));
    if name == "volpathmis" {
        object.ignore(&["use_spectral_mis"], "coloured media are always sampled with spectral MIS", report);
    }
    object.ignore(&["block_size", "samples_per_pass"], "tiles and passes do not change the image", report);
    object.ignore(&["timeout"], "time is limited on the command line", report);
    if name.contains("projective") {
        let edges = ["sppc", "sppp", "sppi", "guiding", "guiding_proj", "guiding_rounds"];
        object.ignore(&edges, NO_DERIVATIVES, report);
    }
    object.finish(report);
    Some(IntegratorDesc {
        name: Spanned::new(name.into(), element.span_of("type")),
        max_depth,
        counted: if name.contains("volpath") { Counted::Turns } else { Counted::Scatterings },
        explicit_grains,
        rr_depth,
        hide_emitters,
        layers,
    })
}

/// The integrator inside of another one.
fn inner<'t>(builder: &mut Builder<'t>, mut object: Object<'t>, layers: Vec<LayerKind>) -> Option<IntegratorDesc> {
    let child = object.only("integrator", &mut builder.report);
    object.ignore(&["block_size", "samples_per_pass"], "tiles and passes do not change the image", &mut builder.report);
    let span = object.element.span;
    object.finish(&mut builder.report);
    let Some(child) = child else {
        if layers.is_empty() {
            builder.report.errors.push(SceneError::at(span, "it has no <integrator> inside"));
            return None;
        }
        return Some(IntegratorDesc { layers, ..super::scene::default_integrator(span) });
    };
    if matches!(child.element.text("type"), "moment" | "aov") {
        let message = format!("a \"{}\" inside of another is not known", child.element.text("type"));
        builder.report.errors.push(SceneError::at(child.at.span, message));
        return None;
    }
    let inside = integrator(builder, child.element)?;
    let layers = layers.into_iter().chain(inside.layers).collect();
    Some(IntegratorDesc { layers, ..inside })
}

/// `max_depth` as a limit on scatterings, and `rr_depth`.
fn depths(object: &mut Object, report: &mut Report) -> (Option<Spanned<u32>>, Option<Spanned<u32>>) {
    let max_depth = object.integer("max_depth", -1, report);
    let rr_depth = object.integer("rr_depth", 1, report).map(|depth| depth.map(|d| d as u32));
    if let Some(depth) = max_depth.filter(|depth| depth.value == 0) {
        report.errors.push(
            SceneError::at(depth.span, "with \"max_depth\" 0 nothing is seen at all")
                .help("-1 is without limit, 1 shows lights, 2 what they shine on"),
        );
    }
    // Mitsuba counts the segments of a path, the description its scatterings.
    let limit = max_depth.filter(|depth| depth.value > 0).map(|depth| depth.map(|d| d as u32 - 1));
    (limit, rr_depth)
}

/// Only the integrators of volumes let paths through open surfaces for nothing.
pub(super) fn warn_of_open_surfaces(integrator: &IntegratorDesc, materials: &[MaterialDesc], report: &mut Report) {
    let Some(limit) = &integrator.max_depth else { return };
    let is_open = |of: &MaterialDesc| matches!(of.kind, MaterialKind::Interface | MaterialKind::Mask { .. });
    if integrator.counted == Counted::Scatterings && materials.iter().any(is_open) {
        let message = format!(
            "Mitsuba's \"{}\" counts each surface that is passed straight (\"null\", \"mask\") for its depth, tyndall \
             counts none: more light is found behind them here",
            integrator.name.value
        );
        let warning = SceneError::warning(limit.span, message);
        report.errors.push(warning.help("\"volpath\" counts as tyndall does; without \"max_depth\" both agree"));
    }
}
