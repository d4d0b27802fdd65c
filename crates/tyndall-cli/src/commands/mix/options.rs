//! The arguments of `tyndall mix`: a command for each recipe, an option for each number that it asks for.

use std::path::PathBuf;

use clap::{Arg, ArgMatches, Args, Command, Error, FromArgMatches, Subcommand, error::ErrorKind};
use tyndall_optics::recipe::{self, RECIPES, Recipe};

/// What to mix, and what to tell of it.
#[derive(Debug)]
pub(crate) struct MixOptions {
    pub(crate) recipe: &'static Recipe,
    /// In the order of the recipe.
    pub(crate) values: Vec<f64>,
    pub(crate) output: MixOutput,
}

/// Where to write.
#[derive(Debug, Args)]
pub(crate) struct MixOutput {
    /// Write coefficients and phase functions by wavelength as JSON to a file, or to standard output with -
    #[arg(long, value_name = "FILE|-", help_heading = "Output")]
    pub(crate) json: Option<PathBuf>,
    /// Draw coefficients and mean cosine by wavelength: a name in .svg or .png
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub(crate) plot: Option<PathBuf>,
    /// Write a medium that scenes can include: a name in .pbrt (pbrt-v4) or .xml (Mitsuba 3)
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub(crate) medium: Option<PathBuf>,
}

fn command(recipe: &'static Recipe) -> Command {
    let arguments = recipe.parameters.iter().map(|p| {
        let [least, most] = p.range;
        let help = format!("{}, {least} to {most} [default: {}]", p.about, super::short(p.default));
        let parser = move |word: &str| match word.parse::<f64>() {
            Ok(v) if (least..=most).contains(&v) => Ok(v),
            _ => Err(format!("expected a number between {least} and {most}")),
        };
        Arg::new(p.name).long(p.name).value_name("NUMBER").help(help).value_parser(parser).allow_negative_numbers(true)
    });
    let command = MixOutput::augment_args(Command::new(recipe.name).args(arguments));
    command.about(recipe.about).long_about(None).after_help(format!("Source: {}", recipe.source))
}

impl Subcommand for MixOptions {
    fn augment_subcommands(all: Command) -> Command {
        all.subcommands(RECIPES.iter().map(command)).subcommand_required(true).arg_required_else_help(true)
    }

    fn augment_subcommands_for_update(all: Command) -> Command {
        Self::augment_subcommands(all)
    }

    fn has_subcommand(name: &str) -> bool {
        recipe::named(name).is_some()
    }
}

impl FromArgMatches for MixOptions {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        let (name, found) = matches.subcommand().ok_or_else(|| Error::new(ErrorKind::MissingSubcommand))?;
        let recipe = recipe::named(name).ok_or_else(|| Error::new(ErrorKind::InvalidSubcommand))?;
        let value = |p: &recipe::Parameter| found.get_one(p.name).copied().unwrap_or(p.default);
        let values = recipe.parameters.iter().map(value).collect();
        Ok(Self { recipe, values, output: MixOutput::from_arg_matches(found)? })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
