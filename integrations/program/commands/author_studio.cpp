// SPDX-License-Identifier: MIT
#include "integrations/program/commands/author_studio.h"

#include <algorithm>
#include <cmath>

#include "integrations/program/render/visibility.h"
#include "integrations/program/scene/mesh_material.h"

namespace mien::cli::author_images {

using math::Vec3;
using render::Camera;
using render::Surface;

namespace {

// One color: gradients would take half of the bytes.
constexpr render::Backdrop kBackdrop = {{228, 230, 232}, {228, 230, 232}};

Vec3 point_of(const Json& json) {
  return {json[0].get<float>(), json[1].get<float>(), json[2].get<float>()};
}

}  // namespace

Source::Source(const MadeRig& made) : axes_(made.scene.axes) {
  const MeshFile& mesh = made.mesh;
  for (const double value : mesh.positions) {
    positions_.push_back(static_cast<float>(value * made.unit) + 0.0f);  // no negative zeros
  }
  std::vector<size_t> first_corner = {0};
  for (const uint32_t size : mesh.face_sizes) first_corner.push_back(first_corner.back() + size);
  for (const MeshObject& from : mesh.objects) {
    Object object = {mesh_class(from.name), {}};
    if (needs_textures(object.mesh_class)) continue;
    for (uint32_t f = from.first_face; f < from.first_face + from.face_count; ++f) {
      const uint32_t* face = mesh.corners.data() + first_corner[f];
      for (uint32_t k = 2; k < mesh.face_sizes[f]; ++k) {
        object.triangles.insert(object.triangles.end(), {face[0], face[k - 1], face[k]});
      }
    }
    objects_.push_back(std::move(object));
  }
  for (const Json& v : made.report["mask"]) mask_.push_back(v.get<uint32_t>());
  paint_eyes();
  find_points();
}

void Source::paint_eyes() {
  for (const Object& object : objects_) {
    if (object.mesh_class != MeshClass::kEye) continue;
    eye_colors_.resize(positions_.size());
    std::vector<uint32_t> used = object.triangles;
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    std::vector<float> own;
    for (const uint32_t v : used) {
      own.insert(own.end(), positions_.data() + 3 * v, positions_.data() + 3 * v + 3);
    }
    const std::vector<uint8_t> colors =
        paint_eye(own.data(), static_cast<uint32_t>(used.size()), axes_.front);
    for (size_t i = 0; i < used.size(); ++i) {
      paint(eye_colors_, used[i], {colors[3 * i], colors[3 * i + 1], colors[3 * i + 2]});
    }
  }
}

void Source::find_points() {
  math::Box face, near, all;
  for (const uint32_t v : mask_) face.add(position(v));
  for (const Object& object : objects_) {
    for (const uint32_t v : object.triangles) all.add(position(v));
  }
  // A face may be little of a head, as that of an animal with a long muzzle.
  const bool is_head = face.empty() || length(all.size()) < 4 * length(face.size());
  const Vec3 margin = face.size() * 0.85f;
  near.add(face.min - margin);
  near.add(face.max + margin);
  for (const Object& object : objects_) {
    for (const uint32_t v : object.triangles) {
      const Vec3 p = position(v);
      const bool inside = p.x >= near.min.x && p.y >= near.min.y && p.z >= near.min.z &&
                          p.x <= near.max.x && p.y <= near.max.y && p.z <= near.max.z;
      if (inside || is_head) points_.push_back(p);
    }
  }
}

std::vector<Surface> Source::surfaces(const std::vector<uint8_t>& colors,
                                      const std::vector<float>& positions) const {
  std::vector<Surface> surfaces;
  for (const Object& object : objects_) {
    Surface surface;
    surface.positions = positions.data();
    surface.position_count = surface.vertex_count = count();
    surface.triangles = object.triangles.data();
    surface.triangle_count = object.triangles.size() / 3;
    surface.material = mesh_material(object.mesh_class);
    if (!colors.empty()) {
      surface.colors = colors.data();
      surface.material.softness = 0.1f;
      surface.material.roughness = 0.6f;
    } else if (object.mesh_class == MeshClass::kEye) {
      surface.colors = eye_colors_.data();
    }
    surfaces.push_back(surface);
  }
  return surfaces;
}

Studio::Studio(const Source& from, render::Size tile) : source(from), size(tile) {
  options.width = size.width;
  options.height = size.height;
  options.backdrop = kBackdrop;
  math::Box box;
  for (const Vec3& p : from.points()) box.add(p);
  options.scale = box.empty() ? 1 : length(box.size());
}

Camera Studio::camera(const render::View& view) const {
  return frame_points(source.axes(), view, source.points(), size.width, size.height);
}

Camera Studio::face_camera(const render::View& view) const {
  std::vector<Vec3> face;
  for (const uint32_t v : source.mask()) face.push_back(source.position(v));
  return frame_points(source.axes(), view, face.empty() ? source.points() : face, size.width,
                      size.height);
}

render::Image Studio::draw(const std::vector<uint8_t>& colors, const Camera& camera) const {
  return render_image(source.surfaces(colors, source.positions()), camera, options);
}

std::vector<float> Studio::distances(const Camera& camera) const {
  std::vector<Vec3> places;
  for (size_t v = 0; v < source.count(); ++v) places.push_back(camera.to_view(source.position(v)));
  render::Visibility seen;
  seen.reset(size.width, size.height, 1);
  const render::Lens lens = make_lens(camera, size.width, size.height);
  for (const Surface& surface : source.surfaces({}, source.positions())) {
    render::draw({places.data(), places.size(), nullptr, places.size(), surface.triangles,
                  surface.triangle_count, 1},
                 lens, seen);
  }
  std::vector<float> distances;
  for (const render::Seen& at : seen.seen) {
    distances.push_back(at.triangle ? 1 / at.depth : INFINITY);
  }
  return distances;
}

render::Sheet Studio::sheet(size_t count, size_t columns) const {
  return {{count, std::min(columns, count), size, true}, kBackdrop};
}

void paint(std::vector<uint8_t>& colors, size_t position, render::Color color) {
  colors[3 * position] = color.r;
  colors[3 * position + 1] = color.g;
  colors[3 * position + 2] = color.b;
}

std::vector<Bone> read_bones(const Source& source, const Json& report) {
  std::vector<Bone> bones;
  for (const Json& from : report["bones"]) {
    Bone bone;
    bone.name = from["name"].get<std::string>();
    bone.kind = from["kind"].get<std::string>();
    bone.position = point_of(from["position"]);
    bone.mirror = from["mirror"].get<size_t>();
    if (bone.kind == "facial") {
      bone.rank = from["rank"].get<size_t>();
      bone.color = kMiddle;
    }
    bones.push_back(std::move(bone));
  }
  for (size_t b = 0; b < bones.size(); ++b) {
    const size_t other = bones[b].mirror;
    if (bones[b].kind != "facial" || other == b || other >= bones.size()) continue;
    const Vec3 across = bones[b].position - bones[other].position;
    bones[b].color = dot(across, source.axes().left) > 0 ? kLeft : kRight;
  }
  return bones;
}

}  // namespace mien::cli::author_images
