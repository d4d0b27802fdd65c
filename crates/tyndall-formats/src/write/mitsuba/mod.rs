//! Scenes in Mitsuba 3's language.
//!
//! Integrator and sensor first, then media and materials by their ids, then emitters, groups, instances and shapes. What has no
//! name and is used once stands where it is used.

mod bsdf;
mod element;
mod emitter;
mod medium;
mod sensor;
mod shape;
mod spectrum;
mod texture;

use glam::{DMat4, DVec3};

use super::Draft;
use super::names::{Names, printable};
use super::place::{Look, Place, width};
use crate::desc::{MaterialId, MediumId, Span, TextureId};
use crate::mitsuba::{Answer, look_at};
use element::Element;

/// Lines of comment, in front of the scene.
pub(super) fn commented(lines: &[String]) -> String {
    // Two dashes would end the comment.
    let lines: Vec<_> = lines.iter().map(|line| printable(line).replace("--", "- -")).collect();
    format!("<!-- {} -->\n", lines.join("\n     "))
}

/// The scene without its header.
pub(super) fn scene(draft: &mut Draft<'_>) -> String {
    let desc = draft.desc;
    let mut names = Names::default();
    let media = desc.media.iter().map(|m| names.unique(m.name.as_deref(), "medium")).collect();
    let materials = desc.materials.iter().map(|m| names.unique(m.name.as_deref(), bsdf::word(&m.kind))).collect();
    let groups = desc.groups.iter().map(|group| names.unique(Some(&group.name), "group")).collect();
    let textures = desc.textures.iter().map(|t| names.unique(t.name.as_deref(), "texture")).collect();
    let mut pen = Pen { draft, names, media, materials, textures, groups, textures_written: Vec::new() };

    let mut scene = Element::new("scene").with("version", "3.0.0");
    scene.push(pen.integrator());
    let (sensor, meter) = pen.sensor();
    scene.extend(sensor);
    let media: Vec<_> = desc.media.iter().enumerate().map(|(i, medium)| pen.medium(i, medium)).collect();
    let materials = pen.all_bsdfs();
    let lights: Vec<_> = desc.lights.iter().filter_map(|light| pen.light(light)).collect();
    let shapes = pen.shapes(meter);
    for part in [media, materials, lights, shapes] {
        scene.gap();
        scene.extend(part);
    }
    scene.into_text()
}

/// A writer with the names that things have.
struct Pen<'a, 'b> {
    draft: &'a mut Draft<'b>,
    names: Names,
    media: Vec<String>,
    materials: Vec<String>,
    textures: Vec<String>,
    groups: Vec<String>,
    /// Textures that stand somewhere already, by their names: they are referred to from then on.
    textures_written: Vec<(TextureId, Answer, String)>,
}

impl Pen<'_, '_> {
    fn lacks(&mut self, span: Span, what: &str) {
        self.draft.lacks(span, what);
    }

    /// The `id` of a shape or a light that has a name. No two things have the same.
    fn called(&mut self, element: Element, name: Option<&str>, span: Span) -> Element {
        let Some(name) = name else { return element };
        let id = self.names.unique(Some(name), "thing");
        if id != name && !self.draft.desc.film.parts.layers.is_empty() {
            let message = format!("no two things have one id in Mitsuba: \"{name}\" is called \"{id}\" there");
            self.draft.differs(span, &message);
        }
        element.with("id", &id)
    }

    fn medium_ref(&self, id: MediumId) -> Element {
        Element::new("ref").with("id", self.media.get(id.0 as usize).map_or("", |name| name))
    }

    fn material_ref(&self, id: MaterialId) -> Element {
        Element::new("ref").with("id", self.materials.get(id.0 as usize).map_or("", |name| name))
    }
}

/// A placement, if it is not where things are anyway.
fn placed(to_world: DMat4) -> Option<Element> {
    let mut transform = Element::new("transform").with("name", "to_world");
    match Place::of(to_world) {
        Place::Identity => return None,
        Place::Steps { scale, translation } => {
            if let Some(s) = scale {
                let uniform = s.x == s.y && s.y == s.z;
                let scale = Element::new("scale");
                transform.push(if uniform { scale.number("value", s.x) } else { axes(scale, s, 1.0) });
            }
            if let Some(t) = translation {
                transform.push(axes(Element::new("translate"), t, 0.0));
            }
        }
        Place::Matrix(m) => transform.extend(turned(m).unwrap_or_else(|| vec![matrix(m)])),
    }
    Some(transform)
}

/// `x`, `y` and `z`, where they are not what is taken anyway.
fn axes(element: Element, v: DVec3, default: f64) -> Element {
    ["x", "y", "z"]
        .into_iter()
        .zip(v.to_array())
        .fold(element, |element, (name, v)| if v == default { element } else { element.number(name, v) })
}

/// A view in words, mirrored and scaled first if it is.
fn turned(m: DMat4) -> Option<Vec<Element>> {
    let width = width(m);
    let scale = DVec3::new(if m.determinant() < 0.0 { -width } else { width }, width, 1.0);
    let made = |l: Look| Some(look_at(l.eye, l.target, l.up)? * DMat4::from_scale(scale));
    let look = Look::at(m, made)?;
    let mut element = Element::new("lookat");
    for (name, v) in [("origin", look.eye), ("target", look.target), ("up", look.up)] {
        element = element.numbers(name, &v.to_array());
    }
    let scale = (scale != DVec3::ONE).then(|| axes(Element::new("scale"), scale, 1.0));
    Some(scale.into_iter().chain([element]).collect())
}

fn matrix(m: DMat4) -> Element {
    Element::new("matrix").text("value", &m.transpose().to_cols_array().map(super::number::double).join(" "))
}
