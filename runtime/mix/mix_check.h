// SPDX-License-Identifier: MIT
#pragma once

#include "runtime/base/status.h"
#include "runtime/mix/mix.h"

namespace mien {

/// Whether a mix can be made of a desc: each field within its limits (mix_fields.h), and the fields
/// together. kInvalidArgument; the message names the element and the field.
Status check_mix(const MixDesc& desc, Error& error);

}  // namespace mien
