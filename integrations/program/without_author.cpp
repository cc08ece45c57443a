// SPDX-License-Identifier: MIT
// For a build without libmien-author: `mien gen`, `mien demo-head`, `mien author`,
// `mien edit`, `mien solve` and landmarks of `mien play` say so.
#include <mien_author.h>

#include <cstring>

#include "integrations/program/commands/commands.h"
#include "integrations/program/commands/solve.h"
#include "integrations/program/commands/solve_live.h"
#include "integrations/program/reduce/reduce.h"

namespace {

MienStatus fail_unsupported(MienError* error, const char* message) {
  error->status = MIEN_ERROR_UNSUPPORTED;
  error->byte_offset = MIEN_NO_OFFSET;
  std::strncpy(error->message, message, sizeof(error->message) - 1);
  return MIEN_ERROR_UNSUPPORTED;
}

}  // namespace

MienStatus mien_dna_generate(const MienGenerateDesc*, MienDna** out_dna, MienError* error) {
  *out_dna = nullptr;
  return fail_unsupported(
      error, "this build of mien has no generator (MIEN_BUILD_COMPILER=OFF): use a full build");
}

MienStatus mien_author_rig(const MienAuthorMesh*, const MienAuthorDesc*, MienDna** out_dna,
                           MienAuthorReport** out_report, MienError* error) {
  *out_dna = nullptr;
  *out_report = nullptr;
  return fail_unsupported(
      error, "this build of mien makes no rigs (MIEN_BUILD_COMPILER=OFF): use a full build");
}

MienStatus mien_author_report_json(const MienAuthorReport*, MienStringView* out_json) {
  *out_json = {};
  return MIEN_ERROR_UNSUPPORTED;
}

void mien_author_report_close(MienAuthorReport*) {}

namespace mien::cli {

Command add_solve_command(CLI::App& app, const Session&) {
  CLI::App* solve = app.add_subcommand("solve", "Find controls (not in this build)");
  solve->allow_extras();
  return {solve, [] {
            fail(kUsage, "mien solve", "",
                 "this build of mien cannot solve (MIEN_BUILD_COMPILER=OFF)", "use a full build");
          }};
}

void solve_file(const SolveCommand&, const Session&) {
  fail(kUsage, "mien solve", "", "this build of mien cannot solve (MIEN_BUILD_COMPILER=OFF)",
       "use a full build");
}

void check_landmark_options(const LandmarkOptions&) {
  fail(kUsage, "mien play --live landmarks", "",
       "this build of mien cannot solve (MIEN_BUILD_COMPILER=OFF)", "use a full build");
}

live::LandmarkSolver open_landmark_solver(const LandmarkOptions&, bool, const MienRig*,
                                          const MienDeformer*, const std::string&) {
  return {};
}

Reduced reduce_rig(const MienDna*, const ReduceOptions&) {
  fail(kUsage, "mien bake --tolerance", "",
       "this build of mien cannot reduce rigs (MIEN_BUILD_COMPILER=OFF)", "use a full build");
}
std::string reduction_text(const Reduced&, const std::string&) { return {}; }
std::string reduction_json(const Reduced&, const std::string&) { return {}; }

Command add_edit_command(CLI::App& app, const Session&) {
  CLI::App* edit = app.add_subcommand("edit", "Change a DNA file (not in this build)");
  edit->allow_extras();
  return {edit, [] {
            fail(kUsage, "mien edit", "",
                 "this build of mien cannot change DNA files "
                 "(MIEN_BUILD_COMPILER=OFF)",
                 "use a full build");
          }};
}

}  // namespace mien::cli
