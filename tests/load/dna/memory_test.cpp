// SPDX-License-Identifier: MIT
// Opening, choosing LODs, converting, validating and planning to write, while any one array cannot be had.
#include "runtime/load/dna/check/check_written.h"
#include "runtime/load/dna/dna_reader.h"
#include "tests/support/dna_bytes.h"
#include "tests/support/failing_arrays.h"
#include "tests/support/memory_stream.h"
#include "tests/support/random_layer_rig.h"
#include "tests/support/random_space_rig.h"
#include "tests/support/rig_handles.h"
#include "tests/support/tiny_rig.h"

namespace mien::dna {
namespace {

Status read(const Bytes& bytes, const ReadOptions& options, const Allocator& allocator,
            Error& error) {
  Arena arena(allocator);
  DnaView view;
  return read_dna(bytes.data(), bytes.size(), options, arena, view, error);
}

size_t fail_reading(const Bytes& bytes, const ReadOptions& options) {
  return fail_every_array([&](const Allocator& allocator, Error& error) {
    return read(bytes, options, allocator, error);
  });
}

Bytes tiny(uint16_t version = 8, bool keep_unknown = true) {
  Arena arena(default_allocator());
  return written(tiny_rig(arena), version, keep_unknown);
}

/// The LODs turn the tongue in different orders.
Bytes turned_differently() {
  Arena arena(default_allocator());
  DnaView view = tiny_rig(arena);
  view.bhvr.joints.groups[1].lods = be<uint16_t>(arena, {4, 1});
  return written(view);
}

/// Choosing LOD 1 leaves a vertex one of its weights.
Bytes skinned_to_the_tongue() {
  Arena arena(default_allocator());
  DnaView view = tiny_rig(arena);
  view.geom.meshes[0].skin_weights[3] = {be<float>(arena, {0.5f, 0.5f}),
                                         be<uint16_t>(arena, {2, 0})};
  return written(view);
}

std::vector<Bytes> files() {
  std::vector<Bytes> found = {tiny(), tiny(1), tiny(4, false), turned_differently(),
                              skinned_to_the_tongue()};
  for (uint64_t seed : {1, 2}) {
    Random random = Random::from_seed(14, seed);
    found.push_back(LayerFile(random_layer_rig(random, false, seed == 2)).bytes);
  }
  return found;
}

TEST(DnaMemory, EachArrayOfOpening) {
  for (const Bytes& bytes : files()) {
    EXPECT_GT(fail_reading(bytes, {}), 10u);
    for (uint64_t lods : {1, 2}) {
      ReadOptions options;
      options.lods = lods;
      fail_reading(bytes, options);
    }
  }
}

TEST(DnaMemory, EachArrayOfConverting) {
  Random random = Random::from_seed(14, 9);
  Arena arena(default_allocator());
  std::vector<Bytes> rigs = {tiny()};
  for (const bool euler_rows : {true, false}) {
    SpaceRigOptions options;
    options.euler_rows = euler_rows;
    rigs.push_back(written(random_space_rig(random, options, arena)));
  }
  size_t converted = 0;
  for (const Bytes& bytes : rigs) {
    for (const RotationRule rule : {RotationRule::kCarried, RotationRule::kExact}) {
      CoordinateSystem system = kNamedSystems[1].system;
      system.rotation_rule = rule;
      ReadOptions options;
      options.system = &system;
      Error refused;
      if (read(bytes, options, default_allocator(), refused) != Status::kOk) continue;
      ++converted;
      fail_reading(bytes, options);
    }
  }
  EXPECT_GE(converted, 4u);
}

TEST(DnaMemory, EachArrayOfReadingAStream) {
  const MemoryStream stream(tiny());
  EXPECT_GT(fail_every_array([&](const Allocator& allocator, Error& error) {
              Arena arena(allocator);
              DnaView view;
              return read_dna(stream.get(), {}, arena, view, error);
            }),
            10u);
}

TEST(DnaMemory, EachArrayOfPlanningToWrite) {
  Arena arena(default_allocator());
  const DnaView view = tiny_rig(arena);
  const WriteOptions options = {4, false};  // solvers, but not what their poses drive
  EXPECT_GT(fail_every_array([&](const Allocator& allocator, Error& error) {
              Arena left(allocator);
              return check_written(view, options, left, error);
            }),
            0u);
}

bool keep_first(void* user, const Finding& finding) {
  Error& first = *static_cast<Error*>(user);
  if (finding.status != Status::kOk && first.status == Status::kOk) {
    fail(first, finding.status, finding.byte_offset, "%s", finding.message);
  }
  return true;
}

TEST(DnaMemory, EachArrayOfValidating) {
  for (const Bytes& bytes : files()) {
    EXPECT_GT(fail_every_array([&](const Allocator& allocator, Error& error) {
                Arena arena(allocator);
                DnaView view;
                examine_dna(bytes.data(), bytes.size(), arena, view, {&error, keep_first, true});
                return error.status;
              }),
              10u);
  }
}

}  // namespace
}  // namespace mien::dna
