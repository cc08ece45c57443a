// SPDX-License-Identifier: MIT
// Half meshes, weights and residuals become the geometry of a DNA file: the other half is their
// mirror image to the last bit.
#include <algorithm>

#include "author/generate/head/dna.h"

namespace mien::head {

using author::copy_text;
using author::make;
using author::make_lod_map;
using author::NewVec3s;
using author::Text;

namespace {

constexpr const char* kPartNames[kPartCount] = {"head",     "teeth", "tongue", "eyeLeft",
                                                "eyeRight", "hair",  "brows",  "lashes"};
/// Smaller offsets are not stored; in each coarser LOD, which is seen from farther away, a quarter more is small.
constexpr double kLeastOffset = 0.002;
constexpr double kLeastShare = 1e-3;
/// Correctives that only moderate the sum of a pair come this close to it.
constexpr double kModerationError = 0.03;

Text mesh_name(Part part, uint32_t lod) {
  return Text().add(kPartNames[static_cast<int>(part)]).add("_lod").add(uint64_t{lod}).add("_mesh");
}

class MeshMaker {
 public:
  MeshMaker(const Head& head, Span<const Affine> poses, Displacements& displacements, Part part,
            uint32_t lod, const HalfMesh& half, Arena& arena, Arena& scratch)
      : head_(head), poses_(poses), displacements_(displacements), part_(part), lod_(lod),
        arena_(arena), scratch_(scratch), half_(half) {}

  /// `used` is set for channels for which the mesh has a target.
  bool make(dna::Mesh& out, Span<uint8_t> used) {
    flipped_ = part_ == Part::kEyeRight;
    return number() && make_points(out) && make_layouts(out) && make_faces(out) &&
           make_weights(out) && make_targets(out, used);
  }
  bool make_colors(dna::MetadataPair& out);

 private:
  uint32_t left_count() const { return half_.vertices.count(); }
  bool has_twin(uint32_t i) const { return half_.mirrored && !half_.on_plane(i); }
  Vec3 placed(Vec3 v) const { return flipped_ ? mirrored(v) : v; }

  /// Vertices of the other half come after those of this one.
  bool number() {
    if (!author::make(scratch_, left_count(), twin_) ||
        !author::make(scratch_, left_count(), weights_)) {
      return false;
    }
    count_ = left_count();
    for (uint32_t i = 0; i < left_count(); ++i) twin_[i] = has_twin(i) ? count_++ : i;
    for (uint32_t i = 0; i < left_count(); ++i) {
      weights_[i] = weigh(head_.skeleton, lod_, half_.vertices[i], half_.on_plane(i));
    }
    return true;
  }

  bool make_points(dna::Mesh& out) {
    NewVec3s positions, normals;
    if (!positions.allocate(arena_, count_) || !normals.allocate(arena_, count_)) return false;
    for (uint32_t i = 0; i < left_count(); ++i) {
      const Vertex& v = half_.vertices[i];
      positions.set(i, placed(v.position));
      normals.set(i, placed(v.normal));
      if (!has_twin(i)) continue;
      positions.set(twin_[i], mirrored(v.position));
      normals.set(twin_[i], mirrored(v.normal));
    }
    out.positions = positions;
    out.normals = normals;
    return true;
  }

  /// Texture coordinates of the other half are mirrored about u = 0.5; vertices on the plane with another u
  /// have a layout for each half.
  bool make_layouts(dna::Mesh& out) {
    if (!author::make(scratch_, left_count(), other_layout_)) return false;
    uint32_t layouts = left_count();
    if (half_.mirrored) {
      for (uint32_t i = 0; i < left_count(); ++i) {
        const bool shared = half_.on_plane(i) && half_.vertices[i].u == 0.5;
        other_layout_[i] = shared ? i : layouts++;
      }
    }
    dna::NewArray<uint32_t> positions, coordinates, normals;
    dna::NewArray<float> us, vs;
    if (!author::make(arena_, layouts, positions) || !author::make(arena_, layouts, coordinates) ||
        !author::make(arena_, layouts, normals) || !author::make(arena_, layouts, us) ||
        !author::make(arena_, layouts, vs)) {
      return false;
    }
    const auto set = [&](uint32_t layout, uint32_t position, double u, double v) {
      positions.set(layout, position);
      coordinates.set(layout, layout);
      normals.set(layout, position);
      us.set(layout, static_cast<float>(u));
      vs.set(layout, static_cast<float>(v));
    };
    for (uint32_t i = 0; i < left_count(); ++i) {
      const Vertex& v = half_.vertices[i];
      set(i, i, flipped_ ? 1 - v.u : v.u, v.v);
      if (half_.mirrored && other_layout_[i] != i) set(other_layout_[i], twin_[i], 1 - v.u, v.v);
    }
    out.texture_coordinates = {us, vs};
    out.layouts = {positions, coordinates, normals};
    return true;
  }

  bool make_faces(dna::Mesh& out) {
    const Span<Face> faces = half_.faces.span();
    const uint32_t halves = half_.mirrored ? 2 : 1;
    uint32_t corners = 0, corner = 0, face = 0;
    for (const Face& f : faces) corners += f.count * halves;
    dna::NewArray<uint32_t> indices;
    if (!author::make(arena_, faces.count * halves, out.faces) ||
        !author::make(arena_, corners, indices)) {
      return false;
    }
    for (uint32_t half = 0; half < halves; ++half) {
      const bool turned = half == 1 || flipped_;
      for (const Face& f : faces) {
        out.faces[face++].layout_indices = {indices.data + corner * sizeof(uint32_t), f.count};
        for (uint32_t i = 0; i < f.count; ++i) {
          // The first corner stays the first one, so that quads are split alike.
          const uint32_t from = f.corners[turned ? (f.count - i) % f.count : i];
          indices.set(corner++, half == 1 ? other_layout_[from] : from);
        }
      }
    }
    return true;
  }

  bool make_weights(dna::Mesh& out) {
    if (!author::make(arena_, count_, out.skin_weights)) return false;
    out.maximum_influence_per_vertex = 0;
    for (uint32_t i = 0; i < left_count(); ++i) {
      const Weights& w = weights_[i];
      out.maximum_influence_per_vertex =
          std::max(out.maximum_influence_per_vertex, static_cast<uint16_t>(w.count));
      if (!store_weights(w, flipped_, out.skin_weights[i])) return false;
      if (has_twin(i) && !store_weights(w, true, out.skin_weights[twin_[i]])) return false;
    }
    return true;
  }

  bool store_weights(const Weights& w, bool turned, dna::VertexSkinWeights& out) {
    dna::NewArray<float> values;
    dna::NewArray<uint16_t> joints;
    if (!author::make(arena_, w.count, values) || !author::make(arena_, w.count, joints)) {
      return false;
    }
    for (uint32_t i = 0; i < w.count; ++i) {
      values.set(i, w.values[i]);
      joints.set(i, turned ? head_.skeleton.joints[w.joints[i]].twin : w.joints[i]);
    }
    out = {values, joints};
    return true;
  }

  /// The part of a shape that joints cannot produce, for the vertices of this half.
  void find_offsets(uint32_t shape, Span<Vec3> out) const;

  bool make_targets(dna::Mesh& out, Span<uint8_t> used) {
    if (!author::make(scratch_, left_count(), shares_)) return false;
    bool moves = false;
    for (uint32_t i = 0; i < left_count(); ++i) {
      const Vertex& v = half_.vertices[i];
      if (v.carrier == Carrier::kSkin) shares_[i] = lod_ < kShapeLods ? 1 : near_lips(v);
      moves = moves || shares_[i] >= kLeastShare;
    }
    if (!moves) return true;
    if (part_ != Part::kHead && !displacements_.make(left_count(), scratch_)) return false;
    for (uint32_t i = 0; i < left_count(); ++i) {
      if (shares_[i] >= kLeastShare) displacements_.find(half_.vertices[i]);
    }
    const uint32_t shapes = head_.shapes.count();
    if (!author::make(scratch_, size_t{shapes} * left_count(), offsets_)) return false;
    for (uint32_t s = 0; s < shapes; ++s) find_offsets(s, offsets_of(s));

    uint32_t targets = 0, target = 0;
    for (uint32_t s = 0; s < shapes; ++s) targets += count_moved(s) > 0;
    if (!author::make(arena_, targets, out.blend_shape_targets)) return false;
    for (uint32_t s = 0; s < shapes; ++s) {
      const uint32_t moved = count_moved(s);
      if (moved == 0) continue;
      used[s] = 1;
      if (!store_target(s, moved, out.blend_shape_targets[target++])) return false;
    }
    return true;
  }

  /// LODs without shapes of the whole face have shapes of the edges of the lips, so that a closed mouth has
  /// no slit.
  double near_lips(const Vertex& v) const {
    if (std::abs(v.look.x) > kMouthHalfWidth || std::abs(v.look.y - kMouthY) > 1.3) return 0;
    return bump(v.above_mouth, v.depth, 0, 0, 0.35, 0.15);
  }

  Span<Vec3> offsets_of(uint32_t shape) const {
    return offsets_.slice(size_t{shape} * left_count(), left_count());
  }
  /// Small offsets are not stored, except where edges have to meet.
  bool is_moved(uint32_t vertex, Vec3 offset) const {
    const Vertex& v = half_.vertices[vertex];
    const double least =
        kLeastOffset * (v.edge || v.lid != 0 ? 0.01 : 1 + 0.25 * static_cast<double>(lod_));
    return dot(offset, offset) >= least * least;
  }

  uint32_t count_moved(uint32_t shape) const {
    uint32_t moved = 0;
    const Span<Vec3> here = offsets_of(shape), other = offsets_of(head_.shapes.twin(shape));
    for (uint32_t i = 0; i < left_count(); ++i) {
      moved += is_moved(i, here[i]);
      moved += has_twin(i) && is_moved(i, other[i]);
    }
    return moved;
  }

  bool store_target(uint32_t shape, uint32_t moved, dna::BlendShapeTarget& out) {
    NewVec3s deltas;
    dna::NewArray<uint32_t> indices;
    if (!deltas.allocate(arena_, moved) || !author::make(arena_, moved, indices)) return false;
    uint32_t n = 0;
    const auto add = [&](uint32_t i, uint32_t vertex, Vec3 offset) {
      if (!is_moved(i, offset)) return;
      indices.set(n, vertex);
      deltas.set(n++, offset);
    };
    const Span<Vec3> here = offsets_of(shape), other = offsets_of(head_.shapes.twin(shape));
    for (uint32_t i = 0; i < left_count(); ++i) add(i, i, here[i]);
    for (uint32_t i = 0; i < left_count(); ++i) {
      if (has_twin(i)) add(i, twin_[i], mirrored(other[i]));
    }
    out.deltas = deltas;
    out.vertex_indices = indices;
    out.channel_index = static_cast<uint16_t>(shape);
    return true;
  }

  const Head& head_;
  const Span<const Affine> poses_;  // [shape * joint count + joint]
  Displacements& displacements_;
  const Part part_;
  const uint32_t lod_;
  Arena& arena_;
  Arena& scratch_;
  const HalfMesh& half_;
  bool flipped_ = false;
  uint32_t count_ = 0;
  Span<uint32_t> twin_, other_layout_;
  Span<Weights> weights_;
  Span<double> shares_;  // of the offsets of a vertex that the mesh has
  Span<Vec3> offsets_;   // [shape * left_count() + vertex]
};

/// A corrective acts together with its members: it has to correct the sum of the three.
struct Active {
  uint32_t shapes[3] = {}, count = 1;
};

Active active_with(const Shapes& shapes, uint32_t shape) {
  Active active;
  active.shapes[0] = shape;
  if (shape >= kExpressionCount) {
    const Corrective& c = shapes.corrective(shape - kExpressionCount);
    active.shapes[active.count++] = c.first;
    active.shapes[active.count++] = c.second;
  }
  return active;
}

void MeshMaker::find_offsets(uint32_t shape, Span<Vec3> out) const {
  const Shapes& shapes = head_.shapes;
  if (shapes.is_of_tongue(shape)) return;  // the skin takes no part
  const Active active = active_with(shapes, shape);
  const Affine* pose = &poses_[size_t{shape} * head_.skeleton.count];
  const uint32_t twin = shapes.twin(shape);
  for (uint32_t i = 0; i < left_count(); ++i) {
    const Vertex& v = half_.vertices[i];
    const double share = shares_[i];
    if (share < kLeastShare) continue;
    // Lids are turned by their joints alone, or those that are shut would open where a pair is moderated.
    if (shapes.is_moderation(shape) && v.lid != 0) continue;
    if (half_.on_plane(i) && twin < shape) {  // the mirror image of offsets found already
      out[i] = mirrored(offsets_of(twin)[i]);
      continue;
    }
    Vec3 from = v.position, target = v.position;
    for (uint32_t a = 0; a < active.count; ++a) {
      target = target + displacements_.at(active.shapes[a], v);
      if (a > 0) from = from + offsets_of(active.shapes[a])[i];
    }
    Vec3 offset = author::residual(pose, influences(weights_[i]), from, target);
    if (half_.on_plane(i) && twin == shape) offset.x = 0;
    offset = offset * share;
    if (head_.shapes.is_moderation(shape) && !v.edge) {
      offset = offset * std::max(0.0, 1 - kModerationError / std::max(length(offset), 1e-9));
    }
    out[i] = is_moved(i, offset) ? offset : Vec3();
  }
}

bool MeshMaker::make_colors(dna::MetadataPair& out) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  // Three bytes make four digits: one group for each position, no padding needed.
  uint8_t* text = static_cast<uint8_t*>(arena_.allocate(size_t{count_} * 4, 1));
  if (!text) return false;
  const auto byte = [](double c) {
    return static_cast<uint32_t>(std::min(std::max(c, 0.0), 255.0) + 0.5);
  };
  for (uint32_t i = 0; i < left_count(); ++i) {
    const Color c = half_.vertices[i].color;
    const uint32_t bits = byte(c.r) << 16 | byte(c.g) << 8 | byte(c.b);
    for (const uint32_t at : {i, twin_[i]}) {
      for (uint32_t k = 0; k < 4; ++k) {
        text[at * 4 + k] = static_cast<uint8_t>(kDigits[bits >> (18 - 6 * k) & 63]);
      }
    }
  }
  out.value = {text, count_ * 4};
  return copy_text(
      arena_,
      Text().add("mien.colors.").add(mesh_name(part_, lod_).chars, mesh_name(part_, lod_).count),
      out.key);
}

bool pose_shapes(const Head& head, Arena& scratch, Span<Affine>& out) {
  const uint32_t joints = head.skeleton.count;
  if (!make(scratch, size_t{head.shapes.count()} * joints, out)) return false;
  for (uint32_t s = 0; s < head.shapes.count(); ++s) {
    const Active active = active_with(head.shapes, s);
    pose_joints(head.skeleton, head.deltas, active.shapes, active.count, &out[size_t{s} * joints]);
  }
  return true;
}

bool fill_channels(const Head& head, Span<const uint8_t> used, Arena& arena, dna::DnaView& out) {
  const uint32_t shapes = head.shapes.count();
  uint32_t count = 0;
  for (uint8_t u : used) count += u;
  dna::NewArray<uint16_t> lods, inputs, outputs;
  if (!make(arena, count, out.defn.channel_names) || !make(arena, kLodCount, lods) ||
      !make(arena, count, inputs) || !make(arena, count, outputs)) {
    return false;
  }
  uint32_t channel = 0;
  for (uint32_t s = 0; s < shapes; ++s) {
    if (!used[s]) continue;
    Text name;
    name.add("head__");
    if (s < kExpressionCount) {
      name.add(kExpressions[s].name);
    } else {
      const Corrective& c = head.shapes.corrective(s - kExpressionCount);
      name.add(kExpressions[c.first].name).add("_").add(kExpressions[c.second].name);
    }
    if (!copy_text(arena, name, out.defn.channel_names[channel])) return false;
    inputs.set(channel, static_cast<uint16_t>(s));
    outputs.set(channel, static_cast<uint16_t>(channel));
    ++channel;
  }
  for (uint32_t lod = 0; lod < kLodCount; ++lod) {
    lods.set(lod, static_cast<uint16_t>(count));
  }
  out.bhvr.channels = {lods, inputs, outputs};
  const auto in_lod = [](size_t, size_t) { return true; };
  return make_lod_map(arena, kLodCount, count, in_lod, out.defn.lod_channels);
}

}  // namespace

bool fill_meshes(const Head& head, const PartLods& skin, Displacements& displacements, Arena& arena,
                 const Allocator& allocator, size_t metadata_used, dna::DnaView& out) {
  Arena scratch(allocator);
  dna::List<dna::Mesh>& meshes = out.geom.meshes;
  Span<uint8_t> used;
  Span<uint16_t> channel_of;
  Span<Affine> poses;
  if (!pose_shapes(head, scratch, poses) || !make(arena, kMeshCount, meshes) ||
      !make(arena, kMeshCount, out.defn.mesh_names) || !make(scratch, head.shapes.count(), used) ||
      !make(scratch, used.count, channel_of)) {
    return false;
  }
  const auto make_meshes = [&](Part part, const PartLods& made) {
    for (uint32_t lod = 0; lod < kLodCount; ++lod) {
      const uint32_t m = lod * kPartCount + static_cast<uint32_t>(part);
      Arena for_mesh(allocator);
      Displacements of_mesh(head.shapes);
      MeshMaker maker(head, poses, part == Part::kHead ? displacements : of_mesh, part, lod,
                      made.at[lod], arena, for_mesh);
      if (!copy_text(arena, mesh_name(part, lod), out.defn.mesh_names[m]) ||
          !maker.make(meshes[m], used) ||
          !maker.make_colors(out.desc.metadata[metadata_used + m])) {
        return false;
      }
    }
    return true;
  };
  if (!make_meshes(Part::kHead, skin)) return false;
  for (const Part part :
       {Part::kTeeth, Part::kTongue, Part::kEyeLeft, Part::kHair, Part::kBrows, Part::kLashes}) {
    Arena for_part(allocator);
    PartLods made(for_part);
    if (!make_lods(head.form, part, allocator, made) || !make_meshes(part, made) ||
        (part == Part::kEyeLeft && !make_meshes(Part::kEyeRight, made))) {
      return false;
    }
  }
  const auto in_lod = [](size_t lod, size_t mesh) { return mesh / kPartCount == lod; };
  if (!make_lod_map(arena, kLodCount, kMeshCount, in_lod, out.defn.lod_meshes) ||
      !fill_channels(head, used, arena, out)) {
    return false;
  }

  // Until here, targets have numbers of shapes; channels are the shapes that are used.
  uint16_t channel = 0;
  for (uint32_t s = 0; s < used.count; ++s) channel_of[s] = used[s] ? channel++ : 0;
  uint32_t count = 0, entry = 0;
  for (const dna::Mesh& mesh : meshes) count += mesh.blend_shape_targets.count;
  dna::NewArray<uint16_t> from, to;
  if (!make(arena, count, from) || !make(arena, count, to)) return false;
  for (uint32_t m = 0; m < kMeshCount; ++m) {
    for (dna::BlendShapeTarget& target : meshes[m].blend_shape_targets) {
      target.channel_index = channel_of[target.channel_index];
      from.set(entry, static_cast<uint16_t>(m));
      to.set(entry++, target.channel_index);
    }
  }
  out.defn.mesh_channels = {from, to};
  return true;
}

}  // namespace mien::head
