// SPDX-License-Identifier: MIT
#include "integrations/program/commands/solve_neutral.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "integrations/program/commands/moving_mesh.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

constexpr size_t kMostNeutralFrames = 1000, kEnoughNeutralFrames = 60;

bool is_there(const float* point, size_t width) {
  return std::all_of(point, point + width, [](float v) { return std::isfinite(v); });
}

/// 0 of none.
float median(std::vector<float> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

uint32_t MIEN_CALLBACK stop_at_once(void*) { return 1; }

}  // namespace

NeutralOption parse_neutral(const std::string& word) {
  NeutralOption option;
  if (word.empty()) return option;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, option.frame_count);
  if (stop != end) return {0, word};
  if (error == std::errc() && option.frame_count >= 1 && option.frame_count <= kMostNeutralFrames) {
    return option;
  }
  fail_usage("--neutral " + word,
             "not a number of frames from 1 to " + std::to_string(kMostNeutralFrames),
             "give one such as 60, or a CSV file of landmarks");
}

std::vector<std::vector<float>> read_neutral_rows(const std::string& path, bool images,
                                                  const std::vector<std::string>& names) {
  const LandmarkTable table = read_landmark_table(path, images);
  const size_t width = images ? 2 : 3, columns = table.take.names.size();
  std::vector<std::vector<float>> rows(table.take.row_count,
                                       std::vector<float>(names.size() * width, NAN));
  size_t found = 0;
  for (size_t i = 0; i < names.size(); ++i) {
    const auto at = std::find(table.names.begin(), table.names.end(), names[i]);
    if (at == table.names.end()) continue;
    ++found;
    const size_t column = static_cast<size_t>(at - table.names.begin()) * width;
    for (size_t r = 0; r < rows.size(); ++r) {
      std::copy_n(table.take.values.data() + r * columns + column, width,
                  rows[r].data() + i * width);
    }
  }
  if (found == 0 || rows.empty()) {
    fail(kInvalid, "cannot use the neutral face", table.take.shown,
         rows.empty() ? "it has no frames" : "it has none of the landmarks",
         "the header is time,NAME.x,NAME.y,... with the names of the landmarks that are solved");
  }
  return rows;
}

double landmark_spread(const float* row, size_t point_count, size_t width) {
  double sums[3] = {}, squares = 0, count = 0;
  for (size_t i = 0; i < point_count; ++i) {
    if (!is_there(row + width * i, width)) continue;
    ++count;
    for (size_t k = 0; k < width; ++k) {
      const double v = double{row[width * i + k]};
      sums[k] += v;
      squares += v * v;
    }
  }
  if (count == 0) return 0;
  for (const double sum : sums) squares -= sum * sum / count;
  return std::sqrt(std::max(squares / count, 0.0));
}

void NeutralFace::adapt(float* row, size_t width) const {
  for (size_t i = 0; i < known.size(); ++i) {
    for (size_t k = 0; k < width; ++k) {
      float& v = row[width * i + k];
      if (width == 3) v *= scale;
      if (!known[i]) v = NAN;
    }
  }
}

std::string NeutralFace::text() const {
  char numbers[96];
  std::snprintf(numbers, sizeof numbers, "its landmarks are %.3g from those of the rig",
                difference);
  std::string text = numbers;
  if (scale != 1) {
    std::snprintf(numbers, sizeof numbers, ", once scaled by %.4g", double{scale});
    text += numbers;
  }
  return text;
}

NeutralFinder::NeutralFinder(MienFit* fit, const SolvedRig& rig,
                             const std::vector<MienSolvePoint>& points, bool images)
    : fit_(fit), width_(images ? 2 : 3), raw_(rig_count(rig.rig, MIEN_KIND_RAW_CONTROL)) {
  std::map<uint32_t, std::vector<float>> meshes;
  for (const MienSolvePoint& point : points) {
    std::vector<float>& positions = meshes[point.mesh];
    if (positions.empty()) positions = MovingMesh(rig, point.mesh).rest();
    for (size_t k = 0; k < 3; ++k) {
      float sum = 0;
      for (size_t n = 0; n < 3; ++n) {
        sum += point.weights[n] * positions[size_t{point.positions[n]} * 3 + k];
      }
      rest_.push_back(sum);
    }
  }
}

bool NeutralFinder::add(const float* row, MienFitCamera* camera, bool finds_focal) {
  const size_t count = rest_.size() / 3;
  // The rig has the landmarks that the frame has.
  std::vector<float> there = rest_, scaled(row, row + count * width_);
  size_t present = 0;
  for (size_t i = 0; i < count; ++i) {
    const bool has = is_there(row + width_ * i, width_);
    present += has;
    if (!has) std::fill_n(there.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, NAN);
  }
  const double spread = landmark_spread(row, count, width_);
  if (present < 3 || present * kLeastLandmarkShare < count || !(spread > 0)) return false;
  float scale = 1;
  if (width_ == 3) {
    scale = static_cast<float>(landmark_spread(there.data(), count, 3) / spread);
    for (float& v : scaled) v *= scale;
  }

  // The controls stay at rest; the rotation, the place and the camera are found.
  auto frame = sized<MienFitFrame>();
  frame.points = width_ == 3 ? scaled.data() : nullptr;
  frame.images = width_ == 2 ? scaled.data() : nullptr;
  frame.camera = width_ == 2 ? camera : nullptr;
  frame.rigid = 1;
  frame.focal = width_ == 2 && finds_focal ? 1 : 0;
  frame.canceled = stop_at_once;
  auto result = sized<MienFitResult>();
  check(mien_fit_solve(fit_, &frame, raw_.data(), &result), nullptr, "cannot solve", "");
  if (!(result.point_residual <= kMostLandmarkResidual * spread * double{scale})) return false;

  const float *r = result.rotation, *t = result.translation;
  std::vector<float> offsets(rest_.size(), NAN);
  for (size_t i = 0; i < count; ++i) {
    if (!is_there(row + width_ * i, width_)) continue;
    const float* const own = rest_.data() + 3 * i;
    float apart[3];  // in the space of the camera or of the target
    float placed[3];
    for (size_t k = 0; k < 3; ++k) {
      placed[k] = r[3 * k] * own[0] + r[3 * k + 1] * own[1] + r[3 * k + 2] * own[2] + t[k];
    }
    for (size_t k = 0; k < 3; ++k) {
      if (width_ == 3) {
        apart[k] = scaled[3 * i + k] - placed[k];
      } else {
        // As deep as the point of the rig.
        apart[k] =
            k == 2 ? 0
                   : (row[2 * i + k] - camera->center[k]) * placed[2] / result.focal[k] - placed[k];
      }
    }
    for (size_t k = 0; k < 3; ++k) {
      offsets[3 * i + k] = r[k] * apart[0] + r[3 + k] * apart[1] + r[6 + k] * apart[2];
    }
  }
  found_.push_back(std::move(offsets));
  scales_.push_back(scale);
  if (width_ == 2) {
    std::copy_n(r, 9, camera->rotation);
    std::copy_n(t, 3, camera->translation);
    std::copy_n(result.focal, 2, camera->focal);
    focals_.push_back(result.focal[0]);
  }
  return true;
}

NeutralFace NeutralFinder::find() const {
  NeutralFace face;
  face.scale = median(scales_);
  face.focal = median(focals_);
  face.offsets.resize(rest_.size());
  face.known.resize(rest_.size() / 3);
  double squares = 0, count = 0;
  for (size_t i = 0; i < face.known.size(); ++i) {
    for (size_t k = 0; k < 3; ++k) {
      std::vector<float> values;
      for (const std::vector<float>& offsets : found_) {
        if (std::isfinite(offsets[3 * i + k])) values.push_back(offsets[3 * i + k]);
      }
      face.known[i] = !values.empty();
      const float v = median(std::move(values));
      face.offsets[3 * i + k] = v;
      squares += double{v} * double{v};
    }
    count += face.known[i];
  }
  face.difference = std::sqrt(squares / count);
  return face;
}

NeutralFace measure_neutral_rows(NeutralFinder& finder, const std::vector<std::vector<float>>& rows,
                                 const std::optional<MienFitCamera>& camera, bool finds_focal,
                                 const std::string& shown) {
  MienFitCamera moving = camera ? *camera : MienFitCamera{};
  const size_t used = std::min(rows.size(), kEnoughNeutralFrames);
  for (size_t k = 0; k < used; ++k) {
    finder.add(rows[k * rows.size() / used].data(), &moving, finds_focal);
  }
  if (finder.count() == 0) {
    fail(kInvalid, "cannot use the neutral face", shown,
         "its landmarks are not those of a face, or too few",
         "give frames of the same landmarks, in which the face is at rest");
  }
  return finder.find();
}

}  // namespace mien::cli
