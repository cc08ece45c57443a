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

size_t count_of(const MienRig* rig, uint32_t kind) {
  uint32_t count = 0;
  static_cast<void>(mien_rig_count(rig, kind, &count));
  return count;
}

void place(const MienFitDesc& desc, Placer& placer, MienFit& fit) {
  placer.array<MienFit>(1);
  const size_t raw = fit.raw_count, all = fit.control_count, joints = fit.joint_count;
  const size_t moving = desc.controls ? desc.control_count : raw;
  fit.initial = placer.array<float>(raw);
  fit.controls = placer.array<uint32_t>(moving);
  fit.lower = placer.array<float>(moving);
  fit.upper = placer.array<float>(moving);
  fit.symmetric = placer.array<uint32_t>(desc.symmetric_count);
  fit.points = placer.array<MienSolvePoint>(desc.point_count);
  fit.joint_weights = placer.array<float>(joints);
  fit.joint_metric = placer.array<float>(all * all);
  fit.point_metric = placer.array<float>(desc.point_count ? all * all : 0);
  fit.observability = placer.array<float>(raw);
  fit.start = placer.array<float>(raw);
  fit.prior = placer.array<float>(raw);
  fit.best = placer.array<float>(raw);
  fit.joint_gradient = placer.array<float>(joints);
  fit.position_gradient = placer.array<float>(fit.position_count * 3);
  fit.from_joints = placer.array<float>(raw);
  fit.from_positions = placer.array<float>(raw);
  fit.metric_row = placer.array<float>(all);
  fit.matrix = placer.array<double>(moving * moving);
  fit.factor = placer.array<double>(moving * moving);
  fit.gradient = placer.array<double>(moving);
  fit.step = placer.array<double>(moving);
  fit.work = placer.array<double>(moving);
  fit.free = placer.array<uint32_t>(moving);
  fit.inputs = placer.array<uint32_t>(moving);
  fit.first = placer.array<uint32_t>(moving + 1);
  fit.rows = placer.array<uint32_t>(moving * all);
  fit.columns = placer.array<uint32_t>(moving * all);
  fit.values = placer.array<float>(moving * all);
  fit.surface = placer.array<double>(desc.point_count * 3);
  fit.targets = placer.array<double>(desc.point_count * 3);
  fit.weights = placer.array<double>(desc.point_count);
  if (desc.point_count == 0) return;
  const size_t every = (desc.point_count + kMostSamples - 1) / kMostSamples;
  fit.samples = placer.array<uint32_t>((desc.point_count + every - 1) / every);
  fit.triangles = placer.array<uint32_t>(fit.triangle_count * 3);
  fit.normals = placer.array<double>(desc.point_count * 3);
  fit.pulls = placer.array<double>(desc.point_count);
  fit.lost = placer.array<double>(desc.point_count);
  fit.position_normals = placer.array<float>(fit.position_count * 3);
  fit.sample_effects = placer.array<float>(all * fit.samples.count * 3);
  fit.step_effects = placer.array<float>(moving * fit.samples.count * 3);
  fit.direction = placer.array<float>(raw);
  fit.moved = placer.array<float>(fit.position_count * 3);
  fit.measured = placer.array<uint8_t>(moving);
  fit.row = placer.array<double>(moving + kMostMotion);
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
  fit.mesh = desc.points[0].mesh;
  MienMesh mesh = mien_mesh_default();
  if (MienStatus status = mien_deformer_mesh(desc.deformer, fit.mesh, &mesh)) {
    return give_error(error, status, "MienFitDesc.points[0].mesh is %u: no such mesh", fit.mesh);
  }
  fit.position_count = mesh.position_count;
  fit.triangle_count = mesh.triangle_count;
  for (size_t i = 0; i < desc.point_count; ++i) {
    const MienSolvePoint& point = desc.points[i];
    if (point.mesh != fit.mesh) {
      return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                        "MienFitDesc.points[%zu] is of mesh %u, the others of %u", i, point.mesh,
                        fit.mesh);
    }
    for (size_t k = 0; k < 3; ++k) {
      if (point.positions[k] >= fit.position_count) {
        return give_error(error, MIEN_ERROR_INDEX,
                          "MienFitDesc.points[%zu] has position %u, the mesh has %zu", i,
                          point.positions[k], fit.position_count);
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
  std::copy(desc.points, desc.points + desc.point_count, fit.points.data);
  // One of each run of points, not always the same: a stride would follow rows of the mesh.
  const size_t every = fit.samples.count ? (desc.point_count - 1) / fit.samples.count + 1 : 1;
  uint32_t random = 1;
  for (size_t s = 0; s < fit.samples.count; ++s) {
    random = random * 1664525u + 1013904223u;
    const size_t left = std::min(every, desc.point_count - s * every);
    fit.samples[s] = static_cast<uint32_t>(s * every + (random >> 8) % left);
  }
  std::copy(desc.symmetric, desc.symmetric + desc.symmetric_count, fit.symmetric.data);
  for (size_t i = 0; i < fit.joint_count; ++i) {
    fit.joint_weights[i] = desc.joint_weights ? desc.joint_weights[i]
                           : desc.point_count ? 0.0f
                                              : 1.0f;
  }
}

void copy_triangles(const MienFitDesc& desc, MienFit& fit) {
  if (desc.point_count == 0) return;
  MienMesh mesh = mien_mesh_default();
  static_cast<void>(mien_deformer_mesh(desc.deformer, fit.mesh, &mesh));
  for (size_t i = 0; i < fit.triangles.count; ++i) {
    fit.triangles[i] = mesh.vertex_position_indices.data[mesh.triangles.data[i]];
  }
  fit.inward = signed_volume(mesh.positions.data, fit.triangles.data, fit.triangle_count) < 0;
}

/// The objects of libmien that the fit owns.
MienStatus create_parts(const MienFitDesc& desc, MienFit& fit, MienError* error) {
  MienInstanceDesc instance = mien_instance_desc_default();
  instance.allocator = desc.allocator;
  if (MienStatus status = mien_instance_create(fit.rig, &instance, &fit.instance, error)) {
    return status;
  }
  MienDerivativesDesc derivatives = mien_derivatives_desc_default();
  derivatives.deformer = desc.deformer;
  derivatives.allocator = desc.allocator;
  if (MienStatus status = mien_derivatives_create(fit.rig, &derivatives, &fit.derivatives, error)) {
    return status;
  }
  if (desc.point_count == 0) return MIEN_OK;
  MienDeformerInstanceDesc deformed = mien_deformer_instance_desc_default();
  deformed.allocator = desc.allocator;
  return mien_deformer_instance_create(desc.deformer, &deformed, &fit.deformed, error);
}

void destroy_parts(const MienFit& fit) {
  mien_deformer_instance_destroy(fit.deformed);
  mien_derivatives_destroy(fit.derivatives);
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
  if (MienStatus status = create_parts(known, measured, error)) {
    destroy_parts(measured);
    return status;
  }
  MienMutableFloatView raw = {};
  MienFloatView joints = {};
  static_cast<void>(mien_instance_raw_controls(measured.instance, &raw));
  static_cast<void>(mien_instance_joints(measured.instance, &joints));
  measured.raw = {raw.data, raw.count};
  measured.joints = {joints.data, joints.count};
  measured.joint_count = joints.count;
  size_t controls = 0;
  static_cast<void>(mien_derivatives_size(measured.derivatives, MIEN_POINT_CONTROLS, 0, &controls));
  measured.control_count = controls;
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
  copy_triangles(known, *fit);
  std::copy(fit->raw.begin(), fit->raw.end(), fit->initial.begin());
  bool measured_all = false;
  {
    Arena arena(allocator);
    static_cast<void>(mien_rig_evaluate(rig, fit->instance, fit->lod));
    static_cast<void>(mien_derivatives_linearize(fit->derivatives, fit->instance, MIEN_STAGE_ALL));
    measured_all = measure_rig(*fit, arena);
  }
  fit->tag = kFitTag;
  if (!measured_all) {
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
  allocator.put(fit, fit->block_size, kBlockAlignment);
}

MienStatus mien_fit_observability(const MienFit* fit, float* out_values, size_t count) {
  if (!out_values) return MIEN_ERROR_NULL_ARGUMENT;
  if (MienStatus status = check_tag(fit, kFitTag)) return status;
  if (count != fit->raw_count) return MIEN_ERROR_INVALID_ARGUMENT;
  std::copy(fit->observability.begin(), fit->observability.end(), out_values);
  return MIEN_OK;
}
