//! The page of the book: a table for each kind of word, a picture and what the comparisons say of each.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::{Row, known::Known};

/// The page; `level` is the probability below which two pictures differ.
pub(super) fn page(rows: &[Row], level: f64, known: &Known) -> String {
    let compared = rows.iter().filter(|row| row.with_mitsuba.is_some()).count();
    let twins = rows.iter().filter(|row| row.with_twin.is_some()).count();
    let mut text = format!(
        "# Words in pictures\n\n\
         A small scene for each word, from `scenes/words`; `cargo xtask words` draws them and makes this page. Of the {} scenes \
         {compared} are Mitsuba's and were rendered by Mitsuba 3.9.1 (`scalar_rgb`) too; {twins} are there in both languages, and \
         the picture of the one was compared with that of the other. Each side ran four times with independent noise; \
         they *agree* if the tiles of 8 × 8 pixels, their χ² and the means say nothing against it, at a chance of 1 % of a \
         false alarm in the whole page. Means are ours over theirs in red, green and blue.\n",
        rows.len(),
    );
    let mut kinds: BTreeMap<&str, Vec<&Row>> = BTreeMap::new();
    for row in rows {
        kinds.entry(row.name.split_once('-').map_or("", |(kind, _)| kind)).or_default().push(row);
    }
    for (kind, rows) in kinds {
        let _ =
            write!(text, "\n## {kind}\n\n| | word | languages | against Mitsuba | pbrt's words against Mitsuba's |\n");
        text += "|---|---|---|---|---|\n";
        for row in rows {
            let told = |found: &Option<_>| {
                found.as_ref().map_or(String::new(), |found: &crate::collections::comparison::Comparison| {
                    let (word, sentence) = found.told(level);
                    match known.reason(&row.name).filter(|_| found.p < level) {
                        Some(reason) => format!("{word}: {sentence}. {reason}"),
                        None => format!("{word}: {sentence}"),
                    }
                })
            };
            let _ = writeln!(
                text,
                "| ![{name}](images/words/{name}.png) | `{}` | {} | {} | {} |",
                row.name.split_once('-').map_or(&*row.name, |(_, word)| word),
                row.languages.join(", "),
                told(&row.with_mitsuba),
                told(&row.with_twin),
                name = row.name,
            );
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collections::comparison::Comparison;

    #[test]
    fn a_row_shows_the_picture_and_tells_both_comparisons() {
        let found =
            Comparison { p: 0.5, extreme_z: 1.0, extreme_at: (8, 16, 1), ratio: [Some((1.0, 0.001)), None, None] };
        let differs = Comparison { p: 1e-9, ..found.clone() };
        let languages = vec!["pbrt".to_owned(), "Mitsuba".to_owned()];
        let row = Row { name: "bsdf-a".to_owned(), languages, with_mitsuba: Some(found), with_twin: Some(differs) };
        let page = page(&[row], 0.01, &Known::default());
        assert!(page.contains("## bsdf\n"), "{page}");
        assert!(
            page.contains(
                "| ![bsdf-a](images/words/bsdf-a.png) | `a` | pbrt, Mitsuba | agrees: means 1.0000±0.0010 – –;"
            )
        );
        assert!(page.contains("| **differs**: means"), "{page}");
    }
}
