//! `tyndall layers`: the layers of light that have names, what expressions select, and what the layers of an image are.

mod groups;
pub(crate) mod options;
mod page;
mod strips;

use std::{ffi::OsString, path::Path, process::ExitCode};

use anyhow::{anyhow, ensure};
use tyndall::lpe::{PathLayer, explain::explain, named, parse};
use tyndall_formats::film::{exr, save};

use crate::outputs::say;
use groups::{Group, groups};
use options::LayersOptions;

/// What there is to say of an image, of an expression or of a list; without any of them, the names.
pub(crate) fn run(options: &LayersOptions) -> anyhow::Result<ExitCode> {
    if let Some(path) = &options.image {
        return of_image(path, options);
    }
    match &options.explain {
        Some(text) => {
            for layer in asked(text)? {
                say(&about(&layer))?;
            }
        }
        None => {
            for (name, expression, meaning) in named::table() {
                say(&format!("{name:<14} {expression:<30} {meaning}"))?;
            }
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// Tells the groups of an image's layers, and writes what was asked for.
fn of_image(path: &Path, options: &LayersOptions) -> anyhow::Result<ExitCode> {
    let image = exr::read(path)?;
    let groups = groups(&image);
    ensure!(
        !groups.is_empty(),
        "{} has no layers of light: make some with `tyndall render SCENE --layers direct,indirect,orders:4`",
        path.display()
    );
    for group in &groups {
        say(&sum(group))?;
    }
    if let Some(to) = &options.page {
        let page = page::page(&image, &groups, options.exposure)?;
        save::replace(to, page.as_bytes())?;
        say(&format!("{} ({:.1} MB)", to.display(), page.len() as f64 / 1e6))?;
    }
    if let Some(stem) = &options.strips {
        for (i, group) in groups.iter().enumerate() {
            let before = groups[..i].iter().filter(|other| other.kind == group.kind).count();
            let number = if before == 0 { String::new() } else { (before + 1).to_string() };
            let mut to = OsString::from(stem);
            to.push(format!("-{}{number}.png", group.kind.word()));
            strips::write(to.as_ref(), &image, group, options.exposure)?;
            say(&Path::new(&to).display().to_string())?;
        }
    }
    let exact = groups.iter().all(|group| group.apart.is_some_and(|apart| apart <= 1));
    Ok(if options.check && !exact { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}

/// `all = direct 40.0 % + indirect 60.0 %, to 1 unit in the last place`.
fn sum(group: &Group) -> String {
    let layers = group.layers.iter().map(|layer| format!("{} {:.2} %", layer.name, 100.0 * layer.share));
    let exact = match group.apart {
        Some(0) => ", bit for bit".into(),
        Some(1) => ", to 1 unit in the last place".into(),
        Some(apart) => format!(", to {apart} units in the last place"),
        None => String::new(),
    };
    format!("all = {}{exact}", layers.collect::<Vec<_>>().join(" + "))
}

/// The layers of a list; or the one of an expression without a name.
fn asked(text: &str) -> anyhow::Result<Vec<PathLayer>> {
    let is_expression = !text.contains('=') && text.trim_start().starts_with(['C', '(', '[', '<', '.', '*', '|']);
    if is_expression {
        let expr = parse(text).map_err(|e| anyhow!("{}", e.shown(text)))?;
        return Ok(vec![PathLayer { name: String::new(), text: text.to_owned(), expr }]);
    }
    Ok(named::list(text)?)
}

fn about(layer: &PathLayer) -> String {
    let title = if layer.name.is_empty() { layer.text.clone() } else { format!("{} = {}", layer.name, layer.text) };
    format!("{title}\n  {}", explain(&layer.expr).replace('\n', "\n  "))
}
