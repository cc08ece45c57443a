// SPDX-License-Identifier: MIT
#include "integrations/program/reduce/character.h"

namespace mien::cli {

namespace {
void must(MienStatus status, const MienError* error = nullptr, const std::string& shown = "") {
  check(status, error, "cannot reduce", shown);
}
}  // namespace

Character::Character(const MienDna* dna, const MienRigDesc& desc, uint32_t deformer_storage,
                     double delta_error, const std::string& shown) {
  auto error = sized<MienError>();
  MienRig* made_rig = nullptr;
  must(mien_rig_create(dna, &desc, &made_rig, &error), &error, shown);
  rig.reset(made_rig);
  MienDeformer* made_deformer = nullptr;
  MienDeformerDesc geometry = mien_deformer_desc_default();
  geometry.storage = deformer_storage;
  geometry.delta_error = delta_error;
  must(mien_deformer_create(dna, made_rig, &geometry, &made_deformer, &error), &error, shown);
  deformer.reset(made_deformer);
  MienInstance* made_instance = nullptr;
  must(mien_instance_create(made_rig, nullptr, &made_instance, &error), &error, shown);
  instance.reset(made_instance);
  MienDeformerInstance* made_pose = nullptr;
  must(mien_deformer_instance_create(made_deformer, nullptr, &made_pose, &error), &error, shown);
  pose.reset(made_pose);
}

MienMutableFloatView Character::raw() const {
  MienMutableFloatView view{};
  must(mien_instance_raw_controls(instance.get(), &view));
  return view;
}

void Character::evaluate(uint32_t lod) {
  must(mien_rig_evaluate(rig.get(), instance.get(), lod));
  must(mien_deformer_instance_update(pose.get(), instance.get()));
}

MienFloatView Character::deformed(uint32_t index) {
  must(mien_deformer_instance_deform(pose.get(), index, MIEN_NORMALS_NONE, nullptr));
  MienFloatView positions{};
  must(mien_deformer_instance_positions(pose.get(), index, &positions));
  return positions;
}

uint64_t Character::deformer_bytes() const {
  auto info = sized<MienDeformerInfo>();
  must(mien_deformer_info(deformer.get(), &info));
  return info.deformer_bytes;
}

MienMesh Character::mesh(uint32_t index) const {
  auto found = sized<MienMesh>();
  must(mien_deformer_mesh(deformer.get(), index, &found));
  return found;
}

MienIndex16View Character::meshes_of(uint32_t lod) const {
  MienIndex16View list{};
  must(mien_rig_lod_indices(rig.get(), MIEN_KIND_MESH, lod, &list));
  return list;
}

void Character::influences(uint32_t index, uint32_t position, MienIndex16View& joints,
                           MienFloatView& weights) const {
  must(mien_deformer_influences(deformer.get(), index, position, &joints, &weights));
}

}  // namespace mien::cli
