//! Shading normals for meshes that bring none.

use tyndall::math::Vec3;

use super::TriangleMesh;

impl TriangleMesh {
    /// A normal for every vertex: the mean of the normals of its triangles, weighted by their angle at the vertex, so
    /// that it does not depend on how a flat face was cut (Thürmer and Wüthrich, "Computing Vertex Normals from
    /// Polygonal Facets", 1998). This is what Mitsuba shades a mesh with that has no normals, unless the scene says
    /// `face_normals`. A vertex without a proper triangle gets the zero vector.
    pub fn smooth_normals(&self) -> Vec<Vec3> {
        let mut normals = vec![Vec3::ZERO; self.positions.len()];
        for triangle in &self.indices {
            let corners = triangle.map(|i| self.positions[i as usize]);
            for k in 0..3 {
                let [here, next, last] = [0, 1, 2].map(|step| corners[(k + step) % 3]);
                let (a, b) = (next - here, last - here);
                normals[triangle[k] as usize] += a.cross(b).normalize_or_zero() * angle(a, b);
            }
        }
        normals.into_iter().map(Vec3::normalize_or_zero).collect()
    }
}

/// The angle between two vectors [rad], accurate when it is tiny too; 0 if one of them is.
fn angle(a: Vec3, b: Vec3) -> f32 {
    a.cross(b).length().atan2(a.dot(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The corner of a cube belongs to three faces of a right angle each, however they are cut into triangles, so that
    /// its normal is the diagonal.
    #[test]
    fn the_normal_at_the_corner_of_a_cube_is_its_diagonal_however_the_faces_are_cut() {
        let positions = (0..8).map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2 & 1) as f32)).collect();
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let indices = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
        let mesh = TriangleMesh { positions, indices, ..Default::default() };
        for (p, n) in mesh.positions.iter().zip(mesh.smooth_normals()) {
            let diagonal = (2.0 * *p - Vec3::ONE).normalize();
            assert!(n.abs_diff_eq(diagonal, 1e-6), "{n} at {p}");
        }
    }
}
