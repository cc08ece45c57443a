// SPDX-License-Identifier: MIT

use crate::convert::{index, rows, slice};
use crate::error::{check, checked};
use crate::{
    Allocator, Compose, DeformerInfo, DeformerInstance, Dna, Isa, Normals, Result, Rig, Storage,
    Weights,
};
use mien_sys as sys;
use std::ptr::{null_mut, NonNull};
use std::sync::Arc;

/// The geometry of a DNA and the hierarchy of its joints, packed once. It never changes.
///
/// Like a [`Rig`], a counted reference: clones are the same deformer, and each [`DeformerInstance`] holds one.
/// Blend shape targets, then linear blend skinning; `mien.h` has the formulas.
///
/// ```
/// use mien::{Deformer, Dna, Kind, Normals, Preset, Rig};
/// let dna = Dna::generate(Preset::SMALL)?;
/// let rig = Rig::new(&dna)?;
/// let deformer = Deformer::new(&dna, &rig)?;
/// drop(dna);
///
/// let mut face = rig.instance()?;
/// let mut pose = deformer.instance()?;
/// face.raw_controls_mut()[rig.find(Kind::RAW_CONTROL, "CTRL_expressions.jawOpen")?] = 1.0;
/// face.evaluate(0)?;
/// pose.update(&face)?;
/// pose.deform(0, Normals::RECOMPUTED)?;
/// for [x, y, z] in pose.positions(0)? {
///     # let _ = (x, y, z);
/// }
/// # Ok::<(), mien::Error>(())
/// ```
#[derive(Clone)]
pub struct Deformer {
    shared: Arc<Shared>,
}

struct Shared {
    handle: NonNull<sys::MienDeformer>,
    info: DeformerInfo,
    // Released after the handle. The deformer uses the memory of the rig, hence its allocator.
    rig: Rig,
    // A subset uses the memory of the deformer that it was made of.
    _whole: Option<Deformer>,
    _allocator: Option<Allocator>,
}

// SAFETY: the handle is const for every call but destroying; const handles may be used by any
// number of threads at the same time, and any thread may destroy it. Allocators are Send + Sync.
unsafe impl Send for Shared {}
unsafe impl Sync for Shared {}

/// A neutral mesh of a [`Deformer`].
///
/// A position is shared by all faces around it; a vertex is a position with a texture coordinate
/// and a normal.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Mesh<'deformer> {
    /// Influences of the position that has most.
    pub max_influences: usize,
    /// Deltas over all blend shape targets.
    pub delta_count: usize,
    /// Bit l: LOD l shows this mesh.
    pub lods: u64,
    /// x y z, in translation units.
    pub positions: &'deformer [[f32; 3]],
    /// x y z per vertex, unit length.
    pub normals: &'deformer [[f32; 3]],
    /// x y z and w per vertex; empty unless [`DeformerOptions::with_tangents`] asked for them.
    pub tangents: &'deformer [[f32; 4]],
    /// u v per vertex, as in the file; empty with 16-bit storage: [`Deformer::texture_coordinates`].
    pub texture_coordinates: &'deformer [[f32; 2]],
    /// Position of each vertex.
    pub vertex_position_indices: &'deformer [u32],
    /// Three vertices each, wound as in the file; faces of more corners are fans about their first.
    /// Empty with 16-bit storage: [`Deformer::triangles`].
    pub triangles: &'deformer [[u32; 3]],
    /// Channel of each blend shape target, in file order.
    pub target_channels: &'deformer [u16],
}

impl Deformer {
    /// Packs the geometry of `dna`, the one that `rig` was made of. [`DeformerOptions`] has other
    /// wishes.
    ///
    /// # Errors
    ///
    /// Those of [`DeformerOptions::create`](crate::DeformerOptions::create).
    pub fn new(dna: &Dna<'_>, rig: &Rig) -> Result<Self> {
        DeformerOptions::new().create(dna, rig)
    }

    /// A pose in neutral, with room for all meshes. [`DeformerInstanceOptions`](crate::DeformerInstanceOptions) leaves out
    /// some.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_deformer_instance_create)]
    pub fn instance(&self) -> Result<DeformerInstance> {
        DeformerInstance::new(self)
    }

    /// A deformer of some positions of one mesh, ascending: position i of that mesh is `positions[i]` of this one's.
    ///
    /// It has no vertices or triangles, and all other meshes are empty. Deformed positions have the bits of the whole
    /// mesh (with 16-bit storage they may be rounded otherwise), and take time for the chosen ones only. It keeps the
    /// memory of this deformer.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_deformer_create_subset)]
    pub fn subset(&self, mesh: usize, positions: &[u32]) -> Result<Self> {
        self.create_subset(mesh, positions, None)
    }

    /// The same in memory of your own.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_deformer_create_subset)]
    pub fn subset_in(&self, mesh: usize, positions: &[u32], allocator: &Allocator) -> Result<Self> {
        self.create_subset(mesh, positions, Some(allocator))
    }

    fn create_subset(
        &self,
        mesh: usize,
        positions: &[u32],
        allocator: Option<&Allocator>,
    ) -> Result<Self> {
        let mut handle = null_mut();
        let (data, count) = (positions.as_ptr(), positions.len());
        Allocator::with(allocator, |allocator| {
            let (whole, mesh) = (self.raw(), index(mesh));
            // SAFETY: a live handle, and positions with their count.
            checked(|error| unsafe {
                let out = &mut handle;
                sys::mien_deformer_create_subset(whole, mesh, data, count, allocator, out, error)
            })
        })?;
        DeformerOptions::adopt(allocator, handle, self.rig(), Some(self))
    }

    pub(crate) fn raw(&self) -> *const sys::MienDeformer {
        self.shared.handle.as_ptr()
    }

    /// The rig that it was made for.
    #[must_use]
    pub fn rig(&self) -> &Rig {
        &self.shared.rig
    }

    /// Counts, choices, memory. Names of meshes are those of the rig
    /// ([`Kind::MESH`](crate::Kind::MESH)).
    #[must_use]
    pub fn info(&self) -> &DeformerInfo {
        &self.shared.info
    }

    /// A neutral mesh.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_deformer_mesh)]
    pub fn mesh(&self, mesh: usize) -> Result<Mesh<'_>> {
        let out = self.neutral(mesh)?;
        // SAFETY: views live as long as the deformer.
        unsafe {
            let (uvs, triangles) = (out.texture_coordinates, out.triangles);
            Ok(Mesh {
                max_influences: out.max_influences as usize,
                delta_count: out.delta_count as usize,
                lods: out.lods,
                positions: rows(out.positions.data, out.positions.count),
                normals: rows(out.normals.data, out.normals.count),
                tangents: rows(out.tangents.data, out.tangents.count),
                texture_coordinates: rows(uvs.data, uvs.count),
                vertex_position_indices: slice(
                    out.vertex_position_indices.data,
                    out.vertex_position_indices.count,
                ),
                triangles: rows(triangles.data, triangles.count),
                target_channels: slice(out.target_channels.data, out.target_channels.count),
            })
        }
    }

    /// Joints that hold a position, and their weights, as they are used: as many as each other,
    /// possibly none.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_deformer_influences)]
    pub fn influences(&self, mesh: usize, position: usize) -> Result<(&[u16], &[f32])> {
        let mut joints = sys::MienIndex16View::default();
        let mut weights = sys::MienFloatView::default();
        let (mesh, position) = (index(mesh), index(position));
        // SAFETY: a live handle; views live as long as the deformer.
        unsafe {
            let deformer = self.raw();
            check(sys::mien_deformer_influences(
                deformer,
                mesh,
                position,
                &mut joints,
                &mut weights,
            ))?;
            Ok((slice(joints.data, joints.count), slice(weights.data, weights.count)))
        }
    }

    /// The triangles of a mesh, three vertices each, with any storage.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_deformer_triangles)]
    pub fn triangles(&self, mesh: usize) -> Result<Vec<[u32; 3]>> {
        let mut out = vec![[0; 3]; self.neutral(mesh)?.triangle_count as usize];
        // SAFETY: a live handle, and room for as many indices as are told.
        check(unsafe {
            let (data, count) = (out.as_mut_ptr().cast(), 3 * out.len());
            sys::mien_deformer_triangles(self.raw(), index(mesh), data, count)
        })?;
        Ok(out)
    }

    /// u v per vertex of a mesh, with any storage.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_deformer_texture_coordinates)]
    pub fn texture_coordinates(&self, mesh: usize) -> Result<Vec<[f32; 2]>> {
        let mut out = vec![[0.0; 2]; self.neutral(mesh)?.vertex_count as usize];
        // SAFETY: a live handle, and room for as many floats as are told.
        check(unsafe {
            let (data, count) = (out.as_mut_ptr().cast(), 2 * out.len());
            sys::mien_deformer_texture_coordinates(self.raw(), index(mesh), data, count)
        })?;
        Ok(out)
    }

    fn neutral(&self, mesh: usize) -> Result<sys::MienMesh> {
        let mut out = sys::MienMesh::default();
        // SAFETY: a live handle and a sized struct.
        check(unsafe { sys::mien_deformer_mesh(self.raw(), index(mesh), &mut out) })?;
        Ok(out)
    }

    /// How far a blend shape target moves each position of the mesh at channel weight 1.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_deformer_target)]
    pub fn target(&self, mesh: usize, target: usize) -> Result<Vec<[f32; 3]>> {
        let mut out = vec![[0.0; 3]; self.mesh(mesh)?.positions.len()];
        let (mesh, target) = (index(mesh), index(target));
        // SAFETY: a live handle, and room for as many floats as are told.
        check(unsafe {
            let (data, count) = (out.as_mut_ptr().cast(), 3 * out.len());
            sys::mien_deformer_target(self.raw(), mesh, target, data, count)
        })?;
        Ok(out)
    }

    /// Model matrices of the joints in the neutral pose: column by column, for column vectors, so
    /// the last four floats are the translation and 1.
    #[must_use]
    pub fn bind_matrices(&self) -> &[[f32; 16]] {
        // SAFETY: a live handle.
        self.matrices(|out| unsafe { sys::mien_deformer_bind_matrices(self.raw(), out) })
    }

    /// Their inverses.
    #[must_use]
    pub fn inverse_bind_matrices(&self) -> &[[f32; 16]] {
        // SAFETY: a live handle.
        self.matrices(|out| unsafe { sys::mien_deformer_inverse_bind_matrices(self.raw(), out) })
    }

    fn matrices(
        &self,
        call: impl FnOnce(*mut sys::MienFloatView) -> sys::MienStatus,
    ) -> &[[f32; 16]] {
        let mut out = sys::MienFloatView::default();
        let status = call(&mut out);
        debug_assert_eq!(status, sys::MIEN_OK);
        // SAFETY: views live as long as the deformer; a failure leaves an empty one.
        unsafe { rows(out.data, out.count) }
    }
}

impl Drop for Shared {
    fn drop(&mut self) {
        // SAFETY: destroyed once; poses hold a reference, so there are none any more.
        unsafe { sys::mien_deformer_destroy(self.handle.as_ptr()) }
    }
}

impl std::fmt::Debug for Deformer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Deformer").field("info", self.info()).finish_non_exhaustive()
    }
}

/// How to pack a deformer.
#[derive(Clone, Debug, Default)]
#[must_use = "options do nothing until they are used"]
pub struct DeformerOptions {
    isa: Isa,
    compose: Compose,
    weights: Weights,
    normals: Normals,
    with_tangents: bool,
    storage: Storage,
    delta_error: f64,
    allocator: Option<Allocator>,
}

impl DeformerOptions {
    /// The instruction set of the rig, products of rotations, weights as stored, the heap.
    pub fn new() -> Self {
        Self::default()
    }

    /// Instruction set; [`Isa::BEST`] is that of the rig.
    pub fn isa(mut self, isa: Isa) -> Self {
        self.isa = isa;
        self
    }

    /// How the rotation of a joint is made of the neutral one and the delta.
    pub fn compose(mut self, compose: Compose) -> Self {
        self.compose = compose;
        self
    }

    /// What is done about skin weights.
    pub fn weights(mut self, weights: Weights) -> Self {
        self.weights = weights;
        self
    }

    /// Normals of calls that leave the choice open.
    pub fn normals(mut self, normals: Normals) -> Self {
        self.normals = normals;
        self
    }

    /// Computes tangents, for [`DeformerInstance::write_vertices`].
    pub fn with_tangents(mut self, with_tangents: bool) -> Self {
        self.with_tangents = with_tangents;
        self
    }

    /// How blend shapes, skin weights and texture coordinates are stored. With 16 bits, [`Deformer::influences`] is an
    /// error.
    pub fn storage(mut self, storage: Storage) -> Self {
        self.storage = storage;
        self
    }

    /// Largest error of a coordinate of a delta that 16-bit storage may make to store it with 10 bits; 0: 2^-18 of the
    /// size of the mesh.
    pub fn delta_error(mut self, delta_error: f64) -> Self {
        self.delta_error = delta_error;
        self
    }

    /// Where memory comes from.
    pub fn allocator(mut self, allocator: &Allocator) -> Self {
        self.allocator = Some(allocator.clone());
        self
    }

    /// Packs the geometry of `dna`, which needs it loaded, else
    /// [`Status::DNA_LAYER`](crate::Status::DNA_LAYER). It is the one that `rig` was made of, or
    /// another opening of the same file with the same LODs, else
    /// [`Status::MISMATCH`](crate::Status::MISMATCH).
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_deformer_create)]
    pub fn create(&self, dna: &Dna<'_>, rig: &Rig) -> Result<Deformer> {
        let mut handle = null_mut();
        Allocator::with(self.allocator.as_ref(), |allocator| {
            let desc = sys::MienDeformerDesc {
                isa: self.isa.0,
                compose: self.compose.0,
                weights: self.weights.0,
                normals: self.normals.0,
                with_tangents: self.with_tangents.into(),
                storage: self.storage.0,
                delta_error: self.delta_error,
                allocator,
                ..Default::default()
            };
            // SAFETY: live handles and a sized struct.
            checked(|error| unsafe {
                sys::mien_deformer_create(dna.raw(), rig.raw(), &desc, &mut handle, error)
            })
        })?;
        Self::adopt(self.allocator.as_ref(), handle, rig, None)
    }

    /// Makes a deformer of what `create` gave.
    pub(crate) fn adopt(
        allocator: Option<&Allocator>,
        handle: *mut sys::MienDeformer,
        rig: &Rig,
        whole: Option<&Deformer>,
    ) -> Result<Deformer> {
        let handle = NonNull::new(handle).expect("a handle after success");
        let mut info = sys::MienDeformerInfo::default();
        // SAFETY: a live handle and a sized struct.
        let status = unsafe { sys::mien_deformer_info(handle.as_ptr(), &mut info) };
        let (info, rig) = (info.into(), rig.clone());
        let (_whole, _allocator) = (whole.cloned(), allocator.cloned());
        let shared = Shared { handle, info, rig, _whole, _allocator };
        let deformer = Deformer { shared: Arc::new(shared) };
        check(status).map(|()| deformer)
    }
}
