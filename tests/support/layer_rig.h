// SPDX-License-Identifier: MIT
// A LayerRig as a DNA file for the library, and a DNA file as a LayerRig.
#pragma once

#include "integrations/program/model/layer_rig.h"
#include "tests/support/plain_rig.h"

namespace mien {

/// Lists and arrays lie in `arena`.
dna::DnaView to_view(const LayerRig& rig, Arena& arena);

/// Opened with all checks. The handle of the file keeps nothing of the rig.
struct LayerFile {
  explicit LayerFile(const LayerRig& rig);
  std::vector<uint8_t> bytes;
  DnaHandle dna;
};

/// The behavior of any file, for the model; `rig` was made of it.
LayerRig read_layer_rig(const dna::DnaView& view, const RigHandle& rig);

/// A row of random raw controls, with every quaternion of `quaternions` (first control) of
/// length 1.
std::vector<float> random_raw(const LayerRig& rig, const std::vector<uint16_t>& quaternions,
                              Random& random);

}  // namespace mien
