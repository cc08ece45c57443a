// SPDX-License-Identifier: MIT
// The public functions, as integrations/api reads them from the headers.
#pragma once

namespace mien {

struct PublicFunction {
  const char* name;
  bool takes_memory;  // its statuses include MIEN_ERROR_MEMORY
};

constexpr PublicFunction kPublicFunctions[] = {
#include "public_functions.inl"  // by integrations/api/function_list.py
};

}  // namespace mien
