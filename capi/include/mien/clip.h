/* SPDX-License-Identifier: MIT
 *
 * Clips: compressed curves, players, and their binding to a rig.
 * The rules of mien.h apply.
 */
#ifndef MIEN_CLIP_H
#define MIEN_CLIP_H

#include "deform.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Clips ----------------------------------------------------------------------------------- */

/* Curves of named channels at a constant frame rate, compressed. A clip is not bound to a rig: a
 * MienClipBinding maps its channels to raw controls.
 *
 *     rows of values -> MienClip -> MienClipPlayer  -> values of channels
 *                              \___ MienClipBinding -> raw controls of a rig
 *
 * Times are integers, in ticks of 1 / MIEN_TICKS_PER_SECOND s. At common frame rates a frame lasts a whole
 * number of ticks; at others its length is rounded to the nearest tick. A clip is used in place: frames
 * are decoded while it plays. Decoded values are always finite, even if the bytes are damaged.
 * Immutable. */
typedef struct MienClip MienClip;

/* Ticks per second. */
#define MIEN_TICKS_PER_SECOND 705600000

/* What happens after the last frame. */
enum MienLooping {
    MIEN_LOOPING_DEFAULT = 0, /* a clip: MIEN_LOOPING_CLAMP; a player: the setting of its clip */
    MIEN_LOOPING_CLAMP = 1,   /* holds the last frame; the length is (frames - 1) * ticks per frame */
    MIEN_LOOPING_WRAP = 2     /* starts over; the length is frames * ticks per frame */
};

/* A named moment of a clip, such as a phoneme. In speech layers, events named "close:lips",
 * "close:lip-to-teeth" and "close:teeth" activate the matching guards of the mixer for `value` seconds. */
typedef struct MienClipEvent {
    int64_t tick;
    MienStringView name;
    float value;
    uint32_t reserved; /* 0 */
} MienClipEvent;

/* What to build a clip from. */
typedef struct MienClipDesc {
    size_t struct_size;
    uint32_t rate_numerator;     /* frames per second, as a fraction. 0: 60 */
    uint32_t rate_denominator;   /* 0: 1 */
    uint32_t frame_count;        /* 1 to 2^28 */
    uint32_t channel_count;      /* at most 65535, of which at most 512 may change over time */
    const MienStringView* names; /* one per channel, all different, not empty */
    const float* values;         /* channel c of frame f is values[f * frame_stride + c] */
    size_t frame_stride;         /* floats from frame to frame. 0: channel_count */
    const float* snaps;          /* one per channel, used instead of `snap`; may be NULL */
    float snap;                  /* 0: values keep all bits. 2^-9, 2^-10 ... 2^-16: values are rounded to
                                    multiples of this step, which makes the clip several times smaller */
    uint32_t looping;            /* MIEN_LOOPING_... */
    uint32_t is_delta;           /* boolean: a delta clip, whose values are added to other values */
    uint32_t event_count;
    const MienClipEvent* events; /* in any order; 0 <= tick < frame_count * ticks per frame */
    const MienAllocator* allocator;
} MienClipDesc;
MIEN_DEFAULT(MienClipDesc, mien_clip_desc_default)

/* Builds a clip in memory. `desc` is required. The same values give the same bytes on every machine.
 * Close with mien_clip_close().
 * Fails with MIEN_ERROR_CLIP_VALUE if a value is not finite (the message names frame and channel),
 * MIEN_ERROR_NAME if a name is empty or occurs twice, MIEN_ERROR_CLIP_LIMIT if there are too many
 * frames, channels or bytes. */
MIEN_CHECKED MienStatus mien_clip_build(const MienClipDesc* desc, MienClip** out_clip,
                                        MienError* error);

/* How to open a clip. */
typedef struct MienClipOpenDesc {
    size_t struct_size;
    uint32_t file_access; /* MIEN_FILE_...; no effect on memory and streams */
    uint32_t reserved;    /* 0 */
    const MienAllocator* allocator;
} MienClipOpenDesc;
MIEN_DEFAULT(MienClipOpenDesc, mien_clip_open_desc_default)

/* Opens a clip. By default it is mapped: do not truncate or overwrite the file until the clip is closed
 * and its players are destroyed; replacing it by renaming is safe. Names and events are checked now,
 * curves when they are decoded: damaged ones decode to zeros (see mien_clip_verify()). Close with
 * mien_clip_close().
 * Fails with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ if the file cannot be read,
 * MIEN_ERROR_CLIP_SIGNATURE, MIEN_ERROR_CLIP_VERSION, MIEN_ERROR_CLIP_TRUNCATED or
 * MIEN_ERROR_CLIP_STRUCTURE if it is not a valid clip. */
MIEN_CHECKED MienStatus mien_clip_open_file(const char* path, const MienClipOpenDesc* desc,
                                            MienClip** out_clip, MienError* error);

/* Opens a clip in memory, at any alignment. `bytes` must outlive the clip and its players, unchanged.
 * Fails like mien_clip_open_file(), but not with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ. */
MIEN_CHECKED MienStatus mien_clip_open_memory(const void* bytes, size_t size,
                                              const MienClipOpenDesc* desc, MienClip** out_clip,
                                              MienError* error);

/* Opens a clip through a stream, which is read completely into memory of the allocator.
 * Fails like mien_clip_open_file(), but not with MIEN_ERROR_FILE_OPEN. */
MIEN_CHECKED MienStatus mien_clip_open_stream(const MienStream* stream, const MienClipOpenDesc* desc,
                                              MienClip** out_clip, MienError* error);

/* Closes a clip. Players stay valid; memory is released and the file unmapped with the last of them. */
MIEN_API void mien_clip_close(MienClip* clip);

/* Writes a clip to a file. The file is written under a temporary name and renamed, so that a failure
 * leaves `path` unchanged.
 * Fails with MIEN_ERROR_FILE_WRITE if the file cannot be written, MIEN_ERROR_MEMORY if the allocator of
 * the clip returns NULL. */
MIEN_CHECKED MienStatus mien_clip_write_file(const MienClip* clip, const char* path,
                                             MienError* error);

/* Writes a clip to memory and returns its size in `out_size`. `buffer` may be NULL with capacity 0 to
 * get the size only. Writes nothing if `capacity` is too small; `out_size` is set nevertheless.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if `capacity` is too small. */
MIEN_CHECKED MienStatus mien_clip_write_memory(const MienClip* clip, void* buffer, size_t capacity,
                                               size_t* out_size, MienError* error);

/* Properties of a clip. */
typedef struct MienClipInfo {
    size_t struct_size;
    uint32_t rate_numerator;         /* frames per second, as a fraction */
    uint32_t rate_denominator;
    uint32_t frame_count;
    uint32_t channel_count;
    uint32_t changing_channel_count; /* channels whose value is not the same in all frames */
    uint32_t event_count;
    uint32_t looping;                /* MIEN_LOOPING_CLAMP or MIEN_LOOPING_WRAP */
    uint32_t is_delta;               /* boolean: as in MienClipDesc */
    float snap;                      /* largest step to which a channel was rounded. 0: none was */
    uint32_t is_mapped;              /* boolean: the file is mapped */
    int64_t ticks_per_frame;
    int64_t length;                  /* ticks */
    uint64_t file_bytes;             /* size of the clip */
    uint64_t memory_bytes;           /* memory taken from the allocator */
    uint64_t player_bytes;           /* memory of a player without MienClipPlayerDesc.reverse */
} MienClipInfo;
MIEN_DEFAULT(MienClipInfo, mien_clip_info_default)

/* Returns the properties of a clip. */
MIEN_CHECKED MienStatus mien_clip_info(const MienClip* clip, MienClipInfo* out_info);

/* A channel of a clip. Block counts, bits and max_error are only known for a clip from
 * mien_clip_build(); they are 0 for a clip that was opened. */
typedef struct MienClipChannel {
    size_t struct_size;
    MienStringView name;
    float rest;               /* value of a channel that does not change; otherwise 0 */
    uint32_t is_changing;     /* boolean: the channel has a curve */
    uint32_t zero_blocks;     /* blocks of 64 frames that are zero */
    uint32_t constant_blocks; /* blocks with one other value */
    uint32_t grid_blocks;     /* blocks whose values are multiples of a decimal or binary fraction */
    uint32_t float_blocks;    /* other blocks */
    uint64_t bits;            /* of all blocks */
    float max_error;          /* largest error of rounding to a step */
    uint32_t reserved;        /* 0 */
} MienClipChannel;
MIEN_DEFAULT(MienClipChannel, mien_clip_channel_default)

/* Returns a channel. Channels keep the order in which the clip was built. The name is a view into the
 * clip.
 * Fails with MIEN_ERROR_INDEX if `index` is out of range. */
MIEN_CHECKED MienStatus mien_clip_channel(const MienClip* clip, uint32_t index,
                                          MienClipChannel* out_channel);

/* Returns the index of the channel with this name. Searches all channels.
 * Fails with MIEN_ERROR_NAME if there is none. */
MIEN_CHECKED MienStatus mien_clip_find_channel(const MienClip* clip, const char* name,
                                               uint32_t* out_index);
MIEN_CHECKED MienStatus mien_clip_find_channel_n(const MienClip* clip, const char* name,
                                                 size_t name_count, uint32_t* out_index);

/* Returns an event. Events are sorted by tick; those at the same tick keep the order in which they were
 * given. The name is a view into the clip.
 * Fails with MIEN_ERROR_INDEX if `index` is out of range. */
MIEN_CHECKED MienStatus mien_clip_event(const MienClip* clip, uint32_t index,
                                        MienClipEvent* out_event);

/* Checks that no byte of a clip has changed since it was written and that all curves can be decoded.
 * Reads the whole clip. Uses up to 48 KiB of stack.
 * Fails with MIEN_ERROR_CLIP_CHECKSUM if bytes have changed, MIEN_ERROR_CLIP_STRUCTURE if a curve cannot
 * be decoded. */
MIEN_CHECKED MienStatus mien_clip_verify(const MienClip* clip, MienError* error);

/* Copies `frame_count` frames, starting at `first_frame`: channel c of frame first_frame + n goes to
 * out_values[n * frame_stride + c]. frame_stride is at least the number of channels; 0 means that
 * number. Each call decodes from the start of a block of 64 frames, so reading many frames in one
 * call costs less than reading them one by one. Uses up to 48 KiB of stack.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if frame_stride is too small, MIEN_ERROR_INDEX if the
 * clip has fewer frames, MIEN_ERROR_CLIP_STRUCTURE if a curve is damaged; its block in `out_values` is
 * zero. */
MIEN_CHECKED MienStatus mien_clip_read(const MienClip* clip, uint32_t first_frame,
                                       uint32_t frame_count, float* out_values, size_t frame_stride,
                                       MienError* error);

/* ---- Clip player ----------------------------------------------------------------------------- */

/* Plays a clip for one character: a position, and the state of the decoder. */
typedef struct MienClipPlayer MienClipPlayer;

/* How values between two frames are computed. They stay within the range of these two frames. */
enum MienInterpolation {
    MIEN_INTERPOLATION_LINEAR = 0,
    MIEN_INTERPOLATION_STEP = 1,       /* the value of the earlier frame */
    MIEN_INTERPOLATION_CATMULL_ROM = 2 /* a Catmull-Rom spline, clamped to that range */
};

/* How to play a clip. */
typedef struct MienClipPlayerDesc {
    size_t struct_size;
    uint32_t looping;          /* MIEN_LOOPING_... */
    uint32_t interpolation;    /* MIEN_INTERPOLATION_... */
    int32_t speed_numerator;   /* speed, as a fraction; negative plays backward. -2^20 to 2^20 */
    int32_t speed_denominator; /* 1 to 2^20. Both 0: 1 / 1 */
    int64_t start_tick;        /* initial position, as for mien_clip_player_seek() */
    uint32_t reverse;          /* boolean: backward playback costs no more than forward; takes 256 more
                                  bytes per changing channel */
    uint32_t reserved;         /* 0 */
    const MienAllocator* allocator;
} MienClipPlayerDesc;
MIEN_DEFAULT(MienClipPlayerDesc, mien_clip_player_desc_default)

/* Creates a player, with one allocation. `clip` may be closed before the player is destroyed. Destroy with
 * mien_clip_player_destroy(). */
MIEN_CHECKED MienStatus mien_clip_player_create(const MienClip* clip, const MienClipPlayerDesc* desc,
                                                MienClipPlayer** out_clip_player, MienError* error);

/* Destroys a player. */
MIEN_API void mien_clip_player_destroy(MienClipPlayer* clip_player);

/* State of a player. */
typedef struct MienClipPlayerInfo {
    size_t struct_size;
    int64_t tick;        /* 0 to the length of the clip; with MIEN_LOOPING_WRAP less than the length */
    int64_t loops;       /* loops completed since creation or the last seek, at most 2^61; negative:
                            backward */
    uint32_t looping;    /* MIEN_LOOPING_CLAMP or MIEN_LOOPING_WRAP */
    uint32_t is_damaged; /* boolean: a damaged curve was played, as zeros */
} MienClipPlayerInfo;
MIEN_DEFAULT(MienClipPlayerInfo, mien_clip_player_info_default)

/* Returns the state of a player. */
MIEN_CHECKED MienStatus mien_clip_player_info(const MienClipPlayer* clip_player,
                                              MienClipPlayerInfo* out_info);

/* Moves to a tick: modulo the length with MIEN_LOOPING_WRAP, otherwise clamped to the range. Reports no
 * events; the next mien_clip_player_advance() also reports events at this tick, as it does after
 * creation. Does not allocate or lock. */
MIEN_CHECKED MienStatus mien_clip_player_seek(MienClipPlayer* clip_player, int64_t tick);

/* Sets the speed for later calls of mien_clip_player_advance(). Does not allocate or lock.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if it is outside the range of MienClipPlayerDesc. */
MIEN_CHECKED MienStatus mien_clip_player_set_speed(MienClipPlayer* clip_player, int32_t numerator,
                                                   int32_t denominator);

/* Moves by `ticks` times the speed. `ticks` is -2^40 to 2^40 (26 minutes). Fractions of ticks are kept,
 * so the position does not depend on the step size. Does not allocate or lock.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if `ticks` is out of range. */
MIEN_CHECKED MienStatus mien_clip_player_advance(MienClipPlayer* clip_player, int64_t ticks);

/* Returns the next event that the last mien_clip_player_advance() passed. `out_found` is 1, or 0 after
 * the last event. An event is passed when the position reaches or crosses its tick in either
 * direction, once per loop. The name is a view into the clip. Does not allocate or lock. */
MIEN_CHECKED MienStatus mien_clip_player_next_event(MienClipPlayer* clip_player,
                                                    MienClipEvent* out_event, uint32_t* out_found);

/* Returns the values at the current position: one float per channel. Exactly at a frame they are
 * bit-identical to those of the clip. Decodes the frames since the last call, or at most 64 after a jump;
 * without MienClipPlayerDesc.reverse, each step backward is a jump. Does not allocate or lock.
 * Contents change with mien_clip_player_sample(). */
MIEN_CHECKED MienStatus mien_clip_player_sample(MienClipPlayer* clip_player,
                                                MienFloatView* out_values);

/* ---- Clip binding ---------------------------------------------------------------------------- */

/* Maps the channels of a clip to raw controls of a rig. Serves all clips with the same channels and
 * all rigs with the same raw controls. Immutable. */
typedef struct MienClipBinding MienClipBinding;

/* Adds weight * value of a channel to a raw or GUI control. */
typedef struct MienMatrixEntry {
    MienStringView channel;
    MienStringView control;
    float weight;
    uint32_t reserved; /* 0 */
} MienMatrixEntry;

/* How to bind a clip. */
typedef struct MienClipBindingDesc {
    size_t struct_size;
    const MienMatrixEntry* matrix; /* for channels whose names the rig does not have; may be NULL: those
                                      that mien_rig_match() knows need none */
    size_t matrix_count;
    const MienAllocator* allocator;
} MienClipBindingDesc;
MIEN_DEFAULT(MienClipBindingDesc, mien_clip_binding_desc_default)

/* Binds a clip to a rig by names. A channel drives the raw control with its name. If there is none, it
 * drives the GUI control with its name, which is then mapped as by mien_rig_map_gui_to_raw(). If there is
 * none either, it drives the controls of its entries in the matrix, which are summed in the order of the
 * matrix. Names match without regard to case; `.` matches `_`; the prefix `CTRL_expressions.` may be
 * missing. If several names match, only an exact match counts. A channel that drives nothing so far drives
 * the controls that mien_rig_match() finds for its name, such as mouthSmile_L for mouthSmileLeft; these are
 * summed after those of the matrix. A raw control that a channel drives by name is driven by nothing else,
 * and one that the matrix or mien_rig_match() drives is not driven by GUI controls. Names without a match
 * are not an error: see mien_clip_binding_info(). `clip` may be closed and `rig` may be destroyed
 * afterwards. Destroy with mien_clip_binding_destroy().
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if a weight is not finite, MIEN_ERROR_CLIP_LIMIT if channels
 * drive more than 4095 GUI controls. */
MIEN_CHECKED MienStatus mien_clip_binding_create(const MienClip* clip, const MienRig* rig,
                                                 const MienClipBindingDesc* desc,
                                                 MienClipBinding** out_clip_binding,
                                                 MienError* error);

/* Returns a matrix that binds clips with the 52 ARKit expression names, such as those of the Live Link
 * Face app, to rigs with the other common naming of raw controls (eyeBlinkL for eyeBlinkLeft). It suits
 * every rig: channels whose names the rig has do not use the matrix, and entries for missing controls are
 * skipped. docs/face-capture.md, 3 "ARKit expressions on raw controls" explains the entries. Writes as
 * many entries as fit; `out_count` is the total number. Names are static. `out_entries` may be NULL if
 * `capacity` is 0. */
MIEN_CHECKED MienStatus mien_arkit_matrix(MienMatrixEntry* out_entries, size_t capacity,
                                          size_t* out_count);

/* Destroys a binding. */
MIEN_API void mien_clip_binding_destroy(MienClipBinding* clip_binding);

/* What a binding found. Indices are ascending. */
typedef struct MienClipBindingInfo {
    size_t struct_size;
    uint32_t channel_count;           /* channels of the clip */
    uint32_t raw_control_count;       /* raw controls of the rig */
    uint32_t missing_entry_count;     /* matrix entries whose channel or control does not exist */
    uint32_t reserved;                /* 0 */
    MienIndex16View controls;         /* raw controls that are driven */
    MienIndex16View extra_controls;   /* raw controls that are not driven */
    MienIndex16View missing_channels; /* channels that drive nothing: the rig has no such name, or an
                                         earlier channel drives the same control */
} MienClipBindingInfo;
MIEN_DEFAULT(MienClipBindingInfo, mien_clip_binding_info_default)

/* Returns what a binding found. */
MIEN_CHECKED MienStatus mien_clip_binding_info(const MienClipBinding* clip_binding,
                                               MienClipBindingInfo* out_info);

/* Computes the raw controls that are driven and leaves the others unchanged. `values` has one float
 * per channel, as mien_clip_player_sample() returns them; `raw_controls` has one float per raw control,
 * as mien_instance_raw_controls() returns them. Values that drive raw controls by name are
 * copied exactly; GUI controls give the same bits as mien_rig_map_gui_to_raw(). Does not allocate or
 * lock. Uses up to 16 KiB of stack.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if a count differs from that of the clip or the rig. */
MIEN_CHECKED MienStatus mien_clip_binding_apply(const MienClipBinding* clip_binding,
                                                const float* values, size_t value_count,
                                                float* raw_controls, size_t raw_control_count);

/* Finds for each channel of a clip the coarsest rounding step with no visible effect, for
 * MienClipDesc.snaps: the largest of 2^-9 to 2^-16 of which half moves no vertex of LOD 0 by more than
 * `tolerance`, in millimeters, such as 0.02. If LOD 0 has no meshes, joints are measured instead. Each
 * channel is tried at five values from 0 to 1, and from -1 on if GUI controls are driven, with all other
 * channels at 0. Channels that drive nothing get 2^-11; channels for which even the finest step is too
 * coarse get 0. To use the steps, build a clip with all bits, bind it, then build it again with them.
 * Evaluates and deforms the rig at least 10 times per channel, and takes memory from its allocator during
 * the call.
 * Fails with MIEN_ERROR_MEMORY if that returns NULL, MIEN_ERROR_MISMATCH if `channel_count` is not that of
 * the binding, or the binding is for another rig, MIEN_ERROR_INVALID_ARGUMENT if `tolerance` is not a
 * number above 0. */
MIEN_CHECKED MienStatus mien_clip_binding_snaps(const MienClipBinding* clip_binding,
                                                const MienDeformer* deformer, float tolerance,
                                                float* out_snaps, size_t channel_count,
                                                MienError* error);

#ifdef __cplusplus
}
#endif

#endif /* MIEN_CLIP_H */
