//! Boundaries without a material on a path's way, all passed in one search: fog in a room would else cost a ray where its box
//! begins, one where it ends, and one to the wall.
//!
//! The same flights are drawn in the same order as by stopping at each, with the same collisions aimed at lamps, and where the
//! search has not looked far enough another goes on.

use super::{Event, Path, ahead::Seeker, shadow};
use crate::{scene::Scene, shape::Passed, tally::Tally};

impl Path {
    /// The next event behind all boundaries that are open, where [`Scene::open_to_paths`] knows them, past lamps if there are any to
    /// aim at. `None` leaves a flight for [`Self::next_event_past`] to follow, or has done nothing.
    #[inline]
    pub fn pass_open<'s>(
        &mut self,
        scene: &'s Scene,
        seeker: &mut impl Seeker,
        tally: &mut Tally,
    ) -> Option<Event<'s>> {
        let open = scene.open_to_paths()?;
        if self.collision_is_due() {
            return None;
        }
        let (mut flight, mut lamp) = self.begin_flight(seeker);
        if self.stays_clear(flight) {
            return Some(self.arrive(scene, None, flight, None, tally));
        }
        let way = self.ray;
        self.foreseen = false;
        let looks = seeker.looks(&self.inside);
        let reach = if looks || lamp.is_some() { f32::INFINITY } else { self.reach(scene, flight) };
        tally.rays += 1;
        let mut passed = Passed::default();
        let wall = scene.geometry.intersect_but(&way, reach, open, &mut passed);
        let end = wall.map_or(reach, |wall| wall.t);
        if looks && !passed.are_too_many() {
            let (inside, wavelengths) = (self.inside, self.wavelengths);
            let transmittance = || {
                let surfaces = passed.surfaces(&scene.geometry, &way)?.take_while(|(t, _)| *t < end);
                shadow::through(scene, way.dir, end, surfaces, inside, &wavelengths)
            };
            self.foresee(scene, wall, transmittance, seeker, tally);
        }
        let Some(mut surfaces) = passed.surfaces(&scene.geometry, &way) else {
            self.leave_flight(flight);
            return None;
        };
        let mut from = 0.0;
        loop {
            let boundary = surfaces.next().filter(|(t, _)| *t < end);
            let to = boundary.map_or(end, |(t, _)| t);
            // Only a way that is known to its end can be aimed along.
            let is_known = boundary.is_some() || wall.is_some() || end == f32::INFINITY;
            let aim = self.aim(scene, lamp.filter(|_| is_known), to - from, seeker, tally);
            if to - from >= flight + scene.rounding(&self.ray, flight) {
                return Some(self.arrive(scene, None, flight, aim, tally));
            }
            let Some((_, surface)) = boundary else { break };
            self.pass(to - from);
            self.cross(scene, &surface);
            from = to;
            (flight, lamp) = self.begin_flight(seeker);
        }
        let Some(wall) = wall else {
            self.leave_flight(flight);
            return None;
        };
        self.pass(wall.t - from);
        Some(Event::Surface(scene.geometry.interaction(&way, &wall)))
    }

    /// How far to look: as far as the flight, or to the end where it leaves the medium for certain or is likely to.
    #[inline]
    fn reach(&self, scene: &Scene, flight: f32) -> f32 {
        let leaves = self.inside.id().is_none_or(|id| flight > scene.deepest(id) || scene.room(id).is_some());
        if leaves { f32::INFINITY } else { flight + scene.rounding(&self.ray, flight) }
    }
}
