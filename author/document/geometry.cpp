// SPDX-License-Identifier: MIT
#include "author/document/geometry.h"

#include <cmath>

#include "author/base/dna_making.h"
#include "author/base/exact_math.h"
#include "author/document/check_view.h"
#include "author/document/pose.h"
#include "author/document/renumber.h"

namespace mien::author {

using dna::Array;
using dna::NewArray;

namespace {

Status check_finite(const float* values, size_t count, const char* what, Error& error) {
  for (size_t i = 0; i < count; ++i) {
    if (std::isfinite(values[i])) continue;
    return fail(error, Status::kInvalidArgument, kNoOffset, "number %zu of the %s is not finite", i,
                what);
  }
  return Status::kOk;
}

/// Element k of a row of three.
template <class Change>
bool change_vectors(Arena& arena, dna::Vec3Array& vectors, const Change& change) {
  NewVec3s out;
  const uint32_t count = vectors.xs.count;
  if (!out.allocate(arena, count)) return false;
  for (uint32_t i = 0; i < count; ++i) out.set(i, change(vector_of(vectors, i)));
  vectors = out;
  return true;
}

/// Begins an edit of one mesh: its list of meshes is a copy.
Status begin_mesh(Edit& edit, uint32_t mesh, Error& error) {
  if (!edit.begin(error)) return error.status;
  if (Status s = check_indices({&mesh, 1}, edit.view.geom.meshes.count, "mesh", error);
      s != Status::kOk)
    return s;
  return copy_list(edit.arena(), edit.view.geom.meshes) ? Status::kOk : no_memory(error, "an edit");
}

}  // namespace

Status set_neutral(Document& document, uint32_t first, uint32_t count, const float* translations,
                   const float* rotations, Error& error) {
  if (Status s = check_document(document, error); s != Status::kOk) return s;
  Edit edit(document);
  if (!edit.begin(error)) return error.status;
  dna::Definition& defn = edit.view.defn;
  const uint32_t joints = defn.joint_names.count;
  if (first > joints || count > joints - first) {
    return fail(error, Status::kIndex, kNoOffset, "the document has %u joints, not %u from %u on",
                joints, count, first);
  }
  const auto set = [&](const float* values, dna::Vec3Array& vectors, const char* what) {
    if (!values) return Status::kOk;
    if (Status s = check_finite(values, size_t{count} * 3, what, error); s != Status::kOk) return s;
    Array<float>* const parts[3] = {&vectors.xs, &vectors.ys, &vectors.zs};
    for (int k = 0; k < 3; ++k) {
      NewArray<float> out;
      if (!copy_array(edit.arena(), *parts[k], out)) return no_memory(error, "an edit");
      for (uint32_t i = 0; i < count; ++i)
        out.set(first + i, values[3 * size_t{i} + static_cast<size_t>(k)]);
      *parts[k] = out;
    }
    return Status::kOk;
  };
  if (Status s = set(translations, defn.neutral_translations, "translations"); s != Status::kOk)
    return s;
  if (Status s = set(rotations, defn.neutral_rotations, "rotations"); s != Status::kOk) return s;
  edit.commit();
  return Status::kOk;
}

Status set_positions(Document& document, uint32_t mesh, const float* positions, size_t count,
                     Error& error) {
  Edit edit(document);
  if (Status s = begin_mesh(edit, mesh, error); s != Status::kOk) return s;
  dna::Vec3Array& vectors = edit.view.geom.meshes[mesh].positions;
  if (count != vectors.xs.count) {
    return fail(
        error, Status::kInvalidArgument, kNoOffset,
        "mesh %u has %u positions, not %zu: a mesh of another topology is copied from another DNA",
        mesh, vectors.xs.count, count);
  }
  if (Status s = check_finite(positions, count * 3, "positions", error); s != Status::kOk) return s;
  NewVec3s out;
  if (!out.allocate(edit.arena(), count)) return no_memory(error, "an edit");
  for (size_t i = 0; i < count; ++i) {
    out.xs.set(i, positions[3 * i]);
    out.ys.set(i, positions[3 * i + 1]);
    out.zs.set(i, positions[3 * i + 2]);
  }
  vectors = out;
  edit.commit();
  return Status::kOk;
}

namespace {

/// The pair (mesh, channel) is there, or is not.
bool set_pair(Edit& edit, uint32_t mesh, uint32_t channel, bool there) {
  dna::MeshChannelMapping& pairs = edit.view.defn.mesh_channels;
  uint32_t found = 0;
  for (uint32_t i = 0; i < pairs.from.count && i < pairs.to.count; ++i) {
    found += pairs.from[i] == mesh && pairs.to[i] == channel;
  }
  if ((found != 0) == there) return true;
  const uint32_t count = pairs.from.count - found + there;
  const NewArray<uint16_t> from = dna::new_array<uint16_t>(edit.arena(), count);
  const NewArray<uint16_t> to = dna::new_array<uint16_t>(edit.arena(), count);
  if (count != 0 && (!from.data || !to.data)) return false;
  uint32_t next = 0;
  for (uint32_t i = 0; i < pairs.from.count; ++i) {
    if (pairs.from[i] == mesh && pairs.to[i] == channel) continue;
    from.set(next, pairs.from[i]);
    to.set(next++, pairs.to[i]);
  }
  if (there) {
    from.set(next, static_cast<uint16_t>(mesh));
    to.set(next, static_cast<uint16_t>(channel));
  }
  pairs = {from, to};
  return true;
}

}  // namespace

Status set_target(Document& document, uint32_t mesh, uint32_t channel, const uint32_t* vertices,
                  const float* deltas, size_t count, Error& error) {
  if (Status s = check_document(document, error); s != Status::kOk) return s;
  Edit edit(document);
  if (Status s = begin_mesh(edit, mesh, error); s != Status::kOk) return s;
  const uint32_t channels = edit.view.defn.channel_names.count;
  if (Status s = check_indices({&channel, 1}, channels, "blend shape channel", error);
      s != Status::kOk)
    return s;
  dna::Mesh& changed = edit.view.geom.meshes[mesh];
  const uint32_t positions = changed.positions.xs.count;
  if (count > positions) {
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "mesh %u has %u positions, fewer than the %zu deltas", mesh, positions, count);
  }
  if (Status s = check_finite(deltas, count * 3, "deltas", error); s != Status::kOk) return s;
  if (vertices) {
    if (Status s = check_indices({vertices, count}, positions, "position of this mesh", error);
        s != Status::kOk) {
      return s;
    }
  }
  const auto is_zero = [deltas](size_t i) {
    return deltas[3 * i] == 0 && deltas[3 * i + 1] == 0 && deltas[3 * i + 2] == 0;
  };
  uint32_t moving = 0;
  for (size_t i = 0; i < count; ++i) moving += !is_zero(i);

  dna::BlendShapeTarget target;
  NewVec3s out;
  NewArray<uint32_t> indices;
  if (!out.allocate(edit.arena(), moving) || !make(edit.arena(), moving, indices))
    return no_memory(error, "an edit");
  uint32_t next = 0;
  for (size_t i = 0; i < count; ++i) {
    if (is_zero(i)) continue;
    out.xs.set(next, deltas[3 * i]);
    out.ys.set(next, deltas[3 * i + 1]);
    out.zs.set(next, deltas[3 * i + 2]);
    indices.set(next++, vertices ? vertices[i] : static_cast<uint32_t>(i));
  }
  target.deltas = out;
  target.vertex_indices = indices;
  target.channel_index = static_cast<uint16_t>(channel);

  // The first target of the channel is replaced; others of it go.
  const dna::List<dna::BlendShapeTarget> old = changed.blend_shape_targets;
  const Span<dna::BlendShapeTarget> list =
      edit.arena().array<dna::BlendShapeTarget>(size_t{old.count} + 1);
  if (!list.data) return no_memory(error, "an edit");
  uint32_t kept = 0;
  bool placed = moving == 0;
  for (const dna::BlendShapeTarget& other : old) {
    if (other.channel_index != channel) {
      list[kept++] = other;
    } else if (!placed) {
      list[kept++] = target;
      placed = true;
    }
  }
  if (!placed) list[kept++] = target;
  changed.blend_shape_targets = {list.data, kept};
  if (!set_pair(edit, mesh, channel, moving != 0)) return no_memory(error, "an edit");
  edit.commit();
  return Status::kOk;
}

Status prune_targets(Document& document, float epsilon, uint64_t& out_deltas, uint64_t& out_targets,
                     Error& error) {
  out_deltas = out_targets = 0;
  if (!(epsilon >= 0) || !std::isfinite(epsilon)) {
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "epsilon is %g; it is a length from 0 on", static_cast<double>(epsilon));
  }
  if (Status s = check_document(document, error); s != Status::kOk) return s;
  Edit edit(document);
  if (!edit.begin(error)) return error.status;
  Arena& arena = edit.arena();
  if (!copy_list(arena, edit.view.geom.meshes)) return no_memory(error, "an edit");
  const double limit = double{epsilon} * double{epsilon};
  for (uint32_t m = 0; m < edit.view.geom.meshes.count; ++m) {
    dna::Mesh& mesh = edit.view.geom.meshes[m];
    if (!copy_list(arena, mesh.blend_shape_targets)) return no_memory(error, "an edit");
    uint32_t targets = 0;
    for (dna::BlendShapeTarget& target : mesh.blend_shape_targets) {
      const uint32_t count = target.vertex_indices.count;
      const auto stays = [&](uint32_t i) {
        const Vec3 delta = vector_of(target.deltas, i);
        return !(dot(delta, delta) <= limit);
      };
      uint32_t left = 0;
      for (uint32_t i = 0; i < count; ++i) left += stays(i);
      if (left != count && left != 0) {
        NewVec3s deltas;
        NewArray<uint32_t> vertices;
        if (!deltas.allocate(arena, left) || !make(arena, left, vertices))
          return no_memory(error, "an edit");
        uint32_t next = 0;
        for (uint32_t i = 0; i < count; ++i) {
          if (!stays(i)) continue;
          deltas.xs.set(next, target.deltas.xs[i]);
          deltas.ys.set(next, target.deltas.ys[i]);
          deltas.zs.set(next, target.deltas.zs[i]);
          vertices.set(next++, target.vertex_indices[i]);
        }
        target.deltas = deltas;
        target.vertex_indices = vertices;
      }
      out_deltas += count - left;
      if (left == 0) {
        ++out_targets;
        if (!set_pair(edit, m, target.channel_index, false)) return no_memory(error, "an edit");
        continue;
      }
      mesh.blend_shape_targets[targets++] = target;
    }
    mesh.blend_shape_targets.count = targets;
  }
  edit.commit();
  return Status::kOk;
}

// The whole character -------------------------------------------------------------------------------

namespace {

/// Names the first root joint that controls move, if any.
bool moves_root(const dna::DnaView& view, uint32_t& joint) {
  const Array<uint16_t>& parents = view.defn.joint_hierarchy;
  for (const dna::JointGroup& group : view.bhvr.joints.groups) {
    for (uint32_t r = 0; r < group.output_indices.count; ++r) {
      joint = group.output_indices[r] / 9;
      if (parents[joint] == joint && group.output_indices[r] % 9 < 6) return true;
    }
  }
  const dna::MlJoints& ml = view.mlbe.joints;
  if (const uint32_t width = dna::ml_joint_attributes(ml)) {
    for (uint32_t i = 0; i < ml.output_indices.count; ++i) {
      joint = ml.output_indices[i] / width;
      if (parents[joint] == joint) return true;
    }
  }
  return false;
}

/// Translation rows of joint groups, times `scale`.
bool scale_joint_rows(dna::DnaView& view, double scale, Arena& arena) {
  if (!copy_list(arena, view.bhvr.joints.groups)) return false;
  for (dna::JointGroup& group : view.bhvr.joints.groups) {
    const uint32_t columns = group.input_indices.count;
    NewArray<float> values;
    for (uint32_t r = 0; r < group.output_indices.count; ++r) {
      if (group.output_indices[r] % 9 >= 3) continue;
      if (!values.data && !copy_array(arena, group.values, values)) return false;
      for (uint32_t c = 0; c < columns; ++c) {
        const size_t at = size_t{r} * columns + c;
        values.set(at, static_cast<float>(double{group.values[at]} * scale));
      }
    }
    if (values.data) group.values = values;
  }
  return true;
}

}  // namespace

Status place_character(Document& document, const CharacterPlacement& placement, Error& error) {
  const double* const numbers[] = {&placement.scale, placement.rotation, placement.translation};
  for (size_t n = 0; n < 3; ++n) {
    for (int k = 0; k < (n == 0 ? 1 : 3); ++k) {
      if (std::isfinite(numbers[n][k])) continue;
      return fail(error, Status::kInvalidArgument, kNoOffset,
                  "the placement has a number that is not finite");
    }
  }
  if (!(placement.scale > 0)) {
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "the scale is %g; it is above 0 (mirroring would need another rig)",
                placement.scale);
  }
  if (Status s = check_document(document, error); s != Status::kOk) return s;
  const dna::DnaView& old = document.view();
  const bool turns =
      placement.rotation[0] != 0 || placement.rotation[1] != 0 || placement.rotation[2] != 0;
  const bool scales = placement.scale != 1;
  const bool shifts = placement.translation[0] != 0 || placement.translation[1] != 0 ||
                      placement.translation[2] != 0;
  uint32_t joint = 0;
  if (turns && moves_root(old, joint)) {
    const dna::String& name = old.defn.joint_names[joint];
    return fail(error, Status::kDnaValue, kNoOffset,
                "root joint \"%.*s\" is moved by controls, whose angles about turned axes are no "
                "sums: add a root "
                "above it, or clear its animation",
                static_cast<int>(name.count), name.chars());
  }
  if (scales && dna::ml_joint_widths(old.mlbe.joints).translation != 0 &&
      old.mlbe.joints.output_indices.count != 0) {
    return fail(error, Status::kDnaValue, kNoOffset,
                "networks translate joints (mlbe.mlbJoints), and their outputs are not scaled: "
                "clear the animation "
                "of these joints first");
  }
  Edit edit(document);
  if (!edit.begin(error)) return error.status;
  Arena& arena = edit.arena();
  dna::DnaView& view = edit.view;

  RotationConvention right_handed;  // about x, then y, then z
  right_handed.to_radians = static_cast<float>(kPi / 180);
  const float angles[3] = {static_cast<float>(placement.rotation[0]),
                           static_cast<float>(placement.rotation[1]),
                           static_cast<float>(placement.rotation[2])};
  Rigid turn;
  if (turns) turn.turn = matrix_from_euler(right_handed, angles);
  const Vec3 shift{placement.translation[0], placement.translation[1], placement.translation[2]};
  const auto direction = [&](const Vec3& v) { return turns ? turned(v, turn.turn) : v; };
  const auto vector = [&](const Vec3& v) { return direction(v * placement.scale); };
  const auto point = [&](const Vec3& v) { return vector(v) + shift; };

  // Roots turn and move, other joints keep their place relative to their parent.
  dna::Definition& defn = view.defn;
  const RotationConvention convention = convention_of(view);
  NewVec3s places, about;
  const uint32_t joints = defn.joint_names.count;
  if (!places.allocate(arena, joints) || !about.allocate(arena, joints))
    return no_memory(error, "an edit");
  for (uint32_t j = 0; j < joints; ++j) {
    const bool root = defn.joint_hierarchy[j] == j;
    const Vec3 place = vector_of(defn.neutral_translations, j);
    places.set(j, root ? point(place) : place * placement.scale);
    if (root && turns) {
      float turned_angles[3];
      euler_from_matrix(convention, neutral_of(old, convention, j).turn * turn.turn, turned_angles);
      about.xs.set(j, turned_angles[0]);
      about.ys.set(j, turned_angles[1]);
      about.zs.set(j, turned_angles[2]);
    } else {
      about.xs.set(j, defn.neutral_rotations.xs[j]);
      about.ys.set(j, defn.neutral_rotations.ys[j]);
      about.zs.set(j, defn.neutral_rotations.zs[j]);
    }
  }
  defn.neutral_translations = places;
  if (turns) defn.neutral_rotations = about;
  if (scales && !scale_joint_rows(view, placement.scale, arena)) return no_memory(error, "an edit");

  bool done = copy_list(arena, view.geom.meshes);
  for (uint32_t m = 0; done && m < view.geom.meshes.count; ++m) {
    dna::Mesh& mesh = view.geom.meshes[m];
    if (turns || scales || shifts) done = change_vectors(arena, mesh.positions, point);
    if (done && turns) done = change_vectors(arena, mesh.normals, direction);
    if (!done || !(turns || scales)) continue;
    done = copy_list(arena, mesh.blend_shape_targets);
    for (uint32_t t = 0; done && t < mesh.blend_shape_targets.count; ++t) {
      done = change_vectors(arena, mesh.blend_shape_targets[t].deltas, vector);
    }
  }
  if (!done) return no_memory(error, "an edit");
  edit.commit();
  return Status::kOk;
}

}  // namespace mien::author
