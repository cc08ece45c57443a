// SPDX-License-Identifier: MIT
// Locks: cards that grow all over the scalp and follow the way that hairs are combed, those from above over those below;
// more at the hair line of the forehead, and thin hairs along all of the line. The ways of hairs are found on a map of
// the scalp as seen from above, with the crown in the middle and the border of the hair at distance 1.
#include <algorithm>

#include "author/generate/head/scalp.h"

namespace mien::head {

using author::clamp01;
using author::exact_sine;
using author::exact_sine_cosine;
using author::kPi;
using author::mix;
using author::smooth_step;

namespace {

/// Tufts are the tips of locks.
HairLane tuft(HairLane lane) {
  lane.root += 0.16;
  return lane;
}

struct Lock {
  MapPlace root;
  double length, half_width;  // cm
  double from, over;          // height of root and rest, of the thickness of the hair
  double rise;                // the way over which it gets there, cm
  double turn = 0;            // angle by which it leaves the way that others lie
  double reach = 1;           // distance on the map where it ends
  uint32_t number;
  HairLane lane;
  uint32_t rows;
};

/// Fewer than of other hairs at coarse LODs, where shells do.
uint32_t locks_at(uint32_t full, uint32_t least, uint32_t lod) {
  return at_lod(full, least, lod < 2 ? 2 * lod : std::min(lod + 2, kLodCount - 1));
}

class LockMaker {
 public:
  LockMaker(const Scalp& scalp, uint32_t lod, HalfMesh& out)
      : scalp_(scalp), shape_(scalp.shape()), lod_(lod), out_(out), hangs_(shape_.hang < 0) {}

  void make() {
    // Shells do for short hair, and for all of it from afar.
    if (!hangs_ && lod_ < (shape_.shells > 1 ? 3 : 4)) {
      add_all_over();
      add_front();
      if (shape_.parting > 0) add_parting();
    }
    add_thin_hairs();
    if (lod_ == 0 && shape_.top > 3 && !hangs_) add_loose_hairs();
  }

 private:
  bool grows(const Lock& lock, Scalp::Root* roots, MapPlace* places, double& size) const;
  void add(const Lock& lock);
  MapPlace place(double around, double t) const {
    const auto [sine, cosine] = exact_sine_cosine(around);
    return {(1 - t) * sine, (1 - t) * cosine};
  }
  double length_at(double row) const {
    return mix(shape_.sides, shape_.top, smooth_step(2.0, 7.5, row));
  }
  void add_all_over();
  void add_front();
  void add_parting();
  void add_thin_hairs();
  void add_loose_hairs();

  const Scalp& scalp_;
  const HairShape& shape_;
  const uint32_t lod_;
  HalfMesh& out_;
  const bool hangs_;
};

/// Places along a lock, evenly; shorter if it would leave the hair. False if there is no room.
bool LockMaker::grows(const Lock& lock, Scalp::Root* roots, MapPlace* places, double& size) const {
  size = lock.length;
  for (const bool last : {false, true}) {
    double scale = 0.07;  // map per cm
    const double step = size / (lock.rows - 1);
    double reached = size;
    MapPlace p = places[0] = lock.root;
    roots[0] = scalp_.root(p.around(), 1 - p.far());
    for (uint32_t k = 1; k < lock.rows; ++k) {
      MapPlace next = p;
      for (int correction = 0; correction < 2; ++correction) {
        const double far = scale * step;
        const MapPlace half = combed(scalp_, p, lock.turn);
        const MapPlace d =
            combed(scalp_, {p.x + 0.5 * far * half.x, p.z + 0.5 * far * half.z}, lock.turn);
        next = {p.x + far * d.x, p.z + far * d.z};
        roots[k] = scalp_.root(next.around(), 1 - next.far());
        const double cm = length(roots[k].skin - roots[k - 1].skin);
        scale *= std::min(std::max(step / std::max(cm, 1e-6), 0.3), 3.0);
      }
      if (next.far() > lock.reach && next.far() > p.far()) {
        const double share = clamp01((lock.reach - p.far()) / (next.far() - p.far()));
        if (!last) {
          reached = (k - 1 + share) * step;
          break;
        }
        next = {mix(p.x, next.x, share), mix(p.z, next.z, share)};
        roots[k] = scalp_.root(next.around(), 1 - next.far());
      }
      places[k] = p = next;
    }
    if (reached == size) return true;
    size = reached;
    if (size < 0.55 * lock.length) return false;
  }
  return true;
}

void LockMaker::add(const Lock& lock) {
  Scalp::Root roots[kMaxCardRows];
  MapPlace places[kMaxCardRows];
  double size;
  if (!grows(lock, roots, places, size)) return;
  const Color hair = scalp_.person().hair;
  const double shade = scatter(lock.number + 600);
  // The sides of a flat card are farther out than its middle.
  const double flat = lock.half_width * lock.half_width / 16;
  CardRow rows[kMaxCardRows];
  for (uint32_t k = 0; k < lock.rows; ++k) {
    const double s = static_cast<double>(k) / (lock.rows - 1);
    const double body = scalp_.body(places[k].around(), 1 - places[k].far(), roots[k]);
    const double height = 0.012 +
                          body * mix(lock.from, lock.over, smooth_step(0, lock.rise, s * size)) -
                          flat * (lock.from == 0 ? smooth_step(0.1, 0.4, s) : 1);
    Color c = mix(hair, {14, 10, 9}, clamp01(0.16 + 0.12 * shade + 0.22 * smooth_step(0.3, 0, s)));
    // Skin shows between hairs at the line and where they are few, which without a texture the color has to tell.
    const double few = 0.9 * (1 - scalp_.density(roots[k].row)) + (lock.over < 0.6 ? 0.4 : 0);
    const double grown = lock.from == 0 ? smooth_step(-0.3, 0.35, s) : 1;
    c = mix(c, scalp_.person().skin, clamp01(few + 1 - grown));
    rows[k].middle = scalp_.above(roots[k], height, c);
  }
  for (uint32_t k = 0; k < lock.rows; ++k) {
    const double s = static_cast<double>(k) / (lock.rows - 1);
    const Vec3 along = rows[std::min(k + 1, lock.rows - 1)].middle.position -
                       rows[k > 0 ? k - 1 : 0].middle.position;
    const double wide =
        mix(0.75, 1, smooth_step(0, 0.25, s)) * mix(1, 0.5, smooth_step(0.55, 1, s));
    rows[k].half = normalized(cross(along, roots[k].normal)) * (lock.half_width * wide);
  }
  add_card(rows, lock.rows, lock.lane, out_, 0.3);
}

/// Evenly over the scalp, in a spiral from the crown.
void LockMaker::add_all_over() {
  const uint32_t count = locks_at(2 * shape_.locks, 30, lod_);
  const double wider = std::sqrt(2.0 * shape_.locks / count);
  static constexpr uint32_t kRows[] = {6, 6, 5, 4};
  const uint32_t rows = kRows[std::min(lod_, 3u)];
  constexpr double kTurn = 2.39996322972865332;  // golden
  for (uint32_t i = 0; i < count; ++i) {
    // Denser towards the crown, where ways part.
    const double row = 12.5 - 20 * author::exact_pow((i + 0.5) / count, 1.3);
    if (row < -6) break;
    const double turns = kTurn * i / (2 * kPi);
    const double around = 2 * kPi * (turns - std::floor(turns)) - kPi;
    if (row < scalp_.line(around) + 0.25) continue;
    // Short hair is that of the shells.
    if (length_at(row) < 1.3) continue;
    const double dense = scalp_.density(row);
    Lock lock{};
    lock.root = place(around, scalp_.share_of(around, row));
    lock.length = length_at(row) * (1 + 0.18 * scatter(i));
    lock.half_width = (shape_.curls ? 0.75 : std::min(0.60, 0.20 * length_at(row))) *
                      (1 + 0.2 * scatter(i + 100)) * wider;
    lock.half_width *= mix(0.75, 1, smooth_step(1, 6, row));
    lock.from = 0.45;
    // Those from above lie over those from below.
    lock.over = mix(0.84, 1.05, smooth_step(-6, 13, row)) + 0.02 * scatter(i + 200);
    lock.rise = 0.45 * std::min(lock.length, 3.5);
    lock.turn = (shape_.curls ? 0.9 : 0.12) * scatter(i + 300);
    lock.reach = 1.01 + 0.025 * scatter(i + 400);
    lock.number = i;
    lock.lane = shape_.curls                        ? curl_lane(i)
                : dense > 0.95                      ? lock_lane(i)
                : scatter(i + 50) < 5 * dense - 3.4 ? line_lane()
                                                    : thin_lane();
    if (lock.length < 2.5 && !shape_.curls) lock.lane = tuft(lock.lane);
    lock.rows = lock.length < 3.5 ? std::min(rows, 5u) : rows;
    add(lock);
  }
}

/// From the line of the forehead and the temples up.
void LockMaker::add_front() {
  const uint32_t count = at_lod(66, 14, lod_);
  const double until = lod_ == 0 ? 0.43 : 0.33;
  for (uint32_t i = 0; i < count; ++i) {
    const double around = kPi * until * (2 * (i + 0.5 + 0.35 * scatter(i + 40)) / count - 1);
    Lock lock{};
    const double temple = smooth_step(0.22, 0.32, std::abs(around) / kPi);
    lock.root = place(around, 0.015 + 0.02 * temple + 0.03 * scatter(i + 41));
    lock.length =
        0.8 * std::min(length_at(scalp_.line(around) + 1), 9.0) * (1 + 0.2 * scatter(i + 42));
    lock.half_width = mix(0.55, 0.38, temple) * std::sqrt(66.0 / count);
    lock.from = 0;
    lock.over = 0.94 + 0.05 * scatter(i + 43);
    lock.rise = 0.5 * std::min(lock.length, 4.0);
    lock.turn = 0.15 * scatter(i + 44);
    lock.reach = 1.05;
    lock.number = 7000 + i;
    if (lock.length < 1.4) continue;
    const bool thin = scatter(i + 45) > 10 * scalp_.density(scalp_.line(around) + 0.5) - 7.5;
    lock.lane = shape_.curls ? curl_lane(i) : thin ? thin_lane() : line_lane();
    lock.rows = lod_ < 2 ? 5 : 4;
    add(lock);
  }
}

/// Away from both sides of the parting.
void LockMaker::add_parting() {
  const uint32_t count = locks_at(56, 12, lod_);
  const auto [sine, cosine] = exact_sine_cosine(kParting);
  for (uint32_t i = 0; i < count; ++i) {
    const double side = i % 2 == 0 ? 1 : -1, along = mix(0.04, 0.97, (i + 0.5) / count);
    const double off = side * (0.012 + 0.008 * scatter(i + 20));
    Lock lock{};
    lock.root = {along * sine + off * cosine, along * cosine - off * sine};
    lock.length = 6.0 * (1 + 0.15 * scatter(i + 21));
    lock.half_width = 0.6 * std::sqrt(56.0 / count);
    lock.from = 0.55;
    lock.over = 1.06 + 0.03 * scatter(i + 22);
    lock.rise = 1.8;
    lock.turn = 0.1 * scatter(i + 23);
    lock.reach = 1.01 + 0.025 * scatter(i + 24);
    lock.number = 6000 + i;
    lock.lane = lock_lane(i);
    lock.rows = lod_ < 3 ? 6 : 4;
    add(lock);
  }
}

/// Short thin hairs along the line, so that it is not an edge.
void LockMaker::add_thin_hairs() {
  const uint32_t count = locks_at(120, 22, lod_);
  const double until = hangs_ ? 0.29 : 1;
  for (uint32_t i = 0; i < count; ++i) {
    const double around = kPi * until * (2 * (i + 0.5 + 0.4 * scatter(i + 60)) / count - 1);
    const double share = std::abs(around) / kPi;
    if (share > 0.447 && share < 0.50) continue;  // the ear
    const MapPlace there = place(around, 0), d = combed(scalp_, there, 0);
    // Where hairs leave the line they begin above it.
    const bool leaves = d.x * there.x + d.z * there.z > 0.3;
    Lock lock{};
    lock.root = place(around, (leaves ? 0.035 : hangs_ ? 0.006 : -0.012) + 0.02 * scatter(i + 61));
    lock.length = (hangs_ ? 0.7 : 1.1) + 0.35 * scatter(i + 62);
    lock.half_width = 0.40 * std::sqrt(120.0 / count);
    lock.from = 0;
    lock.over = 0.35 + 0.2 * scatter(i + 63);
    lock.rise = 1.2;
    // Elsewhere they stand up rather than along it.
    const double side = there.z * d.x - there.x * d.z;
    lock.turn = 0.35 * scatter(i + 64) + (leaves ? 0 : side > 0 ? 0.5 : -0.5);
    lock.reach = 1.2;
    lock.number = 8000 + i;
    lock.lane = thin_lane();
    lock.rows = 3;
    add(lock);
  }
}

/// A few single hairs above the others.
void LockMaker::add_loose_hairs() {
  const uint32_t count = locks_at(28, 4, lod_);
  for (uint32_t i = 0; i < count; ++i) {
    const double row = mix(3.5, 12, (i + 0.5) / count), around = kPi * scatter(i + 70);
    if (row < scalp_.line(around) + 1) continue;
    Lock lock{};
    lock.root = place(around, scalp_.share_of(around, row));
    lock.length = 0.9 * length_at(row);
    lock.half_width = 0.5;
    lock.from = 0.9;
    lock.over = 1.08 + 0.03 * scatter(i + 71);
    lock.rise = 3;
    lock.turn = 0.35 * scatter(i + 72);
    lock.reach = 1.02;
    lock.number = 9000 + i;
    lock.lane = loose_lane();
    lock.rows = 6;
    add(lock);
  }
}

}  // namespace

/// Hanging hair falls away from the parting and the crown, and somewhat back.
static MapPlace hanging_way(MapPlace at) {
  const double share = std::abs(at.around()) / kPi, far = std::max(at.far(), 1e-3);
  const auto [sine, cosine] = exact_sine_cosine(kParting);
  const double along = std::min(std::max(at.x * sine + at.z * cosine, 0.0), 1.0);
  const MapPlace from = {at.x - along * sine, at.z - along * cosine};
  const double away = std::max(from.far(), 1e-6);
  const double back = mix(0.12, 0.40, smooth_step(0.52, 0.20, share)) * smooth_step(0, 0.08, away) *
                      smooth_step(0.95, 0.6, far);
  const MapPlace out = {at.x / far, at.z / far};
  const double down = smooth_step(0.35, 0.75, far) * smooth_step(0.30, 0.42, share);
  MapPlace d = {mix(from.x / away, out.x, down), mix(from.z / away - back, out.z, down)};
  // Along the line of the forehead, not across it.
  const double held = std::max(0.0, d.x * out.x + d.z * out.z) * smooth_step(0.88, 0.98, far) *
                      smooth_step(0.42, 0.34, share);
  return {d.x - held * out.x, d.z - held * out.z};
}

/// Down on the sides and behind, over the crown back; over the forehead away from the parting, and back.
static MapPlace lying_way(const Scalp& scalp, MapPlace at) {
  const double far = std::max(at.far(), 1e-3), share = std::abs(at.around()) / kPi;
  const auto [sine, cosine] = exact_sine_cosine(kParting);
  const double side = at.x * cosine - at.z * sine > 0 ? 1 : -1;
  const double crown = smooth_step(10.9, 12.4, scalp.row_of(at.around(), 1 - far));
  const double front = smooth_step(0.52, 0.20, share) * (1 - crown);
  const MapPlace down = {at.x / far * (1 - crown), mix(at.z / far, -1, crown)};
  const double back = scalp.shape().swept, aside = front * side * (1 - 0.5 * back);
  return {aside * cosine + (1 - front) * down.x,
          -aside * sine - front * back + (1 - front) * (down.z - 0.35 * back)};
}

MapPlace combed(const Scalp& scalp, MapPlace at, double turn) {
  MapPlace d = scalp.shape().hang < 0 ? hanging_way(at) : lying_way(scalp, at);
  const auto [s, c] = exact_sine_cosine(turn);
  d = {c * d.x + s * d.z, c * d.z - s * d.x};
  const double size = std::max(d.far(), 1e-6);
  return {d.x / size, d.z / size};
}

void add_locks(const Scalp& scalp, uint32_t lod, HalfMesh& out) {
  LockMaker(scalp, lod, out).make();
}

}  // namespace mien::head
