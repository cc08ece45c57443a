// SPDX-License-Identifier: MIT
// An authored rig as the library runs it, and how far from its shapes it ends.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "author/mesh/author_mesh.h"
#include "tests/support/deform_rig.h"
#include "tests/support/rig_handles.h"

namespace mien::author {

/// How many errors and warnings `mien validate` would show.
inline uint32_t findings(const std::vector<uint8_t>& bytes) {
  MienReport* report = nullptr;
  EXPECT_EQ(mien_dna_validate_memory(bytes.data(), bytes.size(), nullptr, &report, nullptr),
            MIEN_OK);
  uint32_t errors = 0, warnings = 0;
  EXPECT_EQ(mien_report_counts(report, &errors, &warnings), MIEN_OK);
  mien_report_destroy(report);
  return errors + warnings;
}

/// A rig as the library runs it.
struct Played {
  DnaHandle dna;
  RigHandle rig;
  Character character;
  DeformerHandle deformer;
  DeformerInstanceHandle instance;

  explicit Played(const std::vector<uint8_t>& bytes, uint32_t isa = MIEN_ISA_ENVIRONMENT)
      : dna(open_dna(bytes)), rig(create_rig(dna.get(), isa)), character(rig),
        deformer(create_deformer(dna.get(), rig.get())),
        instance(create_deformer_instance(deformer.get())) {}

  void set(uint32_t control) {
    for (float& value : character.raw) value = 0;
    if (control < character.raw.count) character.raw[control] = 1;
  }
  std::vector<Vec3> deform(uint32_t lod) {
    character.evaluate(lod);
    EXPECT_EQ(mien_deformer_instance_update(instance.get(), character.instance.get()), MIEN_OK);
    return positions(lod);
  }
  /// As the joints of the deformer are.
  std::vector<Vec3> positions(uint32_t lod) {
    EXPECT_EQ(mien_deformer_instance_deform(instance.get(), lod, MIEN_NORMALS_NONE, nullptr),
              MIEN_OK);
    MienFloatView view = {};
    EXPECT_EQ(mien_deformer_instance_positions(instance.get(), lod, &view), MIEN_OK);
    std::vector<Vec3> out(view.count / 3);
    for (size_t v = 0; v < out.size(); ++v) {
      out[v] = {double{view.data[3 * v]}, double{view.data[3 * v + 1]},
                double{view.data[3 * v + 2]}};
    }
    return out;
  }
  /// `vertices`: which of the head's the LOD has; empty: all.
  double error(const AuthorMesh& head, uint32_t lod, double* max = nullptr,
               Span<const uint32_t> vertices = {}) {
    double squares = 0, energy = 0, longest = 0;
    for (uint32_t s = 0; s < head.shapes.count; ++s) {
      set(s);
      const std::vector<Vec3> points = deform(lod);
      for (size_t i = 0; i < points.size(); ++i) {
        const size_t v = vertices.empty() ? i : vertices[i];
        const Vec3f f = head.shapes[s].displacements[v];
        const Vec3 d = {double{f.x}, double{f.y}, double{f.z}};
        const Vec3 rest = head.frame.to_internal(points[i]) - head.positions[v] - d;
        squares += dot(rest, rest);
        energy += dot(d, d);
        longest = std::max(longest, length(rest));
      }
    }
    if (max) *max = longest / head.diagonal;
    return std::sqrt(squares / energy);
  }
};

}  // namespace mien::author
