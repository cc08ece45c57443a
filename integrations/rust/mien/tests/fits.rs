// SPDX-License-Identifier: MIT
//! Fits: known controls come back; wrong arguments are errors; any order of drops, threads, panics.

use mien::{
    reduce_keys, Allocator, Deformer, Dna, Fit, FitCamera, FitConstraint, FitConstraintKind,
    FitFrame, FitOptions, FitPoint, FitStatus, FitSurface, Instance, Kind, Normals, Preset, Rig,
    Status,
};
use std::alloc::{GlobalAlloc, Layout, System};
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::Arc;

fn made() -> (Rig, Deformer) {
    let dna = Dna::generate(Preset::SMALL).unwrap();
    let rig = Rig::new(&dna).unwrap();
    let deformer = Deformer::new(&dna, &rig).unwrap();
    (rig, deformer)
}

fn posed(rig: &Rig) -> Instance {
    let mut face = rig.instance().unwrap();
    for (i, value) in face.raw_controls_mut().iter_mut().enumerate() {
        *value = if i % 4 == 0 { 0.4 } else { 0.0 };
    }
    face.evaluate(0).unwrap();
    face
}

fn positions(deformer: &Deformer, face: &Instance) -> Vec<[f32; 3]> {
    let mut pose = deformer.instance().unwrap();
    pose.update(face).unwrap();
    pose.deform(0, Normals::NONE).unwrap();
    pose.positions(0).unwrap().to_vec()
}

fn extent(positions: &[[f32; 3]]) -> f64 {
    let xs = positions.iter().map(|p| p[0]);
    f64::from(xs.clone().fold(f32::MIN, f32::max) - xs.fold(f32::MAX, f32::min))
}

fn every_position(count: usize) -> Vec<FitPoint> {
    (0..count).map(FitPoint::from).collect()
}

fn fails<T>(status: Status, result: mien::Result<T>) {
    assert_eq!(result.err().map(|error| error.status()), Some(status));
}

#[test]
fn joints_give_their_controls() {
    let (rig, _) = made();
    let face = posed(&rig);
    let mut fit = Fit::new(&rig).unwrap();
    let observed = fit.observability().unwrap();
    let mut found = vec![0.0; face.raw_controls().len()];
    let frame = FitFrame { joints: Some(face.joints()), max_iterations: 200, ..Default::default() };
    let result = fit.solve(&frame, &mut found).unwrap();
    assert!(result.joint_residual < 0.01 && result.joint_worst >= result.joint_residual);
    let known = observed.iter().filter(|share| **share >= 0.05).count();
    assert!(known > found.len() / 2);
    for (i, value) in found.iter().enumerate() {
        assert!(observed[i] < 0.05 || (value - face.raw_controls()[i]).abs() < 0.01, "{i}");
    }
    // No data: the start.
    let start = vec![0.25; found.len()];
    let nothing = FitFrame { start: Some(&start), ..Default::default() };
    assert_eq!(fit.solve(&nothing, &mut found).unwrap().status, FitStatus::NO_DATA);
    assert_eq!(found, start);
}

#[test]
fn points_and_images_and_surfaces() {
    let (rig, deformer) = made();
    let mesh = deformer.mesh(0).unwrap();
    let points = every_position(mesh.positions.len());
    let target = positions(&deformer, &posed(&rig));
    let size = extent(&target);
    let options = FitOptions { deformer: Some(&deformer), points: &points, ..Default::default() };
    let mut fit = options.create(&rig).unwrap();
    let mut found = vec![0.0; rig.count(Kind::RAW_CONTROL)];

    // A target that lies elsewhere, with a point that is missing.
    let mut moved: Vec<[f32; 3]> = target.iter().map(|p| [p[0] + 1.0, p[1] + 2.0, p[2]]).collect();
    moved[7] = [f32::NAN; 3];
    let frame =
        FitFrame { points: Some(&moved), rigid: true, max_iterations: 200, ..Default::default() };
    let result = fit.solve(&frame, &mut found).unwrap();
    assert_eq!(result.missing_points, 1);
    assert!(result.point_residual < 0.02 * size && result.point_worst < size);

    // The face of another person, whose points are elsewhere at rest.
    let offsets: Vec<[f32; 3]> = (0..target.len()).map(|i| [(i % 3) as f32, 0.0, 0.5]).collect();
    let other: Vec<[f32; 3]> =
        target.iter().zip(&offsets).map(|(p, o)| [p[0] + o[0], p[1] + o[1], p[2] + o[2]]).collect();
    let raw = posed(&rig).raw_controls().to_vec();
    let frame = FitFrame {
        points: Some(&other),
        point_offsets: Some(&offsets),
        start: Some(&raw),
        ..Default::default()
    };
    let result = fit.solve(&frame, &mut found).unwrap();
    assert!(result.point_worst < 1e-3 * size, "{}", result.point_worst);
    let short = FitFrame { point_offsets: Some(&offsets[1..]), ..frame };
    assert!(fit.solve(&short, &mut found).is_err());

    // The rest, as a camera sees it.
    let camera = FitCamera {
        focal: [500.0; 2],
        center: [320.0, 240.0],
        rotation: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        translation: [0.0, 0.0, 10.0 * size as f32],
    };
    let seen = |p: &[f32; 3]| {
        let z = p[2] + camera.translation[2];
        [500.0 * p[0] / z + 320.0, 500.0 * p[1] / z + 240.0]
    };
    let images: Vec<[f32; 2]> = mesh.positions.iter().map(seen).collect();
    let frame = FitFrame { images: Some(&images), camera: Some(&camera), ..Default::default() };
    let result = fit.solve(&frame, &mut found).unwrap();
    assert!(result.point_residual < 0.5 && result.focal == camera.focal);

    // The target as a surface, whose triangles are of positions.
    let corner = |v: u32| mesh.vertex_position_indices[v as usize];
    let triangles: Vec<[u32; 3]> = mesh.triangles.iter().map(|t| t.map(corner)).collect();
    let surface = FitSurface::new(&target, &triangles).unwrap();
    let frame = FitFrame {
        surface: Some(&surface),
        surface_reach: size as f32,
        start: Some(&posed(&rig).raw_controls().to_vec()),
        ..Default::default()
    };
    let result = fit.solve(&frame, &mut found).unwrap();
    assert!(result.point_residual < 1e-3 * size, "{}", result.point_residual);
    assert_eq!(result.point_residual, result.surface_residual);

    // Points at rest draw from it, with the camera that sees them.
    let frame = FitFrame {
        points: Some(&mesh.positions),
        images: Some(&images),
        camera: Some(&camera),
        image_weight: 1e-6,
        ..frame
    };
    let mixed = fit.solve(&frame, &mut found).unwrap();
    assert!(mixed.surface_residual > result.surface_residual && mixed.point_residual > 0.0);
    let none = vec![0.0; mesh.positions.len()];
    let frame = FitFrame { surface_weights: Some(&none), ..frame };
    let alone = fit.solve(&frame, &mut found).unwrap();
    assert!(alone.surface_residual == 0.0 && alone.image_residual < mixed.image_residual);
    assert!(alone.point_residual < mixed.point_residual);
    let frame = FitFrame { surface_weights: Some(&none[1..]), ..frame };
    assert!(fit.solve(&frame, &mut found).is_err());
}

/// Joint values of frames, one after the other, with the controls that gave them.
fn motion(rig: &Rig, frames: usize) -> (Vec<f32>, Vec<f32>) {
    let mut face = rig.instance().unwrap();
    let (mut joints, mut controls) = (Vec::new(), Vec::new());
    for f in 0..frames {
        for (i, value) in face.raw_controls_mut().iter_mut().enumerate() {
            *value = if i % 4 == 0 { 0.4 * f as f32 / frames as f32 } else { 0.0 };
        }
        face.evaluate(0).unwrap();
        joints.extend_from_slice(face.joints());
        controls.extend_from_slice(face.raw_controls());
    }
    (joints, controls)
}

#[test]
fn constraints_move_joints_and_points() {
    let (rig, deformer) = made();
    let face = posed(&rig);
    let mut pose = deformer.instance().unwrap();
    pose.update(&face).unwrap();
    // The joint that moved farthest, and where it is.
    let place = |m: &[f32; 16]| [m[12], m[13], m[14]];
    let far = |a: [f32; 3], b: [f32; 3]| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f32>().sqrt();
    let rest: Vec<[f32; 3]> = deformer.bind_matrices().iter().map(place).collect();
    let there: Vec<[f32; 3]> = pose.joint_matrices().iter().map(place).collect();
    let moved = |joint: &usize| far(rest[*joint], there[*joint]);
    let joint = (0..rest.len()).max_by(|a, b| moved(a).total_cmp(&moved(b))).unwrap();
    let points = [FitPoint::from(0), FitPoint::from(1)];
    let options = FitOptions { deformer: Some(&deformer), points: &points, ..Default::default() };
    let mut fit = options.create(&rig).unwrap();
    let mut out = vec![0.0; rig.count(Kind::RAW_CONTROL)];

    let to_place = [FitConstraint::joint_position(joint, there[joint])];
    let frame = FitFrame { constraints: &to_place, max_iterations: 200, ..Default::default() };
    let result = fit.solve(&frame, &mut out).unwrap();
    assert!(result.constraint_worst < 0.05 * f64::from(moved(&joint)), "{result:?}");
    assert!(result.constraint_residual <= result.constraint_worst);
    // What the rig is like already costs nothing; a target that is missing is no data.
    let axes = [0.0, 0.0, 1.0];
    let at_rest = deformer.mesh(0).unwrap().positions[0];
    let direction = {
        let m = &deformer.bind_matrices()[joint];
        [m[8], m[9], m[10]]
    };
    let ahead = [0, 1, 2].map(|k| rest[joint][k] + direction[k]);
    let kept = [
        FitConstraint::joint_direction(joint, axes, direction),
        FitConstraint::joint_aim(joint, axes, ahead),
        FitConstraint::point_position(0, at_rest),
        FitConstraint::point_distance([0, 1], [0.0, 1e6]),
    ];
    let frame = FitFrame { constraints: &kept, ..Default::default() };
    let result = fit.solve(&frame, &mut out).unwrap();
    assert!(result.constraint_worst < 1e-3, "{result:?}");
    let missing = [FitConstraint::joint_position(joint, [f32::NAN; 3])];
    let frame = FitFrame { constraints: &missing, ..Default::default() };
    assert_eq!(fit.solve(&frame, &mut out).unwrap().status, FitStatus::NO_DATA);
}

#[test]
fn stages_move_controls_one_after_the_other() {
    let (rig, _) = made();
    let face = posed(&rig);
    let mut fit = Fit::new(&rig).unwrap();
    let raw = face.raw_controls().len();
    // The last stage may take no more steps than the first, so with one step each, stages take more of them.
    let stages: Vec<u32> = (0..raw as u32).map(|i| i % 4).collect();
    let joints = Some(face.joints());
    let mut out = vec![0.0; raw];
    let one = FitFrame { joints, max_iterations: 1, ..Default::default() };
    assert_eq!(fit.solve(&one, &mut out).unwrap().iterations, 1);
    let staged = FitFrame { stages: Some(&stages), ..one };
    assert!(fit.solve(&staged, &mut out).unwrap().iterations > 1);
    // All that moved is in the first stage, so the others have nothing to explain.
    let staged = FitFrame { stages: Some(&stages), joints, ..Default::default() };
    fit.solve(&staged, &mut out).unwrap();
    let moved = (0..raw).filter(|i| out[*i] > 0.01).all(|i| i % 4 == 0);
    assert!(moved && out[0] > 0.3, "{out:?}");
}

#[test]
fn frames_of_a_motion() {
    const FRAMES: usize = 8;
    let (rig, _) = made();
    let (joints, controls) = motion(&rig, FRAMES);
    let mut fit = Fit::new(&rig).unwrap();
    let observed = fit.observability().unwrap();
    let raw = observed.len();
    let mut out = vec![0.0; FRAMES * raw];
    let frames = FitFrame { joints: Some(&joints), max_iterations: 200, ..Default::default() };
    let results = fit.solve_frames(&frames, FRAMES, &mut out).unwrap();
    assert_eq!(results.len(), FRAMES);
    assert!(results.iter().all(|result| result.joint_residual < 0.01));
    for (i, value) in out.iter().enumerate() {
        assert!(observed[i % raw] < 0.05 || (value - controls[i]).abs() < 0.01, "{i}");
    }
    assert!(fit.solve_frames(&FitFrame::default(), 0, &mut []).unwrap().is_empty());
    // Stopped at the third question: all later frames stay where that one was.
    let mut left = 2;
    let stop = || {
        left -= 1;
        left < 0
    };
    let results = fit.solve_frames_until(&frames, FRAMES, &mut out, stop).unwrap();
    let canceled = |result: &&mien::FitResult| result.status == FitStatus::CANCELED;
    assert!(results.iter().filter(canceled).count() >= FRAMES - 2);
    assert_eq!(out[(FRAMES - 1) * raw..], out[(FRAMES - 2) * raw..(FRAMES - 1) * raw]);
    // A panic in one frame comes out; no other frame asks.
    let mut asked = 0;
    let panic = catch_unwind(AssertUnwindSafe(|| {
        let _ = fit.solve_frames_until(&frames, FRAMES, &mut out, || {
            asked += 1;
            panic!("stop")
        });
    }));
    assert!(panic.is_err() && asked == 1);
}

#[test]
fn wrong_constraints_stages_and_frames_are_errors() {
    let (rig, deformer) = made();
    let raw = rig.count(Kind::RAW_CONTROL);
    let mut out = vec![0.0; 2 * raw];
    let point = [FitPoint::from(0)];
    let options = FitOptions { deformer: Some(&deformer), points: &point, ..Default::default() };
    let mut fit = options.create(&rig).unwrap();
    let mut solve = |constraints: &[FitConstraint]| {
        let frame = FitFrame { constraints, ..Default::default() };
        fit.solve(&frame, &mut out[..raw])
    };
    let wrong = Status::INVALID_ARGUMENT;
    let place = [0.0; 3];
    let good = FitConstraint::joint_position(0, place);
    fails(Status::INDEX, solve(&[FitConstraint::joint_position(usize::MAX, place)]));
    fails(Status::INDEX, solve(&[FitConstraint::point_position(1, place)]));
    fails(Status::INDEX, solve(&[FitConstraint::point_distance([0, 1], [0.0, 1.0])]));
    fails(wrong, solve(&[FitConstraint::joint_aim(0, [0.0; 3], place)]));
    fails(wrong, solve(&[FitConstraint::joint_direction(0, [1.0, 0.0, 0.0], place)]));
    fails(wrong, solve(&[FitConstraint::point_distance([0, 0], [2.0, 1.0])]));
    fails(wrong, solve(&[FitConstraint { kind: FitConstraintKind(77), ..good }]));
    fails(wrong, solve(&[FitConstraint { weight: -1.0, ..good }]));
    fails(wrong, solve(&[FitConstraint { weight: f32::NAN, ..good }]));
    fails(wrong, solve(&[good; FitConstraint::MOST + 1]));
    assert!(solve(&[good; FitConstraint::MOST]).is_ok());
    let bare = FitFrame { constraints: &[good], ..Default::default() };
    fails(Status::NULL_ARGUMENT, Fit::new(&rig).unwrap().solve(&bare, &mut out[..raw]));

    let mut fit = Fit::new(&rig).unwrap();
    let empty = FitFrame::default();
    fails(wrong, fit.solve(&FitFrame { stages: Some(&[0]), ..empty }, &mut out[..raw]));
    let late = vec![16; raw];
    fails(wrong, fit.solve(&FitFrame { stages: Some(&late), ..empty }, &mut out[..raw]));
    let (joints, _) = motion(&rig, 2);
    let frames = FitFrame { joints: Some(&joints), ..empty };
    fails(wrong, fit.solve_frames(&frames, 1, &mut out[..raw]));
    fails(wrong, fit.solve_frames(&frames, 3, &mut out));
    fails(wrong, fit.solve_frames(&frames, 2, &mut out[1..]));
    fails(wrong, fit.solve_frames(&empty, usize::MAX, &mut out));
    fails(wrong, fit.solve_frames(&FitFrame { start: Some(&joints[..1]), ..frames }, 2, &mut out));
    assert!(fit.solve_frames(&frames, 2, &mut out).is_ok());
}

#[test]
fn wrong_arguments_are_errors() {
    let (rig, deformer) = made();
    let raw = rig.count(Kind::RAW_CONTROL);
    let face = posed(&rig);
    let with = |options: FitOptions<'_>| options.create(&rig);
    let base = FitOptions::default();
    let point = [FitPoint::from(0)];
    fails(Status::LOD, with(FitOptions { lod: 99, ..base }));
    fails(Status::INDEX, with(FitOptions { controls: Some(&[raw as u32]), ..base }));
    fails(Status::INVALID_ARGUMENT, with(FitOptions { controls: Some(&[3, 1]), ..base }));
    fails(Status::INVALID_ARGUMENT, with(FitOptions { lower: Some(&[0.0]), ..base }));
    fails(Status::INVALID_ARGUMENT, with(FitOptions { upper: Some(&[]), ..base }));
    fails(Status::INVALID_ARGUMENT, with(FitOptions { joint_weights: Some(&[1.0]), ..base }));
    fails(Status::INDEX, with(FitOptions { symmetric: &[[0, raw as u32]], ..base }));
    assert!(with(FitOptions { points: &point, ..base }).is_err());
    let far = [FitPoint { mesh: None, positions: [usize::MAX, 0, 0], weights: [1.0, 0.0, 0.0] }];
    let deformer = Some(&deformer);
    fails(Status::INDEX, with(FitOptions { deformer, points: &far, ..base }));
    fails(Status::INDEX, with(FitOptions { deformer, points: &point, mesh: 99, ..base }));
    let other = [FitPoint { mesh: Some(99), ..point[0] }];
    fails(Status::INDEX, with(FitOptions { deformer, points: &other, ..base }));
    let both = [FitPoint { mesh: Some(1), ..point[0] }, point[0]];
    assert!(with(FitOptions { deformer, points: &both, ..base }).is_ok());

    let mut fit = with(FitOptions { deformer, points: &point, ..base }).unwrap();
    let mut out = vec![0.0; raw];
    let empty = FitFrame::default();
    let two = [[0.0; 3]; 2];
    let wrong = Status::INVALID_ARGUMENT;
    let lengths = [
        FitFrame { joints: Some(&face.joints()[1..]), ..empty },
        FitFrame { points: Some(&two), ..empty },
        FitFrame { images: Some(&[]), ..empty },
        FitFrame { point_weights: Some(&[1.0, 1.0]), ..empty },
        FitFrame { start: Some(&[0.0]), ..empty },
        FitFrame { prior: Some(&[]), ..empty },
        FitFrame { points: Some(&two[..1]), sparse_weight: -1.0, ..empty },
        FitFrame { points: Some(&two[..1]), smooth_weight: f32::NAN, ..empty },
    ];
    for frame in &lengths {
        fails(wrong, fit.solve(frame, &mut out));
    }
    let images = FitFrame { images: Some(&[[0.0; 2]]), ..empty };
    fails(Status::NULL_ARGUMENT, fit.solve(&images, &mut out));
    fails(wrong, fit.solve(&empty, &mut out[1..]));

    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    fails(Status::INDEX, FitSurface::new(&corners, &[[0, 1, 3]]));
    fails(wrong, FitSurface::new(&corners, &[]));
    fails(wrong, FitSurface::new(&[[f32::NAN; 3]; 3], &[[0, 1, 2]]));
}

#[test]
fn a_solve_can_be_stopped() {
    let (rig, _) = made();
    let face = posed(&rig);
    let mut fit = Fit::new(&rig).unwrap();
    let mut out = vec![0.0; face.raw_controls().len()];
    let frame = FitFrame { joints: Some(face.joints()), ..Default::default() };
    let mut asked = 0;
    let result = fit.solve_until(&frame, &mut out, || {
        asked += 1;
        asked > 1
    });
    assert_eq!(result.unwrap().status, FitStatus::CANCELED);
    assert_eq!(asked, 2);
    // A panic comes out, and the fit can be used again.
    let panic = catch_unwind(AssertUnwindSafe(|| {
        let _ = fit.solve_until(&frame, &mut out, || panic!("stop"));
    }));
    assert!(panic.is_err());
    assert_eq!(fit.solve(&frame, &mut out).unwrap().status, FitStatus::CONVERGED);
}

#[derive(Clone, Default)]
struct Counted(Arc<AtomicUsize>);

// SAFETY: as the system allocator.
unsafe impl GlobalAlloc for Counted {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        self.0.fetch_add(1, Ordering::Relaxed);
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        self.0.fetch_sub(1, Ordering::Relaxed);
        unsafe { System.dealloc(block, layout) }
    }
}

#[test]
fn fits_outlive_what_they_were_made_of() {
    let live = Counted::default();
    let memory = Allocator::new(live.clone());
    let (mut fit, target) = {
        let (rig, deformer) = made();
        let target = positions(&deformer, &posed(&rig));
        let options = FitOptions {
            deformer: Some(&deformer),
            points: &every_position(target.len()),
            allocator: Some(&memory),
            ..Default::default()
        };
        (options.create(&rig).unwrap(), target)
    };
    let surface = FitSurface::new_in(&target, &[[0, 1, 2]], &memory).unwrap();
    drop(memory);
    assert!(live.0.load(Ordering::Relaxed) >= 2);
    let mut out = vec![0.0; fit.rig().count(Kind::RAW_CONTROL)];
    // On another thread, with what does not move.
    std::thread::scope(|scope| {
        scope.spawn(|| {
            let frame = FitFrame { points: Some(&target), ..Default::default() };
            fit.solve(&frame, &mut out).unwrap();
        });
    });
    assert!(out.iter().any(|value| *value > 0.1));
    drop((fit, surface));
    assert_eq!(live.0.load(Ordering::Relaxed), 0);
}

#[test]
fn keys_of_a_curve() {
    let curve = [0.0, 0.25, 0.5, 0.75, 1.0, 0.5, 0.0];
    assert_eq!(reduce_keys(&curve, 0.001).unwrap(), [0, 4, 6]);
    assert_eq!(reduce_keys(&[], 0.1).unwrap(), []);
    fails(Status::INVALID_ARGUMENT, reduce_keys(&curve, -1.0));
    fails(Status::INVALID_ARGUMENT, reduce_keys(&[f32::NAN], 0.1));
}
