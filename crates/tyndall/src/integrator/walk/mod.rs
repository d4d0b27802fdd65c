//! Walks deep inside a medium: many collisions without a ray.
//!
//! A path knows a *room* around it that no surface cuts and that holds no light ([`Room`]): all of a body that is a ball or a block
//! ([`Scene::room`]), or else a ball: one that touches the surface near it ([`Scene::touching`]), or one around it, from
//! [`Scene::clearance`]. While its flights end inside, nothing can be in their way, and a collision costs a logarithm, a rotation and
//! four random numbers.
//!
//! **Light.** From a point with so much room, `c`, around it no lane has more than `exp(−σ_t c)` of transmittance to any light. There
//! light is sampled with probability
//!
//! ```text
//! q = exp(−min σ_t · c)
//! ```
//!
//! (0.3 of that where light samples must bend, see [`crate::bend`])
//! and counts as a technique of density `q p_light`: what it finds is divided by `q p_light + p_phase T`, what the path
//! runs into by the same (the balance heuristic). `q` depends on what the path has been through and on nothing that is
//! drawn later, so both together stay unbiased.
//!
//! **Weights.** In a homogeneous medium the weight of `n` collisions after flights of total length `L` is
//! `σ_s^n exp(−σ_t L)` in each lane, so a walk carries `n` and `L`, and the lanes are settled where it ends
//! ([`Settled`]): spectral MIS over the lanes costs nothing within.
//!
//! A light sample does not hold a walk up: the walk says where ([`Announced`]) and goes on. It ends ([`End`]) where a flight
//! would leave the room (it is then traced like any other) or where roulette is due. [`Walker::alone`] follows one walk;
//! [`together`] follows many with SIMD and, since every path owns its random numbers and no operation is fused, gives the
//! same bits.

mod step;
pub(crate) mod together;

pub(crate) use step::light_odds;

use crate::{
    math::Vec3,
    medium::{Coefficients, MediumId},
    phase::Phase,
    sampling::Rng,
    scene::{Lit, Scene},
    shape::Room,
    spectrum::Lanes,
};

/// Greatest clearance that is asked for [mean free paths].
const FARTHEST: f32 = 256.0;
/// Least room for a walk to begin [mean free paths].
const ROOM: f32 = 0.5;
/// Most collisions between two games of roulette.
const MOST_COLLISIONS: f32 = 256.0;
/// The probability of a light sample at a wall that bends it \[1\]: such samples cost more than others, and what a path brings varies
/// as much as its mean with a third of them already.
const BENT_SHARE: f32 = 0.3;
/// What a throughput may fall to between two games of roulette \[1\].
const LEAST_THROUGHPUT: f32 = 0.25;

/// What a walk needs to know of a medium, at the wavelengths and with the hero of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Depths {
    /// Which medium.
    pub id: MediumId,
    /// Of the hero [1/length].
    pub sigma_t: f32,
    /// The mean of all lanes, by which lengths are judged: what a path does must not depend on which lane is the hero, or
    /// the weights of multiple importance sampling would not sum to one [1/length].
    pub sigma_mean: f32,
    /// The least of all lanes [1/length].
    pub sigma_min: f32,
    /// How light can be reached.
    pub lit: Lit,
    /// Collisions between two games of roulette.
    pub limit: u32,
    /// `ln(σ_t / σ_t,hero)` in each lane.
    log_extinction: Lanes,
    /// `ln(σ_s / σ_t)` in each lane.
    log_albedo: Lanes,
    /// `σ_t − σ_t,hero` in each lane [1/length].
    beyond_hero: Lanes,
}

/// What a walk does to the weights of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settled {
    /// `f / p_hero`.
    pub beta: Lanes,
    /// `p_lane / p_hero`.
    pub density: Lanes,
}

/// Stands for the logarithm of 0: `exp` of it is 0, and no product with a count is NaN.
const LOG_OF_NOTHING: f32 = -1e4;

impl Depths {
    /// Of a medium, unless walks in it are worth nothing: it glows (each collision counts), nothing scatters, or it is clear.
    pub fn of(scene: &Scene, id: MediumId, coefficients: &Coefficients, hero: usize) -> Option<Self> {
        let Coefficients { sigma_t, sigma_s, source } = *coefficients;
        let extinction = sigma_t.lane(hero);
        let (sigma_mean, scatters) = (sigma_t.mean(), !sigma_s.is_zero() && sigma_t.min_lane() > 0.0);
        if !scatters || !source.is_zero() || scene.is_clear(id, coefficients) {
            return None;
        }
        let log = |v: f32| if v > 0.0 { v.ln() } else { LOG_OF_NOTHING };
        let albedo = sigma_s / sigma_t;
        let limit = LEAST_THROUGHPUT.ln() / log(albedo.max_lane()).min(-f32::MIN_POSITIVE);
        Some(Self {
            id,
            sigma_t: extinction,
            sigma_mean,
            sigma_min: sigma_t.min_lane(),
            lit: scene.lit(Some(id)),
            limit: if limit < MOST_COLLISIONS { (limit as u32).max(1) } else { MOST_COLLISIONS as u32 },
            log_extinction: (sigma_t / extinction).map(log),
            log_albedo: albedo.map(log),
            beyond_hero: sigma_t - Lanes::splat(extinction),
        })
    }

    /// The greatest clearance worth asking for [length].
    #[inline]
    pub fn farthest(&self, scene: &Scene) -> f32 {
        (FARTHEST / self.sigma_mean).min(scene.deepest(self.id))
    }

    /// Whether a walk is worth to begin with so long a way before it [length].
    #[inline]
    pub fn is_roomy(&self, way: f32) -> bool {
        way * self.sigma_mean >= ROOM
    }

    /// The probability of a light sample at the surface \[1\].
    #[inline]
    pub fn share(&self) -> f32 {
        match self.lit {
            Lit::Never => 0.0,
            Lit::Straight => 1.0,
            Lit::Bent => BENT_SHARE,
        }
    }

    /// The probability of a light sample at a point so deep [length].
    #[inline]
    pub fn odds(&self, depth: f32) -> f32 {
        light_odds(self.share(), self.sigma_min * depth.max(0.0))
    }

    /// The weights of `collisions` after flights of total `length` [length].
    #[inline]
    pub fn settle(&self, collisions: u32, length: f32) -> Settled {
        let n = collisions as f32;
        let density = (self.log_extinction * n - self.beyond_hero * length).exp();
        Settled { beta: density * (self.log_albedo * n).exp(), density }
    }
}

/// A walk: what of a path changes while it is deep, and what it must know of where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Walker {
    /// The medium.
    pub medium: MediumId,
    /// The last collision, or where the walk began [length].
    pub p: Vec3,
    /// Direction of travel from there.
    pub dir: Vec3,
    /// Direction of travel before.
    pub came: Vec3,
    /// Random numbers.
    pub rng: Rng,
    /// The room that holds `p`.
    pub room: Room,
    /// `1/σ_t` of the hero [length].
    pub mean_free_path: f32,
    /// The least `σ_t` of all lanes [1/length].
    pub sigma_min: f32,
    /// The probability of a light sample at the surface \[1\].
    pub share: f32,
    /// Whether light can be reached.
    pub lit: bool,
    /// Collisions so far.
    pub collisions: u32,
    /// After so many it ends.
    pub limit: u32,
    /// Sum of all flights that ended in a collision [length].
    pub length: f32,
    /// The flight under way [length].
    pub flight: f32,
    /// Cosine of the last deflection.
    pub cos_theta: f32,
}

/// A light sample at one of the collisions of a walk.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Announced {
    /// Where [length].
    pub p: Vec3,
    /// Direction of travel before the collision.
    pub dir: Vec3,
    /// Collisions of the walk so far, this one included.
    pub collisions: u32,
    /// Sum of their flights [length].
    pub length: f32,
    /// How likely the announcement was \[1\].
    pub odds: f32,
    /// Random numbers for it alone.
    pub rng: Rng,
}

/// Why a walk ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// The flight under way may leave the room.
    Leaves,
    /// So many collisions want a game of roulette.
    Roulette,
}

impl Walker {
    /// Follows a walk to its end, and tells `light` of each light sample on the way.
    pub fn alone(&mut self, phase: &Phase, mut light: impl FnMut(&Announced)) -> End {
        loop {
            let cosine = |u| phase.sample(u);
            let code =
                if self.lit { step::collide::<true>(self, cosine) } else { step::collide::<false>(self, cosine) };
            if step::is_lit(code) {
                light(&self.announced());
            }
            if let Some(end) = step::end(code) {
                return end;
            }
        }
    }

    /// A light sample at the last collision.
    #[inline]
    fn announced(&self) -> Announced {
        Announced {
            p: self.p,
            dir: self.came,
            collisions: self.collisions,
            length: self.length,
            odds: light_odds(self.share, self.sigma_min * self.room.depth(self.p).max(0.0)),
            rng: self.rng.aside(),
        }
    }
}
