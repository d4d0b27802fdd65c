//! `LightSource` and `AreaLightSource`.
//!
//! pbrt-v4 takes of a light's spectrum its colour only: every spectrum but RGB is divided by its luminance, and `scale` is
//! what is left ([`Magnitude::UnitLuminance`]).

use std::rc::Rc;

use glam::{DMat4, DVec3};

use super::Reader;
use super::params::Params;
use super::parser::Statement;
use crate::desc::{AreaLightDesc, EmissionDesc, EnvironmentMapping, LightDesc, LightKind, Magnitude, SpotFalloff};
use crate::error::SceneError;
use crate::source::Spanned;

const LIGHTS: [&str; 4] = ["point", "spot", "distant", "infinite"];
const LATER_LIGHTS: [&str; 2] = ["goniometric", "projection"];

impl Reader {
    pub(super) fn light(&mut self, mut s: Statement<'_>) {
        let name = s.names[0].clone();
        if !LIGHTS.contains(&&*name.value) {
            return self.unknown_kind("light", &name, &LIGHTS, &LATER_LIGHTS);
        }
        let defaults = self.state.now.defaults.light.clone();
        let mut p = self.params("light", &mut s, &defaults);
        let made = match &*name.value {
            "point" => Some(point(&mut p)),
            "spot" => spot(&mut p),
            "distant" => distant(&mut p),
            _ => Some((infinite(&mut p), DMat4::IDENTITY)),
        };
        self.finish_params(p);
        let Some((kind, own)) = made else { return };
        let to_world = self.state.now.ctm * own;
        if !to_world.is_finite() {
            self.errors.push(SceneError::at(s.whole, "the position of this light is too large"));
        }
        let medium = self.state.now.interface.and_then(|i| i.outside.map(|m| Spanned::new(m, i.span)));
        self.lights.push(LightDesc { span: s.whole, kind, to_world, medium });
    }

    pub(super) fn area_light(&mut self, mut s: Statement<'_>) {
        let name = s.names[0].clone();
        if name.value != "diffuse" {
            return self.unknown_kind("area light", &name, &["diffuse"], &[]);
        }
        let defaults = self.state.now.defaults.light.clone();
        let mut p = self.params("area light", &mut s, &defaults);
        p.later("filename");
        p.later("power");
        let radiance = p.emission("L");
        let two_sided = p.boolean("twosided", false).value;
        self.finish_params(p);
        self.state.now.area_light = Some(Rc::new(AreaLightDesc { span: s.whole, radiance, two_sided }));
    }
}

impl Params {
    /// A spectrum of light, by default white, and the parameter `scale`.
    fn emission(&mut self, name: &'static str) -> EmissionDesc {
        let spectrum = self.light(name);
        let scale = self.not_negative("scale", 1.0).value;
        EmissionDesc { spectrum, scale, magnitude: Magnitude::UnitLuminance }
    }

    /// A spectrum of light, if given, and its own factor.
    pub(super) fn emission_opt(&mut self, name: &'static str, scale: &'static str) -> Option<EmissionDesc> {
        let scale = self.not_negative(scale, 1.0).value;
        let spectrum = self.light_opt(name)?;
        Some(EmissionDesc { spectrum, scale, magnitude: Magnitude::UnitLuminance })
    }

    /// The space of a light at `from` that shines towards `to`.
    fn aim(&mut self) -> Option<DMat4> {
        let from = self.point("from", [0.0; 3]);
        let to = self.point("to", [0.0, 0.0, 1.0]);
        let origin = DVec3::from(from.value);
        let Some(z) = (DVec3::from(to.value) - origin).try_normalize() else {
            self.error(SceneError::at(to.span, "a light cannot shine from a point to the same point"));
            return None;
        };
        let (x, y) = z.any_orthonormal_pair();
        Some(DMat4::from_cols(x.extend(0.0), y.extend(0.0), z.extend(0.0), origin.extend(1.0)))
    }
}

fn point(p: &mut Params) -> (LightKind, DMat4) {
    p.later("power");
    let intensity = p.emission("I");
    let from = p.point("from", [0.0; 3]).value;
    (LightKind::Point { intensity }, DMat4::from_translation(from.into()))
}

fn spot(p: &mut Params) -> Option<(LightKind, DMat4)> {
    p.later("power");
    let intensity = p.emission("I");
    let cutoff = p.float_in("coneangle", 30.0, "between 0 and 180 degrees", |a| a > 0.0 && a < 180.0);
    let delta = p.not_negative("conedeltaangle", 5.0);
    let beam = cutoff.value - delta.value;
    if beam < 0.0 {
        // pbrt-v4 then takes the cosine of a negative angle, and can light the outside of the cone.
        p.error(
            SceneError::at(cutoff.span, "\"conedeltaangle\" must not be more than \"coneangle\"")
                .help("without \"conedeltaangle\" it is 5 degrees"),
        );
    }
    let kind = LightKind::Spot { intensity, cutoff: cutoff.value, beam, falloff: SpotFalloff::SmoothCosine };
    Some((kind, p.aim()?))
}

fn distant(p: &mut Params) -> Option<(LightKind, DMat4)> {
    p.later("illuminance");
    let irradiance = p.emission("L");
    Some((LightKind::Distant { irradiance }, p.aim()?))
}

fn infinite(p: &mut Params) -> LightKind {
    p.later("illuminance");
    p.later("portal");
    if !p.has("filename") {
        return LightKind::Constant { radiance: p.emission("L") };
    }
    if p.has("L") {
        p.error(
            SceneError::at(p.span, "an infinite light has either \"L\" or \"filename\"").help("leave out one of them"),
        );
    }
    let EmissionDesc { scale, .. } = p.emission("L");
    let name = p.string_opt("filename").unwrap_or(Spanned::new(String::new(), p.span));
    let path = name.map(|name| p.resolve(&name));
    LightKind::Environment { path, scale, mapping: EnvironmentMapping::EqualAreaOctahedral }
}
