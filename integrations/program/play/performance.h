// SPDX-License-Identifier: MIT
// A scene on a rig: the mix that it describes, its clips, and the resulting frames.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "integrations/program/io/bound_clip.h"
#include "integrations/program/io/clip_file.h"
#include "integrations/program/io/terminal.h"
#include "integrations/program/play/rig_curves.h"
#include "integrations/program/play/script.h"

namespace mien::cli {

using Mix = std::unique_ptr<MienMix, Destroy<MienMix, mien_mix_destroy>>;
using Gaze = std::unique_ptr<MienGaze, Destroy<MienGaze, mien_gaze_destroy>>;
using Mixer = std::unique_ptr<MienMixer, Destroy<MienMixer, mien_mixer_destroy>>;

struct FiredEvent {
  double time;
  std::string layer, name;
  float value;
};

/// Rows that arrive while a scene plays.
struct StreamScript {
  std::vector<uint16_t> curves;
  double delay = 0;  // seconds
};

/// A guard of a mix.
struct GuardFacts {
  std::string name;
  std::vector<uint16_t> controls;  // that it may hold back
};

/// What it did in a frame, in millimeters: see MienGuardState.
struct GuardFrame {
  float activation, protected_distance, wanted, limit, distance;
  /// Whether it had something to hold back.
  bool acts() const { return activation > 0 && wanted > limit; }
};

class Performance {
 public:
  /// `deformer` is where guards and eyes are measured; it may be null if the scene has none. `stream` is for
  /// a live layer. `names` go before those that the library knows.
  Performance(const Script& script, const MienRig* rig, const MienDeformer* deformer,
              const StreamScript& stream, const NamesFile& names, const Session& session);

  const RigCurves& curves() const { return curves_; }
  /// "talk", ..., "reactions", "guards", "antagonists", "limits"
  const std::vector<std::string>& stages() const { return stages_; }
  const std::vector<FiredEvent>& events() const { return events_; }

  /// Calls `use` with each frame: its number, its time and its row, a value per curve. `wait` may be empty;
  /// it is called with the tick of each frame before anything else is done for it, and ends the run with
  /// false.
  void run(double rate, double seconds, const std::function<bool(int64_t tick)>& wait,
           const std::function<void(size_t frame, double time, const float* row)>& use);

  /// A row for the live layer.
  void push(int64_t tick, const std::vector<float>& row);

  /// A curve after each stage, while run() calls.
  std::vector<float> stage_values(uint16_t curve) const;
  const std::vector<GuardFacts>& guards() const { return guards_; }
  /// Of each guard, while run() calls.
  std::vector<GuardFrame> guard_frames() const;

 private:
  /// A channel that turns the head, such as head.up.
  struct HeadChannel {
    uint16_t variable;          // curve of the scene
    std::vector<float> values;  // of each frame
  };
  struct BoundClip {
    ClipFile file;
    ClipBinding binding;
    std::vector<HeadChannel> head;
  };
  /// A clip that a layer plays, for the head.
  struct HeadTurns {
    const BoundClip* clip = nullptr;
    double begin = 0, start = 0, speed = 1;  // seconds
    bool loops = false;
  };
  struct LayerParts {
    std::vector<float> mask;
    CurveValues generated;
  };
  /// Scenes give places in meters from the middle of the eyes, mixers have millimeters of the model.
  struct GazePlace {
    float scale = 1, offset = 0;
  };

  const BoundClip& clip(const ClipScript& what);
  void say(const speech::SpeechSource& source, BoundClip& bound);
  void read_head(BoundClip& bound, const std::vector<std::string>& names);
  /// Adds the head's channels of the clips that play.
  void turn_head(int64_t tick, float* row) const;
  uint32_t add_pose(CurveValues values);
  CurveValues of_mixer(CurveValues values, uint32_t mode, const std::string& where) const;
  float of_scene(size_t curve, float value) const;
  void add_variable(const std::string& name);
  void find_eyes(const MienDeformer* deformer);
  void add_layers();
  void add_glare();
  void order_stages();
  void make_mix(const MienDeformer* deformer);
  void start();
  void play(uint32_t layer, const ClipScript& what, uint32_t transition, double duration,
            const std::string& where);
  void apply(const EventScript& event);
  void step_to(int64_t tick);

  const Script& script_;
  const StreamScript& stream_;
  const MienRig* rig_;
  const Session& session_;
  const NamesFile& names_;
  RigCurves curves_;
  std::map<std::string, BoundClip> clips_;
  std::map<uint32_t, HeadTurns> head_turns_;  // by layer
  std::deque<CurveValues> pose_values_;       // where poses point to
  std::deque<LayerParts> parts_;
  std::deque<std::vector<MienMixStroke>> strokes_;
  std::vector<MienMixPose> poses_;
  std::vector<MienMixLayer> layers_;
  std::vector<MienMixReaction> reactions_;
  std::map<size_t, GazePlace> gaze_places_;  // of curves; empty: nothing turns the eyes
  std::vector<float> initial_;               // raw controls that are not 0 at the beginning
  std::vector<std::string> stages_;
  std::vector<uint32_t> stage_numbers_;  // of each, for mien_mixer_stage()
  std::vector<FiredEvent> events_;
  std::vector<GuardFacts> guards_;
  Gaze gaze_;
  Mix mix_;
  Mixer mixer_;
  int64_t now_ = 0;
};

}  // namespace mien::cli
