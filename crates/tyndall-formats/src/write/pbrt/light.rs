//! Lights.

use glam::{DMat4, DVec3, DVec4};

use super::Pen;
use super::entity::Entity;
use crate::desc::{
    AreaLightDesc, EnvironmentMapping, Evenness, FovAxis, LightDesc, LightKind, MappingDesc, Spanned, SpotFalloff,
    Spread, TextureKind, Varying, WrapKind,
};
use crate::write::number::shortest;
use crate::write::place::target;

impl Pen<'_, '_> {
    pub(super) fn lights(&mut self) {
        let desc = self.draft.desc;
        for light in &desc.lights {
            self.light(light);
        }
        self.sheet.gap();
    }

    fn light(&mut self, light: &LightDesc) {
        let Some((mut entity, space)) = self.light_kind(light) else { return };
        self.name(&mut entity, light.name.as_deref());
        let space = match space {
            Aim::Space(m) if m != DMat4::IDENTITY => Some(m),
            _ => None,
        };
        let medium = light.medium.map(|medium| medium.value);
        let in_a_block = space.is_some() || medium.is_some();
        if in_a_block {
            self.open();
        }
        if let Some(medium) = medium {
            self.interface(None, Some(medium));
        }
        if let Some(space) = space {
            self.place(space);
        }
        self.entity(entity);
        if in_a_block {
            self.close();
        }
    }

    /// The light, and the space that it needs.
    fn light_kind(&mut self, light: &LightDesc) -> Option<(Entity, Aim)> {
        let mut space = Aim::Nowhere;
        let entity = match &light.kind {
            LightKind::Point { intensity } => {
                let mut entity = Entity::new("LightSource", &["point"]);
                self.emission(&mut entity, "I", "scale", intensity);
                let from = light.to_world.w_axis.truncate();
                if from != DVec3::ZERO {
                    entity.list("point3", "from", &from.to_array());
                }
                entity
            }
            LightKind::Spot { intensity, cutoff, beam, falloff, slide } => {
                if let Some(slide) = slide {
                    self.lacks(slide.span, "a picture in front of a spot");
                }
                let mut entity = Entity::new("LightSource", &["spot"]);
                self.emission(&mut entity, "I", "scale", intensity);
                space = aim(&mut entity, light);
                entity.float_unless("coneangle", *cutoff, 30.0);
                let delta = shortest(cutoff - beam, |delta| cutoff - delta == *beam);
                entity.float_unless("conedeltaangle", delta, 5.0);
                if *falloff == SpotFalloff::LinearAngle && beam != cutoff {
                    let message =
                        "in pbrt a spot fades between beam and cutoff by a smooth step, not linearly in the angle";
                    self.draft.differs(light.span, message);
                }
                entity
            }
            LightKind::Distant { irradiance } => {
                let mut entity = Entity::new("LightSource", &["distant"]);
                self.emission(&mut entity, "L", "scale", irradiance);
                space = aim(&mut entity, light);
                entity
            }
            LightKind::Constant { radiance } => {
                let mut entity = Entity::new("LightSource", &["infinite"]);
                self.emission(&mut entity, "L", "scale", radiance);
                entity
            }
            LightKind::Environment { path, scale, illuminance, mapping } => {
                let file = match mapping {
                    EnvironmentMapping::EqualAreaOctahedral => self.draft.relative(&path.value, path.span),
                    EnvironmentMapping::LatitudeLongitude => self.draft.sky(light.span, path, *mapping, None)?.0,
                };
                let mut entity = Entity::new("LightSource", &["infinite"]);
                entity.string("filename", &file);
                entity.float_unless("scale", *scale, 1.0);
                entity.float_if("illuminance", *illuminance);
                space = Aim::Space(light.to_world);
                entity
            }
            LightKind::Goniometric { intensity, path, power } => {
                let mut entity = Entity::new("LightSource", &["goniometric"]);
                self.emission(&mut entity, "I", "scale", intensity);
                let file = self.draft.relative(&path.value, path.span);
                entity.string("filename", &file);
                entity.float_if("power", *power);
                // The middle of the picture is +y.
                let swap = DMat4::from_cols(DVec4::X, DVec4::Z, DVec4::Y, DVec4::W);
                space = Aim::Space(light.to_world * swap);
                entity
            }
            LightKind::Projector { emission, slide, fov, axis, power, even } => {
                if *even != Evenness::Intensity || *axis != FovAxis::Smaller {
                    self.lacks(light.span, "Mitsuba's projector, which lights a wall evenly");
                    return None;
                }
                let mut entity = Entity::new("LightSource", &["projection"]);
                self.emission(&mut entity, "I", "scale", emission);
                match slide {
                    Some(slide) => self.picture(&mut entity, slide),
                    None => self.lacks(light.span, "a projector without a picture"),
                }
                entity.float_unless("fov", fov.value, 90.0);
                entity.float_if("power", *power);
                space = Aim::Space(light.to_world);
                entity
            }
            LightKind::Portal { corners, radiance, path, illuminance } => {
                let mut entity = Entity::new("LightSource", &["infinite"]);
                self.emission(&mut entity, "L", "scale", radiance);
                if let Some(path) = path {
                    let file = self.draft.relative(&path.value, path.span);
                    entity.string("filename", &file);
                }
                entity.float_if("illuminance", *illuminance);
                entity.list("point3", "portal", corners.value.as_flattened());
                space = Aim::Space(light.to_world);
                entity
            }
        };
        Some((entity, space))
    }

    /// A picture of light, which pbrt takes as it is.
    fn picture(&mut self, entity: &mut Entity, picture: &Spanned<Varying>) {
        let desc = self.draft.desc;
        let texture = if let Varying::Texture(id) = picture.value { desc.texture(id) } else { None };
        match texture.map(|texture| &texture.kind) {
            Some(TextureKind::Image(image)) if image.mapping == MappingDesc::UV && image.wrap == WrapKind::Clamp => {
                let file = self.draft.relative(&image.path.value, image.path.span);
                entity.string("filename", &file);
            }
            _ => self.lacks(picture.span, "light by a texture that is no picture as it is"),
        }
    }

    pub(super) fn area_light(&mut self, light: &AreaLightDesc) {
        let mut entity = Entity::new("AreaLightSource", &["diffuse"]);
        self.emission(&mut entity, "L", "scale", &light.radiance);
        if let Some(pattern) = &light.pattern {
            self.picture(&mut entity, pattern);
        }
        entity.float_if("power", light.power);
        if light.spread == Spread::Straight {
            self.lacks(light.span, "a surface that shines straight ahead only");
        }
        if light.two_sided {
            entity.boolean("twosided", true);
        }
        self.name(&mut entity, light.name.as_deref());
        self.entity(entity);
    }
}

/// `from` and `to` of a light along the +z of its space, or that space if they would not be exact.
fn aim(entity: &mut Entity, light: &LightDesc) -> Aim {
    let is_distant = matches!(light.kind, LightKind::Distant { .. });
    let from = if is_distant { DVec3::ZERO } else { light.to_world.w_axis.truncate() };
    let Some(to) = target(from, light.to_world.z_axis.truncate()) else { return Aim::Space(light.to_world) };
    if from != DVec3::ZERO {
        entity.list("point3", "from", &from.to_array());
    }
    if to != DVec3::Z {
        entity.list("point3", "to", &to.to_array());
    }
    Aim::Nowhere
}

/// The space that is left to be said.
enum Aim {
    /// None.
    Nowhere,
    /// This one.
    Space(DMat4),
}
