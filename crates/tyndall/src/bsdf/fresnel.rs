//! Fresnel's equations: how much a smooth interface reflects, for unpolarised light.
//!
//! - [`dielectric`]: exact, with total internal reflection. `eta` is the index on the far side over that on the near
//!   side. Only `(η − 1)(η + 1) + cos²` is ever formed, so that nothing cancels at grazing angles, at the critical
//!   angle, or as `η → 1`, where the interface vanishes exactly.
//! - [`conductor`]: exact, for a complex index `η + i·k` relative to the near side, each lane its own.
//!
//! The reflectance of diffuse light from inside follows from that from outside, `R_int = 1 − (1 − R_ext)/n²`: the tests
//! hold both against the tables.
//!
//! Source: Born and Wolf 1999, § 1.5.2 and § 14.2; in this form Pharr et al. 2023, § 9.3.5.

use crate::spectrum::Lanes;

/// What an interface between dielectrics does with a direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fresnel {
    /// Reflected fraction of the power, in [0, 1].
    pub reflectance: f32,
    /// Cosine of the refracted direction against the normal on its own side, ≥ 0; 0 when all is reflected.
    pub cos_t: f32,
}

/// Reflectance of a smooth interface for the cosine `cos_i` in [0, 1], into `eta` (> 0) times the index.
#[inline]
pub fn dielectric(cos_i: f32, eta: f32) -> Fresnel {
    // (η cos θt)² = η² − sin² θi
    let squared = (eta - 1.0) * (eta + 1.0) + cos_i * cos_i;
    if squared > 0.0 {
        let eta_cos_t = squared.sqrt();
        let cos_t = eta_cos_t / eta;
        let s = (cos_i - eta_cos_t) / (cos_i + eta_cos_t);
        let p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
        Fresnel { reflectance: 0.5 * (s * s + p * p), cos_t }
    } else {
        Fresnel { reflectance: 1.0, cos_t: 0.0 }
    }
}

/// Reflectance of a smooth metal for the cosine `cos_i` in [0, 1].
#[inline]
pub fn conductor(cos_i: f32, eta: Lanes, k: Lanes) -> Lanes {
    Lanes::new(std::array::from_fn(|i| conductor_lane(cos_i, eta.lane(i), k.lane(i))))
}

#[inline]
fn conductor_lane(cos_i: f32, eta: f32, k: f32) -> f32 {
    // Away from exact grazing, where both polarisations are 0/0 for an index of 1.
    let cos = cos_i.clamp(1e-10, 1.0);
    let cos2 = cos * cos;
    let sin2 = 1.0 - cos2;
    // (a + ib)² = (η + ik)² − sin²; a² + b² and a, the latter without cancelling for k ≫ η.
    let real = (eta - 1.0) * (eta + 1.0) - k * k + cos2;
    let half_imaginary = eta * k;
    let modulus = (real * real + 4.0 * half_imaginary * half_imaginary).sqrt();
    let larger = (0.5 * (modulus + real.abs())).sqrt();
    let a = if real >= 0.0 { larger } else { half_imaginary / larger };
    let (even, odd) = (modulus + cos2, 2.0 * a * cos);
    let s = (even - odd) / (even + odd);
    let (even, odd) = (cos2 * modulus + sin2 * sin2, odd * sin2);
    let p_over_s = (even - odd) / (even + odd);
    0.5 * s * (1.0 + p_over_s)
}
