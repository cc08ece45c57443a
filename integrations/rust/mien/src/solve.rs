// SPDX-License-Identifier: MIT

use crate::convert::{bytes, index, slice, utf8};
use crate::error::{check, checked};
use crate::{Allocator, Deformer, DeformerInstance, Result, SolverStackInfo};
use mien_sys as sys;
use std::any::Any;
use std::borrow::Cow;
use std::cell::RefCell;
use std::ffi::CString;
use std::os::raw::c_void;
use std::panic::{catch_unwind, resume_unwind, AssertUnwindSafe};
use std::ptr::{null, null_mut, NonNull};
use std::slice::from_raw_parts_mut;
use std::sync::Arc;

/// No joint: model space, or a target at curves of the row.
pub const NO_JOINT: usize = sys::MIEN_NO_JOINT as usize;

/// Turns a joint so that one of its axes points at a target. Directions may have any length.
#[derive(Clone, Debug)]
pub struct AimSolver {
    /// Which one.
    pub joint: usize,
    /// At which it points; [`NO_JOINT`]: at three curves of the row.
    pub target_joint: usize,
    /// First of these.
    pub target_curve: usize,
    /// Of the joint.
    pub axis: [f32; 3],
    /// Of the joint; zeros: no turn about the axis.
    pub up_axis: [f32; 3],
    /// Where to turn it, in model space; zeros: 0 1 0.
    pub up: [f32; 3],
    /// Farthest from where the neutral pose points; 0 is no limit.
    pub cone_degrees: f32,
    /// 0 to 1.
    pub weight: f32,
}

impl Default for AimSolver {
    /// Joint 0 with its z axis at curve 0.
    fn default() -> Self {
        Self {
            joint: 0,
            target_joint: NO_JOINT,
            target_curve: 0,
            axis: [0.0, 0.0, 1.0],
            up_axis: [0.0; 3],
            up: [0.0; 3],
            cone_degrees: 0.0,
            weight: 1.0,
        }
    }
}

/// Lets a joint hang on one of some joints, which a curve of the row chooses.
#[derive(Clone, Debug, Default)]
pub struct SpaceSolver {
    /// Which one.
    pub joint: usize,
    /// On which it can hang; [`NO_JOINT`] is model space.
    pub spaces: Vec<usize>,
    /// Its value, rounded, is a place in `spaces`.
    pub curve: usize,
    /// Time of a change.
    pub ease_ticks: i64,
}

/// Lets the place of a joint swing about where the pose has it. Output 0 is its speed.
#[derive(Clone, Debug, Default)]
pub struct SpringSolver {
    /// Which one.
    pub joint: usize,
    /// In Hertz, above 0.
    pub frequency: f32,
    /// Share of the critical damping.
    pub damping: f32,
    /// From the place in the pose, in model space.
    pub rest_offset: [f32; 3],
    /// Farthest from the place of rest; 0 is any.
    pub stretch: f32,
    /// What jumps farther in a step takes the joint along; 0 is never.
    pub teleport: f32,
}

/// Gives joints a share of the twist of another. Output 0 is the sine of half of the angle.
#[derive(Clone, Debug, Default)]
pub struct TwistSolver {
    /// Whose twist.
    pub source: usize,
    /// About which.
    pub axis: [f32; 3],
    /// Joints and shares, -1 to 1.
    pub joints: Vec<(usize, f32)>,
}

/// Moves a joint as another one was moved from its neutral pose, or as its mirror image.
#[derive(Clone, Debug, Default)]
pub struct CopySolver {
    /// That moved.
    pub source: usize,
    /// That follows.
    pub joint: usize,
    /// As the mirror image.
    pub is_mirrored: bool,
    /// From right to left in model space; zeros: 1 0 0.
    pub mirror_axis: [f32; 3],
    /// 0 to 1.
    pub weight: f32,
}

/// What a custom solver sees of one character.
#[derive(Debug)]
#[non_exhaustive]
pub struct SolverPose<'a> {
    /// Per joint tx ty tz qx qy qz qw sx sy sz, relative to the parent. Change those that it writes.
    pub locals: &'a mut [[f32; 10]],
    /// Per joint the columns of its model matrix; up to date for joints that it reads.
    pub models: &'a [[f32; 16]],
    /// The same for its previous joints, after the last step.
    pub previous: &'a [[f32; 16]],
    /// Curves of the step's row.
    pub row: &'a [f32],
    /// To publish.
    pub outputs: &'a mut [f32],
    /// Zeros at first; kept between steps.
    pub state: &'a mut [f32],
    /// Level of detail.
    pub lod: usize,
    /// The first step, or the character was moved to another place.
    pub is_reset: bool,
}

/// What a custom solver runs: it gets a character and the ticks since its last step.
type Solve = dyn Fn(SolverPose<'_>, i64) + Send + Sync;

/// A solver of yours.
#[derive(Clone)]
pub struct CustomSolver {
    solve: Arc<Solve>,
    writes: Vec<usize>,
    reads: Vec<usize>,
    previous: Vec<usize>,
    state_floats: usize,
    output_count: usize,
}

impl std::fmt::Debug for CustomSolver {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("CustomSolver").field("writes", &self.writes).finish_non_exhaustive()
    }
}

impl CustomSolver {
    /// Runs `solve` for each character. It changes the local transforms of these joints, and must not allocate if
    /// steps shall not.
    pub fn new(
        writes: &[usize],
        solve: impl Fn(SolverPose<'_>, i64) + Send + Sync + 'static,
    ) -> Self {
        Self {
            solve: Arc::new(solve),
            writes: writes.to_vec(),
            reads: Vec::new(),
            previous: Vec::new(),
            state_floats: 0,
            output_count: 0,
        }
    }

    /// Joints whose model matrices it reads.
    #[must_use]
    pub fn reads(mut self, joints: &[usize]) -> Self {
        self.reads = joints.to_vec();
        self
    }

    /// Joints whose model matrices of the last step it reads.
    #[must_use]
    pub fn previous(mut self, joints: &[usize]) -> Self {
        self.previous = joints.to_vec();
        self
    }

    /// Floats that it remembers.
    #[must_use]
    pub fn state(mut self, floats: usize) -> Self {
        self.state_floats = floats;
        self
    }

    /// Floats that it publishes.
    #[must_use]
    pub fn outputs(mut self, count: usize) -> Self {
        self.output_count = count;
        self
    }
}

/// What moves joints after the rig has posed them.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Solver {
    /// Points at something.
    Aim(AimSolver),
    /// Changes what it hangs on.
    Space(SpaceSolver),
    /// Swings.
    Spring(SpringSolver),
    /// Spreads a twist.
    Twist(TwistSolver),
    /// Follows another joint.
    Copy(CopySolver),
    /// Does what you want.
    Custom(CustomSolver),
}

/// What a custom solver needs when it is called.
struct Called {
    solve: Arc<Solve>,
    curve_count: usize,
    previous_count: usize,
    state_floats: usize,
    output_count: usize,
}

thread_local! {
    /// What a custom solver panicked with; it goes on when C has returned.
    static PANIC: RefCell<Option<Box<dyn Any + Send>>> = RefCell::new(None);
}

/// # Safety
///
/// `user` is a `Called`, and `call` as mien.h says.
unsafe extern "C" fn solve(user: *mut c_void, call: *const sys::MienSolverCall) {
    // SAFETY: the stack keeps what `user` points to; the library gives a call for this time.
    let (called, call) = unsafe { (&*(user as *const Called), &*call) };
    let joints = call.joint_count as usize;
    let run = AssertUnwindSafe(|| {
        // SAFETY: arrays as mien.h describes them, of different characters.
        let pose = |pose: &sys::MienSolverPose| unsafe {
            SolverPose {
                locals: mutable(pose.locals.cast(), joints),
                models: slice(pose.models.cast(), joints),
                previous: slice(pose.previous.cast(), called.previous_count),
                row: slice(pose.row, if pose.row.is_null() { 0 } else { called.curve_count }),
                outputs: mutable(pose.outputs, called.output_count),
                state: mutable(pose.state.cast(), called.state_floats),
                lod: pose.lod as usize,
                is_reset: pose.is_reset != 0,
            }
        };
        // SAFETY: as many as told.
        let poses = unsafe { slice(call.poses, call.pose_count as usize) };
        for each in poses {
            (called.solve)(pose(each), call.ticks);
        }
    });
    if let Err(panic) = catch_unwind(run) {
        // The first one is what the step raises. Others are not dropped here, as that may panic.
        let later = PANIC.with(|place| match &mut *place.borrow_mut() {
            Some(_) => Some(panic),
            empty => {
                *empty = Some(panic);
                None
            }
        });
        std::mem::forget(later);
    }
}

/// # Safety
///
/// As for [`slice`], and nothing else uses the values for `'a`.
unsafe fn mutable<'a, T>(data: *mut T, count: usize) -> &'a mut [T] {
    if count == 0 {
        &mut []
    } else {
        // SAFETY: promised by the caller.
        unsafe { from_raw_parts_mut(data, count) }
    }
}

fn joint(joint: usize) -> u16 {
    // One that does not fit is past the end of everything; so is 65534 of fewer joints.
    if joint == NO_JOINT {
        return sys::MIEN_NO_JOINT as u16;
    }
    u16::try_from(joint).unwrap_or(u16::MAX - 1)
}

fn joints(list: &[usize]) -> Vec<u16> {
    list.iter().map(|one| joint(*one)).collect()
}

/// Solvers as C takes them, each in memory of its own, so that what points to them stays right.
#[derive(Default)]
struct Lists {
    aims: Vec<Arc<sys::MienAimSolver>>,
    spaces: Vec<Arc<sys::MienSpaceSolver>>,
    springs: Vec<Arc<sys::MienSpringSolver>>,
    twists: Vec<Arc<sys::MienTwistSolver>>,
    copies: Vec<Arc<sys::MienCopySolver>>,
    customs: Vec<Arc<sys::MienUserSolver>>,
    joints: Vec<Vec<u16>>,
    shares: Vec<Vec<f32>>,
    names: Vec<CString>,
    called: Vec<Arc<Called>>,
}

fn keep<T>(list: &mut Vec<Arc<T>>, item: T) -> *const T {
    list.push(Arc::new(item));
    Arc::as_ptr(&list[list.len() - 1])
}

impl Lists {
    fn joints(&mut self, list: &[usize]) -> *const u16 {
        self.joints.push(joints(list));
        self.joints[self.joints.len() - 1].as_ptr()
    }

    fn solver(&mut self, solver: &Solver, curve_count: usize) -> sys::MienSolver {
        let mut to = sys::MienSolver::default();
        match solver {
            Solver::Aim(s) => {
                let aim = sys::MienAimSolver {
                    joint: index(s.joint),
                    target_joint: index(s.target_joint),
                    target_curve: index(s.target_curve),
                    axis: s.axis,
                    up_axis: s.up_axis,
                    up: s.up,
                    cone_degrees: s.cone_degrees,
                    weight: s.weight,
                };
                to.aim = keep(&mut self.aims, aim);
            }
            Solver::Space(s) => {
                let space = sys::MienSpaceSolver {
                    ease_ticks: s.ease_ticks,
                    spaces: self.joints(&s.spaces),
                    space_count: index(s.spaces.len()),
                    curve: index(s.curve),
                    joint: index(s.joint),
                    reserved: 0,
                };
                to.space = keep(&mut self.spaces, space);
            }
            Solver::Spring(s) => {
                let spring = sys::MienSpringSolver {
                    joint: index(s.joint),
                    frequency: s.frequency,
                    damping: s.damping,
                    rest_offset: s.rest_offset,
                    stretch: s.stretch,
                    teleport: s.teleport,
                };
                to.spring = keep(&mut self.springs, spring);
            }
            Solver::Twist(s) => {
                let (list, shares): (Vec<_>, Vec<_>) = s.joints.iter().copied().unzip();
                self.shares.push(shares);
                let twist = sys::MienTwistSolver {
                    joints: self.joints(&list),
                    shares: self.shares[self.shares.len() - 1].as_ptr(),
                    joint_count: index(list.len()),
                    source: index(s.source),
                    axis: s.axis,
                    reserved: 0,
                };
                to.twist = keep(&mut self.twists, twist);
            }
            Solver::Copy(s) => {
                let copy = sys::MienCopySolver {
                    source: index(s.source),
                    joint: index(s.joint),
                    is_mirrored: s.is_mirrored.into(),
                    mirror_axis: s.mirror_axis,
                    weight: s.weight,
                };
                to.copy = keep(&mut self.copies, copy);
            }
            Solver::Custom(s) => {
                let called = Called {
                    solve: s.solve.clone(),
                    curve_count,
                    previous_count: s.previous.len(),
                    state_floats: s.state_floats,
                    output_count: s.output_count,
                };
                let custom = sys::MienUserSolver {
                    user: keep(&mut self.called, called) as *mut c_void,
                    solve: Some(solve),
                    reads: self.joints(&s.reads),
                    writes: self.joints(&s.writes),
                    previous_joints: self.joints(&s.previous),
                    read_count: index(s.reads.len()),
                    write_count: index(s.writes.len()),
                    previous_joint_count: index(s.previous.len()),
                    state_bytes: index(s.state_floats.saturating_mul(4)),
                    output_count: index(s.output_count),
                    reserved: 0,
                };
                to.custom = keep(&mut self.customs, custom);
            }
        }
        to
    }
}

/// What solver stacks are made of.
#[derive(Clone, Debug, Default)]
pub struct SolverStackOptions {
    solvers: Vec<(Solver, String, u64)>,
    curve_count: usize,
    check_writes: bool,
    allocator: Option<Allocator>,
}

impl SolverStackOptions {
    /// No solvers.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// One more solver, which runs after those before it.
    #[must_use]
    pub fn solver(self, solver: Solver) -> Self {
        self.solver_at(solver, "", 0)
    }

    /// The same with a name for messages, at some LODs only: bit l is LOD l; 0 is all.
    #[must_use]
    pub fn solver_at(mut self, solver: Solver, name: &str, lods: u64) -> Self {
        self.solvers.push((solver, name.into(), lods));
        self
    }

    /// Curves of the rows that steps get, at least.
    #[must_use]
    pub fn curve_count(mut self, curve_count: usize) -> Self {
        self.curve_count = curve_count;
        self
    }

    /// Compares all joints before and after each solver, for [`SolverState::undeclared`].
    #[must_use]
    pub fn check_writes(mut self) -> Self {
        self.check_writes = true;
        self
    }

    /// Memory of your own, for the stack and its states.
    #[must_use]
    pub fn allocator(mut self, allocator: &Allocator) -> Self {
        self.allocator = Some(allocator.clone());
        self
    }

    /// Makes the stack.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_solver_stack_create)]
    pub fn create(&self, deformer: &Deformer) -> Result<SolverStack> {
        let mut lists = Lists::default();
        let mut solvers = Vec::new();
        for (solver, name, lods) in &self.solvers {
            let mut to = lists.solver(solver, self.curve_count);
            if !name.is_empty() {
                lists.names.push(crate::convert::terminated(name)?);
                to.name = lists.names[lists.names.len() - 1].as_ptr();
            }
            to.lods = *lods;
            solvers.push(to);
        }
        let mut handle = null_mut();
        Allocator::with(self.allocator.as_ref(), |allocator| {
            let desc = sys::MienSolverStackDesc {
                solvers: solvers.as_ptr(),
                solver_count: solvers.len(),
                curve_count: index(self.curve_count),
                check_writes: self.check_writes.into(),
                allocator,
                ..Default::default()
            };
            // SAFETY: a live handle, and a sized struct with as many solvers as it says. What custom
            // ones point to is kept below.
            checked(|error| unsafe {
                sys::mien_solver_stack_create(deformer.raw(), &desc, &mut handle, error)
            })
        })?;
        let handle = NonNull::new(handle).expect("a handle after success");
        let mut info = sys::MienSolverStackInfo::default();
        // SAFETY: a live handle and a sized struct.
        let status = unsafe { sys::mien_solver_stack_info(handle.as_ptr(), &mut info) };
        let shared = Shared {
            handle,
            info: info.into(),
            _called: lists.called,
            _deformer: deformer.clone(),
            allocator: self.allocator.clone(),
        };
        let stack = SolverStack { shared: Arc::new(shared) };
        check(status).map(|()| stack)
    }
}

/// Solvers of one deformer, in the order in which they run. It never changes.
///
/// Like a [`Deformer`], a counted reference: clones are the same stack, and each [`SolverState`] holds
/// one.
///
/// ```
/// use mien::{Deformer, Dna, Preset, Rig, Solver, SolverInput, SolverStackOptions, SpringSolver};
/// let dna = Dna::generate(Preset::SMALL)?;
/// let rig = Rig::new(&dna)?;
/// let deformer = Deformer::new(&dna, &rig)?;
/// let spring = SpringSolver { joint: 1, frequency: 3.0, damping: 0.3, ..Default::default() };
/// let stack = SolverStackOptions::new().solver(Solver::Spring(spring)).create(&deformer)?;
///
/// let (mut face, mut body) = (rig.instance()?, deformer.instance()?);
/// let mut state = stack.state()?;
/// face.evaluate(0)?;
/// body.update(&face)?;
/// state.step(&mut body, 11_760_000, &SolverInput::default())?; // then body.deform()
/// # Ok::<(), mien::Error>(())
/// ```
#[derive(Clone)]
pub struct SolverStack {
    shared: Arc<Shared>,
}

struct Shared {
    handle: NonNull<sys::MienSolverStack>,
    info: SolverStackInfo,
    // Released after the handle.
    _called: Vec<Arc<Called>>,
    _deformer: Deformer,
    allocator: Option<Allocator>,
}

// SAFETY: the handle is const for every call but destroying; const handles may be used by any
// number of threads at the same time, and any thread may destroy it. Custom solvers are Send + Sync.
unsafe impl Send for Shared {}
unsafe impl Sync for Shared {}

impl Drop for Shared {
    fn drop(&mut self) {
        // SAFETY: destroyed once.
        unsafe { sys::mien_solver_stack_destroy(self.handle.as_ptr()) }
    }
}

impl std::fmt::Debug for SolverStack {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("SolverStack").field("info", &self.shared.info).finish_non_exhaustive()
    }
}

impl SolverStack {
    /// Counts and sizes.
    #[must_use]
    pub fn info(&self) -> &SolverStackInfo {
        &self.shared.info
    }

    /// A new character.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_solver_state_create)]
    pub fn state(&self) -> Result<SolverState> {
        let mut handle = null_mut();
        Allocator::with(self.shared.allocator.as_ref(), |allocator| {
            let desc = sys::MienSolverStateDesc { allocator, ..Default::default() };
            // SAFETY: a live handle and a sized struct.
            checked(|error| unsafe {
                let stack = self.shared.handle.as_ptr();
                sys::mien_solver_state_create(stack, &desc, &mut handle, error)
            })
        })?;
        let handle = NonNull::new(handle).expect("a handle after success");
        Ok(SolverState { handle, stack: self.clone() })
    }
}

/// What solvers of one character get in a step.
#[derive(Clone, Copy, Debug, Default)]
pub struct SolverInput<'a> {
    /// Such as [`Mixer::row`](crate::Mixer::row).
    pub row: &'a [f32],
    /// Level of detail.
    pub lod: usize,
    /// The character was moved to another place: springs come to rest, and spaces do not ease.
    pub is_reset: bool,
}

impl SolverInput<'_> {
    fn raw(&self) -> sys::MienSolverInput {
        sys::MienSolverInput {
            row: if self.row.is_empty() { null() } else { self.row.as_ptr() },
            row_count: self.row.len(),
            lod: index(self.lod),
            is_reset: self.is_reset.into(),
        }
    }
}

/// One character: what its solvers remember between steps.
pub struct SolverState {
    handle: NonNull<sys::MienSolverState>,
    // Dropped after the handle is destroyed.
    stack: SolverStack,
}

// SAFETY: a state may be used by any thread, by one at a time if it is changed, which takes
// `&mut self` here.
unsafe impl Send for SolverState {}
unsafe impl Sync for SolverState {}

impl Drop for SolverState {
    fn drop(&mut self) {
        // SAFETY: destroyed once.
        unsafe { sys::mien_solver_state_destroy(self.handle.as_ptr()) }
    }
}

impl std::fmt::Debug for SolverState {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("SolverState").field("stack", &self.stack).finish_non_exhaustive()
    }
}

/// Lets a panic of a custom solver go on.
fn finish(status: sys::MienStatus) -> Result<()> {
    if let Some(panic) = PANIC.with(|place| place.borrow_mut().take()) {
        resume_unwind(panic);
    }
    check(status)
}

impl SolverState {
    /// Runs the solvers on a pose, which [`DeformerInstance::update`] has to set before every step.
    /// A panic of a custom solver goes on when all have run.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_solver_state_step)]
    pub fn step(
        &mut self,
        body: &mut DeformerInstance,
        ticks: i64,
        input: &SolverInput<'_>,
    ) -> Result<()> {
        let input = input.raw();
        // SAFETY: live handles, both borrowed mutably, and a row with its length.
        finish(unsafe {
            sys::mien_solver_state_step(self.handle.as_ptr(), body.raw(), &input, ticks)
        })
    }

    /// Steps states of one stack: the results of single calls. On failure nothing has moved.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_solver_state_step_batch)]
    pub fn step_batch<'a>(
        steps: impl IntoIterator<
            Item = (&'a mut SolverState, &'a mut DeformerInstance, SolverInput<'a>),
        >,
        ticks: i64,
    ) -> Result<()> {
        let (mut states, mut bodies, mut inputs) = (Vec::new(), Vec::new(), Vec::new());
        for (state, body, input) in steps {
            states.push(state.handle.as_ptr());
            bodies.push(body.raw());
            inputs.push(input.raw());
        }
        // SAFETY: live handles, different ones as they are borrowed mutably, and as many as told.
        finish(unsafe {
            sys::mien_solver_state_step_batch(
                states.as_mut_ptr(),
                bodies.as_mut_ptr(),
                inputs.as_ptr(),
                inputs.len(),
                ticks,
            )
        })
    }

    /// What a solver has published in the last step.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_solver_state_outputs)]
    pub fn outputs(&self, solver: usize) -> Result<&[f32]> {
        let mut view = sys::MienFloatView::default();
        // SAFETY: a live handle. What changes outputs takes `&mut self`; the same below.
        unsafe {
            let state = self.handle.as_ptr();
            check(sys::mien_solver_state_outputs(state, index(solver), &mut view))?;
            Ok(slice(view.data, view.count))
        }
    }

    /// Per joint tx ty tz qx qy qz qw sx sy sz after the last step, relative to the parent.
    #[must_use]
    pub fn transforms(&self) -> &[[f32; 10]] {
        let mut view = sys::MienFloatView::default();
        unsafe {
            if sys::mien_solver_state_transforms(self.handle.as_ptr(), &mut view) != sys::MIEN_OK {
                return &[];
            }
            slice(view.data.cast(), view.count / 10)
        }
    }

    /// The solver that changed a joint which is not in its list in the last step, or an empty string.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_solver_state_undeclared)]
    pub fn undeclared(&self) -> Result<Cow<'_, str>> {
        let mut name = sys::MienStringView::default();
        unsafe {
            check(sys::mien_solver_state_undeclared(self.handle.as_ptr(), &mut name))?;
            Ok(utf8(bytes(name)))
        }
    }
}
