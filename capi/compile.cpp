// SPDX-License-Identifier: MIT
// DNA -> rig, DNA -> deformer. mien.h is the manual.
#include <algorithm>

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
       {"MienRigDesc.reuse", known.reuse, MIEN_REUSE_NOTHING},
       {"MienRigDesc.arithmetic", known.arithmetic, MIEN_ARITHMETIC_PORTABLE}},
      error);
  if (in_range != MIEN_OK) return in_range;
  const KernelTable* kernels = nullptr;
  if (MienStatus status = find_kernels(known.isa, kernels, error)) return status;
  if (!dna->view.has(dna::kLayerBehavior)) {
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
  if (compile_rig(dna->view, options, allocator, rig, detail) != Status::kOk) {
    return give_error(detail, error);
  }
  rig->tag = kRigTag;
  rig->instance_size = instance_size(*rig);
  *out_rig = reinterpret_cast<MienRig*>(rig);
  return succeed(error);
}

namespace {

/// A rig and a DNA file must have the same joints, channels and meshes.
MienStatus compare_names(const dna::DnaView& view, const Rig& rig, MienError* error) {
  const struct {
    Kind kind;
    const dna::List<dna::String>& names;
    const char* noun;
  } lists[] = {{Kind::kJoint, view.defn.joint_names, "joint"},
               {Kind::kBlendShapeChannel, view.defn.channel_names, "blend shape channel"},
               {Kind::kMesh, view.defn.mesh_names, "mesh"}};
  for (const auto& list : lists) {
    const NameList& own = rig.names[size_t(list.kind)];
    if (own.count() != list.names.count) {
      return give_error(error, MIEN_ERROR_MISMATCH,
                        "the rig was made of another file, or with other LODs: it has %u %s names, "
                        "the DNA has %u",
                        own.count(), list.noun, list.names.count);
    }
    for (uint32_t i = 0; i < own.count(); ++i) {
      const Span<char> a = own[i];
      const dna::String& b = list.names[i];
      if (a.count == b.count && (a.count == 0 || memcmp(a.data, b.data, a.count) == 0)) continue;
      return give_error(error, MIEN_ERROR_MISMATCH,
                        "the rig was made of another file, or with other LODs: %s %u is %.*s, "
                        "in the DNA it is %.*s",
                        list.noun, i, static_cast<int>(std::min<size_t>(a.count, 40)), a.data,
                        static_cast<int>(std::min<size_t>(b.count, 40)), b.chars());
    }
  }
  return MIEN_OK;
}

}  // namespace

MienStatus mien_deformer_create(const MienDna* dna, const MienRig* handle,
                                const MienDeformerDesc* desc, MienDeformer** out_deformer,
                                MienError* error) {
  if (MienStatus status = clear_output(out_deformer, error)) return status;
  if (MienStatus status = check(dna, "dna", error)) return status;
  if (MienStatus status = check(handle, "rig", error)) return status;
  MienDeformerDesc known;
  if (MienStatus status = read_desc(desc, known, "MienDeformerDesc", error)) return status;
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  const MienStatus in_range =
      check_fields({{"MienDeformerDesc.compose", known.compose, MIEN_COMPOSE_EULER_ADD},
                    {"MienDeformerDesc.weights", known.weights, MIEN_WEIGHTS_FIX},
                    {"MienDeformerDesc.normals", known.normals, MIEN_NORMALS_RECOMPUTED},
                    {"MienDeformerDesc.reserved", known.reserved, 0}},
                   error);
  if (in_range != MIEN_OK) return in_range;
  const Rig& rig = *object(handle);
  const KernelTable* kernels = rig.kernels;
  if (known.isa != MIEN_ISA_BEST) {
    if (MienStatus status = find_kernels(known.isa, kernels, error)) return status;
  }
  if (known.compose == MIEN_COMPOSE_EULER_ADD && rig.quaternion_outputs) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MIEN_COMPOSE_EULER_ADD needs a rig with MIEN_ROTATION_OUTPUT_EULER");
  }
  if (!dna->view.has(dna::kLayerGeometry)) {
    return give_error(error, MIEN_ERROR_DNA_LAYER,
                      "the DNA was opened without its geometry; open it with MIEN_LAYER_GEOMETRY");
  }
  if (MienStatus status = compare_names(dna->view, rig, error)) return status;

  DeformOptions options;
  options.kernels = kernels;
  options.compose = static_cast<Compose>(known.compose);
  options.fix_weights = known.weights == MIEN_WEIGHTS_FIX;
  options.tangents = known.with_tangents != 0;
  if (known.normals != MIEN_NORMALS_DEFAULT) options.normals = static_cast<Normals>(known.normals);
  Deformer* deformer = nullptr;
  Error detail;
  if (compile_deformer(dna->view, rig, options, allocator, deformer, detail) != Status::kOk) {
    return give_error(detail, error);
  }
  deformer->tag = kDeformerTag;
  *out_deformer = reinterpret_cast<MienDeformer*>(deformer);
  return succeed(error);
}
