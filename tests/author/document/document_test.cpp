// SPDX-License-Identifier: MIT
// Documents through the C interface: what comes out is what went in, but for what was written.
#include "author/document/document.h"

#include <gtest/gtest.h>

#include "author/base/random.h"
#include "author/capi/document.h"
#include "tests/support/bytes.h"
#include "tests/support/dna_bytes.h"
#include "tests/support/documents.h"
#include "tests/support/tiny_rig.h"

namespace mien {
namespace {

/// Where two files of equal size differ: [first, last].
std::pair<size_t, size_t> differing(const Bytes& a, const Bytes& b) {
  size_t first = SIZE_MAX, last = 0;
  for (size_t i = 0; i < a.size() && i < b.size(); ++i) {
    if (a[i] == b[i]) continue;
    if (first == SIZE_MAX) first = i;
    last = i;
  }
  return {first, last};
}

TEST(Document, GivesBackTheFileThatItWasMadeOf) {
  for (const std::string& name : golden::present_names()) {
    const Bytes bytes = golden::read_rig(name);
    const DnaHandle dna = open_dna(bytes);
    EXPECT_EQ(bytes_of(create_document(dna.get())), write_dna(dna.get())) << name;
  }
  if (!golden::has_head()) GTEST_SKIP() << golden::no_head();
}

TEST(Document, OutlivesTheFile) {
  Bytes bytes = tiny_bytes();
  const Bytes kept = bytes;
  DnaHandle dna = open_dna(bytes);
  const DocumentHandle document = create_document(dna.get());
  dna.reset();
  std::fill(bytes.begin(), bytes.end(), uint8_t{0});
  EXPECT_EQ(bytes_of(document), kept);
}

TEST(Document, ThatIsEmptyIsAValidFileOfTheNewestVersion) {
  const DocumentHandle document = create_document(nullptr);
  const DnaHandle dna = dna_of(document);
  MienDnaInfo info = sized<MienDnaInfo>();
  ASSERT_EQ(mien_dna_info(dna.get(), &info), MIEN_OK);
  EXPECT_EQ(info.version, 8u);
  EXPECT_EQ(info.layer_count, 11u);
  EXPECT_EQ(info.joint_count, 0u);
}

TEST(Document, ReadsWhatTheFileHolds) {
  const Bytes bytes = tiny_bytes();
  const DnaHandle dna = open_dna(bytes);
  const DocumentHandle document = create_document(dna.get());
  size_t fields = 0;
  for_each_field(document, "", [&](const std::string& path, const MienDnaField& field) {
    MienDnaField of_file = sized<MienDnaField>();
    ASSERT_EQ(mien_dna_field(dna.get(), path.c_str(), &of_file, nullptr), MIEN_OK) << path;
    EXPECT_EQ(field.type, of_file.type) << path;
    EXPECT_EQ(field.count, of_file.count) << path;
    EXPECT_EQ(field.is_array, of_file.is_array) << path;
    EXPECT_EQ(field.byte_offset, MIEN_NO_OFFSET) << path;
    ++fields;
    MienStringView view = {};
    const MienStatus status = mien_document_bytes(document.get(), path.c_str(), &view, nullptr);
    const bool has_bytes = field.is_array || field.type == MIEN_FIELD_STRING;
    EXPECT_EQ(status, has_bytes ? MIEN_OK : MIEN_ERROR_INVALID_ARGUMENT) << path;
    if (has_bytes && view.count != 0) {
      EXPECT_EQ(memcmp(view.data, bytes.data() + of_file.byte_offset, view.count), 0) << path;
    }
  });
  EXPECT_GT(fields, 200u);
}

// Every number and every string of a file, one after another: the bytes of that field change and no others.
TEST(Document, WritesEachFieldAndNothingElse) {
  const Bytes before = tiny_bytes();
  const DnaHandle dna = open_dna(before);
  const DocumentHandle document = create_document(dna.get());
  size_t written = 0;
  for_each_field(document, "", [&](const std::string& path, const MienDnaField& field) {
    if (field.type == MIEN_FIELD_LIST || field.count == 0) return;
    if (field.type == MIEN_FIELD_STRING) {
      std::string text(field.count, '~');
      text[0] = static_cast<char>('A' + written % 26);
      const MienStatus status = write_string(document, path, text);
      if (status == MIEN_ERROR_INVALID_ARGUMENT) return;  // another name is the same
      EXPECT_EQ(status, MIEN_OK) << path;
      EXPECT_EQ(string_of(document, path), text) << path;
    } else if (field.type == MIEN_FIELD_F32) {
      std::vector<float> values = floats_of(document, path);
      values.back() += 0.25f;
      EXPECT_EQ(write_floats(document, path, values), MIEN_OK) << path;
      EXPECT_EQ(floats_of(document, path), values) << path;
    } else {
      std::vector<int64_t> values = integers_of(document, path);
      values.back() ^= 1;
      EXPECT_EQ(write_integers(document, path, values), MIEN_OK) << path;
      EXPECT_EQ(integers_of(document, path), values) << path;
    }
    ++written;
    // Without checks: most of these files are not valid.
    const dna::DnaView& view = document->document.view();
    const Bytes after = dna::written(view);
    ASSERT_EQ(after.size(), before.size()) << path;
    const auto [first, last] = differing(before, after);
    MienDnaField of_file = sized<MienDnaField>();
    ASSERT_EQ(mien_dna_field(dna.get(), path.c_str(), &of_file, nullptr), MIEN_OK);
    if (of_file.byte_offset != MIEN_NO_OFFSET) {
      EXPECT_GE(first, of_file.byte_offset) << path;
      EXPECT_LT(last, of_file.byte_offset + 4 * field.count) << path;
    } else {
      EXPECT_LT(last - first, 4u) << path;
    }
    ASSERT_EQ(mien_document_undo(document.get(), 0, nullptr), MIEN_OK);
    ASSERT_EQ(dna::written(view), before) << path;
  });
  EXPECT_GT(written, 150u);
}

TEST(Document, ResizesListsAndArrays) {
  const DocumentHandle document = document_of(tiny_bytes());
  EXPECT_EQ(resize(document, "desc.metadata", 3), MIEN_OK);
  EXPECT_EQ(write_string(document, "desc.metadata[2].key", "made"), MIEN_OK);
  EXPECT_EQ(write_string(document, "desc.metadata[2].value", "here"), MIEN_OK);
  EXPECT_EQ(field_of(document, "desc.metadata").count, 3u);
  const DnaHandle dna = dna_of(document);
  MienStringView text = {};
  ASSERT_EQ(mien_dna_read_string(dna.get(), "desc.metadata[2].value", &text, nullptr), MIEN_OK);
  EXPECT_EQ(std::string(text.data, text.count), "here");

  // In the middle, of an array.
  ASSERT_EQ(write_floats(document, "geom.meshes[0].positions.xs", {0, 1, 2, 3, 4, 5}), MIEN_OK);
  ASSERT_EQ(mien_document_splice(document.get(), "geom.meshes[0].positions.xs", 2, 3, 1, nullptr),
            MIEN_OK);
  EXPECT_EQ(floats_of(document, "geom.meshes[0].positions.xs"), (std::vector<float>{0, 1, 0, 5}));
  // And of a list of arrays.
  const std::string names = "defn.lodJointMapping.indices";
  const auto last = integers_of(document, names + "[1]");
  ASSERT_EQ(mien_document_splice(document.get(), names.c_str(), 0, 1, 2, nullptr), MIEN_OK);
  EXPECT_EQ(field_of(document, names).count, 3u);
  EXPECT_EQ(field_of(document, names + "[0]").count, 0u);
  EXPECT_EQ(integers_of(document, names + "[2]"), last);
  EXPECT_EQ(resize(document, names, 0), MIEN_OK);
  EXPECT_EQ(field_of(document, names).count, 0u);
}

TEST(Document, RefusesWhatDoesNotFit) {
  const DocumentHandle document = document_of(tiny_bytes());
  const Bytes before = bytes_of(document);
  MienError error = sized<MienError>();
  const auto expect = [&](MienStatus status, MienStatus wanted, const char* said) {
    EXPECT_EQ(status, wanted) << error.message;
    EXPECT_NE(std::string(error.message).find(said), std::string::npos) << error.message;
  };
  expect(write_floats(document, "desc.name", {1}, &error), MIEN_ERROR_INVALID_ARGUMENT,
         "desc.name holds a string, not floats");
  expect(write_floats(document, "desc.nane", {1}, &error), MIEN_ERROR_NAME, "nane");
  expect(
      write_floats(document, "bhvr.joints.jointGroups[0].values", std::vector<float>(999), &error),
      MIEN_ERROR_INDEX, "elements, not 999");
  expect(write_integers(document, "defn.jointHierarchy", {65536}, &error),
         MIEN_ERROR_INVALID_ARGUMENT, "integers from 0 to 65535, not 65536");
  expect(write_integers(document, "defn.jointHierarchy", {-1}, &error), MIEN_ERROR_INVALID_ARGUMENT,
         "-1");
  expect(write_integers(document, "defn", {1}, &error), MIEN_ERROR_INVALID_ARGUMENT, "a record");
  expect(write_string(document, "defn.jointNames[0]", "tongue", &error),
         MIEN_ERROR_INVALID_ARGUMENT, "element 2 is already named \"tongue\"");
  expect(write_string(document, "defn.jointNames[3]", "x", &error), MIEN_ERROR_INDEX,
         "past the end");
  expect(write_string(document, "defn.jointNames", "x", &error), MIEN_ERROR_INVALID_ARGUMENT,
         "a list");
  expect(resize(document, "desc.name", 1, &error), MIEN_ERROR_INVALID_ARGUMENT, "a string");
  expect(resize(document, "defn.jointHierarchy[0]", 1, &error), MIEN_ERROR_INVALID_ARGUMENT,
         "integers");
  expect(mien_document_splice(document.get(), "defn.jointNames", 2, 2, 0, &error), MIEN_ERROR_INDEX,
         "3 elements");
  expect(mien_document_splice(document.get(), "defn.jointNames", 0, 0, UINT64_MAX, &error),
         MIEN_ERROR_INVALID_ARGUMENT, "2^32 - 1");
  expect(mien_document_undo(document.get(), 7, &error), MIEN_ERROR_INDEX, "mark 7");
  expect(mien_document_write_floats(document.get(), nullptr, 0, 0, nullptr, &error),
         MIEN_ERROR_NULL_ARGUMENT, "path");
  expect(mien_document_write_floats(document.get(), "desc", 0, 1, nullptr, &error),
         MIEN_ERROR_NULL_ARGUMENT, "values");
  expect(mien_document_write_floats(nullptr, "desc", 0, 0, nullptr, &error),
         MIEN_ERROR_NULL_ARGUMENT, "document");
  EXPECT_EQ(write_string(document, "defn.jointNames[2]", "tongue"), MIEN_OK) << "its own name";
  EXPECT_EQ(bytes_of(document), before);
}

TEST(Document, ThatIsNoValidFileSaysWhatIsWrong) {
  const DocumentHandle document = document_of(tiny_bytes());
  ASSERT_EQ(resize(document, "defn.jointNames", 2), MIEN_OK);
  std::string message;
  EXPECT_FALSE(dna_of(document, MIEN_ERROR_DNA_REFERENCE, &message));
  EXPECT_NE(message.find("joint"), std::string::npos) << message;
  MienReport* report = nullptr;
  ASSERT_EQ(mien_document_validate(document.get(), nullptr, &report, nullptr), MIEN_OK);
  uint32_t errors = 0, warnings = 0;
  ASSERT_EQ(mien_report_counts(report, &errors, &warnings), MIEN_OK);
  EXPECT_GT(errors, 1u);
  mien_report_destroy(report);
}

TEST(Document, GoesBackToMarks) {
  const DocumentHandle document = document_of(tiny_bytes());
  Random random(3, 1);
  std::vector<std::pair<uint64_t, Bytes>> marks = {{0, bytes_of(document)}};
  const std::string values = "bhvr.joints.jointGroups[0].values";
  const size_t count = field_of(document, values).count;
  for (int step = 0; step < 200; ++step) {
    const uint32_t what = random.below(6);
    if (what == 0) {
      uint64_t mark = 0;
      ASSERT_EQ(mien_document_mark(document.get(), &mark, nullptr), MIEN_OK);
      marks.emplace_back(mark, bytes_of(document));
    } else if (what == 1) {
      const size_t to = random.below(static_cast<uint32_t>(marks.size()));
      ASSERT_EQ(mien_document_undo(document.get(), marks[to].first, nullptr), MIEN_OK);
      ASSERT_EQ(bytes_of(document), marks[to].second) << step;
      for (size_t gone = to + 1; gone < marks.size(); ++gone) {
        EXPECT_EQ(mien_document_undo(document.get(), marks[gone].first, nullptr), MIEN_ERROR_INDEX);
      }
      marks.resize(to + 1);
    } else if (what == 2) {
      EXPECT_EQ(write_string(document, "defn.jointNames[1]", "joint" + std::to_string(step)),
                MIEN_OK);
    } else if (what == 3) {
      EXPECT_EQ(resize(document, "desc.metadata", random.below(5)), MIEN_OK);
    } else {
      const float value = static_cast<float>(step);
      EXPECT_EQ(mien_document_write_floats(document.get(), values.c_str(),
                                           random.below(static_cast<uint32_t>(count)), 1, &value,
                                           nullptr),
                MIEN_OK);
    }
  }
}

TEST(Document, WritesInPlaceWhatNoMarkHasSeen) {
  CountingAllocator memory;
  const MienAllocator allocator = memory.get();
  {
    const DnaHandle dna = generate_dna(MIEN_PRESET_SMALL, 1);
    const DocumentHandle document = create_document(dna.get(), &allocator);
    const size_t count = field_of(document, "geom.meshes[0].skinWeights").count;
    const auto write_all = [&](float value) {
      for (size_t v = 0; v < count; ++v) {
        const std::string path = "geom.meshes[0].skinWeights[" + std::to_string(v) + "].weights";
        ASSERT_EQ(mien_document_write_floats(document.get(), path.c_str(), 0, 1, &value, nullptr),
                  MIEN_OK);
      }
    };
    write_all(0.5f);
    const size_t once = memory.bytes;
    for (int i = 0; i < 10; ++i) write_all(0.25f);
    EXPECT_EQ(memory.bytes, once);
    uint64_t mark = 0;
    ASSERT_EQ(mien_document_mark(document.get(), &mark, nullptr), MIEN_OK);
    write_all(0.125f);
    EXPECT_GT(memory.bytes, once);
    ASSERT_EQ(mien_document_undo(document.get(), mark, nullptr), MIEN_OK);
    EXPECT_EQ(floats_of(document, "geom.meshes[0].skinWeights[0].weights")[0], 0.25f);
  }
  EXPECT_TRUE(memory.clean()) << memory.first_wrong;
}

TEST(Document, IsAsItWasWhenMemoryRunsOut) {
  const Bytes bytes = tiny_bytes();
  CountingAllocator memory;
  const MienAllocator allocator = memory.get();
  {
    const DocumentHandle document = document_of(bytes, &allocator);
    // Lists and arrays above the least that is requested at a time.
    const std::function<MienStatus()> calls[] = {
        [&] { return write_string(document, "desc.name", std::string(100000, 'x')); },
        [&] { return resize(document, "desc.metadata", 5000); },
        [&] { return resize(document, "geom.meshes[0].positions.xs", 50000); },
        [&] {
          return write_floats(document, "geom.meshes[0].positions.xs", {1, 2, 3});
        },
        [&] {
          uint64_t mark;
          return mien_document_mark(document.get(), &mark, nullptr);
        },
    };
    for (const auto& call : calls) {
      for (size_t k = 1;; ++k) {
        memory.restart();
        memory.fail_at = k;
        const MienStatus status = call();
        memory.fail_at = 0;
        if (memory.failed == 0) {
          EXPECT_EQ(status, MIEN_OK);
          EXPECT_GT(k, 1u);
          break;
        }
        EXPECT_EQ(status, MIEN_ERROR_MEMORY);
        ASSERT_EQ(bytes_of(document), bytes);
      }
      ASSERT_EQ(mien_document_undo(document.get(), 0, nullptr), MIEN_OK);
      ASSERT_EQ(bytes_of(document), bytes);
    }
  }
  EXPECT_TRUE(memory.clean()) << memory.first_wrong;
}

TEST(Document, RefusesOtherHandles) {
  const DnaHandle dna = open_dna(tiny_bytes());
  MienDocument* wrong = reinterpret_cast<MienDocument*>(dna.get());
  uint64_t mark = 5;
  EXPECT_EQ(mien_document_mark(wrong, &mark, nullptr), MIEN_ERROR_HANDLE);
  EXPECT_EQ(mark, 0u);
  EXPECT_EQ(mien_document_resize(wrong, "desc.metadata", 1, nullptr), MIEN_ERROR_HANDLE);
  mien_document_destroy(wrong);
  mien_document_destroy(nullptr);
  MienDocument* made = nullptr;
  EXPECT_NE(mien_document_create(reinterpret_cast<const MienDna*>(&mark), nullptr, &made, nullptr),
            MIEN_OK);
  EXPECT_EQ(made, nullptr);
}

}  // namespace
}  // namespace mien
