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
#include <sstream>

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

bool load_mediapipe(AuthorSetup& out) {
  Obj obj;
  if (!read_obj(real_mesh_folder() + "/mediapipe/canonical_face_model.obj", obj)) return false;
  take(
      obj, 1, [](size_t) { return true; }, out);
  return true;
}

}  // namespace mien::author
