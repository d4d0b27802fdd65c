//! Textures: pictures and checkerboards of squares.
//!
//! Mitsuba's checkerboard has its colours the other way round where it is asked for one number: it is written for what it is
//! asked for, twice where it is asked for both.

use super::Pen;
use super::element::Element;
use super::matrix;
use crate::desc::{Board, Encoding, ImageDesc, MappingDesc, Span, Spanned, TextureId, TextureKind, Varying, WrapKind};
use crate::mitsuba::Answer;

impl Pen<'_, '_> {
    /// A texture where it is used first, and a reference where it is used again.
    pub(super) fn texture(&mut self, name: &str, id: TextureId, answer: Answer) -> Option<Element> {
        let desc = self.draft.desc;
        let texture = desc.texture(id)?;
        // Only a checkerboard answers both ways.
        let answer = if matches!(texture.kind, TextureKind::Checkerboard { .. }) { answer } else { Answer::Colour };
        let mut own_name = self.textures.get(id.0 as usize)?.clone();
        for (written, asked, id_there) in &self.textures_written {
            if (*written, *asked) == (id, answer) {
                return Some(Element::new("ref").with("name", name).with("id", id_there));
            }
        }
        if self.textures_written.iter().any(|(written, ..)| *written == id) {
            own_name = self.names.unique(Some(&own_name), "texture");
        }
        let what = match &texture.kind {
            TextureKind::Image(image) => {
                let element = Element::plugin("texture", "bitmap").with("name", name).with("id", &own_name);
                self.textures_written.push((id, answer, own_name));
                return Some(self.bitmap(element, image, texture.span));
            }
            TextureKind::Checkerboard { of, board: Board::Squares(mapping) } => {
                let element = Element::plugin("texture", "checkerboard").with("name", name).with("id", &own_name);
                self.textures_written.push((id, answer, own_name));
                return Some(self.checkerboard(element, of, mapping, answer, texture.span));
            }
            TextureKind::Checkerboard { board: Board::Cubes { .. }, .. } => "a checkerboard of cubes",
            TextureKind::Attribute { of_faces, scale } => {
                let mut element = Element::plugin("texture", "mesh_attribute").with("name", name).with("id", &own_name);
                element.string("name", if *of_faces { "face_color" } else { "vertex_color" });
                element.float_unless("scale", *scale, 1.0);
                self.textures_written.push((id, answer, own_name));
                return Some(element);
            }
            TextureKind::Plain(inner) => return self.answering(name, inner, answer),
            TextureKind::Scale(_) => "the texture \"scale\"",
            TextureKind::Mix { .. } => "the texture \"mix\"",
            TextureKind::DirectionMix { .. } => "the texture \"directionmix\"",
            TextureKind::Bilinear { .. } => "the texture \"bilerp\"",
            TextureKind::Dots { .. } => "the texture \"dots\"",
            TextureKind::Fbm(_) => "the texture \"fbm\"",
            TextureKind::Wrinkled(_) => "the texture \"wrinkled\"",
            TextureKind::Windy { .. } => "the texture \"windy\"",
            TextureKind::Marble { .. } => "the texture \"marble\"",
        };
        self.lacks(texture.span, what);
        None
    }

    fn checkerboard(
        &mut self,
        mut element: Element,
        of: &[Spanned<Varying>; 2],
        mapping: &MappingDesc,
        answer: Answer,
        span: Span,
    ) -> Element {
        let [first, second] = of;
        let colours = if answer == Answer::Number { [second, first] } else { [first, second] };
        for ((name, default), value) in [("color0", 0.4), ("color1", 0.2)].into_iter().zip(colours) {
            if value.value.number() != Some(default) {
                element.extend(self.answering(name, value, answer));
            }
        }
        // Its fields are half a unit wide.
        if let Some([s, t]) = self.uv_rows(mapping, span) {
            element.extend(to_uv([s.map(|v| 0.5 * v), t.map(|v| 0.5 * v)]));
        }
        element
    }

    fn bitmap(&mut self, mut element: Element, image: &ImageDesc, span: Span) -> Element {
        let file = self.draft.relative(&image.path.value, image.path.span);
        element.string("filename", &file);
        if !image.smooth {
            element.string("filter_type", "nearest");
        }
        match image.wrap {
            WrapKind::Repeat => {}
            WrapKind::Mirror => element.string("wrap_mode", "mirror"),
            WrapKind::Clamp => element.string("wrap_mode", "clamp"),
            WrapKind::Black => self.lacks(span, "a picture that is black beyond its edges"),
        }
        match image.encoding {
            Encoding::Srgb => {}
            Encoding::Linear => element.boolean("raw", true),
            Encoding::Gamma(_) => self.lacks(span, "a picture encoded by a power"),
        }
        if image.scale != 1.0 || image.invert {
            self.lacks(span, "a picture that is scaled or inverted");
        }
        // Its v runs downwards.
        if let Some([s, [a, b, c]]) = self.uv_rows(&image.mapping, span) {
            element.extend(to_uv([s, [-a, -b, 1.0 - c]]));
        }
        element
    }

    fn uv_rows(&mut self, mapping: &MappingDesc, span: Span) -> Option<[[f64; 3]; 2]> {
        if let MappingDesc::Uv(rows) = mapping {
            return Some(*rows);
        }
        self.lacks(span, "texture coordinates that are not those of the surface");
        None
    }
}

/// What is done to u and v, if anything is.
fn to_uv([[a, b, c], [d, e, f]]: [[f64; 3]; 2]) -> Option<Element> {
    let mut transform = Element::new("transform").with("name", "to_uv");
    if b != 0.0 || d != 0.0 {
        let rows = [[a, b, 0.0, c], [d, e, 0.0, f], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
        transform.push(matrix(glam::DMat4::from_cols_array_2d(&rows).transpose()));
        return Some(transform);
    }
    if (a, e) != (1.0, 1.0) {
        transform.push(Element::new("scale").number("x", a).number("y", e));
    }
    if (c, f) != (0.0, 0.0) {
        transform.push(Element::new("translate").number("x", c).number("y", f));
    }
    let is_something = (a, e, c, f) != (1.0, 1.0, 0.0, 0.0);
    is_something.then_some(transform)
}
