// SPDX-License-Identifier: MIT
#include "integrations/program/io/dna_fields.h"

namespace mien::cli {

std::string element(const std::string& list, uint64_t index, const std::string& rest) {
  return list + "[" + std::to_string(index) + "]" + rest;
}

uint64_t field_count(const RigFile& file, const std::string& path) {
  auto field = sized<MienDnaField>();
  auto error = sized<MienError>();
  check(mien_dna_field(file.dna.get(), path.c_str(), &field, &error), &error, "cannot read " + path,
        file.shown);
  return field.count;
}

int64_t read_integer(const RigFile& file, const std::string& path) {
  int64_t value = 0;
  auto error = sized<MienError>();
  check(mien_dna_read_integers(file.dna.get(), path.c_str(), 0, 1, &value, &error), &error,
        "cannot read " + path, file.shown);
  return value;
}

std::vector<int64_t> read_integers(const RigFile& file, const std::string& path) {
  std::vector<int64_t> values(field_count(file, path));
  auto error = sized<MienError>();
  if (values.empty()) return values;
  check(
      mien_dna_read_integers(file.dna.get(), path.c_str(), 0, values.size(), values.data(), &error),
      &error, "cannot read " + path, file.shown);
  return values;
}

std::vector<float> read_floats(const RigFile& file, const std::string& path) {
  std::vector<float> values(field_count(file, path));
  auto error = sized<MienError>();
  if (values.empty()) return values;
  check(mien_dna_read_floats(file.dna.get(), path.c_str(), 0, values.size(), values.data(), &error),
        &error, "cannot read " + path, file.shown);
  return values;
}

std::string read_string(const RigFile& file, const std::string& path) {
  MienStringView view{};
  auto error = sized<MienError>();
  check(mien_dna_read_string(file.dna.get(), path.c_str(), &view, &error), &error,
        "cannot read " + path, file.shown);
  return to_string(view);
}

}  // namespace mien::cli
