// SPDX-License-Identifier: MIT
//! Controls for captured motion: libmien-solve.

use crate::convert::index;
use crate::error::{check, checked};
use crate::{Allocator, Deformer, Error, FitStatus, Kind, Result, Rig, Status};
use mien_sys as sys;
use std::any::Any;
use std::os::raw::c_void;
use std::panic::{catch_unwind, resume_unwind, AssertUnwindSafe};
use std::ptr::{null, null_mut, NonNull};

/// A point of a surface: the weighted sum of three positions of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitPoint {
    /// Positions, in the order of the file.
    pub positions: [usize; 3],
    /// Weights of these positions.
    pub weights: [f32; 3],
}

impl From<usize> for FitPoint {
    /// One position of the mesh.
    fn from(position: usize) -> Self {
        Self { positions: [position; 3], weights: [1.0, 0.0, 0.0] }
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
    /// The mesh of all points.
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

/// The targets of a frame, and the weights of the terms; terms of weight 0 are left out. A target of NaN is
/// missing.
///
/// At most one of `points`, `images` and `surface` is given.
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
    /// Weight per point, 0 or more; 1 if `None`.
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
    /// Points farther off than this count less; 0: all count fully.
    pub robust_scale: f32,
    /// Weight of the joints relative to the points; 0: 1.
    pub joint_weight: f32,
    /// The targets may be rotated and translated as a whole. With `images`, the camera is found, from that of
    /// `camera`, or, if its rotation is unknown, from one that sees the face from the front.
    pub rigid: bool,
    /// With `images` and `rigid`, the focal length is found too.
    pub focal: bool,
    /// 0: 50.
    pub max_iterations: u32,
    /// 0: no limit. A limit makes results depend on the machine.
    pub max_seconds: f64,
    /// In place of `points` and `images`: each point is drawn to the nearest place of the surface.
    pub surface: Option<&'a FitSurface>,
    /// Points farther from the surface have no target; 0: no limit.
    pub surface_reach: f32,
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
    /// The same for points, or for image points in their unit.
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
    // SAFETY: as above; the library hands back what solve_until() gave it.
    let canceled = unsafe { &mut *user.cast::<Canceled<C>>() };
    match catch_unwind(AssertUnwindSafe(|| (canceled.ask)())) {
        Ok(stop) => stop.into(),
        Err(panic) => {
            canceled.panic = Some(panic);
            1
        }
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
        self.run(frame, out, null_mut(), None)
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
        let mut asked = Canceled { ask: stop, panic: None };
        let user = (&mut asked as *mut Canceled<C>).cast();
        let result = self.run(frame, out, user, Some(canceled::<C>));
        match asked.panic {
            Some(panic) => resume_unwind(panic),
            None => result,
        }
    }

    fn run(
        &mut self,
        frame: &FitFrame<'_>,
        out: &mut [f32],
        user: *mut c_void,
        canceled: Option<unsafe extern "C" fn(*mut c_void) -> u32>,
    ) -> Result<FitResult> {
        let raw = self.raw_count;
        check_length(frame.joints, self.rig.info().joint_value_count, "joints: not all values")?;
        check_length(frame.points, self.point_count, "points: not one for each point")?;
        check_length(frame.images, self.point_count, "images: not one for each point")?;
        check_length(frame.point_weights, self.point_count, "point_weights: not one per point")?;
        check_length(frame.start, raw, "start: not all raw controls")?;
        check_length(frame.prior, raw, "prior: not all raw controls")?;
        check_length(Some(&*out), raw, "out: not room for all raw controls")?;
        let camera = frame.camera.map(FitCamera::raw);
        let given = sys::MienFitFrame {
            joints: pointer(frame.joints),
            points: pointer(frame.points),
            images: pointer(frame.images),
            camera: camera.as_ref().map_or(null(), |camera| camera),
            point_weights: pointer(frame.point_weights),
            start: pointer(frame.start),
            prior: pointer(frame.prior),
            prior_weight: frame.prior_weight,
            smooth_weight: frame.smooth_weight,
            sparse_weight: frame.sparse_weight,
            symmetric_weight: frame.symmetric_weight,
            robust_scale: frame.robust_scale,
            joint_weight: frame.joint_weight,
            rigid: frame.rigid.into(),
            max_iterations: frame.max_iterations,
            max_seconds: frame.max_seconds,
            user,
            canceled,
            surface: frame.surface.map_or(null(), |surface| surface.handle.as_ptr()),
            surface_reach: frame.surface_reach,
            focal: frame.focal.into(),
            ..Default::default()
        };
        let mut result = sys::MienFitResult::default();
        // SAFETY: a live handle that nobody else uses, sized structs, and arrays of the lengths of the rig
        // and of the points, as checked above.
        check(unsafe {
            sys::mien_fit_solve(self.handle.as_ptr(), &given, out.as_mut_ptr(), &mut result)
        })?;
        Ok(FitResult {
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
        })
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
                mesh: index(self.mesh),
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
