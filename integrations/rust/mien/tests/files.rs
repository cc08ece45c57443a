// SPDX-License-Identifier: MIT
//! DNA files in memory and on disk: opened whole and in part, written, malformed.

use mien::{
    Baked, BakedCheck, BakedOptions, Deformer, Dna, FieldType, Generate, GenerateOptions, Isa,
    Layers, OpenOptions, Preset, Report, Reuse, Rig, Severity, Status, WriteOptions,
};
use std::io::{Cursor, Read, Seek, SeekFrom};
use std::path::PathBuf;
use std::sync::Mutex;

fn tiny() -> Vec<u8> {
    Dna::generate(Preset::TINY).unwrap().to_bytes().unwrap()
}

/// A file of this test process alone, removed at the end.
struct TemporaryFile(PathBuf);

impl TemporaryFile {
    fn new(name: &str) -> Self {
        Self(std::env::temp_dir().join(format!("mien-{}-{name}.dna", std::process::id())))
    }
}

impl Drop for TemporaryFile {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

#[test]
fn a_baked_file_gives_rig_and_deformer() {
    let file = TemporaryFile::new("baked");
    let dna = Dna::generate(Preset::TINY).unwrap();
    let rig = Rig::new(&dna).unwrap();
    let deformer = Deformer::new(&dna, &rig).unwrap();
    rig.bake(&file.0, Some(&deformer)).unwrap();
    let bytes = std::fs::read(&file.0).unwrap();
    assert_eq!(bytes, rig.to_baked_bytes(Some(&deformer)).unwrap());
    // Bytes that live as long as the program, and that a leak checker finds.
    static KEPT: Mutex<Vec<&'static [u8]>> = Mutex::new(Vec::new());
    let kept: &'static [u8] = Box::leak(bytes.clone().into_boxed_slice());
    KEPT.lock().unwrap().push(kept);
    let options = BakedOptions::new().check(BakedCheck::FULL);
    let files = [
        Baked::open(&file.0).unwrap(),
        // SAFETY: nobody else knows of the file.
        unsafe { options.map(&file.0) }.unwrap(),
        options.open_bytes(kept).unwrap(),
        Baked::from_reader(&mut std::fs::File::open(&file.0).unwrap()).unwrap(),
    ];
    for baked in files {
        assert_eq!(baked.info().file_bytes, bytes.len() as u64);
        let again = baked.rig_for(Isa::SCALAR, Reuse::UNCHANGED).unwrap();
        let meshes = baked.deformer(&again).unwrap();
        drop(baked);
        assert_eq!(again.to_baked_bytes(Some(&meshes)).unwrap(), bytes);
        assert_eq!(meshes.info().mesh_count, deformer.info().mesh_count);
    }

    let alone = rig.to_baked_bytes(None).unwrap();
    let baked = Baked::from_reader(&mut Cursor::new(&alone)).unwrap();
    let again = baked.rig().unwrap();
    assert_eq!(baked.deformer(&again).err().unwrap().status(), Status::BAKED_PART);
    assert_eq!(baked.deformer(&rig).err().unwrap().status(), Status::MISMATCH);
    assert_eq!(options.open_bytes(b"DNA").err().unwrap().status(), Status::BAKED_SIGNATURE);
}

/// Fails, or panics, after some bytes.
struct Broken {
    file: Cursor<Vec<u8>>,
    left: usize,
    panics: bool,
}

impl Read for Broken {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        if self.left < buffer.len() {
            assert!(!self.panics, "the reader panics");
            return Err(std::io::Error::new(std::io::ErrorKind::Other, "the network is down"));
        }
        self.left -= buffer.len();
        self.file.read(buffer)
    }
}

impl Seek for Broken {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.file.seek(to)
    }
}

#[test]
fn readers_are_read_where_it_matters_and_may_fail() {
    let bytes = tiny();
    let options = OpenOptions::new().layers(Layers::BEHAVIOR);
    let dna = options.open_reader(&mut Cursor::new(&bytes)).unwrap();
    assert_eq!(dna.info().joint_count, Dna::from_bytes(&bytes).unwrap().info().joint_count);
    for left in [0, 7, 100] {
        let mut broken = Broken { file: Cursor::new(bytes.clone()), left, panics: false };
        let error = options.open_reader(&mut broken).err().unwrap();
        assert_eq!(error.status(), Status::FILE_READ);
        assert!(error.message().contains("network"), "{error}");
        assert!(Baked::from_reader(&mut broken).is_err());
        broken.panics = true;
        let panicked = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
            options.open_reader(&mut broken).is_ok()
        }));
        assert!(panicked.is_err());
    }
}

#[test]
fn what_is_written_is_read() {
    let file = TemporaryFile::new("written");
    let dna = Dna::generate(Preset::TINY).unwrap();
    dna.write(&file.0).unwrap();
    let bytes = std::fs::read(&file.0).unwrap();
    assert_eq!(bytes, dna.to_bytes().unwrap());

    let read = Dna::open(&file.0).unwrap();
    // SAFETY: nobody else knows of the file.
    let mapped = unsafe { OpenOptions::new().map(&file.0) }.unwrap();
    assert!(!read.info().is_mapped);
    assert_eq!(mapped.info().is_mapped, cfg!(unix));
    let borrowed = Dna::from_bytes(&bytes).unwrap();
    for dna in [&read, &mapped, &borrowed] {
        assert_eq!(dna.to_bytes().unwrap(), bytes);
        assert_eq!(dna.info().file_bytes, bytes.len() as u64);
    }
}

#[test]
fn versions_convert() {
    let dna = Dna::generate(Preset::TINY).unwrap();
    for version in 1..=8 {
        let bytes = WriteOptions::new().version(version).to_bytes(&dna).unwrap();
        assert_eq!(Dna::from_bytes(&bytes).unwrap().info().version, version);
    }
    let error = WriteOptions::new().version(9).to_bytes(&dna).unwrap_err();
    assert_eq!(error.status(), Status::INVALID_ARGUMENT);
}

#[test]
fn fields_are_read_by_path() {
    let dna = Dna::generate(Preset::TINY).unwrap();
    let joints = dna.info().joint_count;
    let xs = dna.read_floats("defn.neutralJointTranslations.xs").unwrap();
    assert_eq!(xs.len(), joints);
    let mut part = [0.0; 2];
    dna.read_floats_into("defn.neutralJointTranslations.xs", 1, &mut part).unwrap();
    assert_eq!(part, xs[1..3]);
    let parents = dna.read_integers("defn.jointHierarchy").unwrap();
    assert_eq!(parents.len(), joints);
    let rig = Rig::new(&dna).unwrap();
    let expected: Vec<i64> = rig.joint_parents().iter().map(|parent| i64::from(*parent)).collect();
    assert_eq!(parents, expected);
    assert_eq!(
        dna.read_string("defn.jointNames[1]").unwrap(),
        rig.name(mien::Kind::JOINT, 1).unwrap()
    );
    assert_eq!(dna.field("defn").unwrap().field_type, FieldType::RECORD);
    assert!(!dna.field_name("defn", 0).unwrap().is_empty());
    let layers: Vec<_> = (0..dna.info().layer_count).map(|i| dna.layer(i).unwrap()).collect();
    assert!(layers.iter().any(|layer| layer.code == "bhvr" && layer.layer == Layers::BEHAVIOR));

    let status = |result: mien::Result<Vec<f32>>| result.unwrap_err().status();
    assert_eq!(status(dna.read_floats("defn.nonsense")), Status::NAME);
    assert_eq!(status(dna.read_floats("defn.jointHierarchy")), Status::INVALID_ARGUMENT);
    assert_eq!(status(dna.read_floats("defn\0")), Status::INVALID_ARGUMENT);
    assert!(dna.read_floats("defn").is_err());
    assert!(dna.read_string("defn.jointHierarchy").is_err());
    let mut many = vec![0.0; joints + 1];
    let path = "defn.neutralJointTranslations.xs";
    assert_eq!(dna.read_floats_into(path, 0, &mut many).unwrap_err().status(), Status::INDEX);
    assert!(dna.read_floats_into(path, u64::MAX, &mut many).is_err());
    assert!(dna.layer(usize::MAX).is_err());
}

#[test]
fn machine_learned_behavior_is_generated_on_request() {
    let ml = GenerateOptions::new().preset(Preset::SMALL).with(Generate::ML).generate().unwrap();
    assert!(ml.info().neural_network_count > 0);
    assert_eq!(Dna::generate(Preset::SMALL).unwrap().info().neural_network_count, 0);
}

#[test]
fn parts_are_loaded() {
    let bytes = tiny();
    let dna = OpenOptions::new().layers(Layers::DEFINITION).open_bytes(&bytes).unwrap();
    assert!(dna.info().layers.contains(Layers::DEFINITION));
    assert!(!dna.info().layers.contains(Layers::BEHAVIOR));
    assert_eq!(Rig::new(&dna).unwrap_err().status(), Status::DNA_LAYER);
    let error = OpenOptions::new().lods(1 << 60).open_bytes(&bytes).unwrap_err();
    assert_eq!(error.status(), Status::LOD);
    for skip in [false, true] {
        let options = OpenOptions::new().skip_blend_shape_targets(skip);
        assert_eq!(options.open_bytes(&bytes).unwrap().info().has_blend_shape_targets, !skip);
    }
}

#[test]
fn malformed_files_are_errors() {
    let bytes = tiny();
    for end in 0..bytes.len() {
        // Some ends cut off nothing but what is not needed.
        if let Err(error) = Dna::from_bytes(&bytes[..end]) {
            assert!(!error.message().is_empty());
            assert!(error.byte_offset().map_or(true, |offset| offset <= bytes.len() as u64));
        }
    }
    assert!(Dna::from_bytes(&bytes[..bytes.len() / 2]).is_err());
    let error = Dna::from_bytes(&[]).unwrap_err();
    assert!(matches!(error.status(), Status::DNA_SIGNATURE | Status::DNA_TRUNCATED), "{error}");

    let error = Dna::open("/no/such/file.dna").unwrap_err();
    assert_eq!(error.status(), Status::FILE_OPEN);
    assert!(error.to_string().starts_with("FILE_OPEN: "), "{error}");
    assert_eq!(error.byte_offset(), None);
    assert_eq!(Dna::open("a\0b").unwrap_err().status(), Status::INVALID_ARGUMENT);
    let dna = Dna::generate(Preset::TINY).unwrap();
    assert_eq!(dna.write("/no/such/directory/x.dna").unwrap_err().status(), Status::FILE_WRITE);
}

#[cfg(unix)]
#[test]
fn paths_are_utf8() {
    use std::os::unix::ffi::OsStrExt;
    let path = std::ffi::OsStr::from_bytes(b"\xff.dna");
    assert_eq!(Dna::open(path).unwrap_err().status(), Status::INVALID_ARGUMENT);
}

#[test]
fn reports_list_everything() {
    let bytes = tiny();
    let report = Report::of_bytes(&bytes).unwrap();
    assert_eq!(report.errors(), 0);
    assert_eq!(report.findings().count(), report.warnings());

    let report = Report::of_bytes(&bytes[..bytes.len() * 2 / 3]).unwrap();
    assert!(report.errors() > 0);
    let findings: Vec<_> = report.findings().collect();
    assert_eq!(findings.len(), report.errors() + report.warnings());
    let first = findings.iter().find(|finding| finding.severity == Severity::ERROR).unwrap();
    assert_ne!(first.status, Status::OK);
    assert!(!first.message.is_empty());
    assert_eq!(report.finding(findings.len()).unwrap_err().status(), Status::INDEX);

    let file = TemporaryFile::new("report");
    std::fs::write(&file.0, &bytes).unwrap();
    assert_eq!(Report::of_file(&file.0).unwrap().errors(), 0);
    assert_eq!(Report::of_file("/no/such.dna").unwrap_err().status(), Status::FILE_OPEN);
}
