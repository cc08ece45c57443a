// SPDX-License-Identifier: MIT
#include "runtime/probe/probe_controls.h"

#include <algorithm>
#include <cmath>

#include "runtime/eval/evaluate.h"

namespace mien {
namespace {

Status no_memory_to_probe(Error& error) {
  return fail(error, Status::kMemory, kNoOffset, "no memory to try the controls");
}

// Mirror images
// ------------------------------------------------------------------------------------------------

constexpr double kSame = 0.25;  // share of the motion by which mirror images may differ
constexpr uint32_t kMaxName = 256;

bool begins_with(Span<const char> text, size_t at, const char* word) {
  for (size_t i = 0; word[i]; ++i) {
    if (at + i >= text.count || text[at + i] != word[i]) return false;
  }
  return true;
}

/// L and R that stand for sides: alone between underscores, at the end, or before a phase ("LPh1").
bool is_side(Span<const char> name, size_t i) {
  if (name[i] != 'L' && name[i] != 'R') return false;
  const bool last = i + 1 == name.count;
  if (!last && name[i + 1] == '_') return i == 0 || name[i - 1] == '_';
  return (last && i != 0) || begins_with(name, i + 1, "Ph");
}

/// The name with sides exchanged; its length, 0 if it names no side or is too long.
size_t mirror_name(Span<const char> name, char* out) {
  size_t length = 0;
  bool changed = false;
  for (size_t i = 0; i < name.count;) {
    const char* word = nullptr;
    size_t taken = 1;
    if (begins_with(name, i, "Left")) word = "Right", taken = 4;
    if (begins_with(name, i, "Right")) word = "Left", taken = 5;
    if (is_side(name, i)) word = name[i] == 'L' ? "R" : "L";
    changed = changed || word;
    for (size_t k = 0; word ? word[k] != 0 : k < 1; ++k) {
      if (length == kMaxName) return 0;
      out[length++] = word ? word[k] : name[i];
    }
    i += taken;
  }
  return changed ? length : 0;
}

uint16_t find_mirrored_name(const NameList& names, uint32_t index) {
  char name[kMaxName];
  const size_t length = mirror_name(names[index], name);
  for (uint32_t i = 0; length != 0 && i < names.count(); ++i) {
    const Span<char> other = names[i];
    if (other.count == length && std::equal(name, name + length, other.data)) {
      return static_cast<uint16_t>(i);
    }
  }
  return 0xFFFF;
}

/// Displacements of three points at each joint: at its origin, in front of it, and above it.
constexpr uint32_t kMotionFloats = 9;
constexpr uint32_t kMaxMotions = 1 << 22;  // 151 MB

class Mirror {
 public:
  Mirror(const Deformer& deformer, RigProbe& probe, Arena& arena)
      : deformer_(deformer), probe_(probe), rig_(probe.rig()) {
    motions_ = arena.array<float>(size_t{rig_.raw_count} * rig_.joint_count * kMotionFloats);
    sizes_ = arena.array<double>(rig_.raw_count);
    twins_ = arena.array<uint16_t>(rig_.joint_count);
  }
  bool ready() const {
    const bool controls = rig_.raw_count != 0, joints = rig_.joint_count != 0;
    return (sizes_.data || !controls) && (twins_.data || !joints) &&
           (motions_.data || !controls || !joints);
  }

  void measure() {
    for (uint32_t j = 0; j < rig_.joint_count; ++j) twins_[j] = find_twin(j);
    for (uint16_t c = 0; c < rig_.raw_count; ++c) {
      probe_.clear();
      probe_.set(c, 1);
      probe_.pose();
      for (uint32_t j = 0; j < rig_.joint_count; ++j) measure_joint(c, j);
      double square = 0;
      const float* m = motion(c, 0);
      for (size_t i = 0; i < size_t{rig_.joint_count} * kMotionFloats; ++i) {
        square += double{m[i]} * m[i];
      }
      sizes_[c] = std::sqrt(square);
    }
  }

  uint16_t find(uint16_t control) const {
    const NameList& names = rig_.names[static_cast<size_t>(Kind::kRawControl)];
    const uint16_t named = find_mirrored_name(names, control);
    const bool moves = sizes_[control] > 1e-4;
    if (named != 0xFFFF && (!moves || difference(control, named) <= kSame)) return named;
    uint16_t best = control;
    double least = moves ? difference(control, control) : 0;
    for (uint16_t c = 0; moves && c < rig_.raw_count; ++c) {
      const double d = difference(control, c);
      if (d < least) best = c, least = d;
    }
    return least <= kSame ? best : control;
  }

 private:
  const float* motion(uint32_t control, uint32_t joint) const {
    return motions_.data + (size_t{control} * rig_.joint_count + joint) * kMotionFloats;
  }
  const float* neutral(uint32_t joint) const {
    return deformer_.skeleton.bind.data + size_t{joint} * kMatrixFloats + 12;
  }

  /// In the order left, up, front, so that mirroring is a change of sign of the first.
  void measure_joint(uint16_t control, uint32_t joint) {
    const Vec3 axes[3] = {probe_.axis(0), probe_.axis(2), probe_.axis(4)};
    const float* at = neutral(joint);
    const double reach = 30 / probe_.millimeters();
    float* out = motions_.data + (motion(control, joint) - motions_.data);
    for (int point = 0; point < 3; ++point) {
      Vec3 p = {at[0], at[1], at[2]};
      if (point != 0) p = p + axes[point] * reach;
      const Vec3 moved = probe_.skinned(joint, p) - p;
      for (int k = 0; k < 3; ++k) out[point * 3 + k] = static_cast<float>(dot(moved, axes[k]));
    }
  }

  /// The difference as a share of the first motion: 0 if one is the mirror image of the other.
  double difference(uint16_t a, uint16_t b) const {
    double square = 0;
    for (uint32_t j = 0; j < rig_.joint_count; ++j) {
      const float *x = motion(a, j), *y = motion(b, twins_[j]);
      for (uint32_t i = 0; i < kMotionFloats; ++i) {
        const double d = double{x[i]} - (i % 3 == 0 ? -y[i] : y[i]);
        square += d * d;
      }
    }
    return std::sqrt(square) / sizes_[a];
  }

  /// By name, else the joint nearest to the mirrored place.
  uint16_t find_twin(uint32_t joint) const {
    const uint16_t named = find_mirrored_name(rig_.names[static_cast<size_t>(Kind::kJoint)], joint);
    if (named != 0xFFFF) return named;
    const Vec3 left = probe_.axis(0);
    const float* p = neutral(joint);
    const Vec3 at = {p[0], p[1], p[2]}, there = at - left * (2 * dot(at, left));
    const auto away = [&](uint32_t j) {
      const float* q = neutral(j);
      return length(Vec3{q[0], q[1], q[2]} - there);
    };
    uint32_t best = joint;
    for (uint32_t j = 0; j < rig_.joint_count; ++j) {
      if (away(j) + 1e-4 < away(best)) best = j;
    }
    return static_cast<uint16_t>(best);
  }

  const Deformer& deformer_;
  RigProbe& probe_;
  const Rig& rig_;
  Span<float> motions_;
  Span<double> sizes_;
  Span<uint16_t> twins_;
};

/// The half of a GUI control that drives a raw control: 1, -1, or 0 for both or none.
int driven_half(const ControlTable& table, size_t row) {
  const double at_end =
      double{table.slope[row]} * (table.from[row] >= 0 ? table.to[row] : table.from[row]) +
      table.cut[row];
  if (!(at_end > 0)) return 0;
  return table.from[row] >= 0 ? 1 : table.to[row] <= 0 ? -1 : 0;
}

}  // namespace

uint32_t find_antagonists(const Rig& rig, Span<AntagonistPair> out) {
  const ControlTable& table = rig.gui_to_raw;
  // [raw control] the first row that drives it, if all its rows are of one half of one GUI control.
  constexpr uint32_t kNone = ~uint32_t{0}, kMixed = kNone - 1;
  uint32_t first_rows[kMaxCurves];
  std::fill(first_rows, first_rows + kMaxCurves, kNone);
  for (uint32_t r = 0; r < table.inputs.count; ++r) {
    if (table.outputs[r] >= kMaxCurves) continue;
    uint32_t& first = first_rows[table.outputs[r]];
    if (first == kNone) {
      first = r;
    } else if (first != kMixed && (table.inputs[r] != table.inputs[first] ||
                                   driven_half(table, r) != driven_half(table, first))) {
      first = kMixed;
    }
  }
  // Those of lower halves, by their GUI controls.
  uint16_t lower[kMaxCurves];
  uint32_t lower_count = 0;
  for (uint16_t c = 0; c < kMaxCurves; ++c) {
    if (first_rows[c] < kMixed && driven_half(table, first_rows[c]) == -1) lower[lower_count++] = c;
  }
  const auto gui_of = [&](uint16_t control) { return table.inputs[first_rows[control]]; };
  std::sort(lower, lower + lower_count, [&](uint16_t x, uint16_t y) {
    return gui_of(x) != gui_of(y) ? gui_of(x) < gui_of(y) : first_rows[x] < first_rows[y];
  });
  uint32_t count = 0;
  for (uint32_t r = 0; r < table.inputs.count; ++r) {
    const uint16_t a = table.outputs[r];
    if (a >= kMaxCurves || first_rows[a] != r || driven_half(table, r) != 1) continue;
    const uint16_t* b = std::lower_bound(lower, lower + lower_count, table.inputs[r],
                                         [&](uint16_t x, uint16_t gui) { return gui_of(x) < gui; });
    for (; b != lower + lower_count && gui_of(*b) == table.inputs[r]; ++b) {
      if (count < out.count) out[count] = {a, *b, 1};
      ++count;
    }
  }
  return count;
}

Status find_mirror(const Deformer& deformer, const Allocator& allocator, Span<uint16_t> out,
                   Error& error) {
  const Rig& rig = *deformer.rig;
  if (uint64_t{rig.raw_count} * rig.joint_count > kMaxMotions) {
    return fail(error, Status::kDnaLimit, kNoOffset,
                "%u raw controls and %u joints: what each control does to each joint is compared, "
                "for products up to %u",
                rig.raw_count, rig.joint_count, kMaxMotions);
  }
  Arena arena(allocator);
  RigProbe probe(deformer, allocator);
  if (!probe.ready()) return no_memory_to_probe(error);
  Mirror mirror(deformer, probe, arena);
  if (!mirror.ready()) return no_memory_to_probe(error);
  mirror.measure();
  for (uint16_t c = 0; c < out.count; ++c) out[c] = mirror.find(c);
  // Only pairs that name each other: a map that is not its own inverse would lose controls.
  for (uint16_t c = 0; c < out.count; ++c) {
    if (out[out[c]] != c) out[c] = c;
  }
  return Status::kOk;
}

Status mask_of_groups(const Rig& rig, Span<const uint32_t> groups, float otherwise,
                      const Allocator& allocator, Span<float> out, Error& error) {
  for (uint32_t group : groups) {
    if (group < rig.joints.group_count) continue;
    return fail(error, Status::kIndex, kNoOffset, "joint group %u of %u", group,
                rig.joints.group_count);
  }
  Instance* instance = create_instance(rig, allocator);
  if (!instance) return no_memory_to_probe(error);
  const uint32_t attributes = rig.joint_attributes;
  const double millimeters = rig.units.translation == 0 ? 10 : 1000;
  const double degrees = rig.quaternion_outputs ? 114.6 : rig.units.rotation == 0 ? 1 : 57.3;
  const auto motion_of = [&](uint32_t group) {
    std::fill(instance->joints.begin(), instance->joints.end(), 0.0f);
    evaluate_joint_group(rig, *instance, 0, group);
    double sum = 0;
    for (uint32_t j = 0; j < rig.joint_count; ++j) {
      const float* v = instance->joints.data + size_t{j} * attributes;
      const Vec3 shift = {v[0], v[1], v[2]}, turn = {v[3], v[4], v[5]};
      sum += length(shift) * millimeters + length(turn) * degrees;
    }
    return sum;
  };
  for (uint32_t c = 0; c < out.count; ++c) {
    std::copy_n(rig.initial_controls.begin(), rig.raw_count, instance->controls.begin());
    instance->controls[c] = 1;
    evaluate(rig, *instance, 0, kStageMl | kStageRbf | kStagePsd);
    double inside = 0, all = 0;
    for (uint32_t g = 0; g < rig.joints.group_count; ++g) {
      const double motion = motion_of(g);
      all += motion;
      if (std::find(groups.begin(), groups.end(), g) != groups.end()) inside += motion;
    }
    out[c] = all > 1e-6 ? static_cast<float>(inside / all) : otherwise;
  }
  release(instance);
  return Status::kOk;
}

}  // namespace mien
