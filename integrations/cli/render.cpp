// SPDX-License-Identifier: MIT
// mien render: a rig and controls -> pictures.
#include <algorithm>
#include <cmath>

#include "integrations/cli/controls.h"
#include "integrations/cli/names.h"
#include "integrations/cli/options.h"
#include "integrations/cli/pictures.h"

namespace mien::cli {

namespace {

struct RenderCommand {
  SubjectOptions subject;
  PictureOptions picture;
  std::vector<std::string> settings;
  std::string frames, turntable, select, columns;
  bool sheet = false;
};

/// One picture of several.
struct Shot {
  std::string label;
  Frame frame;
  picture::Camera camera;
};

/// Everything that belongs to one call of the command, parsed before a file is opened.
struct Plan {
  picture::View view;
  Size size;
  size_t turns = 0;    // of a turntable
  size_t columns = 0;  // 0: chosen by the number of pictures
  bool labels = false;
};

Plan make_plan(const RenderCommand& command) {
  const int ways = (command.sheet ? 1 : 0) + (command.turntable.empty() ? 0 : 1) +
                   (command.frames.empty() ? 0 : 1);
  if (ways > 1) {
    fail_usage("--sheet, --turntable, --frames", "only one of them can say what the pictures are",
               "leave the others out");
  }
  if (!command.select.empty() && !command.sheet) {
    fail_usage("--select", "it chooses the controls of a sheet", "add --sheet");
  }
  if (!command.frames.empty() && !command.settings.empty()) {
    fail_usage("--set", "with --frames the frames say what the controls are",
               "leave one of them out");
  }
  if (command.subject.rig == "-" && command.frames == "-") {
    fail_usage("--frames -", "standard input cannot be both RIG and FRAMES",
               "put one of them in a file");
  }
  Plan plan;
  plan.view = parse_camera(command.picture.camera);
  const bool many = ways > 0 && !is_numbered(command.picture.output);
  const int side = many ? 256 : 640;
  plan.size = parse_size(command.picture.size, {side, side});
  plan.labels = command.sheet || !command.frames.empty();
  if (!command.turntable.empty()) {
    plan.turns = parse_number("--turntable", command.turntable, 3600);
    if (plan.turns == 0) fail_usage("--turntable 0", "there is nothing to draw", "take 8, say");
  }
  if (!command.columns.empty()) {
    plan.columns = parse_number("--columns", command.columns, 1000);
    if (plan.columns == 0) fail_usage("--columns 0", "a sheet has one or more", "take 8, say");
    if (!many) {
      fail_usage("--columns", "only pictures side by side have columns",
                 "add --sheet, --turntable or --frames, and no % to the name of the file");
    }
  }
  return plan;
}

/// A picture of each raw control alone, at 1.
std::vector<Shot> sheet_shots(const RenderCommand& command, const Subject& subject,
                              const Frame& base, const picture::Camera& camera) {
  const MienRig* rig = subject.rig.get();
  const uint32_t count = rig_count(rig, MIEN_KIND_RAW_CONTROL);
  NearestName nearest(command.select);
  std::vector<Shot> shots;
  for (uint32_t i = 0; i < count; ++i) {
    const std::string name = rig_name(rig, MIEN_KIND_RAW_CONTROL, i);
    nearest.offer(name);
    if (!command.select.empty() && !matches_pattern(command.select, name)) continue;
    Shot shot{std::string(short_name(name)), base, camera};
    shot.frame.raw.push_back({i, 1.0f});
    shots.push_back(std::move(shot));
  }
  if (!shots.empty()) return shots;
  const std::string what = "cannot draw a sheet";
  if (count == 0) fail(kInvalid, what, subject.file.shown, "the rig has no raw controls", "");
  fail(kInvalid, what, subject.file.shown, "no raw control matches \"" + command.select + "\"",
       nearest.question("'mien info RIG --names raw' lists the names"));
}

std::vector<Shot> turntable_shots(const RenderCommand& command, const Plan& plan,
                                  const Subject& subject, const Frame& base) {
  const std::vector<picture::Vec3> points = find_target(subject, command.picture.target);
  picture::Box box;
  for (const picture::Vec3& point : points) box.add(point);
  std::vector<Shot> shots;
  for (size_t i = 0; i < plan.turns; ++i) {
    picture::View view = plan.view;
    view.yaw += 360 * static_cast<float>(i) / static_cast<float>(plan.turns);
    shots.push_back({"", base,
                     frame_turning(subject.stand, view, box.center(), points, plan.size.width,
                                   plan.size.height)});
  }
  return shots;
}

std::vector<Shot> find_shots(const RenderCommand& command, const Plan& plan,
                             const Subject& subject) {
  const Frame base = parse_settings(command.settings, subject.rig.get(), subject.file.shown);
  if (plan.turns != 0) return turntable_shots(command, plan, subject, base);
  // Tiles are small: a sheet shows the face if it can be found.
  std::string target = command.picture.target;
  if (target.empty() && command.sheet && has_face(subject)) target = "face";
  const picture::Camera camera = aim(subject, target, plan.view, plan.size);
  if (command.sheet) return sheet_shots(command, subject, base, camera);
  if (command.frames.empty()) return {{"", base, camera}};

  std::vector<Shot> shots;
  for (const Frame& frame : read_frames(command.frames, subject.rig.get())) {
    shots.push_back({std::to_string(shots.size()), frame, camera});
  }
  if (shots.empty()) {
    fail(kInvalid, "cannot draw frames", shown_name(command.frames), "the list \"frames\" is empty",
         "give at least one");
  }
  return shots;
}

/// About as wide as high, or a little wider; a turntable is one strip unless it is long.
size_t choose_columns(const Plan& plan, size_t count) {
  if (plan.columns != 0) return plan.columns;
  if (plan.turns != 0 && plan.turns <= 12) return plan.turns;
  return static_cast<size_t>(std::ceil(std::sqrt(static_cast<double>(count) * 1.4)));
}

void run(const RenderCommand& command, const Session& session) {
  const Plan plan = make_plan(command);
  picture::RenderOptions render = parse_render_options(command.picture, plan.size);
  render.wireframe = command.subject.wireframe;
  check_picture_output(command.picture.output, session);

  Subject subject = open_subject(command.subject, session);
  // One measure for all pictures: hollows do not change with what moves.
  render.scale = length(subject.neutral_box().size());
  const std::vector<Shot> shots = find_shots(command, plan, subject);
  Progress progress(session, "picture", shots.size());
  const auto draw = [&](const Shot& shot) {
    pose_subject(subject, shot.frame);
    return picture::render(subject.surfaces(), shot.camera, render);
  };

  const std::string& output = command.picture.output;
  const bool many = command.sheet || plan.turns != 0 || !command.frames.empty();
  if (is_numbered(output)) {
    for (size_t i = 0; i < shots.size(); ++i) {
      progress.at(i);
      write_picture(numbered(output, i), draw(shots[i]));
    }
  } else if (!many || (shots.size() == 1 && !command.sheet)) {
    write_picture(output, draw(shots[0]));
  } else {
    Sheet sheet(shots.size(), choose_columns(plan, shots.size()), plan.size, render.backdrop,
                plan.labels);
    for (size_t i = 0; i < shots.size(); ++i) {
      progress.at(i);
      sheet.add(draw(shots[i]), shots[i].label);
    }
    write_picture(output, sheet.image());
  }
}

}  // namespace

Command add_render_command(CLI::App& app, const Session& session) {
  auto command = std::make_shared<RenderCommand>();
  CLI::App* render = app.add_subcommand("render", "Draw pictures of a rig");
  add_subject_options(*render, command->subject);
  add_picture_options(*render, command->picture,
                      "File to write; - is standard output. With %04d in its name\n"
                      "each picture is a file of its own, else they share one");
  render->get_option("--output")->required();
  render
      ->add_option("--set", command->settings,
                   "A raw or GUI control, as --set jawOpen=0.5; any number of them")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  const std::string group = "Several pictures";
  render->add_flag("--sheet", command->sheet, "Every raw control at 1, with its name")
      ->group(group);
  render->add_option("--select", command->select, "Only these controls of a sheet, as jaw*,*Blink*")
      ->type_name("PATTERN")
      ->group(group);
  render->add_option("--turntable", command->turntable, "N pictures from all around")
      ->type_name("N")
      ->group(group);
  render
      ->add_option("--frames", command->frames,
                   "A picture of each frame: JSON as for 'mien eval'; - reads\nstandard input")
      ->type_name("FRAMES")
      ->group(group);
  render->add_option("--columns", command->columns, "Pictures side by side")
      ->type_name("N")
      ->group(group);
  render->add_flag("--wireframe", command->subject.wireframe, "Edges of the faces on top");
  render->footer(
      "A picture is 640x640 pixels, one of several on a sheet 256x256, if --size does not say\n"
      "otherwise. The light moves with the camera. Meshes are colored by the metadata\n"
      "mien.colors.MESH of the file (base64 of r g b per position), else by what their names say\n"
      "they are.\n\n"
      "Examples:\n"
      "  mien render head.dna -o head.png\n"
      "  mien render head.dna --set jawOpen=0.7 --camera three-quarter -o open.png\n"
      "  mien render head.dna --camera 20,-5,1.5 --target mouth --size 1280x720 -o mouth.png\n"
      "  mien render head.dna --sheet --columns 8 -o sheet.png\n"
      "  mien render head.dna --turntable 8 -o around.png\n"
      "  mien render head.dna --frames frames.json -o 'frame-%04d.png'");
  return {render, [command, &session] { run(*command, session); }};
}

}  // namespace mien::cli
