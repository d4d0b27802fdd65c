//! A cubic Bézier curve in space and radius, and how a ray meets the surface around it.
//!
//! # A tube
//!
//! The surface is swept by circles across the curve. Where a ray meets it is found after Reshetov and Luebke 2018,
//! "Phantom Ray-Hair Intersector": at a parameter `w` the surface is nearly a cone along the tangent, whose intersection with
//! the ray is known; how far along the tangent it lies is the step of `w`, and where that step is nothing the ray meets the
//! circle of `w` itself, exactly. A ray that misses the cone takes the step towards its nearest point instead. Steps that
//! change sign are bracketed, so that they end. Only where a ray comes in does it meet a tube: fibres scatter as a whole, and
//! light that goes through one must leave it unhindered. Hence no ray that starts on a tube meets it by rounding, either.
//!
//! # A ribbon
//!
//! Across the ray, the curve is nearest where `e(w)·e′(w) = 0`; it is met if it is no further than its half-width there.

use glam::{DVec3, DVec4, Vec4Swizzles as _};

use crate::math::Ray;

/// Steps of `w` below this are the last: what is left after one is as small as its square.
const SETTLED: f64 = 1e-6;

/// How far a part reaches beyond its ends at least \[1\], so that neighbours overlap: see [`Bezier::overlap`].
const OVERLAP: f64 = 1e-7;

/// Parts whose bulge is at most this share of their radius are nearly cones.
const STRAIGHT: f64 = 0.5;

/// Radii that a chord is long at least, as the ray sees it, where the search begins at one place alone \[1\].
const STEEP: f64 = 2.0;

/// The shortest parts that are cut in two.
const SHORTEST: f64 = 1.0 / 64.0;

/// After so many steps there is nothing.
const MAX_STEPS: u32 = 40;

/// A cubic Bézier curve; the fourth coordinate is the radius [length].
#[derive(Debug, Clone, Copy)]
pub(super) struct Bezier(pub(super) [DVec4; 4]);

/// Place, velocity and acceleration on a curve, each with that of the radius.
#[derive(Debug, Clone, Copy)]
pub(super) struct Jet {
    pub(super) p: DVec4,
    pub(super) d: DVec4,
    pub(super) dd: DVec4,
}

impl Bezier {
    /// At parameter `w`, also a little outside of [0, 1].
    #[inline]
    pub(super) fn at(&self, w: f64) -> Jet {
        let [a, b, c, d] = self.0;
        let (ab, bc, cd) = (b - a, c - b, d - c);
        let v = 1.0 - w;
        let (p0, p1) = (ab * v + bc * w, bc * v + cd * w);
        Jet {
            p: a * (v * v * v) + b * (3.0 * v * v * w) + c * (3.0 * v * w * w) + d * (w * w * w),
            d: (p0 * v + p1 * w) * 3.0,
            dd: (p1 - p0) * 6.0,
        }
    }

    /// The part between two parameters.
    pub(super) fn part(&self, [from, to]: [f64; 2]) -> Self {
        let blossom = |x: f64, y: f64, z: f64| {
            let [a, b, c, d] = self.0;
            let (ab, bc, cd) = (a.lerp(b, x), b.lerp(c, x), c.lerp(d, x));
            ab.lerp(bc, y).lerp(bc.lerp(cd, y), z)
        };
        Self([blossom(from, from, from), blossom(from, from, to), blossom(from, to, to), blossom(to, to, to)])
    }

    /// The greatest radius of the control points.
    pub(super) fn reach(&self) -> f64 {
        self.0.iter().map(|p| p.w).fold(0.0, f64::max)
    }

    /// How far a part reaches beyond its ends \[1\]. The control points are rounded, so tangents of neighbours differ by an angle,
    /// their end circles part by that angle times the radius, and the gap is to be closed.
    pub(super) fn overlap(&self) -> f64 {
        let [a, .., d] = self.0.map(DVec4::truncate);
        let (size, leg) = (a.abs().max_element().max(d.abs().max_element()), (d - a).length() / 3.0);
        let angle = 4.0 * f64::from(f32::EPSILON) * size / leg;
        (OVERLAP + angle * (1.0 + self.reach() / leg)).min(SHORTEST)
    }

    /// The greatest distance from one control point to the next, also in radius: a third of the greatest speed.
    pub(super) fn leg(&self) -> f64 {
        let [a, b, c, d] = self.0;
        (b - a).length().max((c - b).length()).max((d - c).length())
    }

    /// Whether a part is so nearly a cone that a ray enters it once, unless it sees it from its end.
    pub(super) fn is_cone(&self, [from, to]: [f64; 2]) -> bool {
        is_cone(self.bulge() * (to - from) * (to - from), self.reach())
    }

    /// How far the curve is from its chord at most: an eighth of the greatest second derivative.
    pub(super) fn bulge(&self) -> f64 {
        let [a, b, c, d] = self.0.map(DVec4::truncate);
        0.75 * (a - b - b + c).length_squared().max((b - c - c + d).length_squared()).sqrt()
    }
}

/// Whether a part that bulges so much is nearly a cone.
#[inline]
fn is_cone(bulge: f64, reach: f64) -> bool {
    bulge <= STRAIGHT * reach
}

/// That at the lesser distance.
pub(super) fn nearer<const N: usize>(found: [Option<Meeting>; N]) -> Option<Meeting> {
    found.into_iter().flatten().min_by(|a, b| a[0].total_cmp(&b[0]))
}

/// A ray made ready for curves: distances are along the unit direction.
#[derive(Debug, Clone, Copy)]
pub(in crate::shape) struct Line {
    pub(super) origin: DVec3,
    pub(super) dir: DVec3,
    /// Two axes across.
    across: [DVec3; 2],
    /// Of the ray's direction.
    length: f64,
}

/// A curve as a ray sees it: across the ray on two axes, along it, and the radius, each a polynomial of the parameter.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen<'a> {
    curve: &'a Bezier,
    powers: [DVec4; 4],
}

/// How near a ray comes to a chord: the distance, the parameter, and how long the chord is as the ray sees it.
struct Approach {
    distance: f64,
    w: f64,
    projected: f64,
}

/// Where a ray meets a curve: distance along the unit direction, parameter.
pub(super) type Meeting = [f64; 2];

impl Line {
    /// The line of a ray.
    pub(in crate::shape) fn of(ray: &Ray) -> Self {
        let dir = ray.dir.as_dvec3();
        let length = dir.length();
        let dir = dir / length;
        let (x, y) = dir.any_orthonormal_pair();
        Self { origin: ray.origin.as_dvec3(), dir, across: [x, y], length }
    }

    /// A distance along the line, as the ray counts.
    #[inline]
    pub(super) fn t(&self, distance: f64) -> f32 {
        (distance / self.length) as f32
    }

    /// From the ray's place nearest to `p` to `p`, and how far that place is.
    #[inline]
    pub(super) fn across(&self, p: DVec3) -> (DVec3, f64) {
        let from = p - self.origin;
        let along = from.dot(self.dir);
        (from - self.dir * along, along)
    }

    /// The curve as this ray sees it.
    #[inline(always)]
    pub(super) fn see<'a>(&self, curve: &'a Bezier) -> Seen<'a> {
        let [x, y] = self.across;
        let [a, b, c, d] = curve.0.map(|p| {
            let from = p.truncate() - self.origin;
            DVec4::new(from.dot(x), from.dot(y), from.dot(self.dir), p.w)
        });
        Seen { curve, powers: [a, (b - a) * 3.0, (a - b - b + c) * 3.0, d - a + (b - c) * 3.0] }
    }
}

impl Seen<'_> {
    #[inline(always)]
    fn at(&self, w: f64) -> Jet {
        let [a, b, c, d] = self.powers;
        Jet { p: ((d * w + c) * w + b) * w + a, d: (d * (3.0 * w) + c * 2.0) * w + b, dd: d * (6.0 * w) + c * 2.0 }
    }

    /// The nearest entrance into the tube around a part of a curve, if it is ahead of the origin.
    pub(super) fn enter(&self, part: [f64; 2]) -> Option<Meeting> {
        self.enter_within(part, self.curve.reach(), self.curve.bulge())
    }

    /// The same; `reach` and `bulge` are those of the whole curve.
    fn enter_within(&self, part: [f64; 2], reach: f64, bulge: f64) -> Option<Meeting> {
        let [from, to] = part;
        let Approach { distance, w, projected } = self.approach(part);
        let own_bulge = bulge * (to - from) * (to - from);
        if distance > (reach + own_bulge) * (1.0 + OVERLAP) {
            return None;
        }
        if !is_cone(own_bulge, reach) && to - from > SHORTEST {
            let middle = 0.5 * (from + to);
            return nearer([[from, middle], [middle, to]].map(|half| self.enter_within(half, reach, bulge)));
        }
        self.enter_near(part, reach, w, projected)
    }

    /// The entrance into the tube around a part that [is nearly a cone](Bezier::is_cone), if it is ahead of the origin.
    #[inline(always)]
    pub(super) fn enter_cone(&self, part: [f64; 2]) -> Option<Meeting> {
        let Approach { w, projected, .. } = self.approach(part);
        self.enter_near(part, self.curve.reach(), w, projected)
    }

    /// From where the chord of a part is nearest.
    #[inline(always)]
    fn enter_near(&self, part: [f64; 2], reach: f64, w: f64, projected: f64) -> Option<Meeting> {
        let [from, to] = part;
        // A cone is entered once, unless the ray sees it from its end.
        let count = if projected > STEEP * reach { 1 } else { 3 };
        let mut nearest = None;
        for &start in &[w, from, to][..count] {
            nearest = nearer([nearest, self.search(part, start)]);
        }
        nearest
    }

    /// Where the chord of a part is nearest.
    #[inline(always)]
    fn approach(&self, [from, to]: [f64; 2]) -> Approach {
        let [k0, k1, k2, k3] = self.powers.map(DVec4::xy);
        let [a, b] = [from, to].map(|w| ((k3 * w + k2) * w + k1) * w + k0);
        let chord = b - a;
        let square = chord.length_squared();
        let share = if square > 0.0 { (-a.dot(chord) / square).clamp(0.0, 1.0) } else { 0.5 };
        Approach { distance: (a + chord * share).length(), w: from + share * (to - from), projected: square.sqrt() }
    }

    /// Whether a parameter is on the part or so little beyond it that a neighbour may leave it out.
    #[inline(always)]
    fn is_on(&self, [from, to]: [f64; 2], w: f64) -> bool {
        if w >= from && w <= to {
            return true;
        }
        let overlap = self.curve.overlap();
        w >= from - overlap && w <= to + overlap
    }

    /// From one parameter of the part.
    #[inline(always)]
    fn search(&self, part: [f64; 2], start: f64) -> Option<Meeting> {
        let [from, to] = part;
        let width = to - from;
        let mut w = start;
        let mut last: Option<[f64; 2]> = None;
        for count in 0..MAX_STEPS {
            let (distance, step, is_met) = self.meet_cone(w)?;
            if step.abs() < SETTLED {
                let w = w + step;
                return (is_met && distance > 0.0 && self.is_on(part, w)).then_some([distance, w]);
            }
            let step = step.clamp(-0.5 * width, 0.5 * width);
            let next = match last {
                Some([before, old]) if old * step < 0.0 => {
                    // Between the two: by the secant, and now and then by halves.
                    if count % 4 == 3 { 0.5 * (before + w) } else { (step * before - old * w) / (step - old) }
                }
                _ => w + step,
            };
            last = Some([w, step]);
            w = next;
            if w < from - width || w > to + width {
                return None;
            }
        }
        None
    }

    /// The cone that touches the surface at a parameter: the distance where the ray enters it, how far along the curve that is,
    /// and whether it does; else where it is nearest. `None` along the axis.
    ///
    /// With `c` from the ray's nearest place to the curve, `v` its velocity, `τ = (s d − c)·v/v²` and the radius `r + r′τ`:
    /// `|s d − c|² − τ² v² = (r + r′τ)²`.
    #[inline(always)]
    fn meet_cone(&self, w: f64) -> Option<(f64, f64, bool)> {
        let Jet { p, d: v, dd } = self.at(w);
        let (along, r, vd, dr) = (p.z, p.w, v.z, v.w);
        let (c, vv, cv) = (p.xy(), v.truncate().length_squared(), p.xy().dot(v.xy()));
        let k = 1.0 + dr * dr / vv;
        let qa = vv - k * vd * vd;
        let qb = vd * (k * cv - r * dr);
        let qc = vv * (c.length_squared() - r * r) - k * cv * cv + 2.0 * r * dr * cv;
        if qa.is_nan() || qa <= 0.0 {
            return None;
        }
        let discriminant = qb * qb - qa * qc;
        let s = (-qb - discriminant.max(0.0).sqrt()) / qa;
        // The foot of the perpendicular moves faster than along a straight line where the curve bends towards the ray. Only what is
        // across the curve bends it: where three control points coincide, it stops, and is straight.
        let foot = s * vd - cv;
        let bend = s * dd.z - c.dot(dd.xy()) - foot * v.truncate().dot(dd.truncate()) / vv;
        Some((along + s, foot / (vv - bend).max(0.25 * vv), discriminant >= 0.0))
    }

    /// Where a ribbon that is turned to the ray is met. `half` is its half-width at a parameter, in units of the radius.
    pub(super) fn cross(&self, part: [f64; 2], half: impl Fn(f64) -> f64) -> Option<Meeting> {
        let [from, to] = part;
        let Approach { distance, mut w, .. } = self.approach(part);
        if distance > (self.curve.reach() + self.curve.bulge() * (to - from).powi(2)) * (1.0 + OVERLAP) {
            return None;
        }
        for _ in 0..MAX_STEPS {
            let Jet { p, d, dd } = self.at(w);
            let (e, along, d, dd) = (p.xy(), p.z, d.xy(), dd.xy());
            let slope = d.length_squared() + e.dot(dd);
            // Where the distance bends the wrong way: as if the curve were straight.
            let slope = if slope > 0.0 { slope } else { d.length_squared() };
            let step = -e.dot(d) / slope;
            if step.is_nan() {
                return None;
            }
            if step.abs() < SETTLED {
                let w = w + step;
                let is_met = e.length() <= p.w * half(w) && along > 0.0 && self.is_on(part, w);
                return is_met.then_some([along, w]);
            }
            w += step.clamp(from - to, to - from);
            if w < from - (to - from) || w > to + (to - from) {
                return None;
            }
        }
        None
    }

    /// The same meeting to all digits, from one that was rounded.
    pub(super) fn refined(&self, w: f64) -> Meeting {
        let mut w = w;
        let mut distance = 0.0;
        for _ in 0..8 {
            let Some((at, step, _)) = self.meet_cone(w) else { break };
            distance = at;
            if step.abs() < f64::EPSILON || step.abs() > OVERLAP {
                break;
            }
            w += step;
        }
        [distance, w]
    }
}

#[cfg(test)]
mod tests;
