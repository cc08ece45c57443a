// SPDX-License-Identifier: MIT
//! Rigs from meshes: what goes in, what comes out, wrong arrays, cancellation, threads.

use mien::{
    AuthorBone, AuthorFlags, AuthorLod, AuthorMesh, AuthorOptions, AuthorShape, BoneKind, Deformer,
    Kind, MeshAxis, Rig, Status, Symmetry,
};
use std::ops::ControlFlow;
use std::panic::{catch_unwind, AssertUnwindSafe};

const ROWS: u32 = 24;
const COLUMNS: u32 = 28;

/// An egg with a nose, of quads, and two shapes of it.
struct Egg {
    positions: Vec<[f64; 3]>,
    corners: Vec<u32>,
    sizes: Vec<u32>,
    smile: Vec<[f64; 3]>,
    puff: Vec<[f64; 3]>,
}

impl Egg {
    fn new() -> Self {
        let pi = std::f64::consts::PI;
        let mut egg = Self {
            positions: Vec::new(),
            corners: Vec::new(),
            sizes: Vec::new(),
            smile: Vec::new(),
            puff: Vec::new(),
        };
        for i in 0..ROWS * COLUMNS {
            let v = pi * (0.03 + 0.94 * f64::from(i / COLUMNS) / f64::from(ROWS - 1));
            let u = 2.0 * pi * f64::from(i % COLUMNS) / f64::from(COLUMNS);
            let (x, y) = (7.0 * v.sin() * u.sin(), 10.0 * v.cos());
            let mut z = 8.5 * v.sin() * u.cos();
            let front = if z > 4.0 { 1.0 } else { 0.0 };
            z += 2.0 * front * (-(x * x + y * y) / 4.0).exp();
            let amount =
                |at: f64| front * (-((x.abs() - at).powi(2) + (y + 4.0).powi(2)) / 5.0).exp();
            egg.positions.push([x, y, z]);
            egg.smile.push([0.2, 0.5, -0.2].map(|by| amount(3.0) * by));
            egg.puff.push([0.3, 0.0, 0.4].map(|by| amount(4.0) * by));
        }
        for cell in 0..(ROWS - 1) * COLUMNS {
            let beside = cell - cell % COLUMNS + (cell + 1) % COLUMNS;
            egg.corners.extend([cell, cell + COLUMNS, beside + COLUMNS, beside]);
            egg.sizes.push(4);
        }
        egg
    }

    fn shapes(&self) -> [AuthorShape<'_>; 2] {
        [
            AuthorShape { name: "smile", positions: None, displacements: &self.smile },
            AuthorShape { name: "puff", positions: None, displacements: &self.puff },
        ]
    }

    fn mesh<'a>(&'a self, shapes: &'a [AuthorShape<'a>]) -> AuthorMesh<'a> {
        AuthorMesh {
            positions: &self.positions,
            corners: &self.corners,
            face_sizes: Some(&self.sizes),
            shapes,
            ..Default::default()
        }
    }
}

fn few<'a>() -> AuthorOptions<'a> {
    few_lods(1)
}

fn few_lods<'a>(lods: usize) -> AuthorOptions<'a> {
    AuthorOptions::new().facial_joints(12).lods(lods)
}

fn bytes(mesh: &AuthorMesh<'_>, options: &AuthorOptions<'_>) -> Vec<u8> {
    options.make(mesh).unwrap().dna.to_bytes().unwrap()
}

#[track_caller]
fn refused(status: Status, words: &str, mesh: &AuthorMesh<'_>, options: &AuthorOptions<'_>) {
    let error = options.make(mesh).unwrap_err();
    assert_eq!(error.status(), status, "{error}");
    assert!(error.message().contains(words), "{error}");
}

#[test]
fn a_mesh_with_shapes_becomes_a_rig_that_makes_them() {
    let egg = Egg::new();
    let shapes = egg.shapes();
    let made = few().facial_joints(30).make(&egg.mesh(&shapes)).unwrap();
    assert!(made.report.starts_with('{') && made.report.contains("\"per_shape\""));
    let rig = Rig::new(&made.dna).unwrap();
    assert_eq!(rig.count(Kind::RAW_CONTROL), 2);
    let mut face = rig.instance().unwrap();
    let mut pose = Deformer::new(&made.dna, &rig).unwrap().instance().unwrap();
    for shape in &shapes {
        face.reset().unwrap();
        face.raw_controls_mut()[rig.find(Kind::RAW_CONTROL, shape.name).unwrap()] = 1.0;
        face.evaluate(0).unwrap();
        pose.update(&face).unwrap();
        pose.deform(0, mien::Normals::NONE).unwrap();
        let moved = pose.positions(0).unwrap();
        let (mut left, mut all) = (0.0, 0.0);
        for (i, by) in shape.displacements.iter().enumerate() {
            for k in 0..3 {
                left += (f64::from(moved[i][k]) - egg.positions[i][k] - by[k]).powi(2);
                all += by[k].powi(2);
            }
        }
        assert!(left < 0.04 * all, "{}: {}", shape.name, (left / all).sqrt());
    }
}

#[test]
fn all_ways_to_give_the_same_mesh_give_the_same_bytes_on_any_number_of_threads() {
    let egg = Egg::new();
    let shapes = egg.shapes();
    let mesh = egg.mesh(&shapes);
    let expected = bytes(&mesh, &few());
    let moving: Vec<u32> =
        (0..ROWS * COLUMNS).filter(|i| egg.smile[*i as usize] != [0.0; 3]).collect();
    let by: Vec<_> = moving.iter().map(|i| egg.smile[*i as usize]).collect();
    let sparse = AuthorShape { name: "smile", positions: Some(&moving), displacements: &by };
    assert!(bytes(&egg.mesh(&[sparse, shapes[1]]), &few()) == expected);
    let mut steps = Vec::new();
    let mut used = 0;
    let progress = |step: &str, share: f64| {
        steps.push((step.to_string(), share));
        ControlFlow::Continue(())
    };
    let on_three = |_, work: mien::Work<'_>| {
        used += 1;
        std::thread::scope(|scope| {
            for _ in 0..3 {
                scope.spawn(work);
            }
        });
    };
    let made = few().make_on(&mesh, progress, on_three).unwrap();
    assert!(made.dna.to_bytes().unwrap() == expected);
    assert!(used > 0);
    assert!(steps.len() > 3 && steps.windows(2).all(|pair| pair[0].1 <= pair[1].1));
    for other in [few().with(AuthorFlags::PAPER), few().symmetry(Symmetry::OFF).influences(3)] {
        assert!(bytes(&mesh, &other) != expected, "{other:?}");
    }
}

#[test]
fn each_stage_takes_the_result_of_the_caller() {
    let egg = Egg::new();
    let [smile, puff] = egg.shapes();
    let shapes = [smile, puff, AuthorShape { name: "grin", ..smile }]; // as smile, which it doubles
    let mesh = egg.mesh(&shapes);
    let bone = |name, position, kind| AuthorBone { name, position, parent: 0, kind };
    let bones = [
        bone("root", [0.0; 3], BoneKind::ROOT),
        bone("left", [4.0, 0.0, 7.0], BoneKind::FACIAL),
        bone("right", [-4.0, 0.0, 7.0], BoneKind::FACIAL),
    ];
    let mask: Vec<u8> = egg.positions.iter().map(|p| (p[2] > 5.0).into()).collect();
    let groups: Vec<u8> = egg.positions.iter().map(|p| if p[2] > 5.0 { 0 } else { 1 }).collect();
    let mut motions = [[0.0; 6]; 9];
    motions[1] = [0.5, 1.0, 0.0, 0.0, 0.0, 10.0];
    let options = AuthorOptions::new()
        .bones(&bones)
        .lod_joints(&[2, 1])
        .mask(&mask)
        .depth_groups(&groups)
        .groups(2)
        .bone_groups(&[0, 7, 3])
        .bone_motions(&motions)
        .joint_groups(2)
        .overlap_correctives(1)
        .lod_triangles(0.25);
    let made = options.make(&mesh).unwrap();
    Rig::new(&made.dna).unwrap();
    assert!(made.report.contains("\"lods\": [\n    {\"facial_joints\": 2"));
    assert!(made.report.contains("\"correctives\": 1"));
    let values = made.dna.read_floats("bhvr.joints.jointGroups[1].values").unwrap();
    assert_eq!(values[0], 0.5);

    let wrong = Status::INVALID_ARGUMENT;
    refused(wrong, "mask", &mesh, &options.clone().mask(&mask[1..]));
    refused(wrong, "depth_groups", &mesh, &options.clone().depth_groups(&[]));
    refused(wrong, "bone_motions", &mesh, &options.clone().bone_motions(&motions[1..]));
    refused(wrong, "bone_groups", &mesh, &options.clone().bone_groups(&[0, 1]));
    refused(wrong, "lod_joints", &mesh, &options.clone().lods(3));
    refused(wrong, "lod_joints", &mesh, &options.clone().lod_joints(&[1, 2]));
    refused(wrong, "joint_groups", &mesh, &options.clone().joint_groups(25));
    refused(wrong, "lod_triangles", &mesh, &options.clone().lod_triangles(1.5));
    refused(
        Status::AUTHOR_MESH,
        "joint group 256",
        &mesh,
        &options.clone().bone_groups(&[0, 1, 256]),
    );
}

#[test]
fn meshes_of_lods_are_those_of_the_caller() {
    let egg = Egg::new();
    let mesh = egg.mesh(&[]);
    let triangles: Vec<[u32; 3]> = egg
        .corners
        .chunks(4)
        .flat_map(|quad| [[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]])
        .collect();
    let half = AuthorLod { triangles: &triangles[..triangles.len() / 2], uvs: None };
    let few = AuthorLod { triangles: &triangles[..9], uvs: None };
    let options = few_lods(0);
    let made = options.clone().lod_meshes(&[half, few]).make(&mesh).unwrap();
    assert!(made.report.contains("\"own_lod_meshes\": true"));
    let rig = Rig::new(&made.dna).unwrap();
    assert_eq!(rig.count(Kind::MESH), 3);
    let deformer = Deformer::new(&made.dna, &rig).unwrap();
    assert_eq!(deformer.mesh(1).unwrap().triangles.len(), half.triangles.len());
    assert_eq!(deformer.mesh(2).unwrap().triangles.len(), 9);
    let corner_uvs = vec![0; egg.corners.len()];
    let textured = AuthorMesh { uvs: &[[0.0; 2], [0.5; 2]], corner_uvs: &corner_uvs, ..mesh };
    let own = AuthorLod { uvs: Some(&[[1; 3]; 9]), ..few };
    let made = options.clone().lod_meshes(&[own]).make(&textured).unwrap();
    let us = made.dna.read_floats("geom.meshes[1].textureCoordinates.us").unwrap();
    assert_eq!(us, [0.5]);

    let wrong = Status::INVALID_ARGUMENT;
    refused(wrong, "lod_meshes", &mesh, &few_lods(2).lod_meshes(&[half, few]));
    refused(wrong, "lod_meshes", &mesh, &options.clone().lod_meshes(&[few]).lod_joints(&[12]));
    let short = AuthorLod { uvs: Some(&[[1; 3]; 8]), ..few };
    refused(wrong, "UVs", &textured, &options.clone().lod_meshes(&[short]));
    let bad = Status::AUTHOR_MESH;
    refused(bad, "the mesh has none", &mesh, &options.clone().lod_meshes(&[own]));
    refused(
        bad,
        "LOD 1 has 0 corners",
        &mesh,
        &options.clone().lod_meshes(&[AuthorLod::default()]),
    );
    let nowhere = AuthorLod { triangles: &[[0, 1, u32::MAX]], uvs: None };
    refused(bad, "names position", &mesh, &options.lod_meshes(&[half, nowhere]));
}

#[test]
fn bones_weights_objects_and_uvs_of_the_caller_arrive() {
    let egg = Egg::new();
    let bone = |name, position, parent, kind| AuthorBone { name, position, parent, kind };
    let bones = [
        bone("root", [0.0; 3], 0, BoneKind::ROOT),
        bone("head", [0.0, -5.0, 0.0], 0, BoneKind::HEAD),
        bone("left", [4.0, 0.0, 7.0], 1, BoneKind::FACIAL),
        bone("right", [-4.0, 0.0, 7.0], 1, BoneKind::FACIAL),
    ];
    let side = |place: &[f64; 3]| [if place[0] > 0.0 { 2 } else { 3 }, 1];
    let joints: Vec<u16> = egg.positions.iter().flat_map(side).collect();
    let weights: Vec<f32> = egg.positions.iter().flat_map(|_| [0.75, 0.25]).collect();
    let corner_uvs: Vec<u32> = egg.corners.iter().map(|corner| corner % 2).collect();
    let mesh = AuthorMesh {
        objects: &[("skin", egg.sizes.len() - 20), ("cap", 20)],
        uvs: &[[0.0; 2], [1.0; 2]],
        corner_uvs: &corner_uvs,
        ..egg.mesh(&[])
    };
    let options = AuthorOptions::new().lods(1).bones(&bones);
    let made = options.clone().weights(&joints, &weights).make(&mesh).unwrap();
    let rig = Rig::new(&made.dna).unwrap();
    assert_eq!(rig.count(Kind::JOINT), 4);
    assert_eq!(rig.count(Kind::MESH), 2);
    assert!(rig.name(Kind::MESH, 1).unwrap().starts_with("cap"));
    let influences = made.dna.read_floats("geom.meshes[0].skinWeights[0].weights").unwrap();
    assert_eq!(influences, [0.75, 0.25]);

    let wrong = Status::INVALID_ARGUMENT;
    refused(wrong, "weights", &mesh, &options.clone().weights(&joints[1..], &weights));
    refused(wrong, "weights", &mesh, &options.clone().weights(&joints, &weights[2..]));
    refused(wrong, "influences", &mesh, &options.weights(&joints, &weights).influences(8));
    let alone = AuthorOptions::new();
    refused(wrong, "with bones", &mesh, &alone.clone().weights(&joints, &weights));
    refused(Status::AUTHOR_MESH, "", &mesh, &alone.bones(&bones[1..]));
}

#[test]
fn wrong_meshes_are_refused() {
    let egg = Egg::new();
    let mesh = egg.mesh(&[]);
    let wrong = Status::INVALID_ARGUMENT;
    let check = |status, words, mesh: AuthorMesh<'_>| refused(status, words, &mesh, &few());
    check(wrong, "corners", AuthorMesh { face_sizes: None, corners: &[0, 1], ..mesh });
    check(wrong, "corner_uvs", AuthorMesh { uvs: &[[0.0; 2]], ..mesh });
    check(wrong, "corner_uvs", AuthorMesh { corner_uvs: &egg.corners, ..mesh });
    let short =
        |positions| AuthorShape { name: "short", positions, displacements: &egg.smile[1..] };
    check(wrong, "shapes", egg.mesh(&[short(None)]));
    check(wrong, "shapes", egg.mesh(&[short(Some(&[1, 2]))]));
    let bad = Status::AUTHOR_MESH;
    check(Status::AUTHOR_REFUSED, "faces", AuthorMesh::default());
    check(Status::AUTHOR_REFUSED, "face", AuthorMesh { corners: &[], face_sizes: None, ..mesh });
    check(bad, "", AuthorMesh { face_sizes: None, corners: &[0, 1, 9999], ..mesh });
    check(bad, "", AuthorMesh { face_sizes: Some(&egg.sizes[1..]), ..mesh });
    check(bad, "", AuthorMesh { objects: &[("skin", 5)], ..mesh });
    check(bad, "", AuthorMesh { objects: &[("skin", usize::MAX), ("cap", usize::MAX)], ..mesh });
    let nowhere =
        AuthorShape { name: "far", positions: Some(&[9999]), displacements: &[[0.0, 0.0, 1.0]] };
    check(bad, "", egg.mesh(&[nowhere]));
    let nameless = AuthorShape { name: "", ..egg.shapes()[0] };
    check(bad, "name", egg.mesh(&[nameless]));
    let flat: Vec<_> = egg.positions.iter().map(|[x, y, _]| [*x, *y, 0.0]).collect();
    check(Status::AUTHOR_REFUSED, "flat", AuthorMesh { positions: &flat, ..mesh });
    refused(wrong, "lods", &mesh, &few().lods(9));
    refused(wrong, "", &mesh, &few().lods(usize::MAX).groups(1).unit(-1.0));
    refused(wrong, "", &mesh, &few().axes(MeshAxis::X, MeshAxis::MINUS_X));
    refused(Status::AUTHOR_REFUSED, "nose", &mesh, &few().face_object("nose"));
}

#[test]
fn progress_cancels_and_panics_go_on() {
    let egg = Egg::new();
    let mesh = egg.mesh(&[]);
    let late = |_: &str, share: f64| {
        if share > 0.1 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    let error = few().make_on(&mesh, late, |_, work| work()).unwrap_err();
    assert_eq!(error.status(), Status::AUTHOR_CANCELED);
    let hurt = AssertUnwindSafe(|| few().make_on(&mesh, |_, _| panic!("told"), |_, work| work()));
    assert_eq!(*catch_unwind(hurt).unwrap_err().downcast::<&str>().unwrap(), "told");
    let go_on = |_: &str, _: f64| ControlFlow::Continue(());
    let hurt = AssertUnwindSafe(|| few().make_on(&mesh, go_on, |_, _| panic!("ran")));
    assert_eq!(*catch_unwind(hurt).unwrap_err().downcast::<&str>().unwrap(), "ran");
}
