//! The triangles and patches that shapes are made of.

use tyndall::{
    math::{Vec2, Vec3},
    shape::{Mesh, Patch},
};

use crate::{
    desc::{MeshDesc, PatchDesc, ShapeKind},
    mesh::{MeshError, TriangleMesh, read_obj, read_ply, read_serialized, subdivide},
};

/// The normals of a mesh from a file.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Normals {
    /// Each face is flat.
    Flat,
    /// Those of the file, if it has any.
    AsGiven,
    /// Those of the file, or else averages over the faces at a vertex.
    Smooth,
}

impl Normals {
    pub(super) fn asked(flat: bool, smooth: bool) -> Self {
        match (flat, smooth) {
            (true, _) => Self::Flat,
            (false, true) => Self::Smooth,
            (false, false) => Self::AsGiven,
        }
    }
}

/// The mesh of a file with the normals and texture coordinates that are asked for.
pub(super) fn finished(mut mesh: TriangleMesh, normals: Normals, flip_tex_coords: bool) -> Mesh {
    let smooth = (normals == Normals::Smooth && mesh.normals.is_none()).then(|| mesh.smooth_normals());
    let mut uvs = mesh.uvs.take().unwrap_or_default();
    if flip_tex_coords {
        for uv in &mut uvs {
            uv.y = 1.0 - uv.y;
        }
    }
    let is_pbrt = normals == Normals::AsGiven;
    let normals = match normals {
        Normals::Flat => Vec::new(),
        Normals::AsGiven | Normals::Smooth => mesh.normals.take().or(smooth).unwrap_or_default(),
    };
    let mesh = mesh_of(TriangleMesh { normals: Some(normals), uvs: Some(uvs), ..mesh });
    if is_pbrt { wound_by_normals(mesh) } else { mesh }
}

/// The triangles that a shape is made of as it stands, for whoever writes them elsewhere. `None` for what is no mesh, and for
/// one whose vertices a texture moves.
pub(crate) fn triangles_of(kind: &ShapeKind) -> Option<Result<Mesh, MeshError>> {
    let file = |mesh: Result<TriangleMesh, MeshError>, flat, smooth, flip| {
        mesh.map(|mesh| finished(mesh, Normals::asked(flat, smooth), flip))
    };
    Some(match kind {
        ShapeKind::Rectangle => Ok(rectangle()),
        ShapeKind::Cube => Ok(cube()),
        ShapeKind::TriangleMesh(mesh) => Ok(inline_mesh(mesh)),
        ShapeKind::Ply { path, face_normals, smooth_normals, flip_tex_coords, displacement: None } => {
            file(read_ply(&path.value), *face_normals, *smooth_normals, *flip_tex_coords)
        }
        ShapeKind::Obj { path, face_normals, smooth_normals, flip_tex_coords } => {
            file(read_obj(&path.value), *face_normals, *smooth_normals, *flip_tex_coords)
        }
        ShapeKind::Serialized { path, index, face_normals } => {
            file(read_serialized(&path.value, *index), *face_normals, true, false)
        }
        ShapeKind::Subdivision { positions, indices, levels } => {
            let positions: Vec<_> = positions.iter().copied().map(Vec3::from_array).collect();
            let named = |problem| MeshError { path: "this surface".into(), problem };
            subdivide(&positions, indices, *levels).map(mesh_of).map(wound_by_normals).map_err(named)
        }
        ShapeKind::Sphere { .. }
        | ShapeKind::Disk { .. }
        | ShapeKind::Cylinder { .. }
        | ShapeKind::Curve(_)
        | ShapeKind::Strands(_)
        | ShapeKind::BilinearMesh(_)
        | ShapeKind::Ply { displacement: Some(_), .. } => return None,
    })
}

pub(super) fn mesh_of(mesh: TriangleMesh) -> Mesh {
    let TriangleMesh { positions, indices, normals, uvs, .. } = mesh;
    let (normals, uvs) = (normals.unwrap_or_default(), uvs.unwrap_or_default());
    Mesh { positions, indices, normals, uvs, reversed: false }
}

pub(super) fn inline_mesh(mesh: &MeshDesc) -> Mesh {
    wound_by_normals(Mesh {
        positions: mesh.positions.iter().map(|p| Vec3::from_array(*p)).collect(),
        indices: mesh.indices.clone(),
        normals: mesh.normals.iter().map(|n| Vec3::from_array(*n)).collect(),
        uvs: mesh.uvs.iter().map(|uv| Vec2::from_array(*uv)).collect(),
        reversed: false,
    })
}

/// In pbrt the outside of a triangle is where the normals of its corners point, if it has some, however it is wound. Those of
/// a subdivided mesh are against the winding.
pub(super) fn wound_by_normals(mut mesh: Mesh) -> Mesh {
    if mesh.normals.is_empty() {
        return mesh;
    }
    for prim in 0..mesh.indices.len() {
        if is_against_normals(&mesh, mesh.indices[prim]) {
            mesh.indices[prim].swap(1, 2);
        }
    }
    mesh
}

/// The same surface for pbrt, to whom normals say where outside is: a triangle whose normals are against its winding gets
/// corners of its own, with normals turned round. Shading follows the side of the triangle, so nothing looks different.
pub(crate) fn with_normals_along_winding(mut mesh: Mesh) -> Mesh {
    if mesh.normals.is_empty() {
        return mesh;
    }
    let mut turned = std::collections::HashMap::new();
    for prim in 0..mesh.indices.len() {
        let corners = mesh.indices[prim];
        if !is_against_normals(&mesh, corners) {
            continue;
        }
        mesh.indices[prim] = corners.map(|i| {
            *turned.entry(i).or_insert_with(|| {
                let old = i as usize;
                mesh.positions.push(mesh.positions[old]);
                mesh.normals.push(-mesh.normals[old]);
                if let Some(&uv) = mesh.uvs.get(old) {
                    mesh.uvs.push(uv);
                }
                (mesh.positions.len() - 1) as u32
            })
        });
    }
    mesh
}

/// Whether a triangle is wound against the normals of its corners.
pub(crate) fn is_against_normals(mesh: &Mesh, corners: [u32; 3]) -> bool {
    let at = |of: &[Vec3]| corners.map(|i| of.get(i as usize).copied().unwrap_or_default());
    let ([a, b, c], normals) = (at(&mesh.positions), at(&mesh.normals));
    (b - a).cross(c - a).dot(normals.into_iter().sum()) < 0.0
}

pub(super) fn patches_of(patches: &PatchDesc) -> impl Iterator<Item = Patch> {
    patches.indices.iter().map(|corners| Patch::new(corners.map(|i| Vec3::from_array(patches.positions[i as usize]))))
}

/// The square [−1, 1]² at z = 0, seen from +z: as a flat patch with these corners.
pub(super) fn rectangle() -> Mesh {
    let corner = |x: f32, y: f32| Vec3::new(x, y, 0.0);
    Mesh {
        positions: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
        indices: vec![[0, 1, 2], [0, 2, 3]],
        normals: Vec::new(),
        uvs: vec![Vec2::new(0.0, 0.0), Vec2::new(1.0, 0.0), Vec2::new(1.0, 1.0), Vec2::new(0.0, 1.0)],
        reversed: false,
    }
}

/// The cube [−1, 1]³ with shared corners, so that it is closed.
pub(super) fn cube() -> Mesh {
    let sign = |bit: u32| if bit == 0 { -1.0 } else { 1.0 };
    let positions = (0..8u32).map(|i| Vec3::new(sign(i & 1), sign(i & 2), sign(i & 4))).collect();
    let indices = vec![
        [0, 2, 1],
        [1, 2, 3], // z = −1
        [4, 5, 6],
        [5, 7, 6], // z = +1
        [0, 1, 4],
        [1, 5, 4], // y = −1
        [2, 6, 3],
        [3, 6, 7], // y = +1
        [0, 4, 2],
        [2, 4, 6], // x = −1
        [1, 3, 5],
        [3, 7, 5], // x = +1
    ];
    Mesh { positions, indices, normals: Vec::new(), uvs: Vec::new(), reversed: false }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_face_of_the_cube_looks_outward() {
        let cube = cube();
        for prim in 0..12 {
            let [a, b, c] = cube.triangle(prim);
            assert!((b - a).cross(c - a).dot(a + b + c) > 0.0, "triangle {prim}");
        }
    }

    /// Of two triangles with the same normals the one that is wound against them is turned round; without normals
    /// none is.
    #[test]
    fn in_pbrt_the_outside_is_where_the_normals_point() {
        let mut mesh = MeshDesc {
            positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            indices: vec![[0, 1, 2], [0, 2, 1]],
            normals: vec![[0.3, 0.0, -1.0]; 3],
            uvs: Vec::new(),
        };
        assert_eq!(inline_mesh(&mesh).indices, [[0, 2, 1], [0, 2, 1]]);
        mesh.normals.clear();
        assert_eq!(inline_mesh(&mesh).indices, mesh.indices);
    }

    /// Only the triangle that is wound against its normals gets corners of its own.
    #[test]
    fn normals_are_turned_along_the_winding() {
        let n = Vec3::new(0.3, 0.0, -1.0);
        let mesh = Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            indices: vec![[0, 1, 2], [0, 2, 1]],
            normals: vec![n; 3],
            uvs: vec![Vec2::ZERO, Vec2::X, Vec2::Y],
            reversed: false,
        };
        let mended = with_normals_along_winding(mesh.clone());
        assert_eq!(mended.indices, [[3, 4, 5], [0, 2, 1]]);
        assert_eq!(mended.normals, [n, n, n, -n, -n, -n]);
        assert_eq!((&mended.positions[3..], &mended.uvs[3..]), (&mesh.positions[..], &mesh.uvs[..]));
        assert_eq!(wound_by_normals(mended.clone()).indices, mended.indices);
    }
}
