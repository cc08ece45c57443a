// SPDX-License-Identifier: MIT
// GLB: every mesh of the scene where its node puts it, morph targets as shapes, materials with base color,
// roughness and normals. Skins and animations are skipped. What is compressed or lies in other files is refused.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/text.h"
#include "integrations/program/mesh/glb_data.h"

namespace mien::cli {

namespace {

using Json = GlbData::Json;
using Matrix = std::array<double, 12>;  // 3 rows of 4

constexpr int kMaxDepth = 256;
constexpr size_t kMaxTargets = 4096;  // each takes memory for all positions
// What looking at one of them takes, in numbers that are read in the same time.
constexpr size_t kNodeNumbers = 128, kPrimitiveNumbers = 256, kTargetNumbers = 64;

constexpr size_t kMaxMaterialName = 200;

/// %20 is a space.
std::string unescaped(const std::string& uri) {
  std::string path;
  for (size_t i = 0; i < uri.size(); ++i) {
    unsigned value = 0;
    const char* from = uri.data() + i + 1;
    const bool is_code = uri[i] == '%' && i + 2 < uri.size() &&
                         std::from_chars(from, from + 2, value, 16).ptr == from + 2 && value != 0;
    path += is_code ? static_cast<char>(value) : uri[i];
    if (is_code) i += 2;
  }
  return path;
}

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix out;
  for (size_t r = 0; r < 3; ++r) {
    for (size_t c = 0; c < 4; ++c) {
      double sum = c == 3 ? a[4 * r + 3] : 0;
      for (size_t k = 0; k < 3; ++k) sum += a[4 * r + k] * b[4 * k + c];
      out[4 * r + c] = sum;
    }
  }
  return out;
}

class Glb : GlbData {
 public:
  Glb(const std::string& bytes, const std::string& path) : GlbData(bytes, path) {}

  MeshFile read();

 private:
  std::vector<uint32_t> indices(size_t accessor, size_t below, const char* what);
  Matrix local_matrix(const Json& node) const;
  void add_node(size_t index, const Matrix& parent, int depth);
  /// Whether the positions are integers, whose scale is undone by the node or, if there is one, by the skin.
  bool has_integers(const Json& primitive) const;
  /// Where the first joint of the node's skin puts a mesh.
  Matrix skin_place(const Json& node);
  Matrix world_matrix(size_t node);
  std::string new_object_name(const Json& mesh);
  void add_primitive(const Json& mesh, const Json& primitive, const Matrix& place);
  /// Number of a material in the result, which is read when it is first used.
  uint32_t material_number(const Json& primitive);
  void read_texture_of(const Json& holder, const char* key, TextureKind kind,
                       MeshMaterial& material);
  double share(const Json& value, const char* what) const;

  MeshFile out_;
  std::map<std::string, size_t> shape_of_;
  std::set<std::string> object_names_;
  std::map<std::string, size_t> next_numbers_;  // of objects with the same name
  std::set<size_t> visited_;
  std::map<size_t, uint32_t> materials_, images_;  // numbers in the result
  std::map<size_t, Matrix> skin_places_;
  std::set<std::string> material_names_;
  bool all_have_uvs_ = true;
};

std::vector<uint32_t> Glb::indices(size_t accessor, size_t below, const char* what) {
  std::vector<uint32_t> out;
  for (const double value : numbers(accessor, 1, what)) {
    if (!(value >= 0 && value < static_cast<double>(below))) {
      fail("accessor " + std::to_string(accessor), std::string(what) + " names vertex " +
                                                       std::to_string(value) + " of " +
                                                       std::to_string(below));
    }
    out.push_back(static_cast<uint32_t>(value));
  }
  return out;
}

Matrix Glb::local_matrix(const Json& node) const {
  const auto array = [&](const char* key, std::vector<double> otherwise) {
    const Json& given = list(node, key);
    if (given.empty()) return otherwise;
    if (given.size() != otherwise.size())
      fail("", std::string("\"") + key + "\" of a node is wrong");
    for (size_t i = 0; i < given.size(); ++i) {
      if (!given[i].is_number()) fail("", std::string("\"") + key + "\" of a node is wrong");
      otherwise[i] = given[i].get<double>();
    }
    return otherwise;
  };
  Matrix out;
  if (node.contains("matrix")) {
    const std::vector<double> m = array("matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    for (size_t r = 0; r < 3; ++r) {
      for (size_t c = 0; c < 4; ++c) out[4 * r + c] = m[4 * c + r];
    }
    return out;
  }
  const std::vector<double> t = array("translation", {0, 0, 0}), s = array("scale", {1, 1, 1});
  const std::vector<double> q = array("rotation", {0, 0, 0, 1});
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  const double r[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                          {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                          {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
  for (size_t i = 0; i < 3; ++i) {
    for (size_t k = 0; k < 3; ++k) out[4 * i + k] = r[i][k] * s[k];
    out[4 * i + 3] = t[i];
  }
  return out;
}

bool Glb::has_integers(const Json& primitive) const {
  const auto attributes = primitive.find("attributes");
  if (attributes == primitive.end() || !attributes->is_object()) return false;
  const Json& positions = element("accessors", whole(*attributes, "POSITION", kMaxElements));
  return whole(positions, "componentType", 0) != 5126;
}

Matrix Glb::world_matrix(size_t node) {
  Matrix place = local_matrix(element("nodes", node));
  const Json& nodes = list(root(), "nodes");
  for (int depth = 0; depth < kMaxDepth; ++depth) {
    size_t parent = 0;
    for (; parent < nodes.size(); ++parent) {
      const Json& children = list(nodes[parent], "children");
      take_numbers(1 + children.size());
      if (std::find(children.begin(), children.end(), Json(node)) != children.end()) break;
    }
    if (parent == nodes.size()) return place;
    place = product(local_matrix(nodes[parent]), place);
    node = parent;
  }
  fail("node " + std::to_string(node), "it has over 256 ancestors");
}

Matrix Glb::skin_place(const Json& node) {
  const size_t number = whole(node, "skin", 0);
  const auto known = skin_places_.find(number);
  if (known != skin_places_.end()) return known->second;
  const Json& skin = element("skins", number);
  const Json& joints = list(skin, "joints");
  if (joints.empty() || !joints[0].is_number_unsigned()) {
    fail("skin " + std::to_string(number), "it has no joints");
  }
  Matrix place = world_matrix(joints[0].get<size_t>());
  if (skin.contains("inverseBindMatrices")) {
    const std::vector<double> m = numbers(whole(skin, "inverseBindMatrices", 0), 16, "a skin");
    if (m.size() < 16) fail("skin " + std::to_string(number), "it has no matrices");
    Matrix unbind;
    for (size_t r = 0; r < 3; ++r) {
      for (size_t c = 0; c < 4; ++c) unbind[4 * r + c] = m[4 * c + r];
    }
    place = product(place, unbind);
  }
  return skin_places_[number] = place;
}

/// The mesh's name, with a number if there is an object of this name.
std::string Glb::new_object_name(const Json& mesh) {
  const std::string name = text(mesh, "name").empty() ? "mesh" : text(mesh, "name");
  take_numbers(name.size());
  if (object_names_.insert(name).second) return name;
  size_t& number = next_numbers_.try_emplace(name, 2).first->second;
  for (;;) {
    const std::string numbered = name + "_" + std::to_string(number++);
    if (object_names_.insert(numbered).second) return numbered;
  }
}

void Glb::add_primitive(const Json& mesh, const Json& primitive, const Matrix& place) {
  take_numbers(kPrimitiveNumbers);
  if (!primitive.is_object() || !primitive.contains("attributes")) fail("", "a primitive is wrong");
  if (whole(primitive, "mode", 4) != 4) return;  // points and lines have no surface
  const Json& attributes = primitive["attributes"];
  if (!attributes.is_object() || !attributes.contains("POSITION")) return;
  const std::vector<double> local = numbers(whole(attributes, "POSITION", 0), 3, "POSITION");
  const size_t count = local.size() / 3, first = out_.position_count();
  const auto transform = [&](const double* p, double w, double* to) {
    for (size_t r = 0; r < 3; ++r) {
      to[r] = place[4 * r] * p[0] + place[4 * r + 1] * p[1] + place[4 * r + 2] * p[2] +
              place[4 * r + 3] * w;
    }
  };
  if (first + count > (size_t{1} << 24)) fail("", "more than 2^24 vertices", "make it smaller");
  out_.positions.resize(3 * (first + count));
  for (size_t v = 0; v < count; ++v) transform(&local[3 * v], 1, &out_.positions[3 * (first + v)]);

  std::vector<uint32_t> corners;
  if (primitive.contains("indices")) {
    corners = indices(whole(primitive, "indices", 0), count, "indices");
  } else {
    take_numbers(count);
    for (size_t v = 0; v < count; ++v) corners.push_back(static_cast<uint32_t>(v));
  }
  corners.resize(corners.size() / 3 * 3);
  const uint32_t first_uv = static_cast<uint32_t>(out_.uvs.size() / 2);
  if (attributes.contains("TEXCOORD_0")) {
    const std::vector<double> uvs = numbers(whole(attributes, "TEXCOORD_0", 0), 2, "TEXCOORD_0");
    if (uvs.size() != 2 * count) fail("", "TEXCOORD_0 and POSITION have different counts");
    // An image's first row is at v = 0 in glTF, its last one elsewhere.
    for (size_t v = 0; v < count; ++v) {
      out_.uvs.push_back(uvs[2 * v]);
      out_.uvs.push_back(1 - uvs[2 * v + 1]);
    }
  } else {
    all_have_uvs_ = false;
  }
  const auto first_face = static_cast<uint32_t>(out_.face_sizes.size());
  const auto face_count = static_cast<uint32_t>(corners.size() / 3);
  for (const uint32_t corner : corners) {
    out_.corners.push_back(static_cast<uint32_t>(first) + corner);
    out_.corner_uvs.push_back(first_uv + corner);
  }
  out_.face_sizes.insert(out_.face_sizes.end(), face_count, 3);
  if (face_count > 0) {
    const uint32_t material = material_number(primitive);
    out_.objects.push_back({new_object_name(mesh), first_face, face_count, material});
  }

  const Json& targets = list(primitive, "targets");
  const Json& names =
      mesh.contains("extras") ? list(mesh["extras"], "targetNames") : list(mesh, "");
  for (size_t t = 0; t < targets.size(); ++t) {
    std::string shape_name = t < names.size() && names[t].is_string()
                                 ? names[t].get<std::string>()
                                 : "target_" + std::to_string(t);
    if (shape_name.empty()) shape_name = "target_" + std::to_string(t);
    take_numbers(kTargetNumbers + shape_name.size());
    const auto [it, added] = shape_of_.emplace(shape_name, out_.shapes.size());
    if (added) {
      if (out_.shapes.size() == kMaxTargets) {
        fail("", "more than " + std::to_string(kMaxTargets) + " morph targets", "make it smaller");
      }
      out_.shapes.emplace_back();
      out_.shapes.back().name = shape_name;
    }
    if (!targets[t].is_object() || !targets[t].contains("POSITION")) continue;
    const std::vector<double> deltas = numbers(whole(targets[t], "POSITION", 0), 3, "a target");
    if (deltas.size() != local.size()) fail("", "a target has another count than its mesh");
    MeshShape& shape = out_.shapes[it->second];
    for (size_t v = 0; v < count; ++v) {
      if (deltas[3 * v] == 0 && deltas[3 * v + 1] == 0 && deltas[3 * v + 2] == 0) continue;
      double moved[3];
      transform(&deltas[3 * v], 0, moved);
      shape.vertices.push_back(static_cast<uint32_t>(first + v));
      shape.displacements.insert(shape.displacements.end(), moved, moved + 3);
    }
  }
}

double Glb::share(const Json& value, const char* what) const {
  const double number = value.is_number() ? value.get<double>() : -1;
  if (!(number >= 0 && number <= 1)) {
    fail("", std::string(what) + " of a material is not a number from 0 to 1");
  }
  return number;
}

void Glb::read_texture_of(const Json& holder, const char* key, TextureKind kind,
                          MeshMaterial& material) {
  const auto info = holder.find(key);
  if (info == holder.end()) return;
  if (!info->is_object()) fail("", std::string(key) + " of a material is wrong");
  if (whole(*info, "texCoord", 0) != 0) {
    out_.material_problems.push_back("material " + one_line(material.surface.name) +
                                     " has a texture for other texture coordinates");
    return;
  }
  const Json& texture = element("textures", whole(*info, "index", 0));
  if (!texture.contains("source")) return;  // of an extension
  const size_t number = whole(texture, "source", 0);
  const Json& image = element("images", number);
  const std::string uri = text(image, "uri");
  if (uri.compare(0, 5, "data:") == 0) {
    out_.material_problems.push_back("image " + std::to_string(number) + " is a data: address");
    return;
  }
  if (!uri.empty()) {
    if (uri.size() > kMaxPathBytes) fail("", "the address of an image is longer than 4095 bytes");
    const std::filesystem::path folder = std::filesystem::path(path()).parent_path();
    material.surface.textures[size_t(kind)] = (folder / unescaped(uri)).lexically_normal().string();
    return;
  }
  const auto known = images_.find(number);
  if (known != images_.end()) {
    material.images[size_t(kind)] = known->second;
    return;
  }
  const Json& view = element("bufferViews", whole(image, "bufferView", kMaxElements));
  const size_t begin = whole(view, "byteOffset", 0), length = whole(view, "byteLength", 0);
  if (begin > binary().size() || length > binary().size() - begin) {
    fail("image " + std::to_string(number), "it does not lie within the file");
  }
  take_numbers(length);
  material.images[size_t(kind)] = static_cast<uint32_t>(out_.images.size());
  images_[number] = material.images[size_t(kind)];
  out_.images.push_back(texture_of(std::string(binary().substr(begin, length)),
                                   one_line(path()) + ", image " + std::to_string(number)));
}

uint32_t Glb::material_number(const Json& primitive) {
  if (!primitive.contains("material")) return kNoMaterial;
  const size_t index = whole(primitive, "material", 0);
  const auto [it, is_new] = materials_.emplace(index, static_cast<uint32_t>(out_.materials.size()));
  if (!is_new) return it->second;
  const uint32_t number = it->second;
  if (out_.materials.size() == kMaxMeshMaterials) fail("", "more than 4096 materials");
  const Json& from = element("materials", index);
  MeshMaterial material;
  SurfaceMaterial& surface = material.surface;
  surface.name = text(from, "name").substr(0, kMaxMaterialName);
  if (surface.name.empty()) surface.name = "material_" + std::to_string(index);
  while (!material_names_.insert(surface.name).second) surface.name += "_" + std::to_string(index);
  // What is not said is 1 there.
  surface.color = {1, 1, 1, 1};
  surface.roughness = 1;
  surface.has_color = surface.has_roughness = true;
  read_texture_of(from, "normalTexture", TextureKind::kNormal, material);
  if (text(from, "alphaMode") == "MASK") {
    surface.alpha_cutoff =
        from.contains("alphaCutoff") ? share(from["alphaCutoff"], "the cutoff of a material") : 0.5;
  }
  const auto pbr = from.find("pbrMetallicRoughness");
  if (pbr != from.end() && pbr->is_object()) {
    const Json& color = list(*pbr, "baseColorFactor");
    if (!color.empty() && color.size() != 4) fail("", "baseColorFactor of a material is wrong");
    for (size_t i = 0; i < color.size(); ++i) surface.color[i] = share(color[i], "a color");
    if (pbr->contains("roughnessFactor")) {
      surface.roughness = share((*pbr)["roughnessFactor"], "the roughness");
    }
    read_texture_of(*pbr, "baseColorTexture", TextureKind::kBaseColor, material);
    read_texture_of(*pbr, "metallicRoughnessTexture", TextureKind::kRoughness, material);
  }
  out_.materials.push_back(std::move(material));
  return number;
}

void Glb::add_node(size_t index, const Matrix& parent, int depth) {
  const Json& node = element("nodes", index);
  take_numbers(kNodeNumbers);
  // A node that comes back would never end.
  if (depth > kMaxDepth || !visited_.insert(index).second) {
    fail("node " + std::to_string(index), "it has several parents or over 256 ancestors");
  }
  const Matrix place = product(parent, local_matrix(node));
  if (node.contains("mesh")) {
    const Json& mesh = element("meshes", whole(node, "mesh", 0));
    // A skinned mesh is where its joints put it; its own node does not count.
    const Matrix identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    for (const Json& primitive : list(mesh, "primitives")) {
      add_primitive(mesh, primitive,
                    !node.contains("skin")    ? place
                    : has_integers(primitive) ? skin_place(node)
                                              : identity);
    }
  }
  for (const Json& child : list(node, "children")) {
    if (!child.is_number_unsigned())
      fail("node " + std::to_string(index), "a child is not a number");
    add_node(child.get<size_t>(), place, depth + 1);
  }
}

MeshFile Glb::read() {
  const Matrix identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  if (!list(root(), "scenes").empty()) {
    for (const Json& node : list(element("scenes", whole(root(), "scene", 0)), "nodes")) {
      if (!node.is_number_unsigned()) fail("", "a node of the scene is not a number");
      add_node(node.get<size_t>(), identity, 0);
    }
  } else {
    for (size_t node = 0; node < list(root(), "nodes").size(); ++node) {
      if (visited_.count(node) == 0) add_node(node, identity, 0);
    }
  }
  if (!all_have_uvs_) {
    out_.uvs.clear();
    out_.corner_uvs.clear();
  }
  for (MeshShape& shape : out_.shapes) {
    if (!shape.vertices.empty()) continue;
    shape.vertices = {0};
    shape.displacements = {0, 0, 0};
  }
  out_.in_meters = true;
  return std::move(out_);
}

}  // namespace

MeshFile read_glb(const std::string& bytes, const std::string& path) {
  return Glb(bytes, path).read();
}

}  // namespace mien::cli
