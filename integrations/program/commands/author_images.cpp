// SPDX-License-Identifier: MIT
#include "integrations/program/commands/author_images.h"

#include <algorithm>
#include <cmath>

#include "integrations/program/commands/author_studio.h"
#include "integrations/program/render/marks.h"

namespace mien::cli::author_images {

namespace {

using math::Vec3;
using render::Camera;
using render::Color;
using render::Image;
using render::LegendLine;
using render::Spot;
using render::Surface;

constexpr Color kMask = {232, 150, 92};

/// A color for each of `count` things that lie in a row.
Color color_in_row(size_t index, size_t count) {
  constexpr Color kRow[] = {{226, 112, 74}, {98, 168, 132}, {92, 116, 186}};
  const float at = count < 2 ? 0 : 2 * static_cast<float>(index) / static_cast<float>(count - 1);
  const size_t low = std::min(static_cast<size_t>(at), size_t{1});
  return render::to_srgb(mix(render::to_linear(kRow[low]), render::to_linear(kRow[low + 1]),
                             at - static_cast<float>(low)));
}

std::vector<uint8_t> plain_colors(const Source& source) {
  std::vector<uint8_t> colors(3 * source.count());
  for (size_t v = 0; v < source.count(); ++v) paint(colors, v, kPlain);
  return colors;
}

// Groups and mask ------------------------------------------------------------------------------------

Image draw_groups(const Source& source, const Json& groups) {
  const std::vector<float> borders = groups["borders"].get<std::vector<float>>();
  const std::vector<uint64_t> counts = groups["counts"].get<std::vector<uint64_t>>();
  std::vector<uint8_t> colors(3 * source.count());
  for (size_t v = 0; v < source.count(); ++v) {
    const float depth = dot(source.position(v), source.axes().front);
    size_t group = 0;
    while (group < borders.size() && depth < borders[group]) ++group;
    paint(colors, v, color_in_row(group, counts.size()));
  }
  const Studio studio(source, kTile);
  render::Sheet sheet = studio.sheet(3, 3);
  for (const auto& [view, name] :
       {std::pair{kFront, "front"}, std::pair{kThreeQuarter, "groups in depth"},
        std::pair{kSide, "side"}}) {
    Image image = studio.draw(colors, studio.camera(view));
    if (view.yaw == kFront.yaw) {
      std::vector<LegendLine> lines;
      for (size_t g = 0; g < counts.size(); ++g) {
        const std::string number = "group " + std::to_string(g + 1);
        const std::string name_of_group = counts.size() != 3 ? number
                                          : g == 0           ? "face"
                                          : g == 1           ? "middle"
                                                             : "back";
        lines.push_back(
            {color_in_row(g, counts.size()), name_of_group + " " + std::to_string(counts[g])});
      }
      draw_legend(image, lines, studio.text_size(), kInk);
    }
    sheet.add(image, name);
  }
  return sheet.image();
}

Image draw_mask(const Source& source) {
  std::vector<uint8_t> colors = plain_colors(source);
  for (const uint32_t v : source.mask()) paint(colors, v, kMask);
  const Studio studio(source, kTile);
  render::Sheet sheet = studio.sheet(3, 3);
  const std::string count = std::to_string(source.mask().size()) + " positions of the face";
  sheet.add(studio.draw(colors, studio.camera(kFront)), "front");
  sheet.add(studio.draw(colors, studio.camera(kThreeQuarter)), count);
  sheet.add(studio.draw(colors, studio.camera(kSide)), "side");
  return sheet.image();
}

// Bones ----------------------------------------------------------------------------------------------

float dot_radius(const Studio& studio, const Camera& camera, float spacing) {
  const Vec3 at = studio.source.points().empty() ? Vec3{} : studio.source.points()[0];
  const Spot a = find_spot(camera, studio.size, at);
  const Spot b = find_spot(camera, studio.size, at + camera.right * spacing);
  return std::clamp(std::fabs(b.x - a.x) * 0.24f, 1.2f, 5.0f);
}

/// Facial bones whose rank is below `count` and which lie less than `depth` below what is seen.
void mark_facial(Image& image, const std::vector<Bone>& bones, const Studio& studio,
                 const Camera& camera, size_t count, float depth, float radius) {
  const std::vector<float> distances = studio.distances(camera);
  for (const Bone& bone : bones) {
    if (bone.kind != "facial" || bone.rank >= count) continue;
    const Spot spot = find_spot(camera, studio.size, bone.position);
    const int x = static_cast<int>(spot.x), y = static_cast<int>(spot.y);
    if (!spot.seen || x < 0 || y < 0 || x >= image.width || y >= image.height) continue;
    const float seen = distances[static_cast<size_t>(y) * static_cast<size_t>(image.width) +
                                 static_cast<size_t>(x)];
    if (-camera.to_view(bone.position).z > seen + depth) continue;
    draw_dot(image, spot, radius, bone.color);
  }
}

/// Neck, head, jaw and eyes: seen through the skin.
void mark_inner(Image& image, const std::vector<Bone>& bones, const Studio& studio,
                const Camera& camera) {
  const auto spot = [&](Vec3 p) { return find_spot(camera, studio.size, p); };
  math::Box box;
  for (const Vec3& p : studio.source.points()) box.add(p);
  const Vec3 up = studio.source.axes().up, front = studio.source.axes().front;
  const auto top = [&](Vec3 along, Vec3 from) {
    const Vec3 corner = {along.x > 0 ? box.max.x : box.min.x, along.y > 0 ? box.max.y : box.min.y,
                         along.z > 0 ? box.max.z : box.min.z};
    return dot(corner - from, along);
  };
  Vec3 head;
  for (const Bone& bone : bones) {
    if (bone.kind == "head") head = bone.position;
  }
  for (const Bone& bone : bones) {
    const Vec3 p = bone.position;
    if (bone.kind == "neck") draw_bone(image, spot(p), spot(head), bone.color);
    // Ends that no joint tells: the crown, and what the joint turns.
    if (bone.kind == "head")
      draw_bone(image, spot(p), spot(p + up * (0.9f * top(up, p))), bone.color);
    if (bone.kind == "eye")
      draw_bone(image, spot(p), spot(p + front * (0.06f * studio.options.scale)), bone.color);
    if (bone.kind == "jaw") {
      Vec3 chin = p;
      float lowest = INFINITY;
      for (const uint32_t v : studio.source.mask()) {
        const Vec3 q = studio.source.position(v);
        const float score = dot(q, up) - dot(q, front);
        if (score < lowest) lowest = score, chin = q;
      }
      draw_bone(image, spot(p), spot(p + (chin - p) * 0.85f), bone.color);
    }
  }
}

Image draw_bones(const Source& source, const std::vector<Bone>& bones, float spacing) {
  const std::vector<uint8_t> colors = plain_colors(source);
  const Studio studio(source, kTile);
  render::Sheet sheet = studio.sheet(3, 3);
  size_t facial = 0, others = 0;
  bool pairs = false;
  for (const Bone& bone : bones) {
    ++(bone.kind == "facial" ? facial : others);
    pairs = pairs || (bone.kind == "facial" && bone.color == kRight);
  }
  for (const auto& [view, name] :
       {std::pair{kFront, std::string("front")},
        std::pair{kThreeQuarter,
                  std::to_string(facial) + " facial joints, " + std::to_string(others) + " others"},
        std::pair{kSide, std::string("side")}}) {
    const Camera camera = studio.camera(view);
    Image image = studio.draw(colors, camera);
    mark_inner(image, bones, studio, camera);
    mark_facial(image, bones, studio, camera, facial, spacing, dot_radius(studio, camera, spacing));
    if (view.yaw == kFront.yaw) {
      std::vector<LegendLine> lines = {{kInner, "neck, head, jaw, eyes"}};
      if (pairs) {
        lines.insert(lines.end(), {{kLeft, "left"}, {kRight, "right"}, {kMiddle, "middle"}});
      } else {
        lines.push_back({kMiddle, "facial"});
      }
      draw_legend(image, lines, studio.text_size(), kInk);
    }
    sheet.add(image, name);
  }
  return sheet.image();
}

/// The expression that moves most, if there is one.
const MeshShape* find_strongest(const MeshFile& mesh) {
  const MeshShape* strongest = nullptr;
  double most = 0;
  for (const MeshShape& shape : mesh.shapes) {
    double energy = 0;
    for (const double d : shape.displacements) energy += d * d;
    if (!(energy > most)) continue;
    most = energy;
    strongest = &shape;
  }
  return strongest;
}

/// Each LOD at rest with its joints, and in the expression that moves most.
Image draw_lods(const MadeRig& made, const Source& source, const std::vector<Bone>& bones,
                const Session& session) {
  const Json& report = made.report;
  const Json& lods = report["lods"];
  Studio studio(source, kSmallTile);
  const Camera camera = studio.camera(kFront);
  const MeshShape* shape = find_strongest(made.mesh);
  Frame posed;
  uint32_t control = 0;
  if (shape && mien_rig_find(made.scene.rig.get(), MIEN_KIND_RAW_CONTROL, shape->name.c_str(),
                             &control) == MIEN_OK) {
    posed.raw.push_back({control, 1.0f});
  }
  const size_t rows = posed.raw.empty() ? 1 : 2;
  render::Sheet sheet = studio.sheet(rows * lods.size(), std::min(lods.size(), size_t{4}));
  const float spacing = report["spacing"].get<float>();
  const float radius = std::max(dot_radius(studio, camera, spacing), 2.5f);
  const auto draw = [&](size_t lod, const Frame& frame, bool wireframe) {
    show_lod(made.scene, static_cast<uint32_t>(lod), session);
    pose_scene(made.scene, frame);
    studio.options.wireframe = wireframe;
    return render_image(made.scene.surfaces(), camera, studio.options);
  };
  for (size_t first = 0; first < lods.size(); first += 4) {
    const size_t end = std::min(first + 4, lods.size());
    for (size_t lod = first; lod < end; ++lod) {
      Image image = draw(lod, {}, true);
      const size_t count = lods[lod]["facial_joints"].get<size_t>();
      mark_facial(image, bones, studio, camera, count, spacing, radius);
      sheet.add(image,
                "LOD " + std::to_string(lod) + ": " + std::to_string(count) + " facial joints");
    }
    for (size_t lod = first; lod < end && rows == 2; ++lod) {
      sheet.add(draw(lod, posed, false),
                std::to_string(lods[lod]["triangles"].get<size_t>()) + " triangles");
    }
  }
  show_lod(made.scene, 0, session);
  return sheet.image();
}

}  // namespace

}  // namespace mien::cli::author_images

namespace mien::cli {

std::vector<AuthorImage> draw_author_images(const MadeRig& made, const Session& session) {
  using namespace author_images;
  const Json& report = made.report;
  const Source source(made);
  const std::vector<Bone> bones = read_bones(source, report);
  std::vector<AuthorImage> images;
  Progress progress(session, "image", 7);
  // Groups in space have no borders in depth to draw them by.
  if (!report["face_only"].get<bool>() && !report["groups"]["borders"].empty()) {
    images.push_back({"groups.png", draw_groups(source, report["groups"])});
  }
  progress.at(1);
  images.push_back({"mask.png", draw_mask(source)});
  progress.at(2);
  images.push_back({"bones.png", draw_bones(source, bones, report["spacing"].get<float>())});
  progress.at(3);
  if (report["lods"].size() > 1) {
    images.push_back({"lods.png", draw_lods(made, source, bones, session)});
  }
  progress.at(4);
  images.push_back({"weights.png", draw_weights(made, source, bones)});
  progress.at(5);
  images.push_back({"head-turn.png", draw_head_turns(made, source, bones)});
  progress.at(6);
  if (!report["jaw"].is_null()) images.push_back({"jaw.png", draw_jaw(made, source, bones)});
  if (!report["gaze"].empty()) images.push_back({"eyes.png", draw_eyes(made, source, bones)});
  if (!report["fit"].is_null()) images.push_back({"shapes.png", draw_shapes(made, source)});
  return images;
}

}  // namespace mien::cli
