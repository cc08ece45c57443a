// SPDX-License-Identifier: MIT
#include "integrations/program/commands/options.h"

#include <algorithm>
#include <charconv>

#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

struct OptionWords {
  const char* option;
  Words words;
};

// The order counts: the enums of mien.h follow it, and so do tables of the commands.
const OptionWords kOptionWords[] = {
    {"--layers",
     {"descriptor", "definition", "behavior", "geometry", "geometry-without-blend-shapes", "ml",
      "rbf", "joint-metadata", "twist-swing", "all"}},
    {"--isa", {"scalar", "sse2", "avx2", "avx512", "neon"}},
    {"--storage", {"f32", "f16"}},
    {"--rotation", {"euler", "quaternion"}},
    {"--ml-masks", {"switch", "blend"}},
    {"--arithmetic", {"fast", "portable"}},
    {"--preset",
     {"tiny", "small", "medium", "large", "body", "metahuman-head", "metahuman-body", "archetype"}},
    {"author --preset", {"metahuman"}},
    {"--version", {"2.1", "2.2", "2.3", "2.4", "2.5", "2.6", "2.7", "2.8"}},
    {"--unknown", {"keep", "drop"}},
    {"--format", {"glb", "obj", "vrm", "usda"}},
    {"eval --format", {"json", "jsonl", "csv", "npy"}},
    {"--mouth-close", {"alone", "jaw"}},
    {"--influences", {"1", "2", "4", "8", "12"}},
    {"--rotation-order", {"carried", "exact", "per-column"}},
    {"--names",
     {"gui", "raw", "ml", "rbf", "joints", "channels", "maps", "meshes", "regions", "solvers",
      "poses", "all"}},
    {"--camera",
     {"front", "three-quarter", "three-quarter-right", "side", "side-right", "back", "above",
      "below"}},
    {"--background", {"dark", "light"}},
    {"--samples", {"1", "4", "16"}},
    {"--target", {"face", "eyes", "mouth"}},
    {"--loop", {"clamp", "wrap"}},
    {"solve --place-landmarks", {"68", "mediapipe"}},
    {"solve --kind", {"vertices", "joints", "landmarks3", "landmarks2", "weights", "surface"}},
    {"--engine", {"local", "dask", "mpi", "slurm", "opencue", "deadline", "openjd", "flamenco"}},
    {"--symmetry", {"auto", "on", "off"}},
    {"--residual", {"targets", "off"}},
    {"--metric", {"depth", "euclid3"}},
    {"--unit", {"cm", "m", "mm", "dm", "in"}},
    {"--up", {"x", "y", "z", "-x", "-y", "-z"}},
    {"--front", {"x", "y", "z", "-x", "-y", "-z"}},
    {"SHELL", {"bash", "zsh", "fish"}},
};

// Geometry whose blend shape targets stay in the file. No bit of the library's.
constexpr uint32_t kGeometryWithoutTargets = 1u << 31;

// In the order of the words of --layers.
constexpr uint32_t kLayerBits[] = {
    MIEN_LAYER_DESCRIPTOR,
    MIEN_LAYER_DEFINITION,
    MIEN_LAYER_BEHAVIOR,
    MIEN_LAYER_GEOMETRY,
    kGeometryWithoutTargets,
    MIEN_LAYER_MACHINE_LEARNED_BEHAVIOR,
    MIEN_LAYER_RBF_BEHAVIOR,
    MIEN_LAYER_JOINT_BEHAVIOR_METADATA,
    MIEN_LAYER_TWIST_SWING_BEHAVIOR,
    MIEN_LAYER_ALL,
};

/// Sets the fields of `desc` that --layers is about.
void parse_layers(const std::string& list, MienDnaDesc& desc) {
  for (const size_t word : parse_words("--layers", list)) desc.layers |= kLayerBits[word];
  if (!(desc.layers & kGeometryWithoutTargets)) return;
  if (desc.layers & MIEN_LAYER_GEOMETRY) {
    fail_usage("--layers " + list, "asks for geometry both with and without blend shapes",
               "name one of the two");
  }
  desc.layers ^= kGeometryWithoutTargets | MIEN_LAYER_GEOMETRY;
  desc.skip_blend_shape_targets = 1;
}

/// Bits first ... last. Numbers past the mask are of LODs that no file has.
uint64_t lod_range(uint64_t first, uint64_t last) {
  uint64_t mask = 0;
  for (uint64_t lod = first; lod <= std::min(last, kLastMaskLod); ++lod) mask |= uint64_t{1} << lod;
  return mask;
}

[[noreturn]] void fail_lod(const std::string& option) {
  fail_usage(option,
             "LOD " + std::to_string(kMaxLods - 1) + " is the last that a DNA file can have",
             "see 'mien info' for the LODs that a file has");
}

uint64_t parse_lods(const LoadOptions& options) {
  if (!options.lods.empty()) return parse_lod_list(options.lods);
  if (!options.max_lod.empty() || !options.min_lod.empty()) {
    const uint64_t finest =
        options.max_lod.empty() ? 0 : parse_number("--max-lod", options.max_lod, 65535);
    if (finest >= kMaxLods) fail_lod("--max-lod " + options.max_lod);
    const uint64_t coarsest =
        options.min_lod.empty() ? 65535 : parse_number("--min-lod", options.min_lod, 65535);
    if (coarsest < finest) {
      fail_usage("--max-lod " + options.max_lod + " --min-lod " + options.min_lod,
                 "nothing is between them", "--max-lod is the finest LOD, the smaller number");
    }
    return lod_range(finest, coarsest);
  }
  return 0;
}

MienCoordinateSystem system_named(const std::string& name) {
  auto system = sized<MienCoordinateSystem>();
  check(mien_coordinate_system_find(name.c_str(), &system), nullptr,
        "cannot find coordinate system " + name, "");
  return system;
}

/// One for each name and rotation order, so that descriptions can point to them.
const MienCoordinateSystem* find_system(const LoadOptions& options) {
  const size_t rules = option_words("--rotation-order").size();
  static const std::vector<MienCoordinateSystem> systems = [rules] {
    std::vector<MienCoordinateSystem> all;
    for (const std::string& name : system_names()) {
      for (uint32_t rule = MIEN_ROTATION_RULE_CARRIED; rule < rules; ++rule) {
        all.push_back(system_named(name));
        all.back().rotation_rule = rule;
      }
    }
    return all;
  }();
  const bool has_order = !options.rotation_order.empty();
  const size_t rule = has_order ? parse_word("--rotation-order", options.rotation_order) : 0;
  if (options.system.empty()) {
    if (has_order) {
      fail_usage("--rotation-order", "the order of rotations only changes with the system",
                 "name one with --system");
    }
    return nullptr;
  }
  return &systems[parse_word("--system", options.system) * rules + rule];
}

}  // namespace

double parse_unit(const std::string& word) {
  constexpr double kCentimeters[] = {1, 100, 0.1, 10, 2.54};
  return kCentimeters[parse_word("--unit", word)];
}

uint64_t parse_lod_list(const std::string& list) {
  uint64_t mask = 0;
  for (const std::string& word : split_at_commas(list)) {
    const size_t dash = word.find('-', 1);
    const uint64_t first = parse_number("--lods", word.substr(0, dash), 65535);
    if (first >= kMaxLods) fail_lod("--lods " + list);
    const uint64_t last =
        dash == std::string::npos ? first : parse_number("--lods", word.substr(dash + 1), 65535);
    if (last < first) {
      fail_usage("--lods " + list, "a range goes from the finest LOD, the smaller number, up",
                 "write " + std::to_string(last) + "-" + std::to_string(first));
    }
    mask |= lod_range(first, last);
  }
  return mask;
}

MienCoordinateSystem parse_system(const std::string& name) {
  return system_named(system_names()[parse_word("--system", name)]);
}

const Words& system_names() {
  static const Words names = [] {
    Words all;
    MienStringView name;
    while (mien_coordinate_system_name(static_cast<uint32_t>(all.size()), &name) == MIEN_OK) {
      all.push_back(to_string(name));
    }
    return all;
  }();
  return names;
}

std::string name_of_system(const MienDnaInfo& info) {
  for (const std::string& name : system_names()) {
    const MienCoordinateSystem system = system_named(name);
    if (std::equal(info.axes, info.axes + 3, system.axes) &&
        info.translation_unit == system.translation_unit &&
        info.rotation_unit == system.rotation_unit && info.face_winding == system.face_winding) {
      return name;
    }
  }
  return "";
}

Words command_names(const CLI::App& app) {
  Words names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
  }
  return names;
}

const Words& option_words(const std::string& option) {
  static const Words none;
  if (option == "--system") return system_names();
  for (const OptionWords& entry : kOptionWords) {
    if (option == entry.option) return entry.words;
  }
  return none;
}

void add_load_options(CLI::App& app, LoadOptions& options) {
  const std::string group = "What to load";
  app.add_option("--layers", options.layers,
                 "Layers to load, separated by commas; layers that they need are loaded too:\n"
                 "descriptor, definition, behavior, geometry,\n"
                 "geometry-without-blend-shapes, ml, rbf, joint-metadata,\n"
                 "twist-swing or all")
      ->type_name("LIST")
      ->group(group);
  app.add_option("--max-lod", options.max_lod, "Finest LOD to load: the smaller number")
      ->type_name("N")
      ->group(group);
  app.add_option("--min-lod", options.min_lod, "Coarsest LOD to load: the larger number")
      ->type_name("N")
      ->group(group);
  app.add_option(
         "--lods", options.lods,
         "Only these LODs, such as 0,2-4; overrides --max-lod and --min-lod.\nLoaded LODs are "
         "renumbered from 0")
      ->type_name("LIST")
      ->group(group);
  app.add_option("--system", options.system,
                 "Convert to the axes, units and winding of:\n" + list_of(system_names(), "or") +
                     "\n(default: those of the file)")
      ->type_name("NAME")
      ->group(group);
  app.add_option(
         "--rotation-order", options.rotation_order,
         "Order of Euler angles with --system: carried (default; the file's order,\nwith axes "
         "renamed), exact (the system's; refused if sums of angles\ncannot be converted exactly) "
         "or per-column")
      ->type_name("RULE")
      ->group(group);
}

void add_rig_options(CLI::App& app, RigOptions& options, bool with_isa) {
  const std::string group = "How to evaluate";
  if (with_isa) {
    app.add_option("--isa", options.isa,
                   "Instruction set: " + list_of(option_words("--isa"), "or") +
                       "\n(default: $MIEN_ISA, otherwise the best of this machine)")
        ->type_name("NAME")
        ->group(group);
  }
  app.add_option("--storage", options.storage,
                 "Storage of matrices and weights: f32, or f16 (half the memory, about 3 digits)")
      ->type_name("TYPE")
      ->group(group);
  app.add_option("--rotation", options.rotation,
                 "Joint rotations: euler (9 values per joint) or quaternion (10)")
      ->type_name("TYPE")
      ->group(group);
  app.add_option("--ml-masks", options.ml_masks,
                 "Masks of machine-learned behavior: switch (0 is off) or blend (0 to 1)")
      ->type_name("TYPE")
      ->group(group);
  app.add_option("--arithmetic", options.arithmetic,
                 "fast, or portable: the same bits on every instruction set")
      ->type_name("TYPE")
      ->group(group);
}

size_t parse_word(const std::string& option, const std::string& word) {
  const Words& words = option_words(option);
  const auto found = std::find(words.begin(), words.end(), word);
  if (found != words.end()) return static_cast<size_t>(found - words.begin());
  fail_usage(option + " \"" + word + "\"", "not one of " + list_of(words, "and"),
             nearest_question(word, words, "choose one of them"));
}

std::vector<size_t> parse_words(const std::string& option, const std::string& list) {
  std::vector<size_t> indices;
  for (const std::string& word : split_at_commas(list)) indices.push_back(parse_word(option, word));
  return indices;
}

uint64_t parse_number(const std::string& option, const std::string& word, uint64_t largest) {
  uint64_t number = 0;
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, number);
  if (error == std::errc() && stop == end && number <= largest) return number;
  fail_usage(option + " \"" + word + "\"",
             "not a whole number from 0 to " + std::to_string(largest),
             "give one in decimal digits");
}

uint32_t parse_lod(const std::string& word, bool or_all) {
  uint64_t lod = 0;
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, lod);
  if (error == std::errc::invalid_argument || stop != end) {
    fail_usage(
        "--lod \"" + word + "\"", "this is not the number of a LOD",
        or_all ? nearest_question(word, {"all"}, "count from 0, or write all") : "count from 0");
  }
  if (error != std::errc() || lod >= kMaxLods) fail_lod("--lod " + word);
  return static_cast<uint32_t>(lod);
}

CLI::Option* add_output_options(CLI::App& app, OutputFile& output, const std::string& text,
                                const std::string& type_name) {
  app.add_flag("--force", output.force, "Replace even an input or a read-only file");
  return app.add_option("-o,--output", output.path, text)->type_name(type_name);
}

MienDnaDesc parse_load_options(const LoadOptions& options, uint32_t default_layers) {
  auto desc = sized<MienDnaDesc>();
  desc.layers = options.layers.empty() ? default_layers : 0;
  if (!options.layers.empty()) parse_layers(options.layers, desc);
  desc.lods = parse_lods(options);
  desc.system = find_system(options);
  return desc;
}

void require_behavior(const MienDnaDesc& desc) {
  const uint32_t brings_behavior = MIEN_LAYER_BEHAVIOR | MIEN_LAYER_RBF_BEHAVIOR;
  if (desc.layers == MIEN_LAYER_ALL || (desc.layers & brings_behavior)) return;
  fail_usage("--layers", "without behavior there is nothing to evaluate",
             "add behavior to the list");
}

const std::string& arithmetic_word(const MienRigInfo& info) {
  return option_words("--arithmetic")[info.arithmetic];
}

MienRigDesc parse_rig_options(const RigOptions& options) {
  auto desc = sized<MienRigDesc>();
  desc.rotation_output = static_cast<uint32_t>(parse_word("--rotation", options.rotation));
  desc.ml_masks = static_cast<uint32_t>(parse_word("--ml-masks", options.ml_masks));
  desc.storage = static_cast<uint32_t>(parse_word("--storage", options.storage));
  desc.arithmetic = static_cast<uint32_t>(parse_word("--arithmetic", options.arithmetic));
  desc.isa = MIEN_ISA_ENVIRONMENT;
  if (options.isa.empty()) return desc;
  desc.isa = MIEN_ISA_SCALAR + static_cast<uint32_t>(parse_word("--isa", options.isa));
  if (!mien_isa_available(desc.isa)) {
    fail_usage("--isa " + options.isa, "this machine, or this build, does not have it",
               "choose another, or leave it out for the best one");
  }
  return desc;
}

}  // namespace mien::cli
