// SPDX-License-Identifier: MIT
// Files of inputs and expected outputs, computed by OpenRigLogic 13.2.5 in scalar float. They lie
// in golden/ of the shared folder beside the project; golden/README.md there is their manual.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "runtime/base/span.h"

namespace mien::golden {

/// The shared folder: the environment variable MIEN_SHARED, else ../shared beside the source tree.
/// Empty if it has no golden files.
std::string shared_folder();

/// What a test says when it cannot run. Used as GTEST_SKIP() << no_golden_files("...").
std::string no_golden_files(const char* what_is_not_tested);

/// One array, row-major.
struct Record {
  std::vector<uint32_t> dims;
  std::vector<float> floats;       // of an f32 record
  std::vector<uint32_t> integers;  // of an u16 or u32 record
  std::string text;                // of an UTF-8 record

  /// Row `i` of the first dimension of an f32 record.
  Span<const float> row(uint32_t i) const;
};

struct File {
  std::map<std::string, Record> records;

  /// Null if there is none.
  const Record* find(const std::string& name) const;
};

/// Empty, or what is wrong with the bytes.
std::string parse(const std::vector<uint8_t>& bytes, File& out);

/// Empty if the file cannot be read.
std::vector<uint8_t> read_bytes(const std::string& path);

uint64_t fnv1a64(const std::vector<uint8_t>& bytes);

/// What the values of a joint array mean.
enum class Rotations {
  kNone,     // compared as they are
  kDegrees,  // 9 per joint; 3, 4, 5 are angles, compared modulo a full turn
  kRadians,
  kQuaternions,  // 10 per joint; 3 to 6 are a quaternion, compared up to its sign
};

/// The rule of the README: |mine - golden| <= absolute + relative * max(|golden|).
struct Rule {
  double absolute = 0;
  double relative = 0;
  Rotations rotations = Rotations::kNone;
};

struct Worst {
  size_t compared = 0;
  double error = 0;  // absolute
};

/// Compares one row and adds to `worst`. A failure tells the first and the worst difference.
testing::AssertionResult matches(Span<const float> mine, Span<const float> golden, const Rule& rule,
                                 Worst& worst);

}  // namespace mien::golden
