/* SPDX-License-Identifier: MIT
 *
 * Names of controls in the spellings and vocabularies of other tools.
 * The rules of mien.h apply.
 *
 * A name matches the raw controls found by the first of these steps that finds any:
 *
 *   1. the same name, without regard to case; `.` matches `_`, and a prefix up to the last `.` may be missing
 *   2. the same letters and the same side: mouthSmileLeft, mouthSmile_L, mouth_smile_l, Left mouth smile
 *   3. both sides, for a name without one: browInnerUp is browInnerUp_L and browInnerUp_R
 *   4. an expression of several controls: mouthFunnel is four controls of MetaHuman rigs
 *   5. another word for the same control: AU12_L and mouthCornerPullL are mouthSmileLeft
 *
 * The words are those of ARKit, Unified Expressions, VRM, FACS (AU12, with sides), MetaHuman's raw
 * controls, and some that sculptors and MakeHuman use. docs/face-capture.md, 2 "Names" lists the rules.
 */
#ifndef MIEN_NAMES_H
#define MIEN_NAMES_H

#include "rig.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Names of controls ----------------------------------------------------------------------- */

/* How a name was matched. */
enum MienNameMatch {
    MIEN_NAME_MATCH_NONE = 0,
    MIEN_NAME_MATCH_AS_WRITTEN = 1, /* the control has this name */
    MIEN_NAME_MATCH_SPELLING = 2,   /* the same letters and side */
    MIEN_NAME_MATCH_ALIAS = 3,      /* another word for the same control */
    MIEN_NAME_MATCH_BOTH_SIDES = 4, /* the controls of the left and the right side */
    MIEN_NAME_MATCH_EXPRESSION = 5  /* an expression of several controls */
};

/* A raw control and its share: if the name has the value v, the control gets weight * v. */
typedef struct MienControlShare {
    uint32_t control;
    float weight;
} MienControlShare;

/* The largest number of controls that a name matches. */
#define MIEN_MOST_SHARES 16

/* Finds the raw controls that a name stands for on a rig. Takes time proportional to the number of raw
 * controls: meant for loading, not for every frame. Does not allocate or lock. Writes as many shares as
 * fit; `out_count` is the total number, at most MIEN_MOST_SHARES, each of a different control. `out_shares`
 * may be NULL if `capacity` is 0. `out_match` is one of MIEN_NAME_MATCH_....
 * Fails with MIEN_ERROR_NAME if the name matches no control of this rig, or several in step 1 or 2.
 * See docs/face-capture.md, 2 "Names". */
MIEN_CHECKED MienStatus mien_rig_match(const MienRig* rig, const char* name, size_t name_count,
                                       MienControlShare* out_shares, size_t capacity,
                                       size_t* out_count, uint32_t* out_match);

/* Returns the usual name of a control: that of ARKit, such as mouthSmileLeft for AU12_L and
 * mouthCornerPullL, or that of MetaHuman's raw controls if ARKit has none. A name without a side gets none:
 * mouthSmile. Writes as many bytes as fit, without a null; `out_count` is the total number. `out_name` may
 * be NULL if `capacity` is 0.
 * Fails with MIEN_ERROR_NAME if the name is not in the table.
 * See docs/face-capture.md, 2 "Names". */
MIEN_CHECKED MienStatus mien_control_name(const char* name, size_t name_count, char* out_name,
                                          size_t capacity, size_t* out_count);

#ifdef __cplusplus
}
#endif

#endif /* MIEN_NAMES_H */
