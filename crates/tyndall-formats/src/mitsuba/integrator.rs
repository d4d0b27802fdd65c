//! `<integrator>`: `path`, `volpath`, `volpathmis` and `direct`, with `max_depth`, `rr_depth` and `hide_emitters`.

use super::scene::Builder;
use super::tree::Element;
use super::words;
use crate::desc::IntegratorDesc;
use crate::source::Spanned;

pub(super) fn integrator<'t>(builder: &mut Builder<'t>, element: &'t Element) -> Option<IntegratorDesc> {
    let name = words::plugin(element, &mut builder.report)?;
    let mut object = builder.object(element);
    let report = &mut builder.report;
    let hide_emitters = object.flag("hide_emitters", false, report);
    let (max_depth, rr_depth) = if name == "direct" {
        let samples = ["shading_samples", "emitter_samples", "bsdf_samples"];
        object.ignore(&samples, "each sample of a pixel takes one of a light and one of the surface", report);
        (Some(Spanned::new(1, element.span_of("type"))), None)
    } else {
        let max_depth = object.integer("max_depth", -1, report);
        let rr_depth = object.integer("rr_depth", 1, report).map(|depth| depth.map(|d| d as u32));
        if let Some(depth) = max_depth.filter(|depth| depth.value == 0) {
            report.errors.push(
                crate::error::SceneError::at(depth.span, "with \"max_depth\" 0 nothing is seen at all")
                    .help("-1 is without limit, 1 shows lights, 2 what they shine on"),
            );
        }
        // Mitsuba counts the segments of a path, the description its scatterings.
        let limit = max_depth.filter(|depth| depth.value > 0).map(|depth| depth.map(|d| d as u32 - 1));
        (limit, rr_depth)
    };
    if name == "volpathmis" {
        object.ignore(&["use_spectral_mis"], "coloured media are always sampled with spectral MIS", report);
    }
    object.ignore(&["block_size", "samples_per_pass"], "tiles and passes do not change the image", report);
    object.ignore(&["timeout"], "time is limited on the command line", report);
    object.finish(report);
    Some(IntegratorDesc {
        name: Spanned::new(name.into(), element.span_of("type")),
        max_depth,
        rr_depth,
        hide_emitters,
    })
}
