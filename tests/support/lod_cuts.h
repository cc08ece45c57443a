// SPDX-License-Identifier: MIT
// Files with several LODs, and all that is worth keeping of them.
#pragma once

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "tests/support/bytes.h"
#include "tests/support/golden.h"
#include "tests/support/long_run.h"
#include "tests/support/rig_handles.h"
#include "tests/support/tiny_rig.h"

namespace mien {

/// A file of every kind that is to be had.
struct Source {
  std::string name;
  Bytes bytes;
};

inline std::vector<Source> generated_sources() {
  std::vector<Source> sources;
  for (uint32_t preset = MIEN_PRESET_TINY; preset <= largest_preset(); ++preset) {
    sources.push_back(
        {"preset " + std::to_string(preset), write_dna(generate_dna(preset, 5).get())});
  }
  Arena arena(default_allocator());
  sources.push_back({"tiny_rig", write_view(dna::tiny_rig(arena))});
  return sources;
}

inline std::vector<Source> golden_sources() {
  std::vector<Source> sources;
  for (const std::string& name : golden::present_names()) {
    sources.push_back({name, golden::read_rig(name)});
  }
  return sources;
}

/// Each LOD alone, ranges from either end and in the middle, and lists with gaps; never all.
inline std::vector<uint64_t> masks_for(uint32_t lod_count) {
  const uint64_t all = (uint64_t{1} << lod_count) - 1;
  std::set<uint64_t> masks;
  for (uint32_t l = 0; l < lod_count; ++l) masks.insert(uint64_t{1} << l);
  masks.insert(all >> 1);                  // but the coarsest
  masks.insert(all & ~uint64_t{1});        // but the finest
  masks.insert(all & 0x6);                 // 1, 2
  masks.insert(all & 0x5555555555555555);  // every other
  masks.insert(all & 0xAAAAAAAAAAAAAAAA);
  masks.insert(all & (0x8 | 0x1));
  masks.erase(all);
  masks.erase(0);
  return {masks.begin(), masks.end()};
}

inline std::vector<uint32_t> lods_of(uint64_t mask) {
  std::vector<uint32_t> lods;
  for (uint32_t l = 0; l < 64; ++l) {
    if (mask >> l & 1) lods.push_back(l);
  }
  return lods;
}

/// Calls f(dna, mask, cut) for every source and mask: the whole file and what is left of it, with
/// both views into the same bytes.
template <class F>
void for_each_cut(const std::vector<Source>& sources, F&& f) {
  size_t cuts = 0;
  for (const Source& source : sources) {
    SCOPED_TRACE(source.name);
    const DnaHandle whole = open_dna(source.bytes);
    ASSERT_TRUE(whole);
    for (uint64_t mask : masks_for(whole->view.desc.lod_count)) {
      SCOPED_TRACE("LODs " + testing::PrintToString(lods_of(mask)));
      const DnaHandle cut = open_dna(source.bytes, mask);
      ASSERT_TRUE(cut);
      f(*whole, mask, *cut);
      if (testing::Test::HasFatalFailure()) return;
      ++cuts;
    }
  }
  EXPECT_GT(cuts, sources.size()) << "files of one LOD show nothing";
}

}  // namespace mien
