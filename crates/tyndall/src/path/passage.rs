//! Boundaries without a material on a path's way, all passed in one search: fog in a room would else cost a ray where its box
//! begins, one where it ends, and one to the wall.
//!
//! The same flights are drawn in the same order as by stopping at each, and where the search has not looked far enough another
//! goes on.

use super::{Event, Path};
use crate::{scene::Scene, shape::Passed, tally::Tally};

impl Path {
    /// The next event behind all boundaries that are open, where [`Scene::open_to_paths`] knows them. `None` leaves a flight for
    /// [`Self::next_event`] to follow, or has done nothing.
    #[inline]
    pub fn pass_open<'s>(&mut self, scene: &'s Scene, tally: &mut Tally) -> Option<Event<'s>> {
        let open = scene.open_to_paths()?;
        if self.collision_is_due() {
            return None;
        }
        let mut flight = self.unfinished_flight().unwrap_or_else(|| self.sample_flight());
        let way = self.ray;
        let reach = self.reach(scene, flight);
        tally.rays += 1;
        let mut passed = Passed::default();
        let wall = scene.geometry.intersect_but(&way, reach, open, &mut passed);
        let end = wall.map_or(reach, |wall| wall.t);
        let Some(hits) = passed.in_order() else {
            self.leave_flight(flight);
            return None;
        };
        let (mut from, mut clear) = (0.0, 0.0);
        for hit in hits {
            if hit.t <= clear {
                continue;
            }
            if hit.t >= end || hit.t - from >= flight + scene.rounding(&self.ray, flight) {
                break;
            }
            self.pass(hit.t - from);
            let surface = scene.geometry.interaction(&way, &hit);
            self.cross(scene, &surface);
            (from, clear) = (hit.t, surface.end_of_error(hit.t, way.dir));
            flight = self.sample_flight();
        }
        let stop = from + flight + scene.rounding(&self.ray, flight);
        match wall {
            Some(wall) if wall.t < stop => {
                self.pass(wall.t - from);
                Some(Event::Surface(scene.geometry.interaction(&way, &wall)))
            }
            _ if stop <= reach => Some(self.arrive(scene, None, flight, None, tally)),
            _ => {
                self.leave_flight(flight);
                None
            }
        }
    }

    /// How far to look: as far as the flight, or to the end where it is likely to leave the medium.
    #[inline]
    fn reach(&self, scene: &Scene, flight: f32) -> f32 {
        let leaves = self.inside.id().is_none_or(|id| flight > scene.deepest(id));
        if leaves { f32::INFINITY } else { flight + scene.rounding(&self.ray, flight) }
    }
}
