// SPDX-License-Identifier: MIT
//
// What makes DNA files, over mien_author.h: link libmien-author too. Everything said in mien.hpp
// holds here.
#pragma once

#include <mien_author.h>

#include <mien.hpp>

namespace mien {
inline namespace MIEN_CPP_NAMESPACE {

using GenerateDesc = Sized<MienGenerateDesc>;

/// A synthetic rig of a preset: tiny by default. The same seed gives the same bytes everywhere.
inline Result<Dna> generate(const GenerateDesc& desc = {}) {
  return make<Dna>(
      [&](MienDna** out, MienError* error) { return mien_dna_generate(&desc, out, error); });
}

}  // namespace MIEN_CPP_NAMESPACE
}  // namespace mien
