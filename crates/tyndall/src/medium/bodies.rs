//! Bodies that may overlap: which of them a point is in, and which of those has it.
//!
//! A body is a closed surface with a priority, of a dielectric or of no material, and what fills it. Bodies may overlap in
//! any way. At each point the body of the highest priority is there and those below it are not: liquid that reaches into
//! the wall of its glass ends where the glass begins. Bodies of one priority mix: their coefficients add, and light is
//! scattered by one of them, by chance in the ratio of their `σ_s`.
//!
//! | of the bodies of the highest priority at a point | |
//! |---|---|
//! | `σ_a`, `σ_s`, emission | their sums |
//! | phase function | of one of them, with probability `σ_s,i / Σσ_s`, drawn at each collision |
//! | index of refraction, relative to vacuum \[1\] | that of the one with a dielectric surface (if several, the first in the scene); 1 if none has |
//!
//! Outside of all bodies is what the camera's surroundings and the surfaces without a priority say. Such a surface means
//! what its [`super::MediumInterface`] says, whatever bodies are around it, until a body's surface is crossed.
//!
//! A path carries a record of the bodies that it is in, [`Within`], and no ray is traced to find them but one at the
//! camera ([`super::enclosure`]). Source: Schmidt and Budge 2002, "Simple nested dielectrics in ray traced images".

use super::{Coefficients, Inside, MediumId, MediumInterface};
use crate::{
    material::{Index, Material},
    math::Vec3,
    scene::{MaterialId, Object, Scene},
    shape::{Geometry, ObjectId},
    spectrum::{Lanes, Wavelengths},
};

/// Index of a body of the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BodyId(pub u32);

/// That an object is (part of) the surface of a body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Member {
    /// Which. Objects of one body bound it together.
    pub body: BodyId,
    /// The body of the highest priority is there.
    pub priority: i32,
}

/// A body, gathered from its objects.
#[derive(Debug, Clone)]
pub struct Body {
    /// The body of the highest priority is there.
    pub priority: i32,
    /// What fills it.
    pub medium: Option<MediumId>,
    /// Index of refraction relative to vacuum; `None` if its surface has no material.
    pub index: Option<Index>,
    /// Its surface.
    pub objects: Vec<ObjectId>,
    /// Whether its surface has no edge.
    pub closed: bool,
}

impl Body {
    /// The bodies of a scene. Their ids become their places in the list.
    pub(crate) fn gather(objects: &mut [Object], materials: &[Material], geometry: &Geometry) -> Vec<Self> {
        let mut bodies: Vec<Self> = Vec::new();
        let mut places = std::collections::HashMap::new();
        for (i, object) in objects.iter_mut().enumerate() {
            let Some(member) = &mut object.body else { continue };
            let place = *places.entry(member.body).or_insert_with(|| {
                bodies.push(Self {
                    priority: member.priority,
                    medium: object.interface.and_then(|interface| interface.inside),
                    index: even(materials, object.material).index().cloned(),
                    objects: Vec::new(),
                    closed: false,
                });
                bodies.len() - 1
            });
            member.body = BodyId(place as u32);
            bodies[place].objects.push(ObjectId(i as u32));
        }
        for body in &mut bodies {
            body.closed = geometry.is_closed(&body.objects);
        }
        bodies
    }
}

/// A material without its relief.
fn even(materials: &[Material], id: MaterialId) -> &Material {
    match &materials[id.0 as usize] {
        Material::Embossed { of, .. } => &materials[of.0 as usize],
        plain => plain,
    }
}

/// Bodies that one record can hold.
const DEPTH: usize = 8;

/// A body, or one placed copy of it, and how many times a path is inside of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Entry {
    body: u32,
    instance: u32,
    count: u32,
}

/// What a surface without a priority has said of the medium, in spite of the bodies around it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Said {
    /// None was crossed since the last surface of a body.
    #[default]
    Nothing,
    /// This is here.
    Medium(Option<MediumId>),
}

/// What surrounds a point: the bodies that it is in, and what surfaces without a priority have said.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Within {
    /// The medium outside of all bodies.
    around: Option<MediumId>,
    /// What a surface without a priority has said, since the last surface of a body.
    said: Said,
    entries: [Entry; DEPTH],
    len: usize,
}

/// One of the media that share a place, for one collision.
#[derive(Debug, Clone, Copy)]
pub struct Part {
    /// Which.
    pub id: MediumId,
    /// `σ_s,i / Σσ_s` in each lane: the factor on the path's throughput [1].
    pub share: Lanes,
    /// The probability with which each lane takes this part \[1\]: the share, or any where nothing scatters.
    pub probability: Lanes,
}

impl Within {
    /// Outside of all bodies, in `around`.
    pub fn outside(around: Option<MediumId>) -> Self {
        Self { around, ..Self::default() }
    }

    /// Notes that a surface of a body is crossed; `false` if the record is full and the body counts as not there.
    pub(super) fn cross_body(&mut self, body: BodyId, instance: u32, inward: bool, closed: bool) -> bool {
        self.said = Said::Nothing;
        let found = self.entries[..self.len].iter().position(|e| (e.body, e.instance) == (body.0, instance));
        match (found, inward) {
            // Of a surface with an edge nobody can count the crossings: the last one holds.
            (Some(i), true) if closed => self.entries[i].count += 1,
            (Some(_), true) | (None, false) => {}
            (Some(i), false) => {
                self.entries[i].count -= 1;
                if self.entries[i].count == 0 {
                    self.len -= 1;
                    self.entries.swap(i, self.len);
                }
            }
            (None, true) if self.len < DEPTH => {
                self.entries[self.len] = Entry { body: body.0, instance, count: 1 };
                self.len += 1;
            }
            (None, true) => return false,
        }
        true
    }

    /// Notes that a surface without a priority is crossed, to the side where `cos_normal = dir · n`.
    pub(crate) fn cross_written(&mut self, interface: &MediumInterface, cos_normal: f32) {
        let medium = interface.towards(cos_normal);
        if self.len == 0 {
            self.around = medium;
        } else {
            self.said = Said::Medium(medium);
        }
    }

    /// Says what the medium is, in spite of all bodies (a camera whose medium the scene gives).
    pub(super) fn say(&mut self, medium: MediumId) {
        if self.len > 0 {
            self.said = Said::Medium(Some(medium));
        }
        self.around = Some(medium);
    }

    /// The bodies of the highest priority, in the order of the scene.
    fn winners<'a>(&self, scene: &'a Scene) -> impl Iterator<Item = &'a Body> + use<'a> {
        let bodies = scene.bodies();
        let (entries, len) = (self.entries, self.len);
        let top = entries[..len].iter().map(|e| bodies[e.body as usize].priority).max();
        let mut ids = entries.map(|e| e.body);
        ids[..len].sort_unstable();
        (0..len).map(move |i| &bodies[ids[i] as usize]).filter(move |body| Some(body.priority) == top)
    }

    /// The index of refraction relative to vacuum; `None` for 1.
    pub(super) fn index<'a>(&self, scene: &'a Scene) -> Option<&'a Index> {
        self.winners(scene).find_map(|body| body.index.as_ref())
    }

    /// The media that are here.
    fn media(&self, scene: &Scene) -> impl Iterator<Item = MediumId> {
        let (bodies, written) = match self.said {
            _ if self.len == 0 => (false, self.around),
            Said::Nothing => (true, None),
            Said::Medium(medium) => (false, medium),
        };
        let bodies = bodies.then(|| self.winners(scene).filter_map(|body| body.medium));
        bodies.into_iter().flatten().chain(written)
    }

    /// The medium here, with its coefficients.
    pub fn inside(&self, scene: &Scene, wavelengths: &Wavelengths) -> Inside {
        if self.len == 0 { Inside::of(scene, self.around, wavelengths) } else { self.inside_bodies(scene, wavelengths) }
    }

    fn inside_bodies(&self, scene: &Scene, wavelengths: &Wavelengths) -> Inside {
        let mut media = self.media(scene);
        let Some(first) = media.next() else { return Inside::Vacuum };
        let mut rest = media.peekable();
        if rest.peek().is_none() {
            return Inside::of(scene, Some(first), wavelengths);
        }
        let of = |id: MediumId| scene.medium(id).coefficients(wavelengths);
        Inside::Mixture { coefficients: rest.fold(of(first), |sum, id| sum + of(id)) }
    }

    /// One of the media that share this place, for a collision in a mixture; `u` in [0, 1).
    ///
    /// The choice is part of the path: what it weighs and with which probability each lane would have made it is for
    /// [`crate::path::PathWeights::choose`].
    pub fn choose_part(&self, scene: &Scene, wavelengths: &Wavelengths, hero: usize, u: f32) -> Option<Part> {
        let sigma_s = |id: MediumId| scene.medium(id).coefficients(wavelengths).sigma_s;
        let (total, count) = self.media(scene).fold((Lanes::ZERO, 0.0), |(t, n), id| (t + sigma_s(id), n + 1.0));
        let share = |s: Lanes, empty: f32| {
            Lanes::new(std::array::from_fn(|lane| {
                let total = total.lane(lane);
                if total > 0.0 { s.lane(lane) / total } else { empty }
            }))
        };
        let mut below = 0.0;
        let mut chosen = None;
        for id in self.media(scene) {
            let probability = share(sigma_s(id), 1.0 / count);
            if probability.lane(hero) > 0.0 {
                chosen = Some((id, probability));
                below += probability.lane(hero);
                if u < below {
                    break;
                }
            }
        }
        let (id, probability) = chosen?;
        Some(Part { id, share: share(sigma_s(id), 0.0), probability })
    }
}

impl std::ops::Add for Coefficients {
    type Output = Self;
    /// Media that share a place.
    fn add(self, other: Self) -> Self {
        Self {
            sigma_t: self.sigma_t + other.sigma_t,
            sigma_s: self.sigma_s + other.sigma_s,
            source: self.source + other.source,
        }
    }
}

/// Whether light that travels along `dir` enters the body whose surface has the normal `ng`.
pub(super) fn inward(dir: Vec3, ng: Vec3) -> bool {
    dir.dot(ng) < 0.0
}
