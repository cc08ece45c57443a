// SPDX-License-Identifier: MIT
#include "integrations/program/commands/edit_options.h"

#include <algorithm>
#include <set>

#include "integrations/program/commands/edit_values.h"
#include "integrations/program/commands/options.h"
#include "integrations/program/io/dna_fields.h"
#include "integrations/program/io/input.h"
#include "integrations/program/io/json_check.h"
#include "integrations/program/io/nearest_name.h"

namespace mien::cli {

namespace {

std::string apply_rename(Document& document, const std::string& value) {
  const char* const form = "KIND:OLD=NEW";
  const NamePair kind_and_names = split_pair(document, value, ':', form);
  const NamePair names = split_pair(document, kind_and_names.second, '=', form);
  const uint32_t kind = kind_named(document, kind_and_names.first);
  const uint32_t index = find_element(document, kind, names.first);
  edited(document, mien_document_rename, kind, index, names.second.c_str());
  return std::string("renamed ") + kind_noun(kind) + " \"" + names.first + "\" to \"" +
         names.second + "\"";
}

/// The quaternion joints that a removal gave joint groups of their own, behind the others; see
/// mien_document_remove().
std::string regrouped_text(const Document& document, uint64_t groups_before) {
  const std::string groups = "bhvr.joints.jointGroups";
  const uint64_t count = field_count(document, groups);
  std::set<std::string> names;
  for (uint64_t g = groups_before; g < count; ++g) {
    const std::string path = groups + "[" + std::to_string(g) + "].jointIndices";
    for (const int64_t joint : read_integers(document, path)) {
      names.insert("\"" + read_string(document, "defn.jointNames[" + std::to_string(joint) + "]") +
                   "\"");
    }
  }
  if (names.empty()) return "";
  return "; to keep the order of rotations, joint groups of their own (within 0.01 degrees) for " +
         list_of({names.begin(), names.end()}, "and");
}

std::string apply_remove(Document& document, const std::string& value) {
  const NamePair pair = split_pair(document, value, ':', "KIND:NAME");
  const uint32_t kind = kind_named(document, pair.first);
  const uint32_t index = find_element(document, kind, pair.second);
  const uint64_t groups = field_count(document, "bhvr.joints.jointGroups");
  edited(document, mien_document_remove, kind, &index, 1);
  return std::string("removed ") + kind_noun(kind) + " \"" + pair.second + "\"" +
         regrouped_text(document, groups);
}

std::string apply_clear(Document& document, const std::string& value) {
  const std::string animation = "joint-animation";
  if (value.compare(0, animation.size() + 1, animation + ":") == 0) {
    const std::string name = value.substr(animation.size() + 1);
    const uint32_t joint = find_element(document, MIEN_KIND_JOINT, name);
    edited(document, mien_document_clear_joints, &joint, 1);
    return "removed what moves joint \"" + name + "\"";
  }
  static const Words words = {"blend-shapes", "animated-maps", animation};
  constexpr uint32_t kKinds[] = {MIEN_KIND_BLEND_SHAPE_CHANNEL, MIEN_KIND_ANIMATED_MAP,
                                 MIEN_KIND_JOINT};
  for (size_t i = 0; i < words.size(); ++i) {
    if (words[i] != value) continue;
    edited(document, mien_document_clear, kKinds[i]);
    return "removed all " + (i == 2 ? "that moves joints" : value);
  }
  fail_edit_value(document, "\"" + value + "\" is not one of " + list_of(words, "and"),
                  nearest_question(value, words, "or write joint-animation:NAME"));
}

std::string apply_neutral(Document& document, const std::string& value) {
  const char* const form = "JOINT:tx,ty,tz or JOINT:tx,ty,tz,rx,ry,rz";
  const NamePair pair = split_pair(document, value, ':', form, true);
  const std::vector<double> numbers = parse_list(document, pair.second);
  if (numbers.size() != 3 && numbers.size() != 6) {
    fail_edit_value(document, "expected 3 or 6 numbers, not " + std::to_string(numbers.size()),
                    std::string("write ") + form);
  }
  const std::vector<float> transform(numbers.begin(), numbers.end());
  const uint32_t joint = find_element(document, MIEN_KIND_JOINT, pair.first);
  edited(document, mien_document_set_neutral, joint, transform.data(),
         numbers.size() == 6 ? transform.data() + 3 : nullptr, 1);
  return "moved joint \"" + pair.first + "\"";
}

void apply_placement(const Document& document, const MienPlacement& placement) {
  edited(document, mien_document_place, &placement);
}

std::string apply_scale(Document& document, const std::string& value) {
  auto placement = sized<MienPlacement>();
  placement.scale = parse_list_of(document, value, 1, "one number")[0];
  if (placement.scale <= 0) fail_edit_value(document, "a scale is above 0", "write 2, or 0.01");
  apply_placement(document, placement);
  return "scaled by " + value;
}

std::string apply_translate(Document& document, const std::string& value) {
  auto placement = sized<MienPlacement>();
  const std::vector<double> numbers = parse_list_of(document, value, 3, "x,y,z");
  std::copy(numbers.begin(), numbers.end(), placement.translation);
  apply_placement(document, placement);
  return "moved by " + value;
}

std::string apply_rotate(Document& document, const std::string& value) {
  auto placement = sized<MienPlacement>();
  const std::vector<double> numbers = parse_list_of(document, value, 3, "x,y,z, in degrees");
  std::copy(numbers.begin(), numbers.end(), placement.rotation);
  apply_placement(document, placement);
  return "rotated by " + value + " degrees";
}

std::string apply_lods(Document& document, const std::string& value) {
  const uint64_t lods = parse_lod_list(value);
  edited(document, mien_document_keep_lods, lods);
  return "kept LODs " + value;
}

std::string apply_system(Document& document, const std::string& value) {
  const MienCoordinateSystem system = parse_system(value);
  edited(document, mien_document_convert, &system);
  return "converted to the units and axes of " + value;
}

std::string apply_name(Document& document, const std::string& value) {
  edited(document, mien_document_write_string, "desc.name", value.data(), value.size());
  return "named \"" + value + "\"";
}

void write_metadata(const Document& document, uint64_t index, const char* member,
                    const std::string& text) {
  edited(document, mien_document_write_string, element("desc.metadata", index, member).c_str(),
         text.data(), text.size());
}

std::string apply_metadata(Document& document, const std::string& value) {
  const size_t equals = value.find('=');
  if (equals == std::string::npos || equals == 0) {
    fail_edit_value(document, "this is not KEY=VALUE",
                    "write KEY=VALUE, or KEY= for an empty value");
  }
  const std::string key = value.substr(0, equals);
  const uint64_t count = field_count(document, "desc.metadata");
  uint64_t index = 0;
  while (index < count && read_string(document, element("desc.metadata", index, ".key")) != key) {
    ++index;
  }
  if (index == count) {
    edited(document, mien_document_resize, "desc.metadata", count + 1);
    write_metadata(document, index, ".key", key);
  }
  write_metadata(document, index, ".value", value.substr(equals + 1));
  return "set metadata \"" + key + "\"";
}

std::string apply_version(Document& document, const std::string& value) {
  document.version = 1 + static_cast<uint32_t>(parse_word("--version", value));
  return "version " + value;
}

const EditOption* find_edit_option(const std::string& name) {
  for (const EditOption& option : edit_options()) {
    if (name == option.name) return &option;
  }
  return nullptr;
}

}  // namespace

const std::vector<EditOption>& edit_options() {
  static const std::vector<EditOption> options = [] {
    const char* const kNames = "Names and parts";
    const char* const kPlaces = "Places";
    std::vector<EditOption> all = {
        {"--rename", "KIND:OLD=NEW", kNames,
         "KIND: joint, mesh, blend-shape, animated-map, raw, gui, ml or rbf", apply_rename},
        {"--remove", "KIND:NAME", kNames,
         "KIND: joint, mesh, blend-shape, animated-map, raw, gui, psd (psd0, psd1, ...), ml, rbf. "
         "What\n"
         "refers to it is removed, too; children of a joint go to its parent and keep their place",
         apply_remove},
        {"--clear", "WHAT", kNames,
         "blend-shapes (channels too), animated-maps, joint-animation, or\njoint-animation:NAME "
         "for "
         "one joint",
         apply_clear},
        {"--lods", "LIST", kNames, "Keep only these LODs, such as 2-7; renumbered from 0",
         apply_lods},
        {"--name", "NAME", kNames, "Name of the character", apply_name},
        {"--metadata", "KEY=VALUE", kNames, "Add or replace a pair of the descriptor",
         apply_metadata},
        {"--version", "V", kNames, "Version to write, 2.1 to 2.8 (default: that of IN)",
         apply_version},
        {"--neutral", "JOINT:NUMBERS", kPlaces,
         "tx,ty,tz or tx,ty,tz,rx,ry,rz: neutral transform relative to the parent", apply_neutral},
        {"--scale", "F", kPlaces, "Scale the whole character about the origin", apply_scale},
        {"--rotate", "X,Y,Z", kPlaces,
         "Rotate the whole character about the origin: right-handed degrees about x, then y, then "
         "z",
         apply_rotate},
        {"--translate", "X,Y,Z", kPlaces, "Move the whole character", apply_translate},
        {"--system", "NAME", kPlaces,
         "Convert to the units, axes and winding of an engine or tool, as 'mien convert'",
         apply_system},
    };
    for (const auto& group : {mesh_edit_options(), other_file_edit_options()})
      all.insert(all.end(), group.begin(), group.end());
    return all;
  }();
  return options;
}

std::vector<Edit> join_options(const std::vector<Edit>& edits) {
  std::vector<Edit> joined;
  std::string before;  // the option before
  size_t used = 0;
  for (const Edit& edit : edits) {
    const bool follows = edit.option == "--from" || edit.option == "--match";
    const char* const wanted = edit.option == "--match" ? "--from" : "--make-lod";
    if (follows ? before != wanted : before == "--make-lod") break;
    if (follows) {
      joined.back().value += " " + edit.option + " " + edit.value;
    } else {
      joined.push_back(edit);
    }
    before = edit.option;
    ++used;
  }
  if (before == "--make-lod" || used != edits.size()) {
    fail_usage("--make-lod", "--make-lod, --from and --match go together, in this order",
               "write --make-lod 3 --from 0");
  }
  return joined;
}

std::vector<std::string> apply_edits(Document& document, const std::vector<Edit>& edits) {
  std::vector<std::string> done;
  for (const Edit& edit : edits) {
    document.edit = edit.option + " " + edit.value;
    try {
      done.push_back(find_edit_option(edit.option)->apply(document, edit.value));
    } catch (const Failure& failure) {
      if (edit.script.empty() || failure.exit_code != kUsage) throw;
      throw Failure(kInvalid, "invalid script, " + edit.script + ": " + failure.what());
    }
  }
  return done;
}

std::vector<Edit> read_edit_script(const std::string& path) {
  const char* const example = "write [[\"--rename\", \"joint:a=b\"], [\"--scale\", \"2\"]]";
  const char* const what = "invalid script";
  const auto script =
      parse_json<nlohmann::json>(read_text(path, "cannot read script"), what, path, example);
  if (!script.is_array()) fail(kInvalid, what, path, "this is not a list of commands", example);
  std::vector<Edit> edits;
  for (size_t i = 0; i < script.size(); ++i) {
    const auto& words = script[i];
    const std::string where = path + ", command " + std::to_string(i);
    bool valid = words.is_array() && !words.empty() && words.size() % 2 == 0;
    for (size_t k = 0; valid && k < words.size(); ++k) {
      valid = words[k].is_string() && !words[k].get_ref<const std::string&>().empty();
    }
    if (!valid) fail(kInvalid, what, where, "not an option and its value, as strings", example);
    for (size_t k = 0; k < words.size(); k += 2) {
      if (find_edit_option(words[k]) == nullptr) {
        Words names;
        for (const EditOption& option : edit_options()) names.emplace_back(option.name);
        fail(kInvalid, what, where, "there is no edit " + words[k].dump(),
             nearest_question(words[k].get<std::string>(), names, "see 'mien help edit'"));
      }
      edits.push_back({words[k], words[k + 1], path});
    }
  }
  try {
    return join_options(edits);
  } catch (const Failure& failure) {
    throw Failure(kInvalid, std::string(what) + ", " + path + ": " + failure.what());
  }
}

}  // namespace mien::cli
