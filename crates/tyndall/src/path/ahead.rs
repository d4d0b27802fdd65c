//! What there is to find along the way of a path, beside what its flight finds: lamps that collisions are aimed at, and the light
//! at the end of the way.
//!
//! **Light at the end.** A path that goes towards a lamp through fog reaches it with probability `T`, the transmittance, and counts
//! its radiance `L` in full when it does. In a clear medium ([`Scene::looks_ahead`]) the path looks to the end of its way before it
//! draws a flight, counts `T·L`, the mean of that, and nothing when it gets there (the *expected-value estimator* of particle
//! transport). Then a lamp in fog is as free of noise as one in a vacuum.
//!
//! Multiple importance sampling with light samples must know: scattering finds the light with its density over directions alone
//! ([`Scene::reached`]). Whether a path looks depends on what it is in where its way begins and on nothing that is drawn later.
//!
//! Source: Spanier and Gelbard 1969, "Monte Carlo Principles and Neutron Transport Problems", § 2.8.

use super::{Path, event::Aimed};
use crate::{
    math::Bounds,
    medium::Inside,
    scene::{Emission, Scene},
    shape::{Hit, Interaction},
    spectrum::Lanes,
    tally::Tally,
};

/// Who is asked what a path is to look for along its way, and told what it has found.
pub trait Seeker {
    /// A lamp to aim at, where a flight begins.
    fn lamp(&mut self, path: &mut Path) -> Option<Bounds>;

    /// A collision that was aimed at it.
    fn aimed(&mut self, path: &Path, aimed: &Aimed, tally: &mut Tally);

    /// Whether a path whose way begins in this looks for light at the end of it.
    fn looks(&self, inside: &Inside) -> bool;

    /// The way of the path ends at a surface, or nowhere, through this transmittance.
    fn seen(&mut self, path: &Path, end: Option<&Interaction>, transmittance: Lanes, tally: &mut Tally);
}

/// Who looks for nothing.
impl Seeker for () {
    fn lamp(&mut self, _: &mut Path) -> Option<Bounds> {
        None
    }

    fn aimed(&mut self, _: &Path, _: &Aimed, _: &mut Tally) {}

    fn looks(&self, _: &Inside) -> bool {
        false
    }

    fn seen(&mut self, _: &Path, _: Option<&Interaction>, _: Lanes, _: &mut Tally) {}
}

impl Path {
    /// Finds the light at the end of the way, at a surface or nowhere; `transmittance` is asked for if anything can shine there, and
    /// is `None` where nothing comes through.
    #[inline]
    pub(super) fn foresee(
        &mut self,
        scene: &Scene,
        end: Option<Hit>,
        transmittance: impl FnOnce() -> Option<Lanes>,
        seeker: &mut impl Seeker,
        tally: &mut Tally,
    ) {
        self.foreseen = true;
        let shines = match end {
            Some(hit) => scene.objects[hit.object.0 as usize].emission != Emission::None,
            None => !scene.lights.environments.is_empty(),
        };
        if shines && let Some(transmittance) = transmittance() {
            let surface = end.map(|hit| scene.geometry.interaction(&self.ray, &hit));
            seeker.seen(self, surface.as_ref(), transmittance, tally);
        }
    }
}

impl Scene {
    /// The probability with which a direction that leads to a light from where this is finds it, in each lane: all of it where paths
    /// look ahead, else as often as their flights get there \[1\].
    #[inline]
    pub fn reached(&self, inside: &Inside, transmittance: Lanes) -> Lanes {
        if self.looks_ahead(inside) { Lanes::ONE } else { transmittance }
    }
}
