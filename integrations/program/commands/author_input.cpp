// SPDX-License-Identifier: MIT
#include "integrations/program/commands/author_input.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <unordered_map>
#include <vector>

namespace mien::cli {

namespace {

using Point = std::array<double, 3>;

constexpr double kDegree = 3.14159265358979323846 / 180;

/// Positions of faces, without those at the same place.
std::vector<Point> used_points(const MeshFile& mesh) {
  std::vector<bool> used(mesh.position_count());
  for (const uint32_t v : mesh.corners) used[v] = true;
  std::vector<Point> points;
  for (size_t v = 0; v < used.size(); ++v) {
    const double* p = &mesh.positions[3 * v];
    if (used[v]) points.push_back({p[0], p[1], p[2]});
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

struct Extent {
  Point low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};

  explicit Extent(const std::vector<Point>& points) {
    for (const Point& p : points) {
      for (size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], p[k]);
        high[k] = std::max(high[k], p[k]);
      }
    }
  }
  double size(size_t k) const { return high[k] - low[k]; }
  double middle(size_t k) const { return (low[k] + high[k]) / 2; }
  double diagonal() const { return std::hypot(size(0), size(1), size(2)); }
};

/// Points in cells, to find the nearest one.
class Cells {
 public:
  Cells(const std::vector<Point>& points, double size) : points_(points), size_(size) {
    for (size_t i = 0; i < points.size(); ++i) cells_[key(cell(points[i]))].push_back(i);
  }
  /// The distance of the nearest point, or three cells if none is within that.
  double distance(const Point& p) const {
    const std::array<int64_t, 3> at = cell(p);
    double best = 3 * size_;
    for (int64_t ring = 0; ring <= 3 && best > static_cast<double>(ring - 1) * size_; ++ring) {
      for (int64_t x = -ring; x <= ring; ++x) {
        for (int64_t y = -ring; y <= ring; ++y) {
          for (int64_t z = -ring; z <= ring; ++z) {
            if (std::max({std::abs(x), std::abs(y), std::abs(z)}) != ring) continue;
            const auto found = cells_.find(key({at[0] + x, at[1] + y, at[2] + z}));
            if (found == cells_.end()) continue;
            for (const size_t i : found->second) {
              const Point& q = points_[i];
              best = std::min(best, std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
            }
          }
        }
      }
    }
    return best;
  }

 private:
  std::array<int64_t, 3> cell(const Point& p) const {
    std::array<int64_t, 3> out;
    for (size_t k = 0; k < 3; ++k) out[k] = static_cast<int64_t>(std::floor(p[k] / size_));
    return out;
  }
  static uint64_t key(const std::array<int64_t, 3>& c) {
    return static_cast<uint64_t>(c[0]) * 73856093u ^ static_cast<uint64_t>(c[1]) * 19349663u ^
           static_cast<uint64_t>(c[2]) * 83492791u;
  }

  const std::vector<Point>& points_;
  double size_;
  std::unordered_map<uint64_t, std::vector<size_t>> cells_;
};

/// Mean distance of mirrored points from the mesh, in shares of the diagonal. The plane goes through the
/// middle of the box; its normal is `axis`, turned by some degrees about `about`.
double mirror_error(const std::vector<Point>& points, const Cells& cells, const Extent& box,
                    size_t axis, size_t about, double degrees) {
  constexpr size_t kSamples = 400;
  Point normal = {};
  normal[axis] = std::cos(degrees * kDegree);
  normal[3 - axis - about] = std::sin(degrees * kDegree);
  Point center = {box.middle(0), box.middle(1), box.middle(2)};
  if (degrees != 0) {
    // The box of a turned head says little about its middle: that of the points along the normal.
    double low = INFINITY, high = -INFINITY;
    for (const Point& p : points) {
      const double along = p[0] * normal[0] + p[1] * normal[1] + p[2] * normal[2];
      low = std::min(low, along);
      high = std::max(high, along);
    }
    for (size_t k = 0; k < 3; ++k) center[k] = normal[k] * (low + high) / 2;
  }
  const size_t step = std::max<size_t>(1, points.size() / kSamples);
  double sum = 0, count = 0;
  for (size_t i = 0; i < points.size(); i += step) {
    const Point& p = points[i];
    double off = 0;
    for (size_t k = 0; k < 3; ++k) off += (p[k] - center[k]) * normal[k];
    Point mirrored;
    for (size_t k = 0; k < 3; ++k) mirrored[k] = p[k] - 2 * off * normal[k];
    sum += cells.distance(mirrored);
    count += 1;
  }
  return sum / count / box.diagonal();
}

/// The section through the middle from the top down: how far a nose stands out from what is beside it, and
/// how deep a throat lies below it, in shares of the height.
struct FaceSigns {
  double nose = 0, throat = 0;
};
FaceSigns find_signs(const std::vector<Point>& points, const Extent& box, const MeshStand& stand) {
  constexpr size_t kBins = 32;
  FaceSigns signs;
  const size_t across = stand.left_axis(), up = stand.up.axis;
  const double height = box.size(up), width = box.size(across);
  if (!(height > 0 && width > 0)) return signs;
  const double base = stand.up.sign > 0 ? box.low[up] : -box.high[up];
  // The front of the middle, and of what is beside it.
  std::array<double, kBins> middle, beside;
  middle.fill(-INFINITY);
  beside.fill(-INFINITY);
  for (const Point& p : points) {
    const double x = std::abs(p[across] - box.middle(across)) / (width / 2);
    const double at = (stand.height_of(p.data()) - base) / height * kBins;
    const size_t bin = std::min(kBins - 1, static_cast<size_t>(std::max(at, 0.0)));
    std::array<double, kBins>& line = x < 0.12 ? middle : beside;
    if (x < 0.12 || (x > 0.18 && x < 0.45))
      line[bin] = std::max(line[bin], stand.depth_of(p.data()));
  }
  for (size_t b = 1; b < kBins; ++b) {
    if (!std::isfinite(middle[b])) middle[b] = middle[b - 1];
    if (!std::isfinite(beside[b])) beside[b] = beside[b - 1];
  }
  // A coarse mesh has few positions in each bin.
  const std::array<double, kBins> found = beside;
  for (size_t b = 1; b + 1 < kBins; ++b) {
    beside[b] = std::max({found[b - 1], found[b], found[b + 1]});
  }
  size_t nose = kBins * 3 / 10;
  for (size_t b = nose; b < kBins * 9 / 10; ++b) {
    if (std::isfinite(beside[b]))
      signs.nose = std::max(signs.nose, (middle[b] - beside[b]) / height);
    if (middle[b] > middle[nose]) nose = b;
  }
  // The deepest place behind a line from the nose to what is lower.
  for (size_t low = kBins / 32; low < nose; ++low) {
    for (size_t b = low + 1; b < nose; ++b) {
      const double share = static_cast<double>(b - low) / static_cast<double>(nose - low);
      const double line = middle[low] + (middle[nose] - middle[low]) * share;
      if (std::isfinite(line)) signs.throat = std::max(signs.throat, (line - middle[b]) / height);
    }
  }
  return signs;
}

/// Whether the other sign of an axis is that much plainer.
bool is_plainer(double other, double given, double least) {
  return other > least && other > 1.5 * given;
}

/// The plane of symmetry and an angle, where no axis of the file will do.
void find_turn(const std::vector<Point>& points, const Cells& cells, const Extent& box,
               double alike, StandGuess& guess) {
  constexpr double kLeastTurn = 8, kBetter = 0.6;
  for (size_t axis = 0; axis < 3; ++axis) {
    for (size_t about = 0; about < 3; ++about) {
      for (double degrees = -44; degrees <= 44 && about != axis; degrees += 4) {
        if (std::abs(degrees) < kLeastTurn) continue;
        const double here = mirror_error(points, cells, box, axis, about, degrees);
        if (here > kBetter * alike) continue;
        alike = here / kBetter;  // the next one has to be better than this
        guess.turned_degrees = degrees;
        guess.turned_about = about;
      }
    }
  }
}

}  // namespace

StandGuess guess_stand(const MeshFile& mesh, const MeshStand& given) {
  // Shares of the diagonal; halves that differ by less than kAlike are those of a head.
  constexpr double kAlike = 0.012, kMuchWorse = 0.008;
  constexpr double kNose = 0.02, kThroat = 0.06;  // of the height
  StandGuess guess;
  guess.stand = given;
  const std::vector<Point> points = used_points(mesh);
  const Extent box(points);
  if (points.size() < 50 || !(box.diagonal() > 0)) return guess;
  const Cells cells(points, box.diagonal() / 48);
  double errors[3];
  for (size_t axis = 0; axis < 3; ++axis) {
    errors[axis] = mirror_error(points, cells, box, axis, (axis + 1) % 3, 0);
  }
  guess.symmetry_error = errors[given.left_axis()];
  const size_t best = static_cast<size_t>(std::min_element(errors, errors + 3) - errors);
  if (errors[best] > kAlike) {
    find_turn(points, cells, box, errors[best], guess);
    return guess;
  }
  // Left and right are where the halves are alike. A head is higher than it is deep.
  MeshStand& stand = guess.stand;
  const bool is_aside = guess.symmetry_error > errors[best] + kMuchWorse;
  const size_t left = is_aside ? best : given.left_axis();
  if (is_aside) {
    const size_t a = (left + 1) % 3, b = (left + 2) % 3;
    const bool up_stays = given.up.axis != left;
    const size_t up = up_stays ? given.up.axis : box.size(a) > box.size(b) ? a : b;
    stand = {{up, up_stays ? given.up.sign : 1}, {3 - left - up, 1}};
  }
  // Unless a snout is what makes it deep.
  constexpr double kSnout = 0.3;
  if (box.size(stand.front.axis) > 1.1 * box.size(stand.up.axis) &&
      find_signs(points, box, stand).nose < kSnout) {
    std::swap(stand.up.axis, stand.front.axis);
    stand.up.sign = stand.front.sign = 1;
  }
  // Which end is the head of a body, and what is the rest of it.
  MeshStand other = stand;
  other.up.sign = -stand.up.sign;
  BodyGuess body = guess_body(mesh, stand);
  if (!body.is_body && guess_body(mesh, other).is_body) {
    stand = other;
    body = guess_body(mesh, stand);
  }
  const double top = stand.up.sign > 0 ? box.high[stand.up.axis] : -box.low[stand.up.axis];
  std::vector<Point>
      head;  // of a body without the shoulders, which also have a middle that stands out
  for (const Point& p : points) {
    if (!body.is_body || stand.height_of(p.data()) > top - body.head_height) head.push_back(p);
  }
  const Extent head_box(head);
  const auto signs_of = [&](double up, double front) {
    MeshStand turned = stand;
    turned.up.sign *= up;
    turned.front.sign *= front;
    return find_signs(head, head_box, turned);
  };
  if (is_plainer(signs_of(1, -1).nose, signs_of(1, 1).nose, kNose)) stand.front.sign *= -1;
  if (!body.is_body && is_plainer(signs_of(-1, 1).throat, signs_of(1, 1).throat, kThroat)) {
    stand.up.sign *= -1;
  }
  return guess;
}

BodyGuess guess_body(const MeshFile& mesh, const MeshStand& stand) {
  constexpr size_t kSlices = 96;
  constexpr double kShoulders = 1.6;               // of the width of the neck
  constexpr double kBody = 3.2;                    // heads, from which on there is more than a bust
  constexpr double kBelow = 0.55, kBeside = 0.45;  // of the head's height: what is kept
  BodyGuess guess;
  std::fill(guess.low, guess.low + 3, -INFINITY);
  std::fill(guess.high, guess.high + 3, INFINITY);
  const std::vector<Point> points = used_points(mesh);
  if (points.size() < 50) return guess;
  const Extent box(points);
  const size_t up = stand.up.axis, across = stand.left_axis();
  guess.height = box.size(up);
  if (!(guess.height > 0)) return guess;
  const double top = stand.up.sign > 0 ? box.high[up] : -box.low[up];
  // From the top down: half widths about the middle.
  std::vector<double> widths(kSlices);
  for (const Point& p : points) {
    const double down = (top - stand.height_of(p.data())) / guess.height * kSlices;
    double& width = widths[std::min(kSlices - 1, static_cast<size_t>(std::max(down, 0.0)))];
    width = std::max(width, std::abs(p[across] - box.middle(across)));
  }
  // A coarse mesh has no position in some slices.
  std::vector<double> smooth(kSlices);
  for (size_t s = 0; s < kSlices; ++s) {
    const size_t from = s > 1 ? s - 1 : 0, to = std::min(s + 2, kSlices);
    smooth[s] = *std::max_element(widths.begin() + static_cast<std::ptrdiff_t>(from),
                                  widths.begin() + static_cast<std::ptrdiff_t>(to));
  }
  widths = smooth;
  size_t widest = 0, neck = 0;
  for (size_t s = 0; s < kSlices; ++s) {
    if (widths[s] == 0) continue;
    if (neck > 0 && widths[s] > kShoulders * widths[neck]) {
      guess.head_height = guess.height * (static_cast<double>(neck) + 0.5) / kSlices;
      break;
    }
    if (widths[s] > widths[widest]) {
      if (neck == 0) widest = s;
    } else if (widths[s] < 0.8 * widths[widest] && (neck == 0 || widths[s] < widths[neck])) {
      neck = s;
    }
  }
  // Heads are higher than wide, but not by much.
  const double wide = 2 * widths[widest];
  if (guess.head_height < 0.8 * wide || guess.head_height > 2.5 * wide) guess.head_height = 0;
  guess.is_body = guess.head_height > 0 && guess.height > kBody * guess.head_height;
  if (!guess.is_body) return guess;
  const double lowest = top - (1 + kBelow) * guess.head_height;
  (stand.up.sign > 0 ? guess.low : guess.high)[up] = stand.up.sign * lowest;
  guess.low[across] = box.middle(across) - kBeside * guess.head_height;
  guess.high[across] = box.middle(across) + kBeside * guess.head_height;
  return guess;
}

UnitGuess guess_unit(double head_height) {
  // Heads of 12 to 60 cm, with or without neck and shoulders; inches where no other unit fits.
  const struct {
    double least, most;
    UnitGuess unit;
  } units[] = {{0.12, 0.6, {100, "m"}},
               {1.2, 6, {10, "dm"}},
               {6, 12, {2.54, "in"}},
               {12, 120, {1, "cm"}},
               {120, 600, {0.1, "mm"}}};
  for (const auto& known : units) {
    if (head_height >= known.least && head_height < known.most) return known.unit;
  }
  return {};
}

}  // namespace mien::cli
