// SPDX-License-Identifier: MIT
// Golden rigs: rigs with inputs and expected outputs. tests/golden/README.md describes the files.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "runtime/base/span.h"

namespace mien::golden {

/// The golden rigs of the repository, tests/golden/. A test that misses one of them fails.
constexpr const char* kNames[] = {"tiny",     "tiny_v21", "tiny_v22", "tiny_v23", "tiny_v24",
                                  "tiny_v25", "tiny_v26", "tiny_v27", "small",    "small_rot",
                                  "body",     "ml",       "ml_ext"};

/// Data that is not in the repository: the folder that the environment variable MIEN_SHARED names, by
/// default ../shared beside the source tree. It need not be there.
std::string shared_folder();

/// One more of production size, too large for the repository: golden/head.dna in shared_folder().
constexpr const char* kHead = "head";
bool has_head();

/// What a test that needs the head says without it: GTEST_SKIP() << no_head().
std::string no_head();

/// The names above; the head only if it is there.
std::vector<std::string> present_names();

/// tests/golden
std::string folder();

/// Path of the file NAME.dna or NAME.golden.bin.
std::string path_of(const std::string& name, const char* suffix = ".dna");

/// Bytes of NAME.dna. Fails the test if there are none.
std::vector<uint8_t> read_rig(const std::string& name);

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

/// The rule of the README, "Comparison": |mine - golden| <= absolute + relative * max(|golden|).
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
