// SPDX-License-Identifier: MIT
//! Documents: fields, layers, undoing, every operation, and what is refused.

use mien::{
    Allocator, CoordinateSystem, Dna, Document, Kind, Layers, Match, Placement, Preset,
    ProjectOptions, Status,
};
use std::alloc::System;

fn head() -> (Dna<'static>, Document) {
    let dna = Dna::generate(Preset::SMALL).unwrap();
    let document = Document::new(&dna).unwrap();
    (dna, document)
}

fn bytes_of(document: &Document) -> Vec<u8> {
    document.to_dna().unwrap().to_bytes().unwrap()
}

#[test]
fn fields_are_written_and_read_and_undone() {
    let (dna, mut head) = head();
    assert_eq!(bytes_of(&head), dna.to_bytes().unwrap());
    let mark = head.mark().unwrap();
    head.write_string("desc.name", "Ada").unwrap();
    assert_eq!(head.read_string("desc.name").unwrap(), "Ada");
    assert_eq!(head.bytes("desc.name").unwrap(), b"Ada");
    let xs = "defn.neutralJointTranslations.xs";
    head.write_floats(xs, 1, &[1.5, 2.5]).unwrap();
    assert_eq!(head.read_floats(xs).unwrap()[1..3], [1.5, 2.5]);
    head.write_integers("desc.gender", 0, &[2]).unwrap();
    assert_eq!(head.read_integers("desc.gender").unwrap(), [2]);
    assert_eq!(head.field_name("desc", 0).unwrap(), "name");
    head.resize("desc.metadata", 2).unwrap();
    head.splice("desc.metadata", 0, 1, 3).unwrap();
    assert_eq!(head.field("desc.metadata").unwrap().count, 4);
    assert_eq!(head.validate().unwrap().errors(), 0);
    head.undo(mark).unwrap();
    assert_eq!(bytes_of(&head), dna.to_bytes().unwrap());
    drop(dna);
    assert!(head.to_dna().is_ok());

    let wrong = head.write_floats("desc.name", 0, &[1.0]).unwrap_err();
    assert_eq!(wrong.status(), Status::INVALID_ARGUMENT);
    assert_eq!(head.field("no.such").unwrap_err().status(), Status::NAME);
    assert_eq!(head.undo(77).unwrap_err().status(), Status::INDEX);
    assert_eq!(Document::empty().unwrap().field("defn.jointNames").unwrap().count, 0);
}

#[test]
fn layers_are_listed_anew() {
    let (_, mut head) = head();
    let (version, count) = head.layer_count().unwrap();
    assert_eq!((version, count), (8, 11));
    head.add_layer("note", (1, 2), b"a\0b").unwrap();
    let (layer, bytes) = head.layer(count).unwrap();
    assert_eq!((layer.code.as_str(), layer.version_minor, bytes), ("note", 2, &b"a\0b"[..]));
    let again = Document::new(&head.to_dna().unwrap()).unwrap();
    assert_eq!(again.layer(count).unwrap().1, b"a\0b");
    assert_eq!(head.layer(count + 1).unwrap_err().status(), Status::INDEX);
    assert_eq!(head.add_layer("desc", (1, 1), b"").unwrap_err().status(), Status::INVALID_ARGUMENT);
    head.clear_layers(8).unwrap();
    assert_eq!(head.layer_count().unwrap(), (8, 0));
}

#[test]
fn every_operation_changes_the_character() {
    let (dna, mut head) = head();
    let other = Document::new_in(&dna, &Allocator::new(System)).unwrap();
    head.rename(Kind::JOINT, 2, "jaw").unwrap();
    assert_eq!(head.find(Kind::JOINT, "jaw").unwrap(), 2);
    assert_eq!(head.find(Kind::JOINT, "no such").unwrap_err().status(), Status::NAME);
    head.set_neutral(2, Some(&[[1.0, 2.0, 3.0]]), None).unwrap();
    head.set_neutral(2, None, Some(&[[4.0, 5.0, 6.0]])).unwrap();
    assert_eq!(head.read_floats("defn.neutralJointTranslations.ys").unwrap()[2], 2.0);
    assert_eq!(head.read_floats("defn.neutralJointRotations.zs").unwrap()[2], 6.0);
    let uneven = head.set_neutral(2, Some(&[[1.0; 3]]), Some(&[])).unwrap_err();
    assert_eq!(uneven.status(), Status::MISMATCH);

    let count = head.field("geom.meshes[0].positions.xs").unwrap().count as usize;
    head.set_weights(0, 1, &vec![1; count], &vec![0.5; count]).unwrap();
    assert_eq!(head.set_weights(0, 1, &[1], &[]).unwrap_err().status(), Status::MISMATCH);
    head.normalize_weights(0).unwrap();
    assert_eq!(head.read_floats("geom.meshes[0].skinWeights[0].weights").unwrap(), [1.0]);
    head.limit_influences(0, 1).unwrap();
    head.smooth_weights(0, 1, 0.5, 4).unwrap();
    head.set_target(0, 0, &[[1.0, 0.0, 0.0]], Some(&[7])).unwrap();
    let targets = head.read_integers("geom.meshes[0].blendShapeTargets[0].vertexIndices");
    assert!(targets.unwrap().len() == 1);
    assert_eq!(head.set_target(0, 0, &[], Some(&[7])).unwrap_err().status(), Status::MISMATCH);
    assert!(head.prune_targets(100.0).unwrap().deltas > 0);
    assert!(head.prune_joints(1.0, 0.0, 0.0).unwrap().removed_count > 0);
    head.place(&Placement { scale: 2.0, ..Default::default() }).unwrap();
    let nowhere = head.place(&Placement { scale: 0.0, ..Default::default() });
    assert_eq!(nowhere.unwrap_err().status(), Status::INVALID_ARGUMENT);
    head.conform(0, &vec![[0.5; 3]; count], true).unwrap();
    head.set_positions(0, &vec![[0.25; 3]; count]).unwrap();
    assert_eq!(head.read_floats("geom.meshes[0].positions.zs").unwrap()[count - 1], 0.25);
    head.undo(0).unwrap();

    let by_uv = ProjectOptions { matched_by: Match::UV, keep_targets: true, ..Default::default() };
    head.make_lod(1, 0, &by_uv).unwrap();
    let same = head.project(0, 0, &by_uv).unwrap_err();
    assert_eq!(same.status(), Status::INVALID_ARGUMENT);
    head.copy_layers(&other, Layers::DESCRIPTOR).unwrap();
    assert_eq!(head.copy_mesh(&other, 0).unwrap(), 0);
    head.clear_joints(&[3]).unwrap();
    head.remove(Kind::JOINT, &[3]).unwrap();
    head.remove(Kind::RAW_CONTROL, &[0]).unwrap();
    head.merge_joints(&other, 10.0).unwrap();
    head.split_joints(&other).unwrap();
    head.convert(&CoordinateSystem::named("unreal").unwrap()).unwrap();
    head.clear(Kind::ANIMATED_MAP).unwrap();
    head.keep_lods(1).unwrap();
    let made = head.to_dna().unwrap();
    assert_eq!((made.info().lod_count, made.info().animated_map_count), (1, 0));
    assert_eq!(made.info().raw_control_count + 1, dna.info().raw_control_count);
    head.undo(0).unwrap();
    let errors = head.transplant(&other, Match::SURFACE, 0).unwrap();
    assert_eq!(errors.len(), dna.info().raw_control_count as usize);
    assert!(errors.iter().all(|error| error.worst <= 0.01 * error.moved.max(1.0)));
}
