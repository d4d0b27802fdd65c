//! Running other programs: from the root of the repository, with a named and timed stage around each.

use std::io::{BufRead, BufReader, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use anyhow::{Context, Result, bail};

/// The root of the repository.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("xtask lies in the repository").to_path_buf()
}

/// `cargo` with arguments separated by blanks, the same cargo that runs this program.
pub(crate) fn cargo(arguments: &str) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(arguments.split_whitespace()).current_dir(root());
    if std::io::stderr().is_terminal() {
        command.env("CARGO_TERM_COLOR", "always");
    }
    command
}

/// Where cargo puts what it builds.
pub(crate) fn target() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from)
}

/// Whether a program answers when called.
pub(crate) fn answers(command: &mut Command) -> bool {
    command.stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok_and(|status| status.success())
}

/// Runs a command to its end, shows what it prints as it comes, and returns it too. Fails if the command fails.
pub(crate) fn tee(command: &mut Command) -> Result<String> {
    let (reader, writer) = std::io::pipe()?;
    command.stdout(writer.try_clone()?).stderr(writer);
    let name = format!("{} {}", program_name(command), arguments(command));
    let mut child = command.spawn().with_context(|| format!("cannot start `{name}`"))?;
    command.stdout(Stdio::null()).stderr(Stdio::null()); // drops our ends of the pipe, else the reading never ends
    let mut text = String::new();
    let mut reader = BufReader::new(reader);
    let mut line = Vec::new();
    while reader.read_until(b'\n', &mut line)? > 0 {
        std::io::stderr().write_all(&line)?;
        text.push_str(&String::from_utf8_lossy(&line));
        line.clear();
    }
    let status = child.wait()?;
    if !status.success() {
        bail!("`{name}` failed ({status})");
    }
    Ok(text)
}

/// Runs a command quietly and returns its standard output. Fails, with its standard error, if the command fails.
pub(crate) fn output(command: &mut Command) -> Result<String> {
    let name = format!("{} {}", program_name(command), arguments(command));
    let output = command.output().with_context(|| format!("cannot start `{name}`"))?;
    if !output.status.success() {
        bail!("`{name}` failed ({})\n{}", output.status, String::from_utf8_lossy(&output.stderr));
    }
    Ok(String::from_utf8(output.stdout)?)
}

/// Stages of a longer chore: each prints its name, what it takes, and stops the chore where it fails.
#[derive(Debug)]
pub(crate) struct Stages {
    chore: &'static str,
    begun: Instant,
    done: Vec<(String, f64)>,
}

impl Stages {
    /// No stage has run yet.
    pub(crate) fn new(chore: &'static str) -> Self {
        Self { chore, begun: Instant::now(), done: Vec::new() }
    }

    /// Runs one stage.
    pub(crate) fn stage<T>(&mut self, name: &str, work: impl FnOnce() -> Result<T>) -> Result<T> {
        eprintln!("\n━━ {}: {name}", self.chore);
        let begun = Instant::now();
        let result = work().with_context(|| format!("{} stopped at stage `{name}`", self.chore))?;
        let seconds = begun.elapsed().as_secs_f64();
        eprintln!("━━ {}: {name}: passed in {seconds:.1} s", self.chore);
        self.done.push((name.to_owned(), seconds));
        Ok(result)
    }

    /// The table of stages and times.
    pub(crate) fn close(&self) {
        eprintln!("\n━━ {}: all {} stages passed", self.chore, self.done.len());
        for (name, seconds) in &self.done {
            eprintln!("   {seconds:8.1} s  {name}");
        }
        eprintln!("   {:8.1} s  in all", self.begun.elapsed().as_secs_f64());
    }
}

fn program_name(command: &Command) -> String {
    Path::new(command.get_program()).file_name().unwrap_or_default().to_string_lossy().into_owned()
}

fn arguments(command: &Command) -> String {
    command.get_args().map(|argument| argument.to_string_lossy()).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_command_prints_is_returned() {
        let text = tee(Command::new("cargo").arg("--version")).unwrap();
        assert!(text.starts_with("cargo 1."), "{text}");
    }

    #[test]
    fn a_failing_command_is_an_error_that_names_it() {
        let error = tee(Command::new("cargo").arg("no-such-command")).unwrap_err();
        assert!(error.to_string().contains("cargo no-such-command"), "{error}");
    }
}
