//! Writing a file so that it is there whole or not at all.

use std::{
    fs,
    io::{self, Write},
    path::{Path, PathBuf},
};

use super::FilmError;

/// Puts `bytes` at `path`: written to a temporary name in the same directory, then renamed. What was at `path` stays
/// until the new file is whole.
///
/// # Errors
/// The directory does not exist or may not be written, the disk is full, or `path` is a directory.
pub fn replace(path: &Path, bytes: &[u8]) -> Result<(), FilmError> {
    let temporary = temporary_name(path);
    let written = create(&temporary).and_then(|mut file| {
        file.write_all(bytes)?;
        file.sync_all()?;
        fs::rename(&temporary, path)
    });
    written.map_err(|source| {
        // Whatever it was that failed, no half-written file stays behind; that there may be none is no second error.
        let _ = fs::remove_file(&temporary);
        cannot_write(path, source)
    })
}

/// Finds out whether [`replace`] could work, before hours are spent on an image that cannot be saved.
///
/// # Errors
/// As [`replace`].
pub fn check(path: &Path) -> Result<(), FilmError> {
    let temporary = temporary_name(path);
    let probed = if path.is_dir() {
        Err(io::Error::from(io::ErrorKind::IsADirectory))
    } else {
        create(&temporary).and_then(|_| fs::remove_file(&temporary))
    };
    probed.map_err(|source| cannot_write(path, source))
}

fn create(temporary: &Path) -> io::Result<fs::File> {
    fs::OpenOptions::new().write(true).create(true).truncate(true).open(temporary)
}

fn cannot_write(path: &Path, source: io::Error) -> FilmError {
    FilmError::Io { action: "write", path: path.to_owned(), source }
}

/// `.NAME.PID.tmp` beside the file, so that renaming stays on one file system and two processes do not meet.
fn temporary_name(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}.{}.tmp", std::process::id()))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A fresh directory of the test's own.
    pub(crate) fn scratch(name: &str) -> PathBuf {
        let dir = std::env::temp_dir().join(format!("tyndall-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&dir);
        fs::create_dir_all(&dir).unwrap();
        dir
    }

    #[test]
    fn a_saved_file_is_whole_and_leaves_nothing_beside_it() {
        let dir = scratch("save");
        replace(&dir.join("a"), b"old").unwrap();
        replace(&dir.join("a"), b"new").unwrap();
        assert_eq!(fs::read(dir.join("a")).unwrap(), b"new");
        assert_eq!(fs::read_dir(&dir).unwrap().count(), 1);
        fs::remove_dir_all(dir).unwrap();
    }

    #[test]
    fn what_cannot_be_written_is_told_before_and_after_and_harms_nothing() {
        let dir = scratch("save-fail");
        let missing = dir.join("missing").join("a.exr");
        let message = check(&missing).unwrap_err().to_string();
        assert!(message.contains("cannot write") && message.contains("a.exr"), "{message}");
        assert!(replace(&missing, b"x").is_err());
        // A directory that bears the file's name.
        fs::create_dir(dir.join("b.exr")).unwrap();
        assert!(check(&dir.join("b.exr")).is_err());
        assert!(replace(&dir.join("b.exr"), b"x").is_err());
        assert_eq!(fs::read_dir(&dir).unwrap().count(), 1);
        fs::remove_dir_all(dir).unwrap();
    }
}
