// SPDX-License-Identifier: MIT
// Baked rigs. mien.h is the manual.
#include "capi/handles.h"
#include "runtime/baked/baked_objects.h"

using namespace mien;
using namespace mien::capi;

static_assert(MIEN_ERROR_BAKED_SIGNATURE == int(Status::kBakedSignature) &&
                  MIEN_ERROR_BAKED_CHECKSUM == int(Status::kBakedChecksum),
              "status.h and mien.h number the same statuses");
static_assert(MIEN_BAKED_CHECK_FULL == int(BakedCheck::kFull),
              "baked_file.h and mien.h number the same checks");

// Saving ------------------------------------------------------------------------------------------

MienStatus mien_rig_save_file(const MienRig* handle, const char* path, MienError* error) {
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  if (!path) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "path is NULL");
  if (MienStatus status = check(handle)) return give_error(error, status, "not a rig");
  const Rig& rig = *object(handle);
  const size_t size = baked_size(rig, nullptr);
  uint8_t* bytes = static_cast<uint8_t*>(rig.allocator.get(size, kBlockAlignment));
  if (!bytes) {
    return give_error(error, MIEN_ERROR_MEMORY, "no memory for an image of %zu bytes", size);
  }
  bake(rig, nullptr, bytes);
  Error detail;
  const Status status = write_file(path, bytes, size, rig.allocator, detail);
  rig.allocator.put(bytes, size, kBlockAlignment);
  return status == Status::kOk ? succeed(error) : give_error(detail, error);
}

MienStatus mien_rig_save_memory(const MienRig* handle, void* buffer, size_t capacity,
                                size_t* out_size, MienError* error) {
  if (MienStatus status = clear_output(out_size, error)) return status;
  if (!buffer && capacity != 0) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "buffer is NULL");
  }
  if (MienStatus status = check(handle)) return give_error(error, status, "not a rig");
  const Rig& rig = *object(handle);
  const size_t size = baked_size(rig, nullptr);
  *out_size = size;
  if (!buffer) return succeed(error);
  if (capacity < size) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "the image takes %zu bytes, the buffer has %zu", size, capacity);
  }
  bake(rig, nullptr, static_cast<uint8_t*>(buffer));
  return succeed(error);
}

// Opening -----------------------------------------------------------------------------------------

namespace {

struct OpenArguments {
  MienBakedDesc desc;
  Allocator allocator;
  const KernelTable* kernels = nullptr;
};

/// Takes over `file`, which is empty if the bytes belong to the caller.
MienStatus open_baked(const void* bytes, size_t size, MappedFile& file,
                      const OpenArguments& arguments, MienRig** out_rig, MienError* error) {
  const size_t block_size = align_up(sizeof(Baked), kBlockAlignment);
  void* block = arguments.allocator.get(block_size, kBlockAlignment);
  if (!block) {
    if (file.bytes) close_file(file);
    return give_error(error, MIEN_ERROR_MEMORY, "no memory for a baked file");
  }
  Baked* baked = new (block) Baked;
  baked->bytes.allocator = arguments.allocator;
  baked->bytes.block_size = block_size;
  baked->bytes.file = file;
  baked->bytes.data = static_cast<const uint8_t*>(bytes);
  baked->bytes.size = size;
  baked->check = static_cast<BakedCheck>(arguments.desc.check);
  Error detail;
  Rig* rig = nullptr;
  Status status = read_baked(*baked, detail);
  if (status == Status::kOk && !baked->rig) {
    status = fail(detail, Status::kBakedStructure, kNoOffset, "the baked file has no rig");
  }
  if (status == Status::kOk) {
    status = open_baked_rig(*baked, arguments.kernels, arguments.allocator, rig, detail);
  }
  release_bytes(&baked->bytes);
  if (status != Status::kOk) return give_error(detail, error);
  rig->always_evaluate = arguments.desc.reuse == MIEN_REUSE_NOTHING;
  rig->instance_size = instance_size(*rig);
  rig->tag = kRigTag;
  *out_rig = reinterpret_cast<MienRig*>(rig);
  return succeed(error);
}

MienStatus read_open_arguments(const MienBakedDesc* desc, OpenArguments& out, MienError* error) {
  if (MienStatus status = read_desc(desc, out.desc, "MienBakedDesc", error)) return status;
  if (MienStatus status = read_allocator(out.desc.allocator, out.allocator, error)) return status;
  if (out.desc.file_access > MIEN_FILE_READ || out.desc.check > MIEN_BAKED_CHECK_FULL ||
      out.desc.reuse > MIEN_REUSE_NOTHING) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MienBakedDesc.file_access, .check or .reuse is none of its values");
  }
  return find_kernels(out.desc.isa, out.kernels, error);
}

/// Memory whose beginning is no place for vectors.
MienStatus copy_image(const void* bytes, size_t size, const Allocator& allocator, MappedFile& file,
                      MienError* error) {
  uint8_t* copy = static_cast<uint8_t*>(allocator.get(size, kBlockAlignment));
  if (!copy) {
    return give_error(error, MIEN_ERROR_MEMORY, "no memory for an image of %zu bytes", size);
  }
  memcpy(copy, bytes, size);
  file.bytes = copy;
  file.size = file.capacity = size;
  file.allocator = allocator;
  return MIEN_OK;
}

}  // namespace

MienStatus mien_rig_open_file(const char* path, const MienBakedDesc* desc, MienRig** out_rig,
                              MienError* error) {
  if (MienStatus status = clear_output(out_rig, error)) return status;
  if (!path) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "path is NULL");
  OpenArguments arguments;
  if (MienStatus status = read_open_arguments(desc, arguments, error)) return status;
  MappedFile file;
  Error detail;
  const Status status = open_file(path, static_cast<FileAccess>(arguments.desc.file_access),
                                  arguments.allocator, file, detail);
  if (status != Status::kOk) return give_error(detail, error);
  return open_baked(file.bytes, file.size, file, arguments, out_rig, error);
}

MienStatus mien_rig_open_memory(const void* bytes, size_t size, const MienBakedDesc* desc,
                                MienRig** out_rig, MienError* error) {
  if (MienStatus status = clear_output(out_rig, error)) return status;
  if (!bytes && size != 0) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "bytes is NULL");
  OpenArguments arguments;
  if (MienStatus status = read_open_arguments(desc, arguments, error)) return status;
  MappedFile file;
  if (size != 0 && reinterpret_cast<uintptr_t>(bytes) % kBlockAlignment != 0) {
    if (MienStatus status = copy_image(bytes, size, arguments.allocator, file, error)) {
      return status;
    }
    bytes = file.bytes;
  }
  return open_baked(bytes, size, file, arguments, out_rig, error);
}
