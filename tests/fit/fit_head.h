// SPDX-License-Identifier: MIT
// A generated head to solve, and fits that release themselves.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "capi/include/mien_solve.h"
#include "tests/support/deform_rig.h"
#include "tests/support/plain_rig.h"

namespace mien {

struct DestroyFit {
  void operator()(MienFit* fit) const { mien_fit_destroy(fit); }
};
using FitHandle = std::unique_ptr<MienFit, DestroyFit>;

inline FitHandle create_fit(const RigHandle& rig, const MienFitDesc& desc,
                            MienStatus expected = MIEN_OK) {
  MienFit* made = nullptr;
  MienError error = sized<MienError>();
  EXPECT_EQ(mien_fit_create(rig.get(), &desc, &made, &error), expected) << error.message;
  return FitHandle(made);
}

struct DestroySurface {
  void operator()(MienFitSurface* surface) const { mien_fit_surface_destroy(surface); }
};
using SurfaceHandle = std::unique_ptr<MienFitSurface, DestroySurface>;

inline SurfaceHandle create_surface(const std::vector<float>& positions,
                                    const std::vector<uint32_t>& triangles,
                                    MienStatus expected = MIEN_OK,
                                    const MienAllocator* memory = nullptr) {
  MienFitSurfaceDesc desc = mien_fit_surface_desc_default();
  desc.positions = positions.data();
  desc.position_count = positions.size() / 3;
  desc.triangles = triangles.data();
  desc.triangle_count = triangles.size() / 3;
  desc.allocator = memory;
  MienFitSurface* made = nullptr;
  MienError error = sized<MienError>();
  EXPECT_EQ(mien_fit_surface_create(&desc, &made, &error), expected) << error.message;
  return SurfaceHandle(made);
}

/// A generated head of medium size, with its deformer, and a pose of some controls.
struct Head {
  DnaHandle dna;
  RigHandle rig;
  DeformerHandle deformer;
  DeformerInstanceHandle deformed;
  Character character;
  std::vector<float> observed;

  explicit Head(uint32_t preset = MIEN_PRESET_HEAD) : Head(generate_dna(preset, 3)) {}
  explicit Head(DnaHandle opened)
      : dna(std::move(opened)), rig(create_rig(dna.get())),
        deformer(create_deformer(dna.get(), rig.get())),
        deformed(create_deformer_instance(deformer.get())), character(rig) {}

  std::vector<float> pose(Random& random, uint32_t count) {
    std::vector<float> raw(character.raw.count);
    for (uint32_t i = 0; i < count; ++i) {
      raw[random.below(static_cast<uint32_t>(raw.size()))] =
          static_cast<float>(random.between(0.1, 1));
    }
    return raw;
  }
  std::vector<float> joints(const std::vector<float>& raw) {
    evaluate(raw);
    return {character.joints.begin(), character.joints.end()};
  }
  void evaluate(const std::vector<float>& raw) {
    std::copy(raw.begin(), raw.end(), character.raw.begin());
    character.evaluate(0);
  }
  std::vector<float> positions(const std::vector<float>& raw) {
    evaluate(raw);
    EXPECT_EQ(mien_deformer_instance_update(deformed.get(), character.instance.get()), MIEN_OK);
    EXPECT_EQ(mien_deformer_instance_deform(deformed.get(), 0, MIEN_NORMALS_NONE, nullptr),
              MIEN_OK);
    const Span<const float> all = Deformed::positions(deformed.get(), 0);
    return {all.begin(), all.begin() + mesh_of(deformer.get(), 0).position_count * 3};
  }
};

inline std::vector<MienSolvePoint> every(uint32_t count, uint32_t step) {
  std::vector<MienSolvePoint> points;
  for (uint32_t i = 0; i < count; i += step) points.push_back({0, {i, i, i}, {1, 0, 0}});
  return points;
}

/// All controls may move.
inline FitHandle create_point_fit(const Head& head, const std::vector<MienSolvePoint>& points) {
  MienFitDesc desc = sized<MienFitDesc>();
  desc.deformer = head.deformer.get();
  desc.points = points.data();
  desc.point_count = points.size();
  return create_fit(head.rig, desc);
}

}  // namespace mien
