// SPDX-License-Identifier: MIT
//! From a DNA file to poses, as users do it; and what they may do wrong.

use mien::{
    Batch, Dna, Instance, Isa, Kind, Preset, Rig, RigOptions, RotationOutput, Stages, Status,
    Storage,
};
use mien_sys as sys;
use std::ptr::{null, null_mut};

fn rig(preset: Preset) -> Rig {
    Rig::new(&Dna::generate(preset).unwrap()).unwrap()
}

/// Controls that differ from each other and from frame to frame.
fn drive(face: &mut Instance, frame: usize) {
    for (i, control) in face.raw_controls_mut().iter_mut().enumerate() {
        *control = ((i * 7 + frame * 13) % 11) as f32 / 10.0;
    }
}

fn bits(values: &[f32]) -> Vec<u32> {
    values.iter().map(|value| value.to_bits()).collect()
}

fn outputs(face: &Instance) -> Vec<u32> {
    let outputs = [face.controls(), face.joints(), face.blend_shapes(), face.animated_maps()];
    outputs.iter().flat_map(|values| bits(values)).collect()
}

#[test]
fn types_cross_threads() {
    fn send_and_sync<T: Send + Sync + 'static>() {}
    send_and_sync::<Dna<'static>>();
    send_and_sync::<Rig>();
    send_and_sync::<Instance>();
    send_and_sync::<mien::Batch>();
    send_and_sync::<mien::Deformer>();
    send_and_sync::<mien::DeformerInstance>();
    send_and_sync::<mien::Report>();
    send_and_sync::<mien::Allocator>();
    send_and_sync::<mien::Error>();
}

#[test]
fn gives_what_c_gives() {
    let rig = rig(Preset::SMALL);
    let mut face = rig.instance().unwrap();
    drive(&mut face, 3);
    face.ml_masks_mut().fill(0.5);
    face.evaluate(1).unwrap();

    // SAFETY: the life of a rig in C, with arguments that are right.
    let expected = unsafe {
        let desc = sys::MienGenerateDesc { preset: sys::MIEN_PRESET_SMALL, ..Default::default() };
        let (mut dna, mut rig, mut instance) = (null_mut(), null_mut(), null_mut());
        assert_eq!(sys::mien_dna_generate(&desc, &mut dna, null_mut()), sys::MIEN_OK);
        assert_eq!(sys::mien_rig_create(dna, null(), &mut rig, null_mut()), sys::MIEN_OK);
        assert_eq!(sys::mien_instance_create(rig, null(), &mut instance, null_mut()), 0);
        let mut inputs = sys::MienMutableFloatView::default();
        assert_eq!(sys::mien_instance_raw_controls(instance, &mut inputs), sys::MIEN_OK);
        std::slice::from_raw_parts_mut(inputs.data, inputs.count)
            .copy_from_slice(face.raw_controls());
        assert_eq!(sys::mien_instance_ml_masks(instance, &mut inputs), sys::MIEN_OK);
        if inputs.count > 0 {
            std::slice::from_raw_parts_mut(inputs.data, inputs.count).fill(0.5);
        }
        assert_eq!(sys::mien_rig_evaluate(rig, instance, 1), sys::MIEN_OK);
        let mut expected = Vec::new();
        for get in [
            sys::mien_instance_controls,
            sys::mien_instance_joints,
            sys::mien_instance_blend_shapes,
            sys::mien_instance_animated_maps,
        ] {
            let mut view = sys::MienFloatView::default();
            assert_eq!(get(instance, &mut view), sys::MIEN_OK);
            if view.count > 0 {
                expected.extend(bits(std::slice::from_raw_parts(view.data, view.count)));
            }
        }
        sys::mien_instance_destroy(instance);
        sys::mien_rig_destroy(rig);
        sys::mien_dna_close(dna);
        expected
    };
    assert_eq!(outputs(&face), expected);
    assert!(face.joints().iter().any(|value| *value != 0.0));
}

#[test]
fn an_instance_keeps_its_rig() {
    let dna = Dna::generate(Preset::TINY).unwrap();
    let rig = Rig::new(&dna).unwrap();
    drop(dna);
    let again = rig.clone();
    let mut face = rig.instance().unwrap();
    assert!(face.rig().ptr_eq(&again));
    drop(rig);
    drop(again);
    drive(&mut face, 0);
    face.evaluate(0).unwrap();
    let moved = std::thread::spawn(move || {
        face.evaluate(1).unwrap();
        face.joints().len()
    });
    assert_eq!(moved.join().unwrap() % 9, 0);
}

#[test]
fn one_rig_serves_many_threads() {
    let rig = rig(Preset::SMALL);
    let mut alone = rig.instance().unwrap();
    let expected: Vec<Vec<u32>> = (0..8)
        .map(|frame| {
            drive(&mut alone, frame);
            alone.evaluate(frame % 2).unwrap();
            outputs(&alone)
        })
        .collect();
    std::thread::scope(|threads| {
        for _ in 0..8 {
            threads.spawn(|| {
                for _ in 0..20 {
                    let mut face = rig.instance().unwrap();
                    for (frame, expected) in expected.iter().enumerate() {
                        drive(&mut face, frame);
                        face.evaluate(frame % 2).unwrap();
                        assert_eq!(&outputs(&face), expected);
                    }
                }
            });
        }
    });
    // Several threads may read one instance.
    std::thread::scope(|threads| {
        for _ in 0..4 {
            threads.spawn(|| assert_eq!(&outputs(&alone), expected.last().unwrap()));
        }
    });
}

#[test]
fn names_and_numbers_belong_together() {
    let rig = rig(Preset::SMALL);
    let kinds = [Kind::GUI_CONTROL, Kind::RAW_CONTROL, Kind::JOINT, Kind::BLEND_SHAPE_CHANNEL];
    for kind in kinds {
        assert!(rig.count(kind) > 0, "{kind:?}");
        for i in 0..rig.count(kind) {
            let name = rig.name(kind, i).unwrap();
            let found = rig.find(kind, &*name).unwrap();
            assert_eq!(rig.name(kind, found).unwrap(), name);
            assert_eq!(rig.find(kind, rig.name_bytes(kind, i).unwrap()).unwrap(), found);
        }
    }
    assert_eq!(rig.joint_parents().len(), rig.count(Kind::JOINT));
    assert_eq!(rig.neutral_joint_values().len(), rig.info().joint_value_count);
    assert_eq!(rig.initial_raw_controls().len(), rig.count(Kind::RAW_CONTROL));
    let psd = rig.psd_inputs(0).unwrap();
    assert!(psd.iter().all(|control| usize::from(*control) < rig.info().control_count));
    assert_eq!(
        rig.lod_indices(Kind::JOINT, 0).unwrap().len(),
        rig.statistics(0).unwrap().joint_count
    );
}

#[test]
fn only_variable_joint_values_change() {
    let rig = rig(Preset::SMALL);
    let mut face = rig.instance().unwrap();
    let before = face.joints().to_vec();
    for lod in 0..rig.info().lod_count {
        let variable = rig.variable_joint_values(lod).unwrap();
        drive(&mut face, lod);
        face.evaluate(lod).unwrap();
        for (i, value) in face.joints().iter().enumerate() {
            if variable.binary_search(&(i as u16)).is_err() {
                assert_eq!(value.to_bits(), before[i].to_bits(), "LOD {lod}, value {i}");
            }
        }
    }
}

#[test]
fn stages_one_by_one_give_the_whole() {
    let rig = rig(Preset::SMALL);
    let (mut whole, mut parts) = (rig.instance().unwrap(), rig.instance().unwrap());
    drive(&mut whole, 1);
    drive(&mut parts, 1);
    whole.evaluate(0).unwrap();
    parts.evaluate_stages(0, Stages::ML | Stages::RBF | Stages::PSD).unwrap();
    assert!(parts.joints().iter().all(|value| *value == 0.0));
    parts.evaluate_stages(0, Stages::JOINTS).unwrap();
    parts.evaluate_stages(0, Stages::BLEND_SHAPES | Stages::ANIMATED_MAPS).unwrap();
    assert_eq!(outputs(&parts), outputs(&whole));

    for group in 0..rig.count(Kind::JOINT_GROUP) {
        parts.evaluate_joint_group(0, group).unwrap();
    }
    for solver in 0..rig.count(Kind::RBF_SOLVER) {
        parts.evaluate_rbf_solver(0, solver).unwrap();
    }
    for setup in 0..rig.count(Kind::TWIST_SWING) {
        parts.evaluate_twist_swing(0, setup).unwrap();
    }
    assert_eq!(bits(parts.controls()), bits(whole.controls()));

    parts.reset().unwrap();
    let fresh = rig.instance().unwrap();
    assert_eq!(outputs(&parts), outputs(&fresh));
    assert_eq!(bits(parts.raw_controls()), bits(rig.initial_raw_controls()));
}

#[test]
fn batches_give_the_same_bits() {
    let rig = rig(Preset::SMALL);
    let lods = rig.info().lod_count;
    let faces = || -> Vec<Instance> {
        let mut faces: Vec<_> = (0..70).map(|_| rig.instance().unwrap()).collect();
        faces.iter_mut().enumerate().for_each(|(i, face)| drive(face, i));
        faces
    };
    let all = |faces: &[Instance]| faces.iter().map(outputs).collect::<Vec<_>>();

    let mut one_by_one = faces();
    one_by_one.iter_mut().for_each(|face| face.evaluate(1).unwrap());
    let mut batch = Batch::new(&rig, 70).unwrap();
    let mut together = faces();
    batch.evaluate(&mut together, 1).unwrap();
    assert!(all(&together) == all(&one_by_one));

    for (i, face) in one_by_one.iter_mut().enumerate() {
        face.evaluate(i % lods).unwrap();
    }
    let mut batch = Batch::with_tasks(&rig, 70, 4).unwrap();
    assert!(Batch::bytes(&rig, 70, 4).unwrap() > Batch::bytes(&rig, 70, 1).unwrap());
    let mut threaded = faces();
    let each = threaded.iter_mut().enumerate().map(|(i, face)| (face, i % lods));
    batch
        .evaluate_each_on(each, Stages::ALL, |_, work| {
            std::thread::scope(|threads| {
                for _ in 0..4 {
                    threads.spawn(work);
                }
            });
        })
        .unwrap();
    assert!(all(&threaded) == all(&one_by_one));

    // What is not right in one of them is done to none.
    let before = all(&threaded);
    let each = threaded.iter_mut().enumerate().map(|(i, face)| (face, i));
    assert_eq!(batch.evaluate_each(each, Stages::ALL).unwrap_err().status(), Status::LOD);
    let mut foreign = self::rig(Preset::SMALL).instance().unwrap();
    let mixed = threaded.iter_mut().take(3).chain([&mut foreign]);
    assert_eq!(batch.evaluate(mixed, 0).unwrap_err().status(), Status::MISMATCH);
    let mut small = Batch::new(&rig, 2).unwrap();
    assert_eq!(small.evaluate(&mut threaded, 0).unwrap_err().status(), Status::INVALID_ARGUMENT);
    assert!(all(&threaded) == before);
    assert!(Batch::new(&rig, usize::MAX).is_err());
    assert!(Batch::new(&rig, usize::MAX).is_err());
    small.evaluate([], 0).unwrap();
    drop(rig);
    small.evaluate(threaded.iter_mut().take(2), 0).unwrap();
}

#[test]
fn gui_controls_become_raw_controls() {
    let rig = rig(Preset::SMALL);
    let mut face = rig.instance().unwrap();
    let before = face.raw_controls().to_vec();
    face.gui_controls_mut().fill(0.75);
    assert!(face.gui_controls().iter().all(|value| *value == 0.75));
    face.map_gui_to_raw().unwrap();
    assert_ne!(face.raw_controls(), &before[..]);
    assert_eq!(face.controls()[..before.len()], *face.raw_controls());
    face.map_raw_to_gui().unwrap();
}

#[test]
fn options_reach_the_library() {
    let dna = Dna::generate(Preset::TINY).unwrap();
    for isa in [Isa::SCALAR, Isa::SSE2, Isa::AVX2, Isa::AVX512, Isa::NEON] {
        let rig = RigOptions::new().isa(isa).create(&dna);
        match rig {
            Ok(rig) => assert_eq!(rig.info().isa, isa),
            Err(error) => assert_eq!(error.status(), Status::ISA),
        }
        assert_eq!(RigOptions::new().isa(isa).create(&dna).is_ok(), isa.is_available());
    }
    assert_eq!(Isa::SCALAR.name(), "scalar");
    assert_eq!(Isa(99).name(), "unknown");
    let rig = RigOptions::new().rotation(RotationOutput::QUATERNION).create(&dna).unwrap();
    assert_eq!(rig.info().rotation_output, RotationOutput::QUATERNION);
    let face = rig.instance().unwrap();
    assert!(face.joints().chunks_exact(10).all(|joint| joint[3..7] == [0.0, 0.0, 0.0, 1.0]));
    let rig = RigOptions::new().storage(Storage::BIT_16).create(&dna).unwrap();
    assert_eq!(rig.info().storage, Storage::BIT_16);
    let error = RigOptions::new().rotation(RotationOutput(7)).create(&dna).unwrap_err();
    assert_eq!(error.status(), Status::INVALID_ARGUMENT);
}

#[test]
fn what_is_not_there_is_an_error() {
    let rig = rig(Preset::TINY);
    let mut face = rig.instance().unwrap();
    let lods = rig.info().lod_count;
    for lod in [lods, usize::MAX, u32::MAX as usize + 1] {
        assert_eq!(face.evaluate(lod).unwrap_err().status(), Status::LOD);
        assert_eq!(rig.statistics(lod).unwrap_err().status(), Status::LOD);
    }
    let past = rig.count(Kind::JOINT);
    for i in [past, usize::MAX] {
        assert_eq!(rig.name(Kind::JOINT, i).unwrap_err().status(), Status::INDEX);
        assert_eq!(rig.psd_inputs(i).unwrap_err().status(), Status::INDEX);
        assert_eq!(face.evaluate_joint_group(0, i).unwrap_err().status(), Status::INDEX);
    }
    assert_eq!(rig.count(Kind(77)), 0);
    assert_eq!(rig.name(Kind(77), 0).unwrap_err().status(), Status::INVALID_ARGUMENT);
    assert!(rig.lod_indices(Kind::GUI_CONTROL, 0).is_err());
    assert!(face.evaluate_stages(0, Stages(1 << 20)).is_err());

    let error = rig.find(Kind::JOINT, "no such joint").unwrap_err();
    assert_eq!(error.status(), Status::NAME);
    assert_eq!(error.to_string(), "NAME: no Kind::JOINT is named \"no such joint\"");
    assert!(rig.find(Kind::JOINT, b"\xff\0").is_err());
    assert!(rig.find(Kind::JOINT, "").is_err());
}

#[test]
fn any_number_may_be_written() {
    // What comes out is of no use, but safe code cannot be asked to write finite numbers only.
    for preset in [Preset::TINY, Preset::SMALL, Preset::MEDIUM] {
        let rig = rig(preset);
        let mut face = rig.instance().unwrap();
        for odd in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN_POSITIVE / 2.0] {
            for part in 1..4 {
                let every = |values: &mut [f32]| {
                    values.iter_mut().step_by(part).for_each(|value| *value = odd);
                };
                every(face.gui_controls_mut());
                every(face.ml_masks_mut());
                face.map_gui_to_raw().unwrap();
                every(face.raw_controls_mut());
                face.map_raw_to_gui().unwrap();
                for lod in 0..rig.info().lod_count {
                    face.evaluate(lod).unwrap();
                }
                face.reset().unwrap();
            }
        }
        // Nothing of it stays.
        face.evaluate(0).unwrap();
        let mut fresh = rig.instance().unwrap();
        fresh.evaluate(0).unwrap();
        assert_eq!(outputs(&face), outputs(&fresh));
    }
}

#[test]
fn numbers_have_names() {
    assert_eq!(format!("{:?}", Kind::RAW_CONTROL), "Kind::RAW_CONTROL");
    assert_eq!(format!("{:?}", Kind(77)), "Kind(77)");
    assert_eq!(format!("{:?}", Stages::ML | Stages::PSD), "Stages(0x5: ML | PSD)");
    assert!(Stages::ALL.contains(Stages::JOINTS));
    assert!(!Stages::JOINTS.contains(Stages::ALL));
    assert_eq!(Status::DNA_TRUNCATED.to_string(), "DNA_TRUNCATED");
    assert_eq!(Status(12345).name(), "UNKNOWN");
    assert_eq!(mien::version().0, sys::MIEN_VERSION_MAJOR);
}

#[test]
fn options_that_reach_the_library() {
    let dna = Dna::generate(Preset::TINY).unwrap();
    let rig = RigOptions::new().arithmetic(mien::Arithmetic::PORTABLE).create(&dna).unwrap();
    let mut bytes = rig.to_baked_bytes(None).unwrap();
    let full = mien::BakedOptions::new().check(mien::BakedCheck::FULL);
    assert!(full.open_reader(&mut std::io::Cursor::new(&bytes)).is_ok());

    // A changed number at the end: only the full check reads it.
    *bytes.last_mut().unwrap() ^= 1;
    assert!(mien::Baked::from_reader(&mut std::io::Cursor::new(&bytes)).unwrap().rig().is_ok());
    let error = full.open_reader(&mut std::io::Cursor::new(&bytes)).unwrap_err();
    assert_eq!(error.status(), mien::Status::BAKED_CHECKSUM);
}

#[test]
fn names_of_a_kind_in_order() {
    let rig = Rig::new(&Dna::generate(Preset::TINY).unwrap()).unwrap();
    let names: Vec<_> = rig.names(Kind::JOINT).collect();
    assert_eq!(names.len(), rig.count(Kind::JOINT));
    for (i, name) in names.iter().enumerate() {
        assert_eq!(rig.find(Kind::JOINT, name.as_bytes()).unwrap(), i);
    }
}

#[test]
fn errors_as_io_errors() {
    let error = Dna::from_bytes(b"not a rig").unwrap_err();
    let io = std::io::Error::from(error.clone());
    assert_eq!(io.kind(), std::io::ErrorKind::InvalidData);
    assert_eq!(io.get_ref().unwrap().downcast_ref::<mien::Error>(), Some(&error));
}
