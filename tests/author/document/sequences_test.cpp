// SPDX-License-Identifier: MIT
// Random sequences of operations, and operations that run out of memory.
#include <gtest/gtest.h>

#include <set>

#include "author/capi/document.h"
#include "tests/support/bytes.h"
#include "tests/support/dna_bytes.h"
#include "tests/support/document_edits.h"
#include "tests/support/tiny_rig.h"

namespace mien {
namespace {

/// As it is, valid or not.
Bytes raw_bytes(const DocumentHandle& document) {
  const dna::DnaView& view = document->document.view();
  return dna::written(view, view.version);
}

// After every operation the document is a valid file; at the end it evaluates, survives writing, and undoing gives
// every state back.
TEST(Sequences, OfFiftyOperationsGiveValidFilesAndAreUndone) {
  std::set<std::string> succeeded;
  const auto edits = document_edits();
  for (const char* rig : {"tiny", "small", "ml", "ml_ext", "tiny_v21", "small_rot"}) {
    const Bytes bytes = golden::read_rig(rig);
    const DocumentHandle other = document_of(golden::read_rig("small"));
    for (uint64_t seed = 1; seed <= 4; ++seed) {
      Random random(seed, 9);
      const DocumentHandle document = document_of(bytes);
      std::vector<std::pair<uint64_t, Bytes>> marks;
      for (int step = 0; step < 50; ++step) {
        const DocumentEdit& edit = edits[random.below(static_cast<uint32_t>(edits.size()))];
        SCOPED_TRACE(std::string(rig) + " " + std::to_string(seed) + "." + std::to_string(step) +
                     " " + edit.function);
        const Bytes before = raw_bytes(document);
        MienError error = sized<MienError>();
        const MienStatus status = edit.run(document.get(), other.get(), random, &error);
        if (status != MIEN_OK) {
          EXPECT_NE(status, MIEN_ERROR_MEMORY);
          EXPECT_NE(error.message[0], 0);
          ASSERT_EQ(raw_bytes(document), before) << error.message;
        } else {
          succeeded.insert(edit.function);
          ASSERT_TRUE(dna_of(document));
        }
        if (step % 10 == 5) {
          uint64_t mark = 0;
          ASSERT_EQ(mien_document_mark(document.get(), &mark, nullptr), MIEN_OK);
          marks.emplace_back(mark, raw_bytes(document));
        }
      }
      MienReport* report = nullptr;
      ASSERT_EQ(mien_document_validate(document.get(), nullptr, &report, nullptr), MIEN_OK);
      uint32_t errors = 0, warnings = 0;
      ASSERT_EQ(mien_report_counts(report, &errors, &warnings), MIEN_OK);
      EXPECT_EQ(errors, 0u);
      mien_report_destroy(report);
      const DnaHandle dna = dna_of(document);
      const RigHandle compiled = create_rig(dna.get());
      ASSERT_TRUE(compiled);
      Character character(compiled);
      for (float& value : character.raw) value = 0.5f;
      character.evaluate(0);
      const Bytes written = write_dna(dna.get());
      EXPECT_EQ(write_dna(open_dna(written).get()), written);
      while (!marks.empty()) {
        ASSERT_EQ(mien_document_undo(document.get(), marks.back().first, nullptr), MIEN_OK);
        ASSERT_EQ(raw_bytes(document), marks.back().second);
        marks.pop_back();
      }
      ASSERT_EQ(mien_document_undo(document.get(), 0, nullptr), MIEN_OK);
      ASSERT_EQ(bytes_of(document), bytes);
    }
  }
  std::set<std::string> all;
  for (const DocumentEdit& edit : edits) all.insert(edit.function);
  EXPECT_EQ(succeeded, all) << "operations that never succeeded";
}

TEST(Sequences, LeaveTheDocumentAsItWasWhenMemoryRunsOut) {
  const Bytes bytes = golden::read_rig("small");
  CountingAllocator memory;
  const MienAllocator allocator = memory.get();
  {
    const DocumentHandle document = document_of(bytes, &allocator);
    const DocumentHandle other = document_of(golden::read_rig("tiny"));
    const Bytes start = raw_bytes(document);
    for (const DocumentEdit& edit : document_edits()) {
      SCOPED_TRACE(edit.function);
      const size_t live = memory.live, size = memory.bytes;
      for (size_t k = 1;; ++k) {
        Random random(3, 4);
        memory.restart();
        memory.fail_at = k;
        MienError error = sized<MienError>();
        const MienStatus status = edit.run(document.get(), other.get(), random, &error);
        memory.fail_at = 0;
        if (memory.failed == 0) {
          EXPECT_TRUE(status != MIEN_OK || k > 1);
          break;
        }
        ASSERT_EQ(status, MIEN_ERROR_MEMORY) << k << error.message;
        ASSERT_EQ(raw_bytes(document), start) << k;
        // Field writes keep their memory for the next one.
        ASSERT_EQ(mien_document_undo(document.get(), 0, nullptr), MIEN_OK);
        ASSERT_EQ(memory.live, live) << k;
        ASSERT_EQ(memory.bytes, size) << k;
      }
      ASSERT_EQ(mien_document_undo(document.get(), 0, nullptr), MIEN_OK);
      ASSERT_EQ(raw_bytes(document), start);
    }
  }
  EXPECT_TRUE(memory.clean()) << memory.first_wrong;
}

}  // namespace
}  // namespace mien
