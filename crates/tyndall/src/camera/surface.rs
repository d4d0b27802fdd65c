//! A surface in the world from whose points rays start, or to which they go.

use crate::{
    light::{EmitterShape, Point},
    math::Vec2,
    sampling::discrete::Discrete,
};

/// Pieces of surface, in the world.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    pieces: Vec<EmitterShape>,
    by_area: Discrete,
}

impl Surface {
    /// `None` for a surface without area.
    pub fn new(pieces: Vec<EmitterShape>) -> Option<Self> {
        let by_area = Discrete::from_f64(pieces.iter().map(|piece| f64::from(piece.area())))?;
        Some(Self { pieces, by_area })
    }

    /// A point, and what it weighs in a mean over the area: 1, but for curved patches, whose points are not quite uniform.
    #[inline]
    pub(super) fn sample(&self, u: Vec2) -> (Point, f32) {
        let (piece, _, rest) = self.by_area.sample(u.x.clamp(0.0, 1.0));
        let piece = &self.pieces[piece];
        let point = piece.sample_area(Vec2::new(rest, u.y.clamp(0.0, 1.0)));
        (point, 1.0 / (piece.area() * piece.pdf_area(point.p, point.ng)))
    }
}
