//! What the statistics say of pictures that are the same, and of pictures that are not.

use super::*;
use tyndall::{
    film::{Crop, Film},
    sampling::Rng,
};
use tyndall_formats::film::Metadata;

/// A render of a flat image: samples are exponential with the given mean, so their standard deviation is the mean.
fn render(mean: f32, seed: u64) -> Image {
    let mut film = Film::new(64, 48, Crop::full(64, 48));
    for (i, pixel) in film.pixels.iter_mut().enumerate() {
        let mut rng = Rng::for_sample((i as u32, 0), 0, seed);
        for _ in 0..64 {
            pixel.add(std::array::from_fn(|_| -mean * rng.next_positive().ln()));
        }
    }
    Image::of(&film, Metadata::default())
}

/// Normal noise of known size: every z is exactly standard normal and independent, so both p-values are uniform.
/// Kolmogorov–Smirnov: the largest distance between the empirical and the uniform distribution of 400 values stays
/// below 1.63/√400 with probability 0.99.
#[test]
fn p_values_are_uniform_when_two_images_differ_by_noise_alone() {
    let flat = render(1.0, 0);
    let noise = |seed: u64| {
        let mut image = flat.clone();
        let mut rng = Rng::for_sample((0, 0), 0, seed);
        for (mean, se) in image.mean.iter_mut().zip(image.standard_error.as_mut().unwrap()) {
            *mean = std::array::from_fn(|_| {
                let (radius, turn) = ((-2.0 * rng.next_positive().ln()).sqrt(), rng.next_1d());
                1.0 + 0.1 * radius * (std::f32::consts::TAU * turn).cos()
            });
            *se = [0.1; 3];
        }
        image
    };
    let tests: Vec<Test> = (0..400).map(|i| z_test(&noise(1000 + 2 * i), &noise(1001 + 2 * i), 8).unwrap()).collect();
    assert_eq!(tests[0].tests, 8 * 6 * 3);
    for p in [|t: &Test| t.p_max_z, |t: &Test| t.p_chi_square] {
        let mut values: Vec<f64> = tests.iter().map(p).collect();
        values.sort_by(f64::total_cmp);
        let distance = values.iter().enumerate().map(|(i, p)| (p - (i as f64 + 0.5) / 400.0).abs());
        let distance = distance.fold(0.0, f64::max);
        assert!(distance < 1.63 / 20.0, "Kolmogorov–Smirnov distance {distance}");
    }
}

/// Standard errors that are themselves estimated, from 64 samples of a skewed distribution.
#[test]
fn two_renders_of_one_image_agree() {
    let tests: Vec<Test> = (0..20).map(|i| z_test(&render(1.0, 2 * i), &render(1.0, 2 * i + 1), 8).unwrap()).collect();
    assert!(tests.iter().all(|t| t.p > 1e-4), "{tests:?}");
    let spread = tests.iter().flat_map(|t| t.chi_square_per_degree).sum::<f64>() / 60.0;
    assert!((spread - 1.0).abs() < 0.05, "χ² a degree of freedom {spread}");
}

/// A tile has 64 pixels of 64 samples: the difference of two means is known to √2/64 = 2.2 %. A shift of 5 % is
/// z = 2.3, nothing to see in one tile of 144; but χ² of 48 tiles grows by 48 · 2.3² = 250, 25 standard deviations.
/// One tile over the whole image knows the difference to 0.32 %: there 2 % is z = 6.
#[test]
fn a_small_shift_is_found_by_chi_square_and_a_local_one_by_the_largest_z() {
    let a = render(1.0, 1);
    let shifted = z_test(&a, &render(1.05, 2), 8).unwrap();
    assert!(shifted.p_chi_square < 1e-6, "{shifted:?}");

    let whole = |mean| z_test(&render(mean, 3), &render(1.0, 4), 64).unwrap();
    assert!(whole(1.02).p < 1e-4);

    let mut local = render(1.0, 5);
    for x in 8..16 {
        for y in 16..24 {
            local.mean[y * 64 + x][1] *= 1.2;
        }
    }
    let test = z_test(&a, &local, 8).unwrap();
    assert!(test.p_max_z < 1e-6 && test.max_z_pixel == (8, 16), "{test:?}");
}

/// A shift of 1 % in images of a thousand times more samples (their standard errors √1000 smaller) is obvious.
#[test]
fn one_percent_is_found_when_noise_is_small_enough() {
    let quiet = |mean: f32, seed| {
        let mut image = render(mean, seed);
        for (m, se) in image.mean.iter_mut().zip(image.standard_error.as_mut().unwrap()) {
            for c in 0..3 {
                m[c] = mean + (m[c] - mean) / 1000f32.sqrt();
                se[c] /= 1000f32.sqrt();
            }
        }
        image
    };
    assert!(z_test(&quiet(1.01, 1), &quiet(1.0, 2), 8).unwrap().p < 1e-9);
    assert!(z_test(&quiet(1.0, 1), &quiet(1.0, 2), 8).unwrap().p > 1e-3);
}

/// One sample in 4096 is 4096, the others are 0: a tile of 64 pixels and 64 samples finds a Poisson number of mean 1,
/// and in every third tile nothing, with a standard error of nothing. Its partner knows the mean well.
#[test]
fn light_that_was_found_too_rarely_is_no_difference() {
    let rare = |seed: u64| {
        let mut film = Film::new(64, 48, Crop::full(64, 48));
        for (i, pixel) in film.pixels.iter_mut().enumerate() {
            let mut rng = Rng::for_sample((i as u32, 0), 0, seed);
            for _ in 0..64 {
                pixel.add([if rng.next_1d() < 1.0 / 4096.0 { 4096.0 } else { 0.0 }; 3]);
            }
        }
        Image::of(&film, Metadata::default())
    };
    for seed in 0..20 {
        let test = z_test(&render(1.0, seed), &rare(seed), 8).unwrap();
        assert!(test.p > 0.01, "{test:?}");
    }
    // But not finding it anywhere is one.
    let mut never = rare(0);
    never.mean.fill([0.0; 3]);
    never.standard_error.as_mut().unwrap().fill([0.0; 3]);
    assert!(z_test(&render(1.0, 1), &never, 8).unwrap().p < 1e-6);
}

#[test]
fn noiseless_images_agree_when_equal_and_differ_when_not() {
    let flat = |value: f32| {
        let mut film = Film::new(16, 16, Crop::full(16, 16));
        for pixel in &mut film.pixels {
            pixel.add([value; 3]);
            pixel.add([value; 3]);
        }
        Image::of(&film, Metadata::default())
    };
    assert_eq!(z_test(&flat(1.0), &flat(1.0), 8), None);
    assert!(z_test(&flat(1.0), &flat(1.0 + f32::EPSILON), 8).unwrap().p > 0.1, "rounding is no difference");
    assert!(z_test(&flat(1.0), &flat(1.001), 8).unwrap().p < 1e-9);
    assert!(z_test(&flat(1.0), &flat(f32::NAN), 8).unwrap().p == 0.0, "what is not a number agrees with nothing");
}

/// a = b + 0.5 everywhere: MSE 1/4, MAE 1/2; b = 1: relative 0.25/1.01, PSNR 10 log₁₀ 4.
#[test]
fn measures_have_their_textbook_values() {
    let mut a = render(1.0, 1);
    let mut b = a.clone();
    a.mean.fill([1.5; 3]);
    b.mean.fill([1.0; 3]);
    let m = measures(&a, &b);
    let close = |x: f64, y: f64| (x - y).abs() < 1e-12;
    assert!(close(m.mse, 0.25) && close(m.mae, 0.5) && close(m.relative_mse, 0.25 / 1.01), "{m:?}");
    assert!(close(m.psnr, 10.0 * 4f64.log10()) && close(m.max_difference, 0.5));
}

/// 1 − (1 − 0.01)² = 0.0199; and tiny p-values times n.
#[test]
fn sidak_corrects_for_the_number_of_tests() {
    assert!((sidak(0.01, 2) - 0.0199).abs() < 1e-12);
    assert!((sidak(1e-18, 100) / 1e-16 - 1.0).abs() < 1e-6);
    assert_eq!(sidak(1.0, 3), 1.0);
}
