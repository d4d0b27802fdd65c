//! Small worlds for closed forms: one camera ray, many samples, a mean with its standard error.
#![allow(dead_code)] // each test file uses its own part

use tyndall::{
    bsdf::Sides,
    camera::{Camera, CameraModel, Perspective, View},
    film::Filter,
    integrator::Integrator,
    light::{AreaLight, ConstantEnvironment, EmitterShape, EnvironmentMap, Light, LightId, LightTable, Projection},
    material::{Index, Material, Roughness},
    math::{Transform, Vec3},
    medium::{BodyId, Homogeneous, MediumId, MediumInterface, Member},
    phase::{Isotropic, Phase},
    render::{Settings, render},
    sampling::SamplerKind,
    scene::{Emission, MaterialId, Object, Scene},
    shape::{Disk, GeometryBuilder, Mesh, ObjectId, Sphere},
    spectrum::{ColorMode, Spectrum},
};

/// A mean of independent samples in the film's red, green and blue, with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Measured {
    pub(crate) mean: [f64; 3],
    pub(crate) standard_error: [f64; 3],
}

/// A world in the making.
pub(crate) struct World {
    pub(crate) color: ColorMode,
    pub(crate) camera: Camera,
    pub(crate) builder: GeometryBuilder,
    pub(crate) objects: Vec<Object>,
    pub(crate) materials: Vec<Material>,
    pub(crate) media: Vec<Homogeneous>,
    pub(crate) lights: Vec<Light>,
}

pub(crate) fn grey(v: f32) -> Spectrum {
    Spectrum::constant(v)
}

pub(crate) fn diffuse(reflectance: f32) -> Material {
    Material::Diffuse { reflectance: reflectance.into(), sides: Sides::Both }
}

pub(crate) fn glass(eta: f32, alpha: f32) -> Material {
    Material::Dielectric {
        eta: Index::Constant(eta),
        alpha: Roughness::constant([alpha; 2]),
        reflection_tint: 1.0.into(),
        transmission_tint: 1.0.into(),
    }
}

pub(crate) fn medium(sigma_a: [f32; 3], sigma_s: [f32; 3], g: f32) -> Homogeneous {
    let phase = if g == 0.0 { Phase::Isotropic(Isotropic) } else { Phase::henyey_greenstein(g).unwrap() };
    Homogeneous {
        sigma_a: Spectrum::unbounded_rgb(sigma_a),
        sigma_s: Spectrum::unbounded_rgb(sigma_s),
        emission: None,
        phase,
    }
}

impl World {
    /// One pixel that looks from `eye` at `target`; the pixel is so narrow that it is one ray.
    pub(crate) fn seen(eye: Vec3, target: Vec3) -> Self {
        let forward = (target - eye).normalize();
        let side = if forward.y.abs() > 0.9 { Vec3::X } else { Vec3::Y };
        let x = side.cross(forward).normalize();
        let to_world = glam::DMat4::from_cols(
            x.as_dvec3().extend(0.0),
            forward.cross(x).as_dvec3().extend(0.0),
            forward.as_dvec3().extend(0.0),
            eye.as_dvec3().extend(1.0),
        );
        let camera = Camera {
            view: View {
                to_world: Transform::new(to_world).unwrap(),
                model: CameraModel::Perspective(Perspective::pinhole([-1e-4, 1e-4, -1e-4, 1e-4])),
                near: 0.0,
            },
            width: 1,
            height: 1,
            filter: Filter::default(),
            exposure: 1.0,
            medium: None,
            layers: Vec::new(),
        };
        Self {
            color: ColorMode::Rgb,
            camera,
            builder: GeometryBuilder::new(),
            objects: Vec::new(),
            materials: Vec::new(),
            media: Vec::new(),
            lights: Vec::new(),
        }
    }

    /// A material that others are made of.
    pub(crate) fn part(&mut self, material: Material) -> MaterialId {
        self.materials.push(material);
        MaterialId(self.materials.len() as u32 - 1)
    }

    /// `1 − amount` of one material and `amount` of another.
    pub(crate) fn mix(&mut self, first: Material, second: Material, amount: f32) -> Material {
        Material::Mix { of: [self.part(first), self.part(second)], amount: amount.into() }
    }

    pub(crate) fn object(&mut self, material: Material, interface: Option<MediumInterface>) {
        self.materials.push(material);
        self.objects.push(Object {
            name: String::new(),
            material: MaterialId(self.materials.len() as u32 - 1),
            interface,
            emission: Emission::None,
            body: None,
            granular: None,
        });
    }

    /// The interface of a body filled with `inside`.
    fn filled(&mut self, inside: Option<Homogeneous>) -> Option<MediumInterface> {
        inside.map(|m| {
            self.media.push(m);
            MediumInterface { inside: Some(MediumId(self.media.len() as u32 - 1)), outside: None }
        })
    }

    pub(crate) fn sphere(
        &mut self,
        centre: Vec3,
        radius: f32,
        material: Material,
        inside: Option<Homogeneous>,
    ) -> ObjectId {
        let interface = self.filled(inside);
        self.object(material, interface);
        self.builder.add_sphere(Sphere::new(centre, radius), &Transform::IDENTITY, false).unwrap()
    }

    /// The box `min ≤ p ≤ max`.
    pub(crate) fn cuboid(&mut self, min: Vec3, max: Vec3, material: Material, inside: Option<Homogeneous>) -> ObjectId {
        let interface = self.filled(inside);
        self.object(material, interface);
        let corner = |i: usize| {
            Vec3::new(
                if i & 1 == 0 { min.x } else { max.x },
                if i & 2 == 0 { min.y } else { max.y },
                if i & 4 == 0 { min.z } else { max.z },
            )
        };
        let indices = vec![
            [0, 2, 1],
            [1, 2, 3],
            [4, 5, 6],
            [5, 7, 6],
            [0, 1, 4],
            [1, 5, 4],
            [2, 6, 3],
            [3, 6, 7],
            [0, 4, 2],
            [2, 4, 6],
            [1, 3, 5],
            [3, 7, 5],
        ];
        let mesh = Mesh {
            positions: (0..8).map(corner).collect(),
            indices,
            normals: Vec::new(),
            uvs: Vec::new(),
            reversed: false,
        };
        self.builder.add_mesh(mesh, &Transform::IDENTITY, false).unwrap()
    }

    /// A ball of `n` by `2n` quadrilaterals with the normals of a sphere.
    pub(crate) fn faceted_ball(&mut self, radius: f32, n: u32, material: Material, inside: Homogeneous) {
        self.add_ball(|_| radius, n, true, material, inside);
    }

    /// The same of another radius in each direction, and without normals.
    pub(crate) fn uneven_ball(
        &mut self,
        radius: impl Fn(Vec3) -> f32,
        n: u32,
        material: Material,
        inside: Homogeneous,
    ) {
        self.add_ball(radius, n, false, material, inside);
    }

    fn add_ball(
        &mut self,
        radius: impl Fn(Vec3) -> f32,
        n: u32,
        is_smooth: bool,
        material: Material,
        inside: Homogeneous,
    ) {
        let interface = self.filled(Some(inside));
        self.object(material, interface);
        let m = 2 * n;
        let direction = |i: u32, j: u32| {
            let (sin_theta, cos_theta) = (std::f32::consts::PI * i as f32 / n as f32).sin_cos();
            let (sin_phi, cos_phi) = (std::f32::consts::TAU * j as f32 / m as f32).sin_cos();
            Vec3::new(sin_theta * sin_phi, cos_theta, sin_theta * cos_phi)
        };
        // Two poles, and n − 1 rings of m vertices between them.
        let rings = (1..n).flat_map(|i| (0..m).map(move |j| (i, j))).map(|(i, j)| direction(i, j));
        let normals: Vec<Vec3> = rings.chain([Vec3::Y, -Vec3::Y]).collect();
        let at = |i: u32, j: u32| match i {
            0 => (n - 1) * m,
            i if i == n => (n - 1) * m + 1,
            i => (i - 1) * m + j % m,
        };
        let quads = (0..n).flat_map(|i| (0..m).map(move |j| (i, j)));
        let indices = quads
            .flat_map(|(i, j)| [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]])
            .filter(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
            .collect();
        let positions = normals.iter().map(|d| *d * radius(*d)).collect();
        let normals = if is_smooth { normals } else { Vec::new() };
        let mesh = Mesh { positions, indices, normals, uvs: Vec::new(), reversed: false };
        self.builder.add_mesh(mesh, &Transform::IDENTITY, false).unwrap();
    }

    /// Makes a body of the last `objects` objects together.
    pub(crate) fn with_priority(&mut self, priority: i32, objects: usize) {
        let body = BodyId(self.objects.len() as u32);
        let first = self.objects.len() - objects;
        for object in &mut self.objects[first..] {
            object.body = Some(Member { body, priority });
        }
    }

    /// A wide plane slab between y = −thickness and y = 0.
    pub(crate) fn slab(&mut self, thickness: f32, material: Material, inside: Homogeneous) {
        let wide = 1e4 * thickness.max(1.0);
        self.cuboid(Vec3::new(-wide, -thickness, -wide), Vec3::new(wide, 0.0, wide), material, Some(inside));
    }

    /// A sphere whose surface shines, inwards or outwards.
    pub(crate) fn shining_sphere(&mut self, centre: Vec3, radius: f32, material: Material, le: f32, inward: bool) {
        self.object(material, None);
        self.builder.add_sphere(Sphere::new(centre, radius), &Transform::IDENTITY, inward).unwrap();
        self.shine(EmitterShape::Sphere { centre, radius, inward }, le);
    }

    /// A disk of given radius at height y that shines downwards.
    pub(crate) fn shining_disk(&mut self, y: f32, radius: f32, material: Material, le: f32) {
        self.object(material, None);
        let down = glam::DMat4::from_translation(glam::DVec3::new(0.0, f64::from(y), 0.0))
            * glam::DMat4::from_rotation_x(std::f64::consts::FRAC_PI_2);
        let id = self.builder.add_disk(Disk::new(0.0, radius, 0.0), &Transform::new(down).unwrap(), false).unwrap();
        assert_eq!(id.0 as usize, self.objects.len() - 1);
        self.shine(EmitterShape::Disk { centre: Vec3::Y * y, ng: -Vec3::Y, radius, inner: 0.0 }, le);
    }

    /// A mesh that is one light.
    pub(crate) fn shining_mesh(&mut self, mesh: Mesh, material: Material, light: AreaLight) {
        self.object(material, None);
        self.builder.add_mesh(mesh, &Transform::IDENTITY, false).unwrap();
        self.objects.last_mut().unwrap().emission = Emission::Whole(LightId(self.lights.len() as u32));
        self.lights.push(Light::Area(light));
    }

    fn shine(&mut self, shape: EmitterShape, le: f32) {
        let id = LightId(self.lights.len() as u32);
        self.objects.last_mut().unwrap().emission = Emission::Whole(id);
        self.lights.push(Light::Area(AreaLight {
            shape,
            radiance: grey(le),
            luminance: le,
            two_sided: false,
            opacity: 1.0,
            pattern: None,
        }));
    }

    /// The same radiance from everywhere.
    pub(crate) fn sky(&mut self, le: f32) {
        self.lights
            .push(Light::Constant(ConstantEnvironment { radiance: Spectrum::illuminant_rgb([le; 3]), luminance: le }));
    }

    /// Radiance `above` from all directions with y > 0 and `below` from the others.
    pub(crate) fn half_sky(&mut self, above: f32, below: f32) {
        // In the map's own space the left half of an equal-area square has x < 0.
        let pixels = [[below; 3], [above; 3], [below; 3], [above; 3]];
        let upright = Transform::new(glam::DMat4::from_rotation_z(std::f64::consts::FRAC_PI_2)).unwrap();
        let map = EnvironmentMap::new(upright, Projection::EqualArea, 2, 2, &pixels, 1.0).unwrap();
        self.lights.push(Light::Map(Box::new(map)));
    }

    pub(crate) fn scene(self) -> Scene {
        let table = LightTable::new(self.lights);
        let granular = |id: ObjectId| self.objects[id.0 as usize].granular;
        let (geometry, proxied) = self.builder.build_granular(granular).unwrap();
        let scene = Scene::new(self.color, self.camera, geometry, self.objects, self.materials, self.media, table);
        match proxied {
            Some(geometry) => scene.with_proxy(geometry),
            None => scene,
        }
    }

    /// The radiance along the one ray, from independent samples.
    pub(crate) fn measure(self, integrator: &dyn Integrator, spp: u32) -> Measured {
        measure(&self.scene(), integrator, spp)
    }
}

pub(crate) fn measure(scene: &Scene, integrator: &dyn Integrator, spp: u32) -> Measured {
    let settings = Settings { spp, seed: 1, sampler: SamplerKind::Independent, ..Settings::default() };
    let rendering = render(scene, integrator, &settings, &());
    assert_eq!(rendering.tally.bad_samples, 0, "{:?}", rendering.tally.bad_sample_list);
    let pixel = rendering.film.pixel(0, 0).unwrap();
    let n = pixel.count as f64;
    let mean = pixel.sum.map(|s| s / n);
    let standard_error =
        std::array::from_fn(|c| ((pixel.sum_of_squares[c] / n - mean[c] * mean[c]).max(0.0) / (n - 1.0)).sqrt());
    Measured { mean, standard_error }
}

/// Fails when a channel is more than 4.5 standard errors (one in 150,000) from what it should be, or when the
/// measurement is too blunt to tell: a standard error above `precision` of the expectation.
#[track_caller]
pub(crate) fn assert_mean(what: &str, m: &Measured, expected: [f64; 3], precision: f64) {
    for (c, expected) in expected.into_iter().enumerate() {
        let z = (m.mean[c] - expected) / m.standard_error[c].max(1e-6 * expected.abs() + 1e-12);
        assert!(
            z.abs() < 4.5,
            "{what}, channel {c}: mean {:.6} ± {:.6}, expected {:.6} (z = {z:.1})",
            m.mean[c],
            m.standard_error[c],
            expected
        );
        assert!(
            m.standard_error[c] <= precision * expected.abs(),
            "{what}, channel {c}: standard error {:.2e} is above {precision} of {:.6}",
            m.standard_error[c],
            expected
        );
    }
}

/// The same for two measurements, of each other.
#[track_caller]
pub(crate) fn assert_agree(what: &str, [a, b]: [Measured; 2], precision: f64) {
    for c in 0..3 {
        let error = a.standard_error[c].hypot(b.standard_error[c]);
        let z = (a.mean[c] - b.mean[c]) / error;
        assert!(z.abs() < 4.5, "{what}, channel {c}: {:.5} and {:.5}, z = {z:.1}", a.mean[c], b.mean[c]);
        assert!(error < precision * a.mean[c], "{what}, channel {c}: {error:.2e} of {:.5}", a.mean[c]);
    }
}
