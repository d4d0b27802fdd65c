//! Which light to sample: of a few, in proportion to a guess at the irradiance each makes at the point; of many, by the
//! bounds of a tree over them.

use super::{Light, LightId, Reference, hierarchy::Hierarchy};

/// Up to so many lights are weighed one by one.
const WEIGHED: usize = 16;

/// All lights of a scene.
#[derive(Debug, Clone)]
pub struct LightTable {
    /// By [`LightId`].
    pub lights: Vec<Light>,
    /// Those that escaping rays find.
    pub environments: Vec<LightId>,
    /// For scenes with many lights.
    many: Option<Hierarchy>,
}

impl LightTable {
    /// A table of lights.
    pub fn new(lights: Vec<Light>) -> Self {
        let environments =
            (0..lights.len()).filter(|i| lights[*i].is_environment()).map(|i| LightId(i as u32)).collect();
        let many = (lights.len() > WEIGHED).then(|| Hierarchy::new(&lights));
        Self { lights, environments, many }
    }

    /// A light.
    #[inline]
    pub fn get(&self, id: LightId) -> &Light {
        &self.lights[id.0 as usize]
    }

    /// A light to sample from `from`, with its probability; `None` when none shines here.
    #[inline]
    pub fn choose(&self, from: &Reference, u: f32) -> Option<(LightId, f32)> {
        match (self.lights.len(), &self.many) {
            (0, _) => None,
            (1, _) => Some((LightId(0), 1.0)),
            (_, Some(many)) => many.choose(from, u),
            _ => self.choose_weighed(u, |light| weight(light, from)),
        }
    }

    /// The same for light samples through walls that bend them: of a few lights only one for which that is worth while.
    #[inline]
    pub fn choose_bending(&self, from: &Reference, u: f32) -> Option<(LightId, f32)> {
        match (self.lights.len(), &self.many) {
            (0 | 1, _) | (_, Some(_)) => self.choose(from, u),
            _ => self.choose_weighed(u, |light| bending_weight(light, from)),
        }
    }

    /// The probability with which [`Self::choose_bending`] takes `id`.
    #[inline]
    pub fn bending_probability(&self, from: &Reference, id: LightId) -> f32 {
        match (self.lights.len(), &self.many) {
            (0 | 1, _) | (_, Some(_)) => self.probability(from, id),
            _ => self.weighed_probability(id, |light| bending_weight(light, from)),
        }
    }

    /// The probability with which [`Self::choose`] takes `id`.
    #[inline]
    pub fn probability(&self, from: &Reference, id: LightId) -> f32 {
        match (self.lights.len(), &self.many) {
            (1, _) => 1.0,
            (_, Some(many)) => many.probability(from, id),
            _ => self.weighed_probability(id, |light| weight(light, from)),
        }
    }

    fn weighed_probability(&self, id: LightId, weight: impl Fn(&Light) -> f32) -> f32 {
        let total: f32 = self.lights.iter().map(&weight).sum();
        if total > 0.0 { weight(self.get(id)) / total } else { 0.0 }
    }

    fn choose_weighed(&self, u: f32, weight: impl Fn(&Light) -> f32) -> Option<(LightId, f32)> {
        let mut weights = [0.0; WEIGHED];
        let mut total = 0.0;
        for (place, light) in weights.iter_mut().zip(&self.lights) {
            *place = weight(light);
            total += *place;
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

/// A guess at the irradiance that is finite even at a point light.
#[inline]
fn weight(light: &Light, from: &Reference) -> f32 {
    light.importance(from.p).min(1e30)
}

#[inline]
fn bending_weight(light: &Light, from: &Reference) -> f32 {
    if light.is_worth_bending() { weight(light, from) } else { 0.0 }
}
