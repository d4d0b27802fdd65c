//! Repository chores, one command each: `cargo xtask ci`, `tidy`, `peers`, `words`, `collections`, `gallery`, `bench`, `full`.
#![allow(clippy::print_stdout, clippy::print_stderr)] // a command line talks to its user

mod bench;
#[cfg(feature = "rays")]
mod bench_rays;
mod ci;
mod collections;
mod docs;
#[cfg(feature = "rays")]
mod embree;
mod gallery;
mod peers;
mod shell;
mod tidy;
mod venv;
mod words;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// The chores of this repository.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
struct Cli {
    #[command(subcommand)]
    chore: Chore,
}

#[derive(Debug, Subcommand)]
enum Chore {
    /// Everything that must hold for every commit: format, lints, docs, tests, tidy, smoke test
    Ci,
    /// The rules of STYLE.md that a program can check
    Tidy,
    /// tyndall against Mitsuba 3, and RGB against spectral colour: agreement and efficiency
    Peers(peers::Options),
    /// A small scene for each word of the scene languages: drawn, and compared with Mitsuba 3
    Words(words::Options),
    /// Other people's scenes: what loads, what renders, what agrees with Mitsuba 3 or with published images
    Collections(collections::Options),
    /// The pictures of the gallery, with their light taken apart, and their page
    Gallery(gallery::Options),
    /// The figures that tyndall promises, measured on this machine
    Bench(bench::Options),
    /// All that is known to be worth checking: ci, the slow tests, peers, words, bench
    Full,
}

fn main() -> ExitCode {
    match run(Cli::parse().chore) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("\nerror: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(chore: Chore) -> anyhow::Result<()> {
    match chore {
        Chore::Ci => ci::run(),
        Chore::Tidy => tidy::run(),
        Chore::Peers(options) => peers::run(&options),
        Chore::Words(options) => words::run(&options),
        Chore::Collections(options) => collections::run(&options),
        Chore::Gallery(options) => gallery::run(&options),
        Chore::Bench(options) => bench::run(&options),
        Chore::Full => {
            ci::run()?;
            ci::run_slow()?;
            peers::run(&peers::Options::default())?;
            words::run(&words::Options::default())?;
            bench::run(&bench::Options::default())
        }
    }
}
