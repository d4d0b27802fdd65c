//! Parts of the light, told apart by what its paths have been through.
//!
//! | part | light that has been scattered |
//! |---|---|
//! | `emission` | not at all: sources as they are seen |
//! | `direct` | once, by a surface or in a medium |
//! | `indirect` | more than once |
//! | `unscattered` | in no medium |
//! | `single` | once in media |
//! | `multiple` | more than once in media |
//! | `order0`, `order1`, … | so many times in media |
//! | `beyond8` | more than eight times in media |
//!
//! A mirror and a face of glass scatter as any surface does; a boundary without a material does not. Emission, direct and
//! indirect light are all there is, and so are unscattered, single and multiple light, or all orders up to one with those
//! beyond: but for the rounding of single precision (their sums are taken in another order) they add up to the image.

use super::{Average, LayerKind, Recorded};
use crate::path::History;

/// A part of the light.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// Not scattered.
    Emission,
    /// Scattered once.
    Direct,
    /// Scattered more than once.
    Indirect,
    /// Not scattered in media.
    Unscattered,
    /// Scattered once in media.
    Single,
    /// Scattered more than once in media.
    Multiple,
    /// Scattered so many times in media.
    Order(u32),
    /// Scattered more often than that in media.
    Beyond(u32),
}

impl Part {
    /// Whether light that has been through this belongs to it.
    #[inline]
    pub fn holds(self, history: &History) -> bool {
        match self {
            Self::Emission => history.vertices == 0,
            Self::Direct => history.vertices == 1,
            Self::Indirect => history.vertices > 1,
            Self::Unscattered => history.order == 0,
            Self::Single => history.order == 1,
            Self::Multiple => history.order > 1,
            Self::Order(order) => history.order == order,
            Self::Beyond(order) => history.order > order,
        }
    }

    /// As its channels are called, `single` for `single.R`.
    pub fn name(self) -> String {
        match self {
            Self::Emission => "emission".into(),
            Self::Direct => "direct".into(),
            Self::Indirect => "indirect".into(),
            Self::Unscattered => "unscattered".into(),
            Self::Single => "single".into(),
            Self::Multiple => "multiple".into(),
            Self::Order(order) => format!("order{order}"),
            Self::Beyond(order) => format!("beyond{order}"),
        }
    }

    /// The layer of a film that records it.
    pub fn layer(self) -> LayerKind {
        let name = self.name();
        let channels = ["R", "G", "B"].map(|channel| format!("{name}.{channel}")).into();
        LayerKind { recorded: Recorded::Part(self), channels, average: Average::Samples }
    }
}
