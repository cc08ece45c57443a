// SPDX-License-Identifier: MIT
// Images of the rig: weights, and input shapes beside those of the rig.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>
#include <unordered_map>

#include "integrations/program/commands/author_studio.h"
#include "integrations/program/render/marks.h"
#include "integrations/program/scene/heat_map.h"

namespace mien::cli::author_images {

namespace {

using math::Vec3;
using render::Camera;
using render::Color;
using render::Image;
using render::LegendLine;
using render::Spot;
using render::Surface;

constexpr size_t kShownShapes = 7, kShownRegions = 7;

/// A color for each number, far from those of its neighbors.
Color color_of_number(size_t number) {
  const float hue = std::fmod(static_cast<float>(number) * 0.618034f, 1.0f);
  const float level = 0.55f + 0.3f * static_cast<float>(number % 3);
  const auto channel = [&](float shift) {
    const float wave = 0.5f + 0.5f * std::cos(6.2831853f * (hue + shift));
    return static_cast<uint8_t>(255 * std::min(level * (0.25f + 0.75f * wave), 1.0f));
  };
  return {channel(0), channel(0.333f), channel(0.667f)};
}

// Weights --------------------------------------------------------------------------------------------

/// `FACIAL_L_Cheek12` is of the region Cheek.
std::string region_of(const std::string& name) {
  const size_t from = name.rfind('_') + 1;
  size_t to = name.size();
  while (to > from && name[to - 1] >= '0' && name[to - 1] <= '9') --to;
  return name.substr(from, to - from);
}

/// Of each region the joint that the most LODs have, and those that are not facial.
std::vector<size_t> choose_bones(const std::vector<Bone>& bones) {
  std::map<std::string, size_t> first;
  std::vector<size_t> chosen;
  bool eye = false;
  for (size_t b = 0; b < bones.size(); ++b) {
    const Bone& bone = bones[b];
    if (bone.kind == "facial" && bone.color != kRight) {
      const auto [it, added] = first.emplace(region_of(bone.name), b);
      if (!added && bone.rank < bones[it->second].rank) it->second = b;
    } else if (bone.kind == "neck" || bone.kind == "head" || bone.kind == "jaw") {
      chosen.push_back(b);
    } else if (bone.kind == "eye" && !eye) {
      chosen.push_back(b);
      eye = true;
    }
  }
  std::vector<size_t> facial;
  for (const auto& [region, b] : first) facial.push_back(b);
  std::sort(facial.begin(), facial.end(),
            [&](size_t a, size_t b) { return bones[a].rank < bones[b].rank; });
  facial.resize(std::min(facial.size(), kShownRegions));
  chosen.insert(chosen.end(), facial.begin(), facial.end());
  return chosen;
}

/// Surfaces of the rig in colors of their own; `colors` has those of each mesh.
std::vector<Surface> colored(const PosedScene& scene,
                             const std::vector<std::vector<uint8_t>>& colors) {
  std::vector<Surface> surfaces = scene.surfaces();
  for (size_t m = 0; m < surfaces.size(); ++m) {
    surfaces[m].colors = colors[m].data();
    surfaces[m].material.softness = 0.1f;
    surfaces[m].material.roughness = 0.6f;
  }
  return surfaces;
}

template <class ColorOf>
Image draw_weights_in(const PosedScene& scene, const Studio& studio, const Camera& camera,
                      const ColorOf& color_of) {
  std::vector<std::vector<uint8_t>> colors;
  for (const SceneMesh& mesh : scene.meshes) {
    std::vector<uint8_t>& painted = colors.emplace_back(3 * size_t{mesh.neutral.position_count});
    for (uint32_t p = 0; p < mesh.neutral.position_count; ++p) {
      MienIndex16View joints{};
      MienFloatView weights{};
      check(mien_deformer_influences(scene.deformer.get(), mesh.mesh, p, &joints, &weights),
            nullptr, "cannot draw weights", mesh.name);
      paint(painted, p, color_of(joints, weights));
    }
  }
  return render_image(colored(scene, colors), camera, studio.options);
}

size_t count_different(const Image& a, const Image& b) {
  size_t count = 0;
  for (size_t i = 0; i < a.pixels.size(); i += 3) {
    count += memcmp(&a.pixels[i], &b.pixels[i], 3) != 0;
  }
  return count;
}

}  // namespace

render::Image draw_weights(const MadeRig& made, const Source& source,
                           const std::vector<Bone>& bones) {
  PosedScene& scene = made.scene;
  pose_scene(scene, {});
  const Studio studio(source, kSmallTile);
  const Camera camera = studio.camera(kThreeQuarter);
  const std::vector<size_t> chosen = choose_bones(bones);
  std::vector<std::pair<std::string, Image>> tiles;
  // Mirror images have one color.
  std::vector<Vec3> color_of;
  for (size_t b = 0; b < bones.size(); ++b) {
    const bool facial = bones[b].kind == "facial";
    const size_t number = std::min(b, bones[b].mirror);
    color_of.push_back(render::to_linear(facial ? color_of_number(number) : kPlain));
  }
  tiles.emplace_back(
      "all weights",
      draw_weights_in(scene, studio, camera,
                      [&](const MienIndex16View& joints, const MienFloatView& weights) {
                        Vec3 sum;
                        for (size_t i = 0; i < joints.count; ++i) {
                          sum += color_of[joints.data[i]] * weights.data[i];
                        }
                        return render::to_srgb(sum);
                      }));
  const auto zero = [](const MienIndex16View&, const MienFloatView&) { return heat_color(0); };
  const Image none = draw_weights_in(scene, studio, camera, zero);
  for (const size_t b : chosen) {
    Image image = draw_weights_in(scene, studio, camera,
                                  [&](const MienIndex16View& joints, const MienFloatView& weights) {
                                    float weight = 0;
                                    for (size_t i = 0; i < joints.count; ++i) {
                                      if (joints.data[i] == b) weight += weights.data[i];
                                    }
                                    return heat_color(weight * weight);  // linear on the scale
                                  });
    const size_t changed = count_different(image, none);
    if (changed < none.pixels.size() / 3 / 1000) continue;  // what it moves is inside
    draw_dot(image, find_spot(camera, studio.size, bones[b].position), 3, bones[b].color);
    tiles.emplace_back(bones[b].name, std::move(image));
  }
  render::Sheet sheet = studio.sheet(tiles.size(), 4);
  for (const auto& [name, image] : tiles) sheet.add(image, name);
  return sheet.image();
}

namespace {

// Turns ----------------------------------------------------------------------------------------------

constexpr uint32_t kNoControl = ~uint32_t{0};
constexpr Color kEyeball = {240, 240, 238}, kIris = {92, 130, 160}, kPupil = {24, 24, 28};
constexpr render::View kEyeView = {0, 0, 22, 1.6f};

/// The raw control of the name, or kNoControl.
uint32_t find_raw_control(const MienRig* rig, const Json& name) {
  uint32_t control = 0;
  const bool found =
      name.is_string() && mien_rig_find(rig, MIEN_KIND_RAW_CONTROL, name.get<std::string>().c_str(),
                                        &control) == MIEN_OK;
  return found ? control : kNoControl;
}

/// Poses the scene with one joint turned by these degrees about the axes of the head.
void turn_joint(PosedScene& scene, size_t joint, const Vec3& degrees) {
  const Vec3 about =
      scene.axes.left * degrees.x + scene.axes.up * degrees.y + scene.axes.front * degrees.z;
  std::vector<float> values(9 * rig_count(scene.rig.get(), MIEN_KIND_JOINT));
  for (int k = 0; k < 3; ++k) values[9 * joint + 3 + static_cast<size_t>(k)] = about[k];
  check(mien_deformer_instance_update_from_values(scene.pose.get(), values.data(), values.size(),
                                                  nullptr, 0),
        nullptr, "cannot draw", scene.shown);
  for (const SceneMesh& mesh : scene.meshes) {
    check(mien_deformer_instance_deform(scene.pose.get(), mesh.mesh, MIEN_NORMALS_DEFAULT, nullptr),
          nullptr, "cannot draw", mesh.name);
  }
}

}  // namespace

render::Image draw_jaw(const MadeRig& made, const Source& source, const std::vector<Bone>& bones) {
  const Studio studio(source, kSmallTile);
  const Json& jaw = made.report["jaw"];
  size_t joint = 0;
  while (joint + 1 < bones.size() && bones[joint].kind != "jaw") ++joint;
  const float open = jaw["degrees"].get<float>();
  const struct {
    const char* name;
    Vec3 degrees;
    render::View view;
  } turns[] = {
      {"jaw at rest", {}, kThreeQuarter},
      {"turned by half", {open / 2, 0, 0}, kThreeQuarter},
      {"turned as far as it opens", {open, 0, 0}, kThreeQuarter},
      {"from the side", {open, 0, 0}, kSide},
      {"to the left", {0, 8, 0}, kFront},
  };
  const uint32_t opens = find_raw_control(made.scene.rig.get(), jaw["shape"]);
  render::Sheet sheet = studio.sheet(std::size(turns) + (opens != kNoControl), 3);
  for (const auto& turn : turns) {
    turn_joint(made.scene, joint, turn.degrees);
    sheet.add(render_image(made.scene.surfaces(), studio.face_camera(turn.view), studio.options),
              turn.name);
  }
  Frame frame;
  if (opens != kNoControl) frame.raw.push_back({opens, 1.0f});
  pose_scene(made.scene, frame);
  if (opens != kNoControl) {
    sheet.add(
        render_image(made.scene.surfaces(), studio.face_camera(kThreeQuarter), studio.options),
        "control " + jaw["shape"].get<std::string>());
  }
  pose_scene(made.scene, {});
  return sheet.image();
}

namespace {

/// Eyeballs of any rig: what turns with the joint of an eye, with a pupil where it looks.
std::vector<std::vector<uint8_t>> paint_eyeballs(const PosedScene& scene,
                                                 const std::vector<Bone>& bones) {
  std::vector<std::vector<uint8_t>> colors;
  for (const SceneMesh& mesh : scene.meshes) {
    std::vector<uint8_t>& painted = colors.emplace_back(3 * size_t{mesh.neutral.position_count});
    for (uint32_t p = 0; p < mesh.neutral.position_count; ++p) {
      MienIndex16View joints{};
      MienFloatView weights{};
      check(mien_deformer_influences(scene.deformer.get(), mesh.mesh, p, &joints, &weights),
            nullptr, "cannot draw eyes", mesh.name);
      Color color = kPlain;
      for (size_t i = 0; i < joints.count; ++i) {
        const Bone& bone = bones[joints.data[i]];
        if (bone.kind != "eye" || weights.data[i] < 0.5f) continue;
        const Vec3 out = math::load3(mesh.neutral.positions.data, p) - bone.position;
        const float ahead = dot(out, scene.axes.front) / length(out);
        color = ahead > 0.97f ? kPupil : ahead > 0.87f ? kIris : kEyeball;
      }
      paint(painted, p, color);
    }
  }
  return colors;
}

}  // namespace

render::Image draw_eyes(const MadeRig& made, const Source& source, const std::vector<Bone>& bones) {
  const Studio studio(source, kSmallTile);
  render::Sheet sheet = studio.sheet(6, 3);
  const std::vector<std::vector<uint8_t>> colors = paint_eyeballs(made.scene, bones);
  const auto add = [&](const Frame& frame, const std::string& name) {
    pose_scene(made.scene, frame);
    sheet.add(
        render_image(colored(made.scene, colors), studio.face_camera(kEyeView), studio.options),
        name);
  };
  add({}, "eyes at rest");
  for (const char* way : {"left", "right", "up", "down"}) {
    Frame frame;
    for (const Json& eye : made.report["gaze"]) {
      const uint32_t control = find_raw_control(made.scene.rig.get(), eye[way]);
      if (control != kNoControl) frame.raw.push_back({control, 1.0f});
    }
    add(frame, std::string("looking ") + way);
  }
  pose_scene(made.scene, {});
  return sheet.image();
}

render::Image draw_head_turns(const MadeRig& made, const Source& source,
                              const std::vector<Bone>& bones) {
  const Studio studio(source, kSmallTile);
  size_t head = 0;
  while (head + 1 < bones.size() && bones[head].kind != "head") ++head;
  const struct {
    const char* name;
    Vec3 degrees;
    render::View view;
  } turns[] = {
      {"head at rest", {}, kThreeQuarter},  {"turned by 30 degrees", {0, 30, 0}, kFront},
      {"nodded by 30", {30, 0, 0}, kSide},  {"raised by 30", {-30, 0, 0}, kSide},
      {"tilted by 30", {0, 0, 30}, kFront},
  };
  render::Sheet sheet = studio.sheet(std::size(turns), std::size(turns));
  for (const auto& turn : turns) {
    turn_joint(made.scene, head, turn.degrees);
    sheet.add(render_image(made.scene.surfaces(), studio.camera(turn.view), studio.options),
              turn.name);
  }
  pose_scene(made.scene, {});
  return sheet.image();
}

namespace {

// Shapes ---------------------------------------------------------------------------------------------

/// An expression of the input and that of the rig.
struct ShownShape {
  const MeshShape* shape;
  uint32_t control;
  double energy = 0, error = 0;  // squared; of the rig, relative
};

/// Half of them those that move most, half those with the largest error.
std::vector<ShownShape> choose_shapes(const MadeRig& made) {
  std::vector<ShownShape> all;
  const Json& errors = made.report["fit"]["per_shape"];
  for (const MeshShape& shape : made.mesh.shapes) {
    // A shape that combines others has no control.
    if (!errors.contains(shape.name)) continue;
    ShownShape shown = {&shape, 0, 0, errors[shape.name].get<double>()};
    for (const double d : shape.displacements) shown.energy += d * d;
    if (!(shown.energy > 0)) continue;
    if (mien_rig_find(made.scene.rig.get(), MIEN_KIND_RAW_CONTROL, shape.name.c_str(),
                      &shown.control) != MIEN_OK) {
      continue;
    }
    all.push_back(shown);
  }
  const auto by = [&](auto value, size_t from) {
    std::stable_sort(all.begin() + static_cast<ptrdiff_t>(from), all.end(),
                     [&](const ShownShape& a, const ShownShape& b) { return value(a) > value(b); });
  };
  by([](const ShownShape& s) { return s.energy; }, 0);
  if (all.size() > kShownShapes) {
    by([](const ShownShape& s) { return s.energy * s.error * s.error; }, (kShownShapes + 1) / 2);
    all.resize(kShownShapes);
  }
  return all;
}

/// Positions of the mesh that lie at the same place, to the last bit.
class Places {
 public:
  explicit Places(const Source& source) {
    for (uint32_t v = 0; v < source.count(); ++v) places_[key(source.position(v))].push_back(v);
  }
  const std::vector<uint32_t>& at(Vec3 p) const {
    static const std::vector<uint32_t> kNone;
    const auto found = places_.find(key(p));
    return found == places_.end() ? kNone : found->second;
  }

 private:
  static std::string key(Vec3 p) {
    const float bits[3] = {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};
    return std::string(reinterpret_cast<const char*>(bits), sizeof(bits));
  }
  std::unordered_map<std::string, std::vector<uint32_t>> places_;
};

/// How far each position of the posed rig is from where the shape wants it, in centimeters.
std::vector<std::vector<float>> find_residuals(const PosedScene& scene, const Places& places,
                                               const std::vector<float>& wanted) {
  std::vector<std::vector<float>> residuals;
  for (const SceneMesh& mesh : scene.meshes) {
    std::vector<float>& left = residuals.emplace_back();
    const float* posed = scene.positions(mesh);
    for (uint32_t p = 0; p < mesh.neutral.position_count; ++p) {
      float least = INFINITY;
      // Touching lips are at one place; each follows one of them.
      for (const uint32_t v : places.at(math::load3(mesh.neutral.positions.data, p))) {
        least = std::min(least, length(math::load3(posed, p) - math::load3(wanted.data(), v)));
      }
      left.push_back(std::isfinite(least) ? least : 0);
    }
  }
  return residuals;
}

std::vector<float> shaped(const Source& source, const MeshShape& shape, double unit) {
  std::vector<float> positions = source.positions();
  for (size_t i = 0; i < shape.displacements.size() / 3; ++i) {
    const size_t v = shape.vertices.empty() ? i : shape.vertices[i];
    for (size_t k = 0; k < 3; ++k) {
      positions[3 * v + k] += static_cast<float>(shape.displacements[3 * i + k] * unit);
    }
  }
  return positions;
}

std::string millimeters(float centimeters) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.2g mm", static_cast<double>(centimeters) * 10);
  return text;
}

}  // namespace

render::Image draw_shapes(const MadeRig& made, const Source& source) {
  const std::vector<ShownShape> shapes = choose_shapes(made);
  const Studio studio(source, kShapeTile);
  const Camera camera = studio.face_camera({20, 2, 22, 1});
  const Places places(source);
  PosedScene& scene = made.scene;
  const auto pose = [&](const ShownShape& shown) {
    Frame frame;
    frame.raw.push_back({shown.control, 1.0f});
    pose_scene(scene, frame);
    return find_residuals(scene, places, shaped(source, *shown.shape, made.unit));
  };
  const auto longest_of = [](const std::vector<std::vector<float>>& residuals) {
    float longest = 0;
    for (const std::vector<float>& mesh : residuals) {
      for (const float left : mesh) longest = std::max(longest, left);
    }
    return longest;
  };
  // One scale for all, so that they can be compared, and one that does not exaggerate invisible
  // differences.
  float longest = 0.005f * studio.options.scale;
  for (const ShownShape& shown : shapes) longest = std::max(longest, longest_of(pose(shown)));

  const auto draw_heat = [&](const std::vector<std::vector<float>>& residuals) {
    std::vector<std::vector<uint8_t>> colors;
    for (const std::vector<float>& mesh : residuals) {
      std::vector<uint8_t>& painted = colors.emplace_back(3 * mesh.size());
      for (size_t p = 0; p < mesh.size(); ++p) {
        paint(painted, p, heat_color(mesh[p] * mesh[p] / (longest * longest)));
      }
    }
    return render_image(colored(scene, colors), camera, studio.options);
  };

  render::Sheet sheet = studio.sheet(3 + 3 * shapes.size(), 6);
  sheet.add(studio.draw({}, camera), "mesh");
  pose_scene(scene, {});
  sheet.add(render_image(scene.surfaces(), camera, studio.options), "rig at rest");
  Image rest = draw_heat(find_residuals(scene, places, source.positions()));
  std::vector<LegendLine> lines;
  for (const float share : {0.0f, 0.25f, 0.5f, 1.0f}) {
    lines.push_back({heat_color(share * share), share > 0 ? millimeters(share * longest) : "0"});
  }
  draw_legend(rest, lines, studio.text_size() * 1.2f, kInk);
  sheet.add(rest, "left to do");
  for (const ShownShape& shown : shapes) {
    const std::vector<float> wanted = shaped(source, *shown.shape, made.unit);
    sheet.add(render_image(source.surfaces({}, wanted), camera, studio.options), shown.shape->name);
    const std::vector<std::vector<float>> residuals = pose(shown);
    char error[32];
    std::snprintf(error, sizeof(error), "rig: %.1f %% off", 100 * shown.error);
    sheet.add(render_image(scene.surfaces(), camera, studio.options), error);
    sheet.add(draw_heat(residuals), "up to " + millimeters(longest_of(residuals)));
  }
  return sheet.image();
}

}  // namespace mien::cli::author_images
