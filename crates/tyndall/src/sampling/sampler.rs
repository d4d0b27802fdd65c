//! The numbers that one path asks for: low-discrepancy points for the first dimensions, a random stream for the rest.
//!
//! A path has few dimensions that matter alike in all samples of a pixel: place in the pixel, wavelength, and at the
//! first vertices the light and the direction. These come from Owen-scrambled Sobol points (Burley 2020), one
//! four-dimensional block a purpose, padded; all others come from [`Rng`].

use glam::Vec2;
use openqmc::SobolSampler;

use super::rng::{Rng, mix64};

/// Where the first dimensions come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SamplerKind {
    /// Independent random numbers: the standard error of a pixel is exact.
    Independent,
    /// Owen-scrambled Sobol points: less error for the same samples; the standard error is an upper bound.
    #[default]
    Sobol,
}

/// The numbers of one sample of one pixel.
#[derive(Debug, Clone, Copy)]
pub struct Sampler {
    /// The stream for all dimensions that are not stratified.
    pub rng: Rng,
    points: Option<SobolSampler>,
}

impl Sampler {
    /// How many vertices of a path have low-discrepancy blocks of their own.
    pub const STRATIFIED_VERTICES: u32 = 3;

    /// The numbers of sample `index` of `pixel`.
    #[inline]
    pub fn new(kind: SamplerKind, pixel: (u32, u32), index: u32, seed: u64) -> Self {
        let rng = Rng::for_sample(pixel, index, seed);
        let points = match kind {
            SamplerKind::Independent => None,
            SamplerKind::Sobol => {
                let pattern = mix64(seed ^ mix64(u64::from(pixel.0) | (u64::from(pixel.1) << 32)));
                // The crate adds the high bits of the index to the pattern: keep the sum from overflowing.
                Some(SobolSampler::new(0, 0, (pattern >> 34) as i32, index as i32))
            }
        };
        Self { rng, points }
    }

    #[inline]
    fn block<const N: usize>(&mut self, domain: i32) -> [f32; N] {
        match &self.points {
            Some(points) => points.new_domain(domain).draw_sample_f32::<N>(),
            None => self.random(),
        }
    }

    #[inline]
    fn vertex_block<const N: usize>(&mut self, vertex: u32, purpose: i32) -> [f32; N] {
        if vertex < Self::STRATIFIED_VERTICES { self.block(2 + 4 * vertex as i32 + purpose) } else { self.random() }
    }

    /// Whether numbers at vertex `vertex` come from low-discrepancy points.
    #[inline]
    pub fn is_stratified(&self, vertex: u32) -> bool {
        vertex < Self::STRATIFIED_VERTICES && self.points.is_some()
    }

    /// From the random stream, each in `[0, 1)`. Written as a loop: closures over arrays are not always inlined.
    #[inline]
    pub fn random<const N: usize>(&mut self) -> [f32; N] {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = self.rng.next_1d();
        }
        numbers
    }

    /// Place in the pixel (two) and on the lens (two).
    #[inline]
    pub fn camera(&mut self) -> [f32; 4] {
        self.block(0)
    }

    /// Wavelength, and the lane that steers the path.
    #[inline]
    pub fn wavelength(&mut self) -> [f32; 2] {
        self.block(1)
    }

    /// Free flight before vertex `vertex`, in `(0, 1]`.
    #[inline]
    pub fn flight(&mut self, vertex: u32) -> f32 {
        if self.is_stratified(vertex) {
            let [u] = self.vertex_block(vertex, 0);
            1.0 - u
        } else {
            self.rng.next_positive()
        }
    }

    /// Choice of a light (one) and of a point on it (two) at vertex `vertex`; on surfaces, whether that is worth a ray (one).
    #[inline]
    pub fn light<const N: usize>(&mut self, vertex: u32) -> [f32; N] {
        self.vertex_block(vertex, 1)
    }

    /// Choice of a lobe (one) and of a direction (two) at vertex `vertex`.
    #[inline]
    pub fn direction(&mut self, vertex: u32) -> [f32; 3] {
        self.vertex_block(vertex, 2)
    }

    /// Distance of a collision that is aimed at a lamp on the way to vertex `vertex` (one), choice of a light (one) and of a
    /// point on it (two).
    #[inline]
    pub fn aim(&mut self, vertex: u32) -> [f32; 4] {
        self.vertex_block(vertex, 3)
    }

    /// Survival of roulette: never stratified, for the dimension moves with the path.
    #[inline]
    pub fn roulette(&mut self) -> f32 {
        self.rng.next_1d()
    }

    /// One number in `[0, 1)` from the random stream.
    #[inline]
    pub fn next_1d(&mut self) -> f32 {
        self.rng.next_1d()
    }

    /// Two numbers in `[0, 1)²` from the random stream.
    #[inline]
    pub fn next_2d(&mut self) -> Vec2 {
        Vec2::new(self.rng.next_1d(), self.rng.next_1d())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sobol_points_of_one_pixel_stratify_the_lens_and_the_pixel() {
        // 64 points of a (0,2)-sequence: each of 8×8 cells holds exactly one.
        let mut seen = [false; 64];
        for index in 0..64 {
            let [x, y, ..] = Sampler::new(SamplerKind::Sobol, (300, 7), index, 1).camera();
            let cell = (x * 8.0) as usize * 8 + (y * 8.0) as usize;
            assert!(!std::mem::replace(&mut seen[cell], true), "cell {cell} twice");
        }
    }

    #[test]
    fn distant_pixels_and_seeds_have_different_points() {
        let first = |pixel, seed| Sampler::new(SamplerKind::Sobol, pixel, 0, seed).camera();
        assert_ne!(first((0, 0), 0), first((256, 0), 0));
        assert_ne!(first((0, 0), 0), first((0, 0), 1));
    }
}
