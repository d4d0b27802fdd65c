//! Lights.

use glam::{DMat4, DVec3};

use super::Pen;
use super::entity::Entity;
use crate::desc::{AreaLightDesc, EnvironmentMapping, LightDesc, LightKind, SpotFalloff};
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
        let mut aim = Aim::Nowhere;
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
            LightKind::Spot { intensity, cutoff, beam, falloff } => {
                let mut entity = Entity::new("LightSource", &["spot"]);
                self.emission(&mut entity, "I", "scale", intensity);
                aim = self.aim(&mut entity, light);
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
                aim = self.aim(&mut entity, light);
                entity
            }
            LightKind::Constant { radiance } => {
                let mut entity = Entity::new("LightSource", &["infinite"]);
                self.emission(&mut entity, "L", "scale", radiance);
                entity
            }
            LightKind::Environment { path, scale, mapping } => {
                if *mapping == EnvironmentMapping::LatitudeLongitude {
                    let what =
                        "an environment by longitude and latitude (its `imgtool makeequiarea` turns the picture)";
                    return self.lacks(light.span, what);
                }
                let mut entity = Entity::new("LightSource", &["infinite"]);
                let file = self.draft.relative(&path.value, path.span);
                entity.string("filename", &file);
                entity.float_unless("scale", *scale, 1.0);
                aim = Aim::Space(light.to_world);
                entity
            }
        };
        let space = match aim {
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

    /// `from` and `to` of a light along the +z of its space, or that space if they would not be exact.
    fn aim(&mut self, entity: &mut Entity, light: &LightDesc) -> Aim {
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

    pub(super) fn area_light(&mut self, light: &AreaLightDesc) {
        let mut entity = Entity::new("AreaLightSource", &["diffuse"]);
        self.emission(&mut entity, "L", "scale", &light.radiance);
        if light.two_sided {
            entity.boolean("twosided", true);
        }
        self.entity(entity);
    }
}

/// The space that is left to be said.
enum Aim {
    /// None.
    Nowhere,
    /// This one.
    Space(DMat4),
}
