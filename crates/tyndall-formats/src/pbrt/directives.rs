//! What each directive does.

use std::borrow::Cow;
use std::rc::Rc;

use glam::{DMat4, DVec3};

use super::Reader;
use super::color_space::ColorSpace;
use super::param::Param;
use super::params::{MAX_PARAMS, Params, quote};
use super::parser::Statement;
use super::state::{Block, look_at};
use crate::desc::{GroupDesc, GroupId, Ignored, InstanceDesc, MediumId, MediumInterface};
use crate::error::SceneError;
use crate::source::{Span, Spanned};

/// Directives that belong before `WorldBegin`.
const BEFORE_WORLD: [&str; 8] =
    ["Accelerator", "Camera", "Film", "Integrator", "Option", "PixelFilter", "Sampler", "TransformTimes"];

/// Directives that belong after it.
const IN_WORLD: [&str; 17] = [
    "AreaLightSource",
    "Attribute",
    "AttributeBegin",
    "AttributeEnd",
    "Import",
    "LightSource",
    "MakeNamedMaterial",
    "Material",
    "NamedMaterial",
    "ObjectBegin",
    "ObjectEnd",
    "ObjectInstance",
    "ReverseOrientation",
    "Shape",
    "Texture",
    "TransformBegin",
    "TransformEnd",
];

impl Reader {
    /// Carries out one statement.
    pub(super) fn execute(&mut self, s: Statement<'_>) {
        if let Some(error) = self.misplaced(&s) {
            self.errors.push(error);
            // The block is entered all the same, so that its end is no error of its own.
        }
        match s.word {
            "Accelerator" => self.ignore(s.whole, "tyndall builds its own bounding volume hierarchy"),
            "ActiveTransform" => self.active_transform(&s),
            "AreaLightSource" => self.area_light(s),
            "Attribute" => self.attribute(s),
            "AttributeBegin" | "TransformBegin" => self.begin(Block::Attribute, s.span),
            "AttributeEnd" | "TransformEnd" => self.end(Block::Attribute, s.span),
            "Camera" => self.camera(s),
            "ColorSpace" => self.color_space(&s),
            "CoordSysTransform" => self.checked(|r| r.state.recall(&s.names[0])),
            "CoordinateSystem" => self.state.name(&s.names[0].value, self.state.now.ctm),
            "Film" => self.film(s),
            "Import" => self.import(&s.names[0].value, s.whole),
            "Include" => self.include(&s.names[0].value, s.whole),
            "Integrator" => self.integrator(s),
            "LightSource" => self.light(s),
            "MakeNamedMaterial" => self.named_material(s),
            "MakeNamedMedium" => self.named_medium(s),
            "Material" => self.material(s),
            "MediumInterface" => self.medium_interface(&s),
            "NamedMaterial" => self.use_material(&s.names[0]),
            "ObjectBegin" => self.begin_object(&s),
            "ObjectEnd" => self.end_object(s.span),
            "ObjectInstance" => self.instance(&s),
            "Option" => self.option(&s),
            "PixelFilter" => self.filter(s),
            "ReverseOrientation" => self.state.now.reverse_orientation ^= true,
            "Sampler" => self.sampler(s),
            "Shape" => self.shape(s),
            "Texture" => self.texture(s),
            "TransformTimes" => self.ignore(s.whole, "nothing moves"),
            "WorldBegin" => self.world_begin(s.span),
            _ => self.transform(&s),
        }
    }

    /// A directive on the wrong side of `WorldBegin`.
    fn misplaced(&self, s: &Statement<'_>) -> Option<SceneError> {
        let error = |side| SceneError::at(s.span, format!("{} belongs {side} WorldBegin", s.word));
        match self.settings.world {
            None if IN_WORLD.contains(&s.word) => Some(error("after").help("move it, or add WorldBegin before it")),
            Some(world) if BEFORE_WORLD.contains(&s.word) => {
                Some(error("before").help("move it up").related(world, "the world begins here"))
            }
            _ => None,
        }
    }

    fn transform(&mut self, s: &Statement<'_>) {
        if self.state.now.at_end_only {
            return self.ignore(s.whole, "nothing moves: things stand where they are at the start time");
        }
        let n = &s.numbers;
        let vec = |at: usize| DVec3::new(n[at], n[at + 1], n[at + 2]);
        // The file lists a matrix column by column.
        let matrix = || DMat4::from_cols_slice(n);
        match s.word {
            "ConcatTransform" => self.checked(|r| r.state.concat(matrix(), matrix().inverse(), s.whole)),
            "Identity" => (self.state.now.ctm, self.state.now.inverse) = (DMat4::IDENTITY, DMat4::IDENTITY),
            "LookAt" => match look_at(vec(0), vec(3), vec(6)) {
                Some(inverse) => self.checked(|r| r.state.concat(inverse.inverse(), inverse, s.whole)),
                None => self.errors.push(
                    SceneError::at(s.whole, "this LookAt has no direction")
                        .help("eye and target must differ, and up must not point along the view"),
                ),
            },
            "Rotate" => match vec(1).try_normalize() {
                Some(axis) => {
                    let rotation = DMat4::from_axis_angle(axis, n[0].to_radians());
                    self.checked(|r| r.state.concat(rotation, rotation.transpose(), s.whole));
                }
                None => self.errors.push(
                    SceneError::at(s.whole, "this axis of rotation has no direction")
                        .help("Rotate takes an angle in degrees and then an axis: Rotate 90 0 1 0"),
                ),
            },
            "Scale" => {
                let [scale, inverse] = [vec(0), vec(0).recip()].map(DMat4::from_scale);
                self.checked(|r| r.state.concat(scale, inverse, s.whole));
            }
            "Transform" => self.checked(|r| r.state.set(matrix(), matrix().inverse(), s.whole)),
            "Translate" => {
                let [there, back] = [vec(0), -vec(0)].map(DMat4::from_translation);
                self.checked(|r| r.state.concat(there, back, s.whole));
            }
            other => self.errors.push(SceneError::not_yet(s.span, format!("\"{other}\" is not supported yet"))),
        }
    }

    fn active_transform(&mut self, s: &Statement<'_>) {
        match &*s.names[0].value {
            word @ ("All" | "StartTime" | "EndTime") => {
                self.state.now.at_end_only = word == "EndTime";
                self.ignore(s.whole, "nothing moves: things stand where they are at the start time");
            }
            word => {
                let error = SceneError::at(s.names[0].span, format!("ActiveTransform knows no {}", quote(word)));
                self.errors.push(error.suggest(word, ["All", "StartTime", "EndTime"]));
            }
        }
    }

    fn color_space(&mut self, s: &Statement<'_>) {
        let word = &*s.names[0].value;
        if let Some((_, space)) = ColorSpace::NAMES.into_iter().find(|(name, _)| *name == word) {
            self.state.now.color_space = space;
        } else {
            let message = format!("there is no colour space {}", quote(word));
            let known = ColorSpace::NAMES.map(|(name, _)| name);
            self.errors.push(SceneError::at(s.names[0].span, message).suggest(word, known));
        }
    }

    fn world_begin(&mut self, span: Span) {
        if let Some(first) = self.settings.world {
            let error = SceneError::at(span, "the world begins twice").help("leave out the second WorldBegin");
            return self.errors.push(error.related(first, "first here"));
        }
        self.settings.world = Some(span);
        (self.state.now.ctm, self.state.now.inverse) = (DMat4::IDENTITY, DMat4::IDENTITY);
        self.state.name("world", DMat4::IDENTITY);
    }

    /// Parameters for everything of a kind that comes later in the scope.
    fn attribute(&mut self, s: Statement<'_>) {
        let target = &s.names[0];
        let defaults = &mut self.state.now.defaults;
        let list = match &*target.value {
            "shape" => &mut defaults.shape,
            "light" => &mut defaults.light,
            "material" => &mut defaults.material,
            "medium" => &mut defaults.medium,
            "texture" => &mut defaults.texture,
            word => {
                let error = SceneError::at(target.span, format!("Attribute knows no {}", quote(word)));
                return self.errors.push(error.suggest(word, ["shape", "light", "material", "medium", "texture"]));
            }
        };
        let list = Rc::make_mut(list);
        list.extend(s.params.into_iter().map(Param::inherit));
        if list.len() > MAX_PARAMS {
            list.truncate(MAX_PARAMS);
            let message = format!("Attribute has set more than {MAX_PARAMS} parameters");
            self.errors.push(
                SceneError::at(s.whole, message).help("set them in a scope, between AttributeBegin and AttributeEnd"),
            );
        }
    }

    fn begin(&mut self, block: Block, span: Span) {
        self.checked(|r| r.state.push(block, span));
    }

    fn end(&mut self, block: Block, span: Span) {
        self.checked(|r| r.state.pop(block, span));
    }

    fn begin_object(&mut self, s: &Statement<'_>) {
        self.begin(Block::Object, s.span);
        let name = &s.names[0].value;
        if let Some((_, first)) = self.group {
            let error = SceneError::at(s.whole, "an object inside of an object").help("end the first one before");
            return self.errors.push(error.related(first, "this one is being defined"));
        }
        let group = GroupDesc { span: s.whole, name: name.to_string(), shapes: Vec::new() };
        if let Some(id) = self.errors.ok(self.groups.define(name, s.whole, group)) {
            self.group = Some((id, s.whole));
        }
    }

    fn end_object(&mut self, span: Span) {
        self.group = None;
        self.end(Block::Object, span);
    }

    fn instance(&mut self, s: &Statement<'_>) {
        if let Some((_, first)) = self.group {
            let error = SceneError::at(s.whole, "an instance inside of an object is not supported")
                .help("place the instance after ObjectEnd, as pbrt-v4 asks for");
            return self.errors.push(error.related(first, "this object is being defined"));
        }
        let name = &s.names[0];
        let group = Spanned::new(GroupId(self.groups.refer(&name.value, name.span)), name.span);
        self.instances.push(InstanceDesc { span: s.whole, group, to_world: self.state.now.ctm });
    }

    /// One name stands for both sides; an empty name is empty space.
    fn medium_interface(&mut self, s: &Statement<'_>) {
        let inside = self.medium_of(&s.names[0]);
        let outside = self.medium_of(s.names.last().unwrap_or(&s.names[0]));
        self.state.now.interface = Some(MediumInterface { span: s.whole, inside, outside });
    }

    fn medium_of(&mut self, name: &Spanned<Cow<'_, str>>) -> Option<MediumId> {
        (!name.value.is_empty()).then(|| MediumId(self.media.refer(&name.value, name.span)))
    }

    /// Opens the parameters of an entity. `what` is its directive in words: `shape "sphere"`.
    pub(super) fn params(&self, what: &str, s: &mut Statement<'_>, defaults: &[Param]) -> Params {
        let name = &s.names[0];
        let owner = format!("{what} {}", quote(&name.value));
        Params::new(owner, name.span, std::mem::take(&mut s.params), defaults, &self.dir)
            .in_space(self.state.now.color_space)
    }

    /// Closes them.
    pub(super) fn finish_params(&mut self, params: Params) {
        params.finish(&mut self.errors, &mut self.ignored);
    }

    /// Reports the fault of what `act` does.
    pub(super) fn checked(&mut self, act: impl FnOnce(&mut Self) -> Result<(), SceneError>) {
        if let Err(error) = act(self) {
            self.errors.push(error);
        }
    }

    /// Notes words that change nothing here.
    pub(super) fn ignore(&mut self, span: Span, reason: &'static str) {
        self.ignored.push(Ignored { span, reason });
    }

    /// Reports a kind of thing that this reader does not know: those of `later` are pbrt's.
    pub(super) fn unknown_kind(&mut self, what: &str, name: &Spanned<Cow<'_, str>>, known: &[&str], later: &[&str]) {
        let word = &*name.value;
        let list = known.iter().map(|k| quote(k)).collect::<Vec<_>>().join(", ");
        let error = if later.contains(&word) {
            SceneError::not_yet(name.span, format!("the {what} {} is not supported yet", quote(word)))
                .help(format!("supported are {list}"))
        } else {
            let error = SceneError::at(name.span, format!("there is no {what} {}", quote(word)));
            match crate::error::nearest(word, known.iter().chain(later).copied()) {
                Some(near) => error.help(format!("did you mean \"{near}\"?")),
                None => error.help(format!("supported are {list}")),
            }
        };
        self.errors.push(error);
    }
}
