// SPDX-License-Identifier: MIT
// Any bytes as a DNA file, through its whole life (tests/support/exercise_dna.h). An input is a
// file, with eight bytes behind it that choose layers, LODs and controls:
//
//     file | 'M' 'o' | 1: no targets, u8 | layers, u8 | LODs, u8 | seed of controls, u8 |
//     flags, u8 | system, u8
//
// A system is the seed of a random one; 0 keeps the file's.
//
// Without the two letters all of the input is the file, and everything is chosen.
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <vector>

#include "capi/include/mien_author.h"
#include "runtime/load/dna/dna_reader.h"
#include "runtime/load/dna/format/dna_writer.h"
#include "tests/fuzz/time_limit.h"
#include "tests/fuzz/view_mutator.h"
#include "tests/support/bytes.h"
#include "tests/support/exercise_dna.h"
#include "tests/support/tiny_rig.h"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t max_size);

namespace {

using namespace mien;
using namespace mien::dna;

constexpr size_t kTail = 8;

enum Flags : uint8_t { kDropUnknown = 1, kDoNotValidate = 2, kTwins = 4 };

bool has_tail(const uint8_t* data, size_t size) {
  return size >= kTail && data[size - kTail] == 'M' && data[size - kTail + 1] == 'o';
}

MienCoordinateSystem system_of(uint8_t seed) {
  Random random(seed);
  for (int i = 0; i < 4; ++i) random();  // the first numbers of near seeds are near
  MienCoordinateSystem system = {};
  system.struct_size = sizeof(system);
  uint32_t lines[3] = {0, 1, 2};
  for (uint32_t i = 3; i > 1; --i) std::swap(lines[i - 1], lines[below(random, i)]);
  for (int i = 0; i < 3; ++i) {
    system.axes[i] = 2 * lines[i] + below(random, 2);
    system.rotation_signs[i] = static_cast<int32_t>(below(random, 3)) - 1;
  }
  system.translation_unit = below(random, 2);
  system.rotation_unit = below(random, 2);
  system.rotation_rule = below(random, 3);
  system.rotation_sequence = below(random, 6);
  system.face_winding = below(random, 2);
  return system;
}

LifeOptions options_of(const uint8_t* data, size_t size) {
  LifeOptions options;
  if (!has_tail(data, size)) return options;
  const uint8_t* tail = data + size - kTail;
  options.layers = tail[3];
  options.skip_targets = tail[2] & 1;
  options.lods = tail[4];
  options.control_seed = tail[5];
  if (tail[6] & kDropUnknown) options.unknown_layers = MIEN_UNKNOWN_LAYERS_DROP;
  options.validate = !(tail[6] & kDoNotValidate);
  options.twins = (tail[6] & kTwins) != 0;
  return options;
}

// Files to start from -----------------------------------------------------------------------------

std::vector<Bytes>& seeds() {
  static std::vector<Bytes> files;
  return files;
}

void add_seed(const DnaView& view, uint16_t version) {
  const WriteOptions options = {version, true};
  Bytes bytes(encoded_size(view, options));
  encode(view, options, bytes.data());
  seeds().push_back(bytes);
}

void make_seeds() {
  Arena arena(default_allocator());
  DnaView tiny = tiny_rig(arena);
  for (uint16_t version = 2; version <= 8; ++version) add_seed(tiny, version);
  tiny.bhvr.joints.groups[1].input_indices = be<uint16_t>(arena, {0, 4, 2});  // no RBF in 2.1
  add_seed(tiny, 1);

  MienGenerateDesc desc = {};
  desc.struct_size = sizeof(desc);
  MienDna* generated = nullptr;
  if (mien_dna_generate(&desc, &generated, nullptr) != MIEN_OK) abort();
  for (uint32_t version : {1u, 2u, 8u}) {
    MienWriteDesc write = {};
    write.struct_size = sizeof(write);
    write.version = version;
    size_t size = 0;
    if (mien_dna_write_memory(generated, &write, nullptr, 0, &size, nullptr)) abort();
    Bytes bytes(size);
    if (mien_dna_write_memory(generated, &write, bytes.data(), size, &size, nullptr)) abort();
    seeds().push_back(bytes);
  }
  mien_dna_close(generated);
}

// Mutation ----------------------------------------------------------------------------------------

bool ignore_finding(void*, const Finding&) { return true; }

/// Whatever can be read of a file, checked or not.
void read_leniently(const uint8_t* data, size_t size, Arena& arena, DnaView& view) {
  examine_dna(data, size, arena, view, {nullptr, ignore_finding, false});
}

uint16_t any_version(Random& random, uint16_t current) {
  const uint16_t versions[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 0xFFFF};
  return below(random, 8) ? current : versions[below(random, 11)];
}

/// A number of the header or the index, or any other four bytes.
void change_raw(Random& random, uint8_t* data, size_t size) {
  if (size < 8) return;
  const size_t front = below(random, 4) ? std::min<size_t>(size, 7 + 4 + 16 * 12) : size;
  const size_t at = below(random, 4) ? 7 + below(random, front - 7) / 4 * 4 : below(random, front);
  if (at + 4 > size) return;
  const uint32_t old = load_big_endian<uint32_t>(data + at);
  const uint32_t n = static_cast<uint32_t>(size);
  const uint32_t values[] = {0,       1,       old + 1,    old - 1,    n,     n - 1,
                             n + 1,   n - old, 0x7FFFFFFF, 0x80000000, ~0u,   ~0u - old,
                             old ^ 1, old / 2, old + 4,    old - 4,    0x27u, 11 + 16 * 11};
  store_big_endian(data + at, values[below(random, sizeof(values) / sizeof(values[0]))]);
}

/// The count in front of an array, wherever it is.
void change_count(Random& random, uint8_t* data, size_t size) {
  Arena arena(default_allocator());
  DnaView view;
  read_leniently(data, size, arena, view);
  ArrayCollector arrays;
  for (const LayerKind& kind : kLayerKinds) {
    with_layer(view, kind.id, [&](auto& record) { arrays.visit(record); });
  }
  if (arrays.data.empty()) return;
  const uint8_t* const array = arrays.data[below(random, arrays.data.size())];
  if (array < data + 4 || array > data + size) return;  // in the arena
  uint8_t* const count = data + (array - data) - 4;
  const uint32_t old = load_big_endian<uint32_t>(count);
  const uint32_t values[] = {0,      1,       old + 1, old - 1,    old * 2,    old / 2,
                             0xFFFF, 0x10000, 0x10001, 0x7FFFFFFF, 0x80000000, ~0u};
  store_big_endian(count, values[below(random, std::size(values))]);
}

/// Writes the view and a tail over `data`. 0 if it does not fit.
size_t put(const DnaView& view, uint16_t version, const uint8_t* tail, uint8_t* data,
           size_t max_size) {
  const WriteOptions options = {version, true};
  const uint64_t size = encoded_size(view, options);
  if (size + kTail > max_size) return 0;
  Bytes bytes(size);  // the view points into `data`
  encode(view, options, bytes.data());
  memcpy(data, bytes.data(), size);
  memcpy(data + size, tail, kTail);
  return size + kTail;
}

void change_tail(Random& random, uint8_t* tail) {
  tail[0] = 'M';
  tail[1] = 'o';
  const bool whole = below(random, 2) != 0;
  store_big_endian(tail + 2, static_cast<uint16_t>(whole ? 0 : random() & 0x1FF));
  tail[4] = static_cast<uint8_t>(below(random, 3) ? 0 : below(random, 16));
  tail[5] = static_cast<uint8_t>(random());
  tail[6] = static_cast<uint8_t>(below(random, 8) == 0 ? kDropUnknown : 0);
  if (!whole || below(random, 4)) tail[6] |= kDoNotValidate;
  if (below(random, 3) == 0) tail[6] |= kTwins;
  tail[7] = static_cast<uint8_t>(below(random, 2) ? 0 : random());
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  // Defaults that suit files of this size; what the caller says comes later and wins.
  static char max_len[] = "-max_len=300000", len_control[] = "-len_control=0";
  static std::vector<char*> arguments(*argv, *argv + *argc);
  arguments.insert(arguments.begin() + 1, {max_len, len_control});
  arguments.push_back(nullptr);
  *argc += 2;
  *argv = arguments.data();
  make_seeds();
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size,
                                          unsigned int seed) {
  Random random(seed);
  for (int i = 0; i < 4; ++i) random();  // the first numbers of near seeds are near

  uint8_t tail[kTail];
  const bool tailed = has_tail(data, size);
  if (tailed) memcpy(tail, data + size - kTail, kTail);
  if (!tailed || below(random, 8) == 0) change_tail(random, tail);
  size_t file_size = tailed ? size - kTail : size;
  if (below(random, 20) == 0) return LLVMFuzzerMutate(data, size, max_size);

  Arena arena(default_allocator());
  DnaView view;
  read_leniently(data, file_size, arena, view);
  Bytes start;
  if (view.index.count == 0 || below(random, 2000) == 0) {
    start = seeds()[below(random, seeds().size())];
    read_leniently(start.data(), start.size(), arena, view);
  }
  uint16_t version = any_version(random, view.version);
  const uint32_t changes = below(random, 12) == 0 ? 0 : 1 + below(random, 3);
  for (uint32_t i = 0; i < changes; ++i) change_view(random, arena, view);
  const size_t made = put(view, version, tail, data, max_size);
  if (made == 0) return LLVMFuzzerMutate(data, size, max_size);

  if (below(random, 10) == 0) change_raw(random, data, made - kTail);
  if (below(random, 8) == 0) change_count(random, data, made - kTail);
  if (below(random, 50) == 0) return LLVMFuzzerMutate(data, made, max_size);
  return made;
}

// A layer or two of another file.
extern "C" size_t LLVMFuzzerCustomCrossOver(const uint8_t* a, size_t a_size, const uint8_t* b,
                                            size_t b_size, uint8_t* out, size_t max_size,
                                            unsigned int seed) {
  Random random(seed);
  for (int i = 0; i < 4; ++i) random();
  Arena arena(default_allocator());
  DnaView one, other;
  read_leniently(a, has_tail(a, a_size) ? a_size - kTail : a_size, arena, one);
  read_leniently(b, has_tail(b, b_size) ? b_size - kTail : b_size, arena, other);
  for (uint32_t layers = 1 + below(random, 3); layers != 0; --layers) {
    const LayerId id = static_cast<LayerId>(below(random, kLayerIdCount));
    with_layer(one, id, [&](auto& into) {
      with_layer(other, id, [&](auto& from) {
        if constexpr (std::is_same<decltype(into), decltype(from)>::value) into = from;
      });
    });
  }
  uint8_t tail[kTail];
  change_tail(random, tail);
  return put(one, below(random, 2) ? one.version : other.version, tail, out, max_size);
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  LifeOptions options = options_of(data, size);
  const uint8_t seed = has_tail(data, size) ? data[size - 1] : 0;
  const MienCoordinateSystem system = system_of(seed);
  if (seed != 0) options.system = &system;
  const size_t file_size = has_tail(data, size) ? size - kTail : size;
  // A block of its own, so that the address sanitizer sees the first byte past the end.
  const Bytes file(data, data + file_size);
  Life life = live(file.data(), file.size(), options);
  check_time(life.seconds, file.size(), life.broken);
  if (life.broken.empty()) return 0;
  fprintf(stderr, "broken promise (layers 0x%x, LODs 0x%llx, unknown layers %u, system %u): %s\n",
          options.layers, static_cast<unsigned long long>(options.lods), options.unknown_layers,
          unsigned{seed}, life.broken.c_str());
  abort();
}
