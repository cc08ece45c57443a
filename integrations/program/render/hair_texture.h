// SPDX-License-Identifier: MIT
// One texture for the cards of hair, brows and lashes of the generated head: gray, to be multiplied by the color of
// the hair, with an alpha. Where each kind is, from the lower left corner, as author/generate/head/cards.h has it:
//
//     v 1.0  +-----+-----+-----+-----+-----+-----+-----+-----+
//            | five lanes of locks         |line |thin |loose|
//            | roots below, tips above     |     |hairs|hairs|
//     v 0.6  +-----+-----+-----+-----+-----+-----+-----+-----+
//            | short hair, to be mirrored | four lanes of    |
//            | at its borders; thin below | curls            |
//     v 0.2  +------------+------------+--+---------+--------+
//            | 4 of lashes| 4 of brows | 4 of brows | lashes |
//     v 0.0  +------------+------------+------------+--------+
//            u 0         0.25         0.5          0.75      1
//
// The other half of a face has 1 - u.
#pragma once

#include "integrations/program/render/image.h"

namespace mien::render {

struct HairMap {
  Image gray;                  // red, green and blue are equal
  std::vector<uint8_t> alpha;  // of each pixel
};

/// 512 x 640 pixels, the same at each call. Throws std::bad_alloc.
HairMap make_hair_map();

}  // namespace mien::render
