// SPDX-License-Identifier: MIT
// Handles of the library as owners, and its structs with their size set.
#pragma once

#include <mien.h>

#include <memory>
#include <string>

namespace mien::cli {

/// A struct of the library, zeroed, with its size set.
template <class T>
T sized() {
  T value{};
  value.struct_size = sizeof(T);
  return value;
}

template <class T, void (*destroy)(T*)>
struct Destroy {
  void operator()(T* handle) const { destroy(handle); }
};
using Dna = std::unique_ptr<MienDna, Destroy<MienDna, mien_dna_close>>;
using Rig = std::unique_ptr<MienRig, Destroy<MienRig, mien_rig_destroy>>;
using Instance = std::unique_ptr<MienInstance, Destroy<MienInstance, mien_instance_destroy>>;
using Batch = std::unique_ptr<MienBatch, Destroy<MienBatch, mien_batch_destroy>>;
using Deformer = std::unique_ptr<MienDeformer, Destroy<MienDeformer, mien_deformer_destroy>>;
using DeformerInstance =
    std::unique_ptr<MienDeformerInstance,
                    Destroy<MienDeformerInstance, mien_deformer_instance_destroy>>;
using Baked = std::unique_ptr<MienBaked, Destroy<MienBaked, mien_baked_close>>;
using Clip = std::unique_ptr<MienClip, Destroy<MienClip, mien_clip_close>>;
using Report = std::unique_ptr<MienReport, Destroy<MienReport, mien_report_destroy>>;

inline std::string to_string(MienStringView view) { return std::string(view.data, view.count); }

}  // namespace mien::cli
