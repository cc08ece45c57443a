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

using AuthorMesh = Sized<MienAuthorMesh>;
using AuthorDesc = Sized<MienAuthorDesc>;

/// What was found and measured while a rig was made.
class AuthorReport : public Owner<MienAuthorReport, mien_author_report_close> {
 public:
  using Owner::Owner;

  Result<std::string_view> json() const {
    MienStringView text = {nullptr, 0};
    const MienStatus status = mien_author_report_json(get(), &text);
    return {status, view(text)};
  }
};

/// A rig from a mesh. `report` may be null; if the call fails it is left empty.
inline Result<Dna> author_rig(const AuthorMesh& mesh, const AuthorDesc& desc = {},
                              AuthorReport* report = nullptr) {
  MienAuthorReport* made = nullptr;
  Result<Dna> dna = make<Dna>([&](MienDna** out, MienError* error) {
    return mien_author_rig(&mesh, &desc, out, report ? &made : nullptr, error);
  });
  if (report) *report = AuthorReport(made);
  return dna;
}

}  // namespace MIEN_CPP_NAMESPACE
}  // namespace mien
