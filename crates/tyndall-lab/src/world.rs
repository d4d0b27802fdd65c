//! Worlds for experiments: planes and spheres between substances, seen in one colour.

use std::collections::HashMap;

use glam::{DMat4, DVec3};
use tyndall::{
    camera::{Camera, CameraModel, Perspective, View},
    film::Filter,
    light::LightTable,
    material::{Index, Material, Roughness},
    math::{Transform, Vec3},
    medium::{Homogeneous, MediumId, MediumInterface},
    phase::{Isotropic, Phase, PhaseError},
    scene::{Emission, MaterialId, Object, Scene},
    shape::{Disk, GeometryBuilder, Mesh, ShapeError, Sphere},
    spectrum::{ColorMode, Spectrum},
};

/// Something that light passes through.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Substance {
    /// Absorption coefficient [1/length], at least 0.
    pub sigma_a: f64,
    /// Scattering coefficient [1/length], at least 0.
    pub sigma_s: f64,
    /// Mean cosine of its Henyey–Greenstein phase function \[1\], in (−1, 1).
    pub g: f64,
    /// Refractive index \[1\], positive.
    pub n: f64,
}

/// Why an experiment cannot be set up.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SetupError {
    /// A number is out of its range.
    #[error("{what} must be {wanted}: got {value}")]
    OutOfRange {
        /// What it is.
        what: &'static str,
        /// The range in words.
        wanted: &'static str,
        /// The number.
        value: f64,
    },
    /// No layer, no bin: nothing to measure.
    #[error("there is no {0}")]
    Missing(&'static str),
    /// A phase function that cannot be.
    #[error(transparent)]
    Phase(#[from] PhaseError),
    /// A size that cannot be.
    #[error(transparent)]
    Shape(#[from] ShapeError),
}

/// Checks that `value` is in a range.
pub(crate) fn within(
    what: &'static str,
    value: f64,
    wanted: &'static str,
    holds: impl Fn(f64) -> bool,
) -> Result<(), SetupError> {
    if holds(value) { Ok(()) } else { Err(SetupError::OutOfRange { what, wanted, value }) }
}

impl Substance {
    /// Empty space of index 1.
    pub const VACUUM: Self = Self { sigma_a: 0.0, sigma_s: 0.0, g: 0.0, n: 1.0 };

    /// Extinction coefficient `σ_a + σ_s` [1/length].
    pub fn sigma_t(&self) -> f64 {
        self.sigma_a + self.sigma_s
    }

    /// The part of extinction that scatters \[1\]; 0 in empty space.
    pub fn albedo(&self) -> f64 {
        if self.sigma_t() > 0.0 { self.sigma_s / self.sigma_t() } else { 0.0 }
    }

    /// Of extinction 1 per length, without a step of the index.
    pub fn of_albedo(albedo: f64, g: f64) -> Self {
        Self { sigma_a: 1.0 - albedo, sigma_s: albedo, g, n: 1.0 }
    }

    /// Whether it can be.
    ///
    /// # Errors
    /// A coefficient is negative or not finite, `g` outside of (−1, 1), the index not positive.
    pub fn check(&self) -> Result<(), SetupError> {
        let amount = |v: f64| v >= 0.0 && f64::from(v as f32).is_finite();
        within("the absorption coefficient", self.sigma_a, "at least 0, and finite", amount)?;
        within("the scattering coefficient", self.sigma_s, "at least 0, and finite", amount)?;
        within("the mean cosine g", self.g, "greater than -1 and less than 1", |g| g.abs() < 1.0)?;
        within("the refractive index", self.n, "from 0.1 to 10", |n| (0.1..=10.0).contains(&n))
    }
}

/// A world in the making.
#[derive(Debug, Default)]
pub(crate) struct World {
    builder: GeometryBuilder,
    objects: Vec<Object>,
    materials: Vec<Material>,
    media: Vec<Homogeneous>,
    known: HashMap<[u64; 3], MediumId>,
}

impl World {
    /// The medium of a substance; none where it neither absorbs nor scatters.
    pub(crate) fn medium(&mut self, substance: &Substance) -> Result<Option<MediumId>, SetupError> {
        substance.check()?;
        if substance.sigma_t() == 0.0 {
            return Ok(None);
        }
        let Substance { sigma_a, sigma_s, g, .. } = *substance;
        let key = [sigma_a, sigma_s, g].map(f64::to_bits);
        if let Some(id) = self.known.get(&key) {
            return Ok(Some(*id));
        }
        let phase = if g == 0.0 { Phase::Isotropic(Isotropic) } else { Phase::henyey_greenstein(g as f32)? };
        let [sigma_a, sigma_s] = [sigma_a, sigma_s].map(|sigma| Spectrum::constant(sigma as f32));
        self.media.push(Homogeneous { sigma_a, sigma_s, emission: None, phase });
        let id = MediumId(self.media.len() as u32 - 1);
        self.known.insert(key, id);
        Ok(Some(id))
    }

    /// A wide plane at a height z [length] between two substances.
    pub(crate) fn plane(
        &mut self,
        z: f64,
        radius: f64,
        above: &Substance,
        below: &Substance,
    ) -> Result<(), SetupError> {
        // It faces down, so that what is below is outside: then no substance counts as enclosed, and none is.
        self.boundary(above, below)?;
        self.builder.add_disk(Disk::new(z as f32, radius as f32, 0.0), &Transform::IDENTITY, true)?;
        Ok(())
    }

    /// A sphere around the origin.
    pub(crate) fn sphere(&mut self, radius: f64, inside: &Substance, outside: &Substance) -> Result<(), SetupError> {
        self.boundary(inside, outside)?;
        self.builder.add_sphere(Sphere::new(Vec3::ZERO, radius as f32), &Transform::IDENTITY, false)?;
        Ok(())
    }

    /// A mesh; what its normals point away from is inside.
    pub(crate) fn mesh(&mut self, mesh: Mesh, inside: &Substance, outside: &Substance) -> Result<(), SetupError> {
        self.boundary(inside, outside)?;
        self.builder.add_mesh(mesh, &Transform::IDENTITY, false)?;
        Ok(())
    }

    /// A polished boundary, or a mere change of coefficients where the indices are equal.
    fn boundary(&mut self, inside: &Substance, outside: &Substance) -> Result<(), SetupError> {
        let interface = Some(MediumInterface { inside: self.medium(inside)?, outside: self.medium(outside)? });
        self.materials.push(if inside.n == outside.n {
            Material::Null
        } else {
            Material::Dielectric {
                eta: Index::Constant((inside.n / outside.n) as f32),
                alpha: Roughness::constant([0.0; 2]),
                reflection_tint: 1.0.into(),
                transmission_tint: 1.0.into(),
            }
        });
        let material = MaterialId(self.materials.len() as u32 - 1);
        self.objects.push(Object {
            name: String::new(),
            material,
            interface,
            emission: Emission::None,
            body: None,
            granular: None,
        });
        Ok(())
    }

    /// The world, where photons start at `source` [length] in `around`.
    pub(crate) fn build(mut self, around: &Substance, source: DVec3) -> Result<Scene, SetupError> {
        let medium = self.medium(around)?;
        let camera = Camera {
            view: View {
                to_world: Transform::new(DMat4::from_translation(source)).unwrap_or(Transform::IDENTITY),
                model: CameraModel::Perspective(Perspective::pinhole([-1.0, 1.0, -1.0, 1.0])),
                near: 0.0,
            },
            width: 1,
            height: 1,
            filter: Filter::default(),
            exposure: 1.0,
            medium,
            layers: Vec::new(),
        };
        let geometry = self.builder.build()?;
        let lights = LightTable::new(Vec::new());
        Ok(Scene::new(ColorMode::Mono, camera, geometry, self.objects, self.materials, self.media, lights))
    }
}
