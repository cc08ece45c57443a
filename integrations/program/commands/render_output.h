// SPDX-License-Identifier: MIT
// What the commands that draw have in common: options of the camera and of the image, names of
// files, PNG files.
#pragma once

#include <string>

#include "integrations/program/commands/commands.h"
#include "integrations/program/io/output.h"
#include "integrations/program/render/camera.h"
#include "integrations/program/render/sheet.h"
#include "integrations/program/scene/posed_scene.h"

namespace mien::cli {

/// RIG, --lod, --meshes as they were typed.
struct SceneArguments {
  std::string rig, lod = "0", meshes;
};
void add_scene_options(CLI::App& app, SceneArguments& arguments);
PosedSceneOptions parse_scene_options(const SceneArguments& arguments);

/// As they were typed.
struct RenderOutputOptions {
  OutputFile output;
  std::string camera = "front", target, size, background = "dark", samples = "4";
};

/// --camera, --target, --size, --background, --samples.
void add_camera_options(CLI::App& app, RenderOutputOptions& options, const std::string& group = "");
/// The same and -o.
void add_render_output_options(CLI::App& app, RenderOutputOptions& options,
                               const std::string& output_text);

/// A name of --camera, or "30,10" (yaw, pitch) and optionally zoom and field of view.
render::View parse_camera(const std::string& text);

/// "640x480" or "640"; `otherwise` if it is empty.
render::Size parse_size(const std::string& text, render::Size otherwise);

render::RenderOptions parse_render_options(const RenderOutputOptions& options, render::Size size);

/// Wrong usage if the sheet is too large.
render::Sheet make_sheet(const render::SheetLayout& layout, const render::Backdrop& backdrop);

/// Whether the name of a file holds a number, as "%d" or "%04d"; a name without one is one file.
bool is_numbered(const std::string& output);
std::string numbered(const std::string& output, size_t number);

/// Wrong usage if the name tells of another format than PNG.
void require_png_name(const std::string& output);

/// Returns the bytes of the file.
uint64_t write_png(const std::string& path, const render::Image& image);

}  // namespace mien::cli
