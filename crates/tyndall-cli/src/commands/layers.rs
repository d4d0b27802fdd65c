//! `tyndall layers`: the layers of light that have names, and what expressions select.

use std::process::ExitCode;

use anyhow::anyhow;
use tyndall::lpe::{PathLayer, explain::explain, named, parse};

use crate::args::LayersOptions;

/// What there is to say of an expression or of a list; without one, the names.
pub(crate) fn run(options: &LayersOptions) -> anyhow::Result<ExitCode> {
    match &options.explain {
        Some(text) => {
            for layer in asked(text)? {
                println!("{}", about(&layer));
            }
        }
        None => {
            for (name, expression, meaning) in named::table() {
                println!("{name:<14} {expression:<30} {meaning}");
            }
        }
    }
    Ok(ExitCode::SUCCESS)
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
