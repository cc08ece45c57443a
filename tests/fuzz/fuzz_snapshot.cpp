// SPDX-License-Identifier: MIT
// Any bytes as a snapshot of a mixer in which everything is on. What is refused changes nothing; what
// is accepted goes on: steps with finite values, plays, triggers, snapshots that are accepted. Those to start from are made here; mutations keep the header right most of the time.
#include <cmath>
#include <cstdlib>
#include <random>

#include "tests/support/bytes.h"
#include "tests/support/mix_scene.h"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t max_size);

namespace {

using namespace mien;

constexpr size_t kHeaderSize = 24;

const MixScene& scene() {
  static const MixScene made(9);
  return made;
}

Bytes snapshot_of(SceneActor& actor) {
  Bytes bytes(snapshot_size(*actor.scene.mix));
  Error error;
  scene_requires(take_snapshot(*actor.mixer, {bytes.data(), bytes.size()}, error));
  return bytes;
}

std::vector<Bytes>& seeds() {
  static std::vector<Bytes> snapshots;
  return snapshots;
}

void use(SceneActor& actor, uint64_t seed) {
  Random random = Random::from_seed(seed, 0);
  actor.pushed = actor.mixer->header->now;
  for (int step = 0; step < 8; ++step) {
    actor.disturb(random);
    const float* row = actor.step(step == 0 ? 0 : kSceneStep);
    for (uint32_t l = 0; l < actor.scene.mix->curve_count; ++l) {
      if (!std::isfinite(row[l])) abort();
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  for (uint64_t seed = 0; seed < 8; ++seed) {
    SceneActor actor(scene(), seed);
    if (seed != 0) actor.begin();
    Random random = Random::from_seed(seed, 1);
    for (uint64_t step = 0; step < 40 * seed; ++step) {
      actor.disturb(random);
      actor.step(kSceneStep);
    }
    seeds().push_back(snapshot_of(actor));
  }
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size,
                                          unsigned seed) {
  std::minstd_rand random(seed);
  for (int i = 0; i < 3; ++i) random();  // the first numbers of near seeds are near
  const Bytes& good = seeds()[random() % seeds().size()];
  if (max_size < good.size()) return LLVMFuzzerMutate(data, size, max_size);
  if (size != good.size() || random() % 64 == 0) memcpy(data, good.data(), size = good.size());
  if (random() % 4 == 0) size = LLVMFuzzerMutate(data, size, max_size);
  // Numbers as they are in memory: times, indices, floats.
  for (uint32_t left = random() % 4; left > 0 && size > kHeaderSize + 8; --left) {
    const size_t at = kHeaderSize + random() % ((size - kHeaderSize) / 4) * 4;
    const uint32_t values[] = {0,          1,          0xFFFF,     0x7FFFFFFF,
                               0x80000000, 0x3F800000, 0x7F7FFFFF, static_cast<uint32_t>(random())};
    const uint32_t value = values[random() % 8];
    if (at + sizeof(value) <= size) memcpy(data + at, &value, sizeof(value));
  }
  if (random() % 16 != 0 && size >= kHeaderSize) memcpy(data, good.data(), kHeaderSize);
  return size;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  SceneActor actor(scene(), 1);
  const Bytes before = snapshot_of(actor);
  Error error;
  const Status status = restore_snapshot(*actor.mixer, {data, size}, scene().finder(), error);
  if (status != Status::kOk) {
    if (error.message[0] == 0 || snapshot_of(actor) != before) abort();
    return 0;
  }
  use(actor, size != 0 ? data[size - 1] : 0);
  if (actor.mixer->header->now > kMaxMixerTime) return 0;
  // What it writes then, any other mixer accepts.
  const Bytes after = snapshot_of(actor);
  SceneActor other(scene(), 2);
  scene_requires(
      restore_snapshot(*other.mixer, {after.data(), after.size()}, scene().finder(), error));
  return 0;
}
