//! What a ray passes on its way: surfaces that are open, all of them in one search, where a ray for each would begin anew.

use super::{
    Geometry, Hit, Interaction, ObjectId,
    bvh::traverse::{Met, Nearest},
};
use crate::math::Ray;

/// Surfaces that most ways have at most.
const FEW: usize = 8;
/// Most surfaces that are noted on a way.
const MOST: usize = 1024;

/// The hits of a ray on open surfaces.
#[derive(Debug, Clone)]
pub struct Passed {
    few: [Nearest; FEW],
    /// All of them where there are more.
    many: Vec<Nearest>,
    /// How many there were, noted or not.
    len: usize,
}

impl Default for Passed {
    #[inline]
    fn default() -> Self {
        Self { few: [Nearest::before(0.0); FEW], many: Vec::new(), len: 0 }
    }
}

impl Passed {
    /// Whether there were more than can be told.
    #[inline]
    pub fn are_too_many(&self) -> bool {
        self.len > MOST
    }

    /// In the order of their distances; `None` if there were too many. Where faces meet, an edge can be hit on both.
    #[inline]
    pub fn in_order(&mut self) -> Option<impl Iterator<Item = Hit>> {
        if self.are_too_many() {
            return None;
        }
        let hits = if self.many.is_empty() { &mut self.few[..self.len] } else { &mut self.many[..] };
        hits.sort_unstable_by(|a, b| a.t.total_cmp(&b.t));
        Some(hits.iter().map(Nearest::hit))
    }

    /// The surfaces in that order, with their distances. One that is within the error of another is passed with it, as by a ray
    /// that leaves there.
    #[inline]
    pub fn surfaces(&mut self, geometry: &Geometry, ray: &Ray) -> Option<impl Iterator<Item = (f32, Interaction)>> {
        let mut clear = 0.0;
        let hits = self.in_order()?;
        Some(hits.filter_map(move |hit| {
            if hit.t <= clear {
                return None;
            }
            let surface = geometry.interaction(ray, &hit);
            clear = surface.end_of_error(hit.t, ray.dir);
            Some((hit.t, surface))
        }))
    }

    #[inline(always)]
    fn note(&mut self, hit: Nearest) {
        match self.few.get_mut(self.len) {
            Some(place) => *place = hit,
            None => self.note_many(hit),
        }
        self.len += 1;
    }

    #[cold]
    fn note_many(&mut self, hit: Nearest) {
        if self.many.is_empty() {
            self.many.extend_from_slice(&self.few);
        }
        if self.many.len() < MOST {
            self.many.push(hit);
        }
    }
}

/// What is seen through open surfaces.
pub(super) struct View<'a> {
    pub(super) nearest: Nearest,
    /// By object.
    pub(super) open: &'a [bool],
    pub(super) passed: &'a mut Passed,
}

impl Met for View<'_> {
    #[inline(always)]
    fn limit(&self) -> f32 {
        self.nearest.t
    }

    #[inline(always)]
    fn is_blocked(&self) -> bool {
        self.nearest.found()
    }

    #[inline(always)]
    fn take(&mut self, hit: Nearest) {
        if self.open[hit.object as usize] {
            self.passed.note(hit);
        } else {
            self.nearest = hit;
        }
    }
}

/// What is met inside of an instance.
pub(super) struct Placed<'a, M> {
    pub(super) met: &'a mut M,
    pub(super) instance: u32,
}

impl<M: Met> Met for Placed<'_, M> {
    #[inline(always)]
    fn limit(&self) -> f32 {
        self.met.limit()
    }

    #[inline(always)]
    fn is_blocked(&self) -> bool {
        self.met.is_blocked()
    }

    #[inline(always)]
    fn take(&mut self, hit: Nearest) {
        self.met.take(Nearest { instance: self.instance, ..hit });
    }
}

impl Nearest {
    #[inline]
    pub(super) fn hit(&self) -> Hit {
        let Self { t, object, prim, instance, uv } = *self;
        Hit { t, object: ObjectId(object), prim, uv, instance }
    }
}
