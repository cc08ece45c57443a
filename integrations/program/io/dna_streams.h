// SPDX-License-Identifier: MIT
// DNA files inside other files, such as .uasset: found by their own structure, wherever they lie.
#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

namespace mien::cli {

/// One DNA file within a file.
struct DnaStream {
  uint64_t offset = 0;   // of its first byte
  uint64_t size = 0;     // in bytes; of a truncated stream, to the end of the file
  uint32_t version = 0;  // 2.version
  bool truncated = false;
  std::string name;     // of the character; empty if the reader refuses the stream
  std::string problem;  // what the reader says of it; empty if it opens
};

struct FoundStreams {
  std::vector<DnaStream> streams;  // in file order
  uint64_t bytes = 0;              // searched
  // Payloads of Unreal packages that are compressed: what is in them is not searched.
  uint32_t oodle_payloads = 0, lz4_payloads = 0;
};

/// Bytes by their offset: of a file, or of what was read from a pipe.
class FileBytes {
 public:
  /// `path` may be "-".
  explicit FileBytes(const std::string& path);
  FileBytes(std::string shown, std::string bytes);

  uint64_t size() const { return size_; }
  const std::string& shown() const { return shown_; }

  /// At most to the end of the file.
  std::string read(uint64_t offset, uint64_t count);

 private:
  std::string shown_;
  std::string bytes_;
  std::ifstream file_;
  uint64_t size_ = 0;
};

/// Searches from the beginning to the end; takes memory for one DNA stream at a time.
FoundStreams find_dna_streams(FileBytes& file);

/// The one stream of a file that is not a DNA file itself, or nothing if there is none. Fails if there are
/// several, or compressed payloads only, or if the stream is truncated; `cannot` is what failed by that.
std::optional<DnaStream> only_dna_stream(FileBytes& file, const char* cannot);

/// "it has 2 DNA streams: 0 at byte 4096 (2.5, 1234 bytes, \"Ada\"), ..."
std::string list_of_streams(const FoundStreams& found);

/// Why there is nothing to open, for an error message.
std::string why_no_stream(const FoundStreams& found);

}  // namespace mien::cli
