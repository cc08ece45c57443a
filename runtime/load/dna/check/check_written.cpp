// SPDX-License-Identifier: MIT
#include "runtime/load/dna/check/check_written.h"

#include <cinttypes>

#include "runtime/load/dna/check/dna_check.h"
#include "runtime/load/dna/format/pose_controls.h"

namespace mien::dna {
namespace {

struct FirstError {
  Error& error;
  unsigned version;
};

bool keep_first(void* user, const Finding& finding) {
  if (finding.status == Status::kOk) return true;
  const FirstError& first = *static_cast<FirstError*>(user);
  fail(first.error, finding.status, finding.byte_offset,
       "without the layers that are left out of version 2.%u the file would not open: %s: %s",
       first.version, finding.field, finding.message);
  return false;
}

}  // namespace

bool leave_out_layers(DnaView& view, const WriteOptions& options) {
  bool changed = false;
  for (const LayerKind& kind : kLayerKinds) {
    if (is_written(view, kind, options)) continue;
    with_layer(view, kind.id, [](auto& record) { record = {}; });
    changed = true;
  }
  view.ml_control_count = view.mlbh.control_names.count;
  return changed;
}

Status check_written(const DnaView& view, const WriteOptions& options, Arena& arena, Error& error) {
  if (view.has(kLayerRbf) && !view.has(kLayerMachineLearned) && view.ml_control_count != 0) {
    return fail(error, Status::kDnaLayer, kNoOffset,
                "RBF behavior was opened without the machine-learned behavior of the file, "
                "whose controls are numbered before its own: open both to write the file");
  }
  const uint64_t size = encoded_size(view, options);
  if (size > UINT32_MAX) {
    return fail(error, Status::kDnaLimit, kNoOffset,
                "the file would have %" PRIu64
                " bytes, DNA files hold less than 4 GiB: write fewer LODs or layers",
                size);
  }
  DnaView left = view;
  if (!leave_out_layers(left, options)) return Status::kOk;
  if (!synthesize_pose_controls(left, arena)) {
    return fail(error, Status::kMemory, kNoOffset, "no memory for pose controls");
  }
  error.status = Status::kOk;
  FirstError first{error, options.version};
  const FindingSink sink{&first, keep_first, false};
  if (check_definition(left, sink)) check_layers(left, sink);
  return error.status;
}

}  // namespace mien::dna
