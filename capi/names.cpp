// SPDX-License-Identifier: MIT
// mien/names.h.
#include <algorithm>

#include "capi/handles.h"
#include "runtime/anim/match_controls.h"

using namespace mien;
using namespace mien::capi;

static_assert(MIEN_NAME_MATCH_NONE == int(Match::kNone) &&
                  MIEN_NAME_MATCH_EXPRESSION == int(Match::kExpression),
              "match_controls.h and mien.h number the same matches");
static_assert(MIEN_MOST_SHARES == kMostShares, "match_controls.h and mien.h allow as many shares");

MienStatus mien_rig_match(const MienRig* rig, const char* name, size_t name_count,
                          MienControlShare* out_shares, size_t capacity, size_t* out_count,
                          uint32_t* out_match) {
  if (out_count) *out_count = 0;
  if (out_match) *out_match = MIEN_NAME_MATCH_NONE;
  if (!out_count || !out_match) return MIEN_ERROR_NULL_ARGUMENT;
  if (MienStatus status = check(rig)) return status;
  if ((!name && name_count != 0) || (!out_shares && capacity != 0)) return MIEN_ERROR_NULL_ARGUMENT;
  const ControlFinder finder(object(rig)->names[MIEN_KIND_RAW_CONTROL]);
  const ControlMatch match = finder.match({name, name_count});
  if (match.count == 0) return MIEN_ERROR_NAME;
  *out_count = match.count;
  *out_match = static_cast<uint32_t>(match.how);
  for (size_t i = 0; i < match.count && i < capacity; ++i) {
    out_shares[i] = {match.shares[i].control, match.shares[i].weight};
  }
  return MIEN_OK;
}

MienStatus mien_control_name(const char* name, size_t name_count, char* out_name, size_t capacity,
                             size_t* out_count) {
  if (!out_count) return MIEN_ERROR_NULL_ARGUMENT;
  *out_count = 0;
  if ((!name && name_count != 0) || (!out_name && capacity != 0)) return MIEN_ERROR_NULL_ARGUMENT;
  char text[kMostKnownName];
  const size_t count = write_known_name(know_control(spell_control({name, name_count})), text);
  if (count == 0) return MIEN_ERROR_NAME;
  *out_count = count;
  std::copy(text, text + std::min(count, capacity), out_name);
  return MIEN_OK;
}
