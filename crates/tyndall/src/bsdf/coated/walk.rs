//! Walks between the top of a coat and its base.
//!
//! Heights are in mean free paths above the base; directions are those of travel.

use super::{Coated, top::Top};
use crate::bsdf::{Bsdf, BsdfSample, Conductor, ScatterKind};
use crate::math::{Vec2, Vec3, fast};
use crate::phase::{HenyeyGreenstein, deflect};
use crate::sampling::Rng;
use crate::spectrum::Lanes;

/// Walks that weigh less than this play roulette, and survive with this weight.
const LEAST_WEIGHT: f32 = 0.25;

/// A coat and its base, ready for a walk.
pub(super) struct Layers<'a> {
    model: &'a Coated,
    pub(super) top: Top,
    base: Bsdf<'static>,
    /// How the coat scatters; `None` if it only absorbs.
    phase: Option<HenyeyGreenstein>,
}

/// Random numbers, the first two of which may be given: better ones.
pub(super) struct Numbers {
    pub(super) given: Option<Vec2>,
    pub(super) rng: Rng,
}

impl Numbers {
    pub(super) fn next_2d(&mut self) -> Vec2 {
        let Self { given, rng } = self;
        given.take().unwrap_or_else(|| Vec2::new(rng.next_1d(), rng.next_1d()))
    }
}

/// Where a walk is and goes.
struct At {
    height: f32,
    dir: Vec3,
}

/// What a walk meets.
#[derive(Clone, Copy, PartialEq)]
enum Met {
    Top,
    Base,
    /// Something that scatters with this phase function.
    Particle(HenyeyGreenstein),
}

/// A direction that scattering took.
struct Turn {
    dir: Vec3,
    weight: Lanes,
    /// Density [1/sr]; `None` for a Dirac lobe.
    pdf: Option<f32>,
}

impl<'a> Layers<'a> {
    pub(super) fn of(model: &'a Coated) -> Self {
        let clear = model.albedo.is_zero();
        let phase = if clear { None } else { HenyeyGreenstein::new(model.g).ok() };
        Self { model, top: Top::of(model), base: model.base.bsdf(), phase }
    }

    /// An estimate of `f·|cos θi|` [1/sr] of all light that enters the coat, both directions above it.
    pub(super) fn walk(&self, wo: Vec3, wi: Vec3, rng: &mut Rng) -> Lanes {
        let mut numbers = Numbers { given: None, rng: *rng };
        let estimate = self.walk_with(wo, wi, &mut numbers).unwrap_or(Lanes::ZERO);
        *rng = numbers.rng;
        estimate
    }

    fn walk_with(&self, wo: Vec3, wi: Vec3, numbers: &mut Numbers) -> Option<Lanes> {
        let entry = self.top.refract(wo, numbers)?;
        let exit = self.top.refract(wi, numbers);
        let (mut at, mut weight) = (At { height: self.model.thickness, dir: entry.wi }, Lanes::ONE);
        let mut sum = Lanes::ZERO;
        for left in (0..self.model.max_depth).rev() {
            if !survives(&mut weight, &mut numbers.rng) {
                break;
            }
            let met = self.fly(&mut at, &mut weight, &mut numbers.rng);
            if met == Met::Top {
                let Some(back) = self.top.reflect(-at.dir, numbers) else { break };
                weight *= back.weight;
                at.dir = back.wi;
                continue;
            }
            if let Some(exit) = &exit {
                sum += weight * self.towards(exit, wi, met, &at, left);
            }
            let Some(turn) = self.turn(met, &at, numbers) else { break };
            weight *= turn.weight;
            at.dir = turn.dir;
            sum += weight * self.out_by_chance(wi, &turn, at.height);
        }
        Some(sum * entry.weight)
    }

    /// The light from `wi` that came in along `exit` and is scattered into the walk by what it has met, after at most
    /// `left` reflections.
    fn towards(&self, exit: &BsdfSample, wi: Vec3, met: Met, at: &At, left: u16) -> Lanes {
        let out = -exit.wi;
        let (value, pdf) = match met {
            Met::Particle(phase) => {
                let p = phase.eval(at.dir.dot(out));
                (self.model.albedo * p, p)
            }
            _ => (self.base.eval(-at.dir, out), self.base.pdf(-at.dir, out)),
        };
        let share = if exit.specular { 1.0 } else { exit.pdf / (exit.pdf + pdf) };
        let eta = self.model.eta;
        let entered = exit.weight * (eta * eta * wi.z / out.z);
        match (met, &self.base) {
            (Met::Particle(phase), Bsdf::Conductor(metal)) if exit.specular => {
                let internal = (1.0 - exit.weight.lane(0) * eta * eta).max(0.0);
                entered * self.model.albedo * self.between_mirrors(phase, metal, internal, out, at, left)
            }
            _ => entered * value * (share * self.transmittance(at.height, out)),
        }
    }

    /// Neither a smooth top nor a polished metal can be joined with anything: what a particle scatters along `out`, and to
    /// its mirror image below, goes on between them to and fro, of which the sum is a geometric series.
    fn between_mirrors(
        &self,
        phase: HenyeyGreenstein,
        metal: &Conductor,
        top: f32,
        out: Vec3,
        at: &At,
        left: u16,
    ) -> Lanes {
        let across = attenuation(self.model.thickness, out);
        let base = metal.reflected(out.z);
        let series = |reflections: u16| {
            let rounds = i32::from(reflections / 2) + 1;
            (base * (top * across * across)).map(|q| (1.0 - q.powi(rounds)) / (1.0 - q))
        };
        let up = series(left) * (phase.eval(at.dir.dot(out)) * self.transmittance(at.height, out));
        if left == 0 {
            return up;
        }
        let image = Vec3::new(out.x, out.y, -out.z);
        up + series(left - 1) * base * (phase.eval(at.dir.dot(image)) * attenuation(at.height, out) * across)
    }

    /// The light from `wi` that the top lets into a walk that has just turned.
    fn out_by_chance(&self, wi: Vec3, turn: &Turn, height: f32) -> Lanes {
        let out = turn.dir;
        if out.z <= 0.0 {
            return Lanes::ZERO;
        }
        let Some(exit_pdf) = self.top.refraction_pdf(wi, -out) else { return Lanes::ZERO };
        let share = turn.pdf.map_or(1.0, |pdf| pdf / (pdf + exit_pdf));
        self.top.eval(-out, wi) * (share * self.transmittance(height, out))
    }

    /// Follows what was refracted into the coat until it is out again.
    pub(super) fn escape(&self, entry: &BsdfSample, numbers: &mut Numbers) -> Option<BsdfSample> {
        let (mut at, mut weight) =
            (At { height: self.model.thickness, dir: entry.wi }, entry.weight * entry.eta * entry.eta);
        let mut specular = entry.specular;
        for _ in 0..=self.model.max_depth {
            if !survives(&mut weight, &mut numbers.rng) {
                return None;
            }
            let met = self.fly(&mut at, &mut weight, &mut numbers.rng);
            if met == Met::Top {
                let u_lobe = numbers.rng.next_1d();
                let s = self.top.sample(-at.dir, u_lobe, numbers)?;
                specular &= s.specular;
                weight *= s.weight * (s.eta * s.eta);
                if s.kind == ScatterKind::Transmission {
                    return Some(BsdfSample { weight, specular, ..s });
                }
                at.dir = s.wi;
            } else {
                let turn = self.turn(met, &at, numbers)?;
                specular &= turn.pdf.is_none();
                weight *= turn.weight;
                at.dir = turn.dir;
            }
        }
        None
    }

    /// Flies to what comes next. What is absorbed on the way is taken from the weight.
    fn fly(&self, at: &mut At, weight: &mut Lanes, rng: &mut Rng) -> Met {
        let (wall, to_go) =
            if at.dir.z > 0.0 { (Met::Top, self.model.thickness - at.height) } else { (Met::Base, at.height) };
        match self.phase {
            None => *weight *= attenuation(to_go, at.dir),
            Some(phase) => {
                let flown = -fast::ln(rng.next_positive()) * at.dir.z.abs();
                if flown < to_go {
                    at.height += flown.copysign(at.dir.z);
                    return Met::Particle(phase);
                }
            }
        }
        at.height = if wall == Met::Top { self.model.thickness } else { 0.0 };
        wall
    }

    /// Scatters; `None` if there is nothing left, or nowhere to go.
    fn turn(&self, met: Met, at: &At, numbers: &mut Numbers) -> Option<Turn> {
        let turn = if let Met::Particle(phase) = met {
            let u = numbers.next_2d();
            let cos = phase.sample(u.x);
            Turn { dir: deflect(at.dir, cos, u.y), weight: self.model.albedo, pdf: Some(phase.eval(cos)) }
        } else {
            let s = self.base.sample(-at.dir, 0.0, numbers.next_2d())?;
            Turn { dir: s.wi, weight: s.weight, pdf: (!s.specular).then_some(s.pdf) }
        };
        (turn.dir.z != 0.0).then_some(turn)
    }

    /// What of the light along `dir`, from `height` to the top, is not extinguished.
    fn transmittance(&self, height: f32, dir: Vec3) -> f32 {
        attenuation(self.model.thickness - height, dir)
    }
}

/// `exp(−depth/|cos|)`: the part that is left after a layer of so many mean free paths.
fn attenuation(depth: f32, dir: Vec3) -> f32 {
    if depth > 0.0 { libm::expf(-depth / dir.z.abs()) } else { 1.0 }
}

/// Roulette: a walk of little weight ends, or goes on with more.
fn survives(weight: &mut Lanes, rng: &mut Rng) -> bool {
    let chance = weight.max_lane() / LEAST_WEIGHT;
    if chance >= 1.0 {
        return true;
    }
    *weight *= 1.0 / chance.max(f32::MIN_POSITIVE);
    rng.next_1d() < chance
}
