// SPDX-License-Identifier: MIT

use crate::convert::{index, rows};
use crate::error::{check, checked};
use crate::threads::{with_runner, Work};
use crate::{Allocator, Deformer, Instance, Normals, Result};
use mien_sys as sys;
use std::ptr::{null, null_mut, NonNull};

/// One character's joint matrices, positions and normals, made by a [`Deformer`], which it holds.
///
/// What changes it takes `&mut self`; any number of threads may read its results.
pub struct DeformerInstance {
    handle: NonNull<sys::MienDeformerInstance>,
    joint_matrices: sys::MienFloatView,
    skin_matrices: sys::MienFloatView,
    // Dropped after the handle is destroyed.
    deformer: Deformer,
    _allocator: Option<Allocator>,
}

// SAFETY: a pose may be used by any thread, by one at a time if it is changed, which takes
// `&mut self` here; const calls may run on any number of threads.
unsafe impl Send for DeformerInstance {}
unsafe impl Sync for DeformerInstance {}

impl DeformerInstance {
    /// A pose in neutral, with room for all meshes, in memory of the heap.
    ///
    /// # Errors
    ///
    /// Those of [`DeformerInstanceOptions::create`](crate::DeformerInstanceOptions::create).
    pub fn new(deformer: &Deformer) -> Result<Self> {
        DeformerInstanceOptions::new().create(deformer)
    }

    /// The deformer that makes it.
    #[must_use]
    pub fn deformer(&self) -> &Deformer {
        &self.deformer
    }

    /// Takes over joint values and channel weights of the last evaluation of an instance of the
    /// same rig, and computes the matrices of all joints; meshes follow with
    /// [`deform`](Self::deform). Allocates nothing, locks nothing.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_deformer_instance_update)]
    pub fn update(&mut self, instance: &Instance) -> Result<()> {
        // SAFETY: live handles, and `&mut self` for the one that changes.
        check(unsafe { sys::mien_deformer_instance_update(self.raw(), instance.raw_const()) })
    }

    /// The same from arrays: values as [`Instance::joints`] gives them, and one weight per channel.
    /// Empty ones: no deltas, no weights.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_deformer_instance_update_from_values)]
    pub fn update_from_values(&mut self, joints: &[f32], channel_weights: &[f32]) -> Result<()> {
        let pointer = |values: &[f32]| if values.is_empty() { null() } else { values.as_ptr() };
        let (values, weights) = (pointer(joints), pointer(channel_weights));
        // SAFETY: a live handle, and as many values as are told.
        check(unsafe {
            let pose = self.raw();
            sys::mien_deformer_instance_update_from_values(
                pose,
                values,
                joints.len(),
                weights,
                channel_weights.len(),
            )
        })
    }

    /// Model matrices of the joints as of the last update, laid out as
    /// [`Deformer::bind_matrices`].
    #[inline]
    #[must_use]
    pub fn joint_matrices(&self) -> &[[f32; 16]] {
        // SAFETY: valid as long as `self`; what writes to it takes `&mut self`.
        unsafe { rows(self.joint_matrices.data, self.joint_matrices.count) }
    }

    /// Matrices for skinning elsewhere, as on a GPU: model matrices times inverse bind matrices.
    #[inline]
    #[must_use]
    pub fn skin_matrices(&self) -> &[[f32; 16]] {
        // SAFETY: as above.
        unsafe { rows(self.skin_matrices.data, self.skin_matrices.count) }
    }

    /// Writes the transforms of the last update, relative to the parent, one row per joint: tx ty
    /// tz qx qy qz qw sx sy sz, the quaternion of unit length.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_deformer_instance_local_transforms)]
    pub fn local_transforms(&self, out: &mut [[f32; 10]]) -> Result<()> {
        let (data, count) = (out.as_mut_ptr().cast(), 10 * out.len());
        // SAFETY: a live handle, and room for as many floats as are told.
        check(unsafe {
            sys::mien_deformer_instance_local_transforms(self.raw_const(), data, count)
        })
    }

    /// Positions of one mesh as of the last update, and its normals, on this thread. Allocates
    /// nothing, locks nothing. [`Status::LOD`](crate::Status::LOD): the pose has no room for this
    /// mesh.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_deformer_instance_deform)]
    pub fn deform(&mut self, mesh: usize, normals: Normals) -> Result<()> {
        // SAFETY: a live handle.
        check(unsafe {
            sys::mien_deformer_instance_deform(self.raw(), index(mesh), normals.0, null())
        })
    }

    /// The same by threads of yours, for meshes of 16384 positions and more, with the same bits.
    /// `run` gets the number of pieces and the work; what it leaves is done on this thread.
    ///
    /// ```
    /// # use mien::{Deformer, Dna, Normals, Preset, Rig};
    /// # let dna = Dna::generate(Preset::TINY)?;
    /// # let mut pose = Deformer::new(&dna, &Rig::new(&dna)?)?.instance()?;
    /// pose.deform_on(0, Normals::RECOMPUTED, |pieces, work| {
    ///     std::thread::scope(|threads| {
    ///         for _ in 1..pieces.min(4) {
    ///             threads.spawn(work);
    ///         }
    ///     });
    /// })?;
    /// # Ok::<(), mien::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_deformer_instance_deform)]
    pub fn deform_on(
        &mut self,
        mesh: usize,
        normals: Normals,
        run: impl FnMut(usize, Work<'_>),
    ) -> Result<()> {
        let (pose, mesh) = (self.raw(), index(mesh));
        // SAFETY: a live handle, and a runner that keeps its promises.
        with_runner(run, |parallel| unsafe {
            sys::mien_deformer_instance_deform(pose, mesh, normals.0, parallel)
        })
    }

    /// One mesh of several poses of one deformer, on this thread: the same bits as one after the
    /// other, but each piece of the mesh is fetched once. Poses of another deformer are
    /// [`Status::MISMATCH`](crate::Status::MISMATCH); then none is deformed.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_deformer_instance_deform_batch)]
    pub fn deform_batch<'poses>(
        poses: impl IntoIterator<Item = &'poses mut DeformerInstance>,
        mesh: usize,
        normals: Normals,
    ) -> Result<()> {
        let poses: Vec<_> = poses.into_iter().map(DeformerInstance::raw).collect();
        // SAFETY: live handles, different ones as they are borrowed mutably.
        check(unsafe {
            let (mesh, count) = (index(mesh), poses.len());
            sys::mien_deformer_instance_deform_batch(poses.as_ptr(), count, mesh, normals.0, null())
        })
    }

    /// The same by threads of yours, as in [`deform_on`](Self::deform_on); all poses together count
    /// for how large it is.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_deformer_instance_deform_batch)]
    pub fn deform_batch_on<'poses>(
        poses: impl IntoIterator<Item = &'poses mut DeformerInstance>,
        mesh: usize,
        normals: Normals,
        run: impl FnMut(usize, Work<'_>),
    ) -> Result<()> {
        let poses: Vec<_> = poses.into_iter().map(DeformerInstance::raw).collect();
        let (mesh, count) = (index(mesh), poses.len());
        // SAFETY: as above, and a runner that keeps its promises.
        with_runner(run, |parallel| unsafe {
            sys::mien_deformer_instance_deform_batch(
                poses.as_ptr(),
                count,
                mesh,
                normals.0,
                parallel,
            )
        })
    }

    /// x y z of the positions of a mesh, as it was deformed last.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_deformer_instance_positions)]
    pub fn positions(&self, mesh: usize) -> Result<&[[f32; 3]]> {
        let mut out = sys::MienFloatView::default();
        // SAFETY: a live handle; the view stays valid, and what writes to it takes `&mut self`.
        unsafe {
            check(sys::mien_deformer_instance_positions(self.raw_const(), index(mesh), &mut out))?;
            Ok(rows(out.data, out.count))
        }
    }

    /// x y z of the normals of a mesh, per vertex, unit length.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_deformer_instance_normals)]
    pub fn normals(&self, mesh: usize) -> Result<&[[f32; 3]]> {
        let mut out = sys::MienFloatView::default();
        // SAFETY: as above.
        unsafe {
            check(sys::mien_deformer_instance_normals(self.raw_const(), index(mesh), &mut out))?;
            Ok(rows(out.data, out.count))
        }
    }

    pub(crate) fn raw(&mut self) -> *mut sys::MienDeformerInstance {
        self.handle.as_ptr()
    }

    fn raw_const(&self) -> *const sys::MienDeformerInstance {
        self.handle.as_ptr()
    }
}

impl Drop for DeformerInstance {
    fn drop(&mut self) {
        // SAFETY: destroyed once; nothing that points into it outlives `self`.
        unsafe { sys::mien_deformer_instance_destroy(self.handle.as_ptr()) }
    }
}

impl std::fmt::Debug for DeformerInstance {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("DeformerInstance").field("deformer", &self.deformer).finish_non_exhaustive()
    }
}

/// How to make a pose.
#[derive(Clone, Debug, Default)]
#[must_use = "options do nothing until they are used"]
pub struct DeformerInstanceOptions {
    lods: u64,
    allocator: Option<Allocator>,
}

impl DeformerInstanceOptions {
    /// Room for all meshes, from the heap.
    pub fn new() -> Self {
        Self::default()
    }

    /// Room for the meshes that these LODs show: bit l is LOD l; 0 is all.
    pub fn lods(mut self, lods: u64) -> Self {
        self.lods = lods;
        self
    }

    /// Where memory comes from: one block.
    pub fn allocator(mut self, allocator: &Allocator) -> Self {
        self.allocator = Some(allocator.clone());
        self
    }

    /// Makes a pose in neutral.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_deformer_instance_create)]
    pub fn create(&self, deformer: &Deformer) -> Result<DeformerInstance> {
        let mut handle = null_mut();
        Allocator::with(self.allocator.as_ref(), |allocator| {
            let desc =
                sys::MienDeformerInstanceDesc { lods: self.lods, allocator, ..Default::default() };
            // SAFETY: a live handle and a sized struct.
            checked(|error| unsafe {
                sys::mien_deformer_instance_create(deformer.raw(), &desc, &mut handle, error)
            })
        })?;
        let mut pose = DeformerInstance {
            handle: NonNull::new(handle).expect("a handle after success"),
            joint_matrices: Default::default(),
            skin_matrices: Default::default(),
            deformer: deformer.clone(),
            _allocator: self.allocator.clone(),
        };
        // SAFETY: a live handle, and places for views, which stay valid.
        unsafe {
            check(sys::mien_deformer_instance_joint_matrices(handle, &mut pose.joint_matrices))?;
            check(sys::mien_deformer_instance_skin_matrices(handle, &mut pose.skin_matrices))?;
        }
        Ok(pose)
    }
}
