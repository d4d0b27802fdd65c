//! Affine transforms with their inverse kept beside them.

use glam::{DMat4, Mat3, Mat4, Vec3};

use super::{Bounds, Ray, rounding::gamma};

/// An invertible affine map. The inverse is computed once, in double precision.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transform {
    /// Local to world.
    pub matrix: Mat4,
    /// World to local.
    pub inverse: Mat4,
}

impl Default for Transform {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Transform {
    /// The map that changes nothing.
    pub const IDENTITY: Self = Self { matrix: Mat4::IDENTITY, inverse: Mat4::IDENTITY };

    /// The affine map with this matrix, or `None` when the matrix is singular or not finite.
    pub fn new(matrix: DMat4) -> Option<Self> {
        let inverse = matrix.inverse();
        (matrix.is_finite() && inverse.is_finite() && matrix.determinant() != 0.0)
            .then(|| Self { matrix: matrix.as_mat4(), inverse: inverse.as_mat4() })
    }

    /// Maps a point.
    #[inline]
    pub fn point(&self, p: Vec3) -> Vec3 {
        self.matrix.transform_point3(p)
    }

    /// Maps a difference of points.
    #[inline]
    pub fn vector(&self, v: Vec3) -> Vec3 {
        self.matrix.transform_vector3(v)
    }

    /// Maps a normal, by the inverse transpose. Not normalised.
    #[inline]
    pub fn normal(&self, n: Vec3) -> Vec3 {
        let m = &self.inverse;
        Vec3::new(m.x_axis.truncate().dot(n), m.y_axis.truncate().dot(n), m.z_axis.truncate().dot(n))
    }

    /// Maps a world ray into local space; `t` keeps its meaning, so the local direction is not normalised.
    #[inline]
    pub fn ray_to_local(&self, ray: &Ray) -> Ray {
        Ray::new(self.inverse.transform_point3(ray.origin), self.inverse.transform_vector3(ray.dir))
    }

    /// The box around a mapped box.
    pub fn bounds(&self, b: &Bounds) -> Bounds {
        if b.is_empty() {
            return Bounds::EMPTY;
        }
        let mapped = Bounds::of(b.corners().map(|c| self.point(c)));
        let error = gamma(4) * mapped.min.abs().max(mapped.max.abs());
        Bounds { min: mapped.min - error, max: mapped.max + error }
    }

    /// Absolute error of `point(p)` [length] for a `p` that is itself in error by at most `error`:
    /// `|M|·error·(1+γ₃) + γ₃(|M||p| + |translation|)` (Pharr et al. 2023, § 6.8.5).
    pub fn point_error(&self, p: Vec3, error: Vec3) -> Vec3 {
        let abs = Mat3::from_cols(
            self.matrix.x_axis.truncate().abs(),
            self.matrix.y_axis.truncate().abs(),
            self.matrix.z_axis.truncate().abs(),
        );
        let translation = self.matrix.w_axis.truncate().abs();
        abs * error * (1.0 + gamma(3)) + (abs * p.abs() + translation) * gamma(3)
    }

    /// Whether the map mirrors space, so that it turns outward normals of a winding order inward.
    pub fn mirrors(&self) -> bool {
        Mat3::from_mat4(self.matrix).determinant() < 0.0
    }

    /// The greatest factor by which the map shrinks a length, in `(0, 1]` for a contraction: the least singular
    /// value, bounded from below by `1 / ‖M⁻¹‖_F`.
    pub fn least_stretch(&self) -> f32 {
        let inv = Mat3::from_mat4(self.inverse);
        let frobenius =
            (inv.x_axis.length_squared() + inv.y_axis.length_squared() + inv.z_axis.length_squared()).sqrt();
        1.0 / frobenius
    }
}
