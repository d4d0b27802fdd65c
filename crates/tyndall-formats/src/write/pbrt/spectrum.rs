//! Spectra, and what may be a texture.

use super::Pen;
use super::entity::{Entity, quoted};
use super::texture::Texels;
use crate::build::spectra::table_luminance;
use crate::desc::{EmissionDesc, Magnitude, Span, Spanned, SpectrumDesc, TextureKind, Varying};
use crate::write::number::double;

impl Pen<'_, '_> {
    /// A spectrum. One number for all wavelengths is a grey colour.
    pub(super) fn spectrum(&mut self, entity: &mut Entity, name: &str, spectrum: &SpectrumDesc, span: Span) {
        match spectrum {
            SpectrumDesc::Constant(v) => entity.list("rgb", name, &[*v; 3]),
            SpectrumDesc::Rgb(rgb) => entity.list("rgb", name, rgb),
            SpectrumDesc::Blackbody { kelvin } => entity.param("blackbody", name, &double(*kelvin)),
            SpectrumDesc::Samples { lambda, values } => {
                let pairs: Vec<_> = lambda.iter().zip(values).flat_map(|(l, v)| [*l, *v]).collect();
                entity.list("spectrum", name, &pairs);
            }
            SpectrumDesc::Named(word) => entity.param("spectrum", name, &quoted(word)),
            SpectrumDesc::File(path) => {
                let file = self.draft.relative(path, span);
                // Without a directory or an ending it would be a name.
                let file = if file.contains(['.', '/']) { file } else { format!("./{file}") };
                entity.param("spectrum", name, &quoted(&file));
            }
        }
    }

    /// An index of refraction: a number, or a spectrum.
    pub(super) fn index(&mut self, entity: &mut Entity, name: &str, eta: &Spanned<SpectrumDesc>) {
        match &eta.value {
            SpectrumDesc::Constant(v) => entity.float_unless(name, *v, 1.5),
            other => self.spectrum(entity, name, other, eta.span),
        }
    }

    /// A colour that may vary, unless it is the number that pbrt takes anyway.
    pub(super) fn colour(&mut self, entity: &mut Entity, name: &str, value: &Spanned<Varying>, default: f64) {
        match &value.value {
            Varying::Texture(id) => {
                let texture = self.textures.name(self.draft.desc, *id, Texels::Colours);
                entity.param("texture", name, &quoted(&texture));
            }
            Varying::Everywhere(SpectrumDesc::Constant(v)) if *v == default => {}
            Varying::Everywhere(spectrum) => self.spectrum(entity, name, spectrum, value.span),
        }
    }

    /// A number that may vary, unless it is the one that pbrt takes anyway.
    pub(super) fn number(&mut self, entity: &mut Entity, name: &str, value: &Spanned<Varying>, default: f64) {
        let desc = self.draft.desc;
        match &value.value {
            Varying::Texture(id) => {
                if let Some(TextureKind::Image(image)) = desc.texture(*id).map(|texture| &texture.kind)
                    && image.by_luminance
                {
                    let message = "where a coloured picture stands for a number, pbrt takes the mean of its channels";
                    self.draft.differs(image.path.span, message);
                }
                let texture = self.textures.name(desc, *id, Texels::Numbers);
                entity.param("texture", name, &quoted(&texture));
            }
            Varying::Everywhere(spectrum) => match grey(spectrum) {
                Some(v) => entity.float_unless(name, v, default),
                None => self.lacks(value.span, &format!("a colour as \"{name}\"")),
            },
        }
    }

    /// Light: its colour, and by `scale` its size, as pbrt takes of a spectrum that is no colour the shape only.
    pub(super) fn emission(&mut self, entity: &mut Entity, name: &str, scale: &str, light: &EmissionDesc) {
        let spectrum = &light.spectrum.value;
        let own = match (light.magnitude, spectrum) {
            (Magnitude::UnitLuminance, _) | (_, SpectrumDesc::Constant(_) | SpectrumDesc::Rgb(_)) => 1.0,
            (Magnitude::AsWritten, SpectrumDesc::Blackbody { kelvin }) => {
                tyndall::spectrum::blackbody::luminance(*kelvin)
            }
            (Magnitude::AsWritten, table) => table_luminance(table).map_or(1.0, f64::from),
        };
        if !matches!(spectrum, SpectrumDesc::Rgb([1.0, 1.0, 1.0])) || name == "Le" {
            self.spectrum(entity, name, spectrum, light.spectrum.span);
        }
        // A light that is dark has no colour that a factor could change.
        entity.float_unless(scale, if own > 0.0 { own * light.scale } else { light.scale }, 1.0);
    }
}

/// The number of a spectrum that is the same everywhere, or of a grey colour.
pub(super) fn grey(spectrum: &SpectrumDesc) -> Option<f64> {
    match spectrum {
        SpectrumDesc::Constant(v) => Some(*v),
        SpectrumDesc::Rgb([r, g, b]) if r == g && g == b => Some(*r),
        _ => None,
    }
}
