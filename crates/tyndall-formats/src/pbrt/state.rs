//! The graphics state: what the next shape or light takes from the directives before it, and the stack of saved states.

use std::collections::BTreeMap;
use std::rc::Rc;

use glam::{DMat4, DVec3};

use super::color_space::ColorSpace;
use super::param::Param;
use super::params::quote;
use crate::desc::{AreaLightDesc, MaterialId, MediumInterface};
use crate::error::SceneError;
use crate::source::{Span, Spanned};

/// The deepest nesting of attribute blocks.
const MAX_DEPTH: usize = 1_000;

/// What a scope saves and restores.
#[derive(Clone, Debug, Default)]
pub(super) struct Graphics {
    /// Current transformation: object to world, and before `WorldBegin` world to camera.
    pub(super) ctm: DMat4,
    /// Its inverse, made of the inverses of its parts: a camera's `LookAt` is where it says to the last bit.
    pub(super) inverse: DMat4,
    pub(super) reverse_orientation: bool,
    /// `None` until a material is set.
    pub(super) material: Option<Spanned<MaterialId>>,
    pub(super) area_light: Option<Rc<AreaLightDesc>>,
    /// `None` until an interface is set.
    pub(super) interface: Option<MediumInterface>,
    pub(super) defaults: Defaults,
    pub(super) color_space: ColorSpace,
    /// Whether transformations are meant for the end of the exposure only.
    pub(super) at_end_only: bool,
}

/// Parameters set by `Attribute` for what comes later.
#[derive(Clone, Debug, Default)]
pub(super) struct Defaults {
    pub(super) shape: Rc<Vec<Param>>,
    pub(super) light: Rc<Vec<Param>>,
    pub(super) material: Rc<Vec<Param>>,
    pub(super) medium: Rc<Vec<Param>>,
    pub(super) texture: Rc<Vec<Param>>,
}

/// A block that is open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Block {
    Attribute,
    Object,
    Import,
}

/// The current state, those that are saved, and named coordinate systems.
#[derive(Debug, Default)]
pub(super) struct State {
    pub(super) now: Graphics,
    saved: Vec<(Block, Span, Graphics)>,
    coordinate_systems: BTreeMap<String, DMat4>,
}

impl State {
    /// Saves the state.
    ///
    /// # Errors
    /// The nesting is too deep.
    pub(super) fn push(&mut self, block: Block, span: Span) -> Result<(), SceneError> {
        if self.saved.len() >= MAX_DEPTH {
            return Err(SceneError::at(span, format!("blocks are nested more than {MAX_DEPTH} deep"))
                .help("is an AttributeEnd missing?"));
        }
        self.saved.push((block, span, self.now.clone()));
        Ok(())
    }

    /// Restores the state saved last.
    ///
    /// # Errors
    /// No such block is open.
    pub(super) fn pop(&mut self, block: Block, span: Span) -> Result<(), SceneError> {
        let (begin, end) = match block {
            Block::Attribute => ("AttributeBegin", "AttributeEnd"),
            Block::Object => ("ObjectBegin", "ObjectEnd"),
            Block::Import => ("Import", "the imported file ends"),
        };
        match self.saved.last() {
            Some((open, _, _)) if *open == block => {}
            Some((_, opened, _)) => {
                return Err(SceneError::at(span, format!("{end} inside of another block"))
                    .help("end the inner block first")
                    .related(*opened, "this block is open"));
            }
            None => {
                return Err(SceneError::at(span, format!("{end} without {begin}"))
                    .help(format!("leave it out, or add {begin} where the block starts")));
            }
        }
        if let Some((_, _, graphics)) = self.saved.pop() {
            self.now = graphics;
        }
        Ok(())
    }

    /// Blocks that are still open, the innermost last.
    pub(super) fn open_blocks(&self) -> impl Iterator<Item = Span> {
        self.saved.iter().map(|(_, span, _)| *span)
    }

    /// Multiplies the current transformation on the right by a matrix, whose inverse is the second.
    ///
    /// # Errors
    /// The product is singular or not finite; the transformation stays what it was.
    pub(super) fn concat(&mut self, matrix: DMat4, inverse: DMat4, span: Span) -> Result<(), SceneError> {
        self.set(self.now.ctm * matrix, inverse * self.now.inverse, span)
    }

    /// Replaces the current transformation.
    ///
    /// # Errors
    /// It is singular or not finite; the transformation stays what it was.
    pub(super) fn set(&mut self, ctm: DMat4, inverse: DMat4, span: Span) -> Result<(), SceneError> {
        // Scale-free: the determinant of a matrix of nanometres is tiny and yet right.
        let finite = [ctm, inverse, ctm.inverse()].iter().all(DMat4::is_finite);
        if !finite || ctm.determinant() == 0.0 {
            return Err(SceneError::at(span, "this makes a transformation that cannot be undone")
                .help("do not scale by 0; the rows of a matrix must be independent"));
        }
        (self.now.ctm, self.now.inverse) = (ctm, inverse);
        Ok(())
    }

    /// Names a coordinate system.
    pub(super) fn name(&mut self, name: &str, to_world: DMat4) {
        self.coordinate_systems.insert(name.into(), to_world);
    }

    pub(super) fn named_spaces(&self) -> BTreeMap<String, DMat4> {
        self.coordinate_systems.clone()
    }

    pub(super) fn restore_named_spaces(&mut self, named: BTreeMap<String, DMat4>) {
        self.coordinate_systems = named;
    }

    /// Makes a named coordinate system the current transformation.
    ///
    /// # Errors
    /// There is none of this name.
    pub(super) fn recall(&mut self, name: &Spanned<impl AsRef<str>>) -> Result<(), SceneError> {
        let word = name.value.as_ref();
        let Some(&matrix) = self.coordinate_systems.get(word) else {
            let error = SceneError::at(name.span, format!("there is no coordinate system {}", quote(word)));
            return Err(error.suggest(word, self.coordinate_systems.keys().map(|k| &**k)));
        };
        (self.now.ctm, self.now.inverse) = (matrix, matrix.inverse());
        Ok(())
    }
}

/// The inverse of pbrt's `LookAt`: camera to world, for a camera at `eye` that looks along its +z at `target`, +y as near to `up` as can be
/// and +x = up × z. pbrt takes the world for left-handed, so this x points to the right of the image. `None` if the
/// directions do not span a camera.
pub(crate) fn look_at(eye: DVec3, target: DVec3, up: DVec3) -> Option<DMat4> {
    let z = (target - eye).try_normalize()?;
    let x = up.try_normalize()?.cross(z).try_normalize()?;
    let y = z.cross(x);
    Some(DMat4::from_cols(x.extend(0.0), y.extend(0.0), z.extend(0.0), eye.extend(1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The eye maps to the origin, the target to the +z axis at its distance, and a point above to +y.
    #[test]
    fn look_at_puts_the_target_on_the_z_axis_and_up_upwards() {
        let m = look_at(DVec3::new(1.0, 2.0, 3.0), DVec3::new(1.0, 2.0, 13.0), DVec3::Y).unwrap().inverse();
        let near = |a: DVec3, b: DVec3| assert!((a - b).length() < 1e-12, "{a} {b}");
        near(m.transform_point3(DVec3::new(1.0, 2.0, 3.0)), DVec3::ZERO);
        near(m.transform_point3(DVec3::new(1.0, 2.0, 13.0)), DVec3::new(0.0, 0.0, 10.0));
        near(m.transform_vector3(DVec3::Y), DVec3::Y);
        // Looking along +z with y up, pbrt shows the world's +x on the right.
        near(m.transform_vector3(DVec3::X), DVec3::X);
    }

    #[test]
    fn a_camera_that_looks_along_up_is_none() {
        assert_eq!(look_at(DVec3::ZERO, DVec3::Y, DVec3::Y), None);
        assert_eq!(look_at(DVec3::ONE, DVec3::ONE, DVec3::Y), None);
    }
}
