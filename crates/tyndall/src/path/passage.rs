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
        let Some(surfaces) = passed.surfaces(&scene.geometry, &way) else {
            self.leave_flight(flight);
            return None;
        };
        let mut from = 0.0;
        for (t, surface) in surfaces {
            if t >= end || t - from >= flight + scene.rounding(&self.ray, flight) {
                break;
            }
            self.pass(t - from);
            self.cross(scene, &surface);
            from = t;
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
