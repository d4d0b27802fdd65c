//! Materials, each by its name.

use tyndall::relief::Rule;

use super::Pen;
use super::entity::{Entity, quoted};
use crate::desc::{
    BaseDesc, CoatedDesc, ConductorOptics, HairColourDesc, HairDesc, MappingDesc, MaterialDesc, MaterialId,
    MaterialKind, MicrofacetKind, ReliefMap, RoughnessDesc, ShadowingKind, Span, Spanned, SpectrumDesc, TextureKind,
    Varying, WrapKind,
};

/// pbrt's word for a material, or the nearest: materials without a name are called by it.
pub(super) fn word(kind: &MaterialKind) -> &'static str {
    match kind {
        MaterialKind::Diffuse { .. } => "diffuse",
        MaterialKind::Conductor { .. } => "conductor",
        MaterialKind::Dielectric { .. } => "dielectric",
        MaterialKind::ThinDielectric { .. } => "thindielectric",
        MaterialKind::DiffuseTransmission { .. } => "diffusetransmission",
        MaterialKind::Plastic { .. } => "plastic",
        MaterialKind::Interface => "interface",
        MaterialKind::Mix { .. } => "mix",
        MaterialKind::Mask { .. } => "mask",
        MaterialKind::TwoFaced { .. } => "twofaced",
        MaterialKind::Principled(_) => "principled",
        MaterialKind::PrincipledThin(_) => "principledthin",
        MaterialKind::Coated(coated) => match coated.base {
            BaseDesc::Diffuse(_) => "coateddiffuse",
            BaseDesc::Conductor { .. } => "coatedconductor",
        },
        MaterialKind::Measured { .. } => "measured",
        MaterialKind::Hair(_) => "hair",
        MaterialKind::Embossed { .. } => "embossed",
    }
}

impl Pen<'_, '_> {
    pub(super) fn all_materials(&mut self) {
        let desc = self.draft.desc;
        for (index, material) in desc.materials.iter().enumerate() {
            // What is embossed is said where it is.
            let id = MaterialId(index as u32);
            if !self.draft.stands_inside(id, |kind| matches!(kind, MaterialKind::Embossed { .. })) {
                let name = self.materials[index].clone();
                self.material(&name, material, None);
            }
        }
    }

    /// A material, with a relief on it if there is one.
    fn material(&mut self, name: &str, material: &MaterialDesc, relief: Option<&ReliefMap>) {
        let span = material.span;
        let mut entity = Entity::new("MakeNamedMaterial", &[name]);
        // A mask is an "alpha" of the shapes that have it; what is masked is a material of its own.
        if !matches!(material.kind, MaterialKind::Mask { .. }) {
            entity.string("type", word(&material.kind));
        }
        match &material.kind {
            MaterialKind::Diffuse { reflectance } => {
                self.both_sides(material);
                self.colour(&mut entity, "reflectance", reflectance, 0.5);
            }
            MaterialKind::Conductor { optics, roughness, tint } => {
                self.both_sides(material);
                self.conductor(&mut entity, optics, ["eta", "k"]);
                self.roughness(&mut entity, roughness, "");
                self.no_tint(tint.as_ref());
            }
            MaterialKind::Dielectric { eta, roughness, reflection_tint, transmission_tint } => {
                self.index(&mut entity, "eta", eta);
                self.roughness(&mut entity, roughness, "");
                self.no_tint(reflection_tint.as_ref());
                self.no_tint(transmission_tint.as_ref());
            }
            MaterialKind::ThinDielectric { eta, reflection_tint, transmission_tint } => {
                self.index(&mut entity, "eta", eta);
                self.no_tint(reflection_tint.as_ref());
                self.no_tint(transmission_tint.as_ref());
            }
            MaterialKind::DiffuseTransmission { reflectance, transmittance, scale } => {
                self.colour(&mut entity, "reflectance", reflectance, 0.25);
                self.colour(&mut entity, "transmittance", transmittance, 0.25);
                entity.float_unless("scale", *scale, 1.0);
            }
            MaterialKind::Plastic { .. } => return self.stand_in(name, span, "the material \"plastic\""),
            MaterialKind::Principled(_) => return self.stand_in(name, span, "the material \"principled\""),
            MaterialKind::PrincipledThin(_) => return self.stand_in(name, span, "the material \"principledthin\""),
            MaterialKind::Coated(coated) => self.coated(&mut entity, coated),
            MaterialKind::Hair(hair) => self.hair(&mut entity, hair),
            MaterialKind::Measured { path } => {
                self.both_sides(material);
                entity.string("filename", &self.draft.relative(&path.value, path.span));
            }
            MaterialKind::Embossed { of, map, rule } => {
                if *rule != Rule::Pbrt {
                    self.draft.differs(span, "pbrt has other rules for reliefs that would turn light round");
                }
                return match self.draft.desc.material(of.value) {
                    Some(even) if relief.is_none() => self.material(name, even, Some(map)),
                    _ => self.stand_in(name, span, "a relief on a relief"),
                };
            }
            MaterialKind::Interface => {}
            MaterialKind::Mix { of: [first, second], amount } => {
                let names = [first, second].map(|part| quoted(self.material_name(part.value)));
                entity.param("string", "materials", &format!("[ {} {} ]", names[0], names[1]));
                self.number(&mut entity, "amount", amount, 0.5);
            }
            MaterialKind::Mask { .. } => return self.mask_in_a_mix(name, material),
            MaterialKind::TwoFaced { .. } => {
                return self.stand_in(name, span, "another material on each face (Mitsuba's \"twosided\")");
            }
        }
        match relief {
            None => {}
            Some(ReliefMap::Heights { texture, scale }) => {
                if *scale != 1.0 {
                    self.lacks(texture.span, "a factor on the heights of a relief");
                }
                self.number(&mut entity, "displacement", texture, f64::NAN);
            }
            Some(ReliefMap::Normals(texture)) => self.normal_map(&mut entity, texture),
        }
        self.entity(entity);
    }

    /// A picture of normals, as it is.
    fn normal_map(&mut self, entity: &mut Entity, texture: &Spanned<Varying>) {
        let desc = self.draft.desc;
        let Varying::Texture(id) = texture.value else {
            return self.lacks(texture.span, "normals that are no picture");
        };
        match desc.texture(id).map(|texture| &texture.kind) {
            Some(TextureKind::Image(image)) if image.mapping == MappingDesc::UV && image.wrap == WrapKind::Repeat => {
                let file = self.draft.relative(&image.path.value, image.path.span);
                entity.string("normalmap", &file);
            }
            _ => self.lacks(texture.span, "normals that are no picture as it is"),
        }
    }

    fn hair(&mut self, entity: &mut Entity, hair: &HairDesc) {
        let HairDesc { colour, eta, beta_m, beta_n, alpha } = hair;
        match colour {
            HairColourDesc::SigmaA(sigma_a) => self.colour(entity, "sigma_a", sigma_a, f64::NAN),
            HairColourDesc::Reflectance(colour) => self.colour(entity, "reflectance", colour, f64::NAN),
            HairColourDesc::Pigments { eumelanin, pheomelanin } => {
                self.number(entity, "eumelanin", eumelanin, f64::NAN);
                self.number(entity, "pheomelanin", pheomelanin, 0.0);
            }
        }
        self.number(entity, "eta", eta, 1.55);
        self.number(entity, "beta_m", beta_m, 0.3);
        self.number(entity, "beta_n", beta_n, 0.3);
        self.number(entity, "alpha", alpha, 2.0);
    }

    fn coated(&mut self, entity: &mut Entity, coated: &CoatedDesc) {
        let metal = matches!(coated.base, BaseDesc::Conductor { .. });
        match &coated.base {
            BaseDesc::Diffuse(reflectance) => self.colour(entity, "reflectance", reflectance, 0.5),
            BaseDesc::Conductor { optics, roughness } => {
                self.conductor(entity, optics, ["conductor.eta", "conductor.k"]);
                self.roughness(entity, roughness, "conductor.");
            }
        }
        let prefix = if metal { "interface." } else { "" };
        self.index(entity, &format!("{prefix}eta"), &coated.eta);
        self.coat_roughness(entity, &coated.roughness, prefix);
        // A metal under the coat has said it.
        if !metal && !coated.roughness.remap {
            entity.boolean("remaproughness", false);
        }
        self.number(entity, "thickness", &coated.thickness, 0.01);
        self.colour(entity, "albedo", &coated.albedo, 0.0);
        self.number(entity, "g", &coated.g, 0.0);
        if coated.max_depth != 10 {
            entity.integer("maxdepth", coated.max_depth.into());
        }
        if coated.walks != 1 {
            entity.integer("nsamples", coated.walks.into());
        }
    }

    /// Grey stands for a material that there is no word for, where the user is lenient.
    fn stand_in(&mut self, name: &str, span: Span, what: &str) {
        self.lacks(span, what);
        let mut entity = Entity::new("MakeNamedMaterial", &[name]);
        entity.string("type", "diffuse");
        self.entity(entity);
    }

    /// pbrt has holes in shapes only.
    fn mask_in_a_mix(&mut self, name: &str, mask: &MaterialDesc) {
        let materials = &self.draft.desc.materials;
        let is_mask =
            |part: &Spanned<_>| self.draft.desc.material(part.value).is_some_and(|part| std::ptr::eq(part, mask));
        if materials.iter().any(|material| crate::build::made::parts(&material.kind).iter().any(is_mask)) {
            self.stand_in(name, mask.span, "holes in a part of a material");
        }
    }

    fn both_sides(&mut self, material: &MaterialDesc) {
        if !material.two_sided {
            let message = "in pbrt every material reflects on both sides: this one is black on its back";
            self.draft.differs(material.span, message);
        }
    }

    fn no_tint(&mut self, tint: Option<&Spanned<Varying>>) {
        if let Some(tint) = tint.filter(|tint| tint.value.number() != Some(1.0)) {
            self.lacks(tint.span, "a factor on what is reflected or transmitted");
        }
    }

    fn conductor(&mut self, entity: &mut Entity, optics: &ConductorOptics, [eta_name, k_name]: [&str; 2]) {
        let is_copper =
            |value: &Varying, which| matches!(value, Varying::Everywhere(SpectrumDesc::Named(name)) if name == which);
        match optics {
            ConductorOptics::EtaK { eta, k } => {
                if !is_copper(&eta.value, "metal-Cu-eta") || !is_copper(&k.value, "metal-Cu-k") {
                    self.colour(entity, eta_name, eta, f64::NAN);
                    self.colour(entity, k_name, k, f64::NAN);
                }
            }
            ConductorOptics::Reflectance(reflectance) => self.colour(entity, "reflectance", reflectance, f64::NAN),
            // The index i reflects all light at every angle.
            ConductorOptics::Mirror => {
                entity.list("rgb", eta_name, &[0.0; 3]);
                entity.list("rgb", k_name, &[1.0; 3]);
            }
        }
    }

    fn roughness(&mut self, entity: &mut Entity, roughness: &RoughnessDesc, prefix: &str) {
        let smooth = [&roughness.u, &roughness.v].iter().all(|r| r.value.number() == Some(0.0));
        // Without roughness its measure is only said where another one shares it.
        if smooth && (prefix.is_empty() || roughness.remap) {
            return;
        }
        self.coat_roughness(entity, roughness, prefix);
        if !roughness.remap {
            entity.boolean("remaproughness", false);
        }
    }

    /// Roughness but for its measure, which a coat shares with what is under it.
    fn coat_roughness(&mut self, entity: &mut Entity, roughness: &RoughnessDesc, prefix: &str) {
        let RoughnessDesc { u, v, remap: _, distribution, shadowing } = roughness;
        if [u, v].iter().all(|r| r.value.number() == Some(0.0)) {
            return;
        }
        if *distribution == MicrofacetKind::Beckmann {
            self.lacks(u.span, "Beckmann's distribution");
        }
        if *shadowing == ShadowingKind::Separable {
            let message =
                "in pbrt masking and shadowing of rough surfaces depend on each other: a little more is reflected";
            self.draft.differs(u.span, message);
        }
        if u.value == v.value {
            self.number(entity, &format!("{prefix}roughness"), u, 0.0);
        } else {
            self.number(entity, &format!("{prefix}uroughness"), u, 0.0);
            self.number(entity, &format!("{prefix}vroughness"), v, 0.0);
        }
    }
}
