// SPDX-License-Identifier: MIT
#include "integrations/program/gltf/usd_writer.h"

#include <algorithm>
#include <map>

#include "integrations/program/gltf/usd_text.h"

namespace mien::gltf {

namespace {

using math::Matrix;
using math::Transform;

// How values are written -----------------------------------------------------------------------------

const auto write_tuple = [](UsdText& text, const auto& values) { text.tuple(values); };
const auto write_number = [](UsdText& text, const auto& value) { text.number(value); };
const auto write_token = [](UsdText& text, const std::string& value) { text.token(value); };

/// USD multiplies row vectors: the transpose, row by row.
const auto write_matrix = [](UsdText& text, const Matrix& m) {
  std::string separator = "(";
  for (size_t c = 0; c < 4; ++c) {
    std::array<double, 4> row{0, 0, 0, c == 3 ? 1.0 : 0.0};
    for (size_t r = 0; r < 3; ++r) row[r] = m.m[r][c];
    text.raw(separator);
    text.tuple(row);
    separator = ", ";
  }
  text.raw(")");
};

Float3 floats(const math::Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

Float4 floats(const math::Quaternion& q) {
  return {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z),
          static_cast<float>(q.w)};
}

// Skeleton -----------------------------------------------------------------------------------------

struct Skeleton {
  std::vector<uint32_t> order;   // parents first: joints of the scene
  std::vector<uint32_t> places;  // of each joint of the scene in this order
  std::vector<std::string> paths;
};

Skeleton order_joints(const std::vector<Joint>& joints) {
  Skeleton skeleton;
  skeleton.places.assign(joints.size(), kNone);
  std::map<uint32_t, PrimNames> names;  // by parent
  for (uint32_t joint = 0; joint < joints.size(); ++joint) {
    std::vector<uint32_t> path;
    for (uint32_t j = joint; j != kNone && skeleton.places[j] == kNone; j = joints[j].parent) {
      path.push_back(j);
    }
    for (; !path.empty(); path.pop_back()) {
      const uint32_t j = path.back(), parent = joints[j].parent;
      const std::string name = names[parent].take(joints[j].name);
      skeleton.places[j] = static_cast<uint32_t>(skeleton.order.size());
      skeleton.paths.push_back(
          parent == kNone ? name : skeleton.paths[skeleton.places[parent]] + "/" + name);
      skeleton.order.push_back(j);
    }
  }
  return skeleton;
}

void write_skeleton(const Scene& scene, const Skeleton& skeleton, const std::string& root,
                    UsdText& text) {
  text.about("bind pose");
  std::vector<Matrix> rest, bind;
  std::string names;
  for (const uint32_t j : skeleton.order) {
    const Joint& joint = scene.joints[j];
    rest.push_back(matrix_of(joint.bind));
    bind.push_back(joint.parent == kNone ? rest.back()
                                         : bind[skeleton.places[joint.parent]] * rest.back());
    names += (names.empty() ? "" : ", ") + usd_string(joint.name);
  }
  text.begin_prim("Skeleton", "Skeleton",
                  {"prepend apiSchemas = [\"SkelBindingAPI\"]", "customData = {",
                   "    string[] mienJointNames = [" + names + "]", "}"});
  text.array("uniform token[] joints", skeleton.paths, write_token);
  text.array("uniform matrix4d[] bindTransforms", bind, write_matrix);
  text.array("uniform matrix4d[] restTransforms", rest, write_matrix);
  text.line("rel skel:animationSource = <" + root + "/Animation>");
  text.end_prim();
}

// Animation ----------------------------------------------------------------------------------------

/// Names of targets, each once, with the meshes and numbers that have them.
struct ShapeList {
  std::vector<std::string> names;
  std::vector<std::pair<uint32_t, uint32_t>> first;  // mesh and target of each name
};

ShapeList list_shapes(const Scene& scene) {
  ShapeList shapes;
  std::set<std::string> known;
  for (uint32_t m = 0; m < scene.meshes.size(); ++m) {
    for (uint32_t t = 0; t < scene.meshes[m].targets.size(); ++t) {
      const std::string& name = scene.meshes[m].targets[t].name;
      if (!known.insert(name).second) continue;
      shapes.names.push_back(name);
      shapes.first.emplace_back(m, t);
    }
  }
  return shapes;
}

/// Values of a track, or of the pose, in frame f.
template <class Value, class Of>
std::vector<Value> values_at(const Scene& scene, const Skeleton& skeleton,
                             const std::vector<const JointTrack*>& tracks, size_t frame,
                             const std::vector<Value> JointTrack::*member, const Of& of_pose) {
  std::vector<Value> values;
  for (const uint32_t j : skeleton.order) {
    const JointTrack* track = tracks[j];
    const bool moves = track && !(track->*member).empty();
    values.push_back(moves ? (track->*member)[frame] : of_pose(scene.joints[j].pose));
  }
  return values;
}

std::vector<float> weights_at(const Scene& scene, const ShapeList& shapes, size_t frame) {
  std::vector<float> weights;
  for (const auto& [mesh, target] : shapes.first) {
    float weight = scene.meshes[mesh].targets[target].weight;
    for (const WeightTrack& track : scene.animation.weights) {
      if (track.mesh != mesh) continue;
      weight = track.weights[frame * scene.meshes[mesh].targets.size() + target];
    }
    weights.push_back(weight);
  }
  return weights;
}

void write_animation(const Scene& scene, const Skeleton& skeleton, UsdText& text) {
  text.about("animation");
  const size_t frames = scene.animation.times.size();
  std::vector<const JointTrack*> tracks(scene.joints.size());
  for (const JointTrack& track : scene.animation.joints) tracks[track.joint] = &track;
  const ShapeList shapes = list_shapes(scene);
  /// Once, or once for each frame.
  const auto write = [&](const std::string& name, const auto& at_frame, const auto& write_value) {
    if (frames == 0) return text.array(name, at_frame(0), write_value);
    text.begin_samples(name);
    for (size_t f = 0; f < frames; ++f) text.sample(f, at_frame(f), write_value);
    text.end_samples();
  };
  text.begin_prim("SkelAnimation", "Animation");
  if (!skeleton.order.empty()) {
    text.array("uniform token[] joints", skeleton.paths, write_token);
    write(
        "float3[] translations",
        [&](size_t f) {
          return values_at(scene, skeleton, tracks, f, &JointTrack::translations,
                           [](const Transform& pose) { return floats(pose.translation); });
        },
        write_tuple);
    write(
        "quatf[] rotations",
        [&](size_t f) {
          return values_at(scene, skeleton, tracks, f, &JointTrack::rotations,
                           [](const Transform& pose) { return floats(pose.rotation); });
        },
        // The real part first.
        [](UsdText& out, const Float4& q) {
          out.tuple(Float4{q[3], q[0], q[1], q[2]});
        });
    write(
        "half3[] scales",
        [&](size_t f) {
          return values_at(scene, skeleton, tracks, f, &JointTrack::scales,
                           [](const Transform& pose) { return floats(pose.scale); });
        },
        write_tuple);
  }
  if (!shapes.names.empty()) {
    text.array("uniform token[] blendShapes", shapes.names, write_token);
    write(
        "float[] blendShapeWeights", [&](size_t f) { return weights_at(scene, shapes, f); },
        write_number);
  }
  text.end_prim();
}

// Meshes -------------------------------------------------------------------------------------------

void write_target(const MorphTarget& target, const std::string& name, UsdText& text) {
  // Both kinds of offsets share the list of points.
  std::map<uint32_t, std::pair<Float3, Float3>> points;
  for (size_t i = 0; i < target.vertices.size(); ++i) {
    points[target.vertices[i]].first = target.positions[i];
  }
  for (size_t i = 0; i < target.normal_vertices.size(); ++i) {
    points[target.normal_vertices[i]].second = target.normals[i];
  }
  text.begin_prim("BlendShape", name, {"displayName = " + usd_string(target.name)});
  text.array("uniform vector3f[] offsets", points,
             [](UsdText& out, const auto& point) { out.tuple(point.second.first); });
  if (!target.normals.empty()) {
    text.array("uniform vector3f[] normalOffsets", points,
               [](UsdText& out, const auto& point) { out.tuple(point.second.second); });
  }
  text.array("uniform int[] pointIndices", points,
             [](UsdText& out, const auto& point) { out.number(point.first); });
  text.end_prim();
}

void write_points(const Scene& scene, size_t m, const UsdOptions& options, UsdText& text) {
  const Mesh& mesh = scene.meshes[m];
  if (options.cached_frames == 0) {
    text.array("point3f[] points", mesh.positions, write_tuple);
    if (!mesh.normals.empty()) {
      text.array("normal3f[] normals", mesh.normals, write_tuple, {"interpolation = \"vertex\""});
    }
    return;
  }
  std::vector<PosedVertices> frames;
  for (size_t f = 0; f < options.cached_frames; ++f) frames.push_back(options.posed(m, f));
  text.begin_samples("point3f[] points");
  for (size_t f = 0; f < frames.size(); ++f) text.sample(f, frames[f].positions, write_tuple);
  text.end_samples();
  text.line("normal3f[] normals", {"interpolation = \"vertex\""});
  text.begin_samples("normal3f[] normals");
  for (size_t f = 0; f < frames.size(); ++f) text.sample(f, frames[f].normals, write_tuple);
  text.end_samples();
}

void write_extent(const Mesh& mesh, UsdText& text) {
  if (mesh.positions.empty()) return;
  std::array<Float3, 2> extent{mesh.positions[0], mesh.positions[0]};
  for (const Float3& p : mesh.positions) {
    for (size_t i = 0; i < 3; ++i) {
      extent[0][i] = std::min(extent[0][i], p[i]);
      extent[1][i] = std::max(extent[1][i], p[i]);
    }
  }
  text.array("float3[] extent", extent, write_tuple);
}

void write_mesh(const Scene& scene, size_t m, const std::string& path, const std::string& root,
                const Skeleton& skeleton, const std::vector<std::string>& materials,
                const UsdOptions& options, UsdText& text) {
  const Mesh& mesh = scene.meshes[m];
  const bool cached = options.cached_frames != 0;
  text.about("mesh " + mesh.name);
  const std::string name = path.substr(path.rfind('/') + 1);
  text.begin_prim("Mesh", name,
                  {std::string("prepend apiSchemas = [") + (cached ? "" : "\"SkelBindingAPI\", ") +
                       "\"MaterialBindingAPI\"]",
                   "displayName = " + usd_string(mesh.name)});
  text.line("uniform token subdivisionScheme = \"none\"");
  text.line("uniform token orientation = \"rightHanded\"");
  if (scene.materials[mesh.material].double_sided) text.line("uniform bool doubleSided = true");
  text.array("int[] faceVertexCounts", std::vector<uint32_t>(mesh.triangles.size() / 3, 3),
             write_number);
  text.array("int[] faceVertexIndices", mesh.triangles, write_number);
  if (!cached) write_extent(mesh, text);
  write_points(scene, m, options, text);
  if (!mesh.uvs.empty()) {
    text.array("texCoord2f[] primvars:st", mesh.uvs,
               [](UsdText& out, const Float2& uv) {
                 out.tuple(Float2{uv[0], 1 - uv[1]});
               },
               {"interpolation = \"vertex\""});
  }
  if (!mesh.colors.empty()) {
    text.array("color3f[] primvars:displayColor", mesh.colors,
               [](UsdText& out, const std::array<uint16_t, 4>& color) {
                 out.tuple(Float3{color[0] / 65535.0f, color[1] / 65535.0f, color[2] / 65535.0f});
               },
               {"interpolation = \"vertex\""});
  }
  text.line("rel material:binding = <" + root + "/Materials/" + materials[mesh.material] + ">");
  if (cached) return text.end_prim();

  if (mesh.influences != 0) {
    const std::vector<std::string> each = {"elementSize = " + std::to_string(mesh.influences),
                                           "interpolation = \"vertex\""};
    text.array(
        "int[] primvars:skel:jointIndices", mesh.joints,
        [&](UsdText& out, uint16_t joint) { out.number(skeleton.places[joint]); }, each);
    text.array("float[] primvars:skel:jointWeights", mesh.weights, write_number, each);
    text.line(
        "matrix4d primvars:skel:geomBindTransform = "
        "((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1))");
  }
  if (!skeleton.order.empty()) text.line("rel skel:skeleton = <" + root + "/Skeleton>");
  if (!mesh.targets.empty()) {
    PrimNames names;
    std::vector<std::string> tokens, prims;
    std::string paths;
    for (const MorphTarget& target : mesh.targets) {
      tokens.push_back(target.name);
      prims.push_back(names.take(target.name));
      paths += (paths.empty() ? "<" : ", <") + path + "/" + prims.back() + ">";
    }
    text.array("uniform token[] skel:blendShapes", tokens, write_token);
    text.line("rel skel:blendShapeTargets = [" + paths + "]");
    for (size_t t = 0; t < prims.size(); ++t) write_target(mesh.targets[t], prims[t], text);
  }
  text.end_prim();
}

// Materials ----------------------------------------------------------------------------------------

/// Between @: paths with one in them take three.
std::string asset_path(const std::string& path) {
  for (const char c : path) {
    if (static_cast<unsigned char>(c) >= 0x20) continue;
    throw ExportError(MIEN_ERROR_DNA_VALUE, "texture", "its path has control characters in it",
                      "rename the file");
  }
  const char* quote = path.find('@') == std::string::npos ? "@" : "@@@";
  return quote + path + quote;
}

/// An image that the shader input `to` of the surface reads from `output`.
struct UsdTexture {
  const char* name;
  uint32_t image;
  const char* input;   // with its type
  const char* output;  // with its type
  bool is_color;
  std::array<double, 4> scale, bias;
};

std::vector<UsdTexture> textures_of(const Material& material) {
  const auto& c = material.color;
  const double r = material.roughness;
  const std::vector<UsdTexture> all = {
      {"BaseColor",
       material.color_image,
       "color3f inputs:diffuseColor",
       "float3 outputs:rgb",
       true,
       {c[0], c[1], c[2], c[3]},
       {0, 0, 0, 0}},
      {"Normal",
       material.normal_image,
       "normal3f inputs:normal",
       "float3 outputs:rgb",
       false,
       {2, 2, 2, 1},
       {-1, -1, -1, 0}},
      // Green, as in glTF; gray images have the same in all channels.
      {"Roughness",
       material.roughness_image,
       "float inputs:roughness",
       "float outputs:g",
       false,
       {r, r, r, 1},
       {0, 0, 0, 0}}};
  std::vector<UsdTexture> used;
  for (const UsdTexture& texture : all) {
    if (texture.image != kNone) used.push_back(texture);
  }
  return used;
}

void write_texture(const UsdTexture& texture, const Image& image, const std::string& path,
                   bool with_alpha, UsdText& text) {
  text.begin_prim("Shader", texture.name);
  text.line("uniform token info:id = \"UsdUVTexture\"");
  text.line("asset inputs:file = " + asset_path(image.path));
  text.line("float2 inputs:st.connect = <" + path + "/TextureCoordinates.outputs:result>");
  text.line(std::string("token inputs:sourceColorSpace = ") +
            (texture.is_color ? "\"sRGB\"" : "\"raw\""));
  text.line("token inputs:wrapS = \"repeat\"");
  text.line("token inputs:wrapT = \"repeat\"");
  text.value("float4 inputs:scale", texture.scale);
  text.value("float4 inputs:bias", texture.bias);
  text.line(texture.output);
  if (with_alpha) text.line("float outputs:a");
  text.end_prim();
}

void write_primvar_reader(const char* name, const char* type, const char* primvar, UsdText& text) {
  text.begin_prim("Shader", name);
  text.line(std::string("uniform token info:id = \"UsdPrimvarReader_") + type + "\"");
  text.line(std::string("string inputs:varname = \"") + primvar + "\"");
  text.line(std::string(type) + " outputs:result");
  text.end_prim();
}

void write_material(const Material& material, const std::vector<Image>& images, bool with_colors,
                    const std::string& path, UsdText& text) {
  const std::vector<UsdTexture> textures = textures_of(material);
  const bool colors = with_colors && material.color_image == kNone;
  text.begin_prim("Material", path.substr(path.rfind('/') + 1),
                  {"displayName = " + usd_string(material.name)});
  text.line("token outputs:surface.connect = <" + path + "/Surface.outputs:surface>");
  text.begin_prim("Shader", "Surface");
  text.line("uniform token info:id = \"UsdPreviewSurface\"");
  for (const UsdTexture& texture : textures) {
    const std::string output = texture.output;
    text.line(std::string(texture.input) + ".connect = <" + path + "/" + texture.name + "." +
              output.substr(output.find(' ') + 1) + ">");
  }
  if (colors) {
    text.line("color3f inputs:diffuseColor.connect = <" + path + "/Colors.outputs:result>");
  } else if (material.color_image == kNone) {
    text.value("color3f inputs:diffuseColor",
               std::array<double, 3>{material.color[0], material.color[1], material.color[2]});
  }
  if (material.roughness_image == kNone) {
    text.value("float inputs:roughness", material.roughness);
  }
  text.line("float inputs:metallic = 0");
  if (material.see_through) {
    text.line("float inputs:opacity.connect = <" + path + "/BaseColor.outputs:a>");
  } else {
    text.value("float inputs:opacity", material.color[3]);
  }
  if (material.alpha_cutoff > 0) {
    text.value("float inputs:opacityThreshold", material.alpha_cutoff);
  }
  text.line("token outputs:surface");
  text.end_prim();
  if (colors) write_primvar_reader("Colors", "float3", "displayColor", text);
  if (!textures.empty()) write_primvar_reader("TextureCoordinates", "float2", "st", text);
  for (const UsdTexture& texture : textures) {
    write_texture(texture, images[texture.image], path, texture.is_color && material.see_through,
                  text);
  }
  text.end_prim();
}

bool has_colors(const Scene& scene, size_t material) {
  return std::any_of(scene.meshes.begin(), scene.meshes.end(), [&](const Mesh& mesh) {
    return mesh.material == material && !mesh.colors.empty();
  });
}

}  // namespace

std::string write_usda(const Scene& scene, const UsdOptions& options) {
  UsdText text;
  const bool cached = options.cached_frames != 0;
  const size_t frames = cached ? options.cached_frames : scene.animation.times.size();
  const std::string name = PrimNames().take(scene.name), root = "/" + name;
  text.line("#usda 1.0");
  text.line("(");
  text.line("    defaultPrim = \"" + name + "\"");
  text.line("    metersPerUnit = 1");
  text.line("    upAxis = \"Y\"");
  text.value("    timeCodesPerSecond", options.rate);
  text.value("    framesPerSecond", options.rate);
  if (frames != 0) {
    text.line("    startTimeCode = 0");
    text.line("    endTimeCode = " + std::to_string(frames - 1));
  }
  text.line(")");
  text.line("");
  const Skeleton skeleton = cached ? Skeleton{} : order_joints(scene.joints);
  text.begin_prim(cached ? "Xform" : "SkelRoot", name,
                  {"displayName = " + usd_string(scene.name), "kind = \"component\""});
  if (!skeleton.order.empty()) {
    write_skeleton(scene, skeleton, root, text);
    write_animation(scene, skeleton, text);
  }
  PrimNames material_names;
  std::vector<std::string> materials;
  for (const Material& material : scene.materials) {
    materials.push_back(material_names.take(material.name));
  }
  std::vector<bool> written(scene.meshes.size());
  for (size_t lod = 0; lod < scene.lods.size(); ++lod) {
    PrimNames names;
    const std::string group = "LOD_" + std::to_string(lod);
    text.begin_prim("Xform", group, {"displayName = " + usd_string(scene.lod_names[lod])});
    if (lod != 0) text.line("token visibility = \"invisible\"");
    for (const uint32_t m : scene.lods[lod]) {
      if (written[m]) continue;  // of a finer LOD
      written[m] = true;
      write_mesh(scene, m, root + "/" + group + "/" + names.take(scene.meshes[m].name), root,
                 skeleton, materials, options, text);
    }
    text.end_prim();
  }
  text.begin_prim("Scope", "Materials");
  for (size_t i = 0; i < materials.size(); ++i) {
    write_material(scene.materials[i], scene.images, has_colors(scene, i),
                   root + "/Materials/" + materials[i], text);
  }
  text.end_prim();
  text.end_prim();
  return text.take();
}

}  // namespace mien::gltf
