//! Whether light arrives: shadow rays, through surfaces without a material or with holes, with analytic transmittance.

use crate::{
    light::Target,
    math::{Ray, Vec3, rounding::gamma},
    medium::{Inside, Skin, Within},
    scene::Scene,
    shape::{Interaction, Passed, offset_point},
    spectrum::{Lanes, Wavelengths},
    tally::Tally,
};

/// The transmittance from `origin` to a light, or `None` when a surface stands between.
///
/// `medium` and `within` are those that the ray starts in; `hero` is the lane that says whether two indices are the same.
/// `origin` must have been moved off the surface it lies on; the light's end is moved off here.
#[inline]
pub fn transmittance(
    scene: &Scene,
    origin: Vec3,
    dir: Vec3,
    target: &Target,
    (mut inside, within): (Inside, &Within),
    (wavelengths, hero): (&Wavelengths, usize),
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
    if let Some(open) = scene.open() {
        tally.shadow_rays += 1;
        let mut passed = Passed::default();
        if scene.geometry.occluded_but(&ray, t_max, open, &mut passed) {
            return None;
        }
        if let Some(surfaces) = passed.surfaces(&scene.geometry, &ray) {
            return through(scene, ray.dir, t_max, surfaces, inside, wavelengths);
        }
    }
    let mut transmittance = Lanes::ONE;
    let mut within = *within;
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
        let mut surface = scene.geometry.interaction(&ray, &hit);
        let (skin, beyond) = if scene.has_bodies() {
            within.meet(scene, &mut surface, ray.dir, wavelengths, hero, tally)
        } else {
            (Skin::Written, within)
        };
        let open = skin.openness(scene, &surface, ray.dir);
        if open.part <= 0.0 {
            return None;
        }
        transmittance *= open.part;
        if scene.has_bodies() {
            if open.crosses {
                within = beyond;
                inside = within.inside(scene, wavelengths);
            }
        } else if let Some(interface) = scene.object(&surface).interface.filter(|_| open.crosses) {
            inside = Inside::of(scene, interface.towards(ray.dir.dot(surface.ng)), wavelengths);
        }
        let next = surface.spawn(ray.dir).origin;
        (ray, t_max) = segment(next, dir, target);
        if t_max <= 0.0 {
            return Some(transmittance);
        }
    }
}

/// The transmittance of a segment of length `t_max` along `dir` that meets these surfaces without a material, at these distances.
pub(super) fn through(
    scene: &Scene,
    dir: Vec3,
    t_max: f32,
    surfaces: impl Iterator<Item = (f32, Interaction)>,
    mut inside: Inside,
    wavelengths: &Wavelengths,
) -> Option<Lanes> {
    let mut transmittance = Lanes::ONE;
    let mut from = 0.0;
    for (t, surface) in surfaces {
        if let Some(coefficients) = inside.coefficients() {
            transmittance *= coefficients.transmittance(t - from);
            if transmittance.is_zero() {
                return None;
            }
        }
        if let Some(interface) = scene.object(&surface).interface {
            inside = Inside::of(scene, interface.towards(dir.dot(surface.ng)), wavelengths);
        }
        from = t;
    }
    if let Some(coefficients) = inside.coefficients() {
        transmittance *= coefficients.transmittance(t_max - from);
    }
    Some(transmittance)
}

/// What of the way from `origin` to a light no surface blocks \[1\], media left out of account: 1 or 0, but for surfaces
/// that are open in part.
pub fn visible(
    scene: &Scene,
    origin: Vec3,
    dir: Vec3,
    target: &Target,
    within: &Within,
    (wavelengths, hero): (&Wavelengths, usize),
    tally: &mut Tally,
) -> f32 {
    let (mut ray, mut t_max) = segment(origin, dir, target);
    let mut within = *within;
    let mut open = 1.0;
    loop {
        tally.shadow_rays += 1;
        let Some(hit) = scene.geometry.intersect(&ray, t_max) else { return open };
        let mut surface = scene.geometry.interaction(&ray, &hit);
        let (skin, beyond) = within.meet(scene, &mut surface, ray.dir, wavelengths, hero, tally);
        let here = skin.openness(scene, &surface, ray.dir);
        open *= here.part;
        if open <= 0.0 {
            return 0.0;
        }
        if here.crosses {
            within = beyond;
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
