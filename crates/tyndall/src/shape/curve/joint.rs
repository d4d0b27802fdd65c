//! Where a tube goes on in another direction: between the circles at which two segments end, a part of a ball.
//!
//! Each segment of a tube ends at a plane across it. Where the next one goes another way, the planes part on the outside of the
//! bend, by an angle; on the inside the tubes pass through each other. What a ball covers that goes along the strand is,
//! besides the tubes, the part of the ball at the joint that is beyond the end of the one and before the beginning of the other:
//! a lune. Its edges are halves of the circles at which the tubes end, so nothing is open, and no other part of the ball is met.
//! Bends without an end of the tube (B-splines and Catmull–Rom curves turn, however sharply) need none of this.

use glam::{DVec3, DVec4};

use super::segment::{Bezier, Line, Meeting};

/// A sharp bend.
#[derive(Debug, Clone, Copy)]
pub(super) struct Joint {
    /// Place and radius.
    ball: DVec4,
    /// Along the segment that ends here.
    before: DVec3,
    /// Along the segment that begins here.
    after: DVec3,
}

impl Joint {
    /// At the end of `a`, if `b` begins there and goes another way than the overlap of neighbours closes.
    pub(super) fn between(a: &Bezier, b: &Bezier) -> Option<Self> {
        let ([a0, a1, a2, ball], [b0, b1, b2, b3]) = (a.0, b.0);
        if ball != b0 {
            return None;
        }
        // Control points may coincide.
        let first = |steps: [DVec4; 3]| steps.map(DVec4::truncate).into_iter().find(|step| *step != DVec3::ZERO);
        let before = first([ball - a2, ball - a1, ball - a0])?;
        let after = first([b1 - b0, b2 - b0, b3 - b0])?;
        let closed = a.overlap().min(b.overlap()) * before.length().min(after.length());
        let sine = before.cross(after).length() / (before.length() * after.length());
        (before.dot(after) <= 0.0 || sine * ball.w > closed).then_some(Self { ball, before, after })
    }

    /// Where a ray comes in, if that is ahead of its origin: at the end of the segment before.
    pub(super) fn enter(&self, line: &Line) -> Option<Meeting> {
        let (c, along) = line.across(self.ball.truncate());
        let distance = along - (self.ball.w * self.ball.w - c.length_squared()).sqrt();
        let from = line.origin + line.dir * distance - self.ball.truncate();
        // Also not where the root is not a number.
        (distance > 0.0 && from.dot(self.before) >= 0.0 && from.dot(self.after) <= 0.0).then_some([distance, 1.0])
    }
}
