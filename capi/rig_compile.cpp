// SPDX-License-Identifier: MIT
// mien_rig_create() of mien/rig.h and mien_deformer_create() of mien/deform.h: what needs the compiler.
#include <cmath>

#include "capi/dna_handle.h"
#include "runtime/load/compile/compile_deformer.h"
#include "runtime/load/compile/compile_rig.h"

using namespace mien;
using namespace mien::capi;

MienStatus mien_rig_create(const MienDna* dna, const MienRigDesc* desc, MienRig** out_rig,
                           MienError* error) {
  if (MienStatus status = clear_output(out_rig, error)) return status;
  if (MienStatus status = check(dna, "dna", error)) return status;
  MienRigDesc known;
  if (MienStatus status = read_desc(desc, known, "MienRigDesc", error)) return status;
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  const MienStatus in_range = check_fields(
      {{"MienRigDesc.rotation_output", known.rotation_output, MIEN_ROTATION_OUTPUT_QUATERNION},
       {"MienRigDesc.ml_masks", known.ml_masks, MIEN_ML_MASKS_BLEND},
       {"MienRigDesc.storage", known.storage, MIEN_STORAGE_16_BIT},
       {"MienRigDesc.reuse", known.reuse, MIEN_REUSE_SUMS},
       {"MienRigDesc.arithmetic", known.arithmetic, MIEN_ARITHMETIC_PORTABLE}},
      error);
  if (in_range != MIEN_OK) return in_range;
  const KernelTable* kernels = nullptr;
  if (MienStatus status = find_kernels(known.isa, kernels, error)) return status;
  if (!object(dna)->view.has(dna::kLayerBehavior)) {
    return give_error(error, MIEN_ERROR_DNA_LAYER,
                      "the DNA was opened without its behavior; open it with MIEN_LAYER_BEHAVIOR");
  }
  Rig* rig = nullptr;
  Error detail;
  const CompileOptions options = {kernels,
                                  known.rotation_output == MIEN_ROTATION_OUTPUT_QUATERNION,
                                  known.ml_masks == MIEN_ML_MASKS_BLEND,
                                  known.storage == MIEN_STORAGE_16_BIT,
                                  known.arithmetic == MIEN_ARITHMETIC_PORTABLE,
                                  known.reuse == MIEN_REUSE_NOTHING};
  Status status = compile_rig(object(dna)->view, options, allocator, rig, detail);
  if (status == Status::kOk) status = set_reuse(known.reuse, rig, detail);
  return give_object(status, rig, detail, out_rig, error);
}

MienStatus mien_deformer_create(const MienDna* dna, const MienRig* rig,
                                const MienDeformerDesc* desc, MienDeformer** out_deformer,
                                MienError* error) {
  if (MienStatus status = clear_output(out_deformer, error)) return status;
  if (MienStatus status = check(dna, "dna", error)) return status;
  if (MienStatus status = check(rig, "rig", error)) return status;
  MienDeformerDesc known;
  if (MienStatus status = read_desc(desc, known, "MienDeformerDesc", error)) return status;
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  const MienStatus in_range =
      check_fields({{"MienDeformerDesc.compose", known.compose, MIEN_COMPOSE_EULER_ADD},
                    {"MienDeformerDesc.weights", known.weights, MIEN_WEIGHTS_FIX},
                    {"MienDeformerDesc.normals", known.normals, MIEN_NORMALS_RECOMPUTED},
                    {"MienDeformerDesc.storage", known.storage, MIEN_STORAGE_16_BIT}},
                   error);
  if (in_range != MIEN_OK) return in_range;
  if (!(known.delta_error >= 0) || !std::isfinite(known.delta_error)) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MienDeformerDesc.delta_error is %g: give a distance, or 0",
                      known.delta_error);
  }
  const Rig& of = *object(rig);
  const KernelTable* kernels = of.kernels;
  if (known.isa != MIEN_ISA_BEST) {
    if (MienStatus status = find_kernels(known.isa, kernels, error)) return status;
  }
  if (known.compose == MIEN_COMPOSE_EULER_ADD && of.quaternion_outputs) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MIEN_COMPOSE_EULER_ADD needs a of with MIEN_ROTATION_OUTPUT_EULER");
  }
  if (!object(dna)->view.has(dna::kLayerGeometry)) {
    return give_error(error, MIEN_ERROR_DNA_LAYER,
                      "the DNA was opened without its geometry; open it with MIEN_LAYER_GEOMETRY");
  }

  DeformOptions options;
  options.kernels = kernels;
  options.compose = static_cast<Compose>(known.compose);
  options.fix_weights = known.weights == MIEN_WEIGHTS_FIX;
  options.tangents = known.with_tangents != 0;
  options.half_storage = known.storage == MIEN_STORAGE_16_BIT;
  options.delta_error = known.delta_error;
  if (known.normals != MIEN_NORMALS_DEFAULT) options.normals = static_cast<Normals>(known.normals);
  Deformer* deformer = nullptr;
  Error detail;
  const Status status =
      compile_deformer(object(dna)->view, of, options, allocator, deformer, detail);
  return give_object(status, deformer, detail, out_deformer, error);
}
