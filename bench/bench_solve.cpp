// SPDX-License-Identifier: MIT
// Solves of generated motion at 60 frames per second, each frame from the one before: time per frame, iterations,
// and how well joints or vertices are met; and what central differences would cost in place of one gradient.
//
//     ./build/release/bench/bench_solve [frames]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

#include "author/base/random.h"
#include "capi/include/mien_author.h"
#include "capi/include/mien_solve.h"

namespace {

/// Of the processor, so that other programs count for little.
double seconds_since(std::clock_t start) {
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

/// Some controls swing at different rates between 0 and 0.8.
std::vector<float> motion(size_t raw_count, double time) {
  std::vector<float> raw(raw_count);
  for (size_t i = 0; i < raw_count; i += 11) {
    const double phase = static_cast<double>(i);
    raw[i] = static_cast<float>(0.4 - 0.4 * std::cos(time * (1 + 0.07 * (i % 13)) + phase));
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

  explicit Rig(uint32_t preset) {
    MienGenerateDesc generate = mien_generate_desc_default();
    generate.preset = preset;
    generate.seed = 1;
    const bool made =
        mien_dna_generate(&generate, &dna, nullptr) == MIEN_OK &&
        mien_rig_create(dna, nullptr, &rig, nullptr) == MIEN_OK &&
        mien_instance_create(rig, nullptr, &instance, nullptr) == MIEN_OK &&
        mien_deformer_create(dna, rig, nullptr, &deformer, nullptr) == MIEN_OK &&
        mien_deformer_instance_create(deformer, nullptr, &deformed, nullptr) == MIEN_OK &&
        mien_instance_raw_controls(instance, &raw) == MIEN_OK &&
        mien_instance_joints(instance, &joints) == MIEN_OK;
    if (!made) std::exit(1);
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

/// `every`: of how many vertices one is a target; 0: joints are.
void run(const char* name, uint32_t preset, uint32_t every, int frames) {
  Rig rig(preset);
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
  double total = 0, worst_joint = 0, range = 0, worst_point = 0, gradient = 0;
  uint32_t iterations = 0;
  for (int f = 0; f < frames; ++f) {
    const std::vector<float> raw = motion(rig.raw.count, f / 60.0);
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
      worst_point = std::max(worst_point, result.point_residual);
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
  // One central difference takes two evaluations, and a gradient one for each control.
  start = std::clock();
  for (size_t i = 0; i < 2 * rig.raw.count; ++i) {
    found[i / 2] += 1e-3f;
    every == 0 ? rig.pose(found) : rig.deform(found);
  }
  gradient = seconds_since(start);
  std::printf("%-34s %5zu targets  made in %5.2f s  %7.3f ms a frame, %4.1f iterations  ", name,
              every ? points.size() : joints.size(), create, total / (frames - 1) * 1e3,
              static_cast<double>(iterations) / (frames - 1));
  if (every == 0) {
    std::printf("joints within %.1e of their range", worst_joint / range);
  } else {
    std::printf("residual %.1e", worst_point);
  }
  std::printf("  (evaluations of numeric differences alone: %.1f ms an iteration)\n",
              gradient * 1e3);
  mien_fit_destroy(fit);
}

}  // namespace

int main(int argc, char** argv) {
  const int frames = argc > 1 ? std::max(std::atoi(argv[1]), 2) : 300;
  run("joints, large head", MIEN_PRESET_LARGE, 0, frames);
  run("all vertices, head", MIEN_PRESET_HEAD, 1, frames / 4 + 2);
  run("every 12th vertex, head", MIEN_PRESET_HEAD, 12, frames / 4 + 2);
  return 0;
}
