//! A blend of phase functions: particles of several kinds in one medium.
//!
//! ```text
//! p(c) = Σ wᵢ pᵢ(c),   Σ wᵢ = 1
//! ```
//!
//! A component is drawn with its weight by a part of `u`, and its cosine with the rest of `u`. What is evaluated, and the
//! density, is the whole sum. A blend of blends is one list.
//!
//! | parameter | meaning | range |
//! |---|---|---|
//! | `weight` | share of the second \[1\] | [0, 1] |

use super::{Phase, PhaseError};

/// A weighted sum.
#[derive(Debug, Clone, PartialEq)]
pub struct Blend {
    /// None is a blend itself, and none has the weight 0.
    parts: Box<[Part]>,
}

#[derive(Debug, Clone, PartialEq)]
struct Part {
    weight: f32,
    /// The weights of this part and of those before it.
    up_to: f32,
    phase: Phase,
}

impl Blend {
    /// `1 − weight` of the first and `weight` of the second.
    ///
    /// # Errors
    /// [`PhaseError::Weight`] when the weight is not in [0, 1].
    pub fn new(first: &Phase, second: &Phase, weight: f32) -> Result<Self, PhaseError> {
        if !(0.0..=1.0).contains(&weight) {
            return Err(PhaseError::Weight(weight));
        }
        let mut parts = Vec::new();
        for (phase, share) in [(first, 1.0 - weight), (second, weight)] {
            match phase {
                Phase::Blend(blend) => {
                    parts.extend(blend.parts.iter().map(|part| (part.weight * share, part.phase.clone())));
                }
                plain => parts.push((share, plain.clone())),
            }
        }
        parts.retain(|(weight, _)| *weight > 0.0);
        let mut up_to = 0.0;
        let part = |(weight, phase)| {
            up_to += weight;
            Part { weight, up_to, phase }
        };
        Ok(Self { parts: parts.into_iter().map(part).collect() })
    }

    /// `p(cos θ)` [1/sr].
    #[inline]
    pub fn eval(&self, cos_theta: f32) -> f32 {
        self.parts.iter().map(|part| part.weight * part.phase.eval(cos_theta)).sum()
    }

    /// A cosine with the density [`Self::eval`].
    #[inline]
    pub fn sample(&self, u: f32) -> f32 {
        let last = self.parts.len() - 1;
        let i = self.parts[..last].iter().position(|part| u < part.up_to).unwrap_or(last);
        let Part { weight, up_to, phase } = &self.parts[i];
        phase.sample(((u - (up_to - weight)) / weight).clamp(0.0, 1.0))
    }

    /// `Σ wᵢ gᵢ`.
    #[inline]
    pub fn mean_cosine(&self) -> f32 {
        self.parts.iter().map(|part| part.weight * part.phase.mean_cosine()).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 0.4 + 0.6·(0.5 + 0.5·…): weights 0.4, 0.3 and 0.3.
    #[test]
    fn a_blend_of_blends_is_one_list() {
        let [a, b, c] = [0.9, -0.5, 0.1].map(|g| Phase::henyey_greenstein(g).unwrap());
        let inner = Phase::blend(&b, &c, 0.5).unwrap();
        let all = Phase::blend(&a, &inner, 0.6).unwrap();
        for cos in [-1.0, -0.3, 0.5, 1.0] {
            let sum = 0.4 * a.eval(cos) + 0.3 * b.eval(cos) + 0.3 * c.eval(cos);
            assert!((all.eval(cos) / sum - 1.0).abs() < 1e-6);
        }
        assert!((all.mean_cosine() - (0.36 - 0.15 + 0.03)).abs() < 1e-6);
    }

    /// All of one part and none of the other, at the ends of the interval too.
    #[test]
    fn a_part_without_weight_is_never_drawn() {
        let (back, on) = (Phase::henyey_greenstein(-0.999).unwrap(), Phase::henyey_greenstein(0.9).unwrap());
        for (blend, of) in [(Phase::blend(&back, &on, 1.0), &on), (Phase::blend(&on, &back, 0.0), &on)] {
            let blend = blend.unwrap();
            for u in [0.0, 0.3, 1.0 - f32::EPSILON / 2.0, 1.0] {
                assert_eq!(blend.sample(u), of.sample(u));
            }
        }
        for weight in [-1e-6, 1.1, f32::NAN] {
            assert!(matches!(Phase::blend(&back, &on, weight), Err(PhaseError::Weight(_))));
        }
    }
}
