// SPDX-License-Identifier: MIT
// mien/derivatives.h.
#include "runtime/derive/derivatives.h"

#include "capi/handles.h"

using namespace mien;
using namespace mien::capi;

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

MienStatus check_way(const MienDerivatives* handle, uint32_t from, uint32_t to, uint32_t mesh) {
  if (MienStatus status = check(handle)) return status;
  const Derivatives& d = *object(handle);
  if (from > kLastPoint || to > kLastPoint) return MIEN_ERROR_INVALID_ARGUMENT;
  if (!is_point(d, from, mesh) || !is_point(d, to, mesh)) return MIEN_ERROR_INDEX;
  if (!leads_to(static_cast<Point>(from), static_cast<Point>(to))) {
    return MIEN_ERROR_INVALID_ARGUMENT;
  }
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

/// Whether a list of numbers is within a point, and ascending if it must be.
MienStatus check_numbers(const uint32_t* numbers, size_t count, size_t size, bool ascending) {
  if (!numbers) return count == 0 ? MIEN_OK : MIEN_ERROR_NULL_ARGUMENT;
  for (size_t i = 0; i < count; ++i) {
    if (numbers[i] >= size) return MIEN_ERROR_INDEX;
    if (ascending && i != 0 && numbers[i] <= numbers[i - 1]) return MIEN_ERROR_INVALID_ARGUMENT;
  }
  return MIEN_OK;
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

MienStatus mien_derivatives_jacobian(MienDerivatives* derivatives, uint32_t from, uint32_t to,
                                     uint32_t mesh, const MienJacobian* jacobian,
                                     size_t* out_count) {
  if (!out_count) return MIEN_ERROR_NULL_ARGUMENT;
  *out_count = 0;
  if (MienStatus status = check_way(derivatives, from, to, mesh)) return status;
  MienJacobian known;
  if (MienStatus status = read_struct(jacobian, known)) return status;
  Derivatives& d = *object(derivatives);
  const auto first = static_cast<Point>(from), last = static_cast<Point>(to);
  if (MienStatus status =
          check_numbers(known.inputs, known.input_count, point_size(d, first, mesh), false)) {
    return status;
  }
  if (MienStatus status =
          check_numbers(known.outputs, known.output_count, point_size(d, last, mesh), true)) {
    return status;
  }
  if (known.capacity != 0 && (!known.rows || !known.columns || !known.values)) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  *out_count = find_jacobian(d, {first,
                                 last,
                                 mesh,
                                 {known.inputs, known.input_count},
                                 {known.outputs, known.output_count},
                                 known.rows,
                                 known.columns,
                                 known.values,
                                 known.capacity});
  return known.capacity != 0 && *out_count > known.capacity ? MIEN_ERROR_INVALID_ARGUMENT : MIEN_OK;
}
