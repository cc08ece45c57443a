// SPDX-License-Identifier: MIT
//! Controls for captured motion: libmien-solve.

use crate::convert::index;
use crate::error::{check, checked};
use crate::{Allocator, Deformer, Error, FitConstraintKind, FitStatus, Kind, Result, Rig, Status};
use mien_sys as sys;
use std::any::Any;
use std::os::raw::c_void;
use std::panic::{catch_unwind, resume_unwind, AssertUnwindSafe};
use std::ptr::{null, null_mut, NonNull};

/// A point of a surface: the weighted sum of three positions of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitPoint {
    /// Its mesh; that of [`FitOptions::mesh`] if `None`.
    pub mesh: Option<usize>,
    /// Positions, in the order of the file.
    pub positions: [usize; 3],
    /// Weights of these positions.
    pub weights: [f32; 3],
}

impl From<usize> for FitPoint {
    /// One position of the mesh.
    fn from(position: usize) -> Self {
        Self { mesh: None, positions: [position; 3], weights: [1.0, 0.0, 0.0] }
    }
}

/// How to create a [`Fit`]. By default all raw controls move, from 0 to 1, and joint values are matched.
#[derive(Clone, Copy, Debug, Default)]
#[must_use = "options do nothing until they are used"]
pub struct FitOptions<'a> {
    /// Of the rig; needed for points.
    pub deformer: Option<&'a Deformer>,
    /// Raw controls that may move, ascending; all if `None`.
    pub controls: Option<&'a [u32]>,
    /// Lower bound of each of these controls; 0 if `None`.
    pub lower: Option<&'a [f32]>,
    /// Upper bound of each of these controls; 1 if `None`.
    pub upper: Option<&'a [f32]>,
    /// Pairs of raw controls that are kept similar: left and right.
    pub symmetric: &'a [[u32; 2]],
    /// The mesh of points that do not name another.
    pub mesh: usize,
    /// Points to match, such as landmarks.
    pub points: &'a [FitPoint],
    /// Weight per joint value, 0 or more. `None`: 1 each, or 0 if there are points.
    pub joint_weights: Option<&'a [f32]>,
    /// LOD of the rig that is solved.
    pub lod: u32,
    /// Where memory comes from; the heap if `None`.
    pub allocator: Option<&'a Allocator>,
}

/// A pinhole camera: image x = `focal[0]` * x / z + `center[0]`, and y likewise, for the point x y z in
/// camera space. z grows away from the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitCamera {
    /// Focal lengths in pixels, for x and y.
    pub focal: [f32; 2],
    /// The pixel on the optical axis.
    pub center: [f32; 2],
    /// Rows, from model space to camera space. With [`FitFrame::rigid`], all 0 if unknown.
    pub rotation: [f32; 9],
    /// Added after the rotation.
    pub translation: [f32; 3],
}

impl FitCamera {
    fn raw(&self) -> sys::MienFitCamera {
        sys::MienFitCamera {
            focal: self.focal,
            center: self.center,
            rotation: self.rotation,
            translation: self.translation,
        }
    }
}

/// What a joint or a point of a frame is drawn to besides the other targets. Places and directions are in model
/// space, before the motion of [`FitFrame::rigid`]; one of NaN is missing.
///
/// The functions below make one of each kind, of weight 1. Kinds with joints need [`FitOptions::deformer`].
///
/// ```
/// use mien::FitConstraint;
/// let gaze = FitConstraint::joint_aim(3, [0.0, 0.0, 1.0], [10.0, 160.0, 100.0]);
/// let closed_lips = FitConstraint { weight: 50.0, ..FitConstraint::point_distance([0, 1], [0.0, 0.0]) };
/// # let _ = (gaze, closed_lips);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitConstraint {
    /// What the other fields mean.
    pub kind: FitConstraintKind,
    /// Of the rig.
    pub joint: usize,
    /// Places in [`FitOptions::points`].
    pub points: [usize; 2],
    /// In the axes of the joint, of any length but 0.
    pub axis: [f32; 3],
    /// A place, or a direction of any length but 0.
    pub target: [f32; 3],
    /// The smallest and the largest distance that cost nothing.
    pub distances: [f32; 2],
    /// Times the squared residual: of a length in the unit of the rig, or of the difference of directions of
    /// length 1. 0 or more.
    pub weight: f32,
}

impl FitConstraint {
    /// A frame has at most so many.
    pub const MOST: usize = 64;

    const fn of(kind: FitConstraintKind) -> Self {
        Self {
            kind,
            joint: 0,
            points: [0; 2],
            axis: [0.0; 3],
            target: [0.0; 3],
            distances: [0.0; 2],
            weight: 1.0,
        }
    }

    /// A joint is at a place: where the jaw is.
    #[must_use]
    pub const fn joint_position(joint: usize, place: [f32; 3]) -> Self {
        Self { joint, target: place, ..Self::of(FitConstraintKind::JOINT_POSITION) }
    }

    /// An axis of a joint has a direction: an eye's gaze.
    #[must_use]
    pub const fn joint_direction(joint: usize, axis: [f32; 3], direction: [f32; 3]) -> Self {
        Self { joint, axis, target: direction, ..Self::of(FitConstraintKind::JOINT_DIRECTION) }
    }

    /// An axis of a joint points at a place.
    #[must_use]
    pub const fn joint_aim(joint: usize, axis: [f32; 3], place: [f32; 3]) -> Self {
        Self { joint, axis, target: place, ..Self::of(FitConstraintKind::JOINT_AIM) }
    }

    /// A point is at a place.
    #[must_use]
    pub const fn point_position(point: usize, place: [f32; 3]) -> Self {
        Self { points: [point, 0], target: place, ..Self::of(FitConstraintKind::POINT_POSITION) }
    }

    /// Two points are from `distances[0]` to `distances[1]` apart: 0 and 0 where lips touch.
    #[must_use]
    pub const fn point_distance(points: [usize; 2], distances: [f32; 2]) -> Self {
        Self { points, distances, ..Self::of(FitConstraintKind::POINT_DISTANCE) }
    }

    fn raw(&self) -> sys::MienFitConstraint {
        sys::MienFitConstraint {
            kind: self.kind.0,
            joint: index(self.joint),
            points: self.points.map(index),
            axis: self.axis,
            target: self.target,
            distances: self.distances,
            weight: self.weight,
        }
    }
}

/// The targets of a frame, and the weights of the terms; terms of weight 0 are left out. A target of NaN is
/// missing.
///
/// Targets of several kinds may be given together: a point may have one of each.
#[derive(Clone, Copy, Debug, Default)]
pub struct FitFrame<'a> {
    /// Joint values, as in [`Instance::joints`](crate::Instance::joints).
    pub joints: Option<&'a [f32]>,
    /// Position of each point.
    pub points: Option<&'a [[f32; 3]]>,
    /// Each point as `camera` sees it.
    pub images: Option<&'a [[f32; 2]]>,
    /// Needed for `images`.
    pub camera: Option<&'a FitCamera>,
    /// Weight per point, 0 or more, of points and images; 1 if `None`.
    pub point_weights: Option<&'a [f32]>,
    /// All raw controls, to start from; the initial ones if `None`.
    pub start: Option<&'a [f32]>,
    /// All raw controls, that the result is drawn to; the initial ones if `None`.
    pub prior: Option<&'a [f32]>,
    /// Times the squared distance to `prior`.
    pub prior_weight: f32,
    /// Times the squared distance to `start`, the previous frame.
    pub smooth_weight: f32,
    /// Times the sum of magnitudes: few controls explain the frame.
    pub sparse_weight: f32,
    /// Times the squared differences of symmetric pairs.
    pub symmetric_weight: f32,
    /// Points farther off than this, or from the surface, count less; 0: all count fully.
    pub robust_scale: f32,
    /// Weight of the joints relative to the points; 0: 1.
    pub joint_weight: f32,
    /// Points and surface may be rotated and translated as a whole. With `images`, these stay where they are in model
    /// space, and the camera is found, from that of `camera`, or, if its rotation is unknown, from one that sees the
    /// face from the front.
    pub rigid: bool,
    /// With `images` and `rigid`, the focal length is found too.
    pub focal: bool,
    /// 0: 50.
    pub max_iterations: u32,
    /// 0: no limit. A limit makes results depend on the machine.
    pub max_seconds: f64,
    /// Each point is drawn to the nearest place of the surface.
    pub surface: Option<&'a FitSurface>,
    /// Points farther from the surface have no target; 0: no limit.
    pub surface_reach: f32,
    /// Up to [`FitConstraint::MOST`], added to all other targets.
    pub constraints: &'a [FitConstraint],
    /// For each raw control 0 to 15: the solve begins with the controls of stage 0 alone, then those of stage 1 move
    /// too, and so on, as jaw and eyes before the rest. Each stage may take `max_iterations`. `None`: all move from
    /// the start.
    pub stages: Option<&'a [u32]>,
    /// For each point, in model space: how far the points of the face in the targets are from those of the rig at rest,
    /// where it is another person's. `None`: 0.
    pub point_offsets: Option<&'a [[f32; 3]]>,
    /// Per point, 0 or more: how much it is drawn to `surface`; `point_weights` if `None`.
    pub surface_weights: Option<&'a [f32]>,
    /// Weight of the images relative to the points: of a squared length in the image, against one in space; 0: 1.
    pub image_weight: f32,
    /// `robust_scale` of images, in their unit; 0: `robust_scale`, or, if there are points or a surface too, all count
    /// fully.
    pub image_robust_scale: f32,
}

/// The result of a solve.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct FitResult {
    /// Why it ended.
    pub status: FitStatus,
    /// How many steps it took.
    pub iterations: u32,
    /// The minimized sum, with all terms.
    pub cost: f64,
    /// Weighted root mean square of the differences of joint values.
    pub joint_residual: f64,
    /// The same for points; without these, for images in their unit; without both, for the surface.
    pub point_residual: f64,
    /// Largest difference of a joint value that counts.
    pub joint_worst: f64,
    /// Largest distance of a point that counts.
    pub point_worst: f64,
    /// Points without a target.
    pub missing_points: usize,
    /// Rows: points of the target = rotation * model + translation, if rigid; the camera's with images.
    pub rotation: [f32; 9],
    /// See `rotation`.
    pub translation: [f32; 3],
    /// Of the camera, with images; else 0.
    pub focal: [f32; 2],
    /// Weighted root mean square of the residuals of constraints.
    pub constraint_residual: f64,
    /// Largest residual of a constraint that counts.
    pub constraint_worst: f64,
    /// Joint values or points moved farther from where they are at `start` than their targets ask for.
    pub jumped: bool,
    /// Weighted root mean square of the distances in the image.
    pub image_residual: f64,
    /// The largest one that counts.
    pub image_worst: f64,
    /// Weighted root mean square of the distances from the surface.
    pub surface_residual: f64,
    /// The largest one that counts.
    pub surface_worst: f64,
}

impl From<sys::MienFitResult> for FitResult {
    fn from(result: sys::MienFitResult) -> Self {
        Self {
            status: FitStatus(result.status),
            iterations: result.iterations,
            cost: result.cost,
            joint_residual: result.joint_residual,
            point_residual: result.point_residual,
            joint_worst: result.joint_worst,
            point_worst: result.point_worst,
            missing_points: result.missing_points as usize,
            rotation: result.rotation,
            translation: result.translation,
            focal: result.focal,
            constraint_residual: result.constraint_residual,
            constraint_worst: result.constraint_worst,
            jumped: result.jumped != 0,
            image_residual: result.image_residual,
            image_worst: result.image_worst,
            surface_residual: result.surface_residual,
            surface_worst: result.surface_worst,
        }
    }
}

/// A surface without correspondences: a scan, or a mesh of another topology. Immutable.
pub struct FitSurface {
    handle: NonNull<sys::MienFitSurface>,
    // Dropped after the handle is destroyed.
    _allocator: Option<Allocator>,
}

// SAFETY: the handle is const for every call but destroying, which any thread may do.
unsafe impl Send for FitSurface {}
unsafe impl Sync for FitSurface {}

impl FitSurface {
    /// Copies a surface in the unit and axes of the rig. Positions in the same place are one, as along
    /// texture seams; all triangles are wound the same way.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_fit_surface_create)]
    pub fn new(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Result<Self> {
        Self::create(positions, triangles, None)
    }

    /// The same in memory of your own.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_fit_surface_create)]
    pub fn new_in(
        positions: &[[f32; 3]],
        triangles: &[[u32; 3]],
        allocator: &Allocator,
    ) -> Result<Self> {
        Self::create(positions, triangles, Some(allocator))
    }

    fn create(
        positions: &[[f32; 3]],
        triangles: &[[u32; 3]],
        allocator: Option<&Allocator>,
    ) -> Result<Self> {
        let mut handle = null_mut();
        Allocator::with(allocator, |allocator| {
            let desc = sys::MienFitSurfaceDesc {
                positions: positions.as_ptr().cast(),
                triangles: triangles.as_ptr().cast(),
                position_count: positions.len(),
                triangle_count: triangles.len(),
                allocator,
                ..Default::default()
            };
            // SAFETY: a sized struct, and arrays of the lengths that it says.
            checked(|error| unsafe { sys::mien_fit_surface_create(&desc, &mut handle, error) })
        })?;
        let handle = NonNull::new(handle).expect("a handle after success");
        Ok(Self { handle, _allocator: allocator.cloned() })
    }
}

impl Drop for FitSurface {
    fn drop(&mut self) {
        // SAFETY: destroyed once.
        unsafe { sys::mien_fit_surface_destroy(self.handle.as_ptr()) }
    }
}

impl std::fmt::Debug for FitSurface {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("FitSurface").finish_non_exhaustive()
    }
}

/// Finds the raw controls of a rig that give captured joints, vertices, surfaces or landmarks.
///
/// It holds its [`Rig`], and the memory to solve, so one thread uses it at a time. `docs/solving.md` has the
/// formulas.
///
/// ```
/// use mien::{Dna, Fit, FitFrame, Preset, Rig};
/// let rig = Rig::new(&Dna::generate(Preset::SMALL)?)?;
/// let mut face = rig.instance()?;
/// face.raw_controls_mut()[3] = 0.5;
/// face.evaluate(0)?;
///
/// let mut fit = Fit::new(&rig)?;
/// let frame = FitFrame { joints: Some(face.joints()), ..Default::default() };
/// let mut raw = vec![0.0; face.raw_controls().len()];
/// let result = fit.solve(&frame, &mut raw)?;
/// assert!(result.joint_residual < 1e-3 && (raw[3] - 0.5).abs() < 0.01);
/// # Ok::<(), mien::Error>(())
/// ```
pub struct Fit {
    handle: NonNull<sys::MienFit>,
    raw_count: usize,
    point_count: usize,
    // Dropped after the handle is destroyed.
    rig: Rig,
    _allocator: Option<Allocator>,
}

// SAFETY: any thread may use and destroy it, one at a time: what changes it takes `&mut self`.
unsafe impl Send for Fit {}
unsafe impl Sync for Fit {}

struct Canceled<C> {
    ask: C,
    panic: Option<Box<dyn Any + Send>>,
}

/// # Safety
///
/// `user` is a `Canceled<C>` that nothing else uses.
unsafe extern "C" fn canceled<C: FnMut() -> bool>(user: *mut c_void) -> u32 {
    // SAFETY: as above; the library hands back what until() gave it.
    let canceled = unsafe { &mut *user.cast::<Canceled<C>>() };
    if canceled.panic.is_some() {
        return 1; // of a frame before
    }
    match catch_unwind(AssertUnwindSafe(|| (canceled.ask)())) {
        Ok(stop) => stop.into(),
        Err(panic) => {
            canceled.panic = Some(panic);
            1
        }
    }
}

/// A function that asks whether to stop, with what it is given.
type Stop = (*mut c_void, Option<unsafe extern "C" fn(*mut c_void) -> u32>);

/// Calls `run` with a function that asks `stop`, whose panic comes out afterwards.
fn until<C: FnMut() -> bool, T>(stop: C, run: impl FnOnce(Stop) -> Result<T>) -> Result<T> {
    let mut asked = Canceled { ask: stop, panic: None };
    let user = (&mut asked as *mut Canceled<C>).cast();
    let result = run((user, Some(canceled::<C>)));
    match asked.panic {
        Some(panic) => resume_unwind(panic),
        None => result,
    }
}

fn pointer<T, U>(values: Option<&[T]>) -> *const U {
    values.map_or(null(), |values| values.as_ptr().cast())
}

fn check_length<T>(values: Option<&[T]>, wanted: usize, what: &'static str) -> Result<()> {
    match values {
        Some(values) if values.len() != wanted => Err(Error::new(Status::INVALID_ARGUMENT, what)),
        _ => Ok(()),
    }
}

impl Fit {
    /// Matches joint values with all raw controls. [`FitOptions`] has other wishes.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_fit_create)]
    pub fn new(rig: &Rig) -> Result<Self> {
        FitOptions::default().create(rig)
    }

    /// The rig whose controls are found.
    #[must_use]
    pub fn rig(&self) -> &Rig {
        &self.rig
    }

    /// How many points a frame has.
    #[must_use]
    pub fn point_count(&self) -> usize {
        self.point_count
    }

    /// Writes all raw controls of the rig to `out`; those that may not move keep their values of
    /// [`FitFrame::start`]. Deterministic unless there is a time limit. Does not allocate.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_fit_solve)]
    pub fn solve(&mut self, frame: &FitFrame<'_>, out: &mut [f32]) -> Result<FitResult> {
        self.solve_one(frame, out, (null_mut(), None))
    }

    /// The same, until `stop` returns true: it is asked before each iteration.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_fit_solve)]
    pub fn solve_until<C: FnMut() -> bool>(
        &mut self,
        frame: &FitFrame<'_>,
        out: &mut [f32],
        stop: C,
    ) -> Result<FitResult> {
        until(stop, |stop| self.solve_one(frame, out, stop))
    }

    /// Solves `count` frames of a motion, each from the result of the one before.
    ///
    /// `joints`, `points`, `images` and `point_weights` of `frame` have a row for each frame, one after the other; all
    /// else is for all frames. `start` and `stages` are for the first frame, and so is `camera`, if it may move. `out`
    /// gets a row of all raw controls for each frame. Where joints are the only targets, this is faster than calls of
    /// [`solve`](Self::solve), and differs from them by rounding.
    ///
    /// ```
    /// use mien::{Dna, Fit, FitFrame, Preset, Rig};
    /// let rig = Rig::new(&Dna::generate(Preset::SMALL)?)?;
    /// let mut face = rig.instance()?;
    /// let count = face.raw_controls().len();
    /// let mut joints = Vec::new();
    /// for f in 0..10 {
    ///     face.raw_controls_mut()[3] = 0.05 * f as f32;
    ///     face.evaluate(0)?;
    ///     joints.extend_from_slice(face.joints());
    /// }
    /// let mut raw = vec![0.0; 10 * count];
    /// let frames = FitFrame { joints: Some(&joints), ..Default::default() };
    /// Fit::new(&rig)?.solve_frames(&frames, 10, &mut raw)?;
    /// assert!((raw[9 * count + 3] - 0.45).abs() < 0.01);
    /// # Ok::<(), mien::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_fit_solve_frames)]
    pub fn solve_frames(
        &mut self,
        frame: &FitFrame<'_>,
        count: usize,
        out: &mut [f32],
    ) -> Result<Vec<FitResult>> {
        self.solve_all(frame, count, out, (null_mut(), None))
    }

    /// The same, until `stop` returns true: it is asked before each iteration of each frame, so once it returns true
    /// it has to go on doing so. Frames after that keep the controls of the one before.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_fit_solve_frames)]
    pub fn solve_frames_until<C: FnMut() -> bool>(
        &mut self,
        frame: &FitFrame<'_>,
        count: usize,
        out: &mut [f32],
        stop: C,
    ) -> Result<Vec<FitResult>> {
        until(stop, |stop| self.solve_all(frame, count, out, stop))
    }

    fn solve_one(
        &mut self,
        frame: &FitFrame<'_>,
        out: &mut [f32],
        stop: Stop,
    ) -> Result<FitResult> {
        self.check_lengths(frame, 1, out)?;
        let mut result = sys::MienFitResult::default();
        frame.with_raw(stop, |given| {
            // SAFETY: a live handle that nobody else uses, sized structs, and arrays of the lengths of the rig and of
            // the points, as checked above.
            check(unsafe {
                sys::mien_fit_solve(self.handle.as_ptr(), given, out.as_mut_ptr(), &mut result)
            })
        })?;
        Ok(result.into())
    }

    fn solve_all(
        &mut self,
        frame: &FitFrame<'_>,
        count: usize,
        out: &mut [f32],
        stop: Stop,
    ) -> Result<Vec<FitResult>> {
        self.check_lengths(frame, count, out)?;
        let mut results = vec![sys::MienFitResult::default(); count];
        frame.with_raw(stop, |given| {
            let handle = self.handle.as_ptr();
            let (out, results) = (out.as_mut_ptr(), results.as_mut_ptr());
            // SAFETY: the same, with a row of each array and a result for each frame.
            check(unsafe { sys::mien_fit_solve_frames(handle, given, count, out, results) })
        })?;
        Ok(results.into_iter().map(FitResult::from).collect())
    }

    /// Whether all arrays have the lengths that the library reads and writes, for `count` frames.
    fn check_lengths(&self, frame: &FitFrame<'_>, count: usize, out: &[f32]) -> Result<()> {
        let (raw, points) = (self.raw_count, self.point_count);
        let rows = |width: usize| {
            count.checked_mul(width).ok_or_else(|| {
                Error::new(Status::INVALID_ARGUMENT, "count: more numbers than there can be")
            })
        };
        let values = rows(self.rig.info().joint_value_count)?;
        check_length(frame.joints, values, "joints: not all values")?;
        check_length(frame.points, rows(points)?, "points: not one for each point")?;
        check_length(frame.images, rows(points)?, "images: not one for each point")?;
        check_length(frame.point_weights, rows(points)?, "point_weights: not one per point")?;
        check_length(frame.start, raw, "start: not all raw controls")?;
        check_length(frame.prior, raw, "prior: not all raw controls")?;
        check_length(frame.surface_weights, rows(points)?, "surface_weights: not one per point")?;
        check_length(frame.point_offsets, points, "point_offsets: not one for each point")?;
        check_length(frame.stages, raw, "stages: not one for each raw control")?;
        check_length(Some(out), rows(raw)?, "out: not room for all raw controls")
    }

    /// How well the data determines each raw control at the initial pose: 0 if it moves nothing that has a
    /// target, or if other controls have the same effect; up to 1.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_fit_observability)]
    pub fn observability(&self) -> Result<Vec<f32>> {
        let mut out = vec![0.0; self.raw_count];
        // SAFETY: a live handle, and room for as many floats as are told.
        check(unsafe {
            sys::mien_fit_observability(self.handle.as_ptr(), out.as_mut_ptr(), out.len())
        })?;
        Ok(out)
    }
}

impl FitFrame<'_> {
    /// Calls `run` with the struct of the library, which does not allocate.
    fn with_raw(
        &self,
        (user, canceled): Stop,
        run: impl FnOnce(&sys::MienFitFrame) -> Result<()>,
    ) -> Result<()> {
        let mut constraints = [sys::MienFitConstraint::default(); FitConstraint::MOST];
        if self.constraints.len() > constraints.len() {
            return Err(Error::new(Status::INVALID_ARGUMENT, "constraints: more than 64"));
        }
        for (to, constraint) in constraints.iter_mut().zip(self.constraints) {
            *to = constraint.raw();
        }
        let camera = self.camera.map(FitCamera::raw);
        run(&sys::MienFitFrame {
            joints: pointer(self.joints),
            points: pointer(self.points),
            images: pointer(self.images),
            camera: camera.as_ref().map_or(null(), |camera| camera),
            point_weights: pointer(self.point_weights),
            start: pointer(self.start),
            prior: pointer(self.prior),
            prior_weight: self.prior_weight,
            smooth_weight: self.smooth_weight,
            sparse_weight: self.sparse_weight,
            symmetric_weight: self.symmetric_weight,
            robust_scale: self.robust_scale,
            joint_weight: self.joint_weight,
            rigid: self.rigid.into(),
            max_iterations: self.max_iterations,
            max_seconds: self.max_seconds,
            user,
            canceled,
            surface: self.surface.map_or(null(), |surface| surface.handle.as_ptr()),
            surface_reach: self.surface_reach,
            focal: self.focal.into(),
            constraint_count: self.constraints.len(),
            constraints: constraints.as_ptr(),
            stages: pointer(self.stages),
            point_offsets: pointer(self.point_offsets),
            surface_weights: pointer(self.surface_weights),
            image_weight: self.image_weight,
            image_robust_scale: self.image_robust_scale,
            ..Default::default()
        })
    }
}

impl FitOptions<'_> {
    /// Measures the effect of each control, which takes up to some seconds for large rigs.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_fit_create)]
    pub fn create(&self, rig: &Rig) -> Result<Fit> {
        let raw = rig.count(Kind::RAW_CONTROL);
        let moving = self.controls.map_or(raw, <[u32]>::len);
        check_length(self.lower, moving, "lower: not one for each control that moves")?;
        check_length(self.upper, moving, "upper: not one for each control that moves")?;
        let values = rig.info().joint_value_count;
        check_length(self.joint_weights, values, "joint_weights: not one per joint value")?;
        let points: Vec<sys::MienSolvePoint> = self
            .points
            .iter()
            .map(|point| sys::MienSolvePoint {
                mesh: index(point.mesh.unwrap_or(self.mesh)),
                positions: point.positions.map(index),
                weights: point.weights,
            })
            .collect();
        let mut handle = null_mut();
        Allocator::with(self.allocator, |allocator| {
            let desc = sys::MienFitDesc {
                deformer: self.deformer.map_or(null(), Deformer::raw),
                controls: pointer(self.controls),
                lower: pointer(self.lower),
                upper: pointer(self.upper),
                symmetric: self.symmetric.as_ptr().cast(),
                points: points.as_ptr(),
                joint_weights: pointer(self.joint_weights),
                control_count: self.controls.map_or(0, <[u32]>::len),
                symmetric_count: 2 * self.symmetric.len(),
                point_count: points.len(),
                lod: self.lod,
                allocator,
                ..Default::default()
            };
            // SAFETY: live handles, a sized struct, and arrays of the lengths that it says.
            checked(|error| unsafe { sys::mien_fit_create(rig.raw(), &desc, &mut handle, error) })
        })?;
        Ok(Fit {
            handle: NonNull::new(handle).expect("a handle after success"),
            raw_count: raw,
            point_count: points.len(),
            rig: rig.clone(),
            _allocator: self.allocator.cloned(),
        })
    }
}

impl Drop for Fit {
    fn drop(&mut self) {
        // SAFETY: destroyed once.
        unsafe { sys::mien_fit_destroy(self.handle.as_ptr()) }
    }
}

impl std::fmt::Debug for Fit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Fit")
            .field("rig", &self.rig)
            .field("point_count", &self.point_count)
            .finish_non_exhaustive()
    }
}

/// Frame numbers of the keys of a curve, ascending, with the first and the last frame: straight lines between
/// them are within `tolerance` of all values.
///
/// # Errors
///
#[doc = errors!(mien_fit_keys)]
pub fn reduce_keys(values: &[f32], tolerance: f32) -> Result<Vec<u32>> {
    let mut keys = vec![0; values.len()];
    let mut count = 0;
    // SAFETY: values with their count, and room for as many keys.
    check(unsafe {
        let (data, room) = (values.as_ptr(), keys.as_mut_ptr());
        sys::mien_fit_keys(data, values.len(), tolerance, room, &mut count)
    })?;
    keys.truncate(count);
    Ok(keys)
}
