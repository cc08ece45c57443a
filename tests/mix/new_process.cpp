// SPDX-License-Identifier: MIT
// A mix and its snapshots continue in another process with the same results.
//
//     new_process take FOLDER         plays a scene, takes 100 snapshots of it, and writes the mix, the
//                                     snapshots, and the hash of the frames after each
//     new_process continue FOLDER     continues from each snapshot in a new mixer, and compares
#include <cstdio>
#include <fstream>
#include <iterator>

#include "runtime/mix/mix_file.h"
#include "tests/support/bytes.h"
#include "tests/support/mix_scene.h"

namespace {

using namespace mien;
constexpr int kSnapshots = 100;

Bytes read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(file), {});
}

void write(const std::string& path, const void* bytes, size_t size) {
  std::ofstream file(path, std::ios::binary);
  file.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
  scene_requires(file.flush().good() ? Status::kOk : Status::kFileWrite);
}

/// What both do. Streams get no rows: those that wait are no part of a snapshot.
uint64_t go_on(SceneActor& actor) {
  uint64_t hash = kHashStart;
  Error error;
  for (int64_t step = 0; step < 100; ++step) {
    if (step % 50 == 30) {
      LayerPlayDesc desc;
      desc.play.looping = Looping::kLoop;
      desc.transition = step == 30 ? Transition::kCrossfade : Transition::kInertial;
      actor.play(MixScene::kSpeech, static_cast<uint32_t>(step) % MixScene::kClips, desc);
    }
    if (step == 50) scene_requires(trigger(*actor.mixer, 0, 1, kTicksPerSecond / 2, error));
    hash = hash_floats(hash, actor.step(kSceneStep + step), actor.scene.mix->curve_count);
  }
  return hash;
}

int take(const std::string& folder) {
  const MixScene scene(24);
  SceneActor actor(scene, 9);
  actor.begin();
  Random random = Random::from_seed(10, 0);
  const size_t snapshot_bytes = snapshot_size(*scene.mix);
  Bytes snapshots(kSnapshots * snapshot_bytes);
  std::vector<uint64_t> hashes;
  Error error;
  for (size_t i = 0; i < kSnapshots; ++i) {
    for (uint32_t steps = random.below(40); steps > 0; --steps) {
      actor.disturb(random);
      actor.step(kSceneStep);
    }
    for (int step = 0; step < 40; ++step) actor.step(kSceneStep);  // the stream ends
    // In the middle of a transition, a fade and a reaction.
    LayerPlayDesc desc;
    desc.transition = static_cast<Transition>(random.below(3));
    actor.play(MixScene::kBase, random.below(MixScene::kClips), desc);
    scene_requires(set_layer_weight(*actor.mixer, MixScene::kMood, 0.25f, kTicksPerSecond, error));
    scene_requires(trigger(*actor.mixer, 0, 0.75f, kTicksPerSecond / 3, error));
    for (uint32_t steps = random.below(30); steps > 0; --steps) actor.step(kSceneStep);
    const Span<uint8_t> snapshot = {snapshots.data() + i * snapshot_bytes, snapshot_bytes};
    scene_requires(take_snapshot(*actor.mixer, snapshot, error));
    hashes.push_back(go_on(actor));
  }

  size_t size = 0;
  scene_requires(write_mix(*scene.mix, {}, size, error));
  Bytes mix(size);
  scene_requires(write_mix(*scene.mix, {mix.data(), size}, size, error));
  write(folder + "/new_process.mix", mix.data(), mix.size());
  write(folder + "/new_process.snapshots", snapshots.data(), snapshots.size());
  write(folder + "/new_process.hashes", hashes.data(), hashes.size() * sizeof(uint64_t));
  return 0;
}

int continue_there(const std::string& folder) {
  const Bytes mix = read(folder + "/new_process.mix");
  const Bytes snapshots = read(folder + "/new_process.snapshots");
  const Bytes hashes = read(folder + "/new_process.hashes");
  MixScene scene(24);  // for its clips
  release(scene.mix);
  Error error;
  // Its raw controls come in the order of their names without a rig, so this is one with the
  // names of the scene.
  std::string chars;
  std::vector<uint32_t> ends = {0};
  for (uint32_t l = 0; l < scene.raw_count; ++l) {
    chars += "control" + std::to_string(l);
    ends.push_back(static_cast<uint32_t>(chars.size()));
  }
  Rig rig;
  rig.raw_count = scene.raw_count;
  rig.names[static_cast<size_t>(Kind::kRawControl)] = {
      {ends.data(), ends.size()}, {&chars[0], chars.size()}, {}};
  scene.mix = nullptr;
  scene_requires(open_mix({mix.data(), mix.size()}, &rig, default_allocator(), scene.mix, error));
  const size_t bytes = snapshot_size(*scene.mix);
  if (snapshots.size() != kSnapshots * bytes || hashes.size() != kSnapshots * sizeof(uint64_t)) {
    std::fprintf(stderr, "the files have other sizes\n");
    return 1;
  }
  for (size_t i = 0; i < kSnapshots; ++i) {
    SceneActor actor(scene, 1);
    scene_requires(restore_snapshot(*actor.mixer, {snapshots.data() + i * bytes, bytes},
                                    scene.finder(), error));
    const uint64_t hash = go_on(actor);
    if (memcmp(hashes.data() + i * sizeof(hash), &hash, sizeof(hash)) == 0) continue;
    std::fprintf(stderr, "from snapshot %zu it went on in another way\n", i);
    return 1;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc == 3 ? argv[1] : "";
  if (what == "take") return take(argv[2]);
  if (what == "continue") return continue_there(argv[2]);
  return 2;
}
