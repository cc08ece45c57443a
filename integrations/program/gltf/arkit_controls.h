// SPDX-License-Identifier: MIT
// The 52 ARKit expressions on the raw controls of a rig.
//
// A control of the name of an expression (as control_names.h finds it) is that expression. For an
// expression without one, a table by meaning gives the raw controls of heads that name them in the
// other usual way ("eyeBlinkL" for eyeBlinkLeft); all of them have to be there.
#pragma once

#include "integrations/program/gltf/rig_source.h"

namespace mien::gltf {

constexpr size_t kArkitCount = 52;

/// In the order of the ARKit documentation.
extern const char* const kArkitNames[kArkitCount];

/// mien_arkit_matrix().
std::vector<MienMatrixEntry> arkit_matrix();

struct ControlWeight {
  uint32_t control;  // raw
  float weight;
};

struct ArkitControls {
  std::vector<ControlWeight> controls[kArkitCount];
  /// Every expression is a control of its name, so that values of controls are weights of
  /// expressions.
  bool by_name = true;
};

// Numbers of two of them that belong together, see arkit_bake.h.
constexpr size_t kJawOpen = 17, kMouthClose = 18;

using ArkitWeights = std::array<float, kArkitCount>;

/// Throws ExportError that names what the rig lacks.
ArkitControls find_arkit_controls(const RigSource& source);

}  // namespace mien::gltf
