// SPDX-License-Identifier: MIT
// The generated head with a mouth that can be measured: on its meshes, in millimeters.
#pragma once

#include <mien.h>
#include <mien_author.h>

#include <array>
#include <initializer_list>
#include <map>
#include <string>
#include <vector>

#include "integrations/program/io/handles.h"
#include "integrations/program/speech/take.h"

namespace mien::speech {

/// What a frame of a take does to the mouth.
struct MouthShape {
  double lip_gap;  // the least distance up from the lower lip to the upper one, near the middle
  double
      lip_to_teeth;  // the least distance of the upper front teeth from the skin of the lower lip
  double jaw;        // how far the lower front teeth are from where they rest
};

/// How deep the front teeth of each jaw are in the tongue, in millimeters; 0 where they are not.
struct PiercedTongue {
  double by_lower, by_upper;
};

class SpokenHead {
 public:
  explicit SpokenHead(uint64_t seed = 0);

  /// `take` names ARKit's controls.
  MouthShape shape(const SpokenTake& take, size_t frame);
  /// MouthShape.jaw alone, which is quick.
  double jaw(const SpokenTake& take, size_t frame);
  MouthShape shape(const std::vector<std::pair<std::string, float>>& values);
  PiercedTongue pierced(const SpokenTake& take, size_t frame);
  PiercedTongue pierced(const std::vector<std::pair<std::string, float>>& values);
  /// How far the tip of the tongue is in front of the edges of the lower incisors, in millimeters.
  double tongue_over_teeth(const SpokenTake& take, size_t frame);
  double tongue_over_teeth(const std::vector<std::pair<std::string, float>>& values);
  const MienRig* rig() const { return rig_.get(); }

 private:
  struct Point {
    double x, y, z;
  };
  void pose(const std::vector<std::pair<std::string, float>>& values,
            std::initializer_list<uint32_t> meshes);
  double jaw_of(const std::vector<Point>& teeth) const;
  std::vector<Point> positions(uint32_t mesh);
  uint32_t mesh_named(const std::string& part) const;
  std::vector<std::array<uint32_t, 3>> triangles_of(uint32_t mesh) const;
  double depth_in_tongue(const std::vector<Point>& tongue, const std::vector<Point>& teeth,
                         const std::vector<std::array<uint32_t, 3>>& of_teeth) const;

  cli::Dna dna_;
  cli::Rig rig_;
  cli::Deformer deformer_;
  cli::Instance instance_;
  cli::DeformerInstance body_;
  std::map<std::string, uint32_t> controls_;
  uint32_t skin_ = 0, teeth_ = 0, tongue_ = 0;
  // Positions near the middle that touch in the neutral pose and part when the jaw opens.
  std::vector<uint32_t> upper_contact_, lower_contact_;
  std::vector<std::array<uint32_t, 3>> lower_lip_;   // triangles, outside and inside
  std::vector<uint32_t> upper_teeth_, lower_teeth_;  // of the front
  std::vector<Point> lower_teeth_at_rest_;
  std::vector<std::array<uint32_t, 3>> upper_incisors_, lower_incisors_, tongue_surface_;
};

/// The head, made once.
SpokenHead& spoken_head();

}  // namespace mien::speech
