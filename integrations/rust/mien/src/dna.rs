// SPDX-License-Identifier: MIT

use crate::convert::{bytes, empty_string, index, path_string, terminated, utf8};
use crate::error::{check, checked};
use crate::stream::with_stream;
use crate::{
    Allocator, CoordinateSystem, DnaField, DnaInfo, DnaLayer, Generate, Layers, Preset, Result,
    UnknownLayers,
};
use mien_sys as sys;
use std::borrow::Cow;
use std::io::{Read, Seek};
use std::marker::PhantomData;
use std::mem::replace;
use std::os::raw::c_void;
use std::path::Path;
use std::ptr::{null, null_mut, NonNull};

/// A checked, read-only view of a DNA file.
///
/// A rig keeps its own copy of all it needs, so a `Dna` may be dropped as soon as the rig is made.
/// `'bytes` is how long the file's bytes live if they are borrowed.
///
/// ```no_run
/// let dna = mien::Dna::open("head.dna")?;
/// println!("{} joints in {} LODs", dna.info().joint_count, dna.info().lod_count);
/// # Ok::<(), mien::Error>(())
/// ```
pub struct Dna<'bytes> {
    handle: NonNull<sys::MienDna>,
    info: DnaInfo,
    // Released after the handle.
    _allocator: Option<Allocator>,
    _bytes: PhantomData<&'bytes [u8]>,
}

// SAFETY: after opening, the library is only called with the handle as const, which any number of
// threads may do; any thread may close it. Allocators are Send + Sync.
unsafe impl Send for Dna<'_> {}
unsafe impl Sync for Dna<'_> {}

impl Dna<'static> {
    /// Reads a whole file and checks it. [`OpenOptions`] loads parts, or maps the file.
    ///
    /// # Errors
    ///
    /// Those of [`OpenOptions::open`](crate::OpenOptions::open).
    pub fn open(path: impl AsRef<Path>) -> Result<Self> {
        OpenOptions::new().open(path)
    }

    /// Makes a synthetic face rig. [`GenerateOptions`] has a seed, too.
    ///
    /// # Errors
    ///
    /// Those of [`GenerateOptions::preset`](crate::GenerateOptions::preset).
    pub fn generate(preset: Preset) -> Result<Self> {
        GenerateOptions::new().preset(preset).generate()
    }
}

impl<'bytes> Dna<'bytes> {
    /// Checks a file that is in memory, without a copy of it.
    ///
    /// # Errors
    ///
    /// Those of [`OpenOptions::open_bytes`](crate::OpenOptions::open_bytes).
    pub fn from_bytes(bytes: &'bytes [u8]) -> Result<Self> {
        OpenOptions::new().open_bytes(bytes)
    }

    pub(crate) fn created(
        allocator: Option<&Allocator>,
        call: impl FnOnce(*const sys::MienAllocator, *mut *mut sys::MienDna, *mut sys::MienError) -> i32,
    ) -> Result<Self> {
        /// Closes what was opened if `call` panics.
        struct Opened(*mut sys::MienDna);
        impl Drop for Opened {
            fn drop(&mut self) {
                // SAFETY: closed once; null is allowed.
                unsafe { sys::mien_dna_close(self.0) }
            }
        }
        let mut opened = Opened(null_mut());
        Allocator::with(allocator, |raw| checked(|error| call(raw, &mut opened.0, error)))?;
        let handle =
            NonNull::new(replace(&mut opened.0, null_mut())).expect("a handle after success");
        let mut info = sys::MienDnaInfo::default();
        // SAFETY: a live handle and a sized struct.
        let status = unsafe { sys::mien_dna_info(handle.as_ptr(), &mut info) };
        let dna =
            Self { handle, info: info.into(), _allocator: allocator.cloned(), _bytes: PhantomData };
        check(status).map(|()| dna)
    }

    pub(crate) fn raw(&self) -> *const sys::MienDna {
        self.handle.as_ptr()
    }

    /// What the file holds: counts, units, axes, LODs.
    #[must_use]
    pub fn info(&self) -> &DnaInfo {
        &self.info
    }

    /// Entry `index` of the file's table of layers, of `info().layer_count`.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_dna_layer)]
    pub fn layer(&self, layer: usize) -> Result<DnaLayer> {
        let mut out = sys::MienDnaLayer::default();
        // SAFETY: a live handle and a sized struct.
        check(unsafe { sys::mien_dna_layer(self.raw(), index(layer), &mut out) })?;
        Ok(out.into())
    }

    /// What is at a path: the layer's code and the field names of the DNA format, with an index
    /// after each list.
    ///
    /// ```
    /// # let dna = mien::Dna::generate(mien::Preset::TINY)?;
    /// let field = dna.field("defn.jointNames")?;
    /// assert_eq!(field.field_type, mien::FieldType::LIST);
    /// assert_eq!(field.count, dna.info().joint_count as u64);
    /// let name = dna.read_string("defn.jointNames[0]")?;
    /// let xs = dna.read_floats("defn.neutralJointTranslations.xs")?;
    /// # assert_eq!(xs.len(), dna.info().joint_count);
    /// # assert!(!name.is_empty());
    /// # Ok::<(), mien::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_dna_field)]
    pub fn field(&self, path: &str) -> Result<DnaField> {
        let path = terminated(path)?;
        let mut out = sys::MienDnaField::default();
        // SAFETY: a live handle, a terminated path, a sized struct.
        checked(|error| unsafe {
            sys::mien_dna_field(self.raw(), path.as_ptr(), &mut out, error)
        })?;
        Ok(out.into())
    }

    /// Name of field `field` of the record at `path` (`""` for the layers themselves).
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_dna_child_name)]
    pub fn field_name(&self, path: &str, field: usize) -> Result<Cow<'_, str>> {
        let path = terminated(path)?;
        let mut out = empty_string();
        checked(|error| unsafe {
            // SAFETY: a live handle and a terminated path.
            sys::mien_dna_child_name(self.raw(), path.as_ptr(), index(field), &mut out, error)
        })?;
        // SAFETY: the view lives as long as the handle.
        Ok(utf8(unsafe { bytes(out) }))
    }

    /// All elements of a float field.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_dna_read_floats)]
    pub fn read_floats(&self, path: &str) -> Result<Vec<f32>> {
        let mut out = vec![0.0; self.length(path)?];
        self.read_floats_into(path, 0, &mut out)?;
        Ok(out)
    }

    /// Fills `out` with elements of a float field, from element `first` on.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_dna_read_floats)]
    pub fn read_floats_into(&self, path: &str, first: u64, out: &mut [f32]) -> Result<()> {
        let (path, count) = (terminated(path)?, out.len() as u64);
        // SAFETY: a live handle, a terminated path, and room for `count` values.
        checked(|error| unsafe {
            let out = out.as_mut_ptr();
            sys::mien_dna_read_floats(self.raw(), path.as_ptr(), first, count, out, error)
        })
    }

    /// All elements of an integer field, whatever their width.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_dna_read_integers)]
    pub fn read_integers(&self, path: &str) -> Result<Vec<i64>> {
        let mut out = vec![0; self.length(path)?];
        self.read_integers_into(path, 0, &mut out)?;
        Ok(out)
    }

    /// Fills `out` with elements of an integer field, from element `first` on.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_dna_read_integers)]
    pub fn read_integers_into(&self, path: &str, first: u64, out: &mut [i64]) -> Result<()> {
        let (path, count) = (terminated(path)?, out.len() as u64);
        // SAFETY: as for floats.
        checked(|error| unsafe {
            let out = out.as_mut_ptr();
            sys::mien_dna_read_integers(self.raw(), path.as_ptr(), first, count, out, error)
        })
    }

    /// Elements at a path, if it can be read at all; the file bounds them, so they can be
    /// allocated.
    fn length(&self, path: &str) -> Result<usize> {
        let field = self.field(path)?;
        let numbers = field.field_type.0 >= sys::MIEN_FIELD_U8;
        // Of records and lists the read call says what is wrong.
        Ok(if numbers { field.count as usize } else { 0 })
    }

    /// The text at a path. Where it is not UTF-8, replacement characters stand.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_dna_read_string)]
    pub fn read_string(&self, path: &str) -> Result<Cow<'_, str>> {
        self.read_string_bytes(path).map(utf8)
    }

    /// The text at a path as it is in the file.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_dna_read_string)]
    pub fn read_string_bytes(&self, path: &str) -> Result<&[u8]> {
        let path = terminated(path)?;
        let mut out = empty_string();
        // SAFETY: a live handle and a terminated path.
        checked(|error| unsafe {
            sys::mien_dna_read_string(self.raw(), path.as_ptr(), &mut out, error)
        })?;
        // SAFETY: the view lives as long as the handle.
        Ok(unsafe { bytes(out) })
    }

    /// Writes a canonical file; [`WriteOptions`] converts to other versions. Goes to a temporary
    /// name first, so a failure leaves `path` as it was.
    ///
    /// # Errors
    ///
    /// Those of [`WriteOptions::write`](crate::WriteOptions::write).
    pub fn write(&self, path: impl AsRef<Path>) -> Result<()> {
        WriteOptions::new().write(self, path)
    }

    /// The same to memory.
    ///
    /// # Errors
    ///
    /// Those of [`WriteOptions::to_bytes`](crate::WriteOptions::to_bytes).
    pub fn to_bytes(&self) -> Result<Vec<u8>> {
        WriteOptions::new().to_bytes(self)
    }
}

impl Drop for Dna<'_> {
    fn drop(&mut self) {
        // SAFETY: closed once; nothing that points into it outlives `self`.
        unsafe { sys::mien_dna_close(self.handle.as_ptr()) }
    }
}

impl std::fmt::Debug for Dna<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Dna").field("info", &self.info).finish_non_exhaustive()
    }
}

/// What to load of a file, and how.
///
/// ```
/// use mien::{Layers, OpenOptions};
/// let file = mien::Dna::generate(mien::Preset::TINY)?.to_bytes()?;
/// // The coarsest two LODs, without geometry.
/// let dna = OpenOptions::new().layers(Layers::BEHAVIOR).lods(0b110).open_bytes(&file)?;
/// assert_eq!(dna.info().lod_count, 2);
/// # Ok::<(), mien::Error>(())
/// ```
#[derive(Clone, Debug, Default)]
#[must_use = "options do nothing until they are used"]
pub struct OpenOptions {
    layers: Layers,
    skip_blend_shape_targets: bool,
    unknown_layers: UnknownLayers,
    lods: u64,
    system: Option<CoordinateSystem>,
    allocator: Option<Allocator>,
}

impl OpenOptions {
    /// Everything, from the heap.
    pub fn new() -> Self {
        Self::default()
    }

    /// Only these layers, and those that they need. What is not chosen is not looked at.
    pub fn layers(mut self, layers: Layers) -> Self {
        self.layers = layers;
        self
    }

    /// Loads the geometry without its blend shape targets.
    pub fn skip_blend_shape_targets(mut self, skip: bool) -> Self {
        self.skip_blend_shape_targets = skip;
        self
    }

    /// What to do with layers of a kind that Mien does not know.
    pub fn unknown_layers(mut self, unknown_layers: UnknownLayers) -> Self {
        self.unknown_layers = unknown_layers;
        self
    }

    /// Bit `l` keeps LOD `l` of the file; 0 keeps all. Kept LODs are renumbered from 0, and
    /// what no kept LOD uses is dropped and the rest renumbered.
    /// [`Status::LOD`](crate::Status::LOD) if the file has none of them.
    pub fn lods(mut self, lods: u64) -> Self {
        self.lods = lods;
        self
    }

    /// Converts everything to another coordinate system. What cannot follow is refused with
    /// [`Status::DNA_VALUE`](crate::Status::DNA_VALUE).
    pub fn system(mut self, system: &CoordinateSystem) -> Self {
        self.system = Some(*system);
        self
    }

    /// Where memory comes from.
    pub fn allocator(mut self, allocator: &Allocator) -> Self {
        self.allocator = Some(allocator.clone());
        self
    }

    /// Opens by `open`, which gets the description as C takes it.
    fn open_by(
        &self,
        access: u32,
        open: impl FnOnce(
            *const sys::MienDnaDesc,
            *mut *mut sys::MienDna,
            *mut sys::MienError,
        ) -> sys::MienStatus,
    ) -> Result<Dna<'static>> {
        let system = self.system.as_ref().map(sys::MienCoordinateSystem::from);
        let system = system.as_ref().map_or(null(), |system| system as *const _);
        Dna::created(self.allocator.as_ref(), |allocator, out, error| {
            open(&self.desc(allocator, system, access), out, error)
        })
    }

    fn desc(
        &self,
        allocator: *const sys::MienAllocator,
        system: *const sys::MienCoordinateSystem,
        access: u32,
    ) -> sys::MienDnaDesc {
        sys::MienDnaDesc {
            system,
            layers: self.layers.0,
            skip_blend_shape_targets: self.skip_blend_shape_targets.into(),
            unknown_layers: self.unknown_layers.0,
            file_access: access,
            lods: self.lods,
            allocator,
            ..Default::default()
        }
    }

    /// Reads the whole file into memory, then checks what was chosen of it.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_dna_open_file)]
    pub fn open(&self, path: impl AsRef<Path>) -> Result<Dna<'static>> {
        // SAFETY: once read, the copy cannot change.
        unsafe { self.open_file(path.as_ref(), sys::MIEN_FILE_READ) }
    }

    /// Maps the file instead of reading it: what was not chosen is never read from disk.
    ///
    /// # Safety
    ///
    /// While the `Dna` lives, no one may truncate the file or rewrite it in place: it is checked
    /// once, and then believed. Replacing it by renaming another one over it is fine.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_dna_open_file)]
    pub unsafe fn map(&self, path: impl AsRef<Path>) -> Result<Dna<'static>> {
        // SAFETY: the caller sees to it that the file stays as it is.
        unsafe { self.open_file(path.as_ref(), sys::MIEN_FILE_MAP) }
    }

    /// # Safety
    ///
    /// As for [`map`](Self::map), if `access` maps.
    unsafe fn open_file(&self, path: &Path, access: u32) -> Result<Dna<'static>> {
        let path = path_string(path)?;
        self.open_by(access, |desc, out, error| {
            // SAFETY: a terminated path and a sized struct; the rest is the caller's.
            unsafe { sys::mien_dna_open_file(path.as_ptr(), desc, out, error) }
        })
    }

    /// Reads what was chosen, and nothing else, from a file inside of something larger, such as an
    /// archive.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_dna_open_stream)]
    ///
    /// An error of the reader is [`Status::FILE_READ`](crate::Status::FILE_READ).
    pub fn open_reader(&self, reader: &mut (impl Read + Seek)) -> Result<Dna<'static>> {
        with_stream(reader, |stream| {
            self.open_by(sys::MIEN_FILE_READ, |desc, out, error| {
                // SAFETY: a stream that is valid for the call, and a sized struct.
                unsafe { sys::mien_dna_open_stream(stream, desc, out, error) }
            })
        })
    }

    /// Checks a file that is in memory, without a copy of it.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_dna_open_memory)]
    pub fn open_bytes<'bytes>(&self, bytes: &'bytes [u8]) -> Result<Dna<'bytes>> {
        self.open_by(sys::MIEN_FILE_MAP, |desc, out, error| {
            let data = bytes.as_ptr().cast();
            // SAFETY: the `Dna` that is returned borrows the bytes, so they outlive it unchanged.
            unsafe { sys::mien_dna_open_memory(data, bytes.len(), desc, out, error) }
        })
    }
}

/// How to write a file.
#[derive(Clone, Debug, Default)]
#[must_use = "options do nothing until they are used"]
pub struct WriteOptions {
    version: u32,
    unknown_layers: UnknownLayers,
}

impl WriteOptions {
    /// The version of the file itself, with everything that was loaded.
    pub fn new() -> Self {
        Self::default()
    }

    /// 1 to 8 write 2.1 to 2.8; 0 keeps the version.
    pub fn version(mut self, version: u32) -> Self {
        self.version = version;
        self
    }

    /// What to do with layers that the version does not know (2.1 keeps the four classic ones).
    pub fn unknown_layers(mut self, unknown_layers: UnknownLayers) -> Self {
        self.unknown_layers = unknown_layers;
        self
    }

    fn desc(&self) -> sys::MienWriteDesc {
        sys::MienWriteDesc {
            version: self.version,
            unknown_layers: self.unknown_layers.0,
            ..Default::default()
        }
    }

    /// Writes `dna` to a temporary name first, so a failure leaves `path` as it was.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_dna_write_file)]
    pub fn write(&self, dna: &Dna<'_>, path: impl AsRef<Path>) -> Result<()> {
        let path = path_string(path.as_ref())?;
        // SAFETY: a live handle, a terminated path, a sized struct.
        checked(|error| unsafe {
            sys::mien_dna_write_file(dna.raw(), path.as_ptr(), &self.desc(), error)
        })
    }

    /// The same bytes, to memory.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_dna_write_memory)]
    pub fn to_bytes(&self, dna: &Dna<'_>) -> Result<Vec<u8>> {
        let write = |buffer: *mut c_void, capacity, size: &mut usize| {
            // SAFETY: a live handle, a sized struct, and room for `capacity` bytes.
            checked(|error| unsafe {
                sys::mien_dna_write_memory(dna.raw(), &self.desc(), buffer, capacity, size, error)
            })
        };
        let mut size = 0;
        write(null_mut(), 0, &mut size)?;
        let mut bytes = Vec::<u8>::with_capacity(size);
        write(bytes.as_mut_ptr().cast(), bytes.capacity(), &mut size)?;
        assert!(size <= bytes.capacity());
        // SAFETY: the call succeeded, so it has written all of them.
        unsafe { bytes.set_len(size) };
        Ok(bytes)
    }
}

/// Which synthetic rig to make.
///
/// The same seed gives the same bytes on every machine.
#[derive(Clone, Debug, Default)]
#[must_use = "options do nothing until they are used"]
pub struct GenerateOptions {
    preset: Preset,
    seed: u64,
    flags: u32,
    allocator: Option<Allocator>,
}

impl GenerateOptions {
    /// The tiny rig of seed 0.
    pub fn new() -> Self {
        Self::default()
    }

    /// How large.
    pub fn preset(mut self, preset: Preset) -> Self {
        self.preset = preset;
        self
    }

    /// Which of its size.
    pub fn seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }

    /// What it has beyond that: [`Generate::ML`] is machine-learned behavior.
    pub fn with(mut self, extra: Generate) -> Self {
        self.flags |= extra.0;
        self
    }

    /// Where memory comes from.
    pub fn allocator(mut self, allocator: &Allocator) -> Self {
        self.allocator = Some(allocator.clone());
        self
    }

    /// Makes it.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_dna_generate)]
    pub fn generate(&self) -> Result<Dna<'static>> {
        Dna::created(self.allocator.as_ref(), |allocator, out, error| {
            let desc = sys::MienGenerateDesc {
                preset: self.preset.0,
                seed: self.seed,
                flags: self.flags,
                allocator,
                ..Default::default()
            };
            // SAFETY: a sized struct.
            unsafe { sys::mien_dna_generate(&desc, out, error) }
        })
    }
}
