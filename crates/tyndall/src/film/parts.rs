//! From the layers of a sample's light to colours that add up to the sample's own.
//!
//! A sample has the colour `v`, in single precision. Its layers are lanes `l`, all contributions together `L`, in double
//! precision, and the film's colour is a linear map `M` of lanes. `M L` is not `v` to the last bit: what is left,
//! `r = v − M L`, is shared in proportion to the light,
//!
//! `c = M l + r · (|M| l) / (|M| L)`,
//!
//! channel by channel. This is linear in `l`, so the layers of every partition add up to `v` (to 2⁻⁵⁰), and no layer is
//! changed by more than `v` itself is rounded. In the file each mean is rounded to single precision; as none is negative,
//! their sum and the image differ by one unit in the last place at most.

use crate::spectrum::{Lanes, Wavelengths, film_rgb};

/// The map from lanes to colours of one sample.
#[derive(Debug, Clone, Copy)]
pub struct Share {
    /// `M`, a row a channel.
    map: [[f64; 4]; 3],
    /// `r / (|M| L)`.
    rest: [f64; 3],
}

impl Share {
    /// That of a sample with these wavelengths and this factor, the sum of all contributions, and its colour on the film.
    pub fn new(wavelengths: &Wavelengths, factor: f32, total: &[f64; 4], color: [f32; 3]) -> Self {
        let mut map = [[0.0; 4]; 3];
        for lane in 0..4 {
            let mut unit = [0.0; 4];
            unit[lane] = 1.0;
            for (row, v) in map.iter_mut().zip(film_rgb(Lanes::new(unit), wavelengths)) {
                row[lane] = f64::from(v) * f64::from(factor);
            }
        }
        let rest = std::array::from_fn(|c| {
            let weight = dot(&map[c].map(f64::abs), total);
            if weight > 0.0 { (f64::from(color[c]) - dot(&map[c], total)) / weight } else { 0.0 }
        });
        Self { map, rest }
    }

    /// The colour of a layer.
    pub fn color(&self, layer: &[f64; 4]) -> [f64; 3] {
        std::array::from_fn(|c| {
            let row = &self.map[c];
            dot(row, layer) + self.rest[c] * dot(&row.map(f64::abs), layer)
        })
    }
}

fn dot(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{sampling::rng::Rng, spectrum::ColorMode};

    /// However the light of a sample is divided, the parts add up to its colour: for a sum that was rounded (a millionth
    /// off), in every mode, to 2⁻⁵⁰ of what is added.
    #[test]
    fn the_parts_of_a_sample_add_up_to_its_colour() {
        let mut rng = Rng::for_sample((0, 0), 0, 7);
        for mode in [ColorMode::Rgb, ColorMode::Mono, ColorMode::Spectral] {
            for _ in 0..200 {
                let wavelengths = Wavelengths::sample(mode, rng.next_1d());
                let layers: Vec<[f64; 4]> = (0..5).map(|_| [0; 4].map(|_| f64::from(rng.next_1d()).powi(9))).collect();
                let total: [f64; 4] = std::array::from_fn(|lane| layers.iter().map(|l| l[lane]).sum());
                let radiance = Lanes::new(total.map(|v| (v * (1.0 + 1e-6)) as f32));
                let color = film_rgb(radiance, &wavelengths).map(|v| v * 0.7);
                let share = Share::new(&wavelengths, 0.7, &total, color);
                for (c, whole) in color.into_iter().map(f64::from).enumerate() {
                    let colors = layers.iter().map(|layer| share.color(layer)[c]);
                    let (sum, size) = colors.fold((0.0, 0.0), |(sum, size), v| (sum + v, size + v.abs()));
                    let weight = dot(&share.map[c].map(f64::abs), &total);
                    assert!((sum - whole).abs() <= (size + weight) * 2f64.powi(-50), "{mode:?}");
                }
            }
        }
    }
}
