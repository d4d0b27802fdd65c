//! Textures: patterns and pictures, each picture read once.

use std::path::PathBuf;
use std::sync::Arc;

use glam::{Affine2, DMat4, DVec2, DVec3, Vec2, Vec3};
use tyndall::{
    math::Transform,
    texture::{
        Attribute, Grey, ImageTexture, Interpolation, Mapping2, Mapping3, Noise, Picture, Texture, Weight, Wrap,
        noise::Kind,
        pattern::{Checkerboard, Marble},
    },
};

use super::{Builder, spectra::Measure};
use crate::{
    desc::{Board, Encoding, ImageDesc, MappingDesc, NoiseDesc, TextureId, TextureKind, Varying, WrapKind},
    error::SceneError,
    image,
    source::{Span, Spanned},
};

/// The most leaves that one look-up may visit: shared parts can be named again and again.
const MAX_COST: u64 = 4_096;

/// Pictures by file and encoding.
pub(super) type Pictures = Vec<(PathBuf, Encoding, Arc<Picture>)>;

impl Builder<'_> {
    /// A quantity that may vary.
    pub(super) fn texture(&mut self, desc: &Spanned<Varying>, measure: Measure) -> Option<Texture> {
        match &desc.value {
            Varying::Everywhere(spectrum) => {
                self.spectrum(&Spanned::new(spectrum.clone(), desc.span), measure).map(Texture::Constant)
            }
            Varying::Texture(id) => self.named_texture(*id, measure, desc.span),
        }
    }

    /// A texture of the scene, made once for each measure that it is used for.
    fn named_texture(&mut self, id: TextureId, measure: Measure, span: Span) -> Option<Texture> {
        if let Some(made) = self.textures.get(&(id, measure)) {
            return made.clone();
        }
        let scene = self.desc;
        let made = scene.texture(id).and_then(|desc| self.texture_kind(&desc.kind, measure, desc.span));
        let made = match made {
            Some(texture) if texture.cost() > MAX_COST => {
                let message = format!("a look-up of this texture visits more than {MAX_COST} others");
                self.fail(SceneError::at(span, message).help("use fewer textures of textures"))
            }
            made => made,
        };
        self.textures.insert((id, measure), made.clone());
        made
    }

    fn texture_kind(&mut self, kind: &TextureKind, measure: Measure, span: Span) -> Option<Texture> {
        Some(match kind {
            TextureKind::Plain(value) => self.texture(value, measure)?,
            // What is scaled to more than a share is cut where it is used, as in pbrt.
            TextureKind::Scale([of, by]) => {
                Texture::Scale(Arc::new([self.texture(of, measure)?, self.texture(by, Measure::Number)?]))
            }
            TextureKind::Mix { of, amount } => Texture::Mix {
                of: self.textures_of(of, measure)?,
                by: Arc::new(Weight::Texture(self.texture(amount, Measure::Share)?)),
            },
            TextureKind::DirectionMix { of: [along, across], dir } => {
                let Some(dir) = DVec3::from_array(*dir).try_normalize() else {
                    return self.fail(SceneError::at(span, "the direction of this texture has no length"));
                };
                let of = self.textures_of(&[across.clone(), along.clone()], measure)?;
                Texture::Mix { of, by: Arc::new(Weight::Direction(dir.as_vec3())) }
            }
            TextureKind::Bilinear { corners, mapping } => Texture::Bilinear {
                corners: self.textures_of(corners, measure)?,
                mapping: self.mapping(mapping, span)?,
            },
            TextureKind::Checkerboard { of, board } => {
                let board = match board {
                    Board::Squares(mapping) => Checkerboard::Plane(self.mapping(mapping, span)?),
                    Board::Cubes { from_world } => Checkerboard::Space(self.space(*from_world, span)?),
                };
                Texture::Mix { of: self.textures_of(of, measure)?, by: Arc::new(Weight::Checkerboard(board)) }
            }
            TextureKind::Dots { of, mapping } => Texture::Mix {
                of: self.textures_of(of, measure)?,
                by: Arc::new(Weight::Dots(self.mapping(mapping, span)?)),
            },
            TextureKind::Image(desc) => Texture::Image(self.image_texture(desc, measure)?),
            TextureKind::Attribute { of_faces, scale } => {
                let painted = Arc::clone(&self.painted[usize::from(*of_faces)]);
                if painted.meshes.is_empty() {
                    let (wanted, program) = if *of_faces { ("faces", "face") } else { ("vertices", "vertex") };
                    let error = SceneError::at(span, format!("no mesh has colours of its {wanted}"));
                    return self
                        .fail(error.help(format!("a PLY file has them as properties r, g, b of each {program}")));
                }
                Texture::Attribute(Attribute { painted, scale: *scale as f32, most: most(measure) })
            }
            TextureKind::Fbm(noise) => {
                let (octaves, omega) = (noise.octaves, noise.roughness as f32);
                self.noise(Kind::Fbm { octaves, omega }, noise.from_world, span)?
            }
            TextureKind::Wrinkled(noise) => {
                let (octaves, omega) = (noise.octaves, noise.roughness as f32);
                self.noise(Kind::Wrinkled { octaves, omega }, noise.from_world, span)?
            }
            TextureKind::Windy { from_world } => self.noise(Kind::Windy, *from_world, span)?,
            TextureKind::Marble { noise: NoiseDesc { octaves, roughness, from_world }, scale, variation } => {
                Texture::Marble(Marble {
                    octaves: *octaves,
                    omega: *roughness as f32,
                    scale: *scale as f32,
                    variation: *variation as f32,
                    mapping: self.space(*from_world, span)?,
                })
            }
        })
    }

    fn textures_of<const N: usize>(
        &mut self,
        parts: &[Spanned<Varying>; N],
        measure: Measure,
    ) -> Option<Arc<[Texture; N]>> {
        let parts: Vec<_> = parts.iter().map(|part| self.texture(part, measure)).collect();
        let parts: Vec<_> = parts.into_iter().collect::<Option<_>>()?;
        parts.try_into().ok().map(Arc::new)
    }

    fn noise(&mut self, kind: Kind, from_world: DMat4, span: Span) -> Option<Texture> {
        Some(Texture::Noise(Noise { kind, mapping: self.space(from_world, span)? }))
    }

    fn space(&mut self, from_world: DMat4, span: Span) -> Option<Mapping3> {
        self.transform(from_world, span).map(|from_world| Mapping3 { from_world })
    }

    fn mapping(&mut self, desc: &MappingDesc, span: Span) -> Option<Mapping2> {
        let transform = |builder: &mut Self, matrix: &DMat4| -> Option<Transform> { builder.transform(*matrix, span) };
        Some(match desc {
            MappingDesc::Uv([[a, b, c], [d, e, f]]) => {
                let map = [[a, d], [b, e], [c, f]].map(|[x, y]| DVec2::new(*x, *y).as_vec2());
                Mapping2::Uv(Affine2::from_cols(map[0], map[1], map[2]))
            }
            MappingDesc::Spherical { from_world } => Mapping2::Spherical { from_world: transform(self, from_world)? },
            MappingDesc::Cylindrical { from_world } => {
                Mapping2::Cylindrical { from_world: transform(self, from_world)? }
            }
            MappingDesc::Planar { from_world, axes, offset } => Mapping2::Planar {
                from_world: transform(self, from_world)?,
                axes: axes.map(|axis| Vec3::from_array(axis.map(|v| v as f32))),
                offset: Vec2::from_array(offset.map(|v| v as f32)),
            },
        })
    }

    /// A picture as a texture.
    fn image_texture(&mut self, desc: &ImageDesc, measure: Measure) -> Option<ImageTexture> {
        Some(ImageTexture {
            picture: self.picture(desc)?,
            mapping: self.mapping(&desc.mapping, desc.path.span)?,
            wrap: match desc.wrap {
                WrapKind::Repeat => Wrap::Repeat,
                WrapKind::Mirror => Wrap::Mirror,
                WrapKind::Clamp => Wrap::Clamp,
                WrapKind::Black => Wrap::Black,
            },
            interpolation: if desc.smooth { Interpolation::Bilinear } else { Interpolation::Nearest },
            scale: desc.scale as f32,
            invert: desc.invert,
            grey: if desc.by_luminance { Grey::Luminance } else { Grey::Mean },
            least: if measure == Measure::Number { f32::MIN } else { 0.0 },
            most: most(measure),
        })
    }

    /// Columns and rows of a picture; 1 × 1 for what is none.
    pub(super) fn picture_size(&mut self, texture: Option<&Spanned<Varying>>) -> [u32; 2] {
        let scene = self.desc;
        let kind = match texture.map(|texture| &texture.value) {
            Some(Varying::Texture(id)) => scene.texture(*id).map(|desc| &desc.kind),
            _ => None,
        };
        let picture = match kind {
            Some(TextureKind::Image(image)) => self.picture(image),
            _ => None,
        };
        picture.map_or([1, 1], |picture| [picture.width, picture.height])
    }

    fn picture(&mut self, desc: &ImageDesc) -> Option<Arc<Picture>> {
        let is_it =
            |(path, encoding, _): &&(PathBuf, Encoding, _)| *path == desc.path.value && *encoding == desc.encoding;
        if let Some((_, _, picture)) = self.pictures.iter().find(is_it) {
            return Some(Arc::clone(picture));
        }
        match image::read_encoded(&desc.path.value, desc.encoding) {
            Ok(image::Image { width, height, pixels }) => {
                let picture = Arc::new(Picture { width, height, pixels });
                self.pictures.push((desc.path.value.clone(), desc.encoding, Arc::clone(&picture)));
                Some(picture)
            }
            Err(e) => self.fail(SceneError::at(desc.path.span, e.to_string())),
        }
    }
}

/// The greatest value of what is measured so.
fn most(measure: Measure) -> f32 {
    if measure == Measure::Share { 1.0 } else { f32::MAX }
}
