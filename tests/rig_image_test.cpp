// SPDX-License-Identifier: MIT
// Baked rigs: what is opened is what was saved, and whatever else is opened does no harm.
#include "runtime/rig/rig_image.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "tests/support/image_life.h"
#include "tests/support/many_rigs.h"
#include "tests/support/misuse.h"

namespace mien {
namespace {

Bytes save(const MienRig* rig) {
  size_t size = 0;
  EXPECT_EQ(mien_rig_save_memory(rig, nullptr, 0, &size, nullptr), MIEN_OK);
  Bytes bytes(size);
  EXPECT_EQ(mien_rig_save_memory(rig, bytes.data(), size, &size, nullptr), MIEN_OK);
  return bytes;
}

MienRigImageDesc image_desc(uint32_t isa = MIEN_ISA_BEST, uint32_t check = MIEN_IMAGE_CHECK_FULL) {
  MienRigImageDesc desc = sized<MienRigImageDesc>();
  desc.isa = isa;
  desc.check = check;
  return desc;
}

RigHandle open_image(const AlignedBytes& bytes, const MienRigImageDesc& desc = image_desc(),
                     MienStatus expected = MIEN_OK) {
  MienError error = sized<MienError>();
  MienRig* rig = nullptr;
  EXPECT_EQ(mien_rig_open_memory(bytes.data(), bytes.size(), &desc, &rig, &error), expected)
      << error.message;
  return RigHandle(rig);
}

RigHandle tiny() {
  Arena arena(default_allocator());
  const Bytes bytes = write_view(dna::tiny_rig(arena));
  return create_rig(open_dna(bytes).get());
}

// The tiny rig, with every layer, and networks.
Bytes tiny_image() { return save(tiny().get()); }
Bytes ml_image() {
  return save(create_rig(generate_dna(MIEN_PRESET_TINY, 1, MIEN_GENERATE_ML).get()).get());
}

// What is opened is what was saved ---------------------------------------------------------------

void expect_same(const MienDna* dna, const MienRigDesc& desc) {
  RigHandle rig = create_rig(dna, desc);
  const Bytes bytes = save(rig.get());
  const AlignedBytes image(bytes);
  RigHandle opened = open_image(image, image_desc(desc.isa));
  ASSERT_TRUE(opened);
  EXPECT_TRUE(save(opened.get()) == bytes) << "saved again, but with other bytes";

  MienRigInfo info = info_of(rig), again = info_of(opened);
  EXPECT_EQ(info.instance_bytes, again.instance_bytes);
  info.rig_bytes = again.rig_bytes = 0;
  EXPECT_EQ(memcmp(&info, &again, sizeof(info)), 0);
  for (uint32_t kind = 0; kind <= MIEN_KIND_TWIST_SWING; ++kind) {
    EXPECT_EQ(names_of(rig, kind), names_of(opened, kind));
  }

  Character a(rig), b(opened);
  Random random = Random::from_seed(5, 1);
  for (uint32_t lod = 0; lod < info.lod_count; ++lod) {
    for (uint32_t percent : {0u, 20u, 100u}) {
      draw_controls(random, percent, a.raw);
      std::copy(a.raw.begin(), a.raw.end(), b.raw.begin());
      for (size_t m = 0; m < a.masks.count; ++m) {
        a.masks[m] = b.masks[m] = static_cast<float>(random.below(5)) / 4;
      }
      a.evaluate(lod);
      b.evaluate(lod);
      EXPECT_TRUE(same_results(a, b)) << "LOD " << lod;
    }
    for (size_t i = 0; i < a.gui.count; ++i) {
      a.gui[i] = b.gui[i] = static_cast<float>(random.below(100)) / 50 - 1;
    }
    a.map_gui_to_raw();
    b.map_gui_to_raw();
    EXPECT_TRUE(same_bits(a.controls, b.controls));
    a.map_raw_to_gui();
    b.map_raw_to_gui();
    EXPECT_TRUE(same_bits(a.gui, b.gui));
  }
}

TEST(RigImage, EvaluatesAsTheRigThatWasSaved) {
  for_each_dna(8, [](const DnaHandle& dna) {
    for_each_rig_desc([&](MienRigDesc desc) {
      for (uint32_t masks : {MIEN_ML_MASKS_SWITCH, MIEN_ML_MASKS_BLEND}) {
        desc.ml_masks = masks;
        desc.arithmetic = masks;  // each of them once
        expect_same(dna.get(), desc);
      }
    });
  });
}

TEST(RigImage, NetworksBodiesAndOtherSystems) {
  const DnaHandle rigs[] = {generate_dna(MIEN_PRESET_TINY, 1, MIEN_GENERATE_ML),
                            generate_dna(MIEN_PRESET_BODY, 1, MIEN_GENERATE_ML),
                            generate_dna(MIEN_PRESET_HEAD, 0), generate_dna(MIEN_PRESET_LARGE, 2)};
  for (const DnaHandle& dna : rigs) {
    for (uint32_t rotation : {MIEN_OUTPUT_EULER, MIEN_OUTPUT_QUATERNION}) {
      MienRigDesc desc = sized<MienRigDesc>();
      desc.rotation = desc.storage = rotation;
      expect_same(dna.get(), desc);
    }
  }
  MienCoordinateSystem system = sized<MienCoordinateSystem>();
  ASSERT_EQ(mien_coordinate_system_named("unreal", 6, &system), MIEN_OK);
  const Bytes bytes = write_dna(rigs[0].get());
  MienDnaDesc desc = sized<MienDnaDesc>();
  desc.system = &system;
  MienDna* dna = nullptr;
  ASSERT_EQ(mien_dna_open_memory(bytes.data(), bytes.size(), &desc, &dna, nullptr), MIEN_OK);
  const DnaHandle turned(dna);
  expect_same(turned.get(), sized<MienRigDesc>());
}

TEST(RigImage, DoesNotDependOnTheInstructionSet) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_SMALL, 3);
  const Bytes expected = save(create_rig(dna.get()).get());
  for (uint32_t isa : present_isas()) {
    EXPECT_TRUE(save(create_rig(dna.get(), isa).get()) == expected) << mien_isa_name(isa);
  }
}

TEST(RigImage, CannotBeTurnedOffByReuse) {
  const AlignedBytes image(tiny_image());
  MienRigImageDesc desc = image_desc();
  desc.reuse = MIEN_REUSE_NOTHING;
  const RigHandle rig = open_image(image, desc);
  EXPECT_TRUE(reinterpret_cast<const Rig*>(rig.get())->always_evaluate);
  EXPECT_TRUE(save(rig.get()) == tiny_image());
}

// Files
// --------------------------------------------------------------------------------------------

struct TemporaryFile {
  std::string path = testing::TempDir() + "rig_image_test_" + std::to_string(getpid());
  ~TemporaryFile() { remove(path.c_str()); }
};

TEST(RigImage, FilesAreMappedOrReadWithFewAllocations) {
  const TemporaryFile file;
  const RigHandle rig = tiny();
  MienError error = sized<MienError>();
  ASSERT_EQ(mien_rig_save_file(rig.get(), file.path.c_str(), &error), MIEN_OK) << error.message;
  for (uint32_t access : {MIEN_FILE_MAP, MIEN_FILE_READ}) {
    CountingAllocator counter;
    const MienAllocator allocator = counter.get();
    MienRigImageDesc desc = image_desc();
    desc.file_access = access;
    desc.allocator = &allocator;
    MienRig* opened = nullptr;
    ASSERT_EQ(mien_rig_open_file(file.path.c_str(), &desc, &opened, &error), MIEN_OK)
        << error.message;
    EXPECT_EQ(counter.requests, access == MIEN_FILE_MAP ? 1u : 2u);
    EXPECT_TRUE(save(opened) == save(rig.get()));
    MienInstance* instance = nullptr;
    ASSERT_EQ(mien_instance_create(opened, nullptr, &instance, nullptr), MIEN_OK);
    mien_rig_destroy(opened);
    EXPECT_NE(counter.live, 0u) << "the instance needs the rig";
    mien_instance_destroy(instance);
    EXPECT_TRUE(counter.clean()) << counter.first_wrong;
  }
  MienRig* none = nullptr;
  EXPECT_EQ(mien_rig_open_file("/nonexistent/rig", nullptr, &none, &error), MIEN_ERROR_FILE_OPEN);
  EXPECT_EQ(mien_rig_save_file(rig.get(), "/nonexistent/rig", &error), MIEN_ERROR_FILE_WRITE);
}

TEST(RigImage, MemoryThatIsNotAlignedIsCopied) {
  const Bytes bytes = tiny_image();
  Bytes shifted(bytes.size() + 128);
  const size_t off = 64 - reinterpret_cast<uintptr_t>(shifted.data()) % 64 + 1;
  std::copy(bytes.begin(), bytes.end(), shifted.begin() + static_cast<ptrdiff_t>(off));
  MienRig* rig = nullptr;
  ASSERT_EQ(mien_rig_open_memory(shifted.data() + off, bytes.size(), nullptr, &rig, nullptr),
            MIEN_OK);
  const RigHandle opened(rig);
  std::fill(shifted.begin(), shifted.end(), uint8_t{0xA5});
  EXPECT_TRUE(save(rig) == bytes);
}

TEST(RigImage, EveryFailureOfMemoryIsSurvived) {
  const TemporaryFile file;
  const Bytes bytes = tiny_image();
  const RigHandle rig = tiny();
  ASSERT_EQ(mien_rig_save_file(rig.get(), file.path.c_str(), nullptr), MIEN_OK);
  Bytes shifted(bytes.size() + 64);
  const size_t off = 64 - reinterpret_cast<uintptr_t>(shifted.data()) % 64 + 1;
  shifted.resize(bytes.size() + off);
  std::copy(bytes.begin(), bytes.end(), shifted.begin() + static_cast<ptrdiff_t>(off));
  for (bool from_file : {true, false}) {
    for (size_t k = 1; k <= 2; ++k) {
      CountingAllocator counter;
      counter.fail_at = k;
      const MienAllocator allocator = counter.get();
      MienRigImageDesc desc = image_desc();
      desc.file_access = MIEN_FILE_READ;
      desc.allocator = &allocator;
      MienError error = sized<MienError>();
      MienRig* opened = nullptr;
      const MienStatus status =
          from_file
              ? mien_rig_open_file(file.path.c_str(), &desc, &opened, &error)
              : mien_rig_open_memory(shifted.data() + off, bytes.size(), &desc, &opened, &error);
      EXPECT_EQ(status, MIEN_ERROR_MEMORY);
      EXPECT_EQ(opened, nullptr);
      EXPECT_NE(error.message[0], 0);
      EXPECT_TRUE(counter.clean()) << counter.first_wrong;
    }
  }
}

// Misuse
// -------------------------------------------------------------------------------------------

TEST(RigImage, ArgumentsAreChecked) {
  const AlignedBytes image(tiny_image());
  const RigHandle rig = tiny();
  MienRig* out = nullptr;
  size_t size = 0;
  uint8_t small[8];
  EXPECT_EQ(mien_rig_save_file(nullptr, "x", nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_rig_save_file(rig.get(), nullptr, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_rig_save_memory(rig.get(), nullptr, 0, nullptr, nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_rig_save_memory(rig.get(), nullptr, 8, &size, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_rig_save_memory(nullptr, nullptr, 0, &size, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_rig_save_memory(rig.get(), small, 8, &size, nullptr), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(size, image.size());
  EXPECT_EQ(mien_rig_open_file(nullptr, nullptr, &out, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_rig_open_file("x", nullptr, nullptr, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_rig_open_memory(nullptr, 64, nullptr, &out, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_rig_open_memory(nullptr, 0, nullptr, &out, nullptr), MIEN_ERROR_IMAGE_SIGNATURE);

  const auto refused = [&](MienStatus expected, auto&& change) {
    MienRigImageDesc desc = image_desc();
    change(desc);
    out = reinterpret_cast<MienRig*>(&desc);
    MienError error = sized<MienError>();
    EXPECT_EQ(mien_rig_open_memory(image.data(), image.size(), &desc, &out, &error), expected);
    EXPECT_EQ(out, nullptr);
    EXPECT_NE(error.message[0], 0);
  };
  refused(MIEN_ERROR_STRUCT_SIZE, [](MienRigImageDesc& d) { d.struct_size = 8; });
  refused(MIEN_ERROR_INVALID_ARGUMENT, [](MienRigImageDesc& d) { d.isa = 99; });
  refused(MIEN_ERROR_INVALID_ARGUMENT, [](MienRigImageDesc& d) { d.file_access = 2; });
  refused(MIEN_ERROR_INVALID_ARGUMENT, [](MienRigImageDesc& d) { d.check = 2; });
  refused(MIEN_ERROR_INVALID_ARGUMENT, [](MienRigImageDesc& d) { d.reuse = 2; });
  refused(MIEN_ERROR_INVALID_ARGUMENT, [](MienRigImageDesc& d) { d.reserved = 1; });
  const MienAllocator half = {nullptr, nullptr, nullptr};
  refused(MIEN_ERROR_INVALID_ARGUMENT, [&](MienRigImageDesc& d) { d.allocator = &half; });
}

// Foreign and damaged images
// -----------------------------------------------------------------------

/// Status of an image with a number of its header, or anything else, changed.
template <class T>
MienStatus status_with(size_t offset, T value, uint32_t check = MIEN_IMAGE_CHECK_SAFE) {
  const AlignedBytes image(tiny_image());
  memcpy(image.data() + offset, &value, sizeof(value));
  const MienRigImageDesc desc = image_desc(MIEN_ISA_BEST, check);
  MienRig* rig = nullptr;
  const MienStatus status = mien_rig_open_memory(image.data(), image.size(), &desc, &rig, nullptr);
  mien_rig_destroy(rig);
  return status;
}

TEST(RigImage, ForeignImagesAreRefused) {
  EXPECT_EQ(status_with(0, 'X'), MIEN_ERROR_IMAGE_SIGNATURE);
  EXPECT_EQ(status_with(offsetof(ImageHeader, byte_order), uint32_t{0x04030201}),
            MIEN_ERROR_IMAGE_VERSION);
  EXPECT_EQ(status_with(offsetof(ImageHeader, version), kImageVersion + 1),
            MIEN_ERROR_IMAGE_VERSION);
  EXPECT_EQ(status_with(offsetof(ImageHeader, file_size), uint64_t{1} << 40),
            MIEN_ERROR_IMAGE_TRUNCATED);
  EXPECT_EQ(status_with(offsetof(ImageHeader, file_size), uint64_t{64}),
            MIEN_ERROR_IMAGE_STRUCTURE);
  EXPECT_EQ(status_with(offsetof(ImageHeader, span_count), uint32_t{1}),
            MIEN_ERROR_IMAGE_STRUCTURE);
  const ImageHeader header = [] {
    ImageHeader h;
    memcpy(&h, tiny_image().data(), sizeof(h));
    return h;
  }();
  const size_t first_span = sizeof(ImageHeader) + header.scalar_count * sizeof(uint64_t);
  EXPECT_EQ(status_with(first_span + offsetof(ImageSpan, element_size), uint32_t{3}),
            MIEN_ERROR_IMAGE_VERSION);
  EXPECT_EQ(status_with(first_span + offsetof(ImageSpan, offset), uint64_t{0}),
            MIEN_ERROR_IMAGE_STRUCTURE);
  EXPECT_EQ(status_with(first_span + offsetof(ImageSpan, count), ~uint64_t{0}),
            MIEN_ERROR_IMAGE_STRUCTURE);
}

TEST(RigImage, DnaIsNoImageAndImagesAreNoDna) {
  Arena arena(default_allocator());
  const AlignedBytes dna(write_view(dna::tiny_rig(arena)));
  open_image(dna, image_desc(), MIEN_ERROR_IMAGE_SIGNATURE);
  open_dna(tiny_image(), 0, MIEN_ERROR_DNA_SIGNATURE);
}

TEST(RigImage, FullCheckFindsEveryChangedByte) {
  const Bytes bytes = tiny_image();
  for (size_t at = offsetof(ImageHeader, checksum); at < bytes.size(); ++at) {
    const MienStatus status =
        status_with(at, static_cast<uint8_t>(bytes[at] ^ 0x10), MIEN_IMAGE_CHECK_FULL);
    EXPECT_TRUE(status == MIEN_ERROR_IMAGE_CHECKSUM || status == MIEN_ERROR_IMAGE_STRUCTURE ||
                status == MIEN_ERROR_IMAGE_VERSION)
        << "byte " << at << ": " << mien_status_name(status);
    if (HasFailure()) break;
  }
}

TEST(RigImage, EveryTruncationIsRefused) {
  for (const Bytes& whole : {tiny_image(), ml_image()}) {
    for (size_t size = 0; size < whole.size(); size += 64) {
      const AlignedBytes image(Bytes(whole.begin(), whole.begin() + static_cast<ptrdiff_t>(size)));
      const ImageLife life = live_image(image.data(), image.size());
      EXPECT_EQ(life.opened, size == 0 ? MIEN_ERROR_IMAGE_SIGNATURE : MIEN_ERROR_IMAGE_TRUNCATED);
      EXPECT_EQ(life.broken, "");
    }
    const AlignedBytes image(whole);
    const ImageLife life = live_image(image.data(), image.size());
    EXPECT_EQ(life.opened, MIEN_OK) << life.message;
    EXPECT_EQ(life.broken, "");
  }
}

// Each byte of what is not mere numbers: one bit of it, all of it, and the largest value.
TEST(RigImage, AnyChangeIsRefusedOrDoesNoHarm) {
  size_t refused = 0, survived = 0;
  for (const Bytes& whole : {tiny_image(), ml_image()}) {
    const AlignedBytes image(whole);
    for (size_t at = 0; at < whole.size(); ++at) {
      for (const int change : {1 << at % 8, 0xFF, -1}) {
        const auto byte = static_cast<uint8_t>(change < 0 ? 0xFF : whole[at] ^ change);
        image.data()[at] = byte;
        const ImageLife life = live_image(image.data(), image.size());
        ++(life.opened == MIEN_OK ? survived : refused);
        EXPECT_EQ(life.broken, "") << "byte " << at << " is " << unsigned{byte};
      }
      image.data()[at] = whole[at];
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(refused, survived / 4);
  EXPECT_GT(survived, 0u);
}

}  // namespace
}  // namespace mien
