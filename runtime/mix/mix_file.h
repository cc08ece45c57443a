// SPDX-License-Identifier: MIT
// A mix as a file. Controls are stored by name, so the file can be opened for any rig that has them.
//
//     | "MIENMIX\n" | checksum u32 | version u32 | size u64 | names of controls | fields |
//
// Numbers are little-endian, without padding. mix_fields.h lists the fields once, for reading, writing and
// text. The file has only the controls that the mix uses, sorted by name, so its bytes do not depend on
// the order of a rig. A mix that was opened is written with the same bytes.
#pragma once

#include "runtime/mix/mix.h"

namespace mien {

constexpr char kMixMagic[8] = {'M', 'I', 'E', 'N', 'M', 'I', 'X', '\n'};

/// Returns the size of the file in `size`, and writes the file if `out` has room; `out` may be empty.
/// kName if the controls have no names, or if two controls that are used have the same name; kMemory.
Status write_mix(const Mix& mix, Span<uint8_t> out, size_t& size, Error& error);

/// Writes the same as text: one line per number, with its place and the names of controls.
Status write_mix_text(const Mix& mix, Span<char> out, size_t& size, Error& error);

/// Creates a mix for a rig from the bytes of a file, which are not needed afterwards. Names match as those
/// of clips do (control_names.h). If `rig` is null, the controls of the file are the raw controls. Memory
/// is bounded by the size of the file and the number of curves. kMixSignature, kMixVersion, kMixTruncated,
/// kMixChecksum, kMixStructure; kName if the rig lacks controls, which the message names; kMemory.
Status open_mix(Span<const uint8_t> bytes, const Rig* rig, const Allocator& allocator, Mix*& out,
                Error& error);

}  // namespace mien
