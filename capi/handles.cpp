// SPDX-License-Identifier: MIT
#include "capi/handles.h"

#include <cstdarg>
#include <cstdio>

namespace mien::capi {

MienStatus give_error(MienError* to, MienStatus status, const char* format, ...) {
  if (!to) return status;
  Error detail;
  detail.status = static_cast<Status>(status);
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(detail.message, sizeof(detail.message), format, arguments);
  va_end(arguments);
  return give_error(detail, to);
}

MienDna* new_dna(const Allocator& allocator) {
  void* memory = allocator.get(sizeof(MienDna), alignof(MienDna));
  if (!memory) return nullptr;
  return new (memory) MienDna{kDnaTag, allocator, {}, Arena(allocator), {}};
}

}  // namespace mien::capi
