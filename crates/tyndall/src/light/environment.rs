//! Light that comes from all around: a uniform sky, or an image of one.

use std::f32::consts::{FRAC_1_PI, PI};

use super::{LightSample, Reference, SkyError, SkyImage, Target};
use crate::{
    math::{Frame, Transform, Vec2, Vec3, fast::sin_cos_turn},
    sampling::{piecewise2d::Piecewise2d, warp},
    spectrum::{Lanes, Spectrum, Wavelengths, srgb},
};

/// The same radiance from every direction.
#[derive(Debug, Clone)]
pub struct ConstantEnvironment {
    /// Radiance [W·m⁻²·sr⁻¹].
    pub radiance: Spectrum,
    /// Its luminance, for the choice of lights [W·m⁻²·sr⁻¹].
    pub luminance: f32,
}

impl ConstantEnvironment {
    /// At an opaque surface, directions by their cosine; elsewhere, all directions alike.
    #[inline]
    pub fn sample(&self, from: &Reference, u: Vec2, wavelengths: &Wavelengths) -> LightSample {
        let dir = match from.normal {
            Some(n) => Frame::around(n).to_world(warp::cosine_hemisphere(u)),
            None => warp::uniform_sphere(u),
        };
        LightSample {
            dir,
            li: self.radiance.eval(wavelengths),
            pdf: self.pdf(from, dir),
            dirac: false,
            target: Target::Infinity,
        }
    }

    /// Density of [`Self::sample`] [1/sr].
    #[inline]
    pub fn pdf(&self, from: &Reference, dir: Vec3) -> f32 {
        match from.normal {
            Some(n) => n.dot(dir).max(0.0) * FRAC_1_PI,
            None => 0.25 * FRAC_1_PI,
        }
    }
}

/// How directions lie on an environment image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Projection {
    /// Latitude and longitude, 2:1, +y up in the map's own space: `u = atan2(x, −z)/2π` modulo 1, `v = θ/π` from +y. The
    /// values stand at the middles of the columns, the first row at the upper pole and the last at the lower; radiance is
    /// linear between them (Mitsuba 3).
    LatLong,
    /// Equal-area octahedral map of the sphere on a square (Clarberg 2008), +z up in the map's own space; radiance is
    /// constant over a pixel (pbrt-v4).
    EqualArea,
}

impl Projection {
    /// The direction of a place on the image, in the map's own space.
    pub fn direction(self, uv: Vec2) -> Vec3 {
        self.direction_and_jacobian(uv).0
    }

    /// Columns and rows of the cells over which an image of this size is sampled.
    fn cells(self, width: u32, height: u32) -> (u32, u32) {
        match self {
            Self::LatLong => (width, (height - 1).max(1)),
            Self::EqualArea => (width, height),
        }
    }

    /// The same, and the solid angle of a unit of the image's area [sr].
    fn direction_and_jacobian(self, uv: Vec2) -> (Vec3, f32) {
        match self {
            Self::LatLong => {
                let (sin_theta, cos_theta) = sin_cos_turn(0.5 * uv.y);
                let (sin_phi, cos_phi) = sin_cos_turn(uv.x);
                // u = 0 looks along −z.
                let d = Vec3::new(sin_phi * sin_theta, cos_theta, -cos_phi * sin_theta);
                (d, 2.0 * PI * PI * sin_theta)
            }
            Self::EqualArea => (equal_area_sphere(uv), 4.0 * PI),
        }
    }
}

/// An image of the sky.
#[derive(Debug, Clone)]
pub struct EnvironmentMap {
    /// Map space to world.
    pub to_world: Transform,
    /// How directions lie on the image.
    pub projection: Projection,
    /// Radiance by pixel.
    pub image: SkyImage,
    /// Cells in proportion to luminance and solid angle: pixels, or what lies between the values of four.
    pub distribution: Piecewise2d,
    /// Mean luminance over the sphere, for the choice of lights [W·m⁻²·sr⁻¹].
    pub mean_luminance: f32,
}

impl EnvironmentMap {
    /// From linear-sRGB pixels, row by row, scaled by `scale`.
    ///
    /// # Errors
    /// The image is empty or black, or has values that are negative or not finite.
    pub fn new(
        to_world: Transform,
        projection: Projection,
        width: u32,
        height: u32,
        pixels: &[[f32; 3]],
        scale: f32,
    ) -> Result<Self, SkyError> {
        let image = SkyImage::new(width, height, pixels, scale)?;
        let (columns, rows) = projection.cells(width, height);
        let cells: Vec<(u32, u32)> = (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y))).collect();
        let share = |&(_, y): &(u32, u32)| match projection {
            Projection::LatLong => (PI * (y as f32 + 0.5) / rows as f32).sin(),
            Projection::EqualArea => 1.0,
        };
        let middle = |&(x, y): &(u32, u32)| match projection {
            Projection::LatLong => image.between(Vec2::new(x as f32 + 0.5, y as f32 + 0.5)),
            Projection::EqualArea => image.pixels[y as usize * width as usize + x as usize],
        };
        let weights: Vec<f32> = cells.iter().map(|cell| srgb::luminance(middle(cell)) * share(cell)).collect();
        let total_share: f64 = cells.iter().map(|cell| f64::from(share(cell))).sum();
        let mean_luminance = (weights.iter().map(|w| f64::from(*w)).sum::<f64>() / total_share) as f32;
        let distribution = Piecewise2d::new(&weights, columns as usize).ok_or(SkyError::Black)?;
        Ok(Self { to_world, projection, image, distribution, mean_luminance })
    }

    /// A bright direction.
    #[inline]
    pub fn sample(&self, u: Vec2, wavelengths: &Wavelengths) -> Option<LightSample> {
        let (uv, pdf_uv) = self.distribution.sample(u);
        let (local, jacobian) = self.direction_and_jacobian(uv);
        let pdf = pdf_uv / jacobian;
        (pdf > 0.0 && pdf.is_finite()).then(|| LightSample {
            dir: self.to_world.vector(local).normalize(),
            li: self.radiance(uv, wavelengths),
            pdf,
            dirac: false,
            target: Target::Infinity,
        })
    }

    /// Density of [`Self::sample`] [1/sr].
    #[inline]
    pub fn pdf(&self, dir: Vec3) -> f32 {
        let uv = self.coordinates(dir);
        let (_, jacobian) = self.direction_and_jacobian(uv);
        if jacobian > 0.0 { self.distribution.pdf(uv) / jacobian } else { 0.0 }
    }

    /// Radiance out of a direction [W·m⁻²·sr⁻¹].
    #[inline]
    pub fn le(&self, dir: Vec3, wavelengths: &Wavelengths) -> Lanes {
        self.radiance(self.coordinates(dir), wavelengths)
    }

    fn radiance(&self, uv: Vec2, wavelengths: &Wavelengths) -> Lanes {
        match self.projection {
            Projection::LatLong => {
                let (columns, rows) = self.projection.cells(self.image.width, self.image.height);
                let rgb = self.image.between(Vec2::new(uv.x * columns as f32, uv.y * rows as f32));
                self.image.light(rgb, wavelengths)
            }
            Projection::EqualArea => self.image.radiance(uv, wavelengths),
        }
    }

    /// How far, in u, the first cell of the distribution is from the edge of the image.
    fn shift(&self) -> f32 {
        match self.projection {
            Projection::LatLong => 0.5 / self.image.width as f32,
            Projection::EqualArea => 0.0,
        }
    }

    /// The direction of a place among the cells, in the map's own space, and the solid angle of a unit of their area [sr].
    fn direction_and_jacobian(&self, uv: Vec2) -> (Vec3, f32) {
        let u = uv.x + self.shift();
        self.projection.direction_and_jacobian(Vec2::new(if u > 1.0 { u - 1.0 } else { u }, uv.y))
    }

    /// The place of a direction among the cells.
    fn coordinates(&self, dir: Vec3) -> Vec2 {
        let d = self.to_world.inverse.transform_vector3(dir).normalize();
        match self.projection {
            Projection::LatLong => {
                let u = d.x.atan2(-d.z) / (2.0 * PI) - self.shift();
                Vec2::new(u - u.floor(), d.y.clamp(-1.0, 1.0).acos() * FRAC_1_PI)
            }
            Projection::EqualArea => equal_area_square(d),
        }
    }
}

/// Square to sphere, equal areas to equal solid angles (Clarberg 2008).
pub(crate) fn equal_area_sphere(uv: Vec2) -> Vec3 {
    let (u, v) = (2.0 * uv.x - 1.0, 2.0 * uv.y - 1.0);
    let signed_distance = 1.0 - (u.abs() + v.abs());
    let r = 1.0 - signed_distance.abs();
    let phi_quarters = if r == 0.0 { 1.0 } else { (v.abs() - u.abs()) / r + 1.0 };
    let z = (1.0 - r * r).copysign(signed_distance);
    let (sin, cos) = (phi_quarters * PI / 4.0).sin_cos();
    let scale = r * (2.0 - r * r).max(0.0).sqrt();
    Vec3::new(cos.copysign(u) * scale, sin.copysign(v) * scale, z)
}

/// Sphere to square, the inverse of [`equal_area_sphere`].
pub(crate) fn equal_area_square(d: Vec3) -> Vec2 {
    let (x, y) = (d.x.abs(), d.y.abs());
    let r = (1.0 - d.z.abs()).max(0.0).sqrt();
    let phi = y.atan2(x) * (2.0 * FRAC_1_PI);
    let mut v = phi * r;
    let mut u = r - v;
    if d.z < 0.0 {
        (u, v) = (1.0 - v, 1.0 - u);
    }
    Vec2::new((u.copysign(d.x) + 1.0) * 0.5, (v.copysign(d.y) + 1.0) * 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(projection: Projection) -> EnvironmentMap {
        let (w, h) = if projection == Projection::LatLong { (16, 8) } else { (8, 8) };
        let pixels: Vec<[f32; 3]> = (0..w * h).map(|i| [1.0 + (i * 7 % 5) as f32; 3]).collect();
        EnvironmentMap::new(Transform::IDENTITY, projection, w, h, &pixels, 1.0).unwrap()
    }

    #[test]
    fn directions_and_places_on_the_image_are_inverse_to_each_other() {
        for projection in [Projection::LatLong, Projection::EqualArea] {
            let map = map(projection);
            for i in 1..50 {
                for j in 1..50 {
                    let uv = Vec2::new(i as f32 / 50.0, j as f32 / 50.0);
                    let (d, _) = map.direction_and_jacobian(uv);
                    assert!((d.length() - 1.0).abs() < 1e-5);
                    assert!((map.coordinates(d) - uv).length() < 2e-4, "{projection:?} {uv} {}", map.coordinates(d));
                }
            }
        }
    }

    /// ∫ pdf dω over the sphere = 1, by the midpoint rule on the image of the other projection.
    #[test]
    fn densities_integrate_to_one() {
        for projection in [Projection::LatLong, Projection::EqualArea] {
            let map = map(projection);
            let n = 400;
            let mut sum = 0.0f64;
            for i in 0..n {
                for j in 0..n {
                    let uv = Vec2::new((i as f32 + 0.5) / n as f32, (j as f32 + 0.5) / n as f32);
                    sum += f64::from(map.pdf(equal_area_sphere(uv))) * f64::from(4.0 * PI) / f64::from(n * n);
                }
            }
            assert!((sum - 1.0).abs() < 2e-3, "{projection:?}: {sum}");
        }
    }

    /// Mitsuba 3.9.1 on an image that is lit in one row or one column only: full at θ = 2π/7 and φ = 2π · 4.5/16, gone a row
    /// or a column away.
    #[test]
    fn values_stand_where_mitsuba_has_them() {
        let lit = |pixel: fn(u32, u32) -> bool| {
            let at = |i: u32| [if pixel(i % 16, i / 16) { 1.0 } else { 0.0 }; 3];
            let pixels: Vec<[f32; 3]> = (0..16 * 8).map(at).collect();
            EnvironmentMap::new(Transform::IDENTITY, Projection::LatLong, 16, 8, &pixels, 1.0).unwrap()
        };
        let seen = |map: &EnvironmentMap, u: f32, v: f32| {
            map.le(Projection::LatLong.direction(Vec2::new(u, v)), &Wavelengths::Rgb).lane(0)
        };
        let (row, column) = (lit(|_, y| y == 2), lit(|x, _| x == 4));
        for (v, value) in [(0.2, 0.4), (0.2375, 0.6625), (0.3, 0.9), (0.375, 0.375), (0.44, 0.0)] {
            assert!((seen(&row, 0.3, v) - value).abs() < 1e-4, "{v}: {}", seen(&row, 0.3, v));
        }
        for (u, value) in [(0.21, 0.0), (0.225, 0.1), (0.28125, 1.0), (0.325, 0.3), (0.35, 0.0)] {
            assert!((seen(&column, u, 0.5) - value).abs() < 1e-4, "{u}: {}", seen(&column, u, 0.5));
        }
        let rim = lit(|x, _| x == 15);
        assert!((seen(&rim, 0.0, 0.5) - 0.5).abs() < 1e-4, "half way between the last column and the first");
    }
}
