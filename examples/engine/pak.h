// SPDX-License-Identifier: MIT
// A pak file: baked rigs one after the other, each at a multiple of 64 bytes, where the library uses them in place.
//
//   PakHeader | PakEntry x count | padding | bytes of an entry | padding | bytes of the next one ...
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <mutex>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

struct PakHeader {
  char magic[4];  // "PAK1"
  uint32_t count;
  uint64_t generation;  // a larger one: the file was written again
};

struct PakEntry {
  char name[48];  // null-terminated
  uint64_t offset, size;
};

struct File {
  explicit File(const std::string& path, const char* mode)
      : handle(std::fopen(path.c_str(), mode)) {
    if (!handle) throw std::runtime_error("cannot open " + path);
  }
  ~File() {
    if (handle) std::fclose(handle);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  void read(void* to, size_t size) {
    if (std::fread(to, 1, size, handle) != size) throw std::runtime_error("the file is too short");
  }
  void write(const void* from, size_t size) {
    if (std::fwrite(from, 1, size, handle) != size) throw std::runtime_error("cannot write");
  }

  std::FILE* handle;
};

// Memory aligned to 64 bytes.
using Bytes = std::unique_ptr<unsigned char, void (*)(unsigned char*)>;

inline Bytes allocate_bytes(size_t size) {
  void* block = ::operator new(size, std::align_val_t(64));
  return Bytes(static_cast<unsigned char*>(block),
               [](unsigned char* p) { ::operator delete(p, std::align_val_t(64)); });
}

// A reader sees the old file or the new one, never a part.
inline void replace_file(const std::string& from, const std::string& to) {
  std::filesystem::rename(from, to);
}

inline void write_pak(
    const std::string& path, uint64_t generation,
    const std::vector<std::pair<std::string, std::vector<unsigned char>>>& parts) {
  const std::string unfinished = path + ".part";
  {
    File file(unfinished, "wb");
    const PakHeader header = {{'P', 'A', 'K', '1'}, uint32_t(parts.size()), generation};
    file.write(&header, sizeof header);
    uint64_t offset = sizeof header + parts.size() * sizeof(PakEntry);
    std::vector<PakEntry> entries(parts.size());
    for (size_t i = 0; i < parts.size(); ++i) {
      std::snprintf(entries[i].name, sizeof entries[i].name, "%s", parts[i].first.c_str());
      offset = (offset + 63) / 64 * 64;
      entries[i].offset = offset;
      entries[i].size = parts[i].second.size();
      offset += entries[i].size;
    }
    file.write(entries.data(), entries.size() * sizeof(PakEntry));
    const unsigned char zeros[64] = {};
    for (size_t i = 0; i < parts.size(); ++i) {
      file.write(zeros, entries[i].offset - uint64_t(std::ftell(file.handle)));
      file.write(parts[i].second.data(), parts[i].second.size());
    }
  }
  replace_file(unfinished, path);
}

// An open pak file. Entries are read when they are needed, by any thread: also those of a file that was replaced.
class Pak {
 public:
  explicit Pak(const std::string& path) : open_(std::make_shared<Open>(path)) {
    File& file = open_->file;
    file.read(&header_, sizeof header_);
    if (std::memcmp(header_.magic, "PAK1", 4) || header_.count > 4096)
      throw std::runtime_error("not a pak file");
    entries_.resize(header_.count);
    file.read(entries_.data(), entries_.size() * sizeof(PakEntry));
    std::fseek(file.handle, 0, SEEK_END);
    const uint64_t end = uint64_t(std::ftell(file.handle));
    for (const PakEntry& entry : entries_) {
      if (!std::memchr(entry.name, 0, sizeof entry.name) || entry.size > end ||
          entry.offset > end - entry.size) {
        throw std::runtime_error("the pak file is damaged");
      }
    }
  }

  static uint64_t generation_of(const std::string& path) {
    File file(path, "rb");
    PakHeader header;
    file.read(&header, sizeof header);
    return header.generation;
  }

  uint64_t generation() const { return header_.generation; }

  Bytes read(const std::string& name, size_t& size) const {
    for (const PakEntry& entry : entries_) {
      if (name != entry.name) continue;
      Bytes bytes = allocate_bytes(entry.size);
      const std::lock_guard<std::mutex> lock(open_->mutex);
      std::fseek(open_->file.handle, long(entry.offset), SEEK_SET);
      open_->file.read(bytes.get(), entry.size);
      size = entry.size;
      return bytes;
    }
    throw std::runtime_error("the pak file has no " + name);
  }

 private:
  struct Open {
    explicit Open(const std::string& path) : file(path, "rb") {}
    File file;
    std::mutex mutex;
  };

  std::shared_ptr<Open> open_;
  PakHeader header_ = {};
  std::vector<PakEntry> entries_;
};
