// SPDX-License-Identifier: MIT
// Any bytes as a mix: opened, with and without a rig, mixed, written again as bytes and as text. Those
// to start from are made here; mutations change fields and lists (mix_mutator.h), and keep size and checksum
// right most of the time.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

#include "runtime/mix/mix_file.h"
#include "tests/fuzz/mix_mutator.h"
#include "tests/support/bytes.h"
#include "tests/support/mix_scene.h"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t max_size);

namespace {

using namespace mien;

Bytes written(const Mix& mix) {
  size_t size = 0;
  Error error;
  scene_requires(write_mix(mix, {}, size, error));
  Bytes bytes(size);
  scene_requires(write_mix(mix, {bytes.data(), size}, size, error));
  return bytes;
}

const Bytes& good() {
  static const Bytes bytes = written(*MixScene(9).mix);
  return bytes;
}

/// Eleven controls, of which the scene has nine.
const Rig& rig() {
  static std::string chars;
  static std::vector<uint32_t> ends = {0};
  static Rig made;
  if (chars.empty()) {
    for (uint32_t l = 11; l > 0; --l) {
      chars += "control" + std::to_string(l - 1);
      ends.push_back(static_cast<uint32_t>(chars.size()));
    }
    made.raw_count = 11;
    made.names[static_cast<size_t>(Kind::kRawControl)] = {
        {ends.data(), ends.size()}, {&chars[0], chars.size()}, {}};
  }
  return made;
}

void use(const Mix& mix) {
  const Bytes bytes = written(mix);
  Mix* again = nullptr;
  Error error;
  scene_requires(
      open_mix({bytes.data(), bytes.size()}, nullptr, default_allocator(), again, error));
  if (written(*again) != bytes) abort();
  release(again);
  size_t size = 0;
  scene_requires(write_mix_text(mix, {}, size, error));
  std::vector<char> text(size);
  scene_requires(write_mix_text(mix, {text.data(), size}, size, error));
  if (mixer_size(mix, false) > 1 << 20) return;
  Mixer* mixer = create_mixer(mix, 1, false, default_allocator());
  if (!mixer) abort();
  for (uint32_t r = 0; r < mix.reactions.count; ++r) {
    scene_requires(trigger(*mixer, r, 1, kUntilReleased, error));
    if (mix.reactions[r].level_on > 0) scene_requires(set_level(*mixer, r, 1, error));
  }
  for (uint32_t l = 0; l < mix.layers.count; ++l) {
    for (uint32_t p = 0; p < mix.layers[l].pose_count; ++p) {
      scene_requires(set_pose_weight(*mixer, l, p, 1, kSceneStep, error));
    }
  }
  for (int i = 0; i < 4; ++i) {
    step_mixer(*mixer, 5 * kSceneStep, nullptr, 0, nullptr);
    for (float value : mixer->row) {
      if (!std::isfinite(value)) abort();
    }
  }
  release(mixer);
}

}  // namespace

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size,
                                          unsigned seed) {
  std::minstd_rand random(seed);
  for (int i = 0; i < 3; ++i) random();  // the first numbers of near seeds are near
  if (max_size < good().size()) return LLVMFuzzerMutate(data, size, max_size);
  if (size < kMixHeaderSize || random() % 64 == 0)
    memcpy(data, good().data(), size = good().size());
  if (random() % 4 != 0) {
    Bytes mix(data, data + size);
    MixMutator mutator(mix, seed);
    for (uint32_t changes = 1 + random() % 3; changes != 0; --changes) mutator.change();
    mutator.seal();
    if (mix.size() > max_size) return size;
    std::copy(mix.begin(), mix.end(), data);
    return mix.size();
  }
  // Behind the header, that most inputs need.
  size = kMixHeaderSize +
         LLVMFuzzerMutate(data + kMixHeaderSize, size - kMixHeaderSize, max_size - kMixHeaderSize);
  if (random() % 16 == 0) return size;
  memcpy(data, good().data(), kMixHeaderSize);
  store_little_endian(data + kAtSize, uint64_t{size});
  store_little_endian(data + kAtChecksum, clip_checksum(data, size));
  return size;
}

// Layers, poses, guards of another mix.
extern "C" size_t LLVMFuzzerCustomCrossOver(const uint8_t* a, size_t a_size, const uint8_t* b,
                                            size_t b_size, uint8_t* out, size_t max_size,
                                            unsigned seed) {
  Bytes mix(a, a + a_size);
  MixMutator mutator(mix, seed);
  mutator.take_element({b, b_size});
  mutator.seal();
  if (mix.size() > max_size) return 0;
  std::copy(mix.begin(), mix.end(), out);
  return mix.size();
}

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  if (MixPlaces({good().data(), good().size()}).at != good().size())
    abort();  // not all fields would change
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  for (const Rig* of : {static_cast<const Rig*>(nullptr), &rig()}) {
    Mix* mix = nullptr;
    Error error;
    const Status status = open_mix({data, size}, of, default_allocator(), mix, error);
    if (status != Status::kOk) {
      if (error.message[0] == 0 || mix) abort();
      continue;
    }
    use(*mix);
    release(mix);
  }
  return 0;
}
