//! Input files of MCML 1.2 (Wang, Jacques and Zheng 1995), as they are: every run in them becomes a [`Setup`].
//!
//! ```text
//! 1.0                  # version of the format
//! 1                    # number of runs
//! skin.mco A           # output file, ASCII or binary
//! 100000               # photons
//! 0.001 0.01           # dz, dr [cm]
//! 100 50 30            # numbers of bins of z, r and angle
//! 1                    # number of layers
//! 1.0                  # n above
//! 1.4 0.1 100 0.9 1E8  # n, mu_a [1/cm], mu_s [1/cm], g, d [cm]
//! 1.0                  # n below
//! ```
//!
//! `#` begins a comment, empty lines count for nothing. A layer of 10⁶ cm or more, the last, is a half-space.

use crate::slab::{Bins, Edges, Incidence, Layer, Setup};
use crate::world::{SetupError, Substance};

/// A run of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Where MCML would write.
    pub output: String,
    /// Photons.
    pub photons: u64,
    /// The experiment.
    pub setup: Setup,
}

/// What is wrong with a file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("line {line}: {message}")]
pub struct MciError {
    /// Where, from 1.
    pub line: usize,
    /// What.
    pub message: String,
}

/// The most runs, and the most layers of one: no file in the world has as many.
const MOST: u64 = 10_000;
/// Layers at least as thick [cm] have no other end.
const ENDLESS: f64 = 1e6;

/// Reads all runs of a file.
///
/// # Errors
/// The file is cut short, a number is none or out of its range, or there is text where a number should be.
pub fn read(text: &str) -> Result<Vec<Run>, MciError> {
    let mut lines = Lines { lines: text.lines().enumerate(), line: 0 };
    lines.numbers::<1>("the version of the format")?;
    let runs = lines.count("the number of runs")?;
    (0..runs).map(|_| lines.run()).collect()
}

/// The lines of a file that say something.
struct Lines<'a> {
    lines: std::iter::Enumerate<std::str::Lines<'a>>,
    line: usize,
}

impl<'a> Lines<'a> {
    fn run(&mut self) -> Result<Run, MciError> {
        let words = self.words("the output file and its format")?;
        let output = words.first().copied().unwrap_or_default().to_owned();
        if !matches!(words.get(1), None | Some(&("A" | "B" | "a" | "b"))) {
            return Err(self.error("the format of the output file is A or B"));
        }
        let photons = self.numbers::<1>("the number of photons")?[0];
        if !(1.0..=1e18).contains(&photons) || photons.fract() != 0.0 {
            return Err(self.error("the number of photons must be a whole number, at least 1"));
        }
        let [dz, dr] = self.numbers("dz and dr")?;
        let [nz, nr, na] = self.numbers("the numbers of bins of z, r and angle")?;
        let bins = self.bins([dz, dr], [nz, nr, na])?;
        let layers = self.count("the number of layers")?;
        let [n_above] = self.numbers("the index above")?;
        let layers = (0..layers).map(|_| self.layer()).collect::<Result<Vec<_>, _>>()?;
        let [n_below] = self.numbers("the index below")?;
        let setup = Setup { layers, n_above, n_below, incidence: Incidence::Beam(1.0), bins };
        setup.check().map_err(|fault: SetupError| self.error(&fault.to_string()))?;
        Ok(Run { output, photons: photons as u64, setup })
    }

    fn layer(&mut self) -> Result<Layer, MciError> {
        let [n, sigma_a, sigma_s, g, d] = self.numbers("n, mu_a, mu_s, g and d of a layer")?;
        let thickness = if d >= ENDLESS { f64::INFINITY } else { d };
        Ok(Layer { substance: Substance { sigma_a, sigma_s, g, n }, thickness })
    }

    fn bins(&self, [dz, dr]: [f64; 2], counts: [f64; 3]) -> Result<Bins, MciError> {
        if counts.iter().any(|n| !(0.0..=1e5).contains(n) || n.fract() != 0.0) {
            return Err(self.error("numbers of bins are whole numbers from 0 to 100000"));
        }
        let [nz, nr, na] = counts.map(|n| n as usize);
        if [(nz, dz), (nr, dr)].iter().any(|(n, d)| *n > 0 && !(*d > 0.0 && d.is_finite())) {
            return Err(self.error("dz and dr must be positive"));
        }
        Ok(Bins { angles: na, radii: Edges::uniform(nr, dr), depths: Edges::uniform(nz, dz), ..Bins::default() })
    }

    /// A number of things, at least one.
    fn count(&mut self, what: &str) -> Result<u64, MciError> {
        let [count] = self.numbers(what)?;
        if (1.0..=MOST as f64).contains(&count) && count.fract() == 0.0 {
            return Ok(count as u64);
        }
        Err(self.error(&format!("{what} must be a whole number from 1 to {MOST}, not {count}")))
    }

    /// The numbers that a line begins with.
    fn numbers<const N: usize>(&mut self, what: &str) -> Result<[f64; N], MciError> {
        let words = self.words(what)?;
        let mut numbers = [0.0; N];
        for (number, word) in numbers.iter_mut().zip(words.iter().map(Some).chain(std::iter::repeat(None))) {
            let Some(word) = word else {
                return Err(self.error(&format!("{what}: {N} numbers are expected here, not {}", words.len())));
            };
            *number = word.parse().map_err(|_| self.error(&format!("{what}: \"{}\" is no number", short(word))))?;
        }
        Ok(numbers)
    }

    /// The words of the next line that says something.
    fn words(&mut self, what: &str) -> Result<Vec<&'a str>, MciError> {
        for (number, line) in self.lines.by_ref() {
            self.line = number + 1;
            let words: Vec<&str> = line.split('#').next().unwrap_or("").split_whitespace().collect();
            if !words.is_empty() {
                return Ok(words);
            }
        }
        self.line += 1;
        Err(self.error(&format!("the file ends before {what}")))
    }

    fn error(&self, message: &str) -> MciError {
        MciError { line: self.line, message: message.to_owned() }
    }
}

/// A word as messages show it.
fn short(word: &str) -> String {
    word.chars().take(40).collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const TWO_RUNS: &str = "\
        # a sample\n1.0\n2\n\n\
        a.mco A\n1000 # photons\n0.01 0.1\n4 5 6\n2\n1.0\n1.37 1 100 0.9 0.1 # upper\n1.4 2 50 0 1E8\n1.0\n\n\
        b.mco B\n2000\n1E-2 1E-1\n0 0 0\n1\n1\n1.5 0 10 -0.2 0.5\n1.33\n";

    #[test]
    fn every_run_of_a_file_is_read() {
        let runs = read(TWO_RUNS).unwrap();
        assert_eq!(runs.len(), 2);
        let first = &runs[0];
        assert_eq!((first.output.as_str(), first.photons), ("a.mco", 1000));
        assert_eq!(first.setup.layers[0].substance, Substance { sigma_a: 1.0, sigma_s: 100.0, g: 0.9, n: 1.37 });
        assert_eq!((first.setup.layers[0].thickness, first.setup.layers[1].thickness), (0.1, f64::INFINITY));
        assert_eq!((first.setup.bins.depths.count(), first.setup.bins.radii.count()), (4, 5));
        assert_eq!((first.setup.bins.angles, first.setup.bins.radii.bin(1)), (6, [0.1, 0.2]));
        assert_eq!((runs[1].setup.n_below, runs[1].setup.bins.angles), (1.33, 0));
    }

    #[test]
    fn a_fault_is_told_with_its_line() {
        let told = |text: &str| read(text).unwrap_err().to_string();
        assert_eq!(told(""), "line 1: the file ends before the version of the format");
        assert!(told("1.0\n0\n").starts_with("line 2: the number of runs must be a whole number"));
        assert!(told(&TWO_RUNS.replace("0.9 0.1", "0.9")).contains("line 11: n, mu_a, mu_s, g and d of a layer"));
        assert!(told(&TWO_RUNS.replace(" 100 ", " -100 ")).contains("the scattering coefficient must be at least 0"));
        assert!(told(&TWO_RUNS.replace("0.9 0.1", "nan 0.1")).contains("mean cosine"));
        assert!(told(&TWO_RUNS.replace("1.37 1", "1.37 one")).contains("\"one\" is no number"));
        let cut = &TWO_RUNS[..TWO_RUNS.len() - 6];
        assert!(told(cut).contains("the file ends before the index below"), "{}", told(cut));
    }

    proptest! {
        /// Any text is read or refused, soon and without a panic: words of a true file cut, moved and mixed with others.
        #[test]
        fn any_text_is_read_or_refused(
            picks in prop::collection::vec((0usize..60, "[-+.eE0-9#A-Za-z\u{0}é ]{0,6}"), 0..40),
            cut in 0usize..300,
        ) {
            let mut words: Vec<String> = TWO_RUNS.split_inclusive([' ', '\n']).map(str::to_owned).collect();
            for (at, word) in picks {
                let end = words.len().saturating_sub(1);
                words[at.min(end)] = format!("{word}\n");
            }
            let text: String = words.concat().chars().take(cut).collect();
            let _ = read(&text);
        }
    }
}
