// SPDX-License-Identifier: MIT
// OBJ: positions, UVs, faces, objects, groups and names of materials. Normals, lines and points are skipped;
// curves are refused.
#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "integrations/program/io/obj_space.h"
#include "integrations/program/mesh/text_lines.h"

namespace mien::cli {

namespace {

constexpr size_t kMaxPositions = size_t{1} << 26;
constexpr size_t kMaxFaceCorners = 65535;
constexpr size_t kMaxLibraries = 64;

/// A number of a position or UV, from 1 or from the end; -1 if there is none.
int64_t read_index(std::string_view text, size_t count, const char* what, const TextLines& lines) {
  if (text.empty()) return -1;
  int64_t index = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), index);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size() || index == 0) {
    lines.fail("\"" + one_line(text.substr(0, 40)) + "\" is not the number of a " + what);
  }
  const int64_t size = static_cast<int64_t>(count);
  if (index > size || index < -size) {
    lines.fail(std::string("there is no ") + what + " " + std::to_string(index) + ": " +
               std::to_string(count) + " are given above");
  }
  return index > 0 ? index - 1 : size + index;
}

/// Faces of one object, in the order of the file.
struct Faces {
  std::vector<uint32_t> sizes, corners;
  std::vector<int64_t> uvs;
  std::vector<uint32_t> materials;  // of each face
};

/// Which materials of an object belong together: those whose faces share positions, directly or through others. For
/// each one the number of the first of its group.
std::map<uint32_t, uint32_t> material_groups(const Faces& faces) {
  std::map<uint32_t, uint32_t> above;
  const auto first_of = [&](uint32_t material) {
    while (above[material] != material) material = above[material] = above[above[material]];
    return material;
  };
  for (const uint32_t material : faces.materials) above.emplace(material, material);
  if (above.size() > 1) {
    std::map<uint32_t, uint32_t> owners;  // of positions
    size_t corner = 0;
    for (size_t f = 0; f < faces.sizes.size(); ++f) {
      for (uint32_t k = 0; k < faces.sizes[f]; ++k) {
        const uint32_t owner =
            owners.emplace(faces.corners[corner++], faces.materials[f]).first->second;
        const uint32_t a = first_of(owner), b = first_of(faces.materials[f]);
        above[std::max(a, b)] = std::min(a, b);
      }
    }
  }
  for (auto& [material, first] : above) first = first_of(material);
  return above;
}

/// The material of the most faces, among those of a group.
uint32_t main_material(const Faces& faces, const std::map<uint32_t, uint32_t>& groups,
                       uint32_t group) {
  std::map<uint32_t, size_t> counts;
  for (const uint32_t material : faces.materials) {
    if (groups.at(material) == group) ++counts[material];
  }
  const auto fewer = [](const auto& a, const auto& b) { return a.second < b.second; };
  return std::max_element(counts.begin(), counts.end(), fewer)->first;
}

/// Puts the faces of an object behind the others. Each group of materials that no position connects is an object of
/// its own.
void add_object(const std::string& name, const Faces& faces, std::set<std::string>& taken,
                bool& all_have_uvs, MeshFile& mesh) {
  const std::map<uint32_t, uint32_t> groups = material_groups(faces);
  std::set<uint32_t> firsts;
  for (const auto& entry : groups) firsts.insert(entry.second);
  for (const uint32_t group : firsts) {
    MeshObject object = {name, static_cast<uint32_t>(mesh.face_sizes.size()), 0,
                         main_material(faces, groups, group)};
    if (firsts.size() > 1 && object.material != kNoMaterial) {
      object.name += "." + mesh.materials[object.material].surface.name;
    }
    while (!taken.insert(object.name).second) object.name += "_";
    size_t corner = 0;
    for (size_t f = 0; f < faces.sizes.size(); ++f) {
      const size_t end = corner + faces.sizes[f];
      if (groups.at(faces.materials[f]) != group) {
        corner = end;
        continue;
      }
      mesh.face_sizes.push_back(faces.sizes[f]);
      ++object.face_count;
      if (faces.materials[f] != object.material) {
        mesh.lost_materials.insert(mesh.material_name(faces.materials[f]));
      }
      for (; corner < end; ++corner) {
        const int64_t uv = faces.uvs[corner];
        mesh.corners.push_back(faces.corners[corner]);
        all_have_uvs = all_have_uvs && uv >= 0;
        mesh.corner_uvs.push_back(static_cast<uint32_t>(uv < 0 ? 0 : uv));
      }
    }
    mesh.objects.push_back(object);
  }
}

}  // namespace

MeshFile read_obj(const std::string& bytes, const std::string& path) {
  MeshFile mesh;
  TextLines lines(bytes, path);
  mesh.in_meters = bytes.compare(0, sizeof(kObjInMeters) - 1, kObjInMeters) == 0;
  // An object may come back after others.
  std::vector<std::string> names;
  std::vector<Faces> objects;
  std::map<std::string, size_t> numbers;
  std::string object, group;
  std::map<std::string, uint32_t> material_numbers;
  uint32_t material = kNoMaterial;
  size_t current = std::numeric_limits<size_t>::max();
  const auto enter = [&] {
    std::string name = !object.empty() && !group.empty() && object != group ? object + "." + group
                       : object.empty()                                     ? group
                                                                            : object;
    if (name.empty()) name = "head";
    const auto [it, added] = numbers.emplace(name, names.size());
    if (added) {
      names.push_back(name);
      objects.emplace_back();
    }
    current = it->second;
  };
  while (lines.next()) {
    const std::string_view keyword = lines.word();
    if (keyword == "v") {
      if (mesh.position_count() == kMaxPositions) lines.fail("more than 2^26 positions");
      for (int i = 0; i < 3; ++i) mesh.positions.push_back(lines.number("a position"));
    } else if (keyword == "vt") {
      mesh.uvs.push_back(lines.number("a UV"));
      const bool flat = lines.name().empty();
      mesh.uvs.push_back(flat ? 0 : lines.number("a UV"));
    } else if (keyword == "f") {
      if (current == std::numeric_limits<size_t>::max()) enter();
      Faces& faces = objects[current];
      uint32_t size = 0;
      for (std::string_view word = lines.word(); !word.empty(); word = lines.word()) {
        if (++size > kMaxFaceCorners) lines.fail("the face has more than 65535 corners");
        const size_t slash = word.find('/');
        const std::string_view position = word.substr(0, slash);
        std::string_view uv;
        if (slash != std::string_view::npos) {
          uv = word.substr(slash + 1);
          uv = uv.substr(0, uv.find('/'));
        }
        const int64_t vertex = read_index(position, mesh.position_count(), "position", lines);
        if (vertex < 0) lines.fail("a corner names no position");
        faces.corners.push_back(static_cast<uint32_t>(vertex));
        faces.uvs.push_back(read_index(uv, mesh.uvs.size() / 2, "UV", lines));
      }
      if (size < 3) {
        lines.fail("the face has " + std::to_string(size) + " corners: at least 3 are needed");
      }
      faces.sizes.push_back(size);
      faces.materials.push_back(material);
    } else if (keyword == "usemtl") {
      const std::string name = lines.name();
      if (name.size() > kMaxNameBytes) lines.fail("the name is longer than 255 bytes");
      const auto [it, added] =
          material_numbers.emplace(name, static_cast<uint32_t>(mesh.materials.size()));
      if (added && mesh.materials.size() == kMaxMeshMaterials) {
        lines.fail("more than " + std::to_string(kMaxMeshMaterials) + " materials");
      }
      if (added) {
        mesh.materials.emplace_back();
        mesh.materials.back().surface.name = name.empty() ? "material" : name;
      }
      material = it->second;
    } else if (keyword == "mtllib") {
      if (mesh.material_libraries.size() == kMaxLibraries)
        lines.fail("more than 64 lines of mtllib");
      mesh.material_libraries.push_back(lines.name());
    } else if (keyword == "o" || keyword == "g") {
      std::string& name = keyword == "o" ? object : group;
      name = lines.name();
      if (name.size() > kMaxNameBytes) lines.fail("the name is longer than 255 bytes");
      if (keyword == "o") group.clear();
      current = std::numeric_limits<size_t>::max();
    } else if (keyword == "curv" || keyword == "surf" || keyword == "cstype") {
      lines.fail("curves and surfaces are not supported");
    }
  }
  bool all_have_uvs = true;
  std::set<std::string> taken;
  for (size_t o = 0; o < objects.size(); ++o) {
    if (!objects[o].sizes.empty()) add_object(names[o], objects[o], taken, all_have_uvs, mesh);
  }
  if (!all_have_uvs) {
    mesh.corner_uvs.clear();
    mesh.uvs.clear();
  }
  return mesh;
}

MeshShape read_target(const std::string& bytes, size_t position_count, const std::string& path) {
  MeshShape shape;
  TextLines lines(bytes, path);
  while (lines.next()) {
    const std::string_view first = lines.word();
    if (first.empty()) continue;
    uint32_t index = 0;
    const auto read = std::from_chars(first.data(), first.data() + first.size(), index);
    if (read.ec != std::errc() || read.ptr != first.data() + first.size()) {
      lines.fail("\"" + one_line(first.substr(0, 40)) + "\" is not the number of a position");
    }
    if (index >= position_count) {
      lines.fail("there is no position " + std::to_string(index) + ": the mesh has " +
                 std::to_string(position_count));
    }
    shape.vertices.push_back(index);
    for (int i = 0; i < 3; ++i) shape.displacements.push_back(lines.number("a displacement"));
    if (!lines.word().empty()) lines.fail("more than an index and three numbers");
  }
  return shape;
}

}  // namespace mien::cli
