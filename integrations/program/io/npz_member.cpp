// SPDX-License-Identifier: MIT
#include "integrations/program/io/npz_member.h"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <memory>

#include "integrations/program/io/failure.h"

namespace mien::cli {

namespace {

constexpr size_t kZipEndSize = 22, kZipEntrySize = 46, kZipHeaderSize = 30;
constexpr uint64_t kMostZipComment = 65535;
constexpr uint64_t kZipStored = 0, kZipDeflated = 8;
constexpr uint64_t kZipEncrypted = 1;  // a flag

// Arrays of captured motion become a tenth at best; Deflate could make a thousandth of zeros.
constexpr uint64_t kMostInflated = 16 << 20, kMostInflatedPerByte = 200;

[[noreturn]] void fail_npz(const std::string& path, const std::string& why,
                           const std::string& what_to_do = "save it again with numpy.savez()") {
  fail(kInvalid, "invalid NPZ file", path, why, what_to_do);
}

uint64_t little_endian(const std::string& bytes, uint64_t at, size_t size) {
  uint64_t number = 0;
  for (size_t i = size; i-- > 0;) number = number << 8 | static_cast<unsigned char>(bytes[at + i]);
  return number;
}

bool has_mark(const std::string& bytes, uint64_t at, size_t size, const char* mark) {
  return at <= bytes.size() && bytes.size() - at >= size && bytes.compare(at, 4, mark, 4) == 0;
}

uint64_t find_zip_end(const std::string& bytes, const std::string& path) {
  for (uint64_t back = kZipEndSize; back <= bytes.size() && back <= kZipEndSize + kMostZipComment;
       ++back) {
    if (has_mark(bytes, bytes.size() - back, kZipEndSize, "PK\5\6")) return bytes.size() - back;
  }
  fail_npz(path, "the list of its arrays is missing");
}

const Bytef* bytes_at(const std::string& bytes, uint64_t at) {
  return reinterpret_cast<const Bytef*>(bytes.data() + at);
}

/// `size` bytes from `packed` bytes at `data`, which both are below 4 GiB.
std::string inflate_member(const std::string& bytes, uint64_t data, uint64_t packed, uint64_t size,
                           const std::string& path) {
  if (size > kMostInflated + kMostInflatedPerByte * bytes.size()) {
    fail_npz(path, "its array has more than 200 times the bytes of the file",
             "save it with numpy.savez(), which does not compress");
  }
  std::string inflated(size, '\0');
  z_stream stream = {};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw std::bad_alloc();  // without a header
  const std::unique_ptr<z_stream, int (*)(z_stream*)> owner(&stream, inflateEnd);
  Bytef none = 0;
  stream.next_in = const_cast<Bytef*>(bytes_at(bytes, data));
  stream.avail_in = static_cast<uInt>(packed);
  stream.next_out = size == 0 ? &none : reinterpret_cast<Bytef*>(&inflated[0]);
  stream.avail_out = static_cast<uInt>(size);
  const int status = inflate(&stream, Z_FINISH);
  if (status == Z_MEM_ERROR) throw std::bad_alloc();
  if (status != Z_STREAM_END || stream.avail_in != 0 || stream.avail_out != 0) {
    fail_npz(path, "its compressed array is damaged, or does not have the size that the list says");
  }
  return inflated;
}

}  // namespace

std::string read_npz_member(const std::string& bytes, const std::string& path) {
  const uint64_t end = find_zip_end(bytes, path);
  const uint64_t count = little_endian(bytes, end + 10, 2);
  const uint64_t entry = little_endian(bytes, end + 16, 4);
  if (count != 1) {
    fail_npz(path, "it has " + std::to_string(count) + " arrays", "save one array in it");
  }
  if (!has_mark(bytes, entry, kZipEntrySize, "PK\1\2")) {
    fail_npz(path, "the list of its arrays is damaged");
  }
  const uint64_t flags = little_endian(bytes, entry + 8, 2);
  const uint64_t method = little_endian(bytes, entry + 10, 2);
  const uint64_t checksum = little_endian(bytes, entry + 16, 4);
  const uint64_t packed = little_endian(bytes, entry + 20, 4);
  const uint64_t size = little_endian(bytes, entry + 24, 4);
  const uint64_t header = little_endian(bytes, entry + 42, 4);
  if ((flags & kZipEncrypted) != 0) fail_npz(path, "its array is encrypted");
  if (method != kZipStored && method != kZipDeflated) {
    fail_npz(path, "its array is compressed in another way than Deflate");
  }
  if (packed == UINT32_MAX || size == UINT32_MAX) {
    fail_npz(path, "its array has 4 GiB or more", "save it as .npy");
  }
  if (!has_mark(bytes, header, kZipHeaderSize, "PK\3\4")) {
    fail_npz(path, "its array is not where the list says");
  }
  const uint64_t data = header + kZipHeaderSize + little_endian(bytes, header + 26, 2) +
                        little_endian(bytes, header + 28, 2);
  if (data > bytes.size() || packed > bytes.size() - data) {
    fail_npz(path, "its array is cut off");
  }
  if (method == kZipStored && size != packed) {
    fail_npz(path, "the list of its arrays is damaged");
  }
  std::string member = method == kZipStored ? bytes.substr(data, size)
                                            : inflate_member(bytes, data, packed, size, path);
  if (crc32(0, bytes_at(member, 0), static_cast<uInt>(member.size())) != checksum) {
    fail_npz(path, "the checksum of its array is wrong");
  }
  return member;
}

}  // namespace mien::cli
