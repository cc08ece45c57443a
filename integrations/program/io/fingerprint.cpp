// SPDX-License-Identifier: MIT
#include "integrations/program/io/fingerprint.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <vector>

#include "integrations/program/io/failure.h"

namespace mien::cli {

namespace fs = std::filesystem;

namespace {

constexpr size_t kLaneBlock = 32;
constexpr size_t kReadBytes = size_t{1} << 18;
constexpr uint64_t kOdd = 0x9e3779b97f4a7c15;

uint64_t stirred(uint64_t bits) {
  bits = (bits ^ bits >> 32) * kOdd;
  bits = (bits ^ bits >> 29) * kOdd;
  return bits ^ bits >> 32;
}

void add_file(const std::string& path, Fingerprint& fingerprint) {
  const std::unique_ptr<FILE, int (*)(FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  std::vector<char> piece(kReadBytes);
  size_t got = 0;
  while (file && (got = std::fread(piece.data(), 1, piece.size(), file.get())) != 0) {
    fingerprint.add(piece.data(), got);
  }
  if (file && !std::ferror(file.get())) return;
  fail(kFile, "cannot read", path, std::strerror(errno), "check the path and its permissions");
}

}  // namespace

void Fingerprint::mix(const unsigned char* bytes, size_t block_count) {
  uint64_t lanes[4];  // of their own, so that they stay in registers
  std::copy(lanes_, lanes_ + 4, lanes);
  for (const unsigned char* end = bytes + block_count * kLaneBlock; bytes != end;) {
    for (uint64_t& lane : lanes) {
      uint64_t word = 0;
      for (size_t k = 0; k < 8; ++k) word |= uint64_t{bytes[k]} << (8 * k);
      const uint64_t bits = (lane ^ word) * kOdd;
      lane = bits ^ bits >> 31;
      bytes += 8;
    }
  }
  std::copy(lanes, lanes + 4, lanes_);
}

void Fingerprint::add(const void* bytes, size_t size) {
  const auto* at = static_cast<const unsigned char*>(bytes);
  while (size != 0) {
    const size_t filled = size_ % kLaneBlock;
    size_t part = std::min(size, kLaneBlock - filled);
    if (part == kLaneBlock) {
      part = size - size % kLaneBlock;
      mix(at, part / kLaneBlock);
    } else {
      std::memcpy(rest_ + filled, at, part);
      if (filled + part == kLaneBlock) mix(rest_, 1);
    }
    at += part, size -= part, size_ += part;
  }
}

std::string Fingerprint::text() const {
  Fingerprint end = *this;
  std::memset(end.rest_ + size_ % kLaneBlock, 0, kLaneBlock - size_ % kLaneBlock);
  end.mix(end.rest_, 1);
  uint64_t bits = size_;
  for (const uint64_t lane : end.lanes_) bits = stirred(bits ^ lane);
  char digits[17];
  std::snprintf(digits, sizeof(digits), "%016llx", static_cast<unsigned long long>(bits));
  return digits;
}

std::string file_fingerprint(const std::string& path) {
  Fingerprint fingerprint;
  std::error_code reason;
  if (!fs::is_directory(path, reason)) {
    add_file(path, fingerprint);
    return fingerprint.text();
  }
  std::vector<std::string> files;
  for (fs::directory_iterator it(path, reason), end; !reason && it != end; it.increment(reason)) {
    if (it->is_regular_file(reason)) files.push_back(it->path().string());
  }
  if (reason) {
    fail(kFile, "cannot read", path, reason.message(), "check the path and its permissions");
  }
  std::sort(files.begin(), files.end());
  for (const std::string& file : files) {
    fingerprint.add(fs::path(file).filename().string() + '\n');
    add_file(file, fingerprint);
  }
  return fingerprint.text();
}

}  // namespace mien::cli
