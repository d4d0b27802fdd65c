//! What is kept of the images, and what follows from it.

use tyndall::{
    film::{Average, Film},
    spectrum::srgb::luminance,
};

/// Direct and global light of each pixel, row by row, with standard errors.
#[derive(Debug, Clone, PartialEq)]
pub struct Parts {
    /// Direct light \[radiance\].
    pub direct: Vec<[f32; 3]>,
    /// All other \[radiance\].
    pub global: Vec<[f32; 3]>,
    /// Standard error of the direct light. Images under patterns share random numbers: there it is an upper bound.
    pub direct_error: Vec<[f32; 3]>,
    /// Standard error of the global light, an upper bound.
    pub global_error: Vec<[f32; 3]>,
}

/// Direct and global light of the greatest and the least of images under shifted patterns whose dark pixels have the
/// brightness `b`.
fn of_extremes(greatest: f64, least: f64, b: f64) -> [f64; 2] {
    [(greatest - least) / (1.0 - b), 2.0 * (least - b * greatest) / (1.0 - b * b)]
}

/// The same of the mean and the amplitude of waves.
fn of_wave(mean: f64, amplitude: f64, b: f64) -> [f64; 2] {
    let direct = 2.0 * amplitude / (1.0 - b);
    [direct, 2.0 * mean / (1.0 + b) - direct]
}

/// A number by each half of the samples, and the standard error of their mean.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Seen {
    halves: [f64; 2],
    error: f64,
}

impl Seen {
    fn mean(self) -> f64 {
        f64::midpoint(self.halves[0], self.halves[1])
    }
}

/// An extreme of a channel of a pixel.
#[derive(Debug, Clone, Copy)]
struct Extreme {
    /// The pictures that one and the other half of the samples would take.
    by_halves: [Seen; 2],
    /// The one that all would take.
    plain: f64,
}

impl Extreme {
    fn of(seen: Seen) -> Self {
        Self { by_halves: [seen; 2], plain: seen.mean() }
    }

    fn update(&mut self, seen: Seen, is_beyond: impl Fn(f64, f64) -> bool) {
        for (half, taken) in self.by_halves.iter_mut().enumerate() {
            let [new, old] = [seen, *taken].map(|seen| seen.halves[half]);
            // Where there is no noise halves are alike in several pictures, also where the pattern's edge is in the other half.
            if is_beyond(new, old) || (new == old && is_beyond(seen.mean(), taken.mean())) {
                *taken = seen;
            }
        }
        if is_beyond(seen.mean(), self.plain) {
            self.plain = seen.mean();
        }
    }

    /// What each half says of the other's picture, on average: noise that made a picture extreme is not in it.
    fn value(&self) -> f64 {
        f64::midpoint(self.by_halves[0].halves[1], self.by_halves[1].halves[0])
    }

    fn error(&self) -> f64 {
        f64::midpoint(self.by_halves[0].error, self.by_halves[1].error)
    }
}

/// What a channel of a pixel has shown.
#[derive(Debug, Clone, Copy)]
enum Record {
    /// Nothing yet.
    Nothing,
    /// The greatest and the least.
    Extremes { greatest: Extreme, least: Extreme },
    /// By each half: sums of what was seen, times 1, cosine and sine of the phase. Squares of standard errors.
    Wave { sums: [[f64; 3]; 2], error_squared: f64, count: u32 },
}

/// A part of the light with its standard error.
#[derive(Debug, Clone, Copy)]
struct Part {
    value: f64,
    error: f64,
}

impl Record {
    fn add(&mut self, seen: Seen) {
        if let Self::Nothing = self {
            *self = Self::Extremes { greatest: Extreme::of(seen), least: Extreme::of(seen) };
        }
        let Self::Extremes { greatest, least } = self else { return };
        greatest.update(seen, |new, old| new > old);
        least.update(seen, |new, old| new < old);
    }

    fn add_phase(&mut self, seen: Seen, phase: f64) {
        if let Self::Nothing = self {
            *self = Self::Wave { sums: [[0.0; 3]; 2], error_squared: 0.0, count: 0 };
        }
        let Self::Wave { sums, error_squared, count } = self else { return };
        for (sums, value) in sums.iter_mut().zip(seen.halves) {
            for (sum, by) in sums.iter_mut().zip([1.0, phase.cos(), phase.sin()]) {
                *sum += value * by;
            }
        }
        *error_squared += seen.error * seen.error;
        *count += 1;
    }

    /// Direct and global light.
    fn parts(&self, b: f64) -> [Part; 2] {
        match self {
            Self::Nothing => [Part { value: 0.0, error: f64::INFINITY }; 2],
            Self::Extremes { greatest, least } => {
                let [direct, global] = of_extremes(greatest.value(), least.value(), b);
                let [above, below] = [greatest.error(), least.error()];
                let error = [above.hypot(below) / (1.0 - b), 2.0 * below.hypot(b * above) / (1.0 - b * b)];
                [Part { value: direct, error: error[0] }, Part { value: global, error: error[1] }]
            }
            Self::Wave { sums: [[m1, x1, y1], [m2, x2, y2]], error_squared, count } => {
                let n = f64::from(*count);
                // The square of an amplitude is too great by its noise; the product of two halves is not.
                let amplitude = 2.0 / n * (x1 * x2 + y1 * y2).max(0.0).sqrt();
                let [direct, global] = of_wave(f64::midpoint(*m1, *m2) / n, amplitude, b);
                let noise = error_squared.sqrt() / n;
                let error = 2.0 * std::f64::consts::SQRT_2 * noise / (1.0 - b);
                let global = Part { value: global, error: error.hypot(2.0 * noise / (1.0 + b)) };
                [Part { value: direct, error }, global]
            }
        }
    }

    /// How much greater direct light would be by the plain extremes.
    fn bias(&self, b: f64) -> Option<f64> {
        let Self::Extremes { greatest, least } = self else { return None };
        Some(of_extremes(greatest.plain, least.plain, b)[0] - of_extremes(greatest.value(), least.value(), b)[0])
    }
}

/// What the pictures under all patterns so far have shown.
#[derive(Debug, Clone)]
pub(super) struct Observed {
    records: Vec<[Record; 3]>,
    dark: f64,
}

impl Observed {
    /// Nothing yet.
    pub(super) fn new(dark: f32) -> Self {
        Self { records: Vec::new(), dark: f64::from(dark) }
    }

    /// Adds a picture, by halves of its samples, under a pattern: a wave of some phase, or a checkerboard.
    pub(super) fn add(&mut self, [first, second]: &[Film; 2], phase: Option<f32>) {
        self.records.resize(first.pixels.len(), [Record::Nothing; 3]);
        let pixels = first.pixels.iter().zip(&second.pixels);
        for (records, (one, other)) in self.records.iter_mut().zip(pixels) {
            let (means, errors) = ([one.mean(), other.mean()], [one.standard_error(), other.standard_error()]);
            for (c, record) in records.iter_mut().enumerate() {
                let error = 0.5 * f64::from(errors[0][c].hypot(errors[1][c]));
                let seen = Seen { halves: means.map(|mean| f64::from(mean[c])), error };
                match phase {
                    None => record.add(seen),
                    Some(phase) => record.add_phase(seen, f64::from(phase)),
                }
            }
        }
    }

    /// Direct and global light.
    pub(super) fn parts(&self) -> Parts {
        let each = |part: usize, of: fn(&Part) -> f64| -> Vec<[f32; 3]> {
            let pixel = |records: &[Record; 3]| records.map(|record| of(&record.parts(self.dark)[part]) as f32);
            self.records.iter().map(pixel).collect()
        };
        Parts {
            direct: each(0, |part| part.value),
            global: each(1, |part| part.value),
            direct_error: each(0, |part| part.error),
            global_error: each(1, |part| part.error),
        }
    }

    /// How much brighter direct light would be by the plain extremes: the mean of its luminance.
    pub(super) fn bias(&self) -> Option<f64> {
        let pixel = |records: &[Record; 3]| {
            let [r, g, b] = records.map(|record| record.bias(self.dark));
            Some(f64::from(luminance([r?, g?, b?].map(|x| x as f32))))
        };
        let all: Vec<f64> = self.records.iter().filter_map(pixel).collect();
        (!all.is_empty()).then(|| all.iter().sum::<f64>() / all.len() as f64)
    }
}

/// The direct light of a film's first layer, with its standard error.
fn direct_of(film: &Film) -> Vec<[[f32; 3]; 2]> {
    let cells = film.layers.first().map_or(&[][..], |layer| &layer.cells[..]);
    let rgb = |lanes: [f32; 4]| [lanes[0], lanes[1], lanes[2]];
    let pixel = |(cell, pixel): (&tyndall::film::Cell, &tyndall::film::Pixel)| {
        [rgb(cell.value(Average::Samples, pixel.count)), rgb(cell.standard_error(pixel.count))]
    };
    cells.iter().zip(&film.pixels).map(pixel).collect()
}

/// The true parts of the light of a film with a layer of direct light.
pub fn truth(film: &Film) -> Parts {
    let direct = direct_of(film);
    let all = film.pixels.iter().map(|pixel| (pixel.mean(), pixel.standard_error()));
    let rest = |(all, direct): ([f32; 3], [f32; 3])| std::array::from_fn(|c| all[c] - direct[c]);
    let bound = |(all, direct): ([f32; 3], [f32; 3])| std::array::from_fn(|c| all[c].hypot(direct[c]));
    let (means, errors): (Vec<_>, Vec<_>) = all.unzip();
    Parts {
        global: means.into_iter().zip(direct.iter().map(|d| d[0])).map(rest).collect(),
        global_error: errors.into_iter().zip(direct.iter().map(|d| d[1])).map(bound).collect(),
        direct_error: direct.iter().map(|d| d[1]).collect(),
        direct: direct.into_iter().map(|d| d[0]).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::verify::table::rows;

    /// The rows of the table, forwards and back.
    #[test]
    fn the_formulas_reproduce_the_table() {
        let table = rows(include_str!("../../data/nayar2006_separation.csv"));
        assert!(table.len() >= 12);
        for row in table {
            let [direct, global, b, lit, dark] = ["Ld", "Lg", "b", "Lplus", "Lminus"].map(|column| row.number(column));
            assert!((lit - (direct + (1.0 + b) * global / 2.0)).abs() < 1e-6);
            assert!((dark - (b * direct + (1.0 + b) * global / 2.0)).abs() < 1e-6);
            let [found, other] = of_extremes(lit, dark, b);
            assert!(
                (found - row.number("Ld_rec")).abs() < 1e-5 && (other - row.number("Lg_rec")).abs() < 1e-5,
                "{row:?}"
            );
        }
    }

    /// Pictures of one brightness that only noise tells apart: their greatest is no brighter, their plain greatest is.
    #[test]
    fn noise_makes_no_extreme_greater() {
        let mut rng = tyndall::sampling::rng::Rng::for_sample((0, 0), 0, 1);
        let (mut value, mut plain) = (0.0, 0.0);
        let pixels = 4000;
        for _ in 0..pixels {
            let mut record = Record::Nothing;
            for _ in 0..25 {
                record.add(Seen { halves: [0, 1].map(|_| 1.0 + f64::from(rng.next_1d()) - 0.5), error: 0.2 });
            }
            let Record::Extremes { greatest, .. } = record else { panic!("extremes were added") };
            value += greatest.value() / f64::from(pixels);
            plain += greatest.plain / f64::from(pixels);
        }
        // A half has the standard deviation 1/√12, the mean of two of them 1/√24.
        let error = (1.0 / 24.0f64).sqrt() / f64::from(pixels).sqrt();
        assert!((value - 1.0).abs() < 4.0 * error, "{value}");
        assert!(plain > 1.3, "{plain}");
    }

    /// A wave of any phase, seen in three images and in seven.
    #[test]
    fn waves_tell_their_mean_and_their_amplitude() {
        for (n, b, phi) in [(3, 0.0, 0.4), (7, 0.3, 2.0)] {
            let (direct, global) = (0.6, 0.4);
            let mut record = Record::Nothing;
            for k in 0..n {
                let phase = std::f64::consts::TAU * f64::from(k) / f64::from(n);
                let value = (1.0 + b) * (direct + global) / 2.0 + (1.0 - b) * direct / 2.0 * (phi + phase).cos();
                record.add_phase(Seen { halves: [value; 2], error: 0.0 }, phase);
            }
            let [found, other] = record.parts(b);
            assert!((found.value - direct).abs() < 1e-12 && (other.value - global).abs() < 1e-12);
        }
    }
}
