//! `LightSource` and `AreaLightSource`.
//!
//! pbrt-v4 takes of a light's spectrum its colour only: every spectrum but RGB is divided by its luminance, and `scale` is
//! what is left ([`Magnitude::UnitLuminance`]). `power` and `illuminance` are factors on that: what the light gives in all if its
//! spectrum has luminance 1, over what it would give with a radiance or intensity of 1. One that is not positive counts as
//! not given. Each face of a mesh is a light of its own, and has all of the `power`.
//!
//! tyndall's own `name` is what layers of light call it.

use std::f64::consts::PI;
use std::rc::Rc;

use glam::{DMat4, DVec3, DVec4};

use super::Reader;
use super::param::ParamType;
use super::params::Params;
use super::parser::Statement;
use crate::desc::{
    AreaLightDesc, EmissionDesc, Encoding, EnvironmentMapping, Evenness, FileRef, FovAxis, ImageDesc, LightDesc,
    LightKind, Magnitude, MappingDesc, SpectrumDesc, SpotFalloff, Spread, TextureDesc, TextureId, TextureKind, Varying,
    WrapKind,
};
use crate::error::SceneError;
use crate::source::Spanned;

const LIGHTS: [&str; 6] = ["point", "spot", "distant", "infinite", "goniometric", "projection"];

impl Reader {
    pub(super) fn light(&mut self, mut s: Statement<'_>) {
        let name = s.names[0].clone();
        if !LIGHTS.contains(&&*name.value) {
            return self.unknown_kind("light", &name, &LIGHTS, &[]);
        }
        let defaults = self.state.now.defaults.light.clone();
        let mut p = self.params("light", &mut s, &defaults);
        let made = match &*name.value {
            "point" => Some(point(&mut p)),
            "spot" => spot(&mut p),
            "distant" => distant(&mut p),
            "goniometric" => goniometric(&mut p),
            "projection" => self.projection(&mut p),
            _ => Some((infinite(&mut p), DMat4::IDENTITY)),
        };
        let name = p.name();
        self.finish_params(p);
        let Some((kind, own)) = made else { return };
        let to_world = self.state.now.ctm * own;
        if !to_world.is_finite() {
            self.errors.push(SceneError::at(s.whole, "the position of this light is too large"));
        }
        let medium = self.state.now.interface.and_then(|i| i.outside.map(|m| Spanned::new(m, i.span)));
        self.lights.push(LightDesc { span: s.whole, name, kind, to_world, medium });
    }

    pub(super) fn area_light(&mut self, mut s: Statement<'_>) {
        let name = s.names[0].clone();
        if name.value != "diffuse" {
            return self.unknown_kind("area light", &name, &["diffuse"], &[]);
        }
        let defaults = self.state.now.defaults.light.clone();
        let mut p = self.params("area light", &mut s, &defaults);
        if p.has("L") && p.has("filename") {
            let error = SceneError::at(p.span, "an area light has either \"L\" or \"filename\"");
            p.error(error.help("leave out one of them"));
        }
        let radiance = p.emission("L");
        let picture = p.file_opt("filename");
        let power = p.positive_opt("power");
        let two_sided = p.boolean("twosided", false).value;
        let name = p.name();
        self.finish_params(p);
        let pattern = picture.map(|path| self.picture(path, true));
        let spread = Spread::Diffuse;
        let light = AreaLightDesc { span: s.whole, radiance, pattern, power, two_sided, spread, name };
        self.state.now.area_light = Some(Rc::new(light));
    }

    /// A picture of light, as a texture.
    fn picture(&mut self, path: FileRef, smooth: bool) -> Spanned<Varying> {
        let span = path.span;
        let kind = TextureKind::Image(ImageDesc {
            path,
            mapping: MappingDesc::UV,
            wrap: WrapKind::Clamp,
            smooth,
            scale: 1.0,
            invert: false,
            by_luminance: false,
            encoding: Encoding::Srgb,
        });
        self.textures.list.push(TextureDesc { span, name: None, kind });
        Spanned::new(Varying::Texture(TextureId(self.textures.list.len() as u32 - 1)), span)
    }

    fn projection(&mut self, p: &mut Params) -> Option<(LightKind, DMat4)> {
        let white = SpectrumDesc::Rgb([1.0; 3]);
        let scale = p.not_negative("scale", 1.0).value;
        let emission =
            EmissionDesc { spectrum: Spanned::new(white, p.span), scale, magnitude: Magnitude::UnitLuminance };
        let power = p.positive_opt("power");
        let fov = p.float_in("fov", 90.0, "between 0 and 180 degrees", |a| a > 0.0 && a < 180.0);
        let path = needed_file(p, "projection")?;
        let slide = Some(self.picture(path, false));
        let (axis, even) = (FovAxis::Smaller, Evenness::Intensity);
        Some((LightKind::Projector { emission, slide, fov, axis, power, even }, DMat4::IDENTITY))
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

    /// A number, if it is given and positive: pbrt takes others as not given.
    fn positive_opt(&mut self, name: &'static str) -> Option<f64> {
        self.float_opt(name).map(|v| v.value).filter(|v| *v > 0.0)
    }

    /// A file, if one is named.
    fn file_opt(&mut self, name: &'static str) -> Option<FileRef> {
        let name = self.string_opt(name).filter(|name| !name.value.is_empty())?;
        Some(Spanned::new(self.resolve(&name.value), name.span))
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

fn needed_file(p: &mut Params, light: &str) -> Option<FileRef> {
    let path = p.file_opt("filename");
    if path.is_none() {
        p.error(SceneError::at(p.span, format!("a {light} light needs \"string filename\"")));
    }
    path
}

fn point(p: &mut Params) -> (LightKind, DMat4) {
    let mut intensity = p.emission("I");
    if let Some(power) = p.positive_opt("power") {
        intensity.scale *= power / (4.0 * PI);
    }
    let from = p.point("from", [0.0; 3]).value;
    (LightKind::Point { intensity }, DMat4::from_translation(from.into()))
}

fn spot(p: &mut Params) -> Option<(LightKind, DMat4)> {
    let mut intensity = p.emission("I");
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
    if let Some(power) = p.positive_opt("power") {
        // 2π ∫ share d(cos θ): the smooth step has the mean ½ between its ends.
        let [inner, outer] = [beam, cutoff.value].map(|angle| angle.to_radians().cos());
        intensity.scale *= power / (2.0 * PI * ((1.0 - inner) + (inner - outer) / 2.0));
    }
    let falloff = SpotFalloff::SmoothCosine;
    let kind = LightKind::Spot { intensity, cutoff: cutoff.value, beam, falloff, slide: None };
    Some((kind, p.aim()?))
}

fn distant(p: &mut Params) -> Option<(LightKind, DMat4)> {
    let mut irradiance = p.emission("L");
    if let Some(illuminance) = p.positive_opt("illuminance") {
        irradiance.scale *= illuminance;
    }
    Some((LightKind::Distant { irradiance }, p.aim()?))
}

fn goniometric(p: &mut Params) -> Option<(LightKind, DMat4)> {
    let (intensity, power) = (p.emission("I"), p.positive_opt("power"));
    let path = needed_file(p, "goniometric")?;
    // The middle of the picture is +y.
    let swap = DMat4::from_cols(DVec3::X.extend(0.0), DVec3::Z.extend(0.0), DVec3::Y.extend(0.0), DVec4::W);
    Some((LightKind::Goniometric { intensity, path, power }, swap))
}

fn infinite(p: &mut Params) -> LightKind {
    let span = p.span;
    if p.has("L") && p.has("filename") {
        p.error(
            SceneError::at(span, "an infinite light has either \"L\" or \"filename\"").help("leave out one of them"),
        );
    }
    let mut radiance = p.emission("L");
    let path = p.file_opt("filename");
    let illuminance = p.positive_opt("illuminance");
    if let Some(corners) = portal(p) {
        return LightKind::Portal { corners, radiance, path, illuminance };
    }
    if let Some(path) = path {
        let mapping = EnvironmentMapping::EqualAreaOctahedral;
        return LightKind::Environment { path, scale: radiance.scale, illuminance, mapping };
    }
    // Under a uniform sky E = π L.
    radiance.scale *= illuminance.map_or(1.0, |e| e / PI);
    LightKind::Constant { radiance }
}

fn portal(p: &mut Params) -> Option<Spanned<[[f64; 3]; 4]>> {
    let corners = p.tuples::<3>("portal", &[ParamType::Point3]);
    if corners.value.is_empty() {
        return None;
    }
    let four = <[[f32; 3]; 4]>::try_from(corners.value);
    let Ok(four) = four else {
        p.error(SceneError::at(corners.span, "a portal has four corners"));
        return None;
    };
    Some(Spanned::new(four.map(|corner| corner.map(f64::from)), corners.span))
}
