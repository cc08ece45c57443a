// SPDX-License-Identifier: MIT
#include "integrations/program/io/dna_streams.h"

#include <mien.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/handles.h"
#include "integrations/program/io/input.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

constexpr char kCannotSearch[] = "cannot search for DNA streams";
constexpr char kSignature[] = {'D', 'N', 'A', 0, 2, 0};  // and a byte: the version
constexpr size_t kBlock = size_t{1} << 20;
constexpr size_t kHeader = 7, kIndex = 11, kIndexEntry = 16, kSections = 8;
constexpr uint32_t kMaxIndexEntries = 4096, kMaxMeshes = 65535, kMaxVersion = 15;
// A compressed buffer: magic, CRC-32, method. docs/tutorials/metahuman.md says what is not searched.
constexpr char kCompressed[] = {'\xb7', 'u', 'c', 'b'};
constexpr char kOodle = 3, kLz4 = 4;

uint32_t number(const char* bytes) {
  uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

/// A number `offset` bytes behind the start of a stream; false past the end of the file.
bool read_u32(FileBytes& file, const DnaStream& stream, uint64_t offset, uint32_t& out) {
  const std::string bytes = file.read(stream.offset + offset, 4);
  if (bytes.size() < 4) return false;
  out = number(bytes.data());
  return true;
}

enum class Kind { kNone, kWhole, kTruncated };

/// Version 2.1: a table of sections; the last one is the geometry, whose meshes tell where each ends.
Kind measure_sections(FileBytes& file, DnaStream& stream) {
  uint32_t last = kHeader + 4 * kSections, offset = 0;
  for (size_t i = 0; i < kSections; ++i) {
    if (!read_u32(file, stream, kHeader + 4 * i, offset)) return Kind::kNone;
    if (offset < last) return Kind::kNone;
    last = offset;
  }
  uint32_t meshes = 0;
  if (!read_u32(file, stream, last, meshes)) return Kind::kTruncated;
  if (meshes > kMaxMeshes) return Kind::kNone;
  uint64_t end = uint64_t{last} + 4;
  for (uint32_t i = 0; i < meshes; ++i) {
    if (!read_u32(file, stream, end, offset)) return Kind::kTruncated;
    if (offset < end + 4) return Kind::kNone;
    end = offset;
  }
  stream.size = end + 3;  // "AND"
  return stream.offset + stream.size <= file.size() ? Kind::kWhole : Kind::kTruncated;
}

/// Later versions: an index of layers with their offsets and sizes.
Kind measure_index(FileBytes& file, DnaStream& stream) {
  uint32_t count = 0;
  if (!read_u32(file, stream, kHeader, count)) return Kind::kNone;
  if (count == 0 || count > kMaxIndexEntries) return Kind::kNone;
  const uint64_t first = kIndex + kIndexEntry * uint64_t{count};
  const std::string index = file.read(stream.offset + kIndex, first - kIndex);
  if (index.size() < kIndexEntry) return Kind::kNone;
  uint64_t end = first;
  for (size_t at = 0; at + kIndexEntry <= index.size(); at += kIndexEntry) {
    const char* entry = index.data() + at;
    const bool letters =
        std::all_of(entry, entry + 4, [](char c) { return c > ' ' && c < '\x7f'; });
    const uint64_t offset = number(entry + 8);
    if (!letters || offset < first) return Kind::kNone;
    end = std::max(end, offset + number(entry + 12));
  }
  stream.size = end;
  const bool whole = index.size() == first - kIndex && stream.offset + end <= file.size();
  return whole ? Kind::kWhole : Kind::kTruncated;
}

/// What the ordinary reader says of it.
void open_stream(FileBytes& file, DnaStream& stream) {
  const std::string bytes = file.read(stream.offset, stream.size);
  MienDna* opened = nullptr;
  auto error = sized<MienError>();
  const MienStatus status =
      mien_dna_open_memory(bytes.data(), bytes.size(), nullptr, &opened, &error);
  if (status == MIEN_ERROR_MEMORY) throw std::bad_alloc();
  if (status != MIEN_OK) {
    stream.problem = error.message;
    return;
  }
  const Dna dna(opened);
  MienStringView name{};
  if (mien_dna_read_string(dna.get(), "desc.name", &name, nullptr) == MIEN_OK) {
    stream.name = to_string(name);
  }
}

}  // namespace

FileBytes::FileBytes(const std::string& path) : shown_(shown_name(path)) {
  if (is_stream(path)) {
    bytes_ = read_any_bytes(path, kCannotSearch);
    size_ = bytes_.size();
    return;
  }
  file_.open(path, std::ios::binary);
  if (file_) file_.seekg(0, std::ios::end);
  if (!file_) {
    fail(kFile, kCannotSearch, shown_, std::strerror(errno), "check the path and its permissions");
  }
  size_ = static_cast<uint64_t>(file_.tellg());
}

FileBytes::FileBytes(std::string shown, std::string bytes)
    : shown_(std::move(shown)), bytes_(std::move(bytes)), size_(bytes_.size()) {}

std::string FileBytes::read(uint64_t offset, uint64_t count) {
  offset = std::min(offset, size_);
  count = std::min(count, size_ - offset);
  if (!file_.is_open()) return bytes_.substr(offset, count);
  std::string bytes(count, '\0');
  file_.seekg(static_cast<std::streamoff>(offset));
  file_.read(bytes.data(), static_cast<std::streamsize>(count));
  if (!file_) fail(kFile, kCannotSearch, shown_, "the file cannot be read", "check the disk");
  return bytes;
}

FoundStreams find_dna_streams(FileBytes& file) {
  FoundStreams found;
  found.bytes = file.size();
  uint64_t resume = 0;  // what is before has been searched or belongs to a stream
  // Blocks overlap, so that no signature is cut.
  constexpr size_t kOverlap = 16;
  for (uint64_t base = 0; base < file.size(); base += kBlock - kOverlap) {
    if (base + kBlock <= resume) continue;
    const std::string block = file.read(base, kBlock);
    const bool is_last = base + block.size() >= file.size();
    const size_t limit = is_last ? block.size() : block.size() - kOverlap;
    for (size_t at = 0; at < limit; ++at) {
      if (base + at < resume || block.size() - at < kHeader) continue;
      const char* bytes = block.data() + at;
      if (bytes[0] == kCompressed[0] && block.size() - at > 8 &&
          std::memcmp(bytes, kCompressed, 4) == 0) {
        found.oodle_payloads += bytes[8] == kOodle;
        found.lz4_payloads += bytes[8] == kLz4;
      }
      if (bytes[0] != 'D' || std::memcmp(bytes, kSignature, sizeof(kSignature)) != 0) continue;
      DnaStream stream;
      stream.offset = base + at;
      stream.version = static_cast<unsigned char>(bytes[6]);
      if (stream.version == 0 || stream.version > kMaxVersion) continue;
      const Kind kind =
          stream.version == 1 ? measure_sections(file, stream) : measure_index(file, stream);
      if (kind == Kind::kNone) continue;
      stream.truncated = kind == Kind::kTruncated;
      if (stream.truncated) stream.size = file.size() - stream.offset;
      open_stream(file, stream);
      // Another may begin within what the end of the file cuts off.
      resume = stream.offset + (stream.truncated ? 1 : stream.size);
      found.streams.push_back(std::move(stream));
    }
  }
  return found;
}

std::optional<DnaStream> only_dna_stream(FileBytes& file, const char* cannot) {
  const FoundStreams found = find_dna_streams(file);
  if (found.streams.empty()) {
    if (found.oodle_payloads + found.lz4_payloads == 0) return std::nullopt;
    fail(kInvalid, cannot, file.shown(), "not a DNA file, and " + why_no_stream(found),
         "give a DNA file, or a file that holds one uncompressed");
  }
  if (found.streams.size() > 1) {
    fail(kInvalid, cannot, file.shown(), "not a DNA file; " + list_of_streams(found),
         "take one out with 'mien extract --index N'");
  }
  const DnaStream& stream = found.streams[0];
  if (stream.truncated) {
    fail(kInvalid, cannot, file.shown() + ", DNA stream at byte " + std::to_string(stream.offset),
         stream.problem, "export the file again");
  }
  return stream;
}

std::string list_of_streams(const FoundStreams& found) {
  std::string text = "it has " + std::to_string(found.streams.size()) + " DNA streams: ";
  for (size_t i = 0; i < found.streams.size(); ++i) {
    const DnaStream& stream = found.streams[i];
    text += (i == 0 ? "" : ", ") + std::to_string(i) + " at byte " + std::to_string(stream.offset) +
            " (2." + std::to_string(stream.version) + ", " + std::to_string(stream.size) +
            " bytes" + (stream.name.empty() ? "" : ", \"" + one_line(stream.name) + "\"") +
            (stream.truncated ? ", truncated" : "") + ")";
  }
  return text;
}

std::string why_no_stream(const FoundStreams& found) {
  std::string why = "no DNA stream in its " + std::to_string(found.bytes) + " bytes";
  if (found.oodle_payloads + found.lz4_payloads != 0) {
    why +=
        "; compressed payloads, which are not searched: " + std::to_string(found.oodle_payloads) +
        " Oodle, " + std::to_string(found.lz4_payloads) + " LZ4";
  }
  return why;
}

}  // namespace mien::cli
