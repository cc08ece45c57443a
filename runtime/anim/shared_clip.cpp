// SPDX-License-Identifier: MIT
#include "runtime/anim/shared_clip.h"

namespace mien {
namespace {

constexpr char kWhat[] = "a clip";

/// Checks the bytes of a clip that was created; `created` tells whether it was. Drops it on failure.
Status finish(Status created, SharedClip*& clip, Error& error) {
  if (created != Status::kOk) return created;
  const Status status = open_clip(clip->data, clip->size, clip->view, error);
  if (status == Status::kOk) return status;
  release(clip);
  clip = nullptr;
  return status;
}

}  // namespace

Status create_clip(const ClipDesc& desc, const Allocator& allocator, SharedClip*& out,
                   Error& error) {
  Span<ChannelReport> reports;
  out = create_object<SharedClip>(allocator, [&](Placer& placer, SharedClip& clip) {
    clip.reports = reports = placer.array<ChannelReport>(desc.names.count);
  });
  if (!out) return fail(error, Status::kMemory, kNoOffset, "no memory for a clip");
  const Status status = build_clip(desc, allocator, reports, out->built, error);
  if (status != Status::kOk) {
    release(out);
    out = nullptr;
    return status;
  }
  out->data = out->built.bytes;
  out->size = out->built.size;
  return finish(status, out, error);
}

Status open_clip_file(const char* path, FileAccess access, const Allocator& allocator,
                      SharedClip*& out, Error& error) {
  return finish(create_from_file(path, access, {kClipMagic, sizeof(kClipMagic)}, kWhat, allocator,
                                 out, error),
                out, error);
}

Status open_clip_memory(Span<const uint8_t> bytes, const Allocator& allocator, SharedClip*& out,
                        Error& error) {
  const Status created = create_with_bytes(0, kWhat, allocator, out, error);
  if (created == Status::kOk) {
    out->data = bytes.data;
    out->size = bytes.count;
  }
  return finish(created, out, error);
}

Status open_clip_stream(const Stream& stream, const Allocator& allocator, SharedClip*& out,
                        Error& error) {
  return finish(create_from_stream(stream, kWhat, allocator, out, error), out, error);
}

}  // namespace mien
