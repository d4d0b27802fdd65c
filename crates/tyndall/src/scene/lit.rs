//! How light samples from inside a medium reach lights, and which lamps are aimed at: known before the first ray, and the same for
//! every path.

use super::{Object, Scene, overlap};
use crate::{
    light::{Light, LightId, LightTable},
    material::{Index, Material},
    math::Bounds,
    medium::{Body, Coefficients, Inside, MediumId},
    shape::{Geometry, ObjectId, Shape},
    surface::may_be_open,
};

/// How light samples from inside a medium reach lights.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lit {
    /// Not at all.
    Never,
    /// Straight.
    Straight,
    /// Through walls that bend them: see [`crate::bend`].
    Bent,
}

/// The diagonal of a lamp that counts as small, over the depth of the medium that it is in \[1\].
const SMALL_LAMP: f32 = 0.2;
/// The depth of a medium from which on walks serve it better than collisions aimed at its lamps \[mean free paths\].
const THIN: f32 = 8.0;
/// The depth of a medium up to which most flights leave it \[mean free paths\].
const SHALLOW: f32 = 1.0;

impl Scene {
    /// The whole surface of a medium, if it is one ball at which light samples may bend.
    #[inline]
    pub fn only_wall(&self, medium: MediumId) -> Option<ObjectId> {
        self.facts.only_wall[medium.0 as usize]
    }

    /// Whether sampling lights straight from inside a medium can ever succeed: not where every way out leads through glass
    /// and no light is within.
    #[inline]
    pub fn light_can_reach(&self, medium: Option<MediumId>) -> bool {
        self.lit(medium) == Lit::Straight
    }

    /// How light samples from inside a medium reach lights.
    #[inline]
    pub fn lit(&self, medium: Option<MediumId>) -> Lit {
        medium.map_or(Lit::Straight, |id| self.facts.lit[id.0 as usize])
    }

    /// The index inside an object over that outside \[1\], if light samples may bend at its surface.
    #[inline]
    pub fn wall(&self, object: ObjectId) -> Option<f32> {
        self.facts.walls[object.0 as usize]
    }

    /// The box around a light, if that is small and in a medium: one that rays in it may pass closely.
    #[inline]
    pub fn small_lamp(&self, medium: MediumId, lamp: LightId) -> Option<Bounds> {
        let bounds = self.lights.get(lamp).bounds()?;
        let is_small = bounds.extent().length() < SMALL_LAMP * self.deepest(medium);
        (is_small && overlap(&self.facts.extent[medium.0 as usize], &bounds)).then_some(bounds)
    }

    /// Whether paths see through a medium: so few flights end in it that walks there are worth nothing, or collisions are aimed at a
    /// lamp. The same for whatever lane is the hero, as all weights of multiple importance sampling must be.
    #[inline]
    pub fn is_clear(&self, medium: MediumId, coefficients: &Coefficients) -> bool {
        coefficients.sigma_t.mean() * self.deepest(medium) < SHALLOW || self.aims(medium, coefficients)
    }

    /// Whether light straight ahead of a path is looked for beyond where its flight ends: see [`crate::path::ahead`].
    #[inline]
    pub fn looks_ahead(&self, inside: &Inside) -> bool {
        match inside {
            Inside::Vacuum => self.open_to_paths().is_some(),
            Inside::Medium { id, coefficients } => self.open().is_some() && self.is_clear(*id, coefficients),
            Inside::Mixture { .. } => false,
        }
    }

    /// Whether collisions in a medium are to be aimed at lamps: where a small one is in it and it is thin. The same for
    /// whatever lane is the hero, as all weights of multiple importance sampling must be.
    #[inline]
    pub fn aims(&self, medium: MediumId, coefficients: &Coefficients) -> bool {
        let Coefficients { sigma_t, sigma_s, .. } = *coefficients;
        self.facts.holds_lamp[medium.0 as usize]
            && self.light_can_reach(Some(medium))
            && sigma_t.mean() * self.deepest(medium) < THIN
            && !sigma_s.is_zero()
    }
}

/// A medium is lit directly if it has an open boundary (one without a material, or with holes), if it fills the space of a
/// light, or if it reaches as far as we know.
pub(super) fn can_be_lit(
    medium: MediumId,
    extent: &Bounds,
    objects: &[(ObjectId, &Object)],
    materials: &[Material],
    lights: &LightTable,
) -> bool {
    objects.iter().any(|(_, o)| o.bounds(medium) && may_be_open(&materials[o.material.0 as usize], materials))
        || *extent == Bounds::EVERYTHING
        || extent.is_empty()
        || lights.lights.iter().filter_map(Light::bounds).any(|b| overlap(extent, &b))
}

/// The walls that light samples may bend at: polished, flat or a ball, of bodies that nothing overlaps and that stand free, and
/// where there is a light for which that is worth while. The index inside over that outside \[1\], by object.
pub(super) fn walls(scene: &Scene, bodies: &[Body]) -> Vec<Option<f32>> {
    let Scene { objects, materials, lights, geometry, .. } = scene;
    let material = |o: &Object| &materials[o.material.0 as usize];
    let is_simple = bodies.is_empty() && objects.iter().all(|o| o.granular.is_none());
    if !is_simple || !lights.lights.iter().any(Light::is_worth_bending) {
        return vec![None; objects.len()];
    }
    let is_glass = |o: &Object| matches!(material(o), Material::Dielectric { .. } | Material::ThinDielectric { .. });
    let all = || (0..).map(ObjectId).zip(objects.iter());
    let glass = all().filter(|(_, o)| is_glass(o)).flat_map(|(id, _)| geometry.placed_bounds(id));
    let glass: Vec<_> = glass.take(MOST_GLASS + 1).collect();
    let wall = |(id, object)| {
        let index = material(object).polished()?;
        let bends = match geometry.shape(id) {
            Shape::Sphere(sphere) => sphere.round().is_some(),
            Shape::Mesh(mesh) => mesh.normals.is_empty(),
            _ => false,
        };
        let stands_free = || !geometry.is_in_group(id) && !is_behind(&glass, &geometry.object_bounds(id));
        (bends && object.interface.is_some() && stands_free()).then_some(index)
    };
    all().map(wall).collect()
}

/// Pieces of glass that are looked through for one around another.
const MOST_GLASS: usize = 256;

/// Whether a box around glass holds another box: behind a second wall a light sample would have to bend twice.
fn is_behind(glass: &[Bounds], bounds: &Bounds) -> bool {
    let holds = |b: &Bounds| b != bounds && b.min.cmple(bounds.min).all() && b.max.cmpge(bounds.max).all();
    glass.len() <= MOST_GLASS && glass.iter().any(holds)
}

/// The whole surface of a medium, if that is one ball at which light samples may bend.
pub(super) fn only_wall(
    medium: MediumId,
    objects: &[(ObjectId, &Object)],
    walls: &[Option<f32>],
    geometry: &Geometry,
) -> Option<ObjectId> {
    let mut around = objects.iter().filter(|(_, o)| o.bounds(medium)).map(|(id, _)| *id);
    let (first, None) = (around.next()?, around.next()) else { return None };
    let is_ball = matches!(geometry.shape(first), Shape::Sphere(_));
    (is_ball && walls[first.0 as usize].is_some()).then_some(first)
}

/// Whether light may leave the bodies of a medium straight: unless each body of the scene has a surface that bends it
/// against vacuum and against each other body.
pub(super) fn opens_straight(medium: MediumId, bodies: &[Body]) -> bool {
    let index = |body: &Body| match body.index {
        Some(Index::Constant(eta)) if eta != 1.0 => Some(eta),
        _ => None,
    };
    let mut indices: Vec<_> = bodies.iter().map(index).collect();
    indices.sort_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
    let bends = indices.iter().all(Option::is_some) && indices.windows(2).all(|w| w[0] != w[1]);
    !bends && bodies.iter().any(|body| body.medium == Some(medium))
}
