//! Rules for documents: links lead somewhere, scenes are explained.

use super::tree::Tree;

/// Directories of scenes that others explain: the peers' scenes have one page together.
const SCENES_WITHOUT_A_PAGE: [&str; 1] = ["peers"];

/// Every link from a document to a file of the repository finds it.
pub(crate) fn links_resolve(tree: &Tree) -> Vec<String> {
    let mut complaints = Vec::new();
    for (path, text) in tree.ending(".md") {
        let directory = path.rsplit_once('/').map_or("", |(directory, _)| directory);
        for (line, target) in links(text) {
            let file = target.split(['#', '?']).next().unwrap_or(target);
            if !resolve(directory, file).is_some_and(|file| tree.has(&file)) {
                complaints.push(format!("{path}:{line}: the link to `{target}` leads nowhere"));
            }
        }
    }
    complaints
}

/// Every scene of the repository says what to look at.
pub(crate) fn scenes_are_explained(tree: &Tree) -> Vec<String> {
    let scenes = tree.directories_in("scenes").into_iter().filter(|name| !SCENES_WITHOUT_A_PAGE.contains(name));
    let bare = scenes.filter(|name| !tree.has(&format!("scenes/{name}/README.md")));
    bare.map(|name| format!("scenes/{name}/README.md: missing; say what to look at")).collect()
}

/// The local targets of a document's links and pictures, with their lines. Code is passed over.
fn links(text: &str) -> Vec<(usize, &str)> {
    let mut found = Vec::new();
    let mut in_code = false;
    for (number, line) in text.lines().enumerate() {
        if line.trim_start().starts_with("```") {
            in_code = !in_code;
        }
        if in_code {
            continue;
        }
        for (at, _) in line.match_indices("](") {
            let in_inline_code = line[..at].matches('`').count() % 2 == 1;
            let Some(end) = line[at + 2..].find(')').filter(|_| !in_inline_code) else { continue };
            let target = line[at + 2..at + 2 + end].split_whitespace().next().unwrap_or_default();
            let is_local = !target.contains("://") && !target.starts_with("mailto:") && !target.starts_with('#');
            if is_local {
                found.push((number + 1, target));
            }
        }
    }
    found
}

/// A relative path from a directory of the repository; none if it climbs out of it.
fn resolve(directory: &str, target: &str) -> Option<String> {
    let mut parts: Vec<&str> = if target.starts_with('/') { Vec::new() } else { directory.split('/').collect() };
    for part in target.split('/') {
        match part {
            "" | "." => {}
            ".." => {
                parts.pop().filter(|part| !part.is_empty())?;
            }
            name => parts.push(name),
        }
    }
    Some(parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("/"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_are_followed_from_their_own_directory() {
        let page = "[up](../STYLE.md) [beside](b.md#part) [web](https://a.b/c) [here](#part)\n`[code](x.md)`\n\
                    ```\n[code](y.md)\n```\n![gone](gone.png)\n";
        let tree = Tree::of(&[("docs/a.md", page), ("docs/b.md", ""), ("STYLE.md", "")]);
        assert_eq!(links_resolve(&tree), ["docs/a.md:6: the link to `gone.png` leads nowhere"]);
    }

    #[test]
    fn a_link_may_name_a_directory_but_not_leave_the_repository() {
        let tree = Tree::of(&[("README.md", "[d](docs/) [out](../x)"), ("docs/a.md", "[root](..)")]);
        assert_eq!(links_resolve(&tree), ["README.md:1: the link to `../x` leads nowhere"]);
    }

    #[test]
    fn a_scene_without_a_page_is_found() {
        let tree = Tree::of(&[
            ("scenes/milk/scene.pbrt", ""),
            ("scenes/milk/README.md", ""),
            ("scenes/fog/scene.xml", ""),
            ("scenes/peers/mitsuba/a.xml", ""),
        ]);
        assert_eq!(scenes_are_explained(&tree), ["scenes/fog/README.md: missing; say what to look at"]);
    }
}
