// SPDX-License-Identifier: MIT
#include "integrations/cli/gltf/glb_writer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

namespace mien::gltf {

namespace {

using json = nlohmann::ordered_json;
using math::Matrix;
using math::Transform;

// Numbers of the glTF specification.
enum ComponentType : int { kU8 = 5121, kU16 = 5123, kU32 = 5125, kF32 = 5126 };
enum ViewTarget : int { kOtherData = 0, kVertexData = 34962, kIndexData = 34963 };

constexpr const char* kShapes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};

/// A list of one. (Compilers do not agree on what braces around one value mean.)
json list_of(json value) {
  json list = json::array();
  list.push_back(std::move(value));
  return list;
}

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
    const int count = type == kU8 ? 1 : type == kU16 ? 2 : 4;
    for (int i = 0; i < count; ++i) bytes += static_cast<char>(value >> (8 * i) & 255);
  }

  void put(float value) {
    if (!std::isfinite(value)) {
      throw ExportError(MIEN_ERROR_DNA_VALUE, part_, "a value is not a finite number",
                        "see 'mien validate', or give smaller controls");
    }
    uint32_t bits;
    std::memcpy(&bits, &value, sizeof(bits));
    put(bits, kF32);
  }

  template <size_t n>
  void put(const std::array<float, n>& values) {
    for (const float value : values) put(value);
  }

  /// Everything begins at a multiple of four.
  void align() { bytes.resize((bytes.size() + 3) / 4 * 4); }

  size_t add_accessor(json accessor) {
    accessors.push_back(std::move(accessor));
    return accessors.size() - 1;
  }

  /// A view of its own with an accessor for all of it.
  template <size_t n>
  size_t add(const std::vector<std::array<float, n>>& values, ViewTarget target,
             bool with_bounds = false) {
    begin_view();
    const size_t accessor = append(values, with_bounds);
    end_view(target);
    return accessor;
  }

  /// The same within the view that was begun.
  template <size_t n>
  size_t append(const std::vector<std::array<float, n>>& values, bool with_bounds = false) {
    json accessor = accessor_here(kF32, values.size(), kShapes[n]);
    if (with_bounds) set_bounds(accessor, values.data(), values.size());
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

  json accessor_here(ComponentType type, size_t count, const char* shape) const {
    json accessor = {{"bufferView", current_view()}};
    if (offset_in_view() != 0) accessor["byteOffset"] = offset_in_view();
    accessor["componentType"] = static_cast<int>(type);
    accessor["count"] = count;
    accessor["type"] = shape;
    return accessor;
  }

  template <size_t n>
  static void set_bounds(json& accessor, const std::array<float, n>* values, size_t count,
                         bool with_zero = false) {
    std::array<float, n> least{}, most{};
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

// Meshes ------------------------------------------------------------------------------------------

/// Displacements of some of `count` vertices, of which the others have none.
class Displacements {
 public:
  Displacements(const MorphTarget& target, size_t count)
      : target_(target), count_(count), index_type_(count <= 65536 ? kU16 : kU32),
        sparse_(target.vertices.size() * (index_type_ == kU16 ? 14u : 16u) < count * 12) {}

  bool is_sparse() const { return sparse_ && !target_.vertices.empty(); }
  bool is_dense() const { return !sparse_; }

  /// Indices of the sparse form; positions and normals share them.
  void put_indices(Data& data) {
    index_view_ = data.current_view();
    index_offset_ = data.offset_in_view();
    for (const uint32_t vertex : target_.vertices) data.put(vertex, index_type_);
    data.align();
  }

  size_t put_sparse(Data& data, const std::vector<Float3>& values, bool with_bounds) const {
    json accessor = {
        {"componentType", static_cast<int>(kF32)}, {"count", count_}, {"type", "VEC3"}};
    if (with_bounds) Data::set_bounds(accessor, values.data(), values.size(), true);
    // Without sparse values all are 0.
    if (!values.empty()) {
      accessor["sparse"] = {
          {"count", values.size()},
          {"indices",
           {{"bufferView", index_view_},
            {"byteOffset", index_offset_},
            {"componentType", static_cast<int>(index_type_)}}},
          {"values", {{"bufferView", data.current_view()}, {"byteOffset", data.offset_in_view()}}}};
      for (const Float3& value : values) data.put(value);
    }
    return data.add_accessor(std::move(accessor));
  }

  size_t put_dense(Data& data, const std::vector<Float3>& values, bool with_bounds) const {
    std::vector<Float3> all(count_, Float3{});
    for (size_t i = 0; i < values.size(); ++i) all[target_.vertices[i]] = values[i];
    return data.append(all, with_bounds);
  }

 private:
  const MorphTarget& target_;
  size_t count_;
  ComponentType index_type_;
  bool sparse_;
  size_t index_view_ = 0, index_offset_ = 0;
};

/// All sparse data of a mesh is in one view, all dense data in another: viewers upload the second.
json add_targets(Data& data, const Mesh& mesh) {
  const size_t count = mesh.positions.size();
  // Either all targets of a mesh move normals, or none.
  const bool with_normals =
      std::any_of(mesh.targets.begin(), mesh.targets.end(),
                  [](const MorphTarget& target) { return !target.normals.empty(); });
  std::vector<Displacements> moves;
  json targets = json::array();
  for (const MorphTarget& target : mesh.targets) {
    moves.emplace_back(target, count);
    targets.push_back(json::object());
  }

  const auto add_those = [&](bool dense, ViewTarget view) {
    data.begin_view();
    for (size_t i = 0; i < moves.size(); ++i) {
      if (moves[i].is_dense() != dense) continue;
      const MorphTarget& target = mesh.targets[i];
      data.about("mesh " + mesh.name + ", target " + target.name);
      const auto put = [&](const std::vector<Float3>& values, bool with_bounds) {
        return dense ? moves[i].put_dense(data, values, with_bounds)
                     : moves[i].put_sparse(data, values, with_bounds);
      };
      if (moves[i].is_sparse()) moves[i].put_indices(data);
      targets[i]["POSITION"] = put(target.positions, true);
      if (with_normals) targets[i]["NORMAL"] = put(target.normals, false);
    }
    if (data.offset_in_view() != 0) data.end_view(view, dense ? sizeof(Float3) : 0);
  };
  add_those(false, kOtherData);
  add_those(true, kVertexData);
  return targets;
}

/// Four influences of each vertex from `first` on: numbers and weights.
void add_influences(Data& data, const Mesh& mesh, uint32_t first, size_t joint_count,
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
  attributes["WEIGHTS_" + set] = data.add_accessor(data.accessor_here(kF32, count, "VEC4"));
  for (size_t v = 0; v < count; ++v) {
    for (uint32_t k = first; k < first + 4; ++k) data.put(mesh.weights[v * mesh.influences + k]);
  }
  data.end_view(kVertexData);
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

json mesh_json(Data& data, const Mesh& mesh, size_t joint_count) {
  data.about("mesh " + mesh.name);
  json attributes;
  attributes["POSITION"] = data.add(mesh.positions, kVertexData, true);
  if (!mesh.normals.empty()) attributes["NORMAL"] = data.add(mesh.normals, kVertexData);
  if (!mesh.uvs.empty()) attributes["TEXCOORD_0"] = data.add(mesh.uvs, kVertexData);
  if (!mesh.colors.empty()) attributes["COLOR_0"] = add_colors(data, mesh);
  for (uint32_t first = 0; first < mesh.influences; first += 4) {
    add_influences(data, mesh, first, joint_count, attributes);
  }
  json primitive = {{"attributes", std::move(attributes)}};
  primitive["indices"] = add_triangles(data, mesh);
  primitive["material"] = mesh.material;
  json result = {{"name", mesh.name}};
  if (!mesh.targets.empty()) {
    primitive["targets"] = add_targets(data, mesh);
    json weights = json::array(), names = json::array();
    for (const MorphTarget& target : mesh.targets) {
      weights.push_back(target.weight);
      names.push_back(target.name);
    }
    result["weights"] = std::move(weights);
    result["extras"]["targetNames"] = std::move(names);
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

void add_inverse_binds(Data& data, const std::vector<Joint>& joints) {
  data.about("bind pose");
  std::vector<Matrix> known(joints.size());
  std::vector<bool> is_known(joints.size());
  for (uint32_t j = 0; j < joints.size(); ++j) {
    const Matrix unbind = inverse(bind_matrix(joints, j, known, is_known));
    for (int c = 0; c < 4; ++c) {
      for (const auto& row : unbind.m) data.put(static_cast<float>(row[c]));
      data.put(c == 3 ? 1.0f : 0.0f);
    }
  }
}

json skin_json(Data& data, const Scene& scene) {
  json skin = {{"name", scene.name}};
  data.begin_view();
  skin["inverseBindMatrices"] =
      data.add_accessor(data.accessor_here(kF32, scene.joints.size(), "MAT4"));
  add_inverse_binds(data, scene.joints);
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
  result["pbrMetallicRoughness"] = {{"baseColorFactor", material.color},
                                    {"metallicFactor", 0},
                                    {"roughnessFactor", material.roughness}};
  if (material.color[3] < 1) result["alphaMode"] = "BLEND";
  if (material.double_sided) result["doubleSided"] = true;
  return result;
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

std::string write_glb(const Scene& scene) {
  Data data;
  json root;
  root["asset"] = {{"version", "2.0"}, {"generator", "Mien " + version_text()}};
  root["scene"] = 0;

  json nodes = json::array(), meshes = json::array(), materials = json::array();
  if (!scene.joints.empty()) add_skeleton_nodes(scene, nodes);
  const size_t first_mesh_node = nodes.size();
  for (const Mesh& mesh : scene.meshes) {
    json node = {{"name", mesh.name}, {"mesh", meshes.size()}};
    if (mesh.influences != 0) node["skin"] = 0;
    nodes.push_back(std::move(node));
    meshes.push_back(mesh_json(data, mesh, scene.joints.size()));
  }
  json scenes = json::array();
  for (size_t lod = 0; lod < scene.lods.size(); ++lod) {
    json members = json::array();
    if (!scene.joints.empty()) members.push_back(0);
    for (const uint32_t mesh : scene.lods[lod]) members.push_back(first_mesh_node + mesh);
    scenes.push_back({{"name", scene.lod_names[lod]}, {"nodes", std::move(members)}});
  }
  for (const Material& material : scene.materials) materials.push_back(material_json(material));
  root["scenes"] = std::move(scenes);
  root["nodes"] = std::move(nodes);
  root["materials"] = std::move(materials);
  root["meshes"] = std::move(meshes);
  if (!scene.joints.empty()) root["skins"] = list_of(skin_json(data, scene));
  if (moves_something(scene.animation)) {
    root["animations"] = list_of(animation_json(data, scene.animation, first_mesh_node));
  }
  root["accessors"] = std::move(data.accessors);
  root["bufferViews"] = std::move(data.views);
  root["buffers"] = list_of({{"byteLength", data.bytes.size()}});

  // Names come from files and need not be UTF-8.
  return pack(root.dump(-1, ' ', false, json::error_handler_t::replace), data.bytes);
}

}  // namespace mien::gltf
