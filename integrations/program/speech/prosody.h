// SPDX-License-Identifier: MIT
// Stress, loudness and pauses -> effort of the mouth, brows, blinks, beats of the head.
// docs/speech.md, 5 "Prosody" has the sources.
#pragma once

#include <vector>

#include "integrations/program/speech/mouth.h"

namespace mien::speech {

/// Of each phoneme: what the values of its vowel are multiplied by.
std::vector<float> find_effort(const std::vector<Phoneme>& phonemes);

/// Fills brows and lids.
void move_upper_face(const std::vector<Segment>& segments, const std::vector<Phoneme>& phonemes,
                     Curves& curves);

/// head.up of each frame: the tangent of how far the head is turned up.
std::vector<float> move_head(const std::vector<Segment>& segments,
                             const std::vector<Phoneme>& phonemes, double rate, size_t frame_count);

}  // namespace mien::speech
