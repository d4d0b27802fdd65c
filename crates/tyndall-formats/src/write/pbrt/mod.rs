//! Scenes in pbrt-v4's language.
//!
//! Settings first, then `WorldBegin`, then media, textures and materials by their names, then lights, objects and shapes, each
//! shape in a block of its own. Every material has a name.

mod camera;
mod entity;
mod light;
mod material;
mod medium;
mod settings;
mod shape;
mod spectrum;
mod texture;

use glam::DMat4;

use super::Draft;
use super::names::Names;
use super::names::printable;
use super::number::doubles;
use super::place::Place;
use super::sheet::Sheet;
use crate::desc::{MaterialId, MediumId, Span};
use entity::{Entity, quoted};
use texture::Textures;

/// Lines of comment.
pub(super) fn commented(lines: &[String]) -> String {
    let lines: Vec<_> = lines.iter().map(|line| format!("# {}", printable(line))).collect();
    lines.join("\n") + "\n\n"
}

/// The scene without its header.
pub(super) fn scene(draft: &mut Draft<'_>) -> String {
    let desc = draft.desc;
    let mut pen =
        Pen { draft, sheet: Sheet::default(), media: Vec::new(), materials: Vec::new(), textures: Textures::default() };
    let mut names = Names::default();
    pen.media = desc.media.iter().map(|m| names.unique(m.name.as_deref(), "medium")).collect();
    let mut names = Names::default();
    pen.materials = desc.materials.iter().map(|m| names.unique(m.name.as_deref(), material::word(&m.kind))).collect();

    let settings = pen.on_a_sheet(Pen::settings);
    let media = pen.on_a_sheet(|pen| desc.media.iter().enumerate().for_each(|(i, medium)| pen.medium(i, medium)));
    let materials = pen.on_a_sheet(Pen::all_materials);
    let world = pen.on_a_sheet(|pen| {
        pen.lights();
        pen.shapes();
    });
    // What the others refer to is known now.
    let textures = pen.all_textures();
    // What is said of the camera's medium would hold for the world too.
    let begin = if desc.camera.medium.is_some() { "WorldBegin\nMediumInterface \"\" \"\"" } else { "WorldBegin" };
    let parts = [settings, begin.into(), media, textures, materials, world];
    let parts: Vec<_> = parts.iter().map(|part| part.trim_end()).filter(|part| !part.is_empty()).collect();
    parts.join("\n\n") + "\n"
}

/// A writer with the names that things have.
struct Pen<'a, 'b> {
    draft: &'a mut Draft<'b>,
    sheet: Sheet,
    media: Vec<String>,
    materials: Vec<String>,
    textures: Textures,
}

impl Pen<'_, '_> {
    /// What `write` writes, on a sheet of its own.
    fn on_a_sheet(&mut self, write: impl FnOnce(&mut Self)) -> String {
        let before = std::mem::take(&mut self.sheet);
        write(self);
        std::mem::replace(&mut self.sheet, before).into_text()
    }

    fn entity(&mut self, entity: Entity) {
        entity.write(&mut self.sheet);
    }

    /// What layers of light call a thing, where the film asks for some: pbrt has no such word.
    fn name(&mut self, entity: &mut Entity, name: Option<&str>) {
        if let Some(name) = name.filter(|_| self.names_count()) {
            entity.string("name", &printable(name));
        }
    }

    fn names_count(&self) -> bool {
        !self.draft.desc.film.parts.layers.is_empty()
    }

    fn open(&mut self) {
        self.sheet.line("AttributeBegin");
        self.sheet.indent();
    }

    fn close(&mut self) {
        self.sheet.outdent();
        self.sheet.line("AttributeEnd");
    }

    fn medium_name(&self, id: Option<MediumId>) -> String {
        quoted(id.and_then(|id| self.media.get(id.0 as usize)).map_or("", |name| name))
    }

    fn material_name(&self, id: MaterialId) -> &str {
        self.materials.get(id.0 as usize).map_or("", |name| name)
    }

    fn interface(&mut self, inside: Option<MediumId>, outside: Option<MediumId>) {
        let (inside, outside) = (self.medium_name(inside), self.medium_name(outside));
        self.sheet.line(&format!("MediumInterface {inside} {outside}"));
    }

    /// A placement from where things are anyway.
    fn place(&mut self, to_world: DMat4) {
        match Place::of(to_world) {
            Place::Identity => {}
            Place::Steps { scale, translation } => {
                if let Some(t) = translation {
                    self.sheet.line(&format!("Translate {}", doubles(&t.to_array())));
                }
                if let Some(s) = scale {
                    self.sheet.line(&format!("Scale {}", doubles(&s.to_array())));
                }
            }
            Place::Matrix(m) => self.matrix(m),
        }
    }

    fn matrix(&mut self, m: DMat4) {
        let columns = m.to_cols_array_2d().map(|column| doubles(&column));
        self.sheet.line(&format!("Transform [ {} ]", columns.join("  ")));
    }

    fn lacks(&mut self, span: Span, what: &str) {
        self.draft.lacks(span, what);
    }
}
