//! Emitters.

use glam::{DMat4, DVec3};

use super::Pen;
use super::element::Element;
use super::placed;
use super::sensor::field_of_view;
use crate::desc::{
    AreaLightDesc, EmissionDesc, EnvironmentMapping, Evenness, LightDesc, LightKind, Spanned, SpectrumDesc,
    SpotFalloff, Spread, Varying,
};
use crate::mitsuba::facing;
use crate::write::place::target;

impl Pen<'_, '_> {
    pub(super) fn light(&mut self, light: &LightDesc) -> Option<Element> {
        let mut element = match &light.kind {
            LightKind::Point { intensity } => {
                let mut element = Element::plugin("emitter", "point");
                let position = light.to_world.w_axis.truncate();
                if position != DVec3::ZERO {
                    element.push(point("position", position));
                }
                element.extend(self.light_spectrum("intensity", intensity));
                element
            }
            LightKind::Spot { intensity, cutoff, beam, falloff, slide } => {
                let mut element = Element::plugin("emitter", "spot");
                // Without a picture in front of it a spot looks the same however it is turned.
                element.extend(if slide.is_some() { placed(light.to_world) } else { aimed(light.to_world) });
                if let Some(slide) = slide {
                    element.extend(self.varying("texture", slide));
                }
                element.extend(self.light_spectrum("intensity", intensity));
                element.float_unless("cutoff_angle", *cutoff, 20.0);
                element.float_unless("beam_width", *beam, 0.75 * cutoff);
                if *falloff == SpotFalloff::SmoothCosine && beam != cutoff {
                    let message =
                        "in Mitsuba a spot fades between beam and cutoff linearly in the angle, not by a smooth step";
                    self.draft.differs(light.span, message);
                }
                element
            }
            LightKind::Distant { irradiance } => {
                let mut element = Element::plugin("emitter", "directional");
                element.push(point_along(light.to_world)?);
                element.extend(self.light_spectrum("irradiance", irradiance));
                element
            }
            LightKind::Constant { radiance } => {
                let mut element = Element::plugin("emitter", "constant");
                element.extend(self.light_spectrum("radiance", radiance));
                element
            }
            LightKind::Environment { path, scale, illuminance, mapping } => {
                let (file, factor) = match mapping {
                    EnvironmentMapping::LatitudeLongitude => (self.draft.relative(&path.value, path.span), 1.0),
                    EnvironmentMapping::EqualAreaOctahedral => {
                        self.draft.sky(light.span, path, *mapping, *illuminance)?
                    }
                };
                let mut element = Element::plugin("emitter", "envmap");
                element.extend(placed(light.to_world));
                element.string("filename", &file);
                element.float_unless("scale", scale * factor, 1.0);
                element
            }
            LightKind::Projector { emission, slide, fov, axis, power, even } => {
                if *even != Evenness::Irradiance || power.is_some() {
                    self.lacks(light.span, "pbrt's projector, whose intensity is even");
                    return None;
                }
                let mut element = Element::plugin("emitter", "projector");
                // Its picture has x to the left and v downwards.
                element.extend(placed(light.to_world * DMat4::from_scale(DVec3::new(-1.0, -1.0, 1.0))));
                element.extend(self.patterned(
                    "irradiance",
                    &EmissionDesc { scale: 1.0, ..emission.clone() },
                    slide.as_ref(),
                ));
                element.float_unless("scale", emission.scale, 1.0);
                element.extend(field_of_view(fov.value, *axis));
                element
            }
            LightKind::Goniometric { .. } => {
                self.lacks(light.span, "a point that shines by a picture of directions");
                return None;
            }
            LightKind::Portal { .. } => {
                self.lacks(light.span, "a sky behind a portal");
                return None;
            }
        };
        if let Some(medium) = light.medium {
            element.push(self.medium_ref(medium.value));
        }
        Some(self.called(element, light.name.as_deref(), light.span))
    }

    pub(super) fn area_light(&mut self, light: &AreaLightDesc) -> Element {
        if light.two_sided {
            self.lacks(light.span, "a surface that shines on both sides");
        }
        if light.power.is_some() {
            self.lacks(light.span, "a light by its power");
        }
        let word = match light.spread {
            Spread::Diffuse => "area",
            Spread::Straight => "directionalarea",
        };
        let mut element = Element::plugin("emitter", word);
        element.extend(self.patterned("radiance", &light.radiance, light.pattern.as_ref()));
        self.called(element, light.name.as_deref(), light.span)
    }

    /// Light, or a texture of it: white light times the texture.
    fn patterned(&mut self, name: &str, light: &EmissionDesc, pattern: Option<&Spanned<Varying>>) -> Option<Element> {
        let Some(pattern) = pattern else { return self.light_spectrum(name, light) };
        if light.spectrum.value != SpectrumDesc::Rgb([1.0; 3]) || light.scale != 1.0 {
            self.lacks(light.spectrum.span, "a factor on a texture of light");
        }
        self.varying(name, pattern)
    }
}

pub(super) fn point(name: &str, v: DVec3) -> Element {
    Element::new("point").with("name", name).numbers("value", &v.to_array())
}

/// `direction`, or the whole space where that would not be exact.
fn point_along(to_world: DMat4) -> Option<Element> {
    let axis = to_world.z_axis.truncate();
    let found = target(DVec3::ZERO, axis).filter(|direction| {
        let read = facing(*direction).z_axis.truncate().try_normalize();
        read.map(DVec3::as_vec3) == axis.try_normalize().map(DVec3::as_vec3)
    });
    let Some(direction) = found else { return placed(to_world) };
    Some(Element::new("vector").with("name", "direction").numbers("value", &direction.to_array()))
}

/// From where to where a spot shines, or its whole space where that would not be exact.
fn aimed(to_world: DMat4) -> Option<Element> {
    let from = to_world.w_axis.truncate();
    let Some(to) = target(from, to_world.z_axis.truncate()) else { return placed(to_world) };
    let look = Element::new("lookat").numbers("origin", &from.to_array()).numbers("target", &to.to_array());
    Some(Element::new("transform").with("name", "to_world").around(look))
}
