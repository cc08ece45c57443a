// SPDX-License-Identifier: MIT
// Derivatives against those of the model with dual numbers, which are exact: there are no steps. Each stage starts from
// the library's own values, so that it answers for itself; chains start from raw controls.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <string>

#include "integrations/program/model/ml_model.h"
#include "integrations/program/model/rbf_model.h"
#include "integrations/program/model/rotation_model.h"
#include "tests/derive/derivatives_handle.h"
#include "tests/derive/random_skeleton.h"
#include "tests/support/deform_rig.h"
#include "tests/support/random_layer_rig.h"
#include "tests/support/rig_files.h"

namespace mien {
namespace {

using Duals = std::vector<Dual>;

Duals constants(Span<const float> values) { return {values.begin(), values.end()}; }

/// Moved along a direction from its first number on.
Duals along(Duals values, const float* direction, size_t count) {
  for (size_t i = 0; i < count; ++i) values[i].slope = double{direction[i]};
  return values;
}

// Of the largest derivative that a direction has at the point.
struct Bounds {
  static constexpr double kControls = 3e-6, kPoses = 2e-5, kJoints = 1e-5, kMatrices = 3e-6,
                          kChains = 1e-4;
};

constexpr double kSmallest = 1e-12;  // what is left of a pose far away

/// Compares, and keeps what was worst at each stage.
struct Comparison {
  struct Worst {
    double share = 0;  // of what is allowed
    size_t numbers = 0, unsure = 0;
  };
  std::map<std::string, Worst> stages;

  /// Nearly all derivatives are compared to the bound alone.
  void expect_certain() const {
    for (const auto& [stage, worst] : stages) {
      printf("%-24s %9zu numbers, %.3f of the bound, %zu unsure\n", stage.c_str(), worst.numbers,
             worst.share, worst.unsure);
      EXPECT_LE(worst.unsure * 25, worst.numbers) << stage;
    }
    EXPECT_FALSE(stages.empty());
  }

  /// `unsure` is how far rounding may move each derivative besides.
  void see(const std::string& stage, const Duals& made, const Duals& expected, double tolerance,
           const std::vector<double>& unsure = {}) {
    ASSERT_EQ(made.size(), expected.size()) << stage;
    double largest = 0;
    for (const Dual& v : expected) largest = std::fmax(largest, std::fabs(v.slope));
    Worst& worst = stages[stage];
    worst.numbers += made.size();
    for (size_t i = 0; i < made.size(); ++i) {
      const double off = std::fabs(made[i].slope - expected[i].slope);
      double allowed = tolerance * largest + kSmallest;
      if (!unsure.empty()) {
        allowed += unsure[i];
        worst.unsure += unsure[i] > 1e-2 * largest;
      }
      worst.share = std::fmax(worst.share, off / allowed);
      EXPECT_LE(off, allowed) << stage << " " << i << ": " << made[i].slope << ", "
                              << expected[i].slope << " of the model, largest " << largest;
      if (!(off <= allowed)) return;
    }
  }
};

/// A rig that was evaluated and linearized, and its model.
struct Subject {
  const LayerRig& model;
  Character& character;
  const DerivativesHandle& d;
  uint32_t lod = 0;
  bool quaternions = false, blend_masks = false, is_small = false;
  const PlainDeformer* deformer = nullptr;

  Duals controls() const { return constants(character.controls); }
  std::vector<double> masks() const { return {character.masks.begin(), character.masks.end()}; }
  size_t width() const { return quaternions ? 10 : 9; }

  void run_ml(Duals& x) const { model_ml(model, lod, masks(), blend_masks, x); }
  void run_psds(Duals& x) const {
    const Duals before = x;
    model_psds(model.base, x);
    const std::vector<uint8_t> needed = needed_psds(model.base, lod);
    for (size_t p = 0; p < needed.size(); ++p) {
      const size_t i = model.base.raw_count + p;
      if (!needed[p]) x[i] = before[i];
    }
  }
  /// All controls of a new instance.
  Duals evaluated(const Duals& raw, const Rounding& rounding) const {
    Duals x = initial_controls<Dual>(model);
    std::copy(raw.begin(), raw.end(), x.begin());
    run_ml(x);
    if (model.rbf_count != 0) model_rbf(model, lod, x, rounding);
    run_psds(x);
    return x;
  }
};

/// Ten numbers of each joint; angles become quaternions.
Duals flat(const std::vector<JointOf<Dual>>& joints) {
  Duals all;
  for (const JointOf<Dual>& j : joints) {
    all.insert(all.end(), j.translation.begin(), j.translation.end());
    all.insert(all.end(), {j.rotation.x, j.rotation.y, j.rotation.z, j.rotation.w});
    all.insert(all.end(), j.scale.begin(), j.scale.end());
  }
  return all;
}

Duals flat_positions(const std::vector<Vec3Of<Dual>>& positions) {
  Duals numbers;
  for (const Vec3Of<Dual>& p : positions) numbers.insert(numbers.end(), p.begin(), p.end());
  return numbers;
}

/// Joint values of the library, with the signs of the model's quaternions.
Duals flat_outputs(const Subject& s, const float* slopes, const Duals& expected) {
  const Duals values = along(constants(s.character.joints), slopes, s.character.joints.count);
  std::vector<JointOf<Dual>> joints(values.size() / s.width());
  for (size_t j = 0; j < joints.size(); ++j) {
    const Dual* v = values.data() + j * s.width();
    joints[j] = {{v[0], v[1], v[2]}, {v[s.width() - 3], v[s.width() - 2], v[s.width() - 1]}, {}};
    QuaternionOf<Dual>& q = joints[j].rotation;
    if (s.quaternions) {
      q = {v[3], v[4], v[5], v[6]};
    } else {
      q = model_quaternion(convention_of(s.model), std::array<Dual, 3>{v[3], v[4], v[5]});
    }
    const Dual* e = expected.data() + j * 10 + 3;
    if ((q.x * e[0] + q.y * e[1] + q.z * e[2] + q.w * e[3]) < 0) q = {-q.x, -q.y, -q.z, -q.w};
  }
  return flat(joints);
}

Duals slopes_of(const float* row, size_t count) { return along(Duals(count), row, count); }

/// Calls f(direction, product) for each direction.
template <class F>
void for_each_product(const DerivativesHandle& d, uint32_t from, uint32_t to, uint32_t mesh,
                      const std::vector<float>& directions, F&& f) {
  const size_t in = size_of(d, from, mesh), out = size_of(d, to, mesh);
  if (in == 0) return;
  const auto count = static_cast<uint32_t>(directions.size() / in);
  const std::vector<float> products = forward(d, from, to, directions, count, mesh);
  for (uint32_t k = 0; k < count; ++k) f(directions.data() + k * in, products.data() + k * out);
}

/// All axes of a space, or some; a sparse direction and a dense one.
std::vector<float> directions_in(Random& random, size_t size, bool all_axes) {
  const size_t axes = all_axes ? size : std::min<size_t>(size, 3);
  std::vector<float> rows((axes + 2) * size);
  for (size_t k = 0; k < axes; ++k) {
    rows[k * size + (all_axes ? k : random.below(static_cast<uint32_t>(size)))] = 1;
  }
  for (size_t i = 0; i < size; ++i) {
    if (random.chance(0.1)) rows[axes * size + i] = static_cast<float>(random.between(-1, 1));
    rows[(axes + 1) * size + i] = static_cast<float>(random.between(-1, 1));
  }
  return rows;
}

void compare_tables(const Subject& s, Random& random, Comparison& seen) {
  const PlainRig& base = s.model.base;
  for_each_product(
      s.d, MIEN_POINT_GUI, MIEN_POINT_RAW, 0, directions_in(random, base.gui_count, s.is_small),
      [&](const float* direction, const float* product) {
        const Duals gui = along(constants(s.character.gui), direction, base.gui_count);
        const Duals raw =
            forward_plain(base.gui_to_raw, base.gui_to_raw.size(), gui, base.raw_count);
        seen.see("GUI to raw", slopes_of(product, raw.size()), raw, Bounds::kControls);
      });
  const std::vector<float> directions =
      directions_in(random, s.character.controls.count, s.is_small);
  for_each_product(s.d, MIEN_POINT_CONTROLS, MIEN_POINT_MAPS, 0, directions,
                   [&](const float* direction, const float* product) {
                     const Duals x = along(s.controls(), direction, s.character.controls.count);
                     const Duals maps = plain_maps(base, x, s.lod);
                     seen.see("maps", slopes_of(product, maps.size()), maps, Bounds::kControls);
                   });
  for_each_product(s.d, MIEN_POINT_CONTROLS, MIEN_POINT_CHANNELS, 0, directions,
                   [&](const float* direction, const float* product) {
                     const Duals x = along(s.controls(), direction, s.character.controls.count);
                     const Duals channels = plain_channels(base, x, s.lod);
                     seen.see("channels", slopes_of(product, channels.size()), channels,
                              Bounds::kControls);
                   });
}

// How far rounding of distances and weights, which inverses magnify, may move derivatives, to first order or to the other
// side of a clamp: several times what noises of some sizes do, each with signs of its own.
constexpr double kNoises[] = {0x1p-22, -0x1p-22, 0x1p-20, -0x1p-20, 0x1p-18, -0x1p-18};
constexpr double kMargin = 16;

/// `model` gives the derivatives with rounding.
template <class F>
std::vector<double> unsure(const Subject& s, const Duals& expected, F&& model) {
  std::vector<double> all(expected.size());
  for (uint32_t n = 0; s.model.rbf_count != 0 && n < std::size(kNoises); ++n) {
    const Duals with = model(Rounding{kNoises[n], n});
    for (size_t i = 0; i < all.size(); ++i) {
      all[i] = std::fmax(all[i], kMargin * std::fabs(with[i].slope - expected[i].slope));
    }
  }
  return all;
}

/// One stage of the controls after the other; the others are constant.
void compare_control_stages(const Subject& s, Random& random, Comparison& seen) {
  const size_t raw_count = s.model.base.raw_count;
  const std::vector<float> directions = directions_in(random, raw_count, s.is_small);
  const auto compare = [&](uint32_t stage, auto&& f) {
    linearize(s.d, s.character, stage);
    for_each_product(s.d, MIEN_POINT_RAW, MIEN_POINT_CONTROLS, 0, directions, f);
  };
  compare(MIEN_STAGE_ML, [&](const float* direction, const float* product) {
    Duals x = along(s.controls(), direction, raw_count);
    // What ML joints read is converted in place, from the initial values.
    const Duals initial = initial_controls<Dual>(s.model);
    std::copy_n(initial.begin() + s.model.first_ml(), s.model.ml_count,
                x.begin() + s.model.first_ml());
    s.run_ml(x);
    seen.see("networks", slopes_of(product, x.size()), x, Bounds::kControls);
  });
  compare(MIEN_STAGE_RBF, [&](const float* direction, const float* product) {
    if (s.model.rbf_count == 0) return;
    const auto model = [&](const Rounding& rounding) {
      Duals x = along(s.controls(), direction, raw_count);
      model_rbf(s.model, s.lod, x, rounding);
      return x;
    };
    const Duals x = model({});
    seen.see("RBF solvers", slopes_of(product, x.size()), x, Bounds::kPoses, unsure(s, x, model));
  });
  compare(MIEN_STAGE_PSD, [&](const float* direction, const float* product) {
    Duals x = along(s.controls(), direction, raw_count);
    s.run_psds(x);
    seen.see("correctives", slopes_of(product, x.size()), x, Bounds::kControls);
  });
  linearize(s.d, s.character);
}

void compare_joints(const Subject& s, Random& random, Comparison& seen) {
  const size_t count = s.character.controls.count;
  for_each_product(s.d, MIEN_POINT_CONTROLS, MIEN_POINT_JOINTS, 0,
                   directions_in(random, count, s.is_small),
                   [&](const float* direction, const float* product) {
                     const Duals expected = flat(model_joints(
                         s.model, along(s.controls(), direction, count), s.lod, s.quaternions));
                     seen.see(s.quaternions ? "joints, quaternions" : "joints, angles",
                              flat_outputs(s, product, expected), expected, Bounds::kJoints);
                   });
}

/// From raw controls through all stages; to the positions of a mesh where there is one, too.
void compare_chains(const Subject& s, Random& random, Comparison& seen) {
  const size_t raw_count = s.model.base.raw_count;
  const std::vector<float> directions = directions_in(random, raw_count, s.is_small);
  const auto count = static_cast<uint32_t>(directions.size() / raw_count);
  struct Chain {
    const char* name;
    uint32_t to;
    std::function<Duals(const Duals& controls)> model;
    std::vector<float> products;
  };
  const auto joints = [&](const Duals& x) {
    return flat(model_joints(s.model, x, s.lod, s.quaternions));
  };
  const auto channels = [&](const Duals& x) { return plain_channels(s.model.base, x, s.lod); };
  std::vector<Chain> chains = {
      {"raw to controls", MIEN_POINT_CONTROLS, [](const Duals& x) { return x; }, {}},
      {"raw to joints", MIEN_POINT_JOINTS, joints, {}},
      {"raw to channels", MIEN_POINT_CHANNELS, channels, {}},
      {"raw to maps",
       MIEN_POINT_MAPS,
       [&](const Duals& x) { return plain_maps(s.model.base, x, s.lod); },
       {}}};
  if (s.deformer) {
    chains.push_back(
        {"raw to positions",
         MIEN_POINT_POSITIONS,
         [&](const Duals& x) {
           const PlainDeformer& plain = *s.deformer;
           return flat_positions(plain.positions_of(
               0, plain.skins_of(plain.models_of(plain.locals(joints(x)))), channels(x)));
         },
         {}});
  }
  for (Chain& chain : chains) {
    chain.products = forward(s.d, MIEN_POINT_RAW, chain.to, directions, count);
  }
  for (uint32_t k = 0; k < count; ++k) {
    const Duals raw =
        along(constants(s.character.raw), directions.data() + k * raw_count, raw_count);
    std::map<double, Duals> controls;  // by noise
    const auto with = [&](const Rounding& rounding) -> const Duals& {
      const auto [found, is_new] = controls.try_emplace(rounding.noise);
      if (is_new) found->second = s.evaluated(raw, rounding);
      return found->second;
    };
    for (const Chain& chain : chains) {
      const Duals expected = chain.model(with({}));
      const float* const product = chain.products.data() + k * (chain.products.size() / count);
      const Duals made = chain.to == MIEN_POINT_JOINTS ? flat_outputs(s, product, expected)
                                                       : slopes_of(product, expected.size());
      seen.see(chain.name, made, expected, Bounds::kChains,
               unsure(s, expected,
                      [&](const Rounding& rounding) { return chain.model(with(rounding)); }));
    }
  }
}

void compare_behavior(const Subject& s, Random& random, Comparison& seen) {
  compare_tables(s, random, seen);
  compare_control_stages(s, random, seen);
  compare_joints(s, random, seen);
  compare_chains(s, random, seen);
}

/// Solvers of every kind in turn. Numbers as files have them, so that no rounding is magnified: targets of unit length
/// and radii that tell them apart, and joint groups that turn by less than some hundred radians.
void make_sensible(LayerRig& rig, uint32_t first_kind) {
  const bool radians = rig.rotation_unit == 1;
  for (PlainRbfSolver& solver : rig.solvers) {
    const uint32_t kind = first_kind++;
    if (solver.inputs.size() == 4) solver.distance = static_cast<uint16_t>(kind % 4);
    solver.function = static_cast<uint16_t>(kind / 4 % 5);
    solver.type = static_cast<uint16_t>(kind / 20 % 2);
    solver.normalize = static_cast<uint16_t>(kind / 40 % 2);
    if (radians) solver.radius = 1;
    for (size_t i = 0; solver.distance != 0 && i < solver.targets.size(); i += 4) {
      float* q = solver.targets.data() + i;
      const double length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
      for (size_t k = 0; k < 4; ++k) q[k] = static_cast<float>(q[k] / length);
    }
  }
  for (PlainGroup& group : rig.base.groups) {
    for (size_t i = 0; radians && i < group.values.size(); ++i) {
      const uint32_t k = group.outputs[i / group.inputs.size()] % 9;
      if (k >= 3 && k < 6) group.values[i] /= 50;
    }
  }
}

TEST(Duals, OfTheModelAreTheDerivativesOfAllLayers) {
  Random random = Random::from_seed(73, 1);
  Comparison seen;
  for (uint32_t round = 0; round < 28; ++round) {
    LayerRig rig = random_layer_rig(random, false);
    make_sensible(rig, 6 * round);
    // Correctives are computed after poses read them: they would be those of the frame before.
    for (PlainRbfPose& pose : rig.poses) {
      for (uint16_t& input : pose.inputs) input = static_cast<uint16_t>(input % rig.base.raw_count);
    }
    const LayerFile file(rig);
    for (const bool quaternions : {false, true}) {
      MienRigDesc desc = sized<MienRigDesc>();
      desc.isa = present_isas()[round % present_isas().size()];
      desc.rotation_output =
          quaternions ? MIEN_ROTATION_OUTPUT_QUATERNION : MIEN_ROTATION_OUTPUT_EULER;
      desc.ml_masks = round % 3 == 2 ? MIEN_ML_MASKS_BLEND : MIEN_ML_MASKS_SWITCH;
      const RigHandle handle = create_rig(file.dna.get(), desc);
      for (uint32_t lod = 0; lod < rig.base.lod_count; ++lod) {
        SCOPED_TRACE(testing::Message() << "round " << round << ", LOD " << lod);
        Character character(handle);
        const std::vector<float> raw = random_raw(rig, {4, 8}, random);
        std::copy(raw.begin(), raw.end(), character.raw.begin());
        for (size_t i = 0; i < 4; ++i) {  // the ends of the interval, too
          if (random.chance(0.3)) character.raw[i] = static_cast<float>(random.below(2));
        }
        for (float& mask : character.masks) mask = static_cast<float>(random.below(3)) / 2;
        for (float& gui : character.gui) gui = static_cast<float>(random.between(-1, 1));
        character.evaluate(lod);
        const DerivativesHandle d = create_derivatives(handle.get());
        linearize(d, character);
        compare_behavior({rig, character, d, lod, quaternions, round % 3 == 2, true}, random, seen);
        if (testing::Test::HasFailure()) return;
      }
    }
  }
  seen.expect_certain();
}

// Matrices and positions -------------------------------------------------------------------------

template <class Matrix>
Duals flat_matrices(const std::vector<Matrix>& all) {
  Duals numbers;
  for (const Matrix& m : all) {
    for (size_t c = 0; c < 4; ++c) {
      for (size_t r = 0; r < 4; ++r) numbers.push_back(m[r][c]);
    }
  }
  return numbers;
}
std::vector<Matrix4Of<Dual>> matrices(const Duals& numbers) {
  std::vector<Matrix4Of<Dual>> all(numbers.size() / 16);
  for (size_t i = 0; i < numbers.size(); ++i) all[i / 16][i % 4][i / 4 % 4] = numbers[i];
  return all;
}

TEST(Duals, OfTheModelAreTheDerivativesOfMatricesAndPositions) {
  Random random = Random::from_seed(73, 2);
  Comparison seen;
  for (uint32_t round = 0; round < 12; ++round) {
    SCOPED_TRACE(round);
    const RandomSkeleton skeleton(round);
    const DeformValues& values = skeleton.values;
    const DerivativesHandle& d = skeleton.d;
    const PlainDeformer plain = {skeleton.made.dna->view, skeleton.quaternions, skeleton.adds,
                                 false};

    const Duals joints = constants(span_of(values.joints)),
                channels = constants(span_of(values.channels));
    const std::vector<Matrix4Of<Dual>> locals = plain.locals(joints),
                                       models = plain.models_of(locals),
                                       skins = plain.skins_of(models);
    const auto compare = [&](uint32_t from, uint32_t to, const char* name, const Duals& values_of,
                             uint32_t mesh, auto&& model) {
      for_each_product(d, from, to, mesh, directions_in(random, values_of.size(), true),
                       [&](const float* direction, const float* product) {
                         Duals moved = along(values_of, direction, values_of.size());
                         if (from >= MIEN_POINT_LOCALS && from <= MIEN_POINT_SKINS) {
                           // The last row is constant.
                           for (size_t i = 3; i < moved.size(); i += 4) moved[i].slope = 0;
                         }
                         const Duals expected = model(moved);
                         seen.see(name, slopes_of(product, expected.size()), expected,
                                  Bounds::kMatrices);
                       });
    };
    compare(MIEN_POINT_JOINTS, MIEN_POINT_LOCALS, "locals", joints, 0,
            [&](const Duals& v) { return flat_matrices(plain.locals(v)); });
    compare(MIEN_POINT_LOCALS, MIEN_POINT_MODELS, "models", flat_matrices(locals), 0,
            [&](const Duals& v) { return flat_matrices(plain.models_of(matrices(v))); });
    compare(MIEN_POINT_MODELS, MIEN_POINT_SKINS, "skins", flat_matrices(models), 0,
            [&](const Duals& v) { return flat_matrices(plain.skins_of(matrices(v))); });
    for (uint32_t mesh = 0; mesh < 2; ++mesh) {
      compare(MIEN_POINT_SKINS, MIEN_POINT_POSITIONS, "positions by skins", flat_matrices(skins),
              mesh, [&](const Duals& v) {
                return flat_positions(plain.positions_of(mesh, matrices(v), channels));
              });
      compare(MIEN_POINT_CHANNELS, MIEN_POINT_POSITIONS, "positions by channels", channels, mesh,
              [&](const Duals& v) { return flat_positions(plain.positions_of(mesh, skins, v)); });
      compare(MIEN_POINT_JOINTS, MIEN_POINT_POSITIONS, "joints to positions", joints, mesh,
              [&](const Duals& v) {
                return flat_positions(plain.positions_of(
                    mesh, plain.skins_of(plain.models_of(plain.locals(v))), channels));
              });
    }
    if (testing::Test::HasFailure()) return;
  }
  seen.expect_certain();
}

// Files -------------------------------------------------------------------------------------------

/// Rotations in place of the raw controls that are read as such.
void turn_at_random(const LayerRig& rig, Span<float> raw, Random& random) {
  const auto turn = [&](const std::vector<uint16_t>& inputs) {
    for (size_t i = 0; i + 4 <= inputs.size(); i += 4) {
      double q[4], length = 0;
      for (double& part : q) {
        part = random.between(-1, 1);
        length += part * part;
      }
      for (size_t k = 0; k < 4; ++k) {
        const uint16_t control = inputs[i + k];
        if (control < raw.count) raw[control] = static_cast<float>(q[k] / std::sqrt(length));
      }
    }
  };
  for (const PlainTurn& t : rig.twists) turn(t.inputs);
  for (const PlainTurn& t : rig.swings) turn(t.inputs);
  for (const PlainRbfSolver& solver : rig.solvers) {
    if (solver.distance != 0) turn(solver.inputs);
  }
}

TEST(Duals, OfTheModelAreTheDerivativesOfFiles) {
  Random random = Random::from_seed(73, 3);
  Comparison seen;
  for (const NamedRig& file : rigs_of_every_origin()) {
    for (const bool quaternions : {false, true}) {
      const RigHandle rig =
          create_rig(file.dna.get(), MIEN_ISA_ENVIRONMENT, MIEN_OK,
                     quaternions ? MIEN_ROTATION_OUTPUT_QUATERNION : MIEN_ROTATION_OUTPUT_EULER);
      const DeformerHandle deformer = create_deformer(file.dna.get(), rig.get());
      const LayerRig model = read_layer_rig(file.dna->view, rig);
      for (const uint32_t lod : {0u, model.base.lod_count - 1u}) {
        SCOPED_TRACE(testing::Message() << file.name << ", LOD " << lod << ", "
                                        << (quaternions ? "quaternions" : "angles"));
        Character character(rig);
        for (float& v : character.raw) {
          v = random.chance(0.5) ? static_cast<float>(random.between(0, 1)) : 0.0f;
        }
        turn_at_random(model, character.raw, random);
        for (float& v : character.gui) v = static_cast<float>(random.between(-1, 1));
        character.evaluate(lod);
        const DerivativesHandle d = create_derivatives(rig.get(), deformer.get());
        linearize(d, character);
        // The model's joints are quaternions.
        const PlainDeformer plain = {file.dna->view, true, false, false};
        const bool deforms = lod == 0 && file.dna->view.geom.meshes.count != 0;
        compare_behavior(
            {model, character, d, lod, quaternions, false, false, deforms ? &plain : nullptr},
            random, seen);
        if (testing::Test::HasFailure()) return;
      }
    }
  }
  seen.expect_certain();
}

}  // namespace
}  // namespace mien
