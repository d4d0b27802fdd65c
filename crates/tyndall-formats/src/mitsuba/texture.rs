//! `<texture>`: `bitmap`, `checkerboard` and `mesh_attribute`, and where a texture may stand for a number or a colour.
//!
//! Mitsuba's v runs downwards on a bitmap; ours runs upwards, so the mapping turns it round.
//!
//! Mitsuba's checkerboard (3.9 at least) has its colours the other way round where it is asked for one number (a
//! roughness, a weight, an opacity) instead of a colour: what a file shows there is what it shows here, so the reader
//! asks for one or the other.

use glam::DMat4;

use super::object::{Measure, Object};
use super::scene::Builder;
use super::tree::Element;
use super::words;
use crate::desc::{Board, Encoding, ImageDesc, MappingDesc, TextureDesc, TextureId, TextureKind, Varying, WrapKind};
use crate::error::SceneError;
use crate::source::Spanned;

/// The deepest nesting of textures in textures.
const MAX_DEPTH: u32 = 32;

/// What a texture is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Answer {
    /// A colour.
    Colour,
    /// One number.
    Number,
}

impl Answer {
    fn other(self) -> Self {
        match self {
            Self::Colour => Self::Number,
            Self::Number => Self::Colour,
        }
    }
}

impl<'t> Builder<'t> {
    /// A number, a colour or a texture of this name, which is asked for its colour.
    pub(super) fn varying(
        &mut self,
        object: &mut Object<'t>,
        name: &'static str,
        measure: Measure,
    ) -> Option<Spanned<Varying>> {
        self.answering(object, name, measure, Answer::Colour)
    }

    /// The same where one number is asked for.
    pub(super) fn varying_number(
        &mut self,
        object: &mut Object<'t>,
        name: &'static str,
        measure: Measure,
    ) -> Option<Spanned<Varying>> {
        self.answering(object, name, measure, Answer::Number)
    }

    fn answering(
        &mut self,
        object: &mut Object<'t>,
        name: &'static str,
        measure: Measure,
        answer: Answer,
    ) -> Option<Spanned<Varying>> {
        match object.object_of(name, "texture") {
            Some(child) => {
                let id = self.texture(child.element, answer)?;
                Some(Spanned::new(Varying::Texture(id), child.at.span))
            }
            None => object.spectrum(name, measure, &mut self.report).map(|found| found.map(Varying::Everywhere)),
        }
    }

    /// As [`Builder::varying`], or else a constant.
    pub(super) fn varying_or(
        &mut self,
        object: &mut Object<'t>,
        name: &'static str,
        measure: Measure,
        default: f64,
    ) -> Spanned<Varying> {
        let found = self.varying(object, name, measure);
        found.unwrap_or(Spanned::new(Varying::constant(default), object.element.span))
    }

    /// As [`Builder::varying_number`], or else a constant.
    pub(super) fn number_or(
        &mut self,
        object: &mut Object<'t>,
        name: &'static str,
        measure: Measure,
        default: f64,
    ) -> Spanned<Varying> {
        let found = self.varying_number(object, name, measure);
        found.unwrap_or(Spanned::new(Varying::constant(default), object.element.span))
    }

    /// The texture of an element, built once for each answer that makes a difference.
    pub(super) fn texture(&mut self, element: &'t Element, answer: Answer) -> Option<TextureId> {
        let answer = if element.text("type") == "checkerboard" { answer } else { Answer::Colour };
        if let Some(&built) = self.built_textures.get(&(element.span, answer)) {
            return built;
        }
        if let Some(None) = self.built_textures.get(&(element.span, answer.other())) {
            return None; // its faults are told
        }
        // A texture that contains itself finds nothing here, and is reported where it is nested too deep.
        self.built_textures.insert((element.span, answer), None);
        self.texture_depth += 1;
        let kind = if self.texture_depth > MAX_DEPTH {
            let message = format!("textures are nested more than {MAX_DEPTH} deep");
            self.report.errors.push(SceneError::at(element.span, message));
            None
        } else {
            self.texture_kind(element, answer)
        };
        self.texture_depth -= 1;
        let id = kind.map(|kind| {
            let name = element.id();
            self.textures.push(TextureDesc { span: element.span, name, kind });
            TextureId(self.textures.len() as u32 - 1)
        });
        self.built_textures.insert((element.span, answer), id);
        id
    }

    /// A texture that nothing may refer to: whether it is right, and that it is there.
    pub(super) fn unless_built(&mut self, element: &'t Element) {
        if !self.built_textures.contains_key(&(element.span, Answer::Number)) {
            self.texture(element, Answer::Colour);
        }
    }

    fn texture_kind(&mut self, element: &'t Element, answer: Answer) -> Option<TextureKind> {
        let plugin = words::plugin(element, &mut self.report)?;
        let mut object = self.object(element);
        if plugin == "mesh_attribute" {
            let kind = self.attribute(&mut object);
            object.finish(&mut self.report);
            return kind;
        }
        let to_uv = object.named_transform("to_uv", &mut self.report);
        let kind = if plugin == "bitmap" {
            self.bitmap(&mut object, to_uv).map(TextureKind::Image)
        } else {
            let mut of = [("color0", 0.4), ("color1", 0.2)].map(|(name, default)| {
                let found = self.answering(&mut object, name, Measure::Part, answer);
                found.unwrap_or(Spanned::new(Varying::constant(default), element.span))
            });
            if answer == Answer::Number {
                of.reverse();
            }
            // Its fields are half a unit wide.
            let [s, t] = rows(to_uv).map(|row| row.map(|v| 2.0 * v));
            Some(TextureKind::Checkerboard { of, board: Board::Squares(MappingDesc::Uv([s, t])) })
        };
        object.finish(&mut self.report);
        kind
    }

    /// Colours of the mesh itself, by their name.
    fn attribute(&mut self, object: &mut Object<'t>) -> Option<TextureKind> {
        let scale = object.float("scale", |_| true, "", &mut self.report).map_or(1.0, |scale| scale.value);
        let name = object.string("name", &mut self.report);
        let error = match &name {
            Some(name) if name.value == "vertex_color" => {
                return Some(TextureKind::Attribute { of_faces: false, scale });
            }
            Some(name) if name.value == "face_color" => return Some(TextureKind::Attribute { of_faces: true, scale }),
            Some(name) => {
                let message = format!("the attribute \"{}\" of meshes is not known yet", name.value);
                SceneError::not_yet(name.span, message).help("known are \"vertex_color\" and \"face_color\"")
            }
            None => SceneError::at(object.element.span, "the texture \"mesh_attribute\" lacks a \"name\""),
        };
        self.report.errors.push(error);
        None
    }

    fn bitmap(&mut self, object: &mut Object<'t>, to_uv: DMat4) -> Option<ImageDesc> {
        let report = &mut self.report;
        let smooth = object.choice("filter_type", &[("bilinear", true), ("nearest", false)], report);
        let wraps = [("repeat", WrapKind::Repeat), ("mirror", WrapKind::Mirror), ("clamp", WrapKind::Clamp)];
        let wrap = object.choice("wrap_mode", &wraps, report);
        let raw = object.flag("raw", false, report);
        object.ignore(&["format", "accel"], "pictures are kept in single precision", report);
        let Some(name) = object.string("filename", report) else {
            let error = SceneError::at(object.element.span, "the texture \"bitmap\" lacks a \"filename\"");
            report.errors.push(error);
            return None;
        };
        let [s, [a, b, c]] = rows(to_uv);
        Some(ImageDesc {
            path: self.file(name),
            mapping: MappingDesc::Uv([s, [-a, -b, 1.0 - c]]),
            wrap,
            smooth,
            scale: 1.0,
            invert: false,
            by_luminance: true,
            encoding: if raw { Encoding::Linear } else { Encoding::Srgb },
        })
    }
}

/// The rows that u and v see of a transform in space: what it does to the xy plane.
fn rows(m: DMat4) -> [[f64; 3]; 2] {
    [[m.x_axis.x, m.y_axis.x, m.w_axis.x], [m.x_axis.y, m.y_axis.y, m.w_axis.y]]
}
