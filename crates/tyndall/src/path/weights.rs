//! The bookkeeping of a path's weight: throughput, spectral MIS over the lanes, and MIS with light sampling.
//!
//! Every decision is made with the densities of one lane, the hero. Any lane could have been the hero, so a lane's
//! contribution is `beta · L / mean(r_u + r_l)`, the balance heuristic over heroes and over the two ways to find a light
//! (Wilkie et al. 2014; Miller et al. 2019; the rescaled bookkeeping follows Pharr et al. 2023, § 14.2).

use crate::spectrum::Lanes;

/// Throughput and relative densities of a path, all divided by the density of the hero's decisions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathWeights {
    /// `f / p_hero`.
    pub beta: Lanes,
    /// `p_lane / p_hero`: how the path would have been found with another lane as hero.
    pub r_u: Lanes,
    /// `p_lane / p_hero` for finding the next emitter by light sampling at the last vertex instead, still to be
    /// multiplied by the light's own density; `None` when light sampling could not have found this path.
    pub r_l: Option<Lanes>,
    /// `p_lane / p_hero` for a collision here that was aimed at a lamp instead.
    pub r_aim: Lanes,
}

impl Default for PathWeights {
    fn default() -> Self {
        Self { beta: Lanes::ONE, r_u: Lanes::ONE, r_l: None, r_aim: Lanes::ZERO }
    }
}

impl PathWeights {
    /// The weight of an emitter that the path has run into; `light_pdf` is the density of light sampling [1/sr].
    #[inline]
    pub fn emission(&self, light_pdf: impl FnOnce() -> f32) -> Lanes {
        let density = match self.r_l {
            None => self.r_u.mean(),
            Some(r_l) => (self.r_u + r_l * light_pdf()).mean(),
        };
        self.beta / density
    }

    /// The weight of a light that was sampled with density `light_pdf` over solid angle (`aim_pdf` where the collision had been
    /// aimed at a lamp), and that scattering would have found with `scatter_pdf` in each lane, through `transmittance`. For a Dirac
    /// light scattering finds nothing: pass 0 and 1.
    #[inline]
    pub fn light_sample(&self, [light_pdf, aim_pdf]: [f32; 2], scatter_pdf: Lanes, transmittance: Lanes) -> Lanes {
        let density = (self.r_u * (scatter_pdf + Lanes::splat(light_pdf)) + self.r_aim * aim_pdf).mean();
        self.beta * transmittance / density
    }

    /// The path flew a distance without colliding, with probability `transmittance` in each lane.
    #[inline]
    pub fn pass(&mut self, transmittance: Lanes, hero: usize) {
        let by_hero = 1.0 / transmittance.lane(hero);
        self.beta *= transmittance * by_hero;
        self.r_u *= transmittance * by_hero;
        if let Some(r_l) = &mut self.r_l {
            *r_l *= by_hero;
        }
    }

    /// The path collided after a distance, with density `sigma_t · transmittance` in each lane, and scatters. It might have been
    /// aimed there, with density `aim` [1/length].
    #[inline]
    pub fn collide(&mut self, sigma_t: Lanes, sigma_s: Lanes, transmittance: Lanes, hero: usize, aim: f32) {
        self.collide_by(sigma_t.lane(hero) * transmittance.lane(hero), sigma_t, sigma_s, transmittance, aim);
    }

    /// The same where it was aimed there.
    #[inline]
    pub fn collide_aimed(&mut self, sigma_t: Lanes, sigma_s: Lanes, transmittance: Lanes, aim: f32) {
        self.collide_by(aim, sigma_t, sigma_s, transmittance, aim);
    }

    #[inline]
    fn collide_by(&mut self, density: f32, sigma_t: Lanes, sigma_s: Lanes, transmittance: Lanes, aim: f32) {
        let by = 1.0 / density;
        self.r_aim = self.r_u * (aim * by);
        self.beta *= sigma_s * transmittance * by;
        self.r_u *= sigma_t * transmittance * by;
        self.r_l = None;
    }

    /// Of the media that share the place of a collision, one scatters: a part `share` of the collision, which each lane
    /// would have taken with `probability`.
    pub fn choose(&mut self, share: Lanes, probability: Lanes, hero: usize) {
        let by_hero = 1.0 / probability.lane(hero);
        self.beta *= share * by_hero;
        self.r_u *= probability * by_hero;
    }

    /// The weight of what a medium emits at a collision, per length, where [`Self::collide`] has not been called yet. No
    /// light sample finds it.
    #[inline]
    pub fn volume_emission(&self, sigma_t: Lanes, transmittance: Lanes) -> Lanes {
        self.beta * transmittance / (self.r_u * sigma_t * transmittance).mean()
    }

    /// The path went through collisions inside a medium; what each lane would have weighed, and its density.
    #[inline]
    pub fn walk(&mut self, beta: Lanes, density: Lanes) {
        self.beta *= beta;
        self.r_u *= density;
        self.r_l = None;
    }

    /// The path took a direction drawn with density `pdf`, with weight `f·cos / pdf` in each lane, from a place where
    /// light was sampled with probability `odds`.
    #[inline]
    pub fn scatter(&mut self, weight: Lanes, pdf: f32, odds: f32) {
        self.beta *= weight;
        let aimed = std::mem::replace(&mut self.r_aim, Lanes::ZERO);
        self.r_l = (odds > 0.0).then(|| (self.r_u * odds + aimed) * (1.0 / pdf));
    }

    /// The path took the one direction of a Dirac lobe: no light sample could have.
    #[inline]
    pub fn scatter_specular(&mut self, weight: Lanes) {
        self.beta *= weight;
        self.r_l = None;
    }

    /// The path took the Dirac lobe that light samples bend by, with this probability in each lane.
    #[inline]
    pub fn bend(&mut self, weight: Lanes, probability: f32) {
        self.beta *= weight;
        self.r_l = self.r_l.map(|r_l| r_l * (1.0 / probability));
    }

    /// The wavelengths part here: the path goes on with the hero alone, which alone could have come this way. In the
    /// film's mean over four lanes it stands for all of them. To be called once a path.
    pub fn keep_hero_only(&mut self, hero: usize) {
        let lane = |lanes: Lanes| Lanes::splat(lanes.lane(hero));
        let mut only = [0.0; 4];
        only[hero] = 4.0 * self.beta.lane(hero);
        self.beta = Lanes::new(only);
        self.r_u = lane(self.r_u);
        self.r_l = self.r_l.map(lane);
    }

    /// The greatest lane of the throughput as the film would weigh it: what roulette looks at.
    #[inline]
    pub fn throughput(&self) -> f32 {
        self.beta.max_lane() / self.r_u.mean()
    }
}
