//! Bounds on the rounding error of single precision, after Higham (2002) and pbrt (Pharr et al. 2023, § 6.8).

/// Half the distance from 1 to the next `f32`.
pub const UNIT_ROUNDOFF: f32 = f32::EPSILON * 0.5;

/// `γ_n = n·u / (1 − n·u)`: bound on the relative error of `n` successive roundings.
#[inline]
pub const fn gamma(n: u32) -> f32 {
    let nu = n as f32 * UNIT_ROUNDOFF;
    nu / (1.0 - nu)
}
