// SPDX-License-Identifier: MIT
//
// Derivatives of rigs, and controls for captured motion, over mien_solve.h: a Fit needs libmien-solve.
// Everything said in mien.hpp holds here.
#pragma once

#include <mien_solve.h>

#include <mien.hpp>

namespace mien {
inline namespace MIEN_CPP_NAMESPACE {

using DerivativesDesc = Sized<MienDerivativesDesc>;
using JacobianDesc = Sized<MienJacobianDesc>;
using JacobianPattern = Sized<MienJacobianPattern>;

class Jacobian;

/// Derivatives at a pose (docs/derivatives.md). For one thread at a time. `mesh` is that of
/// MIEN_POINT_POSITIONS, else 0.
class Derivatives : public Owner<MienDerivatives, mien_derivatives_destroy> {
 public:
  using Owner::Owner;

  /// Rig and deformer may go afterwards.
  static Result<Derivatives> create(const Rig& rig, const DerivativesDesc& desc = {}) {
    return make<Derivatives>([&](MienDerivatives** out, MienError* error) {
      return mien_derivatives_create(rig.get(), &desc, out, error);
    });
  }
  static Result<uint64_t> bytes(const Rig& rig, const DerivativesDesc& desc = {}) {
    uint64_t found = 0;
    const MienStatus status = mien_derivatives_bytes(rig.get(), &desc, &found);
    return {status, std::move(found)};
  }

  /// How many numbers a point has.
  Result<size_t> size(MienPoint point, uint32_t mesh = 0) const {
    size_t found = 0;
    const MienStatus status = mien_derivatives_size(get(), point, mesh, &found);
    return {status, std::move(found)};
  }
  /// At the last evaluation of the instance.
  Status linearize(const Instance& instance, uint32_t stages = MIEN_STAGE_ALL) {
    return mien_derivatives_linearize(get(), instance.get(), stages);
  }
  /// Rows of numbers at `from` to changes of the numbers at `to`.
  Status forward(MienPoint from, MienPoint to, Span<const float> directions, Span<float> out,
                 uint32_t mesh = 0) {
    uint32_t count = 0;
    if (const MienStatus status = rows(from, to, mesh, directions.size(), out.size(), count)) {
      return status;
    }
    return mien_derivatives_forward(get(), from, to, mesh, count, directions.data(), out.data());
  }
  /// Rows of gradients by the numbers at `to` to those by the numbers at `from`.
  Status reverse(MienPoint from, MienPoint to, Span<const float> gradients, Span<float> out,
                 uint32_t mesh = 0) {
    uint32_t count = 0;
    if (const MienStatus status = rows(to, from, mesh, gradients.size(), out.size(), count)) {
      return status;
    }
    return mien_derivatives_reverse(get(), from, to, mesh, count, gradients.data(), out.data());
  }
  /// The entries of a matrix, in the order of its pattern. `wanted`: a byte per column, 0 leaves the values of
  /// the column as they are; empty: all columns.
  Status jacobian(const Jacobian& jacobian, Span<float> values, Span<const uint8_t> wanted = {});

 private:
  /// Whole rows, as many in as out.
  MienStatus rows(MienPoint in, MienPoint out, uint32_t mesh, size_t in_size, size_t out_size,
                  uint32_t& count) const {
    size_t in_width = 0, out_width = 0;
    if (const MienStatus status = mien_derivatives_size(get(), in, mesh, &in_width)) return status;
    if (const MienStatus status = mien_derivatives_size(get(), out, mesh, &out_width))
      return status;
    const size_t found = in_width != 0 ? in_size / in_width : 0;
    if (found * in_width != in_size || found * out_width != out_size || found > UINT32_MAX) {
      return MIEN_ERROR_INVALID_ARGUMENT;
    }
    count = static_cast<uint32_t>(found);
    return MIEN_OK;
  }
};

/// A sparse matrix of derivatives: which entries it has, and which columns are computed together. Any threads may
/// use one at the same time.
class Jacobian : public Owner<MienJacobian, mien_jacobian_destroy> {
 public:
  using Owner::Owner;

  /// The derivatives may go afterwards; others of their rig and deformer may compute the entries.
  static Result<Jacobian> create(const Derivatives& derivatives, const JacobianDesc& desc) {
    return make<Jacobian>([&](MienJacobian** out, MienError* error) {
      return mien_jacobian_create(derivatives.get(), &desc, out, error);
    });
  }
  /// Its views are valid as long as the matrix.
  Result<JacobianPattern> pattern() const {
    JacobianPattern found;
    const MienStatus status = mien_jacobian_pattern(get(), &found);
    return {status, std::move(found)};
  }
};

inline Status Derivatives::jacobian(const Jacobian& jacobian, Span<float> values,
                                    Span<const uint8_t> wanted) {
  return mien_derivatives_jacobian(get(), jacobian.get(), wanted.empty() ? nullptr : wanted.data(),
                                   wanted.size(), values.data(), values.size());
}

using FitDesc = Sized<MienFitDesc>;
using FitFrame = Sized<MienFitFrame>;
using FitSurfaceDesc = Sized<MienFitSurfaceDesc>;
using FitResult = Sized<MienFitResult>;

/// A scan, or a mesh of another topology, as a target. Any threads may use one at the same time.
class FitSurface : public Owner<MienFitSurface, mien_fit_surface_destroy> {
 public:
  using Owner::Owner;

  /// Everything is copied.
  static Result<FitSurface> create(const FitSurfaceDesc& desc) {
    return make<FitSurface>([&](MienFitSurface** out, MienError* error) {
      return mien_fit_surface_create(&desc, out, error);
    });
  }
};

/// Finds the raw controls of frames (docs/solving.md). For one thread at a time.
class Fit : public Owner<MienFit, mien_fit_destroy> {
 public:
  using Owner::Owner;

  /// The rig outlives the fit; the deformer may go.
  static Result<Fit> create(const Rig& rig, const FitDesc& desc = {}) {
    return make<Fit>([&](MienFit** out, MienError* error) {
      return mien_fit_create(rig.get(), &desc, out, error);
    });
  }

  /// `out_raw` has room for all raw controls of the rig. `result` may be null.
  Status solve(const FitFrame& frame, Span<float> out_raw, FitResult* result = nullptr) {
    return mien_fit_solve(get(), &frame, out_raw.data(), result);
  }
  /// Frames of a motion, each from the one before: the targets of `frame` have a row for each. As many as there are
  /// rows in `out_raw`, each of `raw_count` controls; `results` is empty, or has one for each.
  Status solve_frames(const FitFrame& frame, size_t raw_count, Span<float> out_raw,
                      Span<FitResult> results = {}) {
    const size_t count = raw_count != 0 ? out_raw.size() / raw_count : 0;
    if (results.size() != 0 && results.size() != count) return MIEN_ERROR_INVALID_ARGUMENT;
    return mien_fit_solve_frames(get(), &frame, count, out_raw.data(),
                                 results.size() != 0 ? results.data() : nullptr);
  }
  /// 0 to 1 for each raw control: how well the data determines it.
  Status observability(Span<float> out) const {
    return mien_fit_observability(get(), out.data(), out.size());
  }
};

/// Frame numbers of the keys of a curve, the first of `out`, which has room for all frames. Returns how many.
inline Result<size_t> fit_keys(Span<const float> values, float tolerance, Span<uint32_t> out) {
  size_t count = 0;
  const MienStatus status =
      out.size() < values.size()
          ? MienStatus{MIEN_ERROR_INVALID_ARGUMENT}
          : mien_fit_keys(values.data(), values.size(), tolerance, out.data(), &count);
  return {status, std::move(count)};
}

}  // namespace MIEN_CPP_NAMESPACE
}  // namespace mien
