//! An orthonormal frame around a direction: the local space of BSDFs and phase functions.

use glam::Vec3;

/// A right-handed orthonormal basis; `n` is the local z axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Local x.
    pub s: Vec3,
    /// Local y.
    pub t: Vec3,
    /// Local z: the normal, or the direction of travel.
    pub n: Vec3,
}

impl Frame {
    /// A frame around the unit vector `n`, without branches or singularities (Duff et al. 2017).
    #[inline]
    pub fn around(n: Vec3) -> Self {
        let sign = 1f32.copysign(n.z);
        let a = -1.0 / (sign + n.z);
        let b = n.x * n.y * a;
        Self {
            s: Vec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x),
            t: Vec3::new(b, sign + n.y * n.y * a, -n.y),
            n,
        }
    }

    /// World direction to local coordinates.
    #[inline]
    pub fn to_local(&self, v: Vec3) -> Vec3 {
        Vec3::new(v.dot(self.s), v.dot(self.t), v.dot(self.n))
    }

    /// Local coordinates to a world direction.
    #[inline]
    pub fn to_world(&self, v: Vec3) -> Vec3 {
        self.s * v.x + self.t * v.y + self.n * v.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_is_orthonormal_and_right_handed_at_the_poles_too() {
        for n in [Vec3::Z, -Vec3::Z, Vec3::X, Vec3::new(1.0, -2.0, 3.0).normalize(), Vec3::new(1e-9, 0.0, -1.0)] {
            let f = Frame::around(n);
            assert!((f.s.cross(f.t) - f.n).length() < 1e-6, "{n}");
            assert!(f.s.dot(f.t).abs() < 1e-6 && (f.s.length() - 1.0).abs() < 1e-6, "{n}");
            let v = Vec3::new(0.3, -0.5, 0.7);
            assert!((f.to_local(f.to_world(v)) - v).length() < 1e-6);
        }
    }
}
