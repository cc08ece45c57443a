// SPDX-License-Identifier: MIT
// Landmarks of the generated persons, measured on their surface: the designed one has published proportions, and no
// two of a row are alike.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "author/generate/head/form.h"

namespace mien {
namespace {

using head::FacePoint;
using head::Form;
using head::Side;

struct Measure {
  const char* name;
  // cm: means of women and men less and plus one standard deviation, of young adults of North America (Farkas,
  // "Anthropometry of the Head and Face", 2nd ed., 1994); breadths of the face, of workers of the United States
  // (Zhuang and Bradtmiller, J. Occup. Environ. Hyg. 2, 2005). No range: other definitions than theirs.
  double low, high;
  double deviation;  // between people of one sex; estimated where there is no range
};
constexpr Measure kMeasures[] = {
    {"n-gn", 10.6, 12.8, 0.58},      {"n-sn", 4.75, 5.8, 0.32},
    {"sn-gn", 6.0, 7.7, 0.43},       {"sn-sto", 1.8, 2.45, 0.21},
    {"al-al", 2.95, 3.7, 0.21},      {"ch-ch", 4.65, 5.75, 0.33},
    {"en-en", 2.95, 3.6, 0.25},      {"ex-ex", 8.45, 9.45, 0.32},
    {"zy-zy", 12.9, 15.0, 0.65},     {"eu-eu", 13.9, 15.7, 0.55},
    {"v-gn", 21.0, 23.9, 0.80},      {"go-go", 10.1, 13.1, 0.90},
    {"sn-prn", 1.7, 2.2, 0.18},      {"g-op", 0, 0, 0.65},
    {"tip height", 0, 0, 0.25},      {"bridge", 0, 0, 0.20},
    {"chin before lip", 0, 0, 0.35}, {"upper red", 0, 0, 0.13},
    {"lower red", 0, 0, 0.15},       {"brow before eye", 0, 0, 0.20},
    {"cheekbone", 0, 0, 0.30},
};
constexpr size_t kMeasureCount = sizeof(kMeasures) / sizeof(kMeasures[0]);

using Measured = std::array<double, kMeasureCount>;

Vec3 on_face(const Form& form, double x, double y) {
  return form.face(form.angle_of(x, y), y, Side::kBelow).closed;
}

/// The place of the profile between two rows that is farthest along a direction.
Vec3 farthest(const Form& form, double from, double to, double along_y, double along_z) {
  Vec3 best = on_face(form, 0, from);
  for (int i = 1; i <= 200; ++i) {
    const Vec3 p = on_face(form, 0, from + (to - from) * i / 200);
    if (along_y * (p.y - best.y) + along_z * (p.z - best.z) > 0) best = p;
  }
  return best;
}

double widest(const Form& form, double from, double to) {
  double most = 0;
  for (int i = 0; i <= 40; ++i) {
    for (int k = 20; k <= 60; ++k) {
      most = std::max(
          most, form.face(0.01 * M_PI * k, from + (to - from) * i / 40, Side::kBelow).closed.x);
    }
  }
  return 2 * most;
}

/// Where the side of the nose is steepest.
double half_width_of_nose(const Form& form, double row) {
  double steepest = 0, at = 0;
  for (double x = 0.9; x < 2.6; x += 0.02) {
    const double fall = on_face(form, x, row).z - on_face(form, x + 0.04, row).z;
    if (fall > steepest) steepest = fall, at = on_face(form, x + 0.02, row).x;
  }
  return at;
}

Measured measure(uint64_t seed) {
  const Form form(head::make_person(seed));
  const double eye = form.eye().x, half = form.eye_half_width();
  const Vec3 nasion = farthest(form, 1.6, 0.2, 0, -1);
  const Vec3 tip = farthest(form, -2.0, -4.0, 0, 1);
  // The corner between the nose's septum and the lip.
  const Vec3 subnasale = farthest(form, -3.9, -5.3, 0.5, -1);
  const Vec3 stomion = on_face(form, 0, head::kMouthY);
  const Vec3 gnathion = farthest(form, -9.2, -12.0, -1, 0.45);
  const Vec3 pogonion = farthest(form, -8.6, -10.2, 0, 1), lip = farthest(form, -5.0, -6.9, 0, 1);
  const Vec3 crown = {0, form.raised(head::kCrownY), 0};
  double front = -1e9, back = 1e9;
  for (double y = 1.5; y < 5; y += 0.1) {
    front = std::max(front, form.face(0, y, Side::kBelow).closed.z);
    back = std::min(back, form.face(M_PI, y, Side::kBelow).closed.z);
  }
  const double middle = head::kMouthHalfWidth * 0.25;
  return {nasion.y - gnathion.y,
          nasion.y - subnasale.y,
          subnasale.y - gnathion.y,
          subnasale.y - stomion.y,
          2 * half_width_of_nose(form, -3.5),
          2 * on_face(form, head::kMouthHalfWidth, head::kMouthY).x,
          2 * (eye - half),
          2 * (eye + half),
          widest(form, -3.5, 0),
          widest(form, 3, 8),
          crown.y - gnathion.y,
          widest(form, -9.5, -6),
          tip.z - subnasale.z,
          front - back,
          tip.y - subnasale.y,
          2 * half_width_of_nose(form, -0.4),
          pogonion.z - lip.z,
          form.lip_height(middle, 1),
          form.lip_height(middle, -1),
          on_face(form, 2.4, 2.7).z - (head::kEye.z + head::kLidRadius),
          on_face(form, 4.7, -1.65).z};
}

/// Of eyes and brows, with standard deviations between people. Length and height of the slit: BioMed Res. Int. 2013,
/// 821428; breadth between the inner corners: pooled for white people, PMC9029890; heights of crease and brow: Cartwright
/// et al., Am. J. Ophthalmol. 117, 1994. The others are estimated.
constexpr Measure kEyeMeasures[] = {
    {"length of the slit", 0, 0, 0.17},
    {"height of the slit", 0, 0, 0.12},
    {"en-en", 0, 0, 0.25},
    {"crease", 0, 0, 0.12},
    {"brow", 0, 0, 0.18},
    {"tilt in degrees", 0, 0, 2.5},
    {"inner corner covered", 0, 0, 0.3},
    {"brow before eye", 0, 0, 0.20},
};
constexpr size_t kEyeMeasureCount = sizeof(kEyeMeasures) / sizeof(kEyeMeasures[0]);

std::array<double, kEyeMeasureCount> measure_eye(uint64_t seed) {
  const head::Person person = head::make_person(seed);
  const Form form(person);
  const double x = head::kEye.x, half = form.eye_half_width();
  const Vec3 edge = on_face(form, x, head::kEye.y);
  const double open =
      head::turn_lid(edge, form.upper_opening(x)).y - head::turn_lid(edge, form.lower_opening(x)).y;
  // The height at which the skin leaves the ball of the lid.
  double crease = 0.05;
  for (; crease < 1.5; crease += 0.01) {
    const double row = head::kEye.y + crease;
    const Vec3 from = form.face(form.angle_of(x, row), row, Side::kAbove).closed - head::kEye;
    if (std::sqrt(dot(from, from)) > head::kLidRadius + 0.04) break;
  }
  return {2 * half,
          open,
          2 * (form.eye().x - half),
          crease,
          person.brow_height,
          std::atan2(form.lid_line(x + half) - form.lid_line(x - half), 2 * half) * 180 / M_PI,
          person.epicanthus,
          on_face(form, 2.4, 2.7).z - (head::kEye.z + head::kLidRadius)};
}

TEST(Persons, EyesOfARowDiffer) {
  constexpr size_t kRow = 11;  // the designed one and ten others
  std::vector<std::array<double, kEyeMeasureCount>> row;
  for (uint64_t seed = 0; seed < kRow; ++seed) row.push_back(measure_eye(seed));
  double nearest = 1e9;
  int fewest = kEyeMeasureCount;
  for (size_t a = 0; a < kRow; ++a) {
    for (size_t b = 0; b < a; ++b) {
      double squares = 0;
      int apart = 0;
      for (size_t i = 0; i < kEyeMeasureCount; ++i) {
        const double d = (row[a][i] - row[b][i]) / kEyeMeasures[i].deviation;
        squares += d * d;
        apart += std::abs(d) > 1;
      }
      const double distance = std::sqrt(squares / kEyeMeasureCount);
      EXPECT_GT(distance, 0.9) << "standard deviations, eyes of persons " << a << " and " << b;
      EXPECT_GE(apart, 2) << "features of the eyes of persons " << a << " and " << b;
      nearest = std::min(nearest, distance);
      fewest = std::min(fewest, apart);
    }
  }
  RecordProperty("nearest", std::to_string(nearest));
  RecordProperty("fewest", std::to_string(fewest));
}

TEST(Persons, TheDesignedOneHasPublishedProportions) {
  const Measured measured = measure(0);
  for (size_t i = 0; i < kMeasureCount; ++i) {
    RecordProperty(kMeasures[i].name, std::to_string(measured[i]));
    if (kMeasures[i].high == 0) continue;
    EXPECT_GE(measured[i], kMeasures[i].low) << kMeasures[i].name;
    EXPECT_LE(measured[i], kMeasures[i].high) << kMeasures[i].name;
  }
}

/// The row of the profile's underside that is as far in front as `z`.
Vec3 below_nose(const Form& form, double z) {
  double low = -4.75, high = -3.5;
  for (int i = 0; i < 40; ++i) {
    const double row = 0.5 * (low + high);
    (on_face(form, 0, row).z < z ? low : high) = row;
  }
  return on_face(form, 0, low);
}

TEST(Persons, TheColumellaHangsBelowTheRimsOfTheNostrils) {
  for (uint64_t seed = 0; seed < 10; ++seed) {
    const Form form(head::make_person(seed));
    const auto nostril = [&](double turn, double size) {
      const head::FrontPlace at = form.nostril_curve(2 * author::kPi * turn, size);
      return on_face(form, at.x, at.y);
    };
    // In the view from the side, at the middle of the nostril: 2 to 4 mm (Ding and Zhang, 2020).
    const Vec3 rim = nostril(0.5, 1.35), edge = nostril(0.5, 1);
    const double show = rim.y - below_nose(form, rim.z).y;
    // From the opening to the outside of the wing, seen from below.
    double outside = 0;
    for (double row = -4.1; row < -3.0; row += 0.02) {
      for (double x = edge.x; x < 3; x += 0.01) {
        const Vec3 p = on_face(form, x, row);
        if (p.z >= edge.z) outside = std::max(outside, p.x);
      }
    }
    const double thick = outside - edge.x;
    std::printf("seed %d: columella %.2f cm below the rim, which is %.2f cm thick\n",
                static_cast<int>(seed), show, thick);
    EXPECT_GT(show, 0.2) << seed;
    EXPECT_LT(show, 0.4) << seed;
    EXPECT_GT(thick, 0.2) << seed;
    EXPECT_LT(thick, 0.42) << seed;
    EXPECT_LT(rim.y, edge.y) << seed << ": the rim is a roll around the opening";
    // A pear whose narrow end is at the tip; axes converge there.
    const Vec3 back = nostril(0.25, 1), front = nostril(0.75, 1);
    EXPECT_LT(front.x, back.x - 0.2) << seed;
    EXPECT_GT(front.z, back.z + 0.5) << seed;
    EXPECT_LT(length(nostril(0.66, 1) - nostril(0.84, 1)),
              0.85 * length(nostril(0.34, 1) - nostril(0.16, 1)))
        << seed;
  }
}

TEST(Persons, NoTwoOfARowAreAlike) {
  constexpr size_t kRow = 12;
  std::vector<Measured> row;
  for (uint64_t seed = 0; seed < kRow; ++seed) row.push_back(measure(seed));
  double nearest = 1e9;
  int fewest = kMeasureCount;
  for (size_t a = 0; a < kRow; ++a) {
    for (size_t b = 0; b < a; ++b) {
      double squares = 0;
      int apart = 0;
      for (size_t i = 0; i < kMeasureCount; ++i) {
        const double d = (row[a][i] - row[b][i]) / kMeasures[i].deviation;
        squares += d * d;
        apart += std::abs(d) > 1;
      }
      const double distance = std::sqrt(squares / kMeasureCount);
      EXPECT_GT(distance, 1.0) << "standard deviations, persons " << a << " and " << b;
      EXPECT_GE(apart, 5) << "features of persons " << a << " and " << b;
      nearest = std::min(nearest, distance);
      fewest = std::min(fewest, apart);
    }
  }
  RecordProperty("nearest", std::to_string(nearest));
  RecordProperty("fewest", std::to_string(fewest));
}

}  // namespace
}  // namespace mien
