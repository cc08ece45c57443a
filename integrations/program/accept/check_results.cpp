// SPDX-License-Identifier: MIT
#include "integrations/program/accept/check_results.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "integrations/program/io/dna_streams.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

constexpr char kCannotCheck[] = "cannot check rig";
// Columns of joints represented by quaternions may change their order (docs/numbers.md).
constexpr double kSubset = 1e-4;

/// For each element of the subset its index in the whole, by name.
std::vector<uint32_t> places_in(const MienRig* whole, const MienRig* subset, uint32_t kind) {
  std::vector<uint32_t> places(rig_count(subset, kind));
  for (uint32_t i = 0; i < places.size(); ++i) {
    const std::string name = rig_name(subset, kind, i);
    check(mien_rig_find_n(whole, kind, name.data(), name.size(), &places[i]), nullptr, kCannotCheck,
          "");
  }
  return places;
}

/// The largest difference between values of the subset and those of the whole.
double largest_difference(const std::vector<float>& subset, const std::vector<float>& whole,
                          const std::vector<uint32_t>& places, size_t width) {
  double most = 0;
  for (size_t i = 0; i < places.size(); ++i) {
    for (size_t k = 0; k < width; ++k) {
      const double off = std::fabs(double{subset[i * width + k]} - whole[places[i] * width + k]);
      most = off >= 0 ? std::max(most, off) : HUGE_VAL;
    }
  }
  return most;
}

size_t first_difference(const std::string& a, const std::string& b) {
  const size_t count = std::min(a.size(), b.size());
  return static_cast<size_t>(std::mismatch(a.begin(), a.begin() + count, b.begin()).first -
                             a.begin());
}

}  // namespace

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.2g", value);
  return text;
}

Check check_subsets(const AcceptedRig& rig, const std::string& path, const Session& session) {
  if (path == "-") return skipped_check("subsets", "standard input can be read once");
  Check check{"subsets", true, false, ""};
  double most = 0;
  uint32_t worst_lod = 0;
  for (uint32_t lod = 0; lod < rig.lod_count(); ++lod) {
    auto desc = sized<MienDnaDesc>();
    desc.lods = uint64_t{1} << lod;
    const RigFile file = open_rig_file(path, desc, session);
    const Rig subset = create_rig(file, sized<MienRigDesc>());
    const auto joints = places_in(rig.rig.get(), subset.get(), MIEN_KIND_JOINT);
    const auto channels = places_in(rig.rig.get(), subset.get(), MIEN_KIND_BLEND_SHAPE_CHANNEL);
    const auto maps = places_in(rig.rig.get(), subset.get(), MIEN_KIND_ANIMATED_MAP);
    for (const std::vector<float>& raw : rig.poses) {
      const Results mine = evaluate_fresh(subset.get(), raw, 0);
      const Results whole = evaluate_fresh(rig.rig.get(), raw, lod);
      const double off = std::max({largest_difference(mine.joints, whole.joints, joints, 9),
                                   largest_difference(mine.channels, whole.channels, channels, 1),
                                   largest_difference(mine.maps, whole.maps, maps, 1)});
      if (off <= most) continue;
      most = off;
      worst_lod = lod;
    }
  }
  check.passed = most <= kSubset;
  check.detail = "each of " + std::to_string(rig.lod_count()) + " LODs opened alone: ";
  check.detail +=
      most == 0 ? "the same bits"
                : "off by " + short_number(most) + " at most, at LOD " + std::to_string(worst_lod);
  return check;
}

Check check_bake(const AcceptedRig& rig) {
  size_t size = 0;
  auto error = sized<MienError>();
  check(mien_bake_memory(rig.rig.get(), nullptr, nullptr, 0, &size, &error), &error, kCannotCheck,
        "");
  std::string bytes(size, '\0');
  check(mien_bake_memory(rig.rig.get(), nullptr, bytes.data(), size, &size, &error), &error,
        kCannotCheck, "");
  auto desc = sized<MienBakedDesc>();
  desc.file_access = MIEN_FILE_READ;  // aligned, as the string need not be
  desc.check = MIEN_BAKED_CHECK_FULL;
  MienBaked* opened = nullptr;
  check(mien_baked_open_memory(bytes.data(), bytes.size(), &desc, &opened, &error), &error,
        kCannotCheck, "");
  const Baked baked(opened);
  MienRig* made = nullptr;
  const auto rig_desc = sized<MienBakedRigDesc>();
  check(mien_rig_from_baked(opened, &rig_desc, &made, &error), &error, kCannotCheck, "");
  const Rig again(made);
  Check check{"bake", true, false, ""};
  check.detail = "baked to " + size_text(bytes.size()) + " and opened: the same bits";
  for (uint32_t lod = 0; lod < rig.lod_count() && check.passed; ++lod) {
    for (size_t p = 0; p < rig.poses.size() && check.passed; ++p) {
      if (same_bits(evaluate_fresh(rig.rig.get(), rig.poses[p], lod),
                    evaluate_fresh(made, rig.poses[p], lod))) {
        continue;
      }
      check.passed = false;
      check.detail =
          "results differ at LOD " + std::to_string(lod) + " in pose " + std::to_string(p);
    }
  }
  return check;
}

Check check_round_trip(const AcceptedRig& rig, const std::string& path) {
  size_t size = 0;
  auto error = sized<MienError>();
  check(mien_dna_write_memory(rig.file.dna.get(), nullptr, nullptr, 0, &size, &error), &error,
        kCannotCheck, rig.file.shown);
  std::string written(size, '\0');
  check(mien_dna_write_memory(rig.file.dna.get(), nullptr, written.data(), size, &size, &error),
        &error, kCannotCheck, rig.file.shown);
  // What is inside of another file was read to memory.
  std::string original = rig.file.bytes;
  if (original.empty()) {
    FileBytes file(path);
    original = file.read(0, file.size());
  }
  Check check{"round trip", written == original, false, ""};
  if (check.passed) {
    check.detail = "written again: the same " + grouped(written.size()) + " bytes";
  } else {
    check.detail = "written again: " + grouped(written.size()) + " bytes in place of " +
                   grouped(original.size()) + "; the first difference is at byte " +
                   std::to_string(first_difference(written, original));
  }
  return check;
}

}  // namespace mien::cli
