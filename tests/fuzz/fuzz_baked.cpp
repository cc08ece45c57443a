// SPDX-License-Identifier: MIT
// Any bytes as a baked file, through its whole life (tests/support/exercise_baked.h). Files to start
// from are made here; mutations change numbers of their tables.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "capi/include/mien_author.h"
#include "runtime/baked/baked_objects.h"
#include "runtime/load/dna/format/dna_writer.h"
#include "tests/fuzz/time_limit.h"
#include "tests/support/bytes.h"
#include "tests/support/exercise_baked.h"
#include "tests/support/tiny_rig.h"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t max_size);

namespace {

using namespace mien;
using Random = std::minstd_rand;

uint32_t below(Random& random, size_t end) { return static_cast<uint32_t>(random() % end); }

std::vector<Bytes>& seeds() {
  static std::vector<Bytes> files;
  return files;
}

/// Rigs of each kind, without and with their deformer.
void add_seeds(const MienDna* dna) {
  for (uint32_t kind = 0; kind < 8; ++kind) {
    MienRigDesc desc = {};
    desc.struct_size = sizeof(desc);
    desc.rotation_output = kind & 1;
    desc.storage = kind >> 1 & 1;
    desc.ml_masks = kind & 1;
    MienRig* rig = nullptr;
    MienDeformer* deformer = nullptr;
    if (mien_rig_create(dna, &desc, &rig, nullptr) != MIEN_OK) abort();
    MienDeformerDesc geometry = {};
    geometry.struct_size = sizeof(geometry);
    geometry.storage = desc.storage;
    if (kind >= 4 && mien_deformer_create(dna, rig, &geometry, &deformer, nullptr) != MIEN_OK)
      abort();
    size_t size = 0;
    if (mien_bake_memory(rig, deformer, nullptr, 0, &size, nullptr) != MIEN_OK) abort();
    Bytes bytes(size);
    if (mien_bake_memory(rig, deformer, bytes.data(), size, &size, nullptr) != MIEN_OK) abort();
    mien_deformer_destroy(deformer);
    mien_rig_destroy(rig);
    seeds().push_back(bytes);
  }
}

void make_seeds() {
  Arena arena(default_allocator());
  const dna::DnaView view = dna::tiny_rig(arena);
  const dna::WriteOptions options = {0, true};
  Bytes bytes(dna::encoded_size(view, options));
  dna::encode(view, options, bytes.data());
  MienDna* dna = nullptr;
  if (mien_dna_open_memory(bytes.data(), bytes.size(), nullptr, &dna, nullptr) != MIEN_OK) abort();
  add_seeds(dna);
  mien_dna_close(dna);
  for (uint32_t flags : {0u, uint32_t{MIEN_GENERATE_ML}}) {
    MienGenerateDesc desc = {};
    desc.struct_size = sizeof(desc);
    desc.flags = flags;
    if (mien_dna_generate(&desc, &dna, nullptr) != MIEN_OK) abort();
    add_seeds(dna);
    mien_dna_close(dna);
  }
}

/// A number of 1, 2, 4 or 8 bytes, at a multiple of its size.
template <class T>
void change_number(Random& random, uint8_t* data, size_t begin, size_t end) {
  const size_t first = (begin + sizeof(T) - 1) / sizeof(T);
  if (first >= end / sizeof(T)) return;
  const size_t at = (first + below(random, end / sizeof(T) - first)) * sizeof(T);
  T old;
  memcpy(&old, data + at, sizeof(T));
  const T values[] = {0,
                      1,
                      static_cast<T>(old + 1),
                      static_cast<T>(old - 1),
                      static_cast<T>(~T{0}),
                      static_cast<T>(old ^ (T{1} << below(random, 8 * sizeof(T)))),
                      static_cast<T>(old * 2),
                      static_cast<T>(old / 2),
                      static_cast<T>(old + 16),
                      static_cast<T>(old - 16),
                      static_cast<T>(random()),
                      static_cast<T>(below(random, 64))};
  const T value = values[below(random, std::size(values))];
  memcpy(data + at, &value, sizeof(T));
}

/// Where the tables and arrays of a part lie; false if that is outside of the file.
struct PartPlace {
  BakedPart part;
  size_t arrays;  // the table of arrays

  bool read(Random& random, const uint8_t* data, size_t size) {
    BakedHeader header;
    memcpy(&header, data, sizeof(header));
    const size_t parts =
        std::min<size_t>(header.part_count, (size - sizeof(header)) / sizeof(BakedPart));
    if (parts == 0) return false;
    memcpy(&part, data + sizeof(header) + below(random, parts) * sizeof(part), sizeof(part));
    arrays = part.offset + uint64_t{part.number_count} * sizeof(uint64_t);
    return part.offset <= size &&
           arrays + uint64_t{part.array_count} * sizeof(BakedArray) <= size &&
           part.array_count != 0;
  }
  /// One that lies in the file.
  bool read_array(const uint8_t* data, size_t size, uint32_t i, BakedArray& array) const {
    memcpy(&array, data + arrays + i * sizeof(array), sizeof(array));
    return array.offset < size - part.offset && array.element_size != 0 &&
           array.count <= (size - part.offset - array.offset) / array.element_size;
  }
};

/// Sizes of arrays and parts at their edges, entries that trade places or are there twice.
void change_tables(Random& random, uint8_t* data, size_t size) {
  PartPlace place;
  if (!place.read(random, data, size)) return;
  const uint32_t count = place.part.array_count, i = below(random, count),
                 other = below(random, 2) ? (i + 1) % count : below(random, count);
  uint8_t* const entry = data + place.arrays + i * sizeof(BakedArray);
  uint8_t* const second = data + place.arrays + other * sizeof(BakedArray);
  switch (below(random, 4)) {
    case 0: std::swap_ranges(entry, entry + sizeof(BakedArray), second); break;
    case 1: memmove(entry, second, sizeof(BakedArray)); break;
    case 2: {
      BakedArray array;
      memcpy(&array, entry, sizeof(array));
      const uint64_t counts[] = {0,       1,       array.count - 1, array.count + 1, 0xFFFF,
                                 0x10000, 0x10001, 1u << 31,        1ull << 32,      ~0ull};
      array.count = static_cast<decltype(array.count)>(counts[below(random, std::size(counts))]);
      memcpy(entry, &array, sizeof(array));
      break;
    }
    default: {
      BakedHeader header;
      memcpy(&header, data, sizeof(header));
      uint8_t* const parts = data + sizeof(header);
      const size_t fitting =
          std::min<size_t>(header.part_count, (size - sizeof(header)) / sizeof(BakedPart));
      uint8_t* const a = parts + below(random, fitting) * sizeof(BakedPart);
      uint8_t* const b = parts + below(random, fitting) * sizeof(BakedPart);
      if (below(random, 2)) {
        std::swap_ranges(a, a + (a == b ? 0 : sizeof(BakedPart)), b);
      } else {
        memmove(a, b, sizeof(BakedPart));
      }
    }
  }
}

/// Elements of an array trade places, are there twice, or come from another array.
void change_elements(Random& random, uint8_t* data, size_t size) {
  PartPlace place;
  BakedArray array, from;
  if (!place.read(random, data, size) ||
      !place.read_array(data, size, below(random, place.part.array_count), array) ||
      !place.read_array(data, size, below(random, place.part.array_count), from) ||
      array.count == 0 || from.count == 0) {
    return;
  }
  uint8_t* const begin = data + place.part.offset + array.offset;
  const size_t element = array.element_size;
  uint8_t* const a = begin + below(random, array.count) * element;
  uint8_t* const b = begin + below(random, array.count) * element;
  switch (below(random, 4)) {
    case 0:
      if (a != b) std::swap_ranges(a, a + element, b);
      break;
    case 1: memmove(a, b, element); break;
    case 2: {  // a run of equal elements
      const uint8_t* const end = begin + array.count * element;
      for (uint8_t* at = a; at + 2 * element <= end && below(random, 8) != 0; at += element) {
        memmove(at + element, at, element);
      }
      break;
    }
    default: {
      const size_t bytes = std::min<size_t>(array.count * element, from.count * from.element_size);
      memmove(begin, data + place.part.offset + from.offset, 1 + below(random, bytes));
    }
  }
}

void change(Random& random, uint8_t* data, size_t size) {
  if (size < sizeof(BakedHeader) + sizeof(BakedPart)) return;
  if (below(random, 6) == 0) return change_tables(random, data, size);
  if (below(random, 6) == 0) return change_elements(random, data, size);
  BakedHeader header;
  memcpy(&header, data, sizeof(header));
  const size_t parts =
      std::min<size_t>(header.part_count, (size - sizeof(header)) / sizeof(BakedPart));
  // The header and the table of parts, rarely; else the numbers, the table or an array of a part.
  size_t begin = 0, end = sizeof(header) + parts * sizeof(BakedPart);
  if (parts != 0 && below(random, 16) != 0) {
    BakedPart part;
    memcpy(&part, data + sizeof(header) + below(random, parts) * sizeof(part), sizeof(part));
    const uint64_t table = part.offset + uint64_t{part.number_count} * sizeof(uint64_t);
    const uint64_t tables_end = table + uint64_t{part.array_count} * sizeof(BakedArray);
    if (part.offset > size || tables_end > size || part.array_count == 0) return;
    begin = part.offset;
    end = below(random, 4) ? table : tables_end;
    if (below(random, 4) != 0) {
      BakedArray array;
      memcpy(&array, data + table + below(random, part.array_count) * sizeof(array), sizeof(array));
      if (array.offset < size - part.offset && array.element_size != 0 &&
          array.count <= (size - part.offset - array.offset) / array.element_size) {
        begin = part.offset + array.offset;
        end = begin + array.count * array.element_size;
      }
    }
  }
  switch (below(random, 4)) {
    case 0: change_number<uint8_t>(random, data, begin, end); break;
    case 1: change_number<uint16_t>(random, data, begin, end); break;
    case 2: change_number<uint32_t>(random, data, begin, end); break;
    default: change_number<uint64_t>(random, data, begin, end); break;
  }
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  static char max_len[] = "-max_len=100000", len_control[] = "-len_control=0";
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
  const bool is_baked = size >= sizeof(BakedHeader) && memcmp(data, kBakedMagic, 8) == 0;
  if (!is_baked || below(random, 50) == 0) {
    const Bytes& start = seeds()[below(random, seeds().size())];
    if (start.size() <= max_size) {
      memcpy(data, start.data(), start.size());
      size = start.size();
    }
  }
  if (below(random, 40) == 0) return LLVMFuzzerMutate(data, size, max_size);
  for (uint32_t changes = 1 + below(random, 3); changes != 0; --changes) {
    change(random, data, size);
  }
  return size;
}

// Arrays of another file where both have some.
extern "C" size_t LLVMFuzzerCustomCrossOver(const uint8_t* a, size_t a_size, const uint8_t* b,
                                            size_t b_size, uint8_t* out, size_t max_size,
                                            unsigned int seed) {
  Random random(seed);
  for (int i = 0; i < 4; ++i) random();
  const size_t size = std::min(a_size, max_size);
  memcpy(out, a, size);
  PartPlace to, from;
  BakedArray into, other;
  if (size < sizeof(BakedHeader) || b_size < sizeof(BakedHeader) || !to.read(random, out, size) ||
      !from.read(random, b, b_size)) {
    return size;
  }
  for (uint32_t times = 1 + below(random, 4); times != 0; --times) {
    const uint32_t i = below(random, std::min(to.part.array_count, from.part.array_count));
    if (!to.read_array(out, size, i, into) || !from.read_array(b, b_size, i, other)) continue;
    const size_t bytes =
        std::min<size_t>(into.count * into.element_size, other.count * other.element_size);
    memcpy(out + to.part.offset + into.offset, b + from.part.offset + other.offset, bytes);
  }
  return size;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const AlignedBytes file(Bytes(data, data + size));
  // Which inputs are compared follows from their bytes.
  uint32_t sum = 0;
  for (size_t i = 0; i < size; i += 1 + size / 64) sum = sum * 31 + data[i];
  const uint32_t seed = sum % 4 == 0 ? sum | 1 : 0;
  ExerciseBaked life = exercise_baked(file.data(), file.size(), MIEN_ISA_ENVIRONMENT, seed);
  // Images may ask for twice as much, and the packet is five frames more.
  check_time(life.seconds / 12, file.size(), life.broken);
  if (life.broken.empty()) return 0;
  fprintf(stderr, "broken promise: %s (%s)\n", life.broken.c_str(), life.message.c_str());
  abort();
}
