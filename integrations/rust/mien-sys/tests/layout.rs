// SPDX-License-Identifier: MIT
// Code generated from integrations/api/mien_api.json by generate.py; run ./dev api. DO NOT EDIT.
//! The compiler lays out every struct as the C compiler does.
#![cfg(target_pointer_width = "64")]

use std::mem::{align_of, size_of, MaybeUninit};
use std::ptr::addr_of;

/// Of each struct its name, size and alignment, then its fields and where they begin.
macro_rules! layouts {
    ($($type:ident $size:literal $alignment:literal: $($field:ident $offset:literal)*;)*) => {$({
        use mien_sys::$type as S;
        let name = stringify!($type);
        assert_eq!((size_of::<S>(), align_of::<S>()), ($size, $alignment), "{name}");
        let place = MaybeUninit::<S>::uninit();
        let start = place.as_ptr();
        $(
            // SAFETY: the address of a field is taken, nothing is read.
            let at = unsafe { addr_of!((*start).$field) as usize - start as usize };
            assert_eq!(at, $offset, "{name}.{}", stringify!($field));
        )*
        let _ = start;
    })*};
}

#[test]
fn structs_are_laid_out_as_in_c() {
    layouts! {
        MienError 256 8: struct_size 0 byte_offset 8 status 16 message 20;
        MienAllocator 24 8: user 0 allocate 8 release 16;
        MienParallelFor 16 8: user 0 run 8;
        MienStringView 16 8: data 0 count 8;
        MienFloatView 16 8: data 0 count 8;
        MienMutableFloatView 16 8: data 0 count 8;
        MienIndex16View 16 8: data 0 count 8;
        MienIndex32View 16 8: data 0 count 8;
        MienStream 24 8: user 0 size 8 read 16;
        MienCoordinateSystem 56 8: struct_size 0 axes 8 translation_unit 20 rotation_unit 24
            rotation_rule 28 rotation_sequence 32 rotation_signs 36 face_winding 48 reserved 52;
        MienDnaDesc 48 8: struct_size 0 layers 8 skip_blend_shape_targets 12 unknown_layers 16
            file_access 20 lods 24 system 32 allocator 40;
        MienDnaInfo 160 8: struct_size 0 generation 8 version 12 layers 16 has_blend_shape_targets
            20 file_bytes 24 memory_bytes 32 is_mapped 40 layer_count 44 translation_unit 48
            rotation_unit 52 axes 56 rotation_sequence 68 rotation_signs 72 face_winding 84
            lod_count 88 max_lod 92 gui_control_count 96 raw_control_count 100 psd_control_count 104
            ml_control_count 108 rbf_control_count 112 joint_count 116 joint_group_count 120
            blend_shape_channel_count 124 animated_map_count 128 mesh_count 132 neural_network_count
            136 rbf_solver_count 140 rbf_pose_count 144 twist_count 148 swing_count 152
            metadata_count 156;
        MienDnaLayer 48 8: struct_size 0 layer 8 version_major 12 version_minor 16 is_loaded 20
            byte_offset 24 byte_count 32 code 40;
        MienDnaField 32 8: struct_size 0 r#type 8 is_array 12 count 16 byte_offset 24;
        MienWriteDesc 16 8: struct_size 0 version 8 unknown_layers 12;
        MienFinding 56 8: struct_size 0 severity 8 status 12 byte_offset 16 field 24 message 40;
        MienValidateDesc 16 8: struct_size 0 allocator 8;
        MienRigDesc 40 8: struct_size 0 isa 8 rotation_output 12 ml_masks 16 storage 20 reuse 24
            arithmetic 28 allocator 32;
        MienRigInfo 88 8: struct_size 0 isa 8 lod_count 12 translation_unit 16 rotation_unit 20 axes
            24 rotation_sequence 36 rotation_signs 40 control_count 52 joint_value_count 56
            rotation_output 60 storage 64 arithmetic 68 rig_bytes 72 instance_bytes 80;
        MienRigStatistics 56 8: struct_size 0 lod 8 psd_count 12 joint_count 16 joint_row_count 20
            blend_shape_count 24 animated_map_row_count 28 rbf_solver_count 32
            quaternion_joint_count 36 joint_entry_count 40 joint_byte_count 48;
        MienInstanceDesc 16 8: struct_size 0 allocator 8;
        MienInstanceStatistics 40 8: struct_size 0 lod 8 control_count 12 active_control_count 16
            joint_column_count 20 joint_entry_count 24 joint_byte_count 32;
        MienBatchDesc 24 8: struct_size 0 capacity 8 tasks 12 allocator 16;
        MienDeformerDesc 48 8: struct_size 0 isa 8 compose 12 weights 16 normals 20 with_tangents 24
            storage 28 allocator 32 delta_error 40;
        MienDeformerInfo 64 8: struct_size 0 isa 8 compose 12 weights 16 normals 20 lod_count 24
            joint_count 28 channel_count 32 mesh_count 36 deformer_bytes 40 instance_bytes 48
            storage 56 reserved 60;
        MienMesh 152 8: struct_size 0 position_count 8 vertex_count 12 triangle_count 16
            max_influences 20 target_count 24 delta_count 28 lods 32 positions 40 normals 56
            tangents 72 texture_coordinates 88 vertex_position_indices 104 triangles 120
            target_channels 136;
        MienDeformerInstanceDesc 24 8: struct_size 0 lods 8 allocator 16;
        MienVertexStream 16 8: data 0 stride 8 format 12;
        MienVertexOutput 64 8: struct_size 0 vertex_capacity 8 positions 16 normals 32 tangents 48;
        MienDerivativesDesc 24 8: struct_size 0 deformer 8 allocator 16;
        MienJacobianDesc 64 8: struct_size 0 from_point 8 to_point 12 mesh 16 lod 20 inputs 24
            outputs 32 input_count 40 output_count 48 allocator 56;
        MienJacobianPattern 64 8: struct_size 0 rows 8 columns 24 row_count 40 column_count 48
            direction_count 56;
        MienBakedDesc 24 8: struct_size 0 file_access 8 check 12 allocator 16;
        MienBakedInfo 48 8: struct_size 0 file_bytes 8 memory_bytes 16 rig_bytes 24 deformer_bytes
            32 part_count 40 is_mapped 44;
        MienBakedRigDesc 24 8: struct_size 0 isa 8 reuse 12 allocator 16;
        MienBakedDeformerDesc 24 8: struct_size 0 isa 8 normals 12 allocator 16;
        MienClipEvent 32 8: tick 0 name 8 value 24 reserved 28;
        MienClipDesc 88 8: struct_size 0 rate_numerator 8 rate_denominator 12 frame_count 16
            channel_count 20 names 24 values 32 frame_stride 40 snaps 48 snap 56 looping 60 is_delta
            64 event_count 68 events 72 allocator 80;
        MienClipOpenDesc 24 8: struct_size 0 file_access 8 reserved 12 allocator 16;
        MienClipInfo 88 8: struct_size 0 rate_numerator 8 rate_denominator 12 frame_count 16
            channel_count 20 changing_channel_count 24 event_count 28 looping 32 is_delta 36 snap 40
            is_mapped 44 ticks_per_frame 48 length 56 file_bytes 64 memory_bytes 72 player_bytes 80;
        MienClipChannel 64 8: struct_size 0 name 8 rest 24 is_changing 28 zero_blocks 32
            constant_blocks 36 grid_blocks 40 float_blocks 44 bits 48 max_error 56 reserved 60;
        MienClipPlayerDesc 48 8: struct_size 0 looping 8 interpolation 12 speed_numerator 16
            speed_denominator 20 start_tick 24 reverse 32 reserved 36 allocator 40;
        MienClipPlayerInfo 32 8: struct_size 0 tick 8 loops 16 looping 24 is_damaged 28;
        MienMatrixEntry 40 8: channel 0 control 16 weight 32 reserved 36;
        MienClipBindingDesc 32 8: struct_size 0 matrix 8 matrix_count 16 allocator 24;
        MienClipBindingInfo 72 8: struct_size 0 channel_count 8 raw_control_count 12
            missing_entry_count 16 reserved 20 controls 24 extra_controls 40 missing_channels 56;
        MienMixLayer 88 8: period 0 delay 8 mask 16 curves 24 amounts 32 mask_count 40 curve_count
            44 group 48 mode 52 source 56 after_guards 60 weight 64 first_pose 68 pose_count 72
            generator 76 stream_frames 80 reserved 84;
        MienMixPose 24 8: curves 0 values 8 count 16;
        MienMixStroke 56 8: delay 0 attack 8 hold 16 release 24 pose 32 mode 36 is_held 40 is_lag 44
            is_scaled 48 reserved 52;
        MienMixReaction 64 8: cooldown 0 adapt_ticks 8 recover_ticks 16 strokes 24 stroke_count 32
            retrigger 40 after_guards 44 adapted 48 level_on 52 level_off 56 reserved 60;
        MienMixAntagonists 8 4: first 0 second 2 stiffness 4;
        MienLandmark 16 8: points 0 point_count 8 mesh 12;
        MienMixGuard 48 8: upper 0 lower 16 closed_by 32 needs_speech 36 tolerance 40 f_on 44;
        MienMixDesc 168 8: struct_size 0 layers 8 layer_count 16 poses 24 pose_count 32 reactions 40
            reaction_count 48 antagonists 56 antagonist_count 64 mirror 72 lower 80 upper 88
            custom_guards 96 custom_guard_count 104 gaze 112 deformer 120 guards 128 variable_count
            132 player_count 136 max_channels 140 max_changing_channels 144 max_events 148 reverse
            152 reserved 156 allocator 160;
        MienMixOpenDesc 16 8: struct_size 0 allocator 8;
        MienMixInfo 48 8: struct_size 0 raw_control_count 8 variable_count 12 curve_count 16
            layer_count 20 stage_count 24 guard_count 28 mixer_bytes 32 snapshot_bytes 40;
        MienMixGuardInfo 64 8: struct_size 0 curves 8 gains 24 pair_count 40 needs_speech 44 rest 48
            tolerance 52 f_on 56 fit_error 60;
        MienGazeDesc 32 8: struct_size 0 left_eye 8 right_eye 16 allocator 24;
        MienGazeTarget 12 4: left 0 up 4 front 8;
        MienGazeInfo 40 8: struct_size 0 left_eye 8 right_eye 20 fit_error 32 reserved 36;
        MienGazeRest 8 4: left 0 up 4;
        MienMixerDesc 32 8: struct_size 0 seed 8 stages 16 reserved 20 allocator 24;
        MienPlayDesc 56 8: struct_size 0 clip_id 8 start_tick 16 transition_ticks 24 transition 32
            looping 36 interpolation 40 speed_numerator 44 speed_denominator 48 mirrored 52;
        MienGuardState 64 8: struct_size 0 name 8 controls 24 kind 40 activation 44
            protected_distance 48 wanted 52 limit 56 distance 60;
        MienMixerInfo 24 8: struct_size 0 tick 8 event_count 16 lost_events 20;
        MienMixerClip 24 8: clip_id 0 clip 8 clip_binding 16;
        MienAimSolver 56 4: joint 0 target_joint 4 target_curve 8 axis 12 up_axis 24 up 36
            cone_degrees 48 weight 52;
        MienSpaceSolver 32 8: ease_ticks 0 spaces 8 space_count 16 curve 20 joint 24 reserved 28;
        MienSpringSolver 32 4: joint 0 frequency 4 damping 8 rest_offset 12 stretch 24 teleport 28;
        MienTwistSolver 40 8: joints 0 shares 8 joint_count 16 source 20 axis 24 reserved 36;
        MienCopySolver 28 4: source 0 joint 4 is_mirrored 8 mirror_axis 12 weight 24;
        MienSolverPose 56 8: locals 0 models 8 previous 16 row 24 outputs 32 state 40 lod 48
            is_reset 52;
        MienSolverCall 32 8: poses 0 parents 8 ticks 16 pose_count 24 joint_count 28;
        MienUserSolver 64 8: user 0 solve 8 reads 16 writes 24 previous_joints 32 read_count 40
            write_count 44 previous_joint_count 48 state_bytes 52 output_count 56 reserved 60;
        MienSolver 64 8: name 0 aim 8 space 16 spring 24 twist 32 copy 40 custom 48 lods 56;
        MienSolverStackDesc 40 8: struct_size 0 solvers 8 solver_count 16 curve_count 24
            check_writes 28 allocator 32;
        MienSolverStackInfo 32 8: struct_size 0 solver_count 8 curve_count 12 output_count 16
            joint_count 20 state_bytes 24;
        MienSolverStateDesc 16 8: struct_size 0 allocator 8;
        MienSolverInput 24 8: row 0 row_count 8 lod 16 is_reset 20;
        MienControlShare 8 4: control 0 weight 4;
        MienGenerateDesc 32 8: struct_size 0 preset 8 flags 12 seed 16 allocator 24;
        MienAuthorObject 24 8: name 0 first_face 16 face_count 20;
        MienAuthorShape 40 8: name 0 positions 16 position_count 24 displacements 32;
        MienAuthorMesh 112 8: struct_size 0 positions 8 position_count 16 face_sizes 24 face_count
            32 corners 40 corner_count 48 uvs 56 uv_count 64 corner_uvs 72 objects 80 object_count
            88 shapes 96 shape_count 104;
        MienAuthorBone 48 8: name 0 position 16 parent 40 kind 44;
        MienAuthorLandmark 40 8: name 0 position 16;
        MienAuthorLod 24 8: corners 0 corner_count 8 corner_uvs 16;
        MienAuthorDesc 240 8: struct_size 0 facial_joints 8 influences 12 lods 16 groups 20 seed 24
            unit 32 up 40 front 44 symmetry 48 flags 52 name 56 face_object 72 bones 88 bone_count
            96 weight_joints 104 weights 112 parallel 120 progress_user 128 progress 136 allocator
            144 depth_groups 152 mask 160 lod_joints 168 bone_groups 176 bone_motions 184
            joint_groups 192 overlap_correctives 196 lod_triangles 200 lod_meshes 208 lod_mesh_count
            216 landmarks 224 landmark_count 232;
        MienDocumentDesc 24 8: struct_size 0 allocator 8 file_access 16 unknown_layers 20;
        MienPrunedTargets 24 8: struct_size 0 deltas 8 targets 16;
        MienPruneJointsDesc 24 8: struct_size 0 translation 8 rotation 12 scale 16 reserved 20;
        MienPrunedJoints 48 8: struct_size 0 entry_count 8 removed_count 16 worst_distance 24
            worst_control 32 worst_mesh 36 worst_position 40 reserved 44;
        MienPlacement 64 8: struct_size 0 scale 8 rotation 16 translation 40;
        MienProjectDesc 24 8: struct_size 0 r#match 8 influences 12 keep_weights 16 keep_targets 20;
        MienConformed 24 8: struct_size 0 joint_distance 8 joint 16 reserved 20;
        MienTransplantDesc 16 8: struct_size 0 r#match 8 influences 12;
        MienControlError 32 8: worst 0 rms 8 moved 16 control 24 reserved 28;
        MienByteSink 16 8: user 0 write 8;
        MienSolvePoint 28 4: mesh 0 positions 4 weights 16;
        MienFitDesc 104 8: struct_size 0 deformer 8 controls 16 lower 24 upper 32 symmetric 40
            points 48 joint_weights 56 control_count 64 symmetric_count 72 point_count 80 lod 88
            reserved 92 allocator 96;
        MienFitSurfaceDesc 48 8: struct_size 0 positions 8 triangles 16 position_count 24
            triangle_count 32 allocator 40;
        MienFitCamera 64 4: focal 0 center 8 rotation 16 translation 52;
        MienFitConstraint 52 4: kind 0 joint 4 points 8 axis 16 target 28 distances 40 weight 48;
        MienFitFrame 184 8: struct_size 0 joints 8 points 16 images 24 camera 32 point_weights 40
            start 48 prior 56 prior_weight 64 smooth_weight 68 sparse_weight 72 symmetric_weight 76
            robust_scale 80 joint_weight 84 rigid 88 max_iterations 92 max_seconds 96 user 104
            canceled 112 surface 120 surface_reach 128 focal 132 constraint_count 136 constraints
            144 stages 152 point_offsets 160 surface_weights 168 image_weight 176 image_robust_scale
            180;
        MienFitResult 176 8: struct_size 0 status 8 iterations 12 cost 16 joint_residual 24
            point_residual 32 missing_points 40 reserved 44 rotation 48 translation 84 joint_worst
            96 point_worst 104 focal 112 constraint_residual 120 constraint_worst 128 jumped 136
            reserved_2 140 image_residual 144 image_worst 152 surface_residual 160 surface_worst
            168;
    }
}
