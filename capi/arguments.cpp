// SPDX-License-Identifier: MIT
#include "capi/arguments.h"

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

}  // namespace mien::capi
