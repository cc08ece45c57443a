// SPDX-License-Identifier: MIT
//! Whether the crate keeps the rules of Rust about pointers, which Miri watches. Miri cannot call
//! C, so the functions of the library that make, drive and destroy are written here once more, as
//! little as it takes: the same pointers, the same memory shared between inputs and outputs.
//!
//!     cargo +nightly miri test --test aliasing
#![cfg(miri)]

use mien::{Allocator, Dna, Instance, Rig};
use mien_sys::*;
use std::os::raw::{c_char, c_void};
use std::ptr::{addr_of_mut, null_mut};

/// Stands for each of the three handles.
struct Object {
    allocator: Option<MienAllocator>,
    controls: [f32; 4], // two raw, two computed
    joints: [f32; 9],
    bytes: *const u8,
}

unsafe fn create(allocator: *const MienAllocator, bytes: *const u8) -> *mut c_void {
    let allocator = allocator.as_ref().copied();
    let (size, alignment) = (std::mem::size_of::<Object>(), 64);
    let block = match &allocator {
        Some(given) => given.allocate.unwrap()(given.user, size, alignment),
        None => {
            let layout = std::alloc::Layout::from_size_align(size, alignment).unwrap();
            std::alloc::alloc(layout).cast()
        }
    };
    let object = Object { allocator, controls: [0.0; 4], joints: [0.0; 9], bytes };
    block.cast::<Object>().write(object);
    block
}

unsafe fn destroy(handle: *mut c_void) {
    if handle.is_null() {
        return; // as the library does
    }
    let (size, alignment) = (std::mem::size_of::<Object>(), 64);
    match handle.cast::<Object>().read().allocator {
        Some(given) => given.release.unwrap()(given.user, handle, size, alignment),
        None => {
            let layout = std::alloc::Layout::from_size_align(size, alignment).unwrap();
            std::alloc::dealloc(handle.cast(), layout);
        }
    }
}

macro_rules! exported {
    ($(fn $name:ident($($parameter:ident: $type:ty),*) $(-> $result:ty)? $body:block)*) => {
        $(#[no_mangle] unsafe extern "C" fn $name($($parameter: $type),*) $(-> $result)? $body)*
    };
}

exported! {
    fn mien_dna_open_memory(bytes: *const c_void, _size: usize, desc: *const MienDnaDesc,
            out: *mut *mut MienDna, _error: *mut MienError) -> MienStatus {
        *out = create((*desc).allocator, bytes.cast()).cast();
        MIEN_OK
    }
    fn mien_dna_open_file(_path: *const c_char, _desc: *const MienDnaDesc,
            out: *mut *mut MienDna, error: *mut MienError) -> MienStatus {
        *out = null_mut();
        (*error).message[0] = b'x' as c_char;
        MIEN_ERROR_FILE_OPEN
    }
    fn mien_dna_info(_dna: *const MienDna, out: *mut MienDnaInfo) -> MienStatus {
        (*out).joint_count = 1;
        MIEN_OK
    }
    fn mien_dna_read_string(dna: *const MienDna, _path: *const c_char, out: *mut MienStringView,
            _error: *mut MienError) -> MienStatus {
        *out = MienStringView { data: (*dna.cast::<Object>()).bytes.cast(), count: 3 };
        MIEN_OK
    }
    fn mien_dna_write_memory(_dna: *const MienDna, _desc: *const MienWriteDesc, buffer: *mut c_void,
            capacity: usize, out_size: *mut usize, _error: *mut MienError) -> MienStatus {
        *out_size = 5;
        if capacity >= 5 {
            buffer.cast::<u8>().write_bytes(7, 5);
        }
        MIEN_OK
    }
    fn mien_dna_close(dna: *mut MienDna) { destroy(dna.cast()) }

    fn mien_rig_create(_dna: *const MienDna, desc: *const MienRigDesc, out: *mut *mut MienRig,
            _error: *mut MienError) -> MienStatus {
        *out = create((*desc).allocator, std::ptr::null()).cast();
        MIEN_OK
    }
    fn mien_rig_info(_rig: *const MienRig, _out: *mut MienRigInfo) -> MienStatus { MIEN_OK }
    fn mien_rig_neutral_joint_values(rig: *const MienRig, out: *mut MienFloatView) -> MienStatus {
        *out = MienFloatView { data: std::ptr::addr_of!((*rig.cast::<Object>()).joints).cast(), count: 9 };
        MIEN_OK
    }
    fn mien_rig_destroy(rig: *mut MienRig) { destroy(rig.cast()) }

    fn mien_instance_create(_rig: *const MienRig, desc: *const MienInstanceDesc,
            out: *mut *mut MienInstance, _error: *mut MienError) -> MienStatus {
        *out = create((*desc).allocator, std::ptr::null()).cast();
        MIEN_OK
    }
    fn mien_instance_destroy(instance: *mut MienInstance) { destroy(instance.cast()) }
    fn mien_instance_reset(_instance: *mut MienInstance) -> MienStatus { MIEN_OK }
    fn mien_rig_evaluate(_rig: *const MienRig, instance: *mut MienInstance, _lod: u32) -> MienStatus {
        let object = instance.cast::<Object>();
        (*object).controls[2] = (*object).controls[0] * (*object).controls[1];
        (*object).joints[0] = (*object).controls[2];
        MIEN_OK
    }
    fn mien_instance_raw_controls(instance: *mut MienInstance, out: *mut MienMutableFloatView) -> MienStatus {
        let data = addr_of_mut!((*instance.cast::<Object>()).controls).cast();
        *out = MienMutableFloatView { data, count: 2 };
        MIEN_OK
    }
    fn mien_instance_gui_controls(_instance: *mut MienInstance, _out: *mut MienMutableFloatView) -> MienStatus { MIEN_OK }
    fn mien_instance_ml_masks(_instance: *mut MienInstance, _out: *mut MienMutableFloatView) -> MienStatus { MIEN_OK }
    fn mien_instance_controls(instance: *const MienInstance, out: *mut MienFloatView) -> MienStatus {
        // The whole row: what is raw in it is also given out as an input.
        let data = addr_of_mut!((*(instance as *mut Object)).controls) as *const f32;
        *out = MienFloatView { data, count: 4 };
        MIEN_OK
    }
    fn mien_instance_joints(instance: *const MienInstance, out: *mut MienFloatView) -> MienStatus {
        let data = addr_of_mut!((*(instance as *mut Object)).joints) as *const f32;
        *out = MienFloatView { data, count: 9 };
        MIEN_OK
    }
    fn mien_instance_psd_controls(_instance: *const MienInstance, _out: *mut MienFloatView) -> MienStatus { MIEN_OK }
    fn mien_instance_ml_controls(_instance: *const MienInstance, _out: *mut MienFloatView) -> MienStatus { MIEN_OK }
    fn mien_instance_rbf_controls(_instance: *const MienInstance, _out: *mut MienFloatView) -> MienStatus { MIEN_OK }
    fn mien_instance_blend_shapes(_instance: *const MienInstance, _out: *mut MienFloatView) -> MienStatus { MIEN_OK }
    fn mien_instance_animated_maps(_instance: *const MienInstance, _out: *mut MienFloatView) -> MienStatus { MIEN_OK }
    fn mien_status_name(_status: MienStatus) -> *const c_char { b"NAME\0".as_ptr().cast() }
}

fn drive(face: &mut Instance) {
    for frame in 1..4 {
        let controls = face.raw_controls_mut();
        controls[0] = frame as f32;
        controls[1] = 2.0;
        face.evaluate(0).unwrap();
        let (raw, all, joints) = (face.raw_controls(), face.controls(), face.joints());
        assert_eq!(raw, &all[..2]);
        assert_eq!(all[2], joints[0]);
        assert_eq!(joints[0], frame as f32 * 2.0);
        assert!(face.gui_controls_mut().is_empty() && face.blend_shapes().is_empty());
    }
    face.reset().unwrap();
}

#[test]
fn views_keep_the_rules() {
    let file = b"dna".to_vec();
    let dna = Dna::from_bytes(&file).unwrap();
    assert_eq!(dna.read_string("x").unwrap(), "dna");
    assert_eq!(dna.to_bytes().unwrap(), [7; 5]);
    let rig = Rig::new(&dna).unwrap();
    drop(dna);
    drop(file);
    let mut face = rig.instance().unwrap();
    assert_eq!(rig.neutral_joint_values(), [0.0; 9]);
    drop(rig);
    drive(&mut face);
    let mut face = std::thread::spawn(move || {
        drive(&mut face);
        face
    })
    .join()
    .unwrap();
    drive(&mut face);
    std::thread::scope(|threads| {
        for _ in 0..2 {
            threads.spawn(|| assert_eq!(face.joints()[0], 6.0));
        }
    });
}

#[test]
fn allocators_outlive_what_they_gave() {
    let memory = Allocator::new(std::alloc::System);
    let dna = mien::OpenOptions::new().allocator(&memory).open_bytes(b"dna").unwrap();
    let rig = mien::RigOptions::new().allocator(&memory).create(&dna).unwrap();
    let mut face = Instance::new_in(&rig, &memory).unwrap();
    drop(memory);
    drop(dna);
    drop(rig);
    drive(&mut face);
}

#[test]
fn errors_are_copied_out() {
    let error = Dna::open("x").unwrap_err();
    assert_eq!(error.to_string(), "NAME: x");
}
