// SPDX-License-Identifier: MIT
#include "tests/support/deform_rig.h"

#include <algorithm>
#include <cmath>

#include "tests/support/tiny_rig.h"

namespace mien {
namespace {

using namespace dna;

constexpr double kPi = 3.14159265358979323846;

double between(std::mt19937& random, double from, double to) {
  return from + (to - from) * (random() / 4294967296.0);
}
uint32_t below(std::mt19937& random, uint32_t limit) { return limit == 0 ? 0 : random() % limit; }

template <class T>
Array<T> array_of(Arena& arena, const std::vector<T>& values) {
  const NewArray<T> array = new_array<T>(arena, values.size());
  for (size_t i = 0; i < values.size(); ++i) array.set(i, values[i]);
  return array;
}
template <class T>
List<T> list_of(Arena& arena, const std::vector<T>& items) {
  const Span<T> span = arena.array<T>(items.size());
  std::copy(items.begin(), items.end(), span.begin());
  return {span.data, static_cast<uint32_t>(span.count)};
}
Vec3Array vectors_of(Arena& arena, const std::vector<Vec3d>& vectors) {
  std::vector<float> parts[3];
  for (const Vec3d& v : vectors) {
    for (size_t k = 0; k < 3; ++k) parts[k].push_back(static_cast<float>(v[k]));
  }
  return {array_of(arena, parts[0]), array_of(arena, parts[1]), array_of(arena, parts[2])};
}
List<String> numbered_names(Arena& arena, const char* stem, uint32_t count) {
  std::vector<String> names;
  for (uint32_t i = 0; i < count; ++i) {
    const std::string name = stem + std::to_string(i);
    uint8_t* bytes = static_cast<uint8_t*>(arena.allocate(name.size(), 1));
    memcpy(bytes, name.data(), name.size());
    names.push_back({bytes, static_cast<uint32_t>(name.size())});
  }
  return list_of(arena, names);
}
LodMap one_lod(Arena& arena, uint32_t count) {
  std::vector<uint16_t> all(count);
  for (uint32_t i = 0; i < count; ++i) all[i] = static_cast<uint16_t>(i);
  return {be<uint16_t>(arena, {0}), list_of<Array<uint16_t>>(arena, {array_of(arena, all)})};
}

/// A bent sheet; columns wrap in texture space at every third column, where there are two vertices
/// to a position.
Mesh random_mesh(std::mt19937& random, Arena& arena, const DeformRigOptions& options) {
  const uint32_t rows = options.rows, columns = options.columns, count = rows * columns;
  std::vector<Vec3d> positions, normals;
  for (uint32_t i = 0; i < count; ++i) {
    const double x = i % columns, y = i / columns;
    positions.push_back({x + between(random, -0.2, 0.2),
                         options.height + y + between(random, -0.2, 0.2),
                         3 * std::sin(x * 0.4) + between(random, -0.2, 0.2)});
    // Some normals lie far off the surface: hard edges.
    Vec3d n = {-1.2 * std::cos(x * 0.4), 0, 1};
    if (below(random, 5) == 0) n = {between(random, -1, 1), between(random, -1, 1), 0.4};
    normals.push_back(n);
  }
  std::vector<uint32_t> of_position, of_uv, of_normal;
  std::vector<uint32_t> first(count), second(count);
  std::vector<float> us, vs;
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t copies = i % columns % 3 == 0 ? 2 : 1;
    first[i] = static_cast<uint32_t>(of_position.size());
    second[i] = first[i] + copies - 1;
    for (uint32_t k = 0; k < copies; ++k) {
      of_uv.push_back(static_cast<uint32_t>(us.size()));
      us.push_back(static_cast<float>(k + i % columns));
      vs.push_back(static_cast<float>(i / columns));
      of_position.push_back(i);
      of_normal.push_back(k == 0 ? i : below(random, count));
    }
  }
  std::vector<Face> faces;
  for (uint32_t y = 0; y + 1 < rows; ++y) {
    for (uint32_t x = 0; x + 1 < columns; ++x) {
      const uint32_t at = y * columns + x;
      std::vector<uint32_t> quad = {second[at], first[at + 1], first[at + columns + 1],
                                    second[at + columns]};
      if (options.clockwise) std::reverse(quad.begin(), quad.end());
      switch (below(random, 6)) {
        case 0:
          faces.push_back({array_of<uint32_t>(arena, {quad[0], quad[1], quad[2]})});
          faces.push_back({array_of<uint32_t>(arena, {quad[0], quad[2], quad[3]})});
          break;
        case 1:  // corners that repeat
          faces.push_back(
              {array_of<uint32_t>(arena, {quad[0], quad[1], quad[1], quad[2], quad[3], quad[3]})});
          break;
        case 2:
          faces.push_back(
              {array_of<uint32_t>(arena, {quad[0], quad[1], quad[2], quad[3], quad[3]})});
          break;
        default: faces.push_back({array_of(arena, quad)}); break;
      }
    }
  }
  faces.push_back({array_of<uint32_t>(arena, {0, 1})});
  faces.push_back({});

  std::vector<VertexSkinWeights> skin;
  for (uint32_t i = 0; i < count; ++i) {
    std::vector<float> weights;
    std::vector<uint16_t> joints;
    const uint32_t spread = options.max_influences - options.least_influences + 1;
    const uint32_t n = options.least_influences + below(random, spread);
    double sum = 0;
    for (uint32_t k = 0; k < n; ++k) {
      joints.push_back(static_cast<uint16_t>(below(random, options.joints)));
      weights.push_back(static_cast<float>(between(random, 0.05, 1)));
      sum += weights.back();
    }
    for (float& w : weights) w = static_cast<float>(w / sum);
    if (n > 2 && below(random, 8) == 0) {
      weights.push_back(0);
      joints.push_back(0);
    }
    skin.push_back({array_of(arena, weights), array_of(arena, joints)});
  }
  std::vector<BlendShapeTarget> targets;
  for (uint32_t t = 0; t < options.channels; ++t) {
    std::vector<Vec3d> deltas;
    std::vector<uint32_t> moved;
    for (uint32_t i = count; i-- > 0;) {  // not sorted
      if (below(random, 3) != 0) continue;
      moved.push_back(i);
      deltas.push_back({between(random, -1, 1), between(random, -1, 1), between(random, -1, 1)});
      if (below(random, 10) == 0) deltas.back() = {};
    }
    BlendShapeTarget target;
    target.deltas = vectors_of(arena, deltas);
    target.vertex_indices = array_of(arena, moved);
    target.channel_index = static_cast<uint16_t>(below(random, options.channels));
    targets.push_back(target);
  }

  Mesh mesh;
  mesh.positions = vectors_of(arena, positions);
  mesh.texture_coordinates = {array_of(arena, us), array_of(arena, vs)};
  if (options.normals) mesh.normals = vectors_of(arena, normals);
  mesh.layouts = {array_of(arena, of_position), array_of(arena, of_uv), array_of(arena, of_normal)};
  mesh.faces = list_of(arena, faces);
  mesh.maximum_influence_per_vertex = static_cast<uint16_t>(options.max_influences + 1);
  mesh.skin_weights = list_of(arena, skin);
  mesh.blend_shape_targets = list_of(arena, targets);
  return mesh;
}

// Arithmetic --------------------------------------------------------------------------------------

using model::Dual;

template <class T = double>
Matrix4Of<T> identity() {
  Matrix4Of<T> m = {};
  for (size_t i = 0; i < 4; ++i) m[i][i] = 1;
  return m;
}
template <class A, class B>
auto operator*(const Matrix4Of<A>& a, const Matrix4Of<B>& b) {
  Matrix4Of<decltype(A() * B())> product = {};
  for (size_t r = 0; r < 4; ++r) {
    for (size_t c = 0; c < 4; ++c) {
      for (size_t k = 0; k < 4; ++k) product[r][c] += a[r][k] * b[k][c];
    }
  }
  return product;
}
template <class T>
Matrix4Of<T> about(uint32_t axis, const T& angle) {
  using model::cos;
  using model::sin;
  Matrix4Of<T> m = identity<T>();
  const size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
  m[a][a] = m[b][b] = cos(angle);
  m[a][b] = -sin(angle);
  m[b][a] = sin(angle);
  return m;
}
/// Gauss and Jordan, with pivots.
Matrix4d inverse(Matrix4d m) {
  Matrix4d result = identity();
  for (size_t c = 0; c < 4; ++c) {
    size_t pivot = c;
    for (size_t r = c; r < 4; ++r) {
      if (std::fabs(m[r][c]) > std::fabs(m[pivot][c])) pivot = r;
    }
    std::swap(m[c], m[pivot]);
    std::swap(result[c], result[pivot]);
    const double scale = 1 / m[c][c];
    for (size_t k = 0; k < 4; ++k) {
      m[c][k] *= scale;
      result[c][k] *= scale;
    }
    for (size_t r = 0; r < 4; ++r) {
      if (r == c) continue;
      const double f = m[r][c];
      for (size_t k = 0; k < 4; ++k) {
        m[r][k] -= f * m[c][k];
        result[r][k] -= f * result[c][k];
      }
    }
  }
  return result;
}
Matrix4d transposed(const Matrix4d& m) {
  Matrix4d t;
  for (size_t r = 0; r < 4; ++r) {
    for (size_t c = 0; c < 4; ++c) t[r][c] = m[c][r];
  }
  return t;
}
template <class T>
Vec3Of<T> apply(const Matrix4Of<T>& m, const Vec3Of<T>& v, double w) {
  Vec3Of<T> out;
  for (size_t r = 0; r < 3; ++r)
    out[r] = m[r][0] * v[0] + m[r][1] * v[1] + m[r][2] * v[2] + m[r][3] * w;
  return out;
}
double dot(const Vec3d& a, const Vec3d& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec3d cross(const Vec3d& a, const Vec3d& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vec3d minus(const Vec3d& a, const Vec3d& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec3d unit(Vec3d v) {
  const double length = std::sqrt(dot(v, v));
  if (!(length > 0)) return {};
  for (double& part : v) part /= length;
  return v;
}
template <class T>
Matrix4Of<T> from_quaternion(const T& x, const T& y, const T& z, const T& w) {
  const T squared = x * x + y * y + z * z + w * w;
  if (!(squared > 0)) return identity<T>();
  // A turn about an axis, after Rodrigues. With half its angle: sin(angle) = 2 sin cos, 1 - cos(angle) = 2 sin^2.
  Matrix4Of<T> k = {}, m = identity<T>();
  k[0][1] = -z;
  k[0][2] = y;
  k[1][0] = z;
  k[1][2] = -x;
  k[2][0] = -y;
  k[2][1] = x;
  const Matrix4Of<T> kk = k * k;
  for (size_t r = 0; r < 3; ++r) {
    for (size_t c = 0; c < 3; ++c) m[r][c] += 2 * (w * k[r][c] + kk[r][c]) / squared;
  }
  return m;
}

Vec3d at(const Vec3Array& vectors, size_t i) {
  return {vectors.xs[i], vectors.ys[i], vectors.zs[i]};
}

template <class T>
Matrix4Of<T> turn_of(const DnaView& view, const Vec3Of<T>& angles) {
  static constexpr uint32_t kAxes[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                           {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  const double signs[3] = {double(view.dsce.rotation_sign.x), double(view.dsce.rotation_sign.y),
                           double(view.dsce.rotation_sign.z)};
  const double unit_angle = view.desc.rotation_unit == 0 ? kPi / 180 : 1;
  Matrix4Of<T> turn = identity<T>();
  for (uint32_t axis : kAxes[view.dsce.rotation_sequence]) {
    turn = about(axis, angles[axis] * signs[axis] * unit_angle) * turn;
  }
  return turn;
}

}  // namespace

DeformerHandle create_deformer(const MienDna* dna, const MienRig* rig, MienDeformerDesc desc,
                               MienStatus expected) {
  desc.struct_size = sizeof(desc);
  MienError error = sized<MienError>();
  MienDeformer* made = nullptr;
  EXPECT_EQ(mien_deformer_create(dna, rig, &desc, &made, &error), expected) << error.message;
  return DeformerHandle(made);
}

DeformerInstanceHandle create_deformer_instance(const MienDeformer* deformer, uint64_t lods) {
  MienDeformerInstanceDesc desc = sized<MienDeformerInstanceDesc>();
  desc.lods = lods;
  MienDeformerInstance* made = nullptr;
  EXPECT_EQ(mien_deformer_instance_create(deformer, &desc, &made, nullptr), MIEN_OK);
  return DeformerInstanceHandle(made);
}

MienMesh mesh_of(const MienDeformer* deformer, uint32_t mesh) {
  MienMesh told = sized<MienMesh>();
  EXPECT_EQ(mien_deformer_mesh(deformer, mesh, &told), MIEN_OK);
  return told;
}

std::vector<uint8_t> random_deform_rig(uint32_t seed, const DeformRigOptions& options) {
  std::mt19937 random(seed);
  Arena arena(default_allocator());
  DnaView view = tiny_rig(arena);
  view.desc.lod_count = 1;
  view.desc.rotation_unit = static_cast<uint16_t>(options.rotation_unit);
  view.dsce.rotation_sequence = options.rotation_sequence;
  view.dsce.rotation_sign = {options.rotation_signs[0], options.rotation_signs[1],
                             options.rotation_signs[2]};
  view.dsce.face_winding_order = options.clockwise;
  view.bhvr = {};
  view.bhvr.controls.psd_count = 0;
  view.bhvr.joints.row_count = static_cast<uint16_t>(9 * options.joints);
  view.mlbh = {};
  view.mlbe = {};
  view.rbfb = {};
  view.rbfe = {};
  view.twsw = {};
  view.jbmd = {};
  view.ml_control_count = 0;

  Definition& defn = view.defn;
  defn = {};
  defn.joint_names = numbered_names(arena, "joint", options.joints);
  defn.mesh_names = numbered_names(arena, "mesh", options.meshes);
  defn.channel_names = numbered_names(arena, "channel", options.channels);
  defn.lod_joints = one_lod(arena, options.joints);
  defn.lod_meshes = one_lod(arena, options.meshes);
  defn.lod_channels = one_lod(arena, options.channels);
  defn.lod_maps = one_lod(arena, 0);

  // A parent may stand behind its children: the hierarchy is made along a random order.
  std::vector<uint16_t> order(options.joints), parents(options.joints);
  for (uint32_t j = 0; j < options.joints; ++j) order[j] = static_cast<uint16_t>(j);
  std::shuffle(order.begin(), order.end(), random);
  std::vector<Vec3d> translations(options.joints), rotations(options.joints);
  const double to_unit = options.rotation_unit == 0 ? 1 : kPi / 180;
  for (uint32_t i = 0; i < options.joints; ++i) {
    const bool root = i == 0 || (!options.one_root && below(random, 10) == 0);
    parents[order[i]] = root ? order[i] : order[below(random, i)];
    translations[order[i]] = {between(random, -2, 2),
                              between(random, -2, 2) + (root ? options.height : 0),
                              between(random, -2, 2)};
    for (double& angle : rotations[order[i]]) {
      angle = between(random, -options.neutral_angles, options.neutral_angles) * to_unit;
    }
  }
  defn.joint_hierarchy = array_of(arena, parents);
  defn.neutral_translations = vectors_of(arena, translations);
  defn.neutral_rotations = vectors_of(arena, rotations);

  std::vector<Mesh> meshes;
  for (uint32_t m = 0; m < options.meshes; ++m)
    meshes.push_back(random_mesh(random, arena, options));
  view.geom.meshes = list_of(arena, meshes);
  return write_view(view);
}

DeformValues random_values(const MienRig* rig, uint32_t seed, double scale_skew) {
  std::mt19937 random(seed);
  MienRigInfo info = sized<MienRigInfo>();
  EXPECT_EQ(mien_rig_info(rig, &info), MIEN_OK);
  uint32_t joints = 0, channels = 0;
  EXPECT_EQ(mien_rig_count(rig, MIEN_KIND_JOINT, &joints), MIEN_OK);
  EXPECT_EQ(mien_rig_count(rig, MIEN_KIND_BLEND_SHAPE_CHANNEL, &channels), MIEN_OK);
  const bool quaternions = info.rotation_output == MIEN_ROTATION_OUTPUT_QUATERNION;
  const double to_unit = info.rotation_unit == MIEN_ROTATION_UNIT_DEGREES ? 1 : kPi / 180;
  DeformValues values;
  for (uint32_t j = 0; j < joints; ++j) {
    const bool still = below(random, 4) == 0;
    const double size = still ? 0 : 1;
    for (int i = 0; i < 3; ++i) values.joints.push_back(float(size * between(random, -0.5, 0.5)));
    if (quaternions) {
      for (int i = 0; i < 3; ++i) values.joints.push_back(float(size * between(random, -0.4, 0.4)));
      values.joints.push_back(float(still ? 1 : between(random, 0.5, 1)));
    } else {
      for (int i = 0; i < 3; ++i) {
        values.joints.push_back(float(size * between(random, -40, 40) * to_unit));
      }
    }
    const double scale = size * between(random, -0.2, 0.2);
    for (int i = 0; i < 3; ++i) {
      values.joints.push_back(float(scale + size * between(random, -scale_skew, scale_skew)));
    }
  }
  for (uint32_t c = 0; c < channels; ++c)
    values.channels.push_back(float(between(random, -0.5, 1)));
  return values;
}

template <class T>
std::vector<Matrix4Of<T>> PlainDeformer::locals(const std::vector<T>& values) const {
  std::vector<Matrix4Of<T>> result;
  const uint32_t attributes = quaternions ? 10 : 9;
  for (uint32_t j = 0; j < view.defn.joint_names.count; ++j) {
    const T* delta = values.data() + j * attributes;
    const Vec3d translation = at(view.defn.neutral_translations, j);
    const Vec3d angles = at(view.defn.neutral_rotations, j);
    Matrix4Of<T> move = identity<T>(), scale = move, turn;
    for (size_t i = 0; i < 3; ++i) {
      move[i][3] = translation[i] + delta[i];
      scale[i][i] = 1.0 + delta[attributes - 3 + i];
    }
    if (quaternions) {
      turn = turn_of(view, angles) * from_quaternion(delta[3], delta[4], delta[5], delta[6]);
    } else if (add_angles) {
      turn = turn_of(view,
                     Vec3Of<T>{angles[0] + delta[3], angles[1] + delta[4], angles[2] + delta[5]});
    } else {
      turn = turn_of(view, angles) * turn_of(view, Vec3Of<T>{delta[3], delta[4], delta[5]});
    }
    result.push_back(move * turn * scale);
  }
  return result;
}

template <class T>
std::vector<Matrix4Of<T>> PlainDeformer::models_of(const std::vector<Matrix4Of<T>>& locals) const {
  std::vector<Matrix4Of<T>> result;
  for (uint32_t j = 0; j < locals.size(); ++j) {
    // Each joint walks to its root anew.
    Matrix4Of<T> m = identity<T>();
    for (uint32_t a = j;; a = view.defn.joint_hierarchy[a]) {
      m = locals[a] * m;
      if (view.defn.joint_hierarchy[a] == a) break;
    }
    result.push_back(m);
  }
  return result;
}

template <class T>
std::vector<Matrix4Of<T>> PlainDeformer::skins_of(std::vector<Matrix4Of<T>> models) const {
  const uint32_t attributes = quaternions ? 10 : 9;
  std::vector<double> neutral(models.size() * attributes, 0.0);
  for (size_t i = 6; quaternions && i < neutral.size(); i += 10) neutral[i] = 1;
  const std::vector<Matrix4d> bind = models_of(locals(neutral));
  for (size_t j = 0; j < models.size(); ++j) models[j] = models[j] * inverse(bind[j]);
  return models;
}

namespace {

std::vector<double> doubles(const std::vector<float>& values) {
  return {values.begin(), values.end()};
}

template <class T>
struct Blended {
  std::vector<Matrix4Of<T>> at;  // [position]
};

template <class T>
Blended<T> blend(const PlainDeformer& plain, const dna::Mesh& mesh,
                 const std::vector<Matrix4Of<T>>& skins) {
  Blended<T> blended;
  for (uint32_t p = 0; p < mesh.positions.xs.count; ++p) {
    Matrix4Of<T> sum = {};
    double total = 0;
    bool held = false;
    if (mesh.skin_weights.count != 0) {
      const auto& skin = mesh.skin_weights[p];
      for (uint32_t i = 0; i < skin.weights.count; ++i) {
        double w = skin.weights[i];
        if (plain.fix_weights) w = std::max(w, 0.0);
        if (w == 0) continue;
        held = true;
        total += w;
        for (size_t r = 0; r < 4; ++r) {
          for (size_t c = 0; c < 4; ++c) sum[r][c] += w * skins[skin.joint_indices[i]][r][c];
        }
      }
    }
    if (plain.fix_weights && held) {
      for (auto& row : sum) {
        for (T& value : row) value /= total;
      }
    }
    blended.at.push_back(held ? sum : identity<T>());
  }
  return blended;
}

}  // namespace

template <class T>
std::vector<Vec3Of<T>> PlainDeformer::positions_of(uint32_t m,
                                                   const std::vector<Matrix4Of<T>>& skins,
                                                   const std::vector<T>& channels) const {
  const dna::Mesh& mesh = view.geom.meshes[m];
  std::vector<Vec3Of<T>> result;
  for (uint32_t p = 0; p < mesh.positions.xs.count; ++p) {
    const Vec3d neutral = at(mesh.positions, p);
    result.push_back({neutral[0], neutral[1], neutral[2]});
  }
  for (const auto& target : mesh.blend_shape_targets) {
    const T weight = channels[target.channel_index];
    for (uint32_t i = 0; i < target.vertex_indices.count; ++i) {
      const Vec3d delta = at(target.deltas, i);
      for (size_t k = 0; k < 3; ++k) result[target.vertex_indices[i]][k] += weight * delta[k];
    }
  }
  const Blended<T> blended = blend(*this, mesh, skins);
  for (size_t p = 0; p < result.size(); ++p) result[p] = apply(blended.at[p], result[p], 1);
  return result;
}

#define MIEN_PLAIN_DEFORMER(T)                                                                  \
  template std::vector<Matrix4Of<T>> PlainDeformer::locals(const std::vector<T>&) const;        \
  template std::vector<Matrix4Of<T>> PlainDeformer::models_of(const std::vector<Matrix4Of<T>>&) \
      const;                                                                                    \
  template std::vector<Matrix4Of<T>> PlainDeformer::skins_of(std::vector<Matrix4Of<T>>) const;  \
  template std::vector<Vec3Of<T>> PlainDeformer::positions_of(                                  \
      uint32_t, const std::vector<Matrix4Of<T>>&, const std::vector<T>&) const;
MIEN_PLAIN_DEFORMER(double)
MIEN_PLAIN_DEFORMER(Dual)

std::vector<Matrix4d> PlainDeformer::models(const std::vector<float>& values) const {
  return models_of(locals(doubles(values)));
}
std::vector<Matrix4d> PlainDeformer::skins(const std::vector<float>& values) const {
  return skins_of(models(values));
}
std::vector<Vec3d> PlainDeformer::positions(uint32_t m, const DeformValues& values) const {
  return positions_of(m, skins(values.joints), doubles(values.channels));
}

std::vector<Vec3d> PlainDeformer::skinned_normals(uint32_t m, const DeformValues& values) const {
  const dna::Mesh& mesh = view.geom.meshes[m];
  const Blended<double> blended = blend(*this, mesh, skins(values.joints));
  std::vector<Vec3d> result;
  for (uint32_t v = 0; v < mesh.layouts.positions.count; ++v) {
    Matrix4d turn = blended.at[mesh.layouts.positions[v]];
    for (size_t k = 0; k < 3; ++k) turn[k][3] = 0;
    turn[3] = {0, 0, 0, 1};
    // As area vectors turn: where the blend turns the skin inside out, its normal follows.
    const Vec3d axes[3] = {{turn[0][0], turn[1][0], turn[2][0]},
                           {turn[0][1], turn[1][1], turn[2][1]},
                           {turn[0][2], turn[1][2], turn[2][2]}};
    const double volume = dot(axes[0], cross(axes[1], axes[2]));
    Vec3d n = unit(at(mesh.normals, mesh.layouts.normals[v]));
    if (volume < 0) n = {-n[0], -n[1], -n[2]};
    result.push_back(unit(apply(transposed(inverse(turn)), n, 0)));
  }
  return result;
}

/// Of positions: the area vectors of all faces around them, each face once.
std::vector<Vec3d> PlainDeformer::directions(uint32_t m,
                                             const std::vector<Vec3d>& positions) const {
  const dna::Mesh& mesh = view.geom.meshes[m];
  std::vector<Vec3d> sums(positions.size());
  const auto add = [&](std::vector<uint32_t> corners) {
    Vec3d area = {};
    for (size_t i = 1; i + 1 < corners.size(); ++i) {
      const Vec3d piece = cross(minus(positions[corners[i]], positions[corners[0]]),
                                minus(positions[corners[i + 1]], positions[corners[0]]));
      for (size_t k = 0; k < 3; ++k) area[k] += view.dsce.face_winding_order ? -piece[k] : piece[k];
    }
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    for (uint32_t c : corners) {
      for (size_t k = 0; k < 3; ++k) sums[c][k] += area[k];
    }
  };
  for (const auto& face : mesh.faces) {
    std::vector<uint32_t> all;
    for (uint32_t i = 0; i < face.layout_indices.count; ++i) {
      all.push_back(mesh.layouts.positions[face.layout_indices[i]]);
    }
    // Larger faces are fans of faces of four corners, the last of three or four.
    for (size_t i = 1; i + 1 < all.size(); i += 2) {
      add({all[0], all[i], all[i + 1], all[std::min(i + 2, all.size() - 1)]});
    }
  }
  for (Vec3d& sum : sums) sum = unit(sum);
  return sums;
}

std::vector<Vec3d> PlainDeformer::recomputed_normals(uint32_t m, const DeformValues& values) const {
  const dna::Mesh& mesh = view.geom.meshes[m];
  std::vector<Vec3d> still;
  for (uint32_t p = 0; p < mesh.positions.xs.count; ++p) still.push_back(at(mesh.positions, p));
  const std::vector<Vec3d> was = directions(m, still), now = directions(m, positions(m, values));
  std::vector<Vec3d> result;
  for (uint32_t v = 0; v < mesh.layouts.positions.count; ++v) {
    const uint32_t p = mesh.layouts.positions[v];
    const Vec3d stored =
        mesh.normals.xs.count ? unit(at(mesh.normals, mesh.layouts.normals[v])) : was[p];
    if (dot(now[p], now[p]) == 0) {
      result.push_back(stored);
    } else if (dot(stored, was[p]) >= std::cos(kPi / 6)) {
      result.push_back(now[p]);
    } else {
      const Vec3d axis = cross(was[p], now[p]);
      const Matrix4d turn = from_quaternion(axis[0], axis[1], axis[2], 1 + dot(was[p], now[p]));
      result.push_back(unit(apply(turn, stored, 0)));
    }
  }
  return result;
}

// As MikkTSpace does, but all triangles around a vertex with UVs of the more frequent orientation
// share one tangent.
std::vector<Vec4d> PlainDeformer::neutral_tangents(uint32_t m, Span<const float> normals) const {
  const dna::Mesh& mesh = view.geom.meshes[m];
  const auto on_plane = [](const Vec3d& v, const Vec3d& n) {
    const double along = dot(v, n);
    return unit({v[0] - n[0] * along, v[1] - n[1] * along, v[2] - n[2] * along});
  };
  struct Sum {
    Vec3d tangent = {};
    double angle = 0;
  };
  std::vector<std::array<Sum, 2>> sums(mesh.layouts.positions.count);
  const auto add = [&](const std::array<uint32_t, 3>& corners) {
    Vec3d p[3];
    double u[3], v[3];
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t uv = mesh.layouts.texture_coordinates[corners[k]];
      p[k] = at(mesh.positions, mesh.layouts.positions[corners[k]]);
      u[k] = mesh.texture_coordinates.us[uv];
      v[k] = mesh.texture_coordinates.vs[uv];
    }
    const Vec3d d1 = minus(p[1], p[0]), d2 = minus(p[2], p[0]);
    const double area = (u[1] - u[0]) * (v[2] - v[0]) - (v[1] - v[0]) * (u[2] - u[0]);
    const Vec3d face = cross(d1, d2);
    if (area == 0 || dot(face, face) == 0) return;
    const double sign = area < 0 ? -1 : 1;
    const bool right_handed = (area > 0) != (view.dsce.face_winding_order != 0);
    Vec3d along_u;
    for (size_t k = 0; k < 3; ++k)
      along_u[k] = sign * (d1[k] * (v[2] - v[0]) - d2[k] * (v[1] - v[0]));
    for (size_t k = 0; k < 3; ++k) {
      const float* stored = normals.data + size_t{corners[k]} * 3;
      const Vec3d n = {stored[0], stored[1], stored[2]};
      const Vec3d tangent = on_plane(along_u, n);
      const double cosine =
          dot(on_plane(minus(p[(k + 1) % 3], p[k]), n), on_plane(minus(p[(k + 2) % 3], p[k]), n));
      const double angle = std::acos(std::max(-1.0, std::min(1.0, cosine)));
      Sum& sum = sums[corners[k]][right_handed];
      for (size_t i = 0; i < 3; ++i) sum.tangent[i] += angle * tangent[i];
      sum.angle += angle;
    }
  };
  for (const auto& face : mesh.faces) {
    const auto& c = face.layout_indices;
    for (uint32_t i = 2; i < c.count; ++i) add({c[0], c[i - 1], c[i]});
  }
  std::vector<Vec4d> result;
  for (const std::array<Sum, 2>& sum : sums) {
    const bool right_handed = sum[1].angle >= sum[0].angle;
    const Vec3d tangent = unit(sum[right_handed].tangent);
    result.push_back({tangent[0], tangent[1], tangent[2], right_handed ? 1.0 : -1.0});
  }
  return result;
}

std::vector<Vec3d> PlainDeformer::skinned_tangents(uint32_t m, const DeformValues& values,
                                                   const std::vector<Vec4d>& neutral) const {
  const dna::Mesh& mesh = view.geom.meshes[m];
  const Blended<double> blended = blend(*this, mesh, skins(values.joints));
  std::vector<Vec3d> result;
  for (uint32_t v = 0; v < neutral.size(); ++v) {
    const Vec4d& t = neutral[v];
    result.push_back(apply(blended.at[mesh.layouts.positions[v]], Vec3d{t[0], t[1], t[2]}, 0));
  }
  return result;
}

double PlainDeformer::diagonal(uint32_t m) const {
  Vec3d low = {1e30, 1e30, 1e30}, high = {-1e30, -1e30, -1e30};
  const dna::Mesh& mesh = view.geom.meshes[m];
  for (uint32_t p = 0; p < mesh.positions.xs.count; ++p) {
    const Vec3d v = at(mesh.positions, p);
    for (size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], v[k]);
      high[k] = std::max(high[k], v[k]);
    }
  }
  const Vec3d across = minus(high, low);
  return std::sqrt(dot(across, across));
}

double largest_difference(Span<const float> a, Span<const float> b) {
  EXPECT_EQ(a.count, b.count);
  double largest = 0;
  for (size_t i = 0; i < a.count && i < b.count; ++i) {
    const double difference = std::fabs(double(a[i]) - double(b[i]));
    if (!(difference <= largest)) largest = difference;  // what is not a number is the largest
  }
  return largest;
}

double largest_error(Span<const float> made, const std::vector<Vec3d>& expected) {
  EXPECT_EQ(made.count, expected.size() * 3);
  double largest = 0;
  for (size_t i = 0; i < expected.size() && i * 3 + 2 < made.count; ++i) {
    const float* m = made.data + i * 3;
    const Vec3d apart = minus({m[0], m[1], m[2]}, expected[i]);
    const double error = std::sqrt(dot(apart, apart));
    if (!(error <= largest)) largest = error;  // what is not a number is the largest of all
  }
  return largest;
}

}  // namespace mien
