// SPDX-License-Identifier: MIT
// Every finding about a DNA file, kept in the order in which it was found.
#pragma once

#include "runtime/base/object.h"
#include "runtime/load/dna/dna_reader.h"

namespace mien {

struct StoredFinding {
  Status status;  // kOk: a warning
  uint64_t byte_offset;
  dna::String field, message;
};

struct Report : Object {
  static constexpr uint32_t kTag = 0x6D52'5054;
  static constexpr uint32_t kMaxFindings = 1000;

  uint32_t count = 0;
  uint32_t errors = 0;
  bool out_of_memory = false;
  Arena arena;
  Span<StoredFinding> findings;  // room for kMaxFindings

  explicit Report(const Allocator& of) : arena(of) {}
};

/// Examines a file and tries to compile it. kMemory. On success, give back `out` with release().
Status validate_dna(Span<const uint8_t> bytes, const Allocator& allocator, Report*& out,
                    Error& error);

/// The same for a file, which is read into memory: it cannot change during the checks. Errors of open_file().
Status validate_dna_file(const char* path, const Allocator& allocator, Report*& out, Error& error);

}  // namespace mien
