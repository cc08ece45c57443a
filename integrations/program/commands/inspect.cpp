// SPDX-License-Identifier: MIT
// mien inspect: what one control does, as text, as JSON and as a heat map.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "integrations/program/commands/render_output.h"
#include "integrations/program/io/json_writer.h"
#include "integrations/program/io/text.h"
#include "integrations/program/scene/camera_target.h"
#include "integrations/program/scene/heat_map.h"
#include "integrations/program/scene/influence.h"

namespace mien::cli {

namespace {

using math::Vec3;

struct InspectCommand {
  SceneArguments scene;
  RenderOutputOptions output;
  std::string control, value = "1";
  bool json = false;
};

constexpr size_t kListed = 12;         // lines of each kind in the text
constexpr float kLeastShare = 0.001f;  // of the largest value: less is not shown

/// How many rows from the first on matter; rows are sorted.
template <class T, class Matters>
size_t count_while(const std::vector<T>& rows, const Matters& matters) {
  const auto end =
      std::find_if(rows.begin(), rows.end(), [&](const T& row) { return !matters(row); });
  return static_cast<size_t>(end - rows.begin());
}

// Words for places and directions --------------------------------------------------------------

/// Components along left, up and front of the character.
Vec3 along_axes(const PosedScene& scene, Vec3 v) {
  return {dot(v, scene.axes.left), dot(v, scene.axes.up), dot(v, scene.axes.front)};
}

/// "up and front": the axes with large shares of a movement, the largest first.
std::string direction_words(Vec3 along) {
  struct Part {
    float amount;
    const char* word;
  };
  Part parts[] = {{std::fabs(along.x), along.x > 0 ? "left" : "right"},
                  {std::fabs(along.y), along.y > 0 ? "up" : "down"},
                  {std::fabs(along.z), along.z > 0 ? "front" : "back"}};
  std::stable_sort(std::begin(parts), std::end(parts),
                   [](const Part& a, const Part& b) { return a.amount > b.amount; });
  std::string words;
  for (const Part& part : parts) {
    if (part.amount <= 0 || part.amount < 0.4f * parts[0].amount) continue;
    words += (words.empty() ? "" : " and ") + std::string(part.word);
  }
  return words;
}

/// "left, upper third": where a place lies within the box around all meshes.
std::string place_words(const PosedScene& scene, Vec3 place) {
  const math::Box box = scene.neutral_box();
  const Vec3 half = box.size() * 0.5f;
  const Vec3 from_center = along_axes(scene, place - box.center());
  const Vec3 extent = along_axes(scene, half);
  const auto share = [](float x, float of) { return of != 0 ? x / std::fabs(of) : 0.0f; };
  const float across = share(from_center.x, extent.x), height = share(from_center.y, extent.y);
  const char* third = height > 1 / 3.0f ? "upper" : height < -1 / 3.0f ? "lower" : "middle";
  const char* side = across > 0.08f ? "left" : across < -0.08f ? "right" : "center";
  return std::string(side) + ", " + third + " third";
}

// Text -----------------------------------------------------------------------------------------

std::string number(float value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.4g", static_cast<double>(value));
  return text;
}

std::string padded(std::string text, size_t width) {
  if (text.size() < width) text.append(width - text.size(), ' ');
  return text;
}

std::string rotation_unit(const PosedScene& scene) {
  return scene.info.rotation_unit == MIEN_ROTATION_UNIT_RADIANS ? "rad" : "deg";
}

class Text {
 public:
  Text(const PosedScene& scene, const Session& session, Output& output)
      : scene_(scene), colors_(session.terminal.out_colors), output_(output) {}

  void write(const Influence& influence) {
    const bool gui = influence.control.kind == MIEN_KIND_GUI_CONTROL;
    line(paint(one_line(influence.control.name), Style::kBold, colors_) +
         (gui ? ": GUI control " : ": raw control ") + std::to_string(influence.control.index) +
         " = " + number(influence.value) + ", LOD " + std::to_string(scene_.lod) + " of " +
         one_line(scene_.shown));
    if (gui) values("Raw controls", influence.raw);
    joints(influence);
    values("Blend shape channels", influence.channels);
    values("Animated maps", influence.maps);
    if (!influence.ml.empty()) values("ML controls", influence.ml);
    if (!influence.rbf.empty()) values("RBF pose controls", influence.rbf);
    correctives(influence);
    meshes(influence);
  }

 private:
  void line(const std::string& text) { output_.write(text + "\n"); }

  void title(const std::string& name, size_t count, const std::string& what) {
    line("");
    line(paint(name, Style::kBold, colors_) + "  " + (count == 0 ? "none" : what));
  }

  /// `count` of `all` rows deserve a line.
  void rest(size_t count, size_t all) {
    const size_t listed = std::min(count, kListed);
    if (all == listed) return;
    const bool tiny = count <= kListed;
    line("  and " + grouped(all - listed) + (tiny ? " below a thousandth of these" : " more") +
         "; --json lists all");
  }

  void values(const std::string& name, const std::vector<ValueChange>& list) {
    title(name, list.size(), grouped(list.size()) + ", the largest first");
    const float least = list.empty() ? 0 : kLeastShare * std::fabs(list[0].value);
    const size_t count = count_while(
        list, [&](const ValueChange& change) { return std::fabs(change.value) >= least; });
    for (size_t i = 0; i < std::min(count, kListed); ++i) {
      line("  " + padded(one_line(list[i].name), 36) + " " + number(list[i].value));
    }
    rest(count, list.size());
  }

  void joints(const Influence& influence) {
    const auto& list = influence.joints;
    title("Joints", list.size(),
          grouped(list.size()) + " of " + grouped(rig_count(scene_.rig.get(), MIEN_KIND_JOINT)) +
              " move, the strongest first: by the sum of shares of the largest values");
    JointMotion most{};
    for (const JointMotion& joint : list) {
      most.translation = std::max(most.translation, joint.translation);
      most.rotation = std::max(most.rotation, joint.rotation);
      most.scale = std::max(most.scale, joint.scale);
    }
    const auto matters = [&](float value, float of) {
      return value != 0 && value >= kLeastShare * of;
    };
    const size_t count = count_while(list, [&](const JointMotion& joint) {
      return matters(joint.translation, most.translation) ||
             matters(joint.rotation, most.rotation) || matters(joint.scale, most.scale);
    });
    if (!list.empty()) {
      line("  " + padded("", 36) + " translation  rotation  scale");
    }
    for (size_t i = 0; i < std::min(count, kListed); ++i) {
      const JointMotion& joint = list[i];
      const auto cell = [&](float value, float of, const std::string& unit) {
        return matters(value, of) ? number(value) + unit : std::string("-");
      };
      line("  " + padded(one_line(joint.name), 36) + " " +
           padded(cell(joint.translation, most.translation, " " + scene_.unit()), 12) + " " +
           padded(cell(joint.rotation, most.rotation, " " + rotation_unit(scene_)), 13) + " " +
           cell(joint.scale, most.scale, ""));
    }
    rest(count, list.size());
  }

  void correctives(const Influence& influence) {
    const auto& list = influence.correctives;
    title("Correctives", list.size(),
          grouped(list.size()) + " with this control as an input, the strongest first");
    const std::string unit = scene_.unit();
    const float least = list.empty() ? 0 : kLeastShare * list[0].beyond_sum;
    const size_t count = count_while(list, [&](const Corrective& corrective) {
      return !corrective.reachable || corrective.beyond_sum >= least;
    });
    for (size_t i = 0; i < std::min(count, kListed); ++i) {
      const Corrective& c = list[i];
      std::string with;
      for (const std::string& partner : c.partners) {
        with += (with.empty() ? "with " : ", ") + one_line(short_name(partner));
      }
      if (c.partners.empty()) with = "alone";
      std::string effect = "not measured: an input is not a raw control";
      if (c.reachable) {
        effect = "value " + number(c.value_together) +
                 (c.partners.empty()  ? ""
                  : c.beyond_sum == 0 ? ", nothing beyond the sum of its inputs"
                                      : ", up to " + number(c.beyond_sum) + " " + unit +
                                            " beyond the sum of its inputs");
      }
      line("  " + padded("psd" + std::to_string(c.psd), 8) + " " + padded(with, 50) + " " + effect);
    }
    rest(count, list.size());
  }

  void meshes(const Influence& influence) {
    if (influence.meshes.empty()) {
      title("Meshes", 0, "");
      return;
    }
    title("Meshes", 1,
          "up to " + number(influence.max_distance()) + " " + scene_.unit() +
              ", in the order of the file");
    const std::string unit = " " + scene_.unit();
    for (const MeshMotion& motion : influence.meshes) {
      const std::string name = "  " + padded(one_line(motion.mesh->name), 36) + " ";
      if (motion.moved == 0) {
        line(name + "does not move");
        continue;
      }
      const float share = 100.0f * static_cast<float>(motion.moved) /
                          static_cast<float>(motion.mesh->neutral.position_count);
      const Vec3 size = motion.box.size();
      line(name + number(share) + " % of its positions, up to " + number(motion.max_distance) +
           unit + ", mostly " + direction_words(along_axes(scene_, motion.mean)));
      line("  " + padded("", 36) + " around " + place_words(scene_, motion.center) + "; box " +
           number(size.x) + " x " + number(size.y) + " x " + number(size.z) + unit + " at (" +
           number(motion.box.min.x) + ", " + number(motion.box.min.y) + ", " +
           number(motion.box.min.z) + ")");
    }
  }

  const PosedScene& scene_;
  bool colors_;
  Output& output_;
};

// JSON -----------------------------------------------------------------------------------------

void write_vector(JsonWriter& json, const char* key, Vec3 v) {
  const float values[3] = {v.x, v.y, v.z};
  json.key(key);
  json.floats(values, 3);
}

void write_float(JsonWriter& json, const char* key, float value) {
  json.key(key);
  json.shortest(static_cast<double>(value));
}

void write_values(JsonWriter& json, const char* key, const std::vector<ValueChange>& list) {
  json.key(key);
  json.begin_array(JsonWriter::Layout::kLines);
  for (const ValueChange& change : list) {
    json.begin_object();
    json.member("index", change.index);
    json.member("name", change.name);
    write_float(json, "value", change.value);
    json.end_object();
  }
  json.end_array();
}

void write_correctives(JsonWriter& json, const Influence& influence) {
  json.key("correctives");
  json.begin_array(JsonWriter::Layout::kLines);
  for (const Corrective& corrective : influence.correctives) {
    json.begin_object();
    json.member("index", corrective.psd);
    json.key("with");
    json.begin_array();
    for (const std::string& partner : corrective.partners) json.value(partner);
    json.end_array();
    write_float(json, "value_alone", corrective.value_alone);
    if (corrective.reachable) {
      write_float(json, "value_together", corrective.value_together);
      write_float(json, "beyond_sum", corrective.beyond_sum);
    }
    json.end_object();
  }
  json.end_array();
}

void write_meshes(JsonWriter& json, const Influence& influence, const PosedScene& scene) {
  json.key("meshes");
  json.begin_array(JsonWriter::Layout::kLines);
  for (const MeshMotion& motion : influence.meshes) {
    json.begin_object();
    json.member("name", motion.mesh->name);
    json.member("positions", motion.mesh->neutral.position_count);
    json.member("moved", motion.moved);
    if (motion.moved != 0) {
      write_float(json, "max_distance", motion.max_distance);
      json.member("max_position", motion.max_position);
      write_vector(json, "mean", motion.mean);
      json.member("direction", direction_words(along_axes(scene, motion.mean)));
      json.member("place", place_words(scene, motion.center));
      write_vector(json, "center", motion.center);
      write_vector(json, "box_min", motion.box.min);
      write_vector(json, "box_max", motion.box.max);
    }
    json.end_object();
  }
  json.end_array();
}

void write_json(const Influence& influence, const PosedScene& scene, Output& output) {
  JsonWriter json(output);
  json.begin_object(JsonWriter::Layout::kLines);
  json.member("rig", scene.shown);
  json.member("lod", scene.lod);
  json.member("control", influence.control.name);
  json.member("kind", influence.control.kind == MIEN_KIND_GUI_CONTROL ? "gui" : "raw");
  json.member("index", influence.control.index);
  write_float(json, "value", influence.value);
  json.member("translation_unit", scene.unit());
  json.member("rotation_unit", rotation_unit(scene));
  write_values(json, "raw", influence.raw);
  json.key("joints");
  json.begin_array(JsonWriter::Layout::kLines);
  for (const JointMotion& joint : influence.joints) {
    json.begin_object();
    json.member("index", joint.joint);
    json.member("name", joint.name);
    write_float(json, "translation", joint.translation);
    write_float(json, "rotation", joint.rotation);
    write_float(json, "scale", joint.scale);
    json.key("change");
    json.floats(joint.change, 9);
    json.end_object();
  }
  json.end_array();
  write_values(json, "channels", influence.channels);
  write_values(json, "maps", influence.maps);
  write_values(json, "ml", influence.ml);
  write_values(json, "rbf", influence.rbf);
  write_correctives(json, influence);
  write_meshes(json, influence, scene);
  json.end_object();
  json.finish();
}

void run(const InspectCommand& command, const Session& session) {
  const float value = parse_control_value("--value \"" + command.value + "\"", command.value);
  const RenderOutputOptions& output_options = command.output;
  PosedSceneOptions scene_options = parse_scene_options(command.scene);
  std::optional<render::View> view;  // with a heat map only
  render::RenderOptions render;
  if (!output_options.output.path.empty()) {
    if (output_options.output.path == "-") {
      fail_usage("-o -", "standard output is for the text", "name a file for the image");
    }
    require_png_name(output_options.output.path);
    refuse_replacing(output_options.output, {command.scene.rig});
    view = parse_camera(output_options.camera);
    render = parse_render_options(output_options, parse_size(output_options.size, {480, 480}));
  }
  scene_options.geometry_optional = !view;

  PosedScene scene = open_scene(scene_options, session);
  const Control control =
      find_control(scene.rig.get(), command.control, "cannot inspect", scene.shown);
  const Influence influence = find_influence(scene, control, value, session);
  if (view) {
    const render::Camera camera =
        aim_camera(scene, output_options.target, *view, {render.width, render.height});
    const std::string& path = output_options.output.path;
    const uint64_t bytes = write_png(path, draw_heat_map(scene, influence, {render, camera}));
    note_written(session, path, bytes);
  }
  Output output("-");
  if (command.json) {
    write_json(influence, scene, output);
  } else {
    Text(scene, session, output).write(influence);
  }
  output.commit();
}

}  // namespace

Command add_inspect_command(CLI::App& app, const Session& session) {
  auto command = std::make_shared<InspectCommand>();
  CLI::App* inspect = app.add_subcommand("inspect", "Show what a control does");
  add_scene_options(*inspect, command->scene);
  inspect->add_option("CONTROL", command->control, "A raw or GUI control, such as jawOpen")
      ->type_name("")
      ->required();
  inspect->add_option("--value", command->value, "Value of the control (default: 1)")
      ->type_name("V");
  inspect->add_flag("--json", command->json, "Print everything as JSON");
  add_render_output_options(*inspect, command->output,
                            "Also draw a heat map of what moves, and how far");
  inspect->footer(
      "Compares the neutral pose with the pose in which this control is set: joints (length of\n"
      "the translation, largest angle, largest change of scale), blend shape channels, animated\n"
      "maps, and positions of the meshes (those that move at least 1 % of the largest distance).\n"
      "Lists the correctives of which this control is an input: for each, how far setting all of\n"
      "its inputs moves the mesh beyond the sum of what each input does alone.\n\n"
      "Examples:\n"
      "  mien inspect head.dna jawOpen\n"
      "  mien inspect head.dna CTRL_C_jaw.ty --value 0.5 --json\n"
      "  mien inspect head.dna mouthSmileLeft -o heat.png --target mouth");
  return {inspect, [command, &session] { run(*command, session); }};
}

}  // namespace mien::cli
