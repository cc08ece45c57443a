// SPDX-License-Identifier: MIT
// SCENE of `mien play`: JSON text -> what to play, with names that no rig has been asked about.
#pragma once

#include <mien.h>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "integrations/program/speech/source.h"

namespace mien::cli {

using NamedValues = std::vector<std::pair<std::string, float>>;

struct ClipScript {
  std::string path;                            // of speech: its JSON, which tells one from another
  std::optional<speech::SpeechSource> speech;  // said in place of a clip from a file
  std::optional<bool> loop;                    // else as the clip says
  double speed = 1, start = 0;
};

struct PoseScript {
  std::string name;
  NamedValues values;
};

struct LayerScript {
  std::string name;
  uint32_t group = MIEN_LAYER_GROUP_BASE, mode = MIEN_BLEND_MODE_OVERRIDE;
  uint32_t source = MIEN_LAYER_SOURCE_CLIP;
  float weight = 1;
  bool after_guards = false;
  std::optional<std::vector<std::string>> mask;  // patterns
  bool invert_mask = false;
  ClipScript clip;
  std::vector<PoseScript> poses;
  NamedValues weights;  // of poses
  uint32_t generator = MIEN_GENERATOR_BLINK;
  double period = 4;
  NamedValues controls;  // that the generator moves, with amounts; empty: those it usually moves
  float jitter = 0;      // of a gaze, degrees
  std::vector<std::string> eyes;  // joints of a gaze; empty: those that heads usually have
};

enum class EventKind { kWeight, kWeights, kPlay, kStop, kTrigger, kLevel, kVariable };

struct EventScript {
  double time = 0;
  EventKind kind = EventKind::kWeight;
  std::string where;    // in the scene, for messages
  uint32_t target = 0;  // layer or reaction
  double fade = 0;
  float weight = 1;
  NamedValues weights;
  ClipScript clip;
  uint32_t transition = MIEN_TRANSITION_INERTIAL;
  double duration = 0.25;
  double hold = 0;
  std::string variable;
};

/// Whether a layer turns the eyes.
inline bool is_gaze(const LayerScript& layer) {
  return layer.source == MIEN_LAYER_SOURCE_GENERATOR && layer.generator == MIEN_GENERATOR_GAZE;
}

struct Script {
  std::string shown;
  double seconds = 0;  // 0: not said
  double rate = 60;
  uint64_t seed = 0;
  std::vector<LayerScript> layers;
  std::vector<std::string> reactions;  // names; all of the preset glare
  std::vector<EventScript> events;     // by time, those of one time in their order
  uint32_t guards = 0;                 // MIEN_GUARD_...
  bool antagonists = false, limits = false;
};

/// What happens in a scene, as labels name it: reactions, clips, poses and weights that begin; by time.
using Captions = std::vector<std::pair<double, std::string>>;
Captions find_captions(const Script& script);

/// Exit code 2 with the place of what is wrong. `live`: there is a live source. A scene with no layer for
/// it gets one, "live", before all others.
Script parse_script(const std::string& text, const std::string& shown, bool live);

}  // namespace mien::cli
