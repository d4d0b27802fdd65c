//! The naive twin: one wavelength at a time, absorption by chance, no weights in media, no multiple importance
//! sampling. Slow, obvious, and right: what [`super::VolPath`] must agree with.
//!
//! Lights that a path can run into are found only by running into them. Dirac lights, which no path can run into, are
//! gathered at each vertex.

use super::{CameraSample, Integrator, in_one_lane};
use crate::{
    bsdf::Bsdf,
    light::Light,
    material::Material,
    math::{Ray, Vec2, Vec3},
    medium::{Inside, Within},
    path::{History, Vertex, shadow},
    sampling::Sampler,
    scene::Scene,
    spectrum::{Lanes, Wavelengths},
    tally::Tally,
};

/// The analog estimator.
#[derive(Debug, Clone, Copy, Default)]
pub struct Analog;

impl Integrator for Analog {
    fn li(&self, scene: &Scene, seen: &CameraSample, tally: &mut Tally) -> Lanes {
        let CameraSample { ray, wavelengths, u_hero, mut sampler } = *seen;
        in_one_lane(scene.color, u_hero, |lane| walk(scene, ray, &wavelengths, lane, &mut sampler, tally))
    }
}

/// The radiance along `ray` in one lane.
fn walk(scene: &Scene, mut ray: Ray, w: &Wavelengths, lane: usize, sampler: &mut Sampler, tally: &mut Tally) -> f32 {
    let mut within = *scene.around_camera();
    let mut inside = within.inside(scene, w);
    let (mut radiance, mut throughput) = (0.0, 1.0);
    let mut history = History::default();
    let mut last_vertex = ray.origin;
    loop {
        let [sigma_t, sigma_s, source] =
            inside.coefficients().map_or([0.0; 3], |c| [c.sigma_t, c.sigma_s, c.source].map(|l| l.lane(lane)));
        let flight = if sigma_t > 0.0 { -sampler.rng.next_positive().ln() / sigma_t } else { f32::INFINITY };
        tally.rays += 1;
        let hit = scene.first_surface(&ray, flight);

        let (vertex, beyond) = match hit {
            None if flight.is_finite() => {
                tally.collisions += 1;
                let (id, share) = match &inside {
                    Inside::Vacuum => return radiance,
                    Inside::Medium { id, .. } => (*id, 1.0),
                    Inside::Mixture { .. } => match within.choose_part(scene, w, lane, sampler.next_1d()) {
                        None => return radiance,
                        Some(part) => (part.id, part.share.lane(lane) / part.probability.lane(lane)),
                    },
                };
                let p = ray.at(flight);
                if !scene.may_contain(id, p) {
                    tally.leaks += 1;
                    return radiance;
                }
                if sampler.next_1d() * sigma_t >= sigma_s {
                    // Absorbed; and what absorbs emits L_e.
                    return if source > 0.0 { radiance + throughput * source / (sigma_t - sigma_s) } else { radiance };
                }
                throughput *= share; // 0 where nothing scatters, else 1
                (Vertex::Medium { p, dir: ray.dir, medium: id, phase: &scene.medium(id).phase }, within)
            }
            None => {
                let sky = scene
                    .lights
                    .environments
                    .iter()
                    .map(|id| scene.lights.get(*id).le_from_infinity(last_vertex, ray.dir, w).lane(lane));
                return radiance + throughput * sky.sum::<f32>();
            }
            Some(hit) => {
                let mut surface = scene.geometry.interaction(&ray, &hit);
                let (skin, beyond) = within.meet(scene, &mut surface, ray.dir, w, lane, tally);
                let (material, relief) = scene.meet(&surface, ray.dir, || sampler.next_1d());
                if matches!(material, Material::Hole) {
                    ray = surface.spawn(ray.dir);
                    continue;
                }
                if let Some((_, light)) = scene.light_at(&surface) {
                    radiance += throughput * light.le(surface.ng, -ray.dir, || (&surface).into(), w).lane(lane);
                }
                let bsdf = skin.bsdf(material, &surface, w, lane).seeded(|| sampler.rng.next_u32());
                if matches!(bsdf, Bsdf::Null) {
                    (within, inside) = (beyond, beyond.inside(scene, w));
                    ray = surface.spawn(ray.dir);
                    continue;
                }
                tally.surface_vertices += 1;
                (Vertex::met(scene, surface, bsdf, ray.dir, relief), beyond)
            }
        };

        last_vertex = vertex.reference().p;
        radiance += throughput * dirac_lights(scene, &vertex, ray.dir, [&within, &beyond], (w, lane), sampler, tally);
        let Some(next) = vertex.sample([sampler.next_1d(), sampler.next_1d(), sampler.next_1d()]) else {
            return radiance;
        };
        throughput *= next.weight.lane(lane);
        if throughput == 0.0 {
            return radiance;
        }
        // A surface absorbs by chance, as a medium does; radiance compressed by refraction is no loss.
        history.scattered(next.specular);
        let survival = (next.weight.lane(lane) * next.eta * next.eta).min(history.survival());
        if survival < 1.0 {
            if sampler.next_1d() >= survival {
                return radiance;
            }
            throughput /= survival;
        }
        ray = next.ray;
        if next.crossed {
            (within, inside) = (beyond, beyond.inside(scene, w));
        }
    }
}

/// What lights without extent give at a vertex that was reached along `dir`: all of them. Lights without a surface belong
/// to them.
fn dirac_lights(
    scene: &Scene,
    vertex: &Vertex,
    dir: Vec3,
    [within, beyond]: [&Within; 2],
    (w, lane): (&Wavelengths, usize),
    sampler: &mut Sampler,
    tally: &mut Tally,
) -> f32 {
    if !vertex.can_use_light_samples() {
        return 0.0;
    }
    let reference = vertex.reference();
    let mut sum = 0.0;
    for light in scene.lights.lights.iter().filter(|light| light.is_hidden()) {
        let u = if matches!(light, Light::Area(_)) { sampler.next_2d() } else { Vec2::ZERO };
        let Some(sample) = light.sample(&reference, u, w) else { continue };
        let f = vertex.eval(sample.dir).0.lane(lane);
        let origin = vertex.shadow_origin(sample.dir);
        let from = if vertex.crosses(dir, sample.dir) { beyond } else { within };
        let start = (from.inside(scene, w), from);
        if f > 0.0
            && let Some(t) = shadow::transmittance(scene, origin, sample.dir, &sample.target, start, (w, lane), tally)
        {
            sum += f * sample.li.lane(lane) * t.lane(lane) / sample.pdf;
        }
    }
    sum
}
