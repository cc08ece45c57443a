// SPDX-License-Identifier: MIT
// Rigs that have to give the same bits (docs/numbers.md): of several instruction sets of a family,
// keeping results or not, alone or in a batch, compiled or baked. They get the same random frames, and
// are compared after each. Used by tests and by the fuzzers, so without GoogleTest.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "capi/include/mien.h"
#include "tests/support/descs.h"

namespace mien {

class RigTwins {
 public:
  explicit RigTwins(uint32_t seed) : state_(seed * 2654435761u + 1) {}
  ~RigTwins() {
    for (const Twin& twin : twins_) {
      mien_deformer_instance_destroy(twin.pose);
      mien_deformer_destroy(twin.deformer);
      mien_instance_destroy(twin.instance);
    }
    for (MienInstance* other : others_) mien_instance_destroy(other);
    mien_batch_destroy(batch_);
    for (const Twin& twin : twins_) mien_rig_destroy(twin.rig);
  }
  RigTwins(const RigTwins&) = delete;
  RigTwins& operator=(const RigTwins&) = delete;

  uint32_t draw(uint32_t end) {
    state_ = state_ * 1664525u + 1013904223u;
    return (state_ >> 8) % end;
  }

  /// One of those of this machine whose results have the same bits as those of the first call;
  /// any of them with portable arithmetic.
  uint32_t draw_isa(bool portable) {
    constexpr uint32_t kPlain[] = {MIEN_ISA_SCALAR, MIEN_ISA_SSE2};
    constexpr uint32_t kFused[] = {MIEN_ISA_AVX2, MIEN_ISA_AVX512, MIEN_ISA_NEON};
    std::vector<uint32_t> present;
    if (family_ == kUnknown) {
      family_ = portable ? kAny : draw(3) == 0 ? kPlainFamily : kFusedFamily;
    }
    if (family_ != kPlainFamily) add_available(kFused, 3, present);
    if (family_ != kFusedFamily || present.empty()) add_available(kPlain, 2, present);
    return present[draw(static_cast<uint32_t>(present.size()))];
  }

  /// Takes over the rig and its deformer, or none.
  void add(const char* what, MienRig* rig, MienDeformer* deformer, bool in_batch = false) {
    Twin twin = {what, rig, deformer, nullptr, nullptr, in_batch, {}, {}};
    bool made = mien_instance_create(rig, nullptr, &twin.instance, nullptr) == MIEN_OK;
    if (deformer) {
      made &= mien_deformer_instance_create(deformer, nullptr, &twin.pose, nullptr) == MIEN_OK;
    }
    if (in_batch) {
      const MienBatchDesc desc = batch_desc(kOthers + 1, 1);
      made &= mien_batch_create(rig, &desc, &batch_, nullptr) == MIEN_OK;
      for (uint32_t i = 0; made && i < kOthers; ++i) {
        others_.push_back(nullptr);
        made &= mien_instance_create(rig, nullptr, &others_.back(), nullptr) == MIEN_OK;
      }
    }
    if (!made) differ(twin, "no memory");
    twins_.push_back(twin);
  }

  /// "" if all agree, else the first difference.
  const std::string& compare(uint32_t frames) {
    MienRigInfo info = sized<MienRigInfo>();
    if (twins_.empty() || mien_rig_info(twins_[0].rig, &info) != MIEN_OK) return broken_;
    (void)mien_rig_count(twins_[0].rig, MIEN_KIND_MESH, &mesh_count_);
    for (Twin& twin : twins_) {
      if (mien_instance_raw_controls(twin.instance, &twin.raw) != MIEN_OK ||
          mien_instance_gui_controls(twin.instance, &twin.gui) != MIEN_OK) {
        differ(twin, "no controls");
      }
    }
    for (uint32_t f = 0; f < frames && broken_.empty(); ++f) {
      act();
      evaluate(info.lod_count);
    }
    return broken_;
  }

 private:
  struct Twin {
    const char* what;
    MienRig* rig;
    MienDeformer* deformer;
    MienInstance* instance;
    MienDeformerInstance* pose;
    bool in_batch;
    MienMutableFloatView raw, gui;
  };
  enum Family { kUnknown, kAny, kPlainFamily, kFusedFamily };
  static constexpr uint32_t kOthers = 3;

  static void add_available(const uint32_t* isas, uint32_t count, std::vector<uint32_t>& out) {
    std::copy_if(isas, isas + count, std::back_inserter(out),
                 [](uint32_t isa) { return mien_isa_available(isa); });
  }

  void differ(const Twin& twin, const std::string& how) {
    if (broken_.empty()) broken_ = std::string(twin.what) + ": " + how;
  }

  float draw_value() {
    constexpr float kValues[] = {0, 0, 0, -0.0f, 1, 0.5f, 0.25f, 1.5f, -0.5f};
    return draw(4) ? kValues[draw(9)] : static_cast<float>(draw(1400)) / 1000.0f - 0.2f;
  }

  /// What a caller does between frames, for all alike.
  void act() {
    Twin& first = twins_[0];
    const auto raw_count = static_cast<uint32_t>(first.raw.count);
    switch (draw(8)) {
      case 0:
        for (Twin& twin : twins_) {
          if (mien_instance_reset(twin.instance) != MIEN_OK) differ(twin, "no reset");
        }
        break;
      case 1:
        for (size_t i = 0; i < first.gui.count; ++i) {
          first.gui.data[i] = draw_value();
          for (Twin& twin : twins_) twin.gui.data[i] = first.gui.data[i];
        }
        for (Twin& twin : twins_) {
          if (mien_rig_map_gui_to_raw(twin.rig, twin.instance) != MIEN_OK) differ(twin, "no map");
        }
        break;
      case 2:
      case 3:
        for (uint32_t i = 0; i < raw_count; ++i) first.raw.data[i] = draw_value();
        break;
      default:
        for (uint32_t i = 0, n = draw(4); i < n && raw_count; ++i) {
          first.raw.data[draw(raw_count)] = draw_value();
        }
    }
    for (Twin& twin : twins_) {
      if (twin.raw.count != raw_count) return differ(twin, "other controls");
      if (&twin != &first && raw_count) {
        memcpy(twin.raw.data, first.raw.data, raw_count * sizeof(float));
      }
    }
  }

  void evaluate(uint32_t lod_count) {
    const uint32_t lod = lod_count && draw(3) == 0 ? draw(lod_count) : 0;
    const uint32_t stages = draw(3) ? uint32_t{MIEN_STAGE_ALL} : draw(64);
    const MienStatus expected =
        mien_rig_evaluate_stages(twins_[0].rig, twins_[0].instance, lod, stages);
    for (Twin& twin : twins_) {
      MienStatus status = expected;
      if (twin.in_batch) {
        status = evaluate_batch(twin, lod, lod_count, stages);
      } else if (&twin != &twins_[0]) {
        status = mien_rig_evaluate_stages(twin.rig, twin.instance, lod, stages);
      }
      if (status != expected) differ(twin, "another status");
      if (broken_.empty()) compare_results(twin);
    }
    const bool deform = std::all_of(twins_.begin(), twins_.end(),
                                    [](const Twin& twin) { return twin.pose != nullptr; });
    for (uint32_t m = 0; deform && m < mesh_count_ && m < 4 && broken_.empty(); ++m) {
      const uint32_t normals = 1 + draw(MIEN_NORMALS_RECOMPUTED);
      for (Twin& twin : twins_) compare_mesh(twin, m, normals);
    }
  }

  MienStatus evaluate_batch(Twin& twin, uint32_t lod, uint32_t lod_count, uint32_t stages) {
    MienInstance* instances[kOthers + 1];
    uint32_t lods[kOthers + 1], count = 0;
    const uint32_t place = draw(kOthers + 1);
    for (MienInstance* other : others_) {
      if (count == place) {
        instances[count] = twin.instance;
        lods[count++] = lod;
      }
      MienMutableFloatView raw = {};
      (void)mien_instance_raw_controls(other, &raw);
      if (draw(2)) {
        for (size_t i = 0; i < raw.count; ++i) raw.data[i] = draw_value();
      }
      instances[count] = other;
      lods[count++] = lod_count && draw(2) ? draw(lod_count) : lod;
    }
    if (count == place) {
      instances[count] = twin.instance;
      lods[count++] = lod;
    }
    return mien_rig_evaluate_batch(twin.rig, batch_, instances, lods, count, stages, nullptr);
  }

  /// The bits of a NaN are not promised.
  void compare_views(const Twin& twin, const char* name, const MienFloatView& a,
                     const MienFloatView& b) {
    if (a.count != b.count) return differ(twin, std::string("other counts of ") + name);
    if (a.count == 0 || memcmp(a.data, b.data, a.count * sizeof(float)) == 0) return;
    for (size_t i = 0; i < a.count; ++i) {
      if (memcmp(&a.data[i], &b.data[i], sizeof(float)) == 0) continue;
      if (std::isnan(a.data[i]) && std::isnan(b.data[i])) continue;
      char text[160];
      snprintf(text, sizeof(text), "%s[%zu] is %.9g, of the %s %.9g", name, i,
               static_cast<double>(b.data[i]), twins_[0].what, static_cast<double>(a.data[i]));
      return differ(twin, text);
    }
  }

  void compare_results(const Twin& twin) {
    constexpr struct {
      const char* name;
      MienStatus (*view)(const MienInstance*, MienFloatView*);
    } kViews[] = {{"controls", mien_instance_controls},
                  {"joints", mien_instance_joints},
                  {"blend shapes", mien_instance_blend_shapes},
                  {"animated maps", mien_instance_animated_maps}};
    for (const auto& output : kViews) {
      MienFloatView a = {}, b = {};
      if (output.view(twins_[0].instance, &a) != MIEN_OK ||
          output.view(twin.instance, &b) != MIEN_OK) {
        return differ(twin, "no results");
      }
      compare_views(twin, output.name, a, b);
    }
  }

  void compare_mesh(const Twin& twin, uint32_t mesh, uint32_t normals) {
    if (mien_deformer_instance_update(twin.pose, twin.instance) != MIEN_OK ||
        mien_deformer_instance_deform(twin.pose, mesh, normals, nullptr) != MIEN_OK) {
      return differ(twin, "not deformed");
    }
    MienFloatView a = {}, b = {};
    if (mien_deformer_instance_positions(twins_[0].pose, mesh, &a) != MIEN_OK ||
        mien_deformer_instance_positions(twin.pose, mesh, &b) != MIEN_OK) {
      return differ(twin, "no positions");
    }
    compare_views(twin, "positions", a, b);
    if (mien_deformer_instance_normals(twins_[0].pose, mesh, &a) != MIEN_OK ||
        mien_deformer_instance_normals(twin.pose, mesh, &b) != MIEN_OK) {
      return differ(twin, "no normals");
    }
    compare_views(twin, "normals", a, b);
  }

  uint32_t state_;
  Family family_ = kUnknown;
  std::vector<Twin> twins_;
  std::vector<MienInstance*> others_;
  MienBatch* batch_ = nullptr;
  uint32_t mesh_count_ = 0;
  std::string broken_;
};

}  // namespace mien
