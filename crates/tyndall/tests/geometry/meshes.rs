//! Closed meshes and random rays, for the tests and for `cargo xtask bench rays`.

use tyndall::math::{Ray, Vec3};
use tyndall::shape::Mesh;

/// SplitMix64 (Steele, Lea and Flood 2014).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// Uniform 64 bits.
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1).
    pub(crate) fn unit(&mut self) -> f32 {
        (self.bits() >> 40) as f32 / (1 << 24) as f32
    }

    /// Uniform in [-1, 1).
    pub(crate) fn signed(&mut self) -> f32 {
        2.0 * self.unit() - 1.0
    }

    /// Uniform below `n`.
    pub(crate) fn below(&mut self, n: usize) -> usize {
        ((u128::from(self.bits()) * n as u128) >> 64) as usize
    }

    /// Uniform in the unit ball.
    pub(crate) fn in_ball(&mut self) -> Vec3 {
        loop {
            let p = Vec3::new(self.signed(), self.signed(), self.signed());
            if p.length_squared() < 1.0 {
                return p;
            }
        }
    }

    /// Uniform direction.
    pub(crate) fn dir(&mut self) -> Vec3 {
        loop {
            if let Some(d) = self.in_ball().try_normalize() {
                return d;
            }
        }
    }
}

/// A sphere of radius 1 with bumps, from a cube of `6·n²` squares: `12·n²` triangles.
pub(crate) fn displaced_sphere(n: u32, bump: f32) -> Mesh {
    let mut mesh = Mesh::default();
    let mut index = std::collections::HashMap::new();
    let mut vertex = |mesh: &mut Mesh, c: [i32; 3]| {
        *index.entry(c).or_insert_with(|| {
            let d = Vec3::from_array(c.map(|c| (c as f32 / n as f32 * std::f32::consts::FRAC_PI_4).tan())).normalize();
            let wave = (7.0 * d.x).sin() * (9.0 * d.y + 1.0).sin() * (8.0 * d.z + 2.0).sin();
            mesh.positions.push(d * (1.0 + bump * wave));
            mesh.positions.len() as u32 - 1
        })
    };
    let n = n.cast_signed();
    for axis in 0..3 {
        for side in [-n, n] {
            for (i, j) in (0..n * n).map(|k| (2 * (k % n) - n, 2 * (k / n) - n)) {
                let mut corner = |i: i32, j: i32| {
                    let mut c = [0; 3];
                    (c[axis], c[(axis + 1) % 3], c[(axis + 2) % 3]) = (side, i, j);
                    vertex(&mut mesh, c)
                };
                let q = [corner(i, j), corner(i + 2, j), corner(i + 2, j + 2), corner(i, j + 2)];
                let turn = |t: [u32; 3]| if side > 0 { t } else { [t[0], t[2], t[1]] };
                // Along the outer diagonal: without bumps the body is convex.
                let middle = |a: u32, b: u32| (mesh.positions[a as usize] + mesh.positions[b as usize]).length();
                let [a, b, c, d] = if middle(q[0], q[2]) > middle(q[1], q[3]) { q } else { [q[1], q[2], q[3], q[0]] };
                mesh.indices.extend([turn([a, b, c]), turn([a, c, d])]);
            }
        }
    }
    mesh
}

/// A prism of radius 1 with many sides: triangles of width `2π/sides` and length `height`, and caps of needles.
pub(crate) fn prism(sides: u32, height: f32) -> Mesh {
    let mut mesh = Mesh::default();
    for i in 0..sides {
        let (s, c) = (i as f32 / sides as f32 * std::f32::consts::TAU).sin_cos();
        mesh.positions.extend([Vec3::new(c, s, -0.5 * height), Vec3::new(c, s, 0.5 * height)]);
    }
    mesh.positions.extend([Vec3::Z * -0.5 * height, Vec3::Z * 0.5 * height]);
    for i in 0..sides {
        let (low, next) = (2 * i, 2 * ((i + 1) % sides));
        let (high, next_high) = (low + 1, next + 1);
        mesh.indices.extend([[low, next, next_high], [low, next_high, high]]);
        mesh.indices.extend([[2 * sides, next, low], [2 * sides + 1, high, next_high]]);
    }
    mesh
}

/// A cube from −1 to 1: triangles as large as the body.
pub(crate) fn cube() -> Mesh {
    let mut mesh = displaced_sphere(1, 0.0);
    for p in &mut mesh.positions {
        *p = p.signum();
    }
    mesh
}

/// The mesh moved by `offset` and scaled by `scale` (first scaled, then moved and rounded).
pub(crate) fn moved(mut mesh: Mesh, scale: f32, offset: Vec3) -> Mesh {
    for p in &mut mesh.positions {
        *p = (p.as_dvec3() * f64::from(scale) + offset.as_dvec3()).as_vec3();
    }
    mesh
}

/// A ray from `origin` at a random vertex (even calls) or at a random point of a random edge (odd calls).
pub(crate) fn at_seam(mesh: &Mesh, origin: Vec3, edge: bool, random: &mut Random) -> Ray {
    let triangle = mesh.triangle(random.below(mesh.indices.len()) as u32);
    let corner = random.below(3);
    let (a, b) = (triangle[corner], triangle[(corner + 1) % 3]);
    let target = if edge { a.lerp(b, random.unit()) } else { a };
    Ray::new(origin, (target - origin).normalize())
}
