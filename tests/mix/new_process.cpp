// SPDX-License-Identifier: MIT
// A mixer goes on in another process as it would have gone on in its own, from a mix and a snapshot
// in files (F2).
//
//     new_process take FOLDER         a scene in the middle of everything; writes both files, goes
//                                     on, and writes the hash of what follows
//     new_process continue FOLDER     opens both, goes on, and compares
#include <cstdio>
#include <fstream>
#include <iterator>

#include "runtime/mix/mix_file.h"
#include "tests/support/mix_scene.h"

namespace {

using namespace mien;
using Bytes = std::vector<uint8_t>;

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
  for (int64_t step = 0; step < 600; ++step) {
    if (step % 90 == 30) {
      LayerPlayDesc desc;
      desc.play.looping = Looping::kLoop;
      desc.transition = step % 180 == 30 ? Transition::kCrossfade : Transition::kInertial;
      actor.play(MixScene::kSpeech, static_cast<uint32_t>(step) % MixScene::kClips, desc);
    }
    if (step % 100 == 50) scene_requires(trigger(*actor.mixer, 0, 1, kTicksPerSecond / 2, error));
    hash = hash_floats(hash, actor.step(kSceneStep + step), actor.scene.mix->lane_count);
  }
  return hash;
}

int take(const std::string& folder) {
  const MixScene scene(24);
  SceneActor actor(scene, 9);
  actor.begin();
  Random random = Random::from_seed(10, 0);
  for (int step = 0; step < 300; ++step) {
    actor.disturb(random);
    actor.step(kSceneStep);
  }
  for (int step = 0; step < 120; ++step) actor.step(kSceneStep);  // the stream ends
  // In the middle of a crossfade, a fade and a reaction.
  LayerPlayDesc desc;
  desc.transition = Transition::kCrossfade;
  actor.play(MixScene::kBase, 2, desc);
  Error error;
  scene_requires(set_layer_weight(*actor.mixer, MixScene::kMood, 0.25f, kTicksPerSecond, error));
  scene_requires(trigger(*actor.mixer, 0, 0.75f, kUntilReleased, error));
  for (int step = 0; step < 5; ++step) actor.step(kSceneStep);

  size_t size = 0;
  scene_requires(write_mix(*scene.mix, {}, size, error));
  Bytes mix(size), snapshot(snapshot_size(*scene.mix));
  scene_requires(write_mix(*scene.mix, {mix.data(), size}, size, error));
  scene_requires(take_snapshot(*actor.mixer, {snapshot.data(), snapshot.size()}, error));
  write(folder + "/new_process.mix", mix.data(), mix.size());
  write(folder + "/new_process.snapshot", snapshot.data(), snapshot.size());
  const uint64_t hash = go_on(actor);
  write(folder + "/new_process.hash", &hash, sizeof(hash));
  return 0;
}

int continue_there(const std::string& folder) {
  const Bytes mix = read(folder + "/new_process.mix");
  const Bytes snapshot = read(folder + "/new_process.snapshot");
  const Bytes wanted = read(folder + "/new_process.hash");
  MixScene scene(24);  // for its clips
  release_mix(scene.mix);
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
  SceneActor actor(scene, 1);
  scene_requires(
      restore_snapshot(*actor.mixer, {snapshot.data(), snapshot.size()}, scene.finder(), error));
  const uint64_t hash = go_on(actor);
  if (wanted.size() == sizeof(hash) && memcmp(wanted.data(), &hash, sizeof(hash)) == 0) return 0;
  std::fprintf(stderr, "it went on in another way\n");
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc == 3 ? argv[1] : "";
  if (what == "take") return take(argv[2]);
  if (what == "continue") return continue_there(argv[2]);
  return 2;
}
