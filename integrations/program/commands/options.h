// SPDX-License-Identifier: MIT
// Options that several commands have, and the words that options take.
#pragma once

#include <string>
#include <vector>

#include "integrations/program/commands/commands.h"
#include "integrations/program/io/output.h"
#include "integrations/program/io/rig_file.h"

namespace mien::cli {

/// --layers, --max-lod, --min-lod, --lods, --system, --rotation-order as they were typed.
struct LoadOptions {
  std::string layers, max_lod, min_lod, lods, system, rotation_order;
};

/// --isa, --storage, --rotation, --ml-masks, --arithmetic as they were typed.
struct RigOptions {
  std::string isa, storage = "f32", rotation = "euler", ml_masks = "switch", arithmetic = "fast";
};

void add_load_options(CLI::App& app, LoadOptions& options);
/// `with_isa`: with --isa. Baked files serve all instruction sets.
void add_rig_options(CLI::App& app, RigOptions& options, bool with_isa = true);

using Words = std::vector<std::string>;

/// Of all subcommands.
Words command_names(const CLI::App& app);

/// The words that an option takes: parsing accepts and completion offers these. Empty for options
/// that take something else.
const Words& option_words(const std::string& option);

/// Index of `word` among the words of `option`. Wrong usage if there is none, with the nearest word.
size_t parse_word(const std::string& option, const std::string& word);

/// The same for a list separated by commas.
std::vector<size_t> parse_words(const std::string& option, const std::string& list);

/// Centimeters in a unit, a word of --unit.
double parse_unit(const std::string& word);

/// Names of coordinate systems, as the library lists them.
const Words& system_names();

/// The first of them that has the axes, units and winding of a file; "" if none has.
std::string name_of_system(const MienDnaInfo& info);

/// A decimal number, at most `largest`. `option` is for the message.
uint64_t parse_number(const std::string& option, const std::string& word, uint64_t largest);

/// Wrong usage for what no file has: a LOD from kMaxLods on. "all" is for the caller, and for the message
/// if `or_all`.
uint32_t parse_lod(const std::string& word, bool or_all);

/// "0,2-4": bits 0, 2, 3 and 4.
uint64_t parse_lod_list(const std::string& list);

/// Wrong usage if no system has the name.
MienCoordinateSystem parse_system(const std::string& name);

/// -o and --force.
CLI::Option* add_output_options(CLI::App& app, OutputFile& output, const std::string& text,
                                const std::string& type_name = "OUT");

/// `default_layers` apply if no layers were named.
MienDnaDesc parse_load_options(const LoadOptions& options, uint32_t default_layers);

/// Wrong usage if the layers to load leave out behavior.
void require_behavior(const MienDnaDesc& desc);

/// Wrong usage if this machine does not have the instruction set.
MienRigDesc parse_rig_options(const RigOptions& options);

/// The word of --arithmetic that a rig was made with.
const std::string& arithmetic_word(const MienRigInfo& info);

}  // namespace mien::cli
