// SPDX-License-Identifier: MIT
// Baked files in memory, and what is made of them.
#pragma once

#include <cstddef>
#include <vector>

#include "runtime/baked/baked_objects.h"
#include "tests/support/deform_rig.h"
#include "tests/support/exercise_baked.h"
#include "tests/support/rig_handles.h"
#include "tests/support/tiny_rig.h"

namespace mien {

struct CloseBaked {
  void operator()(MienBaked* baked) const { mien_baked_close(baked); }
};
using BakedHandle = std::unique_ptr<MienBaked, CloseBaked>;

inline std::vector<uint8_t> bake(const MienRig* rig, const MienDeformer* deformer = nullptr) {
  size_t size = 0;
  EXPECT_EQ(mien_bake_memory(rig, deformer, nullptr, 0, &size, nullptr), MIEN_OK);
  std::vector<uint8_t> bytes(size);
  EXPECT_EQ(mien_bake_memory(rig, deformer, bytes.data(), size, &size, nullptr), MIEN_OK);
  return bytes;
}

inline BakedHandle open_baked(const AlignedBytes& bytes, uint32_t check = MIEN_BAKED_CHECK_FULL,
                              MienStatus expected = MIEN_OK) {
  MienBakedDesc desc = sized<MienBakedDesc>();
  desc.check = check;
  MienError error = sized<MienError>();
  MienBaked* baked = nullptr;
  EXPECT_EQ(mien_baked_open_memory(bytes.data(), bytes.size(), &desc, &baked, &error), expected)
      << error.message;
  return BakedHandle(baked);
}

inline RigHandle rig_of(const BakedHandle& baked, uint32_t isa = MIEN_ISA_ENVIRONMENT,
                        MienStatus expected = MIEN_OK) {
  MienBakedRigDesc desc = sized<MienBakedRigDesc>();
  desc.isa = isa;
  MienError error = sized<MienError>();
  MienRig* rig = nullptr;
  EXPECT_EQ(mien_rig_from_baked(baked.get(), &desc, &rig, &error), expected) << error.message;
  return RigHandle(rig);
}

inline DeformerHandle deformer_of(const BakedHandle& baked, const RigHandle& rig,
                                  uint32_t isa = MIEN_ISA_BEST, MienStatus expected = MIEN_OK) {
  MienBakedDeformerDesc desc = sized<MienBakedDeformerDesc>();
  desc.isa = isa;
  MienError error = sized<MienError>();
  MienDeformer* deformer = nullptr;
  EXPECT_EQ(mien_deformer_from_baked(baked.get(), rig.get(), &desc, &deformer, &error), expected)
      << error.message;
  return DeformerHandle(deformer);
}

/// A file, and where its objects have their arrays: in the file, so that tests can change them.
struct OpenBaked {
  AlignedBytes bytes;
  BakedHandle baked;
  RigHandle rig;
  DeformerHandle deformer;  // if there is one

  explicit OpenBaked(const std::vector<uint8_t>& file)
      : bytes(file), baked(open_baked(bytes)), rig(rig_of(baked)) {
    if (reinterpret_cast<const Baked*>(baked.get())->deformer) deformer = deformer_of(baked, rig);
  }
  const Rig& arrays() const { return *reinterpret_cast<const Rig*>(rig.get()); }
  const DeformMesh& mesh(size_t m) const { return deformer_arrays().meshes[m]; }
  const Deformer& deformer_arrays() const {
    return *reinterpret_cast<const Deformer*>(deformer.get());
  }

  /// Opened, and used if it could be, with `value` instead; the change is undone.
  template <class T>
  MienStatus status_with(const Span<T>& array, size_t i, uint64_t value,
                         uint32_t isa = MIEN_ISA_ENVIRONMENT) {
    const T kept = array[i];
    array[i] = static_cast<T>(value);
    const ExerciseBaked life = exercise_baked(bytes.data(), bytes.size(), isa);
    array[i] = kept;
    EXPECT_EQ(life.broken, "") << i << " is " << value;
    return life.opened;
  }
  /// The same for a field of a record.
  template <class T>
  MienStatus status_with(T& field, uint64_t value) {
    return status_with(Span<T>{&field, 1}, 0, value);
  }
  /// With every change so far, and the checksum that belongs to it.
  void seal() {
    const uint64_t checksum = baked_checksum(bytes.data(), bytes.size());
    memcpy(bytes.data() + offsetof(BakedHeader, checksum), &checksum, sizeof(checksum));
  }
};

/// The tiny rig, with every layer.
inline std::vector<uint8_t> tiny_baked() {
  Arena arena(default_allocator());
  return bake(create_rig(open_dna(write_view(dna::tiny_rig(arena))).get()).get());
}

}  // namespace mien
