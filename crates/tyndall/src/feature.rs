//! What a camera ray meets first: its distance, place, orientation, parameters, name and colour.
//!
//! A boundary without a material counts as any other surface; media do not. Where nothing is hit every feature is 0. Each
//! value has four lanes, the last of which is 1 where something was hit (of the albedo too).

use crate::{
    bsdf::Bsdf,
    camera::CameraRay,
    math::{Ray, Transform, Vec2, Vec3},
    path::Vertex,
    sampling::Sampler,
    scene::Scene,
    shape::Interaction,
    spectrum::{Lanes, Spectrum, Wavelengths, film_rgb},
};

/// Something to know about the first surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Feature {
    /// Distance along the ray [length].
    Depth,
    /// Place [length].
    Position(Space),
    /// Unit normal of the surface.
    GeometricNormal(Space, Facing),
    /// Unit normal for shading, that of a relief included.
    ShadingNormal(Space, Facing),
    /// Surface parameters [1].
    Uv,
    /// Derivative of the place by u [length].
    DpDu,
    /// Derivatives of the z of the place, over the plane that touches the surface, by the column and by the row of the image
    /// [length/pixel].
    DzDxy(Space),
    /// Index of the part of an object: a triangle of a mesh.
    Primitive,
    /// Index of the object.
    Object,
    /// The share of light from all around that goes back along the ray, as linear sRGB under the white of sRGB [1].
    Albedo,
}

/// The space that a place or direction is told in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Space {
    /// That of the scene.
    World,
    /// That of the camera.
    Camera,
}

/// The side to which a normal points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Facing {
    /// That of the shape.
    Outward,
    /// That of the camera.
    Viewer,
}

/// The first hit of a camera ray.
#[derive(Debug)]
pub struct FirstHit<'a> {
    scene: &'a Scene,
    ray: CameraRay,
    pixel: (u32, u32),
    u: [f32; 4],
    hit: Option<(f32, Interaction)>,
}

impl<'a> FirstHit<'a> {
    /// Follows the ray that the camera of the scene has for a pixel and four uniform numbers.
    pub fn of(scene: &'a Scene, pixel: (u32, u32), u: [f32; 4]) -> Self {
        let ray = scene.camera.sample_ray(pixel, u);
        let found = scene.first_surface(&ray.ray, f32::INFINITY);
        let hit = found.map(|hit| (hit.t, scene.geometry.interaction(&ray.ray, &hit)));
        Self { scene, ray, pixel, u, hit }
    }

    /// A sample of a feature, with the weight of the camera's.
    pub fn sample(&self, feature: Feature, wavelengths: &Wavelengths, sampler: &mut Sampler) -> [f32; 4] {
        let Some((t, hit)) = &self.hit else { return [0.0; 4] };
        let to_world = &self.scene.camera.view.to_world;
        let [x, y, z] = match feature {
            Feature::Depth => [*t, 0.0, 0.0],
            Feature::Position(Space::World) => hit.p.to_array(),
            Feature::Position(Space::Camera) => to_world.inverse.transform_point3(hit.p).to_array(),
            Feature::GeometricNormal(space, facing) => self.normal(hit.ng, space, facing, to_world),
            Feature::ShadingNormal(space, facing) => {
                self.normal(self.shading_normal(hit, sampler), space, facing, to_world)
            }
            Feature::Uv => {
                let [u, v] = hit.uv.get().to_array();
                [u, v, 0.0]
            }
            Feature::DpDu => hit.dpdu.to_array(),
            Feature::DzDxy(space) => {
                let z = match space {
                    Space::World => Vec3::Z,
                    // The row of the inverse that makes the z of camera space.
                    Space::Camera => to_world.inverse.transpose().z_axis.truncate(),
                };
                let [x, y] = self.slopes(hit).map(|dp| dp.dot(z));
                [x, y, 0.0]
            }
            Feature::Primitive => [hit.prim as f32, 0.0, 0.0],
            Feature::Object => [hit.object.0 as f32, 0.0, 0.0],
            Feature::Albedo => self.albedo(hit, wavelengths, sampler),
        };
        [x, y, z, 1.0].map(|v| v * self.ray.weight)
    }

    /// Derivatives of the place by column and row. The ray `o + t d` of a pixel beside this one meets the plane through `p`
    /// with the normal `n` where `n · (o + t d − p) = 0`, so `∂p = ∂o + t ∂d − d (n · (∂o + t ∂d)) / (n · d)`.
    fn slopes(&self, hit: &Interaction) -> [Vec3; 2] {
        let Ray { origin, dir } = self.ray.ray;
        let t = (hit.p - origin).dot(dir);
        [Vec2::X, Vec2::Y].map(|side| {
            let [before, after] =
                [-0.5, 0.5].map(|step| self.scene.camera.ray_beside(self.pixel, self.u, side * step).ray);
            let swept = (after.origin - before.origin) + (after.dir - before.dir) * t;
            let along = swept.dot(hit.ng) / dir.dot(hit.ng);
            // Beyond the edge of what a camera sees there are no rays to compare with.
            Some(swept - dir * along).filter(|dp| dp.is_finite()).unwrap_or(Vec3::ZERO)
        })
    }

    /// That of the relief, if there is one.
    fn shading_normal(&self, hit: &Interaction, sampler: &mut Sampler) -> Vec3 {
        let dir = self.ray.ray.dir;
        let (_, relief) = self.scene.meet(hit, dir, || sampler.next_1d());
        match Vertex::met(self.scene, *hit, Bsdf::diffuse(Lanes::ONE), dir, relief) {
            Vertex::Surface { frame, .. } if relief.is_some() => frame.n,
            _ => hit.ns,
        }
    }

    fn normal(&self, n: Vec3, space: Space, facing: Facing, to_world: &Transform) -> [f32; 3] {
        let away = facing == Facing::Viewer && n.dot(self.ray.ray.dir) > 0.0;
        let n = if away { -n } else { n };
        match space {
            Space::World => n,
            // A normal goes to camera space by the transpose of what takes points to the world.
            Space::Camera => glam::Mat3::from_mat4(to_world.matrix).transpose().mul_vec3(n).normalize_or_zero(),
        }
        .to_array()
    }

    /// One direction of the BSDF: its weight has the albedo as its mean.
    fn albedo(&self, hit: &Interaction, wavelengths: &Wavelengths, sampler: &mut Sampler) -> [f32; 3] {
        let (material, relief) = self.scene.meet(hit, self.ray.ray.dir, || sampler.next_1d());
        let bsdf = match material {
            crate::material::Material::Null => return [0.0; 3],
            material => material.bsdf(&hit.into(), wavelengths, 0).seeded(|| sampler.rng.next_u32()),
        };
        let vertex = Vertex::met(self.scene, *hit, bsdf, self.ray.ray.dir, relief);
        let Vertex::Surface { bsdf, wo, .. } = vertex else { return [0.0; 3] };
        let u = sampler.next_2d();
        match bsdf.sample(wo, sampler.next_1d(), Vec2::new(u.x, u.y)) {
            Some(sample) => film_rgb(sample.weight * Spectrum::illuminant_rgb([1.0; 3]).eval(wavelengths), wavelengths),
            None => [0.0; 3],
        }
    }
}
