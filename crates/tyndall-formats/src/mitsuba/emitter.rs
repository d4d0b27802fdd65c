//! `<emitter>`: `area` inside a shape; `point`, `spot`, `directional`, `constant` and `envmap` on their own.
//!
//! An area light emits on the side that the normal points to. A spot is full up to `beam_width` (three quarters of
//! `cutoff_angle` if not given) and fades linearly in the angle. An environment map is seen by longitude and latitude.

use glam::{DMat4, DQuat, DVec3};

use super::object::{Object, Report};
use super::scene::Builder;
use super::tree::Element;
use super::words;
use crate::desc::{AreaLightDesc, EnvironmentMapping, LightDesc, LightKind, SpotFalloff};
use crate::error::SceneError;
use crate::source::Spanned;

const CHOSEN: &str = "how often each light is sampled is chosen by what it gives";

impl<'t> Builder<'t> {
    /// An emitter inside a shape.
    pub(super) fn area_light(&mut self, element: &'t Element) -> Option<AreaLightDesc> {
        let plugin = words::plugin(element, &mut self.report)?;
        if plugin != "area" {
            let message = format!("the emitter \"{plugin}\" cannot stand inside a shape");
            let error = SceneError::at(element.span_of("type"), message).help("\"area\" can");
            self.report.errors.push(error);
            return None;
        }
        let mut object = self.object(element);
        let radiance = object.light("radiance", &mut self.report);
        object.ignore(&["sampling_weight"], CHOSEN, &mut self.report);
        object.finish(&mut self.report);
        Some(AreaLightDesc { span: element.span, radiance, two_sided: false })
    }

    /// An emitter on its own.
    pub(super) fn light(&mut self, element: &'t Element) -> Option<LightDesc> {
        let plugin = words::plugin(element, &mut self.report)?;
        let mut object = self.object(element);
        let medium = object.only("medium", &mut self.report);
        let medium = medium.and_then(|m| Some(Spanned::new(self.medium_id(m.element)?, m.at.span)));
        let report = &mut self.report;
        let mut to_world = object.transform(report);
        let kind = match plugin {
            "point" => {
                to_world = placed(&mut object, "position", to_world, DMat4::from_translation, report);
                LightKind::Point { intensity: object.light("intensity", report) }
            }
            "spot" => spot(&mut object, report),
            "directional" => {
                to_world = placed(&mut object, "direction", to_world, facing, report);
                LightKind::Distant { irradiance: object.light("irradiance", report) }
            }
            "constant" => LightKind::Constant { radiance: object.light("radiance", report) },
            "envmap" => {
                let name = object.string("filename", report);
                let scale = object.float("scale", |scale| scale >= 0.0, "at least 0", report);
                object.ignore(&["mis_compensation"], CHOSEN, report);
                let Some(name) = name else {
                    report.errors.push(SceneError::at(element.span, "the emitter \"envmap\" lacks a \"filename\""));
                    return None;
                };
                let path = self.file(name);
                let mapping = EnvironmentMapping::LatitudeLongitude;
                LightKind::Environment { path, scale: scale.map_or(1.0, |s| s.value), mapping }
            }
            _ => {
                let error = SceneError::at(element.span_of("type"), "the emitter \"area\" stands alone");
                report.errors.push(error.help("put it inside the shape that shines"));
                return None;
            }
        };
        object.ignore(&["sampling_weight"], CHOSEN, &mut self.report);
        object.finish(&mut self.report);
        Some(LightDesc { span: element.span, kind, to_world, medium })
    }
}

/// The matrix that `make` gives for a point or vector, which stands instead of `to_world`.
fn placed(
    object: &mut Object,
    name: &'static str,
    to_world: DMat4,
    make: impl FnOnce(DVec3) -> DMat4,
    report: &mut Report,
) -> DMat4 {
    let Some(given) = object.point(name, report) else { return to_world };
    if object.has("to_world") {
        report.errors.push(SceneError::at(given.span, format!("\"{name}\" cannot stand beside \"to_world\"")));
    }
    if name == "direction" && given.value.try_normalize().is_none() {
        report.errors.push(SceneError::at(given.span, "the direction is zero"));
    }
    make(given.value)
}

/// Turns +z into this direction.
pub(crate) fn facing(direction: DVec3) -> DMat4 {
    direction.try_normalize().map_or(DMat4::IDENTITY, |d| DMat4::from_quat(DQuat::from_rotation_arc(DVec3::Z, d)))
}

fn spot(object: &mut Object, report: &mut Report) -> LightKind {
    let angle = |a: f64| a > 0.0 && a <= 180.0;
    let cutoff =
        object.float("cutoff_angle", angle, "greater than 0 and at most 180", report).map_or(20.0, |a| a.value);
    let beam = object.float("beam_width", |a| a >= 0.0 && a <= cutoff, "in [0, cutoff_angle]", report);
    object.not_yet(&["texture"], report);
    LightKind::Spot {
        intensity: object.light("intensity", report),
        cutoff,
        beam: beam.map_or(0.75 * cutoff, |a| a.value),
        falloff: SpotFalloff::LinearAngle,
    }
}
