// SPDX-License-Identifier: MIT
// mien_solve.hpp as users build it: products are each other's transposed, known controls come back.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <mien_author.hpp>
#include <mien_solve.hpp>
#include <vector>

namespace {

void check(bool condition, const char* text, int line) {
  if (condition) return;
  std::fprintf(stderr, "mien_solve_test.cpp:%d: failed: %s\n", line, text);
  std::exit(1);
}
#define CHECK(...) check(static_cast<bool>(__VA_ARGS__), #__VA_ARGS__, __LINE__)

using Row = std::vector<float>;

double dot(const Row& a, const Row& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += double{a[i]} * double{b[i]};
  return sum;
}

void test_derivatives(const mien::Rig& rig, mien::Instance& face) {
  mien::Derivatives derivatives = mien::Derivatives::create(rig).value();
  CHECK(mien::Derivatives::bytes(rig).value() > 0);
  const size_t raw = derivatives.size(MIEN_POINT_RAW).value();
  const size_t joints = derivatives.size(MIEN_POINT_JOINTS).value();
  CHECK(raw == face.raw_controls().size() && joints == face.joints().size());
  CHECK(derivatives.size(MIEN_POINT_POSITIONS).status() == MIEN_ERROR_INDEX);
  Row u(raw), v(joints), forward(joints), reverse(raw);
  for (size_t i = 0; i < raw; ++i) u[i] = static_cast<float>(i % 7) - 3;
  for (size_t i = 0; i < joints; ++i) v[i] = static_cast<float>(i % 5) - 2;
  CHECK(derivatives.forward(MIEN_POINT_RAW, MIEN_POINT_JOINTS, u, forward).status() ==
        MIEN_ERROR_INVALID_ARGUMENT);  // not linearized
  CHECK(derivatives.linearize(face));
  CHECK(derivatives.forward(MIEN_POINT_RAW, MIEN_POINT_JOINTS, u, forward));
  CHECK(derivatives.reverse(MIEN_POINT_RAW, MIEN_POINT_JOINTS, v, reverse));
  const double norms = std::sqrt(dot(forward, forward) * dot(v, v));
  CHECK(norms > 0 && std::fabs(dot(forward, v) - dot(u, reverse)) <= 1e-4 * norms);
  Row two(2 * joints);
  CHECK(derivatives.forward(MIEN_POINT_RAW, MIEN_POINT_JOINTS, u, two).status() ==
        MIEN_ERROR_INVALID_ARGUMENT);
  mien::JacobianDesc desc;
  desc.from_point = MIEN_POINT_JOINTS;
  desc.to_point = MIEN_POINT_RAW;
  CHECK(mien::Jacobian::create(derivatives, desc).status() == MIEN_ERROR_INVALID_ARGUMENT);
  desc.from_point = MIEN_POINT_RAW;
  desc.to_point = MIEN_POINT_JOINTS;
  const mien::Jacobian jacobian = mien::Jacobian::create(derivatives, desc).value();
  const mien::JacobianPattern pattern = jacobian.pattern().value();
  const size_t count = pattern.rows.count;
  CHECK(pattern.row_count == joints && pattern.column_count == raw && count != 0);
  Row values(count), product(joints);
  CHECK(derivatives.jacobian(jacobian, values));
  for (size_t i = 0; i < count; ++i) {
    product[pattern.rows.data[i]] += values[i] * u[pattern.columns.data[i]];
  }
  std::vector<uint8_t> wanted(raw);
  Row kept(count, -7.0f), few(count - 1);
  CHECK(derivatives.jacobian(jacobian, kept, wanted));
  CHECK(kept == Row(count, -7.0f));
  CHECK(derivatives.jacobian(jacobian, few).status() == MIEN_ERROR_INVALID_ARGUMENT);
  wanted.pop_back();
  CHECK(derivatives.jacobian(jacobian, kept, wanted).status() == MIEN_ERROR_INVALID_ARGUMENT);
  for (size_t i = 0; i < joints; ++i) {
    CHECK(std::fabs(product[i] - forward[i]) <= 1e-3f * (1 + std::fabs(forward[i])));
  }
}

void test_fit(const mien::Rig& rig, mien::Instance& face) {
  mien::Fit fit = mien::Fit::create(rig).value();
  const mien::Span<const float> joints = face.joints();
  mien::FitFrame frame;
  frame.joints = joints.data();
  frame.max_iterations = 200;
  mien::FitResult result;
  Row found(face.raw_controls().size()), observed(found.size());
  CHECK(fit.solve(frame, found, &result));
  CHECK(fit.observability(observed));
  CHECK(result.joint_residual < 0.01 && result.joint_worst >= result.joint_residual);
  for (size_t i = 0; i < found.size(); ++i) {
    CHECK(observed[i] < 0.05f || std::fabs(found[i] - face.raw_controls()[i]) < 0.01f);
  }
  frame.sparse_weight = -1;
  CHECK(fit.solve(frame, found).status() == MIEN_ERROR_INVALID_ARGUMENT);
  mien::FitDesc wrong;
  wrong.lod = 99;
  const auto refused = mien::Fit::create(rig, wrong);
  CHECK(!refused && refused.status() == MIEN_ERROR_LOD);
}

void test_frames(const mien::Rig& rig, mien::Instance& face) {
  mien::Fit fit = mien::Fit::create(rig).value();
  const size_t raw = face.raw_controls().size();
  Row joints;
  for (const float share : {0.5f, 1.0f}) {
    for (size_t i = 0; i < raw; i += 4) face.raw_controls()[i] = 0.4f * share;
    CHECK(rig.evaluate(face, 0));
    for (const float value : face.joints()) joints.push_back(value);
  }
  mien::FitFrame frame;
  frame.joints = joints.data();
  frame.max_iterations = 200;
  std::vector<mien::FitResult> results(2);
  Row found(2 * raw), observed(raw);
  CHECK(fit.solve_frames(frame, raw, found, results));
  CHECK(fit.observability(observed));
  for (size_t i = 0; i < raw; ++i) {
    CHECK(observed[i] < 0.05f || std::fabs(found[raw + i] - face.raw_controls()[i]) < 0.01f);
  }
  CHECK(results[0].joint_residual < 0.01 && results[1].joint_residual < 0.01);
  results.pop_back();
  CHECK(fit.solve_frames(frame, raw, found, results).status() == MIEN_ERROR_INVALID_ARGUMENT);
}

void test_constraints(const mien::Dna& dna, const mien::Rig& rig) {
  const mien::Deformer deformer = mien::Deformer::create(dna, rig).value();
  const std::vector<uint32_t> chosen = {1, 3};
  const mien::Deformer part = deformer.subset(0, chosen).value();
  CHECK(part.mesh(0).value().position_count == 2);
  CHECK(deformer.subset(0, std::vector<uint32_t>{3, 1}).status() == MIEN_ERROR_INVALID_ARGUMENT);
  const MienSolvePoint points[2] = {{0, {0, 0, 0}, {1, 0, 0}}, {0, {1, 1, 1}, {1, 0, 0}}};
  mien::FitDesc desc;
  desc.deformer = part.get();
  desc.points = points;
  desc.point_count = 2;
  mien::Fit fit = mien::Fit::create(rig, desc).value();
  // Two points that are as far from each other as they are.
  MienFitConstraint apart = {};
  apart.kind = MIEN_CONSTRAINT_POINT_DISTANCE;
  apart.points[1] = 1;
  apart.distances[1] = 1e6f;
  apart.weight = 1;
  mien::FitFrame frame;
  frame.constraints = &apart;
  frame.constraint_count = 1;
  const size_t raw = rig.instance().value().raw_controls().size();
  std::vector<uint32_t> stages(raw);
  frame.stages = stages.data();
  mien::FitResult result;
  Row found(raw);
  CHECK(fit.solve(frame, found, &result));
  CHECK(result.constraint_worst == 0 && !result.jumped);
  stages[0] = 16;
  CHECK(fit.solve(frame, found).status() == MIEN_ERROR_INVALID_ARGUMENT);
  frame.stages = nullptr;
  apart.points[1] = 2;
  CHECK(fit.solve(frame, found).status() == MIEN_ERROR_INDEX);
}

void test_surface() {
  const Row positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::vector<uint32_t> triangles = {0, 1, 2, 0, 1, 3};
  mien::FitSurfaceDesc desc;
  desc.positions = positions.data();
  desc.position_count = 3;
  desc.triangles = triangles.data();
  desc.triangle_count = 1;
  CHECK(mien::FitSurface::create(desc).value().get() != nullptr);
  desc.triangle_count = 2;
  const auto refused = mien::FitSurface::create(desc);
  CHECK(!refused && refused.status() == MIEN_ERROR_INDEX);
}

void test_keys() {
  const Row curve = {0, 0.25f, 0.5f, 0.75f, 1, 0.5f, 0};
  std::vector<uint32_t> keys(curve.size());
  CHECK(mien::fit_keys(curve, 0.001f, keys).value() == 3);
  CHECK(keys[0] == 0 && keys[1] == 4 && keys[2] == 6);
  CHECK(!mien::fit_keys(curve, -1, keys));
  keys.pop_back();
  CHECK(!mien::fit_keys(curve, 0.001f, keys));
}

}  // namespace

int main() {
  mien::GenerateDesc desc;
  desc.preset = MIEN_PRESET_SMALL;
  const mien::Dna dna = mien::generate(desc).value();
  const mien::Rig rig = mien::Rig::create(dna).value();
  mien::Instance face = rig.instance().value();
  for (size_t i = 0; i < face.raw_controls().size(); i += 4) face.raw_controls()[i] = 0.4f;
  CHECK(rig.evaluate(face, 0));
  test_derivatives(rig, face);
  test_fit(rig, face);
  test_frames(rig, face);
  test_constraints(dna, rig);
  test_surface();
  test_keys();
  return 0;
}
