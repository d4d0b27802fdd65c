//! `Texture "name" "float" "scale" …`: textures, by name and by what they hold.
//!
//! A texture must be defined before it is used. The transformation at its definition is that of its space.

use std::collections::HashMap;

use glam::{DMat4, DVec3};

use super::Reader;
use super::params::{Params, quote};
use super::parser::Statement;
use crate::desc::{
    Board, Encoding, ImageDesc, MappingDesc, NoiseDesc, TextureDesc, TextureId, TextureKind, Varying, WrapKind,
};
use crate::error::SceneError;
use crate::source::Spanned;

const CLASSES: [&str; 12] = [
    "bilerp",
    "checkerboard",
    "constant",
    "directionmix",
    "dots",
    "fbm",
    "imagemap",
    "marble",
    "mix",
    "scale",
    "windy",
    "wrinkled",
];
/// What stands in for a texture that is not known.
const STAND_IN: f64 = 0.5;
const LATER_CLASSES: [&str; 1] = ["ptex"];

/// What a texture holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Texels {
    /// pbrt's "float".
    Numbers,
    /// pbrt's "spectrum".
    Colours,
}

/// Textures in order of definition, and by name.
#[derive(Debug, Default)]
pub(super) struct Textures {
    pub(super) list: Vec<TextureDesc>,
    by_name: HashMap<(Texels, String), TextureId>,
}

impl Textures {
    /// The texture of a name.
    ///
    /// # Errors
    /// There is none, or it holds something else.
    pub(super) fn find(&self, name: &Spanned<String>, texels: Texels) -> Result<TextureId, SceneError> {
        if let Some(id) = self.by_name.get(&(texels, name.value.clone())) {
            return Ok(*id);
        }
        let (wanted, other, there) = match texels {
            Texels::Numbers => ("float", "spectrum", Texels::Colours),
            Texels::Colours => ("spectrum", "float", Texels::Numbers),
        };
        let error = SceneError::at(name.span, format!("no {wanted} texture is called {}", quote(&name.value)));
        if self.by_name.contains_key(&(there, name.value.clone())) {
            return Err(error.help(format!("a {other} texture has this name; here a {wanted} texture is needed")));
        }
        let known = self.by_name.keys().filter(|(kind, _)| *kind == texels).map(|(_, name)| name.as_str());
        Err(error.suggest(&name.value, known))
    }
}

impl Reader {
    /// Carries out a `Texture` directive.
    pub(super) fn texture(&mut self, mut s: Statement<'_>) {
        let [name, of, class] = [0, 1, 2].map(|i| s.names[i].clone());
        let texels = match &*of.value {
            "float" => Texels::Numbers,
            "spectrum" => Texels::Colours,
            word => {
                let error = SceneError::at(of.span, format!("a texture holds no {}", quote(word)));
                return self.errors.push(error.suggest(word, ["float", "spectrum"]));
            }
        };
        let defaults = self.state.now.defaults.texture.clone();
        let mut p = Params::new(
            format!("texture \"{}\"", class.value),
            class.span,
            std::mem::take(&mut s.params),
            &defaults,
            &self.dir,
        );
        let space = Space { from_world: self.state.now.inverse, texels };
        let kind = if let Some(kind) = space.kind(&class.value, &mut p, &self.textures) {
            self.finish_params(p);
            kind
        } else {
            self.unknown_kind("texture", &class, &CLASSES, &LATER_CLASSES);
            TextureKind::Plain(Spanned::new(Varying::constant(STAND_IN), class.span))
        };
        let id = TextureId(self.textures.list.len() as u32);
        let key = (texels, name.value.to_string());
        if let Some(first) = self.textures.by_name.get(&key) {
            let first = self.textures.list[first.0 as usize].span;
            let message = format!("the texture {} is defined twice", quote(&name.value));
            return self.errors.push(SceneError::at(s.whole, message).related(first, "first here"));
        }
        self.textures.list.push(TextureDesc { span: s.whole, name: Some(name.value.to_string()), kind });
        self.textures.by_name.insert(key, id);
    }
}

/// Where a texture is defined and what it holds.
#[derive(Clone, Copy)]
struct Space {
    from_world: DMat4,
    texels: Texels,
}

impl Space {
    /// `None` for a class that is not known.
    fn kind(self, class: &str, p: &mut Params, textures: &Textures) -> Option<TextureKind> {
        let two = |p: &mut Params, names: [&'static str; 2], defaults: [f64; 2]| {
            [self.part(p, names[0], defaults[0], textures), self.part(p, names[1], defaults[1], textures)]
        };
        Some(match class {
            "constant" => TextureKind::Plain(self.part(p, "value", 1.0, textures)),
            "scale" => {
                let by = p.number("scale", textures, |_| true);
                let by = by.unwrap_or(Spanned::new(Varying::constant(1.0), p.span));
                TextureKind::Scale([self.part(p, "tex", 1.0, textures), by])
            }
            "mix" => {
                let amount = p.number("amount", textures, |_| true);
                TextureKind::Mix {
                    of: two(p, ["tex1", "tex2"], [0.0, 1.0]),
                    amount: amount.unwrap_or(Spanned::new(Varying::constant(0.5), p.span)),
                }
            }
            "directionmix" => {
                let dir = DVec3::from_array(p.vector("dir", [0.0, 1.0, 0.0]).value);
                let dir = self.from_world.inverse().transform_vector3(dir).to_array();
                TextureKind::DirectionMix { of: two(p, ["tex1", "tex2"], [0.0, 1.0]), dir }
            }
            "bilerp" => {
                let [low, high] = [two(p, ["v00", "v10"], [0.0, 0.0]), two(p, ["v01", "v11"], [1.0, 1.0])];
                let ([v00, v10], [v01, v11]) = (low, high);
                TextureKind::Bilinear { corners: [v00, v10, v01, v11], mapping: self.mapping(p) }
            }
            "checkerboard" => {
                let of = two(p, ["tex1", "tex2"], [1.0, 0.0]);
                let dimension = p.count("dimension", 2, 2);
                let board = if dimension.value == 2 {
                    Board::Squares(self.mapping(p))
                } else {
                    if dimension.value > 3 {
                        p.error(SceneError::at(dimension.span, "a checkerboard has 2 or 3 dimensions"));
                    }
                    Board::Cubes { from_world: self.from_world }
                };
                TextureKind::Checkerboard { of, board }
            }
            "dots" => TextureKind::Dots { of: two(p, ["outside", "inside"], [0.0, 1.0]), mapping: self.mapping(p) },
            "imagemap" => TextureKind::Image(self.image(p)),
            "fbm" => TextureKind::Fbm(self.noise(p)),
            "wrinkled" => TextureKind::Wrinkled(self.noise(p)),
            "windy" => TextureKind::Windy { from_world: self.from_world },
            "marble" => TextureKind::Marble {
                noise: self.noise(p),
                scale: p.float("scale", 1.0).value,
                variation: p.float("variation", 0.2).value,
            },
            _ => return None,
        })
    }

    /// A part: another texture of the same kind, or a constant.
    fn part(self, p: &mut Params, name: &'static str, default: f64, textures: &Textures) -> Spanned<Varying> {
        let default = Spanned::new(Varying::constant(default), p.span);
        match self.texels {
            Texels::Numbers => p.number(name, textures, |_| true),
            Texels::Colours => p.varying_opt(name, textures),
        }
        .unwrap_or(default)
    }

    fn noise(self, p: &mut Params) -> NoiseDesc {
        NoiseDesc {
            octaves: p.count("octaves", 8, 0).value.min(64),
            roughness: p.float("roughness", 0.5).value,
            from_world: self.from_world,
        }
    }

    fn mapping(self, p: &mut Params) -> MappingDesc {
        let from_world = self.from_world;
        let kind = p.string_opt("mapping").unwrap_or(Spanned::new("uv".into(), p.span));
        match kind.value.as_str() {
            "uv" => {
                let [su, sv] = ["uscale", "vscale"].map(|name| p.float(name, 1.0).value);
                let [du, dv] = ["udelta", "vdelta"].map(|name| p.float(name, 0.0).value);
                MappingDesc::Uv([[su, 0.0, du], [0.0, sv, dv]])
            }
            "spherical" => MappingDesc::Spherical { from_world },
            "cylindrical" => MappingDesc::Cylindrical { from_world },
            "planar" => MappingDesc::Planar {
                from_world,
                axes: [p.vector("v1", [1.0, 0.0, 0.0]).value, p.vector("v2", [0.0, 1.0, 0.0]).value],
                offset: [p.float("udelta", 0.0).value, p.float("vdelta", 0.0).value],
            },
            word => {
                let error = SceneError::at(kind.span, format!("there is no texture mapping {}", quote(word)));
                p.error(error.suggest(word, ["uv", "spherical", "cylindrical", "planar"]));
                MappingDesc::UV
            }
        }
    }

    fn image(self, p: &mut Params) -> ImageDesc {
        let mapping = self.mapping(p);
        let name = p.string_opt("filename").unwrap_or_else(|| {
            p.error(SceneError::at(p.span, "an imagemap needs \"string filename\""));
            Spanned::new(String::new(), p.span)
        });
        p.ignore("maxanisotropy", "textures are looked up at points: the samples of a pixel filter them");
        let coded = std::path::Path::new(&name.value).extension().is_some_and(|e| e.eq_ignore_ascii_case("png"));
        let encoding = encoding(p).unwrap_or(if coded { Encoding::Srgb } else { Encoding::Linear });
        ImageDesc {
            path: Spanned::new(p.resolve(&name.value), name.span),
            mapping,
            wrap: wrap(p),
            smooth: filter(p),
            scale: p.float("scale", 1.0).value,
            invert: p.boolean("invert", false).value,
            by_luminance: false,
            encoding,
        }
    }
}

/// `sRGB`, `linear` or `gamma 2.2`; `None` if the file does not say.
fn encoding(p: &mut Params) -> Option<Encoding> {
    let given = p.string_opt("encoding")?;
    let gamma = |word: &str| word.strip_prefix("gamma ").and_then(|number| number.trim().parse::<f64>().ok());
    match given.value.as_str() {
        "sRGB" => Some(Encoding::Srgb),
        "linear" => Some(Encoding::Linear),
        word => match gamma(word) {
            Some(gamma) if gamma > 0.0 && gamma.is_finite() => Some(Encoding::Gamma(gamma)),
            _ => {
                let error = SceneError::at(given.span, format!("there is no encoding {}", quote(word)));
                p.error(error.help("write \"sRGB\", \"linear\" or \"gamma 2.2\""));
                None
            }
        },
    }
}

fn wrap(p: &mut Params) -> WrapKind {
    const WORDS: [(&str, WrapKind); 4] = [
        ("repeat", WrapKind::Repeat),
        ("clamp", WrapKind::Clamp),
        ("black", WrapKind::Black),
        ("octahedralsphere", WrapKind::Clamp),
    ];
    one_of(p, "wrap", &WORDS).unwrap_or(WrapKind::Repeat)
}

/// Whether values are linear between the centres of pixels.
fn filter(p: &mut Params) -> bool {
    let words = [("bilinear", true), ("point", false), ("trilinear", true), ("ewa", true), ("EWA", true)];
    one_of(p, "filter", &words).unwrap_or(true)
}

fn one_of<T: Copy>(p: &mut Params, name: &'static str, words: &[(&'static str, T)]) -> Option<T> {
    let given = p.string_opt(name)?;
    let found = words.iter().find(|(word, _)| *word == given.value).map(|(_, value)| *value);
    if found.is_none() {
        let error = SceneError::at(given.span, format!("there is no {name} {}", quote(&given.value)));
        p.error(error.suggest(&given.value, words.iter().map(|(word, _)| *word)));
    }
    found
}
