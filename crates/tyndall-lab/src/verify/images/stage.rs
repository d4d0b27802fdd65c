//! A small world in the making: +z is up, the camera looks from a place at another through pixels as narrow as a ray.

use glam::{DMat4, DVec3};
use tyndall::{
    bsdf::Sides,
    camera::{Batch, Camera, CameraModel, Orthographic, Perspective, View},
    film::Filter,
    light::{
        AreaLight, ConstantEnvironment, Distant, EmitterShape, EnvironmentMap, Light, LightId, LightTable, PointLight,
        Projection,
    },
    material::{HairColour, HairTextures, Index, Material, Roughness},
    math::{Transform, Vec3},
    medium::{Homogeneous, MediumId, MediumInterface},
    phase::{Isotropic, Phase},
    scene::{Emission, MaterialId, Object, Scene},
    shape::{Basis, Curves, Disk, GeometryBuilder, Knot, Mesh, Sphere, Style},
    spectrum::{ColorMode, Spectrum},
};

use super::{Made, SIDE};
use crate::world::Substance;

/// How wide planes without an end are [length].
pub(super) const WIDE: f32 = 1e5;

/// A world.
pub(super) struct Stage {
    model: CameraModel,
    to_world: Transform,
    builder: GeometryBuilder,
    objects: Vec<Object>,
    materials: Vec<Material>,
    media: Vec<Homogeneous>,
    lights: Vec<Light>,
}

/// Lambertian.
pub(super) fn diffuse(reflectance: f64) -> Material {
    Material::Diffuse { reflectance: (reflectance as f32).into(), sides: Sides::Both }
}

/// A polished boundary; none at all at the same index.
pub(super) fn glass(eta: f64) -> Material {
    if eta == 1.0 {
        return Material::Null;
    }
    Material::Dielectric {
        eta: Index::Constant(eta as f32),
        alpha: Roughness::constant([0.0; 2]),
        reflection_tint: 1.0.into(),
        transmission_tint: 1.0.into(),
    }
}

/// Looking from `eye` at `target`.
fn looking(eye: Vec3, target: Vec3) -> Transform {
    let forward = (target - eye).normalize();
    let side = if forward.y.abs() > 0.9 { Vec3::X } else { Vec3::Y };
    let x = side.cross(forward).normalize();
    let columns = [x, forward.cross(x), forward].map(|axis| axis.as_dvec3().extend(0.0));
    let [x, y, z] = columns;
    Transform::new(DMat4::from_cols(x, y, z, eye.as_dvec3().extend(1.0))).unwrap_or(Transform::IDENTITY)
}

impl Stage {
    /// Looked at along one ray.
    pub(super) fn seen(eye: Vec3, target: Vec3) -> Self {
        let model = CameraModel::Perspective(Perspective::pinhole([-1e-5, 1e-5, -1e-5, 1e-5]));
        Self::by(model, looking(eye, target))
    }

    /// Looked at along rays side by side, one for each pair of places.
    pub(super) fn seen_by_many(rays: impl Iterator<Item = [Vec3; 2]>) -> Self {
        let model = || CameraModel::Perspective(Perspective::pinhole([-1e-5, 1e-5, -1e-5, 1e-5]));
        let views =
            rays.map(|[eye, target]| View { to_world: looking(eye, target), model: model(), near: 0.0 }).collect();
        Self::by(CameraModel::Batch(Batch { views }), Transform::IDENTITY)
    }

    /// Looked at from above, a square of half the given width around the origin.
    pub(super) fn from_above(half: f32) -> Self {
        let model = CameraModel::Orthographic(Orthographic { window: [-half, half, -half, half] });
        Self::by(model, looking(Vec3::Z * (4.0 * half), Vec3::ZERO))
    }

    /// With a fibre of radius 1 and of the table's index, that absorbs so much [1/radius], seen at an angle to its normal plane
    /// [rad] over all of its width.
    pub(super) fn along_a_fibre(angle: f64, sigma_a: f64) -> Made<Self> {
        const SHORT: f32 = 1e-3;
        let model = CameraModel::Orthographic(Orthographic { window: [-1.0, 1.0, -SHORT, SHORT] });
        let eye = DVec3::new(0.0, angle.sin(), angle.cos()).as_vec3() * 4.0;
        let mut stage = Self::by(model, looking(eye, Vec3::ZERO));
        let mut fibre = Curves::new(Style::Round);
        fibre.push(Basis::Linear, &[-1.0, 1.0].map(|end| Knot { p: Vec3::Y * (end * 50.0), radius: 1.0 }));
        stage.builder.add_curves(fibre, &Transform::IDENTITY)?;
        let hair = HairTextures {
            colour: HairColour::SigmaA((sigma_a as f32).into()),
            eta: 1.55.into(),
            beta_m: 0.3.into(),
            beta_n: 0.3.into(),
            alpha: 2.0.into(),
        };
        stage.object(Material::Hair(Box::new(hair)), None);
        Ok(stage)
    }

    fn by(model: CameraModel, to_world: Transform) -> Self {
        let (builder, objects, materials) = (GeometryBuilder::new(), Vec::new(), Vec::new());
        Self { model, to_world, builder, objects, materials, media: Vec::new(), lights: Vec::new() }
    }

    fn object(&mut self, material: Material, interface: Option<MediumInterface>) {
        let id = MaterialId(self.materials.len() as u32);
        self.materials.push(material);
        let emission = Emission::None;
        self.objects.push(Object {
            name: String::new(),
            material: id,
            interface,
            emission,
            body: None,
            granular: None,
        });
    }

    /// A medium that glows with a radiance.
    fn medium(&mut self, substance: &Substance, glow: f64) -> Made<Option<MediumId>> {
        substance.check()?;
        if substance.sigma_t() == 0.0 {
            return Ok(None);
        }
        let [sigma_a, sigma_s] = [substance.sigma_a, substance.sigma_s].map(|s| Spectrum::constant(s as f32));
        let phase = match substance.g {
            0.0 => Phase::Isotropic(Isotropic),
            g => Phase::henyey_greenstein(g as f32)?,
        };
        let emission = (glow > 0.0).then(|| Spectrum::illuminant_rgb([glow as f32; 3]));
        self.media.push(Homogeneous { sigma_a, sigma_s, emission, phase });
        Ok(Some(MediumId(self.media.len() as u32 - 1)))
    }

    /// A ball around the origin, of a substance that glows with a radiance, behind a boundary of its index.
    pub(super) fn ball(&mut self, radius: f32, substance: &Substance, glow: f64) -> Made<()> {
        let inside = self.medium(substance, glow)?;
        self.object(glass(substance.n), Some(MediumInterface { inside, outside: None }));
        self.builder.add_sphere(Sphere::new(Vec3::ZERO, radius), &Transform::IDENTITY, false)?;
        Ok(())
    }

    /// Two faces of a slab, at z = 0 and z = −`thickness`; without the lower one if that is infinite.
    pub(super) fn slab(&mut self, thickness: f64, substance: &Substance, glow: f64) -> Made<()> {
        let inside = self.medium(substance, glow)?;
        self.object(glass(substance.n), Some(MediumInterface { inside, outside: None }));
        self.builder.add_disk(Disk::new(0.0, WIDE, 0.0), &Transform::IDENTITY, false)?;
        if thickness.is_finite() {
            self.object(glass(substance.n), Some(MediumInterface { inside, outside: None }));
            // It faces down: the slab is behind it too.
            self.builder.add_disk(Disk::new(-thickness as f32, WIDE, 0.0), &Transform::IDENTITY, true)?;
        }
        Ok(())
    }

    /// A ball without a medium.
    pub(super) fn solid_ball(&mut self, centre: Vec3, radius: f32, material: Material) -> Made<()> {
        self.object(material, None);
        self.builder.add_sphere(Sphere::new(centre, radius), &Transform::IDENTITY, false)?;
        Ok(())
    }

    /// A ball that shines with 1, inwards or outwards.
    pub(super) fn shining_ball(&mut self, centre: Vec3, radius: f32, material: Material, inward: bool) -> Made<()> {
        self.object(material, None);
        self.builder.add_sphere(Sphere::new(centre, radius), &Transform::IDENTITY, inward)?;
        self.shine(EmitterShape::Sphere { centre, radius, inward });
        Ok(())
    }

    /// A floor at a height, that does not shine.
    pub(super) fn floor(&mut self, z: f32, radius: f32, material: Material) -> Made<()> {
        self.object(material, None);
        self.builder.add_disk(Disk::new(z, radius, 0.0), &Transform::IDENTITY, false)?;
        Ok(())
    }

    /// A disk at a height over the origin that shines downwards with 1.
    pub(super) fn lamp(&mut self, z: f32, radius: f32, material: Material) -> Made<()> {
        self.object(material, None);
        self.builder.add_disk(Disk::new(z, radius, 0.0), &Transform::IDENTITY, true)?;
        self.shine(EmitterShape::Disk { centre: Vec3::Z * z, ng: -Vec3::Z, radius, inner: 0.0 });
        Ok(())
    }

    /// A black rectangle at a height, from a corner with these sides along x and y, that shines downwards with 1.
    pub(super) fn panel(&mut self, corner: Vec3, sides: [f32; 2]) -> Made<()> {
        let (e1, e2) = (Vec3::Y * sides[1], Vec3::X * sides[0]);
        let positions = vec![corner, corner + e1, corner + e1 + e2, corner + e2];
        let indices = vec![[0, 1, 2], [0, 2, 3]];
        let mesh = Mesh { positions, indices, normals: Vec::new(), uvs: Vec::new(), reversed: false };
        self.object(diffuse(0.0), None);
        self.builder.add_mesh(mesh, &Transform::IDENTITY, false)?;
        self.shine(EmitterShape::Parallelogram { a: corner, e1, e2, ng: -Vec3::Z });
        Ok(())
    }

    fn shine(&mut self, shape: EmitterShape) {
        if let Some(object) = self.objects.last_mut() {
            object.emission = Emission::Whole(LightId(self.lights.len() as u32));
        }
        let radiance = Spectrum::constant(1.0);
        self.lights.push(Light::Area(AreaLight {
            shape,
            radiance,
            luminance: 1.0,
            two_sided: false,
            pattern: None,
            opacity: 1.0,
        }));
    }

    /// The same radiance from everywhere.
    pub(super) fn sky(&mut self, le: f32) {
        let radiance = Spectrum::illuminant_rgb([le; 3]);
        self.lights.push(Light::Constant(ConstantEnvironment { radiance, luminance: le }));
    }

    /// Radiance from above, and from below.
    pub(super) fn half_sky(&mut self, above: f32, below: f32) {
        // In the map's own space the left half of an equal-area square has x < 0; other maps blur the horizon.
        let pixels = [[below; 3], [above; 3], [below; 3], [above; 3]];
        let up = Transform::new(DMat4::from_rotation_y(-std::f64::consts::FRAC_PI_2)).unwrap_or(Transform::IDENTITY);
        if let Ok(map) = EnvironmentMap::new(up, Projection::EqualArea, 2, 2, &pixels, 1.0) {
            self.lights.push(Light::Map(Box::new(map)));
        }
    }

    /// A distant light of an irradiance on a plane that faces it.
    pub(super) fn sun(&mut self, towards: Vec3, irradiance: f64) {
        let luminance = irradiance as f32;
        self.lights.push(Light::Distant(Distant { towards, irradiance: Spectrum::constant(luminance), luminance }));
    }

    /// A point light of intensity 1 at the origin.
    pub(super) fn point_light(&mut self) {
        let intensity = Spectrum::constant(1.0);
        self.lights.push(Light::Point(PointLight { position: Vec3::ZERO, intensity, luminance: 1.0 }));
    }

    /// The world.
    pub(super) fn scene(self) -> Made<Scene> {
        let camera = Camera {
            view: View { to_world: self.to_world, model: self.model, near: 0.0 },
            width: SIDE,
            height: SIDE,
            filter: Filter::default(),
            exposure: 1.0,
            medium: None,
            layers: Vec::new(),
        };
        let lights = LightTable::new(self.lights);
        let geometry = self.builder.build()?;
        Ok(Scene::new(ColorMode::Mono, camera, geometry, self.objects, self.materials, self.media, lights))
    }
}

/// A direction at the cosine to +z, towards an azimuth [rad].
pub(super) fn direction(cosine: f64, azimuth: f64) -> Vec3 {
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    DVec3::new(sine * azimuth.cos(), sine * azimuth.sin(), cosine).as_vec3()
}
