//! Textures. pbrt has two kinds of each, of numbers and of colours: those are written that something refers to.

use std::collections::BTreeMap;

use glam::DMat4;

use super::Pen;
use super::entity::Entity;
use crate::desc::{
    Board, Encoding, ImageDesc, MappingDesc, NoiseDesc, SceneDesc, Span, Spanned, TextureDesc, TextureId, TextureKind,
    Varying, WrapKind,
};
use crate::write::names::Names;
use crate::write::place::inverse_of;

/// What a texture holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Texels {
    /// pbrt's "float".
    Numbers,
    /// pbrt's "spectrum".
    Colours,
}

/// The textures that something refers to, with their names.
#[derive(Default)]
pub(super) struct Textures {
    wanted: BTreeMap<(TextureId, Texels), String>,
    names: Names,
}

impl Textures {
    /// The name of a texture, which is wanted from now on.
    pub(super) fn name(&mut self, desc: &SceneDesc, id: TextureId, texels: Texels) -> String {
        if let Some(name) = self.wanted.get(&(id, texels)) {
            return name.clone();
        }
        let given = desc.texture(id).and_then(|texture| texture.name.as_deref());
        let other = if texels == Texels::Numbers { Texels::Colours } else { Texels::Numbers };
        // The two kinds have names of their own.
        let name = match self.wanted.get(&(id, other)) {
            Some(name) => name.clone(),
            None => self.names.unique(given, "texture"),
        };
        self.wanted.insert((id, texels), name.clone());
        name
    }

    /// The last wanted texture before `end`.
    fn last_before(&self, end: (TextureId, Texels)) -> Option<((TextureId, Texels), String)> {
        self.wanted.range(..end).next_back().map(|(key, name)| (*key, name.clone()))
    }
}

impl Pen<'_, '_> {
    /// All that are wanted, and their parts, which come before them.
    pub(super) fn all_textures(&mut self) -> String {
        let desc = self.draft.desc;
        let mut texts = Vec::new();
        let mut end = (TextureId(u32::MAX), Texels::Colours);
        while let Some((key, name)) = self.textures.last_before(end) {
            end = key;
            if let Some(texture) = desc.texture(key.0) {
                texts.push(self.on_a_sheet(|pen| pen.texture(texture, &name, key.1)));
            }
        }
        texts.reverse();
        texts.concat()
    }

    fn texture(&mut self, texture: &TextureDesc, name: &str, texels: Texels) {
        let kind = if texels == Texels::Numbers { "float" } else { "spectrum" };
        let mut space = None;
        let start = |class: &str| Entity::new("Texture", &[name, kind, class]);
        let pair =
            |pen: &mut Self, mut entity: Entity, of: &[Spanned<Varying>; 2], names: [&str; 2], defaults: [f64; 2]| {
                for ((part, name), default) in of.iter().zip(names).zip(defaults) {
                    pen.part(&mut entity, name, part, default, texels);
                }
                entity
            };
        let entity = match &texture.kind {
            TextureKind::Plain(value) => {
                let mut entity = start("constant");
                self.part(&mut entity, "value", value, 1.0, texels);
                entity
            }
            TextureKind::Scale([of, by]) => {
                let mut entity = start("scale");
                self.part(&mut entity, "tex", of, 1.0, texels);
                self.number(&mut entity, "scale", by, 1.0);
                entity
            }
            TextureKind::Mix { of, amount } => {
                let mut entity = pair(self, start("mix"), of, ["tex1", "tex2"], [0.0, 1.0]);
                self.number(&mut entity, "amount", amount, 0.5);
                entity
            }
            TextureKind::DirectionMix { of, dir } => {
                let mut entity = pair(self, start("directionmix"), of, ["tex1", "tex2"], [0.0, 1.0]);
                entity.list("vector3", "dir", dir);
                entity
            }
            TextureKind::Bilinear { corners: [v00, v10, v01, v11], mapping } => {
                let mut entity = start("bilerp");
                let corners = [(v00, "v00", 0.0), (v10, "v10", 0.0), (v01, "v01", 1.0), (v11, "v11", 1.0)];
                for (value, name, default) in corners {
                    self.part(&mut entity, name, value, default, texels);
                }
                space = self.mapping(&mut entity, mapping, texture.span);
                entity
            }
            TextureKind::Checkerboard { of, board } => {
                let mut entity = pair(self, start("checkerboard"), of, ["tex1", "tex2"], [1.0, 0.0]);
                space = match board {
                    Board::Squares(mapping) => self.mapping(&mut entity, mapping, texture.span),
                    Board::Cubes { from_world } => {
                        entity.integer("dimension", 3);
                        Some(*from_world)
                    }
                };
                entity
            }
            TextureKind::Dots { of, mapping } => {
                let mut entity = pair(self, start("dots"), of, ["outside", "inside"], [0.0, 1.0]);
                space = self.mapping(&mut entity, mapping, texture.span);
                entity
            }
            TextureKind::Image(image) => {
                let mut entity = start("imagemap");
                space = self.image(&mut entity, image, texture.span);
                entity
            }
            TextureKind::Attribute { .. } => {
                self.lacks(texture.span, "colours of a mesh itself");
                start("constant")
            }
            TextureKind::Fbm(noise) => turbulence(start("fbm"), noise, &mut space),
            TextureKind::Wrinkled(noise) => turbulence(start("wrinkled"), noise, &mut space),
            TextureKind::Windy { from_world } => {
                space = Some(*from_world);
                start("windy")
            }
            TextureKind::Marble { noise, scale, variation } => {
                let mut entity = turbulence(start("marble"), noise, &mut space);
                entity.float_unless("scale", *scale, 1.0);
                entity.float_unless("variation", *variation, 0.2);
                entity
            }
        };
        self.in_space(space, entity);
    }

    /// A texture that lies in a space of its own.
    fn in_space(&mut self, from_world: Option<DMat4>, entity: Entity) {
        match from_world.filter(|m| *m != DMat4::IDENTITY) {
            None => self.entity(entity),
            Some(from_world) => {
                self.open();
                self.place(inverse_of(from_world));
                self.entity(entity);
                self.close();
            }
        }
    }

    fn part(&mut self, entity: &mut Entity, name: &str, value: &Spanned<Varying>, default: f64, texels: Texels) {
        match texels {
            Texels::Numbers => self.number(entity, name, value, default),
            Texels::Colours => self.colour(entity, name, value, default),
        }
    }

    /// The mapping, and the space that it is in.
    fn mapping(&mut self, entity: &mut Entity, mapping: &MappingDesc, span: Span) -> Option<DMat4> {
        match mapping {
            MappingDesc::Uv([[su, 0.0, du], [0.0, sv, dv]]) => {
                entity.float_unless("uscale", *su, 1.0);
                entity.float_unless("vscale", *sv, 1.0);
                entity.float_unless("udelta", *du, 0.0);
                entity.float_unless("vdelta", *dv, 0.0);
                None
            }
            MappingDesc::Uv(_) => {
                self.lacks(span, "texture coordinates that are turned");
                None
            }
            MappingDesc::Spherical { from_world } => {
                entity.string("mapping", "spherical");
                Some(*from_world)
            }
            MappingDesc::Cylindrical { from_world } => {
                entity.string("mapping", "cylindrical");
                Some(*from_world)
            }
            MappingDesc::Planar { from_world, axes: [v1, v2], offset: [du, dv] } => {
                entity.string("mapping", "planar");
                entity.list("vector3", "v1", v1);
                entity.list("vector3", "v2", v2);
                entity.float_unless("udelta", *du, 0.0);
                entity.float_unless("vdelta", *dv, 0.0);
                Some(*from_world)
            }
        }
    }

    fn image(&mut self, entity: &mut Entity, image: &ImageDesc, span: Span) -> Option<DMat4> {
        let file = self.draft.relative(&image.path.value, image.path.span);
        entity.string("filename", &file);
        let space = self.mapping(entity, &image.mapping, span);
        match image.wrap {
            WrapKind::Repeat => {}
            WrapKind::Clamp => entity.string("wrap", "clamp"),
            WrapKind::Black => entity.string("wrap", "black"),
            WrapKind::Mirror => self.lacks(span, "a picture that is mirrored at its edges"),
        }
        if !image.smooth {
            entity.string("filter", "point");
        }
        entity.float_unless("scale", image.scale, 1.0);
        if image.invert {
            entity.boolean("invert", true);
        }
        let coded = image.path.value.extension().is_some_and(|e| e.eq_ignore_ascii_case("png"));
        match image.encoding {
            Encoding::Srgb if !coded => entity.string("encoding", "sRGB"),
            Encoding::Linear if coded => entity.string("encoding", "linear"),
            Encoding::Srgb | Encoding::Linear => {}
            Encoding::Gamma(gamma) => entity.string("encoding", &format!("gamma {gamma}")),
        }
        space
    }
}

fn turbulence(mut entity: Entity, noise: &NoiseDesc, space: &mut Option<DMat4>) -> Entity {
    if noise.octaves != 8 {
        entity.integer("octaves", noise.octaves.into());
    }
    entity.float_unless("roughness", noise.roughness, 0.5);
    *space = Some(noise.from_world);
    entity
}
