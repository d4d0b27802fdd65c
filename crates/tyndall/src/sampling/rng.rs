//! The stream of random numbers that a path owns: counter-based, so that it has no state to share and any number of it
//! can be computed alone, in any lane.
//!
//! Numbers come in blocks of four, as many as a collision wants. Block `b` is a round of Wellons' *lowbias32* hash (bias
//! 0.17, 2018) of `b`, keyed with half of a 64-bit key made from pixel, sample and seed; number `j` of the block is a second
//! round of that plus the other half of the key and `j` steps of a Weyl sequence. Only 32-bit products, so 16 lanes run at
//! once.

/// A stream of 2³² uniform numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rng {
    /// Half of the key.
    pub key: [u32; 2],
    /// How many numbers have been drawn.
    pub counter: u32,
}

/// One round of a 32-bit hash of full avalanche.
#[inline]
const fn mix(mut x: u32) -> u32 {
    x ^= x >> 16;
    x = x.wrapping_mul(0x21f0_aaad);
    x ^= x >> 15;
    x = x.wrapping_mul(0x735a_2d97);
    x ^ (x >> 15)
}

/// A 64-bit hash of full avalanche (Steele, Lea, Flood 2014: SplitMix64).
#[inline]
pub const fn mix64(mut x: u64) -> u64 {
    x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// Of half of the key: another stream.
const ASIDE: u32 = 0x5bd1_e995;
/// 2³² divided by the golden ratio.
const WEYL: u32 = 0x9e37_79b9;

/// Number `j` of a block.
#[inline]
const fn number(block: u32, j: u32) -> u32 {
    mix(block.wrapping_add(j.wrapping_mul(WEYL)))
}

/// Random bits as a number in `[0, 1)`, 24 bits of it.
#[inline]
pub fn unit(bits: u32) -> f32 {
    (bits >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// Random bits as a number in `(0, 1]`.
#[inline]
pub fn positive(bits: u32) -> f32 {
    (bits as f32 + 0.5) * (1.0 / 4_294_967_296.0)
}

impl Rng {
    /// The stream of one sample of one pixel: the same on any thread, in any order.
    #[inline]
    pub fn for_sample(pixel: (u32, u32), index: u32, seed: u64) -> Self {
        let place = mix64(u64::from(pixel.0) | (u64::from(pixel.1) << 32));
        let key = mix64(place ^ mix64(seed ^ mix64(u64::from(index))));
        Self { key: [key as u32, (key >> 32) as u32], counter: 0 }
    }

    /// The next 32 random bits.
    #[inline]
    pub fn next_u32(&mut self) -> u32 {
        let bits = number(self.block(), self.counter % 4);
        self.counter = self.counter.wrapping_add(1);
        bits
    }

    /// Four times 32 random bits, from the next whole block.
    #[inline]
    pub fn next_four(&mut self) -> [u32; 4] {
        self.counter = self.counter.wrapping_add(3) & !3;
        let block = self.block();
        self.counter = self.counter.wrapping_add(4);
        [number(block, 0), number(block, 1), number(block, 2), number(block, 3)]
    }

    /// Another stream, for a question on the way: whether it is asked cannot be seen in what this one gives.
    #[inline]
    #[must_use]
    pub fn aside(self) -> Self {
        Self { key: [self.key[0], self.key[1] ^ ASIDE], counter: self.counter }
    }

    /// What the numbers of the block have in common that is under way.
    #[inline]
    fn block(self) -> u32 {
        mix((self.counter / 4).wrapping_mul(WEYL) ^ self.key[0]).wrapping_add(self.key[1])
    }

    /// Uniform in `[0, 1)`, 24 bits.
    #[inline]
    pub fn next_1d(&mut self) -> f32 {
        unit(self.next_u32())
    }

    /// Uniform in `(0, 1]`, 32 bits: the argument of a logarithm.
    #[inline]
    pub fn next_positive(&mut self) -> f32 {
        positive(self.next_u32())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Value stability: a change of these numbers changes every image.
    #[test]
    fn the_first_values_of_a_stream_are_pinned() {
        let mut rng = Rng::for_sample((3, 5), 7, 11);
        let first: [u32; 4] = std::array::from_fn(|_| rng.next_u32());
        assert_eq!(first, [1492736005, 1905860172, 3991765664, 567232534]);
    }

    /// Pearson's statistic of serial pairs over 32×32 cells: χ² with 1023 degrees of freedom has mean 1023 and
    /// standard deviation √2046 = 45.2; 5 σ is asked. Consecutive numbers of one stream, and the same number of
    /// consecutive samples and pixels.
    #[test]
    fn serial_pairs_are_uniform_along_streams_samples_and_pixels() {
        const N: u32 = 1 << 20;
        let statistic = |pair: &mut dyn FnMut(u32) -> (f32, f32)| {
            let mut cells = vec![0u32; 1024];
            for i in 0..N {
                let (a, b) = pair(i);
                cells[(a * 32.0) as usize * 32 + (b * 32.0) as usize] += 1;
            }
            let expected = f64::from(N) / 1024.0;
            cells.iter().map(|&c| (f64::from(c) - expected).powi(2) / expected).sum::<f64>()
        };
        let mut stream = Rng::for_sample((0, 0), 0, 0);
        let along = statistic(&mut |_| (stream.next_1d(), stream.next_1d()));
        let samples =
            statistic(&mut |i| (Rng::for_sample((1, 2), i, 3).next_1d(), Rng::for_sample((1, 2), i + 1, 3).next_1d()));
        let pixels = statistic(&mut |i| {
            (
                Rng::for_sample((i % 1024, i / 1024), 0, 3).next_1d(),
                Rng::for_sample((i % 1024 + 1, i / 1024), 0, 3).next_1d(),
            )
        });
        for (name, chi2) in [("stream", along), ("samples", samples), ("pixels", pixels)] {
            assert!((chi2 - 1023.0).abs() < 5.0 * 45.2, "{name}: chi² = {chi2}");
        }
    }
}
