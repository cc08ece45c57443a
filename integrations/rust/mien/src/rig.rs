// SPDX-License-Identifier: MIT

use crate::convert::{bytes, empty_string, index, slice, utf8};
use crate::error::{check, checked};
use crate::{
    Allocator, Arithmetic, Dna, Instance, Isa, Kind, MlMasks, NameMatch, Result, Reuse, RigInfo,
    RigStatistics, RotationOutput, Storage,
};
use mien_sys as sys;
use std::borrow::Cow;
use std::ptr::{null_mut, NonNull};
use std::sync::Arc;

/// The behavior of a face, packed for evaluation. It never changes.
///
/// A `Rig` is a counted reference: clones are the same rig, and each [`Instance`] holds one. So a
/// rig lives as long as its last user, and neither lifetimes nor the order of dropping are a
/// matter for those who store rigs and instances in an engine's components.
///
/// ```
/// use mien::{Dna, Kind, Preset, Rig};
/// let rig = Rig::new(&Dna::generate(Preset::TINY)?)?;
/// for joint in 0..rig.count(Kind::JOINT) {
///     println!("{}", rig.name(Kind::JOINT, joint)?);
/// }
/// # Ok::<(), mien::Error>(())
/// ```
#[derive(Clone)]
pub struct Rig {
    shared: Arc<Shared>,
}

struct Shared {
    handle: NonNull<sys::MienRig>,
    info: RigInfo,
    // Released after the handle.
    _allocator: Option<Allocator>,
}

// SAFETY: the handle is const for every call but destroying; const handles may be used by any
// number of threads at the same time, and any thread may destroy it. Allocators are Send + Sync.
unsafe impl Send for Shared {}
unsafe impl Sync for Shared {}

impl Rig {
    /// Packs the behavior of `dna` for the best instruction set of this machine, with Euler
    /// angles coming out. [`RigOptions`] has other wishes.
    ///
    /// # Errors
    ///
    /// Those of [`RigOptions::create`](crate::RigOptions::create).
    pub fn new(dna: &Dna<'_>) -> Result<Self> {
        RigOptions::new().create(dna)
    }

    /// One character in its initial state.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_instance_create)]
    pub fn instance(&self) -> Result<Instance> {
        Instance::new(self)
    }

    pub(crate) fn raw(&self) -> *const sys::MienRig {
        self.shared.handle.as_ptr()
    }

    /// Units, axes, lengths of rows, memory.
    #[must_use]
    pub fn info(&self) -> &RigInfo {
        &self.shared.info
    }

    /// Whether both are the same rig, not merely equal ones.
    #[must_use]
    pub fn ptr_eq(&self, other: &Rig) -> bool {
        Arc::ptr_eq(&self.shared, &other.shared)
    }

    /// How many there are of a kind. Unknown kinds: 0.
    #[must_use]
    pub fn count(&self, kind: Kind) -> usize {
        let mut out = 0;
        // SAFETY: a live handle. The only failure is a kind that the library does not know.
        unsafe { sys::mien_rig_count(self.raw(), kind.0, &mut out) };
        out as usize
    }

    /// Name of number `i` of a kind; `""` for kinds without names. Where it is not UTF-8,
    /// replacement characters stand.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_rig_name)]
    pub fn name(&self, kind: Kind, i: usize) -> Result<Cow<'_, str>> {
        self.name_bytes(kind, i).map(utf8)
    }

    /// All names of a kind, by index.
    #[must_use]
    pub fn names(&self, kind: Kind) -> impl Iterator<Item = Cow<'_, str>> + '_ {
        (0..self.count(kind)).map(move |i| self.name(kind, i).unwrap_or_default())
    }

    /// The name as it is in the file.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_rig_name)]
    pub fn name_bytes(&self, kind: Kind, i: usize) -> Result<&[u8]> {
        let mut out = empty_string();
        // SAFETY: a live handle; the view lives as long.
        unsafe {
            check(sys::mien_rig_name(self.raw(), kind.0, index(i), &mut out))?;
            Ok(bytes(out))
        }
    }

    /// What a name of another tool means on this rig: how it was matched, and raw controls with their weights.
    /// `AU12` is both smiles. [`Status::NAME`](crate::Status::NAME) if it means nothing.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_rig_match)]
    pub fn match_name(&self, name: impl AsRef<[u8]>) -> Result<(NameMatch, Vec<(usize, f32)>)> {
        let name = name.as_ref();
        let mut shares = vec![sys::MienControlShare::default(); sys::MIEN_MOST_SHARES as usize];
        let (mut count, mut how) = (0, 0);
        // SAFETY: a live handle, and room for as many shares as are told.
        let status = unsafe {
            sys::mien_rig_match(
                self.raw(),
                name.as_ptr().cast(),
                name.len(),
                shares.as_mut_ptr(),
                shares.len(),
                &mut count,
                &mut how,
            )
        };
        if status == sys::MIEN_ERROR_NAME {
            let message = format!("\"{}\" means no raw control of the rig", utf8(name));
            return Err(crate::Error::new(crate::Status::NAME, message));
        }
        check(status)?;
        let found = shares.iter().take(count);
        Ok((NameMatch(how), found.map(|s| (s.control as usize, s.weight)).collect()))
    }

    /// Number of the one with this very name, in O(log n); of equal names the first.
    /// [`Status::NAME`](crate::Status::NAME) if there is none.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_rig_find_n)]
    pub fn find(&self, kind: Kind, name: impl AsRef<[u8]>) -> Result<usize> {
        let (name, mut out) = (name.as_ref(), 0);
        // SAFETY: a live handle, and as many bytes as are told.
        let status = unsafe {
            sys::mien_rig_find_n(self.raw(), kind.0, name.as_ptr().cast(), name.len(), &mut out)
        };
        if status == sys::MIEN_ERROR_NAME {
            let name = utf8(name);
            let message = format!("no {kind:?} is named \"{name}\"");
            return Err(crate::Error::new(crate::Status::NAME, message));
        }
        check(status)?;
        Ok(out as usize)
    }

    /// Which joints, channels, maps, meshes or RBF solvers exist at a LOD, in file order.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_rig_lod_indices)]
    pub fn lod_indices(&self, kind: Kind, lod: usize) -> Result<&[u16]> {
        self.indices(|out| unsafe {
            // SAFETY: a live handle.
            sys::mien_rig_lod_indices(self.raw(), kind.0, index(lod), out)
        })
    }

    /// Which values of [`Instance::joints`] evaluation may change at a LOD, ascending. All others
    /// keep their initial value: 0, or 1 for the w of a quaternion.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_rig_variable_joint_values)]
    pub fn variable_joint_values(&self, lod: usize) -> Result<&[u16]> {
        // SAFETY: a live handle.
        self.indices(|out| unsafe {
            sys::mien_rig_variable_joint_values(self.raw(), index(lod), out)
        })
    }

    /// Parent of each joint; a root is its own parent.
    #[must_use]
    pub fn joint_parents(&self) -> &[u16] {
        // SAFETY: a live handle.
        self.indices(|out| unsafe { sys::mien_rig_joint_parents(self.raw(), out) }).unwrap_or(&[])
    }

    /// The controls whose product drives a corrective, as indices into
    /// [`Instance::controls`].
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_rig_psd_inputs)]
    pub fn psd_inputs(&self, psd: usize) -> Result<&[u16]> {
        // SAFETY: a live handle.
        self.indices(|out| unsafe { sys::mien_rig_psd_inputs(self.raw(), index(psd), out) })
    }

    /// Neutral pose in the layout of [`Instance::joints`], relative to the parent: translation in
    /// translation units, rotation as angles in rotation units or as a quaternion, scale 1.
    #[must_use]
    pub fn neutral_joint_values(&self) -> &[f32] {
        // SAFETY: a live handle.
        self.floats(|out| unsafe { sys::mien_rig_neutral_joint_values(self.raw(), out) })
    }

    /// Value each raw control starts with: 0, or 1 for the w of a quaternion input.
    #[must_use]
    pub fn initial_raw_controls(&self) -> &[f32] {
        // SAFETY: a live handle.
        self.floats(|out| unsafe { sys::mien_rig_initial_raw_controls(self.raw(), out) })
    }

    /// What one evaluation at a LOD works through.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_rig_statistics)]
    pub fn statistics(&self, lod: usize) -> Result<RigStatistics> {
        let mut out = sys::MienRigStatistics::default();
        // SAFETY: a live handle and a sized struct.
        check(unsafe { sys::mien_rig_statistics(self.raw(), index(lod), &mut out) })?;
        Ok(out.into())
    }

    fn indices(
        &self,
        call: impl FnOnce(*mut sys::MienIndex16View) -> sys::MienStatus,
    ) -> Result<&[u16]> {
        let mut out = sys::MienIndex16View::default();
        check(call(&mut out))?;
        // SAFETY: views of a rig live as long as it does, and it never changes.
        Ok(unsafe { slice(out.data, out.count) })
    }

    /// For calls that a live handle is all they need to succeed.
    fn floats(&self, call: impl FnOnce(*mut sys::MienFloatView) -> sys::MienStatus) -> &[f32] {
        let mut out = sys::MienFloatView::default();
        let status = call(&mut out);
        debug_assert_eq!(status, sys::MIEN_OK);
        // SAFETY: as for indices; a failure leaves an empty view.
        unsafe { slice(out.data, out.count) }
    }
}

impl Drop for Shared {
    fn drop(&mut self) {
        // SAFETY: destroyed once; instances hold a reference, so there are none any more.
        unsafe { sys::mien_rig_destroy(self.handle.as_ptr()) }
    }
}

impl std::fmt::Debug for Rig {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Rig").field("info", self.info()).finish_non_exhaustive()
    }
}

/// How to pack a rig.
///
/// ```
/// use mien::{Dna, Isa, Preset, RigOptions, RotationOutput};
/// let dna = Dna::generate(Preset::TINY)?;
/// let rig = RigOptions::new().isa(Isa::SCALAR).rotation(RotationOutput::QUATERNION).create(&dna)?;
/// assert_eq!(rig.info().joint_value_count, 10 * dna.info().joint_count);
/// # Ok::<(), mien::Error>(())
/// ```
#[derive(Clone, Debug, Default)]
#[must_use = "options do nothing until they are used"]
pub struct RigOptions {
    isa: Isa,
    rotation: RotationOutput,
    ml_masks: MlMasks,
    storage: Storage,
    arithmetic: Arithmetic,
    reuse: Reuse,
    allocator: Option<Allocator>,
}

impl RigOptions {
    /// The best instruction set, Euler angles, masks that switch, the heap.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Instruction set. One that is absent is [`Status::ISA`](crate::Status::ISA), never
    /// replaced silently.
    pub fn isa(mut self, isa: Isa) -> Self {
        self.isa = isa;
        self
    }

    /// How joint rotations come out.
    pub fn rotation(mut self, rotation: RotationOutput) -> Self {
        self.rotation = rotation;
        self
    }

    /// What masks of mesh regions do.
    pub fn ml_masks(mut self, ml_masks: MlMasks) -> Self {
        self.ml_masks = ml_masks;
        self
    }

    /// How the large arrays that evaluation reads are kept.
    pub fn storage(mut self, storage: Storage) -> Self {
        self.storage = storage;
        self
    }

    /// Which instruction sets give the same bits.
    pub fn arithmetic(mut self, arithmetic: Arithmetic) -> Self {
        self.arithmetic = arithmetic;
        self
    }

    /// Whether evaluation keeps results whose inputs did not change. The same bits either way, except
    /// with [`Reuse::SUMS`], whose joints stay within a stated error.
    pub fn reuse(mut self, reuse: Reuse) -> Self {
        self.reuse = reuse;
        self
    }

    /// Where memory comes from.
    pub fn allocator(mut self, allocator: &Allocator) -> Self {
        self.allocator = Some(allocator.clone());
        self
    }

    /// Packs the behavior of `dna`, which needs definition and behavior loaded, else
    /// [`Status::DNA_LAYER`](crate::Status::DNA_LAYER).
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_rig_create)]
    pub fn create(&self, dna: &Dna<'_>) -> Result<Rig> {
        let mut handle = null_mut();
        Allocator::with(self.allocator.as_ref(), |allocator| {
            let desc = sys::MienRigDesc {
                isa: self.isa.0,
                rotation_output: self.rotation.0,
                ml_masks: self.ml_masks.0,
                storage: self.storage.0,
                arithmetic: self.arithmetic.0,
                reuse: self.reuse.0,
                allocator,
                ..Default::default()
            };
            // SAFETY: a live handle and a sized struct.
            checked(|error| unsafe { sys::mien_rig_create(dna.raw(), &desc, &mut handle, error) })
        })?;
        Self::adopt(self.allocator.as_ref(), handle)
    }

    /// Makes a rig of what `create` gave.
    pub(crate) fn adopt(allocator: Option<&Allocator>, handle: *mut sys::MienRig) -> Result<Rig> {
        let handle = NonNull::new(handle).expect("a handle after success");
        let mut info = sys::MienRigInfo::default();
        // SAFETY: a live handle and a sized struct.
        let status = unsafe { sys::mien_rig_info(handle.as_ptr(), &mut info) };
        let shared = Shared { handle, info: info.into(), _allocator: allocator.cloned() };
        let rig = Rig { shared: Arc::new(shared) };
        check(status).map(|()| rig)
    }
}

impl Isa {
    /// Whether rigs can be created for it here.
    #[must_use]
    pub fn is_available(self) -> bool {
        // SAFETY: any number may be asked for.
        unsafe { sys::mien_isa_available(self.0) != 0 }
    }

    /// `"avx2"` for [`Isa::AVX2`], `"unknown"` for other numbers.
    #[must_use]
    pub fn name(self) -> &'static str {
        // SAFETY: any number may be given; the result is static and terminated.
        let name = unsafe { std::ffi::CStr::from_ptr(sys::mien_isa_name(self.0)) };
        name.to_str().unwrap_or("unknown")
    }
}

/// The usual name of a control: `mouthSmileLeft` for `AU12_L`. [`Status::NAME`](crate::Status::NAME) if the table of
/// names does not have it.
///
/// ```
/// assert_eq!(mien::control_name("AU12_L")?, "mouthSmileLeft");
/// # Ok::<(), mien::Error>(())
/// ```
///
/// # Errors
///
#[doc = errors!(mien_control_name)]
pub fn control_name(name: impl AsRef<[u8]>) -> Result<String> {
    let name = name.as_ref();
    let (mut out, mut count) = ([0_u8; 256], 0);
    // SAFETY: as many bytes as are told, on both sides.
    let status = unsafe {
        sys::mien_control_name(
            name.as_ptr().cast(),
            name.len(),
            out.as_mut_ptr().cast(),
            out.len(),
            &mut count,
        )
    };
    if status == sys::MIEN_ERROR_NAME {
        let message = format!("\"{}\" is not in the table of names", utf8(name));
        return Err(crate::Error::new(crate::Status::NAME, message));
    }
    check(status)?;
    Ok(utf8(out.get(..count).unwrap_or_default()).into_owned())
}
