//! What tests of the program share.

use std::{fs, path::PathBuf, process::Command};

/// A directory of the test's own, removed when it is done.
pub(crate) struct Desk(pub(crate) PathBuf);

impl Desk {
    /// An empty directory; tests of one file have different names.
    pub(crate) fn new(name: &str) -> Self {
        let file = env!("CARGO_CRATE_NAME");
        let dir = std::env::temp_dir().join(format!("tyndall-{file}-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&dir);
        fs::create_dir_all(&dir).unwrap();
        Self(dir)
    }

    /// The program, started there.
    pub(crate) fn program(&self) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_tyndall"));
        command.current_dir(&self.0);
        command
    }
}

impl Drop for Desk {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}
