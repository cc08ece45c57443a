// SPDX-License-Identifier: MIT
#define MIEN_EXCEPTIONS  // value() throws; without, test each result
#include <cstdio>
#include <mien_author.hpp>
#include <mien_solve.hpp>
#include <utility>
#include <vector>

/* solve: poses a head, takes some of its vertices as a scanner would, and finds the controls again. */
int main() try {
  mien::GenerateDesc head;
  head.preset = MIEN_PRESET_HEAD;
  const auto dna = mien::generate(head).value();
  const mien::Rig rig = mien::Rig::create(dna).value();
  const mien::Deformer deformer = mien::Deformer::create(dna, rig).value();
  mien::Instance face = rig.instance().value();
  mien::DeformerInstance skin = deformer.instance().value();

  using Control = std::pair<const char*, float>;
  for (const auto& [name, value] :
       {Control{"jawOpen", 0.4f}, {"mouthSmileLeft", 0.7f}, {"browInnerUp", 0.5f}})
    face.raw_controls()[rig.find(MIEN_KIND_RAW_CONTROL, name).value()] = value;
  rig.evaluate(face, 0).value();
  skin.update(face).value();
  skin.deform(0, MIEN_NORMALS_NONE).value();

  // Every tenth vertex of the first mesh. Targets are x y z each; NaN would be missing.
  std::vector<MienSolvePoint> points;
  std::vector<float> targets;
  const auto positions = skin.positions(0);
  for (uint32_t i = 0; i < positions.size() / 3; i += 10) {
    points.push_back({0, {i, i, i}, {1, 0, 0}});
    targets.insert(targets.end(), &positions[3 * i], &positions[3 * i] + 3);
  }
  mien::FitDesc desc;  // all raw controls may move, from 0 to 1
  desc.deformer = deformer.get();
  desc.points = points.data();
  desc.point_count = points.size();
  mien::Fit fit = mien::Fit::create(rig, desc).value();

  mien::FitFrame frame;  // the next one would begin with `start` = the controls found here
  frame.points = targets.data();
  frame.sparse_weight = 1e-4f;  // what the vertices do not determine stays at 0
  std::vector<float> found(face.raw_controls().size());
  mien::FitResult result;
  fit.solve(frame, found, &result).value();

  std::printf("%zu points are off by %.3f, after %u iterations\n", points.size(),
              result.point_residual, result.iterations);
  for (uint32_t c = 0; c < found.size(); ++c) {
    if (found[c] < 0.005f) continue;
    const auto name = rig.name(MIEN_KIND_RAW_CONTROL, c).value();
    std::printf("%.*s %.2f\n", int(name.size()), name.data(), found[c]);
  }
} catch (const mien::Exception& e) {
  std::fprintf(stderr, "%s: %s\n", e.error().name(), e.what());
  return 1;
}
