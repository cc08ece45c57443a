// SPDX-License-Identifier: MIT

use crate::convert::path_string;
use crate::error::{check, checked};
use crate::stream::with_stream;
use crate::{
    Allocator, BakedCheck, BakedInfo, Deformer, DeformerOptions, Isa, Normals, Result, Reuse, Rig,
    RigOptions,
};
use mien_sys as sys;
use std::io::{Read, Seek};
use std::os::raw::c_void;
use std::path::Path;
use std::ptr::{null, null_mut, NonNull};

/// A file that [`Rig::bake`] or `mien bake` wrote: a rig, and its deformer if it has one, as they
/// are in memory. What is made of it keeps the file, so it may be dropped at once.
///
/// ```
/// use mien::{Baked, Deformer, Dna, Preset, Rig};
/// let dna = Dna::generate(Preset::TINY)?;
/// let rig = Rig::new(&dna)?;
/// let file = rig.to_baked_bytes(Some(&Deformer::new(&dna, &rig)?))?;
///
/// let baked = Baked::from_reader(&mut std::io::Cursor::new(file))?;
/// let rig = baked.rig()?;
/// let deformer = baked.deformer(&rig)?;
/// # Ok::<(), mien::Error>(())
/// ```
pub struct Baked {
    handle: NonNull<sys::MienBaked>,
    info: BakedInfo,
    allocator: Option<Allocator>,
}

// SAFETY: the handle is const for every call but closing; const handles may be used by any number
// of threads at the same time, and any thread may close it. Allocators are Send + Sync.
unsafe impl Send for Baked {}
unsafe impl Sync for Baked {}

impl Drop for Baked {
    fn drop(&mut self) {
        // SAFETY: a live handle, which is not used afterwards.
        unsafe { sys::mien_baked_close(self.handle.as_ptr()) }
    }
}

impl std::fmt::Debug for Baked {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Baked").field("info", &self.info).finish_non_exhaustive()
    }
}

impl Baked {
    /// Reads a file; see [`BakedOptions`].
    ///
    /// # Errors
    ///
    /// Those of [`BakedOptions::open`].
    pub fn open(path: impl AsRef<Path>) -> Result<Self> {
        BakedOptions::new().open(path)
    }

    /// Reads all of `reader`.
    ///
    /// # Errors
    ///
    /// Those of [`BakedOptions::open_reader`].
    pub fn from_reader(reader: &mut (impl Read + Seek)) -> Result<Self> {
        BakedOptions::new().open_reader(reader)
    }

    /// Sizes, and what is in it.
    #[must_use]
    pub fn info(&self) -> &BakedInfo {
        &self.info
    }

    /// The rig, for the best instruction set of this machine.
    ///
    /// # Errors
    ///
    /// Those of [`Baked::rig_for`].
    pub fn rig(&self) -> Result<Rig> {
        self.rig_for(Isa::BEST, Reuse::UNCHANGED)
    }

    /// The rig. All other choices were made when it was baked.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_rig_from_baked)]
    pub fn rig_for(&self, isa: Isa, reuse: Reuse) -> Result<Rig> {
        let mut handle = null_mut();
        Allocator::with(self.allocator.as_ref(), |allocator| {
            let desc = sys::MienBakedRigDesc {
                isa: isa.0,
                reuse: reuse.0,
                allocator,
                ..Default::default()
            };
            // SAFETY: a live handle and a sized struct.
            checked(|error| unsafe {
                sys::mien_rig_from_baked(self.handle.as_ptr(), &desc, &mut handle, error)
            })
        })?;
        RigOptions::adopt(self.allocator.as_ref(), handle)
    }

    /// The deformer of a rig that this made, else [`Status::MISMATCH`](crate::Status::MISMATCH);
    /// [`Status::BAKED_PART`](crate::Status::BAKED_PART) if the file has none.
    ///
    /// # Errors
    ///
    /// Those of [`Baked::deformer_for`].
    pub fn deformer(&self, rig: &Rig) -> Result<Deformer> {
        self.deformer_for(rig, Isa::BEST, Normals::DEFAULT)
    }

    /// The same; [`Isa::BEST`] is that of the rig, [`Normals::DEFAULT`] the choice that was baked.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_deformer_from_baked)]
    pub fn deformer_for(&self, rig: &Rig, isa: Isa, normals: Normals) -> Result<Deformer> {
        let mut handle = null_mut();
        Allocator::with(self.allocator.as_ref(), |allocator| {
            let desc = sys::MienBakedDeformerDesc {
                isa: isa.0,
                normals: normals.0,
                allocator,
                ..Default::default()
            };
            // SAFETY: live handles and a sized struct.
            checked(|error| unsafe {
                sys::mien_deformer_from_baked(
                    self.handle.as_ptr(),
                    rig.raw(),
                    &desc,
                    &mut handle,
                    error,
                )
            })
        })?;
        DeformerOptions::adopt(self.allocator.as_ref(), handle, rig, None)
    }
}

/// How to open a baked file.
#[derive(Clone, Debug, Default)]
pub struct BakedOptions {
    check: BakedCheck,
    allocator: Option<Allocator>,
}

impl BakedOptions {
    /// Safe, from the heap.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Whether to look for changed numbers too.
    #[must_use]
    pub fn check(mut self, check: BakedCheck) -> Self {
        self.check = check;
        self
    }

    /// Where memory comes from.
    #[must_use]
    pub fn allocator(mut self, allocator: &Allocator) -> Self {
        self.allocator = Some(allocator.clone());
        self
    }

    /// Reads the whole file.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_baked_open_file)]
    pub fn open(&self, path: impl AsRef<Path>) -> Result<Baked> {
        self.open_file(path.as_ref(), sys::MIEN_FILE_READ)
    }

    /// Maps the file and uses it in place: processes share its pages.
    ///
    /// # Safety
    ///
    /// The file must not be truncated or written to in place until the `Baked` and all that was made
    /// of it are gone; replacing it by renaming is safe.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_baked_open_file)]
    pub unsafe fn map(&self, path: impl AsRef<Path>) -> Result<Baked> {
        self.open_file(path.as_ref(), sys::MIEN_FILE_MAP)
    }

    fn open_file(&self, path: &Path, access: u32) -> Result<Baked> {
        let path = path_string(path)?;
        self.open_by(access, |desc, out| {
            // SAFETY: a terminated path and a sized struct; the rest is the caller's.
            checked(|error| unsafe { sys::mien_baked_open_file(path.as_ptr(), desc, out, error) })
        })
    }

    /// Uses memory that never goes away, such as `include_bytes!`, in place.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_baked_open_memory)]
    pub fn open_bytes(&self, bytes: &'static [u8]) -> Result<Baked> {
        self.open_by(sys::MIEN_FILE_MAP, |desc, out| {
            let data = bytes.as_ptr().cast();
            // SAFETY: the bytes are static, so they outlive everything unchanged.
            checked(|error| unsafe {
                sys::mien_baked_open_memory(data, bytes.len(), desc, out, error)
            })
        })
    }

    /// Reads all of `reader`.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_baked_open_stream)]
    ///
    /// An error of the reader is [`Status::FILE_READ`](crate::Status::FILE_READ).
    pub fn open_reader(&self, reader: &mut (impl Read + Seek)) -> Result<Baked> {
        self.open_by(sys::MIEN_FILE_READ, |desc, out| {
            with_stream(reader, |stream| {
                // SAFETY: a stream that is valid for the call, and a sized struct.
                checked(|error| unsafe { sys::mien_baked_open_stream(stream, desc, out, error) })
            })
        })
    }

    fn open_by(
        &self,
        access: u32,
        open: impl FnOnce(*const sys::MienBakedDesc, *mut *mut sys::MienBaked) -> Result<()>,
    ) -> Result<Baked> {
        let mut handle = null_mut();
        Allocator::with(self.allocator.as_ref(), |allocator| {
            let desc = sys::MienBakedDesc {
                file_access: access,
                check: self.check.0,
                allocator,
                ..Default::default()
            };
            open(&desc, &mut handle)
        })?;
        let handle = NonNull::new(handle).expect("a handle after success");
        let mut info = sys::MienBakedInfo::default();
        // SAFETY: a live handle and a sized struct.
        let status = unsafe { sys::mien_baked_info(handle.as_ptr(), &mut info) };
        let baked = Baked { handle, info: info.into(), allocator: self.allocator.clone() };
        check(status).map(|()| baked)
    }
}

impl Rig {
    /// Writes a baked file, with a deformer of this rig if there is one. A failure leaves `path` as
    /// it was.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_bake_file)]
    pub fn bake(&self, path: impl AsRef<Path>, deformer: Option<&Deformer>) -> Result<()> {
        let path = path_string(path.as_ref())?;
        let deformer = deformer.map_or(null(), |deformer| deformer.raw());
        // SAFETY: live handles and a terminated path.
        checked(|error| unsafe { sys::mien_bake_file(self.raw(), deformer, path.as_ptr(), error) })
    }

    /// The same to memory.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_bake_memory)]
    pub fn to_baked_bytes(&self, deformer: Option<&Deformer>) -> Result<Vec<u8>> {
        let deformer = deformer.map_or(null(), |deformer| deformer.raw());
        let bake = |buffer: *mut c_void, capacity, size: &mut usize| {
            // SAFETY: live handles and room for `capacity` bytes.
            checked(|error| unsafe {
                sys::mien_bake_memory(self.raw(), deformer, buffer, capacity, size, error)
            })
        };
        let mut size = 0;
        bake(null_mut(), 0, &mut size)?;
        let mut bytes = Vec::<u8>::with_capacity(size);
        bake(bytes.as_mut_ptr().cast(), bytes.capacity(), &mut size)?;
        assert!(size <= bytes.capacity());
        // SAFETY: the call succeeded, so it has written all of them.
        unsafe { bytes.set_len(size) };
        Ok(bytes)
    }
}
