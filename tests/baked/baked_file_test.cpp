// SPDX-License-Identifier: MIT
// The file around rigs and deformers: where it comes from, what belongs to it, and which files are
// refused.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdio>
#include <functional>

#include "tests/support/baked_bytes.h"
#include "tests/support/bytes.h"
#include "tests/support/long_run.h"
#include "tests/support/memory_stream.h"
#include "tests/support/temporary_path.h"
#include "tests/support/tiny_rig.h"

namespace mien {
namespace {

struct TemporaryFile {
  std::string path = temporary_path("baked");
  ~TemporaryFile() { remove(path.c_str()); }
};

struct TinyObjects {
  RigHandle rig;
  DeformerHandle deformer;

  TinyObjects() {
    Arena arena(default_allocator());
    const Bytes file = write_view(dna::tiny_rig(arena));
    const DnaHandle dna = open_dna(file);
    rig = create_rig(dna.get());
    deformer = create_deformer(dna.get(), rig.get());
  }
  Bytes baked() const { return bake(rig.get(), deformer.get()); }
};

/// Bytes at an address that is no place for vectors.
struct Misaligned {
  Bytes memory;
  size_t offset;

  explicit Misaligned(const Bytes& bytes) : memory(bytes.size() + 128) {
    offset = 65 - reinterpret_cast<uintptr_t>(memory.data()) % 64;
    std::copy(bytes.begin(), bytes.end(), memory.begin() + static_cast<ptrdiff_t>(offset));
  }
  uint8_t* data() { return memory.data() + offset; }
};

MienStream c_stream(const MemoryStream& stream) {
  const Stream inner = stream.get();
  return {inner.user, inner.size, inner.read};
}

/// What a file was opened from, and how many blocks that takes.
struct Way {
  const char* name;
  size_t blocks;
  std::function<MienStatus(const MienBakedDesc&, MienBaked**, MienError*)> open;
};

void for_each_way(const Bytes& bytes, const std::function<void(const Way&, MienBakedDesc)>& f) {
  const TemporaryFile file;
  FILE* out = fopen(file.path.c_str(), "wb");
  ASSERT_EQ(fwrite(bytes.data(), 1, bytes.size(), out), bytes.size());
  fclose(out);
  const AlignedBytes aligned(bytes);
  Misaligned misaligned(bytes);
  const MemoryStream source(bytes);
  const MienStream stream = c_stream(source);
  const auto from_file = [&](const MienBakedDesc& desc, MienBaked** baked, MienError* error) {
    return mien_baked_open_file(file.path.c_str(), &desc, baked, error);
  };
  const auto from_memory = [&](const MienBakedDesc& desc, MienBaked** baked, MienError* error) {
    return mien_baked_open_memory(aligned.data(), aligned.size(), &desc, baked, error);
  };
  const auto from_misaligned = [&](const MienBakedDesc& desc, MienBaked** baked, MienError* error) {
    return mien_baked_open_memory(misaligned.data(), bytes.size(), &desc, baked, error);
  };
  const auto from_stream = [&](const MienBakedDesc& desc, MienBaked** baked, MienError* error) {
    return mien_baked_open_stream(&stream, &desc, baked, error);
  };
  MienBakedDesc map = sized<MienBakedDesc>(), read = map;
  map.check = read.check = MIEN_BAKED_CHECK_FULL;
  read.file_access = MIEN_FILE_READ;
#if defined(_WIN32)
  constexpr size_t kPath = 1;  // in the letters of the system
#else
  constexpr size_t kPath = 0;
#endif
  f({"mapped", kPath + 1, from_file}, map);
  f({"read", kPath + 2, from_file}, read);
  f({"memory", 1, from_memory}, map);
  f({"memory, copied", 1, from_memory}, read);
  f({"misaligned memory", 1, from_misaligned}, map);
  f({"stream", 1, from_stream}, map);
}

// Life --------------------------------------------------------------------------------------------

TEST(BakedFile, OpensFromFilesMemoryAndStreamsWithFewAllocations) {
  const Bytes bytes = TinyObjects().baked();
  for_each_way(bytes, [&](const Way& way, MienBakedDesc desc) {
    SCOPED_TRACE(way.name);
    CountingAllocator counter;
    const MienAllocator allocator = counter.get();
    desc.allocator = &allocator;
    MienError error = sized<MienError>();
    MienBaked* opened = nullptr;
    ASSERT_EQ(way.open(desc, &opened, &error), MIEN_OK) << error.message;
    EXPECT_EQ(counter.requests, way.blocks);
    MienBakedInfo info = sized<MienBakedInfo>();
    ASSERT_EQ(mien_baked_info(opened, &info), MIEN_OK);
    EXPECT_EQ(info.file_bytes, bytes.size());
    EXPECT_EQ(info.memory_bytes, counter.bytes);
    EXPECT_EQ(info.is_mapped, strcmp(way.name, "mapped") == 0);
    EXPECT_EQ(info.part_count, 2u);
    EXPECT_EQ(sizeof(BakedHeader) + 2 * sizeof(BakedPart) + info.rig_bytes + info.deformer_bytes,
              bytes.size());
    BakedHandle baked(opened);
    RigHandle rig = rig_of(baked);
    DeformerHandle deformer = deformer_of(baked, rig);
    EXPECT_TRUE(bake(rig.get(), deformer.get()) == bytes);

    // Whatever goes first: the last one takes the file along.
    baked.reset();
    EXPECT_NE(counter.live, 0u);
    rig.reset();
    EXPECT_NE(counter.live, 0u);
    const DeformerInstanceHandle instance = create_deformer_instance(deformer.get());
    deformer.reset();
    EXPECT_NE(counter.live, 0u) << "the instance needs the deformer";
    EXPECT_TRUE(counter.first_wrong.empty()) << counter.first_wrong;
  });
}

TEST(BakedFile, IsReleasedWithTheLastOfItsObjects) {
  const AlignedBytes bytes(TinyObjects().baked());
  CountingAllocator counter;
  const MienAllocator allocator = counter.get();
  MienBakedDesc desc = sized<MienBakedDesc>();
  desc.allocator = &allocator;
  for (uint32_t first : {0u, 1u, 2u}) {
    MienBaked* opened = nullptr;
    ASSERT_EQ(mien_baked_open_memory(bytes.data(), bytes.size(), &desc, &opened, nullptr), MIEN_OK);
    BakedHandle baked(opened);
    RigHandle rig = rig_of(baked);
    DeformerHandle deformer = deformer_of(baked, rig);
    if (first == 0) baked.reset();
    if (first == 1) rig.reset();
    if (first == 2) deformer.reset();
    EXPECT_EQ(counter.live, 1u);
    baked.reset();
    rig.reset();
    deformer.reset();
    EXPECT_TRUE(counter.clean()) << counter.first_wrong;
  }
}

TEST(BakedFile, CopiesNeedTheirSourceNoLonger) {
  const Bytes bytes = TinyObjects().baked();
  Misaligned memory(bytes);
  MienBaked* opened = nullptr;
  ASSERT_EQ(mien_baked_open_memory(memory.data(), bytes.size(), nullptr, &opened, nullptr),
            MIEN_OK);
  const BakedHandle from_memory(opened);
  std::fill(memory.memory.begin(), memory.memory.end(), uint8_t{0xA5});
  EXPECT_TRUE(bake(rig_of(from_memory).get()) == tiny_baked());

  MemoryStream source(bytes);
  const MienStream stream = c_stream(source);
  ASSERT_EQ(mien_baked_open_stream(&stream, nullptr, &opened, nullptr), MIEN_OK);
  const BakedHandle from_stream(opened);
  source.bytes.assign(source.bytes.size(), 0xA5);
  EXPECT_EQ(source.reads, 1u);
  EXPECT_TRUE(bake(rig_of(from_stream).get()) == tiny_baked());
}

TEST(BakedFile, EveryAllocationMayFail) {
  const Bytes bytes = TinyObjects().baked();
  for_each_way(bytes, [&](const Way& way, MienBakedDesc desc) {
    SCOPED_TRACE(way.name);
    for (size_t k = 1; k <= way.blocks; ++k) {
      CountingAllocator counter;
      counter.fail_at = k;
      const MienAllocator allocator = counter.get();
      desc.allocator = &allocator;
      MienError error = sized<MienError>();
      MienBaked* opened = nullptr;
      EXPECT_EQ(way.open(desc, &opened, &error), MIEN_ERROR_MEMORY);
      EXPECT_EQ(opened, nullptr);
      EXPECT_NE(error.message[0], 0);
      EXPECT_TRUE(counter.clean()) << counter.first_wrong;
    }
  });
  const AlignedBytes aligned(bytes);
  const BakedHandle baked = open_baked(aligned);
  const RigHandle rig = rig_of(baked);
  CountingAllocator counter;
  counter.fail_at = 1;
  counter.keep_failing = true;
  const MienAllocator allocator = counter.get();
  MienBakedRigDesc rig_desc = sized<MienBakedRigDesc>();
  MienBakedDeformerDesc deformer_desc = sized<MienBakedDeformerDesc>();
  rig_desc.allocator = deformer_desc.allocator = &allocator;
  MienRig* no_rig = nullptr;
  MienDeformer* no_deformer = nullptr;
  EXPECT_EQ(mien_rig_from_baked(baked.get(), &rig_desc, &no_rig, nullptr), MIEN_ERROR_MEMORY);
  EXPECT_EQ(mien_deformer_from_baked(baked.get(), rig.get(), &deformer_desc, &no_deformer, nullptr),
            MIEN_ERROR_MEMORY);
}

TEST(BakedFile, StreamsMayFail) {
  const Bytes bytes = TinyObjects().baked();
  for (const bool reads_short : {false, true}) {
    MemoryStream source(bytes);
    source.fail_at = 1;
    source.reads_short = reads_short;
    const MienStream stream = c_stream(source);
    CountingAllocator counter;
    const MienAllocator allocator = counter.get();
    MienBakedDesc desc = sized<MienBakedDesc>();
    desc.allocator = &allocator;
    MienError error = sized<MienError>();
    MienBaked* opened = nullptr;
    EXPECT_EQ(mien_baked_open_stream(&stream, &desc, &opened, &error), MIEN_ERROR_FILE_READ);
    EXPECT_EQ(opened, nullptr);
    EXPECT_NE(error.message[0], 0);
    EXPECT_TRUE(counter.clean()) << counter.first_wrong;
  }
  // A size that no machine has.
  MemoryStream source(bytes);
  MienStream stream = c_stream(source);
  stream.size = ~uint64_t{0};
  MienBaked* opened = nullptr;
  EXPECT_EQ(mien_baked_open_stream(&stream, nullptr, &opened, nullptr), MIEN_ERROR_MEMORY);
  stream.size = 0;
  EXPECT_EQ(mien_baked_open_stream(&stream, nullptr, &opened, nullptr), MIEN_ERROR_BAKED_SIGNATURE);
}

// Misuse ------------------------------------------------------------------------------------------

TEST(BakedFile, ArgumentsAreChecked) {
  const TinyObjects tiny, other;
  const AlignedBytes file(tiny.baked());
  const MienRig* const rig = tiny.rig.get();
  size_t size = 0;
  uint8_t small[8];
  MienError error = sized<MienError>();
  EXPECT_EQ(mien_bake_file(nullptr, nullptr, "x", nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_bake_file(rig, nullptr, nullptr, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_bake_file(rig, nullptr, "/nonexistent/rig", nullptr), MIEN_ERROR_FILE_WRITE);
  EXPECT_EQ(mien_bake_file(rig, other.deformer.get(), "x", &error), MIEN_ERROR_MISMATCH);
  EXPECT_NE(error.message[0], 0);
  EXPECT_EQ(mien_bake_memory(rig, nullptr, nullptr, 0, nullptr, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_bake_memory(rig, nullptr, nullptr, 8, &size, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_bake_memory(nullptr, nullptr, nullptr, 0, &size, nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_bake_memory(rig, other.deformer.get(), nullptr, 0, &size, nullptr),
            MIEN_ERROR_MISMATCH);
  EXPECT_EQ(mien_bake_memory(rig, tiny.deformer.get(), small, 8, &size, nullptr),
            MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(size, file.size());

  MienBaked* out = nullptr;
  EXPECT_EQ(mien_baked_open_file(nullptr, nullptr, &out, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_baked_open_file("x", nullptr, nullptr, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_baked_open_file("/nonexistent/rig", nullptr, &out, nullptr), MIEN_ERROR_FILE_OPEN);
  EXPECT_EQ(mien_baked_open_memory(nullptr, 64, nullptr, &out, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_baked_open_memory(nullptr, 0, nullptr, &out, nullptr), MIEN_ERROR_BAKED_SIGNATURE);
  EXPECT_EQ(mien_baked_open_stream(nullptr, nullptr, &out, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  const MienStream no_read = {nullptr, 64, nullptr};
  EXPECT_EQ(mien_baked_open_stream(&no_read, nullptr, &out, nullptr), MIEN_ERROR_NULL_ARGUMENT);

  const MienAllocator half = {nullptr, nullptr, nullptr};
  const auto refused = [&](MienStatus expected, auto&& change) {
    MienBakedDesc desc = sized<MienBakedDesc>();
    change(desc);
    out = reinterpret_cast<MienBaked*>(&desc);
    error = sized<MienError>();
    EXPECT_EQ(mien_baked_open_memory(file.data(), file.size(), &desc, &out, &error), expected);
    EXPECT_EQ(out, nullptr);
    EXPECT_NE(error.message[0], 0);
  };
  refused(MIEN_ERROR_STRUCT_SIZE, [](MienBakedDesc& d) { d.struct_size = 8; });
  refused(MIEN_ERROR_INVALID_ARGUMENT, [](MienBakedDesc& d) { d.file_access = 2; });
  refused(MIEN_ERROR_INVALID_ARGUMENT, [](MienBakedDesc& d) { d.check = 2; });
  refused(MIEN_ERROR_INVALID_ARGUMENT, [&](MienBakedDesc& d) { d.allocator = &half; });

  const BakedHandle baked = open_baked(file);
  const auto rig_refused = [&](MienStatus expected, auto&& change) {
    MienBakedRigDesc desc = sized<MienBakedRigDesc>();
    change(desc);
    MienRig* made = reinterpret_cast<MienRig*>(&desc);
    EXPECT_EQ(mien_rig_from_baked(baked.get(), &desc, &made, nullptr), expected);
    EXPECT_EQ(made, nullptr);
  };
  rig_refused(MIEN_ERROR_STRUCT_SIZE, [](MienBakedRigDesc& d) { d.struct_size = 8; });
  rig_refused(MIEN_ERROR_INVALID_ARGUMENT, [](MienBakedRigDesc& d) { d.isa = 99; });
  rig_refused(MIEN_ERROR_INVALID_ARGUMENT, [](MienBakedRigDesc& d) { d.reuse = 3; });
  rig_refused(MIEN_ERROR_INVALID_ARGUMENT, [&](MienBakedRigDesc& d) { d.allocator = &half; });

  const RigHandle opened = rig_of(baked);
  const auto deformer_refused = [&](MienStatus expected, auto&& change) {
    MienBakedDeformerDesc desc = sized<MienBakedDeformerDesc>();
    change(desc);
    MienDeformer* made = reinterpret_cast<MienDeformer*>(&desc);
    EXPECT_EQ(mien_deformer_from_baked(baked.get(), opened.get(), &desc, &made, nullptr), expected);
    EXPECT_EQ(made, nullptr);
  };
  deformer_refused(MIEN_ERROR_STRUCT_SIZE, [](MienBakedDeformerDesc& d) { d.struct_size = 8; });
  deformer_refused(MIEN_ERROR_INVALID_ARGUMENT, [](MienBakedDeformerDesc& d) { d.isa = 99; });
  deformer_refused(MIEN_ERROR_INVALID_ARGUMENT, [](MienBakedDeformerDesc& d) { d.normals = 4; });
  deformer_refused(MIEN_ERROR_INVALID_ARGUMENT,
                   [&](MienBakedDeformerDesc& d) { d.allocator = &half; });

  MienRig* made = nullptr;
  MienDeformer* deformer = nullptr;
  MienBakedInfo info = sized<MienBakedInfo>();
  EXPECT_EQ(mien_rig_from_baked(nullptr, nullptr, &made, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_rig_from_baked(baked.get(), nullptr, nullptr, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_deformer_from_baked(baked.get(), nullptr, nullptr, &deformer, nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_baked_info(nullptr, &info), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_baked_info(baked.get(), nullptr), MIEN_ERROR_NULL_ARGUMENT);
  const auto* not_baked = reinterpret_cast<const MienBaked*>(rig);
  EXPECT_EQ(mien_baked_info(not_baked, &info), MIEN_ERROR_HANDLE);
  EXPECT_EQ(mien_rig_from_baked(not_baked, nullptr, &made, nullptr), MIEN_ERROR_HANDLE);
  mien_baked_close(nullptr);
}

// A rig of the same bytes, but of another opening, does not keep this one alive.
TEST(BakedFile, DeformersBelongToTheRigOfTheirFile) {
  const TinyObjects tiny;
  const AlignedBytes file(tiny.baked());
  const BakedHandle baked = open_baked(file), again = open_baked(file);
  const RigHandle rig = rig_of(again);
  deformer_of(baked, rig, MIEN_ISA_BEST, MIEN_ERROR_MISMATCH);
  deformer_of(baked, tiny.rig, MIEN_ISA_BEST, MIEN_ERROR_MISMATCH);
}

// Foreign and damaged files -----------------------------------------------------------------------

/// A file with something at `offset` changed: the status of opening it, or its rig.
template <class T>
MienStatus status_with(size_t offset, T value, uint32_t check = MIEN_BAKED_CHECK_SAFE) {
  const AlignedBytes file(tiny_baked());
  memcpy(file.data() + offset, &value, sizeof(value));
  MienBakedDesc desc = sized<MienBakedDesc>();
  desc.check = check;
  MienBaked* baked = nullptr;
  MienRig* rig = nullptr;
  MienStatus status = mien_baked_open_memory(file.data(), file.size(), &desc, &baked, nullptr);
  if (status == MIEN_OK) status = mien_rig_from_baked(baked, nullptr, &rig, nullptr);
  mien_rig_destroy(rig);
  mien_baked_close(baked);
  return status;
}

TEST(BakedFile, ForeignFilesAreRefused) {
  EXPECT_EQ(status_with(0, 'X'), MIEN_ERROR_BAKED_SIGNATURE);
  EXPECT_EQ(status_with(offsetof(BakedHeader, byte_order), uint32_t{0x04030201}),
            MIEN_ERROR_BAKED_VERSION);
  EXPECT_EQ(status_with(offsetof(BakedHeader, version), kBakedVersion + 1),
            MIEN_ERROR_BAKED_VERSION);
  EXPECT_EQ(status_with(offsetof(BakedHeader, file_size), uint64_t{1} << 40),
            MIEN_ERROR_BAKED_TRUNCATED);
  EXPECT_EQ(status_with(offsetof(BakedHeader, file_size), uint64_t{64}),
            MIEN_ERROR_BAKED_STRUCTURE);
  for (const uint32_t count : {0u, 2u, ~0u}) {
    EXPECT_EQ(status_with(offsetof(BakedHeader, part_count), count), MIEN_ERROR_BAKED_STRUCTURE);
  }

  constexpr size_t kPart = sizeof(BakedHeader);
  EXPECT_EQ(status_with(kPart + offsetof(BakedPart, kind), uint32_t{99}), MIEN_ERROR_BAKED_PART);
  EXPECT_EQ(status_with(kPart + offsetof(BakedPart, kind), uint32_t(PartKind::kDeformer)),
            MIEN_ERROR_BAKED_PART);
  EXPECT_EQ(status_with(kPart + offsetof(BakedPart, version), uint32_t{99}),
            MIEN_ERROR_BAKED_VERSION);
  for (const size_t field : {offsetof(BakedPart, offset), offsetof(BakedPart, size)}) {
    for (const uint64_t value : {uint64_t{0}, uint64_t{64}, uint64_t{1} << 40, ~uint64_t{63}}) {
      EXPECT_EQ(status_with(kPart + field, value), MIEN_ERROR_BAKED_STRUCTURE);
    }
  }
  for (const size_t field : {offsetof(BakedPart, number_count), offsetof(BakedPart, array_count)}) {
    for (const uint32_t value : {0u, 1u, ~0u}) {
      EXPECT_EQ(status_with(kPart + field, value), MIEN_ERROR_BAKED_STRUCTURE);
    }
  }
  EXPECT_EQ(status_with(kPart + offsetof(BakedPart, zeros), uint8_t{1}),
            MIEN_ERROR_BAKED_STRUCTURE);

  BakedPart part;
  memcpy(&part, tiny_baked().data() + kPart, sizeof(part));
  const size_t array = part.offset + part.number_count * sizeof(uint64_t);
  EXPECT_EQ(status_with(array + offsetof(BakedArray, element_size), uint32_t{3}),
            MIEN_ERROR_BAKED_VERSION);
  for (const uint64_t value : {uint64_t{0}, uint64_t{64}, ~uint64_t{63}}) {
    EXPECT_EQ(status_with(array + offsetof(BakedArray, offset), value), MIEN_ERROR_BAKED_STRUCTURE);
  }
  for (const uint64_t value : {uint64_t{1} << 40, uint64_t{1} << 63, ~uint64_t{0}}) {
    EXPECT_EQ(status_with(array + offsetof(BakedArray, count), value), MIEN_ERROR_BAKED_STRUCTURE);
  }
  EXPECT_EQ(status_with(array + offsetof(BakedArray, zero), uint32_t{1}),
            MIEN_ERROR_BAKED_STRUCTURE);
}

TEST(BakedFile, DnaIsNotBakedAndBakedIsNotDna) {
  Arena arena(default_allocator());
  const AlignedBytes dna(write_view(dna::tiny_rig(arena)));
  open_baked(dna, MIEN_BAKED_CHECK_SAFE, MIEN_ERROR_BAKED_SIGNATURE);
  open_dna(tiny_baked(), 0, MIEN_ERROR_DNA_SIGNATURE);
}

/// A file with the parts of others, in this order.
Bytes file_of_parts(const std::vector<std::pair<BakedPart, Bytes>>& parts) {
  BakedHeader header = {};
  memcpy(header.magic, kBakedMagic, sizeof(kBakedMagic));
  header.byte_order = kBakedByteOrder;
  header.version = kBakedVersion;
  header.part_count = static_cast<uint32_t>(parts.size());
  header.file_size = sizeof(header) + parts.size() * sizeof(BakedPart);
  for (const auto& part : parts) header.file_size += part.second.size();
  Bytes file(header.file_size);
  memcpy(file.data(), &header, sizeof(header));
  size_t entry = sizeof(header), at = entry + parts.size() * sizeof(BakedPart);
  for (auto [part, bytes] : parts) {
    part.offset = at;
    part.size = bytes.size();
    memcpy(file.data() + entry, &part, sizeof(part));
    std::copy(bytes.begin(), bytes.end(), file.begin() + static_cast<ptrdiff_t>(at));
    entry += sizeof(part);
    at += bytes.size();
  }
  header.checksum = baked_checksum(file.data(), file.size());
  memcpy(file.data(), &header, sizeof(header));
  return file;
}

std::pair<BakedPart, Bytes> part_of(const Bytes& file, size_t i) {
  BakedPart part;
  memcpy(&part, file.data() + sizeof(BakedHeader) + i * sizeof(part), sizeof(part));
  const auto begin = file.begin() + static_cast<ptrdiff_t>(part.offset);
  return {part, Bytes(begin, begin + static_cast<ptrdiff_t>(part.size))};
}

TEST(BakedFile, PartsOfUnknownKindsAreSkipped) {
  const Bytes whole = TinyObjects().baked();
  const auto rig = part_of(whole, 0), deformer = part_of(whole, 1);
  BakedPart clip = {};
  clip.kind = 77;
  clip.version = 9;
  clip.number_count = clip.array_count = ~uint32_t{0};  // of no meaning here
  const std::pair<BakedPart, Bytes> unknown = {clip, Bytes(192, 0xEE)};
  EXPECT_TRUE(file_of_parts({rig, deformer}) == whole);
  const std::vector<std::vector<std::pair<BakedPart, Bytes>>> orders = {
      {unknown, rig, unknown, deformer}, {deformer, rig, unknown}, {rig, deformer, {clip, {}}}};
  for (const auto& parts : orders) {
    const Bytes bytes = file_of_parts(parts);
    const AlignedBytes file(bytes);
    const BakedHandle baked = open_baked(file);
    const RigHandle opened = rig_of(baked);
    ASSERT_TRUE(opened);
    EXPECT_TRUE(bake(opened.get(), deformer_of(baked, opened).get()) == whole);
    EXPECT_EQ(exercise_baked(file.data(), file.size()).broken, "");
  }
}

TEST(BakedFile, MissingPartsAreReported) {
  const Bytes whole = TinyObjects().baked();
  const AlignedBytes rig_alone(file_of_parts({part_of(whole, 0)}));
  const BakedHandle baked = open_baked(rig_alone);
  deformer_of(baked, rig_of(baked), MIEN_ISA_BEST, MIEN_ERROR_BAKED_PART);
  const AlignedBytes deformer_alone(file_of_parts({part_of(whole, 1)})), nothing(file_of_parts({}));
  for (const AlignedBytes* file : {&deformer_alone, &nothing}) {
    rig_of(open_baked(*file), MIEN_ISA_BEST, MIEN_ERROR_BAKED_PART);
  }
}

TEST(BakedFile, PartsThatGoOnBehindTheirArraysAreRefused) {
  const Bytes whole = TinyObjects().baked();
  for (size_t longer = 0; longer < 2; ++longer) {
    std::vector<std::pair<BakedPart, Bytes>> parts = {part_of(whole, 0), part_of(whole, 1)};
    parts[longer].second.resize(parts[longer].second.size() + 128);
    const AlignedBytes file(file_of_parts(parts));
    const BakedHandle baked = open_baked(file);
    const RigHandle rig =
        rig_of(baked, MIEN_ISA_BEST, longer == 0 ? MIEN_ERROR_BAKED_STRUCTURE : MIEN_OK);
    if (!rig) continue;
    EXPECT_FALSE(deformer_of(baked, rig, MIEN_ISA_BEST, MIEN_ERROR_BAKED_STRUCTURE));
  }
}

TEST(BakedFile, TwoRigsAreRefused) {
  const Bytes whole = TinyObjects().baked();
  const AlignedBytes file(file_of_parts({part_of(whole, 0), part_of(whole, 0)}));
  open_baked(file, MIEN_BAKED_CHECK_FULL, MIEN_ERROR_BAKED_STRUCTURE);
}

// The deformer of another character: whatever fits is used, nothing does harm.
TEST(BakedFile, PartsOfDifferentCharactersAreRefusedOrDoNoHarm) {
  std::vector<Bytes> files = {TinyObjects().baked()};
  for (uint32_t preset : {MIEN_PRESET_TINY, MIEN_PRESET_SMALL}) {
    const DnaHandle dna = generate_dna(preset, 1);
    const RigHandle rig = create_rig(dna.get());
    files.push_back(bake(rig.get(), create_deformer(dna.get(), rig.get()).get()));
  }
  for (const Bytes& a : files) {
    for (const Bytes& b : files) {
      const AlignedBytes file(file_of_parts({part_of(a, 0), part_of(b, 1)}));
      const ExerciseBaked life = exercise_baked(file.data(), file.size());
      EXPECT_EQ(life.broken, "");
      EXPECT_EQ(life.opened == MIEN_OK, &a == &b);
    }
  }
}

TEST(BakedFile, FullCheckFindsEveryChangedByte) {
  const Bytes bytes = tiny_baked();
  for (size_t at = offsetof(BakedHeader, checksum); at < bytes.size(); at += byte_stride()) {
    const MienStatus status =
        status_with(at, static_cast<uint8_t>(bytes[at] ^ 0x10), MIEN_BAKED_CHECK_FULL);
    EXPECT_TRUE(status == MIEN_ERROR_BAKED_CHECKSUM || status == MIEN_ERROR_BAKED_STRUCTURE ||
                status == MIEN_ERROR_BAKED_VERSION)
        << "byte " << at << ": " << mien_status_name(status);
    if (HasFailure()) break;
  }
}

TEST(BakedFile, EveryTruncationIsRefused) {
  const Bytes whole = TinyObjects().baked();
  for (size_t size = 0; size < whole.size(); ++size) {
    const AlignedBytes file(Bytes(whole.begin(), whole.begin() + static_cast<ptrdiff_t>(size)));
    const ExerciseBaked life = exercise_baked(file.data(), file.size());
    EXPECT_EQ(life.opened, size == 0 ? MIEN_ERROR_BAKED_SIGNATURE : MIEN_ERROR_BAKED_TRUNCATED);
    EXPECT_EQ(life.broken, "");
  }
  const AlignedBytes file(whole);
  const ExerciseBaked life = exercise_baked(file.data(), file.size());
  EXPECT_EQ(life.opened, MIEN_OK) << life.message;
  EXPECT_EQ(life.broken, "");
}

// The header and the table tell the truth about what is left: the parts do not.
TEST(BakedFile, EveryTruncationOfAPartIsRefused) {
  const Bytes whole = TinyObjects().baked();
  for (size_t cut : {0u, 1u}) {
    for (size_t size = 64; size < part_of(whole, cut).second.size(); size += 64) {
      std::vector<std::pair<BakedPart, Bytes>> parts = {part_of(whole, 0), part_of(whole, 1)};
      parts[cut].second.resize(size);
      const AlignedBytes file(file_of_parts(parts));
      const ExerciseBaked life = exercise_baked(file.data(), file.size());
      EXPECT_EQ(life.opened, MIEN_ERROR_BAKED_STRUCTURE) << "part " << cut << " of " << size;
      EXPECT_EQ(life.broken, "");
    }
  }
}

}  // namespace
}  // namespace mien
