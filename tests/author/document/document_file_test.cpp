// SPDX-License-Identifier: MIT
// Files that documents are opened from and written to without an open DNA file in between.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

#include "author/base/random.h"
#include "tests/support/bytes.h"
#include "tests/support/documents.h"
#include "tests/support/temporary_path.h"

namespace mien {
namespace {

class TemporaryPath {
 public:
  explicit TemporaryPath(const std::string& name) : path_(temporary_path(name)) {}
  ~TemporaryPath() { std::remove(path_.c_str()); }
  const std::string& str() const { return path_; }

 private:
  std::string path_;
};

void write_bytes(const std::string& path, const Bytes& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}
Bytes read_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(file), {});
}

DocumentHandle open_document(const std::string& path, uint32_t access,
                             const MienAllocator* allocator = nullptr,
                             MienStatus expected = MIEN_OK) {
  MienDocumentDesc desc = sized<MienDocumentDesc>();
  desc.file_access = access;
  desc.allocator = allocator;
  MienDocument* document = nullptr;
  MienError error = sized<MienError>();
  EXPECT_EQ(mien_document_open_file(path.c_str(), &desc, &document, &error), expected)
      << error.message;
  return DocumentHandle(document);
}

struct Collected {
  Bytes bytes;
  size_t pieces = 0, refused = SIZE_MAX;  // the piece that is not taken

  static size_t MIEN_CALLBACK write(void* user, const void* bytes, size_t size) {
    Collected& self = *static_cast<Collected*>(user);
    if (self.pieces++ == self.refused) return size - 1;
    const uint8_t* from = static_cast<const uint8_t*>(bytes);
    self.bytes.insert(self.bytes.end(), from, from + size);
    return size;
  }
};

TEST(DocumentFile, IsOpenedAndWrittenInEveryWay) {
  const TemporaryPath path("document.dna"), other("other.dna");
  for (const std::string& name : golden::present_names()) {
    SCOPED_TRACE(name);
    const Bytes bytes = golden::read_rig(name);
    write_bytes(path.str(), bytes);
    for (uint32_t access : {MIEN_FILE_MAP, MIEN_FILE_READ}) {
      const DocumentHandle document = open_document(path.str(), access);
      ASSERT_TRUE(document);
      EXPECT_EQ(bytes_of(document), write_dna(open_dna(bytes).get()));
      EXPECT_EQ(write_string(document, "desc.name", "another name"), MIEN_OK);
      const Bytes wanted = bytes_of(document);
      ASSERT_EQ(mien_document_write_file(document.get(), other.str().c_str(), nullptr, nullptr),
                MIEN_OK);
      EXPECT_EQ(read_bytes(other.str()), wanted);
      Collected collected;
      const MienByteSink sink = {&collected, Collected::write};
      ASSERT_EQ(mien_document_write_stream(document.get(), &sink, nullptr, nullptr), MIEN_OK);
      EXPECT_EQ(collected.bytes, wanted);
      ASSERT_EQ(mien_document_undo(document.get(), 0, nullptr), MIEN_OK);
      EXPECT_EQ(bytes_of(document), write_dna(open_dna(bytes).get()));
    }
  }
}

TEST(DocumentFile, MayReplaceTheFileThatItWasOpenedFrom) {
  const TemporaryPath path("document.dna");
  write_bytes(path.str(), golden::read_rig("small"));
  const DocumentHandle document = open_document(path.str(), MIEN_FILE_READ);
  ASSERT_EQ(write_string(document, "desc.name", "in place"), MIEN_OK);
  const Bytes wanted = bytes_of(document);
  ASSERT_EQ(mien_document_write_file(document.get(), path.str().c_str(), nullptr, nullptr),
            MIEN_OK);
  EXPECT_EQ(read_bytes(path.str()), wanted);
  EXPECT_EQ(bytes_of(document), wanted);
}

// Pieces end within arrays and numbers.
TEST(DocumentFile, OfManyPiecesIsWhole) {
  const DocumentHandle document = document_of(golden::read_rig("small"));
  ASSERT_EQ(resize(document, "geom.meshes[0].normals.xs", 3'000'000), MIEN_OK);
  ASSERT_EQ(resize(document, "geom.meshes[0].normals.ys", 3'000'000), MIEN_OK);
  ASSERT_EQ(resize(document, "geom.meshes[0].normals.zs", 3'000'000), MIEN_OK);
  std::vector<float> values(3'000'000);
  for (size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
  ASSERT_EQ(write_floats(document, "geom.meshes[0].normals.ys", values), MIEN_OK);
  Collected collected;
  const MienByteSink sink = {&collected, Collected::write};
  ASSERT_EQ(mien_document_write_stream(document.get(), &sink, nullptr, nullptr), MIEN_OK);
  EXPECT_GT(collected.pieces, 4u);
  EXPECT_TRUE(collected.bytes == bytes_of(document));

  Collected refusing;
  refusing.refused = 2;
  const MienByteSink refuses = {&refusing, Collected::write};
  MienError error = sized<MienError>();
  EXPECT_EQ(mien_document_write_stream(document.get(), &refuses, nullptr, &error),
            MIEN_ERROR_FILE_WRITE);
  EXPECT_EQ(refusing.pieces, 3u);
}

// In every version as the opened document is, valid or not.
TEST(DocumentFile, IsTheOneThatTheOpenedDocumentGives) {
  size_t valid = 0, refused = 0;
  for (const char* name : {"tiny", "small", "ml", "ml_ext", "tiny_v21", "body"}) {
    const Bytes bytes = golden::read_rig(name);
    const DocumentHandle document = document_of(bytes);
    std::vector<std::string> paths;
    for_each_field(document, "", [&](const std::string& path, const MienDnaField& field) {
      if (field.type != MIEN_FIELD_F32 && field.type != MIEN_FIELD_STRING &&
          field.type != MIEN_FIELD_RECORD) {
        paths.push_back(path);
      }
    });
    Random random(7, 11);
    for (int step = 0; step < 120; ++step) {
      ASSERT_EQ(mien_document_undo(document.get(), 0, nullptr), MIEN_OK);
      const std::string& path = paths[random.below(static_cast<uint32_t>(paths.size()))];
      const MienDnaField field = field_of(document, path);
      if (field.is_array || field.type == MIEN_FIELD_LIST) {
        const uint64_t count = random.below(3) == 0 ? 0 : field.count + random.below(2);
        EXPECT_EQ(resize(document, path, count), MIEN_OK);
      }
      if (field.type != MIEN_FIELD_LIST && field_of(document, path).count != 0) {
        auto values = integers_of(document, path);
        values[random.below(static_cast<uint32_t>(values.size()))] = random.below(200);
        EXPECT_EQ(write_integers(document, path, values), MIEN_OK);
      }
      const uint32_t version = random.below(9);
      SCOPED_TRACE(std::string(name) + " " + path + " as 2." + std::to_string(version));
      MienDna* dna = nullptr;
      MienStatus wanted = mien_document_to_dna(document.get(), nullptr, &dna, nullptr);
      const DnaHandle owner(dna);
      Bytes wanted_bytes;
      if (wanted == MIEN_OK) {
        MienWriteDesc desc = sized<MienWriteDesc>();
        desc.version = version;
        size_t size = 0;
        wanted = mien_dna_write_memory(dna, &desc, nullptr, 0, &size, nullptr);
        wanted_bytes.resize(size);
        if (wanted == MIEN_OK) {
          ASSERT_EQ(mien_dna_write_memory(dna, &desc, wanted_bytes.data(), size, &size, nullptr),
                    MIEN_OK);
        }
      }
      MienStatus status = MIEN_OK;
      const Bytes direct = written_directly(document, &status, version);
      EXPECT_EQ(status, wanted);
      EXPECT_TRUE(direct == wanted_bytes);
      (wanted == MIEN_OK ? valid : refused) += 1;
    }
  }
  EXPECT_GT(valid, 50u);
  EXPECT_GT(refused, 50u);
}

TEST(DocumentFile, RefusesWhatItCannotOpenOrWrite) {
  const TemporaryPath path("document.dna");
  write_bytes(path.str(), {'D', 'N', 'A', 0, 2});
  EXPECT_FALSE(open_document(path.str(), MIEN_FILE_MAP, nullptr, MIEN_ERROR_DNA_TRUNCATED));
  write_bytes(path.str(), {'N', 'O'});
  EXPECT_FALSE(open_document(path.str(), MIEN_FILE_READ, nullptr, MIEN_ERROR_DNA_SIGNATURE));
  EXPECT_FALSE(
      open_document(path.str() + ".missing", MIEN_FILE_MAP, nullptr, MIEN_ERROR_FILE_OPEN));
  EXPECT_FALSE(open_document(path.str(), 7, nullptr, MIEN_ERROR_INVALID_ARGUMENT));

  const DocumentHandle document = document_of(golden::read_rig("small"));
  const std::string nowhere = path.str() + ".missing/out.dna";
  EXPECT_EQ(mien_document_write_file(document.get(), nowhere.c_str(), nullptr, nullptr),
            MIEN_ERROR_FILE_WRITE);
  size_t size = 0;
  uint8_t small[8];
  EXPECT_EQ(mien_document_write_memory(document.get(), nullptr, small, 8, &size, nullptr),
            MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(size, bytes_of(document).size());
  ASSERT_EQ(resize(document, "defn.neutralJointTranslations.xs", 1), MIEN_OK);
  EXPECT_EQ(mien_document_write_file(document.get(), path.str().c_str(), nullptr, nullptr),
            MIEN_ERROR_DNA_STRUCTURE);
  EXPECT_EQ(read_bytes(path.str()), (Bytes{'N', 'O'}));
}

TEST(DocumentFile, LeaksNothingWhenMemoryRunsOut) {
  const TemporaryPath path("document.dna"), out("out.dna");
  const Bytes bytes = golden::read_rig("small");
  write_bytes(path.str(), bytes);
  CountingAllocator memory;
  const MienAllocator allocator = memory.get();
  MienDocumentDesc desc = sized<MienDocumentDesc>();
  desc.file_access = MIEN_FILE_READ;
  desc.allocator = &allocator;
  for (size_t k = 1;; ++k) {
    memory.restart();
    memory.fail_at = k;
    MienDocument* made = nullptr;
    const MienStatus opened = mien_document_open_file(path.str().c_str(), &desc, &made, nullptr);
    const DocumentHandle document(made);
    MienStatus written = opened;
    if (opened == MIEN_OK)
      written = mien_document_write_file(made, out.str().c_str(), nullptr, nullptr);
    memory.fail_at = 0;
    if (memory.failed == 0) {
      EXPECT_EQ(written, MIEN_OK);
      EXPECT_GT(k, 3u);
      break;
    }
    ASSERT_EQ(written, MIEN_ERROR_MEMORY) << k;
  }
  EXPECT_EQ(read_bytes(out.str()), bytes);
  EXPECT_TRUE(memory.clean()) << memory.first_wrong;
}

}  // namespace
}  // namespace mien
