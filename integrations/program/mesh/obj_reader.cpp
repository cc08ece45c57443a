// SPDX-License-Identifier: MIT
// OBJ: positions, UVs, faces, objects and groups. Normals, lines, points and materials are skipped;
// curves are refused.
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/text.h"
#include "integrations/program/mesh/mesh_file.h"

namespace mien::cli {

namespace {

constexpr size_t kMaxPositions = size_t{1} << 26;
constexpr size_t kMaxFaceCorners = 65535;
constexpr size_t kMaxNameBytes = 255;  // an object's comes back with each of its groups

/// Goes through a file line by line, words separated by blanks. A backslash at the end continues a line.
class Lines {
 public:
  Lines(const std::string& bytes, const std::string& path) : bytes_(bytes), path_(path) {}

  bool next() {
    if (at_ >= bytes_.size()) return false;
    ++number_;
    line_.clear();
    for (;;) {
      size_t end = bytes_.find('\n', at_);
      const bool last = end == std::string::npos;
      if (last) end = bytes_.size();
      std::string_view part(bytes_.data() + at_, end - at_);
      at_ = last ? bytes_.size() : end + 1;
      if (!part.empty() && part.back() == '\r') part.remove_suffix(1);
      const bool goes_on = !part.empty() && part.back() == '\\' && !last;
      if (goes_on) part.remove_suffix(1);
      if (line_.size() + part.size() > kLongest) fail("the line is longer than a megabyte");
      line_.append(part);
      if (!goes_on) break;
      line_ += ' ';
      ++number_;
    }
    const size_t comment = line_.find('#');
    if (comment != std::string::npos) line_.resize(comment);
    rest_ = line_;
    return true;
  }

  /// Empty at the end of the line.
  std::string_view word() {
    const size_t from = rest_.find_first_not_of(" \t");
    if (from == std::string_view::npos) return rest_ = {};
    const size_t to = rest_.find_first_of(" \t", from);
    const std::string_view found = rest_.substr(from, to - from);
    rest_ = to == std::string_view::npos ? std::string_view() : rest_.substr(to);
    return found;
  }

  /// The rest of the line without blanks around it.
  std::string name() const {
    const size_t from = rest_.find_first_not_of(" \t");
    if (from == std::string_view::npos) return "";
    return std::string(rest_.substr(from, rest_.find_last_not_of(" \t") + 1 - from));
  }

  double number(const char* what) {
    const std::string_view text = word();
    if (text.empty()) fail(std::string(what) + " lacks a number");
    double value = 0;
    const char* from = text.data() + (text[0] == '+' ? 1 : 0);
    const auto read = std::from_chars(from, text.data() + text.size(), value);
    if (read.ec == std::errc::result_out_of_range && read.ptr == text.data() + text.size()) {
      value = std::strtod(std::string(text).c_str(), nullptr);  // underflow is 0, overflow infinite
    } else if (read.ec != std::errc() || read.ptr != text.data() + text.size()) {
      fail("\"" + one_line(text.substr(0, 40)) + "\" is not a number");
    }
    if (!std::isfinite(value)) fail("\"" + one_line(text.substr(0, 40)) + "\" is not finite");
    return value;
  }

  [[noreturn]] void fail(const std::string& why) const {
    fail_mesh(path_, "line " + std::to_string(number_), why, "export the mesh again");
  }

 private:
  static constexpr size_t kLongest = size_t{1} << 20;

  const std::string& bytes_;
  const std::string& path_;
  size_t at_ = 0, number_ = 0;
  std::string line_;
  std::string_view rest_;
};

/// A number of a position or UV, from 1 or from the end; -1 if there is none.
int64_t read_index(std::string_view text, size_t count, const char* what, const Lines& lines) {
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
};

}  // namespace

MeshFile read_obj(const std::string& bytes, const std::string& path) {
  MeshFile mesh;
  Lines lines(bytes, path);
  // An object may come back after others.
  std::vector<std::string> names;
  std::vector<Faces> objects;
  std::map<std::string, size_t> numbers;
  std::string object, group;
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
  for (size_t o = 0; o < objects.size(); ++o) {
    const Faces& faces = objects[o];
    if (faces.sizes.empty()) continue;
    mesh.objects.push_back({names[o], static_cast<uint32_t>(mesh.face_sizes.size()),
                            static_cast<uint32_t>(faces.sizes.size())});
    mesh.face_sizes.insert(mesh.face_sizes.end(), faces.sizes.begin(), faces.sizes.end());
    mesh.corners.insert(mesh.corners.end(), faces.corners.begin(), faces.corners.end());
    for (const int64_t uv : faces.uvs) {
      all_have_uvs = all_have_uvs && uv >= 0;
      mesh.corner_uvs.push_back(static_cast<uint32_t>(uv < 0 ? 0 : uv));
    }
  }
  if (!all_have_uvs) {
    mesh.corner_uvs.clear();
    mesh.uvs.clear();
  }
  return mesh;
}

MeshShape read_target(const std::string& bytes, size_t position_count, const std::string& path) {
  MeshShape shape;
  Lines lines(bytes, path);
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
