//! Lights that are not surfaces.

use std::f64::consts::PI;

use glam::{DMat4, DVec3, DVec4};
use tyndall::{
    light::{
        ConstantEnvironment, Distant, EnvironmentMap, Even, Falloff, Goniometric, Light, PointLight, Portal,
        Projection, Projector, SkyImage, Slide, SpotLight,
    },
    math::{Vec2, Vec3},
    texture::Texture,
};

use super::{Builder, spectra::Measure};
use crate::{
    desc::{
        EmissionDesc, EnvironmentMapping, Evenness, FileRef, FovAxis, FrameDesc, LightDesc, LightKind, SpotFalloff,
        Varying,
    },
    error::SceneError,
    image::{self, Image},
    source::Spanned,
};

/// The most points a side by which the light of a slide is summed up.
const FINEST: u32 = 1024;

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
            LightKind::Spot { intensity, cutoff, beam, falloff, slide } => {
                let intensity = self.emission(intensity)?;
                let luminance = intensity.luminance();
                let slide = match slide {
                    None => None,
                    Some(slide) => {
                        let half = Vec2::splat(cutoff.to_radians().tan() as f32);
                        Some(Box::new(self.slide(desc, half, Some(slide))?))
                    }
                };
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
                    slide,
                }))
            }
            LightKind::Goniometric { intensity, path, power } => self.goniometric(desc, intensity, path, *power),
            LightKind::Projector { emission, slide, fov, axis, power, even } => {
                self.projector(desc, (emission, *even, *power), slide.as_ref(), (fov.value, *axis))
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
            LightKind::Environment { path, scale, illuminance, mapping } => {
                let picture = self.light_picture(path)?;
                let projection = match mapping {
                    EnvironmentMapping::EqualAreaOctahedral => Projection::EqualArea,
                    EnvironmentMapping::LatitudeLongitude => Projection::LatLong,
                };
                let to_world = self.transform(without_translation(desc.to_world), desc.span)?;
                let scale = (scale * for_illuminance(&picture, *illuminance)) as f32;
                let Image { width, height, pixels } = &picture;
                match EnvironmentMap::new(to_world, projection, *width, *height, pixels, scale) {
                    Ok(map) => Some(Light::Map(Box::new(map))),
                    Err(e) => self.fail(SceneError::at(path.span, e.to_string())),
                }
            }
            LightKind::Portal { corners, radiance, path, illuminance } => {
                self.portal(desc, corners, (radiance, path.as_ref(), *illuminance))
            }
        }
    }

    /// A picture of light.
    fn light_picture(&mut self, path: &FileRef) -> Option<Image> {
        match image::read_image(&path.value) {
            Ok(picture) => Some(picture),
            Err(e) => self.fail(SceneError::at(path.span, e.to_string())),
        }
    }

    fn goniometric(
        &mut self,
        desc: &LightDesc,
        intensity: &EmissionDesc,
        path: &FileRef,
        power: Option<f64>,
    ) -> Option<Light> {
        let picture = self.light_picture(path)?;
        if picture.width != picture.height {
            let message = "the picture of a goniometric light is square: all directions, equal-area octahedral";
            return self.fail(SceneError::at(path.span, message));
        }
        let shares: Vec<f32> = picture.pixels.iter().map(|p| p.iter().sum::<f32>() / 3.0).collect();
        let mean = Goniometric::mean_share(&shares);
        if mean <= 0.0 {
            return self.fail(SceneError::at(path.span, "the picture is black").help("leave out the light"));
        }
        let factor = power.map_or(1.0, |power| power / (4.0 * PI * mean));
        let intensity = self.emission(intensity)?.scaled(factor as f32);
        let to_world = self.transform(desc.to_world, desc.span)?;
        let luminance = intensity.luminance();
        Some(Light::Goniometric(Box::new(Goniometric { to_world, intensity, luminance, side: picture.width, shares })))
    }

    /// A picture before a light, of half sides `half` at distance 1; clear without one.
    fn slide(&mut self, desc: &LightDesc, half: Vec2, texture: Option<&Spanned<Varying>>) -> Option<Slide> {
        let texture = match texture {
            None => Texture::from(1.0),
            Some(texture) => self.texture(texture, Measure::Coefficient)?,
        };
        let columns = [desc.to_world.x_axis, desc.to_world.y_axis, desc.to_world.z_axis];
        let rigid = columns.map(DVec4::normalize_or_zero);
        let to_world = DMat4::from_cols(rigid[0], rigid[1], rigid[2], desc.to_world.w_axis);
        Some(Slide { to_world: self.transform(to_world, desc.span)?, half, texture })
    }

    fn projector(
        &mut self,
        desc: &LightDesc,
        (emission, even, power): (&EmissionDesc, Evenness, Option<f64>),
        texture: Option<&Spanned<Varying>>,
        (fov, axis): (f64, FovAxis),
    ) -> Option<Light> {
        let columns = [desc.to_world.x_axis, desc.to_world.y_axis, desc.to_world.z_axis].map(DVec4::truncate);
        let square = (0..3).all(|i| {
            let (a, b) = (columns[i], columns[(i + 1) % 3]);
            a.dot(b).abs() <= 1e-3 * a.length() * b.length() && (a.length() - b.length()).abs() <= 1e-3 * a.length()
        });
        if !square || (even == Evenness::Irradiance && (columns[0].length() - 1.0).abs() > 1e-3) {
            return self.fail(SceneError::at(desc.span, "the transform of a projector cannot scale or shear"));
        }
        let size = self.picture_size(texture);
        let window = FrameDesc::of_film(axis).window((fov.to_radians() / 2.0).tan(), size[0], size[1]);
        let half = Vec2::new(window.right as f32, window.top as f32);
        let slide = self.slide(desc, half, texture)?;
        let (even, on_axis) = match even {
            Evenness::Intensity => (Even::Intensity, 1.0),
            Evenness::Irradiance => (Even::Irradiance, PI),
        };
        let grid = size.map(|side| side.clamp(16, FINEST));
        let power_of_unit = |slide: &Slide| {
            let share = |cos: f64| f64::from(even.share(cos as f32)) * cos.powi(3);
            let white = tyndall::spectrum::Spectrum::illuminant_rgb([1.0; 3]);
            f64::from(slide.area()) * slide.mean_luminance(&white, grid, share)
        };
        let factor = match power.map(|power| power / power_of_unit(&slide)) {
            None => on_axis,
            Some(factor) if factor.is_finite() => factor,
            Some(_) => return self.fail(SceneError::at(desc.span, "a black slide has no power").help("leave it out")),
        };
        let intensity = self.emission(emission)?.scaled(factor as f32);
        let luminance = slide.mean_luminance(&intensity, grid.map(|side| side.min(64)), |_| 1.0) as f32;
        Some(Light::Projector(Box::new(Projector {
            position: desc.to_world.transform_point3(DVec3::ZERO).as_vec3(),
            slide,
            intensity,
            even,
            luminance: luminance.max(f32::MIN_POSITIVE),
        })))
    }

    fn portal(
        &mut self,
        desc: &LightDesc,
        corners: &Spanned<[[f64; 3]; 4]>,
        (radiance, path, illuminance): (&EmissionDesc, Option<&FileRef>, Option<f64>),
    ) -> Option<Light> {
        let (picture, factor) = if let Some(path) = path {
            let picture = self.light_picture(path)?;
            if picture.width != picture.height {
                return self.fail(SceneError::at(path.span, "the picture of a sky behind a portal is square"));
            }
            (picture, radiance.scale)
        } else {
            (Image { width: 1, height: 1, pixels: vec![self.emission(radiance)?.rgb()] }, 1.0)
        };
        let scale = factor * for_illuminance(&picture, illuminance);
        let to_world = self.transform(without_translation(desc.to_world), desc.span)?;
        let points = corners.value.map(|corner| Vec3::from_array(corner.map(|v| v as f32)));
        let sky = SkyImage::new(picture.width, picture.height, &picture.pixels, scale as f32);
        match sky.map_err(Into::into).and_then(|sky| Portal::new(points, &to_world, &sky)) {
            Ok(portal) => Some(Light::Portal(Box::new(portal))),
            Err(e) => self.fail(SceneError::at(corners.span, e.to_string())),
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

/// The factor that gives the map the illuminance that is asked for, of which pbrt reckons that of an even sky of radiance L
/// to be π L / 2 (it takes the solid angle of the hemisphere for that of the sphere): its pictures are made by it. What is
/// sought is the middle of the picture, +z.
pub(crate) fn for_illuminance(picture: &Image, illuminance: Option<f64>) -> f64 {
    let Some(illuminance) = illuminance else { return 1.0 };
    let (width, height) = (picture.width as usize, picture.height as usize);
    let mut sum = 0.0;
    for (i, pixel) in picture.pixels.iter().enumerate() {
        let [x, y] = [(i % width, width), (i / width, height)].map(|(i, n)| (i as f32 + 0.5) / n as f32);
        let cos = Projection::EqualArea.direction(Vec2::new(x, y)).z;
        sum += f64::from(tyndall::spectrum::srgb::luminance(*pixel)) * f64::from(cos.max(0.0));
    }
    let reckoned = sum * 2.0 * PI / (width * height) as f64;
    if reckoned > 0.0 { illuminance / reckoned } else { 1.0 }
}
