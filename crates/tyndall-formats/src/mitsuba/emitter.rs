//! `<emitter>`: `area` and `directionalarea` inside a shape; `point`, `spot`, `projector`, `directional`, `constant` and
//! `envmap` on their own.
//!
//! An area light emits on the side that the normal points to. A spot is full up to `beam_width` (three quarters of
//! `cutoff_angle` if not given) and fades linearly in the angle. An environment map is seen by longitude and latitude.
//!
//! Mitsuba's light that goes straight ahead (`directionalarea`) is found by its particle tracer only; here by all integrators.
//!
//! The `id` of an emitter is what layers of light call it.
//!
//! A texture as light is white light times the texture, as a number is.

use glam::{DMat4, DQuat, DVec3};

use super::camera::field_of_view;
use super::object::{Object, Report};
use super::scene::Builder;
use super::texture::Answer;
use super::tree::Element;
use super::words;
use crate::desc::{
    AreaLightDesc, EmissionDesc, EnvironmentMapping, Evenness, LightDesc, LightKind, Magnitude, SpectrumDesc,
    SpotFalloff, Spread, Varying,
};
use crate::error::SceneError;
use crate::source::Spanned;

const CHOSEN: &str = "how often each light is sampled is chosen by what it gives";

impl<'t> Builder<'t> {
    /// An emitter inside a shape.
    pub(super) fn area_light(&mut self, element: &'t Element) -> Option<AreaLightDesc> {
        let plugin = words::plugin(element, &mut self.report)?;
        let spread = match plugin {
            "area" => Spread::Diffuse,
            "directionalarea" => Spread::Straight,
            _ => {
                let message = format!("the emitter \"{plugin}\" cannot stand inside a shape");
                let error = SceneError::at(element.span_of("type"), message).help("\"area\" can");
                self.report.errors.push(error);
                return None;
            }
        };
        let mut object = self.object(element);
        let (radiance, pattern) = self.textured_light(&mut object, "radiance");
        object.ignore(&["sampling_weight"], CHOSEN, &mut self.report);
        object.finish(&mut self.report);
        let (span, name) = (element.span, element.id());
        Some(AreaLightDesc { span, radiance, pattern, power: None, two_sided: false, spread, name })
    }

    /// Light of this name; or white light, and the texture that stands there.
    fn textured_light(
        &mut self,
        object: &mut Object<'t>,
        name: &'static str,
    ) -> (EmissionDesc, Option<Spanned<Varying>>) {
        let Some(child) = object.object_of(name, "texture") else {
            return (object.light(name, &mut self.report), None);
        };
        let texture =
            self.texture(child.element, Answer::Colour).map(|id| Spanned::new(Varying::Texture(id), child.at.span));
        let spectrum = Spanned::new(SpectrumDesc::Rgb([1.0; 3]), child.at.span);
        (EmissionDesc { spectrum, scale: 1.0, magnitude: Magnitude::AsWritten }, texture)
    }

    /// An emitter on its own.
    pub(super) fn light(&mut self, element: &'t Element) -> Option<LightDesc> {
        let plugin = words::plugin(element, &mut self.report)?;
        let mut object = self.object(element);
        let medium = object.only("medium", &mut self.report);
        let medium = medium.and_then(|m| Some(Spanned::new(self.medium_id(m.element)?, m.at.span)));
        let mut to_world = object.transform(&mut self.report);
        let in_front = if plugin == "spot" { self.slide(&mut object) } else { None };
        let projected = (plugin == "projector").then(|| self.textured_light(&mut object, "irradiance"));
        let report = &mut self.report;
        let kind = match plugin {
            "point" => {
                to_world = placed(&mut object, "position", to_world, DMat4::from_translation, report);
                LightKind::Point { intensity: object.light("intensity", report) }
            }
            "spot" => spot(&mut object, in_front, report),
            "projector" => {
                // Its picture has x to the left and v downwards.
                to_world *= DMat4::from_scale(DVec3::new(-1.0, -1.0, 1.0));
                projector(&mut object, projected?, report)
            }
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
                LightKind::Environment { path, scale: scale.map_or(1.0, |s| s.value), illuminance: None, mapping }
            }
            _ => {
                let message = format!("the emitter \"{plugin}\" stands alone");
                let error = SceneError::at(element.span_of("type"), message);
                report.errors.push(error.help("put it inside the shape that shines"));
                return None;
            }
        };
        object.ignore(&["sampling_weight"], CHOSEN, &mut self.report);
        object.finish(&mut self.report);
        Some(LightDesc { span: element.span, name: element.id(), kind, to_world, medium })
    }

    /// The texture in front of a spot.
    fn slide(&mut self, object: &mut Object<'t>) -> Option<Spanned<Varying>> {
        let child = object.object_of("texture", "texture")?;
        Some(Spanned::new(Varying::Texture(self.texture(child.element, Answer::Colour)?), child.at.span))
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

fn projector(
    object: &mut Object,
    (mut emission, slide): (EmissionDesc, Option<Spanned<Varying>>),
    report: &mut Report,
) -> LightKind {
    let scale = object.float("scale", |scale| scale >= 0.0, "at least 0", report);
    emission.scale *= scale.map_or(1.0, |s| s.value);
    let (fov, axis) = field_of_view(object, report);
    LightKind::Projector { emission, slide, fov, axis, power: None, even: Evenness::Irradiance }
}

fn spot(object: &mut Object, slide: Option<Spanned<Varying>>, report: &mut Report) -> LightKind {
    let angle = |a: f64| a > 0.0 && a <= 180.0;
    let cutoff =
        object.float("cutoff_angle", angle, "greater than 0 and at most 180", report).map_or(20.0, |a| a.value);
    let beam = object.float("beam_width", |a| a >= 0.0 && a <= cutoff, "in [0, cutoff_angle]", report);
    LightKind::Spot {
        intensity: object.light("intensity", report),
        cutoff,
        beam: beam.map_or(0.75 * cutoff, |a| a.value),
        falloff: SpotFalloff::LinearAngle,
        slide,
    }
}
