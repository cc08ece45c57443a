// SPDX-License-Identifier: MIT
// Controls by the names that people give them.
#pragma once

#include <mien.h>

#include <map>
#include <string>

namespace mien::gltf {

/// Names are equal without regard to case, `.` and `_` being equal, with or without what stands
/// before the control's last `.`: "jawopen" is "CTRL_expressions.jawOpen". Of equal names whole
/// ones go before such parts, then the first counts.
class ControlNames {
 public:
  /// `kind` is MIEN_KIND_...; the names are copied.
  ControlNames(const MienRig* rig, uint32_t kind);

  bool find(const std::string& name, uint32_t& index) const;

 private:
  std::map<std::string, uint32_t> known_;
};

}  // namespace mien::gltf
