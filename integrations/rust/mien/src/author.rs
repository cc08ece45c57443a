// SPDX-License-Identifier: MIT

use crate::convert::{bytes, index, utf8};
use crate::error::check;
use crate::threads::with_runner;
use crate::{
    Allocator, AuthorFlags, BoneKind, Dna, Error, MeshAxis, Result, Status, Symmetry, Work,
};
use mien_sys as sys;
use std::any::Any;
use std::ffi::CStr;
use std::ops::ControlFlow;
use std::os::raw::{c_char, c_void};
use std::panic::{catch_unwind, resume_unwind, AssertUnwindSafe};
use std::ptr::{null, null_mut};

/// The mesh of a head, in the unit and axes of [`AuthorOptions`].
///
/// ```
/// use mien::AuthorMesh;
///
/// let mesh = AuthorMesh { positions: &[[0.0; 3]; 3], corners: &[0, 1, 2], ..Default::default() };
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct AuthorMesh<'a> {
    /// Places.
    pub positions: &'a [[f64; 3]],
    /// Indices of positions, face after face, counterclockwise from outside.
    pub corners: &'a [u32],
    /// Corners of each face, 3 or more; none: all are triangles.
    pub face_sizes: Option<&'a [u32]>,
    /// Texture coordinates; may be empty.
    pub uvs: &'a [[f64; 2]],
    /// An index of `uvs` for each corner; empty without these.
    pub corner_uvs: &'a [u32],
    /// Names and numbers of faces, in their order; empty: all is one object.
    pub objects: &'a [(&'a str, usize)],
    /// Expressions; may be empty.
    pub shapes: &'a [AuthorShape<'a>],
}

/// An expression: becomes a raw control of its name, 0 to 1.
#[derive(Clone, Copy, Debug, Default)]
pub struct AuthorShape<'a> {
    /// All different.
    pub name: &'a str,
    /// Indices of the positions that move; none: all do, in their order.
    pub positions: Option<&'a [u32]>,
    /// How far these move at full value.
    pub displacements: &'a [[f64; 3]],
}

/// A bone of the caller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AuthorBone<'a> {
    /// All different.
    pub name: &'a str,
    /// In the mesh, not relative to the parent.
    pub position: [f64; 3],
    /// A bone before this one; the first one is its own parent.
    pub parent: usize,
    /// The first one is the root, and facial ones stand in one run.
    pub kind: BoneKind,
}

/// Triangles of yours: a LOD of the mesh.
#[derive(Clone, Copy, Debug, Default)]
pub struct AuthorLod<'a> {
    /// Indices of positions, all of one object. Objects without triangles are not in the LOD.
    pub triangles: &'a [[u32; 3]],
    /// An index of `uvs` for each corner; none: of the UVs that a position has in the mesh, those
    /// nearest to each other.
    pub uvs: Option<&'a [[u32; 3]]>,
}

/// A point of the face that joints are placed by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AuthorLandmark<'a> {
    /// `nose`, `throat`, `lip_upper`, `lip_lower`, `mouth_l`, `mouth_r`, `chin`, `jaw`, `eye_l`, `eye_r`,
    /// `head` or `neck`; each once.
    pub name: &'a str,
    /// In the mesh.
    pub position: [f64; 3],
}

/// A rig that was made.
#[derive(Debug)]
#[non_exhaustive]
pub struct AuthoredRig {
    /// The file.
    pub dna: Dna<'static>,
    /// What was found and measured, as JSON; `docs/authoring.md` lists it.
    pub report: String,
}

/// How a mesh is rigged. Everything has a default.
///
/// ```
/// # use mien::*;
/// # fn main() -> Result<()> {
/// # let head = Dna::generate(Preset::HEAD)?;
/// # let rig = Rig::new(&head)?;
/// # let deformer = Deformer::new(&head, &rig)?;
/// # let lod = deformer.mesh(rig.find(Kind::MESH, "head_lod5_mesh")?)?;
/// # let positions: Vec<_> = lod.positions.iter().map(|p| p.map(f64::from)).collect();
/// # let of_vertex = lod.vertex_position_indices;
/// # let triangles = lod.triangles.iter().flatten();
/// # let corners: Vec<u32> = triangles.map(|vertex| of_vertex[*vertex as usize]).collect();
/// let mesh = AuthorMesh { positions: &positions, corners: &corners, ..Default::default() };
/// let made = AuthorOptions::new().facial_joints(40).lods(1).make(&mesh)?;
/// let rig = Rig::new(&made.dna)?;
/// # assert!(rig.count(Kind::JOINT) > 40);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
#[must_use = "options do nothing until they are used"]
pub struct AuthorOptions<'a> {
    facial_joints: usize,
    influences: usize,
    lods: usize,
    groups: usize,
    seed: u64,
    unit: f64,
    up: MeshAxis,
    front: MeshAxis,
    symmetry: Symmetry,
    flags: AuthorFlags,
    name: &'a str,
    face_object: &'a str,
    bones: &'a [AuthorBone<'a>],
    weights: Option<(&'a [u16], &'a [f32])>,
    depth_groups: Option<&'a [u8]>,
    mask: Option<&'a [u8]>,
    lod_joints: Option<&'a [u32]>,
    bone_groups: Option<&'a [u32]>,
    bone_motions: Option<&'a [[f64; 6]]>,
    joint_groups: usize,
    overlap_correctives: usize,
    lod_triangles: f64,
    lod_meshes: &'a [AuthorLod<'a>],
    landmarks: &'a [AuthorLandmark<'a>],
    allocator: Option<Allocator>,
}

impl Default for AuthorOptions<'_> {
    fn default() -> Self {
        Self {
            facial_joints: 0,
            influences: 0,
            lods: 0,
            groups: 0,
            seed: 1,
            unit: 0.0,
            up: MeshAxis::DEFAULT,
            front: MeshAxis::DEFAULT,
            symmetry: Symmetry::AUTO,
            flags: AuthorFlags(0),
            name: "",
            face_object: "",
            bones: &[],
            weights: None,
            depth_groups: None,
            mask: None,
            lod_joints: None,
            bone_groups: None,
            bone_motions: None,
            joint_groups: 0,
            overlap_correctives: 0,
            lod_triangles: 0.0,
            lod_meshes: &[],
            landmarks: &[],
            allocator: None,
        }
    }
}

fn wrong<T>(what: &'static str) -> Result<T> {
    Err(Error::new(Status::INVALID_ARGUMENT, what))
}

fn view(text: &str) -> sys::MienStringView {
    sys::MienStringView { data: text.as_ptr().cast(), count: text.len() }
}

/// Null for nothing: then the library looks at no length.
fn data<T, U>(values: &[T]) -> *const U {
    if values.is_empty() {
        null()
    } else {
        values.as_ptr().cast()
    }
}

/// Calls `call` with the mesh as C takes it.
fn with_mesh<T>(
    mesh: &AuthorMesh<'_>,
    call: impl FnOnce(&sys::MienAuthorMesh) -> Result<T>,
) -> Result<T> {
    if mesh.face_sizes.is_none() && mesh.corners.len() % 3 != 0 {
        return wrong("corners: not three for each triangle");
    }
    if mesh.corner_uvs.len() != if mesh.uvs.is_empty() { 0 } else { mesh.corners.len() } {
        return wrong("corner_uvs: not one for each corner");
    }
    let mut first_face = 0;
    let mut objects = Vec::with_capacity(mesh.objects.len());
    for (name, faces) in mesh.objects {
        let (first, count) = (index(first_face), index(*faces));
        objects.push(sys::MienAuthorObject {
            name: view(name),
            first_face: first,
            face_count: count,
        });
        first_face = first_face.saturating_add(*faces);
    }
    let mut shapes = Vec::with_capacity(mesh.shapes.len());
    for shape in mesh.shapes {
        let count = shape.positions.map_or(mesh.positions.len(), <[u32]>::len);
        if shape.displacements.len() != count {
            return wrong("shapes: not one displacement for each position");
        }
        shapes.push(sys::MienAuthorShape {
            name: view(shape.name),
            // No position is not all of them, which null would be.
            positions: shape.positions.map_or(null(), <[u32]>::as_ptr),
            position_count: count,
            displacements: shape.displacements.as_ptr().cast(),
        });
    }
    call(&sys::MienAuthorMesh {
        positions: data(mesh.positions),
        position_count: mesh.positions.len(),
        face_sizes: mesh.face_sizes.map_or(null(), <[u32]>::as_ptr),
        face_count: mesh.face_sizes.map_or(mesh.corners.len() / 3, <[u32]>::len),
        corners: data(mesh.corners),
        corner_count: mesh.corners.len(),
        uvs: data(mesh.uvs),
        uv_count: mesh.uvs.len(),
        corner_uvs: data(mesh.corner_uvs),
        objects: data(&objects),
        object_count: objects.len(),
        shapes: data(&shapes),
        shape_count: shapes.len(),
        ..Default::default()
    })
}

struct Progress<P> {
    report: P,
    panic: Option<Box<dyn Any + Send>>,
}

/// # Safety
///
/// `user` is a `Progress<P>` that nothing else uses, `step` a terminated string.
unsafe extern "C" fn progress<P: FnMut(&str, f64) -> ControlFlow<()>>(
    user: *mut c_void,
    step: *const c_char,
    share: f64,
) -> i32 {
    // SAFETY: as above; the library hands back what run() gave it.
    let (progress, step) = unsafe { (&mut *user.cast::<Progress<P>>(), CStr::from_ptr(step)) };
    let report = AssertUnwindSafe(|| (progress.report)(&step.to_string_lossy(), share));
    match catch_unwind(report) {
        Ok(flow) => flow.is_break().into(),
        Err(panic) => {
            progress.panic = Some(panic);
            1
        }
    }
}

impl<'a> AuthorOptions<'a> {
    /// Everything as it is by default.
    pub fn new() -> Self {
        Self::default()
    }

    /// 1 to 7000; 0 means 240.
    pub fn facial_joints(mut self, count: usize) -> Self {
        self.facial_joints = count;
        self
    }

    /// Joints that move a position: 1 to 12; 0 means 8.
    pub fn influences(mut self, count: usize) -> Self {
        self.influences = count;
        self
    }

    /// Levels of detail, 1 to 8; 0 means 8.
    pub fn lods(mut self, count: usize) -> Self {
        self.lods = count;
        self
    }

    /// Groups in depth, of which the front one is the face: 2 to 16; 0 means 3.
    pub fn groups(mut self, count: usize) -> Self {
        self.groups = count;
        self
    }

    /// Of the starts of the search for bones; 1 by default.
    pub fn seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }

    /// Centimeters of one unit of the mesh; 0 means 1.
    pub fn unit(mut self, centimeters: f64) -> Self {
        self.unit = centimeters;
        self
    }

    /// Which axes of the mesh point to the top of the head and out of the face.
    pub fn axes(mut self, up: MeshAxis, front: MeshAxis) -> Self {
        self.up = up;
        self.front = front;
        self
    }

    /// Whether the halves of the face are mirror images.
    pub fn symmetry(mut self, symmetry: Symmetry) -> Self {
        self.symmetry = symmetry;
        self
    }

    /// How bones and weights are made: one more of these.
    pub fn with(mut self, flags: AuthorFlags) -> Self {
        self.flags |= flags;
        self
    }

    /// Of the character; empty means "head".
    pub fn name(mut self, name: &'a str) -> Self {
        self.name = name;
        self
    }

    /// The object with the face; empty: it is found.
    pub fn face_object(mut self, name: &'a str) -> Self {
        self.face_object = name;
        self
    }

    /// Bones of yours, instead of those that would be placed.
    pub fn bones(mut self, bones: &'a [AuthorBone<'a>]) -> Self {
        self.bones = bones;
        self
    }

    /// Skin weights of yours, with [`bones`](Self::bones): for each position as many numbers of bones
    /// and weights.
    pub fn weights(mut self, joints: &'a [u16], weights: &'a [f32]) -> Self {
        self.weights = Some((joints, weights));
        self
    }

    /// Groups in depth of yours, one for each position: 0 in front.
    pub fn depth_groups(mut self, groups: &'a [u8]) -> Self {
        self.depth_groups = Some(groups);
        self
    }

    /// A mask of yours, one for each position: not 0 where facial bones are placed.
    pub fn mask(mut self, mask: &'a [u8]) -> Self {
        self.mask = Some(mask);
        self
    }

    /// Facial joints of each LOD at most, as mirrored pairs stay together. The first one has all.
    pub fn lod_joints(mut self, counts: &'a [u32]) -> Self {
        self.lod_joints = Some(counts);
        self
    }

    /// Joint groups of yours, with [`bones`](Self::bones): one for each, 0 to 255.
    pub fn bone_groups(mut self, groups: &'a [u32]) -> Self {
        self.bone_groups = Some(groups);
        self
    }

    /// Motions of yours, with [`bones`](Self::bones): for each shape, for each bone its translation at
    /// full value, then degrees about X, Y and Z.
    pub fn bone_motions(mut self, motions: &'a [[f64; 6]]) -> Self {
        self.bone_motions = Some(motions);
        self
    }

    /// Joint groups to find: 1 to 24; 0 means as many as have 75 rows each.
    pub fn joint_groups(mut self, count: usize) -> Self {
        self.joint_groups = count;
        self
    }

    /// Correctives for pairs of shapes that double their motion, at most as many; none by default.
    pub fn overlap_correctives(mut self, count: usize) -> Self {
        self.overlap_correctives = count;
        self
    }

    /// Share of its triangles that each further LOD keeps of the LOD before, at most 1, which keeps all;
    /// 0 means 0.5.
    pub fn lod_triangles(mut self, share: f64) -> Self {
        self.lod_triangles = share;
        self
    }

    /// Meshes of yours of LOD 1, LOD 2 and so on, instead of those that would be made.
    pub fn lod_meshes(mut self, lods: &'a [AuthorLod<'a>]) -> Self {
        self.lod_meshes = lods;
        self
    }

    /// Landmarks of yours, used instead of those that are found.
    pub fn landmarks(mut self, landmarks: &'a [AuthorLandmark<'a>]) -> Self {
        self.landmarks = landmarks;
        self
    }

    /// Where memory comes from.
    pub fn allocator(mut self, allocator: &Allocator) -> Self {
        self.allocator = Some(allocator.clone());
        self
    }

    /// Makes a rig: joints, skin weights of every LOD, and for each shape a raw control that moves
    /// them. The same mesh and options give the same bytes on every machine.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_author_rig)]
    #[doc = errors!(mien_author_report_json)]
    pub fn make(&self, mesh: &AuthorMesh<'_>) -> Result<AuthoredRig> {
        self.make_on(mesh, |_, _| ControlFlow::Continue(()), |_, work| work())
    }

    /// The same on threads of yours, with the same bytes: `run` as in
    /// [`Batch::evaluate_each_on`](crate::Batch::evaluate_each_on). `progress` is told on this thread which step begins, and a
    /// share from 0 to 1 that never falls; it may cancel. A panic of either goes on when the library has
    /// returned.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_author_rig)]
    #[doc = errors!(mien_author_report_json)]
    pub fn make_on(
        &self,
        mesh: &AuthorMesh<'_>,
        progress: impl FnMut(&str, f64) -> ControlFlow<()>,
        run: impl FnMut(usize, Work<'_>),
    ) -> Result<AuthoredRig> {
        with_mesh(mesh, |given| self.run(given, progress, run))
    }

    fn bones_of_c(&self) -> Vec<sys::MienAuthorBone> {
        let bone = |bone: &AuthorBone<'_>| sys::MienAuthorBone {
            name: view(bone.name),
            position: bone.position,
            parent: index(bone.parent),
            kind: bone.kind.0,
        };
        self.bones.iter().map(bone).collect()
    }

    /// Influences per position of the caller's weights, and where these are.
    fn weights_of_c(&self, positions: usize) -> Result<(usize, *const u16, *const f32)> {
        let (joints, weights) = match self.weights {
            Some(given) => given,
            None => return Ok((self.influences, null(), null())),
        };
        let influences = joints.len() / positions.max(1);
        if influences * positions != joints.len() || weights.len() != joints.len() {
            return wrong("weights: not as many joints and weights for each position");
        }
        if self.influences != 0 && self.influences != influences {
            return wrong("weights: not as many as the influences");
        }
        Ok((influences, joints.as_ptr(), weights.as_ptr()))
    }

    fn landmarks_of_c(&self) -> Vec<sys::MienAuthorLandmark> {
        let landmark = |given: &AuthorLandmark<'_>| sys::MienAuthorLandmark {
            name: view(given.name),
            position: given.position,
        };
        self.landmarks.iter().map(landmark).collect()
    }

    fn lod_meshes_of_c(&self) -> Result<Vec<sys::MienAuthorLod>> {
        let lod = |lod: &AuthorLod<'_>| {
            if lod.uvs.map_or(false, |uvs| uvs.len() != lod.triangles.len()) {
                return wrong("lod_meshes: not UVs for each triangle");
            }
            Ok(sys::MienAuthorLod {
                corners: data(lod.triangles),
                corner_count: lod.triangles.len().saturating_mul(3),
                corner_uvs: lod.uvs.map_or(null(), |uvs| uvs.as_ptr().cast()),
            })
        };
        self.lod_meshes.iter().map(lod).collect()
    }

    /// How many LODs there are, if each result of the caller is as long as it has to be.
    fn check_results(&self, mesh: &sys::MienAuthorMesh) -> Result<usize> {
        let of =
            |length: Option<usize>, wanted: usize| length.map_or(true, |count| count == wanted);
        let bones = self.bones.len();
        if !of(self.depth_groups.map(<[u8]>::len), mesh.position_count)
            || !of(self.mask.map(<[u8]>::len), mesh.position_count)
        {
            return wrong("depth_groups, mask: not one for each position");
        }
        if !of(self.bone_groups.map(<[u32]>::len), bones)
            || !of(self.bone_motions.map(<[[f64; 6]]>::len), bones.saturating_mul(mesh.shape_count))
        {
            return wrong("bone_groups, bone_motions: not one for each bone");
        }
        let lods = self.lod_joints.map_or(self.lods, <[u32]>::len);
        if self.lod_joints.is_some() && (lods == 0 || self.lods != 0 && self.lods != lods) {
            return wrong("lod_joints: not one for each LOD");
        }
        if self.lod_meshes.is_empty() {
            return Ok(lods);
        }
        let meshes = self.lod_meshes.len() + 1;
        if lods != 0 && lods != meshes {
            return wrong("lod_meshes: not one for each LOD but the first");
        }
        Ok(meshes)
    }

    fn run<P: FnMut(&str, f64) -> ControlFlow<()>>(
        &self,
        mesh: &sys::MienAuthorMesh,
        report: P,
        run: impl FnMut(usize, Work<'_>),
    ) -> Result<AuthoredRig> {
        let bones = self.bones_of_c();
        let lods = self.check_results(mesh)?;
        let lod_meshes = self.lod_meshes_of_c()?;
        let landmarks = self.landmarks_of_c();
        let (influences, weight_joints, weights) = self.weights_of_c(mesh.position_count)?;
        let mut report = Progress { report, panic: None };
        let user = (&mut report as *mut Progress<P>).cast();
        let mut found = Report(null_mut()); // closed even if `run` panics
        let made = Dna::created(self.allocator.as_ref(), |allocator, out, error| {
            let mut status = sys::MIEN_OK;
            let call = |parallel| {
                let desc = sys::MienAuthorDesc {
                    facial_joints: index(self.facial_joints),
                    influences: index(influences),
                    lods: index(lods),
                    groups: index(self.groups),
                    seed: self.seed,
                    unit: self.unit,
                    up: self.up.0,
                    front: self.front.0,
                    symmetry: self.symmetry.0,
                    flags: self.flags.0,
                    name: view(self.name),
                    face_object: view(self.face_object),
                    bones: data(&bones),
                    bone_count: bones.len(),
                    weight_joints,
                    weights,
                    parallel,
                    progress_user: user,
                    progress: Some(progress::<P>),
                    allocator,
                    depth_groups: self.depth_groups.map_or(null(), <[u8]>::as_ptr),
                    mask: self.mask.map_or(null(), <[u8]>::as_ptr),
                    lod_joints: self.lod_joints.map_or(null(), <[u32]>::as_ptr),
                    bone_groups: self.bone_groups.map_or(null(), <[u32]>::as_ptr),
                    bone_motions: self.bone_motions.map_or(null(), |m| m.as_ptr().cast()),
                    joint_groups: index(self.joint_groups),
                    overlap_correctives: index(self.overlap_correctives),
                    lod_triangles: self.lod_triangles,
                    lod_meshes: data(&lod_meshes),
                    lod_mesh_count: lod_meshes.len(),
                    landmarks: data(&landmarks),
                    landmark_count: landmarks.len(),
                    ..Default::default()
                };
                // SAFETY: sized structs; what they point to lives until this function returns, and is
                // as long as they say.
                status = unsafe { sys::mien_author_rig(mesh, &desc, out, &mut found.0, error) };
                sys::MIEN_OK // the status goes out with its detail
            };
            match with_runner(run, call) {
                Ok(()) => status,
                Err(error) => error.status().0,
            }
        });
        if let Some(panic) = report.panic {
            resume_unwind(panic);
        }
        Ok(AuthoredRig { dna: made?, report: found.json()? })
    }
}

/// Closed when it is dropped.
struct Report(*mut sys::MienAuthorReport);

impl Report {
    fn json(&self) -> Result<String> {
        let mut text = sys::MienStringView::default();
        // SAFETY: a live handle.
        check(unsafe { sys::mien_author_report_json(self.0, &mut text) })?;
        // SAFETY: the text lives as long as the report.
        Ok(utf8(unsafe { bytes(text) }).into_owned())
    }
}

impl Drop for Report {
    fn drop(&mut self) {
        // SAFETY: closed once; null is allowed.
        unsafe { sys::mien_author_report_close(self.0) }
    }
}
