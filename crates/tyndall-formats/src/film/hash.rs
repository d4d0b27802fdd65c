//! A name for the contents of a scene: XXH3 (64 bits, Collet 2019) over the bytes of every file it read.
//!
//! The same files give the same hash on every machine and at every path; it tells whether two images show the same
//! scene. It does not resist forgery.

use std::path::Path;

use xxhash_rust::xxh3::Xxh3;

use super::FilmError;

/// Hash of the files' lengths and bytes in the given order, and of the parameters that were set from outside, as 16
/// hexadecimal digits.
///
/// # Errors
/// A file cannot be read.
pub fn of_scene<P: AsRef<Path>>(
    files: impl IntoIterator<Item = P>,
    definitions: &[(String, String)],
) -> Result<String, FilmError> {
    let mut hash = Xxh3::new();
    // The length keeps "ab", "c" apart from "a", "bc".
    let mut add = |bytes: &[u8]| {
        hash.update(&(bytes.len() as u64).to_le_bytes());
        hash.update(bytes);
    };
    for file in files {
        let path = file.as_ref();
        let bytes =
            std::fs::read(path).map_err(|source| FilmError::Io { action: "read", path: path.to_owned(), source })?;
        add(&bytes);
    }
    for (name, value) in definitions {
        add(name.as_bytes());
        add(value.as_bytes());
    }
    Ok(format!("{:016x}", hash.digest()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The pinned value is what makes it the same hash next year.
    #[test]
    fn the_hash_sees_bytes_borders_and_definitions_but_not_names() {
        let dir = super::super::save::tests::scratch("hash");
        let file = |name: &str, text: &str| {
            std::fs::write(dir.join(name), text).unwrap();
            dir.join(name)
        };
        let (ab, c, a, bc) = (file("1", "ab"), file("2", "c"), file("3", "a"), file("4", "bc"));
        let same = file("5", "ab");
        let first = of_scene([&ab, &c], &[]).unwrap();
        assert_eq!(first, of_scene([&same, &c], &[]).unwrap());
        assert_ne!(first, of_scene([&a, &bc], &[]).unwrap());
        assert_ne!(first, of_scene([&ab, &c], &[("g".into(), "0.9".into())]).unwrap());
        assert_eq!(of_scene([""; 0], &[]).unwrap(), "2d06800538d394c2");
        std::fs::remove_dir_all(dir).unwrap();
    }
}
