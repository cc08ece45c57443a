// SPDX-License-Identifier: MIT
// Any bytes as a clip: opened, verified, played in every way (tests/support/exercise_clip.h), bound
// to a rig, built again from what it gives. An input is a clip. Those to start from are made here;
// mutations keep the size and often the checksum right, so that they get far.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <random>
#include <vector>

#include "capi/handles.h"
#include "runtime/anim/binding.h"
#include "runtime/anim/clip_builder.h"
#include "runtime/load/dna/format/dna_writer.h"
#include "tests/support/bytes.h"
#include "tests/support/exercise_clip.h"
#include "tests/support/tiny_rig.h"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t max_size);

namespace {

using namespace mien;
using Random = std::minstd_rand;

std::vector<Bytes>& seeds() {
  static std::vector<Bytes> clips;
  return clips;
}

/// Elements of a section trade places, are there twice, or come from another clip; counts at edges.
size_t change_section(Random& random, uint8_t* data, size_t size, size_t max_size) {
  Clip clip;
  Error error;
  // What cannot be opened has no sections: its counts are changed.
  const bool opens = open_clip(data, size, clip, error) == Status::kOk;
  if (!opens || random() % 4 == 0) {
    if (size < kClipHeaderSize) return size;
    const ClipField& field = kClipFields[random() % std::size(kClipFields)];
    const auto old = load_little_endian<uint32_t>(data + field.at);
    const uint32_t values[] = {0,       1,        2,      63,     64,      65,       511,
                               512,     513,      0xFFFE, 0xFFFF, 0x10000, 1u << 28, old + 1,
                               old - 1, 1u << 31, ~0u,    16,     old * 2};
    store_little_endian(data + field.at, values[random() % std::size(values)]);
    return size;
  }
  const uint64_t begins[] = {
      clip.at.rests,      clip.at.name_ends, clip.at.changing, clip.at.events,
      clip.at.block_ends, clip.at.chars,     clip.at.blocks,   size};
  const size_t elements[] = {4, 4, 2, Clip::kEventSize, 4, 1, 8};
  const uint32_t s = random() % 7;
  const size_t count = (begins[s + 1] - begins[s]) / elements[s];
  if (count == 0) return size;
  uint8_t* const a = data + begins[s] + random() % count * elements[s];
  uint8_t* const b = data + begins[s] + random() % count * elements[s];
  if (random() % 3 == 0 && a != b) {
    std::swap_ranges(a, a + elements[s], b);
  } else if (random() % 2 == 0) {
    memmove(a, b, elements[s]);
  } else {
    const Bytes& other = seeds()[random() % seeds().size()];
    const size_t from = random() % other.size(),
                 at = begins[s] + random() % (begins[s + 1] - begins[s]);
    const size_t bytes = 1 + random() % std::min(other.size() - from, size - at);
    memcpy(data + at, other.data() + from, bytes);
  }
  return std::min(size, max_size);
}

/// `kind` decides what the channels are like.
void add_seed(uint32_t kind, uint32_t frames, bool wraps, uint8_t snap) {
  constexpr uint32_t kChannels = 6;
  const char* strings[kChannels] = {"jawOpen", "CTRL_smile.tx", "smileL", "x", "y", "smileR"};
  std::vector<Span<const char>> names;
  for (const char* s : strings) names.push_back({s, strlen(s)});
  Random random(kind + frames);
  std::vector<float> values(size_t{frames} * kChannels);
  for (size_t i = 0; i < values.size(); ++i) {
    const float ramp = static_cast<float>(i / kChannels) / 64;
    const float noise = static_cast<float>(random() % 1000) / 997;
    const float choices[] = {ramp, noise, i % 5 < 3 ? 0 : noise, 0.5f, ramp + noise, -ramp};
    values[i] = choices[(i % kChannels * (kind + 1)) % 6];
  }
  const std::vector<uint8_t> snaps(kChannels, snap);
  const ClipEventDesc events[] = {{0, 0, 1}, {20000000, 1, 0.5f}, {20000000, 0, -1}};
  ClipDesc desc;
  desc.frame_count = frames;
  desc.values = values.data();
  desc.names = {names.data(), names.size()};
  desc.snaps = {snaps.data(), snaps.size()};
  desc.events = {events, frames > 2 ? 3u : 0u};
  desc.event_names = {names.data(), 2};
  desc.wraps = wraps;
  ClipBytes made;
  Error error;
  if (build_clip(desc, default_allocator(), {}, made, error) != Status::kOk) abort();
  seeds().emplace_back(made.bytes, made.bytes + made.size);
  release_clip(made);
}

MienRig* rig = nullptr;

void make_rig() {
  Arena arena(default_allocator());
  const dna::DnaView view = dna::tiny_rig(arena);
  const dna::WriteOptions options = {0, true};
  Bytes bytes(dna::encoded_size(view, options));
  dna::encode(view, options, bytes.data());
  MienDna* dna = nullptr;
  if (mien_dna_open_memory(bytes.data(), bytes.size(), nullptr, &dna, nullptr) != MIEN_OK) abort();
  if (mien_rig_create(dna, nullptr, &rig, nullptr) != MIEN_OK) abort();
  mien_dna_close(dna);
}

void bind(const uint8_t* data, size_t size) {
  Clip clip;
  Error error;
  if (open_clip(data, size, clip, error) != Status::kOk) return;
  const Span<const char> x = {"x", 1}, control = {"CTRL_jaw.ty", 11};
  const MatrixEntry matrix[] = {{x, control, 0.5f}};
  Binding* binding = nullptr;
  if (bind_clip(clip, *capi::object(rig), {matrix, 1}, default_allocator(), binding, error) !=
      Status::kOk) {
    abort();
  }
  if (binding->controls.count + binding->extra_controls.count != binding->raw_count) abort();
  const std::vector<float> values(clip.channel_count, 0.5f);
  std::vector<float> gui(binding->gui_count), raw(binding->raw_count);
  apply_binding(*binding, {values.data(), values.size()}, {gui.data(), gui.size()},
                {raw.data(), raw.size()});
  release(binding);
}

MienClipBinding* bind_by_handle(const MienClip* clip) {
  MienMatrixEntry entry = {};
  entry.channel = {"x", 1};
  entry.control = {"CTRL_jaw.ty", 11};
  entry.weight = 0.5f;
  MienClipBindingDesc desc = mien_clip_binding_desc_default();
  desc.matrix = &entry;
  desc.matrix_count = 1;
  MienClipBinding* binding = nullptr;
  if (mien_clip_binding_create(clip, rig, &desc, &binding, nullptr) != MIEN_OK) abort();
  return binding;
}

/// Applies the binding to a row of the clip. Returns how many controls it drives.
size_t apply_by_handle(const MienClipBinding* binding, const MienFloatView& values) {
  MienClipBindingInfo info = mien_clip_binding_info_default();
  if (mien_clip_binding_info(binding, &info) != MIEN_OK) abort();
  std::vector<float> raw(info.raw_control_count);
  if (mien_clip_binding_apply(binding, values.data, values.count, raw.data(), raw.size()) !=
      MIEN_OK) {
    abort();
  }
  // A row of another size is refused.
  if (mien_clip_binding_apply(binding, values.data, values.count + 1, raw.data(), raw.size()) ==
      MIEN_OK) {
    abort();
  }
  return info.controls.count;
}

/// Controls that the clip drives.
size_t use_by_handle(const uint8_t* data, size_t size) {
  MienClip* clip = nullptr;
  if (mien_clip_open_memory(data, size, nullptr, &clip, nullptr) != MIEN_OK) return 0;
  MienClipInfo info = mien_clip_info_default();
  if (mien_clip_info(clip, &info) != MIEN_OK) abort();
  const uint32_t count = std::min(info.frame_count, 100u);
  std::vector<float> rows(size_t{count} * info.channel_count);
  const MienStatus read =
      mien_clip_read(clip, info.frame_count - count, count, rows.data(), 0, nullptr);
  if (read != MIEN_OK && read != MIEN_ERROR_CLIP_STRUCTURE) abort();
  for (float value : rows) {
    if (!std::isfinite(value)) abort();
  }
  MienClipPlayer* player = nullptr;
  if (mien_clip_player_create(clip, nullptr, &player, nullptr) != MIEN_OK) abort();
  MienClipBinding* const binding = bind_by_handle(clip);
  mien_clip_close(clip);
  MienClipEvent event;
  uint32_t found = 1;
  MienFloatView values;
  if (mien_clip_player_advance(player, info.ticks_per_frame) != MIEN_OK) abort();
  for (int i = 0; i < 100 && found; ++i) {
    if (mien_clip_player_next_event(player, &event, &found) != MIEN_OK) abort();
  }
  if (mien_clip_player_sample(player, &values) != MIEN_OK) abort();
  if (values.count != info.channel_count) abort();
  const size_t driven = apply_by_handle(binding, values);
  mien_clip_binding_destroy(binding);
  mien_clip_player_destroy(player);
  return driven;
}

using Rows = std::vector<float>;

/// False if a curve is damaged.
bool read_all(const Clip& clip, Rows& rows) {
  rows.assign(size_t{clip.frame_count} * clip.channel_count, 0);
  return read_frames(clip, 0, clip.frame_count, rows.data(), clip.channel_count);
}

/// Exported and built again it is the same clip, unless it has a name twice.
void rebuild(const uint8_t* data, size_t size) {
  constexpr size_t kMaxValues = 1 << 14, kMaxNames = 1 << 10;
  Clip clip;
  Error error;
  if (open_clip(data, size, clip, error) != Status::kOk || clip.event_count > kMaxNames) return;
  if (size_t{clip.frame_count} * clip.channel_count > kMaxValues || clip.name_count > kMaxNames)
    return;
  Rows rows, again;
  if (!read_all(clip, rows)) return;
  std::vector<Span<const char>> names, event_names;
  for (uint32_t c = 0; c < clip.channel_count; ++c) names.push_back(clip.name(c));
  // An event may be called like a channel.
  for (uint32_t n = 0; n < clip.name_count; ++n) event_names.push_back(clip.name(n));
  std::vector<ClipEventDesc> events;
  for (uint32_t e = 0; e < clip.event_count; ++e) {
    const ClipEvent event = clip.event(e);
    uint32_t name = 0;
    while (event_names[name].data != event.name.data ||
           event_names[name].count != event.name.count) {
      ++name;
    }
    events.push_back({event.tick, name, event.value});
  }
  ClipDesc desc;
  desc.rate_numerator = clip.rate_numerator;
  desc.rate_denominator = clip.rate_denominator;
  desc.frame_count = clip.frame_count;
  desc.values = rows.data();
  desc.names = {names.data(), names.size()};
  desc.events = {events.data(), events.size()};
  desc.event_names = {event_names.data(), event_names.size()};
  desc.wraps = clip.has(kClipWraps);
  desc.is_delta = clip.has(kClipIsDelta);
  ClipBytes made;
  const Status status = build_clip(desc, default_allocator(), {}, made, error);
  if (status == Status::kName) return;
  Clip built;
  if (status != Status::kOk || open_clip(made.bytes, made.size, built, error) != Status::kOk ||
      !read_all(built, again)) {
    fprintf(stderr, "not rebuilt: %s\n", error.message);
    abort();
  }
  bool same = memcmp(rows.data(), again.data(), rows.size() * sizeof(float)) == 0 &&
              rows.size() == again.size() && built.event_count == clip.event_count &&
              built.ticks_per_frame == clip.ticks_per_frame &&
              built.has(kClipWraps) == desc.wraps && built.has(kClipIsDelta) == desc.is_delta;
  const auto same_name = [](Span<const char> a, Span<const char> b) {
    return a.count == b.count && memcmp(a.data, b.data, a.count) == 0;
  };
  for (uint32_t c = 0; same && c < clip.channel_count; ++c) {
    same = same_name(clip.name(c), built.name(c));
  }
  for (uint32_t e = 0; same && e < clip.event_count; ++e) {
    const ClipEvent a = clip.event(e), b = built.event(e);
    same = a.tick == b.tick && same_name(a.name, b.name) &&
           memcmp(&a.value, &b.value, sizeof(float)) == 0;
  }
  release_clip(made);
  if (!same) {
    fprintf(stderr, "rebuilt as another clip\n");
    abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  make_rig();
  for (uint32_t kind = 0; kind < 3; ++kind) {
    for (uint32_t frames : {1u, 2u, 65u, 129u}) {
      add_seed(kind, frames, kind == 1, kind == 2 ? kDefaultSnap : kNoSnap);
    }
  }
  for (const Bytes& seed : seeds()) {
    if (use_by_handle(seed.data(), seed.size()) == 0) abort();  // bindings would not be tried
  }
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size,
                                          unsigned seed) {
  Random random(seed);
  for (int i = 0; i < 3; ++i) random();  // the first numbers of near seeds are near
  if (size < kClipHeaderSize || random() % 64 == 0) {
    const Bytes& start = seeds()[random() % seeds().size()];
    size = std::min(start.size(), max_size);
    memcpy(data, start.data(), size);
  }
  const uint32_t way = random() % 6;
  if (way < 2) {
    size = LLVMFuzzerMutate(data, size, max_size);
  } else if (way == 2) {
    size = change_section(random, data, size, max_size);
  } else if (size >= 4) {
    const size_t limit = random() % 2 == 0 ? std::min<size_t>(size, kClipHeaderSize) : size;
    const size_t at = random() % (limit / 4) * 4;
    const auto old = load_little_endian<uint32_t>(data + at);
    const uint32_t values[] = {0,
                               1,
                               old + 1,
                               old - 1,
                               ~0u,
                               old * 2,
                               old / 2,
                               old + 8,
                               ~0u - old,
                               old ^ 1u << random() % 32,
                               0x7F800000,
                               64,
                               static_cast<uint32_t>(random())};
    store_little_endian(data + at, values[random() % std::size(values)]);
  }
  if (size >= kClipHeaderSize && random() % 4 != 0) {
    store_little_endian<uint64_t>(data + kAtSize, size);
    store_little_endian(data + kAtChecksum, clip_checksum(data, size));
  }
  return size;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const ClipExercise exercise(data, size);
  if (!exercise.broken.empty()) {
    fprintf(stderr, "broken: %s\n", exercise.broken.c_str());
    abort();
  }
  bind(data, size);
  use_by_handle(data, size);
  rebuild(data, size);
  return 0;
}
