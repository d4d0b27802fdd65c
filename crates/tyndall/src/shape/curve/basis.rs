//! From the control points of a strand to its segments: cubic Bézier curves in space and radius.
//!
//! Points are `(x, y, z, r)`, so that whatever is done to the points is done to the radius.

use glam::DVec4;

/// How control points make a curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Basis {
    /// Straight from point to point.
    Linear,
    /// Segments of three points that share their ends.
    QuadraticBezier,
    /// Segments of four points that share their ends.
    CubicBezier,
    /// A uniform B-spline of degree 2: one segment for three points, one more for each further point.
    QuadraticBSpline,
    /// A uniform B-spline of degree 3: one segment for four points, one more for each further point.
    CubicBSpline,
    /// Through all points but the first and the last, with the tangent `(p_(i+1) − p_(i−1))/2`.
    CatmullRom,
}

impl Basis {
    /// How many control points a segment has.
    pub fn points(self) -> usize {
        match self {
            Self::Linear => 2,
            Self::QuadraticBezier | Self::QuadraticBSpline => 3,
            Self::CubicBezier | Self::CubicBSpline | Self::CatmullRom => 4,
        }
    }

    /// How many points on the next segment begins.
    pub fn step(self) -> usize {
        match self {
            Self::QuadraticBezier => 2,
            Self::CubicBezier => 3,
            Self::Linear | Self::QuadraticBSpline | Self::CubicBSpline | Self::CatmullRom => 1,
        }
    }

    /// How many segments so many points make, if they make a whole number of them.
    pub fn segments(self, points: usize) -> Option<usize> {
        let more = points.checked_sub(self.points())?;
        more.is_multiple_of(self.step()).then_some(1 + more / self.step())
    }

    /// The segments of a strand, as cubic Bézier curves.
    pub fn beziers(self, points: &[DVec4]) -> impl Iterator<Item = [DVec4; 4]> {
        points.windows(self.points()).step_by(self.step()).map(move |window| self.bezier(window))
    }

    fn bezier(self, p: &[DVec4]) -> [DVec4; 4] {
        match (self, p) {
            (Self::Linear, &[a, b]) => [a, a.lerp(b, 1.0 / 3.0), a.lerp(b, 2.0 / 3.0), b],
            (Self::QuadraticBezier, &[a, b, c]) => raised([a, b, c]),
            (Self::QuadraticBSpline, &[a, b, c]) => raised([(a + b) * 0.5, b, (b + c) * 0.5]),
            (Self::CubicBezier, &[a, b, c, d]) => [a, b, c, d],
            (Self::CubicBSpline, &[a, b, c, d]) => {
                [(a + 4.0 * b + c) / 6.0, (2.0 * b + c) / 3.0, (b + 2.0 * c) / 3.0, (b + 4.0 * c + d) / 6.0]
            }
            (Self::CatmullRom, &[a, b, c, d]) => [b, b + (c - a) / 6.0, c - (d - b) / 6.0, c],
            _ => [DVec4::NAN; 4], // windows have the length that the basis asks for
        }
    }
}

/// The same curve, one degree higher.
fn raised([a, b, c]: [DVec4; 3]) -> [DVec4; 4] {
    [a, a.lerp(b, 2.0 / 3.0), c.lerp(b, 2.0 / 3.0), c]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A spline of points on a line at even distances is that line at even speed: segment i of degree d starts `(d − 1)/2` on.
    #[test]
    fn even_points_make_an_even_line() {
        let points: Vec<_> = (0..7).map(|i| DVec4::new(1.0, 2.0, -1.0, 0.5) * f64::from(i)).collect();
        for (basis, start, count) in [
            (Basis::Linear, 0.0, 6),
            (Basis::QuadraticBezier, 0.0, 3),
            (Basis::CubicBezier, 0.0, 2),
            (Basis::QuadraticBSpline, 0.5, 5),
            (Basis::CubicBSpline, 1.0, 4),
            (Basis::CatmullRom, 1.0, 4),
        ] {
            let segments: Vec<_> = basis.beziers(&points).collect();
            assert_eq!((segments.len(), basis.segments(7)), (count, Some(count)), "{basis:?}");
            let length = match basis {
                Basis::QuadraticBezier => 2.0,
                Basis::CubicBezier => 3.0,
                _ => 1.0,
            };
            for (i, segment) in segments.iter().enumerate() {
                for (k, p) in segment.iter().enumerate() {
                    let at = start + length * (i as f64 + k as f64 / 3.0);
                    assert!((*p - DVec4::new(1.0, 2.0, -1.0, 0.5) * at).length() < 1e-12, "{basis:?} {i} {k}");
                }
            }
        }
    }
}
