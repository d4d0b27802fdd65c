//! How place and normal change with the surface parameters: asked for where a relief is, and nowhere else.
//!
//! Each shape gives `∂p/∂u`, `∂p/∂v` and the derivatives of its normal in its own space; placements carry them over:
//! tangents by the map `A`, derivatives of the unit normal `n` by `|Aᵀn| (1 − n nᵀ) A⁻ᵀ`.

use glam::{DAffine3, DVec3};

use super::{Geometry, Hit, Interaction, Mesh, Shape};
use crate::math::{Vec2, Vec3};

/// Derivatives by the surface parameters, in world space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Derivatives {
    /// Of the place, by u and by v [length].
    pub dp: [Vec3; 2],
    /// Of the normal, by u and by v \[1\].
    pub dn: [Vec3; 2],
    /// Whether the shape is a mesh with normals of its own.
    pub is_smooth_mesh: bool,
}

/// The same in a shape's own space, on the outside of a shape that is not turned round.
#[derive(Debug, Clone, Copy)]
pub(super) struct Local {
    pub(super) dp: [DVec3; 2],
    pub(super) dn: [DVec3; 2],
}

impl Geometry {
    /// At a point of a surface of this geometry.
    pub fn derivatives(&self, at: &Interaction) -> Derivatives {
        let shape = self.shape(at.object);
        let place = (at.instance != Hit::NO_INSTANCE).then(|| self.instances[at.instance as usize].placement.map());
        let p = at.p.as_dvec3();
        let p = place.map_or(p, |map| map.inverse().transform_point3(p));
        let n = at.ns.as_dvec3();
        let local = match shape {
            Shape::Mesh(mesh) => mesh_derivatives(mesh, at.prim),
            Shape::Sphere(sphere) => sphere.derivatives(p),
            Shape::Disk(disk) => disk.derivatives(p),
            Shape::Cylinder(cylinder) => cylinder.derivatives(p),
            Shape::Patch(patch) => patch.derivatives(at.uv.get()),
            Shape::Curves(curves) => {
                let n = place.map_or(n, |map| map.matrix3.transpose() * n);
                curves.derivatives(at.prim, n, at.uv.get().x)
            }
        };
        let Local { dp, dn } = place.map_or(local, |map| local.placed(&map, n));
        let reversed = match shape {
            Shape::Mesh(mesh) => is_turned(mesh, at.prim, place.map_or(n, |map| map.matrix3.transpose() * n)),
            Shape::Sphere(sphere) => sphere.reversed,
            Shape::Disk(disk) => disk.reversed,
            Shape::Cylinder(cylinder) => cylinder.reversed,
            Shape::Patch(patch) => patch.reversed,
            Shape::Curves(_) => false,
        };
        let dn = if reversed { dn.map(|d| -d) } else { dn };
        let is_smooth_mesh = matches!(shape, Shape::Mesh(mesh) if !mesh.normals.is_empty());
        Derivatives { dp: dp.map(DVec3::as_vec3), dn: dn.map(DVec3::as_vec3), is_smooth_mesh }
    }
}

impl Local {
    /// After a map, where the unit normal is `n`.
    pub(super) fn placed(self, map: &DAffine3, n: DVec3) -> Self {
        let (m, cotangent) = (map.matrix3, map.matrix3.inverse().transpose());
        let scale = (m.transpose() * n).length();
        let turned = |d: DVec3| (cotangent * d).reject_from_normalized(n) * scale;
        Self { dp: self.dp.map(|d| m * d), dn: self.dn.map(turned) }
    }

    /// Of a surface with the normal `n(u, v)`, not unit, and its derivatives.
    pub(super) fn of_normal(dp: [DVec3; 2], n: DVec3, dn: [DVec3; 2]) -> Self {
        let length = n.length();
        let unit = n / length;
        Self { dp, dn: dn.map(|d| d.reject_from_normalized(unit) / length) }
    }
}

/// Constant on a triangle: `e = ∂/∂u Δu + ∂/∂v Δv` along two of its sides. Without parameters that span a plane, any two
/// tangents.
fn mesh_derivatives(mesh: &Mesh, prim: u32) -> Local {
    let corners = mesh.indices[prim as usize].map(|i| i as usize);
    let [p0, p1, p2] = corners.map(|i| mesh.positions[i].as_dvec3());
    let [uv0, uv1, uv2] = mesh.corner_uvs(prim).map(Vec2::as_dvec2);
    let (d1, d2) = (uv1 - uv0, uv2 - uv0);
    let det = d1.perp_dot(d2);
    let solve = |e1: DVec3, e2: DVec3| [(e1 * d2.y - e2 * d1.y) / det, (e2 * d1.x - e1 * d2.x) / det];
    let dp = solve(p1 - p0, p2 - p0);
    if det == 0.0 || !dp.iter().all(|d| d.is_finite()) {
        let (s, t) = (p1 - p0).cross(p2 - p0).normalize_or(DVec3::Z).any_orthonormal_pair();
        return Local { dp: [s, t], dn: [DVec3::ZERO; 2] };
    }
    let dn = if mesh.normals.is_empty() {
        [DVec3::ZERO; 2]
    } else {
        let [n0, n1, n2] = corners.map(|i| mesh.normals[i].as_dvec3());
        solve(n1 - n0, n2 - n0)
    };
    Local { dp, dn }
}

/// Whether a normal of a mesh is turned against those that it has.
fn is_turned(mesh: &Mesh, prim: u32, n: DVec3) -> bool {
    let sum = |i: &u32| mesh.normals.get(*i as usize).map_or(DVec3::ZERO, |n| n.as_dvec3());
    mesh.indices[prim as usize].iter().map(sum).sum::<DVec3>().dot(n) < 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Ray, Transform};
    use crate::shape::{Cylinder, Disk, DiskMapping, GeometryBuilder, Patch, Sphere, SpherePart, Turn};

    fn geometry(kind: usize, transform: &Transform, instanced: bool) -> Geometry {
        let mut builder = GeometryBuilder::new();
        let place = if instanced { Transform::IDENTITY } else { *transform };
        let group = instanced.then(|| builder.begin_group());
        let turn = Turn::degrees(300.0);
        match kind {
            0 => builder.add_sphere(Sphere::new(Vec3::ZERO, 1.0), &place, false),
            1 => {
                let part = SpherePart::new(1.0, [-0.9, 0.8], turn);
                builder.add_sphere(Sphere::new(Vec3::ZERO, 1.0).cut(part), &place, true)
            }
            2 => builder.add_cylinder(Cylinder::new(1.0, [-1.0, 2.0], turn), &place, false),
            3 => builder.add_disk(Disk::new(0.3, 1.0, 0.2).cut(turn), &place, false),
            4 => builder.add_disk(Disk::new(0.3, 1.0, 0.0).mapped(DiskMapping::OutwardAzimuth), &place, true),
            5 => builder.add_patch(Patch::new([-Vec3::ONE, Vec3::X, Vec3::Y, Vec3::Z]), &place, true),
            _ => {
                let mesh = Mesh {
                    positions: vec![-Vec3::X - Vec3::Y, Vec3::X * 2.0, Vec3::Y * 2.0 + Vec3::Z],
                    indices: vec![[0, 1, 2]],
                    normals: vec![Vec3::Z, Vec3::new(0.2, 0.0, 1.0), Vec3::new(0.0, 0.3, 1.0)],
                    uvs: vec![Vec2::ZERO, Vec2::new(0.9, 0.2), Vec2::new(0.1, 1.2)],
                    reversed: false,
                };
                builder.add_mesh(mesh, &place, false)
            }
        }
        .unwrap();
        if let Some(group) = group {
            builder.end_group();
            builder.add_instance(group, transform).unwrap();
        }
        builder.build().unwrap()
    }

    /// Rays near one another meet points whose difference is `∂p/∂u Δu + ∂p/∂v Δv`, up to the square of its size, and
    /// whose normals differ by `∂n/∂u Δu + ∂n/∂v Δv`. (The normals of a mesh are compared before they are made unit.)
    #[test]
    fn derivatives_are_the_differences_between_neighbours() {
        let column = |x: f64, y: f64, z: f64| glam::DVec4::new(x, y, z, 0.0);
        let at = glam::DVec4::new(0.3, -0.2, 0.1, 1.0);
        let uneven = glam::DMat4::from_cols(column(1.2, 0.1, 0.0), column(0.2, -0.7, 0.1), column(0.0, 0.3, 0.9), at);
        let even = glam::DMat4::from_cols(column(0.0, 2.0, 0.0), column(0.0, 0.0, 2.0), column(2.0, 0.0, 0.0), at);
        let mut compared = 0;
        for (kind, matrix, instanced) in (0..7).flat_map(|k| {
            [uneven, even].into_iter().flat_map(move |m| [false, true].map(|instanced| (k, m, instanced)))
        }) {
            let geometry = geometry(kind, &Transform::new(matrix).unwrap(), instanced);
            let wave = |i: u32| ((f64::from(i) * 12.9898).sin() * 43758.5453).fract() as f32;
            for i in 0..300 {
                let dir = Vec3::new(wave(3 * i), wave(3 * i + 1), wave(3 * i + 2)).normalize();
                let origin = at.truncate().as_vec3() - dir * 5.0;
                let meet = |dir: Vec3| {
                    let ray = Ray::new(origin, dir);
                    geometry.intersect(&ray, f32::INFINITY).map(|hit| geometry.interaction(&ray, &hit))
                };
                let (x, y) = dir.any_orthonormal_pair();
                for side in [x, y] {
                    let step = 2e-3;
                    let (Some(a), Some(b), Some(c)) = (meet(dir), meet(dir - side * step), meet(dir + side * step))
                    else {
                        continue;
                    };
                    let duv = c.uv.get() - b.uv.get();
                    // Grazing rays, and the seam of u, are left out.
                    if (c.p - b.p).length() > 0.06 || duv.length() > 0.03 {
                        continue;
                    }
                    compared += 1;
                    let d = geometry.derivatives(&a);
                    let dp = d.dp[0] * duv.x + d.dp[1] * duv.y;
                    let between = c.p - b.p;
                    assert!(
                        (between - dp).length() < 2e-2 * between.length(),
                        "{kind} {instanced}: {between} {dp} {a:?}"
                    );
                    assert!((d.dp[0] - a.dpdu).length() < 1e-3 * a.dpdu.length(), "{kind}: {d:?} {a:?}");
                    if kind < 6 {
                        let dn = d.dn[0] * duv.x + d.dn[1] * duv.y;
                        let turned = c.ns - b.ns;
                        assert!((turned - dn).length() < 2e-2 * between.length(), "{kind} {instanced}: {turned} {dn}");
                    }
                }
            }
        }
        assert!(compared > 2000, "{compared}");
    }
}
