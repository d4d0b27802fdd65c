//! Lights that are not surfaces.

use glam::{DMat4, DVec3};
use tyndall::{
    light::{ConstantEnvironment, Distant, EnvironmentMap, Falloff, Light, PointLight, Projection, SpotLight},
    math::Vec3,
};

use super::Builder;
use crate::{
    desc::{EnvironmentMapping, LightDesc, LightKind, SpotFalloff},
    error::SceneError,
    image,
};

impl Builder<'_> {
    pub(super) fn lights(&mut self) -> Option<Vec<Light>> {
        let lights: Vec<_> = self.desc.lights.iter().map(|l| self.light(l)).collect();
        lights.into_iter().collect()
    }

    fn light(&mut self, desc: &LightDesc) -> Option<Light> {
        let position = desc.to_world.transform_point3(DVec3::ZERO).as_vec3();
        match &desc.kind {
            LightKind::Point { intensity } => {
                let intensity = self.emission(intensity)?;
                let luminance = intensity.luminance();
                Some(Light::Point(PointLight { position, intensity, luminance }))
            }
            LightKind::Spot { intensity, cutoff, beam, falloff } => {
                let intensity = self.emission(intensity)?;
                let luminance = intensity.luminance();
                Some(Light::Spot(SpotLight {
                    position,
                    axis: self.axis(desc)?,
                    intensity,
                    luminance,
                    cos_inner: beam.min(*cutoff).to_radians().cos() as f32,
                    cos_outer: cutoff.to_radians().cos() as f32,
                    falloff: match falloff {
                        SpotFalloff::SmoothCosine => Falloff::SmoothStepCosine,
                        SpotFalloff::LinearAngle => Falloff::LinearAngle,
                    },
                }))
            }
            LightKind::Distant { irradiance } => {
                let irradiance = self.emission(irradiance)?;
                let luminance = irradiance.luminance();
                Some(Light::Distant(Distant { towards: -self.axis(desc)?, irradiance, luminance }))
            }
            LightKind::Constant { radiance } => {
                let radiance = self.emission(radiance)?;
                let luminance = radiance.luminance();
                Some(Light::Constant(ConstantEnvironment { radiance, luminance }))
            }
            LightKind::Environment { path, scale, mapping } => {
                let picture = match image::read_image(&path.value) {
                    Ok(picture) => picture,
                    Err(e) => return self.fail(SceneError::at(path.span, e.to_string())),
                };
                let projection = match mapping {
                    EnvironmentMapping::EqualAreaOctahedral => Projection::EqualArea,
                    EnvironmentMapping::LatitudeLongitude => Projection::LatLong,
                };
                let to_world = self.transform(without_translation(desc.to_world), desc.span)?;
                let map = EnvironmentMap::new(
                    to_world,
                    projection,
                    picture.width,
                    picture.height,
                    &picture.pixels,
                    *scale as f32,
                );
                match map {
                    Ok(map) => Some(Light::Map(Box::new(map))),
                    Err(e) => self.fail(SceneError::at(path.span, e.to_string())),
                }
            }
        }
    }

    /// Where a light shines: the image of +z.
    fn axis(&mut self, desc: &LightDesc) -> Option<Vec3> {
        match desc.to_world.transform_vector3(DVec3::Z).try_normalize() {
            Some(axis) => Some(axis.as_vec3()),
            None => self.fail(SceneError::at(desc.span, "this light has no direction").help("from and to must differ")),
        }
    }
}

fn without_translation(m: DMat4) -> DMat4 {
    DMat4::from_mat3(glam::DMat3::from_mat4(m))
}
