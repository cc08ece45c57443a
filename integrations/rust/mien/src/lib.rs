// SPDX-License-Identifier: MIT
//! Facial rigs in DNA files (the format of MetaHuman characters): opened, evaluated and written.
//!
//! ```text
//! DNA file -> Dna -> Rig -> Instance -> joint, channel and map values
//!                \______ Deformer -> DeformerInstance -> joint matrices, positions, normals
//! ```
//!
//! A [`Dna`] is a checked, read-only view of a file. A [`Rig`] is the same data packed for
//! evaluation, shared by any number of characters and threads. An [`Instance`] is one character.
//! A [`Deformer`] is the geometry of the file, shared like a rig; a [`DeformerInstance`] is what it makes of one
//! character.
//!
//! ```
//! use mien::{Dna, Kind, Preset, Rig};
//!
//! fn main() -> mien::Result<()> {
//!     let dna = Dna::generate(Preset::SMALL)?; // or Dna::open("head.dna")
//!     let rig = Rig::new(&dna)?;
//!     let mut face = rig.instance()?;
//!     let jaw = rig.find(Kind::RAW_CONTROL, "CTRL_expressions.jawOpen")?;
//!     face.raw_controls_mut()[jaw] = 1.0;
//!     face.evaluate(0)?;
//!     println!("{:?}", &face.joints()[..9]); // tx ty tz rx ry rz sx sy sz of the first joint
//!     Ok(())
//! }
//! ```
//!
//! # What holds everywhere
//!
//! * **Threads.** `Dna`, `Rig`, `Deformer` and `Report` are immutable, `Send` and `Sync`. What changes an
//!   `Instance` or a `DeformerInstance` takes `&mut`; evaluate different instances of one rig on as many threads as you
//!   like. There is no global state.
//! * **Lifetimes.** A `Rig` is a counted reference, which each instance holds; so is a `Deformer` to
//!   its poses. A `Dna` of bytes in
//!   memory borrows them; a rig borrows nothing.
//! * **Units** are those of the file: [`RigInfo`] tells centimeters or meters, degrees or radians,
//!   and which way the axes point. Outputs are deltas from the neutral pose.
//! * **Errors** carry a [`Status`] for programs, a sentence for people, and the byte offset in
//!   the file. Any bytes may be opened: what is wrong with them is an error, never a crash.
//! * **Memory** comes from an [`Allocator`] of yours, or from the heap. Evaluation takes none.
//! * **Numbers** such as [`Kind`] are named constants, not enums of Rust: a newer library may know
//!   more of them.
#![deny(missing_docs)]
#![warn(unsafe_op_in_unsafe_fn)]

#[macro_use]
#[rustfmt::skip]
mod generated;

mod allocator;
mod author;
mod baked;
mod batch;
mod clip;
mod clip_player;
mod convert;
mod coordinates;
mod deformer;
mod deformer_instance;
mod dna;
mod document;
mod error;
mod fit;
mod instance;
mod mix;
mod mixer;
mod report;
mod rig;
mod solve;
mod stream;
mod threads;
mod vertex_output;

pub use allocator::Allocator;
pub use author::{
    AuthorBone, AuthorLandmark, AuthorLod, AuthorMesh, AuthorOptions, AuthorShape, AuthoredRig,
};
pub use baked::{Baked, BakedOptions};
pub use batch::Batch;
pub use clip::{
    arkit_matrix, Clip, ClipBinding, ClipChannel, ClipEvent, ClipOptions, TICKS_PER_SECOND,
};
pub use clip_player::ClipPlayer;
pub use deformer::{Deformer, DeformerOptions, Mesh};
pub use deformer_instance::{DeformerInstance, DeformerInstanceOptions};
pub use dna::{Dna, GenerateOptions, OpenOptions, WriteOptions};
pub use document::{ControlError, Document, Placement, ProjectOptions};
pub use error::{Error, Result};
pub use fit::{
    reduce_keys, Fit, FitCamera, FitConstraint, FitFrame, FitOptions, FitPoint, FitResult,
    FitSurface,
};
pub use generated::*;
pub use instance::Instance;
pub use mix::{
    Antagonists, CustomGuard, Gaze, GuardInfo, Landmark, Mix, MixLayer, MixOptions, Reaction,
    Stroke,
};
pub use mixer::{GuardState, MixEvent, Mixer, PlayOptions, StreamSender};
pub use report::{Finding, Report};
pub use rig::{control_name, Rig, RigOptions};
pub use solve::{
    AimSolver, CopySolver, CustomSolver, Solver, SolverInput, SolverPose, SolverStack,
    SolverStackOptions, SolverState, SpaceSolver, SpringSolver, TwistSolver, NO_JOINT,
};
pub use threads::Work;
pub use vertex_output::{VertexAttribute, VertexLayout};

/// Major, minor and patch number of the library that runs, which may be newer than this crate.
pub fn version() -> (u32, u32, u32) {
    // SAFETY: takes nothing.
    let version = unsafe { mien_sys::mien_version() };
    (version >> 24, version >> 16 & 0xff, version & 0xffff)
}

/// What the compiler does not let pass.
///
/// ```compile_fail,E0505
/// let file = mien::Dna::generate(mien::Preset::TINY).unwrap().to_bytes().unwrap();
/// let dna = mien::Dna::from_bytes(&file).unwrap();
/// drop(file);
/// println!("{}", dna.info().joint_count);
/// ```
///
/// ```compile_fail,E0502
/// let rig = mien::Rig::new(&mien::Dna::generate(mien::Preset::TINY).unwrap()).unwrap();
/// let mut face = rig.instance().unwrap();
/// let joints = face.joints();
/// face.evaluate(0).unwrap();
/// println!("{}", joints[0]);
/// ```
///
/// ```compile_fail,E0499
/// let rig = mien::Rig::new(&mien::Dna::generate(mien::Preset::TINY).unwrap()).unwrap();
/// let mut face = rig.instance().unwrap();
/// let (one, two) = (face.raw_controls_mut(), face.raw_controls_mut());
/// one[0] = two[0];
/// ```
///
/// ```compile_fail,E0505
/// let rig = mien::Rig::new(&mien::Dna::generate(mien::Preset::TINY).unwrap()).unwrap();
/// let face = rig.instance().unwrap();
/// let joints = face.joints();
/// drop(face);
/// println!("{}", joints[0]);
/// ```
///
/// ```compile_fail,E0133
/// let dna = mien::OpenOptions::new().map("head.dna");
/// ```
///
/// Work that is done after the call, or a solver's pose that is kept:
///
/// ```compile_fail,E0521
/// fn evaluate(batch: &mut mien::Batch, face: &mut mien::Instance) {
///     let all = mien::Stages::ALL;
///     batch.evaluate_each_on([(face, 0)], all, |_, work| drop(std::thread::spawn(work))).unwrap();
/// }
/// ```
///
/// ```compile_fail,E0521
/// let kept = std::sync::Mutex::new(Vec::<&'static mut [f32]>::new());
/// mien::CustomSolver::new(&[0], move |pose, _| kept.lock().unwrap().push(pose.state));
/// ```
///
/// Solvers, allocators and work of one thread, on others:
///
/// ```compile_fail,E0277
/// let count = std::rc::Rc::new(std::cell::Cell::new(0));
/// mien::CustomSolver::new(&[0], move |_, _| count.set(count.get() + 1));
/// ```
///
/// ```compile_fail,E0277
/// let count = std::cell::Cell::new(0);
/// mien::CustomSolver::new(&[0], move |_, _| count.set(count.get() + 1));
/// ```
///
/// Characters on two threads at the same time, and steps of one character:
///
/// ```compile_fail,E0499
/// fn both(face: &mut mien::Instance) {
///     std::thread::scope(|scope| {
///         scope.spawn(|| face.evaluate(0).unwrap());
///         scope.spawn(|| face.evaluate(1).unwrap());
///     });
/// }
/// ```
///
/// ```compile_fail,E0499
/// fn twice(batch: &mut mien::Batch, face: &mut mien::Instance) {
///     batch.evaluate([&mut *face, &mut *face], 0).unwrap();
/// }
/// ```
///
/// A surface that is gone while a frame has it:
///
/// ```compile_fail,E0505
/// fn solve(fit: &mut mien::Fit, surface: mien::FitSurface, out: &mut [f32]) {
///     let frame = mien::FitFrame { surface: Some(&surface), ..Default::default() };
///     drop(surface);
///     fit.solve(&frame, out).unwrap();
/// }
/// ```
///
/// ```compile_fail,E0502
/// fn row(mixer: &mut mien::Mixer) {
///     let row = mixer.row();
///     mixer.step(1, None).unwrap();
///     println!("{}", row[0]);
/// }
/// ```
#[cfg(doctest)]
mod misuse {}
