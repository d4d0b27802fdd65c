//! Strands: curves with a width. Hair, fur, grass.
//!
//! A strand is a run of cubic Bézier segments in space and radius; every [`Basis`] becomes that. What is around the curve:
//!
//! | style | surface | normal |
//! |---|---|---|
//! | [`Style::Flat`] | a ribbon that turns to whoever looks | to the ray |
//! | [`Style::Ribbon`] | a ribbon with normals of its own | to the ray, across the curve (as pbrt); narrower seen from its edge |
//! | [`Style::Round`] | a tube, open at its ends, with parts of balls at sharp bends, met from outside only | that of the tube |
//! | [`Style::Round`], [`Basis::Linear`] | where a ball goes that moves along: closed, with balls at joints and ends (as Mitsuba) | that of the ball |
//!
//! `u` runs along the strand. `v = (1 + h)/2`, where `h` is the offset of the ray from the axis over the radius, positive on
//! the side of `ω_o × ∂p/∂u`: what a model of fibres asks for ([`crate::bsdf::hair`]).
//!
//! In the tree a segment is one or more pieces, cut where that makes boxes much smaller.

mod basis;
mod capsule;
mod joint;
mod segment;

use glam::{DVec3, DVec4, Vec4};

pub use basis::Basis;

use super::{
    ShapeError,
    bvh::bundle::Sheath,
    derivatives::Local,
    instance::{Placement, outward},
    interaction::Point,
};
use crate::math::{Bounds, Ray, Transform, Vec2, Vec3};
use capsule::Capsule;
use joint::Joint;
pub(super) use segment::Line;
use segment::{Bezier, Meeting, nearer};

/// A segment is cut in halves at most so often, and these again, if their boxes have less than [`WORTHWHILE`] of its surface.
const CUTS: u32 = 2;
const WORTHWHILE: f32 = 0.9;

/// Pieces are cut more often, up to so often, that are no cones.
const MAX_CUTS: u32 = 4;

/// What is around a curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Style {
    /// A ribbon that turns to the ray.
    #[default]
    Flat,
    /// A ribbon with normals.
    Ribbon,
    /// A tube.
    Round,
}

/// A control point of a strand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Knot {
    /// Where [length].
    pub p: Vec3,
    /// Half of the width there [length].
    pub radius: f32,
}

/// A segment: control points with their radii, and where on the strand it is.
#[derive(Debug, Clone, Copy)]
struct Segment {
    points: [Vec4; 4],
    u: [f32; 2],
    basis: Basis,
}

impl Segment {
    fn bezier(&self) -> Bezier {
        Bezier(self.points.map(Vec4::as_dvec4))
    }
}

/// A part of a segment, for the tree.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    pub(super) segment: u32,
    /// Its parameters on the segment.
    pub(super) part: [f32; 2],
    /// Whether a ray enters it once: [`Bezier::is_cone`].
    is_cone: bool,
    /// Whether the tube goes on from its end in another direction: [`Joint`].
    is_at_joint: bool,
}

/// Any number of strands of one style.
#[derive(Debug, Clone, Default)]
pub struct Curves {
    style: Style,
    segments: Vec<Segment>,
    /// Of ribbons: normals at both ends of each segment.
    normals: Vec<[Vec3; 2]>,
}

impl Curves {
    /// No strand yet.
    pub fn new(style: Style) -> Self {
        Self { style, ..Self::default() }
    }

    /// Adds a strand; `u` runs from 0 to 1 over all of it. Points that are left over make no segment.
    pub fn push(&mut self, basis: Basis, knots: &[Knot]) {
        let points: Vec<DVec4> = knots.iter().map(|k| k.p.as_dvec3().extend(f64::from(k.radius))).collect();
        let first = self.segments.len();
        let made = basis.beziers(&points).map(|b| Segment { points: b.map(DVec4::as_vec4), u: [0.0, 1.0], basis });
        self.segments.extend(made);
        let count = (self.segments.len() - first) as f32;
        for (i, segment) in self.segments[first..].iter_mut().enumerate() {
            segment.u = [i as f32 / count, (i + 1) as f32 / count];
        }
    }

    /// Adds a strand whose radius changes evenly from one end to the other; `u` runs from 0 to 1 over each of its segments, as
    /// in pbrt.
    pub fn push_tapered(&mut self, basis: Basis, points: &[Vec3], [root, tip]: [f32; 2]) {
        let points: Vec<DVec4> = points.iter().map(|p| p.as_dvec3().extend(0.0)).collect();
        let count = basis.segments(points.len()).unwrap_or(0) as f32;
        self.segments.extend(basis.beziers(&points).enumerate().map(|(i, bezier)| {
            let mut points = bezier.map(DVec4::as_vec4);
            for (k, p) in points.iter_mut().enumerate() {
                let share = (i as f32 + k as f32 / 3.0) / count;
                p.w = root + (tip - root) * share;
            }
            Segment { points, u: [0.0, 1.0], basis }
        }));
    }

    /// Gives the segments of a ribbon normals, from one to the next.
    pub fn orient(&mut self, normals: &[Vec3]) {
        self.normals = normals.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    }

    /// What is around the curves.
    pub fn style(&self) -> Style {
        self.style
    }

    /// How many segments there are.
    pub fn len(&self) -> usize {
        self.segments.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.segments.is_empty()
    }

    pub(super) fn bytes(&self) -> usize {
        size_of_val(&*self.segments) + size_of_val(&*self.normals)
    }

    pub(super) fn check(&self) -> Result<(), ShapeError> {
        let points = || self.segments.iter().flat_map(|s| s.points);
        if !points().all(Vec4::is_finite) || !self.normals.iter().flatten().all(|n| n.is_finite()) {
            return Err(ShapeError::NotFinite);
        }
        if let Some(p) = points().find(|p| p.w < 0.0) {
            return Err(ShapeError::NotPositive { what: "width of the curve", value: 2.0 * p.w });
        }
        if self.segments.iter().all(|s| s.points.iter().all(|p| p.w == 0.0)) {
            return Err(ShapeError::NotPositive { what: "width of the curve", value: 0.0 });
        }
        if self.style == Style::Ribbon && self.normals.len() != self.segments.len() {
            return Err(ShapeError::RibbonNormals { segments: self.segments.len(), normals: self.normals.len() });
        }
        Ok(())
    }

    /// The segments as Bézier curves, with their radii.
    pub fn beziers(&self) -> impl Iterator<Item = [DVec4; 4]> {
        self.segments.iter().map(|segment| segment.bezier().0)
    }

    /// The strands in the world; `None` under a map that stretches them unevenly.
    pub fn placed(mut self, transform: &Transform) -> Option<Self> {
        let scale = Placement::new(transform).uniform_scale()?;
        let map = transform.matrix.as_dmat4();
        for p in self.segments.iter_mut().flat_map(|s| &mut s.points) {
            let moved = map.transform_point3(p.truncate().as_dvec3());
            *p = moved.extend(f64::from(p.w) * scale).as_vec4();
        }
        for n in self.normals.iter_mut().flatten() {
            *n = (map.transform_vector3(n.as_dvec3()) / scale).as_vec3();
        }
        Some(self)
    }

    /// What of the strands goes into the tree.
    pub(super) fn pieces(&self) -> impl Iterator<Item = (Piece, Sheath)> {
        (0..self.segments.len() as u32).flat_map(|segment| {
            let bezier = self.segments[segment as usize].bezier();
            let joint = if self.style == Style::Round { self.joint(segment, &bezier) } else { None };
            let mut pieces = Vec::new();
            cut(&bezier, ([0.0, 1.0], sheath(&bezier, [0.0, 1.0])), 0, &mut |part, sheath| {
                let is_at_joint = part[1] == 1.0 && joint.is_some();
                pieces
                    .push((Piece { segment, part, is_cone: bezier.is_cone(part.map(f64::from)), is_at_joint }, sheath));
            });
            pieces
        })
    }

    pub(super) fn bounds(&self) -> Bounds {
        self.segments.iter().map(|s| around(&s.bezier())).fold(Bounds::EMPTY, Bounds::union)
    }

    /// The nearest hit of a piece before `t_max`: distance, and where on the segment.
    #[inline(always)]
    pub(super) fn intersect(&self, piece: &Piece, line: &Line, t_max: f32) -> Option<(f32, Vec2)> {
        let segment = &self.segments[piece.segment as usize];
        let (bezier, part) = (segment.bezier(), piece.part.map(f64::from));
        let [distance, w] = match self.style {
            Style::Round => self.enter(piece, &bezier, line),
            Style::Flat => line.see(&bezier).cross(part, |_| 1.0),
            Style::Ribbon => line.see(&bezier).cross(part, |w| self.normal(piece.segment, w).dot(line.dir).abs()),
        }?;
        let t = line.t(distance);
        (t > 0.0 && t < t_max).then_some((t, Vec2::new(w as f32, 0.0)))
    }

    /// Where a ray comes into a piece of a tube, or into the bend at its end.
    #[inline(always)]
    fn enter(&self, piece: &Piece, bezier: &Bezier, line: &Line) -> Option<Meeting> {
        if let Some(capsule) = self.capsule(piece.segment) {
            return capsule.enter(line);
        }
        let (seen, part) = (line.see(bezier), piece.part.map(f64::from));
        let tube = if piece.is_cone { seen.enter_cone(part) } else { seen.enter(part) };
        if !piece.is_at_joint {
            return tube;
        }
        nearer([tube, self.joint(piece.segment, bezier).and_then(|joint| joint.enter(line))])
    }

    /// A straight piece of a tube, if this is one: its neighbours are those that share its ends.
    fn capsule(&self, segment: u32) -> Option<Capsule> {
        let is_straight = |segment: &&Segment| segment.basis == Basis::Linear && self.style == Style::Round;
        let get = |index: usize| self.segments.get(index).filter(is_straight).map(|segment| segment.points);
        let index = segment as usize;
        let [first, .., last] = get(index)?;
        let before = index.checked_sub(1).and_then(get);
        let next = get(index + 1).filter(|next| next[0] == last);
        Some(Capsule {
            ends: [first.as_dvec4(), last.as_dvec4()],
            is_first: before.is_none_or(|before| before[3] != first),
            next: next.map(|next| next[3].as_dvec4()),
        })
    }

    /// The sharp bend at the end of a segment.
    fn joint(&self, segment: u32, bezier: &Bezier) -> Option<Joint> {
        Joint::between(bezier, &self.segments.get(segment as usize + 1)?.bezier())
    }

    /// The normal of a ribbon, turned evenly from one end to the other.
    fn normal(&self, segment: u32, w: f64) -> DVec3 {
        let [a, b] = self.normals[segment as usize].map(|n| n.as_dvec3().normalize_or_zero());
        let angle = a.angle_between(b);
        let sin = angle.sin();
        if sin < 1e-6 {
            return a.lerp(b, w).normalize_or_zero();
        }
        (a * ((1.0 - w) * angle).sin() + b * (w * angle).sin()) / sin
    }

    pub(super) fn point(&self, ray: &Ray, segment: u32, at: Vec2) -> Point {
        let line = Line::of(ray);
        let Segment { u: [u0, u1], .. } = self.segments[segment as usize];
        let bezier = self.segments[segment as usize].bezier();
        let w = f64::from(at.x);
        let is_tube = self.style == Style::Round;
        let capsule = self.capsule(segment).and_then(|capsule| capsule.meet(&line));
        let ball = match capsule {
            None if is_tube && w == 1.0 => self.joint(segment, &bezier).and_then(|joint| joint.enter(&line)),
            _ => capsule,
        };
        let surface = ball.or_else(|| is_tube.then(|| line.see(&bezier).refined(w)));
        let w = surface.map_or(w, |[_, w]| w);
        let jet = bezier.at(w);
        let (centre, tangent, radius) = (jet.p.truncate(), jet.d.truncate(), jet.p.w);
        let axis = tangent.normalize_or(DVec3::X);
        // To the side that is positive for h.
        let side = axis.cross(line.dir).normalize_or_zero();
        let size = centre.abs().max_element() + radius;
        let (p, ng, h, error) = if let Some([distance, _]) = surface {
            let from = line.origin + line.dir * distance - centre;
            let (out, slope) = match ball {
                Some(_) => (from, 0.0),
                None => (from.reject_from_normalized(axis), jet.d.w / tangent.length()),
            };
            let out = out.normalize_or(-line.dir);
            let ng = out - axis * slope;
            (centre + out * radius, ng, out.dot(side), size * (-45f64).exp2())
        } else {
            let distance = (centre - line.origin).dot(line.dir);
            let met = line.origin + line.dir * distance;
            let half = match self.style {
                Style::Ribbon => radius * self.normal(segment, w).dot(line.dir).abs(),
                _ => radius,
            };
            let ng = (-line.dir).reject_from_normalized(axis);
            // To another ray the ribbon shows another face: it is anywhere within its width.
            (met, ng, (met - centre).dot(side) / half, 2.0 * radius)
        };
        let u = f64::from(u0) + w * f64::from(u1 - u0);
        let v = 0.5 + 0.5 * h.clamp(-1.0, 1.0);
        Point { p, error, ng, ns: ng, uv: Vec2::new(u as f32, v as f32).into(), dpdu: tangent / f64::from(u1 - u0) }
    }

    /// Along the strand and across it. They have no relief, so nothing asks how their normals turn.
    pub(super) fn derivatives(&self, segment: u32, n: DVec3, u: f32) -> Local {
        let Segment { u: [u0, u1], .. } = self.segments[segment as usize];
        let jet = self.segments[segment as usize].bezier().at(f64::from((u - u0) / (u1 - u0)));
        let along = jet.d.truncate() / f64::from(u1 - u0);
        let across = n.cross(along).normalize_or_zero() * (2.0 * jet.p.w);
        Local { dp: [along, across], dn: [DVec3::ZERO; 2] }
    }
}

/// The box of the control points, grown by the greatest radius.
fn around(bezier: &Bezier) -> Bounds {
    let points = bezier.0.map(DVec4::truncate);
    let min = points.iter().fold(DVec3::INFINITY, |a, p| a.min(*p));
    let max = points.iter().fold(DVec3::NEG_INFINITY, |a, p| a.max(*p));
    // A little more, for pieces overlap.
    let reach = DVec3::splat(bezier.reach()) + (max - min) * 1e-6;
    outward(min - reach, max + reach)
}

/// What holds a part of a segment: all within its chord's distance from the curve and the greatest radius, and a little more for
/// what it shares with its neighbours and for the rounding of its ends.
fn sheath(bezier: &Bezier, part: [f32; 2]) -> Sheath {
    let overlap = 3.0 * bezier.leg() * bezier.overlap();
    let part = bezier.part(part.map(f64::from));
    let ends = [part.0[0], part.0[3]].map(DVec4::truncate);
    let rounding = ends.map(|p| (p.as_vec3().as_dvec3() - p).length());
    let radius = (part.reach() + part.bulge()) * (1.0 + 1e-6) + overlap + rounding[0].max(rounding[1]);
    Sheath { ends: ends.map(DVec3::as_vec3), radius: (radius as f32).next_up() }
}

/// Cuts a part of a segment, with its sheath, into halves while that is worth it: `cuts` are those behind it.
fn cut(bezier: &Bezier, (part, whole): ([f32; 2], Sheath), cuts: u32, found: &mut impl FnMut([f32; 2], Sheath)) {
    let [from, to] = part;
    let is_bent = cuts < MAX_CUTS && !bezier.is_cone(part.map(f64::from));
    if !is_bent && cuts >= CUTS {
        return found(part, whole);
    }
    let middle = 0.5 * (from + to);
    let halves = [[from, middle], [middle, to]].map(|part| (part, sheath(bezier, part)));
    let area = |sheath: &Sheath| sheath.bounds().half_area();
    if !is_bent && area(&halves[0].1) + area(&halves[1].1) > WORTHWHILE * area(&whole) {
        return found(part, whole);
    }
    for half in halves {
        cut(bezier, half, cuts + 1, found);
    }
}
