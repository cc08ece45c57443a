// SPDX-License-Identifier: MIT
// The section "Clip binding" of mien/clip.h.
#include <cmath>
#include <cstdio>

#include "capi/handles.h"
#include "runtime/anim/arkit_table.h"
#include "runtime/probe/probe_snaps.h"

using namespace mien;
using namespace mien::capi;

MienStatus mien_clip_binding_create(const MienClip* clip, const MienRig* rig,
                                    const MienClipBindingDesc* desc,
                                    MienClipBinding** out_clip_binding, MienError* error) {
  if (MienStatus status = clear_output(out_clip_binding, error)) return status;
  if (MienStatus status = check(clip, "clip", error)) return status;
  if (MienStatus status = check(rig, "rig", error)) return status;
  MienClipBindingDesc known;
  if (MienStatus status = read_desc(desc, known, "MienClipBindingDesc", error)) return status;
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  if (!known.matrix && known.matrix_count != 0) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT,
                      "MienClipBindingDesc.matrix is NULL, but .matrix_count is %zu",
                      known.matrix_count);
  }
  if (known.matrix_count > UINT32_MAX / 2) {
    return give_error(error, MIEN_ERROR_CLIP_LIMIT,
                      "MienClipBindingDesc.matrix_count is %zu; at most %u are supported",
                      known.matrix_count, UINT32_MAX / 2);
  }
  for (size_t e = 0; e < known.matrix_count; ++e) {
    const MienMatrixEntry& entry = known.matrix[e];
    if ((entry.channel.data || entry.channel.count == 0) &&
        (entry.control.data || entry.control.count == 0)) {
      continue;
    }
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "entry %zu of the matrix: a name is NULL",
                      e);
  }
  Arena arena(allocator);
  const Span<MatrixEntry> matrix = arena.array<MatrixEntry>(known.matrix_count);
  if (matrix.count != known.matrix_count) {
    return give_error(error, MIEN_ERROR_MEMORY, "no memory to bind a clip");
  }
  for (size_t e = 0; e < matrix.count; ++e) {
    const MienMatrixEntry& entry = known.matrix[e];
    matrix[e] = {span_of(entry.channel), span_of(entry.control), entry.weight};
  }
  Binding* made = nullptr;
  Error detail;
  const Status status =
      bind_clip(object(clip)->view, *object(rig), matrix, allocator, made, detail);
  return give_object(status, made, detail, out_clip_binding, error);
}

MienStatus mien_arkit_matrix(MienMatrixEntry* out_entries, size_t capacity, size_t* out_count) {
  if (!out_count) return MIEN_ERROR_NULL_ARGUMENT;
  *out_count = 0;
  if (!out_entries && capacity != 0) return MIEN_ERROR_NULL_ARGUMENT;
  const Span<const ArkitEntry> table = arkit_table();
  *out_count = table.count;
  for (size_t i = 0; i < table.count && i < capacity; ++i) {
    const ArkitEntry& from = table[i];
    out_entries[i] = {{from.expression, strlen(from.expression)},
                      {from.control, strlen(from.control)},
                      from.weight,
                      0};
  }
  return MIEN_OK;
}

void mien_clip_binding_destroy(MienClipBinding* clip_binding) { destroy(clip_binding); }

MienStatus mien_clip_binding_info(const MienClipBinding* clip_binding,
                                  MienClipBindingInfo* out_info) {
  if (MienStatus status = clear_struct(out_info)) return status;
  if (MienStatus status = check(clip_binding)) return status;
  const Binding& binding = *object(clip_binding);
  MienClipBindingInfo info = {};
  info.channel_count = binding.channel_count;
  info.raw_control_count = binding.raw_count;
  info.missing_entry_count = binding.missing_entries;
  info.controls = view_of(binding.controls);
  info.extra_controls = view_of(binding.extra_controls);
  info.missing_channels = view_of(binding.missing_channels);
  write_struct(out_info, info);
  return MIEN_OK;
}

MienStatus mien_clip_binding_apply(const MienClipBinding* clip_binding, const float* values,
                                   size_t value_count, float* raw_controls,
                                   size_t raw_control_count) {
  if (MienStatus status = check(clip_binding)) return status;
  const Binding& binding = *object(clip_binding);
  if ((!values && value_count != 0) || (!raw_controls && raw_control_count != 0)) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  if (value_count != binding.channel_count || raw_control_count != binding.raw_count) {
    return MIEN_ERROR_INVALID_ARGUMENT;
  }
  float gui[kMaxBoundGuiControls];
  apply_binding(binding, {values, value_count}, {gui, kMaxBoundGuiControls},
                {raw_controls, raw_control_count});
  return MIEN_OK;
}

MienStatus mien_clip_binding_snaps(const MienClipBinding* clip_binding,
                                   const MienDeformer* deformer, float tolerance, float* out_snaps,
                                   size_t channel_count, MienError* error) {
  if (MienStatus status = check_error(error)) return status;
  if (!out_snaps && channel_count != 0) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "out_snaps is NULL");
  }
  if (MienStatus status = check(clip_binding, "clip_binding", error)) return status;
  if (MienStatus status = check(deformer, "deformer", error)) return status;
  const Binding& binding = *object(clip_binding);
  const Deformer& of = *object(deformer);
  if (channel_count != binding.channel_count || binding.raw_count != of.rig->raw_count) {
    return give_error(error, MIEN_ERROR_MISMATCH,
                      "%zu steps for %u channels, which drive %u raw controls of the %u of the rig",
                      channel_count, binding.channel_count, binding.raw_count, of.rig->raw_count);
  }
  if (!(tolerance > 0) || !std::isfinite(tolerance)) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "tolerance is %g; it must be above 0 millimeters", double{tolerance});
  }
  Arena arena(of.rig->allocator);
  const Span<uint8_t> snaps = arena.array<uint8_t>(channel_count + 1);
  Error detail;
  if (!snaps.data) return give_error(error, MIEN_ERROR_MEMORY, "no memory for steps");
  if (probe_snaps(of, binding, tolerance, of.rig->allocator, snaps, detail) != Status::kOk) {
    return give_error(detail, error);
  }
  for (size_t c = 0; c < channel_count; ++c) {
    out_snaps[c] = snap_step(snaps[c]);
  }
  return succeed(error);
}
