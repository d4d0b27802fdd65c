//! Mesh files, each read once however many shapes are made of it.

use std::{collections::HashMap, path::PathBuf};

use crate::{
    desc::{SceneDesc, ShapeKind},
    mesh::{MeshError, TriangleMesh},
};

/// A mesh of a file: its name, and its number there.
pub(super) type MeshKey = (PathBuf, u32);

/// Meshes that were read and will be needed again.
#[derive(Debug)]
pub(super) struct Meshes {
    /// How many shapes are still to be made of each.
    uses: HashMap<MeshKey, usize>,
    read: HashMap<MeshKey, TriangleMesh>,
}

impl Meshes {
    pub(super) fn new(desc: &SceneDesc) -> Self {
        let mut uses = HashMap::new();
        for shape in desc.shapes.iter().chain(desc.groups.iter().flat_map(|group| &group.shapes)) {
            match &shape.kind {
                ShapeKind::Ply { path, .. } | ShapeKind::Obj { path, .. } => {
                    *uses.entry((path.value.clone(), 0)).or_default() += 1;
                }
                ShapeKind::Serialized { path, index, .. } => {
                    *uses.entry((path.value.clone(), *index)).or_default() += 1;
                }
                _ => {}
            }
        }
        Self { uses, read: HashMap::new() }
    }

    /// The mesh, by `read` if it is not at hand. The last shape that needs it takes it away.
    pub(super) fn get(
        &mut self,
        key: MeshKey,
        read: impl FnOnce() -> Result<TriangleMesh, MeshError>,
    ) -> Result<TriangleMesh, MeshError> {
        let mesh = self.read.remove(&key).map_or_else(read, Ok)?;
        if let Some(left) = self.uses.get_mut(&key) {
            *left = left.saturating_sub(1);
            if *left > 0 {
                self.read.insert(key, mesh.clone());
            }
        }
        Ok(mesh)
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn a_mesh_is_read_once_and_let_go_after_its_last_use() {
        let shape = |file: &str| format!("Shape \"plymesh\" \"string filename\" \"{file}\" ");
        let world = format!("WorldBegin {} ObjectBegin \"o\" {} ObjectEnd {}", shape("a"), shape("a"), shape("b"));
        let (desc, _) = crate::pbrt::parse(Path::new("scene.pbrt"), &world).unwrap();
        let mut meshes = Meshes::new(&desc);
        let mut reads = 0;
        let mut get = |meshes: &mut Meshes, file: &str| {
            let read = || {
                reads += 1;
                Ok(TriangleMesh::default())
            };
            meshes.get((file.into(), 0), read).unwrap();
            meshes.read.len()
        };
        assert_eq!([get(&mut meshes, "a"), get(&mut meshes, "b"), get(&mut meshes, "a")], [1, 1, 0]);
        assert_eq!(reads, 2);
    }
}
