/* SPDX-License-Identifier: MIT
 *
 * Mixes: layers, reactions, guards and limits, and the mixers that step them; gaze.
 * The rules of mien.h apply.
 */
#ifndef MIEN_MIX_H
#define MIEN_MIX_H

#include "clip.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Mix ------------------------------------------------------------------------------------- */

/* A description of what is mixed for one rig, and how. A row holds one value per curve. The curves are the
 * raw controls of the rig, then pose variables: numbers of the caller that are mixed by the same rules
 * (gaze, head turn, breath). Each step of a MienMixer applies the layers in order, then reactions, guards,
 * layers and reactions that act after the guards, antagonists, and limits. docs/mixing.md explains each
 * stage. One mix serves any number of mixers and threads. Immutable. */
typedef struct MienMix MienMix;

/* The purpose of a layer. Guards protect the result of base and speech from the other groups. */
enum MienLayerGroup {
    MIEN_LAYER_GROUP_BASE = 0,
    MIEN_LAYER_GROUP_SPEECH = 1,
    MIEN_LAYER_GROUP_EMOTION = 2,
    MIEN_LAYER_GROUP_REACTION = 3,
    MIEN_LAYER_GROUP_LIFE = 4      /* acts after the reactions if no layer of another group follows */
};

/* How a layer changes a curve: o is the value so far, x the value of the layer, a = weight * mask. Curves
 * for which the layer's source has no value do not change. */
enum MienBlendMode {
    MIEN_BLEND_MODE_OVERRIDE = 0, /* o + a (x - o) */
    MIEN_BLEND_MODE_ADD = 1,      /* o + a x */
    MIEN_BLEND_MODE_SCREEN = 2,   /* o + a x (1 - p), or o + a x p if x < 0; p is o clamped to 0..1 */
    MIEN_BLEND_MODE_MAX = 3,      /* o + a max(0, x - o) */
    MIEN_BLEND_MODE_SCALE = 4     /* o (1 + a (x - 1)) */
};

/* Where the values of a layer come from. */
enum MienLayerSource {
    MIEN_LAYER_SOURCE_CLIP = 0,     /* mien_mixer_play() */
    MIEN_LAYER_SOURCE_POSES = 1,    /* a weighted sum: mien_mixer_set_pose_weight() */
    MIEN_LAYER_SOURCE_STREAM = 2,   /* mien_mixer_push() */
    MIEN_LAYER_SOURCE_GENERATOR = 3 /* MIEN_GENERATOR_... */
};

/* What a layer generates from the seed of the mixer and the time. */
enum MienGenerator {
    MIEN_GENERATOR_BLINK = 0,  /* blinks every `period` on average, at least 0.5 s apart. The wait starts
                                  over when earlier layers raise the first curve above 0.6 */
    MIEN_GENERATOR_BREATH = 1, /* rises from 0 to 1 in 40 % of the period, then falls back to 0 */
    MIEN_GENERATOR_NOISE = 2,  /* smooth noise between -1 and 1 with a new random value every period */
    MIEN_GENERATOR_GAZE = 3    /* turns the eyes to a target with saccades, by MienMixDesc.gaze. `curves` are
                                  three curves with the left, up and front of a MienGazeTarget, read after
                                  the earlier layers, then optionally two curves that get the part left for
                                  the head (MienGazeRest). `amounts` are fixation jitter sideways and up in
                                  degrees, 0, and factors for the two head curves. Shifts of 20 degrees or
                                  more make the blink layers of the mix blink */
};

/* A layer of a mix. Leave the fields that its source does not use at zero. */
typedef struct MienMixLayer {
    int64_t period;         /* of a generator, ticks */
    int64_t delay;          /* of a stream, ticks: rows are played this much later than their times */
    const float* mask;      /* one per curve, 0 to 1; curves beyond mask_count have 0. NULL: 1 for all */
    const uint16_t* curves; /* the curve of each channel of a stream, or the curves of a generator */
    const float* amounts;   /* one per curve of a generator: a factor for its value */
    uint32_t mask_count;
    uint32_t curve_count;
    uint32_t group;         /* MIEN_LAYER_GROUP_... */
    uint32_t mode;          /* MIEN_BLEND_MODE_... */
    uint32_t source;        /* MIEN_LAYER_SOURCE_... */
    uint32_t after_guards;  /* boolean: acts after the guards; not allowed for base and speech */
    float weight;           /* initial weight. 0 to 1; -1 to 1 with MIEN_BLEND_MODE_ADD */
    uint32_t first_pose;    /* index of its first pose in MienMixDesc.poses */
    uint32_t pose_count;
    uint32_t generator;     /* MIEN_GENERATOR_... */
    uint32_t stream_frames; /* capacity of a stream's queue, in rows. 0: 64; otherwise 2 to 1024 */
    uint32_t reserved;      /* 0 */
} MienMixLayer;

/* A pose: the curves that it moves, and their values. */
typedef struct MienMixPose {
    const uint16_t* curves;
    const float* values;
    size_t count;
} MienMixPose;

/* A part of a reaction: moves the curves of a pose to its values and back to 0. Times are in ticks. */
typedef struct MienMixStroke {
    int64_t delay;    /* after the trigger */
    int64_t attack;   /* time to reach strength * pose */
    int64_t hold;     /* time after the attack; ignored if is_held */
    int64_t release;  /* time to return to 0 */
    uint32_t pose;    /* index in MienMixDesc.poses */
    uint32_t mode;    /* MIEN_BLEND_MODE_... */
    uint32_t is_held; /* boolean: holds as long as the stimulus lasts, and adapts unless is_lag */
    uint32_t is_lag;  /* boolean: moves exponentially; attack and release are time constants */
    uint32_t is_scaled; /* boolean: scaled by the level of the reaction, which is 1 if
                           mien_mixer_trigger() started it */
    uint32_t reserved;  /* 0 */
} MienMixStroke;

/* What a trigger does while the reaction is already running. */
enum MienRetrigger {
    MIEN_RETRIGGER_EXTEND = 0,  /* extends the stimulus; strokes that are releasing or over start again */
    MIEN_RETRIGGER_RESTART = 1, /* all strokes start again, at most once per cooldown */
    MIEN_RETRIGGER_IGNORE = 2
};

/* The response of a face to a stimulus, such as a bright light. */
typedef struct MienMixReaction {
    int64_t cooldown;             /* ticks; minimum time between two starts of strokes that are not held */
    int64_t adapt_ticks;          /* time constant of adaptation to a lasting stimulus */
    int64_t recover_ticks;        /* time constant of recovery after the stimulus */
    const MienMixStroke* strokes; /* at most 8 */
    size_t stroke_count;
    uint32_t retrigger;           /* MIEN_RETRIGGER_... */
    uint32_t after_guards;        /* boolean: acts after the guards */
    float adapted;                /* share of the strength that remains after full adaptation; 1: all */
    float level_on;               /* levels of this or more are a stimulus: mien_mixer_set_level(). 0: the
                                     reaction takes no levels */
    float level_off;              /* the stimulus ends below this; at most level_on */
    uint32_t reserved;            /* 0 */
} MienMixReaction;

/* Two curves that move the face in opposite directions. If both are above 0, the smaller one times
 * stiffness is subtracted from both. */
typedef struct MienMixAntagonists {
    uint16_t first;
    uint16_t second;
    float stiffness; /* 0 to 1 */
} MienMixAntagonists;

/* Built-in guards: gaps that emotions and reactions must not open while speech or a blink closes them.
 * Bits of MienMixDesc.guards. */
enum MienGuard {
    MIEN_GUARD_LIPS = 1,  /* between the lips, left, center and right, and from lower lip to upper teeth */
    MIEN_GUARD_LIDS = 2,  /* between the lids */
    MIEN_GUARD_TEETH = 4, /* between the teeth */
    MIEN_GUARD_ALL = 7
};

/* No mesh: the points of a landmark are joints. */
#define MIEN_NO_MESH 0xFFFFFFFF
/* No raw control. */
#define MIEN_NO_CONTROL 0xFFFF

/* A point of the face: the mean of some positions of a mesh that LOD 0 shows, or of some joints. */
typedef struct MienLandmark {
    const uint32_t* points; /* indices of positions of the mesh, or of joints */
    uint32_t point_count;   /* 1 to 65536 */
    uint32_t mesh;          /* index of the mesh. MIEN_NO_MESH: the points are joints */
} MienLandmark;

/* A guard with landmarks of the caller. It keeps the gap between them, the height of `upper` above `lower`
 * along the axis that points up, from being opened. */
typedef struct MienMixGuard {
    MienLandmark upper;
    MienLandmark lower;
    uint32_t closed_by;    /* raw control that closes the gap at 1. MIEN_NO_CONTROL: it is closed at rest */
    uint32_t needs_speech; /* boolean: acts at most as much as the largest weight of a speech layer */
    float tolerance;       /* millimeters by which later layers may open the gap, 0 or more; 0.3 for
                              built-in guards */
    float f_on;            /* millimeters, above 0: acts if base and speech leave a smaller gap, fully at 0.
                              Built-in guards: 12 for lips, 6 for lids, 4 for teeth */
} MienMixGuard;

/* Which raw controls turn the eyes of a rig, and by how much. Immutable. */
typedef struct MienGaze MienGaze;

/* What to mix. Everything is copied. */
typedef struct MienMixDesc {
    size_t struct_size;
    const MienMixLayer* layers;            /* at most 16 */
    size_t layer_count;
    const MienMixPose* poses;              /* at most 1024; used by layers and strokes */
    size_t pose_count;
    const MienMixReaction* reactions;      /* at most 16 */
    size_t reaction_count;
    const MienMixAntagonists* antagonists;
    size_t antagonist_count;
    const uint16_t* mirror;                /* for each curve its counterpart in the other half of the face,
                                              or itself. NULL: clips cannot be played mirrored */
    const float* lower;                    /* limits per curve. NULL: none; both or neither */
    const float* upper;
    const MienMixGuard* custom_guards;     /* numbered after the built-in ones; at most 8 guards in total */
    size_t custom_guard_count;
    const MienGaze* gaze;                  /* for a layer with MIEN_GENERATOR_GAZE; may be NULL */
    const MienDeformer* deformer;          /* to measure guards; may be NULL if there are none */
    uint32_t guards;                       /* MIEN_GUARD_... bits; a guard is left out if the rig lacks its
                                              landmarks */
    uint32_t variable_count;               /* pose variables; at most 4096 curves with the raw controls */
    uint32_t player_count;                 /* clips that can play at the same time; a crossfade needs two.
                                              0: two for each clip layer */
    uint32_t max_channels;                 /* of any clip. 0: the number of raw controls */
    uint32_t max_changing_channels;        /* of any clip. 0: max_channels, 512 at most */
    uint32_t max_events;                   /* events that one step can report. 0: 64 */
    uint32_t reverse;                      /* boolean: as in MienClipPlayerDesc */
    uint32_t reserved;                     /* 0 */
    const MienAllocator* allocator;
} MienMixDesc;
MIEN_DEFAULT(MienMixDesc, mien_mix_desc_default)

/* Creates a mix for a rig. `desc` is required. `rig` may be destroyed afterwards, and so may the
 * deformer. Measuring guards takes time: it evaluates and deforms the rig at LOD 0 for each raw control
 * and for pairs of raw controls that share a corrective. Destroy with mien_mix_destroy().
 * Fails with MIEN_ERROR_MISMATCH if the deformer or the gaze is for another rig, MIEN_ERROR_INDEX if a
 * landmark names a mesh, position or joint that does not exist, MIEN_ERROR_INVALID_ARGUMENT if a field
 * of `desc` is out of range; the message names it, MIEN_ERROR_DNA_LIMIT if guards are measured and raw
 * controls times joints exceed 2^22. */
MIEN_CHECKED MienStatus mien_mix_create(const MienRig* rig, const MienMixDesc* desc,
                                        MienMix** out_mix, MienError* error);

/* How to open a mix. */
typedef struct MienMixOpenDesc {
    size_t struct_size;
    const MienAllocator* allocator;
} MienMixOpenDesc;
MIEN_DEFAULT(MienMixOpenDesc, mien_mix_open_desc_default)

/* Opens a mix for a rig, which must have all controls that the mix uses; names match as in
 * mien_clip_binding_create(). For other controls of the rig, the masks of the file are 0 and there are no
 * limits. Guards and gaze are those measured when the mix was created. `rig` may be NULL: then the raw
 * controls are those of the file, to inspect it or to write it again. `rig` may be destroyed afterwards.
 * A hostile file may make mixers large: check MienMixInfo.mixer_bytes. Destroy with mien_mix_destroy().
 * Fails with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ if the file cannot be read,
 * MIEN_ERROR_MIX_SIGNATURE, MIEN_ERROR_MIX_VERSION, MIEN_ERROR_MIX_TRUNCATED, MIEN_ERROR_MIX_CHECKSUM or
 * MIEN_ERROR_MIX_STRUCTURE if it is not a valid mix, MIEN_ERROR_NAME if the rig lacks controls; the
 * message names them. */
MIEN_CHECKED MienStatus mien_mix_open_file(const char* path, const MienRig* rig,
                                           const MienMixOpenDesc* desc, MienMix** out_mix,
                                           MienError* error);

/* Opens a mix in memory. `bytes` may be released afterwards. `rig` may be NULL. `rig` may be destroyed
 * afterwards.
 * Fails like mien_mix_open_file(), but not with MIEN_ERROR_FILE_OPEN or MIEN_ERROR_FILE_READ. */
MIEN_CHECKED MienStatus mien_mix_open_memory(const void* bytes, size_t size, const MienRig* rig,
                                             const MienMixOpenDesc* desc, MienMix** out_mix,
                                             MienError* error);

/* Writes a mix to a file: the arguments of mien_mix_create(), what it measured, and the names of the
 * controls that the mix uses. Equal mixes give the same bytes on every machine; a mix that was opened is
 * written with the bytes of its file. The file is written under a temporary name and renamed, so that a
 * failure leaves `path` unchanged. Takes memory from the allocator of the mix during the call.
 * Fails with MIEN_ERROR_MEMORY if that returns NULL, MIEN_ERROR_NAME if two of these controls have the
 * same name, MIEN_ERROR_FILE_WRITE if the file cannot be written. */
MIEN_CHECKED MienStatus mien_mix_write_file(const MienMix* mix, const char* path, MienError* error);

/* Writes a mix to memory and returns its size in `out_size`. `buffer` may be NULL with capacity 0 to get
 * the size only. Writes nothing if `capacity` is too small; `out_size` is set nevertheless.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if `capacity` is too small, MIEN_ERROR_MEMORY and MIEN_ERROR_NAME
 * if mien_mix_write_file() would fail with them. */
MIEN_CHECKED MienStatus mien_mix_write_memory(const MienMix* mix, void* buffer, size_t capacity,
                                              size_t* out_size, MienError* error);

/* Writes a mix as text, for reading and for version control: one line for each number, with its path in
 * the mix and the names of controls. Floats have nine digits, enough to restore their bits. The text
 * cannot be opened as a mix, and is not null-terminated. `buffer` may be NULL with capacity 0 to get the
 * size only.
 * Fails like mien_mix_write_memory(). */
MIEN_CHECKED MienStatus mien_mix_write_text(const MienMix* mix, void* buffer, size_t capacity,
                                            size_t* out_size, MienError* error);

/* Destroys a mix. Its mixers stay valid; its memory is released with the last of them. */
MIEN_API void mien_mix_destroy(MienMix* mix);

/* Properties of a mix. */
typedef struct MienMixInfo {
    size_t struct_size;
    uint32_t raw_control_count;
    uint32_t variable_count;
    uint32_t curve_count;    /* raw controls and pose variables */
    uint32_t layer_count;
    uint32_t stage_count;    /* for mien_mixer_stage() */
    uint32_t guard_count;    /* for mien_mixer_set_guard() */
    uint64_t mixer_bytes;    /* memory of a mixer without MienMixerDesc.stages */
    uint64_t snapshot_bytes; /* size of a snapshot */
} MienMixInfo;
MIEN_DEFAULT(MienMixInfo, mien_mix_info_default)

/* Returns the properties of a mix. */
MIEN_CHECKED MienStatus mien_mix_info(const MienMix* mix, MienMixInfo* out_info);

/* A guard of a mix, as it was measured: the distance in millimeters is `rest`, plus the sum of gain * curve,
 * plus a sum over pairs of curves that share a corrective. See docs/mixing.md, 4 "Guards". */
typedef struct MienMixGuardInfo {
    size_t struct_size;
    MienIndex16View curves; /* raw controls that change the distance, by descending gain */
    MienFloatView gains;    /* 1 float per curve: millimeters at value 1 */
    uint32_t pair_count;
    uint32_t needs_speech; /* boolean: as in MienMixGuard */
    float rest;            /* distance of a row of zeros */
    float tolerance;       /* as in MienMixGuard */
    float f_on;
    float fit_error;       /* millimeters, root mean square over the measured rows */
} MienMixGuardInfo;
MIEN_DEFAULT(MienMixGuardInfo, mien_mix_guard_info_default)

/* Returns the measured function of a guard. `guard_index` counts as in mien_mixer_set_guard(), from 0 to
 * MienMixInfo.guard_count - 1; mien_mixer_guard() has its name.
 * Fails with MIEN_ERROR_INDEX if there is no such guard. */
MIEN_CHECKED MienStatus mien_mix_guard(const MienMix* mix, uint32_t guard_index,
                                       MienMixGuardInfo* out_guard);

/* Returns a ready-made reaction to a light in the eyes, with 5 strokes. The caller provides its poses, from
 * `first_pose` on: lids closed; squint and lowered brows; gaze turned away; narrow pupils; head turned
 * away. docs/mixing.md, 3 "Reactions" lists the times. `out_reaction` refers to `out_strokes`.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if `stroke_count` is less than 5. */
MIEN_CHECKED MienStatus mien_mix_glare(uint32_t first_pose, MienMixStroke* out_strokes,
                                       size_t stroke_count, MienMixReaction* out_reaction);

/* Finds antagonists: pairs of raw controls that only the two halves of one GUI control drive. Writes as
 * many as fit, with stiffness 1; `out_count` is the total number. `out_pairs` may be NULL if `capacity` is
 * 0. Raw controls from 4096 on, which no mix has, are left out. */
MIEN_CHECKED MienStatus mien_mix_antagonists(const MienRig* rig, MienMixAntagonists* out_pairs,
                                             size_t capacity, size_t* out_count);

/* Finds the counterparts of raw controls in the other half of the face, for MienMixDesc.mirror. Controls
 * are counterparts if their names differ only in Left and Right (or L and R) and their motions agree, or
 * else if their motions are mirror images. Other controls, and curves beyond the raw controls, map to
 * themselves. Evaluates the rig once for each raw control, and takes memory from its allocator during
 * the call.
 * Fails with MIEN_ERROR_MEMORY if that returns NULL, MIEN_ERROR_MISMATCH if `curve_count` is less than the
 * raw controls, MIEN_ERROR_DNA_LIMIT if raw controls times joints exceed 2^22. */
MIEN_CHECKED MienStatus mien_mix_mirror(const MienDeformer* deformer, uint16_t* out_curves,
                                        size_t curve_count, MienError* error);

/* Computes a mask that selects joint groups: for each raw control the share of its joint motion, at
 * value 1 and LOD 0, that belongs to these groups. A millimeter counts as much as a degree. Controls
 * that move no joint, and curves beyond the raw controls, get `otherwise_weight`. Evaluates the rig once
 * for each raw control and group, and takes memory from its allocator during the call.
 * Fails with MIEN_ERROR_MEMORY if that returns NULL, MIEN_ERROR_INDEX if a group does not exist,
 * MIEN_ERROR_MISMATCH if `curve_count` is less than the raw controls. */
MIEN_CHECKED MienStatus mien_mix_mask(const MienRig* rig, const uint32_t* groups, size_t group_count,
                                      float otherwise_weight, float* out_mask, size_t curve_count,
                                      MienError* error);

/* How to create a gaze. */
typedef struct MienGazeDesc {
    size_t struct_size;
    const char* left_eye;  /* name of a joint. NULL: L_Eye or FACIAL_L_Eye */
    const char* right_eye; /* name of a joint. NULL: R_Eye or FACIAL_R_Eye */
    const MienAllocator* allocator;
} MienGazeDesc;
MIEN_DEFAULT(MienGazeDesc, mien_gaze_desc_default)

/* Creates a gaze by measuring how raw controls turn the eyes, which evaluates the rig at least twice per
 * raw control. `deformer` may be destroyed afterwards. Destroy with mien_gaze_destroy().
 * Fails with MIEN_ERROR_NAME if there are no such joints, MIEN_ERROR_INVALID_ARGUMENT if no raw
 * control turns an eye monotonically in one of the four directions. */
MIEN_CHECKED MienStatus mien_gaze_create(const MienDeformer* deformer, const MienGazeDesc* desc,
                                         MienGaze** out_gaze, MienError* error);

/* Destroys a gaze. */
MIEN_API void mien_gaze_destroy(MienGaze* gaze);

/* A point in millimeters from the origin of the rig's model space, with the head in its neutral pose. */
typedef struct MienGazeTarget {
    float left;
    float up;
    float front;
} MienGazeTarget;

/* What was measured on the eyes. */
typedef struct MienGazeInfo {
    size_t struct_size;
    MienGazeTarget left_eye; /* center of rotation */
    MienGazeTarget right_eye;
    float fit_error;         /* degrees, largest error found when an eye turns sideways and up at once */
    uint32_t reserved;       /* 0 */
} MienGazeInfo;
MIEN_DEFAULT(MienGazeInfo, mien_gaze_info_default)

/* Returns where the eyes are, so that a target can be placed in front of them. */
MIEN_CHECKED MienStatus mien_gaze_info(const MienGaze* gaze, MienGazeInfo* out_info);

/* The part of a gaze that the eyes cannot reach, left for the head to turn: tangents of angles, averaged
 * over both eyes. */
typedef struct MienGazeRest {
    float left;
    float up;
} MienGazeRest;

/* Sets the raw controls of a row so that both eyes look at a target. Eyes converge on near targets.
 * `out_rest` may be NULL. Does not allocate or lock.
 * Fails with MIEN_ERROR_MISMATCH if `row_count` is less than the raw controls, MIEN_ERROR_INVALID_ARGUMENT
 * if the target is not finite. */
MIEN_CHECKED MienStatus mien_gaze_look_at(const MienGaze* gaze, const MienGazeTarget* target, float* row,
                                          size_t row_count, MienGazeRest* out_rest);

/* ---- Mixer ----------------------------------------------------------------------------------- */

/* One character in a mix: its running clips, fades and reactions. Another thread may only call
 * mien_mixer_push() at the same time. */
typedef struct MienMixer MienMixer;

/* How to create a mixer. */
typedef struct MienMixerDesc {
    size_t struct_size;
    uint64_t seed;     /* of the generators */
    uint32_t stages;   /* boolean: keep the row after each stage, for mien_mixer_stage() */
    uint32_t reserved; /* 0 */
    const MienAllocator* allocator;
} MienMixerDesc;
MIEN_DEFAULT(MienMixerDesc, mien_mixer_desc_default)

/* Creates a mixer at time 0, with one allocation. No clip plays; pose weights and pose variables are 0.
 * `mix` may be destroyed before it. Destroy with mien_mixer_destroy(). */
MIEN_CHECKED MienStatus mien_mixer_create(const MienMix* mix, const MienMixerDesc* desc,
                                          MienMixer** out_mixer, MienError* error);

/* Destroys a mixer. */
MIEN_API void mien_mixer_destroy(MienMixer* mixer);

/* How a layer changes to another clip. A layer that plays no clip fades in, except with a cut. */
enum MienTransition {
    MIEN_TRANSITION_INERTIAL = 0,  /* the old clip stops; each curve blends from its last value and speed */
    MIEN_TRANSITION_CROSSFADE = 1, /* both clips play; MIEN_TRANSITION_INERTIAL if no player is free */
    MIEN_TRANSITION_CUT = 2        /* immediate; transition_ticks is not used */
};

/* How to play a clip in a layer. */
typedef struct MienPlayDesc {
    size_t struct_size;
    uint64_t clip_id;          /* chosen by the caller, to identify clip and binding in
                                  mien_mixer_restore() */
    int64_t start_tick;        /* in the clip */
    int64_t transition_ticks;  /* 0 to 2^40 */
    uint32_t transition;       /* MIEN_TRANSITION_... */
    uint32_t looping;          /* MIEN_LOOPING_... */
    uint32_t interpolation;    /* MIEN_INTERPOLATION_... */
    int32_t speed_numerator;   /* as in MienClipPlayerDesc */
    int32_t speed_denominator;
    uint32_t mirrored;         /* boolean; requires MienMixDesc.mirror */
} MienPlayDesc;
MIEN_DEFAULT(MienPlayDesc, mien_play_desc_default)

/* Plays a clip in a layer, from the next step on. `clip` and `clip_binding` must outlive their playback,
 * including the transition to the next clip. On failure the layer continues as before. Does not allocate or
 * lock.
 * Fails with MIEN_ERROR_INDEX if the layer does not exist or has another source, MIEN_ERROR_MISMATCH if
 * the binding is for another clip or rig, MIEN_ERROR_INVALID_ARGUMENT if a time, speed or enum value is
 * out of range or a delta clip would play in a layer that overrides, MIEN_ERROR_CLIP_LIMIT if the clip is
 * larger than the mix allows. */
MIEN_CHECKED MienStatus mien_mixer_play(MienMixer* mixer, uint32_t layer, const MienClip* clip,
                                        const MienClipBinding* clip_binding,
                                        const MienPlayDesc* desc, MienError* error);

/* Fades out the clip of a layer and stops it. Fades take 0 to 2^40 ticks, here and below; they start from
 * the current value and speed, and end with speed 0. Does not allocate or lock.
 * Fails with MIEN_ERROR_INDEX if the layer does not exist or is not a clip layer. */
MIEN_CHECKED MienStatus mien_mixer_stop(MienMixer* mixer, uint32_t layer, int64_t fade_ticks);

/* Fades the weight of a layer to `weight`, which has the range of MienMixLayer.weight. Does not allocate or
 * lock.
 * Fails with MIEN_ERROR_INDEX if the layer does not exist. */
MIEN_CHECKED MienStatus mien_mixer_set_weight(MienMixer* mixer, uint32_t layer, float weight,
                                              int64_t fade_ticks);

/* Fades the weight of a pose to `weight`, 0 to 1. `pose` counts from the first pose of the layer. Weights
 * of a layer that add up to more than 1 are divided by their sum. Does not allocate or lock.
 * Fails with MIEN_ERROR_INDEX if the layer or its pose does not exist. */
MIEN_CHECKED MienStatus mien_mixer_set_pose_weight(MienMixer* mixer, uint32_t layer, uint32_t pose,
                                                   float weight, int64_t fade_ticks);

/* Sets the `value` that a pose variable has at the start of each step, before the layers. Does not
 * allocate or lock.
 * Fails with MIEN_ERROR_INDEX if it does not exist, MIEN_ERROR_INVALID_ARGUMENT if the value is not
 * finite. */
MIEN_CHECKED MienStatus mien_mixer_set_variable(MienMixer* mixer, uint32_t variable, float value);

/* Sets how much a guard acts: `activation` is 0 to 1, or negative for automatic, the default: the smaller
 * the gap that base and speech leave, the more the guard acts; guards of lips and teeth act at most as
 * much as the largest weight of a speech layer. mien_mixer_guard() returns the name for a `guard_index`.
 * Does not allocate or lock.
 * Fails with MIEN_ERROR_INDEX if the guard does not exist, MIEN_ERROR_INVALID_ARGUMENT if `activation` is
 * above 1 or not a number. */
MIEN_CHECKED MienStatus mien_mixer_set_guard(MienMixer* mixer, uint32_t guard_index,
                                             float activation);

/* What a guard did in the last step. Distances are in millimeters, computed by the function of raw controls
 * that was measured on the rig; a negative distance means that both sides overlap. */
typedef struct MienGuardState {
    size_t struct_size;
    MienStringView name;       /* "lips left", "lips center", "lips right", "teeth", "lower lip to teeth",
                                  "left lids", "right lids" or "custom" */
    MienIndex16View controls;  /* raw controls that it may hold back */
    uint32_t kind;             /* MIEN_GUARD_...; 0: one of MienMixDesc.custom_guards */
    float activation;          /* how much it acted, 0 to 1 */
    float protected_distance;  /* distance after the last layer of base and speech */
    float wanted;              /* distance just before the guards, after the later layers and reactions */
    float limit;               /* largest distance that the guard allows when fully active */
    float distance;            /* distance after the guards: above `limit` if the guard is not fully
                                  active, while it eases in, or if other controls open the gap */
} MienGuardState;
MIEN_DEFAULT(MienGuardState, mien_guard_state_default)

/* Returns what a guard did in the last step. `guard_index` counts as in mien_mixer_set_guard(). Views point
 * into the mix.
 * Fails with MIEN_ERROR_INDEX if the guard does not exist. */
MIEN_CHECKED MienStatus mien_mixer_guard(const MienMixer* mixer, uint32_t guard_index,
                                         MienGuardState* out_state);

/* Starts a reaction to a stimulus of `strength`, 0 to 1, that lasts for `hold_ticks`, at most 2^40; if
 * negative, until mien_mixer_release(). Does not allocate or lock.
 * Fails with MIEN_ERROR_INDEX if the reaction does not exist, MIEN_ERROR_INVALID_ARGUMENT if strength or
 * time is out of range. */
MIEN_CHECKED MienStatus mien_mixer_trigger(MienMixer* mixer, uint32_t reaction, float strength,
                                           int64_t hold_ticks);

/* Ends the stimulus of a reaction. Does not allocate or lock.
 * Fails with MIEN_ERROR_INDEX if the reaction does not exist. */
MIEN_CHECKED MienStatus mien_mixer_release(MienMixer* mixer, uint32_t reaction);

/* Sets the level of what a reaction responds to, such as a brightness, 0 to 1. Call it whenever the level
 * changes. A level of MienMixReaction.level_on or more is a stimulus of strength 1, which ends once the
 * level has been below level_off for 50 ms, so a flickering light counts as on. During the stimulus, scaled
 * strokes follow the level without overshoot; 90 % of a change takes 0.25 s. Does not allocate or lock.
 * Fails with MIEN_ERROR_INDEX if the reaction does not exist, MIEN_ERROR_INVALID_ARGUMENT if it has no
 * level_on or `level` is out of range. */
MIEN_CHECKED MienStatus mien_mixer_set_level(MienMixer* mixer, uint32_t reaction, float level);

/* Queues a row for a stream layer: one value per channel, for time `tick` of the mixer. One thread may call
 * this while another one uses the mixer. `out_accepted` may be NULL; it is set to 0 if the row is dropped
 * because it is not newer than the last one or the queue is full. Does not allocate or lock.
 * Fails with MIEN_ERROR_INDEX if the layer does not exist or is not a stream, MIEN_ERROR_MISMATCH if it has
 * another number of channels, MIEN_ERROR_INVALID_ARGUMENT if a value is not finite or `tick` is 2^61 or
 * more. */
MIEN_CHECKED MienStatus mien_mixer_push(MienMixer* mixer, uint32_t layer, int64_t tick,
                                        const float* values, size_t value_count,
                                        uint32_t* out_accepted);

/* Advances the time by `ticks`, 0 to 2^40, and mixes. Writes the raw controls to `instance`, which may
 * be NULL. Does not allocate or lock.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if `ticks` is out of range or the time would exceed 2^60 ticks
 * (51 years), MIEN_ERROR_MISMATCH if the instance has another number of raw controls. */
MIEN_CHECKED MienStatus mien_mixer_step(MienMixer* mixer, int64_t ticks, MienInstance* instance);

/* Steps `count` mixers; instances[i] belongs to mixers[i]. `instances` may be NULL. The results are those
 * of single calls. On failure no mixer is advanced.
 * Fails like mien_mixer_step(), and with MIEN_ERROR_INVALID_ARGUMENT if a mixer is listed twice. */
MIEN_CHECKED MienStatus mien_mixer_step_batch(MienMixer* const* mixers,
                                              MienInstance* const* instances, size_t count,
                                              int64_t ticks);

/* Returns the row of the last step, one float per curve: raw controls, then pose variables.
 * Contents change with mien_mixer_step() and mien_mixer_step_batch(). */
MIEN_CHECKED MienStatus mien_mixer_row(const MienMixer* mixer, MienFloatView* out_row);

/* Returns the row after a stage of the last step, one float per curve. Stages are numbered: the layers,
 * then reactions, guards, antagonists, limits. Layers that act after the reactions or the guards keep
 * their numbers.
 * Fails with MIEN_ERROR_INDEX if the stage does not exist, MIEN_ERROR_INVALID_ARGUMENT if
 * MienMixerDesc.stages was 0.
 * Contents change with mien_mixer_step() and mien_mixer_step_batch(). */
MIEN_CHECKED MienStatus mien_mixer_stage(const MienMixer* mixer, uint32_t stage,
                                         MienFloatView* out_row);

/* State of a mixer. */
typedef struct MienMixerInfo {
    size_t struct_size;
    int64_t tick;         /* time since creation */
    uint32_t event_count; /* clip events that the last step passed */
    uint32_t lost_events; /* boolean: there were more than MienMixDesc.max_events */
} MienMixerInfo;
MIEN_DEFAULT(MienMixerInfo, mien_mixer_info_default)

/* Returns the state of a mixer. */
MIEN_CHECKED MienStatus mien_mixer_info(const MienMixer* mixer, MienMixerInfo* out_info);

/* Returns an event of the last step and its layer. The tick is in the time of the clip, and the name is a
 * view into the clip.
 * Fails with MIEN_ERROR_INDEX if `index` is out of range. */
MIEN_CHECKED MienStatus mien_mixer_event(const MienMixer* mixer, uint32_t index,
                                         MienClipEvent* out_event, uint32_t* out_layer);

/* Writes the state of a mixer to memory: everything that later steps depend on, except queued stream rows.
 * Returns its size in `out_size`. `buffer` may be NULL with capacity 0 to get the size only. Snapshots
 * can be restored on 64-bit machines of the same byte order. Does not allocate or lock.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if `capacity` is too small. */
MIEN_CHECKED MienStatus mien_mixer_snapshot(MienMixer* mixer, void* buffer, size_t capacity,
                                            size_t* out_size, MienError* error);

/* A clip that mien_mixer_restore() may need. */
typedef struct MienMixerClip {
    uint64_t clip_id; /* as in MienPlayDesc */
    const MienClip* clip;
    const MienClipBinding* clip_binding;
} MienMixerClip;

/* Restores a snapshot of a mixer of the same mix; later steps give the same bits. Queued stream rows are
 * not part of it. `clips` lists the clips that may have been playing. The bytes are validated, so they
 * need not be trusted. On failure the mixer does not change. Does not allocate or lock.
 * Fails with MIEN_ERROR_INVALID_ARGUMENT if the bytes are not a snapshot of this mix,
 * MIEN_ERROR_MISMATCH if a clip is missing or is not the one that was playing. */
MIEN_CHECKED MienStatus mien_mixer_restore(MienMixer* mixer, const void* bytes, size_t size,
                                           const MienMixerClip* clips, size_t clip_count,
                                           MienError* error);

#ifdef __cplusplus
}
#endif

#endif /* MIEN_MIX_H */
