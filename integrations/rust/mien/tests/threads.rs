// SPDX-License-Identifier: MIT
//! What may be shared between threads or sent to others, on threads that sanitizers know: those of
//! std join by calls that std compiles without them, so `check.sh` runs this file with the thread
//! sanitizer and the library compiled with it.
#![cfg(unix)]

use mien::{
    ClipOptions, Deformer, DeformerInstance, Dna, Instance, LayerGroup, MixLayer, MixOptions,
    Normals, Preset, Rig,
};
use std::os::raw::{c_int, c_void};
use std::sync::Arc;

extern "C" {
    fn pthread_create(
        thread: *mut usize,
        attributes: *const c_void,
        start: extern "C" fn(*mut c_void) -> *mut c_void,
        argument: *mut c_void,
    ) -> c_int;
    fn pthread_join(thread: usize, result: *mut *mut c_void) -> c_int;
}

type Job<'a> = Box<dyn FnOnce() + Send + 'a>;

extern "C" fn run_job(argument: *mut c_void) -> *mut c_void {
    let job = unsafe { Box::from_raw(argument.cast::<Job>()) };
    job();
    std::ptr::null_mut()
}

/// Runs each job on a thread of its own, all at the same time.
fn run(jobs: Vec<Job<'_>>) {
    let threads: Vec<usize> = jobs
        .into_iter()
        .map(|job| {
            let mut thread = 0;
            let argument = Box::into_raw(Box::new(job)).cast();
            let status =
                unsafe { pthread_create(&mut thread, std::ptr::null(), run_job, argument) };
            assert_eq!(status, 0);
            thread
        })
        .collect();
    for thread in threads {
        assert_eq!(unsafe { pthread_join(thread, std::ptr::null_mut()) }, 0);
    }
}

const THREADS: usize = 4;

struct Head {
    rig: Rig,
    deformer: Deformer,
}

fn head() -> Head {
    let dna = Dna::generate(Preset::SMALL).unwrap();
    let rig = Rig::new(&dna).unwrap();
    let deformer = Deformer::new(&dna, &rig).unwrap();
    Head { rig, deformer }
}

fn pose(face: &mut Instance, value: f32) -> Vec<u32> {
    face.raw_controls_mut().fill(value);
    face.evaluate(0).unwrap();
    face.joints().iter().map(|value| value.to_bits()).collect()
}

fn mesh(deformer: &Deformer, face: &Instance) -> Vec<u32> {
    let mut vertices: DeformerInstance = DeformerInstance::new(deformer).unwrap();
    vertices.update(face).unwrap();
    vertices.deform(0, Normals::NONE).unwrap();
    let positions = vertices.positions(0).unwrap();
    positions.iter().flatten().map(|value| value.to_bits()).collect()
}

#[test]
fn rigs_and_deformers_are_shared() {
    let head = head();
    let mut face = head.rig.instance().unwrap();
    let expected = pose(&mut face, 0.5);
    let expected_mesh = mesh(&head.deformer, &face);
    let job = || {
        for _ in 0..10 {
            let mut face = head.rig.instance().unwrap();
            assert!(pose(&mut face, 0.5) == expected);
            assert!(mesh(&head.deformer, &face) == expected_mesh);
        }
    };
    run((0..THREADS).map(|_| Box::new(job) as Job).collect());
}

#[test]
fn instances_move_to_other_threads_and_outlive_what_made_them() {
    let head = head();
    let mut faces: Vec<Instance> = (0..THREADS).map(|_| head.rig.instance().unwrap()).collect();
    let expected = pose(&mut faces[0], 0.25);
    let mut results: Vec<Vec<u32>> = vec![Vec::new(); THREADS];
    let jobs = faces.into_iter().zip(&mut results).map(|(mut face, result)| {
        Box::new(move || *result = pose(&mut face, 0.25)) as Job // destroyed here
    });
    let mut jobs: Vec<Job> = jobs.collect();
    jobs.push(Box::new(move || drop(head)));
    run(jobs);
    assert!(results.iter().all(|result| *result == expected));
}

#[test]
fn clips_are_shared_and_released_by_any_thread() {
    let values: Vec<f32> = (0..120).map(|frame| frame as f32 / 120.0).collect();
    let clip = Arc::new(ClipOptions::new(&["jawOpen"]).build(&values).unwrap());
    let jobs = (0..THREADS).map(|_| {
        let clip = Arc::clone(&clip);
        Box::new(move || {
            let mut player = clip.player().unwrap();
            for _ in 0..60 {
                assert_eq!(player.sample(), [0.0]);
            }
            drop(clip);
            assert_eq!(player.sample(), [0.0]);
        }) as Job
    });
    let mut jobs: Vec<Job> = jobs.collect();
    jobs.push(Box::new(move || drop(clip)));
    run(jobs);
}

#[test]
fn packets_are_pushed_while_the_mixer_steps() {
    let head = head();
    let mix = MixOptions::new()
        .layer(MixLayer::stream(LayerGroup::SPEECH, &[0]))
        .create(&head.rig)
        .unwrap();
    let mut mixer = mix.mixer(0).unwrap();
    let mut sender = mixer.sender().unwrap();
    let mut taken = 0;
    run(vec![
        Box::new(|| taken = (0..300).filter(|i| sender.push(0, i * 1000, &[0.5]).unwrap()).count()),
        Box::new(|| {
            for _ in 0..300 {
                mixer.step(1000, None).unwrap();
            }
        }),
    ]);
    assert!(taken > 0);
}
