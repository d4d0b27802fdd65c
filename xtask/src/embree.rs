//! Embree, loaded at run time as a yardstick for our rays.
//!
//! The library comes from the PyPI wheel `embreex` and is called through its C interface, so this module holds the
//! only `unsafe` code of the workspace's chores. It is safe as long as the library is Embree 4.4: the types below are
//! those of its headers, the buffers are filled within the sizes that were asked for, and a scene is only read after
//! it has been committed.
#![allow(unsafe_code)] // foreign functions

use std::{
    ffi::{c_char, c_int, c_uint, c_void},
    path::Path,
    ptr,
};

use anyhow::{Context, Result, ensure};
use libloading::Library;
use tyndall::{math::Ray, shape::Mesh};

type Handle = *mut c_void;

const GEOMETRY_TRIANGLE: c_int = 0;
const GEOMETRY_ROUND_BSPLINE_CURVE: c_int = 32;
const BUFFER_INDEX: c_int = 0;
const BUFFER_VERTEX: c_int = 1;
const FORMAT_UINT: c_int = 0x5001;
const FORMAT_UINT3: c_int = 0x5003;
const FORMAT_FLOAT3: c_int = 0x9003;
const FORMAT_FLOAT4: c_int = 0x9004;
const SCENE_FLAG_ROBUST: c_int = 1 << 2;
const INVALID: c_uint = c_uint::MAX;

/// `RTCRayHit`.
#[repr(C, align(16))]
struct RayHit {
    origin: [f32; 3],
    near: f32,
    dir: [f32; 3],
    time: f32,
    far: f32,
    mask: c_uint,
    id: c_uint,
    flags: c_uint,
    normal: [f32; 3],
    uv: [f32; 2],
    prim: c_uint,
    geometry: c_uint,
    instance: [c_uint; 2],
}

/// One mesh, or many strands, in an Embree scene with the robust flag.
#[derive(Debug)]
pub(crate) struct Scene {
    handle: Handle,
    intersect: unsafe extern "C" fn(Handle, *mut RayHit, *mut c_void),
    _library: Library, // must outlive the handles
}

impl Scene {
    /// Loads the library and builds its tree over `mesh`.
    pub(crate) fn new(library: &Path, mesh: &Mesh) -> Result<Self> {
        let vertices: Vec<[f32; 3]> = mesh.positions.iter().map(glam::Vec3::to_array).collect();
        // SAFETY: see the head of this module.
        unsafe { Self::of(library, GEOMETRY_TRIANGLE, (FORMAT_FLOAT3, &vertices), (FORMAT_UINT3, &mesh.indices)) }
    }

    /// The same over round cubic B-splines: `points` with their radii, and the first of the four points of each segment.
    pub(crate) fn of_strands(library: &Path, points: &[[f32; 4]], segments: &[u32]) -> Result<Self> {
        // SAFETY: see the head of this module.
        unsafe { Self::of(library, GEOMETRY_ROUND_BSPLINE_CURVE, (FORMAT_FLOAT4, points), (FORMAT_UINT, segments)) }
    }

    /// # Safety
    /// The library is Embree 4.4, the formats are those of the items, and what the items of a geometry of this kind refer to is
    /// there.
    unsafe fn of<V: Copy, I: Copy>(
        library: &Path,
        kind: c_int,
        (vertex_format, vertices): (c_int, &[V]),
        (index_format, indices): (c_int, &[I]),
    ) -> Result<Self> {
        // SAFETY: by the caller.
        unsafe {
            let library = Library::new(library).with_context(|| format!("cannot load {}", library.display()))?;
            let new_device = library.get::<unsafe extern "C" fn(*const c_char) -> Handle>(b"rtcNewDevice")?;
            let new_scene = library.get::<unsafe extern "C" fn(Handle) -> Handle>(b"rtcNewScene")?;
            let new_geometry = library.get::<unsafe extern "C" fn(Handle, c_int) -> Handle>(b"rtcNewGeometry")?;
            let set_flags = library.get::<unsafe extern "C" fn(Handle, c_int)>(b"rtcSetSceneFlags")?;
            let attach = library.get::<unsafe extern "C" fn(Handle, Handle) -> c_uint>(b"rtcAttachGeometry")?;
            let commit_geometry = library.get::<unsafe extern "C" fn(Handle)>(b"rtcCommitGeometry")?;
            let commit_scene = library.get::<unsafe extern "C" fn(Handle)>(b"rtcCommitScene")?;
            let device = new_device(c"threads=1".as_ptr());
            ensure!(!device.is_null(), "Embree has no device");
            let (scene, geometry) = (new_scene(device), new_geometry(device, kind));
            ensure!(!geometry.is_null(), "this Embree has no such geometry");
            set_flags(scene, SCENE_FLAG_ROBUST);
            fill(&library, geometry, BUFFER_VERTEX, vertex_format, vertices)?;
            fill(&library, geometry, BUFFER_INDEX, index_format, indices)?;
            commit_geometry(geometry);
            attach(scene, geometry);
            commit_scene(scene);
            let intersect = *library.get(b"rtcIntersect1")?;
            Ok(Self { handle: scene, intersect, _library: library })
        }
    }

    /// The distance to the nearest hit before `t_max`.
    #[inline]
    pub(crate) fn intersect(&self, ray: &Ray, t_max: f32) -> Option<f32> {
        let mut query = RayHit {
            origin: ray.origin.to_array(),
            near: 0.0,
            dir: ray.dir.to_array(),
            time: 0.0,
            far: t_max,
            mask: INVALID,
            id: 0,
            flags: 0,
            normal: [0.0; 3],
            uv: [0.0; 2],
            prim: INVALID,
            geometry: INVALID,
            instance: [INVALID; 2],
        };
        // SAFETY: see the head of this module.
        unsafe { (self.intersect)(self.handle, &raw mut query, ptr::null_mut()) };
        (query.geometry != INVALID).then_some(query.far)
    }
}

/// Copies `items` into a new buffer of the geometry.
///
/// # Safety
/// `library` is Embree 4.4, `geometry` one of its geometries, and `format` that of `items`.
unsafe fn fill<T: Copy>(library: &Library, geometry: Handle, kind: c_int, format: c_int, items: &[T]) -> Result<()> {
    type NewBuffer = unsafe extern "C" fn(Handle, c_int, c_uint, c_int, usize, usize) -> *mut c_void;
    // SAFETY: by the caller; the buffer has room for `items.len()` items of this size.
    unsafe {
        let new_buffer = library.get::<NewBuffer>(b"rtcSetNewGeometryBuffer")?;
        let buffer = new_buffer(geometry, kind, 0, format, size_of::<T>(), items.len());
        ensure!(!buffer.is_null(), "Embree has no memory");
        ptr::copy_nonoverlapping(items.as_ptr(), buffer.cast(), items.len());
    }
    Ok(())
}
