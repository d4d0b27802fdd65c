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
    /// Of each piece [length²].
    areas: Vec<f32>,
    by_area: Discrete,
}

impl Surface {
    /// `None` for a surface without area.
    pub fn new(pieces: Vec<EmitterShape>) -> Option<Self> {
        let areas: Vec<f32> = pieces.iter().map(EmitterShape::area).collect();
        let by_area = Discrete::new(&areas)?;
        Some(Self { pieces, areas, by_area })
    }

    /// A point, and what it weighs in a mean over the area: 1, but for curved patches, whose points are not quite uniform.
    #[inline]
    pub(super) fn sample(&self, u: Vec2) -> (Point, f32) {
        let (index, _, rest) = self.by_area.sample(u.x.clamp(0.0, 1.0));
        let piece = &self.pieces[index];
        let point = piece.sample_area(Vec2::new(rest, u.y.clamp(0.0, 1.0)));
        (point, 1.0 / (self.areas[index] * piece.pdf_area(point.p, point.ng)))
    }
}
