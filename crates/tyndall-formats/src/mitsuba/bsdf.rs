//! `<bsdf>`: `diffuse`, `conductor`, `dielectric`, `plastic`, their rough kin, `thindielectric`, `principled` and
//! `principledthin`, `null`; `blendbsdf`, `mask`, `bumpmap`, `normalmap`, and `twosided` around one that reflects or two.

use tyndall::relief::Rule;
use tyndall_optics::spectra;

use super::object::{Child, Measure, Object, Report};
use super::scene::Builder;
use super::texture::Answer;
use super::tree::Element;
use super::words;
use crate::desc::{
    ConductorOptics, MaterialDesc, MaterialId, MaterialKind, MicrofacetKind, ReliefMap, RoughnessDesc, ShadowingKind,
    SpectrumDesc, Varying,
};
use crate::error::SceneError;
use crate::source::Spanned;

/// Refractive indices by name, at 589 nm and room temperature (Hecht, "Optics", 4th ed., as Mitsuba documents them).
pub(crate) const INDICES: &[(&str, f64)] = &[
    ("vacuum", 1.0),
    ("helium", 1.000036),
    ("hydrogen", 1.000132),
    ("air", 1.000277),
    ("carbon dioxide", 1.00045),
    ("water", 1.3330),
    ("acetone", 1.36),
    ("ethanol", 1.361),
    ("carbon tetrachloride", 1.461),
    ("glycerol", 1.4729),
    ("benzene", 1.501),
    ("silicone oil", 1.52045),
    ("bromine", 1.661),
    ("water ice", 1.31),
    ("fused quartz", 1.458),
    ("pyrex", 1.470),
    ("acrylic glass", 1.49),
    ("polypropylene", 1.49),
    ("bk7", 1.5046),
    ("sodium chloride", 1.544),
    ("amber", 1.55),
    ("pet", 1.5750),
    ("diamond", 2.419),
];

impl<'t> Builder<'t> {
    /// A material; `two_sided` where a `twosided` is around it.
    pub(super) fn bsdf(&mut self, element: &'t Element, two_sided: bool) -> Option<MaterialDesc> {
        let plugin = words::plugin(element, &mut self.report)?;
        let name = element.id();
        let desc = |kind| MaterialDesc { span: element.span, name: name.clone(), kind, two_sided };
        if plugin != "twosided" {
            return self.bsdf_kind(plugin, element, two_sided).map(desc);
        }
        let mut object = self.object(element);
        let faces = object.nested("bsdf");
        object.finish(&mut self.report);
        let error = match faces[..] {
            [face] => {
                self.reflects_only(&face)?;
                let inside = self.bsdf(face.element, true)?;
                return Some(MaterialDesc { span: element.span, name, ..inside });
            }
            [front, back] => {
                let (front, back) = (self.face(&front), self.face(&back));
                return Some(desc(MaterialKind::TwoFaced { of: [front?, back?] }));
            }
            [] => SceneError::at(element.span, "\"twosided\" has no <bsdf> inside"),
            _ => SceneError::at(faces[2].at.span, "\"twosided\" has two faces, not three"),
        };
        self.report.errors.push(error);
        None
    }

    /// One of two faces.
    fn face(&mut self, child: &Child<'t>) -> Option<Spanned<MaterialId>> {
        self.reflects_only(child)?;
        self.part(child, true)
    }

    /// A material inside of another.
    fn part(&mut self, child: &Child<'t>, two_sided: bool) -> Option<Spanned<MaterialId>> {
        Some(Spanned::new(self.material(child.element, two_sided)?, child.at.span))
    }

    /// What `twosided` is around must not let light through.
    fn reflects_only(&mut self, child: &Child<'t>) -> Option<()> {
        let plugin = words::plugin(child.element, &mut self.report)?;
        let what = match plugin {
            "twosided" => "two-sided already",
            "dielectric" | "roughdielectric" | "thindielectric" | "principledthin" | "null" | "mask" | "hair" => {
                "not a surface that only reflects"
            }
            "principled" if super::principled::is_clear(child.element) => "not a surface that only reflects",
            _ => return Some(()),
        };
        let error = SceneError::at(child.element.span_of("type"), format!("\"{plugin}\" is {what}"));
        self.report.errors.push(error.help("leave the \"twosided\" out"));
        None
    }

    /// The two materials of a `blendbsdf`, or the one of a `mask`, with the share of it or of the second.
    fn compound<const N: usize>(
        &mut self,
        object: &mut Object<'t>,
        share: &'static str,
        two_sided: bool,
    ) -> Option<([Spanned<MaterialId>; N], Spanned<Varying>)> {
        let parts = object.nested("bsdf");
        let wrong = parts.len() != N;
        if wrong {
            let message = format!("\"{}\" is made of {N} <bsdf>, not of {}", object.kind(), parts.len());
            self.report.errors.push(SceneError::at(object.element.span, message));
        }
        let share = self.number_or(object, share, Measure::Part, 0.5);
        let parts: Vec<_> = parts.iter().map(|part| self.part(part, two_sided)).collect();
        let parts: Vec<_> = parts.into_iter().collect::<Option<_>>()?;
        Some((parts.try_into().ok()?, share))
    }

    /// Any plugin but `twosided`.
    fn bsdf_kind(&mut self, plugin: &str, element: &'t Element, two_sided: bool) -> Option<MaterialKind> {
        let mut object = self.object(element);
        let kind = match plugin {
            "diffuse" => {
                MaterialKind::Diffuse { reflectance: self.varying_or(&mut object, "reflectance", Measure::Part, 0.5) }
            }
            "dielectric" | "roughdielectric" => MaterialKind::Dielectric {
                eta: relative_index(&mut object, "bk7", &mut self.report),
                roughness: self.roughness(plugin == "roughdielectric", &mut object),
                reflection_tint: self.varying(&mut object, "specular_reflectance", Measure::Part),
                transmission_tint: self.varying(&mut object, "specular_transmittance", Measure::Part),
            },
            "thindielectric" => MaterialKind::ThinDielectric {
                eta: relative_index(&mut object, "bk7", &mut self.report),
                reflection_tint: self.varying(&mut object, "specular_reflectance", Measure::Part),
                transmission_tint: self.varying(&mut object, "specular_transmittance", Measure::Part),
            },
            "conductor" | "roughconductor" => MaterialKind::Conductor {
                optics: self.conductor(&mut object)?,
                roughness: self.roughness(plugin == "roughconductor", &mut object),
                tint: self.varying(&mut object, "specular_reflectance", Measure::Part),
            },
            "plastic" | "roughplastic" => MaterialKind::Plastic {
                eta: relative_index(&mut object, "polypropylene", &mut self.report),
                reflectance: self.varying_or(&mut object, "diffuse_reflectance", Measure::Part, 0.5),
                nonlinear: object.flag("nonlinear", false, &mut self.report),
                roughness: (plugin == "roughplastic").then(|| self.roughness(true, &mut object)),
                tint: self.varying(&mut object, "specular_reflectance", Measure::Part),
            },
            "measured" => {
                let Some(name) = object.string("filename", &mut self.report) else {
                    let error = SceneError::at(element.span, "the bsdf \"measured\" lacks a \"filename\"");
                    self.report.errors.push(error);
                    return None;
                };
                MaterialKind::Measured { path: self.file(name) }
            }
            "hair" => self.hair(&mut object),
            "principled" => self.principled(&mut object),
            "principledthin" => self.principled_thin(&mut object),
            "blendbsdf" => {
                if !object.has("weight") {
                    let error = SceneError::at(element.span, "\"blendbsdf\" lacks a \"weight\"");
                    self.report.errors.push(error.help("0 is the first material alone, 1 the second"));
                }
                let (of, amount) = self.compound(&mut object, "weight", two_sided)?;
                MaterialKind::Mix { of, amount }
            }
            "mask" => {
                let ([of], opacity) = self.compound(&mut object, "opacity", two_sided)?;
                MaterialKind::Mask { of, opacity }
            }
            "bumpmap" | "normalmap" => self.embossed(plugin, &mut object, two_sided)?,
            _ => MaterialKind::Interface,
        };
        object.finish(&mut self.report);
        Some(kind)
    }

    /// A relief over another material. Of the texture of a `bumpmap` the name does not matter.
    fn embossed(&mut self, plugin: &str, object: &mut Object<'t>, two_sided: bool) -> Option<MaterialKind> {
        let scale = if plugin == "bumpmap" { object.float("scale", |_| true, "", &mut self.report) } else { None };
        let rule = Rule::Mitsuba {
            flips: object.flag("flip_invalid_normals", true, &mut self.report),
            shadows: object.flag("use_shadowing_function", true, &mut self.report),
            mirrored: two_sided,
        };
        let texture = match plugin {
            "bumpmap" => object.only("texture", &mut self.report),
            _ => object.object_of("normalmap", "texture"),
        };
        let bsdf = object.only("bsdf", &mut self.report);
        let missing = match (&texture, &bsdf) {
            (None, _) => Some("<texture>"),
            (_, None) => Some("<bsdf>"),
            _ => None,
        };
        if let Some(missing) = missing {
            let error = SceneError::at(object.element.span, format!("\"{plugin}\" has no {missing} inside"));
            self.report.errors.push(error);
        }
        let (texture, bsdf) = (texture?, bsdf?);
        let of = self.part(&bsdf, two_sided);
        let answer = if plugin == "bumpmap" { Answer::Number } else { Answer::Colour };
        let varying = self.texture(texture.element, answer);
        let varying = varying.map(|id| Spanned::new(Varying::Texture(id), texture.at.span));
        let (of, texture) = (of?, varying?);
        let map = match plugin {
            "bumpmap" => ReliefMap::Heights { texture, scale: scale.map_or(1.0, |scale| scale.value) },
            _ => ReliefMap::Normals(texture),
        };
        Some(MaterialKind::Embossed { of, map, rule })
    }

    /// Mitsuba's distribution is Beckmann's unless the file says otherwise, its α is that of the model, and
    /// its masking and shadowing are a product.
    fn roughness(&mut self, rough: bool, object: &mut Object<'t>) -> RoughnessDesc {
        let at = object.element.span;
        if !rough {
            return RoughnessDesc::smooth(at);
        }
        object.ignore(&["sample_visible"], "only visible normals are sampled", &mut self.report);
        let kinds = [("beckmann", MicrofacetKind::Beckmann), ("ggx", MicrofacetKind::Ggx)];
        let distribution = object.choice("distribution", &kinds, &mut self.report);
        let [both, u, v] =
            ["alpha", "alpha_u", "alpha_v"].map(|name| self.varying_number(object, name, Measure::Amount));
        let default = || Spanned::new(Varying::constant(0.1), at);
        let (u, v) = match (both, u, v) {
            (Some(both), None, None) => (both.clone(), both),
            (None, Some(u), Some(v)) => (u, v),
            (None, None, None) => (default(), default()),
            (_, u, v) => {
                let span = u.or(v).map_or(at, |given| given.span);
                let error = SceneError::at(span, "give either \"alpha\", or both \"alpha_u\" and \"alpha_v\"");
                self.report.errors.push(error);
                (default(), default())
            }
        };
        RoughnessDesc { u, v, remap: false, distribution, shadowing: ShadowingKind::Separable }
    }

    /// By `eta` and `k`, by the name of a `material`, or a perfect mirror.
    fn conductor(&mut self, object: &mut Object<'t>) -> Option<ConductorOptics> {
        let material = object.string("material", &mut self.report).filter(|m| m.value != "none");
        let eta = self.varying(object, "eta", Measure::Amount);
        let k = self.varying(object, "k", Measure::Amount);
        let error = match (eta, k, material) {
            (None, None, None) => return Some(ConductorOptics::Mirror),
            (eta, k, None) => {
                // Mitsuba's defaults: the index i reflects all.
                let default = |v| Spanned::new(Varying::constant(v), object.element.span);
                let (eta, k) = (eta.unwrap_or_else(|| default(0.0)), k.unwrap_or_else(|| default(1.0)));
                return Some(ConductorOptics::EtaK { eta, k });
            }
            (None, None, Some(material)) if is_metal(material.value) => {
                let named = |what| SpectrumDesc::Named(format!("metal-{}-{what}", material.value));
                let data = |what| Spanned::new(Varying::Everywhere(named(what)), material.span);
                return Some(ConductorOptics::EtaK { eta: data("eta"), k: data("k") });
            }
            (None, None, Some(material)) => {
                let error = SceneError::at(material.span, format!("the metal \"{}\" is not known", material.value));
                error.suggest(material.value, spectra::metals().chain(["none"]).collect::<Vec<_>>())
            }
            _ => SceneError::at(object.element.span, "a conductor has either a \"material\", or \"eta\" and \"k\""),
        };
        self.report.errors.push(error);
        None
    }
}

/// `int_ior` over `ext_ior`.
pub(super) fn relative_index(object: &mut Object, default: &str, report: &mut Report) -> Spanned<SpectrumDesc> {
    let inside = index(object, "int_ior", default, report);
    let outside = index(object, "ext_ior", "air", report);
    Spanned::new(SpectrumDesc::Constant(inside.value / outside.value), inside.span)
}

/// A refractive index, by value or by the name of a substance.
fn index(object: &mut Object, name: &'static str, default: &str, report: &mut Report) -> Spanned<f64> {
    let by_name = |word: &str| INDICES.iter().find(|(known, _)| *known == word).map(|(_, index)| *index);
    let default = Spanned::new(by_name(default).unwrap_or(1.0), object.element.span);
    let Some((tag, text)) = object.number_or_name(name, report) else { return default };
    let error = if tag == "string" {
        if let Some(index) = by_name(&text.value.to_lowercase()) {
            return text.map(|_| index);
        }
        let message = format!("no refractive index is known for \"{}\"", text.value);
        SceneError::at(text.span, message).suggest(text.value, INDICES.iter().map(|(known, _)| *known))
    } else {
        match super::number::number(text.value, text.span) {
            Ok(index) if index > 0.0 => return text.map(|_| index),
            Ok(_) => SceneError::at(text.span, format!("\"{name}\" must be greater than 0, not {}", text.value)),
            Err(error) => error,
        }
    };
    report.errors.push(error);
    default
}

/// Whether the complex index of this substance is known.
fn is_metal(name: &str) -> bool {
    spectra::named(&format!("metal-{name}-eta")).is_some()
}
