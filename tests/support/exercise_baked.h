// SPDX-License-Identifier: MIT
// The whole life of a baked file, whatever its bytes are: its rig and its deformer are opened,
// asked, evaluated alone and in a packet, deformed, and baked again. Used by tests and by the fuzzer, so without GoogleTest.
#pragma once

#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "capi/include/mien.h"
#include "tests/support/counting_allocator.h"
#include "tests/support/cpu_time.h"
#include "tests/support/descs.h"
#include "tests/support/rig_twins.h"

namespace mien {

/// Most memory that an instance or a deformer instance may take.
constexpr size_t baked_instance_bound(size_t file_size) { return 40 * file_size + 8 * 1024 * 1024; }

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
  double seconds = 0;  // of opening, and frames at each LOD
};

class ExerciseBakedRun {
 public:
  ExerciseBakedRun(const uint8_t* bytes, size_t size, uint32_t isa, uint32_t twin_seed)
      : allocator_(counter_.get()), file_size_(size) {
    MienBakedDesc desc = {};
    desc.struct_size = sizeof(desc);
    desc.allocator = &allocator_;
    MienBaked* baked = nullptr;
    MienRig* rig = nullptr;
    MienDeformer* deformer = nullptr;
    const double start = cpu_seconds();
    const auto error = [] {
      MienError fresh = {};
      fresh.struct_size = sizeof(fresh);
      return fresh;
    };
    MienError detail = error();
    MienStatus status = mien_baked_open_memory(bytes, size, &desc, &baked, &detail);
    MienBakedInfo info = {};
    info.struct_size = sizeof(info);
    if (opened(status, baked, detail, size)) {
      if (mien_baked_info(baked, &info) != MIEN_OK) broke("no info of the file");
      MienBakedRigDesc wanted = {};
      wanted.struct_size = sizeof(wanted);
      wanted.isa = isa;
      wanted.allocator = &allocator_;
      detail = error();
      status = mien_rig_from_baked(baked, &wanted, &rig, &detail);
      if (opened(status, rig, detail, size)) {
        ask(rig);
        evaluate(rig);
      }
    }
    if (rig && info.deformer_bytes != 0) {
      MienBakedDeformerDesc wanted = {};
      wanted.struct_size = sizeof(wanted);
      wanted.allocator = &allocator_;
      detail = error();
      counter_.requests = 0;
      status = mien_deformer_from_baked(baked, rig, &wanted, &deformer, &detail);
      if (opened(status, deformer, detail, size)) {
        ask(deformer);
        deform(rig, deformer);
      }
    }
    life.seconds = cpu_seconds() - start;
    if (rig && life.opened == MIEN_OK) bake_again(rig, deformer, size, info);
    if (rig && twin_seed != 0 && life.broken.empty()) compare_twins(baked, rig, twin_seed);
    mien_deformer_destroy(deformer);
    mien_rig_destroy(rig);
    mien_baked_close(baked);
    if (!counter_.clean()) broke("memory was left");
  }

  ExerciseBaked life;

 private:
  void broke(const char* what) {
    if (life.broken.empty()) life.broken = what;
  }

  /// What an open call gave; each takes one block.
  bool opened(MienStatus status, const void* handle, const MienError& error, size_t size) {
    life.opened = status;
    if ((status == MIEN_OK) != (handle != nullptr)) broke("open gave a handle or none");
    if (status == MIEN_OK) {
      if (counter_.requests != 1) broke("opening took more than one block");
    } else {
      life.message = error.message;
      if (life.message.empty()) broke("refused without a word");
      if (error.status != status) broke("two statuses");
      if (error.byte_offset != MIEN_NO_OFFSET && error.byte_offset > size) broke("a place outside");
      if (status < MIEN_ERROR_BAKED_SIGNATURE || status > MIEN_ERROR_BAKED_PART) {
        broke("refused with another family's status");
      }
    }
    counter_.requests = 0;
    return status == MIEN_OK;
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
    if (counter_.peak > (kCrowd + 3) * baked_instance_bound(file_size_)) {
      broke("instances and a batch take too much memory");
    }
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

  template <class View>
  void read(const View& view) {
    for (size_t i = 0; i < view.count; ++i) sink_ = sink_ + static_cast<float>(view.data[i]);
  }
  template <class View>
  void check_below(const View& view, size_t limit) {
    for (size_t i = 0; i < view.count; ++i) {
      if (view.data[i] >= limit) broke("an index past the end");
    }
  }

  void ask(const MienDeformer* deformer) {
    deformer_info_.struct_size = sizeof(deformer_info_);
    if (mien_deformer_info(deformer, &deformer_info_) != MIEN_OK) broke("no info of a deformer");
    MienFloatView floats = {};
    for (const auto view : {mien_deformer_bind_matrices, mien_deformer_inverse_bind_matrices}) {
      if (view(deformer, &floats) != MIEN_OK) broke("no matrices");
      if (floats.count != size_t{16} * deformer_info_.joint_count) broke("other matrices");
      read(floats);
    }
    for (uint32_t m = 0; m < deformer_info_.mesh_count; ++m) {
      MienMesh mesh = {};
      mesh.struct_size = sizeof(mesh);
      if (mien_deformer_mesh(deformer, m, &mesh) != MIEN_OK) broke("no mesh");
      if (mesh.positions.count != size_t{3} * mesh.position_count ||
          mesh.normals.count != size_t{3} * mesh.vertex_count ||
          mesh.vertex_position_indices.count != mesh.vertex_count ||
          mesh.target_channels.count != mesh.target_count) {
        broke("counts of a mesh");
      }
      read(mesh.positions);
      read(mesh.normals);
      read(mesh.texture_coordinates);
      check_below(mesh.vertex_position_indices, mesh.position_count);
      check_below(mesh.triangles, mesh.vertex_count);
      std::vector<uint32_t> corners(size_t{3} * mesh.triangle_count);
      std::vector<float> uvs(size_t{2} * mesh.vertex_count);
      if (mien_deformer_triangles(deformer, m, corners.data(), corners.size()) != MIEN_OK ||
          mien_deformer_texture_coordinates(deformer, m, uvs.data(), uvs.size()) != MIEN_OK) {
        broke("no triangles");
      }
      check_below(MienIndex32View{corners.data(), corners.size()}, mesh.vertex_count);
      read(MienFloatView{uvs.data(), uvs.size()});
      check_below(mesh.target_channels, deformer_info_.channel_count);
      for (uint32_t p = 0; p < mesh.position_count; ++p) {
        MienIndex16View joints = {};
        const MienStatus found = mien_deformer_influences(deformer, m, p, &joints, &floats);
        if (found != MIEN_OK && found != MIEN_ERROR_UNSUPPORTED) {
          broke("no influences");
        }
        if (joints.count != floats.count || joints.count > mesh.max_influences) {
          broke("other influences");
        }
        check_below(joints, deformer_info_.joint_count);
        read(floats);
      }
      std::vector<float> deltas(size_t{3} * mesh.position_count);
      for (uint32_t t = 0; t < mesh.target_count && t < 8; ++t) {
        if (mien_deformer_target(deformer, m, t, deltas.data(), deltas.size()) != MIEN_OK) {
          broke("no target");
        }
      }
    }
  }

  void deform(const MienRig* rig, const MienDeformer* deformer) {
    constexpr size_t kCount = 2;
    MienDeformerInstanceDesc desc = {};
    desc.struct_size = sizeof(desc);
    desc.allocator = &allocator_;
    const auto instance_desc = desc_with<MienInstanceDesc>(&allocator_);
    MienInstance* instance = nullptr;
    MienDeformerInstance* deformed[kCount] = {};
    bool made = mien_instance_create(rig, &instance_desc, &instance, nullptr) == MIEN_OK;
    for (MienDeformerInstance*& one : deformed) {
      made &= mien_deformer_instance_create(deformer, &desc, &one, nullptr) == MIEN_OK;
    }
    if (!made) broke("no memory for a deformer instance");
    if (counter_.peak > 8 * baked_instance_bound(file_size_)) {
      broke("deformer instances take too much memory");
    }
    const size_t requests = counter_.requests;
    for (uint32_t round = 0; made && round < 3; ++round) {
      MienMutableFloatView raw = {};
      (void)mien_instance_raw_controls(instance, &raw);
      for (size_t k = 0; k < raw.count; ++k) raw.data[k] = next_control();
      if (round < info_.lod_count) (void)mien_rig_evaluate(rig, instance, round);
      std::vector<float> joints(info_.joint_value_count), channels(deformer_info_.channel_count);
      for (float& value : joints) value = next_control();
      for (float& value : channels) value = next_control();
      if (mien_deformer_instance_update(deformed[0], instance) != MIEN_OK ||
          mien_deformer_instance_update_from_values(
              deformed[1], joints.empty() ? nullptr : joints.data(), joints.size(),
              channels.empty() ? nullptr : channels.data(), channels.size()) != MIEN_OK) {
        broke("not updated");
      }
      for (uint32_t m = 0; m < deformer_info_.mesh_count; ++m) {
        const uint32_t normals = 1 + (round + m) % 3;
        if (mien_deformer_instance_deform_batch(deformed, kCount, m, normals, nullptr) != MIEN_OK) {
          broke("not deformed");
        }
        write_vertices(deformer, deformed[0], m, normals);
        for (const MienDeformerInstance* one : deformed) {
          MienFloatView view = {};
          if (mien_deformer_instance_positions(one, m, &view) != MIEN_OK) broke("no positions");
          read(view);
          if (mien_deformer_instance_normals(one, m, &view) != MIEN_OK) broke("no normals");
          read(view);
        }
      }
      std::vector<float> locals(size_t{10} * deformer_info_.joint_count + 1);
      for (const MienDeformerInstance* one : deformed) {
        MienFloatView view = {};
        (void)mien_deformer_instance_joint_matrices(one, &view);
        read(view);
        (void)mien_deformer_instance_skin_matrices(one, &view);
        read(view);
        if (mien_deformer_instance_local_transforms(one, locals.data(), locals.size()) != MIEN_OK) {
          broke("no local transforms");
        }
      }
    }
    if (counter_.requests != requests) broke("deformation allocated");
    for (MienDeformerInstance* one : deformed) mien_deformer_instance_destroy(one);
    mien_instance_destroy(instance);
  }

  void write_vertices(const MienDeformer* deformer, MienDeformerInstance* instance, uint32_t m,
                      uint32_t normals) {
    MienMesh mesh = {};
    mesh.struct_size = sizeof(mesh);
    if (mien_deformer_mesh(deformer, m, &mesh) != MIEN_OK) broke("no mesh");
    const size_t floats = size_t{4} * mesh.vertex_count + 1;
    std::vector<float> positions(floats), directions(floats), tangents(floats);
    MienVertexOutput output = {};
    output.struct_size = sizeof(output);
    output.vertex_capacity = mesh.vertex_count;
    output.positions = {positions.data(), 16, MIEN_VERTEX_FORMAT_FLOAT32X4};
    output.normals = {directions.data(), 16, m % 4};
    if (mesh.tangents.count != 0) {
      output.tangents = {tangents.data(), 16, MIEN_VERTEX_FORMAT_SNORM16X4};
    }
    if (mien_deformer_instance_write_vertices(instance, m, normals, &output, nullptr) != MIEN_OK) {
      broke("vertices were not written");
    }
    for (const float value : positions) sink_ = sink_ + value;
  }

  // What was opened is as large as its part of the file, whatever it holds.
  void bake_again(const MienRig* rig, const MienDeformer* deformer, size_t file_size,
                  const MienBakedInfo& info) {
    const size_t expected =
        64 + (deformer ? 128 : 64) + static_cast<size_t>(info.rig_bytes + info.deformer_bytes);
    size_t size = 0;
    if (mien_bake_memory(rig, deformer, nullptr, 0, &size, nullptr) != MIEN_OK ||
        size != expected || size > file_size) {
      return broke("a file of another size");
    }
    std::vector<uint8_t> again(size);
    if (mien_bake_memory(rig, deformer, again.data(), size, &size, nullptr) != MIEN_OK) {
      broke("not baked again");
    }
  }

  // Whatever it holds, the same bytes give the same bits, and so does what is baked again. (What an
  // instruction set takes of a block that is not full, which results may be kept and what a batch skips
  // is up to the tables.)
  void compare_twins(const MienBaked* baked, const MienRig* rig, uint32_t seed) {
    RigTwins twins(seed);
    MienBakedRigDesc desc = {};
    desc.struct_size = sizeof(desc);
    desc.isa = twins.draw_isa(true);
    desc.reuse = MIEN_REUSE_NOTHING;
    size_t size = 0;
    (void)mien_bake_memory(rig, nullptr, nullptr, 0, &size, nullptr);
    std::vector<uint8_t> bytes(size);
    (void)mien_bake_memory(rig, nullptr, bytes.data(), size, &size, nullptr);
    const AlignedBytes aligned(bytes);
    MienBaked* again = nullptr;
    if (mien_baked_open_memory(aligned.data(), size, nullptr, &again, nullptr) != MIEN_OK) {
      return broke("what was baked again does not open");
    }
    for (const MienBaked* file : {baked, baked, static_cast<const MienBaked*>(again)}) {
      MienRig* twin = nullptr;
      if (mien_rig_from_baked(file, &desc, &twin, nullptr) != MIEN_OK) {
        broke("a rig does not open again");
        break;
      }
      twins.add(file == again ? "rig baked again" : "rig", twin, nullptr);
    }
    mien_baked_close(again);
    const std::string difference = twins.compare(4);
    if (!difference.empty()) broke(difference.c_str());
  }

  CountingAllocator counter_;
  MienAllocator allocator_;
  size_t file_size_;
  MienRigInfo info_ = {};
  MienDeformerInfo deformer_info_ = {};
  uint32_t state_ = 1;
  volatile float sink_ = 0;
};

/// `bytes` is at a multiple of 64. With a seed, rigs of it are compared.
inline ExerciseBaked exercise_baked(const uint8_t* bytes, size_t size,
                                    uint32_t isa = MIEN_ISA_ENVIRONMENT, uint32_t twin_seed = 0) {
  return ExerciseBakedRun(bytes, size, isa, twin_seed).life;
}

}  // namespace mien
