//! What the user wrote, in one form for every scene language.
//!
//! A [`SceneDesc`] says what a scene file says and no more: meshes and images are still paths, named measured data are
//! still names, lengths are still in the user's unit. Values carry [`Span`]s, so that whoever makes a scene of it can point
//! at the words. References between parts are resolved: they are ids into the arrays of [`SceneDesc`].
//!
//! # Conventions
//!
//! Matrices act on column vectors, in double precision, and map to world space.
//!
//! - **Lengths** are scene units; one scene unit is [`Options::unit`]. Coefficients of media are per scene unit, except
//!   those of a [preset](Coefficients::Preset).
//! - **The camera** looks along its own +z; +x points to the right of the image and +y up. A matrix of positive determinant
//!   sees the world as left-handed, as pbrt does; Mitsuba's sensors, whose +x points left, come with their x axis flipped.
//! - **The natural normal** of a surface points away from the centre (sphere, cube), along the shape's +z (disk, rectangle),
//!   or by the right hand around the corners of a triangle in the shape's own space. It is carried to the world as a normal:
//!   a mirroring matrix does not turn a body inside out. Where vertex normals are given they choose the side.
//!   [`ShapeDesc::reverse_orientation`] turns it round, vertex normals too. "Inside" is the side that it points away from.
//! - **Colours** are linear sRGB.

mod camera;
mod hair;
mod light;
mod material;
mod medium;
mod principled;
mod settings;
mod shape;
mod spectrum;
mod texture;
mod uses;

use std::path::PathBuf;

pub use camera::{
    ApertureDesc, CameraDesc, CameraKind, CropDesc, DistantTarget, FilmDesc, FilterDesc, FovAxis, FrameDesc,
    ImageWindow, PartsDesc, RealisticDesc, SphereMapping, ThinLensDesc,
};
pub use hair::{HairColourDesc, HairDesc};
pub use light::{
    AreaLightDesc, EmissionDesc, EnvironmentMapping, Evenness, LightDesc, LightKind, Magnitude, SpotFalloff, Spread,
};
pub use material::{
    BaseDesc, CoatedDesc, ConductorOptics, MaterialDesc, MaterialKind, MicrofacetKind, ReliefMap, RoughnessDesc,
    ShadowingKind,
};
pub use medium::{Coefficients, MediumDesc, MediumInterface, PhaseDesc};
pub use principled::{BurleyDesc, PrincipledDesc, PrincipledThinDesc};
pub use settings::{Ignored, IntegratorDesc, LengthUnit, Options, SamplerDesc};
pub(crate) use shape::granular;
pub use shape::{
    CurveDesc, DisplacementDesc, GroupDesc, InstanceDesc, MeshDesc, PatchDesc, Radii, ShapeDesc, ShapeKind, StrandsDesc,
};
pub use spectrum::SpectrumDesc;
pub use texture::{
    Board, Encoding, ImageDesc, MappingDesc, NoiseDesc, TextureDesc, TextureId, TextureKind, Varying, WrapKind,
};

use crate::error::SceneError;
pub use crate::source::{Span, Spanned};

/// A material of [`SceneDesc::materials`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MaterialId(pub u32);

/// A medium of [`SceneDesc::media`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MediumId(pub u32);

/// A group of [`SceneDesc::groups`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct GroupId(pub u32);

/// A scene as the user wrote it.
#[derive(Clone, Debug)]
pub struct SceneDesc {
    /// Settings of the scene as a whole.
    pub options: Options,
    /// Where it is seen from.
    pub camera: CameraDesc,
    /// What it is seen with.
    pub film: FilmDesc,
    /// How many samples, and which.
    pub sampler: SamplerDesc,
    /// How light is transported.
    pub integrator: IntegratorDesc,
    /// Textures, named or not; a part of one comes before it.
    pub textures: Vec<TextureDesc>,
    /// Materials, named or not.
    pub materials: Vec<MaterialDesc>,
    /// Participating media.
    pub media: Vec<MediumDesc>,
    /// Shapes in the world.
    pub shapes: Vec<ShapeDesc>,
    /// Groups of shapes that are placed by instances only.
    pub groups: Vec<GroupDesc>,
    /// Placed groups.
    pub instances: Vec<InstanceDesc>,
    /// Lights that are not surfaces: points, spots, distant ones, environments.
    pub lights: Vec<LightDesc>,
    /// Words that were read and have no effect here, each with the reason.
    pub ignored: Vec<Ignored>,
    /// What means something else in the language, and what was left out because it is not supported yet, if the user wanted no
    /// more than warnings of it.
    pub warnings: Vec<SceneError>,
}

impl SceneDesc {
    /// A material. `None` for an id of another scene.
    pub fn material(&self, id: MaterialId) -> Option<&MaterialDesc> {
        self.materials.get(id.0 as usize)
    }

    /// A texture. `None` for an id of another scene.
    pub fn texture(&self, id: TextureId) -> Option<&TextureDesc> {
        self.textures.get(id.0 as usize)
    }

    /// A medium. `None` for an id of another scene.
    pub fn medium(&self, id: MediumId) -> Option<&MediumDesc> {
        self.media.get(id.0 as usize)
    }

    /// Every mesh, image and lens that the scene names, in the order of their mention.
    pub fn files(&self) -> impl Iterator<Item = &PathBuf> {
        let shapes = self.shapes.iter().chain(self.groups.iter().flat_map(|group| &group.shapes));
        let meshes = shapes.filter_map(|shape| match &shape.kind {
            ShapeKind::Ply { path, .. }
            | ShapeKind::Obj { path, .. }
            | ShapeKind::Serialized { path, .. }
            | ShapeKind::Strands(StrandsDesc { path, .. }) => Some(path),
            _ => None,
        });
        let pictures = self.textures.iter().filter_map(|texture| match &texture.kind {
            TextureKind::Image(image) => Some(&image.path),
            _ => None,
        });
        let skies = self.lights.iter().filter_map(|light| match &light.kind {
            LightKind::Environment { path, .. } | LightKind::Goniometric { path, .. } => Some(path),
            LightKind::Portal { path, .. } => path.as_ref(),
            _ => None,
        });
        meshes.chain(pictures).chain(skies).chain(self.camera.files()).map(|file| &file.value)
    }

    /// A group. `None` for an id of another scene.
    pub fn group(&self, id: GroupId) -> Option<&GroupDesc> {
        self.groups.get(id.0 as usize)
    }
}

/// A file that the scene names, with directories resolved. It has not been opened.
pub type FileRef = Spanned<PathBuf>;
