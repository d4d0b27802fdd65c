//! Boundaries without a material on a path's way, all passed in one search: fog in a room would else cost a ray where its box
//! begins, one where it ends, and one to the wall.
//!
//! The same flights are drawn in the same order as by stopping at each, with the same collisions aimed at lamps, and where the
//! search has not looked far enough another goes on.

use super::{Event, Path, aim::Aiming};
use crate::{math::Bounds, scene::Scene, shape::Passed, tally::Tally};

impl Path {
    /// The next event behind all boundaries that are open, where [`Scene::open_to_paths`] knows them, past a `lamp` if there is one to
    /// aim at. `None` leaves a flight for [`Self::next_event`] to follow, or has done nothing.
    #[inline]
    pub fn pass_open<'s>(
        &mut self,
        scene: &'s Scene,
        mut lamp: Option<Bounds>,
        aiming: &mut impl Aiming,
        tally: &mut Tally,
    ) -> Option<Event<'s>> {
        let open = scene.open_to_paths()?;
        if self.collision_is_due() {
            return None;
        }
        let mut flight = match self.unfinished_flight() {
            Some(flight) => {
                lamp = None;
                flight
            }
            None => self.sample_flight(),
        };
        let way = self.ray;
        let reach = if lamp.is_some() { f32::INFINITY } else { self.reach(scene, flight) };
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
            if t >= end {
                break;
            }
            let aim = self.aim(scene, lamp, t - from, aiming, tally);
            if t - from >= flight + scene.rounding(&self.ray, flight) {
                return Some(self.arrive(scene, None, flight, aim, tally));
            }
            self.pass(t - from);
            self.cross(scene, &surface);
            from = t;
            lamp = aiming.lamp(self);
            flight = self.sample_flight();
        }
        let stop = from + flight + scene.rounding(&self.ray, flight);
        match wall {
            Some(wall) => {
                let aim = self.aim(scene, lamp, wall.t - from, aiming, tally);
                if stop <= wall.t {
                    return Some(self.arrive(scene, None, flight, aim, tally));
                }
                self.pass(wall.t - from);
                Some(Event::Surface(scene.geometry.interaction(&way, &wall)))
            }
            None if stop <= reach => {
                // Only a way that is known to its end can be aimed along.
                let lamp = lamp.filter(|_| reach == f32::INFINITY);
                let aim = self.aim(scene, lamp, f32::INFINITY, aiming, tally);
                Some(self.arrive(scene, None, flight, aim, tally))
            }
            None => {
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
