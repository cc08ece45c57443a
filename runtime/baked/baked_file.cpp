// SPDX-License-Identifier: MIT
#include "runtime/baked/baked_file.h"

#include <cstddef>

namespace mien {
namespace {

Status damaged_baked_file(Error& error, uint64_t at, const char* what) {
  return fail(error, Status::kBakedStructure, at, "%s: the baked file is damaged; bake it again",
              what);
}

Status check_header(const SharedBytes& file, Error& error) {
  const size_t common = file.size < sizeof(kBakedMagic) ? file.size : sizeof(kBakedMagic);
  if (common == 0 || memcmp(file.data, kBakedMagic, common) != 0) {
    return fail(error, Status::kBakedSignature, 0,
                "not a baked file: it does not begin with MIENBAKE; give a file that mien bake "
                "wrote");
  }
  if (file.size < sizeof(BakedHeader)) {
    return fail(error, Status::kBakedTruncated, file.size,
                "the file ends within its header: it is truncated; fetch or bake it again");
  }
  BakedHeader header;
  memcpy(&header, file.data, sizeof(header));
  if (header.byte_order != kBakedByteOrder) {
    return fail(error, Status::kBakedVersion, offsetof(BakedHeader, byte_order),
                "the file was baked on a machine of another byte order; bake it for this one");
  }
  if (header.version != kBakedVersion) {
    return fail(error, Status::kBakedVersion, offsetof(BakedHeader, version),
                "the file is of version %u, this library reads %u; bake it again", header.version,
                kBakedVersion);
  }
  if (header.file_size > file.size) {
    return fail(error, Status::kBakedTruncated, file.size,
                "the file ends after %zu of %llu bytes; fetch or bake it again", file.size,
                static_cast<unsigned long long>(header.file_size));
  }
  if (header.file_size < file.size) {
    return damaged_baked_file(error, header.file_size, "bytes after the end");
  }
  for (uint8_t zero : header.zeros) {
    if (zero) return damaged_baked_file(error, offsetof(BakedHeader, zeros), "header");
  }
  if (header.part_count > (file.size - sizeof(header)) / sizeof(BakedPart)) {
    return damaged_baked_file(error, offsetof(BakedHeader, part_count), "header");
  }
  return Status::kOk;
}

}  // namespace

// Eight independent sums. Each step is invertible, so a change of one word always changes the result.
uint64_t baked_checksum(const uint8_t* bytes, size_t size) {
  constexpr size_t kLanes = 8, kStep = kLanes * sizeof(uint64_t);
  constexpr uint64_t kOdd = 0x9E37'79B9'7F4A'7C15;
  uint64_t sums[kLanes];
  for (size_t i = 0; i < kLanes; ++i) sums[i] = kOdd * (i + 1);
  size_t at = offsetof(BakedHeader, part_count);
  for (; at + kStep <= size; at += kStep) {
    uint64_t words[kLanes];
    memcpy(words, bytes + at, kStep);
    for (size_t i = 0; i < kLanes; ++i) {
      sums[i] = (sums[i] ^ words[i]) * kOdd;
      sums[i] ^= sums[i] >> 32;
    }
  }
  uint64_t sum = size;
  for (; at < size; ++at) sum = (sum ^ bytes[at]) * kOdd;
  for (uint64_t lane : sums) {
    sum = (sum ^ lane) * kOdd;
    sum ^= sum >> 29;
  }
  return sum;
}

namespace {

constexpr char kBakedFile[] = "a baked file";

Status read_baked(Baked& baked, Error& error) {
  const uint8_t* bytes = baked.data;
  const size_t size = baked.size;
  const Status status = check_header(baked, error);
  if (status != Status::kOk) return status;
  const BakedHeader* header = header_of(bytes);
  if (baked.check == BakedCheck::kFull && baked_checksum(bytes, size) != header->checksum) {
    return fail(error, Status::kBakedChecksum, offsetof(BakedHeader, checksum),
                "the bytes are not those that were written: the file is damaged; fetch or bake it "
                "again");
  }

  // Parts follow each other, so no two share bytes.
  const auto* parts = static_cast<const BakedPart*>(static_cast<const void*>(header + 1));
  uint64_t at = sizeof(BakedHeader) + uint64_t{header->part_count} * sizeof(BakedPart);
  for (uint32_t i = 0; i < header->part_count; ++i) {
    const BakedPart& part = parts[i];
    const auto entry = static_cast<uint64_t>(reinterpret_cast<const uint8_t*>(&part) - bytes);
    bool good = part.offset == at && part.size % kBlockAlignment == 0 && part.size <= size - at;
    for (uint8_t zero : part.zeros) good &= zero == 0;
    const BakedPart** known = part.kind == uint32_t(PartKind::kRig)        ? &baked.rig
                              : part.kind == uint32_t(PartKind::kDeformer) ? &baked.deformer
                                                                           : nullptr;
    if (!good || (known && *known)) return damaged_baked_file(error, entry, "table of parts");
    if (known) *known = &part;
    at += part.size;
  }
  if (at != size) return damaged_baked_file(error, at, "end of the file");
  return Status::kOk;
}

/// Checks the bytes of a file that was created; `created` tells whether it was. Drops it on failure.
Status finish(Status created, BakedCheck check, Baked*& baked, Error& error) {
  if (created != Status::kOk) return created;
  baked->check = check;
  const Status status = read_baked(*baked, error);
  if (status == Status::kOk) return status;
  release(baked);
  baked = nullptr;
  return status;
}

}  // namespace

Status open_baked_file(const char* path, FileAccess access, BakedCheck check,
                       const Allocator& allocator, Baked*& out, Error& error) {
  return finish(create_from_file(path, access, {kBakedMagic, sizeof(kBakedMagic)}, kBakedFile,
                                 allocator, out, error),
                check, out, error);
}

Status open_baked_memory(Span<const uint8_t> bytes, FileAccess access, BakedCheck check,
                         const Allocator& allocator, Baked*& out, Error& error) {
  const bool aligned = reinterpret_cast<uintptr_t>(bytes.data) % kBlockAlignment == 0;
  const size_t copied = aligned && access == FileAccess::kMap ? 0 : bytes.count;
  const Status created = create_with_bytes(copied, kBakedFile, allocator, out, error);
  if (created == Status::kOk && copied != 0) {
    memcpy(const_cast<uint8_t*>(out->data), bytes.data, copied);
  } else if (created == Status::kOk) {
    out->data = bytes.data;
    out->size = bytes.count;
  }
  return finish(created, check, out, error);
}

Status open_baked_stream(const Stream& stream, BakedCheck check, const Allocator& allocator,
                         Baked*& out, Error& error) {
  return finish(create_from_stream(stream, kBakedFile, allocator, out, error), check, out, error);
}

}  // namespace mien
