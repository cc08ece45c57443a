// SPDX-License-Identifier: MIT
// The handles of the part of the library that MIEN_BUILD_COMPILER=OFF leaves out.
#pragma once

#include "capi/handles.h"
#include "runtime/load/dna/dna_file.h"
#include "runtime/load/report/dna_report.h"

namespace mien::capi {

template <>
struct ObjectOf<MienDna> : TypeOf<dna::DnaFile> {};
template <>
struct ObjectOf<MienReport> : TypeOf<Report> {};

}  // namespace mien::capi
