// SPDX-License-Identifier: MIT
// mien/baked.h.
#include "capi/handles.h"
#include "runtime/baked/baked_objects.h"

using namespace mien;
using namespace mien::capi;

static_assert(MIEN_ERROR_BAKED_SIGNATURE == int(Status::kBakedSignature) &&
                  MIEN_ERROR_BAKED_PART == int(Status::kBakedPart),
              "status.h and mien.h number the same statuses");
static_assert(MIEN_BAKED_CHECK_FULL == int(BakedCheck::kFull),
              "baked_file.h and mien.h number the same checks");

// Baking ------------------------------------------------------------------------------------------

namespace {

MienStatus check_objects(const MienRig* rig, const MienDeformer* deformer, MienError* error) {
  if (MienStatus status = check(rig, "rig", error)) return status;
  if (!deformer) return MIEN_OK;
  if (MienStatus status = check(deformer, "deformer", error)) return status;
  if (object(deformer)->rig == object(rig)) return MIEN_OK;
  return give_error(error, MIEN_ERROR_MISMATCH,
                    "the deformer was created for another rig: bake it with its own");
}

}  // namespace

MienStatus mien_bake_file(const MienRig* rig, const MienDeformer* deformer, const char* path,
                          MienError* error) {
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  if (!path) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "path is NULL");
  if (MienStatus status = check_objects(rig, deformer, error)) return status;
  const Allocator& allocator = object(rig)->allocator;
  const size_t size = baked_size(*object(rig), deformer ? object(deformer) : nullptr);
  uint8_t* bytes = static_cast<uint8_t*>(allocator.get(size, kBlockAlignment));
  if (!bytes) {
    return give_error(error, MIEN_ERROR_MEMORY, "no memory for a file of %zu bytes", size);
  }
  bake(*object(rig), deformer ? object(deformer) : nullptr, bytes);
  Error detail;
  const Status status = write_file(path, bytes, size, allocator, detail);
  allocator.put(bytes, size, kBlockAlignment);
  return give_status(status, detail, error);
}

MienStatus mien_bake_memory(const MienRig* rig, const MienDeformer* deformer, void* buffer,
                            size_t capacity, size_t* out_size, MienError* error) {
  if (MienStatus status = clear_output(out_size, error)) return status;
  if (!buffer && capacity != 0) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "buffer is NULL");
  }
  if (MienStatus status = check_objects(rig, deformer, error)) return status;
  const size_t size = baked_size(*object(rig), deformer ? object(deformer) : nullptr);
  *out_size = size;
  if (!buffer) return succeed(error);
  if (capacity < size) {
    return give_error(
        error, MIEN_ERROR_INVALID_ARGUMENT,
        "the file has %zu bytes, the buffer %zu: call again with a buffer of this size", size,
        capacity);
  }
  bake(*object(rig), deformer ? object(deformer) : nullptr, static_cast<uint8_t*>(buffer));
  return succeed(error);
}

// Opening -----------------------------------------------------------------------------------------

namespace {

MienStatus read_baked_desc(const MienBakedDesc* desc, MienBakedDesc& known, Allocator& allocator,
                           MienError* error) {
  if (MienStatus status = read_desc(desc, known, "MienBakedDesc", error)) return status;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  return check_fields({{"MienBakedDesc.file_access", known.file_access, MIEN_FILE_READ},
                       {"MienBakedDesc.check", known.check, MIEN_BAKED_CHECK_FULL}},
                      error);
}

BakedCheck check_of(const MienBakedDesc& desc) { return static_cast<BakedCheck>(desc.check); }

}  // namespace

MienStatus mien_baked_open_file(const char* path, const MienBakedDesc* desc, MienBaked** out_baked,
                                MienError* error) {
  if (MienStatus status = clear_output(out_baked, error)) return status;
  if (!path) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "path is NULL");
  MienBakedDesc known;
  Allocator allocator;
  if (MienStatus status = read_baked_desc(desc, known, allocator, error)) return status;
  Baked* baked = nullptr;
  Error detail;
  const Status status = open_baked_file(path, static_cast<FileAccess>(known.file_access),
                                        check_of(known), allocator, baked, detail);
  return give_object(status, baked, detail, out_baked, error);
}

MienStatus mien_baked_open_memory(const void* bytes, size_t size, const MienBakedDesc* desc,
                                  MienBaked** out_baked, MienError* error) {
  if (MienStatus status = clear_output(out_baked, error)) return status;
  if (!bytes && size != 0) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "bytes is NULL");
  MienBakedDesc known;
  Allocator allocator;
  if (MienStatus status = read_baked_desc(desc, known, allocator, error)) return status;
  Baked* baked = nullptr;
  Error detail;
  const Status status = open_baked_memory({static_cast<const uint8_t*>(bytes), size},
                                          static_cast<FileAccess>(known.file_access),
                                          check_of(known), allocator, baked, detail);
  return give_object(status, baked, detail, out_baked, error);
}

MienStatus mien_baked_open_stream(const MienStream* stream, const MienBakedDesc* desc,
                                  MienBaked** out_baked, MienError* error) {
  if (MienStatus status = clear_output(out_baked, error)) return status;
  if (!stream || !stream->read) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "stream or stream->read is NULL");
  }
  MienBakedDesc known;
  Allocator allocator;
  if (MienStatus status = read_baked_desc(desc, known, allocator, error)) return status;
  Baked* baked = nullptr;
  Error detail;
  const Status status = open_baked_stream({stream->user, stream->size, stream->read},
                                          check_of(known), allocator, baked, detail);
  return give_object(status, baked, detail, out_baked, error);
}

void mien_baked_close(MienBaked* baked) { destroy(baked); }

MienStatus mien_baked_info(const MienBaked* baked, MienBakedInfo* out_info) {
  if (MienStatus status = clear_struct(out_info)) return status;
  if (MienStatus status = check(baked)) return status;
  const Baked& of = *object(baked);
  MienBakedInfo info = {};
  info.file_bytes = of.size;
  info.memory_bytes = of.block_size + of.file.capacity;
  info.rig_bytes = of.rig ? of.rig->size : 0;
  info.deformer_bytes = of.deformer ? of.deformer->size : 0;
  info.part_count = header_of(of.data)->part_count;
  info.is_mapped = of.file.mapped;
  write_struct(out_info, info);
  return MIEN_OK;
}

// Objects -----------------------------------------------------------------------------------------

namespace {

MienStatus no_part(const char* what, MienError* error) {
  return give_error(error, MIEN_ERROR_BAKED_PART,
                    "the baked file has no %s: bake it again with one", what);
}

}  // namespace

MienStatus mien_rig_from_baked(const MienBaked* baked, const MienBakedRigDesc* desc,
                               MienRig** out_rig, MienError* error) {
  if (MienStatus status = clear_output(out_rig, error)) return status;
  if (MienStatus status = check(baked, "baked", error)) return status;
  MienBakedRigDesc known;
  if (MienStatus status = read_desc(desc, known, "MienBakedRigDesc", error)) return status;
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  const MienStatus in_range =
      check_fields({{"MienBakedRigDesc.reuse", known.reuse, MIEN_REUSE_SUMS}}, error);
  if (in_range != MIEN_OK) return in_range;
  const KernelTable* kernels = nullptr;
  if (MienStatus status = find_kernels(known.isa, kernels, error)) return status;
  if (!object(baked)->rig) return no_part("rig", error);
  Rig* rig = nullptr;
  Error detail;
  Status status = open_baked_rig(*object(baked), kernels, allocator, rig, detail);
  if (status == Status::kOk) status = set_reuse(known.reuse, rig, detail);
  return give_object(status, rig, detail, out_rig, error);
}

MienStatus mien_deformer_from_baked(const MienBaked* baked, const MienRig* rig,
                                    const MienBakedDeformerDesc* desc, MienDeformer** out_deformer,
                                    MienError* error) {
  if (MienStatus status = clear_output(out_deformer, error)) return status;
  if (MienStatus status = check(baked, "baked", error)) return status;
  if (MienStatus status = check(rig, "rig", error)) return status;
  MienBakedDeformerDesc known;
  if (MienStatus status = read_desc(desc, known, "MienBakedDeformerDesc", error)) return status;
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  const MienStatus in_range = check_fields(
      {{"MienBakedDeformerDesc.normals", known.normals, MIEN_NORMALS_RECOMPUTED}}, error);
  if (in_range != MIEN_OK) return in_range;
  const KernelTable* kernels = object(rig)->kernels;
  if (known.isa != MIEN_ISA_BEST) {
    if (MienStatus status = find_kernels(known.isa, kernels, error)) return status;
  }
  if (object(rig)->bytes != object(baked)) {
    return give_error(
        error, MIEN_ERROR_MISMATCH,
        "the rig was not created from this baked file: use that of mien_rig_from_baked()");
  }
  if (!object(baked)->deformer) return no_part("deformer", error);
  Deformer* deformer = nullptr;
  Error detail;
  const Status status =
      open_baked_deformer(*object(baked), *object(rig), kernels, allocator, deformer, detail);
  if (status == Status::kOk && known.normals != MIEN_NORMALS_DEFAULT) {
    deformer->normals = static_cast<Normals>(known.normals);
  }
  return give_object(status, deformer, detail, out_deformer, error);
}
