//! Files compressed by gzip: scene files and meshes whose name ends in `.gz`.

use std::io::{Read, Write};
use std::path::Path;

use flate2::{Compression, read::MultiGzDecoder, write::GzEncoder};

/// Whether a file is compressed, by the ending of its name.
pub fn is_gzip(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("gz"))
}

/// The content of a compressed file, which must not be longer than `limit` [bytes]: a small file can unfold to any length.
pub(crate) fn inflate(bytes: &[u8], limit: u64) -> Result<Vec<u8>, String> {
    let mut out = Vec::new();
    let decoder = MultiGzDecoder::new(bytes);
    decoder.take(limit + 1).read_to_end(&mut out).map_err(|error| format!("is no gzip file: {error}"))?;
    if out.len() as u64 > limit { Err(format!("unfolds to more than {limit} bytes")) } else { Ok(out) }
}

/// Compressed content; the same for the same, whenever it is made.
///
/// # Errors
/// If there is not enough memory.
pub fn deflate(bytes: &[u8]) -> std::io::Result<Vec<u8>> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes)?;
    encoder.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_folded_unfolds_and_no_further_than_it_may() {
        let text = b"Shape ".repeat(1000);
        let folded = deflate(&text).unwrap();
        assert!(folded.len() < 100);
        assert_eq!(inflate(&folded, 6000).unwrap(), text);
        assert_eq!(inflate(&folded, 5999).unwrap_err(), "unfolds to more than 5999 bytes");
        assert!(inflate(&folded[..20], 6000).unwrap_err().starts_with("is no gzip file"));
        assert!(inflate(b"Shape", 6000).unwrap_err().starts_with("is no gzip file"));
    }
}
