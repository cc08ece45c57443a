// SPDX-License-Identifier: MIT

use crate::convert::{bytes, empty_string, index, path_string, terminated, utf8};
use crate::error::checked;
use crate::{
    Allocator, Conformed, CoordinateSystem, Dna, DnaField, DnaLayer, Error, Kind, Layers, Match,
    PrunedJoints, PrunedTargets, Report, Result, Status, UnknownLayers,
};
use mien_sys as sys;
use std::borrow::Cow;
use std::ffi::c_void;
use std::path::Path;
use std::ptr::{null, null_mut, NonNull};

/// A DNA file that can be changed: its fields by the paths of [`Dna::field`], and as a whole by operations
/// that keep together what refers to each other.
///
/// A call that fails changes nothing. What is not changed stays as it was, byte for byte.
///
/// ```
/// use mien::{Dna, Document, Kind, Preset};
///
/// let dna = Dna::generate(Preset::TINY)?;
/// let mut head = Document::new(&dna)?;
/// let jaw = head.find(Kind::JOINT, &dna.read_string("defn.jointNames[1]")?)?;
/// let before = head.mark()?;
/// head.rename(Kind::JOINT, jaw, "jaw")?;
/// head.keep_lods(0b10)?;
/// assert_eq!(head.to_dna()?.info().lod_count, 1);
/// head.undo(before)?;
/// assert_eq!(head.to_dna()?.to_bytes()?, dna.to_bytes()?);
/// # Ok::<(), mien::Error>(())
/// ```
pub struct Document {
    handle: NonNull<sys::MienDocument>,
    // Released after the handle.
    allocator: Option<Allocator>,
}

// SAFETY: the library keeps no state per thread; const calls may be made by any number of threads, and what
// changes a document takes `&mut self`. Allocators are Send + Sync.
unsafe impl Send for Document {}
unsafe impl Sync for Document {}

/// Where a character goes: scaled about the origin, then rotated about it, then moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Above 0.
    pub scale: f64,
    /// Right-handed degrees about x, then y, then z of the file.
    pub rotation: [f64; 3],
    /// In the unit of the file.
    pub translation: [f64; 3],
}

impl Default for Placement {
    fn default() -> Self {
        Self { scale: 1.0, rotation: [0.0; 3], translation: [0.0; 3] }
    }
}

/// How [`Document::project`] and [`Document::make_lod`] work.
#[derive(Clone, Copy, Debug, Default)]
pub struct ProjectOptions {
    /// How places are found.
    pub matched_by: Match,
    /// At most, per position. 0: 8.
    pub influences: usize,
    /// Leaves the skin weights as they are.
    pub keep_weights: bool,
    /// Leaves the targets as they are.
    pub keep_targets: bool,
}

/// What a raw control that both rigs have does differently after a transplant, at 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControlError {
    /// Its number in the new rig.
    pub control: usize,
    /// Distance of a position of LOD 0, in the unit of the file.
    pub worst: f64,
    /// Of all positions.
    pub rms: f64,
    /// The farthest that the control moved a position before.
    pub moved: f64,
}

impl Document {
    /// A document of an open file, as it was loaded.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_create)]
    pub fn new(dna: &Dna<'_>) -> Result<Self> {
        Self::create(dna.raw(), None)
    }

    /// The same, with memory of your own.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_create)]
    pub fn new_in(dna: &Dna<'_>, allocator: &Allocator) -> Result<Self> {
        Self::create(dna.raw(), Some(allocator))
    }

    /// A document of a whole file, which is read into memory once.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_open_file)]
    pub fn open(path: impl AsRef<Path>) -> Result<Self> {
        let path = path_string(path.as_ref())?;
        let desc = sys::MienDocumentDesc {
            file_access: sys::MIEN_FILE_READ,
            unknown_layers: UnknownLayers::KEEP.0,
            ..Default::default()
        };
        let mut handle = null_mut();
        // SAFETY: a terminated path and a sized struct.
        checked(|error| unsafe {
            sys::mien_document_open_file(path.as_ptr(), &desc, &mut handle, error)
        })?;
        let handle = NonNull::new(handle).expect("a handle after success");
        Ok(Self { handle, allocator: None })
    }

    /// A file of version 2.8 with all layers, and nothing in them.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_create)]
    pub fn empty() -> Result<Self> {
        Self::create(null(), None)
    }

    fn create(dna: *const sys::MienDna, allocator: Option<&Allocator>) -> Result<Self> {
        let mut handle = null_mut();
        Allocator::with(allocator, |allocator| {
            let desc = sys::MienDocumentDesc { allocator, ..Default::default() };
            // SAFETY: null or a live handle, and a sized struct.
            checked(|error| unsafe { sys::mien_document_create(dna, &desc, &mut handle, error) })
        })?;
        let handle = NonNull::new(handle).expect("a handle after success");
        Ok(Self { handle, allocator: allocator.cloned() })
    }

    fn raw(&self) -> *const sys::MienDocument {
        self.handle.as_ptr()
    }

    /// Calls what changes the document.
    fn change(
        &mut self,
        call: impl FnOnce(*mut sys::MienDocument, *mut sys::MienError) -> sys::MienStatus,
    ) -> Result<()> {
        checked(|error| call(self.handle.as_ptr(), error))
    }

    /// What is at a path, as [`Dna::field`].
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_field)]
    pub fn field(&self, path: &str) -> Result<DnaField> {
        let path = terminated(path)?;
        let mut out = sys::MienDnaField::default();
        // SAFETY: a live handle, a terminated path, a sized struct.
        checked(|error| unsafe {
            sys::mien_document_field(self.raw(), path.as_ptr(), &mut out, error)
        })?;
        Ok(out.into())
    }

    /// Name of field `field` of the record at `path`, as [`Dna::field_name`].
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_child_name)]
    pub fn field_name(&self, path: &str, field: usize) -> Result<Cow<'_, str>> {
        let path = terminated(path)?;
        let mut out = empty_string();
        // SAFETY: a live handle and a terminated path.
        checked(|error| unsafe {
            sys::mien_document_child_name(self.raw(), path.as_ptr(), index(field), &mut out, error)
        })?;
        // SAFETY: the view is static.
        Ok(utf8(unsafe { bytes(out) }))
    }

    /// Elements at a path, if it can be read at all.
    fn length(&self, path: &str) -> Result<usize> {
        let field = self.field(path)?;
        let numbers = field.field_type.0 >= sys::MIEN_FIELD_U8;
        Ok(if numbers { field.count as usize } else { 0 })
    }

    /// All elements of a float field.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_read_floats)]
    pub fn read_floats(&self, path: &str) -> Result<Vec<f32>> {
        let mut out = vec![0.0; self.length(path)?];
        let (path, count) = (terminated(path)?, out.len() as u64);
        // SAFETY: a live handle, a terminated path, and room for `count` values.
        checked(|error| unsafe {
            let out = out.as_mut_ptr();
            sys::mien_document_read_floats(self.raw(), path.as_ptr(), 0, count, out, error)
        })?;
        Ok(out)
    }

    /// All elements of an integer field, whatever their width.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_read_integers)]
    pub fn read_integers(&self, path: &str) -> Result<Vec<i64>> {
        let mut out = vec![0; self.length(path)?];
        let (path, count) = (terminated(path)?, out.len() as u64);
        // SAFETY: as for floats.
        checked(|error| unsafe {
            let out = out.as_mut_ptr();
            sys::mien_document_read_integers(self.raw(), path.as_ptr(), 0, count, out, error)
        })?;
        Ok(out)
    }

    /// The text at a path. Where it is not UTF-8, replacement characters stand.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_read_string)]
    pub fn read_string(&self, path: &str) -> Result<Cow<'_, str>> {
        let path = terminated(path)?;
        let mut out = empty_string();
        // SAFETY: a live handle and a terminated path.
        checked(|error| unsafe {
            sys::mien_document_read_string(self.raw(), path.as_ptr(), &mut out, error)
        })?;
        // SAFETY: the view is valid until the document changes, which takes `&mut self`.
        Ok(utf8(unsafe { bytes(out) }))
    }

    /// An array or string as it is in the file: big-endian.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_bytes)]
    pub fn bytes(&self, path: &str) -> Result<&[u8]> {
        let path = terminated(path)?;
        let mut out = empty_string();
        // SAFETY: a live handle and a terminated path.
        checked(|error| unsafe {
            sys::mien_document_bytes(self.raw(), path.as_ptr(), &mut out, error)
        })?;
        // SAFETY: the view is valid until the document changes, which takes `&mut self`.
        Ok(unsafe { bytes(out) })
    }

    /// Replaces elements of a float field, from element `first` on.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_write_floats)]
    pub fn write_floats(&mut self, path: &str, first: u64, values: &[f32]) -> Result<()> {
        let (path, count, values) = (terminated(path)?, values.len() as u64, values.as_ptr());
        // SAFETY: a live handle, a terminated path, `count` values.
        self.change(|document, error| unsafe {
            sys::mien_document_write_floats(document, path.as_ptr(), first, count, values, error)
        })
    }

    /// Replaces elements of an integer field, from element `first` on.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_write_integers)]
    pub fn write_integers(&mut self, path: &str, first: u64, values: &[i64]) -> Result<()> {
        let (path, count, values) = (terminated(path)?, values.len() as u64, values.as_ptr());
        // SAFETY: as for floats.
        self.change(|document, error| unsafe {
            sys::mien_document_write_integers(document, path.as_ptr(), first, count, values, error)
        })
    }

    /// Replaces a string.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_write_string)]
    pub fn write_string(&mut self, path: &str, text: &str) -> Result<()> {
        let (path, count, text) = (terminated(path)?, text.len(), text.as_ptr().cast());
        // SAFETY: a live handle, a terminated path, `count` bytes.
        self.change(|document, error| unsafe {
            sys::mien_document_write_string(document, path.as_ptr(), text, count, error)
        })
    }

    /// Replaces `removed` elements of an array or list by `inserted` new ones: zeros, empty strings, or records
    /// of these. What refers to elements by number stays as it is.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_splice)]
    pub fn splice(&mut self, path: &str, first: u64, removed: u64, inserted: u64) -> Result<()> {
        let path = terminated(path)?;
        // SAFETY: a live handle and a terminated path.
        self.change(|document, error| unsafe {
            sys::mien_document_splice(document, path.as_ptr(), first, removed, inserted, error)
        })
    }

    /// Gives an array or list `count` elements, at its end.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_resize)]
    pub fn resize(&mut self, path: &str, count: u64) -> Result<()> {
        let path = terminated(path)?;
        // SAFETY: a live handle and a terminated path.
        self.change(|document, error| unsafe {
            sys::mien_document_resize(document, path.as_ptr(), count, error)
        })
    }

    /// The version of the file, 2.x, and the number of layers that its list names.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_layer_count)]
    pub fn layer_count(&self) -> Result<(u32, usize)> {
        let (mut version, mut count) = (0, 0);
        // SAFETY: a live handle.
        checked(|error| unsafe {
            sys::mien_document_layer_count(self.raw(), &mut version, &mut count, error)
        })?;
        Ok((version, count as usize))
    }

    /// A layer of the list and, if its kind is not known, its bytes.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_layer)]
    pub fn layer(&self, layer: usize) -> Result<(DnaLayer, &[u8])> {
        let (mut out, mut content) = (sys::MienDnaLayer::default(), empty_string());
        // SAFETY: a live handle and a sized struct.
        checked(|error| unsafe {
            sys::mien_document_layer(self.raw(), index(layer), &mut out, &mut content, error)
        })?;
        // SAFETY: the view is valid until the document changes, which takes `&mut self`.
        Ok((out.into(), unsafe { bytes(content) }))
    }

    /// Makes the document a file of version 2.`version` and its list of layers empty.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_clear_layers)]
    pub fn clear_layers(&mut self, version: u32) -> Result<()> {
        // SAFETY: a live handle.
        self.change(|document, error| unsafe {
            sys::mien_document_clear_layers(document, version, error)
        })
    }

    /// Appends a layer of version major.minor to the list: of a known kind without bytes, or of another one with
    /// its bytes.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_add_layer)]
    pub fn add_layer(&mut self, code: &str, version: (u32, u32), content: &[u8]) -> Result<()> {
        let (code, size, content) = (terminated(code)?, content.len(), content.as_ptr().cast());
        let (major, minor) = version;
        // SAFETY: a live handle, terminated text, `size` bytes.
        self.change(|document, error| unsafe {
            sys::mien_document_add_layer(
                document,
                code.as_ptr(),
                major,
                minor,
                content,
                size,
                error,
            )
        })
    }

    /// Remembers the current state, for [`undo`](Self::undo).
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_mark)]
    pub fn mark(&mut self) -> Result<u64> {
        let mut mark = 0;
        // SAFETY: a live handle.
        self.change(|document, error| unsafe {
            sys::mien_document_mark(document, &mut mark, error)
        })?;
        Ok(mark)
    }

    /// Goes back to the state at a mark; 0 is the state at the beginning.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_undo)]
    pub fn undo(&mut self, mark: u64) -> Result<()> {
        // SAFETY: a live handle.
        self.change(|document, error| unsafe { sys::mien_document_undo(document, mark, error) })
    }

    /// Number of the element of a kind that has this name.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_find)]
    pub fn find(&self, kind: Kind, name: &str) -> Result<usize> {
        let name = terminated(name)?;
        let mut found = 0;
        // SAFETY: a live handle and terminated text.
        checked(|error| unsafe {
            sys::mien_document_find(self.raw(), kind.0, name.as_ptr(), &mut found, error)
        })?;
        Ok(found as usize)
    }

    /// Gives an element another name.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_rename)]
    pub fn rename(&mut self, kind: Kind, element: usize, name: &str) -> Result<()> {
        let name = terminated(name)?;
        // SAFETY: a live handle and terminated text.
        self.change(|document, error| unsafe {
            sys::mien_document_rename(document, kind.0, index(element), name.as_ptr(), error)
        })
    }

    /// Removes controls, joints, blend shape channels, animated maps or meshes, and what refers to them.
    /// Children and skin weights of joints go to the nearest ancestor that stays.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_remove)]
    pub fn remove(&mut self, kind: Kind, elements: &[u32]) -> Result<()> {
        // SAFETY: a live handle and as many elements as are told.
        self.change(|document, error| unsafe {
            sys::mien_document_remove(document, kind.0, elements.as_ptr(), elements.len(), error)
        })
    }

    /// Removes all blend shape channels with their targets, all animated maps, or, for
    /// [`Kind::JOINT`], all that moves joints.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_clear)]
    pub fn clear(&mut self, kind: Kind) -> Result<()> {
        // SAFETY: a live handle.
        self.change(|document, error| unsafe { sys::mien_document_clear(document, kind.0, error) })
    }

    /// Removes what moves these joints.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_clear_joints)]
    pub fn clear_joints(&mut self, joints: &[u32]) -> Result<()> {
        // SAFETY: a live handle and as many elements as are told.
        self.change(|document, error| unsafe {
            sys::mien_document_clear_joints(document, joints.as_ptr(), joints.len(), error)
        })
    }

    /// Sets neutral transforms relative to the parents, from a joint on. `None` leaves them.
    ///
    /// # Errors
    ///
    /// [`Status::MISMATCH`] if there are translations and another number of rotations.
    #[doc = errors!(mien_document_set_neutral)]
    pub fn set_neutral(
        &mut self,
        first_joint: usize,
        translations: Option<&[[f32; 3]]>,
        rotations: Option<&[[f32; 3]]>,
    ) -> Result<()> {
        let count = translations.or(rotations).map_or(0, <[_]>::len);
        if rotations.map_or(false, |given| given.len() != count) {
            return mismatch("translations and rotations are not as many");
        }
        let data = |given: Option<&[[f32; 3]]>| given.map_or(null(), |given| given.as_ptr().cast());
        let (moved, turned) = (data(translations), data(rotations));
        // SAFETY: a live handle and `count` vectors in each, or null.
        self.change(|document, error| unsafe {
            let first = index(first_joint);
            sys::mien_document_set_neutral(document, first, moved, turned, count, error)
        })
    }

    /// Sets all positions of a mesh. Normals stay as they are.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_set_positions)]
    pub fn set_positions(&mut self, mesh: usize, positions: &[[f32; 3]]) -> Result<()> {
        let (data, count) = (positions.as_ptr().cast(), positions.len());
        // SAFETY: a live handle and `count` vectors.
        self.change(|document, error| unsafe {
            sys::mien_document_set_positions(document, index(mesh), data, count, error)
        })
    }

    /// Sets the target of a channel on a mesh: deltas of the positions `vertices`, or of the first ones. Deltas
    /// of zero are left out; without any other the target is removed.
    ///
    /// # Errors
    ///
    /// [`Status::MISMATCH`] if there is another number of vertices.
    #[doc = errors!(mien_document_set_target)]
    pub fn set_target(
        &mut self,
        mesh: usize,
        channel: usize,
        deltas: &[[f32; 3]],
        vertices: Option<&[u32]>,
    ) -> Result<()> {
        if vertices.map_or(false, |vertices| vertices.len() != deltas.len()) {
            return mismatch("there is not a delta for each vertex");
        }
        let (mesh, channel) = (index(mesh), index(channel));
        let (data, count) = (deltas.as_ptr().cast(), deltas.len());
        let vertices = vertices.map_or(null(), <[u32]>::as_ptr);
        // SAFETY: a live handle, `count` vectors and vertices.
        self.change(|document, error| unsafe {
            sys::mien_document_set_target(document, mesh, channel, vertices, data, count, error)
        })
    }

    /// Removes deltas not longer than this, and targets that have none left.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_prune_targets)]
    pub fn prune_targets(&mut self, tolerance: f32) -> Result<PrunedTargets> {
        let mut out = sys::MienPrunedTargets::default();
        // SAFETY: a live handle and a sized struct.
        self.change(|document, error| unsafe {
            sys::mien_document_prune_targets(document, tolerance, &mut out, error)
        })?;
        Ok(out.into())
    }

    /// Sets entries of the joint matrix not above these to 0, and measures what that does to the positions
    /// of LOD 0.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_prune_joints)]
    pub fn prune_joints(
        &mut self,
        translation: f32,
        rotation: f32,
        scale: f32,
    ) -> Result<PrunedJoints> {
        let desc = sys::MienPruneJointsDesc { translation, rotation, scale, ..Default::default() };
        let mut out = sys::MienPrunedJoints::default();
        // SAFETY: a live handle and sized structs.
        self.change(|document, error| unsafe {
            sys::mien_document_prune_joints(document, &desc, &mut out, error)
        })?;
        Ok(out.into())
    }

    /// Sets the skin weights of a mesh: `influences` joints and weights for each position. Weights of 0 are
    /// left out.
    ///
    /// # Errors
    ///
    /// [`Status::MISMATCH`] if there are not as many joints as weights.
    #[doc = errors!(mien_document_set_weights)]
    pub fn set_weights(
        &mut self,
        mesh: usize,
        influences: usize,
        joints: &[u16],
        weights: &[f32],
    ) -> Result<()> {
        if joints.len() != weights.len() {
            return mismatch("there is not a weight for each joint");
        }
        let (mesh, influences) = (index(mesh), index(influences));
        let (joints, weights, count) = (joints.as_ptr(), weights.as_ptr(), weights.len());
        // SAFETY: a live handle, `count` joints and weights.
        self.change(|document, error| unsafe {
            sys::mien_document_set_weights(
                document, mesh, influences, joints, weights, count, error,
            )
        })
    }

    /// Scales the weights of each position of a mesh to a sum of 1.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_normalize_weights)]
    pub fn normalize_weights(&mut self, mesh: usize) -> Result<()> {
        // SAFETY: a live handle.
        self.change(|document, error| unsafe {
            sys::mien_document_normalize_weights(document, index(mesh), error)
        })
    }

    /// Keeps the largest weights of each position of a mesh.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_limit_influences)]
    pub fn limit_influences(&mut self, mesh: usize, influences: usize) -> Result<()> {
        let (mesh, influences) = (index(mesh), index(influences));
        // SAFETY: a live handle.
        self.change(|document, error| unsafe {
            sys::mien_document_limit_influences(document, mesh, influences, error)
        })
    }

    /// Mixes the weights of each position, by `strength` from 0 to 1, with the mean of its neighbors along
    /// edges.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_smooth_weights)]
    pub fn smooth_weights(
        &mut self,
        mesh: usize,
        iterations: usize,
        strength: f32,
        influences: usize,
    ) -> Result<()> {
        let (mesh, times, most) = (index(mesh), index(iterations), index(influences));
        // SAFETY: a live handle.
        self.change(|document, error| unsafe {
            sys::mien_document_smooth_weights(document, mesh, times, strength, most, error)
        })
    }

    /// Scales, rotates and moves the whole character.
    ///
    /// # Errors
    ///
    /// [`Status::INVALID_ARGUMENT`] also if the scale is 0.
    #[doc = errors!(mien_document_place)]
    pub fn place(&mut self, placement: &Placement) -> Result<()> {
        let &Placement { scale, rotation, translation } = placement;
        if scale == 0.0 {
            return Err(Error::new(Status::INVALID_ARGUMENT, "the scale is 0"));
        }
        let given = sys::MienPlacement { scale, rotation, translation, ..Default::default() };
        // SAFETY: a live handle and a sized struct.
        self.change(|document, error| unsafe { sys::mien_document_place(document, &given, error) })
    }

    /// Keeps the LODs whose bits are set, renumbered from 0.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_keep_lods)]
    pub fn keep_lods(&mut self, lods: u64) -> Result<()> {
        // SAFETY: a live handle.
        self.change(|document, error| unsafe {
            sys::mien_document_keep_lods(document, lods, error)
        })
    }

    /// Converts to the axes, units and winding of a system.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_convert)]
    pub fn convert(&mut self, system: &CoordinateSystem) -> Result<()> {
        let system = sys::MienCoordinateSystem::from(system);
        // SAFETY: a live handle and a sized struct.
        self.change(|document, error| unsafe {
            sys::mien_document_convert(document, &system, error)
        })
    }

    /// Copies layers of another document.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_copy_layers)]
    pub fn copy_layers(&mut self, from: &Document, layers: Layers) -> Result<()> {
        // SAFETY: live handles.
        self.change(|document, error| unsafe {
            sys::mien_document_copy_layers(document, from.raw(), layers.0, error)
        })
    }

    /// Copies a mesh of another document, over the one of that name or as a new one, and returns its number
    /// here.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_copy_mesh)]
    pub fn copy_mesh(&mut self, from: &Document, mesh: usize) -> Result<usize> {
        let mut copied = 0;
        // SAFETY: live handles.
        self.change(|document, error| unsafe {
            sys::mien_document_copy_mesh(document, from.raw(), index(mesh), &mut copied, error)
        })?;
        Ok(copied as usize)
    }

    /// Adds the joints of another document that this one lacks. Joints that both have must stand in the same
    /// place, within `tolerance`.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_merge_joints)]
    pub fn merge_joints(&mut self, from: &Document, tolerance: f64) -> Result<()> {
        // SAFETY: live handles.
        self.change(|document, error| unsafe {
            sys::mien_document_merge_joints(document, from.raw(), tolerance, error)
        })
    }

    /// Removes the joints that another document does not have.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_split_joints)]
    pub fn split_joints(&mut self, from: &Document) -> Result<()> {
        // SAFETY: live handles.
        self.change(|document, error| unsafe {
            sys::mien_document_split_joints(document, from.raw(), error)
        })
    }

    /// Gives a mesh the skin weights and targets of another one, and returns the largest distance to a place
    /// on it.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_project)]
    pub fn project(&mut self, mesh: usize, source: usize, how: &ProjectOptions) -> Result<f64> {
        let (desc, mut farthest) = (how.desc(), 0.0);
        // SAFETY: a live handle and a sized struct.
        self.change(|document, error| unsafe {
            let (mesh, source) = (index(mesh), index(source));
            sys::mien_document_project(document, mesh, source, &desc, &mut farthest, error)
        })?;
        Ok(farthest)
    }

    /// The same for all meshes of a LOD, from the meshes of a finer one whose names differ only in the number of
    /// the LOD.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_make_lod)]
    pub fn make_lod(&mut self, lod: usize, source: usize, how: &ProjectOptions) -> Result<f64> {
        let (desc, mut farthest) = (how.desc(), 0.0);
        // SAFETY: a live handle and a sized struct.
        self.change(|document, error| unsafe {
            let (lod, source) = (index(lod), index(source));
            sys::mien_document_make_lod(document, lod, source, &desc, &mut farthest, error)
        })?;
        Ok(farthest)
    }

    /// Gives a mesh new positions and lets joints, targets and, with `others`, the other meshes follow.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_conform)]
    pub fn conform(
        &mut self,
        mesh: usize,
        positions: &[[f32; 3]],
        others: bool,
    ) -> Result<Conformed> {
        let (data, count) = (positions.as_ptr().cast(), positions.len());
        let mut out = sys::MienConformed::default();
        // SAFETY: a live handle, `count` vectors, a sized struct.
        self.change(|document, error| unsafe {
            let mesh = index(mesh);
            sys::mien_document_conform(document, mesh, data, count, others.into(), &mut out, error)
        })?;
        Ok(out.into())
    }

    /// Gives the character the rig of a template: controls, joints, behavior and LODs. It keeps its shape.
    /// Returns what raw controls that both have do differently. `influences`: at most, per position; 0: 8.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_transplant)]
    pub fn transplant(
        &mut self,
        rig: &Document,
        matched_by: Match,
        influences: usize,
    ) -> Result<Vec<ControlError>> {
        let desc = sys::MienTransplantDesc {
            r#match: matched_by.0,
            influences: index(influences),
            ..Default::default()
        };
        let capacity = rig.field("defn.rawControlNames")?.count as usize;
        let mut errors = vec![sys::MienControlError::default(); capacity];
        let mut count = 0;
        // SAFETY: live handles, a sized struct, room for `capacity` errors.
        self.change(|document, error| unsafe {
            let out = errors.as_mut_ptr();
            sys::mien_document_transplant(
                document,
                rig.raw(),
                &desc,
                out,
                capacity,
                &mut count,
                error,
            )
        })?;
        let of_c = |error: &sys::MienControlError| ControlError {
            control: error.control as usize,
            worst: error.worst,
            rms: error.rms,
            moved: error.moved,
        };
        Ok(errors.iter().take(count).map(of_c).collect())
    }

    /// The document as an open file, checked as files are.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_to_dna)]
    pub fn to_dna(&self) -> Result<Dna<'static>> {
        Dna::created(self.allocator.as_ref(), |allocator, out, error| {
            let desc = sys::MienDocumentDesc { allocator, ..Default::default() };
            // SAFETY: a live handle and a sized struct.
            unsafe { sys::mien_document_to_dna(self.raw(), &desc, out, error) }
        })
    }

    /// Writes the document to a file of version 2.`version`, or of its own version for 0. Goes to a temporary name
    /// first, so a failure leaves `path` as it was.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_write_file)]
    pub fn write(&self, path: impl AsRef<Path>, version: u32) -> Result<()> {
        let path = path_string(path.as_ref())?;
        let desc = sys::MienWriteDesc { version, ..Default::default() };
        // SAFETY: a live handle, a terminated path, a sized struct.
        checked(|error| unsafe {
            sys::mien_document_write_file(self.raw(), path.as_ptr(), &desc, error)
        })
    }

    /// The same bytes, to memory.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_write_memory)]
    pub fn to_bytes(&self, version: u32) -> Result<Vec<u8>> {
        let desc = sys::MienWriteDesc { version, ..Default::default() };
        let write = |buffer: *mut c_void, capacity, size: &mut usize| {
            // SAFETY: a live handle, a sized struct, and room for `capacity` bytes.
            checked(|error| unsafe {
                sys::mien_document_write_memory(self.raw(), &desc, buffer, capacity, size, error)
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

    /// Every finding, as [`Report::of_bytes`] gives of a file.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_document_validate)]
    pub fn validate(&self) -> Result<Report> {
        Report::create(self.allocator.as_ref(), |desc, out, error| {
            // SAFETY: a live handle and a sized struct.
            unsafe { sys::mien_document_validate(self.raw(), desc, out, error) }
        })
    }
}

impl Drop for Document {
    fn drop(&mut self) {
        // SAFETY: destroyed once; nothing that points into it outlives `self`.
        unsafe { sys::mien_document_destroy(self.handle.as_ptr()) }
    }
}

impl std::fmt::Debug for Document {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Document").finish_non_exhaustive()
    }
}

impl ProjectOptions {
    fn desc(&self) -> sys::MienProjectDesc {
        sys::MienProjectDesc {
            r#match: self.matched_by.0,
            influences: index(self.influences),
            keep_weights: self.keep_weights.into(),
            keep_targets: self.keep_targets.into(),
            ..Default::default()
        }
    }
}

fn mismatch<T>(message: &'static str) -> Result<T> {
    Err(Error::new(Status::MISMATCH, message))
}
