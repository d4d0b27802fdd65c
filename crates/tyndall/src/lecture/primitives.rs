//! What the slides take for granted: tracing a ray, random directions, the values of BRDF, phase function and luminaires.
//!
//! Conventions are the slides': a ray leaves `x` along `ω`; at a surface `ω` and `ω′` both point away from it; at a
//! collision both are directions of travel, `ω` into it and `ω′` out of it, against the light. Densities of directions
//! are over projected solid angle (PSA, `dω |cos θ|`) at surfaces and over solid angle (SA) in volumes, so that no cosine
//! shows on a slide.
//!
//! What is behind the names is the renderer's: geometry, BSDFs, media and lights are those of every other integrator.

use std::{
    f32::consts::PI,
    ops::{Add, Div, Mul},
};

use crate::{
    bsdf::Bsdf,
    light::Target,
    material::Material,
    math::{Ray, Vec3, rounding::gamma},
    medium::{Inside, MediumId, Skin, Within},
    path::{Vertex, shadow},
    phase::Phase,
    sampling::{Sampler, warp},
    scene::{MaterialId, Scene},
    shape::Interaction,
    spectrum::Wavelengths,
    tally::Tally,
};

/// The chance \[1\] that a walk goes on at each vertex, from version 0.5. A walk that carries the albedo `a` at each vertex
/// has a finite variance only where `a² <` this, unless it can escape.
pub const SURVIVAL_PROBABILITY: f32 = 0.9;

/// Rays a recursion may follow. Version 0 never ends by itself in a closed scene, and a stack does: what is lost is
/// tallied as truncated. With roulette one walk in 10⁴⁵ gets so far.
pub const MAX_DEPTH: u32 = 1000;

/// An estimate of radiance in one lane, with what was lost where the recursion was cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Radiance {
    /// The estimate [W·m⁻²·sr⁻¹].
    found: f32,
    /// What radiance 1 at the cut would have added.
    lost: f32,
}

impl Radiance {
    /// No light.
    pub(super) const ZERO: Self = Self::of(0.0);
    /// The recursion is too deep.
    pub(super) const LOST: Self = Self { found: 0.0, lost: 1.0 };

    /// An estimate without loss.
    pub(super) const fn of(found: f32) -> Self {
        Self { found, lost: 0.0 }
    }
}

impl Add for Radiance {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { found: self.found + other.found, lost: self.lost + other.lost }
    }
}

impl Mul<Radiance> for f32 {
    type Output = Radiance;
    fn mul(self, radiance: Radiance) -> Radiance {
        Radiance { found: self * radiance.found, lost: self * radiance.lost }
    }
}

impl Div<f32> for Radiance {
    type Output = Self;
    fn div(self, by: f32) -> Self {
        Self { found: self.found / by, lost: self.lost / by }
    }
}

/// What surrounds a point, as the walk has noted it: points are many on the stack of a recursion, and small.
type Record = u32;

/// A point `x` or `y` of the slides.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point<'s> {
    place: Place<'s>,
    /// What was around it on the side from which it was reached.
    within: Record,
    /// The medium there.
    inside: Inside,
    /// Its distance from where the ray that found it began [length]: the slides' `|y − x|`.
    pub(super) distance: f32,
}

#[derive(Debug, Clone, Copy)]
enum Place<'s> {
    Eye(Vec3),
    Surface {
        hit: Interaction,
        bsdf: Bsdf<'s>,
        relief: Option<MaterialId>,
        from_outside: bool,
        beyond: Record,
    },
    Collision {
        p: Vec3,
        medium: MediumId,
        phase: &'s Phase,
    },
    /// Seen from a point.
    Infinity(Vec3),
}

impl<'s> Point<'s> {
    /// Whether there is no material: light goes straight on.
    pub(super) fn is_open(&self) -> bool {
        matches!(self.place, Place::Surface { bsdf: Bsdf::Null, .. })
    }

    /// Whether the BRDF is a Dirac.
    pub(super) fn is_dirac(&self) -> bool {
        matches!(&self.place, Place::Surface { bsdf, .. } if bsdf.is_specular())
    }

    /// `∫ |cos θ| dω`, π over the hemisphere of the slides; 2π where light passes through and comes from both sides.
    pub(super) fn projected_solid_angle(&self) -> f32 {
        if self.transmits() { 2.0 * PI } else { PI }
    }

    fn transmits(&self) -> bool {
        matches!(&self.place, Place::Surface { bsdf, .. } if bsdf.transmits())
    }

    /// `σ_s/σ_t` of the medium, in the lane of the walk.
    pub(super) fn albedo(&self, world: &World) -> f32 {
        self.inside.coefficients().map_or(0.0, |c| c.sigma_s.lane(world.lane) / c.sigma_t.lane(world.lane))
    }

    /// The vertex of the renderer that this point is, seen along `ω`.
    fn vertex(&self, scene: &Scene, omega: Vec3) -> Option<Vertex<'s>> {
        match self.place {
            Place::Surface { hit, bsdf, relief, .. } => Some(Vertex::met(scene, hit, bsdf, -omega, relief)),
            Place::Collision { p, medium, phase } => Some(Vertex::Medium { p, dir: omega, medium, phase }),
            Place::Eye(_) | Place::Infinity(_) => None,
        }
    }

    fn cosine(&self, omega_prime: Vec3) -> f32 {
        match &self.place {
            Place::Surface { hit, .. } => hit.ns.dot(omega_prime).abs(),
            _ => 1.0,
        }
    }
}

/// A point `y` on a luminaire, as luminaire sampling finds it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Luminaire {
    /// `emittedRadiance(y, −ω′)` [W·m⁻²·sr⁻¹]; of a light without extent, its irradiance [W·m⁻²].
    pub(super) emitted_radiance: Radiance,
    target: Target,
}

/// The scene in one wavelength, and the random numbers of one walk through it.
#[derive(Debug)]
pub(super) struct World<'a> {
    scene: &'a Scene,
    wavelengths: Wavelengths,
    lane: usize,
    sees_media: bool,
    depth: u32,
    /// What the points of the walk are within; first, the eye.
    records: Vec<Within>,
    sampler: &'a mut Sampler,
    tally: &'a mut Tally,
}

impl<'a> World<'a> {
    pub(super) fn new(
        scene: &'a Scene,
        wavelengths: Wavelengths,
        lane: usize,
        sees_media: bool,
        sampler: &'a mut Sampler,
        tally: &'a mut Tally,
    ) -> Self {
        let records = vec![*scene.around_camera()];
        Self { scene, wavelengths, lane, sees_media, depth: 0, records, sampler, tally }
    }

    /// The eye at `p`.
    pub(super) fn eye(&self, p: Vec3) -> Point<'a> {
        Point { place: Place::Eye(p), within: 0, inside: self.inside(0), distance: 0.0 }
    }

    fn inside(&self, within: Record) -> Inside {
        if self.sees_media {
            self.records[within as usize].inside(self.scene, &self.wavelengths)
        } else {
            Inside::Vacuum
        }
    }

    /// The estimate of a walk that has ended, its loss tallied.
    pub(super) fn settle(&mut self, estimate: Radiance) -> f32 {
        if estimate.lost > 0.0 {
            self.tally.truncated_paths += 1;
            self.tally.truncated_throughput += f64::from(estimate.lost);
        }
        estimate.found
    }

    /// `random()`, in [0, 1).
    pub(super) fn random(&mut self) -> f32 {
        self.sampler.next_1d()
    }

    /// `y = traceRay(x, ω)`: the first surface, or infinity; `None` when the recursion is too deep.
    pub(super) fn trace_ray(&mut self, x: &Point, omega: Vec3) -> Option<Point<'a>> {
        if self.depth >= MAX_DEPTH {
            return None;
        }
        self.depth += 1;
        self.tally.rays += 1;
        let (mut ray, within) = self.leave(x, omega);
        let from = ray.origin;
        let inside = self.inside(within);
        let mut gone = 0.0;
        loop {
            let Some(hit) = self.scene.geometry.intersect(&ray, f32::INFINITY) else {
                return Some(Point { place: Place::Infinity(from), within, inside, distance: f32::INFINITY });
            };
            // Taken short by what rounding can add to a collision: it must not be rounded across the surface.
            let distance = gone + hit.t - gamma(8) * (ray.origin.abs().max_element() + hit.t);
            let t = hit.t;
            let mut hit = self.scene.geometry.interaction(&ray, &hit);
            let (skin, beyond) = self.meet(within, &mut hit, omega);
            let (material, relief) = self.scene.meet(&hit, omega, || self.sampler.next_1d());
            if matches!(material, Material::Hole) {
                gone += t;
                ray = hit.spawn(omega);
                continue;
            }
            let bsdf = skin.bsdf(material, &hit, &self.wavelengths, self.lane);
            let bsdf = bsdf.seeded(|| self.sampler.rng.next_u32());
            let from_outside = omega.dot(hit.ng) < 0.0;
            return Some(Point {
                place: Place::Surface { hit, bsdf, relief, from_outside, beyond },
                within,
                inside,
                distance,
            });
        }
    }

    /// What is at a surface, and what is behind it.
    fn meet(&mut self, within: Record, hit: &mut Interaction, omega: Vec3) -> (Skin, Record) {
        let before = self.records[within as usize];
        let (skin, beyond) = before.meet(self.scene, hit, omega, &self.wavelengths, self.lane, self.tally);
        if beyond == before {
            return (skin, within);
        }
        self.records.push(beyond);
        (skin, self.records.len() as Record - 1)
    }

    /// `traceRay` past all surfaces without a material, whatever they emit.
    pub(super) fn trace_ray_past_openings(&mut self, x: &Point, omega: Vec3) -> Option<Point<'a>> {
        let mut y = self.trace_ray(x, omega)?;
        while y.is_open() {
            y = self.trace_ray(&y, omega)?;
        }
        Some(y)
    }

    /// The ray from `x` along `ω`, and what it starts within.
    #[allow(clippy::unused_self)] // the slides' primitives are called alike
    fn leave(&self, x: &Point, omega: Vec3) -> (Ray, Record) {
        match &x.place {
            Place::Surface { hit, from_outside, beyond, .. } => {
                let crossed = (omega.dot(hit.ng) > 0.0) != *from_outside;
                (hit.spawn(omega), if crossed { *beyond } else { x.within })
            }
            Place::Eye(p) | Place::Collision { p, .. } => (Ray::new(*p, omega), x.within),
            Place::Infinity(_) => (Ray::new(Vec3::INFINITY, omega), x.within),
        }
    }

    /// The extinction on the way to `y`.
    pub(super) fn sigma_t(&self, y: &Point) -> f32 {
        y.inside.coefficients().map_or(0.0, |c| c.sigma_t.lane(self.lane))
    }

    /// A number in (0, 1], whose logarithm is finite.
    pub(super) fn random_positive(&mut self) -> f32 {
        self.sampler.rng.next_positive()
    }

    /// The collision `x′ = x + sω` before `y`. One that rounding has carried out of its medium is tallied, and black.
    pub(super) fn collision(&mut self, x: &Point, s: f32, omega: Vec3, y: &Point) -> Point<'a> {
        let p = self.leave(x, omega).0.at(s);
        match self.scatterer(y) {
            Some(id) if self.scene.may_contain(id, p) => {
                self.tally.collisions += 1;
                let place = Place::Collision { p, medium: id, phase: &self.scene.medium(id).phase };
                Point { place, within: y.within, inside: y.inside, distance: s }
            }
            _ => {
                self.tally.leaks += 1;
                Point { place: Place::Infinity(p), within: y.within, inside: Inside::Vacuum, distance: s }
            }
        }
    }

    /// The medium that scatters on the way to `y`: where several share the place, one of them by chance.
    fn scatterer(&mut self, y: &Point) -> Option<MediumId> {
        match y.inside {
            Inside::Vacuum => None,
            Inside::Medium { id, .. } => Some(id),
            Inside::Mixture { .. } => {
                let u = self.random();
                let part = self.records[y.within as usize].choose_part(self.scene, &self.wavelengths, self.lane, u)?;
                Some(part.id)
            }
        }
    }

    /// `emittedRadiance(y, ω)`: of the luminaire at `y`, or of the environment at infinity.
    pub(super) fn emitted_radiance(&self, y: &Point, omega: Vec3) -> Radiance {
        let le = match &y.place {
            Place::Surface { hit, .. } => self
                .scene
                .light_at(hit)
                .map_or(0.0, |(_, l)| l.le(hit.ng, omega, || hit.into(), &self.wavelengths).lane(self.lane)),
            Place::Infinity(from) => {
                let lights = &self.scene.lights;
                let sky = |id| lights.get(id).le_from_infinity(*from, -omega, &self.wavelengths).lane(self.lane);
                lights.environments.iter().copied().map(sky).sum()
            }
            Place::Eye(_) | Place::Collision { .. } => 0.0,
        };
        Radiance::of(le)
    }

    /// `brdf(x, ω, ω′)` [1/sr], for transmission too; zero for a Dirac, and at infinity.
    pub(super) fn brdf(&self, x: &Point, omega: Vec3, omega_prime: Vec3) -> f32 {
        let cosine = x.cosine(omega_prime);
        match x.vertex(self.scene, omega) {
            Some(vertex) if cosine > 0.0 => vertex.eval(omega_prime).0.lane(self.lane) / cosine,
            _ => 0.0,
        }
    }

    /// `ω′ = uniformRandomPSA(n(x))`: cosine-weighted around the normal on the side of `ω`; on both sides where light
    /// passes through.
    pub(super) fn uniform_random_psa(&mut self, x: &Point, omega: Vec3) -> Vec3 {
        let Some(Vertex::Surface { frame, wo, .. }) = x.vertex(self.scene, omega) else { return omega };
        self.tally.surface_vertices += 1;
        let mut local = warp::cosine_hemisphere(self.sampler.next_2d());
        let across = x.transmits() && self.random() < 0.5;
        if (wo.z < 0.0) != across {
            local.z = -local.z;
        }
        frame.to_world(local).normalize()
    }

    /// `ω′, pdf = brdfSample(x, n(x))`, with `brdf(x, ω, ω′)`, since of a Dirac both are coefficients that only the
    /// sampler knows. `None`: absorbed.
    pub(super) fn brdf_sample(&mut self, x: &Point, omega: Vec3) -> Option<(Vec3, f32, f32)> {
        let vertex = x.vertex(self.scene, omega)?;
        self.tally.surface_vertices += 1;
        let sample = vertex.sample([self.random(), self.random(), self.random()])?;
        let omega_prime = sample.ray.dir;
        let weight = sample.weight.lane(self.lane);
        let cosine = x.cosine(omega_prime);
        if weight == 0.0 || cosine == 0.0 {
            return None;
        }
        let pdf = if sample.specular { 1.0 } else { sample.pdf / cosine };
        Some((omega_prime, weight * pdf, pdf))
    }

    /// `phaseFn(x, ω, ω′)` [1/sr].
    #[allow(clippy::unused_self)] // the slides' primitives are called alike
    pub(super) fn phase_fn(&self, x: &Point, omega: Vec3, omega_prime: Vec3) -> f32 {
        match &x.place {
            Place::Collision { phase, .. } => phase.eval(omega.dot(omega_prime)),
            _ => 0.0,
        }
    }

    /// `ω′ = uniformRandomSA()`, on the sphere.
    pub(super) fn uniform_random_sa(&mut self) -> Vec3 {
        warp::uniform_sphere(self.sampler.next_2d())
    }

    /// `ω′, pdf = phaseFunctionSample()`.
    pub(super) fn phase_function_sample(&mut self, x: &Point, omega: Vec3) -> Option<(Vec3, f32)> {
        let sample = x.vertex(self.scene, omega)?.sample([0.0, self.random(), self.random()])?;
        (sample.pdf > 0.0).then_some((sample.ray.dir, sample.pdf))
    }

    /// `ω′, pdf = luminaireSamplePSA(x, n(x))`, with the point `y` that was sampled. `None` where no luminaire can be
    /// seen, or none could matter (a Dirac).
    pub(super) fn luminaire_sample_psa(&mut self, x: &Point, omega: Vec3) -> Option<(Vec3, Luminaire, f32)> {
        let (omega_prime, y, pdf) = self.luminaire_sample_sa(x, omega)?;
        let cosine = x.cosine(omega_prime);
        (cosine > 0.0).then(|| (omega_prime, y, pdf / cosine))
    }

    /// `ω′, pdf = luminaireSampleSA(x)`, with the point `y` that was sampled: one luminaire is chosen, then a point on it.
    pub(super) fn luminaire_sample_sa(&mut self, x: &Point, omega: Vec3) -> Option<(Vec3, Luminaire, f32)> {
        let vertex = x.vertex(self.scene, omega)?;
        if !vertex.can_use_light_samples() {
            return None;
        }
        let reference = vertex.reference();
        let (id, probability) = self.scene.lights.choose(&reference, self.sampler.next_1d())?;
        let light = self.scene.lights.get(id);
        let sample = light.sample(&reference, self.sampler.next_2d(), &self.wavelengths)?;
        let emitted_radiance = Radiance::of(sample.li.lane(self.lane));
        Some((sample.dir, Luminaire { emitted_radiance, target: sample.target }, probability * sample.pdf))
    }

    /// Whether `y` is the first thing that a ray from `x` along `ω′` meets: 1 or 0, or what is open of the surfaces between.
    pub(super) fn visibility(&mut self, x: &Point, omega_prime: Vec3, y: &Luminaire) -> f32 {
        let (ray, within) = self.leave(x, omega_prime);
        let wavelengths = (&self.wavelengths, self.lane);
        shadow::visible(
            self.scene,
            ray.origin,
            omega_prime,
            &y.target,
            &self.records[within as usize],
            wavelengths,
            self.tally,
        )
    }

    /// `attenuation(x, y)`: `exp(−∫ σ_t)` from `x` along `ω′` to `y`, 0 where a surface stands between.
    pub(super) fn attenuation(&mut self, x: &Point, omega_prime: Vec3, y: &Luminaire) -> f32 {
        let (ray, within) = self.leave(x, omega_prime);
        let (scene, start) = (self.scene, (self.inside(within), &self.records[within as usize]));
        let wavelengths = (&self.wavelengths, self.lane);
        shadow::transmittance(scene, ray.origin, omega_prime, &y.target, start, wavelengths, self.tally)
            .map_or(0.0, |t| t.lane(self.lane))
    }
}
