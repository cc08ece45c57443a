// SPDX-License-Identifier: MIT
// Written by generate_api.py from mien.h. Do not edit.
//! The compiler lays out every struct as the C compiler does.
#![cfg(target_pointer_width = "64")]

use std::mem::{align_of, size_of, MaybeUninit};
use std::ptr::addr_of;

macro_rules! offset {
    ($type:ty, $field:ident) => {{
        let place = MaybeUninit::<$type>::uninit();
        // SAFETY: the address of a field is taken, nothing is read.
        unsafe { addr_of!((*place.as_ptr()).$field) as usize - place.as_ptr() as usize }
    }};
}

#[test]
fn mien_error() {
    use mien_sys::MienError as S;
    assert_eq!(size_of::<S>(), 256);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, byte_offset), 8);
    assert_eq!(offset!(S, status), 16);
    assert_eq!(offset!(S, message), 20);
}

#[test]
fn mien_allocator() {
    use mien_sys::MienAllocator as S;
    assert_eq!(size_of::<S>(), 24);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, user), 0);
    assert_eq!(offset!(S, allocate), 8);
    assert_eq!(offset!(S, release), 16);
}

#[test]
fn mien_parallel_for() {
    use mien_sys::MienParallelFor as S;
    assert_eq!(size_of::<S>(), 16);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, user), 0);
    assert_eq!(offset!(S, run), 8);
}

#[test]
fn mien_string_view() {
    use mien_sys::MienStringView as S;
    assert_eq!(size_of::<S>(), 16);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, data), 0);
    assert_eq!(offset!(S, count), 8);
}

#[test]
fn mien_float_view() {
    use mien_sys::MienFloatView as S;
    assert_eq!(size_of::<S>(), 16);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, data), 0);
    assert_eq!(offset!(S, count), 8);
}

#[test]
fn mien_mutable_float_view() {
    use mien_sys::MienMutableFloatView as S;
    assert_eq!(size_of::<S>(), 16);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, data), 0);
    assert_eq!(offset!(S, count), 8);
}

#[test]
fn mien_index16_view() {
    use mien_sys::MienIndex16View as S;
    assert_eq!(size_of::<S>(), 16);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, data), 0);
    assert_eq!(offset!(S, count), 8);
}

#[test]
fn mien_index32_view() {
    use mien_sys::MienIndex32View as S;
    assert_eq!(size_of::<S>(), 16);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, data), 0);
    assert_eq!(offset!(S, count), 8);
}

#[test]
fn mien_stream() {
    use mien_sys::MienStream as S;
    assert_eq!(size_of::<S>(), 24);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, user), 0);
    assert_eq!(offset!(S, size), 8);
    assert_eq!(offset!(S, read), 16);
}

#[test]
fn mien_coordinate_system() {
    use mien_sys::MienCoordinateSystem as S;
    assert_eq!(size_of::<S>(), 56);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, axes), 8);
    assert_eq!(offset!(S, translation_unit), 20);
    assert_eq!(offset!(S, rotation_unit), 24);
    assert_eq!(offset!(S, rotation_rule), 28);
    assert_eq!(offset!(S, rotation_sequence), 32);
    assert_eq!(offset!(S, rotation_signs), 36);
    assert_eq!(offset!(S, face_winding), 48);
    assert_eq!(offset!(S, reserved), 52);
}

#[test]
fn mien_dna_desc() {
    use mien_sys::MienDnaDesc as S;
    assert_eq!(size_of::<S>(), 48);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, layers), 8);
    assert_eq!(offset!(S, skip_blend_shape_targets), 12);
    assert_eq!(offset!(S, unknown_layers), 16);
    assert_eq!(offset!(S, file_access), 20);
    assert_eq!(offset!(S, lods), 24);
    assert_eq!(offset!(S, system), 32);
    assert_eq!(offset!(S, allocator), 40);
}

#[test]
fn mien_dna_info() {
    use mien_sys::MienDnaInfo as S;
    assert_eq!(size_of::<S>(), 160);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, generation), 8);
    assert_eq!(offset!(S, version), 12);
    assert_eq!(offset!(S, layers), 16);
    assert_eq!(offset!(S, has_blend_shape_targets), 20);
    assert_eq!(offset!(S, file_bytes), 24);
    assert_eq!(offset!(S, memory_bytes), 32);
    assert_eq!(offset!(S, is_mapped), 40);
    assert_eq!(offset!(S, layer_count), 44);
    assert_eq!(offset!(S, translation_unit), 48);
    assert_eq!(offset!(S, rotation_unit), 52);
    assert_eq!(offset!(S, axes), 56);
    assert_eq!(offset!(S, rotation_sequence), 68);
    assert_eq!(offset!(S, rotation_signs), 72);
    assert_eq!(offset!(S, face_winding), 84);
    assert_eq!(offset!(S, lod_count), 88);
    assert_eq!(offset!(S, max_lod), 92);
    assert_eq!(offset!(S, gui_control_count), 96);
    assert_eq!(offset!(S, raw_control_count), 100);
    assert_eq!(offset!(S, psd_control_count), 104);
    assert_eq!(offset!(S, ml_control_count), 108);
    assert_eq!(offset!(S, rbf_control_count), 112);
    assert_eq!(offset!(S, joint_count), 116);
    assert_eq!(offset!(S, joint_group_count), 120);
    assert_eq!(offset!(S, blend_shape_channel_count), 124);
    assert_eq!(offset!(S, animated_map_count), 128);
    assert_eq!(offset!(S, mesh_count), 132);
    assert_eq!(offset!(S, neural_network_count), 136);
    assert_eq!(offset!(S, rbf_solver_count), 140);
    assert_eq!(offset!(S, rbf_pose_count), 144);
    assert_eq!(offset!(S, twist_count), 148);
    assert_eq!(offset!(S, swing_count), 152);
    assert_eq!(offset!(S, metadata_count), 156);
}

#[test]
fn mien_dna_layer() {
    use mien_sys::MienDnaLayer as S;
    assert_eq!(size_of::<S>(), 48);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, layer), 8);
    assert_eq!(offset!(S, version_major), 12);
    assert_eq!(offset!(S, version_minor), 16);
    assert_eq!(offset!(S, is_loaded), 20);
    assert_eq!(offset!(S, byte_offset), 24);
    assert_eq!(offset!(S, byte_count), 32);
    assert_eq!(offset!(S, code), 40);
}

#[test]
fn mien_dna_field() {
    use mien_sys::MienDnaField as S;
    assert_eq!(size_of::<S>(), 32);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, r#type), 8);
    assert_eq!(offset!(S, is_array), 12);
    assert_eq!(offset!(S, count), 16);
    assert_eq!(offset!(S, byte_offset), 24);
}

#[test]
fn mien_write_desc() {
    use mien_sys::MienWriteDesc as S;
    assert_eq!(size_of::<S>(), 16);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, version), 8);
    assert_eq!(offset!(S, unknown_layers), 12);
}

#[test]
fn mien_finding() {
    use mien_sys::MienFinding as S;
    assert_eq!(size_of::<S>(), 56);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, severity), 8);
    assert_eq!(offset!(S, status), 12);
    assert_eq!(offset!(S, byte_offset), 16);
    assert_eq!(offset!(S, field), 24);
    assert_eq!(offset!(S, message), 40);
}

#[test]
fn mien_validate_desc() {
    use mien_sys::MienValidateDesc as S;
    assert_eq!(size_of::<S>(), 16);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, allocator), 8);
}

#[test]
fn mien_rig_desc() {
    use mien_sys::MienRigDesc as S;
    assert_eq!(size_of::<S>(), 40);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, isa), 8);
    assert_eq!(offset!(S, rotation_output), 12);
    assert_eq!(offset!(S, ml_masks), 16);
    assert_eq!(offset!(S, storage), 20);
    assert_eq!(offset!(S, reuse), 24);
    assert_eq!(offset!(S, arithmetic), 28);
    assert_eq!(offset!(S, allocator), 32);
}

#[test]
fn mien_rig_info() {
    use mien_sys::MienRigInfo as S;
    assert_eq!(size_of::<S>(), 88);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, isa), 8);
    assert_eq!(offset!(S, lod_count), 12);
    assert_eq!(offset!(S, translation_unit), 16);
    assert_eq!(offset!(S, rotation_unit), 20);
    assert_eq!(offset!(S, axes), 24);
    assert_eq!(offset!(S, rotation_sequence), 36);
    assert_eq!(offset!(S, rotation_signs), 40);
    assert_eq!(offset!(S, control_count), 52);
    assert_eq!(offset!(S, joint_value_count), 56);
    assert_eq!(offset!(S, rotation_output), 60);
    assert_eq!(offset!(S, storage), 64);
    assert_eq!(offset!(S, arithmetic), 68);
    assert_eq!(offset!(S, rig_bytes), 72);
    assert_eq!(offset!(S, instance_bytes), 80);
}

#[test]
fn mien_rig_statistics() {
    use mien_sys::MienRigStatistics as S;
    assert_eq!(size_of::<S>(), 56);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, lod), 8);
    assert_eq!(offset!(S, psd_count), 12);
    assert_eq!(offset!(S, joint_count), 16);
    assert_eq!(offset!(S, joint_row_count), 20);
    assert_eq!(offset!(S, blend_shape_count), 24);
    assert_eq!(offset!(S, animated_map_row_count), 28);
    assert_eq!(offset!(S, rbf_solver_count), 32);
    assert_eq!(offset!(S, quaternion_joint_count), 36);
    assert_eq!(offset!(S, joint_entry_count), 40);
    assert_eq!(offset!(S, joint_byte_count), 48);
}

#[test]
fn mien_instance_desc() {
    use mien_sys::MienInstanceDesc as S;
    assert_eq!(size_of::<S>(), 16);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, allocator), 8);
}

#[test]
fn mien_instance_statistics() {
    use mien_sys::MienInstanceStatistics as S;
    assert_eq!(size_of::<S>(), 40);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, lod), 8);
    assert_eq!(offset!(S, control_count), 12);
    assert_eq!(offset!(S, active_control_count), 16);
    assert_eq!(offset!(S, joint_column_count), 20);
    assert_eq!(offset!(S, joint_entry_count), 24);
    assert_eq!(offset!(S, joint_byte_count), 32);
}

#[test]
fn mien_batch_desc() {
    use mien_sys::MienBatchDesc as S;
    assert_eq!(size_of::<S>(), 24);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, capacity), 8);
    assert_eq!(offset!(S, tasks), 12);
    assert_eq!(offset!(S, allocator), 16);
}

#[test]
fn mien_deformer_desc() {
    use mien_sys::MienDeformerDesc as S;
    assert_eq!(size_of::<S>(), 40);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, isa), 8);
    assert_eq!(offset!(S, compose), 12);
    assert_eq!(offset!(S, weights), 16);
    assert_eq!(offset!(S, normals), 20);
    assert_eq!(offset!(S, with_tangents), 24);
    assert_eq!(offset!(S, reserved), 28);
    assert_eq!(offset!(S, allocator), 32);
}

#[test]
fn mien_deformer_info() {
    use mien_sys::MienDeformerInfo as S;
    assert_eq!(size_of::<S>(), 56);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, isa), 8);
    assert_eq!(offset!(S, compose), 12);
    assert_eq!(offset!(S, weights), 16);
    assert_eq!(offset!(S, normals), 20);
    assert_eq!(offset!(S, lod_count), 24);
    assert_eq!(offset!(S, joint_count), 28);
    assert_eq!(offset!(S, channel_count), 32);
    assert_eq!(offset!(S, mesh_count), 36);
    assert_eq!(offset!(S, deformer_bytes), 40);
    assert_eq!(offset!(S, instance_bytes), 48);
}

#[test]
fn mien_mesh() {
    use mien_sys::MienMesh as S;
    assert_eq!(size_of::<S>(), 152);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, position_count), 8);
    assert_eq!(offset!(S, vertex_count), 12);
    assert_eq!(offset!(S, triangle_count), 16);
    assert_eq!(offset!(S, max_influences), 20);
    assert_eq!(offset!(S, target_count), 24);
    assert_eq!(offset!(S, delta_count), 28);
    assert_eq!(offset!(S, lods), 32);
    assert_eq!(offset!(S, positions), 40);
    assert_eq!(offset!(S, normals), 56);
    assert_eq!(offset!(S, tangents), 72);
    assert_eq!(offset!(S, texture_coordinates), 88);
    assert_eq!(offset!(S, vertex_position_indices), 104);
    assert_eq!(offset!(S, triangles), 120);
    assert_eq!(offset!(S, target_channels), 136);
}

#[test]
fn mien_deformer_instance_desc() {
    use mien_sys::MienDeformerInstanceDesc as S;
    assert_eq!(size_of::<S>(), 24);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, lods), 8);
    assert_eq!(offset!(S, allocator), 16);
}

#[test]
fn mien_vertex_stream() {
    use mien_sys::MienVertexStream as S;
    assert_eq!(size_of::<S>(), 16);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, data), 0);
    assert_eq!(offset!(S, stride), 8);
    assert_eq!(offset!(S, format), 12);
}

#[test]
fn mien_vertex_output() {
    use mien_sys::MienVertexOutput as S;
    assert_eq!(size_of::<S>(), 64);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, vertex_capacity), 8);
    assert_eq!(offset!(S, positions), 16);
    assert_eq!(offset!(S, normals), 32);
    assert_eq!(offset!(S, tangents), 48);
}

#[test]
fn mien_baked_desc() {
    use mien_sys::MienBakedDesc as S;
    assert_eq!(size_of::<S>(), 24);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, file_access), 8);
    assert_eq!(offset!(S, check), 12);
    assert_eq!(offset!(S, allocator), 16);
}

#[test]
fn mien_baked_info() {
    use mien_sys::MienBakedInfo as S;
    assert_eq!(size_of::<S>(), 48);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, file_bytes), 8);
    assert_eq!(offset!(S, memory_bytes), 16);
    assert_eq!(offset!(S, rig_bytes), 24);
    assert_eq!(offset!(S, deformer_bytes), 32);
    assert_eq!(offset!(S, part_count), 40);
    assert_eq!(offset!(S, is_mapped), 44);
}

#[test]
fn mien_baked_rig_desc() {
    use mien_sys::MienBakedRigDesc as S;
    assert_eq!(size_of::<S>(), 24);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, isa), 8);
    assert_eq!(offset!(S, reuse), 12);
    assert_eq!(offset!(S, allocator), 16);
}

#[test]
fn mien_baked_deformer_desc() {
    use mien_sys::MienBakedDeformerDesc as S;
    assert_eq!(size_of::<S>(), 24);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, isa), 8);
    assert_eq!(offset!(S, normals), 12);
    assert_eq!(offset!(S, allocator), 16);
}

#[test]
fn mien_clip_event() {
    use mien_sys::MienClipEvent as S;
    assert_eq!(size_of::<S>(), 32);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, tick), 0);
    assert_eq!(offset!(S, name), 8);
    assert_eq!(offset!(S, value), 24);
    assert_eq!(offset!(S, reserved), 28);
}

#[test]
fn mien_clip_desc() {
    use mien_sys::MienClipDesc as S;
    assert_eq!(size_of::<S>(), 88);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, rate_numerator), 8);
    assert_eq!(offset!(S, rate_denominator), 12);
    assert_eq!(offset!(S, frame_count), 16);
    assert_eq!(offset!(S, channel_count), 20);
    assert_eq!(offset!(S, names), 24);
    assert_eq!(offset!(S, values), 32);
    assert_eq!(offset!(S, frame_stride), 40);
    assert_eq!(offset!(S, snaps), 48);
    assert_eq!(offset!(S, snap), 56);
    assert_eq!(offset!(S, looping), 60);
    assert_eq!(offset!(S, is_delta), 64);
    assert_eq!(offset!(S, event_count), 68);
    assert_eq!(offset!(S, events), 72);
    assert_eq!(offset!(S, allocator), 80);
}

#[test]
fn mien_clip_open_desc() {
    use mien_sys::MienClipOpenDesc as S;
    assert_eq!(size_of::<S>(), 24);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, file_access), 8);
    assert_eq!(offset!(S, reserved), 12);
    assert_eq!(offset!(S, allocator), 16);
}

#[test]
fn mien_clip_info() {
    use mien_sys::MienClipInfo as S;
    assert_eq!(size_of::<S>(), 88);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, rate_numerator), 8);
    assert_eq!(offset!(S, rate_denominator), 12);
    assert_eq!(offset!(S, frame_count), 16);
    assert_eq!(offset!(S, channel_count), 20);
    assert_eq!(offset!(S, changing_channel_count), 24);
    assert_eq!(offset!(S, event_count), 28);
    assert_eq!(offset!(S, looping), 32);
    assert_eq!(offset!(S, is_delta), 36);
    assert_eq!(offset!(S, snap), 40);
    assert_eq!(offset!(S, is_mapped), 44);
    assert_eq!(offset!(S, ticks_per_frame), 48);
    assert_eq!(offset!(S, length), 56);
    assert_eq!(offset!(S, file_bytes), 64);
    assert_eq!(offset!(S, memory_bytes), 72);
    assert_eq!(offset!(S, player_bytes), 80);
}

#[test]
fn mien_clip_channel() {
    use mien_sys::MienClipChannel as S;
    assert_eq!(size_of::<S>(), 64);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, name), 8);
    assert_eq!(offset!(S, rest), 24);
    assert_eq!(offset!(S, is_changing), 28);
    assert_eq!(offset!(S, zero_blocks), 32);
    assert_eq!(offset!(S, constant_blocks), 36);
    assert_eq!(offset!(S, grid_blocks), 40);
    assert_eq!(offset!(S, float_blocks), 44);
    assert_eq!(offset!(S, bits), 48);
    assert_eq!(offset!(S, max_error), 56);
    assert_eq!(offset!(S, reserved), 60);
}

#[test]
fn mien_clip_player_desc() {
    use mien_sys::MienClipPlayerDesc as S;
    assert_eq!(size_of::<S>(), 48);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, looping), 8);
    assert_eq!(offset!(S, interpolation), 12);
    assert_eq!(offset!(S, speed_numerator), 16);
    assert_eq!(offset!(S, speed_denominator), 20);
    assert_eq!(offset!(S, start_tick), 24);
    assert_eq!(offset!(S, reverse), 32);
    assert_eq!(offset!(S, reserved), 36);
    assert_eq!(offset!(S, allocator), 40);
}

#[test]
fn mien_clip_player_info() {
    use mien_sys::MienClipPlayerInfo as S;
    assert_eq!(size_of::<S>(), 32);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, tick), 8);
    assert_eq!(offset!(S, loops), 16);
    assert_eq!(offset!(S, looping), 24);
    assert_eq!(offset!(S, is_damaged), 28);
}

#[test]
fn mien_matrix_entry() {
    use mien_sys::MienMatrixEntry as S;
    assert_eq!(size_of::<S>(), 40);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, channel), 0);
    assert_eq!(offset!(S, control), 16);
    assert_eq!(offset!(S, weight), 32);
    assert_eq!(offset!(S, reserved), 36);
}

#[test]
fn mien_clip_binding_desc() {
    use mien_sys::MienClipBindingDesc as S;
    assert_eq!(size_of::<S>(), 32);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, matrix), 8);
    assert_eq!(offset!(S, matrix_count), 16);
    assert_eq!(offset!(S, allocator), 24);
}

#[test]
fn mien_clip_binding_info() {
    use mien_sys::MienClipBindingInfo as S;
    assert_eq!(size_of::<S>(), 72);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, channel_count), 8);
    assert_eq!(offset!(S, raw_control_count), 12);
    assert_eq!(offset!(S, missing_entry_count), 16);
    assert_eq!(offset!(S, reserved), 20);
    assert_eq!(offset!(S, controls), 24);
    assert_eq!(offset!(S, extra_controls), 40);
    assert_eq!(offset!(S, missing_channels), 56);
}

#[test]
fn mien_mix_layer() {
    use mien_sys::MienMixLayer as S;
    assert_eq!(size_of::<S>(), 88);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, period), 0);
    assert_eq!(offset!(S, delay), 8);
    assert_eq!(offset!(S, mask), 16);
    assert_eq!(offset!(S, curves), 24);
    assert_eq!(offset!(S, amounts), 32);
    assert_eq!(offset!(S, mask_count), 40);
    assert_eq!(offset!(S, curve_count), 44);
    assert_eq!(offset!(S, group), 48);
    assert_eq!(offset!(S, mode), 52);
    assert_eq!(offset!(S, source), 56);
    assert_eq!(offset!(S, after_guards), 60);
    assert_eq!(offset!(S, weight), 64);
    assert_eq!(offset!(S, first_pose), 68);
    assert_eq!(offset!(S, pose_count), 72);
    assert_eq!(offset!(S, generator), 76);
    assert_eq!(offset!(S, stream_frames), 80);
    assert_eq!(offset!(S, reserved), 84);
}

#[test]
fn mien_mix_pose() {
    use mien_sys::MienMixPose as S;
    assert_eq!(size_of::<S>(), 24);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, curves), 0);
    assert_eq!(offset!(S, values), 8);
    assert_eq!(offset!(S, count), 16);
}

#[test]
fn mien_mix_stroke() {
    use mien_sys::MienMixStroke as S;
    assert_eq!(size_of::<S>(), 56);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, delay), 0);
    assert_eq!(offset!(S, attack), 8);
    assert_eq!(offset!(S, hold), 16);
    assert_eq!(offset!(S, release), 24);
    assert_eq!(offset!(S, pose), 32);
    assert_eq!(offset!(S, mode), 36);
    assert_eq!(offset!(S, is_held), 40);
    assert_eq!(offset!(S, is_lag), 44);
    assert_eq!(offset!(S, is_scaled), 48);
    assert_eq!(offset!(S, reserved), 52);
}

#[test]
fn mien_mix_reaction() {
    use mien_sys::MienMixReaction as S;
    assert_eq!(size_of::<S>(), 64);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, cooldown), 0);
    assert_eq!(offset!(S, adapt_ticks), 8);
    assert_eq!(offset!(S, recover_ticks), 16);
    assert_eq!(offset!(S, strokes), 24);
    assert_eq!(offset!(S, stroke_count), 32);
    assert_eq!(offset!(S, retrigger), 40);
    assert_eq!(offset!(S, after_guards), 44);
    assert_eq!(offset!(S, adapted), 48);
    assert_eq!(offset!(S, level_on), 52);
    assert_eq!(offset!(S, level_off), 56);
    assert_eq!(offset!(S, reserved), 60);
}

#[test]
fn mien_mix_antagonists() {
    use mien_sys::MienMixAntagonists as S;
    assert_eq!(size_of::<S>(), 8);
    assert_eq!(align_of::<S>(), 4);
    assert_eq!(offset!(S, first), 0);
    assert_eq!(offset!(S, second), 2);
    assert_eq!(offset!(S, stiffness), 4);
}

#[test]
fn mien_landmark() {
    use mien_sys::MienLandmark as S;
    assert_eq!(size_of::<S>(), 16);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, points), 0);
    assert_eq!(offset!(S, point_count), 8);
    assert_eq!(offset!(S, mesh), 12);
}

#[test]
fn mien_mix_guard() {
    use mien_sys::MienMixGuard as S;
    assert_eq!(size_of::<S>(), 48);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, upper), 0);
    assert_eq!(offset!(S, lower), 16);
    assert_eq!(offset!(S, closed_by), 32);
    assert_eq!(offset!(S, needs_speech), 36);
    assert_eq!(offset!(S, tolerance), 40);
    assert_eq!(offset!(S, f_on), 44);
}

#[test]
fn mien_mix_desc() {
    use mien_sys::MienMixDesc as S;
    assert_eq!(size_of::<S>(), 168);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, layers), 8);
    assert_eq!(offset!(S, layer_count), 16);
    assert_eq!(offset!(S, poses), 24);
    assert_eq!(offset!(S, pose_count), 32);
    assert_eq!(offset!(S, reactions), 40);
    assert_eq!(offset!(S, reaction_count), 48);
    assert_eq!(offset!(S, antagonists), 56);
    assert_eq!(offset!(S, antagonist_count), 64);
    assert_eq!(offset!(S, mirror), 72);
    assert_eq!(offset!(S, lower), 80);
    assert_eq!(offset!(S, upper), 88);
    assert_eq!(offset!(S, custom_guards), 96);
    assert_eq!(offset!(S, custom_guard_count), 104);
    assert_eq!(offset!(S, gaze), 112);
    assert_eq!(offset!(S, deformer), 120);
    assert_eq!(offset!(S, guards), 128);
    assert_eq!(offset!(S, variable_count), 132);
    assert_eq!(offset!(S, player_count), 136);
    assert_eq!(offset!(S, max_channels), 140);
    assert_eq!(offset!(S, max_changing_channels), 144);
    assert_eq!(offset!(S, max_events), 148);
    assert_eq!(offset!(S, reverse), 152);
    assert_eq!(offset!(S, reserved), 156);
    assert_eq!(offset!(S, allocator), 160);
}

#[test]
fn mien_mix_open_desc() {
    use mien_sys::MienMixOpenDesc as S;
    assert_eq!(size_of::<S>(), 16);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, allocator), 8);
}

#[test]
fn mien_mix_info() {
    use mien_sys::MienMixInfo as S;
    assert_eq!(size_of::<S>(), 48);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, raw_control_count), 8);
    assert_eq!(offset!(S, variable_count), 12);
    assert_eq!(offset!(S, curve_count), 16);
    assert_eq!(offset!(S, layer_count), 20);
    assert_eq!(offset!(S, stage_count), 24);
    assert_eq!(offset!(S, guard_count), 28);
    assert_eq!(offset!(S, mixer_bytes), 32);
    assert_eq!(offset!(S, snapshot_bytes), 40);
}

#[test]
fn mien_mix_guard_info() {
    use mien_sys::MienMixGuardInfo as S;
    assert_eq!(size_of::<S>(), 64);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, curves), 8);
    assert_eq!(offset!(S, gains), 24);
    assert_eq!(offset!(S, pair_count), 40);
    assert_eq!(offset!(S, needs_speech), 44);
    assert_eq!(offset!(S, rest), 48);
    assert_eq!(offset!(S, tolerance), 52);
    assert_eq!(offset!(S, f_on), 56);
    assert_eq!(offset!(S, fit_error), 60);
}

#[test]
fn mien_gaze_desc() {
    use mien_sys::MienGazeDesc as S;
    assert_eq!(size_of::<S>(), 32);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, left_eye), 8);
    assert_eq!(offset!(S, right_eye), 16);
    assert_eq!(offset!(S, allocator), 24);
}

#[test]
fn mien_gaze_target() {
    use mien_sys::MienGazeTarget as S;
    assert_eq!(size_of::<S>(), 12);
    assert_eq!(align_of::<S>(), 4);
    assert_eq!(offset!(S, left), 0);
    assert_eq!(offset!(S, up), 4);
    assert_eq!(offset!(S, front), 8);
}

#[test]
fn mien_gaze_info() {
    use mien_sys::MienGazeInfo as S;
    assert_eq!(size_of::<S>(), 40);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, left_eye), 8);
    assert_eq!(offset!(S, right_eye), 20);
    assert_eq!(offset!(S, fit_error), 32);
    assert_eq!(offset!(S, reserved), 36);
}

#[test]
fn mien_gaze_rest() {
    use mien_sys::MienGazeRest as S;
    assert_eq!(size_of::<S>(), 8);
    assert_eq!(align_of::<S>(), 4);
    assert_eq!(offset!(S, left), 0);
    assert_eq!(offset!(S, up), 4);
}

#[test]
fn mien_mixer_desc() {
    use mien_sys::MienMixerDesc as S;
    assert_eq!(size_of::<S>(), 32);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, seed), 8);
    assert_eq!(offset!(S, stages), 16);
    assert_eq!(offset!(S, reserved), 20);
    assert_eq!(offset!(S, allocator), 24);
}

#[test]
fn mien_play_desc() {
    use mien_sys::MienPlayDesc as S;
    assert_eq!(size_of::<S>(), 56);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, clip_id), 8);
    assert_eq!(offset!(S, start_tick), 16);
    assert_eq!(offset!(S, transition_ticks), 24);
    assert_eq!(offset!(S, transition), 32);
    assert_eq!(offset!(S, looping), 36);
    assert_eq!(offset!(S, interpolation), 40);
    assert_eq!(offset!(S, speed_numerator), 44);
    assert_eq!(offset!(S, speed_denominator), 48);
    assert_eq!(offset!(S, mirrored), 52);
}

#[test]
fn mien_guard_state() {
    use mien_sys::MienGuardState as S;
    assert_eq!(size_of::<S>(), 64);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, name), 8);
    assert_eq!(offset!(S, controls), 24);
    assert_eq!(offset!(S, kind), 40);
    assert_eq!(offset!(S, activation), 44);
    assert_eq!(offset!(S, protected_distance), 48);
    assert_eq!(offset!(S, wanted), 52);
    assert_eq!(offset!(S, limit), 56);
    assert_eq!(offset!(S, distance), 60);
}

#[test]
fn mien_mixer_info() {
    use mien_sys::MienMixerInfo as S;
    assert_eq!(size_of::<S>(), 24);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, tick), 8);
    assert_eq!(offset!(S, event_count), 16);
    assert_eq!(offset!(S, lost_events), 20);
}

#[test]
fn mien_mixer_clip() {
    use mien_sys::MienMixerClip as S;
    assert_eq!(size_of::<S>(), 24);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, clip_id), 0);
    assert_eq!(offset!(S, clip), 8);
    assert_eq!(offset!(S, clip_binding), 16);
}

#[test]
fn mien_aim_solver() {
    use mien_sys::MienAimSolver as S;
    assert_eq!(size_of::<S>(), 56);
    assert_eq!(align_of::<S>(), 4);
    assert_eq!(offset!(S, joint), 0);
    assert_eq!(offset!(S, target_joint), 4);
    assert_eq!(offset!(S, target_curve), 8);
    assert_eq!(offset!(S, axis), 12);
    assert_eq!(offset!(S, up_axis), 24);
    assert_eq!(offset!(S, up), 36);
    assert_eq!(offset!(S, cone_degrees), 48);
    assert_eq!(offset!(S, weight), 52);
}

#[test]
fn mien_space_solver() {
    use mien_sys::MienSpaceSolver as S;
    assert_eq!(size_of::<S>(), 32);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, ease_ticks), 0);
    assert_eq!(offset!(S, spaces), 8);
    assert_eq!(offset!(S, space_count), 16);
    assert_eq!(offset!(S, curve), 20);
    assert_eq!(offset!(S, joint), 24);
    assert_eq!(offset!(S, reserved), 28);
}

#[test]
fn mien_spring_solver() {
    use mien_sys::MienSpringSolver as S;
    assert_eq!(size_of::<S>(), 32);
    assert_eq!(align_of::<S>(), 4);
    assert_eq!(offset!(S, joint), 0);
    assert_eq!(offset!(S, frequency), 4);
    assert_eq!(offset!(S, damping), 8);
    assert_eq!(offset!(S, rest_offset), 12);
    assert_eq!(offset!(S, stretch), 24);
    assert_eq!(offset!(S, teleport), 28);
}

#[test]
fn mien_twist_solver() {
    use mien_sys::MienTwistSolver as S;
    assert_eq!(size_of::<S>(), 40);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, joints), 0);
    assert_eq!(offset!(S, shares), 8);
    assert_eq!(offset!(S, joint_count), 16);
    assert_eq!(offset!(S, source), 20);
    assert_eq!(offset!(S, axis), 24);
    assert_eq!(offset!(S, reserved), 36);
}

#[test]
fn mien_copy_solver() {
    use mien_sys::MienCopySolver as S;
    assert_eq!(size_of::<S>(), 28);
    assert_eq!(align_of::<S>(), 4);
    assert_eq!(offset!(S, source), 0);
    assert_eq!(offset!(S, joint), 4);
    assert_eq!(offset!(S, is_mirrored), 8);
    assert_eq!(offset!(S, mirror_axis), 12);
    assert_eq!(offset!(S, weight), 24);
}

#[test]
fn mien_solver_pose() {
    use mien_sys::MienSolverPose as S;
    assert_eq!(size_of::<S>(), 56);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, locals), 0);
    assert_eq!(offset!(S, models), 8);
    assert_eq!(offset!(S, previous), 16);
    assert_eq!(offset!(S, row), 24);
    assert_eq!(offset!(S, outputs), 32);
    assert_eq!(offset!(S, state), 40);
    assert_eq!(offset!(S, lod), 48);
    assert_eq!(offset!(S, is_reset), 52);
}

#[test]
fn mien_solver_call() {
    use mien_sys::MienSolverCall as S;
    assert_eq!(size_of::<S>(), 32);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, poses), 0);
    assert_eq!(offset!(S, parents), 8);
    assert_eq!(offset!(S, ticks), 16);
    assert_eq!(offset!(S, pose_count), 24);
    assert_eq!(offset!(S, joint_count), 28);
}

#[test]
fn mien_user_solver() {
    use mien_sys::MienUserSolver as S;
    assert_eq!(size_of::<S>(), 64);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, user), 0);
    assert_eq!(offset!(S, solve), 8);
    assert_eq!(offset!(S, reads), 16);
    assert_eq!(offset!(S, writes), 24);
    assert_eq!(offset!(S, previous_joints), 32);
    assert_eq!(offset!(S, read_count), 40);
    assert_eq!(offset!(S, write_count), 44);
    assert_eq!(offset!(S, previous_joint_count), 48);
    assert_eq!(offset!(S, state_bytes), 52);
    assert_eq!(offset!(S, output_count), 56);
    assert_eq!(offset!(S, reserved), 60);
}

#[test]
fn mien_solver() {
    use mien_sys::MienSolver as S;
    assert_eq!(size_of::<S>(), 64);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, name), 0);
    assert_eq!(offset!(S, aim), 8);
    assert_eq!(offset!(S, space), 16);
    assert_eq!(offset!(S, spring), 24);
    assert_eq!(offset!(S, twist), 32);
    assert_eq!(offset!(S, copy), 40);
    assert_eq!(offset!(S, custom), 48);
    assert_eq!(offset!(S, lods), 56);
}

#[test]
fn mien_solver_stack_desc() {
    use mien_sys::MienSolverStackDesc as S;
    assert_eq!(size_of::<S>(), 40);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, solvers), 8);
    assert_eq!(offset!(S, solver_count), 16);
    assert_eq!(offset!(S, curve_count), 24);
    assert_eq!(offset!(S, check_writes), 28);
    assert_eq!(offset!(S, allocator), 32);
}

#[test]
fn mien_solver_stack_info() {
    use mien_sys::MienSolverStackInfo as S;
    assert_eq!(size_of::<S>(), 32);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, solver_count), 8);
    assert_eq!(offset!(S, curve_count), 12);
    assert_eq!(offset!(S, output_count), 16);
    assert_eq!(offset!(S, joint_count), 20);
    assert_eq!(offset!(S, state_bytes), 24);
}

#[test]
fn mien_solver_state_desc() {
    use mien_sys::MienSolverStateDesc as S;
    assert_eq!(size_of::<S>(), 16);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, allocator), 8);
}

#[test]
fn mien_solver_input() {
    use mien_sys::MienSolverInput as S;
    assert_eq!(size_of::<S>(), 24);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, row), 0);
    assert_eq!(offset!(S, row_count), 8);
    assert_eq!(offset!(S, lod), 16);
    assert_eq!(offset!(S, is_reset), 20);
}

#[test]
fn mien_generate_desc() {
    use mien_sys::MienGenerateDesc as S;
    assert_eq!(size_of::<S>(), 32);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, preset), 8);
    assert_eq!(offset!(S, flags), 12);
    assert_eq!(offset!(S, seed), 16);
    assert_eq!(offset!(S, allocator), 24);
}

#[test]
fn mien_author_object() {
    use mien_sys::MienAuthorObject as S;
    assert_eq!(size_of::<S>(), 24);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, name), 0);
    assert_eq!(offset!(S, first_face), 16);
    assert_eq!(offset!(S, face_count), 20);
}

#[test]
fn mien_author_shape() {
    use mien_sys::MienAuthorShape as S;
    assert_eq!(size_of::<S>(), 40);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, name), 0);
    assert_eq!(offset!(S, positions), 16);
    assert_eq!(offset!(S, position_count), 24);
    assert_eq!(offset!(S, displacements), 32);
}

#[test]
fn mien_author_mesh() {
    use mien_sys::MienAuthorMesh as S;
    assert_eq!(size_of::<S>(), 112);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, positions), 8);
    assert_eq!(offset!(S, position_count), 16);
    assert_eq!(offset!(S, face_sizes), 24);
    assert_eq!(offset!(S, face_count), 32);
    assert_eq!(offset!(S, corners), 40);
    assert_eq!(offset!(S, corner_count), 48);
    assert_eq!(offset!(S, uvs), 56);
    assert_eq!(offset!(S, uv_count), 64);
    assert_eq!(offset!(S, corner_uvs), 72);
    assert_eq!(offset!(S, objects), 80);
    assert_eq!(offset!(S, object_count), 88);
    assert_eq!(offset!(S, shapes), 96);
    assert_eq!(offset!(S, shape_count), 104);
}

#[test]
fn mien_author_bone() {
    use mien_sys::MienAuthorBone as S;
    assert_eq!(size_of::<S>(), 48);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, name), 0);
    assert_eq!(offset!(S, position), 16);
    assert_eq!(offset!(S, parent), 40);
    assert_eq!(offset!(S, kind), 44);
}

#[test]
fn mien_author_lod() {
    use mien_sys::MienAuthorLod as S;
    assert_eq!(size_of::<S>(), 24);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, corners), 0);
    assert_eq!(offset!(S, corner_count), 8);
    assert_eq!(offset!(S, corner_uvs), 16);
}

#[test]
fn mien_author_desc() {
    use mien_sys::MienAuthorDesc as S;
    assert_eq!(size_of::<S>(), 224);
    assert_eq!(align_of::<S>(), 8);
    assert_eq!(offset!(S, struct_size), 0);
    assert_eq!(offset!(S, facial_joints), 8);
    assert_eq!(offset!(S, influences), 12);
    assert_eq!(offset!(S, lods), 16);
    assert_eq!(offset!(S, groups), 20);
    assert_eq!(offset!(S, seed), 24);
    assert_eq!(offset!(S, unit), 32);
    assert_eq!(offset!(S, up), 40);
    assert_eq!(offset!(S, front), 44);
    assert_eq!(offset!(S, symmetry), 48);
    assert_eq!(offset!(S, flags), 52);
    assert_eq!(offset!(S, name), 56);
    assert_eq!(offset!(S, face_object), 72);
    assert_eq!(offset!(S, bones), 88);
    assert_eq!(offset!(S, bone_count), 96);
    assert_eq!(offset!(S, weight_joints), 104);
    assert_eq!(offset!(S, weights), 112);
    assert_eq!(offset!(S, parallel), 120);
    assert_eq!(offset!(S, progress_user), 128);
    assert_eq!(offset!(S, progress), 136);
    assert_eq!(offset!(S, allocator), 144);
    assert_eq!(offset!(S, depth_groups), 152);
    assert_eq!(offset!(S, mask), 160);
    assert_eq!(offset!(S, lod_joints), 168);
    assert_eq!(offset!(S, bone_groups), 176);
    assert_eq!(offset!(S, bone_motions), 184);
    assert_eq!(offset!(S, joint_groups), 192);
    assert_eq!(offset!(S, overlap_correctives), 196);
    assert_eq!(offset!(S, lod_triangles), 200);
    assert_eq!(offset!(S, lod_meshes), 208);
    assert_eq!(offset!(S, lod_mesh_count), 216);
}
