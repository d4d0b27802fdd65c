//! Meshes that are right, and meshes that are not.

use proptest::prelude::*;

use super::*;

/// A unit square of one quad, with normals along z and texture coordinates equal to x and y.
const SQUARE_PLY: &str = "ply
format ascii 1.0
comment one quad
element vertex 4
property float u
property double z
property uchar y
property int x
property float nx
property float ny
property float nz
property float v
property uchar red
element edge 1
property int vertex1
property list uchar float ignored
element face 1
property uchar flags
property list uchar int vertex_index
end_header
0 0 0 0 0 0 1 0 255
1 0 0 1 0 0 1 0 255
1 0 1 1 0 0 1 1 255
0 0 1 0 0 0 1 1 255
7 2 0.5 0.25
9 4 0 1 2 3";

const SQUARE_OBJ: &str = "# one quad
mtllib none.mtl
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
vt 0 0
vt 1 0
vt 1 1
vt 0 1
vn 0 0 1
o square
usemtl paper
f 1/1/1 2/2/1 -2/3/-1 4/4/1
";

fn square() -> TriangleMesh {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vec2::from_array);
    TriangleMesh {
        positions: corners.map(|c| c.extend(0.0)).to_vec(),
        indices: vec![[0, 1, 2], [0, 2, 3]],
        normals: Some(vec![Vec3::Z; 4]),
        uvs: Some(corners.to_vec()),
        ..TriangleMesh::default()
    }
}

fn written(mesh: &TriangleMesh) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_ply(mesh, &mut bytes).unwrap();
    bytes
}

/// The same square with every number the other way round.
fn big_endian() -> Vec<u8> {
    let mut bytes = b"ply\nformat binary_big_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\n\
        property float z\nelement face 1\nproperty list uchar ushort vertex_indices\nend_header\n"
        .to_vec();
    for p in square().positions {
        bytes.extend(p.to_array().into_iter().flat_map(f32::to_be_bytes));
    }
    bytes.push(4);
    bytes.extend([0u16, 1, 2, 3].into_iter().flat_map(u16::to_be_bytes));
    bytes
}

#[test]
fn a_square_is_the_same_square_in_every_format() {
    assert_eq!(parse_ply(SQUARE_PLY.into()).unwrap(), square());
    assert_eq!(parse_ply(written(&square())).unwrap(), square());
    assert_eq!(parse_ply(big_endian()).unwrap(), TriangleMesh { normals: None, uvs: None, ..square() });
    assert_eq!(parse_obj(SQUARE_OBJ).unwrap(), square());
}

#[test]
fn groups_of_an_obj_file_become_one_mesh_and_half_given_normals_are_dropped() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 1\ng a\nf 1//1 2//1 3//1\ng b\nf 1 2 4\n";
    let mesh = parse_obj(text).unwrap();
    assert_eq!(mesh.indices, [[0, 1, 2], [3, 4, 5]]);
    assert_eq!(mesh.positions[5], Vec3::Z);
    assert_eq!(mesh.normals, None);
}

#[test]
fn a_faulty_ply_file_is_told_what_is_wrong() {
    let header = |vertices: &str, faces: &str, body: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\n\
             element face {faces}\nproperty list uchar int vertex_indices\nend_header\n{body}"
        )
    };
    let triangle = "0 0 0  1 0 0  0 1 0 ";
    let cases = [
        (String::new(), "File must start with 'ply'"),
        ("ply\nformat ascii 1.0\n".into(), "the file ends too early"),
        ("ply\nformat ascii 1.0\nelement vertex 9\nend_header\n".into(), "element `vertex` has rows but no properties"),
        (
            header("99999999999999", "1", triangle),
            "the header promises 99999999999999 rows of `vertex`, more than the file can hold",
        ),
        (header("-3", "1", ""), "Invalid element count: -3"),
        (header("3", "1", triangle), "element `face`: the file ends too early"),
        (header("3", "1", &format!("{triangle} 250 0 1 2")), "element `face`: the file ends too early"),
        (header("3", "1", &format!("{triangle} 3 0 1 3")), "a face uses vertex 3, but there are 3 (counted from 0)"),
        (
            header("3", "1", &format!("{triangle} 3 0 1 -1")),
            "element `face`: invalid value: integer `-1`, expected u32",
        ),
        (header("3", "1", "0 0 0  1 nan 0  0 1 0  3 0 1 2"), "the position of vertex 1 is [1, NaN, 0]"),
        (header("3", "1", &format!("{triangle} 2 0 1")), "has no triangles"),
        (header("3", "1", "0 0 0 x"), "element `vertex`: Failed to parse f32 from ASCII"),
        (SQUARE_PLY.replace("int x", "int a"), "element `vertex` lacks one of the properties x, y and z"),
    ];
    for (text, problem) in cases {
        assert_eq!(parse_ply(text.clone().into()).unwrap_err(), problem, "{text}");
    }
    let error = read_ply(Path::new("no/such.ply")).unwrap_err();
    assert_eq!(error.to_string(), "no/such.ply: No such file or directory (os error 2)");
}

#[test]
fn a_faulty_obj_file_is_told_the_line() {
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let cases = [
        (format!("{triangle}f 1 2 4\n"), "line 4: there is no vertex 4 among 3 (counted from 1)"),
        (format!("{triangle}f 1 2 0\n"), "line 4: there is no vertex 0 among 3 (counted from 1)"),
        (format!("{triangle}f -4 1 2\n"), "line 4: there is no vertex -4 among 3 (counted from 1)"),
        (
            format!("{triangle}f 1/9223372036854775807 2 3\n"),
            "line 4: there is no texture coordinate 9223372036854775807 among 0 (counted from 1)",
        ),
        (format!("{triangle}f 1///1 2 3\n"), "line 4: `1///1` is no corner of a face"),
        (format!("{triangle}f a b c\n"), "line 4: `a` is no corner of a face"),
        ("v 0 0 0\nv 1 0\n".into(), "line 2: position parse error"),
        ("v 0 0 NaN\nv 1 0 0\nv 0 1 0\nf 1 2 3".into(), "the position of vertex 0 is [0, 0, NaN]"),
        (triangle.into(), "has no triangles"),
    ];
    for (text, problem) in cases {
        assert_eq!(parse_obj(&text).unwrap_err(), problem, "{text}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn no_damage_to_a_mesh_file_makes_a_reader_panic(
        which in 0usize..4,
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6),
        keep in any::<prop::sample::Index>(),
        cut in any::<bool>(),
    ) {
        let mut bytes = match which {
            0 => SQUARE_PLY.as_bytes().to_vec(),
            1 => written(&square()),
            2 => big_endian(),
            _ => SQUARE_OBJ.as_bytes().to_vec(),
        };
        for (at, byte) in damage {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        if cut {
            bytes.truncate(keep.index(bytes.len()));
        }
        let read = if which == 3 { parse_obj(&String::from_utf8_lossy(&bytes)) } else { parse_ply(bytes) };
        if let Ok(mesh) = read {
            prop_assert!(mesh.indices.iter().flatten().all(|&i| (i as usize) < mesh.positions.len()));
        }
    }
}

/// Colours of vertices as the numbers that they are; of faces one a triangle, so twice for a quadrilateral; in text and in
/// bytes alike.
#[test]
fn colours_of_vertices_and_faces_are_read() {
    let text = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
        property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 2\n\
        property list uchar int vertex_indices\nproperty float color_0\nproperty float color_1\nproperty float color_2\nend_header\n\
        0 0 0 1 2 3\n1 0 0 4 5 6\n1 1 0 7 8 9\n0 1 0 255 0 1\n4 0 1 2 3 0.5 0.25 1\n3 0 1 2 0 1 0\n";
    let header = text.replace("ascii", "binary_little_endian");
    let mut bytes = header.as_bytes()[..header.find("end_header\n").unwrap() + 11].to_vec();
    let corners = [([0f32, 0.0, 0.0], [1u8, 2, 3]), ([1.0, 0.0, 0.0], [4, 5, 6]), ([1.0, 1.0, 0.0], [7, 8, 9])];
    for (p, colour) in corners.into_iter().chain([([0.0, 1.0, 0.0], [255, 0, 1])]) {
        bytes.extend(p.into_iter().flat_map(f32::to_le_bytes));
        bytes.extend(colour);
    }
    for (face, colour) in [(&[0i32, 1, 2, 3][..], [0.5f32, 0.25, 1.0]), (&[0, 1, 2], [0.0, 1.0, 0.0])] {
        bytes.push(face.len() as u8);
        bytes.extend(face.iter().flat_map(|i| i.to_le_bytes()));
        bytes.extend(colour.into_iter().flat_map(f32::to_le_bytes));
    }
    for mesh in [parse_ply(text.into()).unwrap(), parse_ply(bytes).unwrap()] {
        let colours = vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0], [255.0, 0.0, 1.0]];
        assert_eq!(mesh.colours, Some(colours));
        assert_eq!(mesh.face_colours, Some(vec![[0.5, 0.25, 1.0], [0.5, 0.25, 1.0], [0.0, 1.0, 0.0]]));
    }
}
