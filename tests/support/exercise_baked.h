// SPDX-License-Identifier: MIT
// The whole life of an image of a rig, whatever its bytes are: opened, asked, evaluated alone and
// in a packet, saved. Used by tests and by the fuzzer, so without GoogleTest.
#pragma once

#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "capi/mien.h"
#include "tests/support/counting_allocator.h"
#include "tests/support/descs.h"

namespace mien {

/// Bytes at a multiple of 64, in a block that ends where they do.
class AlignedBytes {
 public:
  explicit AlignedBytes(const std::vector<uint8_t>& bytes) : size_(bytes.size()) {
    data_ = static_cast<uint8_t*>(::operator new (size_ + 1, std::align_val_t{64}));
    if (size_) memcpy(data_, bytes.data(), size_);
  }
  ~AlignedBytes() { ::operator delete (data_, std::align_val_t{64}); }
  AlignedBytes(const AlignedBytes&) = delete;
  AlignedBytes& operator=(const AlignedBytes&) = delete;
  uint8_t* data() const { return data_; }
  size_t size() const { return size_; }

 private:
  uint8_t* data_;
  size_t size_;
};

struct ExerciseBaked {
  MienStatus opened = MIEN_OK;
  std::string message;
  std::string broken;  // a promise that was not kept; "" if all were
};

class ExerciseBakedRun {
 public:
  ExerciseBakedRun(const uint8_t* bytes, size_t size, uint32_t isa) : allocator_(counter_.get()) {
    MienBakedDesc desc = {};
    desc.struct_size = sizeof(desc);
    desc.isa = isa;
    desc.allocator = &allocator_;
    MienError error = {};
    error.struct_size = sizeof(error);
    MienRig* rig = nullptr;
    life.opened = mien_rig_open_memory(bytes, size, &desc, &rig, &error);
    if ((life.opened == MIEN_OK) != (rig != nullptr)) broke("open gave a rig or none");
    if (life.opened != MIEN_OK) {
      life.message = error.message;
      if (life.message.empty()) broke("refused without a word");
      if (error.status != life.opened) broke("two statuses");
      if (error.byte_offset != MIEN_NO_OFFSET && error.byte_offset > size) broke("a place outside");
      const bool expected =
          life.opened >= MIEN_ERROR_BAKED_SIGNATURE && life.opened <= MIEN_ERROR_BAKED_CHECKSUM;
      if (!expected) broke("refused with another family's status");
    } else {
      if (counter_.requests != 2) broke("opening took more than two blocks");
      ask(rig);
      evaluate(rig);
      save(rig, size);
    }
    mien_rig_destroy(rig);
    if (!counter_.clean()) broke("memory was left");
  }

  ExerciseBaked life;

 private:
  void broke(const char* what) {
    if (life.broken.empty()) life.broken = what;
  }

  void ask(const MienRig* rig) {
    for (uint32_t kind = 0; kind <= MIEN_KIND_TWIST_SWING; ++kind) {
      uint32_t count = 0, index = 0;
      if (mien_rig_count(rig, kind, &count) != MIEN_OK) broke("no count");
      for (uint32_t i = 0; i < count; ++i) {
        MienStringView name;
        if (mien_rig_name(rig, kind, i, &name) != MIEN_OK) broke("no name");
        for (size_t k = 0; k < name.count; ++k) sink_ = sink_ + static_cast<float>(name.data[k]);
        if (kind <= MIEN_KIND_ML_MASK && i < 8) {
          (void)mien_rig_find_n(rig, kind, name.data, name.count, &index);
        }
      }
    }
    info_.struct_size = sizeof(info_);
    if (mien_rig_info(rig, &info_) != MIEN_OK) broke("no info");
    for (uint32_t lod = 0; lod < info_.lod_count; ++lod) {
      MienRigStatistics statistics = {};
      statistics.struct_size = sizeof(statistics);
      if (mien_rig_statistics(rig, lod, &statistics) != MIEN_OK) broke("no statistics");
      for (uint32_t kind : {MIEN_KIND_JOINT, MIEN_KIND_BLEND_SHAPE_CHANNEL, MIEN_KIND_ANIMATED_MAP,
                            MIEN_KIND_MESH, MIEN_KIND_RBF_SOLVER}) {
        uint32_t count = 0;
        MienIndex16View list = {};
        (void)mien_rig_count(rig, kind, &count);
        if (mien_rig_lod_indices(rig, kind, lod, &list) != MIEN_OK) broke("no LOD list");
        for (size_t i = 0; i < list.count; ++i) {
          if (list.data[i] >= count) broke("an index past the end");
        }
      }
      MienIndex16View values = {};
      if (mien_rig_variable_joint_values(rig, lod, &values) != MIEN_OK) broke("no values");
      for (size_t i = 0; i < values.count; ++i) {
        if (values.data[i] >= info_.joint_value_count) broke("a joint value past the end");
      }
    }
    MienFloatView floats = {};
    MienIndex16View indices = {};
    if (mien_rig_neutral_joint_values(rig, &floats) != MIEN_OK) broke("no neutral pose");
    for (size_t i = 0; i < floats.count; ++i) sink_ = sink_ + floats.data[i];
    if (mien_rig_initial_raw_controls(rig, &floats) != MIEN_OK) broke("no initial controls");
    for (size_t i = 0; i < floats.count; ++i) sink_ = sink_ + floats.data[i];
    uint32_t count = 0;
    (void)mien_rig_count(rig, MIEN_KIND_PSD_CONTROL, &count);
    for (uint32_t i = 0; i < count; ++i) {
      if (mien_rig_psd_inputs(rig, i, &indices) != MIEN_OK) broke("no inputs of a corrective");
      for (size_t k = 0; k < indices.count; ++k) {
        if (indices.data[k] >= info_.control_count) broke("a control past the end");
      }
    }
    if (mien_rig_joint_parents(rig, &indices) != MIEN_OK) broke("no parents");
    for (size_t i = 0; i < indices.count; ++i) sink_ = sink_ + indices.data[i];
  }

  float next_control() {
    state_ = state_ * 1664525u + 1013904223u;
    return static_cast<float>(state_ >> 8) / static_cast<float>(1 << 24) * 3.0f - 1.0f;
  }

  void evaluate(const MienRig* rig) {
    constexpr uint32_t kCrowd = 5;
    MienInstance* packet[kCrowd] = {};
    MienBatch* batch = nullptr;
    const auto desc = batch_desc(kCrowd, 1, &allocator_);
    const auto instance_desc = desc_with<MienInstanceDesc>(&allocator_);
    bool made = mien_batch_create(rig, &desc, &batch, nullptr) == MIEN_OK;
    for (MienInstance*& instance : packet) {
      made &= mien_instance_create(rig, &instance_desc, &instance, nullptr) == MIEN_OK;
    }
    if (!made) broke("no memory for a packet");
    const size_t requests = counter_.requests;
    for (uint32_t lod = 0; made && lod < info_.lod_count; ++lod) {
      uint32_t lods[kCrowd];
      for (uint32_t i = 0; i < kCrowd; ++i) {
        MienMutableFloatView raw = {}, gui = {};
        (void)mien_instance_gui_controls(packet[i], &gui);
        (void)mien_instance_raw_controls(packet[i], &raw);
        for (size_t k = 0; k < gui.count; ++k) gui.data[k] = next_control();
        for (size_t k = 0; k < raw.count; ++k) raw.data[k] = next_control();
        if (i == 0) {
          (void)mien_rig_map_gui_to_raw(rig, packet[i]);
          (void)mien_rig_map_raw_to_gui(rig, packet[i]);
        }
        if (i < 2 && mien_rig_evaluate(rig, packet[i], lod) != MIEN_OK) broke("not evaluated");
        lods[i] = (lod + i) % info_.lod_count;
      }
      if (mien_rig_evaluate_batch(rig, batch, packet, lods, kCrowd, MIEN_STAGE_ALL, nullptr) !=
          MIEN_OK) {
        broke("packet not evaluated");
      }
      evaluate_parts(rig, packet[0], lod);
      for (MienInstance* instance : packet) read_outputs(instance);
    }
    if (counter_.requests != requests) broke("evaluation allocated");
    for (MienInstance* instance : packet) mien_instance_destroy(instance);
    mien_batch_destroy(batch);
  }

  void evaluate_parts(const MienRig* rig, MienInstance* instance, uint32_t lod) {
    uint32_t count = 0;
    (void)mien_rig_count(rig, MIEN_KIND_JOINT_GROUP, &count);
    for (uint32_t i = 0; i < count && i < 8; ++i) {
      (void)mien_rig_evaluate_joint_group(rig, instance, lod, i);
    }
    (void)mien_rig_count(rig, MIEN_KIND_RBF_SOLVER, &count);
    for (uint32_t i = 0; i < count && i < 8; ++i) {
      (void)mien_rig_evaluate_rbf_solver(rig, instance, lod, i);
    }
    (void)mien_rig_count(rig, MIEN_KIND_TWIST_SWING, &count);
    for (uint32_t i = 0; i < count && i < 8; ++i) {
      (void)mien_rig_evaluate_twist_swing(rig, instance, lod, i);
    }
  }

  void read_outputs(const MienInstance* instance) {
    MienStatus (*const views[])(const MienInstance*, MienFloatView*) = {
        mien_instance_controls,     mien_instance_psd_controls, mien_instance_ml_controls,
        mien_instance_rbf_controls, mien_instance_joints,       mien_instance_blend_shapes,
        mien_instance_animated_maps};
    for (const auto view : views) {
      MienFloatView values = {};
      if (view(instance, &values) != MIEN_OK) broke("no outputs");
      for (size_t i = 0; i < values.count; ++i) sink_ = sink_ + values.data[i];
    }
  }

  // What was opened is as large as its file, whatever it holds.
  void save(const MienRig* rig, size_t expected) {
    size_t size = 0;
    if (mien_rig_save_memory(rig, nullptr, 0, &size, nullptr) != MIEN_OK || size != expected) {
      return broke("an image of another size");
    }
    std::vector<uint8_t> again(size);
    if (mien_rig_save_memory(rig, again.data(), size, &size, nullptr) != MIEN_OK) {
      broke("not saved");
    }
  }

  CountingAllocator counter_;
  MienAllocator allocator_;
  MienRigInfo info_ = {};
  uint32_t state_ = 1;
  volatile float sink_ = 0;
};

/// `bytes` is at a multiple of 64.
inline ExerciseBaked live_image(const uint8_t* bytes, size_t size,
                                uint32_t isa = MIEN_ISA_ENVIRONMENT) {
  return ExerciseBakedRun(bytes, size, isa).life;
}

}  // namespace mien
