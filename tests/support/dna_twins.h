// SPDX-License-Identifier: MIT
// What is made of an open DNA file in several ways gives the same bits (rig_twins.h): compiled, baked and
// opened again, written and opened again.
#pragma once

#include <string>
#include <vector>

#include "tests/support/rig_twins.h"

namespace mien {

class DnaTwins {
 public:
  DnaTwins(const MienDna* dna, uint32_t seed) : dna_(dna), twins_(seed) {}

  /// "" if all agree, else the first difference.
  std::string run() {
    MienRigDesc desc = sized<MienRigDesc>();
    desc.rotation_output = twins_.draw(2);
    desc.ml_masks = twins_.draw(2);
    desc.storage = twins_.draw(4) == 0 ? MIEN_STORAGE_16_BIT : MIEN_STORAGE_32_BIT;
    desc.arithmetic = twins_.draw(2);
    // Deformers of different families differ.
    with_deformer_ = desc.arithmetic == MIEN_ARITHMETIC_FAST && twins_.draw(2) != 0;
    desc.reuse = MIEN_REUSE_NOTHING;
    const MienStatus expected = add("rig that keeps nothing", dna_, desc, false);
    if (expected != MIEN_OK) return "";  // the other numbers of a rig may be too large for a limit
    desc.reuse = MIEN_REUSE_UNCHANGED;
    if (add("rig", dna_, desc, false) != MIEN_OK) return "a rig that keeps results is refused";
    if (add("batch", dna_, desc, true) != MIEN_OK) return "a rig of a batch is refused";
    const std::string written = add_written(desc);
    if (!written.empty()) return written;
    return broken_.empty() ? twins_.compare(6) : broken_;
  }

 private:
  MienStatus add(const char* what, const MienDna* dna, MienRigDesc desc, bool in_batch) {
    desc.isa = twins_.draw_isa(desc.arithmetic == MIEN_ARITHMETIC_PORTABLE);
    MienRig* rig = nullptr;
    MienDeformer* deformer = nullptr;
    const MienStatus status = mien_rig_create(dna, &desc, &rig, nullptr);
    if (status != MIEN_OK) return status;
    if (with_deformer_ && mien_deformer_create(dna, rig, nullptr, &deformer, nullptr) != MIEN_OK) {
      with_deformer_ = false;
    }
    if (in_batch) bake(rig, deformer, desc);
    twins_.add(what, rig, deformer, in_batch);
    return MIEN_OK;
  }

  void bake(const MienRig* rig, const MienDeformer* deformer, const MienRigDesc& desc) {
    size_t size = 0;
    if (mien_bake_memory(rig, deformer, nullptr, 0, &size, nullptr) != MIEN_OK) {
      broken_ = "not baked";
      return;
    }
    std::vector<uint8_t> bytes(size);
    MienError error = sized<MienError>();
    MienBaked* baked = nullptr;
    MienBakedDesc baked_desc = sized<MienBakedDesc>();
    baked_desc.file_access = MIEN_FILE_READ;
    baked_desc.check = twins_.draw(2) ? MIEN_BAKED_CHECK_FULL : MIEN_BAKED_CHECK_SAFE;
    MienBakedRigDesc rig_desc = sized<MienBakedRigDesc>();
    rig_desc.isa = twins_.draw_isa(desc.arithmetic == MIEN_ARITHMETIC_PORTABLE);
    MienRig* opened = nullptr;
    MienDeformer* opened_deformer = nullptr;
    bool good =
        mien_bake_memory(rig, deformer, bytes.data(), size, &size, &error) == MIEN_OK &&
        mien_baked_open_memory(bytes.data(), size, &baked_desc, &baked, &error) == MIEN_OK &&
        mien_rig_from_baked(baked, &rig_desc, &opened, &error) == MIEN_OK;
    if (good && deformer) {
      good = mien_deformer_from_baked(baked, opened, nullptr, &opened_deformer, &error) == MIEN_OK;
    }
    mien_baked_close(baked);
    if (!good) broken_ = std::string("what was baked does not open: ") + error.message;
    if (opened) twins_.add("baked rig", opened, opened_deformer);
  }

  std::string add_written(const MienRigDesc& desc) {
    size_t size = 0;
    if (mien_dna_write_memory(dna_, nullptr, nullptr, 0, &size, nullptr) != MIEN_OK) return "";
    std::vector<uint8_t> bytes(size);
    MienDna* copy = nullptr;
    if (mien_dna_write_memory(dna_, nullptr, bytes.data(), size, &size, nullptr) != MIEN_OK ||
        mien_dna_open_memory(bytes.data(), size, nullptr, &copy, nullptr) != MIEN_OK) {
      return "the written file does not open";
    }
    const MienStatus status = add("rig of the written file", copy, desc, false);
    mien_dna_close(copy);
    return status == MIEN_OK ? "" : "the rig of the written file is refused";
  }

  const MienDna* dna_;
  RigTwins twins_;
  bool with_deformer_ = false;
  std::string broken_;
};

inline std::string compare_dna_twins(const MienDna* dna, uint32_t seed) {
  return DnaTwins(dna, seed).run();
}

}  // namespace mien
