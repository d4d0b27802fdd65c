//! Materials, each by its name.

use super::Pen;
use super::entity::{Entity, quoted};
use crate::desc::{
    ConductorOptics, MaterialDesc, MaterialKind, MicrofacetKind, RoughnessDesc, ShadowingKind, Span, Spanned,
    SpectrumDesc, Varying,
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
    }
}

impl Pen<'_, '_> {
    pub(super) fn all_materials(&mut self) {
        let desc = self.draft.desc;
        for (index, material) in desc.materials.iter().enumerate() {
            let name = self.materials[index].clone();
            self.material(&name, material);
        }
    }

    fn material(&mut self, name: &str, material: &MaterialDesc) {
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
                self.conductor(&mut entity, optics);
                self.roughness(&mut entity, roughness);
                self.no_tint(tint.as_ref());
            }
            MaterialKind::Dielectric { eta, roughness, reflection_tint, transmission_tint } => {
                self.index(&mut entity, eta);
                self.roughness(&mut entity, roughness);
                self.no_tint(reflection_tint.as_ref());
                self.no_tint(transmission_tint.as_ref());
            }
            MaterialKind::ThinDielectric { eta, reflection_tint, transmission_tint } => {
                self.index(&mut entity, eta);
                self.no_tint(reflection_tint.as_ref());
                self.no_tint(transmission_tint.as_ref());
            }
            MaterialKind::DiffuseTransmission { reflectance, transmittance, scale } => {
                self.colour(&mut entity, "reflectance", reflectance, 0.25);
                self.colour(&mut entity, "transmittance", transmittance, 0.25);
                entity.float_unless("scale", *scale, 1.0);
            }
            MaterialKind::Plastic { .. } => return self.stand_in(name, span, "the material \"plastic\""),
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
        self.entity(entity);
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

    fn conductor(&mut self, entity: &mut Entity, optics: &ConductorOptics) {
        let is_copper =
            |value: &Varying, which| matches!(value, Varying::Everywhere(SpectrumDesc::Named(name)) if name == which);
        match optics {
            ConductorOptics::EtaK { eta, k } => {
                if !is_copper(&eta.value, "metal-Cu-eta") || !is_copper(&k.value, "metal-Cu-k") {
                    self.colour(entity, "eta", eta, f64::NAN);
                    self.colour(entity, "k", k, f64::NAN);
                }
            }
            ConductorOptics::Reflectance(reflectance) => self.colour(entity, "reflectance", reflectance, f64::NAN),
            // The index i reflects all light at every angle.
            ConductorOptics::Mirror => {
                entity.list("rgb", "eta", &[0.0; 3]);
                entity.list("rgb", "k", &[1.0; 3]);
            }
        }
    }

    fn roughness(&mut self, entity: &mut Entity, roughness: &RoughnessDesc) {
        let RoughnessDesc { u, v, remap, distribution, shadowing } = roughness;
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
            self.number(entity, "roughness", u, 0.0);
        } else {
            self.number(entity, "uroughness", u, 0.0);
            self.number(entity, "vroughness", v, 0.0);
        }
        if !remap {
            entity.boolean("remaproughness", false);
        }
    }
}
