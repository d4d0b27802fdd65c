//! Running a program on a file from anywhere: in a process of its own, with an end to its time and its memory.
//!
//! Linux: `timeout` of coreutils and `prlimit` of util-linux do the work.

use std::os::unix::process::ExitStatusExt;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use anyhow::{Context, Result};

/// What one process may take.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limits {
    /// Wall time [s]
    pub(crate) seconds: u32,
    /// Address space [GiB]; none if the program reserves more than it uses
    pub(crate) gibibytes: Option<u64>,
}

/// How a process ended.
#[derive(Debug)]
pub(crate) enum End {
    /// It did what it should, and printed this
    Done(String),
    /// It said that it cannot, with this on standard error
    Failed(String),
    /// It broke: a panic, a signal
    Broken(String),
    /// It took longer than it may
    TooLong,
}

/// Exit status of `timeout` for a program that was ended.
const TIMED_OUT: i32 = 124;
/// Exit status of a Rust program that panicked.
const PANICKED: i32 = 101;

impl Limits {
    /// Runs a program to its end, or to the end of what it may take.
    pub(crate) fn run(self, program: &PathBuf, set: impl FnOnce(&mut Command)) -> Result<End> {
        let mut command = Command::new("timeout");
        command.arg("--kill-after=5").arg(self.seconds.to_string());
        if let Some(gibibytes) = self.gibibytes {
            command.arg("prlimit").arg(format!("--as={}", gibibytes << 30));
        }
        command.arg(program).stdin(Stdio::null());
        set(&mut command);
        let output = command.output().context("cannot start `timeout`")?;
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        Ok(match output.status.code() {
            Some(0) => End::Done(String::from_utf8_lossy(&output.stdout).into_owned()),
            Some(TIMED_OUT) => End::TooLong,
            Some(PANICKED) => End::Broken(stderr),
            Some(code) if code > 128 => End::Broken(format!("signal {}\n{stderr}", code - 128)),
            // `timeout` ends as its program did.
            None => End::Broken(format!("signal {}\n{stderr}", output.status.signal().unwrap_or_default())),
            Some(_) => End::Failed(stderr),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shell(seconds: u32, text: &str) -> End {
        let limits = Limits { seconds, gibibytes: None };
        limits
            .run(&"sh".into(), |command| {
                command.args(["-c", text]);
            })
            .unwrap()
    }

    #[test]
    fn every_way_to_end_is_told_from_the_others() {
        assert!(matches!(shell(60, "echo yes"), End::Done(stdout) if stdout == "yes\n"));
        assert!(matches!(shell(60, "echo no >&2; exit 2"), End::Failed(text) if text == "no\n"));
        assert!(matches!(shell(60, "exit 101"), End::Broken(_)));
        assert!(matches!(shell(60, "kill -SEGV $$"), End::Broken(text) if text == "signal 11\n"));
        assert!(matches!(shell(1, "sleep 60"), End::TooLong));
    }

    /// dash and bash both say so and fail where they cannot have what they ask for.
    #[test]
    fn who_wants_too_much_memory_does_not_get_it() {
        let limits = Limits { seconds: 60, gibibytes: Some(1) };
        let end = limits.run(&"dd".into(), |command| {
            command.args(["if=/dev/zero", "of=/dev/null", "bs=2G", "count=1"]);
        });
        assert!(matches!(end.unwrap(), End::Failed(_)));
    }
}
