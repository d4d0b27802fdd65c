//! Shapes, groups and instances. Geometry stays in the shape's own space.

use glam::DMat4;
use tyndall::granular::Granular;
use tyndall::shape::{Basis, DiskMapping, SpherePart, Style, Turn};

use crate::error::SceneError;

use super::{AreaLightDesc, FileRef, GroupId, MaterialId, MediumInterface, Span, Spanned, Varying};

/// A shape with everything that was bound to it.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapeDesc {
    /// The words that made it.
    pub span: Span,
    /// Its name, if the language gives names to shapes.
    pub name: Option<String>,
    /// The geometry.
    pub kind: ShapeKind,
    /// Its own space to world (to the group's space, in a [`GroupDesc`]).
    pub to_world: DMat4,
    /// Whether the natural normal is turned round (see [`crate::desc`]).
    pub reverse_orientation: bool,
    /// What the surface is made of.
    pub material: Spanned<MaterialId>,
    /// How much of the surface is there, in [0, 1], if not all of it; the rest are holes that nothing meets (pbrt).
    pub opacity: Option<Spanned<Varying>>,
    /// Light that it emits.
    pub emission: Option<AreaLightDesc>,
    /// What is on either side of it, if the user says.
    pub interface: Option<MediumInterface>,
    /// Its priority, if it is a body that may overlap others: of those at a point the highest is there.
    pub priority: Option<Spanned<i32>>,
    /// What it is among grains, if the user says.
    pub granular: Option<Spanned<Granular>>,
}

/// The words of scene files for what a shape is among grains.
const GRANULAR: [(&str, Granular); 2] = [("grain", Granular::Grain), ("proxy", Granular::Proxy)];

impl ShapeDesc {
    /// The word for what it is among grains.
    pub(crate) fn granular_word(&self) -> Option<&'static str> {
        let granular = self.granular?.value;
        GRANULAR.into_iter().find(|(_, known)| *known == granular).map(|(word, _)| word)
    }
}

/// What a shape is among grains, by its word.
pub(crate) fn granular(given: Spanned<&str>) -> Result<Spanned<Granular>, SceneError> {
    match GRANULAR.into_iter().find(|(word, _)| *word == given.value) {
        Some((_, granular)) => Ok(given.map(|_| granular)),
        None => Err(SceneError::at(given.span, format!("nothing is \"{}\" among grains", given.value))
            .suggest(given.value, GRANULAR.map(|known| known.0))),
    }
}

/// The geometry of a shape. Lengths are scene units before [`ShapeDesc::to_world`].
#[derive(Clone, Debug, PartialEq)]
pub enum ShapeKind {
    /// A sphere around the origin.
    Sphere {
        /// Radius, positive.
        radius: f64,
        /// What of it there is.
        part: SpherePart,
    },
    /// A disk, or a ring, around the z axis.
    Disk {
        /// Its z.
        height: f64,
        /// Outer radius, positive.
        radius: f64,
        /// Inner radius: 0 for a full disk.
        inner_radius: f64,
        /// How far round it goes.
        turn: Turn,
        /// Its texture coordinates.
        mapping: DiskMapping,
    },
    /// A cylinder around the z axis, without lids.
    Cylinder {
        /// Radius, positive.
        radius: f64,
        /// Its ends, in order.
        heights: [f64; 2],
        /// How far round it goes.
        turn: Turn,
    },
    /// The square [-1, 1]² at z = 0, normal +z.
    Rectangle,
    /// The cube [-1, 1]³.
    Cube,
    /// Triangles written in the scene.
    TriangleMesh(MeshDesc),
    /// Bilinear patches written in the scene.
    BilinearMesh(PatchDesc),
    /// A PLY file: triangles and quadrilaterals.
    Ply {
        /// The file.
        path: FileRef,
        /// Whether normals of the file are left out and each face is flat.
        face_normals: bool,
        /// Whether a file without normals is shaded with smooth ones, weighted by angle (Mitsuba, unless `face_normals`),
        /// or flat (pbrt).
        smooth_normals: bool,
        /// Whether v of the texture coordinates runs the other way.
        flip_tex_coords: bool,
        /// How its vertices are moved, if they are (pbrt).
        displacement: Option<DisplacementDesc>,
    },
    /// The limit surface of triangles under Loop subdivision (pbrt). Its natural normal is against the winding.
    Subdivision {
        /// Corners.
        positions: Vec<[f32; 3]>,
        /// Three corners a triangle.
        indices: Vec<[u32; 3]>,
        /// How often triangles are divided.
        levels: u32,
    },
    /// A Wavefront OBJ file.
    Obj {
        /// The file.
        path: FileRef,
        /// Whether normals of the file are left out and each face is flat.
        face_normals: bool,
        /// Whether a file without normals is shaded with smooth ones, weighted by angle (Mitsuba, unless `face_normals`),
        /// or flat (pbrt).
        smooth_normals: bool,
        /// Whether v of the texture coordinates runs the other way.
        flip_tex_coords: bool,
    },
    /// A mesh of a file in Mitsuba's own format.
    Serialized {
        /// The file.
        path: FileRef,
        /// Which of its meshes, from 0.
        index: u32,
        /// Whether normals of the file are left out and each face is flat; a mesh without normals is smoothed otherwise.
        face_normals: bool,
    },
    /// A strand written in the scene (pbrt).
    Curve(CurveDesc),
    /// Strands of a file.
    Strands(StrandsDesc),
}

impl ShapeKind {
    /// A whole sphere.
    pub const fn sphere(radius: f64) -> Self {
        Self::Sphere { radius, part: SpherePart::WHOLE }
    }
}

/// A strand. Checked by the reader: the points make a whole number of segments, widths are not negative and not both 0, and a
/// ribbon has one normal more than it has segments, which others have none of.
#[derive(Clone, Debug, PartialEq)]
pub struct CurveDesc {
    /// How the points make a curve.
    pub basis: Basis,
    /// What is around it.
    pub style: Style,
    /// Control points.
    pub points: Vec<[f32; 3]>,
    /// Normals of a ribbon.
    pub normals: Vec<[f32; 3]>,
    /// Widths at the two ends.
    pub widths: [f64; 2],
}

/// Strands of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct StrandsDesc {
    /// The file: cyHair's if its name ends in `.hair`, else lines of x, y, z and radius, and an empty one after each strand.
    pub path: FileRef,
    /// How the points of a strand make a curve. A curve through all but the ends of its points has its ends twice.
    pub basis: Basis,
    /// What is around it.
    pub style: Style,
    /// Whose lengths the radii are.
    pub radii: Radii,
}

/// Whose lengths radii are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Radii {
    /// Of the shape's own space, as its points.
    Own,
    /// Of the world, whatever happens to the points (Mitsuba).
    World,
}

/// Heights over a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct DisplacementDesc {
    /// The height along the normals, before [`ShapeDesc::to_world`].
    pub height: Spanned<Varying>,
    /// Triangles are cut until their edges are shorter than this, in the world; positive.
    pub edge_length: f64,
}

/// Triangles. Checked by the reader: indices are in range, and normals and coordinates are none or as many as positions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshDesc {
    /// Corners.
    pub positions: Vec<[f32; 3]>,
    /// Three corners a triangle.
    pub indices: Vec<[u32; 3]>,
    /// Normals at the corners, or none. Not necessarily unit vectors.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates at the corners, or none.
    pub uvs: Vec<[f32; 2]>,
}

/// Bilinear patches: `p(u,v)` between corners `p00, p10, p01, p11`, in this order; the natural normal is ∂p/∂u × ∂p/∂v.
/// Checked as [`MeshDesc`] is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PatchDesc {
    /// Corners.
    pub positions: Vec<[f32; 3]>,
    /// Four corners a patch.
    pub indices: Vec<[u32; 4]>,
    /// Normals at the corners, or none.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates at the corners, or none.
    pub uvs: Vec<[f32; 2]>,
}

/// Shapes that are placed together.
#[derive(Clone, Debug, PartialEq)]
pub struct GroupDesc {
    /// The words that name it.
    pub span: Span,
    /// Its name.
    pub name: String,
    /// Its shapes.
    pub shapes: Vec<ShapeDesc>,
}

/// A placed group.
#[derive(Clone, Debug, PartialEq)]
pub struct InstanceDesc {
    /// The words that made it.
    pub span: Span,
    /// Which group.
    pub group: Spanned<GroupId>,
    /// The group's space to world.
    pub to_world: DMat4,
}
