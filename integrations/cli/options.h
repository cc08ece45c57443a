// SPDX-License-Identifier: MIT
// Options that several commands have, and the words that options take.
#pragma once

#include <string>
#include <vector>

#include "integrations/cli/cli.h"

namespace mien::cli {

/// --layers, --max-lod, --min-lod, --lods, --system, --rotation-order as they were typed.
struct LoadOptions {
  std::string layers, max_lod, min_lod, lods, system, rotation_order;
};

/// --isa, --storage, --rotation, --ml-masks as they were typed.
struct RigOptions {
  std::string isa, storage = "f32", rotation = "euler", ml_masks = "switch";
};

void add_load_options(CLI::App& app, LoadOptions& options);
/// Without --isa for what serves all of them.
void add_rig_options(CLI::App& app, RigOptions& options, bool with_isa = true);

using Words = std::vector<std::string>;

/// The words that an option takes: what parsing accepts and completion scripts offer. Empty for
/// options that take something else.
const Words& option_words(const std::string& option);

/// Index of `word` among the words of `option`, else a wrong usage that names the nearest.
size_t parse_word(const std::string& option, const std::string& word);

/// The same for a list with commas.
std::vector<size_t> parse_words(const std::string& option, const std::string& list);

/// Coordinate systems that have names, as the library lists them.
const Words& system_names();

/// The first of them with the axes, units and winding of a file; "" if there is none.
std::string name_of_system(const MienDnaInfo& info);

/// A decimal number of `option`, at most `largest`.
uint64_t parse_number(const std::string& option, const std::string& word, uint64_t largest);

/// `default_layers` holds if no layers were named.
MienDnaDesc parse_load_options(const LoadOptions& options, uint32_t default_layers);

/// A command that evaluates has to load behavior.
void require_behavior(const MienDnaDesc& desc);

/// Refuses instruction sets that this machine does not have.
MienRigDesc parse_rig_options(const RigOptions& options);

/// All that evaluation needs, and no geometry.
constexpr uint32_t kEvaluationLayers =
    MIEN_LAYER_DESCRIPTOR | MIEN_LAYER_DEFINITION | MIEN_LAYER_BEHAVIOR |
    MIEN_LAYER_MACHINE_LEARNED_BEHAVIOR | MIEN_LAYER_RBF_BEHAVIOR |
    MIEN_LAYER_JOINT_BEHAVIOR_METADATA | MIEN_LAYER_TWIST_SWING_BEHAVIOR;

// A mask of LODs has a bit for each up to this one; files have at most 33.
constexpr uint64_t kLastMaskLod = 63;

}  // namespace mien::cli
