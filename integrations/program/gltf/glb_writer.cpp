// SPDX-License-Identifier: MIT
#include "integrations/program/gltf/glb_writer.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>

#include "integrations/program/gltf/vrm.h"

namespace mien::gltf {

namespace {

using json = nlohmann::ordered_json;
using math::Matrix;
using math::Transform;

// Numbers of the glTF specification.
enum ComponentType : int { kS8 = 5120, kU8, kS16, kU16, kU32 = 5125, kF32 };
enum ViewTarget : int { kOtherData = 0, kVertexData = 34962, kIndexData = 34963 };

constexpr const char* kShapes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};

/// A list of one. (Compilers do not agree on what braces around one value mean.)
json list_of(json value) {
  json list = json::array();
  list.push_back(std::move(value));
  return list;
}

size_t size_of(ComponentType type) {
  return type == kS8 || type == kU8 ? 1 : type == kS16 || type == kU16 ? 2 : 4;
}

/// How vectors of three are written: as floats, or as normalized integers that a reader multiplies
/// by `scale` and moves by `center`.
struct Packing {
  ComponentType type = kF32;
  math::Vec3d center;
  double scale = 1;

  bool is_float() const { return type == kF32; }
  /// In an attribute every vertex begins at a multiple of four.
  size_t stride() const { return type == kF32 ? 12 : type == kS16 ? 8 : 4; }

  std::array<int, 3> packed(const Float3& values) const {
    const double most = type == kS16 ? 32767 : 127;
    std::array<int, 3> result{};
    for (int i = 0; i < 3; ++i) {
      const double share = (values[size_t(i)] - center[i]) / scale;
      result[size_t(i)] = static_cast<int>(std::lround(std::clamp(share, -1.0, 1.0) * most));
    }
    return result;
  }
};

/// The packings of a file.
struct Packings {
  bool quantized = false;  // by the extension
  bool shares = false;     // weights and texture coordinates are 16-bit shares of 1
  Packing positions, moves, normals, turns;
};

/// The binary part, and what the JSON part says about it.
class Data {
 public:
  std::string bytes;
  json views = json::array(), accessors = json::array();

  /// What follows is about this part of the scene; for messages.
  void about(const std::string& part) { part_ = part; }

  /// Views do not overlap: one begins when the last has ended.
  void begin_view() { view_begin_ = bytes.size(); }

  /// `stride` is needed where several vertex attributes share the view.
  void end_view(ViewTarget target, size_t stride = 0) {
    json view = {{"buffer", 0}, {"byteOffset", view_begin_}};
    view["byteLength"] = bytes.size() - view_begin_;
    if (stride != 0) view["byteStride"] = stride;
    if (target != kOtherData) view["target"] = static_cast<int>(target);
    views.push_back(std::move(view));
    align();
  }

  /// Number of the view that begin_view() began.
  size_t current_view() const { return views.size(); }
  size_t offset_in_view() const { return bytes.size() - view_begin_; }

  void put(uint32_t value, ComponentType type) {
    for (size_t i = 0; i < size_of(type); ++i) bytes += static_cast<char>(value >> (8 * i) & 255);
  }

  void put(float value) {
    check_finite(std::array<float, 1>{value});
    uint32_t bits;
    std::memcpy(&bits, &value, sizeof(bits));
    put(bits, kF32);
  }

  template <size_t n>
  void put(const std::array<float, n>& values) {
    for (const float value : values) put(value);
  }

  template <size_t n>
  void check_finite(const std::array<float, n>& values) const {
    for (const float value : values) {
      if (std::isfinite(value)) continue;
      throw ExportError(MIEN_ERROR_DNA_VALUE, part_, "a value is not a finite number",
                        "see 'mien validate', or give smaller controls");
    }
  }

  /// Everything begins at a multiple of four.
  void align() { bytes.resize((bytes.size() + 3) / 4 * 4); }

  size_t add_accessor(json accessor) {
    accessors.push_back(std::move(accessor));
    return accessors.size() - 1;
  }

  /// A view of its own with an accessor for all of it.
  template <size_t n>
  size_t add(const std::vector<std::array<float, n>>& values, ViewTarget target) {
    begin_view();
    const size_t accessor = append(values);
    end_view(target);
    return accessor;
  }

  /// The same within the view that was begun.
  template <size_t n>
  size_t append(const std::vector<std::array<float, n>>& values) {
    json accessor = accessor_here(kF32, values.size(), kShapes[n]);
    for (const auto& value : values) put(value);
    return add_accessor(std::move(accessor));
  }

  size_t append(const std::vector<float>& values, bool with_bounds = false) {
    json accessor = accessor_here(kF32, values.size(), "SCALAR");
    if (with_bounds) {
      const auto [least, most] = std::minmax_element(values.begin(), values.end());
      accessor["min"] = json::array({*least});
      accessor["max"] = json::array({*most});
    }
    for (const float value : values) put(value);
    return add_accessor(std::move(accessor));
  }

  /// Vectors in this packing, as an attribute (with its stride) or close together.
  void put(const std::vector<Float3>& values, const Packing& packing, bool as_attribute) {
    for (const Float3& value : values) {
      if (packing.is_float()) {
        put(value);
        continue;
      }
      check_finite(value);
      for (const int component : packing.packed(value)) {
        put(static_cast<uint32_t>(component), packing.type);
      }
      if (as_attribute) align();
    }
  }

  /// A view of its own.
  size_t add_attribute(const std::vector<Float3>& values, const Packing& packing,
                       bool with_bounds) {
    begin_view();
    json accessor = accessor_here(packing.type, values.size(), "VEC3");
    describe(accessor, values, packing, with_bounds, false);
    put(values, packing, true);
    end_view(kVertexData, packing.is_float() ? 0 : packing.stride());
    return add_accessor(std::move(accessor));
  }

  static void describe(json& accessor, const std::vector<Float3>& values, const Packing& packing,
                       bool with_bounds, bool with_zero) {
    if (!packing.is_float()) accessor["normalized"] = true;
    if (!with_bounds) return;
    if (packing.is_float()) return set_bounds(accessor, values.data(), values.size(), with_zero);
    std::vector<std::array<int, 3>> packed;
    for (const Float3& value : values) packed.push_back(packing.packed(value));
    set_bounds(accessor, packed.data(), packed.size(), with_zero);
  }

  json accessor_here(ComponentType type, size_t count, const char* shape) const {
    json accessor = {{"bufferView", current_view()}};
    if (offset_in_view() != 0) accessor["byteOffset"] = offset_in_view();
    accessor["componentType"] = static_cast<int>(type);
    accessor["count"] = count;
    accessor["type"] = shape;
    return accessor;
  }

  template <class T, size_t n>
  static void set_bounds(json& accessor, const std::array<T, n>* values, size_t count,
                         bool with_zero) {
    std::array<T, n> least{}, most{};
    if (!with_zero && count != 0) least = most = values[0];
    for (size_t i = 0; i < count; ++i) {
      for (size_t k = 0; k < n; ++k) {
        least[k] = std::min(least[k], values[i][k]);
        most[k] = std::max(most[k], values[i][k]);
      }
    }
    accessor["min"] = least;
    accessor["max"] = most;
  }

 private:
  std::string part_;
  size_t view_begin_ = 0;
};

// Quantization ------------------------------------------------------------------------------------

/// One cube holds all positions, because one skin undoes its scale; moves have its scale too. Turns of
/// normals end at 1, which is 60 degrees: readers normalize.
Packings packings_of(const Scene& scene) {
  math::Boxd box;
  double longest = 0;
  const auto vector = [](const Float3& v) { return math::Vec3d{v[0], v[1], v[2]}; };
  for (const Mesh& mesh : scene.meshes) {
    for (const Float3& position : mesh.positions) box.add(vector(position));
    for (const MorphTarget& target : mesh.targets) {
      for (const Float3& move : target.positions) {
        for (const float value : move) longest = std::max(longest, std::abs(double{value}));
      }
    }
  }
  Packings packings;
  packings.quantized = packings.shares = true;
  if (!box.empty()) {
    const math::Vec3d size = box.size();
    longest = std::max({longest, size.x / 2, size.y / 2, size.z / 2});
    packings.positions.center = box.center();
  }
  if (!(longest > 0)) longest = 1;
  packings.positions.type = packings.moves.type = kS16;
  packings.positions.scale = packings.moves.scale = longest;
  packings.normals.type = packings.turns.type = kS8;
  return packings;
}

// Meshes ------------------------------------------------------------------------------------------

/// Displacements of some of `count` vertices, of which the others have none: of positions or normals.
class Displacements {
 public:
  Displacements(const std::vector<uint32_t>& vertices, const std::vector<Float3>& values,
                const Packing& packing, size_t count)
      : vertices_(vertices), values_(values), packing_(packing), count_(count),
        index_type_(count <= 65536 ? kU16 : kU32) {}

  bool is_dense() const {
    const size_t entry = size_of(index_type_) + 3 * size_of(packing_.type);
    return vertices_.size() * entry >= count_ * packing_.stride();
  }

  size_t put_sparse(Data& data, bool with_bounds) const {
    json accessor = {
        {"componentType", static_cast<int>(packing_.type)}, {"count", count_}, {"type", "VEC3"}};
    Data::describe(accessor, values_, packing_, with_bounds, true);
    // Without sparse values all are 0.
    if (!values_.empty()) {
      json indices = {{"bufferView", data.current_view()}, {"byteOffset", data.offset_in_view()}};
      indices["componentType"] = static_cast<int>(index_type_);
      for (const uint32_t vertex : vertices_) data.put(vertex, index_type_);
      data.align();
      json values = {{"bufferView", data.current_view()}, {"byteOffset", data.offset_in_view()}};
      data.put(values_, packing_, false);
      data.align();
      accessor["sparse"] = {{"count", values_.size()},
                            {"indices", std::move(indices)},
                            {"values", std::move(values)}};
    }
    return data.add_accessor(std::move(accessor));
  }

  size_t put_dense(Data& data, bool with_bounds) const {
    std::vector<Float3> all(count_, Float3{});
    for (size_t i = 0; i < values_.size(); ++i) all[vertices_[i]] = values_[i];
    json accessor = data.accessor_here(packing_.type, count_, "VEC3");
    Data::describe(accessor, all, packing_, with_bounds, false);
    data.put(all, packing_, true);
    return data.add_accessor(std::move(accessor));
  }

 private:
  const std::vector<uint32_t>& vertices_;
  const std::vector<Float3>& values_;
  const Packing& packing_;
  size_t count_;
  ComponentType index_type_;
};

/// All sparse data of a mesh is in one view; viewers upload those of dense data.
json add_targets(Data& data, const Mesh& mesh, const Packings& packings) {
  const size_t count = mesh.positions.size();
  // Either all targets of a mesh move normals, or none.
  const bool with_normals =
      std::any_of(mesh.targets.begin(), mesh.targets.end(),
                  [](const MorphTarget& target) { return !target.normals.empty(); });
  struct Attribute {
    const char* name;
    const Packing& packing;
    const std::vector<uint32_t> MorphTarget::*vertices;
    const std::vector<Float3> MorphTarget::*values;
  };
  std::vector<Attribute> attributes = {
      {"POSITION", packings.moves, &MorphTarget::vertices, &MorphTarget::positions}};
  if (with_normals) {
    attributes.push_back(
        {"NORMAL", packings.turns, &MorphTarget::normal_vertices, &MorphTarget::normals});
  }

  json targets = json::array();
  for (size_t i = 0; i < mesh.targets.size(); ++i) targets.push_back(json::object());
  const auto add_those = [&](const Attribute& attribute, bool dense) {
    for (size_t i = 0; i < targets.size(); ++i) {
      const MorphTarget& target = mesh.targets[i];
      const Displacements moves(target.*attribute.vertices, target.*attribute.values,
                                attribute.packing, count);
      if (moves.is_dense() != dense) continue;
      data.about("mesh " + mesh.name + ", target " + target.name);
      const bool with_bounds = &attribute == &attributes[0];
      targets[i][attribute.name] =
          dense ? moves.put_dense(data, with_bounds) : moves.put_sparse(data, with_bounds);
    }
  };
  data.begin_view();
  for (const Attribute& attribute : attributes) add_those(attribute, false);
  if (data.offset_in_view() != 0) data.end_view(kOtherData);
  for (const Attribute& attribute : attributes) {
    data.begin_view();
    add_those(attribute, true);
    if (data.offset_in_view() != 0) data.end_view(kVertexData, attribute.packing.stride());
  }
  return targets;
}

/// A weight in 65535ths; those of a vertex sum to 65535. The first, which is the largest, takes what
/// rounding leaves.
uint32_t normalized_weight(const Mesh& mesh, size_t vertex, uint32_t influence) {
  const float* weights = mesh.weights.data() + vertex * mesh.influences;
  const auto rounded = [&](uint32_t k) { return std::lround(weights[k] * 65535.0); };
  if (influence != 0) return static_cast<uint32_t>(rounded(influence));
  long rest = 65535;
  for (uint32_t k = 1; k < mesh.influences; ++k) rest -= rounded(k);
  return static_cast<uint32_t>(rest);
}

/// Four influences of each vertex from `first` on: numbers and weights.
void add_influences(Data& data, const Mesh& mesh, uint32_t first, size_t joint_count, bool shares,
                    json& attributes) {
  const ComponentType type = joint_count <= 256 ? kU8 : kU16;
  const std::string set = std::to_string(first / 4);
  const size_t count = mesh.positions.size();
  data.begin_view();
  attributes["JOINTS_" + set] = data.add_accessor(data.accessor_here(type, count, "VEC4"));
  for (size_t v = 0; v < count; ++v) {
    for (uint32_t k = first; k < first + 4; ++k)
      data.put(mesh.joints[v * mesh.influences + k], type);
  }
  data.end_view(kVertexData);
  data.begin_view();
  json weights = data.accessor_here(shares ? kU16 : kF32, count, "VEC4");
  if (shares) weights["normalized"] = true;
  attributes["WEIGHTS_" + set] = data.add_accessor(std::move(weights));
  for (size_t v = 0; v < count; ++v) {
    for (uint32_t k = first; k < first + 4; ++k) {
      if (shares) {
        data.put(normalized_weight(mesh, v, k), kU16);
      } else {
        data.put(mesh.weights[v * mesh.influences + k]);
      }
    }
  }
  data.end_view(kVertexData);
}

/// Texture coordinates that a 16-bit share of 1 can hold.
bool are_shares(const std::vector<Float2>& uvs) {
  return std::all_of(uvs.begin(), uvs.end(), [](const Float2& uv) {
    return uv[0] >= 0 && uv[0] <= 1 && uv[1] >= 0 && uv[1] <= 1;
  });
}

size_t add_uvs(Data& data, const Mesh& mesh, bool shares) {
  if (!shares || !are_shares(mesh.uvs)) return data.add(mesh.uvs, kVertexData);
  data.begin_view();
  json accessor = data.accessor_here(kU16, mesh.uvs.size(), "VEC2");
  accessor["normalized"] = true;
  for (const Float2& uv : mesh.uvs) {
    for (const float value : uv) {
      data.put(static_cast<uint32_t>(std::lround(value * 65535)), kU16);
    }
  }
  data.end_view(kVertexData);
  return data.add_accessor(std::move(accessor));
}

size_t add_colors(Data& data, const Mesh& mesh) {
  data.begin_view();
  json accessor = data.accessor_here(kU16, mesh.colors.size(), "VEC4");
  accessor["normalized"] = true;
  for (const auto& color : mesh.colors) {
    for (const uint16_t channel : color) data.put(channel, kU16);
  }
  data.end_view(kVertexData);
  return data.add_accessor(std::move(accessor));
}

size_t add_triangles(Data& data, const Mesh& mesh) {
  // The largest number of each type means something else.
  const ComponentType type = mesh.positions.size() < 65536 ? kU16 : kU32;
  data.begin_view();
  json accessor = data.accessor_here(type, mesh.triangles.size(), "SCALAR");
  for (const uint32_t vertex : mesh.triangles) data.put(vertex, type);
  data.end_view(kIndexData);
  return data.add_accessor(std::move(accessor));
}

json mesh_json(Data& data, const Mesh& mesh, size_t joint_count, const Packings& packings) {
  data.about("mesh " + mesh.name);
  json attributes;
  attributes["POSITION"] = data.add_attribute(mesh.positions, packings.positions, true);
  if (!mesh.normals.empty()) {
    attributes["NORMAL"] = data.add_attribute(mesh.normals, packings.normals, false);
  }
  if (!mesh.uvs.empty()) attributes["TEXCOORD_0"] = add_uvs(data, mesh, packings.shares);
  if (!mesh.colors.empty()) attributes["COLOR_0"] = add_colors(data, mesh);
  for (uint32_t first = 0; first < mesh.influences; first += 4) {
    add_influences(data, mesh, first, joint_count, packings.shares, attributes);
  }
  json primitive = {{"attributes", std::move(attributes)}};
  primitive["indices"] = add_triangles(data, mesh);
  primitive["material"] = mesh.material;
  json result = {{"name", mesh.name}};
  if (!mesh.targets.empty()) {
    primitive["targets"] = add_targets(data, mesh, packings);
    json weights = json::array(), names = json::array();
    for (const MorphTarget& target : mesh.targets) {
      weights.push_back(target.weight);
      names.push_back(target.name);
    }
    result["weights"] = std::move(weights);
    result["extras"]["targetNames"] = std::move(names);
    for (const Corrective& corrective : mesh.correctives) {
      result["extras"]["correctives"].push_back(
          {{"target", corrective.target}, {"product", corrective.product}});
    }
  }
  result["primitives"] = list_of(std::move(primitive));
  return result;
}

// Skeleton ----------------------------------------------------------------------------------------

// Node 0 holds the skeleton; joint j is node j + 1.
constexpr size_t kFirstJointNode = 1;

json joint_node(const Joint& joint, std::vector<uint32_t> children) {
  json node = {{"name", joint.name}};
  const Transform& pose = joint.pose;
  const auto floats = [](auto... values) { return json::array({static_cast<float>(values)...}); };
  const math::Vec3d &t = pose.translation, &s = pose.scale;
  const math::Quaternion& q = pose.rotation;
  if (t != math::Vec3d{0, 0, 0}) node["translation"] = floats(t.x, t.y, t.z);
  if (q != math::Quaternion{0, 0, 0, 1}) node["rotation"] = floats(q.x, q.y, q.z, q.w);
  if (s != math::Vec3d{1, 1, 1}) node["scale"] = floats(s.x, s.y, s.z);
  if (!children.empty()) node["children"] = std::move(children);
  return node;
}

/// The transform as readers of the file will see it, in floats.
Transform rounded(const Transform& transform) {
  const auto round = [](double value) { return double{static_cast<float>(value)}; };
  const auto [t, q, s] = transform;
  return {{round(t.x), round(t.y), round(t.z)},
          {round(q.x), round(q.y), round(q.z), round(q.w)},
          {round(s.x), round(s.y), round(s.z)}};
}

/// Model-space matrices of the bind pose. `depth` guards against a circle of parents.
Matrix bind_matrix(const std::vector<Joint>& joints, uint32_t joint, std::vector<Matrix>& known,
                   std::vector<bool>& is_known) {
  std::vector<uint32_t> path;
  for (uint32_t j = joint; j != kNone && !is_known[j] && path.size() <= joints.size();
       j = joints[j].parent) {
    path.push_back(j);
  }
  while (!path.empty()) {
    const uint32_t j = path.back();
    path.pop_back();
    const Matrix local = matrix_of(rounded(joints[j].bind));
    known[j] = joints[j].parent == kNone ? local : known[joints[j].parent] * local;
    is_known[j] = true;
  }
  return known[joint];
}

/// `packing` of the positions: a skinned vertex knows no node that could undo it.
void add_inverse_binds(Data& data, const std::vector<Joint>& joints, const Packing& packing) {
  data.about("bind pose");
  std::vector<Matrix> known(joints.size());
  std::vector<bool> is_known(joints.size());
  const Matrix unpack =
      math::matrix_of({packing.center, {}, {packing.scale, packing.scale, packing.scale}});
  for (uint32_t j = 0; j < joints.size(); ++j) {
    const Matrix unbind = inverse(bind_matrix(joints, j, known, is_known)) * unpack;
    for (int c = 0; c < 4; ++c) {
      for (const auto& row : unbind.m) data.put(static_cast<float>(row[c]));
      data.put(c == 3 ? 1.0f : 0.0f);
    }
  }
}

json skin_json(Data& data, const Scene& scene, const Packing& packing) {
  json skin = {{"name", scene.name}};
  data.begin_view();
  skin["inverseBindMatrices"] =
      data.add_accessor(data.accessor_here(kF32, scene.joints.size(), "MAT4"));
  add_inverse_binds(data, scene.joints, packing);
  data.end_view(kOtherData);
  skin["skeleton"] = 0;
  json joints = json::array();
  for (size_t j = 0; j < scene.joints.size(); ++j) joints.push_back(j + kFirstJointNode);
  skin["joints"] = std::move(joints);
  return skin;
}

void add_skeleton_nodes(const Scene& scene, json& nodes) {
  std::vector<uint32_t> roots;
  std::vector<std::vector<uint32_t>> children(scene.joints.size());
  for (uint32_t j = 0; j < scene.joints.size(); ++j) {
    const uint32_t parent = scene.joints[j].parent;
    (parent == kNone ? roots : children[parent]).push_back(j + kFirstJointNode);
  }
  nodes.push_back({{"name", scene.name}, {"children", roots}});
  for (uint32_t j = 0; j < scene.joints.size(); ++j) {
    nodes.push_back(joint_node(scene.joints[j], std::move(children[j])));
  }
}

// Animation ---------------------------------------------------------------------------------------

json animation_json(Data& data, const Animation& animation, size_t first_mesh_node) {
  data.about("animation");
  json channels = json::array(), samplers = json::array();
  data.begin_view();
  const size_t times = data.append(animation.times, true);
  const auto add = [&](size_t node, const char* path, const auto& values) {
    if (values.empty()) return;
    channels.push_back(
        {{"sampler", samplers.size()}, {"target", {{"node", node}, {"path", path}}}});
    samplers.push_back({{"input", times}, {"output", data.append(values)}});
  };
  for (const JointTrack& track : animation.joints) {
    const size_t node = track.joint + kFirstJointNode;
    add(node, "translation", track.translations);
    add(node, "rotation", track.rotations);
    add(node, "scale", track.scales);
  }
  for (const WeightTrack& track : animation.weights) {
    add(first_mesh_node + track.mesh, "weights", track.weights);
  }
  data.end_view(kOtherData);
  return {{"name", animation.name},
          {"channels", std::move(channels)},
          {"samplers", std::move(samplers)}};
}

bool moves_something(const Animation& animation) {
  return !animation.times.empty() && !(animation.joints.empty() && animation.weights.empty());
}

// File --------------------------------------------------------------------------------------------

std::string version_text() {
  const uint32_t version = mien_version();
  return std::to_string(version >> 24) + "." + std::to_string(version >> 16 & 255) + "." +
         std::to_string(version & 0xffff);
}

json material_json(const Material& material) {
  json result = {{"name", material.name}};
  json surface = {{"baseColorFactor", material.color},
                  {"metallicFactor", 0},
                  {"roughnessFactor", material.roughness}};
  // Texture i shows image i. Green is roughness; blue would be how metallic, times the factor.
  if (material.color_image != kNone) surface["baseColorTexture"]["index"] = material.color_image;
  if (material.roughness_image != kNone) {
    surface["metallicRoughnessTexture"]["index"] = material.roughness_image;
  }
  result["pbrMetallicRoughness"] = std::move(surface);
  if (material.normal_image != kNone) result["normalTexture"]["index"] = material.normal_image;
  if (material.alpha_cutoff > 0) {
    result["alphaMode"] = "MASK";
    result["alphaCutoff"] = material.alpha_cutoff;
  } else if (material.color[3] < 1 || material.see_through) {
    result["alphaMode"] = "BLEND";
  }
  if (material.double_sided) result["doubleSided"] = true;
  if (material.cornea_depth > 0) {
    result["extras"]["cornea"] = {{"depth", material.cornea_depth}, {"iris", material.cornea_iris}};
  }
  return result;
}

/// In the binary part, or by a path, in which all but plain letters are %XX.
json image_json(Data& data, const Image& image) {
  json result = {{"name", image.name}};
  if (image.bytes.empty()) {
    std::string uri;
    for (const char c : image.path) {
      const bool plain =
          std::strchr("-._~/", c) != nullptr || std::isalnum(static_cast<unsigned char>(c)) != 0;
      char hex[4];
      std::snprintf(hex, sizeof(hex), "%%%02X",
                    static_cast<unsigned>(static_cast<unsigned char>(c)));
      uri += plain && c != 0 ? std::string(1, c) : hex;
    }
    result["uri"] = uri;
    return result;
  }
  result["mimeType"] = image.mime_type;
  data.begin_view();
  result["bufferView"] = data.current_view();
  data.bytes += image.bytes;
  data.end_view(kOtherData);
  return result;
}

void add_images(const std::vector<Image>& images, Data& data, json& root) {
  for (size_t i = 0; i < images.size(); ++i) {
    root["images"].push_back(image_json(data, images[i]));
    root["textures"].push_back({{"sampler", 0}, {"source", i}});
  }
  // Smooth from near and from afar, and repeated, as readers do without a word about it.
  if (!images.empty()) root["samplers"] = list_of({{"magFilter", 9729}, {"minFilter", 9987}});
}

/// Header, then chunks of whole words.
std::string pack(std::string text, const std::string& binary) {
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const uint64_t size = 12 + 8 + uint64_t{text.size()} + 8 + binary.size();
  if (size > UINT32_MAX) {
    throw ExportError(
        MIEN_ERROR_DNA_LIMIT, "",
        "the file would have " + std::to_string(size) + " bytes, and GLB files end at 4 GiB",
        "export fewer LODs or frames");
  }
  std::string bytes;
  bytes.reserve(size);
  const auto word = [&bytes](size_t value) {
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i) & 255);
  };
  bytes += "glTF";
  word(2);
  word(size);
  word(text.size());
  bytes += "JSON";
  bytes += text;
  word(binary.size());
  bytes += std::string("BIN\0", 4);
  return bytes += binary;
}

}  // namespace

double quantization_error(const Scene& scene) {
  return packings_of(scene).positions.scale * std::sqrt(3.0) / (2 * 32767);
}

std::string write_glb(const Scene& scene, Encoding encoding, const Vrm* vrm) {
  Data data;
  const bool quantized = encoding == Encoding::kQuantized;
  Packings packings = quantized ? packings_of(scene) : Packings{};
  packings.shares = encoding != Encoding::kFloat;
  json root;
  root["asset"] = {{"version", "2.0"}, {"generator", "Mien " + version_text()}};
  if (quantized) {
    root["extensionsUsed"] = list_of("KHR_mesh_quantization");
    root["extensionsRequired"] = list_of("KHR_mesh_quantization");
  }
  root["scene"] = 0;

  json nodes = json::array(), meshes = json::array(), materials = json::array();
  if (!scene.joints.empty()) add_skeleton_nodes(scene, nodes);
  const size_t first_mesh_node = nodes.size();
  for (const Mesh& mesh : scene.meshes) {
    json node = {{"name", mesh.name}, {"mesh", meshes.size()}};
    if (mesh.influences != 0) {
      node["skin"] = 0;
    } else if (quantized) {
      const auto& [type, center, scale] = packings.positions;
      node["translation"] = {center.x, center.y, center.z};
      node["scale"] = {scale, scale, scale};
    }
    nodes.push_back(std::move(node));
    meshes.push_back(mesh_json(data, mesh, scene.joints.size(), packings));
  }
  json scenes = json::array();
  for (size_t lod = 0; lod < scene.lods.size(); ++lod) {
    json members = json::array();
    if (!scene.joints.empty()) members.push_back(0);
    for (const uint32_t mesh : scene.lods[lod]) members.push_back(first_mesh_node + mesh);
    scenes.push_back({{"name", scene.lod_names[lod]}, {"nodes", std::move(members)}});
  }
  for (const Material& material : scene.materials) materials.push_back(material_json(material));
  add_images(scene.images, data, root);
  root["scenes"] = std::move(scenes);
  root["nodes"] = std::move(nodes);
  root["materials"] = std::move(materials);
  root["meshes"] = std::move(meshes);
  if (!scene.joints.empty()) root["skins"] = list_of(skin_json(data, scene, packings.positions));
  if (moves_something(scene.animation)) {
    root["animations"] = list_of(animation_json(data, scene.animation, first_mesh_node));
  }
  if (vrm) {
    root["extensionsUsed"].push_back("VRMC_vrm");
    root["extensions"]["VRMC_vrm"] = vrm_json(*vrm, scene, kFirstJointNode, first_mesh_node);
  }
  root["accessors"] = std::move(data.accessors);
  root["bufferViews"] = std::move(data.views);
  root["buffers"] = list_of({{"byteLength", data.bytes.size()}});

  // Names come from files and need not be UTF-8.
  return pack(root.dump(-1, ' ', false, json::error_handler_t::replace), data.bytes);
}

}  // namespace mien::gltf
