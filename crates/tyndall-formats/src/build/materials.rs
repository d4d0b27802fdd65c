//! Materials.

use std::sync::Arc;

use tyndall::{
    bsdf::{
        RoughCoat, SMOOTHEST_ALPHA, Sides, internal_reflectance,
        measured::Tables,
        microfacet::{Distribution, Microfacets, Shadowing},
    },
    material::{CoatedBase, CoatedMaterial, Index, Material, Metal, Roughness},
    relief::{Map, Relief},
    spectrum::{Spectrum, glass::Glass},
    texture::Texture,
};

use super::{Builder, made::parts, material_id, spectra::Measure};
use crate::{
    desc::{
        BaseDesc, CoatedDesc, ConductorOptics, FileRef, MaterialDesc, MaterialId, MaterialKind, MicrofacetKind,
        ReliefMap, RoughnessDesc, ShadowingKind, SpectrumDesc, Varying,
    },
    error::SceneError,
    source::{Span, Spanned},
};

/// The most materials that one can be made of, counted as often as they are part of it.
const MAX_PARTS: u32 = 1024;

/// The deepest nesting of materials in materials.
const MAX_DEPTH: u32 = 64;

impl Builder<'_> {
    /// All materials of the file, unless one of them contains itself, or too many others.
    pub(super) fn materials(&mut self) -> Option<Vec<Material>> {
        for desc in &self.desc.materials {
            if self.has_too_many_parts(desc, 0, &mut 0) {
                let message = format!("this material contains itself, or more than {MAX_PARTS} others");
                return self.fail(SceneError::at(desc.span, message));
            }
        }
        let materials: Vec<_> = self.desc.materials.iter().map(|m| self.material(m)).collect();
        materials.into_iter().collect()
    }

    fn has_too_many_parts(&self, desc: &MaterialDesc, depth: u32, count: &mut u32) -> bool {
        *count += 1;
        let part = |id: &Spanned<MaterialId>| self.desc.material(id.value);
        depth > MAX_DEPTH
            || *count > MAX_PARTS
            || parts(&desc.kind).iter().filter_map(part).any(|part| self.has_too_many_parts(part, depth + 1, count))
    }

    fn material(&mut self, desc: &MaterialDesc) -> Option<Material> {
        let sides = if desc.two_sided { Sides::Both } else { Sides::Outside };
        match &desc.kind {
            MaterialKind::Diffuse { reflectance } => {
                Some(Material::Diffuse { reflectance: self.texture(reflectance, Measure::Share)?, sides })
            }
            MaterialKind::Conductor { optics, roughness, tint } => Some(Material::Conductor {
                metal: self.metal(optics)?,
                alpha: self.roughness(roughness)?,
                tint: self.tint(tint.as_ref())?,
                sides,
            }),
            MaterialKind::Dielectric { eta, roughness, reflection_tint, transmission_tint } => {
                Some(Material::Dielectric {
                    eta: self.index(eta)?,
                    alpha: self.roughness(roughness)?,
                    reflection_tint: self.tint(reflection_tint.as_ref())?,
                    transmission_tint: self.tint(transmission_tint.as_ref())?,
                })
            }
            MaterialKind::ThinDielectric { eta, reflection_tint, transmission_tint } => {
                Some(Material::ThinDielectric {
                    eta: self.index(eta)?,
                    reflection_tint: self.tint(reflection_tint.as_ref())?,
                    transmission_tint: self.tint(transmission_tint.as_ref())?,
                })
            }
            MaterialKind::DiffuseTransmission { reflectance, transmittance, scale } => {
                Some(Material::DiffuseTransmission {
                    reflectance: self.texture(reflectance, Measure::Share)?,
                    transmittance: self.texture(transmittance, Measure::Share)?,
                    scale: *scale as f32,
                })
            }
            MaterialKind::Plastic { eta, reflectance, nonlinear, roughness, tint } => {
                let Index::Constant(coat) = self.index(eta)? else {
                    return self.fail(SceneError::at(eta.span, "the index of this coat is one number"));
                };
                let reflectance = self.texture(reflectance, Measure::Share)?;
                let (nonlinear, tint) = (*nonlinear, self.tint(tint.as_ref())?);
                Some(match roughness {
                    None => {
                        let internal = internal_reflectance(coat);
                        Material::Plastic { eta: coat, internal, reflectance, nonlinear, tint, sides }
                    }
                    Some(roughness) => {
                        let coat = self.rough_coat(coat, roughness)?;
                        Material::RoughPlastic { coat, reflectance, nonlinear, tint, sides }
                    }
                })
            }
            MaterialKind::Principled(desc) => self.principled(desc, sides),
            MaterialKind::PrincipledThin(desc) => self.principled_thin(desc),
            MaterialKind::Coated(coated) => self.coated(coated).map(|coated| Material::Coated(Box::new(coated))),
            MaterialKind::Hair(hair) => self.hair(hair).map(|hair| Material::Hair(Box::new(hair))),
            MaterialKind::Measured { path } => self.measured(path).map(|tables| Material::Measured { tables, sides }),
            MaterialKind::Interface => Some(Material::Null),
            MaterialKind::Mix { of, amount } => Some(Material::Mix {
                of: [material_id(of[0].value), material_id(of[1].value)],
                amount: self.texture(amount, Measure::Share)?,
            }),
            MaterialKind::Mask { of, opacity } => Some(Material::Mix {
                of: [self.made.null(), material_id(of.value)],
                amount: self.texture(opacity, Measure::Share)?,
            }),
            MaterialKind::TwoFaced { of: [outside, inside] } => {
                Some(Material::TwoFaced { outside: material_id(outside.value), inside: material_id(inside.value) })
            }
            MaterialKind::Embossed { of, map, rule } => {
                if let Some(other) = self.embossed_part(of) {
                    let error = SceneError::not_yet(desc.span, "a relief upon a relief is not known yet");
                    return self.fail(error.help("leave one of them out").related(other, "the other one"));
                }
                let map = match map {
                    ReliefMap::Heights { texture, scale } => {
                        Map::Heights { texture: self.texture(texture, Measure::Number)?, scale: *scale as f32 }
                    }
                    ReliefMap::Normals(texture) => Map::Normals(self.texture(texture, Measure::Share)?),
                };
                Some(Material::Embossed { of: material_id(of.value), relief: Box::new(Relief { map, rule: *rule }) })
            }
        }
    }

    /// Where a material, or a part of it, is embossed.
    fn embossed_part(&self, of: &Spanned<MaterialId>) -> Option<Span> {
        let desc = self.desc.material(of.value)?;
        match &desc.kind {
            MaterialKind::Embossed { .. } => Some(desc.span),
            kind => parts(kind).iter().find_map(|part| self.embossed_part(part)),
        }
    }

    fn coated(&mut self, desc: &CoatedDesc) -> Option<CoatedMaterial> {
        let base = match &desc.base {
            BaseDesc::Diffuse(reflectance) => CoatedBase::Diffuse(self.texture(reflectance, Measure::Share)?),
            BaseDesc::Conductor { optics, roughness } => {
                CoatedBase::Metal { metal: self.metal(optics)?, alpha: Box::new(self.roughness(roughness)?) }
            }
        };
        Some(CoatedMaterial {
            eta: self.index(&desc.eta)?,
            alpha: self.roughness(&desc.roughness)?,
            thickness: self.texture(&desc.thickness, Measure::Coefficient)?,
            albedo: self.texture(&desc.albedo, Measure::Share)?,
            g: self.texture(&desc.g, Measure::Number)?,
            base,
            max_depth: desc.max_depth,
            walks: desc.walks,
        })
    }

    /// A measured material, read once.
    fn measured(&mut self, path: &FileRef) -> Option<Arc<Tables>> {
        if let Some((_, tables)) = self.measured.iter().find(|(file, _)| *file == path.value) {
            return Some(Arc::clone(tables));
        }
        let made = crate::measured::read(&path.value)
            .and_then(|parts| Tables::new(parts, self.color).map_err(|error| error.to_string()));
        match made {
            Ok(tables) => {
                let tables = Arc::new(tables);
                self.measured.push((path.value.clone(), Arc::clone(&tables)));
                Some(tables)
            }
            Err(problem) => self.fail(SceneError::at(path.span, format!("{}: {problem}", path.value.display()))),
        }
    }

    fn metal(&mut self, optics: &ConductorOptics) -> Option<Metal> {
        match optics {
            ConductorOptics::EtaK { eta, k } => {
                let [eta, k] = [eta, k].map(|part| self.texture(part, Measure::Index).map(Box::new));
                Some(Metal::Index { eta: eta?, k: k? })
            }
            ConductorOptics::Reflectance(r) => Some(Metal::Reflectance(self.texture(r, Measure::Share)?)),
            ConductorOptics::Mirror => Some(Metal::Mirror),
        }
    }

    fn index(&mut self, eta: &Spanned<SpectrumDesc>) -> Option<Index> {
        match &eta.value {
            SpectrumDesc::Constant(v) if *v > 0.0 && v.is_finite() => Some(Index::Constant(*v as f32)),
            SpectrumDesc::Named(name) if Glass::named(name).is_some() => Glass::named(name).copied().map(Index::Glass),
            SpectrumDesc::Samples { .. } | SpectrumDesc::Named(_) | SpectrumDesc::File(_) => {
                match self.spectrum(eta, Measure::Index)? {
                    Spectrum::Sampled(table) => Some(Index::Table(table)),
                    _ => None,
                }
            }
            _ => self.fail(
                SceneError::at(eta.span, "an index of refraction is a positive number or the name of a glass")
                    .help("water has 1.33, glass 1.5; \"glass-BK7\" disperses"),
            ),
        }
    }

    fn roughness(&mut self, desc: &RoughnessDesc) -> Option<Roughness> {
        let u = self.texture(&desc.u, Measure::Coefficient);
        let v = self.texture(&desc.v, Measure::Coefficient);
        let distribution = match desc.distribution {
            MicrofacetKind::Ggx => Distribution::TrowbridgeReitz,
            MicrofacetKind::Beckmann => Distribution::Beckmann,
        };
        let shadowing = match desc.shadowing {
            ShadowingKind::Correlated => Shadowing::Correlated,
            ShadowingKind::Separable => Shadowing::Separable,
        };
        u.zip(v).map(|(u, v)| Roughness { u, v, remap: desc.remap, distribution, shadowing })
    }

    /// The coat of a plastic, tabulated once.
    fn rough_coat(&mut self, eta: f32, desc: &RoughnessDesc) -> Option<Arc<RoughCoat>> {
        let Some([alpha, _]) = desc.alpha().filter(|[u, v]| u == v) else {
            let error =
                SceneError::at(desc.u.span, "the coat of a plastic is equally rough everywhere, in all directions");
            return self.fail(error.help("give one number, \"alpha\""));
        };
        let Roughness { distribution, shadowing, .. } = self.roughness(desc)?;
        let alpha = (alpha as f32).max(SMOOTHEST_ALPHA);
        let microfacets = Microfacets { alpha_x: alpha, alpha_y: alpha, distribution, shadowing };
        if let Some(made) = self.coats.iter().find(|coat| coat.eta == eta && coat.microfacets == microfacets) {
            return Some(Arc::clone(made));
        }
        let made = Arc::new(RoughCoat::new(eta, microfacets));
        self.coats.push(Arc::clone(&made));
        Some(made)
    }

    fn tint(&mut self, tint: Option<&Spanned<Varying>>) -> Option<Texture> {
        tint.map_or(Some(Texture::from(1.0)), |t| self.texture(t, Measure::Share))
    }
}
