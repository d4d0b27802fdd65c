//! What a ray passes on its way: surfaces that are open, all of them in one search, where a ray for each would begin anew.

use super::{
    Geometry, Hit, Interaction, ObjectId,
    bvh::traverse::{Met, Nearest},
};
use crate::math::Ray;

/// Most surfaces that are noted on a way.
const MOST: usize = 8;

/// The hits of a ray on open surfaces.
#[derive(Debug, Clone)]
pub struct Passed {
    hits: [Nearest; MOST],
    /// How many there were, noted or not.
    len: usize,
}

impl Default for Passed {
    #[inline]
    fn default() -> Self {
        Self { hits: [Nearest::before(0.0); MOST], len: 0 }
    }
}

impl Passed {
    /// In the order of their distances; `None` if there were too many. Where faces meet, an edge can be hit on both.
    #[inline]
    pub fn in_order(&mut self) -> Option<impl Iterator<Item = Hit>> {
        let hits = self.hits.get_mut(..self.len)?;
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
        // A packet that is not full repeats its last triangle.
        let last = self.len.checked_sub(1).and_then(|last| self.hits.get(last));
        if last.is_some_and(|last| last.is_again(&hit)) {
            return;
        }
        if let Some(place) = self.hits.get_mut(self.len) {
            *place = hit;
        }
        self.len += 1;
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
    #[inline(always)]
    fn is_again(&self, other: &Self) -> bool {
        (self.prim, self.object, self.instance) == (other.prim, other.object, other.instance)
    }

    #[inline]
    pub(super) fn hit(&self) -> Hit {
        let Self { t, object, prim, instance, uv } = *self;
        Hit { t, object: ObjectId(object), prim, uv, instance }
    }
}
