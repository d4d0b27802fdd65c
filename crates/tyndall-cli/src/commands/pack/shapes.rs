//! Containers and grains as the command line names them: in words, or by the file of a mesh.

use std::{path::Path, sync::Arc};

use anyhow::Context;
use tyndall_formats::mesh::{read_obj, read_ply, read_serialized};
use tyndall_grains::{container::Container, form::Form, solid::Solid};

/// What is filled.
pub(super) fn container(text: &str) -> anyhow::Result<Container> {
    Ok(match solid(text)? {
        Some(solid) => Container::Mesh(Arc::new(solid)),
        None => text.parse()?,
    })
}

/// The shape of the grains.
pub(super) fn form(text: &str) -> anyhow::Result<Form> {
    match solid(text)? {
        Some(solid) => Form::mesh(solid).with_context(|| text.to_owned()),
        None => Ok(Form::parse(text)?),
    }
}

/// The body in a file, if the text has the name of one.
fn solid(text: &str) -> anyhow::Result<Option<Solid>> {
    let file = Path::new(text);
    let mesh = match file.extension().and_then(|ending| ending.to_str()) {
        Some("ply") => read_ply(file)?,
        Some("obj") => read_obj(file)?,
        Some("serialized") => read_serialized(file, 0)?,
        _ => return Ok(None),
    };
    let points: Vec<_> = mesh.positions.iter().map(|p| glam::DVec3::from_array(p.to_array().map(f64::from))).collect();
    Ok(Some(Solid::new(&points, &mesh.indices).with_context(|| text.to_owned())?))
}
