// SPDX-License-Identifier: MIT
// Controls by the names that people give them.
#pragma once

#include <mien.h>

#include <map>
#include <string>

namespace mien::gltf {

/// Names are equal without regard to case, `.` and `_` being equal, with or without what stands
/// before the control's last `.`: "jawopen" is "CTRL_expressions.jawOpen". Of equal names whole
/// ones go before such parts, then the first counts. A name without such an equal matches one that spells the
/// same words in another usual way, if there is only one: mouthSmileLeft, mouthSmile_L, mouth_smile_l.
class ControlNames {
 public:
  /// `kind` is MIEN_KIND_...; the names are copied.
  ControlNames(const MienRig* rig, uint32_t kind);

  bool find(const std::string& name, uint32_t& index) const;

 private:
  std::map<std::string, uint32_t> known_, spellings_;
};

}  // namespace mien::gltf
