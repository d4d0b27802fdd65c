//! What a path meets at a surface where bodies may overlap, and what is behind it.
//!
//! A surface of a body that does not show on either side of it is not there. Where it is a boundary, light is refracted
//! from the index that is on one side to the one that is on the other, whatever surface brought them together: the wall
//! between liquid and glass may be written once, by either.
//!
//! Faces that coincide are one boundary. A ray that leaves a surface starts beyond the error of the hit and so beyond
//! any face that coincides with it; so the faces in between are looked for, each is crossed with the one that was met,
//! and bodies are compared before the first and after the last. Of faces that coincide, an ordinary surface (one without
//! a priority) is the one that is met, or else the one whose body has the highest priority: which of them a ray happened
//! to report does not matter.

use super::bodies::{Within, inward};
use crate::{
    bsdf::Bsdf,
    material::{Index, Material},
    math::Vec3,
    scene::Scene,
    shape::{Interaction, offset_point},
    spectrum::Wavelengths,
    surface::Openness,
    tally::Tally,
};

/// By how much more than the error of a hit two surfaces may differ and still coincide \[1\].
pub(super) const COINCIDENT: f32 = 4.0;
/// Objects whose faces may coincide; more are passed unseen.
const MOST_FACES: usize = 8;

/// What is at a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Skin {
    /// Nothing: light passes.
    Open,
    /// What its material says.
    Written,
    /// A boundary between two indices.
    Between {
        /// Index on the inside of the surface over that on the outside \[1\].
        eta: f32,
        /// Whether it is another at other wavelengths.
        disperses: bool,
    },
}

impl Skin {
    /// The BSDF; [`Bsdf::Null`] where nothing is.
    #[inline]
    pub fn bsdf<'s>(
        self,
        material: &'s Material,
        hit: &Interaction,
        wavelengths: &Wavelengths,
        hero: usize,
    ) -> Bsdf<'s> {
        match self {
            Self::Open => Bsdf::Null,
            Self::Written => material.bsdf(&hit.into(), wavelengths, hero),
            Self::Between { eta, .. } => material.bsdf_between(eta, &hit.into(), wavelengths),
        }
    }

    /// What of the light along `dir` passes straight.
    #[inline]
    pub(crate) fn openness(self, scene: &Scene, hit: &Interaction, dir: Vec3) -> Openness {
        match self {
            Self::Open => Openness { part: 1.0, crosses: true },
            Self::Between { .. } => Openness { part: 0.0, crosses: false },
            Self::Written => scene.openness(hit, dir),
        }
    }
}

impl Within {
    /// What a path meets that comes along `dir` to the surface `hit`, and what it is within if it passes. Where faces
    /// coincide, `hit` becomes the one that counts.
    pub fn meet(
        &self,
        scene: &Scene,
        hit: &mut Interaction,
        dir: Vec3,
        wavelengths: &Wavelengths,
        hero: usize,
        tally: &mut Tally,
    ) -> (Skin, Self) {
        let mut beyond = *self;
        beyond.cross(scene, hit, inward(dir, hit.ng), tally);
        if scene.has_bodies() {
            hit.error *= COINCIDENT;
            let met = *hit;
            for (face, inward) in coincident(scene, &met, dir) {
                beyond.cross(scene, &face, inward, tally);
                if rank(scene, &face) > rank(scene, hit) {
                    *hit = Interaction { error: face.error * COINCIDENT, ..face };
                }
            }
        }
        (self.skin(&beyond, scene, hit, dir, wavelengths, hero), beyond)
    }

    fn cross(&mut self, scene: &Scene, face: &Interaction, inward: bool, tally: &mut Tally) {
        let object = scene.object(face);
        match (object.body, &object.interface) {
            (Some(member), _) => {
                let closed = scene.bodies()[member.body.0 as usize].closed;
                if !self.cross_body(member.body, face.instance, inward, closed) {
                    tally.lost_bodies += 1;
                }
            }
            (None, Some(interface)) => self.cross_written(interface, if inward { -1.0 } else { 1.0 }),
            (None, None) => {}
        }
    }

    fn skin(
        &self,
        beyond: &Self,
        scene: &Scene,
        hit: &Interaction,
        dir: Vec3,
        wavelengths: &Wavelengths,
        hero: usize,
    ) -> Skin {
        if scene.object(hit).body.is_none() {
            return Skin::Written;
        }
        let indices = [self.index(scene), beyond.index(scene)];
        let [near, far] = indices.map(|index| index.map_or(1.0, |index| index.at(wavelengths, hero)));
        if near == far {
            return Skin::Open;
        }
        let eta = if inward(dir, hit.ng) { far / near } else { near / far };
        Skin::Between { eta, disperses: indices.into_iter().flatten().any(Index::disperses) }
    }
}

/// Which of coincident faces counts: ordinary ones with a material, then bodies by priority, then mere boundaries.
fn rank(scene: &Scene, face: &Interaction) -> (bool, bool, i32, std::cmp::Reverse<u32>) {
    let null = matches!(scene.material(face), Material::Null);
    match scene.object(face).body {
        None => (!null, false, i32::MIN, std::cmp::Reverse(face.object.0)),
        Some(member) => (false, !null, member.priority, std::cmp::Reverse(face.object.0)),
    }
}

/// Another surface at the place of a hit.
#[derive(Clone, Copy)]
struct Face {
    at: Interaction,
    /// How many more of its triangles look against the way across than along it: where the way runs through an edge,
    /// several do.
    inward: i32,
}

/// The other surfaces between the two places where rays leave `hit` to either side: each with whether it is entered.
pub(super) fn coincident(
    scene: &Scene,
    hit: &Interaction,
    dir: Vec3,
) -> impl Iterator<Item = (Interaction, bool)> + use<> {
    let across = if inward(dir, hit.ng) { -hit.ng } else { hit.ng };
    let [start, end] = [-across, across].map(|way| offset_point(hit.p, hit.error, hit.ng, way));
    let mut faces: [Option<Face>; MOST_FACES] = [None; MOST_FACES];
    scene.geometry.between(start, end, &mut |at| {
        if (at.object, at.instance) == (hit.object, hit.instance) {
            return;
        }
        let sign = if inward(across, at.ng) { 1 } else { -1 };
        let same = |f: &Face| (f.at.object, f.at.instance) == (at.object, at.instance);
        for slot in &mut faces {
            match slot {
                Some(face) if same(face) => face.inward += sign,
                Some(_) => continue,
                None => *slot = Some(Face { at, inward: sign }),
            }
            break;
        }
    });
    faces.into_iter().flatten().filter(|face| face.inward != 0).map(|face| (face.at, face.inward > 0))
}
