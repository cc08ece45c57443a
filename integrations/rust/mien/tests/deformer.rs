// SPDX-License-Identifier: MIT
//! From a pose of joints to meshes, and between coordinate systems.

use mien::{
    CoordinateSystem, Deformer, DeformerInstance, DeformerInstanceOptions, DeformerOptions, Dna,
    Instance, Kind, Layers, Normals, OpenOptions, Preset, Rig, Status, VertexAttribute,
    VertexFormat, VertexLayout, Weights,
};

struct Face {
    deformer: Deformer,
    instance: Instance,
}

fn face(preset: Preset) -> Face {
    let dna = Dna::generate(preset).unwrap();
    let rig = Rig::new(&dna).unwrap();
    let deformer = Deformer::new(&dna, &rig).unwrap();
    let mut instance = rig.instance().unwrap();
    for (i, control) in instance.raw_controls_mut().iter_mut().enumerate() {
        *control = (i * 7 % 11) as f32 / 10.0;
    }
    instance.evaluate(0).unwrap();
    Face { deformer, instance }
}

fn bits(rows: &[[f32; 3]]) -> Vec<u32> {
    rows.iter().flatten().map(|value| value.to_bits()).collect()
}

fn fails<T>(status: Status, result: mien::Result<T>) {
    assert_eq!(result.err().map(|error| error.status()), Some(status));
}

/// Positions and normals of a mesh.
fn bytes_of(words: &mut [u32]) -> &mut [u8] {
    let count = std::mem::size_of_val(words);
    unsafe { std::slice::from_raw_parts_mut(words.as_mut_ptr().cast(), count) }
}

#[test]
fn vertices_in_a_buffer() {
    let dna = Dna::generate(Preset::SMALL).unwrap();
    let rig = Rig::new(&dna).unwrap();
    let deformer = DeformerOptions::new().with_tangents(true).create(&dna, &rig).unwrap();
    let mesh = deformer.mesh(0).unwrap();
    let count = mesh.normals.len();
    assert_eq!(mesh.tangents.len(), count);
    let layout = VertexLayout::interleaved(
        Some(VertexFormat::FLOAT32X3),
        Some(VertexFormat::SNORM10_10_10_2),
        Some(VertexFormat::FLOAT32X4),
    );
    let (mut instances, mut buffers) = (vec![], vec![]);
    for _ in 0..2 {
        instances.push(deformer.instance().unwrap());
        buffers.push(vec![7u32; count * 8 + 1]);
    }
    let bytes = bytes_of(&mut buffers[0]);
    instances[0].write_vertices(0, Normals::SKINNED, bytes, &layout).unwrap();
    let positions = instances[0].positions(0).unwrap();
    for (v, vertex) in buffers[0].chunks_exact(8).enumerate() {
        let position = positions[mesh.vertex_position_indices[v] as usize];
        assert_eq!([0, 1, 2].map(|k| f32::from_bits(vertex[k])), position);
        assert_eq!(f32::from_bits(vertex[7]), mesh.tangents[v][3]);
    }
    assert_eq!(*buffers[0].last().unwrap(), 7);
    let outputs: Vec<_> = buffers.iter_mut().map(|b| (bytes_of(b), layout)).collect();
    DeformerInstance::write_vertices_batch_on(
        &mut instances,
        0,
        Normals::SKINNED,
        outputs,
        |_, work| work(),
    )
    .unwrap();
    assert_eq!(buffers[0], buffers[1]);
}

#[test]
fn vertices_that_do_not_fit_are_refused() {
    let Face { deformer, .. } = face(Preset::TINY);
    let count = deformer.mesh(0).unwrap().normals.len();
    let mut instance = deformer.instance().unwrap();
    let mut buffer = vec![0u32; count * 4];
    let layout = VertexLayout::interleaved(Some(VertexFormat::FLOAT32X4), None, None);
    let mut status = |words: usize, change: &dyn Fn(&mut VertexAttribute)| {
        let mut changed = layout;
        change(changed.positions.as_mut().unwrap());
        let bytes = bytes_of(&mut buffer[..words]);
        match instance.write_vertices(0, Normals::NONE, bytes, &changed) {
            Ok(()) => Status::OK,
            Err(error) => error.status(),
        }
    };
    assert_eq!(status(count * 4, &|_| ()), Status::OK);
    assert_eq!(status(count * 4 - 1, &|_| ()), Status::INVALID_ARGUMENT);
    assert_eq!(status(0, &|_| ()), Status::INVALID_ARGUMENT);
    for wrong in [0, 8, 18, usize::MAX - 3] {
        assert_eq!(status(count * 4, &|a| a.stride = wrong), Status::INVALID_ARGUMENT);
    }
    for wrong in [2, 4, count * 16, usize::MAX - 3] {
        assert_eq!(status(count * 4, &|a| a.offset = wrong), Status::INVALID_ARGUMENT);
    }
    let wrong = VertexFormat::SNORM16X4;
    assert_eq!(status(count * 4, &|a| a.format = wrong), Status::INVALID_ARGUMENT);
    let bytes = bytes_of(&mut buffer);
    let none = VertexLayout::default();
    assert!(instance.write_vertices(0, Normals::NONE, bytes, &none).is_err());
    let tangents = VertexLayout::interleaved(None, None, layout.positions.map(|p| p.format));
    assert!(instance.write_vertices(0, Normals::NONE, bytes, &tangents).is_err());
    let few = DeformerInstance::write_vertices_batch_on(
        [&mut instance],
        0,
        Normals::NONE,
        [],
        |_, work| work(),
    );
    assert_eq!(few.unwrap_err().status(), Status::INVALID_ARGUMENT);
}

fn mesh_bits(pose: &DeformerInstance, mesh: usize) -> (Vec<u32>, Vec<u32>) {
    (bits(pose.positions(mesh).unwrap()), bits(pose.normals(mesh).unwrap()))
}

#[test]
fn meshes_have_the_shapes_that_their_types_say() {
    let Face { deformer, .. } = face(Preset::SMALL);
    let info = deformer.info();
    assert_eq!(info.mesh_count, deformer.rig().count(Kind::MESH));
    assert_eq!(deformer.bind_matrices().len(), info.joint_count);
    assert_eq!(deformer.inverse_bind_matrices().len(), info.joint_count);
    for matrix in deformer.bind_matrices() {
        assert_eq!([matrix[3], matrix[7], matrix[11], matrix[15]], [0.0, 0.0, 0.0, 1.0]);
    }
    for m in 0..info.mesh_count {
        let mesh = deformer.mesh(m).unwrap();
        let (positions, vertices) = (mesh.positions.len(), mesh.vertex_position_indices.len());
        assert!(positions > 0);
        assert_eq!(mesh.normals.len(), vertices);
        assert_eq!(mesh.texture_coordinates.len(), vertices);
        assert!(mesh.vertex_position_indices.iter().all(|p| (*p as usize) < positions));
        assert!(mesh.triangles.iter().flatten().all(|v| (*v as usize) < vertices));
        assert_eq!(deformer.triangles(m).unwrap(), mesh.triangles);
        assert_eq!(deformer.texture_coordinates(m).unwrap(), mesh.texture_coordinates);
        let (joints, weights) = deformer.influences(m, positions - 1).unwrap();
        assert_eq!(joints.len(), weights.len());
        assert!(joints.len() <= mesh.max_influences);
        for target in 0..mesh.target_channels.len() {
            assert_eq!(deformer.target(m, target).unwrap().len(), positions);
        }
        let past = mesh.target_channels.len();
        assert_eq!(deformer.target(m, past).unwrap_err().status(), Status::INDEX);
        assert_eq!(deformer.influences(m, positions).unwrap_err().status(), Status::INDEX);
    }
    for past in [info.mesh_count, usize::MAX] {
        assert_eq!(deformer.mesh(past).unwrap_err().status(), Status::INDEX);
    }
}

#[test]
fn poses_follow_their_instance() {
    let Face { deformer, instance } = face(Preset::SMALL);
    let mut pose = deformer.instance().unwrap();
    let neutral = deformer.mesh(0).unwrap();
    pose.deform(0, Normals::RECOMPUTED).unwrap();
    for (p, n) in pose.positions(0).unwrap().iter().zip(neutral.positions) {
        assert!(p.iter().zip(n).all(|(a, b)| (a - b).abs() < 1e-3), "{p:?} {n:?}");
    }
    pose.update(&instance).unwrap();
    pose.deform(0, Normals::RECOMPUTED).unwrap();
    let moved = mesh_bits(&pose, 0);
    assert_ne!(moved.0, bits(neutral.positions));
    assert_eq!(pose.joint_matrices().len(), deformer.info().joint_count);
    assert_eq!(pose.skin_matrices().len(), deformer.info().joint_count);

    // From arrays: the same.
    let mut other = deformer.instance().unwrap();
    other.update_from_values(instance.joints(), instance.blend_shapes()).unwrap();
    other.deform(0, Normals::RECOMPUTED).unwrap();
    assert_eq!(mesh_bits(&other, 0), moved);
    other.update_from_values(&[], &[]).unwrap();
    let mut transforms = vec![[0.0; 10]; deformer.info().joint_count];
    other.local_transforms(&mut transforms).unwrap();
    for (t, n) in transforms.iter().zip(deformer.rig().neutral_joint_values().chunks_exact(9)) {
        assert_eq!(t[..3], n[..3]);
    }
    let error = other.update_from_values(&[1.0], &[]).unwrap_err();
    assert_eq!(error.status(), Status::INVALID_ARGUMENT);
    assert!(other.local_transforms(&mut transforms[1..]).is_err());

    // It holds what it needs.
    drop(deformer);
    drop(instance);
    pose.deform(0, Normals::SKINNED).unwrap();
}

#[test]
fn a_subset_has_the_bits_of_the_whole_mesh() {
    let Face { deformer, instance } = face(Preset::SMALL);
    let count = deformer.mesh(0).unwrap().positions.len() as u32;
    let chosen: Vec<u32> = (0..count).step_by(7).collect();
    let deformed = |deformer: &Deformer| {
        let mut pose = deformer.instance().unwrap();
        pose.update(&instance).unwrap();
        pose.deform(0, Normals::NONE).unwrap();
        pose.positions(0).unwrap().to_vec()
    };
    let whole = deformed(&deformer);
    let memory = mien::Allocator::new(std::alloc::System);
    let subset = deformer.subset_in(0, &chosen, &memory).unwrap();
    let nested = deformer.subset(0, &[0, 7, 14]).unwrap().subset(0, &[1]).unwrap();
    fails(Status::INDEX, deformer.subset(99, &[0]));
    fails(Status::INDEX, deformer.subset(usize::MAX, &[0]));
    fails(Status::INDEX, deformer.subset(0, &[count]));
    fails(Status::INVALID_ARGUMENT, deformer.subset(0, &[3, 1]));
    fails(Status::INVALID_ARGUMENT, deformer.subset(0, &[3, 3]));
    drop((deformer, memory)); // the subsets keep what they need
    let wanted: Vec<[f32; 3]> = chosen.iter().map(|p| whole[*p as usize]).collect();
    assert_eq!(bits(&deformed(&subset)), bits(&wanted));
    assert_eq!(bits(&deformed(&nested)), bits(&whole[7..8]));
    let mesh = subset.mesh(0).unwrap();
    assert!(mesh.triangles.is_empty() && mesh.positions.len() == chosen.len());
}

#[test]
fn a_pose_is_of_one_rig() {
    let (one, other) = (face(Preset::TINY), face(Preset::TINY));
    let mut pose = one.deformer.instance().unwrap();
    assert_eq!(pose.update(&other.instance).unwrap_err().status(), Status::MISMATCH);
    let mut foreign = other.deformer.instance().unwrap();
    let error =
        DeformerInstance::deform_batch([&mut pose, &mut foreign], 0, Normals::NONE).unwrap_err();
    assert_eq!(error.status(), Status::MISMATCH);

    let dna = Dna::generate(Preset::SMALL).unwrap();
    let error = Deformer::new(&dna, one.deformer.rig()).unwrap_err();
    assert_eq!(error.status(), Status::MISMATCH);
    let file = Dna::generate(Preset::TINY).unwrap().to_bytes().unwrap();
    let dna = OpenOptions::new().layers(Layers::BEHAVIOR).open_bytes(&file).unwrap();
    let error = Deformer::new(&dna, one.deformer.rig()).unwrap_err();
    assert_eq!(error.status(), Status::DNA_LAYER);
}

#[test]
fn options_reach_the_library() {
    let dna = Dna::generate(Preset::SMALL).unwrap();
    let rig = Rig::new(&dna).unwrap();
    let deformer = DeformerOptions::new()
        .weights(Weights::FIX)
        .normals(Normals::SKINNED)
        .create(&dna, &rig)
        .unwrap();
    assert_eq!(deformer.info().weights, Weights::FIX);
    assert_eq!(deformer.info().normals, Normals::SKINNED);
    let last = rig.info().lod_count - 1;
    let mut pose = DeformerInstanceOptions::new().lods(1 << last).create(&deformer).unwrap();
    let shown = |m: usize| deformer.mesh(m).unwrap().lods >> last & 1 == 1;
    for m in 0..deformer.info().mesh_count {
        match pose.deform(m, Normals::DEFAULT) {
            Ok(()) => assert!(shown(m) && !pose.positions(m).unwrap().is_empty()),
            Err(error) => {
                assert!(!shown(m));
                assert_eq!(error.status(), Status::LOD);
                assert_eq!(pose.positions(m).unwrap_err().status(), Status::LOD);
            }
        }
    }
}

/// Many poses of a mesh, so that there are pieces.
fn batch(face: &Face) -> Vec<DeformerInstance> {
    let positions = face.deformer.mesh(0).unwrap().positions.len();
    let mut poses: Vec<_> = (0..40_000 / positions + 2)
        .map(|_| DeformerInstanceOptions::new().lods(1).create(&face.deformer).unwrap())
        .collect();
    for (i, pose) in poses.iter_mut().enumerate() {
        let joints: Vec<_> = face.instance.joints().iter().map(|v| v * i as f32).collect();
        pose.update_from_values(&joints, face.instance.blend_shapes()).unwrap();
    }
    poses
}

#[test]
fn batches_and_threads_give_the_same_bits() {
    let face = face(Preset::SMALL);
    let mut poses = batch(&face);
    for pose in &mut poses {
        pose.deform(0, Normals::RECOMPUTED).unwrap();
    }
    let expected: Vec<_> = poses.iter().map(|pose| mesh_bits(pose, 0)).collect();
    let results = |poses: &[DeformerInstance]| {
        poses.iter().map(|pose| mesh_bits(pose, 0)).collect::<Vec<_>>()
    };

    let mut poses = batch(&face);
    DeformerInstance::deform_batch(&mut poses, 0, Normals::RECOMPUTED).unwrap();
    assert!(results(&poses) == expected);

    // Whatever the caller's threads do with the work: each piece is done once.
    let mut most = 0;
    let ways: [&dyn Fn(mien::Work<'_>); 4] =
        [&|_| {}, &|work| work(), &|work| (0..5).for_each(|_| work()), &|work| {
            std::thread::scope(|threads| {
                for _ in 0..4 {
                    threads.spawn(work);
                }
            })
        }];
    for way in ways {
        let mut poses = batch(&face);
        DeformerInstance::deform_batch_on(&mut poses, 0, Normals::RECOMPUTED, |pieces, work| {
            most = most.max(pieces);
            way(work);
        })
        .unwrap();
        assert!(results(&poses) == expected);
    }
    assert!(most > 1, "there were no pieces to share");

    poses[0].deform_on(0, Normals::RECOMPUTED, |_, work| work()).unwrap();
    assert!(mesh_bits(&poses[0], 0) == expected[0]);
}

#[test]
fn a_panic_passes_by_c() {
    let face = face(Preset::SMALL);
    let mut poses = batch(&face);
    let result = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        DeformerInstance::deform_batch_on(&mut poses, 0, Normals::NONE, |_, _| {
            panic!("of the caller")
        })
    }));
    assert_eq!(*result.unwrap_err().downcast::<&str>().unwrap(), "of the caller");
    // All is as after any other call.
    DeformerInstance::deform_batch(&mut poses, 0, Normals::NONE).unwrap();
}

#[test]
fn coordinate_systems_have_names() {
    let names: Vec<_> = CoordinateSystem::names().collect();
    assert!(names.iter().any(|name| name == "unreal"), "{names:?}");
    let file = Dna::generate(Preset::TINY).unwrap().to_bytes().unwrap();
    for name in &names {
        let system = CoordinateSystem::named(name).unwrap();
        let dna = OpenOptions::new().system(&system).open_bytes(&file).unwrap();
        assert_eq!(dna.info().axes, system.axes, "{name}");
        assert_eq!(dna.info().translation_unit, system.translation_unit, "{name}");
    }
    let error = CoordinateSystem::named("nowhere").unwrap_err();
    assert_eq!(error.status(), Status::NAME);
    let mut flat = CoordinateSystem::named("maya").unwrap();
    flat.axes[1] = flat.axes[0];
    let error = OpenOptions::new().system(&flat).open_bytes(&file).unwrap_err();
    assert_eq!(error.status(), Status::INVALID_ARGUMENT);
}
