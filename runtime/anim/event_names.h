// SPDX-License-Identifier: MIT
// Events that name themselves -> the list of names that a clip stores once.
#pragma once

#include "runtime/anim/clip_builder.h"
#include "runtime/base/arena.h"

namespace mien {

/// Sets `desc.event_names`, ascending and each once, and the number of the name in `desc.events`, which are
/// as many as `names`, in the same order. Memory is that of the arena; false if it ran out.
bool list_event_names(Span<const Span<const char>> names, Span<ClipEventDesc> events, Arena& arena,
                      ClipDesc& desc);

}  // namespace mien
