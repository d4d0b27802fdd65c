//! `Material`, `MakeNamedMaterial` and `NamedMaterial`.

use std::borrow::Cow;

use tyndall::relief::Rule;

use super::Reader;
use super::params::Params;
use super::parser::Statement;
use super::textures::Textures;
use crate::desc::{
    BaseDesc, CoatedDesc, ConductorOptics, Encoding, HairColourDesc, HairDesc, ImageDesc, MappingDesc, MaterialDesc,
    MaterialId, MaterialKind, MicrofacetKind, ReliefMap, RoughnessDesc, ShadowingKind, SpectrumDesc, TextureDesc,
    TextureId, TextureKind, Varying, WrapKind,
};
use crate::error::SceneError;
use crate::source::{Span, Spanned};

const MATERIALS: [&str; 12] = [
    "coatedconductor",
    "coateddiffuse",
    "conductor",
    "dielectric",
    "diffuse",
    "diffusetransmission",
    "hair",
    "interface",
    "measured",
    "mix",
    "subsurface",
    "thindielectric",
];

impl MaterialDesc {
    /// The material of shapes before any `Material`.
    pub(super) fn pbrt_default(span: Span) -> Self {
        let reflectance = Spanned::new(Varying::constant(0.5), span);
        Self { span, name: None, kind: MaterialKind::Diffuse { reflectance }, two_sided: true }
    }
}

impl Reader {
    pub(super) fn material(&mut self, mut s: Statement<'_>) {
        let name = s.names[0].clone();
        let defaults = self.state.now.defaults.material.clone();
        let p = self.params("material", &mut s, &defaults);
        let desc = self.material_of(s.whole, None, &name, p);
        let id = MaterialId(self.materials.push(s.whole, desc));
        self.fillings.settle(id);
        self.state.now.material = Some(Spanned::new(id, s.whole));
    }

    pub(super) fn named_material(&mut self, mut s: Statement<'_>) {
        let name = s.names[0].clone();
        let defaults = self.state.now.defaults.material.clone();
        let mut p = self.params("material", &mut s, &defaults);
        let kind = p.string_opt("type").map(|kind| kind.map(Cow::Owned));
        if kind.is_none() {
            p.error(
                SceneError::at(name.span, "a named material needs \"string type\"").help("\"string type\" \"diffuse\""),
            );
        }
        let kind = kind.unwrap_or(Spanned::new("interface".into(), name.span));
        let desc = self.material_of(s.whole, Some(name.value.to_string()), &kind, p);
        self.checked(|r| r.materials.define(&name.value, s.whole, desc).map(|id| r.fillings.settle(MaterialId(id))));
    }

    pub(super) fn use_material(&mut self, name: &Spanned<Cow<'_, str>>) {
        let id = MaterialId(self.materials.refer(&name.value, name.span));
        self.state.now.material = Some(Spanned::new(id, name.span));
    }

    /// What the parameters make of a kind. A kind that is not known is reported and stands in as the default material.
    fn material_of(
        &mut self,
        span: Span,
        name: Option<String>,
        kind: &Spanned<Cow<'_, str>>,
        mut p: Params,
    ) -> MaterialDesc {
        let made = match &*kind.value {
            "diffuse" => diffuse(&mut p, &self.textures),
            "conductor" => conductor(&mut p, &self.textures),
            "dielectric" => dielectric(&mut p, &self.textures),
            "thindielectric" => thin_dielectric(&mut p),
            "diffusetransmission" => diffuse_transmission(&mut p, &self.textures),
            "coateddiffuse" => coated_diffuse(&mut p, &self.textures),
            "coatedconductor" => coated_conductor(&mut p, &self.textures),
            "hair" => hair(&mut p, &self.textures),
            "measured" => measured(&mut p),
            "mix" => self.mix(&mut p),
            "subsurface" => self.subsurface(span, &mut p),
            "interface" | "none" | "" => MaterialKind::Interface,
            _ => {
                self.unknown_kind("material", kind, &MATERIALS, &[]);
                return MaterialDesc { name, ..MaterialDesc::pbrt_default(span) };
            }
        };
        let map = match made {
            MaterialKind::Mix { .. } | MaterialKind::Interface => None,
            _ => self.relief(&mut p),
        };
        self.finish_params(p);
        let desc = MaterialDesc { span, name, kind: made, two_sided: true };
        let Some(map) = map else { return desc };
        let name = desc.name.clone();
        let even = MaterialId(self.materials.push(span, MaterialDesc { name: None, ..desc }));
        let kind = MaterialKind::Embossed { of: Spanned::new(even, span), map, rule: Rule::Pbrt };
        MaterialDesc { span, name, kind, two_sided: true }
    }

    /// A normal map, or else a bump map.
    fn relief(&mut self, p: &mut Params) -> Option<ReliefMap> {
        let heights = p.number("displacement", &self.textures, |_| true);
        let Some(file) = p.string_opt("normalmap") else {
            return heights.map(|texture| ReliefMap::Heights { texture, scale: 1.0 });
        };
        let image = ImageDesc {
            path: Spanned::new(p.resolve(&file.value), file.span),
            mapping: MappingDesc::UV,
            wrap: WrapKind::Repeat,
            smooth: true,
            scale: 1.0,
            invert: false,
            by_luminance: false,
            encoding: Encoding::Linear,
        };
        let id = TextureId(self.textures.list.len() as u32);
        self.textures.list.push(TextureDesc { span: file.span, name: None, kind: TextureKind::Image(image) });
        Some(ReliefMap::Normals(file.map(|_| Varying::Texture(id))))
    }
}

impl Reader {
    /// Two named materials, defined before or after.
    fn mix(&mut self, p: &mut Params) -> MaterialKind {
        let amount = p.number("amount", &self.textures, |_| true);
        let amount = amount.unwrap_or(Spanned::new(Varying::constant(0.5), p.span));
        let Some(of) = p.strings("materials", 2) else {
            p.error(
                SceneError::at(p.span, "a mix needs the names of two materials")
                    .help("\"string materials\" [ \"first\" \"second\" ]"),
            );
            return MaterialKind::Interface;
        };
        let of = [&of[0], &of[1]]
            .map(|name| Spanned::new(MaterialId(self.materials.refer(&name.value, name.span)), name.span));
        MaterialKind::Mix { of, amount }
    }
}

fn diffuse(p: &mut Params, textures: &Textures) -> MaterialKind {
    MaterialKind::Diffuse { reflectance: p.varying("reflectance", 0.5, textures) }
}

fn conductor(p: &mut Params, textures: &Textures) -> MaterialKind {
    MaterialKind::Conductor { optics: optics(p, textures, ["eta", "k"]), roughness: rough(p, textures), tint: None }
}

/// How a metal reflects, whose complex index has these names.
fn optics(p: &mut Params, textures: &Textures, [eta, k]: [&'static str; 2]) -> ConductorOptics {
    let reflectance = p.varying_opt("reflectance", textures);
    let given = [p.varying_opt(eta, textures), p.varying_opt(k, textures)];
    match (reflectance, given) {
        (Some(reflectance), [None, None]) => ConductorOptics::Reflectance(reflectance),
        (Some(reflectance), _) => {
            let message = format!("a conductor has either \"reflectance\" or \"{eta}\" and \"{k}\"");
            p.error(SceneError::at(reflectance.span, message).help("leave out one of them"));
            ConductorOptics::Reflectance(reflectance)
        }
        (None, [eta, k]) => {
            let copper = |which: &str| Spanned::new(Varying::Everywhere(SpectrumDesc::Named(which.into())), p.span);
            ConductorOptics::EtaK {
                eta: eta.unwrap_or_else(|| copper("metal-Cu-eta")),
                k: k.unwrap_or_else(|| copper("metal-Cu-k")),
            }
        }
    }
}

fn coated_diffuse(p: &mut Params, textures: &Textures) -> MaterialKind {
    let base = BaseDesc::Diffuse(p.varying("reflectance", 0.5, textures));
    let roughness = rough(p, textures);
    coated(p, textures, "eta", roughness, base)
}

fn coated_conductor(p: &mut Params, textures: &Textures) -> MaterialKind {
    let remap = remap(p);
    let [base, top] = [
        ["conductor.roughness", "conductor.uroughness", "conductor.vroughness"],
        ["interface.roughness", "interface.uroughness", "interface.vroughness"],
    ]
    .map(|names| roughness(p, textures, names, remap));
    let optics = optics(p, textures, ["conductor.eta", "conductor.k"]);
    coated(p, textures, "interface.eta", top, BaseDesc::Conductor { optics, roughness: base })
}

/// The coat, whose index has this name.
fn coated(
    p: &mut Params,
    textures: &Textures,
    eta: &'static str,
    roughness: RoughnessDesc,
    base: BaseDesc,
) -> MaterialKind {
    let thickness = p.amount("thickness", textures);
    let g = p.number("g", textures, |_| true);
    MaterialKind::Coated(Box::new(CoatedDesc {
        eta: p.spectrum_or_float(eta, SpectrumDesc::Constant(1.5)),
        roughness,
        thickness: thickness.unwrap_or(Spanned::new(Varying::constant(0.01), p.span)),
        albedo: p.varying("albedo", 0.0, textures),
        g: g.unwrap_or(Spanned::new(Varying::constant(0.0), p.span)),
        base,
        max_depth: few(p, "maxdepth", 10, 0),
        walks: few(p, "nsamples", 1, 1),
    }))
}

/// A number of at least `least`, of which more than 65535 are never wanted.
fn few(p: &mut Params, name: &'static str, default: u16, least: u32) -> u16 {
    let found = p.count(name, default.into(), least);
    u16::try_from(found.value).unwrap_or_else(|_| {
        p.error(SceneError::at(found.span, format!("\"{name}\" is at most {}", u16::MAX)));
        default
    })
}

fn dielectric(p: &mut Params, textures: &Textures) -> MaterialKind {
    MaterialKind::Dielectric {
        eta: p.spectrum_or_float("eta", SpectrumDesc::Constant(1.5)),
        roughness: rough(p, textures),
        reflection_tint: None,
        transmission_tint: None,
    }
}

fn thin_dielectric(p: &mut Params) -> MaterialKind {
    MaterialKind::ThinDielectric {
        eta: p.spectrum_or_float("eta", SpectrumDesc::Constant(1.5)),
        reflection_tint: None,
        transmission_tint: None,
    }
}

fn diffuse_transmission(p: &mut Params, textures: &Textures) -> MaterialKind {
    MaterialKind::DiffuseTransmission {
        reflectance: p.varying("reflectance", 0.25, textures),
        transmittance: p.varying("transmittance", 0.25, textures),
        scale: p.not_negative("scale", 1.0).value,
    }
}

/// By absorption, by colour, or by pigments: what is given first of these.
fn hair(p: &mut Params, textures: &Textures) -> MaterialKind {
    let sigma_a = p.varying_opt("sigma_a", textures);
    let reflectance = p.varying_opt("reflectance", textures);
    let colour = p.varying_opt("color", textures);
    let pigments = ["eumelanin", "pheomelanin"].map(|name| p.amount(name, textures));
    let given: Vec<_> = [&sigma_a, &reflectance, &colour].into_iter().flatten().map(|given| given.span).collect();
    let of_pigments = pigments.iter().flatten().map(|given| given.span).next();
    if let [first, second, ..] = given.iter().copied().chain(of_pigments).collect::<Vec<_>>()[..] {
        let message = "the colour of hair is said by \"sigma_a\", by \"reflectance\", or by pigments";
        p.error(SceneError::at(second, message).help("leave out one of them").related(first, "given here too"));
    }
    let of = |name: Option<Spanned<Varying>>, p: &Params, default: f64| {
        name.unwrap_or(Spanned::new(Varying::constant(default), p.span))
    };
    let colour = match (sigma_a, reflectance.or(colour)) {
        (Some(sigma_a), _) => HairColourDesc::SigmaA(sigma_a),
        (None, Some(colour)) => HairColourDesc::Reflectance(colour),
        (None, None) => {
            // Brown.
            let eumelanin = if pigments[1].is_some() { 0.0 } else { 1.3 };
            let [brown, red] = pigments;
            HairColourDesc::Pigments { eumelanin: of(brown, p, eumelanin), pheomelanin: of(red, p, 0.0) }
        }
    };
    let number = |p: &mut Params, name, default| {
        let found = p.number(name, textures, |_| true);
        of(found, p, default)
    };
    MaterialKind::Hair(Box::new(HairDesc {
        colour,
        eta: number(p, "eta", 1.55),
        beta_m: number(p, "beta_m", 0.3),
        beta_n: number(p, "beta_n", 0.3),
        alpha: number(p, "alpha", 2.0),
    }))
}

fn measured(p: &mut Params) -> MaterialKind {
    let Some(file) = p.string_opt("filename") else {
        p.error(SceneError::at(p.span, "a measured material needs \"string filename\""));
        return MaterialKind::Interface;
    };
    MaterialKind::Measured { path: file.map(|name| p.resolve(&name)) }
}

/// The names of a roughness: along both tangents, along the first, along the second.
const ROUGHNESS: [&str; 3] = ["roughness", "uroughness", "vroughness"];

/// The roughness of a material with one surface.
pub(super) fn rough(p: &mut Params, textures: &Textures) -> RoughnessDesc {
    let remap = remap(p);
    roughness(p, textures, ROUGHNESS, remap)
}

/// Whether roughness is that of the eye or of the model, of all surfaces of a material.
fn remap(p: &mut Params) -> bool {
    p.boolean("remaproughness", true).value
}

fn roughness(p: &mut Params, textures: &Textures, [both, u, v]: [&'static str; 3], remap: bool) -> RoughnessDesc {
    let smooth = Spanned::new(Varying::constant(0.0), p.span);
    let both = p.amount(both, textures).unwrap_or(smooth);
    RoughnessDesc {
        u: p.amount(u, textures).unwrap_or_else(|| both.clone()),
        v: p.amount(v, textures).unwrap_or(both),
        remap,
        distribution: MicrofacetKind::Ggx,
        shadowing: ShadowingKind::Correlated,
    }
}
