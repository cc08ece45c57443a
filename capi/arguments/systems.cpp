// SPDX-License-Identifier: MIT
#include "capi/arguments/systems.h"

namespace mien::capi {

MienStatus read_system(const MienCoordinateSystem* in, CoordinateSystem& out, MienError* error) {
  MienCoordinateSystem known;
  if (MienStatus status = read_desc(in, known, "MienCoordinateSystem", error)) return status;
  for (int i = 0; i < 3; ++i) {
    out.axes[i] = known.axes[i];
    out.rotation_signs[i] = known.rotation_signs[i];
    if (known.rotation_signs[i] < -1 || known.rotation_signs[i] > 1) {
      return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                        "MienCoordinateSystem.rotation_signs[%d] is %d; valid values are -1 to 1",
                        i, known.rotation_signs[i]);
    }
  }
  if (!spans_space(out.axes)) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MienCoordinateSystem.axes %u, %u, %u do not span space: one of them is left "
                      "or right, one up or down, one front or back",
                      out.axes[0], out.axes[1], out.axes[2]);
  }
  const MienStatus in_range = check_fields(
      {{"MienCoordinateSystem.translation_unit", known.translation_unit,
        MIEN_TRANSLATION_UNIT_METERS},
       {"MienCoordinateSystem.rotation_unit", known.rotation_unit, MIEN_ROTATION_UNIT_RADIANS},
       {"MienCoordinateSystem.rotation_rule", known.rotation_rule, MIEN_ROTATION_RULE_PER_COLUMN},
       {"MienCoordinateSystem.rotation_sequence", known.rotation_sequence,
        MIEN_ROTATION_SEQUENCE_ZYX},
       {"MienCoordinateSystem.face_winding", known.face_winding, MIEN_FACE_WINDING_INWARD},
       {"MienCoordinateSystem.reserved", known.reserved, 0}},
      error);
  if (in_range != MIEN_OK) return in_range;
  out.translation_unit = known.translation_unit;
  out.rotation_unit = known.rotation_unit;
  out.rotation_rule = static_cast<RotationRule>(known.rotation_rule);
  out.rotation_sequence = known.rotation_sequence;
  out.face_winding = known.face_winding;
  return MIEN_OK;
}

}  // namespace mien::capi
