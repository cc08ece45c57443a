// SPDX-License-Identifier: MIT
#include "integrations/program/reduce/reduce.h"

#include <algorithm>
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
  Character original(dna, exact, MIEN_STORAGE_32_BIT, 0, options.shown);
  Reduced reduced;
  reduced.tolerances = options.tolerances;
  find_regions(original, reduced.tolerances);
  Pruning pruning(dna, original, reduced.tolerances);
  const auto measure = [&](double limit) {
    reduced.dna = pruning.prune(reduced.limits);
    Character character(reduced.dna.get(), desc, reduced.deformer_storage, reduced.delta_error,
                        options.shown);
    reduced.proof = prove(original, character, reduced.tolerances, limit, options.performances);
    reduced.after = sizes_of(character, pruning);
    reduced.rig = std::move(character.rig);
    reduced.deformer = std::move(character.deformer);
    return reduced.proof.share <= limit;
  };
  // The best one first; the error of deltas as a share of the tolerance.
  constexpr struct {
    uint32_t rig, deformer;
    double delta_error;
  } kStorages[] = {{MIEN_STORAGE_16_BIT, MIEN_STORAGE_16_BIT, 0.25},
                   {MIEN_STORAGE_16_BIT, MIEN_STORAGE_16_BIT, 0.125},
                   {MIEN_STORAGE_16_BIT, MIEN_STORAGE_16_BIT, 0.0625},
                   {MIEN_STORAGE_16_BIT, MIEN_STORAGE_16_BIT, 0},
                   {MIEN_STORAGE_32_BIT, MIEN_STORAGE_16_BIT, 0},
                   {MIEN_STORAGE_32_BIT, MIEN_STORAGE_32_BIT, 0}};
  for (const auto& storage : kStorages) {
    desc.storage = std::max(storage.rig, options.rig.storage);
    reduced.deformer_storage = storage.deformer;
    reduced.delta_error = storage.delta_error * reduced.tolerances.least();
    if (measure(kOfStorage)) break;
  }
  reduced.storage = desc.storage;
  reduced.before = {original.rig_bytes(), original.deformer_bytes(), pruning.matrix_entries,
                    pruning.deltas, pruning.influences};
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

std::string reduction_text(const Reduced& reduced, const std::string& unit) {
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
  const auto bits = [](uint32_t storage) { return storage == MIEN_STORAGE_16_BIT ? 16 : 32; };
  add("Reduced, with %d-bit storage of the rig and %d-bit storage of the deformer\n",
      bits(reduced.storage), bits(reduced.deformer_storage));
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
        reduced.tolerances.at(lod, 0));
  }
  for (size_t r = 1; r < reduced.proof.regions.size(); ++r) {
    const RegionProof& of = reduced.proof.regions[r];
    const Region& region = reduced.tolerances.regions[r - 1];
    add("  region %.60s: at most %.3g at LOD %u; tolerance %.3g\n", region.pattern.c_str(),
        of.worst, of.lod, region.tolerance);
  }
  return text + "  worst pose: " + reduced.proof.worst_pose + "\n";
}

std::string reduction_json(const Reduced& reduced, const std::string& unit) {
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
  const auto name = [](uint32_t storage) { return storage == MIEN_STORAGE_16_BIT ? "f16" : "f32"; };
  root["storage"] = name(reduced.storage);
  root["deformer_storage"] = name(reduced.deformer_storage);
  root["delta_error"] = reduced.delta_error;
  root["limits"] = {{"matrix", reduced.limits.matrix}, {"deformer", reduced.limits.deformer}};
  root["before"] = sizes(reduced.before);
  root["after"] = sizes(reduced.after);
  root["poses"] = reduced.proof.pose_count;
  root["worst_pose"] = reduced.proof.worst_pose;
  root["lods"] = ReduceJson::array();
  for (uint32_t lod = 0; lod < reduced.proof.lods.size(); ++lod) {
    const LodProof& of = reduced.proof.lods[lod];
    root["lods"].push_back({{"tolerance", reduced.tolerances.at(lod, 0)},
                            {"worst", of.worst},
                            {"rms", of.rms},
                            {"pose", of.pose},
                            {"mesh", of.mesh},
                            {"position", of.position}});
  }
  root["regions"] = ReduceJson::array();
  for (size_t r = 1; r < reduced.proof.regions.size(); ++r) {
    const RegionProof& of = reduced.proof.regions[r];
    const Region& region = reduced.tolerances.regions[r - 1];
    root["regions"].push_back({{"names", region.pattern},
                               {"tolerance", region.tolerance},
                               {"worst", of.worst},
                               {"worst_pose", of.shown_pose},
                               {"lod", of.lod},
                               {"mesh", of.mesh},
                               {"position", of.position}});
  }
  return root.dump(1, ' ', false, ReduceJson::error_handler_t::replace) + "\n";
}

}  // namespace mien::cli
