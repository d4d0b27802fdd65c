//! Materials that no file names: where there is nothing, and surfaces with holes. They come after those of the file.

use std::collections::HashMap;

use tyndall::{material::Material, scene};

use super::{Builder, material_id, spectra::Measure};
use crate::{
    desc::{MaterialId, MaterialKind, TextureId, Varying},
    source::Spanned,
};

/// They, in the making.
#[derive(Debug)]
pub(super) struct Made {
    first: u32,
    list: Vec<Material>,
    /// By material, and by the texture or the number of their opacity.
    pierced: HashMap<(MaterialId, Result<TextureId, u64>), scene::MaterialId>,
}

impl Made {
    /// For a file of so many materials.
    pub(super) fn new(materials: usize) -> Self {
        Self { first: materials as u32, list: vec![Material::Null, Material::Hole], pierced: HashMap::new() }
    }

    /// A boundary of media.
    pub(super) fn null(&self) -> scene::MaterialId {
        scene::MaterialId(self.first)
    }

    /// Nothing.
    fn hole(&self) -> scene::MaterialId {
        scene::MaterialId(self.first + 1)
    }

    fn push(&mut self, material: Material) -> scene::MaterialId {
        self.list.push(material);
        scene::MaterialId(self.first + self.list.len() as u32 - 1)
    }

    /// All of them, in order.
    pub(super) fn take(&mut self) -> Vec<Material> {
        std::mem::take(&mut self.list)
    }
}

/// The materials that one is made of.
pub(crate) fn parts(kind: &MaterialKind) -> &[Spanned<MaterialId>] {
    match kind {
        MaterialKind::Mix { of, .. } | MaterialKind::TwoFaced { of } => of,
        MaterialKind::Mask { of, .. } | MaterialKind::Embossed { of, .. } => std::slice::from_ref(of),
        MaterialKind::Diffuse { .. }
        | MaterialKind::Conductor { .. }
        | MaterialKind::Dielectric { .. }
        | MaterialKind::ThinDielectric { .. }
        | MaterialKind::DiffuseTransmission { .. }
        | MaterialKind::Plastic { .. }
        | MaterialKind::Principled(_)
        | MaterialKind::PrincipledThin(_)
        | MaterialKind::Coated(_)
        | MaterialKind::Hair(_)
        | MaterialKind::Measured { .. }
        | MaterialKind::Interface => &[],
    }
}

impl Builder<'_> {
    /// A material with holes where `opacity` is not 1, made once.
    pub(super) fn pierced(&mut self, of: MaterialId, opacity: &Spanned<Varying>) -> Option<scene::MaterialId> {
        let key = match &opacity.value {
            Varying::Texture(id) => Ok(*id),
            Varying::Everywhere(_) => Err(opacity.value.number()?.to_bits()),
        };
        if let Some(id) = self.made.pierced.get(&(of, key)) {
            return Some(*id);
        }
        let amount = self.texture(opacity, Measure::Share)?;
        let id = self.made.push(Material::Mix { of: [self.made.hole(), material_id(of)], amount });
        self.made.pierced.insert((of, key), id);
        Some(id)
    }
}
