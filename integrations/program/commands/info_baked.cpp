// SPDX-License-Identifier: MIT
#include "integrations/program/commands/info_baked.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "integrations/program/commands/options.h"
#include "integrations/program/io/json_writer.h"
#include "integrations/program/io/rig_file.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

struct KindWords {
  uint32_t kind;
  const char* key;   // in JSON, as in the description of a DNA file
  const char* text;  // for people
};
constexpr KindWords kKinds[] = {
    {MIEN_KIND_GUI_CONTROL, "gui_controls", "GUI controls"},
    {MIEN_KIND_RAW_CONTROL, "raw_controls", "raw controls"},
    {MIEN_KIND_PSD_CONTROL, "psd_controls", "PSD controls (correctives)"},
    {MIEN_KIND_ML_CONTROL, "ml_controls", "ML controls"},
    {MIEN_KIND_RBF_CONTROL, "rbf_controls", "RBF pose controls"},
    {MIEN_KIND_JOINT, "joints", "joints"},
    {MIEN_KIND_JOINT_GROUP, "joint_groups", "joint groups"},
    {MIEN_KIND_BLEND_SHAPE_CHANNEL, "blend_shape_channels", "blend shape channels"},
    {MIEN_KIND_ANIMATED_MAP, "animated_maps", "animated maps"},
    {MIEN_KIND_MESH, "meshes", "meshes"},
    {MIEN_KIND_ML_MASK, "ml_masks", "masks of mesh regions"},
    {MIEN_KIND_RBF_SOLVER, "rbf_solvers", "RBF solvers"},
    {MIEN_KIND_TWIST_SWING, "twists_and_swings", "twists and swings"},
};

using Numbers = std::vector<std::pair<const char*, uint64_t>>;

Numbers numbers_at(const MienRig* rig, uint32_t lod) {
  auto statistics = sized<MienRigStatistics>();
  check(mien_rig_statistics(rig, lod, &statistics), nullptr, "cannot examine rig", "");
  return {{"joints", statistics.joint_count},
          {"psd_controls", statistics.psd_count},
          {"joint_values", statistics.joint_row_count},
          {"matrix_entries", statistics.joint_entry_count},
          {"matrix_bytes", statistics.joint_byte_count},
          {"rbf_solvers", statistics.rbf_solver_count}};
}

const char* rotation_word(const MienRigInfo& info) {
  return info.rotation_output == MIEN_ROTATION_OUTPUT_QUATERNION ? "quaternion" : "euler";
}
const char* storage_word(const MienRigInfo& info) {
  return info.storage == MIEN_STORAGE_16_BIT ? "f16" : "f32";
}

void write_json(const BakedFile& file, const MienRigInfo& info, Output& output) {
  const MienRig* rig = file.rig.get();
  JsonWriter json(output);
  using Layout = JsonWriter::Layout;
  json.begin_object(Layout::kLines);
  json.member("file", file.shown);
  json.member("baked", true);
  json.member("rotation", rotation_word(info));
  json.member("storage", storage_word(info));
  json.member("arithmetic", arithmetic_word(info));
  json.member("lod_count", info.lod_count);
  json.key("counts");
  json.begin_object(Layout::kLines);
  for (const KindWords& words : kKinds) json.member(words.key, rig_count(rig, words.kind));
  json.end_object();
  json.key("lods");
  json.begin_array(Layout::kLines);
  for (uint32_t lod = 0; lod < info.lod_count; ++lod) {
    json.begin_object();
    json.member("lod", lod);
    for (const auto& [key, value] : numbers_at(rig, lod)) json.member(key, value);
    json.end_object();
  }
  json.end_array();
  json.key("rig");
  json.begin_object();
  json.member("isa", mien_isa_name(info.isa));
  json.member("rig_bytes", info.rig_bytes);
  json.member("instance_bytes", info.instance_bytes);
  json.end_object();
  json.end_object();
  json.finish();
}

std::string text_of(const BakedFile& file, const MienRigInfo& info, const Session& session) {
  const MienRig* rig = file.rig.get();
  const auto heading = [&](const std::string& text) {
    return paint(text, Style::kBold, session.terminal.out_colors) + "\n";
  };
  const auto line = [](std::string label, const std::string& value) {
    label.resize(std::max<size_t>(label.size(), 28), ' ');
    return "  " + label + value + "\n";
  };
  std::string text = heading(one_line(file.shown) + ": a baked file");
  text += line("rotations", rotation_word(info));
  text += line("storage", storage_word(info));
  text += line("arithmetic", arithmetic_word(info));
  text += line("size", size_text(info.rig_bytes) + ", " + size_text(info.instance_bytes) +
                           " per character, " + mien_isa_name(info.isa));
  text += line("LODs", std::to_string(info.lod_count));
  text += "\n" + heading("Counts");
  for (const KindWords& words : kKinds) {
    text += line(words.text, grouped(rig_count(rig, words.kind)));
  }
  text += "\n" + heading("Levels of detail");
  for (uint32_t lod = 0; lod < info.lod_count; ++lod) {
    std::string numbers;
    for (const auto& [key, value] : numbers_at(rig, lod)) {
      std::string words = key;
      for (char& c : words) c = c == '_' ? ' ' : c;
      numbers += (numbers.empty() ? "" : ", ") + grouped(value) + " " + words;
    }
    text += "  LOD " + std::to_string(lod) + ": " + numbers + "\n";
  }
  return text;
}

}  // namespace

void write_baked_info(const BakedFile& file, bool json, const Session& session) {
  const MienRigInfo info = rig_info(file.rig.get());
  Output output("-");
  if (json) {
    write_json(file, info, output);
  } else {
    output.write(text_of(file, info, session));
  }
  output.commit();
}

}  // namespace mien::cli
