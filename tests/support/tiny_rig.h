// SPDX-License-Identifier: MIT
// The smallest rig that has some of everything, to be changed and broken by tests.
//
//   joints      0 head, 1 jaw (of head), 2 tongue (of jaw; turned as a quaternion)
//   GUI         0 CTRL_jaw.ty, 1 CTRL_smile.tx
//   controls    0 jawOpen, 1 smileL, 2 smileR       raw
//               3 jawOpen * smileL, 4 jawOpen * smileR / 2   PSD
//               5-8 tongue.qx .qy .qz .qw           ML: a network's guess from jawOpen and smileL
//               9 rest, 10 open                     RBF: how close jawOpen and smileL are to a pose
//   LODs        2; LOD 1 drops the tongue, channel 1, the map, the network and the solver
//   channels    0 jawOpen, 1 smile                  one target, of channel 0
//   maps        0 wrinkle
//   meshes      0 face: two quads side by side, six vertices, skinned to head and jaw
//
//     3---4---5      faces 0 1 4 3 and 1 2 5 4; positions, texture coordinates,
//     |   |   |      normals and layouts all have the same numbers
//     0---1---2
#pragma once

#include <cstring>
#include <initializer_list>

#include "runtime/load/dna/format/dna_view.h"

namespace mien::dna {

/// Numbers as a file holds them.
template <class T>
Array<T> be(Arena& arena, std::initializer_list<T> values) {
  const NewArray<T> array = new_array<T>(arena, values.size());
  size_t i = 0;
  for (T value : values) array.set(i++, value);
  return array;
}

/// Records, arrays or strings.
template <class T>
List<T> list(Arena& arena, std::initializer_list<T> items) {
  const Span<T> span = arena.array<T>(items.size());
  size_t i = 0;
  for (const T& item : items) span[i++] = item;
  return {span.data, static_cast<uint32_t>(span.count)};
}

/// A literal; needs no arena.
inline String text(const char* literal) {
  return {reinterpret_cast<const uint8_t*>(literal), static_cast<uint32_t>(strlen(literal))};
}

/// The rig above as a file of version 2.8 with all layers loaded. Lists and arrays lie in `arena`
/// and no address is within a file. Passes all checks without a finding.
DnaView tiny_rig(Arena& arena);

}  // namespace mien::dna
