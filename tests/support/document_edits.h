// SPDX-License-Identifier: MIT
// Every operation on documents with random arguments, for sequences and for failing memory.
#pragma once

#include <functional>

#include "author/base/random.h"
#include "tests/support/documents.h"

namespace mien {

struct DocumentEdit {
  const char* function;
  /// May refuse its arguments; `other` is another document.
  std::function<MienStatus(MienDocument*, const MienDocument* other, Random&, MienError*)> run;
};

inline uint32_t count_at(const MienDocument* document, const char* path) {
  MienDnaField field = sized<MienDnaField>();
  EXPECT_EQ(mien_document_field(document, path, &field, nullptr), MIEN_OK) << path;
  return static_cast<uint32_t>(field.count);
}
inline uint32_t pick(const MienDocument* document, const char* path, Random& random) {
  const uint32_t count = count_at(document, path);
  return count == 0 ? 0 : random.below(count);
}
inline uint32_t positions_of(const MienDocument* document, uint32_t mesh) {
  return count_at(document, "geom.meshes") == 0
             ? 0
             : count_at(document,
                        ("geom.meshes[" + std::to_string(mesh) + "].positions.xs").c_str());
}
inline std::vector<float> positions_at(const MienDocument* document, uint32_t mesh) {
  std::vector<float> all(size_t{positions_of(document, mesh)} * 3), part(all.size() / 3);
  const char* axes[] = {".xs", ".ys", ".zs"};
  for (size_t k = 0; k < 3 && !part.empty(); ++k) {
    const std::string path = "geom.meshes[" + std::to_string(mesh) + "].positions" + axes[k];
    EXPECT_EQ(
        mien_document_read_floats(document, path.c_str(), 0, part.size(), part.data(), nullptr),
        MIEN_OK);
    for (size_t v = 0; v < part.size(); ++v) all[3 * v + k] = part[v];
  }
  return all;
}

inline std::vector<DocumentEdit> document_edits() {
  using D = MienDocument*;
  using O = const MienDocument*;
  using E = MienError*;
  const char* const joints = "defn.jointNames";
  const char* const meshes = "geom.meshes";
  return {
      {"mien_document_rename",
       [=](D d, O, Random& random, E error) {
         const std::string name = "renamed" + std::to_string(random.bits());
         return mien_document_rename(d, MIEN_KIND_JOINT, pick(d, joints, random), name.c_str(),
                                     error);
       }},
      {"mien_document_remove",
       [=](D d, O, Random& random, E error) {
         const uint32_t joint = pick(d, joints, random);
         return mien_document_remove(d, MIEN_KIND_JOINT, &joint, 1, error);
       }},
      {"mien_document_remove",
       [=](D d, O, Random& random, E error) {
         const uint32_t channel = pick(d, "defn.blendShapeChannelNames", random);
         return mien_document_remove(d, MIEN_KIND_BLEND_SHAPE_CHANNEL, &channel, 1, error);
       }},
      {"mien_document_remove",
       [=](D d, O, Random& random, E error) {
         const uint32_t map = pick(d, "defn.animatedMapNames", random);
         return mien_document_remove(d, MIEN_KIND_ANIMATED_MAP, &map, 1, error);
       }},
      {"mien_document_remove",
       [=](D d, O, Random& random, E error) {
         const uint32_t mesh = count_at(d, meshes) > 1 ? pick(d, meshes, random) : 99;
         return mien_document_remove(d, MIEN_KIND_MESH, &mesh, 1, error);
       }},
      {"mien_document_remove",
       [=](D d, O, Random& random, E error) {
         const uint32_t control = pick(d, "defn.rawControlNames", random);
         return mien_document_remove(d, MIEN_KIND_RAW_CONTROL, &control, 1, error);
       }},
      {"mien_document_remove",
       [=](D d, O, Random& random, E error) {
         int64_t count = 0;
         EXPECT_EQ(mien_document_read_integers(d, "bhvr.controls.psdCount", 0, 1, &count, nullptr),
                   MIEN_OK);
         const uint32_t psd = random.below(static_cast<uint32_t>(count) + 1);
         return mien_document_remove(d, MIEN_KIND_PSD_CONTROL, &psd, 1, error);
       }},
      {"mien_document_remove",
       [=](D d, O, Random& random, E error) {
         const uint32_t control = pick(d, "defn.guiControlNames", random);
         return mien_document_remove(d, MIEN_KIND_GUI_CONTROL, &control, 1, error);
       }},
      {"mien_document_remove",
       [=](D d, O, Random& random, E error) {
         const uint32_t control = pick(d, "mlbh.mlControlNames", random);
         return mien_document_remove(d, MIEN_KIND_ML_CONTROL, &control, 1, error);
       }},
      {"mien_document_remove",
       [=](D d, O, Random& random, E error) {
         const uint32_t control = pick(d, "rbfe.poseControlNames", random);
         return mien_document_remove(d, MIEN_KIND_RBF_CONTROL, &control, 1, error);
       }},
      {"mien_document_add_layer",
       [=](D d, O, Random&, E error) {
         return mien_document_add_layer(d, "note", 1, 2, "bytes", 5, error);
       }},
      {"mien_document_clear_layers",
       [=](D d, O, Random&, E error) {
         uint32_t version = 0, count = 0;
         EXPECT_EQ(mien_document_layer_count(d, &version, &count, nullptr), MIEN_OK);
         return mien_document_clear_layers(d, version, error);
       }},
      {"mien_document_clear",
       [=](D d, O, Random& random, E error) {
         return mien_document_clear(
             d, random.below(2) ? MIEN_KIND_ANIMATED_MAP : MIEN_KIND_BLEND_SHAPE_CHANNEL, error);
       }},
      {"mien_document_clear_joints",
       [=](D d, O, Random& random, E error) {
         const uint32_t joint = pick(d, joints, random);
         return mien_document_clear_joints(d, &joint, 1, error);
       }},
      {"mien_document_set_neutral",
       [=](D d, O, Random& random, E error) {
         const float place[] = {1, 2, 3};
         return mien_document_set_neutral(d, pick(d, joints, random), place, nullptr, 1, error);
       }},
      {"mien_document_set_positions",
       [=](D d, O, Random& random, E error) {
         const uint32_t mesh = pick(d, meshes, random);
         auto positions = positions_at(d, mesh);
         for (float& x : positions) x += 0.125f;
         return mien_document_set_positions(d, mesh, positions.data(), positions.size() / 3, error);
       }},
      {"mien_document_set_target",
       [=](D d, O, Random& random, E error) {
         const float delta[] = {0.25f, 0, 1};
         const uint32_t mesh = pick(d, meshes, random);
         const uint32_t vertex = random.below(positions_of(d, mesh) + 1);
         return mien_document_set_target(d, mesh, pick(d, "defn.blendShapeChannelNames", random),
                                         &vertex, delta, 1, error);
       }},
      {"mien_document_prune_targets",
       [=](D d, O, Random& random, E error) {
         MienPrunedTargets pruned = sized<MienPrunedTargets>();
         return mien_document_prune_targets(d, static_cast<float>(random.below(100)) / 1000,
                                            &pruned, error);
       }},
      {"mien_document_prune_joints",
       [=](D d, O, Random& random, E error) {
         MienPruneJointsDesc desc = sized<MienPruneJointsDesc>();
         desc.translation = desc.rotation = static_cast<float>(random.below(100)) / 1000;
         MienPrunedJoints pruned = sized<MienPrunedJoints>();
         return mien_document_prune_joints(d, &desc, &pruned, error);
       }},
      {"mien_document_set_weights",
       [=](D d, O, Random& random, E error) {
         const uint32_t mesh = pick(d, meshes, random), count = positions_of(d, mesh);
         const std::vector<uint16_t> of(count, static_cast<uint16_t>(pick(d, joints, random)));
         const std::vector<float> weights(count, 1.0f);
         return mien_document_set_weights(d, mesh, 1, of.data(), weights.data(), count, error);
       }},
      {"mien_document_normalize_weights",
       [=](D d, O, Random& random, E error) {
         return mien_document_normalize_weights(d, pick(d, meshes, random), error);
       }},
      {"mien_document_limit_influences",
       [=](D d, O, Random& random, E error) {
         return mien_document_limit_influences(d, pick(d, meshes, random), 1 + random.below(4),
                                               error);
       }},
      {"mien_document_smooth_weights",
       [=](D d, O, Random& random, E error) {
         return mien_document_smooth_weights(d, pick(d, meshes, random), 2, 0.5f, 8, error);
       }},
      {"mien_document_place",
       [=](D d, O, Random& random, E error) {
         MienPlacement placement = sized<MienPlacement>();
         placement.scale = random.below(2) ? 0 : 1.25;
         placement.rotation[1] = random.below(2) ? 0 : 30;
         placement.translation[2] = 1;
         return mien_document_place(d, &placement, error);
       }},
      {"mien_document_keep_lods",
       [=](D d, O, Random& random, E error) {
         return mien_document_keep_lods(d, random.below(4), error);
       }},
      {"mien_document_convert",
       [=](D d, O, Random& random, E error) {
         MienCoordinateSystem system = sized<MienCoordinateSystem>();
         EXPECT_EQ(mien_coordinate_system_find(random.below(2) ? "unreal" : "maya", &system),
                   MIEN_OK);
         return mien_document_convert(d, &system, error);
       }},
      {"mien_document_copy_layers",
       [=](D d, O other, Random&, E error) {
         return mien_document_copy_layers(d, other, MIEN_LAYER_DESCRIPTOR, error);
       }},
      {"mien_document_copy_mesh",
       [=](D d, O other, Random& random, E error) {
         uint32_t mesh = 0;
         return mien_document_copy_mesh(d, other, pick(other, meshes, random), &mesh, error);
       }},
      {"mien_document_merge_joints",
       [=](D d, O other, Random&, E error) {
         return mien_document_merge_joints(d, other, 1000, error);
       }},
      {"mien_document_split_joints",
       [=](D d, O other, Random&, E error) { return mien_document_split_joints(d, other, error); }},
      {"mien_document_project",
       [=](D d, O, Random& random, E error) {
         double farthest = 0;
         MienProjectDesc desc = sized<MienProjectDesc>();
         desc.match = random.below(2);
         return mien_document_project(d, pick(d, meshes, random), pick(d, meshes, random), &desc,
                                      &farthest, error);
       }},
      {"mien_document_make_lod",
       [=](D d, O, Random& random, E error) {
         double farthest = 0;
         return mien_document_make_lod(d, random.below(3), random.below(3), nullptr, &farthest,
                                       error);
       }},
      {"mien_document_conform",
       [=](D d, O, Random& random, E error) {
         const uint32_t mesh = pick(d, meshes, random);
         auto positions = positions_at(d, mesh);
         for (float& x : positions) x *= 1.125f;
         MienConformed conformed = sized<MienConformed>();
         return mien_document_conform(d, mesh, positions.data(), positions.size() / 3,
                                      random.below(2), &conformed, error);
       }},
      {"mien_document_transplant",
       [=](D d, O other, Random& random, E error) {
         MienTransplantDesc desc = sized<MienTransplantDesc>();
         desc.match = random.below(2);
         MienControlError errors[8];
         size_t count = 0;
         return mien_document_transplant(d, other, &desc, errors, 8, &count, error);
       }},
  };
}

}  // namespace mien
