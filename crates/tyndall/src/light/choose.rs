//! Which light to sample: with few lights, in proportion to a guess at the irradiance each makes at the point; with
//! many, in proportion to that guess at the middle of the scene.

use super::{Light, LightId, Reference};
use crate::sampling::discrete::Discrete;

/// Up to so many lights are weighed at every point.
const WEIGHED: usize = 16;

/// All lights of a scene.
#[derive(Debug, Clone)]
pub struct LightTable {
    /// By [`LightId`].
    pub lights: Vec<Light>,
    /// Those that escaping rays find.
    pub environments: Vec<LightId>,
    /// Fixed probabilities for scenes with many lights.
    many: Option<Discrete>,
}

impl LightTable {
    /// A table of lights; `middle` is where a scene with many of them is judged from [length].
    pub fn new(lights: Vec<Light>, middle: crate::math::Vec3) -> Self {
        let environments =
            (0..lights.len()).filter(|i| lights[*i].is_environment()).map(|i| LightId(i as u32)).collect();
        let many = (lights.len() > WEIGHED).then_some(()).and_then(|()| {
            let weights: Vec<f32> = lights.iter().map(|l| l.importance(middle).min(1e30)).collect();
            let mean = weights.iter().sum::<f32>() / weights.len() as f32;
            // A light that the middle cannot see may still shine elsewhere: every one keeps a share.
            Discrete::new(&weights.iter().map(|w| w + 0.1 * mean + f32::MIN_POSITIVE).collect::<Vec<_>>())
        });
        Self { lights, environments, many }
    }

    /// A light.
    #[inline]
    pub fn get(&self, id: LightId) -> &Light {
        &self.lights[id.0 as usize]
    }

    /// A light to sample from `from`, with its probability and a fresh uniform number; `None` when none shines here.
    #[inline]
    pub fn choose(&self, from: &Reference, u: f32) -> Option<(LightId, f32)> {
        match (self.lights.len(), &self.many) {
            (0, _) => None,
            (1, _) => Some((LightId(0), 1.0)),
            (_, Some(many)) => {
                let (index, probability, _) = many.sample(u);
                Some((LightId(index as u32), probability))
            }
            _ => self.choose_weighed(from, u),
        }
    }

    /// The probability with which [`Self::choose`] takes `id`.
    #[inline]
    pub fn probability(&self, from: &Reference, id: LightId) -> f32 {
        match (self.lights.len(), &self.many) {
            (1, _) => 1.0,
            (_, Some(many)) => many.pmf(id.0 as usize),
            _ => {
                let total: f32 = self.lights.iter().map(|l| l.importance(from.p)).sum();
                if total > 0.0 { self.get(id).importance(from.p) / total } else { 0.0 }
            }
        }
    }

    fn choose_weighed(&self, from: &Reference, u: f32) -> Option<(LightId, f32)> {
        let mut weights = [0.0; WEIGHED];
        let mut total = 0.0;
        for (weight, light) in weights.iter_mut().zip(&self.lights) {
            *weight = light.importance(from.p);
            total += *weight;
        }
        if total <= 0.0 {
            return None;
        }
        let mut rest = u * total;
        let mut last = None;
        for (i, weight) in weights.iter().enumerate().take(self.lights.len()) {
            if *weight > 0.0 {
                last = Some((LightId(i as u32), weight / total));
                if rest < *weight {
                    break;
                }
            }
            rest -= weight;
        }
        last
    }
}
