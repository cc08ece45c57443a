// SPDX-License-Identifier: MIT
// What deformation promises beyond being right: neutral and rigid motion are exact, weights and
// targets count as they are said to, threads and batches change nothing.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "tests/support/deform_rig.h"
#include "tests/support/tiny_rig.h"

namespace mien {
namespace {

using namespace dna;

/// The tiny rig, changed.
template <class Change>
std::vector<uint8_t> changed_rig(Change&& change) {
  Arena arena(default_allocator());
  DnaView view = tiny_rig(arena);
  change(arena, view);
  return write_view(view);
}

DeformValues no_values(const MienRig* rig) {
  DeformValues values = random_values(rig, 0);
  std::fill(values.joints.begin(), values.joints.end(), 0.0f);
  std::fill(values.channels.begin(), values.channels.end(), 0.0f);
  return values;
}

/// The identity of joint j with Euler outputs; `euler` are degrees.
void turn(DeformValues& values, uint32_t joint, float x, float y, float z) {
  values.joints[joint * 9 + 3] = x;
  values.joints[joint * 9 + 4] = y;
  values.joints[joint * 9 + 5] = z;
}

// Neutral -----------------------------------------------------------------------------------------

TEST(Deform, NeutralIsTheStoredMesh) {
  for (double height : {0.0, 150.0}) {
    DeformRigOptions options;
    options.height = height;
    options.rows = options.columns = 25;  // of the size of a head
    for (uint32_t compose : {MIEN_COMPOSE_PRODUCT, MIEN_COMPOSE_EULER_ADD}) {
      MienDeformerDesc desc = {};
      desc.compose = compose;
      Deformed d(random_deform_rig(5, options), desc);
      const MienMesh mesh = mesh_of(d.deformer.get(), 0);
      const Span<const float> stored = {mesh.positions.data, mesh.positions.count};
      const Span<const float> normals = {mesh.normals.data, mesh.normals.count};
      const double diagonal = PlainDeformer{d.dna->view}.diagonal(0);

      // As created, without any call.
      EXPECT_TRUE(same_bits(d.positions(0), stored));
      EXPECT_TRUE(same_bits(d.normals(0), normals));

      d.update(random_values(d.rig.get(), 1));
      d.deform(0);
      EXPECT_GT(largest_difference(d.positions(0), stored), 0.1);
      d.update(no_values(d.rig.get()));
      d.deform(0, MIEN_NORMALS_SKINNED);
      EXPECT_LE(largest_difference(d.positions(0), stored), 1e-6 * diagonal);
      EXPECT_LE(largest_difference(d.normals(0), normals), 1e-6);

      EXPECT_EQ(mien_deformer_instance_update_from_values(d.instance.get(), nullptr, 0, nullptr, 0),
                MIEN_OK);
      d.deform(0, MIEN_NORMALS_SKINNED);
      EXPECT_LE(largest_difference(d.positions(0), stored), 1e-6 * diagonal);
    }
  }
}

TEST(Deform, NeutralSkinMatricesAreTheIdentity) {
  DeformRigOptions options;
  options.height = 150;
  Deformed d(random_deform_rig(5, options));
  d.update(no_values(d.rig.get()));
  for (size_t i = 0; i < d.skins().count; ++i) EXPECT_EQ(d.skins()[i], i % 16 % 5 == 0 ? 1 : 0);
}

// Motion ------------------------------------------------------------------------------------------

TEST(Deform, RigidMotionKeepsAllDistances) {
  DeformRigOptions options;
  options.one_root = true;
  options.least_influences = 1;
  Deformed d(random_deform_rig(8, options));
  MienIndex16View parents = {};
  ASSERT_EQ(mien_rig_joint_parents(d.rig.get(), &parents), MIEN_OK);
  uint32_t root = 0;
  while (parents.data[root] != root) ++root;
  DeformValues values = no_values(d.rig.get());
  turn(values, root, 35, -80, 110);
  values.joints[root * 9 + 1] = 3;
  d.update(values);
  d.deform(0);
  const MienMesh mesh = mesh_of(d.deformer.get(), 0);
  const Span<const float> was = {mesh.positions.data, mesh.positions.count};
  const Span<const float> now = d.positions(0);
  const auto distance = [](const Span<const float>& p, size_t a, size_t b) {
    double sum = 0;
    for (size_t k = 0; k < 3; ++k) sum += std::pow(double(p[a * 3 + k]) - p[b * 3 + k], 2);
    return std::sqrt(sum);
  };
  for (size_t a = 0; a < mesh.position_count; ++a) {
    for (size_t b = 0; b < a; ++b) {
      EXPECT_NEAR(distance(was, a, b), distance(now, a, b),
                  1e-5 * PlainDeformer{d.dna->view}.diagonal(0));
    }
  }
  // All joints move as the root does, to the bit.
  for (size_t i = 0; i < d.skins().count; ++i)
    EXPECT_EQ(d.skins()[i], d.skins()[root * 16 + i % 16]);
}

TEST(Deform, JointsOutsideALodFollowTheirParent) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_SMALL, 3);
  const RigHandle rig = create_rig(dna.get());
  const DeformerHandle deformer = create_deformer(dna.get(), rig.get());
  const DeformerInstanceHandle instance = create_deformer_instance(deformer.get());
  Character character(rig);
  for (float& control : character.raw) control = 0.7f;
  const uint32_t last = info_of(rig).lod_count - 1;
  character.evaluate(last);
  ASSERT_EQ(mien_deformer_instance_update(instance.get(), character.instance.get()), MIEN_OK);
  MienIndex16View listed = {}, parents = {};
  MienFloatView skins = {};
  ASSERT_EQ(mien_rig_lod_indices(rig.get(), MIEN_KIND_JOINT, last, &listed), MIEN_OK);
  ASSERT_EQ(mien_rig_joint_parents(rig.get(), &parents), MIEN_OK);
  ASSERT_EQ(mien_deformer_instance_skin_matrices(instance.get(), &skins), MIEN_OK);
  std::vector<bool> exists(parents.count);
  for (size_t i = 0; i < listed.count; ++i) exists[listed.data[i]] = true;
  size_t followers = 0, movers = 0;
  for (size_t j = 0; j < parents.count; ++j) {
    const bool same = memcmp(skins.data + j * 16, skins.data + parents.data[j] * 16, 64) == 0;
    if (!exists[j]) {
      EXPECT_TRUE(same) << "joint " << j;
      ++followers;
    }
    movers += !same;
  }
  EXPECT_GT(followers, 0u);
  EXPECT_GT(movers, 0u);
}

TEST(Deform, TakesWhatTheInstanceEvaluated) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_SMALL, 3);
  const RigHandle rig = create_rig(dna.get());
  const DeformerHandle deformer = create_deformer(dna.get(), rig.get());
  const DeformerInstanceHandle a = create_deformer_instance(deformer.get()),
                               b = create_deformer_instance(deformer.get());
  Character character(rig);
  for (float& control : character.raw) control = 0.4f;
  character.evaluate(0);
  ASSERT_EQ(mien_deformer_instance_update(a.get(), character.instance.get()), MIEN_OK);
  ASSERT_EQ(mien_deformer_instance_update_from_values(
                b.get(), character.joints.data, character.joints.count, character.channels.data,
                character.channels.count),
            MIEN_OK);
  for (MienDeformerInstance* instance : {a.get(), b.get()}) {
    ASSERT_EQ(mien_deformer_instance_deform(instance, 0, MIEN_NORMALS_DEFAULT, nullptr), MIEN_OK);
  }
  EXPECT_TRUE(same_bits(Deformed::positions(a.get(), 0), Deformed::positions(b.get(), 0)));
  const PlainDeformer plain = {dna->view};
  DeformValues values;
  values.joints.assign(character.joints.begin(), character.joints.end());
  values.channels.assign(character.channels.begin(), character.channels.end());
  EXPECT_LE(largest_error(Deformed::positions(a.get(), 0), plain.positions(0, values)),
            1e-5 * plain.diagonal(0));
}

TEST(Deform, AFrameDoesNotDependOnTheOneBefore) {
  Deformed d(random_deform_rig(9, {}));
  const DeformValues first = random_values(d.rig.get(), 1), second = random_values(d.rig.get(), 2);
  d.update(first);
  d.deform(0);
  const std::vector<float> expected = d.results(0);
  d.update(second);
  d.deform(0, MIEN_NORMALS_SKINNED);
  d.deform(1);
  EXPECT_FALSE(same_bits(span_of(d.results(0)), span_of(expected)));
  d.update(first);
  d.deform(0);
  EXPECT_TRUE(same_bits(span_of(d.results(0)), span_of(expected)));
}

// Targets -----------------------------------------------------------------------------------------

TEST(Deform, ChannelsNearZeroCountAsZero) {
  Deformed d(random_deform_rig(4, {}));
  const DeformValues still = no_values(d.rig.get());
  d.update(still);
  d.deform(0);
  const std::vector<float> neutral = d.results(0);
  for (float weight : {0.9e-5f, -0.9e-5f}) {
    DeformValues values = still;
    std::fill(values.channels.begin(), values.channels.end(), weight);
    d.update(values);
    d.deform(0);
    EXPECT_TRUE(same_bits(span_of(d.results(0)), span_of(neutral)));
    std::fill(values.channels.begin(), values.channels.end(), weight * 1.2f);
    d.update(values);
    d.deform(0);
    EXPECT_FALSE(same_bits(span_of(d.results(0)), span_of(neutral)));
  }
}

TEST(Deform, TargetsOfOneChannelAddUp) {
  const std::vector<uint8_t> file = changed_rig([](Arena& arena, DnaView& view) {
    Mesh& mesh = view.geom.meshes[0];
    BlendShapeTarget twice = mesh.blend_shape_targets[0];
    // One position three times.
    twice.vertex_indices = be<uint32_t>(arena, {4, 4, 4});
    twice.deltas = {be<float>(arena, {1, 2, 4}), be<float>(arena, {0, 0, 0}),
                    be<float>(arena, {0, 0, 0})};
    mesh.blend_shape_targets =
        list<BlendShapeTarget>(arena, {mesh.blend_shape_targets[0], twice, twice});
  });
  for (const uint32_t storage : {MIEN_STORAGE_32_BIT, MIEN_STORAGE_16_BIT}) {
    MienDeformerDesc desc = {};
    desc.storage = storage;
    Deformed d(file, desc);
    DeformValues values = no_values(d.rig.get());
    values.channels[0] = 0.5f;
    d.update(values);
    d.deform(0);
    EXPECT_FLOAT_EQ(d.positions(0)[4 * 3], 7);  // two targets, half of 1 + 2 + 4 each
    EXPECT_NEAR(d.positions(0)[1 * 3 + 1], -0.25f, storage == MIEN_STORAGE_32_BIT ? 0 : 1e-4);
  }
}

// Weights -----------------------------------------------------------------------------------------

TEST(Deform, AnyNumberOfInfluences) {
  DeformRigOptions options;
  options.joints = 60;
  options.least_influences = options.max_influences = 40;
  Deformed d(random_deform_rig(2, options));
  EXPECT_GE(mesh_of(d.deformer.get(), 0).max_influences, 40u);
  const PlainDeformer plain = {d.dna->view};
  const DeformValues values = random_values(d.rig.get(), 6);
  d.update(values);
  d.deform(0);
  EXPECT_LE(largest_error(d.positions(0), plain.positions(0, values)), 1e-5 * plain.diagonal(0));
}

TEST(Deform, PositionsWithoutInfluencesStayWhereTargetsPutThem) {
  for (bool listed : {false, true}) {
    const std::vector<uint8_t> file = changed_rig([&](Arena& arena, DnaView& view) {
      auto& skin = view.geom.meshes[0].skin_weights;
      if (!listed) {
        skin = {};
        return;
      }
      for (auto& weights : skin) weights = {be<float>(arena, {0, 0}), be<uint16_t>(arena, {0, 1})};
    });
    Deformed d(file);
    EXPECT_EQ(mesh_of(d.deformer.get(), 0).max_influences, 0u);
    DeformValues values = no_values(d.rig.get());
    turn(values, 0, 40, 0, 0);
    values.channels[0] = 1;
    d.update(values);
    d.deform(0, MIEN_NORMALS_SKINNED);
    const MienMesh mesh = mesh_of(d.deformer.get(), 0);
    for (size_t i = 0; i < mesh.positions.count; ++i) {
      const float moved = i == 4 ? -0.5f : i == 7 ? -0.25f : i == 8 ? 0.125f : 0;
      EXPECT_EQ(d.positions(0)[i], mesh.positions.data[i] + moved) << i;
    }
    EXPECT_TRUE(same_bits(d.normals(0), {mesh.normals.data, mesh.normals.count}));
  }
}

TEST(Deform, WeightsAreAsStoredOrFixed) {
  const std::vector<uint8_t> file = changed_rig([](Arena& arena, DnaView& view) {
    auto& skin = view.geom.meshes[0].skin_weights;
    skin[0] = {be<float>(arena, {0.5f, 0.25f}), be<uint16_t>(arena, {0, 1})};
    skin[1] = {be<float>(arena, {1.5f, -0.5f}), be<uint16_t>(arena, {0, 1})};
    skin[2] = {be<float>(arena, {-1}), be<uint16_t>(arena, {0})};
    skin[3] = {be<float>(arena, {1e-9f}), be<uint16_t>(arena, {1})};
    skin[4] = {be<float>(arena, {0.5f, 0.5f, 1}), be<uint16_t>(arena, {1, 1, 0})};
  });
  for (uint32_t weights : {MIEN_WEIGHTS_AS_STORED, MIEN_WEIGHTS_FIX}) {
    MienDeformerDesc desc = {};
    desc.weights = weights;
    Deformed d(file, desc);
    PlainDeformer plain = {d.dna->view};
    plain.fix_weights = weights == MIEN_WEIGHTS_FIX;
    MienIndex16View joints = {};
    MienFloatView values = {};
    ASSERT_EQ(mien_deformer_influences(d.deformer.get(), 0, 0, &joints, &values), MIEN_OK);
    ASSERT_EQ(values.count, 2u);
    EXPECT_FLOAT_EQ(values.data[0], plain.fix_weights ? 2.0f / 3 : 0.5f);
    ASSERT_EQ(mien_deformer_influences(d.deformer.get(), 0, 1, &joints, &values), MIEN_OK);
    EXPECT_EQ(values.count, plain.fix_weights ? 1u : 2u);
    EXPECT_EQ(values.data[0], plain.fix_weights ? 1.0f : 1.5f);
    for (uint32_t p : {2u, 3u}) {
      ASSERT_EQ(mien_deformer_influences(d.deformer.get(), 0, p, &joints, &values), MIEN_OK);
      EXPECT_EQ(values.count, plain.fix_weights ? 0u : 1u) << p;
    }
    if (plain.fix_weights) continue;  // the model divides by sums of any size
    const DeformValues moved = random_values(d.rig.get(), 3);
    d.update(moved);
    d.deform(0);
    EXPECT_LE(largest_error(d.positions(0), plain.positions(0, moved)), 1e-6 * 150);
  }
}

// 16-bit storage ----------------------------------------------------------------------------------

TEST(Deform, SixteenBitsMovePositionsLittle) {
  for (const double height : {0.0, 150.0}) {  // the sums of weights must stay
    DeformRigOptions options;
    options.height = height;
    options.rows = options.columns = 40;  // several blocks
    const std::vector<uint8_t> file = random_deform_rig(6, options);
    MienDeformerDesc half = {};
    half.storage = MIEN_STORAGE_16_BIT;
    half.weights = MIEN_WEIGHTS_FIX;
    MienDeformerDesc exact = half;
    exact.storage = MIEN_STORAGE_32_BIT;
    Deformed d(file, half), as_floats(file, exact);
    auto info = sized<MienDeformerInfo>(), other = info;
    ASSERT_EQ(mien_deformer_info(d.deformer.get(), &info), MIEN_OK);
    ASSERT_EQ(mien_deformer_info(as_floats.deformer.get(), &other), MIEN_OK);
    EXPECT_EQ(info.storage, uint32_t{MIEN_STORAGE_16_BIT});
    EXPECT_EQ(other.storage, uint32_t{MIEN_STORAGE_32_BIT});
    EXPECT_LT(info.deformer_bytes, other.deformer_bytes * 9 / 10);
    const double diagonal = PlainDeformer{d.dna->view}.diagonal(0);
    for (const uint32_t seed : {1u, 2u, 3u}) {
      const DeformValues values = random_values(d.rig.get(), seed);
      for (Deformed* each : {&d, &as_floats}) {
        each->update(values);
        each->deform(0, MIEN_NORMALS_SKINNED);
      }
      const double off = largest_difference(d.positions(0), as_floats.positions(0));
      EXPECT_GT(off, 0);
      EXPECT_LT(off, 1e-3 * diagonal);
      EXPECT_LT(largest_difference(d.normals(0), as_floats.normals(0)), 1e-2);
    }
  }
}

/// By how much a number of a target may be off: half of a 16-bit step, or, if it is packed, 2^-18 of the size of the mesh.
double largest_rounding(const MienMesh& mesh, double largest_delta) {
  double size = 0;
  for (size_t k = 0; k < 3; ++k) {
    double least = INFINITY, most = -INFINITY;
    for (size_t i = k; i < size_t{mesh.position_count} * 3; i += 3) {
      least = std::min(least, double{mesh.positions.data[i]});
      most = std::max(most, double{mesh.positions.data[i]});
    }
    size = std::max(size, most - least);
  }
  return std::max(0.5 * largest_delta / 32767, size * 0x1p-18) * 1.01;
}

TEST(Deform, SixteenBitsOfATargetAreWithinHalfAStep) {
  MienDeformerDesc half = {};
  half.storage = MIEN_STORAGE_16_BIT;
  const std::vector<uint8_t> file = random_deform_rig(7, {});
  Deformed d(file, half), as_floats(file);
  const MienMesh mesh = mesh_of(d.deformer.get(), 0);
  std::vector<float> rounded(mesh.position_count * size_t{3}), exact = rounded;
  ASSERT_GT(mesh.target_count, 0u);
  for (uint32_t t = 0; t < mesh.target_count; ++t) {
    ASSERT_EQ(mien_deformer_target(d.deformer.get(), 0, t, rounded.data(), rounded.size()),
              MIEN_OK);
    ASSERT_EQ(mien_deformer_target(as_floats.deformer.get(), 0, t, exact.data(), exact.size()),
              MIEN_OK);
    EXPECT_LE(largest_difference(span_of(rounded), span_of(exact)), largest_rounding(mesh, 2));
  }
  EXPECT_NE(rounded, exact);
  MienIndex16View joints = {};
  MienFloatView weights = {};
  EXPECT_EQ(mien_deformer_influences(d.deformer.get(), 0, 0, &joints, &weights),
            MIEN_ERROR_UNSUPPORTED);
  EXPECT_EQ(joints.count + weights.count, 0u);
}

// Targets of small numbers take 10 bits for each, others 16; a mesh may have both.
TEST(Deform, SmallDeltasArePacked) {
  MienDeformerDesc half = {};
  half.storage = MIEN_STORAGE_16_BIT;
  const std::vector<uint8_t> file = changed_rig([](Arena& arena, DnaView& view) {
    Mesh& mesh = view.geom.meshes[0];
    mesh.blend_shape_targets[0].deltas.zs = be<float>(arena, {0.5f, -0.25f});
    dna::BlendShapeTarget small = mesh.blend_shape_targets[0];
    small.deltas.xs = be<float>(arena, {0, 1e-4f});
    small.deltas.ys = be<float>(arena, {2e-4f, 0});
    small.deltas.zs = be<float>(arena, {-3e-4f, 1e-5f});
    mesh.blend_shape_targets = dna::list<dna::BlendShapeTarget>(
        arena, {mesh.blend_shape_targets[0], small, mesh.blend_shape_targets[0], small});
  });
  Deformed d(file, half), as_floats(file);
  const DeformMesh& arrays = capi::object(d.deformer.get())->meshes[0];
  ASSERT_EQ(arrays.fixed_runs.count, 4u);
  for (uint32_t r = 0; r < 4; ++r) EXPECT_EQ(arrays.fixed_runs[r].is_packed(), r % 2 == 1) << r;
  EXPECT_EQ(arrays.fixed_deltas.count, (1 + 6u + 1 + 4u) * 2 + kDeltaPadding);
  const MienMesh mesh = mesh_of(d.deformer.get(), 0);
  std::vector<float> rounded(mesh.position_count * size_t{3}), exact = rounded;
  for (uint32_t t = 0; t < 4; ++t) {
    ASSERT_EQ(mien_deformer_target(d.deformer.get(), 0, t, rounded.data(), rounded.size()),
              MIEN_OK);
    ASSERT_EQ(mien_deformer_target(as_floats.deformer.get(), 0, t, exact.data(), exact.size()),
              MIEN_OK);
    const double largest = t % 2 == 1 ? 3e-4 : 1;
    EXPECT_LE(largest_difference(span_of(rounded), span_of(exact)), 0.5 * largest / 511 * 1.01);
    EXPECT_LE(largest_difference(span_of(rounded), span_of(exact)), largest_rounding(mesh, 1));
  }
  DeformValues values = random_values(d.rig.get(), 3);
  std::fill(values.joints.begin(), values.joints.end(), 0.0f);
  for (Deformed* each : {&d, &as_floats}) {
    each->update(values);
    each->deform(0);
  }
  const double off = largest_difference(d.positions(0), as_floats.positions(0));
  EXPECT_GT(off, 0);
  EXPECT_LE(off, 1e-4);
}

TEST(Deform, SixteenBitsTakeAnyWeightsAndDeltas) {
  const std::vector<uint8_t> file = changed_rig([](Arena& arena, DnaView& view) {
    Mesh& mesh = view.geom.meshes[0];
    mesh.skin_weights[0] = {be<float>(arena, {1.5f, -0.5f}), be<uint16_t>(arena, {0, 1})};
    mesh.skin_weights[1] = {be<float>(arena, {1e-45f}), be<uint16_t>(arena, {1})};
    mesh.skin_weights[2] = {be<float>(arena, {3e38f, -3e38f}), be<uint16_t>(arena, {0, 1})};
    mesh.blend_shape_targets[0].deltas.zs = be<float>(arena, {1e-45f, 3e38f});
  });
  MienDeformerDesc half = {};
  half.storage = MIEN_STORAGE_16_BIT;
  Deformed d(file, half);
  d.update(random_values(d.rig.get(), 3));
  d.deform(0);
  const MienMesh mesh = mesh_of(d.deformer.get(), 0);
  std::vector<float> target(mesh.position_count * size_t{3});
  ASSERT_EQ(mien_deformer_target(d.deformer.get(), 0, 0, target.data(), target.size()), MIEN_OK);
  EXPECT_NEAR(*std::max_element(target.begin(), target.end()) / 3e38f, 1, 1e-4);
}

TEST(Deform, ManyInfluencesKeepTheirWeights) {
  DeformRigOptions options;
  options.joints = 90;
  options.least_influences = options.max_influences = 70;
  MienDeformerDesc half = {};
  half.storage = MIEN_STORAGE_16_BIT;
  Deformed d(random_deform_rig(4, options), half);
  MienIndex16View joints = {};
  MienFloatView weights = {};
  EXPECT_EQ(mien_deformer_influences(d.deformer.get(), 0, 0, &joints, &weights), MIEN_OK);
  const DeformValues values = random_values(d.rig.get(), 1);
  d.update(values);
  d.deform(0);
  const PlainDeformer plain{d.dna->view};
  EXPECT_LE(largest_error(d.positions(0), plain.positions(0, values)), 1e-3 * plain.diagonal(0));
}

// Normals -----------------------------------------------------------------------------------------

TEST(Deform, NormalsOfTheDescAreTheDefault) {
  DeformRigOptions options;
  for (uint32_t wanted : {MIEN_NORMALS_NONE, MIEN_NORMALS_SKINNED, MIEN_NORMALS_RECOMPUTED}) {
    MienDeformerDesc desc = {};
    desc.normals = wanted;
    Deformed d(random_deform_rig(1, options), desc);
    d.update(random_values(d.rig.get(), 1));
    d.deform(0);
    const std::vector<float> by_default = d.results(0);
    d.deform(0, MIEN_NORMALS_SKINNED);
    d.deform(0, MIEN_NORMALS_NONE);  // leaves them
    const bool was_skinned = same_bits(span_of(d.results(0)), span_of(by_default));
    EXPECT_EQ(was_skinned, wanted == MIEN_NORMALS_SKINNED);
    d.deform(0, MIEN_NORMALS_RECOMPUTED);
    EXPECT_EQ(same_bits(span_of(d.results(0)), span_of(by_default)),
              wanted == MIEN_NORMALS_RECOMPUTED);
  }
}

TEST(Deform, UniformScaleNeedsNoCofactors) {
  // The two ways to skin normals agree where both are right.
  Deformed d(random_deform_rig(1, {}));
  const PlainDeformer plain = {d.dna->view};
  for (double skew : {0.0, 1e-5, 0.05}) {
    const DeformValues values = random_values(d.rig.get(), 4, skew);
    DeformValues rigid = values;
    // Blends of turns are not turns, so only positions of one influence compare exactly.
    d.update(rigid);
    d.deform(0, MIEN_NORMALS_SKINNED);
    const std::vector<Vec3d> expected = plain.skinned_normals(0, values);
    const MienMesh mesh = mesh_of(d.deformer.get(), 0);
    size_t compared = 0;
    for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
      MienIndex16View joints = {};
      MienFloatView weights = {};
      EXPECT_EQ(mien_deformer_influences(d.deformer.get(), 0, mesh.vertex_position_indices.data[v],
                                         &joints, &weights),
                MIEN_OK);
      if (joints.count != 1) continue;
      ++compared;
      for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(d.normals(0)[v * 3 + k], expected[v][k], 1e-4);
    }
    EXPECT_GT(compared, 5u);
  }
}

TEST(Deform, HardEdgesKeepTheirAngle) {
  // A flat sheet whose normals lie 45 degrees off, turned as a whole and bent in no way.
  const std::vector<uint8_t> file = changed_rig([](Arena& arena, DnaView& view) {
    Mesh& mesh = view.geom.meshes[0];
    mesh.normals = {be<float>(arena, {1, 0, 0, 0, 0, 0}), be<float>(arena, {0, 0, 0.3f, 0, 0, 0}),
                    be<float>(arena, {1, 1, 1, 1, 1, 1})};
    for (auto& skin : mesh.skin_weights) skin = {be<float>(arena, {1}), be<uint16_t>(arena, {0})};
  });
  Deformed d(file);
  DeformValues values = no_values(d.rig.get());
  d.update(values);
  d.deform(0);
  const float half = std::sqrt(0.5f);
  const auto expect_normal = [&](uint32_t v, float x, float y, float z) {
    EXPECT_NEAR(d.normals(0)[v * 3], x, 1e-6);
    EXPECT_NEAR(d.normals(0)[v * 3 + 1], y, 1e-6);
    EXPECT_NEAR(d.normals(0)[v * 3 + 2], z, 1e-6);
  };
  expect_normal(0, half, 0, half);  // hard: as stored
  expect_normal(2, 0, 0, 1);        // 17 degrees off: recomputed
  turn(values, 0, 90, 0, 0);        // z to -y
  d.update(values);
  d.deform(0);
  expect_normal(0, half, -half, 0);
  expect_normal(2, 0, -1, 0);
  turn(values, 0, 180, 0, 0);  // there is no shortest way: any that keeps the angle
  d.update(values);
  d.deform(0);
  EXPECT_NEAR(d.normals(0)[2], -half, 1e-3);
}

TEST(Deform, WithoutADirectionNormalsAreNeutral) {
  const std::vector<uint8_t> file = changed_rig([](Arena& arena, DnaView& view) {
    Mesh& mesh = view.geom.meshes[0];
    mesh.faces = list<Face>(arena, {{be<uint32_t>(arena, {0, 1, 4, 3})}});  // 2 and 5 have none
    for (auto& skin : mesh.skin_weights) skin = {be<float>(arena, {1}), be<uint16_t>(arena, {0})};
  });
  Deformed d(file);
  DeformValues values = no_values(d.rig.get());
  turn(values, 0, 0, 90, 0);
  d.update(values);
  d.deform(0);
  EXPECT_NEAR(d.normals(0)[0], 1, 1e-6);
  EXPECT_EQ(d.normals(0)[2 * 3 + 2], 1);
  for (uint32_t k = 0; k < 3; ++k) values.joints[6 + k] = -1;  // everything in one point
  d.update(values);
  for (uint32_t normals : {MIEN_NORMALS_SKINNED, MIEN_NORMALS_RECOMPUTED}) {
    d.deform(0, normals);
    for (uint32_t v = 0; v < 6; ++v) {
      EXPECT_EQ(d.normals(0)[v * 3 + 2], 1) << "vertex " << v << " normals " << normals;
    }
  }
}

TEST(Deform, NormalsThatTheFileLacksAreRecomputed) {
  for (bool clockwise : {false, true}) {
    for (bool left_handed : {false, true}) {
      const std::vector<uint8_t> file = changed_rig([&](Arena&, DnaView& view) {
        Mesh& mesh = view.geom.meshes[0];
        mesh.normals = {};
        view.dsce.face_winding_order = clockwise;
        if (left_handed) view.desc.coordinate_system.x_axis = 0;  // left instead of right
      });
      Deformed d(file);
      const float expected = clockwise != left_handed ? -1 : 1;
      for (uint32_t v = 0; v < 6; ++v) EXPECT_EQ(d.normals(0)[v * 3 + 2], expected);
      d.update(no_values(d.rig.get()));
      d.deform(0);
      for (uint32_t v = 0; v < 6; ++v) EXPECT_EQ(d.normals(0)[v * 3 + 2], expected);
    }
  }
}

// Threads and batches -----------------------------------------------------------------------------

struct Threads {
  MienParallelFor interface = {this, run};
  std::atomic<uint32_t> calls{0}, tasks{0};

  static void run(void* user, uint32_t count, void (*task)(void*, uint32_t), void* context) {
    Threads& self = *static_cast<Threads*>(user);
    ++self.calls;
    self.tasks += count;
    std::atomic<uint32_t> next{0};
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t) {
      threads.emplace_back([&] {
        for (uint32_t i = next++; i < count; i = next++) task(context, count - 1 - i);
      });
    }
    for (std::thread& thread : threads) thread.join();
  }
};

DeformRigOptions large_mesh() {
  DeformRigOptions options;
  options.rows = 130;
  options.columns = 131;
  options.meshes = 1;
  return options;
}

TEST(Deform, ThreadsGiveTheSameBits) {
  const std::vector<uint8_t> file = random_deform_rig(2, large_mesh());
  Deformed d(file);
  const DeformerInstanceHandle other = create_deformer_instance(d.deformer.get());
  const DeformValues values = random_values(d.rig.get(), 2);
  d.update(values);
  Deformed::update(other.get(), values);
  for (uint32_t normals : {MIEN_NORMALS_NONE, MIEN_NORMALS_SKINNED, MIEN_NORMALS_RECOMPUTED}) {
    Threads threads;
    d.deform(0, normals);
    ASSERT_EQ(mien_deformer_instance_deform(other.get(), 0, normals, &threads.interface), MIEN_OK);
    EXPECT_TRUE(same_bits(d.positions(0), Deformed::positions(other.get(), 0)));
    EXPECT_TRUE(same_bits(d.normals(0), Deformed::normals(other.get(), 0)));
    EXPECT_EQ(threads.calls, normals == MIEN_NORMALS_RECOMPUTED ? 3u : 1u);
    EXPECT_GE(threads.tasks, 17u * threads.calls);  // of 1024
  }
}

TEST(Deform, SmallMeshesStayOnTheThread) {
  Deformed d(random_deform_rig(2, {}));
  Threads threads;
  ASSERT_EQ(
      mien_deformer_instance_deform(d.instance.get(), 0, MIEN_NORMALS_DEFAULT, &threads.interface),
      MIEN_OK);
  EXPECT_EQ(threads.calls, 0u);
}

TEST(Deform, ABatchGivesTheSameBits) {
  DeformRigOptions options;
  options.rows = 60;
  options.columns = 40;
  const std::vector<uint8_t> file = random_deform_rig(6, options);
  Deformed d(file);
  std::vector<DeformerInstanceHandle> alone, together;
  std::vector<MienDeformerInstance*> batch;
  for (uint32_t i = 0; i < 11; ++i) {
    const DeformValues values = random_values(d.rig.get(), i, i % 2 ? 0.1 : 0);
    alone.push_back(create_deformer_instance(d.deformer.get()));
    together.push_back(create_deformer_instance(d.deformer.get()));
    Deformed::update(alone.back().get(), values);
    Deformed::update(together.back().get(), values);
    batch.push_back(together.back().get());
  }
  for (uint32_t normals : {MIEN_NORMALS_SKINNED, MIEN_NORMALS_RECOMPUTED}) {
    for (bool with_threads : {false, true}) {
      Threads threads;
      for (DeformerInstanceHandle& instance : alone) {
        ASSERT_EQ(mien_deformer_instance_deform(instance.get(), 1, normals, nullptr), MIEN_OK);
      }
      ASSERT_EQ(mien_deformer_instance_deform_batch(batch.data(), batch.size(), 1, normals,
                                                    with_threads ? &threads.interface : nullptr),
                MIEN_OK);
      for (size_t i = 0; i < batch.size(); ++i) {
        EXPECT_TRUE(
            same_bits(Deformed::positions(alone[i].get(), 1), Deformed::positions(batch[i], 1)));
        EXPECT_TRUE(
            same_bits(Deformed::normals(alone[i].get(), 1), Deformed::normals(batch[i], 1)));
      }
      // Small as one mesh is, all together are worth it.
      EXPECT_EQ(threads.calls > 0, with_threads);
      for (DeformerInstanceHandle& instance : together) {
        ASSERT_EQ(mien_deformer_instance_deform(instance.get(), 1, MIEN_NORMALS_NONE, nullptr),
                  MIEN_OK);
      }
    }
  }
}

}  // namespace
}  // namespace mien
