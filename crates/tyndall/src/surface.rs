//! What a path meets at a surface: mixtures resolved, holes seen through.
//!
//! Some materials are made of others. A path that meets one picks a single component by chance, with its share, and goes
//! on as if that were all: the mean over paths is the mixture. Nothing is picked for a shadow ray, which takes the part
//! that is open: exact, and without noise.

use crate::{
    material::Material,
    math::Vec3,
    relief::Relief,
    scene::{MaterialId, Scene},
    shape::Interaction,
};

impl Scene {
    /// The material that a path along `dir` meets at `hit`, and the one that is its relief if it has any. `random` gives
    /// numbers in [0, 1), one for each mixture on the way.
    #[inline]
    pub fn meet(&self, hit: &Interaction, dir: Vec3, random: impl FnMut() -> f32) -> (&Material, Option<MaterialId>) {
        match self.material(hit) {
            Material::Mix { .. } | Material::TwoFaced { .. } | Material::Embossed { .. } => self.pick(hit, dir, random),
            plain => (plain, None),
        }
    }

    fn pick(&self, hit: &Interaction, dir: Vec3, mut random: impl FnMut() -> f32) -> (&Material, Option<MaterialId>) {
        let mut id = self.object(hit).material;
        let mut relief = None;
        loop {
            id = match &self.materials[id.0 as usize] {
                Material::Mix { of, amount } => of[usize::from(random() < amount.scalar(&hit.into()))],
                Material::TwoFaced { outside, inside } => face(hit, dir, *outside, *inside),
                Material::Embossed { of, .. } => {
                    relief = Some(id);
                    *of
                }
                plain => return (plain, relief),
            };
        }
    }

    /// The relief that an embossed material has.
    pub(crate) fn relief(&self, id: MaterialId) -> Option<&Relief> {
        match &self.materials[id.0 as usize] {
            Material::Embossed { relief, .. } => Some(relief),
            _ => None,
        }
    }

    /// What of the light along `dir` passes straight through the surface at `hit`.
    pub(crate) fn openness(&self, hit: &Interaction, dir: Vec3) -> Openness {
        self.openness_of(self.material(hit), hit, dir)
    }

    fn openness_of(&self, material: &Material, hit: &Interaction, dir: Vec3) -> Openness {
        let of = |id: MaterialId| self.openness_of(&self.materials[id.0 as usize], hit, dir);
        match material {
            Material::Null => Openness { part: 1.0, crosses: true },
            Material::Hole => Openness { part: 1.0, crosses: false },
            Material::Mix { of: [first, second], amount } => {
                let w = amount.scalar(&hit.into()).clamp(0.0, 1.0);
                let (a, b) = (of(*first), of(*second));
                Openness { part: (1.0 - w) * a.part + w * b.part, crosses: a.crosses || b.crosses }
            }
            Material::TwoFaced { outside, inside } => of(face(hit, dir, *outside, *inside)),
            Material::Embossed { of: even, .. } => of(*even),
            _ => Openness { part: 0.0, crosses: false },
        }
    }
}

/// What of a surface lets light pass unchanged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Openness {
    /// The part of it \[1\].
    pub(crate) part: f32,
    /// Whether light that passes enters the medium on the other side: there is a boundary and not a hole. (No scene
    /// language has surfaces that are both, between different media.)
    pub(crate) crosses: bool,
}

/// The face that a ray along `dir` meets.
fn face(hit: &Interaction, dir: Vec3, outside: MaterialId, inside: MaterialId) -> MaterialId {
    if dir.dot(hit.ng) < 0.0 { outside } else { inside }
}

/// Whether any light can pass unchanged.
pub(crate) fn may_be_open(material: &Material, materials: &[Material]) -> bool {
    let of = |id: &MaterialId| may_be_open(&materials[id.0 as usize], materials);
    match material {
        Material::Null | Material::Hole => true,
        Material::Mix { of: [first, second], .. } => of(first) || of(second),
        Material::TwoFaced { outside, inside } => of(outside) || of(inside),
        Material::Embossed { of: even, .. } => of(even),
        _ => false,
    }
}
