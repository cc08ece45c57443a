// SPDX-License-Identifier: MIT
// mien render: a rig and controls -> images.
#include <algorithm>
#include <cmath>

#include "integrations/program/commands/options.h"
#include "integrations/program/commands/render_output.h"
#include "integrations/program/io/controls.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/output.h"
#include "integrations/program/scene/camera_target.h"

namespace mien::cli {

namespace {

struct RenderCommand {
  SceneArguments scene;
  RenderOutputOptions output;
  std::vector<std::string> settings;
  std::string frames, turntable, select, columns;
  bool sheet = false, wireframe = false;
};

/// One image of the output.
struct Shot {
  std::string label;
  Frame frame;
  render::Camera camera;
};

/// The options, parsed before any file is opened.
struct Plan {
  PosedSceneOptions scene;
  render::View view;
  render::Size size;
  size_t turns = 0;    // images of a turntable
  size_t columns = 0;  // 0: depends on the number of images
  bool labels = false;
};

Plan make_plan(const RenderCommand& command) {
  const int modes = (command.sheet ? 1 : 0) + (command.turntable.empty() ? 0 : 1) +
                    (command.frames.empty() ? 0 : 1);
  if (modes > 1) {
    fail_usage("--sheet, --turntable, --frames", "these exclude each other", "choose one");
  }
  if (!command.select.empty() && !command.sheet) {
    fail_usage("--select", "it chooses the controls of a sheet", "add --sheet");
  }
  if (!command.frames.empty() && !command.settings.empty()) {
    fail_usage("--set", "the frames of --frames set the controls", "leave out --set or --frames");
  }
  if (command.scene.rig == "-" && command.frames == "-") {
    fail_usage("--frames -", "standard input cannot be both RIG and FRAMES",
               "put one of them in a file");
  }
  require_png_name(command.output.output.path);
  Plan plan;
  plan.scene = parse_scene_options(command.scene);
  plan.scene.wireframe = command.wireframe;
  plan.view = parse_camera(command.output.camera);
  const bool tiled = modes > 0 && !is_numbered(command.output.output.path);
  const int side = tiled ? 256 : 640;
  plan.size = parse_size(command.output.size, {side, side});
  plan.labels = command.sheet || !command.frames.empty();
  if (!command.turntable.empty()) {
    plan.turns = parse_number("--turntable", command.turntable, 3600);
    if (plan.turns == 0) fail_usage("--turntable 0", "there is nothing to draw", "try 8");
  }
  if (!command.columns.empty()) {
    plan.columns = parse_number("--columns", command.columns, 1000);
    if (plan.columns == 0) fail_usage("--columns 0", "a sheet has at least one", "try 8");
    if (!tiled) {
      fail_usage("--columns", "only images side by side have columns",
                 "add --sheet, --turntable or --frames, and leave % out of the file name");
    }
  }
  return plan;
}

/// An image for each raw control, set to 1.
std::vector<Shot> sheet_shots(const RenderCommand& command, const PosedScene& scene,
                              const Frame& base, const render::Camera& camera) {
  const MienRig* rig = scene.rig.get();
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
  if (count == 0) fail(kInvalid, what, scene.shown, "the rig has no raw controls", "");
  fail(kInvalid, what, scene.shown, "no raw control matches \"" + command.select + "\"",
       nearest.question("'mien info RIG --names raw' lists the names"));
}

std::vector<Shot> turntable_shots(const RenderCommand& command, const Plan& plan,
                                  const PosedScene& scene, const Frame& base) {
  const std::vector<math::Vec3> points = find_target(scene, command.output.target);
  math::Box box;
  for (const math::Vec3& point : points) box.add(point);
  std::vector<Shot> shots;
  for (size_t i = 0; i < plan.turns; ++i) {
    render::View view = plan.view;
    view.yaw += 360 * static_cast<float>(i) / static_cast<float>(plan.turns);
    shots.push_back(
        {"", base,
         frame_turning(scene.axes, view, box.center(), points, plan.size.width, plan.size.height)});
  }
  return shots;
}

std::vector<Shot> find_shots(const RenderCommand& command, const Plan& plan,
                             const PosedScene& scene) {
  const Frame base = parse_settings(command.settings, scene.rig.get(), scene.shown);
  if (plan.turns != 0) return turntable_shots(command, plan, scene, base);
  // Tiles are small, so they show the face if it can be found.
  std::string target = command.output.target;
  if (target.empty() && command.sheet && has_face(scene)) target = "face";
  const render::Camera camera = aim_camera(scene, target, plan.view, plan.size);
  if (command.sheet) return sheet_shots(command, scene, base, camera);
  if (command.frames.empty()) return {{"", base, camera}};

  std::vector<Shot> shots;
  for (const Frame& frame : read_frames(command.frames, scene.rig.get())) {
    shots.push_back({std::to_string(shots.size()), frame, camera});
  }
  if (shots.empty()) {
    fail(kInvalid, "cannot draw frames", shown_name(command.frames), "the list \"frames\" is empty",
         "give at least one frame");
  }
  return shots;
}

/// A sheet is a little wider than high; a turntable is one row unless it is long.
size_t choose_columns(const Plan& plan, size_t count) {
  if (plan.columns != 0) return plan.columns;
  if (plan.turns != 0 && plan.turns <= 12) return plan.turns;
  return static_cast<size_t>(std::ceil(std::sqrt(static_cast<double>(count) * 1.4)));
}

void run(const RenderCommand& command, const Session& session) {
  const Plan plan = make_plan(command);
  render::RenderOptions render = parse_render_options(command.output, plan.size);
  render.wireframe = command.wireframe;
  refuse_terminal(command.output.output.path, session, "a PNG file");
  refuse_replacing(command.output.output, {command.scene.rig, command.frames});

  PosedScene scene = open_scene(plan.scene, session);
  // The same scale for all images, so that shading does not depend on the pose.
  render.scale = length(scene.neutral_box().size());
  const std::vector<Shot> shots = find_shots(command, plan, scene);
  Progress progress(session, shots.size() == 1 ? "drawing" : "image", shots.size());
  if (shots.size() == 1) render.progress = [&](double share) { progress.at_share(share); };
  const auto draw = [&](const Shot& shot) {
    pose_scene(scene, shot.frame);
    return render_image(scene.surfaces(), shot.camera, render);
  };

  const std::string& output = command.output.output.path;
  const bool many = command.sheet || plan.turns != 0 || !command.frames.empty();
  uint64_t bytes = 0;
  if (is_numbered(output)) {
    for (size_t i = 0; i < shots.size(); ++i) {
      progress.at(i);
      const std::string file = numbered(output, i);
      refuse_replacing({file, command.output.output.force}, {command.scene.rig, command.frames});
      bytes += write_png(file, draw(shots[i]));
    }
  } else if (!many || (shots.size() == 1 && !command.sheet)) {
    bytes = write_png(output, draw(shots[0]));
  } else {
    const size_t columns = std::min(choose_columns(plan, shots.size()), shots.size());
    render::Sheet sheet =
        make_sheet({shots.size(), columns, plan.size, plan.labels}, render.backdrop);
    for (size_t i = 0; i < shots.size(); ++i) {
      progress.at(i);
      sheet.add(draw(shots[i]), shots[i].label);
    }
    bytes = write_png(output, sheet.image());
  }
  progress.finish();
  note_written(session, output, bytes);
}

}  // namespace

Command add_render_command(CLI::App& app, const Session& session) {
  auto command = std::make_shared<RenderCommand>();
  CLI::App* render = app.add_subcommand("render", "Draw images of a rig");
  add_scene_options(*render, command->scene);
  add_render_output_options(*render, command->output,
                            "File to write; - is standard output. With %04d in the name,\n"
                            "each image is written to a separate file");
  render->get_option("--output")->required();
  render
      ->add_option("--set", command->settings,
                   "Set a raw or GUI control, such as jawOpen=0.5; may be repeated")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  const std::string group = "Several images";
  render
      ->add_flag("--sheet", command->sheet,
                 "One image per raw control, set to 1, labeled with its name")
      ->group(group);
  render
      ->add_option("--select", command->select,
                   "Only these controls of a sheet, for example jaw*,*Blink*")
      ->type_name("PATTERN")
      ->group(group);
  render->add_option("--turntable", command->turntable, "N images, turning around the head")
      ->type_name("N")
      ->group(group);
  render
      ->add_option("--frames", command->frames,
                   "One image per frame: JSON as for 'mien eval'; - reads\nstandard input")
      ->type_name("FRAMES")
      ->group(group);
  render->add_option("--columns", command->columns, "Images per row")->type_name("N")->group(group);
  render->add_flag("--wireframe", command->wireframe, "Also draw the edges of faces");
  render->footer(
      "The default size is 640x640 pixels, or 256x256 for each of several images in one file.\n"
      "The light moves with the camera. Meshes have the colors of the metadata mien.colors.MESH\n"
      "of the file (base64 of r g b for each position), otherwise a material chosen by mesh name.\n"
      "Baked files have no metadata.\n\n"
      "Examples:\n"
      "  mien render head.dna -o head.png\n"
      "  mien render head.dna --set jawOpen=0.7 --camera three-quarter -o open.png\n"
      "  mien render head.dna --camera 20,-5,1.5 --target mouth -o mouth.png\n"
      "  mien render head.dna --sheet --columns 8 -o sheet.png\n"
      "  mien render head.dna --turntable 8 -o around.png\n"
      "  mien render head.dna --frames frames.json -o 'frame-%04d.png'");
  return {render, [command, &session] { run(*command, session); }};
}

}  // namespace mien::cli
