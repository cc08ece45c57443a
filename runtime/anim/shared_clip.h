// SPDX-License-Identifier: MIT
// A clip with its bytes: built here, a file, a copy of a stream, or the caller's memory. Players share it.
#pragma once

#include "runtime/anim/clip.h"
#include "runtime/anim/clip_builder.h"
#include "runtime/base/shared_bytes.h"

namespace mien {

struct SharedClip : SharedBytes {
  static constexpr uint32_t kTag = 0x6D43'4C50;

  Clip view;
  ClipBytes built;                    // of a clip that was built here, otherwise none
  Span<const ChannelReport> reports;  // [channel] the same
  ~SharedClip() { release_clip(built); }
};

// On success, give back `out` with release(). Errors of open_clip() besides those that are named.

/// Errors of build_clip().
Status create_clip(const ClipDesc& desc, const Allocator& allocator, SharedClip*& out,
                   Error& error);
/// Errors of open_file().
Status open_clip_file(const char* path, FileAccess access, const Allocator& allocator,
                      SharedClip*& out, Error& error);
/// The bytes are used in place and have to outlive the clip. kMemory.
Status open_clip_memory(Span<const uint8_t> bytes, const Allocator& allocator, SharedClip*& out,
                        Error& error);
/// kFileRead, kMemory.
Status open_clip_stream(const Stream& stream, const Allocator& allocator, SharedClip*& out,
                        Error& error);

}  // namespace mien
