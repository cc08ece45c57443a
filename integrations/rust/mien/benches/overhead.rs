// SPDX-License-Identifier: MIT
//! What the safe crate costs over the C functions: the same frames on the same instance, through
//! either. Prints the shortest of many rounds, since everything else is the machine's doing.

use mien::{Dna, Instance, Preset, Rig};
use mien_sys as sys;
use std::ptr::{null, null_mut, read_volatile};
use std::time::Instant;

const ROUNDS: usize = 300;

/// Reads a value in a way that cannot be left out.
fn used(value: &f32) {
    // SAFETY: a reference may be read.
    unsafe { read_volatile(value) };
}

/// Shortest time of a frame by each of two ways, in nanoseconds. They take turns.
fn shortest(frames: usize, mut one: impl FnMut(usize), mut other: impl FnMut(usize)) -> [f64; 2] {
    let mut least = [f64::INFINITY; 2];
    for round in 0..2 * ROUNDS {
        let start = Instant::now();
        for frame in 0..frames {
            if round % 2 == 0 {
                one(frame)
            } else {
                other(frame)
            }
        }
        let time = start.elapsed().as_secs_f64() * 1e9 / frames as f64;
        least[round % 2] = least[round % 2].min(time);
    }
    least
}

fn compare(name: &str, preset: Preset, frames: usize) {
    let dna = Dna::generate(preset).unwrap();
    let rig = Rig::new(&dna).unwrap();
    let mut face: Instance = rig.instance().unwrap();

    // SAFETY: the life of a rig in C, with arguments that are right.
    let (c_rig, c_face, controls, joints) = unsafe {
        let desc = sys::MienGenerateDesc { preset: preset.0, ..Default::default() };
        let (mut dna, mut rig, mut face) = (null_mut(), null_mut(), null_mut());
        let mut status = sys::mien_dna_generate(&desc, &mut dna, null_mut());
        status |= sys::mien_rig_create(dna, null(), &mut rig, null_mut());
        status |= sys::mien_instance_create(rig, null(), &mut face, null_mut());
        let mut controls = sys::MienMutableFloatView::default();
        let mut joints = sys::MienFloatView::default();
        status |= sys::mien_instance_raw_controls(face, &mut controls);
        status |= sys::mien_instance_joints(face, &mut joints);
        assert_eq!(status, sys::MIEN_OK);
        sys::mien_dna_close(dna);
        (rig, face, controls, joints)
    };

    let [safe, c] = shortest(
        frames,
        |frame| {
            face.raw_controls_mut()[0] = frame as f32;
            face.evaluate(0).unwrap();
            used(&face.joints()[0]);
        },
        // SAFETY: views stay valid while the instance lives.
        |frame| unsafe {
            *controls.data = frame as f32;
            assert_eq!(sys::mien_rig_evaluate(c_rig, c_face, 0), sys::MIEN_OK);
            used(&*joints.data);
        },
    );
    println!("{name:<8} C {c:10.1} ns   mien {safe:10.1} ns   {:+.1} ns", safe - c);

    // SAFETY: destroyed once.
    unsafe {
        sys::mien_instance_destroy(c_face);
        sys::mien_rig_destroy(c_rig);
    }
}

fn main() {
    println!("controls written, evaluated and read, per frame; shortest of {ROUNDS} rounds");
    compare("tiny", Preset::TINY, 2000);
    compare("small", Preset::SMALL, 200);
    compare("large", Preset::LARGE, 2);
}
