// SPDX-License-Identifier: MIT
#include "tests/support/real_meshes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <queue>
#include <sstream>

#include "runtime/author/random.h"
#include "tests/support/golden.h"

namespace mien::author {

namespace {

struct Obj {
  std::vector<Vec3> positions;
  std::vector<std::vector<uint32_t>> faces;
  std::vector<std::string> groups;  // of each face
};

bool read_obj(const std::string& path, Obj& out) {
  std::ifstream file(path);
  std::string line, group;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::string key, corner;
    words >> key;
    if (key == "v") {
      Vec3 p;
      words >> p.x >> p.y >> p.z;
      out.positions.push_back(p);
    } else if (key == "g") {
      words >> group;
    } else if (key == "f") {
      out.faces.emplace_back();
      out.groups.push_back(group);
      while (words >> corner) {
        out.faces.back().push_back(static_cast<uint32_t>(std::atoi(corner.c_str()) - 1));
      }
    }
  }
  return !out.positions.empty();
}

/// Keeps these faces and their vertices; returns the new number of each old vertex, or kNone.
template <class Keep>
std::vector<uint32_t> take(const Obj& obj, double scale, const Keep& keep, AuthorSetup& out) {
  std::vector<uint32_t> number(obj.positions.size(), kNone);
  for (size_t f = 0; f < obj.faces.size(); ++f) {
    if (!keep(f)) continue;
    std::vector<uint32_t> corners;
    for (uint32_t v : obj.faces[f]) {
      if (number[v] == kNone) number[v] = out.add_vertex(obj.positions[v] * scale);
      corners.push_back(number[v]);
    }
    out.add_face(corners);
  }
  return number;
}

void add_sparse(const std::string& name, const std::vector<std::pair<uint32_t, Vec3>>& deltas,
                AuthorSetup& out) {
  if (deltas.empty()) return;
  std::vector<Vec3> dense(out.positions.size());
  for (const auto& [vertex, d] : deltas) dense[vertex] = d;
  out.add_shape(name, [&](uint32_t v) { return dense[v]; });
}

template <class T>
T take_number(const char*& at) {
  T value;
  memcpy(&value, at, sizeof(T));
  at += sizeof(T);
  return value;
}

}  // namespace

std::string real_mesh_folder() {
  const std::string folder = golden::shared_folder() + "/data/meshes";
  return std::filesystem::is_directory(folder) ? folder : std::string();
}

bool load_ict(AuthorSetup& out) {
  const std::string folder = real_mesh_folder() + "/ict/";
  Obj obj;
  std::ifstream file(folder + "ict_expressions.mshp", std::ios::binary);
  if (!file || !read_obj(folder + "ict_neutral.obj", obj)) return false;
  const std::vector<uint32_t> number = take(
      obj, 1,
      [&](size_t f) {
        for (uint32_t v : obj.faces[f]) {
          if (v > 11247) return false;
        }
        return true;
      },
      out);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  const char* at = bytes.data() + 12;
  const uint32_t shapes = take_number<uint32_t>(at), index_bytes = take_number<uint32_t>(at);
  for (uint32_t s = 0; s < shapes; ++s) {
    const size_t letters = take_number<uint8_t>(at);
    const std::string name(at, letters);
    at += letters;
    const double scale = double{take_number<float>(at)};
    std::vector<uint32_t> vertices(take_number<uint32_t>(at));
    for (uint32_t& v : vertices) {
      v = index_bytes == 2 ? take_number<uint16_t>(at) : take_number<uint32_t>(at);
    }
    std::vector<std::pair<uint32_t, Vec3>> deltas;
    for (uint32_t v : vertices) {
      const double x = take_number<int16_t>(at), y = take_number<int16_t>(at);
      const Vec3 d = Vec3{x, y, double(take_number<int16_t>(at))} * scale;
      if (number[v] != kNone) deltas.push_back({number[v], d});
    }
    add_sparse(name, deltas, out);
  }
  return true;
}

bool load_makehuman(AuthorSetup& out) {
  const std::string folder = real_mesh_folder() + "/makehuman/";
  Obj obj;
  if (!read_obj(folder + "base.obj", obj)) return false;
  const std::vector<uint32_t> number = take(
      obj, 10,
      [&](size_t f) {
        for (uint32_t v : obj.faces[f]) {
          if (obj.positions[v].y <= 5 || std::abs(obj.positions[v].x) >= 1) return false;
        }
        return obj.groups[f] == "body";
      },
      out);
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder + "targets")) {
    if (entry.path().extension() == ".target") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const std::filesystem::path& path : files) {
    std::ifstream file(path);
    std::vector<std::pair<uint32_t, Vec3>> deltas;
    std::string line;
    while (std::getline(file, line)) {
      uint32_t v = 0;
      Vec3 d;
      if (sscanf(line.c_str(), "%u %lf %lf %lf", &v, &d.x, &d.y, &d.z) != 4) continue;
      if (number.at(v) != kNone) deltas.push_back({number[v], d * 10});
    }
    add_sparse(path.stem().string(), deltas, out);
  }
  return true;
}

namespace {

/// k-means++ and Lloyd, the better of two.
std::vector<Vec3> find_means(const std::vector<Vec3>& points, const std::vector<double>& weights,
                             uint32_t count) {
  Random random = Random::from_seed(1, 1);
  std::vector<Vec3> best;
  double best_energy = 1e300;
  for (int run = 0; run < 2; ++run) {
    std::vector<Vec3> means = {points[random.below(static_cast<uint32_t>(points.size()))]};
    std::vector<double> nearest(points.size(), 1e300);
    while (means.size() < count) {
      double all = 0;
      for (size_t i = 0; i < points.size(); ++i) {
        const Vec3 d = points[i] - means.back();
        nearest[i] = std::min(nearest[i], dot(d, d));
        all += nearest[i] * weights[i];
      }
      double left = random.real() * all;
      size_t i = 0;
      while (i + 1 < points.size() && (left -= nearest[i] * weights[i]) > 0) ++i;
      means.push_back(points[i]);
    }
    double energy = 0;
    for (int round = 0; round < 12; ++round) {
      energy = 0;
      std::vector<Vec3> sums(count);
      std::vector<double> masses(count);
      for (size_t i = 0; i < points.size(); ++i) {
        size_t group = 0;
        double least = 1e300;
        for (size_t j = 0; j < count; ++j) {
          const Vec3 d = points[i] - means[j];
          if (dot(d, d) < least) least = dot(d, d), group = j;
        }
        sums[group] = sums[group] + points[i] * weights[i];
        masses[group] += weights[i];
        energy += least * weights[i];
      }
      for (size_t j = 0; j < count; ++j) {
        if (masses[j] > 0) means[j] = sums[j] * (1 / masses[j]);
      }
    }
    if (energy < best_energy) best_energy = energy, best = means;
  }
  return best;
}

}  // namespace

void add_bones_and_weights(uint32_t count, uint32_t influences, AuthorSetup& out) {
  const size_t n = out.positions.size();
  std::vector<double> motion(n);
  for (const std::vector<Vec3f>& shape : out.displacements) {
    for (size_t v = 0; v < n; ++v) {
      const Vec3 d = {double{shape[v].x}, double{shape[v].y}, double{shape[v].z}};
      motion[v] += dot(d, d) / static_cast<double>(out.displacements.size());
    }
  }
  double mean = 0;
  for (double& m : motion) {
    m = std::sqrt(m);
    mean += m / static_cast<double>(n);
  }
  std::vector<Vec3> points;
  std::vector<double> weights;
  for (uint32_t v = 0; v < n; ++v) {
    if (motion[v] < 1e-4) continue;
    out.mask.push_back(v);
    points.push_back(out.positions[v]);
    weights.push_back(0.15 + motion[v] / mean);
  }
  out.add_trunk();
  const std::vector<Vec3> means = find_means(points, weights, count);
  for (uint32_t j = 0; j < count; ++j) {
    out.add_bone("FACIAL_" + std::to_string(j), means[j], BoneKind::kFacial, 3);
  }

  // The nearest bones along the surface, from where each comes closest to it.
  std::vector<std::vector<std::pair<uint32_t, double>>> neighbors(n);
  for (size_t i = 0; i < out.triangles.size(); ++i) {
    const uint32_t a = out.triangles[i], b = out.triangles[i % 3 == 2 ? i - 2 : i + 1];
    const double edge = length(out.positions[a] - out.positions[b]);
    neighbors[a].push_back({b, edge});
    neighbors[b].push_back({a, edge});
  }
  struct Step {
    double way;
    uint32_t vertex, bone;
    bool operator<(const Step& o) const { return way > o.way; }
  };
  std::priority_queue<Step> steps;
  std::vector<double> depth(count);
  for (uint32_t j = 0; j < count; ++j) {
    uint32_t nearest = 0;
    for (uint32_t v = 1; v < n; ++v) {
      if (length(out.positions[v] - means[j]) < length(out.positions[nearest] - means[j])) {
        nearest = v;
      }
    }
    depth[j] = length(out.positions[nearest] - means[j]);
    steps.push({0, nearest, j});
  }
  const size_t m = influences;
  std::vector<std::vector<std::pair<double, uint32_t>>> found(n);
  while (!steps.empty()) {
    const Step s = steps.top();
    steps.pop();
    auto& here = found[s.vertex];
    const auto same = [&](const std::pair<double, uint32_t>& f) { return f.second == s.bone; };
    if (here.size() > m || std::any_of(here.begin(), here.end(), same)) continue;
    here.push_back({s.way, s.bone});
    for (const auto& [v, edge] : neighbors[s.vertex]) {
      if (found[v].size() <= m) steps.push({s.way + edge, v, s.bone});
    }
  }
  out.joints.assign(n * m, 0);
  out.weight_values.assign(n * m, 0);
  for (size_t v = 0; v < n; ++v) {
    auto& here = found[v];
    for (auto& [way, bone] : here) way = std::max(1e-6, std::hypot(way, depth[bone]));
    std::sort(here.begin(), here.end());
    const double radius = here.size() > m ? here[m].first * 1.0001 : 1e9;
    const size_t used = std::min(m, here.size());
    double sum = 0;
    std::vector<double> w(used);
    for (size_t i = 0; i < used; ++i) {
      const double x = (radius - here[i].first) / (radius * here[i].first);
      w[i] = x * x;
      sum += w[i];
    }
    if (used == 0) {
      out.joints[v * m] = 2;  // head
      out.weight_values[v * m] = 1;
    }
    for (size_t i = 0; i < used; ++i) {
      out.joints[v * m + i] = static_cast<uint16_t>(4 + here[i].second);
      out.weight_values[v * m + i] = static_cast<float>(w[i] / sum);
    }
  }
  out.finish(influences);
}

}  // namespace mien::author
