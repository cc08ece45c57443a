// SPDX-License-Identifier: MIT
// Solves of generated motion at 60 frames per second, each frame from the one before: time per frame, iterations,
// and how well joints or vertices are met; and the same with a matrix of numeric differences (numeric_solve.h).
//
// With a head from a file, in centimeters, also landmarks with noise: how far its surface is from the true one.
//
//     ./build/release/bench/bench_solve [frames [HEAD.dna]]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <thread>
#include <vector>

#include "author/base/random.h"
#include "bench/numeric_solve.h"
#include "capi/include/mien_author.h"
#include "capi/include/mien_solve.h"

namespace {

/// Of the processor, so that other programs count for little.
double seconds_since(std::clock_t start) {
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

/// One of `stride` controls swings between 0 and 0.8, at different rates. `initial`: of the raw controls.
std::vector<float> motion(const std::vector<float>& initial, double time, size_t stride = 11) {
  std::vector<float> raw = initial;
  const auto swing = [&](size_t i, double phase) {
    return 0.4 - 0.4 * std::cos(time * (1 + 0.07 * static_cast<double>(i % 13)) + phase);
  };
  const auto is_rotation = [&](size_t first) {  // x y z w: only w is 1 at rest
    return first + 3 < initial.size() && initial[first + 3] == 1;
  };
  for (size_t i = 0; i < raw.size(); i += stride) {
    raw[i] = static_cast<float>(swing(i, static_cast<double>(i)));
  }
  // Rotations turn by such angles, from rest.
  for (size_t i = 0, count = 0; i < raw.size(); ++i) {
    if (!is_rotation(i)) continue;
    const double angle = count % 3 == 0 ? swing(i, 0) : 0;
    std::fill(raw.data() + i, raw.data() + i + 3, 0.0f);
    raw[i + count++ % 3] = static_cast<float>(std::sin(angle / 2));
    raw[i + 3] = static_cast<float>(std::cos(angle / 2));
    i += 3;
  }
  return raw;
}

struct Rig {
  MienDna* dna = nullptr;
  MienRig* rig = nullptr;
  MienInstance* instance = nullptr;
  MienDeformer* deformer = nullptr;
  MienDeformerInstance* deformed = nullptr;
  MienMutableFloatView raw = {};
  MienFloatView joints = {}, positions = {};
  std::vector<float> initial;  // raw controls

  static MienDna* generate(uint32_t preset) {
    MienGenerateDesc generate = mien_generate_desc_default();
    generate.preset = preset;
    generate.seed = 1;
    MienDna* dna = nullptr;
    if (mien_dna_generate(&generate, &dna, nullptr) != MIEN_OK) std::exit(1);
    return dna;
  }
  explicit Rig(MienDna* owned) : dna(owned) {
    const bool made =
        mien_rig_create(dna, nullptr, &rig, nullptr) == MIEN_OK &&
        mien_instance_create(rig, nullptr, &instance, nullptr) == MIEN_OK &&
        mien_deformer_create(dna, rig, nullptr, &deformer, nullptr) == MIEN_OK &&
        mien_deformer_instance_create(deformer, nullptr, &deformed, nullptr) == MIEN_OK &&
        mien_instance_raw_controls(instance, &raw) == MIEN_OK &&
        mien_instance_joints(instance, &joints) == MIEN_OK;
    if (!made) std::exit(1);
    initial.assign(raw.data, raw.data + raw.count);
  }
  ~Rig() {
    mien_deformer_instance_destroy(deformed);
    mien_deformer_destroy(deformer);
    mien_instance_destroy(instance);
    mien_rig_destroy(rig);
    mien_dna_close(dna);
  }
  void pose(const std::vector<float>& controls) {
    std::copy(controls.begin(), controls.end(), raw.data);
    static_cast<void>(mien_rig_evaluate(rig, instance, 0));
  }
  void deform(const std::vector<float>& controls) {
    pose(controls);
    static_cast<void>(mien_deformer_instance_update(deformed, instance));
    static_cast<void>(mien_deformer_instance_deform(deformed, 0, MIEN_NORMALS_NONE, nullptr));
    static_cast<void>(mien_deformer_instance_positions(deformed, 0, &positions));
  }
};

/// How far the matrix of differences is from the derivatives, as a share of these: root mean square.
double matrix_error(const Rig& rig, uint32_t mesh_step, const mien::NumericSolve& numeric) {
  MienDerivativesDesc desc = mien_derivatives_desc_default();
  desc.deformer = mesh_step ? rig.deformer : nullptr;
  MienDerivatives* derivatives = nullptr;
  if (mien_derivatives_create(rig.rig, &desc, &derivatives, nullptr) != MIEN_OK) std::exit(1);
  static_cast<void>(mien_derivatives_linearize(derivatives, rig.instance, MIEN_STAGE_ALL));
  const uint32_t to = mesh_step ? MIEN_POINT_POSITIONS : MIEN_POINT_JOINTS;
  size_t size = 0;
  static_cast<void>(mien_derivatives_size(derivatives, to, 0, &size));
  std::vector<float> direction(rig.raw.count), exact(size);
  double apart = 0, all = 0;
  for (size_t c = 0; c < rig.raw.count; ++c) {
    direction[c] = 1;
    static_cast<void>(mien_derivatives_forward(derivatives, MIEN_POINT_RAW, to, 0, 1,
                                               direction.data(), exact.data()));
    direction[c] = 0;
    for (size_t i = 0; i < numeric.value_count; ++i) {
      const double value = double{exact[mesh_step ? i / 3 * 3 * mesh_step + i % 3 : i]};
      apart += std::pow(double{numeric.columns[c * numeric.value_count + i]} - value, 2);
      all += value * value;
    }
  }
  mien_derivatives_destroy(derivatives);
  return std::sqrt(apart / all);
}

/// The motion of run() by numeric differences.
void run_numeric(Rig& rig, uint32_t every, int frames) {
  std::vector<float> values;
  const auto evaluate = [&](const std::vector<float>& raw) {
    if (every == 0) {
      rig.pose(raw);
      return rig.joints.data;
    }
    rig.deform(raw);
    values.clear();
    for (size_t p = 0; p < rig.positions.count / 3; p += every) {
      values.insert(values.end(), rig.positions.data + 3 * p, rig.positions.data + 3 * p + 3);
    }
    return static_cast<const float*>(values.data());
  };
  mien::NumericSolve numeric;
  numeric.evaluate = evaluate;
  evaluate(rig.initial);
  numeric.value_count = every ? values.size() : rig.joints.count;
  numeric.control_count = rig.raw.count;
  numeric.prior = every ? 1e-6 : 0;
  std::vector<float> found = rig.initial;
  double total = 0, worst = 0, differences = 0;
  int iterations = 0;
  for (int f = 0; f < frames; ++f) {
    const float* const posed = evaluate(motion(rig.initial, f / 60.0));
    const std::vector<float> targets(posed, posed + numeric.value_count);
    const std::clock_t start = std::clock();
    const double residual = numeric.solve(found, targets, f == 0 ? 200 : 50);
    if (f == 0) numeric.difference_seconds = 0;
    if (f == 0) continue;
    total += seconds_since(start);
    iterations += numeric.iterations;
    worst = std::max(worst, residual * (every ? std::sqrt(3.0) : 1));
    differences = numeric.difference_seconds;
  }
  std::printf(
      "    by numeric differences, %d frames: %.0f ms a frame, %.0f of it evaluations, %.1f "
      "iterations  residual %.1e  matrix off by",
      frames, total / (frames - 1) * 1e3, differences / (frames - 1) * 1e3,
      static_cast<double>(iterations) / (frames - 1), worst);
  for (const float h : {1e-2f, 1e-3f, 1e-4f}) {
    const std::vector<float> at = motion(rig.initial, 1);
    numeric.differentiate(at, h);
    evaluate(at);
    std::printf(" %.1e (step %g)", matrix_error(rig, every, numeric), double{h});
  }
  std::printf("\n");
}

/// `every`: of how many vertices one is a target; 0: joints are.
void run(const char* name, Rig&& rig, uint32_t every, int frames, bool numeric,
         size_t stride = 11) {
  std::vector<MienSolvePoint> points;
  MienFitDesc desc = mien_fit_desc_default();
  if (every != 0) {
    MienMesh mesh = mien_mesh_default();
    static_cast<void>(mien_deformer_mesh(rig.deformer, 0, &mesh));
    for (uint32_t i = 0; i < mesh.position_count; i += every)
      points.push_back({0, {i, i, i}, {1, 0, 0}});
    desc.deformer = rig.deformer;
    desc.points = points.data();
    desc.point_count = points.size();
  }
  std::clock_t start = std::clock();
  MienFit* fit = nullptr;
  if (mien_fit_create(rig.rig, &desc, &fit, nullptr) != MIEN_OK) std::exit(1);
  const double create = seconds_since(start);
  std::vector<float> found(rig.raw.count), before, joints, targets;
  double total = 0, worst_joint = 0, range = 0, worst_residual = 0;
  uint32_t iterations = 0;
  for (int f = 0; f < frames; ++f) {
    const std::vector<float> raw = motion(rig.initial, f / 60.0, stride);
    MienFitFrame frame = mien_fit_frame_default();
    if (every == 0) {
      rig.pose(raw);
      joints.assign(rig.joints.data, rig.joints.data + rig.joints.count);
      frame.joints = joints.data();
    } else {
      rig.deform(raw);
      targets.clear();
      for (const MienSolvePoint& point : points) {
        const float* p = rig.positions.data + size_t{point.positions[0]} * 3;
        targets.insert(targets.end(), p, p + 3);
      }
      frame.points = targets.data();
      frame.prior_weight = 1e-6f;
    }
    frame.start = f == 0 ? nullptr : before.data();
    frame.max_iterations = f == 0 ? 200 : 0;
    MienFitResult result = mien_fit_result_default();
    start = std::clock();
    if (mien_fit_solve(fit, &frame, found.data(), &result) != MIEN_OK) std::exit(1);
    if (f != 0) {
      total += seconds_since(start);
      iterations += result.iterations;
      worst_residual = std::max(worst_residual, result.point_residual + result.joint_residual);
    }
    before = found;
    if (every == 0) {
      rig.pose(found);
      for (size_t i = 0; i < joints.size(); ++i) {
        range = std::max(range, std::fabs(double{joints[i]}));
        worst_joint = std::max(worst_joint, std::fabs(double{rig.joints.data[i]} - joints[i]));
      }
    }
  }
  std::printf("%-34s %5zu targets  made in %5.2f s  %7.3f ms a frame, %4.1f iterations  ", name,
              every ? points.size() : joints.size(), create, total / (frames - 1) * 1e3,
              static_cast<double>(iterations) / (frames - 1));
  std::printf("residual %.1e", worst_residual);
  if (every == 0) std::printf("  joints within %.1e of their range", worst_joint / range);
  std::printf("\n");
  if (numeric) run_numeric(rig, every, std::min(frames, 10));
  mien_fit_destroy(fit);
}

MienFit* fit_of(const Rig& rig) {
  MienFit* fit = nullptr;
  const MienFitDesc desc = mien_fit_desc_default();
  if (mien_fit_create(rig.rig, &desc, &fit, nullptr) != MIEN_OK) std::exit(1);
  return fit;
}

std::vector<float> joints_of(Rig& rig, size_t frames) {
  std::vector<float> targets;
  targets.reserve(frames * rig.joints.count);
  for (size_t f = 0; f < frames; ++f) {
    rig.pose(motion(rig.initial, static_cast<double>(f) / 60));
    targets.insert(targets.end(), rig.joints.data, rig.joints.data + rig.joints.count);
  }
  return targets;
}

/// The same joints in one call.
void run_frames(const char* name, Rig&& rig, size_t frames) {
  MienFit* const fit = fit_of(rig);
  const std::vector<float> targets = joints_of(rig, frames);
  std::vector<float> found(frames * rig.raw.count);
  std::vector<MienFitResult> results(frames, mien_fit_result_default());
  MienFitFrame frame = mien_fit_frame_default();
  frame.joints = targets.data();
  const std::clock_t start = std::clock();
  if (mien_fit_solve_frames(fit, &frame, frames, found.data(), results.data()) != MIEN_OK) {
    std::exit(1);
  }
  const double time = seconds_since(start);
  double worst = 0, range = 0;
  for (const MienFitResult& result : results) worst = std::max(worst, result.joint_worst);
  for (const float v : targets) range = std::max(range, std::fabs(double{v}));
  std::printf("%-34s %5zu targets  %7.3f ms a frame of %zu  joints within %.1e of their range\n",
              name, size_t{rig.joints.count}, time / static_cast<double>(frames) * 1e3, frames,
              worst / range);
  mien_fit_destroy(fit);
}

/// Ranges of 500 frames, each of which starts by itself, on several threads with a fit each: no range depends on which
/// thread solves it.
std::vector<float> solve_ranges(const Rig& rig, const std::vector<float>& targets, size_t frames,
                                const std::vector<MienFit*>& fits) {
  constexpr size_t kRange = 500;
  std::vector<float> found(frames * rig.raw.count);
  std::vector<std::thread> threads;
  for (size_t t = 0; t < fits.size(); ++t) {
    threads.emplace_back([&, t] {
      for (size_t first = t * kRange; first < frames; first += fits.size() * kRange) {
        MienFitFrame frame = mien_fit_frame_default();
        frame.joints = targets.data() + first * rig.joints.count;
        if (mien_fit_solve_frames(fits[t], &frame, std::min(kRange, frames - first),
                                  found.data() + first * rig.raw.count, nullptr) != MIEN_OK) {
          std::exit(1);
        }
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  return found;
}

void run_ranges(const char* name, Rig&& rig, size_t frames) {
  std::vector<MienFit*> fits = {fit_of(rig), fit_of(rig)};
  const std::vector<float> targets = joints_of(rig, frames);
  const auto begin = std::chrono::steady_clock::now();
  const std::clock_t start = std::clock();
  const std::vector<float> found = solve_ranges(rig, targets, frames, fits);
  const double cpu = seconds_since(start);
  const double time =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const bool same = found == solve_ranges(rig, targets, frames, {fits[0]});
  std::printf(
      "%-34s %5zu targets  %7.3f ms a frame of %zu by the clock, %.3f ms of processors  %s\n", name,
      size_t{rig.joints.count}, time / static_cast<double>(frames) * 1e3, frames,
      cpu / static_cast<double>(frames) * 1e3,
      same ? "the same bits as on one thread" : "OTHER BITS THAN ON ONE THREAD");
  for (MienFit* fit : fits) mien_fit_destroy(fit);
}

/// Positions that controls move by more than 0.02, evenly chosen.
std::vector<MienSolvePoint> choose_landmarks(Rig& rig, size_t count) {
  rig.deform(std::vector<float>(rig.raw.count));
  const std::vector<float> rest(rig.positions.data, rig.positions.data + rig.positions.count);
  std::vector<uint8_t> moves(rest.size() / 3);
  for (size_t c = 0; c < rig.raw.count; ++c) {
    std::vector<float> raw(rig.raw.count);
    raw[c] = 1;
    rig.deform(raw);
    for (size_t i = 0; i < rest.size(); ++i) {
      moves[i / 3] |= std::fabs(rig.positions.data[i] - rest[i]) > 0.02f;
    }
  }
  std::vector<uint32_t> moved;
  for (uint32_t i = 0; i < moves.size(); ++i) {
    if (moves[i]) moved.push_back(i);
  }
  std::vector<MienSolvePoint> points;
  for (size_t i = 0; i < count; ++i) {
    const uint32_t p = moved[i * moved.size() / count];
    points.push_back({0, {p, p, p}, {1, 0, 0}});
  }
  return points;
}

/// 60 in front of the middle of the landmarks: the axes of the rig are x to the left, y up, z to the front.
MienFitCamera place_camera(const Rig& rig, const std::vector<MienSolvePoint>& points) {
  MienFitCamera camera = {{1500, 1500}, {320, 240}, {1, 0, 0, 0, -1, 0, 0, 0, -1}, {0, 0, 60}};
  for (const MienSolvePoint& point : points) {
    for (size_t k = 0; k < 3; ++k) {
      camera.translation[k] -= camera.rotation[4 * k] *
                               rig.positions.data[size_t{point.positions[0]} * 3 + k] /
                               static_cast<float>(points.size());
    }
  }
  return camera;
}

enum class See { kSpace, kCamera, kUnknownCamera };

/// Landmarks with noise of a standard deviation of 0.05 (0.5 mm) in space, or of a pixel.
void run_landmarks(const char* name, MienDna* dna, size_t count, See see, int frames) {
  Rig rig(dna);
  const std::vector<MienSolvePoint> points = choose_landmarks(rig, count);
  MienFitDesc desc = mien_fit_desc_default();
  desc.deformer = rig.deformer;
  desc.points = points.data();
  desc.point_count = points.size();
  MienFit* fit = nullptr;
  if (mien_fit_create(rig.rig, &desc, &fit, nullptr) != MIEN_OK) std::exit(1);
  rig.deform(std::vector<float>(rig.raw.count));
  const MienFitCamera known = place_camera(rig, points);
  MienFitCamera camera = known;
  if (see == See::kUnknownCamera) std::fill(camera.rotation, camera.rotation + 9, 0.0f);
  mien::Random random = mien::Random::from_seed(7, 1);
  const double noise = see == See::kSpace ? 0.05 : 1;
  const auto noisy = [&](double v) {
    return static_cast<float>(v + noise * std::sqrt(3.0) * random.between(-1, 1));
  };
  std::vector<float> found(rig.raw.count), before, targets;
  double time = 0, apart = 0, rest_apart = 0, iterations = 0;
  rig.deform(found);
  const std::vector<float> rest(rig.positions.data, rig.positions.data + rig.positions.count);
  for (int f = 0; f < frames; ++f) {
    rig.deform(motion(rig.initial, f / 60.0));
    const std::vector<float> truth(rig.positions.data, rig.positions.data + rig.positions.count);
    targets.clear();
    for (const MienSolvePoint& point : points) {
      const float* p = truth.data() + size_t{point.positions[0]} * 3;
      double at[3];
      for (size_t k = 0; k < 3; ++k) at[k] = known.rotation[4 * k] * p[k] + known.translation[k];
      for (size_t k = 0; k < (see == See::kSpace ? 3u : 2u); ++k) {
        targets.push_back(noisy(
            see == See::kSpace ? double{p[k]} : known.focal[k] * at[k] / at[2] + known.center[k]));
      }
    }
    MienFitFrame frame = mien_fit_frame_default();
    (see == See::kSpace ? frame.points : frame.images) = targets.data();
    frame.camera = &camera;
    frame.rigid = see == See::kUnknownCamera;
    // Controls are some 0.3, and change by some 0.05 from frame to frame.
    frame.prior_weight = static_cast<float>(noise * noise / (0.3 * 0.3));
    frame.smooth_weight = f == 0 ? 0 : static_cast<float>(noise * noise / (0.05 * 0.05));
    frame.start = f == 0 ? nullptr : before.data();
    MienFitResult result = mien_fit_result_default();
    const std::clock_t start = std::clock();
    if (mien_fit_solve(fit, &frame, found.data(), &result) != MIEN_OK) std::exit(1);
    if (f != 0) time += seconds_since(start);
    iterations += result.iterations;
    std::copy(result.rotation, result.rotation + 9, camera.rotation);
    std::copy(result.translation, result.translation + 3, camera.translation);
    before = found;
    rig.deform(found);
    for (size_t i = 0; i < truth.size(); i += 3) {
      double here = 0, there = 0;
      for (size_t k = i; k < i + 3; ++k) {
        here += std::pow(double{rig.positions.data[k]} - truth[k], 2);
        there += std::pow(double{rest[k]} - truth[k], 2);
      }
      apart += std::sqrt(here);
      rest_apart += std::sqrt(there);
    }
  }
  const double all = static_cast<double>(frames) * static_cast<double>(rest.size() / 3);
  std::printf(
      "%-34s %5zu targets  %7.3f ms a frame, %4.1f iterations  surface off by %.2f mm on average "
      "(at rest %.2f mm)\n",
      name, count, time / (frames - 1) * 1e3, iterations / frames, apart / all * 10,
      rest_apart / all * 10);
  mien_fit_destroy(fit);
}

MienDna* open_head(const char* path) {
  MienDna* dna = nullptr;
  MienError error = mien_error_default();
  if (mien_dna_open_file(path, nullptr, &dna, &error) != MIEN_OK) {
    std::fprintf(stderr, "%s\n", error.message);
    std::exit(1);
  }
  return dna;
}

}  // namespace

int main(int argc, char** argv) {
  const int frames = argc > 1 ? std::max(std::atoi(argv[1]), 2) : 300;
  const auto generated = [](uint32_t preset) { return Rig(Rig::generate(preset)); };
  run("joints, large head", generated(MIEN_PRESET_LARGE), 0, frames, true);
  run_frames("the same in one call", generated(MIEN_PRESET_LARGE), static_cast<size_t>(frames));
  run_ranges("ranges of 500 on two threads", generated(MIEN_PRESET_LARGE),
             static_cast<size_t>(frames));
  run("joints, body", generated(MIEN_PRESET_BODY), 0, frames, false);
  run("all vertices, large head", generated(MIEN_PRESET_LARGE), 1, frames / 4 + 2, false);
  run("the same, a quarter of controls", generated(MIEN_PRESET_LARGE), 1, frames / 4 + 2, false, 4);
  run("all vertices, head", generated(MIEN_PRESET_HEAD), 1, frames / 4 + 2, true);
  run("every 12th vertex, head", generated(MIEN_PRESET_HEAD), 12, frames / 4 + 2, true);
  if (argc < 3) return 0;
  run("all vertices, file", Rig(open_head(argv[2])), 1, frames / 4 + 2, true);
  run("every 40th vertex, file", Rig(open_head(argv[2])), 40, frames / 4 + 2, true);
  run_landmarks("478 landmarks, 0.5 mm of noise", open_head(argv[2]), 478, See::kSpace, frames);
  run_landmarks("68 landmarks in images, 1 pixel", open_head(argv[2]), 68, See::kCamera, frames);
  run_landmarks("the same, camera unknown", open_head(argv[2]), 68, See::kUnknownCamera, frames);
  return 0;
}
