// SPDX-License-Identifier: MIT
// An utterance as motion: curves of controls, events, and the turn of the head; and the clip that they make.
#pragma once

#include <string>
#include <vector>

#include "integrations/program/io/handles.h"
#include "integrations/program/io/matched_names.h"
#include "integrations/program/io/output.h"
#include "integrations/program/speech/mouth.h"

namespace mien::speech {

/// A phoneme, or a closure that guards of mixers keep: its length is its value.
struct SpokenEvent {
  int64_t tick;
  std::string name;
  float seconds;
};

struct SpokenTake {
  Curves curves;                     // of ARKit's names, or of a rig's after bind()
  std::vector<SpokenEvent> events;   // by time
  std::vector<float> head_up;        // of each frame: tangent
  std::vector<std::string> unknown;  // labels that no alphabet has
  // After bind(): all raw controls of the rig, and which of them each curve is.
  std::vector<std::string> rig_controls;
  std::vector<uint32_t> raw;
};

/// The channel of clips, and the variable of frames, that has `head_up`.
constexpr const char* kHeadUp = "head.up";

/// Rates from 1 to 1000. Fails with exit code 2 if no phoneme is known, or if the utterance is too
/// long for the bytes that it came from.
SpokenTake make_take(Utterance utterance, Alphabet alphabet, double rate, size_t bytes,
                     const std::string& shown);

/// Curves of the raw controls of a rig. Fails with exit code 2 if it has none of them.
void bind(SpokenTake& take, const MienRig* rig, const cli::NamesFile& names,
          const std::string& rig_shown, const cli::Session& session);

/// Its last channel is kHeadUp.
cli::Clip make_clip(const SpokenTake& take, const std::string& shown);

/// The frames as `mien play` writes them, for `mien eval` and `mien render`; without a rig, values have names.
void write_frames(const SpokenTake& take, const std::string& rig_name, cli::Output& output);

}  // namespace mien::speech
