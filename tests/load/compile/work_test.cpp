// SPDX-License-Identifier: MIT
// Files that ask for more work than their bytes deserve are refused, with the table that does; all
// others stay within the bound of SECURITY.md: opening, compiling, a deformer, a frame at each LOD.
#include "runtime/rig/work.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "runtime/baked/baked_objects.h"
#include "runtime/deform/deformer_instance.h"
#include "tests/support/baked_bytes.h"
#include "tests/support/bytes.h"
#include "tests/support/cpu_time.h"
#include "tests/support/exercise_dna.h"
#include "tests/support/golden.h"
#include "tests/support/long_run.h"
#include "tests/support/many_rigs.h"

namespace mien {
namespace {

// Files made for it ------------------------------------------------------------------------------

using dna::Array;
using dna::be;
using dna::DnaView;
using dna::List;
using dna::MlOperation;

Array<uint16_t> counted(Arena& arena, uint32_t count, uint16_t first = 0, uint16_t step = 1) {
  const dna::NewArray<uint16_t> array = dna::new_array<uint16_t>(arena, count);
  for (uint32_t i = 0; i < count; ++i) array.set(i, static_cast<uint16_t>(first + i * step));
  return array;
}
Array<float> zeros(Arena& arena, size_t count) {
  const dna::NewArray<float> array = dna::new_array<float>(arena, count);
  for (uint32_t i = 0; i < count; ++i) array.set(i, 0);
  return array;
}

/// A type of two sets: a gather and the network in the first, `operations` in the second; all of
/// them at both LODs.
void set_operations(Arena& arena, DnaView& view, const List<MlOperation>& operations) {
  MlOperation gather, run;
  gather.type = static_cast<uint16_t>(dna::MlOperationType::kGather);
  run.type = static_cast<uint16_t>(dna::MlOperationType::kMlp);
  run.parameters = be<uint32_t>(arena, {0});
  gather.parameters = be<uint32_t>(arena, {0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1, 2});
  const auto both_lods = [&](uint32_t count) {
    return dna::LodMap{be<uint16_t>(arena, {0, 0}),
                       dna::list<Array<uint16_t>>(arena, {counted(arena, count)})};
  };
  run.set_dependencies = be<uint16_t>(arena, {0});
  run.operation_dependencies = be<uint16_t>(arena, {0});
  dna::MlType type;
  type.operations = dna::list<List<MlOperation>>(
      arena,
      {dna::list<MlOperation>(arena, {gather}), dna::list<MlOperation>(arena, {run}), operations});
  type.lod_operations =
      dna::list<dna::LodMap>(arena, {both_lods(1), both_lods(1), both_lods(operations.count)});
  view.mlbe = {};
  view.mlbe.types = dna::list<dna::MlType>(arena, {type});
}

/// A network of 12 inputs and `outputs` outputs.
void set_network(Arena& arena, DnaView& view, uint32_t outputs) {
  dna::NetworkLayer layer;
  layer.biases = zeros(arena, outputs);
  layer.weights = zeros(arena, size_t{outputs} * 12);
  view.mlbh.networks[0].layers = dna::list<dna::NetworkLayer>(arena, {layer});
}

/// A sum that adds the outputs of the network `times` times.
void repeat_sum(Arena& arena, DnaView& view, uint32_t times) {
  constexpr uint32_t kOutputs = 4000;
  set_network(arena, view, kOutputs);
  MlOperation sum;
  sum.type = static_cast<uint16_t>(dna::MlOperationType::kWeightedSum);
  sum.set_dependencies = counted(arena, times, 1, 0);
  sum.operation_dependencies = counted(arena, times, 0, 0);
  const dna::NewArray<uint32_t> parameters = dna::new_array<uint32_t>(arena, 1 + times);
  for (uint32_t i = 0; i <= times; ++i) parameters.set(i, i == 0 ? kOutputs : 0);
  sum.parameters = parameters;
  set_operations(arena, view, dna::list<MlOperation>(arena, {sum}));
}

/// `times` operations that run one network.
void repeat_network(Arena& arena, DnaView& view, uint32_t times) {
  set_network(arena, view, 4000);
  MlOperation run;
  run.type = static_cast<uint16_t>(dna::MlOperationType::kMlp);
  run.parameters = be<uint32_t>(arena, {0});
  run.set_dependencies = run.operation_dependencies = be<uint16_t>(arena, {0});
  const Span<MlOperation> runs = arena.array<MlOperation>(times);
  for (MlOperation& operation : runs) operation = run;
  set_operations(arena, view, {runs.data, times});
}

/// `times` solvers that share a pose, which drives many controls.
void share_pose(Arena& arena, DnaView& view, uint32_t times) {
  constexpr uint32_t kOutputs = 20000;
  dna::RbfPoseControls& pose = view.rbfe.poses[1];
  pose.output_control_indices = counted(arena, kOutputs, 9, 0);
  pose.output_control_weights = zeros(arena, kOutputs);
  const Span<dna::RbfSolver> solvers = arena.array<dna::RbfSolver>(times);
  for (dna::RbfSolver& solver : solvers) solver = view.rbfb.solvers[0];
  view.rbfb.solvers = {solvers.data, times};
  view.rbfb.lod_solvers.indices[0] = counted(arena, times);
}

/// Solvers of `poses` poses, whose matrices are inverted or whose radius is measured.
void many_poses(Arena& arena, DnaView& view, uint32_t poses, bool interpolative) {
  constexpr uint32_t kSolvers = 4;
  dna::RbfSolver solver = view.rbfb.solvers[0];
  solver.pose_indices = counted(arena, poses, 0, 0);
  solver.raw_control_indices = counted(arena, interpolative ? 1 : 100, 0, 0);
  solver.raw_control_values = zeros(arena, size_t{poses} * solver.raw_control_indices.count);
  solver.solver_type = interpolative;
  solver.automatic_radius = interpolative;  // 1 is off
  const Span<dna::RbfSolver> solvers = arena.array<dna::RbfSolver>(kSolvers);
  for (dna::RbfSolver& s : solvers) s = solver;
  view.rbfb.solvers = {solvers.data, kSolvers};
  view.rbfb.lod_solvers.indices[0] = be<uint16_t>(arena, {0});
}
void invert(Arena& arena, DnaView& view, uint32_t poses) { many_poses(arena, view, poses, true); }

struct Asked {
  const char* table;
  void (*ask)(Arena& arena, DnaView& view, uint32_t times);
  uint32_t allowed, refused;
};
constexpr Asked kAsked[] = {{"mlbe", repeat_sum, 1000, 10000},
                            {"mlbe", repeat_network, 100, 1000},
                            {"rbfb.solvers", share_pose, 100, 1000},
                            {"rbfb.solvers", invert, 100, 400}};

TEST(Work, OutOfProportionIsRefusedWithItsTable) {
  for (const Asked& asked : kAsked) {
    for (const uint32_t times : {asked.allowed, asked.refused}) {
      SCOPED_TRACE(asked.table + (" " + std::to_string(times)));
      Arena arena(default_allocator());
      DnaView view = dna::tiny_rig(arena);
      asked.ask(arena, view, times);
      const Bytes bytes = write_view(view);
      ASSERT_LT(bytes.size(), kLeastBytes);
      const DnaHandle dna = open_dna(bytes);
      ASSERT_TRUE(dna);
      MienError error = sized<MienError>();
      MienRig* rig = nullptr;
      const MienStatus status = mien_rig_create(dna.get(), nullptr, &rig, &error);
      mien_rig_destroy(rig);
      EXPECT_EQ(status, times == asked.allowed ? MIEN_OK : MIEN_ERROR_DNA_LIMIT) << error.message;
      if (status != MIEN_OK) {
        EXPECT_EQ(strncmp(error.message, asked.table, strlen(asked.table)), 0) << error.message;
      }
    }
  }
}

TEST(Work, SolversAreListedOncePerLod) {
  Arena arena(default_allocator());
  DnaView view = dna::tiny_rig(arena);
  for (const uint32_t times : {2u, 32u, 33u, 1000u}) {
    view.rbfb.lod_solvers.indices[0] = counted(arena, times, 0, 0);
    EXPECT_FALSE(open_dna(write_view(view), 0, MIEN_ERROR_DNA_VALUE)) << times;
  }
  view.rbfb.lod_solvers.indices[0] = counted(arena, 1);
  EXPECT_TRUE(open_dna(write_view(view)));
  // What runs no matter how often it is listed may be listed twice.
  view.defn.lod_meshes.indices[0] = be<uint16_t>(arena, {0, 0});
  EXPECT_TRUE(open_dna(write_view(view)));
}

// A count that follows from the tables alone, whatever the machine: at most the products of what was
// asked for, and not less than a tenth of them.
TEST(Work, CountsWhatIsRepeated) {
  Arena arena(default_allocator());
  const auto count = [&](const Asked& asked, uint32_t times, uint64_t& rbf, uint64_t& ml) {
    DnaView view = dna::tiny_rig(arena);
    asked.ask(arena, view, times);
    const RigHandle rig = create_rig(open_dna(write_view(view)).get());
    ASSERT_TRUE(rig);
    rbf = count_rbf_steps(*capi::object(rig.get()), ~uint64_t{0});
    ml = count_ml_steps(*capi::object(rig.get()), ~uint64_t{0});
  };
  uint64_t rbf[2], ml[2];
  for (int i = 0; i < 2; ++i) count(kAsked[0], 10u << i, rbf[i], ml[i]);
  EXPECT_NEAR(double(ml[1] - ml[0]), 2 * 10 * 4 * 4001.0, 1) << "four steps an addition";
  for (int i = 0; i < 2; ++i) count(kAsked[1], 10u << i, rbf[i], ml[i]);
  // At two LODs: what is gathered, what comes out, half a step a product with eight for the output,
  // and 32 each for the step and for its layer.
  EXPECT_EQ(ml[1] - ml[0], 2 * 10 * (32 + 12 + 4000 + 32 + 4000 * (12 + 8) / 2u));
  for (int i = 0; i < 2; ++i) count(kAsked[2], 10u << i, rbf[i], ml[i]);
  EXPECT_NEAR(double(rbf[1] - rbf[0]), 10 * 6 * 20000.0, 10 * 1000);
}

// A step for four products of interpolation, at the one LOD that runs the solver.
TEST(Work, CountsInterpolation) {
  Arena arena(default_allocator());
  uint64_t steps[2];
  for (const bool interpolative : {false, true}) {
    DnaView view = dna::tiny_rig(arena);
    many_poses(arena, view, 80, interpolative);
    dna::RbfSolver& solver = view.rbfb.solvers[0];
    solver.raw_control_indices = counted(arena, 1, 0, 0);
    solver.raw_control_values = zeros(arena, 80);
    view.rbfb.solvers.count = 1;
    const RigHandle rig = create_rig(open_dna(write_view(view)).get());
    ASSERT_TRUE(rig);
    steps[interpolative] = count_rbf_steps(*capi::object(rig.get()), ~uint64_t{0});
  }
  EXPECT_EQ(steps[1] - steps[0], 80u * 80 / 4);
}

// Per eight poses, a step for four inputs of each, and four for its weight; then one for each input.
TEST(Work, CountsDistances) {
  Arena arena(default_allocator());
  const auto count = [&](uint32_t inputs) {
    DnaView view = dna::tiny_rig(arena);
    many_poses(arena, view, 16, false);
    dna::RbfSolver& solver = view.rbfb.solvers[0];
    solver.raw_control_indices = counted(arena, inputs, 0, 0);
    solver.raw_control_values = zeros(arena, 16 * size_t{inputs});
    view.rbfb.solvers.count = 1;
    const RigHandle rig = create_rig(open_dna(write_view(view)).get());
    return count_rbf_steps(*capi::object(rig.get()), ~uint64_t{0});
  };
  EXPECT_EQ(count(80) - count(40), 16u * (20 - 10) + 40);
}

// Values that come from operations are fetched, four steps for each operation and one for each value;
// those of controls are gathered, a step each.
TEST(Work, CountsWhatOperationsHandOn) {
  Arena arena(default_allocator());
  constexpr uint32_t kValues = 12, kRuns = 10, kLods = 2;
  uint64_t steps[2];
  for (const uint16_t set : {uint16_t{0}, uint16_t{1}}) {  // of the gather, of the first network
    DnaView view = dna::tiny_rig(arena);
    set_network(arena, view, kValues);
    MlOperation run;
    run.type = static_cast<uint16_t>(dna::MlOperationType::kMlp);
    run.parameters = be<uint32_t>(arena, {0});
    run.set_dependencies = be<uint16_t>(arena, {set});
    run.operation_dependencies = be<uint16_t>(arena, {0});
    const Span<MlOperation> runs = arena.array<MlOperation>(kRuns);
    for (MlOperation& operation : runs) operation = run;
    set_operations(arena, view, {runs.data, kRuns});
    const RigHandle rig = create_rig(open_dna(write_view(view)).get());
    ASSERT_TRUE(rig);
    steps[set] = count_ml_steps(*capi::object(rig.get()), ~uint64_t{0});
  }
  EXPECT_EQ(steps[1] - steps[0], kLods * kRuns * (4 + kValues - kValues));
}

// Each matrix is inverted where the one before it was.
TEST(Work, InversionTakesTheMemoryOfOneSolver) {
  constexpr uint32_t kPoses = 80;
  constexpr size_t kMatrix = size_t{2} * kPoses * kPoses * sizeof(double);
  size_t scratch[2];
  for (const bool many : {false, true}) {
    Arena arena(default_allocator());
    DnaView view = dna::tiny_rig(arena);
    many_poses(arena, view, kPoses, true);
    if (!many) view.rbfb.solvers.count = 1;
    const Bytes bytes = write_view(view);
    const DnaHandle dna = open_dna(bytes);
    CountingAllocator counter;
    const MienAllocator allocator = counter.get();
    const RigHandle rig = create_rig(dna.get(), desc_with<MienRigDesc>(&allocator));
    ASSERT_TRUE(rig);
    scratch[many] = counter.peak - counter.bytes;  // beside the rig, which stays
  }
  EXPECT_GE(scratch[false], kMatrix);
  EXPECT_LT(scratch[true], scratch[false] + kMatrix);
}

// Rigs that people make are far away from the limits.
TEST(Work, OrdinaryRigsTakeATenthAtMost) {
  const auto expect_little = [](const MienDna* dna) {
    const RigHandle handle = create_rig(dna);
    ASSERT_TRUE(handle);
    const Rig& rig = *capi::object(handle.get());
    const uint64_t budget = work_budget(rig.block_size);
    EXPECT_LE(count_rbf_steps(rig, budget), budget / 10);
    EXPECT_LE(count_ml_steps(rig, budget), budget / 10);
  };
  for (const std::string& name : golden::present_names()) {
    SCOPED_TRACE(name);
    const Bytes bytes = golden::read_rig(name);
    expect_little(open_dna(bytes).get());
  }
  for (uint32_t preset = MIEN_PRESET_TINY; preset <= largest_preset(); ++preset) {
    SCOPED_TRACE(preset);
    expect_little(generate_dna(preset, 3).get());
  }
}

// What compiling would have refused is refused in a baked file too.
TEST(Work, BakedRigsAreHeldToTheirBytes) {
  for (const Asked& asked : {kAsked[0], kAsked[2]}) {
    SCOPED_TRACE(asked.table);
    Arena arena(default_allocator());
    DnaView view = dna::tiny_rig(arena);
    asked.ask(arena, view, asked.allowed);
    const RigHandle handle = create_rig(open_dna(write_view(view)).get());
    ASSERT_TRUE(handle);
    Rig& rig = *capi::object(handle.get());
    Error error;
    EXPECT_EQ(check_rig(rig, 1000, false, error), Status::kOk) << error.message;
    // The same tables, as if a sum added more often, and more solvers ran.
    const bool rbf = asked.table[0] == 'r';
    if (rbf) {
      const Span<uint16_t> one = rig.rbf.lod_solvers.at(0);
      const Span<uint16_t> many = arena.array<uint16_t>(one.count * 20);
      for (size_t i = 0; i < many.count; ++i) many[i] = one[i % one.count];
      const Span<uint32_t> first = arena.array<uint32_t>(rig.rbf.lod_solvers.first.count);
      for (size_t i = 1; i < first.count; ++i) first[i] = static_cast<uint32_t>(many.count);
      rig.rbf.lod_solvers.indices = many;
      rig.rbf.lod_solvers.first = first;
    } else {
      // The sum, which is the last step, adds its first dependency again and again.
      const size_t count = rig.ml.steps.count;
      const Span<MlStep> steps = arena.array<MlStep>(count);
      std::copy(rig.ml.steps.begin(), rig.ml.steps.end(), steps.begin());
      const uint32_t first = steps[count - 1].first_dependency;
      const Span<MlDependency> many = arena.array<MlDependency>(200000);
      for (size_t i = 0; i < many.count; ++i) {
        many[i] = rig.ml.dependencies[std::min<size_t>(i, first)];
      }
      steps[count - 1].dependency_count = static_cast<uint32_t>(many.count) - first;
      rig.ml.steps = steps;
      rig.ml.dependencies = many;
    }
    EXPECT_EQ(check_rig(rig, 1000, false, error), Status::kBakedStructure);
    EXPECT_NE(strstr(error.message, rbf ? "work of RBF solvers" : "work of learned behavior"),
              nullptr)
        << error.message;
    // And as a file, whose bytes nobody else made wrong.
    Bytes bytes(baked_size(rig, nullptr));
    bake(rig, nullptr, bytes.data());
    for (const uint32_t check : {MIEN_BAKED_CHECK_SAFE, MIEN_BAKED_CHECK_FULL}) {
      const AlignedBytes file(bytes);
      const BakedHandle baked = open_baked(file, check);
      EXPECT_FALSE(rig_of(baked, MIEN_ISA_ENVIRONMENT, MIEN_ERROR_BAKED_STRUCTURE));
    }
  }
}

// Files from elsewhere ---------------------------------------------------------------------------

/// 100 ms for each MiB, of which a smaller file has one.
double bound(size_t bytes) { return 0.1 * std::max(1.0, double(bytes) / (1 << 20)); }

// That tables ask for no more than they may is counted, above. What nobody counts, such as a loop over
// all pairs somewhere between opening and the last vertex, shows in time alone. So this is a clock: time
// of the processor, 2.5 times the bound where files that were not bounded took 100 times it, and the
// best of three. Under sanitizers and emulators time says less still.
#if defined(__has_feature)
#define MIEN_HAS_FEATURE(name) __has_feature(name)
#else
#define MIEN_HAS_FEATURE(name) 0
#endif
#if defined(__x86_64__) && !defined(_WIN32) && !defined(__SANITIZE_ADDRESS__) && \
    !MIEN_HAS_FEATURE(address_sanitizer)
constexpr double kSlack = 2.5;
#else
constexpr double kSlack = 100;
#endif

struct Course {
  MienStatus status = MIEN_OK;
  std::string message;
  double open = 0, rig = 0, deformer = 0, frames = 0;

  double seconds() const { return open + rig + deformer + frames; }
};

void run_frames(const MienRig* rig, const MienDeformer* deformer, Course& course) {
  MienRigInfo info = {};
  info.struct_size = sizeof(info);
  ASSERT_EQ(mien_rig_info(rig, &info), MIEN_OK);
  MienInstance* instance = nullptr;
  ASSERT_EQ(mien_instance_create(rig, nullptr, &instance, nullptr), MIEN_OK);
  MienDeformerInstance* pose = nullptr;
  if (deformer) {
    ASSERT_EQ(mien_deformer_instance_create(deformer, nullptr, &pose, nullptr), MIEN_OK);
  }
  uint32_t meshes = 0;
  (void)mien_rig_count(rig, MIEN_KIND_MESH, &meshes);
  MienMutableFloatView gui = {}, raw = {};
  (void)mien_instance_gui_controls(instance, &gui);
  (void)mien_instance_raw_controls(instance, &raw);
  for (size_t i = 0; i < gui.count; ++i) gui.data[i] = 0.25f + 0.5f * float(i % 2);
  uint32_t refused = 0;  // counted, since expectations would take longer than calls that do nothing
  const double begin = cpu_seconds();
  for (uint32_t lod = 0; lod < info.lod_count; ++lod) {
    (void)mien_rig_map_gui_to_raw(rig, instance);
    for (size_t i = 0; i < raw.count; ++i) raw.data[i] = 0.25f + 0.5f * float((i + lod) % 2);
    EXPECT_EQ(mien_rig_evaluate(rig, instance, lod), MIEN_OK);
    if (!pose) continue;
    EXPECT_EQ(mien_deformer_instance_update(pose, instance), MIEN_OK);
    for (uint32_t m = 0; m < meshes; ++m) {
      refused +=
          mien_deformer_instance_deform(pose, m, MIEN_NORMALS_RECOMPUTED, nullptr) != MIEN_OK;
    }
  }
  course.frames = cpu_seconds() - begin;
  EXPECT_EQ(refused, 0u);
  mien_deformer_instance_destroy(pose);
  mien_instance_destroy(instance);
}

Course run(const Bytes& file) {
  Course course;
  MienError error = {};
  error.struct_size = sizeof(error);
  MienDna* dna = nullptr;
  MienRig* rig = nullptr;
  MienDeformer* deformer = nullptr;
  double at = cpu_seconds();
  const auto lap = [&](double& lap_seconds) {
    lap_seconds = cpu_seconds() - at;
    at = cpu_seconds();
  };
  course.status = mien_dna_open_memory(file.data(), file.size(), nullptr, &dna, &error);
  lap(course.open);
  if (dna) {
    course.status = mien_rig_create(dna, nullptr, &rig, &error);
    lap(course.rig);
  }
  if (rig) {
    course.status = mien_deformer_create(dna, rig, nullptr, &deformer, &error);
    lap(course.deformer);
    run_frames(rig, deformer, course);
  }
  course.message = error.message;
  mien_deformer_destroy(deformer);
  mien_rig_destroy(rig);
  mien_dna_close(dna);
  return course;
}

Bytes read_bytes(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(in), {});
}

void expect_within_bound(const std::string& name, const Bytes& file) {
  Course c = run(file);
  for (int again = 0; again < 2 && c.seconds() > kSlack * bound(file.size()); ++again)
    c = run(file);
  printf(
      "%-32s %8zu bytes, %4.0f ms allowed: open %4.0f rig %4.0f deformer %4.0f frames %4.0f; "
      "%d %s\n",
      name.c_str(), file.size(), 1e3 * bound(file.size()), 1e3 * c.open, 1e3 * c.rig,
      1e3 * c.deformer, 1e3 * c.frames, c.status, c.message.c_str());
  EXPECT_LE(c.seconds(), kSlack * bound(file.size())) << name;
}

// The files below, made anew, for those who do not have them. What the tables repeat is in the tests
// above; these are long, and every LOD has all of it.
TEST(Work, LongTablesMeetTheBound) {
  constexpr uint16_t kLods = 33, kMany = 65000;
  const auto expect = [](const char* name, const PlainRig& plain, uint32_t meshes) {
    Arena arena(default_allocator());
    DnaView view = to_view(plain, arena);
    const Span<dna::String> names = arena.array<dna::String>(meshes);
    for (dna::String& mesh : names) mesh = dna::text("m");
    view.defn.mesh_names = {names.data, meshes};
    view.defn.lod_meshes = {counted(arena, plain.lod_count, 0, 0),
                            dna::list<Array<uint16_t>>(arena, {counted(arena, meshes)})};
    expect_within_bound(name, write_view(view));
  };
  PlainRig meshes;
  meshes.lod_count = kLods;
  meshes.raw_count = 4;
  meshes.joint_count = 1;
  expect("meshes without geometry", meshes, kMany);

  PlainRig chain = meshes;  // each corrective reads the one before it
  chain.psd_count = 16000;
  for (uint16_t i = 0; i < chain.psd_count; ++i) {
    const auto row = static_cast<uint16_t>(4 + i);
    chain.psds.push_back({row, static_cast<uint16_t>(row - 1), 1});
  }
  expect("a chain of correctives", chain, 1);

  PlainRig nothing = meshes;  // correctives without a product
  nothing.psd_count = kMany;
  expect("correctives without products", nothing, 1);

  PlainRig rows = meshes;  // a joint group whose rows repeat one output
  PlainGroup group;
  group.lods.assign(kLods, kMany);
  group.inputs = {0};
  group.outputs.assign(kMany, 3);
  group.values.assign(kMany, 1);
  rows.groups = {group};
  expect("rows of one output", rows, 1);
}

// Correctives are many for a few bytes, so their names are put in order by their numbers.
TEST(Work, NumbersAreInTheOrderOfTheirNames) {
  for (const uint16_t count : {1, 2, 9, 10, 11, 20, 99, 100, 101, 110, 999, 1000, 1201, 65000}) {
    SCOPED_TRACE(count);
    Arena arena(default_allocator());
    PlainRig plain;
    plain.lod_count = plain.joint_count = plain.raw_count = 1;
    plain.psd_count = count;
    const RigHandle rig = create_rig(open_dna(write_view(to_view(plain, arena))).get());
    ASSERT_TRUE(rig);
    std::vector<std::string> names, sorted;
    for (uint32_t i = 0; i < count; ++i) names.push_back("psd" + std::to_string(i));
    const NameList& list = capi::object(rig.get())->names[size_t(Kind::kPsdControl)];
    for (const uint32_t i : list.sorted) sorted.push_back(i < count ? names[i] : "");
    std::sort(names.begin(), names.end());
    EXPECT_EQ(sorted, names);
  }
}

// A file names a mesh with six bytes: one without geometry takes a record and next to nothing else.
TEST(Work, MeshesWithoutGeometryTakeTheirRecordOnly) {
  constexpr uint32_t kMany = 10000;
  Arena arena(default_allocator());
  DnaView view = dna::tiny_rig(arena);
  const Span<dna::String> names = arena.array<dna::String>(kMany);
  for (dna::String& mesh : names) mesh = dna::text("m");
  view.defn.mesh_names = {names.data, kMany};
  view.defn.lod_meshes.indices = dna::list<Array<uint16_t>>(arena, {counted(arena, kMany)});
  const Bytes bytes = write_view(view);
  const DnaHandle dna = open_dna(bytes);
  const RigHandle rig = create_rig(dna.get());
  ASSERT_TRUE(rig);
  MienDeformer* deformer = nullptr;
  ASSERT_EQ(mien_deformer_create(dna.get(), rig.get(), nullptr, &deformer, nullptr), MIEN_OK);
  MienDeformerInfo info = sized<MienDeformerInfo>();
  EXPECT_EQ(mien_deformer_info(deformer, &info), MIEN_OK);
  EXPECT_LE(info.deformer_bytes, kMany * (sizeof(DeformMesh) + 32) + 10000);
  EXPECT_LE(info.instance_bytes, kMany * (sizeof(DeformedMesh) + 16) + 10000);
  MienMesh mesh = sized<MienMesh>();
  EXPECT_EQ(mien_deformer_mesh(deformer, kMany - 1, &mesh), MIEN_OK);
  EXPECT_EQ(mesh.lods, 3u) << "both LODs show it";
  EXPECT_EQ(mesh.position_count + mesh.vertex_count + mesh.triangle_count, 0u);
  MienDeformerInstance* instance = nullptr;
  EXPECT_EQ(mien_deformer_instance_create(deformer, nullptr, &instance, nullptr), MIEN_OK);
  for (const uint32_t m : {0u, 1u, kMany - 1}) {
    for (uint32_t normals = 0; normals <= MIEN_NORMALS_RECOMPUTED; ++normals) {
      EXPECT_EQ(mien_deformer_instance_deform(instance, m, normals, nullptr), MIEN_OK);
    }
  }
  MienFloatView positions = {};
  EXPECT_EQ(mien_deformer_instance_positions(instance, kMany - 1, &positions), MIEN_OK);
  EXPECT_EQ(positions.count, 0u);
  mien_deformer_instance_destroy(instance);
  mien_deformer_destroy(deformer);
}

TEST(Work, HostileFilesMeetTheBound) {
  const std::filesystem::path folder =
      std::filesystem::path(golden::shared_folder()) / "data/hostile";
  if (!std::filesystem::is_directory(folder)) {
    GTEST_SKIP() << "NOT TESTED: hostile files; there is no " << folder.string();
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".rig") {  // baked before there was a magic of its own
      open_baked(AlignedBytes(read_bytes(entry.path())), MIEN_BAKED_CHECK_SAFE,
                 MIEN_ERROR_BAKED_SIGNATURE);
    }
    if (entry.path().extension() != ".dna") continue;
    const std::string name = entry.path().filename().string();
    const Bytes file = read_bytes(entry.path());
    expect_within_bound(name, file);
    // What holds for any bytes, such as the bounds of memory, and the same bits from rigs of all kinds.
    LifeOptions options;
    options.twins = true;
    EXPECT_EQ(live(file.data(), file.size(), options).broken, "") << name;
  }
}

}  // namespace
}  // namespace mien
