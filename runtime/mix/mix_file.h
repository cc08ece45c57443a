// SPDX-License-Identifier: MIT
// A mix as a file: controls by name, so that it can be opened for any rig that has them.
//
//     | "MIENMIX\n" | checksum u32 | version u32 | size u64 | names of controls | fields |
//
// Numbers are little-endian, without padding; mix_fields.h lists the fields once, for reading,
// writing and text. Only controls that something refers to are in the file, in the order of their
// names, so the bytes do not depend on the order of a rig. A mix that was opened is written with the
// same bytes.
#pragma once

#include "runtime/mix/mix.h"

namespace mien {

constexpr char kMixMagic[8] = {'M', 'I', 'E', 'N', 'M', 'I', 'X', '\n'};

/// Gives the size of a mix as a file, and writes it if there is room: `out` may be empty. kName if
/// the controls have no names, or two of one name are used; kMemory.
Status write_mix(const Mix& mix, Span<uint8_t> out, size_t& size, Error& error);

/// The same as text: a line for each number, with its place and the names of controls.
Status write_mix_text(const Mix& mix, Span<char> out, size_t& size, Error& error);

/// Makes a mix for a rig of the bytes of a file; they are not needed afterwards. Names match as those
/// of clips do (control_names.h). Without a rig the controls of the file are the raw controls. Memory
/// is bounded by the size of the file and the lanes. kMixSignature, kMixVersion, kMixTruncated,
/// kMixChecksum, kMixStructure; kName if the rig lacks controls, the message names them; kMemory.
Status open_mix(Span<const uint8_t> bytes, const Rig* rig, const Allocator& allocator, Mix*& out,
                Error& error);

}  // namespace mien
