// SPDX-License-Identifier: MIT
#include "capi/handles.h"

#include <cstdlib>

namespace mien::capi {

MienStatus find_kernels(uint32_t isa, const KernelTable*& out, MienError* error) {
  if (isa == MIEN_ISA_ENVIRONMENT) {
    out = kernels_from_environment();
    if (out) return MIEN_OK;
    const char* wanted = getenv("MIEN_ISA");
    return give_error(error, MIEN_ERROR_ISA,
                      "the environment variable MIEN_ISA is \"%.40s\", which is not an instruction "
                      "set of this CPU and build; unset it or use scalar",
                      wanted ? wanted : "");
  }
  if (isa >= kIsaCount) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT, "isa is %u, which is not a MIEN_ISA_...",
                      isa);
  }
  out = kernels_for(static_cast<Isa>(isa));
  if (out) return MIEN_OK;
  return give_error(error, MIEN_ERROR_ISA, "this CPU or build lacks %s; use MIEN_ISA_BEST",
                    mien_isa_name(isa));
}

Status set_reuse(uint32_t reuse, Rig*& rig, Error& error) {
  rig->always_evaluate = reuse == MIEN_REUSE_NOTHING;
  if (reuse != MIEN_REUSE_SUMS) return Status::kOk;
  rig->changes = create_change_tables(*rig, rig->allocator);
  if (rig->changes) return Status::kOk;
  release(rig);
  rig = nullptr;
  return fail(error, Status::kMemory, kNoOffset, "no memory for the tables of MIEN_REUSE_SUMS");
}

}  // namespace mien::capi
