// SPDX-License-Identifier: MIT
#include "integrations/program/mesh/mesh_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <set>
#include <sstream>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/input.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace fs = std::filesystem;

namespace {

// Every shape takes memory for all positions, whatever it moves.
constexpr uint32_t kMaxShapes = 4096;

std::string lower_extension(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return extension;
}

bool begins(const std::string& bytes, const char* magic) { return bytes.compare(0, 4, magic) == 0; }

/// The difference of two meshes; exact zeros where the numbers are the same.
MeshShape difference(const MeshFile& posed, const MeshFile& mesh, const std::string& path) {
  if (posed.positions.size() != mesh.positions.size()) {
    fail_mesh(path, "",
              std::to_string(posed.position_count()) + " positions, but the mesh has " +
                  std::to_string(mesh.position_count()),
              "export both from the same topology, with all vertices in the same order");
  }
  MeshShape shape;
  for (size_t v = 0; v < mesh.position_count(); ++v) {
    double d[3];
    bool moves = false;
    for (size_t i = 0; i < 3; ++i) {
      d[i] = posed.positions[3 * v + i] - mesh.positions[3 * v + i];
      moves = moves || d[i] != 0;
    }
    if (!moves) continue;
    shape.vertices.push_back(static_cast<uint32_t>(v));
    shape.displacements.insert(shape.displacements.end(), d, d + 3);
  }
  return shape;
}

/// A sparse shape without vertices moves none; the library takes an empty list as "all".
void settle(MeshShape& shape) {
  if (!shape.vertices.empty()) return;
  shape.vertices = {0};
  shape.displacements = {0, 0, 0};
}

std::vector<MeshShape> read_folder(const std::string& path, const MeshFile& mesh) {
  std::vector<fs::path> files;
  std::error_code reason;
  for (fs::directory_iterator it(path, reason), end; !reason && it != end; it.increment(reason)) {
    const std::string extension = lower_extension(it->path().string());
    if (extension == ".obj" || extension == ".target") files.push_back(it->path());
  }
  if (reason) {
    fail(kFile, "cannot read", path, reason.message(), "check the path and its permissions");
  }
  if (files.empty()) {
    fail_mesh(path, "", "the folder has no .obj and no .target files",
              "name a folder with one file for each expression");
  }
  // The order of a folder is that of the file system; names are the same everywhere.
  std::sort(files.begin(), files.end());
  std::vector<MeshShape> shapes;
  std::set<std::string> names;
  for (const fs::path& file : files) {
    const std::string bytes = read_mesh_bytes(file.string(), "cannot read shape");
    MeshShape shape = lower_extension(file.string()) == ".target"
                          ? read_target(bytes, mesh.position_count(), file.string())
                          : difference(read_obj(bytes, file.string()), mesh, file.string());
    shape.name = file.stem().string();
    if (!names.insert(shape.name).second) {
      fail_mesh(path, "", "two files are named " + one_line(shape.name), "rename one of them");
    }
    settle(shape);
    shapes.push_back(std::move(shape));
  }
  return shapes;
}

}  // namespace

void fail_mesh(const std::string& path, const std::string& where, const std::string& why,
               const std::string& what_to_do) {
  fail(kInvalid, "invalid mesh", where.empty() ? path : path + ", " + where, why, what_to_do);
}

std::vector<MeshShape> read_mshp(const std::string& bytes, size_t position_count,
                                 const std::string& path) {
  size_t at = 0;
  const auto take = [&](size_t size) {
    if (size > bytes.size() - at) {
      fail_mesh(path, "byte " + std::to_string(at),
                "truncated: " + std::to_string(size) + " bytes are missing or cut",
                "get the file again");
    }
    const char* from = bytes.data() + at;
    at += size;
    return reinterpret_cast<const unsigned char*>(from);
  };
  const auto number = [&](size_t size) {
    const unsigned char* from = take(size);
    uint32_t value = 0;
    for (size_t i = 0; i < size; ++i) value |= uint32_t{from[i]} << (8 * i);
    return value;
  };
  take(4);
  const uint32_t version = number(4), vertices = number(4), count = number(4), width = number(4);
  if (version != 1 || (width != 2 && width != 4)) {
    fail_mesh(path, "byte 4",
              "version " + std::to_string(version) + " with indices of " + std::to_string(width) +
                  " bytes: version 1 with 2 or 4 is supported",
              "write the file again");
  }
  if (vertices != position_count) {
    fail_mesh(path, "byte 8",
              "made for " + std::to_string(vertices) + " positions, but the mesh has " +
                  std::to_string(position_count),
              "use the mesh that it was made for");
  }
  if (count > kMaxShapes) {
    fail_mesh(path, "byte 12",
              std::to_string(count) + " shapes, more than " + std::to_string(kMaxShapes),
              "split them into several files");
  }
  std::vector<MeshShape> shapes;
  std::set<std::string> names;
  for (uint32_t s = 0; s < count; ++s) {
    MeshShape shape;
    const uint32_t length = number(1);
    shape.name.assign(reinterpret_cast<const char*>(take(length)), length);
    if (shape.name.empty() || !names.insert(shape.name).second) {
      fail_mesh(path, "byte " + std::to_string(at),
                "the name of shape " + std::to_string(s) + " is empty or occurs twice",
                "write the file again");
    }
    const uint32_t scale_bits = number(4), moved = number(4);
    float scale;
    memcpy(&scale, &scale_bits, sizeof(scale));
    if (!std::isfinite(scale)) {
      fail_mesh(path, "byte " + std::to_string(at), "the scale of a shape is not finite",
                "write the file again");
    }
    if (size_t{moved} * (width + 6) > bytes.size() - at) take(size_t{moved} * (width + 6));
    for (uint32_t i = 0; i < moved; ++i) {
      shape.vertices.push_back(number(width));
      if (shape.vertices.back() >= position_count) {
        fail_mesh(path, "byte " + std::to_string(at),
                  "there is no position " + std::to_string(shape.vertices.back()),
                  "write the file again");
      }
    }
    for (uint32_t i = 0; i < 3 * moved; ++i) {
      const uint32_t bits = number(2);
      const int value = bits < 0x8000 ? static_cast<int>(bits) : static_cast<int>(bits) - 0x10000;
      shape.displacements.push_back(double{scale} * value);
    }
    settle(shape);
    shapes.push_back(std::move(shape));
  }
  return shapes;
}

namespace {

/// The files of an OBJ's mtllib lines. A name may have spaces, and a line several names.
void read_libraries(const std::string& path, MeshFile& mesh) {
  const fs::path folder = path == "-" ? fs::path() : fs::path(path).parent_path();
  const auto add = [&](const std::string& name) {
    std::error_code ignored;
    const fs::path library = folder / name;
    if (name.empty() || !fs::is_regular_file(library, ignored)) return false;
    read_mtl(read_mesh_bytes(library.string(), "cannot read materials"), library.string(), mesh);
    return true;
  };
  for (const std::string& line : mesh.material_libraries) {
    if (add(line)) continue;
    std::istringstream words(line);
    std::string word;
    bool any = false;
    while (words >> word) {
      any = true;
      if (!add(word)) mesh.material_problems.push_back("there is no material library " + word);
    }
    if (!any) mesh.material_problems.push_back("a material library has no name");
  }
}

}  // namespace

MeshFile read_mesh_file(const std::string& path) {
  const std::string bytes = read_mesh_bytes(path, "cannot read mesh");
  MeshFile mesh = begins(bytes, "glTF") ? read_glb(bytes, path) : read_obj(bytes, path);
  read_libraries(path, mesh);
  if (mesh.face_sizes.empty()) {
    fail_mesh(path, "", "there are no faces in it", "name an OBJ or GLB file with a surface");
  }
  return mesh;
}

std::vector<MeshShape> read_shapes(const std::string& path, const MeshFile& mesh) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) return read_folder(path, mesh);
  const std::string bytes = read_mesh_bytes(path, "cannot read shapes");
  if (begins(bytes, "MSHP")) return read_mshp(bytes, mesh.position_count(), path);
  if (!begins(bytes, "glTF")) {
    fail_mesh(path, "", "neither a folder nor an .mshp or GLB file",
              "name a folder of .obj or .target files, an .mshp or a GLB");
  }
  MeshFile other = read_glb(bytes, path);
  if (other.positions.size() != mesh.positions.size()) {
    fail_mesh(path, "",
              std::to_string(other.position_count()) + " positions, but the mesh has " +
                  std::to_string(mesh.position_count()),
              "use the GLB as the mesh, too");
  }
  if (other.shapes.empty()) fail_mesh(path, "", "no morph targets in it", "export it with them");
  return std::move(other.shapes);
}

double find_incoherence(const MeshFile& mesh, const MeshShape& shape) {
  std::vector<double> moved(mesh.positions.size());
  for (size_t i = 0; i < shape.displacements.size() / 3; ++i) {
    const size_t v = shape.vertices.empty() ? i : shape.vertices[i];
    std::copy_n(&shape.displacements[3 * i], 3, &moved[3 * v]);
  }
  double apart = 0, all = 0;
  size_t first = 0, edges = 0;
  for (const uint32_t size : mesh.face_sizes) {
    for (size_t k = 0; k < size; ++k) {
      const double* a = &moved[3 * size_t{mesh.corners[first + k]}];
      const double* b = &moved[3 * size_t{mesh.corners[first + (k + 1) % size]}];
      const double before = all;
      for (int i = 0; i < 3; ++i) {
        apart += (a[i] - b[i]) * (a[i] - b[i]);
        all += a[i] * a[i] + b[i] * b[i];
      }
      edges += all > before;
    }
    first += size;
  }
  constexpr size_t kFew = 200;  // what moves a few places has a border all around
  return edges > kFew ? apart / all : 0;
}

}  // namespace mien::cli
