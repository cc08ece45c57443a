// SPDX-License-Identifier: MIT
#include "runtime/baked/baked_rig.h"

#include <cstddef>
#include <cstring>
#include <initializer_list>
#include <type_traits>

namespace mien {
namespace {

// What a rig consists of
// ---------------------------------------------------------------------------

/// Calls f(number) for every number, truth value or small array of them that is stored.
template <class AnyRig, class F>
void for_each_scalar(AnyRig& rig, F&& f) {
  const auto each = [&](auto&... fields) { (f(fields), ...); };
  const auto all = [&](auto& fields) {
    for (auto& field : fields) f(field);
  };
  // The settings first: whoever looks into an image finds them at its beginning.
  each(rig.quaternion_outputs, rig.half_storage, rig.ml.blend_masks, rig.portable, rig.reads_back);
  each(rig.lod_count, rig.units.translation, rig.units.rotation, rig.units.rotation_sequence);
  all(rig.units.axes);
  all(rig.units.rotation_signs);
  each(rig.gui_count, rig.raw_count, rig.psd_count, rig.ml_count, rig.rbf_count);
  each(rig.control_count, rig.joint_count, rig.channel_count, rig.map_count, rig.mesh_count);
  each(rig.mask_count, rig.joint_attributes);
  each(rig.joints.contested, rig.joints.group_count, rig.joints.panel_shift);
  each(rig.joints.widest_group, rig.joints.tallest_group);
  each(rig.rotations.max_quaternion_joints, rig.rbf.independent);

  auto& ml = rig.ml;
  each(ml.buffer_size, ml.widest_layer, ml.quaternion_rotations, ml.converts);
  auto& change = ml.change;
  all(change.from);
  all(change.to);
  all(change.vector);
  all(change.normal);
  all(change.turn);
  all(change.angle);
  each(change.length_unit, change.angle_unit);
  each(change.moves_axes, change.carries_angles, change.reverses_faces);
  for (auto* rotation : {&rig.rotation, &ml.rotation}) {
    all(rotation->axes);
    all(rotation->signs);
    each(rotation->parity, rotation->to_radians);
  }
  for (auto& row : ml.to_rig.m) all(row);
}

/// Calls f(span) for every array, in the order of an image.
template <class AnyRig, class F>
void for_each_span(AnyRig& rig, F&& f) {
  const auto each = [&](auto&... spans) { (f(spans), ...); };
  auto& joints = rig.joints;
  auto& rotations = rig.rotations;
  auto& rbf = rig.rbf;
  auto& ml = rig.ml;

  // Indices and counts.
  for (auto* table : {&rig.gui_to_raw, &rig.maps}) {
    each(table->inputs, table->outputs, table->run_ends);
  }
  each(rig.driven_raw, rig.map_rows_at_lod);
  each(rig.raw_to_gui.first_group, rig.raw_to_gui.first_row, rig.raw_to_gui.rows);
  each(rig.psds.outputs, rig.psds.first_input, rig.psds.inputs, rig.psds.count_at_lod);
  each(rig.psds.run_lengths, rig.psds.entry_of_psd);
  each(rig.channels.inputs, rig.channels.outputs, rig.channels.count_at_lod);
  each(rotations.groups, rotations.angle_joints, rotations.quaternion_joints, rotations.columns);
  each(rotations.columns_at_lod);
  each(rig.twist_swing.setups, rig.twist_swing.outputs);
  each(rbf.plans, rbf.solvers, rbf.inputs, rbf.rotations, rbf.poses, rbf.first_input);
  each(rbf.first_output, rbf.pose_inputs, rbf.pose_outputs);
  each(ml.steps, ml.layers, ml.controls, ml.dependencies, ml.limits, ml.joints);
  for (auto* lists : {&rig.lod_joints, &rig.lod_channels, &rig.lod_maps, &rig.lod_meshes,
                      &rbf.lod_solvers, &rig.variable_joint_values}) {
    each(lists->row_of_lod, lists->first, lists->indices);
  }
  each(rig.joint_parents);
  for (auto& names : rig.names) each(names.first, names.sorted);
  each(joints.columns, joints.column_of_control, joints.first_block, joints.first_entry,
       joints.panels, joints.targets);
  each(joints.panels_at_lod, joints.targets_at_lod, joints.group_rows_at_lod);
  each(joints.parts, joints.block_rows);

  // What can do no harm.
  for (auto& names : rig.names) each(names.chars);
  each(joints.control_panels, rig.initial_controls, rig.neutral_joints);
  for (auto* table : {&rig.gui_to_raw, &rig.maps}) {
    each(table->from, table->to, table->slope, table->cut);
  }
  each(rig.psds.weights, rbf.swings, rbf.pose_scales, rbf.pose_factors, rbf.pose_weights);
  each(rbf.targets, rbf.inverses, ml.default_is_one, ml.biases, ml.values, ml.halves);
  each(rotations.values, rotations.halves);
  each(joints.scales, joints.values, joints.fixed_values);
}

template <class T>
constexpr uint32_t element_size(const Span<T>&) {
  return sizeof(T);
}

// Sums of their fields: an element that hides padding would make two images of one rig.
static_assert(sizeof(ColumnPart) == 4 && sizeof(JointPanel) == 8 && sizeof(JointTarget) == 6 &&
                  sizeof(QuaternionJoint) == 4,
              "");
static_assert(sizeof(GroupRotations) == 24 + sizeof(size_t) && sizeof(RbfSolver) == 4, "");
static_assert(sizeof(RbfSolverPlan) == 32 + 2 * sizeof(size_t), "");
static_assert(sizeof(NetworkLayer) == 24 + sizeof(size_t) && sizeof(MlDependency) == 16, "");
static_assert(sizeof(MlStep) == 56 && sizeof(MlJoint) == 24, "");
static_assert(sizeof(TwistSwing) == 28 && sizeof(TwistSwingOutput) == 16, "");

struct Counts {
  uint32_t scalars = 0, spans = 0;
};

Counts count_parts(const Rig& rig) {
  Counts counts;
  for_each_scalar(rig, [&](const auto&) { ++counts.scalars; });
  for_each_span(rig, [&](const auto&) { ++counts.spans; });
  return counts;
}

size_t head_size(const Counts& counts) {
  return sizeof(ImageHeader) + counts.scalars * sizeof(uint64_t) + counts.spans * sizeof(ImageSpan);
}

Status damaged(Error& error, uint64_t at, const char* what) {
  return fail(error, Status::kBakedStructure, at, "%s: the image is damaged; bake the rig again",
              what);
}

bool read_scalar(const uint8_t* slot, bool& out) {
  out = slot[0] != 0;
  return slot[0] <= 1;
}
template <class T>
bool read_scalar(const uint8_t* slot, T& out) {
  memcpy(&out, slot, sizeof(T));
  return true;
}

}  // namespace

// Writing
// ------------------------------------------------------------------------------------------

size_t image_size(const Rig& rig) {
  size_t size = head_size(count_parts(rig));
  for_each_span(rig, [&](const auto& span) {
    size = align_up(size, kBlockAlignment) + span.count * element_size(span);
  });
  return align_up(size, kBlockAlignment);
}

void write_image(const Rig& rig, uint8_t* bytes) {
  const size_t size = image_size(rig);
  const Counts counts = count_parts(rig);
  memset(bytes, 0, size);
  ImageHeader header = {};
  memcpy(header.magic, kImageMagic, sizeof(kImageMagic));
  header.byte_order = kImageByteOrder;
  header.version = kBakedVersion;
  header.file_size = size;
  header.scalar_count = counts.scalars;
  header.span_count = counts.spans;

  uint8_t* slot = bytes + sizeof(ImageHeader);
  for_each_scalar(rig, [&](const auto& field) {
    memcpy(slot, &field, sizeof(field));
    slot += sizeof(uint64_t);
  });
  size_t at = head_size(counts);
  for_each_span(rig, [&](const auto& span) {
    at = align_up(at, kBlockAlignment);
    const ImageSpan entry = {at, span.count, element_size(span), 0};
    memcpy(slot, &entry, sizeof(entry));
    slot += sizeof(entry);
    const size_t length = span.count * element_size(span);
    if (length) memcpy(bytes + at, static_cast<const void*>(span.data), length);
    at += length;
  });
  memcpy(bytes, &header, sizeof(header));
  header.checksum = image_checksum(bytes, size);
  memcpy(bytes, &header, sizeof(header));
}

// Eight sums that do not wait for each other; each step can be undone, so that a change of one word
// always shows.
uint64_t image_checksum(const uint8_t* bytes, size_t size) {
  constexpr size_t kLanes = 8, kStep = kLanes * sizeof(uint64_t);
  constexpr uint64_t kOdd = 0x9E37'79B9'7F4A'7C15;
  uint64_t sums[kLanes];
  for (size_t i = 0; i < kLanes; ++i) sums[i] = kOdd * (i + 1);
  size_t at = offsetof(ImageHeader, scalar_count);
  for (; at + kStep <= size; at += kStep) {
    uint64_t words[kLanes];
    memcpy(words, bytes + at, kStep);
    for (size_t i = 0; i < kLanes; ++i) {
      sums[i] = (sums[i] ^ words[i]) * kOdd;
      sums[i] ^= sums[i] >> 32;
    }
  }
  uint64_t sum = size;
  for (; at < size; ++at) sum = (sum ^ bytes[at]) * kOdd;
  for (uint64_t lane : sums) {
    sum = (sum ^ lane) * kOdd;
    sum ^= sum >> 29;
  }
  return sum;
}

// Opening
// ------------------------------------------------------------------------------------------

namespace {

Status read_header(const uint8_t* bytes, size_t size, ImageHeader& header, Error& error) {
  const size_t common = size < sizeof(kImageMagic) ? size : sizeof(kImageMagic);
  if (common == 0 || memcmp(bytes, kImageMagic, common) != 0) {
    return fail(error, Status::kBakedSignature, 0,
                "not an image of a rig: it does not begin with "
                "MIENRIG; give a file that mien bake wrote");
  }
  if (size < sizeof(header)) {
    return fail(error, Status::kBakedTruncated, size, "the image ends within its header");
  }
  memcpy(&header, bytes, sizeof(header));
  if (header.byte_order != kImageByteOrder) {
    return fail(error, Status::kBakedVersion, offsetof(ImageHeader, byte_order),
                "the image was made on a machine of another byte order; bake the rig for this one");
  }
  if (header.version != kBakedVersion) {
    return fail(error, Status::kBakedVersion, offsetof(ImageHeader, version),
                "the image is of version %u, this library reads %u; bake the rig again",
                header.version, kBakedVersion);
  }
  if (header.file_size > size) {
    return fail(error, Status::kBakedTruncated, size,
                "the image ends after %zu of %llu bytes; fetch or bake it again", size,
                static_cast<unsigned long long>(header.file_size));
  }
  if (header.file_size < size) return damaged(error, header.file_size, "bytes behind the end");
  for (uint8_t zero : header.zeros) {
    if (zero) return damaged(error, offsetof(ImageHeader, zeros), "header");
  }
  return Status::kOk;
}

}  // namespace

Status read_image(const uint8_t* bytes, size_t size, ImageCheck check, Rig& rig, Error& error) {
  ImageHeader header;
  Status status = read_header(bytes, size, header, error);
  if (status != Status::kOk) return status;
  const Counts counts = count_parts(rig);
  if (header.scalar_count != counts.scalars || header.span_count != counts.spans) {
    return damaged(error, offsetof(ImageHeader, scalar_count), "header");
  }
  if (size < head_size(counts)) return damaged(error, size, "header");
  if (check == ImageCheck::kFull && image_checksum(bytes, size) != header.checksum) {
    return fail(error, Status::kBakedChecksum, offsetof(ImageHeader, checksum),
                "the bytes are not those that were written: the image is damaged; fetch or bake it "
                "again");
  }

  const uint8_t* slot = bytes + sizeof(ImageHeader);
  bool good = true;
  for_each_scalar(rig, [&](auto& field) {
    good &= read_scalar(slot, field);
    slot += sizeof(uint64_t);
  });
  if (!good) return damaged(error, sizeof(ImageHeader), "scalars");

  size_t at = head_size(counts);
  for_each_span(rig, [&](auto& span) {
    if (status != Status::kOk) return;
    ImageSpan entry;
    memcpy(&entry, slot, sizeof(entry));
    const auto offset = static_cast<uint64_t>(slot - bytes);
    slot += sizeof(entry);
    const uint32_t element = element_size(span);
    if (entry.element_size != element) {
      status =
          fail(error, Status::kBakedVersion, offset,
               "elements of %u bytes where this library has %u: the image was made for another "
               "kind of machine; bake the rig for this one",
               entry.element_size, element);
      return;
    }
    at = align_up(at, kBlockAlignment);
    if (entry.zero != 0 || entry.offset != at || at > size || entry.count > (size - at) / element) {
      status = damaged(error, offset, "table of arrays");
      return;
    }
    // Rigs are never written to once they are made.
    using T = typename std::remove_reference<decltype(span)>::type;
    uint8_t* data = const_cast<uint8_t*>(bytes) + at;
    span = T{reinterpret_cast<decltype(T::data)>(data), static_cast<size_t>(entry.count)};
    at += span.count * element;
  });
  if (status != Status::kOk) return status;
  if (align_up(at, kBlockAlignment) != size) return damaged(error, at, "end of the image");
  return check_rig(rig, check == ImageCheck::kFull, error);
}

}  // namespace mien
