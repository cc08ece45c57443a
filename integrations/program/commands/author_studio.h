// SPDX-License-Identifier: MIT
// What the images of `mien author` have in common: the mesh that was read, its bones, cameras, colors.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "integrations/program/commands/author_images.h"
#include "integrations/program/render/sheet.h"

namespace mien::cli::author_images {

using Json = nlohmann::ordered_json;

constexpr render::Color kInk = {40, 42, 46}, kPlain = {190, 190, 188};
// Of facial bones, and of all others.
constexpr render::Color kLeft = {214, 84, 58}, kRight = {52, 118, 196}, kMiddle = {240, 196, 60};
constexpr render::Color kInner = {70, 160, 98};
constexpr render::View kFront = {0, 0, 22, 1}, kThreeQuarter = {35, 4, 22, 1},
                       kSide = {90, 0, 22, 1};
constexpr render::Size kTile = {400, 440}, kSmallTile = {300, 330}, kShapeTile = {240, 264};

struct Bone {
  std::string name, kind;
  math::Vec3 position;
  size_t rank = 0, mirror = 0;
  render::Color color = kInner;
};

/// The mesh as it was read, in centimeters, to be drawn in any colors.
class Source {
 public:
  explicit Source(const MadeRig& made);

  size_t count() const { return positions_.size() / 3; }
  math::Vec3 position(size_t v) const { return math::load3(positions_.data(), v); }
  const std::vector<float>& positions() const { return positions_; }
  /// Positions of the face.
  const std::vector<uint32_t>& mask() const { return mask_; }
  /// Of the head, without the body that may be below it.
  const std::vector<math::Vec3>& points() const { return points_; }
  const render::Axes& axes() const { return axes_; }

  /// `colors` has r g b of each position; empty: as what the objects are. Other positions may be given.
  std::vector<render::Surface> surfaces(const std::vector<uint8_t>& colors,
                                        const std::vector<float>& positions) const;

 private:
  struct Object {
    MeshClass mesh_class;
    std::vector<uint32_t> triangles;
  };
  void find_points();
  void paint_eyes();

  render::Axes axes_;
  std::vector<float> positions_;
  std::vector<Object> objects_;      // those that are drawn
  std::vector<uint8_t> eye_colors_;  // of all positions; empty if there are no eyes
  std::vector<math::Vec3> points_;
  std::vector<uint32_t> mask_;
};

/// Images of one size; all have the same scale of shading.
struct Studio {
  const Source& source;
  render::Size size;
  render::RenderOptions options;

  Studio(const Source& from, render::Size tile);
  /// Looks at the head.
  render::Camera camera(const render::View& view) const;
  /// Looks at the face.
  render::Camera face_camera(const render::View& view) const;
  /// The mesh as it was read.
  render::Image draw(const std::vector<uint8_t>& colors, const render::Camera& camera) const;
  /// How far the mesh is from the viewer at each pixel; infinite where it is not.
  std::vector<float> distances(const render::Camera& camera) const;
  render::Sheet sheet(size_t count, size_t columns) const;
  float text_size() const { return static_cast<float>(size.width) / 26; }
};

void paint(std::vector<uint8_t>& colors, size_t position, render::Color color);

std::vector<Bone> read_bones(const Source& source, const Json& report);

/// The weights of each joint.
render::Image draw_weights(const MadeRig& made, const Source& source,
                           const std::vector<Bone>& bones);

/// The head at rest, and its joint turned alone, as an animator does.
render::Image draw_head_turns(const MadeRig& made, const Source& source,
                              const std::vector<Bone>& bones);

/// The joint of the jaw turned alone, beside the control that opens it. There has to be a jaw.
render::Image draw_jaw(const MadeRig& made, const Source& source, const std::vector<Bone>& bones);

/// The eyes looking to the left, right, up and down, by the controls that turn them. There have to be some.
render::Image draw_eyes(const MadeRig& made, const Source& source, const std::vector<Bone>& bones);

/// Input shapes, those of the rig, and the distance between them. There must be some.
render::Image draw_shapes(const MadeRig& made, const Source& source);

}  // namespace mien::cli::author_images
