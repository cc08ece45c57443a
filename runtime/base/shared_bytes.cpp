// SPDX-License-Identifier: MIT
#include "runtime/base/shared_bytes.h"

namespace mien {

SharedBytes::~SharedBytes() {
  if (file.bytes) close_file(file);
}

}  // namespace mien
