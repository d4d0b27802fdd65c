//! Environments in the other language's mapping: pictures made anew, beside the new file.
//!
//! pbrt-v4 sees a sky on an equal-area octahedral square, constant over each pixel; Mitsuba 3 by longitude and latitude,
//! linear between its values ([`Projection`]). No picture of the one kind is one of the other, so it is sampled: each new
//! value is the mean of the old radiance over its cell, at some [`places`] in it. A new cell is about a quarter of an old
//! one (twice as fine along each side), so that edges stay where they were. The space of the light stays as it is.
//!
//! How exact: with N places in an old pixel its area is known to about `0.7 N^(1/4)/N`, 0.4 % of a lone bright pixel of a
//! square of side 250 and 3 % at 1200; what a surface sees is a sum of many, and better.
//!
//! An old picture of `W × H` by longitude and latitude has cells of `2π²/(W(H−1))` sr at its equator, an old square of side
//! n has `4π/n²` sr everywhere.

use std::f64::consts::PI;

use tyndall::{
    light::{EnvironmentMap, Projection},
    math::{Transform, Vec2},
    spectrum::Wavelengths,
};

use super::Draft;
use crate::build::lights::for_illuminance;
use crate::desc::{EnvironmentMapping, FileRef, Span};
use crate::error::SceneError;
use crate::image::{Image, MAX_PIXELS, read_image, write_openexr};

/// The most places in all at which the old picture is looked up: some ten seconds' work.
const MOST_PLACES: f64 = (1u32 << 28) as f64;
/// Steps from place to place in a cell (Roberts's R₂): a grid would fall in with the edges of old pixels.
const R2: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];

impl Draft<'_> {
    /// The name of a picture of the sky at `path` in the mapping that it has not, and the factor on its radiance that gives
    /// it the illuminance that was asked for. `None` if it cannot be made, which is reported.
    pub(super) fn sky(
        &mut self,
        light: Span,
        path: &FileRef,
        mapping: EnvironmentMapping,
        illuminance: Option<f64>,
    ) -> Option<(String, f64)> {
        let made = read_image(&path.value).map_err(|e| e.to_string()).and_then(|picture| {
            let factor = for_illuminance(&picture, illuminance);
            resampled(&picture, mapping).and_then(|sky| write_openexr(&sky)).map(|bytes| (bytes, factor))
        });
        let (bytes, factor) = match made {
            Ok(made) => made,
            Err(problem) => {
                self.errors.push(SceneError::at(path.span, problem));
                return None;
            }
        };
        let message = format!(
            "the environment is resampled, as {} maps directions to pictures in another way: the same light but for noise",
            self.language.name()
        );
        self.differs(light, &message);
        let wanted = path.value.file_stem().and_then(|stem| stem.to_str()).unwrap_or("sky");
        Some((self.file_beside(path.span, wanted, "exr", bytes), factor))
    }
}

/// The same radiance in the other mapping, or why there is none.
fn resampled(picture: &Image, mapping: EnvironmentMapping) -> Result<Image, String> {
    let Image { width, height, pixels } = picture;
    let (from, to) = match mapping {
        EnvironmentMapping::EqualAreaOctahedral => (Projection::EqualArea, Projection::LatLong),
        EnvironmentMapping::LatitudeLongitude => (Projection::LatLong, Projection::EqualArea),
    };
    let old =
        EnvironmentMap::new(Transform::IDENTITY, from, *width, *height, pixels, 1.0).map_err(|e| e.to_string())?;
    let (columns, rows) = size(to, f64::from(*width) * f64::from(*height));
    let count = places(columns, rows);
    let mean = |column: u32, row: u32| {
        let (mut sum, mut total) = ([0.0; 3], 0.0);
        let first = (u64::from(row) * u64::from(columns) + u64::from(column)) * u64::from(count);
        for place in first..first + u64::from(count) {
            let [dx, dy] = R2.map(|step| (0.5 + step * place as f64).fract() as f32);
            let (u, v) = match to {
                // The value stands in the middle of its column; at the poles half of a row is left.
                Projection::LatLong => {
                    let v = (row as f32 + dy - 0.5) / (rows - 1) as f32;
                    ((column as f32 + dx) / columns as f32, v.abs().min(2.0 - v))
                }
                Projection::EqualArea => ((column as f32 + dx) / columns as f32, (row as f32 + dy) / rows as f32),
            };
            let dir = to.direction(Vec2::new(u, v));
            // By solid angle.
            let weight = if to == Projection::LatLong { dir.x.hypot(dir.z) } else { 1.0 };
            let radiance = old.le(dir, &Wavelengths::Rgb);
            for (channel, sum) in sum.iter_mut().enumerate() {
                *sum += radiance.lane(channel) * weight;
            }
            total += weight;
        }
        sum.map(|sum| sum / total)
    };
    let pixels = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
    Ok(Image { width: columns, height: rows, pixels: pixels.map(|(column, row)| mean(column, row)).collect() })
}

/// Columns and rows of a new picture, four pixels of which have the solid angle of one of the `old` ones, if not so many are
/// too many.
fn size(to: Projection, old: f64) -> (u32, u32) {
    match to {
        // n² = 4 · 4π / (2π² / WH)
        Projection::EqualArea => {
            let side = (8.0 * old / PI).min(MAX_PIXELS as f64).sqrt().floor().max(2.0) as u32;
            (side, side)
        }
        // 2π² / (W · W/2) = ¼ · 4π / n²
        Projection::LatLong => {
            let half = (PI * old).min(MAX_PIXELS as f64 / 2.5).sqrt().floor().max(2.0) as u32;
            (2 * half, half + 1)
        }
    }
}

/// Places in a new cell.
fn places(columns: u32, rows: u32) -> u32 {
    (MOST_PLACES / f64::from(columns) / f64::from(rows)).clamp(16.0, 256.0) as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use EnvironmentMapping::{EqualAreaOctahedral, LatitudeLongitude};
    use tyndall::math::Vec3;

    /// Noise, three times as bright in the lower half.
    fn picture(width: u32, height: u32) -> Image {
        let noise =
            |i: u32| [1.0 + (i * 7 % 5) as f32, (i * 3 % 7) as f32, if i.is_multiple_of(11) { 30.0 } else { 0.5 }];
        let value = |i: u32| noise(i).map(|v| v * (1 + 2 * (2 * i / (width * height))) as f32);
        Image { width, height, pixels: (0..width * height).map(value).collect() }
    }

    /// ∫ L (1, x, y, z, x², y², xy, yz, zx) dω / 4π over the sphere: what a mean over an even grid of the equal-area square says, which has whole numbers of its places in pixels.
    fn moments(image: &Image, projection: Projection) -> Vec<f64> {
        let map = EnvironmentMap::new(Transform::IDENTITY, projection, image.width, image.height, &image.pixels, 1.0)
            .unwrap();
        let n = 960;
        let mut sums = vec![0.0; 27];
        for i in 0..n * n {
            let uv = Vec2::new(((i % n) as f32 + 0.5) / n as f32, ((i / n) as f32 + 0.5) / n as f32);
            let d @ Vec3 { x, y, z } = Projection::EqualArea.direction(uv);
            let seen = map.le(d, &Wavelengths::Rgb);
            for (k, shape) in [1.0, x, y, z, x * x, y * y, x * y, y * z, z * x].into_iter().enumerate() {
                for channel in 0..3 {
                    sums[3 * k + channel] += f64::from(shape * seen.lane(channel)) / f64::from(n * n);
                }
            }
        }
        sums
    }

    /// What any smooth surface sees of a sky are its low moments. A new picture is the old one smoothed by the mean over a
    /// cell and, by longitude and latitude, by the lines between values: with a variance of c²/12 + c²/6 along each axis for
    /// cells of c² = π/n² sr, which takes l(l + 1)/2 · c²/4 of a moment of order l: at n = 48 and l = 2 that is 1e-3.
    #[test]
    fn a_sky_in_the_other_mapping_is_the_same_light() {
        for (mapping, there, back, [width, height]) in [
            (LatitudeLongitude, Projection::LatLong, Projection::EqualArea, [64, 32]),
            (EqualAreaOctahedral, Projection::EqualArea, Projection::LatLong, [48, 48]),
        ] {
            let old = picture(width, height);
            let new = resampled(&old, mapping).unwrap();
            let (old, new) = (moments(&old, there), moments(&new, back));
            for (i, (old_moment, new_moment)) in old.iter().zip(&new).enumerate() {
                let mean = old[i % 3];
                assert!((old_moment - new_moment).abs() < 1e-3 * mean, "{mapping:?} {i}: {old_moment} {new_moment}");
            }
        }
    }

    /// A sun of one pixel: in a new cell there are 16² places, in an old pixel 1024, so its area is known to 0.4 %.
    #[test]
    fn a_sun_of_one_pixel_keeps_its_light() {
        for (mapping, there, back, [width, height]) in [
            (LatitudeLongitude, Projection::LatLong, Projection::EqualArea, [32, 17]),
            (EqualAreaOctahedral, Projection::EqualArea, Projection::LatLong, [24, 24]),
        ] {
            for sun in [40, 100, 200, 300] {
                let value = |i: u32| [if i == sun { 1.0 } else { 0.0 }; 3];
                let old = Image { width, height, pixels: (0..width * height).map(value).collect() };
                let (before, after) = (moments(&old, there)[0], moments(&resampled(&old, mapping).unwrap(), back)[0]);
                assert!((after / before - 1.0).abs() < 1.2e-2, "{mapping:?} {sun}: {before} {after}");
            }
        }
    }

    #[test]
    fn a_black_sky_is_refused_and_a_large_one_keeps_its_size() {
        let black = Image { width: 2, height: 2, pixels: vec![[0.0; 3]; 4] };
        assert!(resampled(&black, EqualAreaOctahedral).unwrap_err().contains("black"));
        for to in [Projection::LatLong, Projection::EqualArea] {
            let (width, height) = size(to, 1e12);
            let pixels = u64::from(width) * u64::from(height);
            assert!(pixels <= MAX_PIXELS && pixels > MAX_PIXELS / 2, "{width} × {height}");
            assert!(size(to, 1.0).1 >= 2);
        }
    }
}
