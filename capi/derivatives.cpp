// SPDX-License-Identifier: MIT
// mien/derivatives.h.
#include "runtime/derive/derivatives.h"

#include "capi/handles.h"
#include "runtime/derive/jacobian.h"

using namespace mien;
using namespace mien::capi;

namespace mien::capi {
template <>
struct ObjectOf<MienJacobian> : TypeOf<Jacobian> {};
}  // namespace mien::capi

namespace {

constexpr uint32_t kLastPoint = MIEN_POINT_MAPS;

MienStatus read_derivatives_desc(const MienRig* rig, const MienDerivativesDesc* desc,
                                 MienDerivativesDesc& out, MienError* error) {
  if (MienStatus status = check(rig, "rig", error)) return status;
  if (MienStatus status = read_desc(desc, out, "MienDerivativesDesc", error)) return status;
  if (!out.deformer) return MIEN_OK;
  if (MienStatus status = check(out.deformer, "MienDerivativesDesc.deformer", error)) return status;
  if (object(out.deformer)->rig == object(rig)) return MIEN_OK;
  return give_error(error, MIEN_ERROR_MISMATCH,
                    "MienDerivativesDesc.deformer is of another rig: pass one that was created "
                    "with this rig");
}

bool is_point(const Derivatives& d, uint32_t point, uint32_t mesh) {
  const bool geometry = point >= MIEN_POINT_LOCALS && point <= MIEN_POINT_POSITIONS;
  if (geometry && !d.deformer) return false;
  return point != MIEN_POINT_POSITIONS || mesh < d.deformer->meshes.count;
}

MienStatus check_points(const Derivatives& d, uint32_t from, uint32_t to, uint32_t mesh) {
  if (from > kLastPoint || to > kLastPoint) return MIEN_ERROR_INVALID_ARGUMENT;
  if (!is_point(d, from, mesh) || !is_point(d, to, mesh)) return MIEN_ERROR_INDEX;
  const bool leads = leads_to(static_cast<Point>(from), static_cast<Point>(to));
  return leads ? MIEN_OK : MIEN_ERROR_INVALID_ARGUMENT;
}

MienStatus check_way(const MienDerivatives* handle, uint32_t from, uint32_t to, uint32_t mesh) {
  if (MienStatus status = check(handle)) return status;
  const Derivatives& d = *object(handle);
  if (MienStatus status = check_points(d, from, to, mesh)) return status;
  return d.linearized ? MIEN_OK : MIEN_ERROR_INVALID_ARGUMENT;
}

/// push() or pull(), from rows at the point `at` to rows at the point `result`. Rows of a point without
/// numbers may be NULL.
struct ProductRows {
  uint32_t at, result;
  const float* rows;
  float* results;
};
MienStatus multiply(decltype(push)& product, MienDerivatives* handle, uint32_t from, uint32_t to,
                    uint32_t mesh, uint32_t count, const ProductRows& p) {
  if (MienStatus status = check_way(handle, from, to, mesh)) return status;
  Derivatives& d = *object(handle);
  const auto lacks = [&](const float* rows, uint32_t point) {
    return !rows && count != 0 && point_size(d, static_cast<Point>(point), mesh) != 0;
  };
  if (lacks(p.rows, p.at) || lacks(p.results, p.result)) return MIEN_ERROR_NULL_ARGUMENT;
  product(d, static_cast<Point>(from), static_cast<Point>(to), mesh, count, p.rows, p.results);
  return MIEN_OK;
}

/// Whether a list of numbers is within a point, and ascending if it must be. `name` is that of the field.
MienStatus check_numbers(const uint32_t* numbers, size_t count, size_t size, bool ascending,
                         const char* name, MienError* error) {
  if (!numbers) {
    if (count == 0) return MIEN_OK;
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "MienJacobianDesc.%s is NULL, its count %zu",
                      name, count);
  }
  for (size_t i = 0; i < count; ++i) {
    if (numbers[i] >= size) {
      return give_error(error, MIEN_ERROR_INDEX, "MienJacobianDesc.%s[%zu] is %u of %zu", name, i,
                        unsigned{numbers[i]}, size);
    }
    if (ascending && i != 0 && numbers[i] <= numbers[i - 1]) {
      return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                        "MienJacobianDesc.%s[%zu] is %u after %u: they must ascend", name, i,
                        unsigned{numbers[i]}, unsigned{numbers[i - 1]});
    }
  }
  return MIEN_OK;
}

MienStatus check_jacobian_desc(const Derivatives& d, const MienJacobianDesc& desc,
                               MienError* error) {
  const MienStatus points = check_points(d, desc.from_point, desc.to_point, desc.mesh);
  if (points == MIEN_ERROR_INDEX) {
    return give_error(
        error, points,
        "MienJacobianDesc: from point %u to point %u of mesh %u: there is no such mesh, "
        "or the derivatives have no deformer",
        unsigned{desc.from_point}, unsigned{desc.to_point}, unsigned{desc.mesh});
  }
  if (points != MIEN_OK) {
    return give_error(error, points, "MienJacobianDesc: point %u has no effect on point %u",
                      unsigned{desc.from_point}, unsigned{desc.to_point});
  }
  if (desc.lod >= d.rig->lod_count) {
    return give_error(error, MIEN_ERROR_LOD, "MienJacobianDesc.lod is %u: the rig has %u LODs",
                      unsigned{desc.lod}, unsigned{d.rig->lod_count});
  }
  const size_t columns = point_size(d, static_cast<Point>(desc.from_point), desc.mesh);
  const size_t rows = point_size(d, static_cast<Point>(desc.to_point), desc.mesh);
  if (MienStatus status =
          check_numbers(desc.inputs, desc.input_count, columns, false, "inputs", error)) {
    return status;
  }
  return check_numbers(desc.outputs, desc.output_count, rows, true, "outputs", error);
}

}  // namespace

MienStatus mien_derivatives_create(const MienRig* rig, const MienDerivativesDesc* desc,
                                   MienDerivatives** out_derivatives, MienError* error) {
  if (MienStatus status = clear_output(out_derivatives, error)) return status;
  MienDerivativesDesc known;
  if (MienStatus status = read_derivatives_desc(rig, desc, known, error)) return status;
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  const Deformer* deformer = object(known.deformer);
  Derivatives* made = create_derivatives(*object(rig), deformer, allocator);
  if (!made) {
    return give_error(error, MIEN_ERROR_MEMORY, "no memory for derivatives of %zu bytes",
                      derivatives_size(*object(rig), deformer));
  }
  *out_derivatives = reinterpret_cast<MienDerivatives*>(made);
  return succeed(error);
}

void mien_derivatives_destroy(MienDerivatives* derivatives) { destroy(derivatives); }

MienStatus mien_derivatives_bytes(const MienRig* rig, const MienDerivativesDesc* desc,
                                  uint64_t* out_bytes) {
  if (!out_bytes) return MIEN_ERROR_NULL_ARGUMENT;
  *out_bytes = 0;
  MienDerivativesDesc known;
  if (MienStatus status = read_derivatives_desc(rig, desc, known, nullptr)) return status;
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, nullptr)) return status;
  *out_bytes = derivatives_size(*object(rig), object(known.deformer));
  return MIEN_OK;
}

MienStatus mien_derivatives_size(const MienDerivatives* derivatives, uint32_t point, uint32_t mesh,
                                 size_t* out_size) {
  if (!out_size) return MIEN_ERROR_NULL_ARGUMENT;
  *out_size = 0;
  if (MienStatus status = check(derivatives)) return status;
  if (point > kLastPoint) return MIEN_ERROR_INVALID_ARGUMENT;
  if (!is_point(*object(derivatives), point, mesh)) return MIEN_ERROR_INDEX;
  *out_size = point_size(*object(derivatives), static_cast<Point>(point), mesh);
  return MIEN_OK;
}

MienStatus mien_derivatives_linearize(MienDerivatives* derivatives, const MienInstance* instance,
                                      uint32_t stages) {
  if (MienStatus status = check(derivatives)) return status;
  if (MienStatus status = check(instance)) return status;
  if (object(instance)->rig != object(derivatives)->rig) return MIEN_ERROR_MISMATCH;
  if (stages & ~uint32_t{kStagesAll}) return MIEN_ERROR_INVALID_ARGUMENT;
  linearize(*object(derivatives), *object(instance), stages);
  return MIEN_OK;
}

MienStatus mien_derivatives_forward(MienDerivatives* derivatives, uint32_t from, uint32_t to,
                                    uint32_t mesh, uint32_t count, const float* directions,
                                    float* outputs) {
  return multiply(push, derivatives, from, to, mesh, count, {from, to, directions, outputs});
}

MienStatus mien_derivatives_reverse(MienDerivatives* derivatives, uint32_t from, uint32_t to,
                                    uint32_t mesh, uint32_t count, const float* gradients,
                                    float* outputs) {
  return multiply(pull, derivatives, from, to, mesh, count, {to, from, gradients, outputs});
}

MienStatus mien_jacobian_create(const MienDerivatives* derivatives, const MienJacobianDesc* desc,
                                MienJacobian** out_jacobian, MienError* error) {
  if (MienStatus status = clear_output(out_jacobian, error)) return status;
  if (MienStatus status = check(derivatives, "derivatives", error)) return status;
  MienJacobianDesc known;
  if (MienStatus status = read_desc(desc, known, "MienJacobianDesc", error)) return status;
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  if (MienStatus status = check_jacobian_desc(*object(derivatives), known, error)) return status;
  Jacobian* made = create_jacobian(*object(derivatives),
                                   {static_cast<Point>(known.from_point),
                                    static_cast<Point>(known.to_point),
                                    known.mesh,
                                    known.lod,
                                    {known.inputs, known.input_count},
                                    {known.outputs, known.output_count}},
                                   allocator);
  if (!made) return give_error(error, MIEN_ERROR_MEMORY, "no memory for a matrix of derivatives");
  *out_jacobian = reinterpret_cast<MienJacobian*>(made);
  return succeed(error);
}

void mien_jacobian_destroy(MienJacobian* jacobian) { destroy(jacobian); }

MienStatus mien_jacobian_pattern(const MienJacobian* jacobian, MienJacobianPattern* out_pattern) {
  if (MienStatus status = clear_struct(out_pattern)) return status;
  if (MienStatus status = check(jacobian)) return status;
  const Jacobian& of = *object(jacobian);
  MienJacobianPattern told = {};
  told.rows = view_of(of.rows);
  told.columns = view_of(of.columns);
  told.row_count = of.row_places.count;
  told.column_count = of.column_places.count;
  told.direction_count = of.color_count();
  write_struct(out_pattern, told);
  return MIEN_OK;
}

MienStatus mien_derivatives_jacobian(MienDerivatives* derivatives, const MienJacobian* jacobian,
                                     const uint8_t* wanted, size_t wanted_count, float* values,
                                     size_t value_count) {
  if (MienStatus status = check(derivatives)) return status;
  if (MienStatus status = check(jacobian)) return status;
  Derivatives& d = *object(derivatives);
  const Jacobian& of = *object(jacobian);
  if (of.rig != d.rig || of.deformer != d.deformer) return MIEN_ERROR_MISMATCH;
  if (!d.linearized) return MIEN_ERROR_INVALID_ARGUMENT;
  if (of.lod != d.lod) return MIEN_ERROR_MISMATCH;
  if (value_count != of.rows.count || wanted_count != (wanted ? of.column_places.count : 0)) {
    return MIEN_ERROR_INVALID_ARGUMENT;
  }
  if (!values && value_count != 0) return MIEN_ERROR_NULL_ARGUMENT;
  find_jacobian(d, of, wanted, values);
  return MIEN_OK;
}
