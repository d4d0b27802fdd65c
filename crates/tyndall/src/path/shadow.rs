//! Whether light arrives: shadow rays, through surfaces without a material or with holes, with analytic transmittance.

use crate::{
    light::Target,
    math::{Ray, Vec3, rounding::gamma},
    medium::Inside,
    scene::Scene,
    shape::offset_point,
    spectrum::{Lanes, Wavelengths},
    tally::Tally,
};

/// The transmittance from `origin` to a light, or `None` when a surface stands between.
///
/// `origin` must have been moved off the surface it lies on; the light's end is moved off here.
#[inline]
pub fn transmittance(
    scene: &Scene,
    origin: Vec3,
    dir: Vec3,
    target: &Target,
    mut inside: Inside,
    wavelengths: &Wavelengths,
    tally: &mut Tally,
) -> Option<Lanes> {
    let (mut ray, mut t_max) = segment(origin, dir, target);
    if !scene.has_null_surfaces() {
        tally.shadow_rays += 1;
        if scene.geometry.occluded(&ray, t_max) {
            return None;
        }
        return Some(inside.coefficients().map_or(Lanes::ONE, |c| c.transmittance(t_max)));
    }
    let mut transmittance = Lanes::ONE;
    loop {
        tally.shadow_rays += 1;
        let hit = scene.geometry.intersect(&ray, t_max);
        let distance = hit.map_or(t_max, |h| h.t);
        if let Some(coefficients) = inside.coefficients() {
            transmittance *= coefficients.transmittance(distance);
            if transmittance.is_zero() {
                return None;
            }
        }
        let Some(hit) = hit else { return Some(transmittance) };
        let surface = scene.geometry.interaction(&ray, &hit);
        let open = scene.openness(&surface, ray.dir);
        if open.part <= 0.0 {
            return None;
        }
        transmittance *= open.part;
        if let Some(interface) = scene.object(&surface).interface.filter(|_| open.crosses) {
            inside = Inside::of(scene, interface.towards(ray.dir.dot(surface.ng)), wavelengths);
        }
        let next = surface.spawn(ray.dir).origin;
        (ray, t_max) = segment(next, dir, target);
        if t_max <= 0.0 {
            return Some(transmittance);
        }
    }
}

/// What of the way from `origin` to a light no surface blocks \[1\], media left out of account: 1 or 0, but for surfaces
/// that are open in part.
pub fn visible(scene: &Scene, origin: Vec3, dir: Vec3, target: &Target, tally: &mut Tally) -> f32 {
    let (mut ray, mut t_max) = segment(origin, dir, target);
    let mut open = 1.0;
    loop {
        tally.shadow_rays += 1;
        let Some(hit) = scene.geometry.intersect(&ray, t_max) else { return open };
        let surface = scene.geometry.interaction(&ray, &hit);
        open *= scene.openness(&surface, ray.dir).part;
        if open <= 0.0 {
            return 0.0;
        }
        (ray, t_max) = segment(surface.spawn(ray.dir).origin, dir, target);
        if t_max <= 0.0 {
            return open;
        }
    }
}

/// The ray to a light and how far it may go: the light's end is moved off its surface by the bound on its error, and
/// the length is shortened by the rounding error of a ray–surface test.
fn segment(origin: Vec3, dir: Vec3, target: &Target) -> (Ray, f32) {
    let end = match *target {
        Target::Infinity => return (Ray::new(origin, dir), f32::INFINITY),
        Target::Point(p) => p,
        Target::Surface { p, error, ng } => offset_point(p, error, ng, -dir),
    };
    let to_end = end - origin;
    let distance = to_end.length();
    if distance == 0.0 || to_end.dot(dir) <= 0.0 {
        return (Ray::new(origin, dir), 0.0);
    }
    (Ray::new(origin, to_end / distance), distance * (1.0 - gamma(12)))
}
