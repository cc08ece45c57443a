// SPDX-License-Identifier: MIT
// Creates fits: checks, one block of memory, and the measurement of the rig.
#include "solve/fit.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "solve/frame.h"
#include "solve/surface.h"

using namespace mien;
using namespace mien::capi;

namespace {

constexpr float kNoBound = 2;  // that a part of a unit quaternion reaches

size_t count_of(const MienRig* rig, uint32_t kind) {
  uint32_t count = 0;
  static_cast<void>(mien_rig_count(rig, kind, &count));
  return count;
}

void place(const MienFitDesc& desc, Placer& placer, MienFit& fit) {
  placer.array<MienFit>(1);
  placer.keep(fit.meshes);
  const size_t raw = fit.raw_count, all = fit.control_count, joints = fit.joint_count;
  const size_t moving = desc.controls ? desc.control_count : raw;
  fit.initial = placer.array<float>(raw);
  fit.controls = placer.array<uint32_t>(moving);
  fit.lower = placer.array<float>(moving);
  fit.upper = placer.array<float>(moving);
  fit.rotations = placer.array<uint32_t>(
      find_rotations(fit.rig, {fit.raw.data, fit.raw.count}, desc.controls, moving, nullptr));
  fit.resting = placer.array<uint8_t>(moving);
  fit.symmetric = placer.array<uint32_t>(desc.symmetric_count);
  fit.points = placer.array<MienSolvePoint>(desc.point_count);
  fit.joint_weights = placer.array<float>(joints);
  fit.joint_metric = placer.array<double>(all * all);
  fit.point_metric = placer.array<double>(desc.point_count ? all * all : 0);
  fit.observability = placer.array<float>(raw);
  fit.start = placer.array<float>(raw);
  fit.prior = placer.array<float>(raw);
  fit.best = placer.array<float>(raw);
  fit.joint_gradient = placer.array<float>(joints);
  fit.position_gradient = placer.array<float>(fit.position_count * 3);
  fit.from_joints = placer.array<float>(raw);
  fit.from_positions = placer.array<float>(raw);
  fit.metric_row = placer.array<float>(all);
  fit.projected = placer.array<double>(all);
  fit.support = placer.array<uint32_t>(all);
  fit.places = placer.array<uint32_t>(all);
  fit.reduced = placer.array<double>(moving * moving);
  fit.pull = placer.array<double>(all);
  fit.last_pull = placer.array<double>(all);
  fit.secant_rows = placer.array<float>(kMostSecants * all);
  fit.secant_weights = placer.array<double>(kMostSecants);
  fit.secant_changes = placer.array<double>(kMostSecants);
  fit.change = placer.array<double>(all);
  fit.response = placer.array<double>(all);
  fit.model_controls = placer.array<float>(all);
  fit.changed = placer.array<uint32_t>(all);
  fit.stiffness = placer.array<double>(moving);
  fit.joint_stiffness = placer.array<double>(moving);
  fit.point_stiffness = placer.array<double>(moving);
  fit.kept = placer.array<float>(raw);
  fit.start_joints = placer.array<float>(joints);
  fit.matrix = placer.array<double>(moving * moving);
  fit.factor = placer.array<double>(moving * moving);
  fit.gradient = placer.array<double>(moving);
  fit.step = placer.array<double>(moving);
  fit.work = placer.array<double>(moving);
  fit.free = placer.array<uint32_t>(moving);
  fit.inputs = placer.array<uint32_t>(moving);
  fit.first = placer.array<uint32_t>(moving + 1);
  const size_t entries = pattern_of(fit).rows.count;
  fit.rows = placer.array<uint32_t>(entries);
  fit.values = placer.array<float>(entries);
  fit.wanted = placer.array<uint8_t>(raw);
  fit.first_entry = placer.array<uint32_t>(raw + 1);
  fit.entries = placer.array<float>(entries);
  fit.surface = placer.array<double>(desc.point_count * 3);
  for (KindTargets& kind : fit.kinds) {
    kind.targets = placer.array<double>(desc.point_count * 3);
    kind.weights = placer.array<double>(desc.point_count);
    kind.pulls = placer.array<double>(desc.point_count);
  }
  if (desc.deformer) {
    const size_t matrices = fit.bone_count * 16;
    fit.model_gradient = placer.array<float>(matrices);
    fit.constraint_rows = placer.array<float>(kMostConstraints * 3 * std::max(all, raw));
    fit.row_models = placer.array<float>(kRowsAtOnce * matrices);
    fit.row_parts = placer.array<float>(kRowsAtOnce * std::max(all, raw));
    fit.moved = placer.array<float>(kDirections * fit.position_count * 3);
    fit.row_weights = placer.array<double>(kMostConstraints * 3);
    fit.row_changes = placer.array<double>(kMostConstraints * 3);
  }
  if (desc.point_count == 0) return;
  fit.start_surface = placer.array<double>(desc.point_count * 3);
  fit.whole_points = placer.array<MienSolvePoint>(desc.point_count);
  fit.samples = placer.array<uint32_t>(sample_count(desc.point_count, kMostSamples));
  fit.own_samples = placer.array<uint32_t>(fit.samples.count);
  fit.is_sample = placer.array<uint8_t>(desc.point_count);
  fit.sample_points = placer.array<MienSolvePoint>(fit.samples.count);
  fit.triangles = placer.array<uint32_t>(fit.triangle_count * 3);
  fit.normals = placer.array<double>(desc.point_count * 3);
  fit.lost = placer.array<uint8_t>(desc.point_count);
  fit.kept_targets = placer.array<double>(desc.point_count * 3);
  fit.kept_lost = placer.array<uint8_t>(desc.point_count);
  fit.position_normals = placer.array<float>(fit.whole_count * 3);
  fit.sample_effects = placer.array<float>(all * fit.samples.count * 3);
  fit.step_effects = placer.array<float>(moving * fit.samples.count * 3);
  fit.directions = placer.array<float>(kDirections * raw);
  fit.measured = placer.array<uint8_t>(moving);
  fit.panel = placer.array<double>((moving + kMostMotion) * kPanel);
  fit.wide = placer.array<double>((moving + kMostMotion) * (moving + kMostMotion));
}

MienStatus check_bounds(const MienFitDesc& desc, size_t moving, MienError* error) {
  for (size_t i = 0; i < moving; ++i) {
    const float low = desc.lower ? desc.lower[i] : 0.0f, high = desc.upper ? desc.upper[i] : 1.0f;
    if (std::isfinite(low) && std::isfinite(high) && low <= high) continue;
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MienFitDesc: the bounds of control %zu are %g and %g: give finite ones, the "
                      "lower first",
                      i, double{low}, double{high});
  }
  return MIEN_OK;
}

MienStatus check_desc(const MienRig* rig, const MienFitDesc& desc, MienFit& fit, MienError* error) {
  MienRigInfo info = mien_rig_info_default();
  if (MienStatus status = mien_rig_info(rig, &info)) {
    return give_error(error, status,
                      rig ? "rig is a handle of another kind, or none" : "rig is NULL");
  }
  if (desc.lod >= info.lod_count) {
    return give_error(error, MIEN_ERROR_LOD, "MienFitDesc.lod is %u, the rig has %u", desc.lod,
                      info.lod_count);
  }
  fit.rig = rig;
  fit.lod = desc.lod;
  fit.raw_count = count_of(rig, MIEN_KIND_RAW_CONTROL);
  const size_t moving = desc.controls ? desc.control_count : fit.raw_count;
  for (size_t i = 0; desc.controls && i < moving; ++i) {
    if (desc.controls[i] >= fit.raw_count) {
      return give_error(error, MIEN_ERROR_INDEX,
                        "MienFitDesc.controls[%zu] is %u, the rig has %zu raw controls", i,
                        desc.controls[i], fit.raw_count);
    }
    if (i != 0 && desc.controls[i] <= desc.controls[i - 1]) {
      return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                        "MienFitDesc.controls is not ascending at %zu: sort it, each control once",
                        i);
    }
  }
  if (MienStatus status = check_bounds(desc, moving, error)) return status;
  if ((desc.symmetric_count != 0 && !desc.symmetric) || (desc.point_count != 0 && !desc.points)) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT,
                      "MienFitDesc has a count for an array that is NULL: symmetric or points");
  }
  for (size_t i = 0; i < desc.symmetric_count; ++i) {
    if (desc.symmetric[i] >= fit.raw_count) {
      return give_error(error, MIEN_ERROR_INDEX,
                        "MienFitDesc.symmetric[%zu] is %u, the rig has %zu raw controls", i,
                        desc.symmetric[i], fit.raw_count);
    }
  }
  if (desc.symmetric_count % 2 != 0) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MienFitDesc.symmetric_count is %zu: pairs are two controls each",
                      desc.symmetric_count);
  }
  if (desc.point_count == 0) return MIEN_OK;
  if (!desc.deformer) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT,
                      "MienFitDesc.deformer is NULL: points need the deformer of the rig");
  }
  MienMesh mesh = mien_mesh_default();
  for (size_t i = 0; i < desc.point_count; ++i) {
    const MienSolvePoint& point = desc.points[i];
    if (i == 0 || point.mesh != desc.points[i - 1].mesh) {
      if (MienStatus status = mien_deformer_mesh(desc.deformer, point.mesh, &mesh)) {
        return give_error(error, status, "MienFitDesc.points[%zu].mesh is %u: no such mesh", i,
                          point.mesh);
      }
    }
    for (size_t k = 0; k < 3; ++k) {
      if (point.positions[k] >= mesh.position_count) {
        return give_error(error, MIEN_ERROR_INDEX,
                          "MienFitDesc.points[%zu] has position %u, the mesh has %u", i,
                          point.positions[k], mesh.position_count);
      }
      if (!std::isfinite(point.weights[k])) {
        return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                          "MienFitDesc.points[%zu] has a weight that is not finite", i);
      }
    }
  }
  return MIEN_OK;
}

void copy_desc(const MienFitDesc& desc, MienFit& fit) {
  const auto moving = static_cast<uint32_t>(fit.controls.count);
  for (uint32_t i = 0; i < moving; ++i) {
    fit.controls[i] = desc.controls ? desc.controls[i] : i;
    fit.lower[i] = desc.lower ? desc.lower[i] : 0.0f;
    fit.upper[i] = desc.upper ? desc.upper[i] : 1.0f;
  }
  find_rotations(fit.rig, {fit.raw.data, fit.raw.count}, desc.controls, moving, fit.rotations.data);
  for (const uint32_t r : fit.rotations) {
    std::fill(fit.lower.data + r, fit.lower.data + r + 4, -kNoBound);
    std::fill(fit.upper.data + r, fit.upper.data + r + 4, kNoBound);
  }
  std::copy(desc.symmetric, desc.symmetric + desc.symmetric_count, fit.symmetric.data);
  for (size_t i = 0; i < fit.joint_count; ++i) {
    fit.joint_weights[i] = desc.joint_weights ? desc.joint_weights[i]
                           : desc.point_count ? 0.0f
                                              : 1.0f;
  }
}

MienMesh mesh_of(const MienDeformer* deformer, uint32_t index) {
  MienMesh mesh = mien_mesh_default();
  static_cast<void>(mien_deformer_mesh(deformer, index, &mesh));
  return mesh;
}

/// False if memory ran out.
bool copy_triangles(const MienFitDesc& desc, MienFit& fit) {
  for (FitMesh& one : fit.meshes) {
    const MienMesh mesh = mesh_of(desc.deformer, one.mesh);
    uint32_t* const to = fit.triangles.data + 3 * one.first_triangle;
    const size_t count = 3 * one.triangle_count;
    if (mien_deformer_triangles(desc.deformer, one.mesh, to, count) != MIEN_OK) return false;
    for (size_t i = 0; i < count; ++i) to[i] = mesh.vertex_position_indices.data[to[i]];
    one.inward = signed_volume(mesh.positions.data, to, one.triangle_count) < 0;
  }
  return true;
}

/// Positions of a mesh that points read, ascending, and the deformer of them.
struct Chosen {
  Span<uint32_t> positions;          // empty: all of the mesh
  MienDeformer* deformer = nullptr;  // null: that of the rig

  MienSolvePoint renumbered(MienSolvePoint point, uint32_t place) const {
    point.mesh = place;
    if (positions.empty()) return point;
    for (uint32_t& position : point.positions) {
      position = static_cast<uint32_t>(
          std::lower_bound(positions.begin(), positions.end(), position) - positions.data);
    }
    return point;
  }
};

/// What points read, and what the samples of them do, which may be the same; mesh by mesh.
struct Parts {
  Span<uint32_t> places;   // [mesh of the rig] place in MienFit::meshes
  Span<uint32_t> sampled;  // MienFit::samples
  Span<Chosen> points, samples;
  bool all_sampled = false;

  ~Parts() {
    for (const Span<Chosen>& all : {points, samples}) {
      for (const Chosen& one : all) mien_deformer_destroy(one.deformer);
    }
  }
  const Chosen& of_samples(size_t place) const { return (all_sampled ? points : samples)[place]; }
  MienSolvePoint point(const MienSolvePoint& given) const {
    return points[places[given.mesh]].renumbered(given, places[given.mesh]);
  }
  MienSolvePoint sample(const MienSolvePoint& given) const {
    return of_samples(places[given.mesh]).renumbered(given, places[given.mesh]);
  }
};

/// Positions of a mesh that some points read; `point(i)` is point i of `count`.
template <class F>
MienStatus choose_positions(const MienFitDesc& desc, const MienFit& fit, uint32_t mesh,
                            size_t count, F&& point, Arena& arena, Chosen& out, MienError* error) {
  size_t own = 0;
  for (size_t i = 0; i < count; ++i) own += point(i).mesh == mesh;
  const Span<uint32_t> list = arena.array<uint32_t>(own * 3 + 1);
  if (!list.data) return give_error(error, MIEN_ERROR_MEMORY, "no memory for a list of positions");
  uint32_t* end = list.data;
  for (size_t i = 0; i < count; ++i) {
    const MienSolvePoint& one = point(i);
    if (one.mesh == mesh) end = std::copy(one.positions, one.positions + 3, end);
  }
  std::sort(list.data, end);
  const size_t used = static_cast<size_t>(std::unique(list.data, end) - list.data);
  // Nearly all: the deformer of the rig serves, unless it has to serve others.
  if (fit.meshes.count == 1 && used * 10 > fit.whole_count * 7) return MIEN_OK;
  out.positions = list.first(used);
  return mien_deformer_create_subset(desc.deformer, mesh, list.data, used, desc.allocator,
                                     &out.deformer, error);
}

MienStatus create_derivatives(const MienFitDesc& desc, const MienFit& fit,
                              const MienDeformer* deformer, MienDerivatives** out,
                              MienError* error) {
  MienDerivativesDesc derivatives = mien_derivatives_desc_default();
  derivatives.deformer = deformer;
  derivatives.allocator = desc.allocator;
  return mien_derivatives_create(fit.rig, &derivatives, out, error);
}

MienStatus create_deformed(const MienFitDesc& desc, const MienDeformer* deformer,
                           MienDeformerInstance** out, MienError* error) {
  MienDeformerInstanceDesc deformed = mien_deformer_instance_desc_default();
  deformed.allocator = desc.allocator;
  return mien_deformer_instance_create(deformer, &deformed, out, error);
}

/// The meshes that points are on. False if memory ran out.
bool list_meshes(const MienFitDesc& desc, MienFit& fit, Arena& arena, Parts& parts) {
  parts.places = arena.array<uint32_t>(count_of(fit.rig, MIEN_KIND_MESH));
  if (!parts.places.data) return false;
  size_t count = 0;
  for (size_t i = 0; i < desc.point_count; ++i) {
    uint32_t& place = parts.places[desc.points[i].mesh];
    count += place == 0;
    place = 1;
  }
  fit.meshes = arena.array<FitMesh>(count);
  parts.points = arena.array<Chosen>(count);
  parts.samples = arena.array<Chosen>(count);
  parts.sampled = arena.array<uint32_t>(sample_count(desc.point_count, kMostSamples));
  if (!fit.meshes.data || !parts.points.data || !parts.samples.data || !parts.sampled.data) {
    return false;
  }
  uint32_t place = 0;
  for (uint32_t m = 0; m < parts.places.count; ++m) {
    if (parts.places[m] == 0) continue;
    const MienMesh mesh = mesh_of(desc.deformer, m);
    FitMesh& one = fit.meshes[place];
    one.mesh = m;
    one.first_whole = fit.whole_count;
    one.first_triangle = fit.triangle_count;
    one.triangle_count = mesh.triangle_count;
    fit.whole_count += mesh.position_count;
    fit.triangle_count += mesh.triangle_count;
    parts.places[m] = place++;
  }
  choose_samples(desc.point_count, parts.sampled);
  parts.all_sampled = parts.sampled.count == desc.point_count;
  return true;
}

MienStatus create_mesh_parts(const MienFitDesc& desc, MienFit& fit, size_t place, Arena& arena,
                             Parts& parts, MienError* error) {
  FitMesh& mesh = fit.meshes[place];
  Chosen& points = parts.points[place];
  Chosen& samples = parts.samples[place];
  MienStatus status = choose_positions(
      desc, fit, mesh.mesh, desc.point_count,
      [&](size_t i) -> const MienSolvePoint& { return desc.points[i]; }, arena, points, error);
  if (status == MIEN_OK && !parts.all_sampled) {
    status = choose_positions(
        desc, fit, mesh.mesh, parts.sampled.count,
        [&](size_t i) -> const MienSolvePoint& { return desc.points[parts.sampled[i]]; }, arena,
        samples, error);
  }
  const auto or_all = [&](const Chosen& chosen) -> const MienDeformer* {
    return chosen.deformer ? chosen.deformer : desc.deformer;
  };
  const MienDeformer* const deformer = or_all(points);
  const MienDeformer* const sampled = or_all(parts.of_samples(place));
  if (status == MIEN_OK) status = create_derivatives(desc, fit, deformer, &mesh.derivatives, error);
  if (status == MIEN_OK) status = create_deformed(desc, deformer, &mesh.deformed, error);
  mesh.sample_derivatives = mesh.derivatives;
  if (sampled != deformer && status == MIEN_OK) {
    mesh.sample_derivatives = nullptr;
    status = create_derivatives(desc, fit, sampled, &mesh.sample_derivatives, error);
  }
  mesh.first = fit.position_count;
  mesh.count = mesh_of(deformer, mesh.mesh).position_count;
  mesh.sample_count = mesh_of(sampled, mesh.mesh).position_count;
  fit.position_count += mesh.count;
  return status;
}

/// Each mesh, and joints by the first one.
MienStatus create_point_parts(const MienFitDesc& desc, MienFit& fit, Arena& arena, Parts& parts,
                              MienError* error) {
  if (!list_meshes(desc, fit, arena, parts)) {
    return give_error(error, MIEN_ERROR_MEMORY, "no memory for a list of meshes");
  }
  MienStatus status = MIEN_OK;
  for (size_t m = 0; m < fit.meshes.count && status == MIEN_OK; ++m) {
    status = create_mesh_parts(desc, fit, m, arena, parts, error);
  }
  fit.derivatives = fit.meshes[0].derivatives;
  fit.deformed = fit.whole = fit.meshes[0].deformed;
  if (parts.points[0].deformer && status == MIEN_OK) {
    fit.whole = nullptr;
    status = create_deformed(desc, desc.deformer, &fit.whole, error);
  }
  return status;
}

/// The objects of libmien that the fit owns.
MienStatus create_parts(const MienFitDesc& desc, MienFit& fit, Arena& arena, Parts& parts,
                        MienError* error) {
  MienInstanceDesc instance = mien_instance_desc_default();
  instance.allocator = desc.allocator;
  MienStatus status = mien_instance_create(fit.rig, &instance, &fit.instance, error);
  if (status == MIEN_OK) {
    status = create_derivatives(desc, fit, nullptr, &fit.control_derivatives, error);
  }
  if (status == MIEN_OK) {
    MienJacobianDesc jacobian = mien_jacobian_desc_default();
    jacobian.from_point = MIEN_POINT_RAW;
    jacobian.to_point = MIEN_POINT_CONTROLS;
    jacobian.lod = fit.lod;
    jacobian.allocator = desc.allocator;
    status = mien_jacobian_create(fit.control_derivatives, &jacobian, &fit.by_raw, error);
  }
  if (status != MIEN_OK || !desc.deformer) return status;
  if (desc.point_count != 0) return create_point_parts(desc, fit, arena, parts, error);
  status = create_derivatives(desc, fit, desc.deformer, &fit.derivatives, error);
  if (status == MIEN_OK) status = create_deformed(desc, desc.deformer, &fit.deformed, error);
  fit.whole = fit.deformed;
  return status;
}

void copy_points(const MienFitDesc& desc, const Parts& parts, MienFit& fit) {
  if (desc.point_count == 0) return;
  std::copy(parts.sampled.begin(), parts.sampled.end(), fit.samples.begin());
  for (size_t i = 0; i < desc.point_count; ++i) {
    fit.whole_points[i] = desc.points[i];
    fit.whole_points[i].mesh = parts.places[desc.points[i].mesh];
    fit.points[i] = parts.point(desc.points[i]);
  }
  for (size_t s = 0; s < fit.samples.count; ++s) {
    fit.sample_points[s] = parts.sample(desc.points[fit.samples[s]]);
  }
}

void destroy_parts(const MienFit& fit) {
  if (fit.whole != fit.deformed) mien_deformer_instance_destroy(fit.whole);
  for (const FitMesh& mesh : fit.meshes) {
    if (mesh.sample_derivatives != mesh.derivatives) {
      mien_derivatives_destroy(mesh.sample_derivatives);
    }
    mien_deformer_instance_destroy(mesh.deformed);
    mien_derivatives_destroy(mesh.derivatives);
  }
  if (fit.meshes.empty()) {
    mien_deformer_instance_destroy(fit.deformed);
    mien_derivatives_destroy(fit.derivatives);
  }
  mien_jacobian_destroy(fit.by_raw);
  mien_derivatives_destroy(fit.control_derivatives);
  mien_instance_destroy(fit.instance);
}

}  // namespace

MienStatus mien_fit_create(const MienRig* rig, const MienFitDesc* desc, MienFit** out_fit,
                           MienError* error) {
  if (MienStatus status = clear_output(out_fit, error)) return status;
  if (!desc) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "desc is NULL");
  MienFitDesc known;
  if (MienStatus status = read_desc(desc, known, "MienFitDesc", error)) return status;
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  MienFit measured;
  if (MienStatus status = check_desc(rig, known, measured, error)) return status;
  Arena arena(allocator);
  Parts parts;
  if (MienStatus status = create_parts(known, measured, arena, parts, error)) {
    destroy_parts(measured);
    return status;
  }
  MienMutableFloatView raw = {};
  MienFloatView joints = {}, all_controls = {};
  static_cast<void>(mien_instance_raw_controls(measured.instance, &raw));
  static_cast<void>(mien_instance_joints(measured.instance, &joints));
  static_cast<void>(mien_instance_controls(measured.instance, &all_controls));
  measured.all_controls = {all_controls.data, all_controls.count};
  measured.raw = {raw.data, raw.count};
  measured.joints = {joints.data, joints.count};
  measured.joint_count = joints.count;
  measured.control_count = all_controls.count;
  measured.bone_count = count_of(rig, MIEN_KIND_JOINT);
  Placer sizes(nullptr);
  place(known, sizes, measured);
  void* block = allocator.get(sizes.size(), kBlockAlignment);
  if (!block) {
    destroy_parts(measured);
    return give_error(error, MIEN_ERROR_MEMORY, "no memory for a fit of %zu bytes", sizes.size());
  }
  Placer placer(block);
  place(known, placer, measured);
  MienFit* fit = new (block) MienFit(measured);
  fit->allocator = allocator;
  fit->block_size = sizes.size();
  copy_desc(known, *fit);
  copy_points(known, parts, *fit);
  const bool copied = copy_triangles(known, *fit);
  for (const uint32_t column : span_of(pattern_of(*fit).columns)) ++fit->first_entry[column + 1];
  for (size_t c = 0; c < fit->raw_count; ++c) fit->first_entry[c + 1] += fit->first_entry[c];
  std::copy(fit->raw.begin(), fit->raw.end(), fit->initial.begin());
  static_cast<void>(mien_rig_evaluate(rig, fit->instance, fit->lod));
  fit->tag = kFitTag;
  const Span<const MienDeformer*> deformers = arena.array<const MienDeformer*>(fit->meshes.count);
  for (size_t m = 0; m < deformers.count; ++m) {
    deformers[m] = parts.points[m].deformer ? parts.points[m].deformer : known.deformer;
  }
  if (!copied || deformers.count != fit->meshes.count || !measure_rig(*fit, deformers, arena)) {
    mien_fit_destroy(fit);
    return give_error(error, MIEN_ERROR_MEMORY, "no memory to measure the rig");
  }
  *out_fit = fit;
  return succeed(error);
}

void mien_fit_destroy(MienFit* fit) {
  if (check_tag(fit, kFitTag) != MIEN_OK) return;
  destroy_parts(*fit);
  fit->tag = 0;
  const Allocator allocator = fit->allocator;
  if (fit->joint_block) allocator.put(fit->joint_block, fit->joint_block_size, kBlockAlignment);
  allocator.put(fit, fit->block_size, kBlockAlignment);
}

MienStatus mien_fit_observability(const MienFit* fit, float* out_values, size_t count) {
  if (!out_values) return MIEN_ERROR_NULL_ARGUMENT;
  if (MienStatus status = check_tag(fit, kFitTag)) return status;
  if (count != fit->raw_count) return MIEN_ERROR_INVALID_ARGUMENT;
  std::copy(fit->observability.begin(), fit->observability.end(), out_values);
  return MIEN_OK;
}
