// SPDX-License-Identifier: MIT
// The face at rest of another person: how its landmarks differ from those of the rig, found from frames of it.
#pragma once

#include "integrations/program/commands/solve_landmarks.h"

namespace mien::cli {

/// What --neutral says: how many of the first frames are neutral, or a file of such frames. Neither: nothing.
struct NeutralOption {
  size_t frame_count = 0;
  std::string file;

  bool given() const { return frame_count != 0 || !file.empty(); }
};
NeutralOption parse_neutral(const std::string& word);

/// Rows of a CSV of landmarks with the columns of `names`; what the file lacks is NaN.
std::vector<std::vector<float>> read_neutral_rows(const std::string& path, bool images,
                                                  const std::vector<std::string>& names);

/// Landmarks of another person, in the space of the rig.
struct NeutralFace {
  float scale = 1;             // of places in space: the rig's size by the person's
  float focal = 0;             // in images, in pixels along x: of the camera that saw it
  std::vector<float> offsets;  // [point][3] MienFitFrame.point_offsets; empty: none was measured
  std::vector<uint8_t> known;  // [point] it was there in a neutral frame
  double difference = 0;       // root mean square of the offsets

  /// Landmarks of a frame as a fit with the offsets takes them: of the size of the rig, without those that are unknown.
  void adapt(float* row, size_t width) const;
  /// "its landmarks are 0.31 from those of the rig, once scaled by 0.94", in the unit of the rig
  std::string text() const;
};

/// Root mean square distance of the landmarks that are there from their middle.
double landmark_spread(const float* row, size_t point_count, size_t width);
/// Of the landmarks. With fewer, neither the place of the head nor its expression is sure.
constexpr size_t kLeastLandmarkShare = 4;
/// Of the spread of the landmarks. Where the residual is larger, they are not those of a face, or the camera was lost.
constexpr double kMostLandmarkResidual = 0.25;

class NeutralFinder {
 public:
  /// `points` are those of the fit, which outlives it. `images`: x and y in pictures.
  NeutralFinder(MienFit* fit, const SolvedRig& rig, const std::vector<MienSolvePoint>& points,
                bool images);

  /// A frame of the face at rest. Of images, `camera` is where the search for it begins, and becomes the one that sees
  /// this frame, with its focal length if `finds_focal`. False if these are no landmarks of a face, or too few.
  bool add(const float* row, MienFitCamera* camera, bool finds_focal);
  size_t count() const { return scales_.size(); }
  /// The medians of all frames, of which there is one at least.
  NeutralFace find() const;

 private:
  MienFit* fit_;
  size_t width_;
  std::vector<float> rest_;                // [point][3] of the rig
  std::vector<float> raw_;                 // that a solve writes
  std::vector<std::vector<float>> found_;  // [frame][point][3] offsets; NaN: missing
  std::vector<float> scales_, focals_;     // [frame]
};

/// The frames of a file, of which some dozens are enough.
NeutralFace measure_neutral_rows(NeutralFinder& finder, const std::vector<std::vector<float>>& rows,
                                 const std::optional<MienFitCamera>& camera, bool finds_focal,
                                 const std::string& shown);

}  // namespace mien::cli
