// SPDX-License-Identifier: MIT
#include "capi/arguments/arguments.h"

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
  make_printable(detail.message);
  return give_error(detail, to);
}

MienStatus check_fields(std::initializer_list<FieldRange> fields, MienError* error) {
  for (const FieldRange& field : fields) {
    if (field.value <= field.last) continue;
    if (field.last == 0) {
      return give_error(error, MIEN_ERROR_INVALID_ARGUMENT, "%s is %u; it must be 0", field.name,
                        field.value);
    }
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT, "%s is %u; valid values are 0 to %u",
                      field.name, field.value, field.last);
  }
  return MIEN_OK;
}

}  // namespace mien::capi
