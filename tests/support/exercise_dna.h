// SPDX-License-Identifier: MIT
// The whole life of a file, whatever is in it: opened, compiled, evaluated, deformed, written,
// opened again, validated. What the library promises of each step for any bytes at all is checked
// on the way; the first broken promise is told in words. Used by tests and by the fuzzer, so
// without GoogleTest.
#pragma once

#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "capi/include/mien.h"
#include "tests/support/counting_allocator.h"
#include "tests/support/cpu_time.h"
#include "tests/support/descs.h"
#include "tests/support/dna_twins.h"

namespace mien {

/// Most memory that opening may hold at a time.
constexpr size_t open_memory_bound(size_t file_size) { return 20 * file_size + 256 * 1024; }

/// The same for packing the geometry and one pose. A position of 12 bytes becomes about 100, with
/// places, neighbors and results; a mesh without geometry, which is listed with 6, becomes records of
/// about 570.
constexpr size_t deformer_memory_bound(size_t file_size) { return 96 * file_size + 1024 * 1024; }

/// The same for compiling a rig and one instance. A joint group of one row is padded to 16, so an
/// entry of 4 bytes can become one of 64; names and tables of 65536 controls, which a file asks for
/// with two bytes (psdCount), are the constant.
constexpr size_t rig_memory_bound(size_t file_size) { return 40 * file_size + 8 * 1024 * 1024; }

struct LifeOptions {
  uint32_t layers = 0;  // all
  bool skip_targets = false;
  uint64_t lods = 0;
  uint32_t unknown_layers = MIEN_UNKNOWN_LAYERS_KEEP;
  uint32_t control_seed = 1;
  bool validate = true;
  bool twins = false;  // compare with rigs that have to give the same bits
  const MienCoordinateSystem* system = nullptr;  // to convert to; refusing is one of the answers
};

struct Life {
  MienStatus opened = MIEN_OK;
  MienStatus compiled = MIEN_OK;  // if opened
  MienStatus packed = MIEN_OK;    // the geometry, if compiled
  std::string message;            // of the step that failed
  size_t open_peak = 0, rig_peak = 0, deformer_peak = 0, report_peak = 0;
  double seconds = 0;  // of opening, compiling, and frames at each LOD
  std::string broken;  // a promise that was not kept; "" if all were
};

class ExerciseDna {
 public:
  ExerciseDna(const uint8_t* bytes, size_t size, const LifeOptions& options)
      : bytes_(bytes), size_(size), options_(options), allocator_(counter_.get()) {}

  Life run() {
    const double start = cpu_seconds();
    MienDna* dna = open(bytes_, size_, options_.lods, life_.opened, options_.system);
    life_.seconds = cpu_seconds() - start;
    life_.open_peak = counter_.peak;
    if (life_.open_peak > open_memory_bound(size_)) {
      broke("opening %zu bytes held %zu", size_, life_.open_peak);
    }
    if (dna) {
      check_info(dna);
      compile(dna);
      write(dna);
      if (options_.twins && life_.compiled == MIEN_OK && life_.broken.empty()) {
        const std::string difference = compare_dna_twins(dna, options_.control_seed);
        if (!difference.empty()) broke("%s", difference.c_str());
      }
    }
    mien_dna_close(dna);
    if (options_.validate) validate();
    if (!counter_.clean()) {
      broke("%zu blocks of %zu bytes were left; %s", counter_.live, counter_.bytes,
            counter_.first_wrong.c_str());
    }
    return life_;
  }

 private:
#if defined(__MINGW_PRINTF_FORMAT)
  __attribute__((format(__MINGW_PRINTF_FORMAT, 2, 3)))
#elif defined(__GNUC__)
  __attribute__((format(printf, 2, 3)))
#endif
  void
  broke(const char* format, ...) {
    if (!life_.broken.empty()) return;
    char text[400];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof(text), format, arguments);
    va_end(arguments);
    life_.broken = text;
  }

  // A failure has a known number, a sentence, and a place within the file if it has one.
  void check_failure(const char* call, MienStatus status, const MienError& error, size_t size) {
    life_.message = error.message;
    if (strcmp(mien_status_name(status), "UNKNOWN") == 0) broke("%s gave %d", call, status);
    if (error.status != status) broke("%s gave %d, its error %d", call, status, error.status);
    if (error.message[0] == 0) broke("%s gave %d without a message", call, status);
    if (!memchr(error.message, 0, sizeof(error.message))) broke("%s: endless message", call);
    if (error.byte_offset != MIEN_NO_OFFSET && error.byte_offset > size) {
      broke("%s: byte offset %llu of %zu (%s)", call,
            static_cast<unsigned long long>(error.byte_offset), size, error.message);
    }
  }

  MienDna* open(const uint8_t* bytes, size_t size, uint64_t lods, MienStatus& status,
                const MienCoordinateSystem* system = nullptr) {
    MienDnaDesc desc = {};
    desc.struct_size = sizeof(desc);
    desc.layers = options_.layers;
    desc.skip_blend_shape_targets = options_.skip_targets;
    desc.unknown_layers = options_.unknown_layers;
    desc.lods = lods;
    desc.system = system;
    desc.allocator = &allocator_;
    MienError error = {};
    error.struct_size = sizeof(error);
    MienDna* dna = nullptr;
    status = mien_dna_open_memory(bytes, size, &desc, &dna, &error);
    if ((status == MIEN_OK) != (dna != nullptr)) broke("open gave %d and a handle or none", status);
    if (status != MIEN_OK) check_failure("open", status, error, size);
    if (status == MIEN_ERROR_MEMORY) broke("open ran out of memory that it had");
    return dna;
  }

  void check_info(const MienDna* dna) {
    MienDnaInfo info = {};
    info.struct_size = sizeof(info);
    if (mien_dna_info(dna, &info) != MIEN_OK) broke("no info");
    if (info.memory_bytes != counter_.bytes) {
      broke("info tells %llu bytes, taken are %zu",
            static_cast<unsigned long long>(info.memory_bytes), counter_.bytes);
    }
    for (uint32_t i = 0; i < info.layer_count; ++i) {
      MienDnaLayer layer = {};
      layer.struct_size = sizeof(layer);
      if (mien_dna_layer(dna, i, &layer) != MIEN_OK) broke("no layer %u", i);
      if (layer.byte_offset + layer.byte_count > size_) broke("layer %u lies outside", i);
    }
    layers_ = info.layers;
    only_correctives_ = info.neural_network_count == 0 && info.rbf_pose_count == 0;
  }

  void compile(const MienDna* dna) {
    const size_t before = counter_.bytes;
    counter_.restart();
    MienRigDesc desc = {};
    desc.struct_size = sizeof(desc);
    desc.allocator = &allocator_;
    MienError error = {};
    error.struct_size = sizeof(error);
    MienRig* rig = nullptr;
    const double start = cpu_seconds();
    life_.compiled = mien_rig_create(dna, &desc, &rig, &error);
    if ((life_.compiled == MIEN_OK) != (rig != nullptr)) broke("create gave a rig or none");
    if (!rig) {
      life_.seconds += cpu_seconds() - start;
      check_failure("create", life_.compiled, error, size_);
      // Opening leaves circles of correctives, and what a file may ask a rig to compute.
      const bool expected =
          layers_ & MIEN_LAYER_BEHAVIOR
              ? life_.compiled == MIEN_ERROR_DNA_VALUE || life_.compiled == MIEN_ERROR_DNA_LIMIT
              : life_.compiled == MIEN_ERROR_DNA_LAYER;
      if (!expected) broke("create gave %d: %s", life_.compiled, error.message);
      if (counter_.bytes != before) broke("a failed create kept memory");
      return;
    }
    evaluate(rig);
    life_.seconds += cpu_seconds() - start;
    life_.rig_peak = counter_.peak - before;
    if (life_.rig_peak > rig_memory_bound(size_)) {
      broke("a rig of %zu bytes of file took %zu", size_, life_.rig_peak);
    }
    deform(dna, rig);
    mien_rig_destroy(rig);
    if (counter_.bytes != before) broke("a destroyed rig kept memory");
  }

  void deform(const MienDna* dna, MienRig* rig) {
    const size_t before = counter_.bytes;
    counter_.restart();
    MienDeformerDesc desc = {};
    desc.struct_size = sizeof(desc);
    desc.weights = options_.control_seed & 1 ? MIEN_WEIGHTS_FIX : MIEN_WEIGHTS_AS_STORED;
    desc.compose = options_.control_seed & 2 ? MIEN_COMPOSE_EULER_ADD : MIEN_COMPOSE_PRODUCT;
    desc.allocator = &allocator_;
    MienError error = {};
    error.struct_size = sizeof(error);
    MienDeformer* deformer = nullptr;
    life_.packed = mien_deformer_create(dna, rig, &desc, &deformer, &error);
    if ((life_.packed == MIEN_OK) != (deformer != nullptr)) broke("a deformer or none");
    if (!deformer) {
      check_failure("packing", life_.packed, error, size_);
      const bool expected = layers_ & MIEN_LAYER_GEOMETRY ? life_.packed == MIEN_ERROR_DNA_VALUE ||
                                                                life_.packed == MIEN_ERROR_DNA_LIMIT
                                                          : life_.packed == MIEN_ERROR_DNA_LAYER;
      if (!expected) broke("packing gave %d: %s", life_.packed, error.message);
      if (counter_.bytes != before) broke("a failed deformer kept memory");
      return;
    }
    read_meshes(deformer);
    MienInstance* instance = nullptr;
    MienDeformerInstance* pose = nullptr;
    const auto instance_desc = desc_with<MienInstanceDesc>(&allocator_);
    if (mien_instance_create(rig, &instance_desc, &instance, nullptr) != MIEN_OK) {
      broke("no instance");
    }
    MienDeformerInstanceDesc pose_desc = {};
    pose_desc.struct_size = sizeof(pose_desc);
    pose_desc.allocator = &allocator_;
    if (mien_deformer_instance_create(deformer, &pose_desc, &pose, nullptr) != MIEN_OK)
      broke("no pose");
    mien_deformer_destroy(deformer);  // the pose keeps what it needs
    if (instance && pose) pose_meshes(rig, instance, pose);
    life_.deformer_peak = counter_.peak - before;
    mien_deformer_instance_destroy(pose);
    mien_instance_destroy(instance);
    if (life_.deformer_peak > deformer_memory_bound(size_)) {
      broke("a deformer of %zu bytes of file took %zu", size_, life_.deformer_peak);
    }
    if (counter_.bytes != before) broke("a destroyed deformer kept memory");
  }

  // What views point at can be read, and indices lie within what they number.
  void read_meshes(const MienDeformer* deformer) {
    MienDeformerInfo info = {};
    info.struct_size = sizeof(info);
    if (mien_deformer_info(deformer, &info) != MIEN_OK) broke("no deformer info");
    for (uint32_t m = 0; m < info.mesh_count; ++m) {
      MienMesh mesh = {};
      mesh.struct_size = sizeof(mesh);
      if (mien_deformer_mesh(deformer, m, &mesh) != MIEN_OK) broke("no mesh %u", m);
      float sum = 0;
      for (size_t i = 0; i < mesh.positions.count; ++i) sum += mesh.positions.data[i];
      for (size_t i = 0; i < mesh.normals.count; ++i) sum += mesh.normals.data[i];
      for (size_t i = 0; i < mesh.texture_coordinates.count; ++i) {
        sum += mesh.texture_coordinates.data[i];
      }
      sink_ = sum;
      for (size_t i = 0; i < mesh.triangles.count; ++i) {
        if (mesh.triangles.data[i] >= mesh.vertex_count) broke("mesh %u: a corner too far", m);
      }
      for (size_t i = 0; i < mesh.vertex_position_indices.count; ++i) {
        if (mesh.vertex_position_indices.data[i] >= mesh.position_count)
          broke("mesh %u: a position", m);
      }
      for (uint32_t p = 0; p < mesh.position_count; ++p) {
        MienIndex16View joints;
        MienFloatView weights;
        if (mien_deformer_influences(deformer, m, p, &joints, &weights) != MIEN_OK ||
            joints.count != weights.count || joints.count > mesh.max_influences) {
          broke("mesh %u: influences of position %u", m, p);
        }
        for (size_t i = 0; i < joints.count; ++i) {
          if (joints.data[i] >= info.joint_count) broke("mesh %u: a joint too far", m);
        }
      }
      std::vector<float> deltas(size_t{mesh.position_count} * 3 + 1);
      for (uint32_t t = 0; t < mesh.target_count && t < 4; ++t) {
        if (mien_deformer_target(deformer, m, t, deltas.data(), deltas.size()) != MIEN_OK) {
          broke("mesh %u: no target %u", m, t);
        }
      }
    }
  }

  void pose_meshes(const MienRig* rig, MienInstance* instance, MienDeformerInstance* pose) {
    MienRigInfo info = {};
    info.struct_size = sizeof(info);
    (void)mien_rig_info(rig, &info);
    uint32_t meshes = 0;
    (void)mien_rig_count(rig, MIEN_KIND_MESH, &meshes);
    MienMutableFloatView raw = {};
    (void)mien_instance_raw_controls(instance, &raw);
    const size_t requests = counter_.requests;
    for (uint32_t lod = 0; lod < info.lod_count; lod += 1 + info.lod_count / 3) {
      for (size_t i = 0; i < raw.count; ++i) raw.data[i] = next_control();
      if (mien_rig_evaluate(rig, instance, lod) != MIEN_OK) broke("LOD %u not evaluated", lod);
      if (mien_deformer_instance_update(pose, instance) != MIEN_OK) broke("no update");
      for (uint32_t m = 0; m < meshes; ++m) {
        for (uint32_t normals = 0; normals <= MIEN_NORMALS_RECOMPUTED; ++normals) {
          if (mien_deformer_instance_deform(pose, m, normals, nullptr) != MIEN_OK)
            broke("mesh %u not posed", m);
        }
        MienFloatView views[2] = {};
        if (mien_deformer_instance_positions(pose, m, &views[0]) != MIEN_OK ||
            mien_deformer_instance_normals(pose, m, &views[1]) != MIEN_OK) {
          broke("no results of mesh %u", m);
        }
        float sum = 0;
        for (const MienFloatView& view : views) {
          for (size_t i = 0; i < view.count; ++i) sum += view.data[i];
        }
        sink_ = sum;
      }
    }
    if (mien_deformer_instance_deform(pose, meshes, 0, nullptr) != MIEN_ERROR_INDEX)
      broke("a mesh too many");
    if (counter_.requests != requests) broke("deforming allocated");
  }

  // Small steps of a linear congruence: anything from -1 to 2.
  float next_control() {
    state_ = state_ * 1664525u + 1013904223u;
    return static_cast<float>(state_ >> 8) / static_cast<float>(1 << 24) * 3.0f - 1.0f;
  }

  void evaluate(const MienRig* rig) {
    MienRigInfo info = {};
    info.struct_size = sizeof(info);
    if (mien_rig_info(rig, &info) != MIEN_OK) broke("no rig info");
    MienInstance* instance = nullptr;
    const auto desc = desc_with<MienInstanceDesc>(&allocator_);
    if (mien_instance_create(rig, &desc, &instance, nullptr) != MIEN_OK) {
      return broke("no instance");
    }
    const size_t requests = counter_.requests;
    MienMutableFloatView gui, raw;
    if (mien_instance_gui_controls(instance, &gui) != MIEN_OK ||
        mien_instance_raw_controls(instance, &raw) != MIEN_OK) {
      return broke("no inputs");
    }
    state_ = options_.control_seed;
    for (uint32_t lod = 0; lod < info.lod_count; ++lod) {
      for (size_t i = 0; i < gui.count; ++i) gui.data[i] = next_control();
      if (mien_rig_map_gui_to_raw(rig, instance) != MIEN_OK) broke("no GUI mapping");
      if (lod % 2 == 1) {
        for (size_t i = 0; i < raw.count; ++i) raw.data[i] = next_control();
      }
      if (mien_rig_evaluate(rig, instance, lod) != MIEN_OK) broke("LOD %u not evaluated", lod);
      check_outputs(instance, lod);
    }
    if (mien_rig_map_raw_to_gui(rig, instance) != MIEN_OK) broke("no mapping back");
    if (mien_rig_evaluate(rig, instance, info.lod_count) != MIEN_ERROR_LOD) broke("a LOD too many");
    if (counter_.requests != requests) broke("evaluation allocated");
    mien_instance_destroy(instance);
  }

  // Correctives end at 1, maps lie in 0..1, whatever the numbers in the file are. (Networks and
  // poses may be told to write over correctives.)
  void check_outputs(const MienInstance* instance, uint32_t lod) {
    MienFloatView psd, joints, channels, maps;
    if (mien_instance_psd_controls(instance, &psd) != MIEN_OK ||
        mien_instance_joints(instance, &joints) != MIEN_OK ||
        mien_instance_blend_shapes(instance, &channels) != MIEN_OK ||
        mien_instance_animated_maps(instance, &maps) != MIEN_OK) {
      return broke("no outputs");
    }
    for (size_t i = 0; i < psd.count; ++i) {
      if (only_correctives_ && !(psd.data[i] <= 1))
        broke("corrective %zu is %g", i, static_cast<double>(psd.data[i]));
    }
    for (size_t i = 0; i < maps.count; ++i) {
      if (!(maps.data[i] >= 0 && maps.data[i] <= 1)) {
        broke("map %zu is %g at LOD %u", i, static_cast<double>(maps.data[i]), lod);
      }
    }
    // To be read is all that is asked of the others: NaN in the file is NaN here.
    float sum = 0;
    for (size_t i = 0; i < joints.count; ++i) sum += joints.data[i];
    for (size_t i = 0; i < channels.count; ++i) sum += channels.data[i];
    sink_ = sum;
  }

  std::vector<uint8_t> write_bytes(const MienDna* dna) {
    MienError error = {};
    error.struct_size = sizeof(error);
    size_t size = 0, again = 0;
    if (mien_dna_write_memory(dna, nullptr, nullptr, 0, &size, &error) != MIEN_OK) {
      broke("not written: %s", error.message);
      return {};
    }
    std::vector<uint8_t> bytes(size);
    if (mien_dna_write_memory(dna, nullptr, bytes.data(), size, &again, &error) != MIEN_OK ||
        again != size) {
      broke("measured as %zu, written as %zu: %s", size, again, error.message);
    }
    return bytes;
  }

  // What opens can be written, what is written opens, and gives the same bytes when written.
  // Layers that were not loaded are written empty. The one selection that cannot live with that is
  // RBF behavior without the learned behavior of the file, and it is refused.
  void write(const MienDna* dna) {
    constexpr uint32_t kBoth = MIEN_LAYER_RBF_BEHAVIOR | MIEN_LAYER_MACHINE_LEARNED_BEHAVIOR;
    size_t size = 0;
    if ((layers_ & kBoth) == MIEN_LAYER_RBF_BEHAVIOR &&
        mien_dna_write_memory(dna, nullptr, nullptr, 0, &size, nullptr) == MIEN_ERROR_DNA_LAYER) {
      return;
    }
    const std::vector<uint8_t> first = write_bytes(dna);
    MienStatus status = MIEN_OK;
    MienDna* copy = open(first.data(), first.size(), 0, status);
    if (!copy) return broke("the written file does not open: %s", life_.message.c_str());
    if (write_bytes(copy) != first) broke("written twice, but with other bytes");
    mien_dna_close(copy);
    write_as(dna, 1 + options_.control_seed % 8, options_.control_seed / 8 % 2);
  }

  // A version that leaves something out: either the call refuses, or the file opens and is complete.
  void write_as(const MienDna* dna, uint32_t version, uint32_t unknown_layers) {
    MienWriteDesc desc = {};
    desc.struct_size = sizeof(desc);
    desc.version = version;
    desc.unknown_layers = unknown_layers;
    MienError error = {};
    error.struct_size = sizeof(error);
    size_t size = 0;
    MienStatus status = mien_dna_write_memory(dna, &desc, nullptr, 0, &size, &error);
    if (status != MIEN_OK) return check_failure("writing", status, error, size_);
    std::vector<uint8_t> bytes(size);
    if (mien_dna_write_memory(dna, &desc, bytes.data(), size, &size, &error) != MIEN_OK ||
        size != bytes.size()) {
      broke("measured for 2.%u, but not written: %s", version, error.message);
    }
    MienDna* copy = open(bytes.data(), size, 0, status);
    if (!copy) {
      broke("as 2.%u, unknown layers %u: the file does not open: %s", version, unknown_layers,
            life_.message.c_str());
    }
    mien_dna_close(copy);
  }

  // A report has errors exactly if opening or compiling refuses the file.
  void validate() {
    MienError error = {};
    error.struct_size = sizeof(error);
    MienReport* report = nullptr;
    const size_t before = counter_.bytes;
    counter_.restart();
    const auto desc = desc_with<MienValidateDesc>(&allocator_);
    const MienStatus status = mien_dna_validate_memory(bytes_, size_, &desc, &report, &error);
    life_.report_peak = counter_.peak - before;
    if (status != MIEN_OK) return broke("no report: %d %s", status, error.message);
    uint32_t errors = 0, warnings = 0;
    if (mien_report_counts(report, &errors, &warnings) != MIEN_OK) broke("no counts");
    for (uint32_t i = 0; i < errors + warnings; ++i) {
      MienFinding finding = {};
      finding.struct_size = sizeof(finding);
      if (mien_report_finding(report, i, &finding) != MIEN_OK) broke("no finding %u", i);
      if (finding.message.count == 0) broke("finding %u says nothing", i);
      if (finding.byte_offset != MIEN_NO_OFFSET && finding.byte_offset > size_) {
        broke("finding %u lies at %llu of %zu", i,
              static_cast<unsigned long long>(finding.byte_offset), size_);
      }
    }
    mien_report_destroy(report);
    const bool whole = options_.layers == 0 && !options_.skip_targets && options_.lods == 0 &&
                       options_.system == nullptr;
    const bool complete = errors + warnings < 1000;
    const bool refused = life_.opened != MIEN_OK || life_.compiled != MIEN_OK;
    if (whole && complete && refused != (errors != 0)) {
      broke("%u errors in the report, opening gave %d, compiling %d: %s", errors, life_.opened,
            life_.compiled, life_.message.c_str());
    }
  }

  const uint8_t* bytes_;
  size_t size_;
  LifeOptions options_;
  CountingAllocator counter_;
  MienAllocator allocator_;
  Life life_;
  uint32_t layers_ = 0;  // that were loaded
  bool only_correctives_ = false;
  uint32_t state_ = 1;
  volatile float sink_ = 0;
};

inline Life live(const uint8_t* bytes, size_t size, const LifeOptions& options = {}) {
  return ExerciseDna(bytes, size, options).run();
}

}  // namespace mien
