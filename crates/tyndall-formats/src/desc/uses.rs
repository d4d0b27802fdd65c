//! What refers to textures.

use super::{
    BaseDesc, CoatedDesc, ConductorOptics, LightKind, MaterialKind, ReliefMap, RoughnessDesc, SceneDesc, ShapeDesc,
    ShapeKind, Spanned, TextureId, TextureKind, Varying,
};

impl SceneDesc {
    /// Every texture that a material, a shape or another texture refers to, as often as it does.
    pub fn textures_in_use(&self) -> impl Iterator<Item = TextureId> {
        let shapes = self.shapes.iter().chain(self.groups.iter().flat_map(|group| &group.shapes));
        let quantities = self.materials.iter().flat_map(|material| material.kind.quantities());
        let quantities = quantities.chain(shapes.flat_map(ShapeDesc::quantities));
        let quantities = quantities.chain(self.lights.iter().filter_map(|light| light.kind.slide()));
        let quantities = quantities.chain(self.textures.iter().flat_map(|texture| texture.kind.quantities()));
        quantities.filter_map(|quantity| match quantity.value {
            Varying::Texture(id) => Some(id),
            Varying::Everywhere(_) => None,
        })
    }
}

impl ShapeDesc {
    fn quantities(&self) -> Vec<&Spanned<Varying>> {
        let height = match &self.kind {
            ShapeKind::Ply { displacement: Some(displacement), .. } => Some(&displacement.height),
            _ => None,
        };
        let pattern = self.emission.as_ref().and_then(|light| light.pattern.as_ref());
        self.opacity.iter().chain(height).chain(pattern).collect()
    }
}

impl LightKind {
    /// The picture that it shines through.
    fn slide(&self) -> Option<&Spanned<Varying>> {
        match self {
            Self::Spot { slide, .. } | Self::Projector { slide, .. } => slide.as_ref(),
            _ => None,
        }
    }
}

impl MaterialKind {
    fn quantities(&self) -> Vec<&Spanned<Varying>> {
        match self {
            Self::Diffuse { reflectance } => vec![reflectance],
            Self::Conductor { optics, roughness, tint } => {
                optics.quantities().into_iter().chain(roughness.quantities()).chain(tint).collect()
            }
            Self::Dielectric { roughness, reflection_tint, transmission_tint, .. } => {
                roughness.quantities().into_iter().chain(reflection_tint).chain(transmission_tint).collect()
            }
            Self::ThinDielectric { reflection_tint, transmission_tint, .. } => {
                reflection_tint.iter().chain(transmission_tint).collect()
            }
            Self::DiffuseTransmission { reflectance, transmittance, .. } => vec![reflectance, transmittance],
            Self::Plastic { reflectance, roughness, tint, .. } => {
                let roughness = roughness.iter().flat_map(RoughnessDesc::quantities);
                [reflectance].into_iter().chain(roughness).chain(tint).collect()
            }
            Self::Principled(solid) => solid.quantities(),
            Self::PrincipledThin(sheet) => sheet.quantities(),
            Self::Coated(coated) => coated.quantities(),
            Self::Hair(hair) => hair.quantities(),
            Self::Mix { amount, .. } => vec![amount],
            Self::Mask { opacity, .. } => vec![opacity],
            Self::Embossed { map: ReliefMap::Heights { texture, .. } | ReliefMap::Normals(texture), .. } => {
                vec![texture]
            }
            Self::Measured { .. } | Self::Interface | Self::TwoFaced { .. } => Vec::new(),
        }
    }
}

impl CoatedDesc {
    fn quantities(&self) -> Vec<&Spanned<Varying>> {
        let base = match &self.base {
            BaseDesc::Diffuse(reflectance) => vec![reflectance],
            BaseDesc::Conductor { optics, roughness } => {
                optics.quantities().into_iter().chain(roughness.quantities()).collect()
            }
        };
        let own = [&self.thickness, &self.albedo, &self.g];
        own.into_iter().chain(self.roughness.quantities()).chain(base).collect()
    }
}

impl ConductorOptics {
    fn quantities(&self) -> Vec<&Spanned<Varying>> {
        match self {
            Self::EtaK { eta, k } => vec![eta, k],
            Self::Reflectance(reflectance) => vec![reflectance],
            Self::Mirror => Vec::new(),
        }
    }
}

impl RoughnessDesc {
    fn quantities(&self) -> [&Spanned<Varying>; 2] {
        [&self.u, &self.v]
    }
}

impl TextureKind {
    fn quantities(&self) -> Vec<&Spanned<Varying>> {
        match self {
            Self::Plain(value) => vec![value],
            Self::Scale(of) | Self::DirectionMix { of, .. } | Self::Checkerboard { of, .. } | Self::Dots { of, .. } => {
                of.iter().collect()
            }
            Self::Mix { of, amount } => of.iter().chain([amount]).collect(),
            Self::Bilinear { corners, .. } => corners.iter().collect(),
            Self::Image(_)
            | Self::Attribute { .. }
            | Self::Fbm(_)
            | Self::Wrinkled(_)
            | Self::Windy { .. }
            | Self::Marble { .. } => Vec::new(),
        }
    }
}
