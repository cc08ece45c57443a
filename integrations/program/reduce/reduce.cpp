// SPDX-License-Identifier: MIT
#include "integrations/program/reduce/reduce.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace mien::cli {

namespace {

/// Four limits for each power of two, from 4 down.
constexpr int kSteps = 63;
double limit_of(int step) { return step == kSteps ? 0 : 4 * std::exp2(-0.25 * step); }

/// The first step, which is the largest limit, that `holds`. Later steps hold, too; the last one is known to.
template <class Holds>
int first_that_holds(const Holds& holds) {
  int fails = -1, good = kSteps;
  while (good - fails > 1) {
    const int step = (fails + good) / 2;
    (holds(step) ? good : fails) = step;
  }
  return good;
}

Sizes sizes_of(const Character& character, const Pruning& pruning) {
  return {character.rig_bytes(), character.deformer_bytes(), pruning.matrix_entries, pruning.deltas,
          pruning.influences};
}

}  // namespace

Reduced reduce_rig(const MienDna* dna, const ReduceOptions& options) {
  constexpr double kOfStorage = 0.5, kOfDeformer = 0.5;  // the share that each may take
  MienRigDesc exact = options.rig, desc = options.rig;
  exact.storage = MIEN_STORAGE_32_BIT;
  desc.storage = MIEN_STORAGE_16_BIT;
  Character original(dna, exact, options.shown);
  Pruning pruning(dna, original, options.tolerances);
  Reduced reduced;
  const auto measure = [&](double limit) {
    reduced.dna = pruning.prune(reduced.limits);
    Character character(reduced.dna.get(), desc, options.shown);
    reduced.proof = prove(original, character, options.tolerances, limit);
    reduced.after = sizes_of(character, pruning);
    reduced.rig = std::move(character.rig);
    reduced.deformer = std::move(character.deformer);
    return reduced.proof.share <= limit;
  };
  measure(kOfStorage);
  reduced.before = {original.rig_bytes(), original.deformer_bytes(), pruning.matrix_entries,
                    pruning.deltas, pruning.influences};
  if (reduced.proof.share > kOfStorage && options.rig.storage == MIEN_STORAGE_32_BIT) {
    desc.storage = MIEN_STORAGE_32_BIT;
  }
  reduced.storage = desc.storage;
  reduced.limits.deformer = limit_of(first_that_holds([&](int step) {
    reduced.limits = {0, limit_of(step)};
    return measure(kOfDeformer);
  }));
  const double deformer = reduced.limits.deformer;
  reduced.limits.matrix = limit_of(first_that_holds([&](int step) {
    reduced.limits = {limit_of(step), deformer};
    return measure(1);
  }));
  measure(INFINITY);  // the whole proof of what was found
  return reduced;
}

std::string reduction_text(const Reduced& reduced, const std::vector<double>& tolerances,
                           const std::string& unit) {
  std::string text;
  const auto add = [&text](const char* format, auto... values) {
    char line[256];
    std::snprintf(line, sizeof(line), format, values...);
    text += line;
  };
  const auto row = [&add](const char* name, uint64_t before, uint64_t after) {
    const double share =
        before ? 100.0 * static_cast<double>(after) / static_cast<double>(before) : 100.0;
    add("  %-22s %12llu -> %12llu  (%.1f %%)\n", name, static_cast<unsigned long long>(before),
        static_cast<unsigned long long>(after), share);
  };
  add("Reduced, %s storage\n", reduced.storage == MIEN_STORAGE_16_BIT ? "16-bit" : "32-bit");
  row("bytes of the rig", reduced.before.rig_bytes, reduced.after.rig_bytes);
  row("bytes of the deformer", reduced.before.deformer_bytes, reduced.after.deformer_bytes);
  row("matrix entries not 0", reduced.before.matrix_entries, reduced.after.matrix_entries);
  row("blend shape deltas", reduced.before.deltas, reduced.after.deltas);
  row("skin weights", reduced.before.influences, reduced.after.influences);
  add("Distance of positions from the original in %zu poses, in %s\n", reduced.proof.pose_count,
      unit.c_str());
  for (uint32_t lod = 0; lod < reduced.proof.lods.size(); ++lod) {
    const LodProof& of = reduced.proof.lods[lod];
    add("  LOD %u: at most %.3g, rms %.3g; tolerance %.3g\n", lod, of.worst, of.rms,
        tolerance_at(tolerances, lod));
  }
  return text + "  worst pose: " + reduced.proof.worst_pose + "\n";
}

std::string reduction_json(const Reduced& reduced, const std::vector<double>& tolerances,
                           const std::string& unit) {
  using ReduceJson = nlohmann::ordered_json;
  const auto sizes = [](const Sizes& of) {
    return ReduceJson{{"rig_bytes", of.rig_bytes},
                      {"deformer_bytes", of.deformer_bytes},
                      {"matrix_entries", of.matrix_entries},
                      {"deltas", of.deltas},
                      {"skin_weights", of.influences}};
  };
  ReduceJson root;
  root["unit"] = unit;
  root["storage"] = reduced.storage == MIEN_STORAGE_16_BIT ? "f16" : "f32";
  root["limits"] = {{"matrix", reduced.limits.matrix}, {"deformer", reduced.limits.deformer}};
  root["before"] = sizes(reduced.before);
  root["after"] = sizes(reduced.after);
  root["poses"] = reduced.proof.pose_count;
  root["worst_pose"] = reduced.proof.worst_pose;
  root["lods"] = ReduceJson::array();
  for (uint32_t lod = 0; lod < reduced.proof.lods.size(); ++lod) {
    const LodProof& of = reduced.proof.lods[lod];
    root["lods"].push_back({{"tolerance", tolerance_at(tolerances, lod)},
                            {"worst", of.worst},
                            {"rms", of.rms},
                            {"pose", of.pose},
                            {"mesh", of.mesh},
                            {"position", of.position}});
  }
  return root.dump(1, ' ', false, ReduceJson::error_handler_t::replace) + "\n";
}

}  // namespace mien::cli
