// SPDX-License-Identifier: MIT
// Handles of the C interface that close themselves, and the calls that tests make all the time.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "capi/dna_handle.h"
#include "capi/include/mien_author.h"
#include "tests/support/descs.h"

namespace mien {

struct CloseHandle {
  void operator()(MienDna* dna) const { mien_dna_close(dna); }
  void operator()(MienRig* rig) const { mien_rig_destroy(rig); }
  void operator()(MienInstance* instance) const { mien_instance_destroy(instance); }
  void operator()(MienBatch* batch) const { mien_batch_destroy(batch); }
  void operator()(MienClip* clip) const { mien_clip_close(clip); }
  void operator()(MienClipPlayer* player) const { mien_clip_player_destroy(player); }
  void operator()(MienClipBinding* binding) const { mien_clip_binding_destroy(binding); }
  void operator()(MienMix* mix) const { mien_mix_destroy(mix); }
  void operator()(MienMixer* mixer) const { mien_mixer_destroy(mixer); }
};
using BatchHandle = std::unique_ptr<MienBatch, CloseHandle>;
/// Shows what is behind the handle: dna->view.
struct DnaHandle : std::unique_ptr<MienDna, CloseHandle> {
  using std::unique_ptr<MienDna, CloseHandle>::unique_ptr;
  dna::DnaFile* operator->() const { return capi::object(get()); }
};
using RigHandle = std::unique_ptr<MienRig, CloseHandle>;
using InstanceHandle = std::unique_ptr<MienInstance, CloseHandle>;
using ClipHandle = std::unique_ptr<MienClip, CloseHandle>;
using BindingHandle = std::unique_ptr<MienClipBinding, CloseHandle>;
using PlayerHandle = std::unique_ptr<MienClipPlayer, CloseHandle>;
using MixHandle = std::unique_ptr<MienMix, CloseHandle>;
using MixerHandle = std::unique_ptr<MienMixer, CloseHandle>;

inline MienDnaInfo info_of(const DnaHandle& dna) {
  MienDnaInfo info = sized<MienDnaInfo>();
  EXPECT_EQ(mien_dna_info(dna.get(), &info), MIEN_OK);
  return info;
}

inline DnaHandle open_dna(const std::vector<uint8_t>& bytes, uint64_t lods = 0,
                          MienStatus expected = MIEN_OK) {
  MienDnaDesc desc = sized<MienDnaDesc>();
  desc.lods = lods;
  MienError error = sized<MienError>();
  MienDna* dna = nullptr;
  EXPECT_EQ(mien_dna_open_memory(bytes.data(), bytes.size(), &desc, &dna, &error), expected)
      << error.message;
  return DnaHandle(dna);
}

/// The same in another coordinate system.
inline DnaHandle open_in_system(const std::vector<uint8_t>& bytes,
                                const MienCoordinateSystem& system, MienStatus expected = MIEN_OK,
                                std::string* message = nullptr) {
  MienDnaDesc desc = sized<MienDnaDesc>();
  desc.system = &system;
  MienError error = sized<MienError>();
  MienDna* dna = nullptr;
  EXPECT_EQ(mien_dna_open_memory(bytes.data(), bytes.size(), &desc, &dna, &error), expected)
      << error.message;
  if (message) *message = error.message;
  return DnaHandle(dna);
}

inline std::vector<uint8_t> write_dna(const MienDna* dna) {
  size_t size = 0;
  EXPECT_EQ(mien_dna_write_memory(dna, nullptr, nullptr, 0, &size, nullptr), MIEN_OK);
  std::vector<uint8_t> bytes(size);
  EXPECT_EQ(mien_dna_write_memory(dna, nullptr, bytes.data(), size, &size, nullptr), MIEN_OK);
  return bytes;
}

/// File bytes of a view that was made by hand: opening them checks it like any other file.
inline std::vector<uint8_t> write_view(const dna::DnaView& view) {
  const DnaHandle dna(reinterpret_cast<MienDna*>(create_object<dna::DnaFile>(default_allocator())));
  dna->view = view;
  return write_dna(dna.get());
}

inline DnaHandle generate_dna(uint32_t preset, uint64_t seed, uint32_t flags = 0) {
  MienGenerateDesc desc = sized<MienGenerateDesc>();
  desc.flags = flags;
  desc.preset = preset;
  desc.seed = seed;
  MienDna* dna = nullptr;
  EXPECT_EQ(mien_dna_generate(&desc, &dna, nullptr), MIEN_OK);
  return DnaHandle(dna);
}

inline RigHandle create_rig(const MienDna* dna, uint32_t isa = MIEN_ISA_ENVIRONMENT,
                            MienStatus expected = MIEN_OK,
                            uint32_t rotation = MIEN_ROTATION_OUTPUT_EULER) {
  MienRigDesc desc = sized<MienRigDesc>();
  desc.isa = isa;
  desc.rotation_output = rotation;
  MienError error = sized<MienError>();
  MienRig* rig = nullptr;
  EXPECT_EQ(mien_rig_create(dna, &desc, &rig, &error), expected) << error.message;
  return RigHandle(rig);
}

inline RigHandle create_rig(const MienDna* dna, MienRigDesc desc) {
  MienError error = sized<MienError>();
  MienRig* rig = nullptr;
  EXPECT_EQ(mien_rig_create(dna, &desc, &rig, &error), MIEN_OK) << error.message;
  return RigHandle(rig);
}

inline MienRigInfo info_of(const RigHandle& rig) {
  MienRigInfo info = sized<MienRigInfo>();
  EXPECT_EQ(mien_rig_info(rig.get(), &info), MIEN_OK);
  return info;
}

inline uint32_t count_of(const RigHandle& rig, uint32_t kind) {
  uint32_t count = 0;
  EXPECT_EQ(mien_rig_count(rig.get(), kind, &count), MIEN_OK);
  return count;
}

inline std::vector<std::string> names_of(const RigHandle& rig, uint32_t kind) {
  std::vector<std::string> names(count_of(rig, kind));
  for (uint32_t i = 0; i < names.size(); ++i) {
    MienStringView name;
    EXPECT_EQ(mien_rig_name(rig.get(), kind, i, &name), MIEN_OK);
    names[i].assign(name.data, name.count);
  }
  return names;
}

/// Instruction sets that this build and this CPU have, without MIEN_ISA_BEST.
inline std::vector<uint32_t> present_isas() {
  std::vector<uint32_t> isas;
  for (uint32_t isa = MIEN_ISA_SCALAR; isa <= MIEN_ISA_NEON; ++isa) {
    if (mien_isa_available(isa)) isas.push_back(isa);
  }
  return isas;
}

/// An instance and its views: they stay valid and the same as long as it lives.
struct Character {
  RigHandle owned;  // a rig that nobody else keeps
  const MienRig* rig;
  InstanceHandle instance;
  Span<float> gui, raw, masks;
  Span<const float> controls, psd, ml, rbf, joints, channels, maps;

  explicit Character(RigHandle&& of) : Character(of) { owned = std::move(of); }
  explicit Character(const RigHandle& of) : rig(of.get()) {
    MienInstance* made = nullptr;
    EXPECT_EQ(mien_instance_create(rig, nullptr, &made, nullptr), MIEN_OK);
    instance.reset(made);
    gui = inputs(mien_instance_gui_controls);
    raw = inputs(mien_instance_raw_controls);
    masks = inputs(mien_instance_ml_masks);
    controls = outputs(mien_instance_controls);
    psd = outputs(mien_instance_psd_controls);
    ml = outputs(mien_instance_ml_controls);
    rbf = outputs(mien_instance_rbf_controls);
    joints = outputs(mien_instance_joints);
    channels = outputs(mien_instance_blend_shapes);
    maps = outputs(mien_instance_animated_maps);
  }

  void evaluate(uint32_t lod, uint32_t stages = MIEN_STAGE_ALL) {
    EXPECT_EQ(mien_rig_evaluate_stages(rig, instance.get(), lod, stages), MIEN_OK);
  }
  void map_gui_to_raw() { EXPECT_EQ(mien_rig_map_gui_to_raw(rig, instance.get()), MIEN_OK); }
  void map_raw_to_gui() { EXPECT_EQ(mien_rig_map_raw_to_gui(rig, instance.get()), MIEN_OK); }

  /// Bits of all that evaluation gives.
  std::vector<float> results() const {
    std::vector<float> all(controls.begin(), controls.end());
    for (const Span<const float>& part : {joints, channels, maps}) {
      all.insert(all.end(), part.begin(), part.end());
    }
    return all;
  }

 private:
  template <class Get>
  Span<float> inputs(Get get) {
    MienMutableFloatView view = {};
    EXPECT_EQ(get(instance.get(), &view), MIEN_OK);
    return {view.data, view.count};
  }
  template <class Get>
  Span<const float> outputs(Get get) {
    MienFloatView view = {};
    EXPECT_EQ(get(instance.get(), &view), MIEN_OK);
    return {view.data, view.count};
  }
};

/// True if both have the same bits.
inline bool same_bits(Span<const float> a, Span<const float> b) {
  return a.count == b.count &&
         (a.count == 0 || memcmp(a.data, b.data, a.count * sizeof(float)) == 0);
}
inline Span<const float> span_of(const std::vector<float>& values) {
  return {values.data(), values.size()};
}

inline BatchHandle create_batch(const RigHandle& rig, uint32_t capacity, uint32_t tasks = 1) {
  MienBatch* batch = nullptr;
  MienError error = sized<MienError>();
  const MienBatchDesc desc = batch_desc(capacity, tasks);
  EXPECT_EQ(mien_batch_create(rig.get(), &desc, &batch, &error), MIEN_OK) << error.message;
  return BatchHandle(batch);
}

}  // namespace mien
