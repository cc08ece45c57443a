// SPDX-License-Identifier: MIT
// Half meshes of the generated head.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <utility>

#include "author/generate/head/mesh.h"

namespace mien {

/// A part at every LOD, made once for all tests of a program.
inline const head::PartLods& head_lods(head::Part part, uint64_t seed = 0) {
  struct Made {
    Arena arena{default_allocator()};
    head::PartLods lods{arena};
  };
  static std::map<std::pair<head::Part, uint64_t>, std::unique_ptr<Made>> all;
  std::unique_ptr<Made>& made = all[{part, seed}];
  if (!made) {
    made = std::make_unique<Made>();
    EXPECT_TRUE(head::make_lods(head::Form(head::make_person(seed)), part, default_allocator(),
                                made->lods));
  }
  return made->lods;
}

}  // namespace mien
