// SPDX-License-Identifier: MIT
// Files of mixes, in the section "Mix" of mien/mix.h.
#include "runtime/mix/mix_file.h"

#include "capi/handles.h"

using namespace mien;
using namespace mien::capi;

static_assert(MIEN_ERROR_MIX_SIGNATURE == int(Status::kMixSignature) &&
                  MIEN_ERROR_MIX_CHECKSUM == int(Status::kMixChecksum),
              "status.h and mien.h number the same statuses");

// Opening -----------------------------------------------------------------------------------------

namespace {

MienStatus read_open(const MienRig* rig, const MienMixOpenDesc* desc, Allocator& allocator,
                     MienError* error) {
  if (rig) {
    if (MienStatus status = check(rig, "rig", error)) return status;
  }
  MienMixOpenDesc known;
  if (MienStatus status = read_desc(desc, known, "MienMixOpenDesc", error)) return status;
  return read_allocator(known.allocator, allocator, error);
}

MienStatus open_bytes(Span<const uint8_t> bytes, const MienRig* rig, const Allocator& allocator,
                      MienMix** out_mix, MienError* error) {
  Mix* made = nullptr;
  Error detail;
  const Status status = open_mix(bytes, object(rig), allocator, made, detail);
  return give_object(status, made, detail, out_mix, error);
}

}  // namespace

MienStatus mien_mix_open_file(const char* path, const MienRig* rig, const MienMixOpenDesc* desc,
                              MienMix** out_mix, MienError* error) {
  if (MienStatus status = clear_output(out_mix, error)) return status;
  if (!path) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "path is NULL");
  Allocator allocator;
  if (MienStatus status = read_open(rig, desc, allocator, error)) return status;
  MappedFile file;
  Error detail;
  if (open_file(path, FileAccess::kRead, {kMixMagic, sizeof(kMixMagic)}, allocator, file, detail) !=
      Status::kOk) {
    return give_error(detail, error);
  }
  const MienStatus status = open_bytes({file.bytes, file.size}, rig, allocator, out_mix, error);
  close_file(file);
  return status;
}

MienStatus mien_mix_open_memory(const void* bytes, size_t size, const MienRig* rig,
                                const MienMixOpenDesc* desc, MienMix** out_mix, MienError* error) {
  if (MienStatus status = clear_output(out_mix, error)) return status;
  if (!bytes && size != 0) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "bytes is NULL");
  Allocator allocator;
  if (MienStatus status = read_open(rig, desc, allocator, error)) return status;
  return open_bytes({static_cast<const uint8_t*>(bytes), size}, rig, allocator, out_mix, error);
}

// Writing -----------------------------------------------------------------------------------------

namespace {

/// Writes to the caller's buffer, if it has room; `write` is write_mix() or write_mix_text().
template <class Char>
MienStatus write_to(Status (*write)(const Mix&, Span<Char>, size_t&, Error&), const MienMix* mix,
                    void* buffer, size_t capacity, size_t* out_size, MienError* error) {
  if (MienStatus status = clear_output(out_size, error)) return status;
  if (!buffer && capacity != 0) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "buffer is NULL");
  }
  if (MienStatus status = check(mix, "mix", error)) return status;
  Error detail;
  if (write(*object(mix), {}, *out_size, detail) != Status::kOk) return give_error(detail, error);
  if (!buffer) return succeed(error);
  if (capacity < *out_size) {
    return give_error(
        error, MIEN_ERROR_INVALID_ARGUMENT,
        "the mix takes %zu bytes, the buffer has %zu: call again with a buffer of this size",
        *out_size, capacity);
  }
  const Status status =
      write(*object(mix), {static_cast<Char*>(buffer), capacity}, *out_size, detail);
  return give_status(status, detail, error);
}

}  // namespace

MienStatus mien_mix_write_memory(const MienMix* mix, void* buffer, size_t capacity,
                                 size_t* out_size, MienError* error) {
  return write_to(write_mix, mix, buffer, capacity, out_size, error);
}

MienStatus mien_mix_write_text(const MienMix* mix, void* buffer, size_t capacity, size_t* out_size,
                               MienError* error) {
  return write_to(write_mix_text, mix, buffer, capacity, out_size, error);
}

MienStatus mien_mix_write_file(const MienMix* mix, const char* path, MienError* error) {
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  if (!path) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "path is NULL");
  if (MienStatus status = check(mix, "mix", error)) return status;
  const Mix& of = *object(mix);
  size_t size = 0;
  Error detail;
  if (write_mix(of, {}, size, detail) != Status::kOk) return give_error(detail, error);
  Arena arena(of.allocator);
  const Span<uint8_t> bytes = arena.array<uint8_t>(size);
  if (bytes.empty()) return give_error(error, MIEN_ERROR_MEMORY, "no memory to write a mix");
  Status status = write_mix(of, bytes, size, detail);
  if (status == Status::kOk) status = write_file(path, bytes.data, size, of.allocator, detail);
  return give_status(status, detail, error);
}
