//! Surface parameters, worked out when something asks for them: clear glass never does, and the angles of a sphere take longer
//! than a look into the tree.

use super::SpherePart;
use crate::math::{Vec2, Vec3};

/// Surface parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Uv {
    /// These.
    Known(Vec2),
    /// Those of a point of a whole sphere, in this direction from its centre by its own axes: `u` is the azimuth, `v` the angle
    /// from the south pole.
    OnSphere(Vec3),
}

impl From<Vec2> for Uv {
    fn from(uv: Vec2) -> Self {
        Self::Known(uv)
    }
}

impl Uv {
    /// The parameters.
    #[inline]
    pub fn get(self) -> Vec2 {
        match self {
            Self::Known(uv) => uv,
            Self::OnSphere(n) => SpherePart::WHOLE.parameters(n.as_dvec3()),
        }
    }
}
