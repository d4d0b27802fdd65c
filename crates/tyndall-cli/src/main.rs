//! The tyndall command line: see `tyndall --help`.
#![allow(clippy::print_stderr, reason = "talking to a person is what this program is for")]

mod args;
mod beside;
mod canvas;
mod commands;
mod false_color;
mod integrators;
mod interrupt;
mod legend;
mod load;
mod outputs;
mod progress;
mod report;
mod shrink;
mod statistics;
mod tev;
mod threads;
mod values;
mod watch;

use std::{io::IsTerminal, process::ExitCode};

use clap::Parser;
use tyndall_formats::error::Diagnostics;

use args::{Arguments, Command};

/// What was asked for cannot be done: bad arguments, a faulty scene, a file that cannot be read or written.
const FAILED: u8 = 2;

fn main() -> ExitCode {
    let outcome = match Arguments::parse().command {
        Command::Render(options) => commands::render::run(&options),
        Command::Compare(options) => commands::compare::run(&options),
        Command::Convert(options) => commands::convert::run(&options),
        Command::Lecture(options) => commands::lecture::run(&options),
        Command::Info(options) => commands::info::run(&options),
        Command::Lab(instrument) => commands::lab::run(&instrument),
        Command::Mix(options) => commands::mix::run(&options),
        Command::Pack(options) => commands::pack::run(&options),
        Command::Materials(options) => commands::materials::run(&options),
        Command::Layers(options) => commands::layers::run(&options),
        Command::Separate(options) => commands::separate::run(&options),
        Command::Verify(options) => commands::verify::run(&options),
    };
    outcome.unwrap_or_else(|error| {
        show(&error);
        ExitCode::from(FAILED)
    })
}

/// Faults of a scene are drawn into the scene's text, others are told in a line.
fn show(error: &anyhow::Error) {
    match error.downcast_ref::<Diagnostics>() {
        Some(faults) => eprintln!("{}", faults.render(std::io::stderr().is_terminal())),
        None => eprintln!("error: {error:#}"),
    }
}
