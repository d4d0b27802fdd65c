//! One collision of a walk, written so that a compiler can do it for many lanes at once: no branch, no library call.

use super::{End, Walker};
use crate::{
    math::{Vec3, fast},
    phase::deflect,
    sampling::rng::{positive, unit},
};

/// The probability of a light sample where the transmittance to any light is at most `exp(−tau)`, and where it is sampled with
/// probability `share` at the surface.
#[inline(always)]
pub(crate) fn light_odds(share: f32, tau: f32) -> f32 {
    share * fast::exp(-tau).min(1.0)
}

/// What [`collide`] says when there is nothing to say.
pub(super) const GOES_ON: u32 = 0;
const LEAVES: u32 = 1;
const ROULETTE: u32 = 2;
const LIGHT: u32 = 4;

/// Why [`collide`] has said that the walk ends.
#[inline(always)]
pub(super) fn end(code: u32) -> Option<End> {
    match code & !LIGHT {
        LEAVES => Some(End::Leaves),
        ROULETTE => Some(End::Roulette),
        _ => None,
    }
}

/// Whether [`collide`] has announced a light sample.
#[inline(always)]
pub(super) fn is_lit(code: u32) -> bool {
    code & LIGHT != 0
}

/// Flies and collides, announces a light sample or not, and turns if the walk goes on.
///
/// Where the flight leaves the room, nothing but [`Walker::flight`] and the random numbers change; where the walk ends at
/// a collision, the direction is still that of the flight that led there. `LIT` says whether light can be reached.
#[inline(always)]
pub(super) fn collide<const LIT: bool>(w: &mut Walker, cosine: impl Fn(f32) -> f32) -> u32 {
    let [u_flight, u_light, u_cosine, u_azimuth] = w.rng.next_four();
    w.flight = -fast::ln(positive(u_flight)) * w.mean_free_path;
    let p = w.p + w.dir * w.flight;
    let depth = w.room.depth(p);
    let stays = depth > 0.0;
    let is_lit = LIT && positive(u_light) <= light_odds(w.share, w.sigma_min * depth.max(0.0));
    let is_due = w.collisions + 1 >= w.limit;
    let cos_theta = cosine(unit(u_cosine));
    let dir = deflect(w.dir, cos_theta, unit(u_azimuth));

    let goes_on = stays && !is_due;
    w.came = w.dir;
    w.p = select(stays, p, w.p);
    w.length += if stays { w.flight } else { 0.0 };
    w.collisions += u32::from(stays);
    w.dir = select(goes_on, dir, w.dir);
    w.cos_theta = if goes_on { cos_theta } else { w.cos_theta };
    let end = if goes_on {
        GOES_ON
    } else if stays {
        ROULETTE
    } else {
        LEAVES
    };
    if stays && is_lit { end | LIGHT } else { end }
}

#[inline(always)]
fn select(first: bool, a: Vec3, b: Vec3) -> Vec3 {
    Vec3::new(if first { a.x } else { b.x }, if first { a.y } else { b.y }, if first { a.z } else { b.z })
}
