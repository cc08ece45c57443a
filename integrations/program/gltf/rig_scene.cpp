// SPDX-License-Identifier: MIT
#include "integrations/program/gltf/rig_scene.h"

#include <algorithm>
#include <cmath>

#include "integrations/program/gltf/material.h"
#include "integrations/program/gltf/rig_skin.h"

namespace mien::gltf {

namespace {

using math::Transform;
using math::Vec3d;

Float3 floats(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
Float4 floats(const math::Quaternion& q) {
  return {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z),
          static_cast<float>(q.w)};
}

// Meshes ------------------------------------------------------------------------------------------

std::vector<Float2> texture_coordinates(const MienMesh& mesh) {
  const float* uv = mesh.texture_coordinates.data;
  const float* end = uv + mesh.texture_coordinates.count;
  if (std::all_of(uv, end, [](float value) { return value == 0; })) return {};
  std::vector<Float2> result(mesh.vertex_count);
  for (Float2& pair : result) {
    pair = {uv[0], 1 - uv[1]};
    uv += 2;
  }
  return result;
}

Mesh make_mesh(const RigSource& source, uint32_t number, const MienMesh& from) {
  Mesh mesh;
  mesh.name = source.name(MIEN_KIND_MESH, number);
  const std::vector<uint8_t>& colors = source.colors(number);
  for (uint32_t v = 0; v < from.vertex_count; ++v) {
    const uint32_t position = from.vertex_position_indices.data[v];
    mesh.positions.push_back(floats(source.point(from.positions.data + size_t{3} * position)));
    const Vec3d normal = source.direction(from.normals.data + size_t{3} * v);
    mesh.normals.push_back(floats(normalized(normal, Vec3d{0, 1, 0})));
    if (!colors.empty()) mesh.colors.push_back(linear_color(&colors[size_t{3} * position]));
  }
  mesh.uvs = texture_coordinates(from);
  mesh.triangles.assign(from.triangles.data, from.triangles.data + from.triangles.count);
  if (source.has_inward_triangles(from)) {
    for (size_t i = 0; i < mesh.triangles.size(); i += 3) {
      std::swap(mesh.triangles[i + 1], mesh.triangles[i + 2]);
    }
  }
  return mesh;
}

uint32_t add_material(std::vector<Material>& materials, const Material& material) {
  const auto found = std::find_if(materials.begin(), materials.end(), [&](const Material& other) {
    return other.name == material.name;
  });
  if (found != materials.end()) return static_cast<uint32_t>(found - materials.begin());
  materials.push_back(material);
  return static_cast<uint32_t>(materials.size() - 1);
}

// Skeleton ----------------------------------------------------------------------------------------

std::vector<Transform> transforms_of(const RigSource& source, const std::vector<float>& values) {
  std::vector<Transform> transforms;
  for (size_t i = 0; i < values.size(); i += 10) {
    transforms.push_back(source.transform(values.data() + i));
  }
  return transforms;
}

std::vector<Transform> local_transforms(const RigSource& source, const MienDeformerInstance* pose) {
  std::vector<float> values(size_t{10} * source.count(MIEN_KIND_JOINT));
  check(mien_deformer_instance_local_transforms(pose, values.data(), values.size()),
        "cannot read pose");
  return transforms_of(source, values);
}

// Targets -----------------------------------------------------------------------------------------

/// Whether one of the LODs that show the mesh drives the channel. Elsewhere its weight is 0.
std::vector<bool> driven_channels(const RigSource& source, uint64_t lods) {
  std::vector<bool> driven(source.count(MIEN_KIND_BLEND_SHAPE_CHANNEL));
  for (uint32_t lod = 0; lod < 64; ++lod) {
    if (!(lods >> lod & 1)) continue;
    MienIndex16View channels{};
    check(mien_rig_lod_indices(source.rig(), MIEN_KIND_BLEND_SHAPE_CHANNEL, lod, &channels),
          "cannot read rig");
    for (size_t i = 0; i < channels.count; ++i) driven[channels.data[i]] = true;
  }
  return driven;
}

std::vector<float> copied(const MienFloatView& view) {
  return std::vector<float>(view.data, view.data + view.count);
}

/// Positions and recomputed normals of the mesh with these channel weights and no joint moved.
void deform(MienDeformerInstance* pose, uint32_t mesh, const std::vector<float>& channel_weights,
            std::vector<float>& positions, std::vector<float>& normals) {
  MienFloatView view{};
  check(mien_deformer_instance_update_from_values(pose, nullptr, 0, channel_weights.data(),
                                                  channel_weights.size()),
        "cannot pose");
  check(mien_deformer_instance_deform(pose, mesh, MIEN_NORMALS_RECOMPUTED, nullptr),
        "cannot deform");
  check(mien_deformer_instance_positions(pose, mesh, &view), "cannot deform");
  positions = copied(view);
  check(mien_deformer_instance_normals(pose, mesh, &view), "cannot deform");
  normals = copied(view);
}

/// Deltas of all targets of the mesh on one channel; there may be several.
std::vector<float> channel_deltas(const RigSource& source, uint32_t rig_mesh, const MienMesh& mesh,
                                  uint16_t channel) {
  std::vector<float> sum(size_t{3} * mesh.position_count), deltas(sum.size());
  for (uint32_t t = 0; t < mesh.target_count; ++t) {
    if (mesh.target_channels.data[t] != channel) continue;
    check(mien_deformer_target(source.deformer(), rig_mesh, t, deltas.data(), deltas.size()),
          "cannot read blend shape target");
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += deltas[i];
  }
  return sum;
}

/// What is not worth its bytes: moves of up to `move` (meters), and turns of normals of up to `turn`
/// (radians).
struct Least {
  double move, turn;
};
constexpr double kHalfDegree = 1e-2, kDegree = 1.75e-2;
// Of the diagonal: a sixth of a pixel where the face fills a screen of 2160 lines.
constexpr double kUnseenMove = 7e-5;

/// What moves and turns further than `least`. `deltas` are per position, the normals per vertex.
MorphTarget make_target(const RigSource& source, const MienMesh& mesh,
                        const std::vector<float>& deltas, const std::vector<float>& normals,
                        const std::vector<float>& neutral_normals, const Least& least) {
  MorphTarget target;
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
    const size_t n = size_t{3} * v, p = size_t{3} * mesh.vertex_position_indices.data[v];
    const float turn[3] = {normals[n] - neutral_normals[n], normals[n + 1] - neutral_normals[n + 1],
                           normals[n + 2] - neutral_normals[n + 2]};
    const Vec3d move = source.point(deltas.data() + p), bend = source.direction(turn);
    if (dot(move, move) > least.move * least.move) {
      target.vertices.push_back(v);
      target.positions.push_back(floats(move));
    }
    if (dot(bend, bend) > least.turn * least.turn) {
      target.normal_vertices.push_back(v);
      target.normals.push_back(floats(bend));
    }
  }
  return target;
}

void add_targets(const RigSource& source, uint32_t rig_mesh, const MienMesh& from,
                 MienDeformerInstance* pose, const Least& least, RigScene& result, Mesh& mesh) {
  std::vector<uint16_t>& channels = result.channels.back();
  const std::vector<bool> driven = driven_channels(source, from.lods);
  for (size_t t = 0; t < from.target_channels.count; ++t) {
    const uint16_t channel = from.target_channels.data[t];
    if (driven[channel] && std::find(channels.begin(), channels.end(), channel) == channels.end()) {
      channels.push_back(channel);
    }
  }
  if (channels.empty()) return;
  std::vector<float> weights(driven.size()), positions, normals, neutral_normals;
  deform(pose, rig_mesh, weights, positions, neutral_normals);
  for (const uint16_t channel : channels) {
    weights[channel] = 1;
    deform(pose, rig_mesh, weights, positions, normals);
    weights[channel] = 0;
    mesh.targets.push_back(make_target(source, from,
                                       channel_deltas(source, rig_mesh, from, channel), normals,
                                       neutral_normals, least));
    mesh.targets.back().name = source.name(MIEN_KIND_BLEND_SHAPE_CHANNEL, channel);
  }
}

/// As the deformer has it.
float used_weight(const MienFloatView& channel_weights, uint16_t channel) {
  const float weight = channel_weights.data[channel];
  return std::abs(weight) < 1e-5f ? 0 : weight;
}

}  // namespace

cli::DeformerInstance make_deformer_instance(const RigSource& source) {
  MienDeformerInstance* made = nullptr;
  auto error = sized<MienError>();
  const MienStatus status =
      mien_deformer_instance_create(source.deformer(), nullptr, &made, &error);
  if (status != MIEN_OK) throw ExportError(status, "", error.message, "");
  cli::DeformerInstance pose(made);
  check(mien_deformer_instance_update_from_values(made, nullptr, 0, nullptr, 0), "cannot pose");
  return pose;
}

std::vector<Joint> neutral_joints(const RigSource& source) {
  MienIndex16View parents{};
  check(mien_rig_joint_parents(source.rig(), &parents), "cannot read rig");
  const cli::DeformerInstance neutral = make_deformer_instance(source);
  const std::vector<Transform> locals = local_transforms(source, neutral.get());
  std::vector<Joint> joints(locals.size());
  for (uint32_t j = 0; j < joints.size(); ++j) {
    joints[j].name = source.name(MIEN_KIND_JOINT, j);
    joints[j].parent = parents.data[j] == j ? kNone : parents.data[j];
    joints[j].bind = joints[j].pose = locals[j];
  }
  return joints;
}

RigScene make_still_scene(const RigSource& source, const SceneOptions& options) {
  RigScene result;
  Scene& scene = result.scene;
  scene.name = options.name;
  const uint32_t lod_count = source.info().lod_count;
  scene.lods.resize(lod_count);
  for (uint32_t lod = 0; lod < lod_count; ++lod) {
    scene.lod_names.push_back("LOD " + std::to_string(options.first_lod + lod));
  }
  for (uint32_t m = 0; m < source.count(MIEN_KIND_MESH); ++m) {
    const MienMesh from = source.mesh(m);
    if (from.vertex_count == 0 || from.triangle_count == 0) {
      result.losses.empty_meshes.push_back(source.name(MIEN_KIND_MESH, m));
      continue;
    }
    for (uint32_t lod = 0; lod < lod_count; ++lod) {
      if (from.lods >> lod & 1) scene.lods[lod].push_back(scene.meshes.size());
    }
    Mesh mesh = make_mesh(source, m, from);
    mesh.material = add_material(scene.materials,
                                 material_for(cli::mesh_class(mesh.name), !mesh.colors.empty()));
    scene.meshes.push_back(std::move(mesh));
    result.rig_meshes.push_back(m);
  }
  if (scene.meshes.empty()) {
    throw ExportError(MIEN_ERROR_DNA_LAYER, "", "no mesh has faces",
                      "see 'mien info' for the layers and meshes that the file has");
  }
  return result;
}

RigScene make_rig_scene(const RigSource& source, const SceneOptions& options) {
  RigScene result = make_still_scene(source, options);
  const cli::DeformerInstance pose = make_deformer_instance(source);
  result.scene.joints = neutral_joints(source);
  add_skin(source, options, result);
  math::Boxd box;
  for (const Mesh& mesh : result.scene.meshes) {
    for (const Float3& p : mesh.positions) box.add({p[0], p[1], p[2]});
  }
  const Least least =
      options.exact ? Least{0, kHalfDegree} : Least{kUnseenMove * length(box.size()), kDegree};
  for (size_t i = 0; i < result.scene.meshes.size(); ++i) {
    const uint32_t rig_mesh = result.rig_meshes[i];
    const MienMesh from = source.mesh(rig_mesh);
    result.channels.emplace_back();
    add_targets(source, rig_mesh, from, pose.get(), least, result, result.scene.meshes[i]);
  }
  return result;
}

void set_pose(RigScene& scene, const RigSource& source, const MienDeformerInstance* pose,
              const MienFloatView& channel_weights) {
  const std::vector<Transform> locals = local_transforms(source, pose);
  for (size_t j = 0; j < locals.size(); ++j) scene.scene.joints[j].pose = locals[j];
  for (size_t m = 0; m < scene.scene.meshes.size(); ++m) {
    std::vector<MorphTarget>& targets = scene.scene.meshes[m].targets;
    for (size_t t = 0; t < targets.size(); ++t) {
      targets[t].weight = used_weight(channel_weights, scene.channels[m][t]);
    }
  }
}

PosedVertices posed_vertices(const RigSource& source, uint32_t rig_mesh,
                             MienDeformerInstance* pose) {
  check(mien_deformer_instance_deform(pose, rig_mesh, MIEN_NORMALS_RECOMPUTED, nullptr),
        "cannot deform");
  MienFloatView positions{}, normals{};
  check(mien_deformer_instance_positions(pose, rig_mesh, &positions), "cannot deform");
  check(mien_deformer_instance_normals(pose, rig_mesh, &normals), "cannot deform");
  const MienMesh mesh = source.mesh(rig_mesh);
  PosedVertices result;
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
    const uint32_t position = mesh.vertex_position_indices.data[v];
    result.positions.push_back(floats(source.point(positions.data + size_t{3} * position)));
    const Vec3d normal = source.direction(normals.data + size_t{3} * v);
    result.normals.push_back(floats(normalized(normal, Vec3d{0, 1, 0})));
  }
  return result;
}

MorphTarget difference(const RigSource& source, uint32_t rig_mesh, const MienDeformerInstance* pose,
                       const std::vector<float>& neutral_positions,
                       const std::vector<float>& neutral_normals, double least) {
  MienFloatView positions{}, normals{};
  check(mien_deformer_instance_positions(pose, rig_mesh, &positions), "cannot deform");
  check(mien_deformer_instance_normals(pose, rig_mesh, &normals), "cannot deform");
  std::vector<float> deltas = copied(positions);
  for (size_t i = 0; i < deltas.size(); ++i) deltas[i] -= neutral_positions[i];
  return make_target(source, source.mesh(rig_mesh), deltas, copied(normals), neutral_normals,
                     {least, kHalfDegree});
}

// Animation ---------------------------------------------------------------------------------------

AnimationRecorder::AnimationRecorder(const RigScene& scene, const RigSource& source,
                                     std::string name, double rate)
    : scene_(scene), source_(source), rate_(rate) {
  animation_.name = std::move(name);
  animation_.joints.resize(source.count(MIEN_KIND_JOINT));
  for (uint32_t j = 0; j < animation_.joints.size(); ++j) animation_.joints[j].joint = j;
  for (uint32_t m = 0; m < scene.scene.meshes.size(); ++m) {
    if (scene.scene.meshes[m].targets.empty()) continue;
    animation_.weights.emplace_back();
    animation_.weights.back().mesh = m;
  }
}

void AnimationRecorder::add_frame(const std::vector<float>& values,
                                  const MienFloatView& channel_weights) {
  animation_.times.push_back(static_cast<float>(animation_.times.size() / rate_));
  const std::vector<Transform> locals = transforms_of(source_, values);
  for (JointTrack& track : animation_.joints) {
    const Transform& local = locals[track.joint];
    Float4 rotation = floats(local.rotation);
    // Readers interpolate components: of q and -q, the nearer to the frame before.
    if (!track.rotations.empty()) {
      const Float4& before = track.rotations.back();
      float cosine = 0;
      for (size_t i = 0; i < 4; ++i) cosine += before[i] * rotation[i];
      if (cosine < 0) {
        for (float& component : rotation) component = -component;
      }
    }
    track.translations.push_back(floats(local.translation));
    track.rotations.push_back(rotation);
    track.scales.push_back(floats(local.scale));
  }
  for (WeightTrack& track : animation_.weights) {
    for (const uint16_t channel : scene_.channels[track.mesh]) {
      track.weights.push_back(used_weight(channel_weights, channel));
    }
  }
}

Animation AnimationRecorder::finish() {
  const auto keep_if_moving = [](auto& values, const auto& still) {
    const auto is_still = [&](const auto& value) { return value == still; };
    if (std::all_of(values.begin(), values.end(), is_still)) values.clear();
  };
  std::vector<JointTrack>& tracks = animation_.joints;
  for (JointTrack& track : tracks) {
    const Transform& still = scene_.scene.joints[track.joint].pose;
    keep_if_moving(track.translations, floats(still.translation));
    keep_if_moving(track.rotations, floats(still.rotation));
    keep_if_moving(track.scales, floats(still.scale));
  }
  tracks.erase(std::remove_if(tracks.begin(), tracks.end(),
                              [](const JointTrack& track) {
                                return track.translations.empty() && track.rotations.empty() &&
                                       track.scales.empty();
                              }),
               tracks.end());
  return std::move(animation_);
}

}  // namespace mien::gltf
