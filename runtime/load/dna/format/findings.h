// SPDX-License-Identifier: MIT
// Where checks report what they find. Opening a file stops at the first error; validation keeps
// all.
#pragma once

#include "runtime/base/status.h"

namespace mien::dna {

struct Finding {
  Status status = Status::kOk;       // kOk: a warning
  uint64_t byte_offset = kNoOffset;  // in the file
  const char* field = "";            // path, as "bhvr.joints.jointGroups[3].values"
  const char* message = "";          // what is wrong, with the numbers; no path, no offset
};

/// `report` copies what it wants to keep. It returns false to end the examination.
struct FindingSink {
  void* user = nullptr;
  bool (*report)(void* user, const Finding& finding) = nullptr;

  /// Opening asks only for errors that evaluation or the caller depend on. Validation also asks for
  /// warnings and for the checks that read every number (NaN, weights).
  bool thorough = false;
};

}  // namespace mien::dna
