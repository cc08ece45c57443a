// SPDX-License-Identifier: MIT
// mien/base.h.
#include "capi/handles.h"
#include "runtime/base/coordinate_system.h"

using namespace mien;
using namespace mien::capi;

static_assert(MIEN_ISA_NEON == int(Isa::kNeon) && MIEN_ISA_BEST == int(Isa::kBest),
              "simd/isa.h and mien.h number the same instruction sets");

uint32_t mien_version(void) { return MIEN_VERSION; }

const char* mien_status_name(MienStatus status) { return status_name(static_cast<Status>(status)); }

uint32_t mien_isa_available(uint32_t isa) {
  if (isa == MIEN_ISA_ENVIRONMENT) return kernels_from_environment() != nullptr;
  return isa < kIsaCount && kernels_for(static_cast<Isa>(isa)) != nullptr;
}

const char* mien_isa_name(uint32_t isa) {
  return isa == MIEN_ISA_ENVIRONMENT ? "environment" : isa_name(static_cast<Isa>(isa));
}

// Coordinate systems ------------------------------------------------------------------------------

MienStatus mien_coordinate_system_find(const char* name, MienCoordinateSystem* out_system) {
  return mien_coordinate_system_find_n(name, name ? strlen(name) : 0, out_system);
}

MienStatus mien_coordinate_system_find_n(const char* name, size_t name_count,
                                         MienCoordinateSystem* out_system) {
  if (MienStatus status = clear_struct(out_system)) return status;
  if (!name) return MIEN_ERROR_NULL_ARGUMENT;
  for (const NamedSystem& named : kNamedSystems) {
    if (strlen(named.name) != name_count || memcmp(named.name, name, name_count) != 0) continue;
    const CoordinateSystem& system = named.system;
    MienCoordinateSystem out = {};
    for (int i = 0; i < 3; ++i) {
      out.axes[i] = system.axes[i];
      out.rotation_signs[i] = system.rotation_signs[i];
    }
    out.translation_unit = system.translation_unit;
    out.rotation_unit = system.rotation_unit;
    out.rotation_rule = static_cast<uint32_t>(system.rotation_rule);
    out.rotation_sequence = system.rotation_sequence;
    out.face_winding = system.face_winding;
    write_struct(out_system, out);
    return MIEN_OK;
  }
  return MIEN_ERROR_NAME;
}

MienStatus mien_coordinate_system_name(uint32_t index, MienStringView* out_name) {
  if (!out_name) return MIEN_ERROR_NULL_ARGUMENT;
  *out_name = {};
  if (index >= kNamedSystemCount) return MIEN_ERROR_INDEX;
  const char* name = kNamedSystems[index].name;
  *out_name = {name, strlen(name)};
  return MIEN_OK;
}
