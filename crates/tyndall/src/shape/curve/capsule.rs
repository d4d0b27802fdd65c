//! A straight piece of a strand: what a ball fills that moves from one point to the next and grows or shrinks evenly.
//!
//! At `w` the ball is `c(w)`, seen from the ray's nearest place, of radius `r(w)`, both linear in `w`. The ray enters it at
//! `s(w) = a(w) − √q(w)`, with `a` along the ray and `q = r² − c²` for the part of `c` across it. `√q` is concave where the
//! ray meets balls, so `s` has one least value: the ray comes in there (Reshetov and Hart 2024, "Modeling Hair Strands with
//! Roving Capsules"). With `q = q₀ + 2q₁w + q₂w²`, `s′ = 0` is `q₁ + q₂w = a′√q`, and squared
//!
//! `q = (q₁² − q₀q₂)/(p′² − r′²)`, `q₁² − q₀q₂ = |r c′ − r′c|² − |c × c′|²`,
//!
//! for the velocity `p′` of the ball in space: that of a cone that touches both balls. Beyond the ends the ray enters a ball.
//!
//! Neighbours share a ball. All of it that the neighbours do not cover is met by the piece before it; the first piece of a
//! strand has its own as well. So a strand is closed at joints and at ends, as Mitsuba's `linearcurve` is (Embree's round
//! linear curves). As all tubes it is met only from outside.

use glam::{DVec3, DVec4};

use super::segment::{Line, Meeting};

/// A ball is met a little further than to where the next piece begins \[1, of the radius\].
const OVERLAP: f64 = 1e-9;

/// A straight piece of a strand.
#[derive(Debug, Clone, Copy)]
pub(super) struct Capsule {
    /// The balls at its ends, each with its radius.
    pub(super) ends: [DVec4; 2],
    /// Whether no piece before it ends with the first ball.
    pub(super) is_first: bool,
    /// Where the piece that begins with the last ball goes to.
    pub(super) next: Option<DVec4>,
}

impl Capsule {
    /// Where a ray comes in, if that is ahead of its origin and not within a ball that a neighbour meets.
    pub(super) fn enter(&self, line: &Line) -> Option<Meeting> {
        let [distance, w] = self.meet(line)?;
        let is_own = match w {
            0.0 => self.is_first,
            1.0 => self.next.is_none_or(|next| !self.is_past(next, line, distance)),
            _ => true,
        };
        (is_own && distance > 0.0).then_some([distance, w])
    }

    /// Where a ray meets the balls first, also behind its origin.
    pub(super) fn meet(&self, line: &Line) -> Option<Meeting> {
        let [a, b] = self.ends;
        let [(c, along), (to, further)] = [a, b].map(|p| line.across(p.truncate()));
        let (dc, speed, r, dr) = (to - c, further - along, a.w, b.w - a.w);
        let cone = dc.length_squared() + speed * speed - dr * dr;
        let greater = if dr > 0.0 { 1.0 } else { 0.0 };
        let mut w = greater;
        // Else one ball is within the other.
        if cone > 0.0 {
            let square = ((dc * r - c * dr).length_squared() - c.cross(dc).length_squared()) / cone;
            let root = square.sqrt();
            if root.is_nan() {
                return None;
            }
            let (q0, q1, q2) = (r * r - c.length_squared(), r * dr - c.dot(dc), dr * dr - dc.length_squared());
            let turn = speed * root;
            // Of two forms that with the sum.
            w = if turn * q1 > 0.0 { (square - q0) / (turn + q1) } else { (turn - q1) / q2 };
            if w.is_nan() {
                w = if speed > 0.0 { 0.0 } else { 1.0 }; // along the axis of a cylinder
            } else if r + dr * w < 0.0 {
                w = greater; // the cone beyond its tip: on this side its balls are met the earlier the greater they are
            } else if w > 0.0 && w < 1.0 {
                return Some([along + speed * w - root, w]);
            }
            w = w.clamp(0.0, 1.0);
        }
        let q = (r + dr * w).powi(2) - (c + dc * w).length_squared();
        (q >= 0.0).then(|| [along + speed * w - q.sqrt(), w])
    }

    /// Whether a place on the last ball is covered by the piece to `next`: beyond the circle where its cone touches the ball.
    fn is_past(&self, next: DVec4, line: &Line, distance: f64) -> bool {
        let [_, ball] = self.ends;
        let step = next - ball;
        let from: DVec3 = line.origin + line.dir * distance - ball.truncate();
        let axis = step.truncate();
        from.dot(axis) + ball.w * step.w > OVERLAP * ball.w * axis.length()
    }
}
