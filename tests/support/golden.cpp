// SPDX-License-Identifier: MIT
#include "tests/support/golden.h"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace mien::golden {
namespace {

/// Little-endian numbers out of bytes that may end at any place.
struct Reader {
  const std::vector<uint8_t>& bytes;
  size_t at = 0;
  bool good = true;

  bool has(uint64_t count) {
    good = good && count <= bytes.size() - at;
    return good;
  }
  uint32_t number(size_t width) {
    if (!has(width)) return 0;
    uint32_t value = 0;
    for (size_t i = 0; i < width; ++i) value |= uint32_t{bytes[at + i]} << 8 * i;
    at += width;
    return value;
  }
  std::string text(uint64_t count) {
    if (!has(count)) return {};
    at += count;
    const char* end = reinterpret_cast<const char*>(bytes.data()) + at;
    return std::string(end - count, end);
  }
};

bool read_record(Reader& in, File& out) {
  enum { kF32, kU16, kU32, kUtf8 };
  constexpr uint32_t kWidths[] = {4, 2, 4, 1};
  const std::string name = in.text(in.number(2));
  const uint32_t type = in.number(1), rank = in.number(1);
  if (!in.good || type > kUtf8) return false;

  Record record;
  uint64_t count = 1;
  for (uint32_t d = 0; d < rank; ++d) {
    record.dims.push_back(in.number(4));
    count *= record.dims.back();
    if (count > in.bytes.size()) return false;
  }
  if (!in.has(count * kWidths[type])) return false;
  if (type == kUtf8) record.text = in.text(count);
  if (type == kF32) record.floats.resize(count);
  for (float& value : record.floats) {
    const uint32_t bits = in.number(4);
    memcpy(&value, &bits, sizeof(value));
  }
  if (type == kU16 || type == kU32) record.integers.resize(count);
  for (uint32_t& value : record.integers) value = in.number(kWidths[type]);
  return out.records.emplace(name, std::move(record)).second;
}

}  // namespace

namespace {

std::filesystem::path head_folder() { return std::filesystem::path(shared_folder()) / "golden"; }

}  // namespace

std::string shared_folder() {
  const char* shared = std::getenv("MIEN_SHARED");
  if (shared && *shared) return shared;
  // MIEN_GOLDEN_FOLDER is tests/golden of the source tree; the build defines it.
  return std::string(MIEN_GOLDEN_FOLDER) + "/../../../shared";
}

bool has_head() {
  std::error_code error;
  return std::filesystem::is_regular_file(head_folder() / "head.dna", error);
}

std::string no_head() {
  return "NOT TESTED: the golden rig of production size; there is no " +
         (head_folder() / "head.dna").lexically_normal().string();
}

std::vector<std::string> present_names() {
  std::vector<std::string> names(std::begin(kNames), std::end(kNames));
  if (has_head()) names.push_back(kHead);
  return names;
}

std::string folder() { return MIEN_GOLDEN_FOLDER; }

std::string path_of(const std::string& name, const char* suffix) {
  const auto in = name == kHead ? head_folder() : std::filesystem::path(MIEN_GOLDEN_FOLDER);
  return (in / (name + suffix)).string();
}

std::vector<uint8_t> read_rig(const std::string& name) {
  std::vector<uint8_t> bytes = read_bytes(path_of(name));
  EXPECT_FALSE(bytes.empty()) << "no golden rig " << path_of(name);
  return bytes;
}

Span<const float> Record::row(uint32_t i) const {
  const size_t width = dims.empty() || dims[0] == 0 ? 0 : floats.size() / dims[0];
  return {floats.data() + i * width, width};
}

const Record* File::find(const std::string& name) const {
  const auto found = records.find(name);
  return found == records.end() ? nullptr : &found->second;
}

std::string parse(const std::vector<uint8_t>& bytes, File& out) {
  Reader in{bytes};
  out.records.clear();
  if (in.text(8) != "RIGGOLD1") return "not a golden file";
  const uint32_t count = in.number(4);
  for (uint32_t i = 0; i < count; ++i) {
    if (!read_record(in, out)) {
      return "record " + std::to_string(i) + ", before byte " + std::to_string(in.at) +
             ": cut short, of unknown type, or named like another";
    }
  }
  if (!in.good) return "cut short";
  return in.at == bytes.size() ? "" : "bytes after the last record";
}

std::vector<uint8_t> read_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

uint64_t fnv1a64(const std::vector<uint8_t>& bytes) {
  uint64_t hash = 14695981039346656037u;
  for (uint8_t byte : bytes) hash = (hash ^ byte) * 1099511628211u;
  return hash;
}

testing::AssertionResult matches(Span<const float> mine, Span<const float> golden, const Rule& rule,
                                 Worst& worst) {
  if (mine.count != golden.count) {
    return testing::AssertionFailure() << mine.count << " values, expected " << golden.count;
  }
  double largest = 0;
  for (float value : golden) largest = std::fmax(largest, std::fabs(value));
  const double limit = rule.absolute + rule.relative * largest;

  // Which of the two quaternions that mean the same rotation is nearer to mine.
  const auto sign_of = [&](size_t first) {
    double dot = 0;
    for (size_t k = first; k < first + 4; ++k) dot += double{mine[k]} * double{golden[k]};
    return dot < 0 ? -1.0 : 1.0;
  };
  const auto differ = [&](size_t i) {
    double expected = golden[i];
    if (rule.rotations == Rotations::kQuaternions && i % 10 >= 3 && i % 10 < 7) {
      expected *= sign_of(i / 10 * 10 + 3);
    }
    double error = std::fabs(double{mine[i]} - expected);
    const bool angle = i % 9 >= 3 && i % 9 < 6;
    if (angle && rule.rotations == Rotations::kDegrees) error = std::remainder(error, 360);
    if (angle && rule.rotations == Rotations::kRadians) {
      error = std::remainder(error, 6.283185307179586476925);
    }
    return std::isnan(error) ? HUGE_VAL : std::fabs(error);
  };
  size_t wrong = 0, first = 0, worst_at = 0;
  double row_worst = -1;
  for (size_t i = 0; i < mine.count; ++i) {
    ++worst.compared;
    const double error = differ(i);
    if (error > row_worst) {
      row_worst = error;
      worst_at = i;
    }
    if (!(error <= limit) && wrong++ == 0) first = i;
  }
  worst.error = std::fmax(worst.error, row_worst);
  if (wrong == 0) return testing::AssertionSuccess();

  testing::AssertionResult failure = testing::AssertionFailure();
  failure << wrong << " of " << mine.count << " values differ by more than " << limit;
  const auto tell = [&](const char* which, size_t i) {
    failure << "; " << which << " [" << i << "]: " << testing::PrintToString(mine[i])
            << ", expected " << testing::PrintToString(golden[i]) << ", off by " << differ(i);
  };
  tell("first", first);
  tell("worst", worst_at);
  return failure;
}

}  // namespace mien::golden
