//! A material on a square, lit evenly: the renderer's own meeting of a path with a surface.

use tyndall::{
    light::LightTable,
    math::{Ray, Transform, Vec2, Vec3},
    path::Vertex,
    sampling::rng::Rng,
    scene::{Emission, MaterialId, Object, Scene},
    shape::{GeometryBuilder, Interaction, Mesh},
    spectrum::{Lanes, Wavelengths},
};

use super::{Scatterer, Scattering};
use crate::world::{SetupError, within};

/// Samples that look for the index on the other side.
const PROBES: u32 = 4096;

/// A square of a material, and from where light falls on it.
#[derive(Debug)]
pub struct Surface {
    scene: Scene,
    /// Of the light that falls on it.
    travel: Vec3,
    /// The index that light passes into, over that which it comes from \[1\].
    eta: f32,
}

impl Surface {
    /// The material `id` of a scene, with light at a `cosine` to its normal: positive from outside, negative from inside.
    ///
    /// # Errors
    /// There is no such material, or the cosine is none.
    pub fn new(scene: Scene, id: MaterialId, cosine: f64) -> Result<Self, SetupError> {
        within("the cosine of the incidence", cosine, "from -1 to 1, and not 0", |c| c != 0.0 && c.abs() <= 1.0)?;
        let Scene { color, camera, materials, media, .. } = scene;
        if id.0 as usize >= materials.len() {
            return Err(SetupError::Missing("such material"));
        }
        let mut builder = GeometryBuilder::new();
        let corner = |x: f32, y: f32| Vec3::new(x, y, 0.0);
        let square = Mesh {
            positions: vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)],
            indices: vec![[0, 1, 2], [0, 2, 3]],
            uvs: vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y],
            ..Mesh::default()
        };
        builder.add_mesh(square, &Transform::IDENTITY, false)?;
        let name = String::new();
        let objects =
            vec![Object { name, material: id, interface: None, emission: Emission::None, body: None, granular: None }];
        let lights = LightTable::new(Vec::new());
        let scene = Scene::new(color, camera, builder.build()?, objects, materials, media, lights);
        let travel = Vec3::new((1.0 - cosine * cosine).max(0.0).sqrt() as f32, 0.0, -cosine as f32);
        let mut surface = Self { scene, travel, eta: 1.0 };
        surface.eta = surface.index_beyond();
        Ok(surface)
    }

    /// The relative index that any light passes into.
    fn index_beyond(&self) -> f32 {
        let mut rng = Rng::for_sample((0, 0), 2, 0);
        let mut draw = || {
            let Met { vertex, .. } = self.meet_surface(&mut rng)?;
            let scattered = vertex.sample([rng.next_1d(), rng.next_1d(), rng.next_1d()])?;
            scattered.crossed.then_some(scattered.eta)
        };
        (0..PROBES).find_map(|_| draw()).unwrap_or(1.0)
    }

    fn hit(&self, rng: &mut Rng) -> Option<Interaction> {
        let at = Vec3::new(rng.next_1d(), rng.next_1d(), 0.0);
        let ray = Ray::new(at - self.travel, self.travel);
        let hit = self.scene.geometry.intersect(&ray, f32::INFINITY)?;
        Some(self.scene.geometry.interaction(&ray, &hit))
    }

    fn meet_surface(&self, rng: &mut Rng) -> Option<Met<'_>> {
        let hit = self.hit(rng)?;
        let (material, relief) = self.scene.meet(&hit, self.travel, || rng.next_1d());
        let wavelengths = Wavelengths::sample(self.scene.color, rng.next_1d());
        let bsdf = material.bsdf(&(&hit).into(), &wavelengths, 0).seeded(|| rng.next_u32());
        let vertex = Vertex::met(&self.scene, hit, bsdf, self.travel, relief);
        Some(Met { vertex, travel: self.travel, eta: self.eta })
    }
}

impl Scatterer for Surface {
    type Met<'s> = Option<Met<'s>>;

    fn meet<'s>(&'s self, rng: &mut Rng) -> Option<Met<'s>> {
        self.meet_surface(rng)
    }
}

/// A place on the surface.
#[derive(Debug)]
pub(super) struct Met<'s> {
    vertex: Vertex<'s>,
    travel: Vec3,
    eta: f32,
}

/// At the very edge of the square light may pass it by.
impl Scattering for Option<Met<'_>> {
    fn travel(&self) -> Vec3 {
        self.as_ref().map_or(Vec3::NEG_Z, |met| met.travel)
    }

    fn sample(&self, rng: &mut Rng) -> Option<(Vec3, [f64; 3], bool)> {
        let scattered = self.as_ref()?.vertex.sample([rng.next_1d(), rng.next_1d(), rng.next_1d()])?;
        // In power and not in radiance.
        let power = channels(scattered.weight, scattered.eta);
        Some((scattered.ray.dir, power, scattered.specular))
    }

    fn eval(&self, dir: Vec3) -> [f64; 3] {
        let Some(Met { vertex, travel, eta }) = self else { return [0.0; 3] };
        let crosses = travel.z * dir.z > 0.0;
        channels(vertex.eval(dir).0, if crosses { *eta } else { 1.0 })
    }
}

fn channels(lanes: Lanes, eta: f32) -> [f64; 3] {
    std::array::from_fn(|c| f64::from(lanes.lane(c) * eta * eta))
}
