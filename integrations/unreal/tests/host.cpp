// SPDX-License-Identifier: MIT
// Runs component and animation node for some frames as an actor would, compares with the library, and reads what the
// editor shows of the node.
#undef NDEBUG
#include <mien_author.h>

#include <cassert>

#include "AnimGraphNode_Mien.h"
#include "AnimNode_Mien.h"
#include "Animation/AnimInstanceProxy.h"
#include "Components/SkeletalMeshComponent.h"
#include "GameFramework/Actor.h"
#include "MienFaceComponent.h"

int main(int argc, char** argv) {
  assert(argc == 2);  // a folder for files
  const std::string path = std::string(argv[1]) + "/unreal_test.dna",
                    baked = std::string(argv[1]) + "/unreal_test.rig";
  MienGenerateDesc generate = mien_generate_desc_default();
  generate.preset = MIEN_PRESET_SMALL;
  MienDna *made = nullptr, *dna = nullptr;
  assert(mien_dna_generate(&generate, &made, nullptr) == MIEN_OK);
  assert(mien_dna_write_file(made, path.c_str(), nullptr, nullptr) == MIEN_OK);
  mien_dna_close(made);
  MienCoordinateSystem system = mien_coordinate_system_default();
  assert(mien_coordinate_system_find("unreal", &system) == MIEN_OK);
  MienDnaDesc desc = mien_dna_desc_default();
  desc.system = &system;
  MienRig* rig = nullptr;
  MienDeformer* deformer = nullptr;
  MienInstance* instance = nullptr;
  MienDeformerInstance* pose = nullptr;
  assert(mien_dna_open_file(path.c_str(), &desc, &dna, nullptr) == MIEN_OK);
  assert(mien_rig_create(dna, nullptr, &rig, nullptr) == MIEN_OK);
  assert(mien_deformer_create(dna, rig, nullptr, &deformer, nullptr) == MIEN_OK);
  assert(mien_instance_create(rig, nullptr, &instance, nullptr) == MIEN_OK);
  assert(mien_deformer_instance_create(deformer, nullptr, &pose, nullptr) == MIEN_OK);
  assert(mien_bake_file(rig, deformer, baked.c_str(), nullptr) == MIEN_OK);

  AActor actor;
  UMienFaceComponent face;
  USkeletalMeshComponent mesh;
  face.Owner = mesh.Owner = &actor;
  actor.Components = {&mesh, &face};
  assert(face.PrimaryComponentTick.bCanEverTick);
  face.RigFile = "no such file.dna";
  face.BeginPlay();
  assert(logged_errors == 1 && !face.SetControl("any", 1));
  face.TickComponent(0.1f, LEVELTICK_All, nullptr);  // does nothing
  for (const std::string& file : {path, baked}) {
    face.RigFile = file.c_str();
    face.BeginPlay();
    assert(logged_errors == 1 && !face.SetControl("no such control", 1));
    FAnimNode_Mien node;
    FAnimInstanceProxy proxy{&mesh};
    node.Initialize_AnyThread({&proxy});
    FPoseContext output;
    const TArray<FName>& joints = face.JointNames();
    assert(joints.Num() > 4);
    for (int32 j = 0; j + 1 < joints.Num(); ++j)
      output.Pose.Bones.Bones[joints[j]] = j;  // the last is no bone
    output.Pose.Transforms.resize(static_cast<size_t>(joints.Num()) / 2 + 1);

    MienMutableFloatView controls{};
    assert(mien_instance_raw_controls(instance, &controls) == MIEN_OK);
    uint32_t raw_count = 0;
    assert(mien_rig_count(rig, MIEN_KIND_RAW_CONTROL, &raw_count) == MIEN_OK);
    for (uint32_t frame = 0; frame < 3; ++frame) {
      for (uint32_t c = 0; c < raw_count; ++c) {
        const float value = static_cast<float>((c * 7 + frame * 3) % 11) / 10;
        MienStringView name{};
        assert(mien_rig_name(rig, MIEN_KIND_RAW_CONTROL, c, &name) == MIEN_OK);
        assert(face.SetControl(
            FString::ConstructFromPtrSize(name.data, static_cast<int32>(name.count)), value));
        controls.data[c] = value;
      }
      face.TickComponent(0.1f, LEVELTICK_All, nullptr);
      node.Update_AnyThread({});
      node.Evaluate_AnyThread(output);
      assert(mien_rig_evaluate(rig, instance, 0) == MIEN_OK);
      assert(mien_deformer_instance_update(pose, instance) == MIEN_OK);
      std::vector<float> wanted(static_cast<size_t>(10 * joints.Num()));
      assert(mien_deformer_instance_local_transforms(pose, wanted.data(), wanted.size()) ==
             MIEN_OK);
      for (int32 j = 0; j + 1 < joints.Num(); j += 2) {
        const FTransform& got = output.Pose.Transforms[static_cast<size_t>(j) / 2];
        const double values[] = {
            got.Translation.X, got.Translation.Y, got.Translation.Z, got.Rotation.X, got.Rotation.Y,
            got.Rotation.Z,    got.Rotation.W,    got.Scale3D.X,     got.Scale3D.Y,  got.Scale3D.Z};
        for (size_t k = 0; k < 10; ++k)
          assert(values[k] == double{wanted[static_cast<size_t>(j) * 10 + k]});
      }
      MienFloatView weights{};
      assert(mien_instance_blend_shapes(instance, &weights) == MIEN_OK &&
             weights.count == mesh.Morphs.size());
      for (uint32_t c = 0; c < weights.count; ++c) {
        MienStringView name{};
        assert(mien_rig_name(rig, MIEN_KIND_BLEND_SHAPE_CHANNEL, c, &name) == MIEN_OK);
        const FName key(FString::ConstructFromPtrSize(name.data, static_cast<int32>(name.count)));
        assert(mesh.Morphs.at(key) == weights.data[c]);
      }
      assert(node.BasePose.Evaluated == static_cast<int>(frame) + 1);
    }
    face.EndPlay(EEndPlayReason::Destroyed);
  }
  {
    // The component is destroyed before the node: the pose stays as it comes in.
    FAnimNode_Mien node;
    auto gone = std::make_unique<UMienFaceComponent>();
    actor.Components = {&mesh, gone.get()};
    gone->Owner = &actor;
    gone->RigFile = baked.c_str();
    gone->BeginPlay();
    gone->TickComponent(0.1f, LEVELTICK_All, nullptr);
    FAnimInstanceProxy proxy{&mesh};
    node.Initialize_AnyThread({&proxy});
    FPoseContext output;
    output.Pose.Bones.Bones[gone->JointNames()[0]] = 0;
    output.Pose.Transforms.resize(1);
    output.Pose.Transforms[0].Translation.X = 4321;
    node.Evaluate_AnyThread(output);
    assert(output.Pose.Transforms[0].Translation.X != 4321);
    output.Pose.Transforms[0].Translation.X = 1234;
    gone->EndPlay(EEndPlayReason::Destroyed);
    gone.reset();
    node.Evaluate_AnyThread(output);
    assert(output.Pose.Transforms[0].Translation.X == 1234);
  }

  {
    // Components with the same file have the same rig, and a batch evaluates them together.
    constexpr uint32_t kCount = 3;
    UMienFaceComponent faces[kCount];
    USkeletalMeshComponent meshes[kCount];
    AActor actors[kCount];
    MienInstance* instances[kCount];
    const uint32_t lods[kCount] = {0, 0, 1};
    for (uint32_t f = 0; f < kCount; ++f) {
      faces[f].Owner = meshes[f].Owner = &actors[f];
      actors[f].Components = {&meshes[f], &faces[f]};
      faces[f].RigFile = baked.c_str();
      faces[f].bEvaluates = false;
      assert(!faces[f].GetRig() && !faces[f].GetInstance());
      faces[f].BeginPlay();
      instances[f] = faces[f].GetInstance();
      assert(instances[f] && faces[f].GetRig() == faces[0].GetRig());
      MienMutableFloatView controls{};
      assert(mien_instance_raw_controls(instances[f], &controls) == MIEN_OK);
      for (size_t c = 0; c < controls.count; ++c)
        controls.data[c] = static_cast<float>((c * 7 + f) % 11) / 10;
    }
    MienBatch* batch = nullptr;
    assert(mien_batch_create(faces[0].GetRig(), nullptr, &batch, nullptr) == MIEN_OK);
    assert(mien_rig_evaluate_batch(faces[0].GetRig(), batch, instances, lods, kCount,
                                   MIEN_STAGE_ALL, nullptr) == MIEN_OK);
    mien_batch_destroy(batch);
    faces[0].EndPlay(EEndPlayReason::Destroyed);  // the rig stays open for the others
    for (uint32_t f = 1; f < kCount; ++f) {
      faces[f].TickComponent(0.1f, LEVELTICK_All, nullptr);
      MienMutableFloatView controls{};
      MienFloatView weights{};
      assert(mien_instance_raw_controls(instance, &controls) == MIEN_OK);
      for (size_t c = 0; c < controls.count; ++c)
        controls.data[c] = static_cast<float>((c * 7 + f) % 11) / 10;
      assert(mien_rig_evaluate(rig, instance, lods[f]) == MIEN_OK);
      assert(mien_instance_blend_shapes(instance, &weights) == MIEN_OK);
      assert(meshes[f].Morphs.size() == weights.count);
      for (uint32_t c = 0; c < weights.count; ++c) {
        MienStringView name{};
        assert(mien_rig_name(rig, MIEN_KIND_BLEND_SHAPE_CHANNEL, c, &name) == MIEN_OK);
        const FName key(FString::ConstructFromPtrSize(name.data, static_cast<int32>(name.count)));
        assert(meshes[f].Morphs.at(key) == weights.data[c]);
      }
      faces[f].EndPlay(EEndPlayReason::Destroyed);
    }
  }

  // The node of animation graphs has an animation node, and says what it is.
  const UAnimGraphNode_Mien graph_node;
  const FAnimNode_Base& animation_node = graph_node.Node;
  assert(dynamic_cast<const FAnimNode_Mien*>(&animation_node));
  const UAnimGraphNode_Base& base = graph_node;
  assert(base.GetNodeTitle(ENodeTitleType::ListView).ToString().text == "Mien");
  assert(base.GetNodeCategory().text == "Animation|Mien" &&
         !base.GetTooltipText().ToString().text.empty());
  assert(base.GetNodeTitleColor().A == 1);

  mien_deformer_instance_destroy(pose);
  mien_instance_destroy(instance);
  mien_deformer_destroy(deformer);
  mien_rig_destroy(rig);
  mien_dna_close(dna);
  std::remove(path.c_str());
  std::remove(baked.c_str());
  std::puts("component and node agree with the library");
  return 0;
}
