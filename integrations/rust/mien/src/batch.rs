// SPDX-License-Identifier: MIT

use crate::convert::index;
use crate::error::{check, checked};
use crate::threads::{with_runner, Work};
use crate::{Allocator, Instance, Result, Rig, Stages};
use mien_sys as sys;
use std::ptr::{null, null_mut, NonNull};

/// Room for evaluating many instances of a rig at once: the same bits as one after the other, but
/// the joint matrix is fetched once for up to 32 of them.
///
/// ```
/// use mien::{Batch, Dna, Preset, Rig};
/// let rig = Rig::new(&Dna::generate(Preset::SMALL)?)?;
/// let mut faces = (0..8).map(|_| rig.instance()).collect::<mien::Result<Vec<_>>>()?;
/// let mut batch = Batch::new(&rig, faces.len())?;
/// for face in &mut faces {
///     face.raw_controls_mut()[0] = 1.0;
/// }
/// batch.evaluate(&mut faces, 0)?;
/// # Ok::<(), mien::Error>(())
/// ```
pub struct Batch {
    handle: NonNull<sys::MienBatch>,
    // What a call hands over. Room is taken once, and they are empty between calls.
    instances: Vec<*mut sys::MienInstance>,
    lods: Vec<u32>,
    // Dropped after the handle is destroyed.
    rig: Rig,
    _allocator: Option<Allocator>,
}

// SAFETY: a batch may be used by any thread, by one at a time, as everything takes `&mut self`.
unsafe impl Send for Batch {}
unsafe impl Sync for Batch {}

impl Batch {
    /// For up to `capacity` instances per call, without threads.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_batch_create)]
    pub fn new(rig: &Rig, capacity: usize) -> Result<Self> {
        Self::create(rig, capacity, 1, None)
    }

    /// The same in up to `tasks` tasks at once, each of which takes scratch memory of its own.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_batch_create)]
    pub fn with_tasks(rig: &Rig, capacity: usize, tasks: usize) -> Result<Self> {
        Self::create(rig, capacity, tasks, None)
    }

    /// The same in memory of your own: one block of [`bytes`](Self::bytes).
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_batch_create)]
    pub fn new_in(rig: &Rig, capacity: usize, tasks: usize, allocator: &Allocator) -> Result<Self> {
        Self::create(rig, capacity, tasks, Some(allocator))
    }

    fn create(
        rig: &Rig,
        capacity: usize,
        tasks: usize,
        allocator: Option<&Allocator>,
    ) -> Result<Self> {
        let mut handle = null_mut();
        Allocator::with(allocator, |raw| {
            let desc = Self::desc(capacity, tasks, raw);
            // SAFETY: a live handle and a sized struct.
            checked(|error| unsafe { sys::mien_batch_create(rig.raw(), &desc, &mut handle, error) })
        })?;
        Ok(Self {
            handle: NonNull::new(handle).expect("a handle after success"),
            instances: Vec::with_capacity(capacity + 1),
            lods: Vec::with_capacity(capacity + 1),
            rig: rig.clone(),
            _allocator: allocator.cloned(),
        })
    }

    /// Bytes that such a batch takes from its allocator.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_batch_bytes)]
    pub fn bytes(rig: &Rig, capacity: usize, tasks: usize) -> Result<u64> {
        let mut out = 0;
        let desc = Self::desc(capacity, tasks, null());
        // SAFETY: a live handle and a sized struct.
        check(unsafe { sys::mien_batch_bytes(rig.raw(), &desc, &mut out) })?;
        Ok(out)
    }

    fn desc(
        capacity: usize,
        tasks: usize,
        allocator: *const sys::MienAllocator,
    ) -> sys::MienBatchDesc {
        // 0 would be the default of C.
        let capacity = index(capacity.max(1));
        sys::MienBatchDesc { capacity, tasks: index(tasks), allocator, ..Default::default() }
    }

    /// The rig whose instances it evaluates.
    #[must_use]
    pub fn rig(&self) -> &Rig {
        &self.rig
    }

    /// Evaluates all stages of the instances at a LOD, on this thread. Allocates nothing. If one of
    /// them is of another rig ([`Status::MISMATCH`](crate::Status::MISMATCH)), or there are more
    /// than there is room for, none is evaluated.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_rig_evaluate_batch)]
    pub fn evaluate<'faces>(
        &mut self,
        instances: impl IntoIterator<Item = &'faces mut Instance>,
        lod: usize,
    ) -> Result<()> {
        self.evaluate_each(instances.into_iter().map(|face| (face, lod)), Stages::ALL)
    }

    /// Evaluates stages of the instances, each at its own LOD.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_rig_evaluate_batch)]
    pub fn evaluate_each<'faces>(
        &mut self,
        instances: impl IntoIterator<Item = (&'faces mut Instance, usize)>,
        stages: Stages,
    ) -> Result<()> {
        self.gather(instances);
        let status = self.call(stages, null());
        check(status)
    }

    /// The same by threads of yours: `run` gets the number of tasks and the work; what it leaves is
    /// done on this thread. [`DeformerInstance::deform_on`](crate::DeformerInstance::deform_on) has an example.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_rig_evaluate_batch)]
    pub fn evaluate_each_on<'faces>(
        &mut self,
        instances: impl IntoIterator<Item = (&'faces mut Instance, usize)>,
        stages: Stages,
        run: impl FnMut(usize, Work<'_>),
    ) -> Result<()> {
        self.gather(instances);
        with_runner(run, |parallel| self.call(stages, parallel))
    }

    /// One more than there is room for is enough to be told so.
    fn gather<'faces>(
        &mut self,
        instances: impl IntoIterator<Item = (&'faces mut Instance, usize)>,
    ) {
        self.instances.clear();
        self.lods.clear();
        for (instance, lod) in instances.into_iter().take(self.instances.capacity()) {
            self.instances.push(instance.raw());
            self.lods.push(index(lod));
        }
    }

    /// Only while what was gathered is borrowed.
    fn call(&mut self, stages: Stages, parallel: *const sys::MienParallelFor) -> sys::MienStatus {
        let count = index(self.instances.len());
        let (instances, lods) = (self.instances.as_ptr(), self.lods.as_ptr());
        // SAFETY: live handles, different ones as they are borrowed mutably, and as many as told.
        let status = unsafe {
            let (rig, batch) = (self.rig.raw(), self.handle.as_ptr());
            sys::mien_rig_evaluate_batch(rig, batch, instances, lods, count, stages.0, parallel)
        };
        self.instances.clear();
        status
    }
}

impl Drop for Batch {
    fn drop(&mut self) {
        // SAFETY: destroyed once.
        unsafe { sys::mien_batch_destroy(self.handle.as_ptr()) }
    }
}

impl std::fmt::Debug for Batch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Batch").field("rig", &self.rig).finish_non_exhaustive()
    }
}
