// SPDX-License-Identifier: MIT
// What a mix needs to know of a rig, in the section "Mix" of mien/mix.h: antagonists, mirror, mask, gaze.
#include <algorithm>
#include <cmath>

#include "capi/handles.h"
#include "runtime/probe/probe_controls.h"
#include "runtime/probe/probe_gaze.h"
#include "runtime/probe/probe_snaps.h"

using namespace mien;
using namespace mien::capi;

static_assert(sizeof(MienMixAntagonists) == sizeof(AntagonistPair) &&
                  offsetof(MienMixAntagonists, second) == offsetof(AntagonistPair, second) &&
                  offsetof(MienMixAntagonists, stiffness) == offsetof(AntagonistPair, stiffness),
              "both have one layout");

MienStatus mien_mix_antagonists(const MienRig* rig, MienMixAntagonists* out_pairs, size_t capacity,
                                size_t* out_count) {
  if (!out_count) return MIEN_ERROR_NULL_ARGUMENT;
  *out_count = 0;
  if (!out_pairs && capacity != 0) return MIEN_ERROR_NULL_ARGUMENT;
  if (MienStatus status = check(rig)) return status;
  *out_count =
      find_antagonists(*object(rig), {reinterpret_cast<AntagonistPair*>(out_pairs), capacity});
  return MIEN_OK;
}

MienStatus mien_mix_mirror(const MienDeformer* deformer, uint16_t* out_curves, size_t curve_count,
                           MienError* error) {
  if (MienStatus status = check_error(error)) return status;
  if (!out_curves) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "out_curves is NULL");
  if (MienStatus status = check(deformer)) return give_error(error, status, "not a deformer");
  const Deformer& of = *object(deformer);
  if (curve_count < of.rig->raw_count || curve_count > kMaxCurves) {
    return give_error(error, MIEN_ERROR_MISMATCH, "%zu curves; the rig has %u raw controls",
                      curve_count, of.rig->raw_count);
  }
  Error detail;
  const Span<uint16_t> curves = {out_curves, of.rig->raw_count};
  if (find_mirror(of, of.rig->allocator, curves, detail) != Status::kOk) {
    return give_error(detail, error);
  }
  for (size_t i = curves.count; i < curve_count; ++i) out_curves[i] = static_cast<uint16_t>(i);
  return succeed(error);
}

MienStatus mien_mix_mask(const MienRig* rig, const uint32_t* groups, size_t group_count,
                         float otherwise_weight, float* out_mask, size_t curve_count,
                         MienError* error) {
  if (MienStatus status = check_error(error)) return status;
  if (!out_mask || (!groups && group_count != 0)) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "groups or out_mask is NULL");
  }
  if (MienStatus status = check(rig)) return give_error(error, status, "not a rig");
  const Rig& of = *object(rig);
  if (curve_count < of.raw_count) {
    return give_error(error, MIEN_ERROR_MISMATCH, "%zu curves; the rig has %u raw controls",
                      curve_count, of.raw_count);
  }
  Error detail;
  if (mask_of_groups(of, {groups, group_count}, otherwise_weight, of.allocator,
                     {out_mask, of.raw_count}, detail) != Status::kOk) {
    return give_error(detail, error);
  }
  std::fill(out_mask + of.raw_count, out_mask + curve_count, otherwise_weight);
  return succeed(error);
}

// Gaze --------------------------------------------------------------------------------------------

MienStatus mien_gaze_create(const MienDeformer* deformer, const MienGazeDesc* desc,
                            MienGaze** out_gaze, MienError* error) {
  if (MienStatus status = clear_output(out_gaze, error)) return status;
  if (MienStatus status = check(deformer)) return give_error(error, status, "not a deformer");
  MienGazeDesc known;
  if (MienStatus status = read_desc(desc, known, "MienGazeDesc", error)) return status;
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  const Deformer& of = *object(deformer);
  uint32_t eyes[2];
  find_eyes(*of.rig, eyes);
  if (known.left_eye) eyes[0] = find_joint(*of.rig, {known.left_eye});
  if (known.right_eye) eyes[1] = find_joint(*of.rig, {known.right_eye});
  for (uint32_t eye : eyes) {
    if (eye != kNoJoint) continue;
    return give_error(error, MIEN_ERROR_NAME, "the rig has no joints for both eyes: name them");
  }
  Gaze* gaze = nullptr;
  Error detail;
  const Status status = create_gaze(of, eyes, allocator, gaze, detail);
  return give_object(status, gaze, detail, out_gaze, error);
}

void mien_gaze_destroy(MienGaze* gaze) { destroy(gaze); }

MienStatus mien_gaze_info(const MienGaze* gaze, MienGazeInfo* out_info) {
  if (MienStatus status = clear_struct(out_info)) return status;
  if (MienStatus status = check(gaze)) return status;
  const auto middle = [](const GazeEye& eye) {
    return MienGazeTarget{eye.center[0], eye.center[1], eye.center[2]};
  };
  const GazeTable& table = object(gaze)->table;
  write_struct(out_info, MienGazeInfo{sizeof(MienGazeInfo), middle(table.eyes[0]),
                                      middle(table.eyes[1]), table.fit_error, 0});
  return MIEN_OK;
}

MienStatus mien_gaze_look_at(const MienGaze* gaze, const MienGazeTarget* target, float* row,
                             size_t row_count, MienGazeRest* out_rest) {
  if (out_rest) *out_rest = {0, 0};
  if (!target || !row) return MIEN_ERROR_NULL_ARGUMENT;
  if (MienStatus status = check(gaze)) return status;
  if (row_count < object(gaze)->raw_count) return MIEN_ERROR_MISMATCH;
  const float place[3] = {target->left, target->up, target->front};
  for (float value : place) {
    if (!std::isfinite(value)) return MIEN_ERROR_INVALID_ARGUMENT;
  }
  float rest[2];
  look_at(object(gaze)->table, place, row, rest);
  if (out_rest) *out_rest = {rest[0], rest[1]};
  return MIEN_OK;
}
