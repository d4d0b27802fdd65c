//! Materials, each by its id.

use tyndall::relief::Rule;
use tyndall_optics::spectra;

use super::Pen;
use super::element::Element;
use crate::build::made::parts;
use crate::desc::{
    BurleyDesc, ConductorOptics, HairColourDesc, HairDesc, MaterialDesc, MaterialId, MaterialKind, MicrofacetKind,
    PrincipledDesc, PrincipledThinDesc, ReliefMap, RoughnessDesc, ShadowingKind, Span, Spanned, SpectrumDesc, Varying,
};
use crate::mitsuba::INDICES;
use crate::write::number::{double, shortest};

/// Mitsuba's word for a material, or the nearest: materials without a name are called by it.
pub(super) fn word(kind: &MaterialKind) -> &'static str {
    match kind {
        MaterialKind::Diffuse { .. } => "diffuse",
        MaterialKind::Conductor { .. } => "conductor",
        MaterialKind::Dielectric { .. } => "dielectric",
        MaterialKind::ThinDielectric { .. } => "thindielectric",
        MaterialKind::DiffuseTransmission { .. } => "diffusetransmission",
        MaterialKind::Plastic { .. } => "plastic",
        MaterialKind::Interface => "null",
        MaterialKind::Mix { .. } => "blendbsdf",
        MaterialKind::Mask { .. } => "mask",
        MaterialKind::TwoFaced { .. } => "twosided",
        MaterialKind::Principled(_) => "principled",
        MaterialKind::PrincipledThin(_) => "principledthin",
        MaterialKind::Coated(_) => "coated",
        MaterialKind::Measured { .. } => "measured",
        MaterialKind::Hair(_) => "hair",
        MaterialKind::Embossed { map: ReliefMap::Heights { .. }, .. } => "bumpmap",
        MaterialKind::Embossed { map: ReliefMap::Normals(_), .. } => "normalmap",
    }
}

/// Whether a material's parts stand inside of it: those of one that is `twosided` as a whole are not so themselves.
fn says_its_parts(kind: &MaterialKind) -> bool {
    matches!(kind, MaterialKind::TwoFaced { .. })
        || matches!(kind, MaterialKind::Embossed { rule: Rule::Mitsuba { mirrored: true, .. }, .. })
}

impl Pen<'_, '_> {
    /// All, a part of one before it.
    pub(super) fn all_bsdfs(&mut self) -> Vec<Element> {
        let desc = self.draft.desc;
        let mut order = Vec::new();
        for index in 0..desc.materials.len() {
            self.after_its_parts(MaterialId(index as u32), &mut order, 0);
        }
        order.retain(|id| !self.draft.stands_inside(*id, says_its_parts));
        order.into_iter().filter_map(|id| Some(self.bsdf(id, desc.material(id)?))).collect()
    }

    fn after_its_parts(&self, id: MaterialId, order: &mut Vec<MaterialId>, depth: u32) {
        // A material that contains itself is found wrong by whoever reads it.
        if order.contains(&id) || depth > 64 {
            return;
        }
        if let Some(material) = self.draft.desc.material(id) {
            for part in parts(&material.kind) {
                self.after_its_parts(part.value, order, depth + 1);
            }
            if !order.contains(&id) {
                order.push(id);
            }
        }
    }

    fn bsdf(&mut self, id: MaterialId, material: &MaterialDesc) -> Element {
        let name = self.materials[id.0 as usize].clone();
        let inside = self.bsdf_kind(&material.kind, material.span);
        // Mitsuba's materials that reflect do so on one side.
        let reflects = matches!(
            material.kind,
            MaterialKind::Diffuse { .. }
                | MaterialKind::Conductor { .. }
                | MaterialKind::Plastic { .. }
                | MaterialKind::Principled(_)
                | MaterialKind::Measured { .. }
        );
        let mirrored =
            matches!(material.kind, MaterialKind::Embossed { rule: Rule::Mitsuba { mirrored: true, .. }, .. });
        if reflects && material.two_sided || mirrored {
            return Element::plugin("bsdf", "twosided").with("id", &name).around(inside);
        }
        inside.with("id", &name)
    }

    fn bsdf_kind(&mut self, kind: &MaterialKind, span: Span) -> Element {
        match kind {
            MaterialKind::Diffuse { reflectance } => {
                let mut element = Element::plugin("bsdf", "diffuse");
                self.varying_unless(&mut element, "reflectance", reflectance, 0.5);
                element
            }
            MaterialKind::Conductor { optics, roughness, tint } => {
                let mut element = Element::plugin("bsdf", rough("conductor", "roughconductor", roughness));
                self.conductor(&mut element, optics, span);
                self.roughness(&mut element, roughness);
                self.tint(&mut element, "specular_reflectance", tint.as_ref());
                element
            }
            MaterialKind::Dielectric { eta, roughness, reflection_tint, transmission_tint } => {
                let mut element = Element::plugin("bsdf", rough("dielectric", "roughdielectric", roughness));
                self.index(&mut element, eta, "bk7");
                self.roughness(&mut element, roughness);
                self.tint(&mut element, "specular_reflectance", reflection_tint.as_ref());
                self.tint(&mut element, "specular_transmittance", transmission_tint.as_ref());
                element
            }
            MaterialKind::ThinDielectric { eta, reflection_tint, transmission_tint } => {
                let mut element = Element::plugin("bsdf", "thindielectric");
                self.index(&mut element, eta, "bk7");
                self.tint(&mut element, "specular_reflectance", reflection_tint.as_ref());
                self.tint(&mut element, "specular_transmittance", transmission_tint.as_ref());
                element
            }
            MaterialKind::Plastic { eta, reflectance, nonlinear, roughness, tint } => {
                let plugin = if roughness.is_some() { "roughplastic" } else { "plastic" };
                let mut element = Element::plugin("bsdf", plugin);
                if let Some(roughness) = roughness {
                    self.roughness(&mut element, roughness);
                    if is_smooth(roughness) {
                        element.push(Element::parameter("float", "alpha", "0"));
                    }
                }
                self.index(&mut element, eta, "polypropylene");
                self.varying_unless(&mut element, "diffuse_reflectance", reflectance, 0.5);
                if *nonlinear {
                    element.boolean("nonlinear", true);
                }
                self.tint(&mut element, "specular_reflectance", tint.as_ref());
                element
            }
            MaterialKind::Principled(principled) => self.principled(principled),
            MaterialKind::PrincipledThin(principled) => self.principled_thin(principled),
            MaterialKind::DiffuseTransmission { .. } => {
                self.lacks(span, "the material \"diffusetransmission\"");
                Element::plugin("bsdf", "diffuse")
            }
            MaterialKind::Coated(_) => {
                self.lacks(span, "a base under a coat (pbrt's \"coateddiffuse\" and \"coatedconductor\")");
                Element::plugin("bsdf", "diffuse")
            }
            MaterialKind::Hair(hair) => self.hair(hair),
            MaterialKind::Measured { path } => {
                let file = self.draft.relative(&path.value, path.span);
                Element::plugin("bsdf", "measured").around(Element::parameter("string", "filename", &file))
            }
            MaterialKind::Embossed { of, map, rule } => self.relief(of, map, *rule, span),
            MaterialKind::Interface => Element::plugin("bsdf", "null"),
            MaterialKind::Mix { of: [first, second], amount } => {
                let mut element = Element::plugin("bsdf", "blendbsdf");
                let weight = self.varying_number("weight", amount);
                element.push(weight.unwrap_or_else(|| Element::parameter("float", "weight", "0.5")));
                element.push(self.material_ref(first.value));
                element.push(self.material_ref(second.value));
                element
            }
            MaterialKind::Mask { of, opacity } => {
                let mut element = Element::plugin("bsdf", "mask");
                self.number_unless(&mut element, "opacity", opacity, 0.5);
                element.around(self.material_ref(of.value))
            }
            MaterialKind::TwoFaced { of: [front, back] } => {
                let mut element = Element::plugin("bsdf", "twosided");
                for face in [front, back] {
                    element.push(self.face(face));
                }
                element
            }
        }
    }

    fn hair(&mut self, hair: &HairDesc) -> Element {
        let HairDesc { colour, eta, beta_m, beta_n, alpha } = hair;
        let mut element = Element::plugin("bsdf", "hair");
        match &eta.value {
            Varying::Everywhere(spectrum) => {
                self.index(&mut element, &Spanned::new(spectrum.clone(), eta.span), "amber");
            }
            Varying::Texture(_) => self.lacks(eta.span, "an index of hair that is a texture"),
        }
        match colour {
            HairColourDesc::SigmaA(sigma_a) => {
                let sigma_a = self.varying("sigma_a", sigma_a);
                element.extend(sigma_a);
            }
            HairColourDesc::Reflectance(colour) => self.lacks(colour.span, "hair by its colour"),
            HairColourDesc::Pigments { eumelanin, pheomelanin } => {
                self.plain_number(&mut element, "eumelanin", eumelanin, 1.3);
                self.plain_number(&mut element, "pheomelanin", pheomelanin, 0.2);
            }
        }
        self.plain_number(&mut element, "longitudinal_roughness", beta_m, 0.3);
        self.plain_number(&mut element, "azimuthal_roughness", beta_n, 0.3);
        self.plain_number(&mut element, "scale_tilt", alpha, 2.0);
        element
    }

    /// A number that cannot be a texture.
    fn plain_number(&mut self, element: &mut Element, name: &str, value: &Spanned<Varying>, default: f64) {
        match value.value.number() {
            Some(number) => element.float_unless(name, number, default),
            None => self.lacks(value.span, "a parameter of hair that is a texture"),
        }
    }

    fn principled(&mut self, desc: &PrincipledDesc) -> Element {
        let PrincipledDesc { burley, metallic, clearcoat, clearcoat_gloss, eta, rates } = desc;
        let mut element = Element::plugin("bsdf", "principled");
        self.burley(&mut element, burley);
        self.number_unless(&mut element, "metallic", metallic, 0.0);
        self.number_unless(&mut element, "clearcoat", clearcoat, 0.0);
        self.number_unless(&mut element, "clearcoat_gloss", clearcoat_gloss, 0.0);
        element.push(Element::parameter("float", "eta", &double(*eta)));
        let names = ["diffuse_reflectance_sampling_rate", "main_specular_sampling_rate", "clearcoat_sampling_rate"];
        for (name, rate) in names.into_iter().zip(rates) {
            element.float_unless(name, *rate, 1.0);
        }
        element
    }

    fn principled_thin(&mut self, desc: &PrincipledThinDesc) -> Element {
        let PrincipledThinDesc { burley, eta, diff_trans, rates } = desc;
        let mut element = Element::plugin("bsdf", "principledthin");
        self.burley(&mut element, burley);
        self.number_unless(&mut element, "eta", eta, 1.5);
        self.number_unless(&mut element, "diff_trans", diff_trans, 0.0);
        for (side, rates) in ["reflectance", "transmittance"].into_iter().zip(rates) {
            for (lobe, rate) in ["diffuse", "specular"].into_iter().zip(rates) {
                element.float_unless(&format!("{lobe}_{side}_sampling_rate"), *rate, 1.0);
            }
        }
        element
    }

    /// What solids and sheets have in common.
    fn burley(&mut self, element: &mut Element, desc: &BurleyDesc) {
        let BurleyDesc { base_color, roughness, anisotropic, spec_trans, spec_tint, sheen, sheen_tint, flatness } =
            desc;
        self.varying_unless(element, "base_color", base_color, 0.5);
        self.number_unless(element, "roughness", roughness, 0.5);
        let none_unless_said = [
            ("anisotropic", anisotropic),
            ("spec_trans", spec_trans),
            ("spec_tint", spec_tint),
            ("sheen", sheen),
            ("sheen_tint", sheen_tint),
            ("flatness", flatness),
        ];
        for (name, value) in none_unless_said {
            self.number_unless(element, name, value, 0.0);
        }
    }

    fn relief(&mut self, of: &Spanned<MaterialId>, map: &ReliefMap, rule: Rule, span: Span) -> Element {
        let (mut element, texture) = match map {
            ReliefMap::Heights { texture, scale } => {
                let mut element = Element::plugin("bsdf", "bumpmap");
                element.float_unless("scale", *scale, 1.0);
                (element, self.varying_number("arbitrary", texture))
            }
            ReliefMap::Normals(texture) => (Element::plugin("bsdf", "normalmap"), self.varying("normalmap", texture)),
        };
        let Some(texture) = texture else {
            // There is no word for it: the surface is even.
            return self.face(of);
        };
        element.push(texture);
        match rule {
            Rule::Mitsuba { flips, shadows, mirrored } => {
                if !flips {
                    element.boolean("flip_invalid_normals", false);
                }
                if !shadows {
                    element.boolean("use_shadowing_function", false);
                }
                element.push(if mirrored { self.face(of) } else { self.material_ref(of.value) });
            }
            Rule::Pbrt => {
                self.draft.differs(span, "Mitsuba has other rules for reliefs that would turn light round");
                element.push(self.material_ref(of.value));
            }
        }
        element
    }

    /// A face of a `twosided` has no `twosided` of its own, and so no id.
    fn face(&mut self, face: &Spanned<MaterialId>) -> Element {
        match self.draft.desc.material(face.value) {
            Some(material) => self.bsdf_kind(&material.kind, material.span),
            None => self.material_ref(face.value),
        }
    }

    fn tint(&mut self, element: &mut Element, name: &str, tint: Option<&Spanned<Varying>>) {
        if let Some(tint) = tint {
            element.extend(self.varying(name, tint));
        }
    }

    fn conductor(&mut self, element: &mut Element, optics: &ConductorOptics, span: Span) {
        match optics {
            ConductorOptics::Mirror => {}
            ConductorOptics::EtaK { eta, k } => {
                if is_grey(&eta.value, 0.0) && is_grey(&k.value, 1.0) {
                    return;
                }
                if let Some(name) = metal(&eta.value, &k.value) {
                    element.string("material", name);
                } else {
                    element.extend(self.varying("eta", eta));
                    element.extend(self.varying("k", k));
                }
            }
            ConductorOptics::Reflectance(_) => self.lacks(span, "a metal by its reflectance"),
        }
    }

    /// Roughness by the model's own measure.
    fn roughness(&mut self, element: &mut Element, roughness: &RoughnessDesc) {
        let RoughnessDesc { u, v, remap, distribution, shadowing } = roughness;
        if is_smooth(roughness) {
            return;
        }
        if *distribution == MicrofacetKind::Ggx {
            element.string("distribution", "ggx");
        }
        if *shadowing == ShadowingKind::Correlated {
            let message =
                "in Mitsuba masking and shadowing of rough surfaces are independent: a little less is reflected";
            self.draft.differs(u.span, message);
        }
        let [alpha_u, alpha_v] = [u, v].map(|r| self.alpha(r, *remap));
        if alpha_u.value == alpha_v.value {
            self.number_unless(element, "alpha", &alpha_u, 0.1);
        } else {
            element.extend(self.varying_number("alpha_u", &alpha_u));
            element.extend(self.varying_number("alpha_v", &alpha_v));
        }
    }

    /// α is the root of pbrt's roughness, which the renderer takes in single precision.
    fn alpha(&mut self, roughness: &Spanned<Varying>, remap: bool) -> Spanned<Varying> {
        if !remap {
            return roughness.clone();
        }
        let Some(v) = roughness.value.number() else {
            self.lacks(roughness.span, "a texture of roughness whose root is meant (\"bool remaproughness\" true)");
            return roughness.clone();
        };
        let wanted = (v as f32).sqrt();
        Spanned::new(Varying::constant(shortest(f64::from(wanted), |a| a as f32 == wanted)), roughness.span)
    }

    /// Two indices whose ratio it is, by names if they have some.
    fn index(&mut self, element: &mut Element, eta: &Spanned<SpectrumDesc>, default: &str) {
        let SpectrumDesc::Constant(eta_value) = eta.value else {
            return self.lacks(eta.span, "an index of refraction by wavelength");
        };
        let air = INDICES.iter().find(|(name, _)| *name == "air").map_or(1.0, |(_, index)| *index);
        if let Some((name, _)) = INDICES.iter().find(|(_, index)| index / air == eta_value) {
            if *name != default {
                element.string("int_ior", name);
            }
            return;
        }
        element.push(Element::parameter("float", "int_ior", &double(eta_value)));
        element.push(Element::parameter("float", "ext_ior", "1"));
    }
}

fn rough(smooth: &'static str, rough: &'static str, roughness: &RoughnessDesc) -> &'static str {
    if is_smooth(roughness) { smooth } else { rough }
}

fn is_smooth(roughness: &RoughnessDesc) -> bool {
    [&roughness.u, &roughness.v].iter().all(|r| r.value.number() == Some(0.0))
}

/// Whether a value is this number, or the grey colour of it.
fn is_grey(value: &Varying, number: f64) -> bool {
    matches!(value, Varying::Everywhere(SpectrumDesc::Rgb(rgb)) if *rgb == [number; 3])
}

/// The name of a metal whose indices these are.
fn metal<'a>(eta: &'a Varying, k: &Varying) -> Option<&'a str> {
    let (Varying::Everywhere(SpectrumDesc::Named(eta)), Varying::Everywhere(SpectrumDesc::Named(k))) = (eta, k) else {
        return None;
    };
    let name = eta.strip_prefix("metal-")?.strip_suffix("-eta")?;
    (*k == format!("metal-{name}-k") && spectra::named(eta).is_some()).then_some(name)
}
