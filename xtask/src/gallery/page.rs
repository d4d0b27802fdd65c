//! The page of the book.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use super::Told;
use super::rows::Entry;

/// A section for each picture that has been rendered; strips are shown where they lie in `book`.
pub(super) fn page(entries: &[Entry], rows: &BTreeMap<String, Told>, book: &Path) -> String {
    let cpu: f64 = rows.values().map(|told| told.cpu_seconds).sum();
    let mut text = format!(
        "# Gallery\n\n\
         Each picture comes from a scene of this repository and the command beneath it; `cargo xtask gallery` renders all of them \
         and makes this page ({:.0} CPU minutes in all). Below each, its light is [taken apart](layers.md): all light is direct \
         and indirect, or unscattered, single and multiple in media, or order by order (of hair and grains, by how often \
         they have scattered it: direct light is what was scattered once). Dark layers are shown brighter, by the \
         factor beneath. The call fails unless the layers of each group add up to the picture in every pixel, to one unit in \
         the last place. `tyndall layers IMAGE.exr --page mix.html` makes a page that mixes them anew.\n",
        cpu / 60.0
    );
    for entry in entries {
        let Some(told) = rows.get(entry.name) else { continue };
        let Entry { name, scene, layers, options, title, caption, .. } = entry;
        let options = options.iter().fold(String::new(), |text, option| text + " " + option);
        let _ = write!(
            text,
            "\n## {title}\n\n![{title}](gallery/{name}.png)\n\n{caption}\n\n\
             ```\ntyndall render scenes/{scene} --spp {}{options}{}\n```\n\n\
             {} × {} pixels, {} samples each, {:.0} CPU seconds ({:.0} s by the clock); the \
             standard error is {:.1} % of a pixel in the mean.\n",
            told.spp,
            if told.sums.is_empty() { String::new() } else { format!(" --layers {}", layers.list()) },
            told.width,
            told.height,
            told.spp,
            told.cpu_seconds,
            told.wall_seconds,
            100.0 * told.relative_error,
        );
        if told.sums.is_empty() {
            let _ = write!(
                text,
                "\nIt was rendered without layers; `cargo xtask gallery --filter {name}` takes it apart.\n"
            );
        }
        for (kind, sum) in layers.groups().iter().zip(&told.sums) {
            if book.join(format!("{name}-{kind}.png")).exists() {
                let _ = write!(text, "\n![{title}: {sum}](gallery/{name}-{kind}.png)\n\n{sum}.\n");
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gallery::rows::ENTRIES;
    use crate::shell::root;

    #[test]
    fn every_picture_is_of_a_scene_of_its_own() {
        let names: std::collections::BTreeSet<_> = ENTRIES.iter().map(|entry| entry.name).collect();
        assert_eq!(names.len(), ENTRIES.len());
        for entry in &ENTRIES {
            assert!(root().join("scenes").join(entry.scene).exists(), "{}", entry.scene);
        }
    }

    #[test]
    fn the_page_tells_what_was_rendered_and_nothing_of_what_was_not() {
        let told = Told {
            width: 40,
            height: 30,
            spp: 16.0,
            wall_seconds: 2.0,
            cpu_seconds: 180.0,
            relative_error: 0.021,
            non_finite_samples: 0,
            sums: vec!["all = direct 40.00 % + indirect 60.00 %, bit for bit".into()],
        };
        let rows = BTreeMap::from([("fog".to_owned(), told)]);
        let page = page(&ENTRIES, &rows, Path::new("nowhere"));
        assert!(
            page.contains("(3 CPU minutes in all)") && page.contains("40 × 30 pixels, 16 samples each, 180 CPU"),
            "{page}"
        );
        assert!(page.contains("2.1 % of a pixel") && page.matches("\n## ").count() == 1);
        assert!(page.contains("tyndall render scenes/fog/scene.pbrt --spp 16 --layers emission"));
    }
}
