// SPDX-License-Identifier: MIT
// Documents for tests: handles that destroy themselves, and every field of one.
#pragma once

#include <functional>

#include "tests/support/counting_allocator.h"
#include "tests/support/dna_bytes.h"
#include "tests/support/golden.h"
#include "tests/support/rig_handles.h"
#include "tests/support/tiny_rig.h"

namespace mien {

inline std::vector<uint8_t> tiny_bytes() {
  Arena arena(default_allocator());
  return dna::written(dna::tiny_rig(arena));
}

struct DestroyDocument {
  void operator()(MienDocument* document) const { mien_document_destroy(document); }
};
using DocumentHandle = std::unique_ptr<MienDocument, DestroyDocument>;

inline DocumentHandle create_document(const MienDna* dna,
                                      const MienAllocator* allocator = nullptr) {
  MienDocumentDesc desc = sized<MienDocumentDesc>();
  desc.allocator = allocator;
  MienDocument* document = nullptr;
  MienError error = sized<MienError>();
  EXPECT_EQ(mien_document_create(dna, &desc, &document, &error), MIEN_OK) << error.message;
  return DocumentHandle(document);
}
inline DocumentHandle document_of(const std::vector<uint8_t>& bytes,
                                  const MienAllocator* allocator = nullptr) {
  return create_document(open_dna(bytes).get(), allocator);
}

inline DnaHandle dna_of(const DocumentHandle& document, MienStatus expected = MIEN_OK,
                        std::string* message = nullptr) {
  MienDna* dna = nullptr;
  MienError error = sized<MienError>();
  EXPECT_EQ(mien_document_to_dna(document.get(), nullptr, &dna, &error), expected) << error.message;
  if (message) *message = error.message;
  return DnaHandle(dna);
}

/// The file that a document becomes in version 2.`version`, straight from its fields; none if it is not valid.
inline std::vector<uint8_t> written_directly(const DocumentHandle& document, MienStatus* out_status,
                                             uint32_t version = 0) {
  MienWriteDesc desc = sized<MienWriteDesc>();
  desc.version = version;
  size_t size = 0;
  *out_status = mien_document_write_memory(document.get(), &desc, nullptr, 0, &size, nullptr);
  std::vector<uint8_t> bytes(size);
  if (*out_status == MIEN_OK) {
    *out_status = mien_document_write_memory(document.get(), &desc, bytes.data(), bytes.size(),
                                             &size, nullptr);
  }
  return bytes;
}

/// The file that a document becomes, checked: by opening it and straight from its fields.
inline std::vector<uint8_t> bytes_of(const DocumentHandle& document) {
  const DnaHandle dna = dna_of(document);
  const std::vector<uint8_t> bytes = dna ? write_dna(dna.get()) : std::vector<uint8_t>();
  MienStatus status = MIEN_OK;
  EXPECT_TRUE(written_directly(document, &status) == bytes) << status;
  EXPECT_EQ(status == MIEN_OK, dna != nullptr);
  return bytes;
}

inline MienDnaField field_of(const DocumentHandle& document, const std::string& path) {
  MienDnaField field = sized<MienDnaField>();
  MienError error = sized<MienError>();
  EXPECT_EQ(mien_document_field(document.get(), path.c_str(), &field, &error), MIEN_OK)
      << error.message;
  return field;
}
inline std::vector<float> floats_of(const DocumentHandle& document, const std::string& path) {
  std::vector<float> values(field_of(document, path).count);
  EXPECT_EQ(mien_document_read_floats(document.get(), path.c_str(), 0, values.size(), values.data(),
                                      nullptr),
            MIEN_OK);
  return values;
}
inline std::vector<int64_t> integers_of(const DocumentHandle& document, const std::string& path) {
  std::vector<int64_t> values(field_of(document, path).count);
  EXPECT_EQ(mien_document_read_integers(document.get(), path.c_str(), 0, values.size(),
                                        values.data(), nullptr),
            MIEN_OK);
  return values;
}
inline std::string string_of(const DocumentHandle& document, const std::string& path) {
  MienStringView view = {};
  EXPECT_EQ(mien_document_read_string(document.get(), path.c_str(), &view, nullptr), MIEN_OK)
      << path;
  return std::string(view.data, view.count);
}
inline std::vector<std::string> strings_of(const DocumentHandle& document,
                                           const std::string& path) {
  std::vector<std::string> strings(field_of(document, path).count);
  for (size_t i = 0; i < strings.size(); ++i) {
    strings[i] = string_of(document, path + "[" + std::to_string(i) + "]");
  }
  return strings;
}

inline MienStatus write_floats(const DocumentHandle& document, const std::string& path,
                               const std::vector<float>& values, MienError* error = nullptr) {
  return mien_document_write_floats(document.get(), path.c_str(), 0, values.size(), values.data(),
                                    error);
}
inline MienStatus write_integers(const DocumentHandle& document, const std::string& path,
                                 const std::vector<int64_t>& values, MienError* error = nullptr) {
  return mien_document_write_integers(document.get(), path.c_str(), 0, values.size(), values.data(),
                                      error);
}
inline MienStatus write_string(const DocumentHandle& document, const std::string& path,
                               const std::string& text, MienError* error = nullptr) {
  return mien_document_write_string(document.get(), path.c_str(), text.data(), text.size(), error);
}
inline MienStatus resize(const DocumentHandle& document, const std::string& path, uint64_t count,
                         MienError* error = nullptr) {
  return mien_document_resize(document.get(), path.c_str(), count, error);
}

/// Calls f(path, field) for every field at or below a path that is not a record.
inline void for_each_field(const DocumentHandle& document, const std::string& path,
                           const std::function<void(const std::string&, const MienDnaField&)>& f) {
  const MienDnaField field = field_of(document, path);
  if (field.type == MIEN_FIELD_RECORD) {
    for (uint32_t i = 0; i < field.count; ++i) {
      MienStringView name = {};
      ASSERT_EQ(mien_document_child_name(document.get(), path.c_str(), i, &name, nullptr), MIEN_OK);
      for_each_field(document,
                     (path.empty() ? "" : path + ".") + std::string(name.data, name.count), f);
    }
    return;
  }
  f(path, field);
  if (field.type != MIEN_FIELD_LIST) return;
  for (uint64_t i = 0; i < field.count; ++i) {
    for_each_field(document, path + "[" + std::to_string(i) + "]", f);
  }
}

}  // namespace mien
