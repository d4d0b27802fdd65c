//! `Material`, `MakeNamedMaterial` and `NamedMaterial`.

use std::borrow::Cow;

use super::Reader;
use super::params::Params;
use super::parser::Statement;
use super::textures::Textures;
use crate::desc::{
    ConductorOptics, MaterialDesc, MaterialId, MaterialKind, MicrofacetKind, RoughnessDesc, ShadowingKind,
    SpectrumDesc, Varying,
};
use crate::error::SceneError;
use crate::source::{Span, Spanned};

const MATERIALS: [&str; 8] =
    ["diffuse", "diffusetransmission", "conductor", "dielectric", "thindielectric", "mix", "interface", "subsurface"];
const LATER_MATERIALS: [&str; 4] = ["coatedconductor", "coateddiffuse", "hair", "measured"];

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
            "mix" => self.mix(&mut p),
            "subsurface" => self.subsurface(span, &mut p),
            "interface" | "none" | "" => MaterialKind::Interface,
            _ => {
                self.unknown_kind("material", kind, &MATERIALS, &LATER_MATERIALS);
                return MaterialDesc { name, ..MaterialDesc::pbrt_default(span) };
            }
        };
        p.later("displacement");
        p.later("normalmap");
        self.finish_params(p);
        MaterialDesc { span, name, kind: made, two_sided: true }
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
    let reflectance = p.varying_opt("reflectance", textures);
    let given = [p.varying_opt("eta", textures), p.varying_opt("k", textures)];
    let optics = match (reflectance, given) {
        (Some(reflectance), [None, None]) => ConductorOptics::Reflectance(reflectance),
        (Some(reflectance), _) => {
            p.error(
                SceneError::at(reflectance.span, "a conductor has either \"reflectance\" or \"eta\" and \"k\"")
                    .help("leave out one of them"),
            );
            ConductorOptics::Reflectance(reflectance)
        }
        (None, [eta, k]) => {
            let copper = |which: &str| Spanned::new(Varying::Everywhere(SpectrumDesc::Named(which.into())), p.span);
            ConductorOptics::EtaK {
                eta: eta.unwrap_or_else(|| copper("metal-Cu-eta")),
                k: k.unwrap_or_else(|| copper("metal-Cu-k")),
            }
        }
    };
    MaterialKind::Conductor { optics, roughness: roughness(p, textures), tint: None }
}

fn dielectric(p: &mut Params, textures: &Textures) -> MaterialKind {
    MaterialKind::Dielectric {
        eta: p.spectrum_or_float("eta", SpectrumDesc::Constant(1.5)),
        roughness: roughness(p, textures),
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

pub(super) fn roughness(p: &mut Params, textures: &Textures) -> RoughnessDesc {
    let smooth = Spanned::new(Varying::constant(0.0), p.span);
    let both = p.amount("roughness", textures).unwrap_or(smooth);
    RoughnessDesc {
        u: p.amount("uroughness", textures).unwrap_or_else(|| both.clone()),
        v: p.amount("vroughness", textures).unwrap_or(both),
        remap: p.boolean("remaproughness", true).value,
        distribution: MicrofacetKind::Ggx,
        shadowing: ShadowingKind::Correlated,
    }
}
