/* SPDX-License-Identifier: MIT
 *
 * Names of controls in the spellings and vocabularies of other tools.
 * The rules of mien.h apply.
 *
 * A name matches the raw control that, in this order,
 *
 *   1. has this name, without regard to case, `.` being `_`, and without what stands before the last `.`
 *   2. has the same letters and the same side: mouthSmileLeft, mouthSmile_L, mouth_smile_l, Left mouth smile
 *   3. is one of both sides, where the name has none: browInnerUp is browInnerUp_L and browInnerUp_R
 *   4. is a part of the expression that the name means: mouthFunnel is four controls of MetaHuman rigs
 *   5. is another word for the same: AU12_L and mouthCornerPullL are mouthSmileLeft
 *
 * The words are those of ARKit, Unified Expressions, VRM, FACS (AU12, with sides), MetaHuman's raw controls,
 * and some of sculptors and of MakeHuman. docs/face-capture.md, 2 "Names" lists the rules.
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
    MIEN_NAME_MATCH_EXPRESSION = 5  /* an expression that is several controls */
};

/* A raw control, and its share: at value v of the name it gets weight * v. */
typedef struct MienControlShare {
    uint32_t control;
    float weight;
} MienControlShare;

/* The largest number of shares of a name. */
#define MIEN_MOST_SHARES 16

/* Finds the raw controls that a name means on a rig. Takes time in proportion to the number of raw controls: for
 * loading, not for every frame. Allocates nothing. Writes as many shares as fit; `out_count` is the
 * total number, at most MIEN_MOST_SHARES, each of another control. `out_shares` may be NULL if `capacity` is 0.
 * `out_match` is one of MIEN_NAME_MATCH_....
 * Fails with MIEN_ERROR_NAME if the name means nothing on this rig, or in step 1 or 2 several controls.
 * See docs/face-capture.md, 2 "Names". */
MIEN_CHECKED MienStatus mien_rig_match(const MienRig* rig, const char* name, size_t name_count,
                                       MienControlShare* out_shares, size_t capacity,
                                       size_t* out_count, uint32_t* out_match);

/* Gives the usual name of a control: that of ARKit, such as mouthSmileLeft for AU12_L and mouthCornerPullL; where ARKit
 * has none, that of MetaHuman's raw controls. A name without a side stays without: mouthSmile. Writes as many bytes as
 * fit, without a null; `out_count` is the total number. `out_name` may be NULL if `capacity` is 0.
 * Fails with MIEN_ERROR_NAME if the name is not in the table.
 * See docs/face-capture.md, 2 "Names". */
MIEN_CHECKED MienStatus mien_control_name(const char* name, size_t name_count, char* out_name,
                                          size_t capacity, size_t* out_count);

#ifdef __cplusplus
}
#endif

#endif /* MIEN_NAMES_H */
