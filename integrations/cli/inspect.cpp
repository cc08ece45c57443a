// SPDX-License-Identifier: MIT
// mien inspect: what one control does, for people, as JSON, and as a picture.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "integrations/cli/heat.h"
#include "integrations/cli/influence.h"
#include "integrations/cli/json_writer.h"
#include "integrations/cli/options.h"
#include "integrations/cli/text.h"

namespace mien::cli {

namespace {

using picture::Vec3;

struct InspectCommand {
  SubjectOptions subject;
  PictureOptions picture;
  std::string control, value = "1";
  bool json = false;
};

constexpr size_t kListed = 12;  // of each kind, for people

float parse_value(const std::string& text) {
  char* end = nullptr;
  const float value = std::strtof(text.c_str(), &end);
  if (!text.empty() && end == text.c_str() + text.size() && std::isfinite(value)) return value;
  fail_usage("--value \"" + text + "\"", "not a finite number", "controls are usually in 0..1");
}

// Words for places and directions
// ------------------------------------------------------------------

/// Along left, up and front of the subject.
Vec3 in_stand(const Subject& subject, Vec3 v) {
  return {dot(v, subject.stand.left), dot(v, subject.stand.up), dot(v, subject.stand.front)};
}

/// "up and front": the axes that have a good share of a movement, the largest first.
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

/// "left, upper third": where a place lies within everything that is shown.
std::string place_words(const Subject& subject, Vec3 place) {
  const picture::Box box = subject.neutral_box();
  const Vec3 half = box.size() * 0.5f;
  const Vec3 from_centre = in_stand(subject, place - box.center());
  const Vec3 extent = in_stand(subject, half);
  const auto share = [](float x, float of) { return of != 0 ? x / std::fabs(of) : 0.0f; };
  const float across = share(from_centre.x, extent.x), height = share(from_centre.y, extent.y);
  const char* third = height > 1 / 3.0f ? "upper" : height < -1 / 3.0f ? "lower" : "middle";
  const char* side = across > 0.08f ? "left" : across < -0.08f ? "right" : "center";
  return std::string(side) + ", " + third + " third";
}

// For people
// ---------------------------------------------------------------------------------------

std::string number(float value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.4g", static_cast<double>(value));
  return text;
}

std::string padded(std::string text, size_t width) {
  if (text.size() < width) text.append(width - text.size(), ' ');
  return text;
}

std::string rotation_unit(const Subject& subject) {
  return subject.file.info.rotation_unit == MIEN_ROTATION_RADIANS ? "rad" : "deg";
}

class Text {
 public:
  Text(const Subject& subject, const Session& session, Output& output)
      : subject_(subject), colors_(session.terminal.out_colours), output_(output) {}

  void write(const Influence& influence) {
    const bool gui = influence.control.kind == MIEN_KIND_GUI_CONTROL;
    line(paint(one_line(influence.control.name), Style::kBold, colors_) +
         (gui ? ": GUI control " : ": raw control ") + std::to_string(influence.control.index) +
         ", at " + number(influence.value) + ", LOD " + std::to_string(subject_.lod) + " of " +
         one_line(subject_.file.shown));
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

  void rest(size_t count) {
    if (count > kListed)
      line("  and " + std::to_string(count - kListed) + " more (--json has all)");
  }

  void values(const std::string& name, const std::vector<ValueChange>& list) {
    title(name, list.size(), std::to_string(list.size()));
    for (size_t i = 0; i < std::min(list.size(), kListed); ++i) {
      line("  " + padded(one_line(list[i].name), 36) + " " + number(list[i].value));
    }
    rest(list.size());
  }

  void joints(const Influence& influence) {
    const auto& list = influence.joints;
    title("Joints", list.size(),
          std::to_string(list.size()) + " of " +
              std::to_string(rig_count(subject_.rig.get(), MIEN_KIND_JOINT)) + " move");
    if (!list.empty()) {
      line("  " + padded("", 36) + " translation  rotation  scale");
    }
    for (size_t i = 0; i < std::min(list.size(), kListed); ++i) {
      const JointMotion& joint = list[i];
      const auto cell = [](float value, const std::string& unit) {
        return value == 0 ? std::string("-") : number(value) + " " + unit;
      };
      line("  " + padded(one_line(joint.name), 36) + " " +
           padded(cell(joint.translation, subject_.unit()), 12) + " " +
           padded(cell(joint.rotation, rotation_unit(subject_)), 13) + " " +
           (joint.scale == 0 ? "-" : number(joint.scale)));
    }
    rest(list.size());
  }

  void correctives(const Influence& influence) {
    const auto& list = influence.correctives;
    title("Correctives", list.size(), std::to_string(list.size()) + " have it as an input");
    const std::string unit = subject_.unit();
    for (size_t i = 0; i < std::min(list.size(), kListed); ++i) {
      const Corrective& c = list[i];
      std::string with;
      for (const std::string& partner : c.partners) {
        with += (with.empty() ? "with " : ", ") + one_line(short_name(partner));
      }
      if (c.partners.empty()) with = "alone";
      std::string effect = "cannot be tried: an input is not a raw control";
      if (c.reachable) {
        effect =
            "value " + number(c.together) +
            (c.partners.empty() ? ""
             : c.further == 0   ? ", nothing beyond the sum"
                                : ", up to " + number(c.further) + " " + unit + " beyond the sum");
      }
      line("  " + padded("psd" + std::to_string(c.psd), 8) + " " + padded(with, 50) + " " + effect);
    }
    rest(list.size());
  }

  void meshes(const Influence& influence) {
    if (influence.meshes.empty()) {
      title("Meshes", 0, "");
      return;
    }
    title("Meshes", 1, "up to " + number(influence.most()) + " " + subject_.unit());
    const std::string unit = " " + subject_.unit();
    for (const MeshMotion& motion : influence.meshes) {
      const std::string name = "  " + padded(one_line(motion.mesh->name), 36) + " ";
      if (motion.moved == 0) {
        line(name + "does not move");
        continue;
      }
      const float share = 100.0f * static_cast<float>(motion.moved) /
                          static_cast<float>(motion.mesh->neutral.position_count);
      const Vec3 size = motion.box.size();
      line(name + number(share) + "% of its positions, up to " + number(motion.most) + unit +
           ", mostly " + direction_words(in_stand(subject_, motion.mean)));
      line("  " + padded("", 36) + " around " + place_words(subject_, motion.center) + "; box " +
           number(size.x) + " x " + number(size.y) + " x " + number(size.z) + unit + " at (" +
           number(motion.box.least.x) + ", " + number(motion.box.least.y) + ", " +
           number(motion.box.least.z) + ")");
    }
  }

  const Subject& subject_;
  bool colors_;
  Output& output_;
};

// JSON
// ---------------------------------------------------------------------------------------------

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
    write_float(json, "alone", corrective.alone);
    if (corrective.reachable) {
      write_float(json, "together", corrective.together);
      write_float(json, "beyond_sum", corrective.further);
    }
    json.end_object();
  }
  json.end_array();
}

void write_meshes(JsonWriter& json, const Influence& influence, const Subject& subject) {
  json.key("meshes");
  json.begin_array(JsonWriter::Layout::kLines);
  for (const MeshMotion& motion : influence.meshes) {
    json.begin_object();
    json.member("name", motion.mesh->name);
    json.member("positions", motion.mesh->neutral.position_count);
    json.member("moved", motion.moved);
    if (motion.moved != 0) {
      write_float(json, "most", motion.most);
      json.member("max_position", motion.max_position);
      write_vector(json, "mean", motion.mean);
      json.member("direction", direction_words(in_stand(subject, motion.mean)));
      json.member("place", place_words(subject, motion.center));
      write_vector(json, "center", motion.center);
      write_vector(json, "box_least", motion.box.least);
      write_vector(json, "box_most", motion.box.most);
    }
    json.end_object();
  }
  json.end_array();
}

void write_json(const Influence& influence, const Subject& subject, Output& output) {
  JsonWriter json(output);
  json.begin_object(JsonWriter::Layout::kLines);
  json.member("rig", subject.file.shown);
  json.member("lod", subject.lod);
  json.member("control", influence.control.name);
  json.member("kind", influence.control.kind == MIEN_KIND_GUI_CONTROL ? "gui" : "raw");
  json.member("index", influence.control.index);
  write_float(json, "value", influence.value);
  json.member("translation_unit", subject.unit());
  json.member("rotation_unit", rotation_unit(subject));
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
  write_meshes(json, influence, subject);
  json.end_object();
  json.finish();
}

void run(InspectCommand command, const Session& session) {
  const float value = parse_value(command.value);
  const bool picture = !command.picture.output.empty();
  if (picture) {
    if (command.picture.output == "-") {
      fail_usage("-o -", "standard output is taken by the text", "name a file for the picture");
    }
    // A typing error is found before the work is done.
    static_cast<void>(parse_camera(command.picture.camera));
    static_cast<void>(parse_render_options(command.picture, parse_size(command.picture.size, {})));
  }
  command.subject.geometry_optional = !picture;

  Subject subject = open_subject(command.subject, session);
  const Control control =
      find_control(subject.rig.get(), command.control, "cannot inspect", subject.file.shown);
  const Influence influence = find_influence(subject, control, value, session);
  if (picture) {
    write_picture(command.picture.output, draw_heat(subject, influence, command.picture));
  }
  Output output("-");
  if (command.json) {
    write_json(influence, subject, output);
  } else {
    Text(subject, session, output).write(influence);
  }
  output.commit();
}

}  // namespace

Command add_inspect_command(CLI::App& app, const Session& session) {
  auto command = std::make_shared<InspectCommand>();
  CLI::App* inspect = app.add_subcommand("inspect", "Explain what a control does");
  add_subject_options(*inspect, command->subject);
  inspect->add_option("CONTROL", command->control, "A raw or GUI control, as jawOpen")
      ->type_name("")
      ->required();
  inspect->add_option("--value", command->value, "Value of the control (default: 1)")
      ->type_name("V");
  inspect->add_flag("--json", command->json, "JSON instead of text, with everything");
  add_picture_options(*inspect, command->picture,
                      "Also draw where it moves the face, as a heat map");
  inspect->footer(
      "Compares the rig at rest with the rig with this control on: joints (length of the\n"
      "translation, largest angle, largest change of scale), channels, maps, and the positions\n"
      "of the meshes (those that go at least a hundredth of the furthest). Correctives are\n"
      "listed with their other inputs; for each, all inputs are set, and what that moves beyond\n"
      "the sum of the inputs alone is measured.\n\n"
      "Examples:\n"
      "  mien inspect head.dna jawOpen\n"
      "  mien inspect head.dna CTRL_C_jaw.ty --value 0.5 --json\n"
      "  mien inspect head.dna mouthSmileLeft -o heat.png --target mouth");
  return {inspect, [command, &session] { run(*command, session); }};
}

}  // namespace mien::cli
