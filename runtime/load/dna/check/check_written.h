// SPDX-License-Identifier: MIT
// Whether a file that is about to be written will open: a version may leave out layers that others need.
#pragma once

#include "runtime/base/status.h"
#include "runtime/load/dna/format/dna_view.h"
#include "runtime/load/dna/format/dna_writer.h"

namespace mien::dna {

/// Checks what remains of a view that passed the checks when it is written with `options`. Looks at
/// nothing if all of it remains. `arena` is for temporary memory. kDnaLayer for RBF behavior without the
/// machine-learned behavior of its file, kDnaLimit for a file of 4 GiB, kMemory.
Status check_written(const DnaView& view, const WriteOptions& options, Arena& arena, Error& error);

/// Empties the layers that will not be written. False if all are.
bool leave_out_layers(DnaView& view, const WriteOptions& options);

}  // namespace mien::dna
