// SPDX-License-Identifier: MIT
#include "integrations/program/io/npy_reader.h"

#include <charconv>
#include <cmath>
#include <cstring>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/npz_member.h"

namespace mien::cli {

namespace {

constexpr char kNpyMagic[] = "\x93NUMPY";
constexpr size_t kNpyMagicSize = 6;

[[noreturn]] void fail_npy(const std::string& path, const std::string& why,
                           const std::string& what_to_do) {
  fail(kInvalid, "invalid NPY file", path, why, what_to_do);
}

/// What stands behind 'key': in the header, a dict as Python writes it; "" if it is not there.
std::string header_value(const std::string& header, const std::string& key) {
  const size_t found = header.find("'" + key + "'");
  if (found == std::string::npos) return "";
  const size_t begin = header.find_first_not_of(": ", found + key.size() + 2);
  if (begin == std::string::npos) return "";
  const char closing = header[begin] == '(' ? ')' : header[begin] == '\'' ? '\'' : ',';
  const size_t end = header.find(closing, begin + 1);
  if (end == std::string::npos) return "";
  return closing == ',' ? header.substr(begin, end - begin)
                        : header.substr(begin + 1, end - begin - 1);
}

std::vector<uint64_t> parse_shape(const std::string& text, const std::string& path) {
  std::vector<uint64_t> shape;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at != end) {
    if (*at == ' ' || *at == ',') {
      ++at;
      continue;
    }
    uint64_t length = 0;
    const auto [stop, error] = std::from_chars(at, end, length);
    if (error != std::errc()) fail_npy(path, "the shape is not a list of numbers", "save it again");
    shape.push_back(length);
    at = stop;
  }
  return shape;
}

template <class T>
void append(const char* bytes, size_t count, std::vector<float>& numbers) {
  for (size_t i = 0; i < count; ++i) {
    T number;
    std::memcpy(&number, bytes + i * sizeof(T), sizeof(T));
    numbers.push_back(static_cast<float>(number));
  }
}

}  // namespace

NpyArray read_npy_or_npz(const std::string& bytes, const std::string& path, bool nan) {
  return bytes.compare(0, 4, "PK\3\4") == 0 ? read_npy(read_npz_member(bytes, path), path, nan)
                                            : read_npy(bytes, path, nan);
}

NpyArray read_npy(const std::string& bytes, const std::string& path, bool nan) {
  if (bytes.compare(0, kNpyMagicSize, kNpyMagic) != 0 || bytes.size() < 12) {
    fail_npy(path, "it does not begin as one", "save it with numpy.save()");
  }
  // Version 1 has a length of 2 bytes, later ones of 4.
  const auto byte = [&bytes](size_t i) { return uint64_t{static_cast<unsigned char>(bytes[i])}; };
  const size_t begin = bytes[6] == 1 ? 10 : 12;
  uint64_t length = byte(8) | byte(9) << 8;
  if (begin == 12) length |= byte(10) << 16 | byte(11) << 24;
  if (length > bytes.size() - begin) fail_npy(path, "the header is cut off", "save it again");
  const std::string header = bytes.substr(begin, length);
  if (header_value(header, "fortran_order").substr(0, 5) != "False") {
    fail_npy(path, "the array is in Fortran order", "save numpy.ascontiguousarray(a)");
  }
  NpyArray array;
  array.shape = parse_shape(header_value(header, "shape"), path);
  const std::string type = header_value(header, "descr");
  const size_t size = type.size() == 3 ? static_cast<size_t>(type[2] - '0') : 0;
  const char* const data = bytes.data() + begin + length;
  const uint64_t data_size = bytes.size() - begin - length;
  uint64_t count = 1;
  bool fits = size != 0;
  for (const uint64_t n : array.shape) {
    fits = fits && (n == 0 || count <= data_size / n);
    if (fits) count *= n;
  }
  if (size != 0 && (!fits || count > data_size / size || count * size != data_size)) {
    fail_npy(path, "the data do not have the size of the shape", "save it again");
  }
  array.numbers.reserve(fits ? count : 0);
  if (type == "<f4")
    append<float>(data, count, array.numbers);
  else if (type == "<f8")
    append<double>(data, count, array.numbers);
  else if (type == "|i1")
    append<int8_t>(data, count, array.numbers);
  else if (type == "|u1")
    append<uint8_t>(data, count, array.numbers);
  else if (type == "<i2")
    append<int16_t>(data, count, array.numbers);
  else if (type == "<u2")
    append<uint16_t>(data, count, array.numbers);
  else if (type == "<i4")
    append<int32_t>(data, count, array.numbers);
  else if (type == "<u4")
    append<uint32_t>(data, count, array.numbers);
  else if (type == "<i8")
    append<int64_t>(data, count, array.numbers);
  else if (type == "<u8")
    append<uint64_t>(data, count, array.numbers);
  else
    fail_npy(path, "numbers of type \"" + type + "\" are not read", "save a.astype('float32')");
  for (size_t i = 0; i < array.numbers.size(); ++i) {
    if (!std::isfinite(array.numbers[i]) && !(nan && std::isnan(array.numbers[i]))) {
      fail_npy(path, "number " + std::to_string(i) + " is not finite",
               nan ? "give finite numbers, or NaN where one is missing" : "give finite numbers");
    }
  }
  return array;
}

}  // namespace mien::cli
