// SPDX-License-Identifier: MIT
// Sounds with times -> curves of the mouth: dominance functions, and closures that close.
// docs/speech.md, 3 "Coarticulation" and 4 "Closures" have the formulas.
#pragma once

#include <string>
#include <vector>

#include "integrations/program/speech/sounds.h"

namespace mien::speech {

/// Values of controls, by ARKit's names, in frames at a constant rate from time 0.
struct Curves {
  double rate = 60;
  size_t frame_count = 0;
  std::vector<std::string> controls;
  std::vector<float> values;  // [frame][control]

  size_t control(const std::string& name) const;  // that it has
  float& at(size_t frame, size_t control) { return values[frame * controls.size() + control]; }
  double time(size_t frame) const { return static_cast<double>(frame) / rate; }
};

/// While something is closed, from contact to release.
struct ClosedTime {
  Closure closure;
  double begin, end;  // seconds
};

/// Of the sounds that close something. Lips and teeth touch for at least as long as two frames take, or one
/// where another closure follows soon, so that a frame shows both and what is between them.
std::vector<ClosedTime> find_closures(const std::vector<Segment>& segments, double rate);

/// All controls that speech moves: those of the visemes, mouthClose, and what prosody.h adds.
std::vector<std::string> speech_controls();

/// Fills the controls of the mouth. `effort`: of each phoneme, what its vowel is scaled by (prosody.h).
void move_mouth(const std::vector<Segment>& segments, const std::vector<float>& effort,
                const std::vector<ClosedTime>& closures, Curves& curves);

/// Continuous to the second derivative, 0 at 0 and 1 at 1; clamped beyond.
double ease(double u);

}  // namespace mien::speech
