// SPDX-License-Identifier: MIT
// Any bytes as a mesh: read as OBJ, GLB, .target or .mshp, rigged if it is small, and the rig compiled,
// evaluated and deformed. An input is two bytes of options and a file; shapes are for a mesh made here.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "capi/include/mien_author.h"
#include "integrations/program/commands/mesh_view.h"
#include "integrations/program/io/failure.h"
#include "integrations/program/io/input.h"
#include "integrations/program/mesh/glb_motion.h"
#include "tests/fuzz/time_limit.h"
#include "tests/support/bytes.h"
#include "tests/support/counting_allocator.h"
#include "tests/support/cpu_time.h"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t max_size);

// Files are not read here.
std::string mien::cli::read_mesh_bytes(const std::string&, const std::string&) { return {}; }
std::string mien::cli::read_json(const std::string&, const std::string&) { return {}; }
bool mien::cli::is_stream(const std::string&) { return false; }

namespace {

using namespace mien;
using cli::MeshFile;
using cli::MeshShape;
using Random = std::minstd_rand;

constexpr uint32_t kRows = 9, kColumns = 10;
constexpr size_t kLargestMesh = 400, kMaxDisplacements = 20000;  // of what is rigged
constexpr size_t kMaxMemory = size_t{64} << 20;                  // for that

void require(bool holds, const char* promise) {
  if (holds) return;
  fprintf(stderr, "broken: %s\n", promise);
  abort();
}

/// An egg with a nose, as text.
std::string small_obj() {
  std::string text = "# small\no skin\n";
  char line[96];
  for (uint32_t r = 0; r < kRows; ++r) {
    const double v = 3.14159 * (r + 0.4) / (kRows - 0.2);
    for (uint32_t c = 0; c < kColumns; ++c) {
      const double u = 2 * 3.14159265 * c / kColumns;
      const double nose = c == 0 && r == 5 ? 2 : 0;
      snprintf(line, sizeof(line), "v %.3f %.3f %.3f\n", 7 * sin(v) * sin(u), 10 * cos(v),
               8 * sin(v) * cos(u) + nose);
      text += line;
    }
  }
  text += "vt 0 0\nvt 1 0.5\n";
  for (uint32_t r = 0; r + 1 < kRows; ++r) {
    if (r == 6) text += "o rest\n";
    for (uint32_t c = 0; c < kColumns; ++c) {
      const uint32_t a = r * kColumns + c + 1, b = r * kColumns + (c + 1) % kColumns + 1;
      snprintf(line, sizeof(line), "f %u/1 %u/2 %u/1 %u/2\n", a, a + kColumns, b + kColumns, b);
      text += line;
    }
  }
  return text;
}

const MeshFile& small_mesh() {
  static const MeshFile mesh = cli::read_obj(small_obj(), "small.obj");
  return mesh;
}

void put(std::string& out, const void* bytes, size_t size) {
  out.append(static_cast<const char*>(bytes), size);
}

std::string small_glb() {
  const MeshFile& mesh = small_mesh();
  std::string data;
  for (const double p : mesh.positions) {
    const auto single = static_cast<float>(p / 100);
    put(data, &single, 4);
  }
  const size_t points = data.size();
  for (size_t f = 0; f < mesh.face_sizes.size(); ++f) {
    for (const size_t k : {0, 1, 2, 0, 2, 3}) {
      const auto corner = static_cast<uint16_t>(mesh.corners[4 * f + k]);
      put(data, &corner, 2);
    }
  }
  const size_t corners = data.size() - points;
  const uint16_t moving[] = {50, 51};
  const float moved[] = {0, 0.01f, 0.01f, 0.01f, 0, 0};
  const size_t sparse = data.size();
  put(data, moving, 4);
  put(data, moved, 24);
  nlohmann::json root = {
      {"asset", {{"version", "2.0"}}},
      {"scene", 0},
      {"scenes", {{{"nodes", {0}}}}},
      {"nodes", {{{"mesh", 0}, {"translation", {0, 0.1, 0}}}}},
      {"buffers", {{{"byteLength", data.size()}}}},
      {"bufferViews",
       {{{"buffer", 0}, {"byteLength", points}},
        {{"buffer", 0}, {"byteOffset", points}, {"byteLength", corners}},
        {{"buffer", 0}, {"byteOffset", sparse}, {"byteLength", 4}},
        {{"buffer", 0}, {"byteOffset", sparse + 4}, {"byteLength", 24}}}},
      {"accessors",
       {{{"bufferView", 0}, {"componentType", 5126}, {"count", points / 12}, {"type", "VEC3"}},
        {{"bufferView", 1}, {"componentType", 5123}, {"count", corners / 2}, {"type", "SCALAR"}},
        {{"componentType", 5126},
         {"count", points / 12},
         {"type", "VEC3"},
         {"sparse",
          {{"count", 2},
           {"indices", {{"bufferView", 2}, {"componentType", 5123}}},
           {"values", {{"bufferView", 3}}}}}}}},
      {"meshes",
       {{{"name", "face"},
         {"extras", {{"targetNames", {"smile"}}}},
         {"primitives",
          {{{"attributes", {{"POSITION", 0}}},
            {"indices", 1},
            {"targets", {{{"POSITION", 2}}}}}}}}}}};
  std::string text = root.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  data.resize((data.size() + 3) / 4 * 4);
  const uint32_t head[] = {2, static_cast<uint32_t>(28 + text.size() + data.size()),
                           static_cast<uint32_t>(text.size()), 0x4E4F534A};
  const uint32_t binary[] = {static_cast<uint32_t>(data.size()), 0x004E4942};
  std::string glb = "glTF";
  put(glb, head, sizeof(head));
  glb += text;
  put(glb, binary, sizeof(binary));
  return glb + data;
}

std::string small_mshp() {
  const uint32_t head[] = {1, kRows * kColumns, 2, 2};
  std::string bytes = "MSHP";
  put(bytes, head, sizeof(head));
  for (const char* name : {"jawOpen", "smile"}) {
    const float scale = 1e-3f;
    const uint32_t count = 3;
    const uint16_t moving[] = {60, 61, 62};
    const int16_t moved[] = {0, -900, 0, 0, -800, 300, 200, -700, 0};
    bytes += static_cast<char>(strlen(name));
    bytes += name;
    put(bytes, &scale, 4);
    put(bytes, &count, 4);
    put(bytes, moving, sizeof(moving));
    put(bytes, moved, sizeof(moved));
  }
  return bytes;
}

const std::vector<std::string>& seeds() {
  static const std::vector<std::string> files = {small_obj(), small_glb(), small_mshp(),
                                                 "#t\n60 0 -0.9 0.1\n61 0 -0.8 0\n12 0.5 0 0\n"};
  return files;
}

bool begins(const std::string& bytes, const char* with) {
  return bytes.compare(0, strlen(with), with) == 0;
}

MeshFile read_any(const std::string& bytes) {
  if (begins(bytes, "glTF")) {
    // The animation of any bytes fails as their meshes do.
    try {
      const cli::GlbMotion motion = cli::read_glb_motion(bytes, "input");
      cli::sample_motion(motion, motion.times.back() / 2);
    } catch (const cli::Failure&) {
    }
    return cli::read_glb(bytes, "input");
  }
  if (!begins(bytes, "MSHP") && !begins(bytes, "#t")) return cli::read_obj(bytes, "input");
  MeshFile mesh = small_mesh();
  if (begins(bytes, "MSHP")) {
    mesh.shapes = cli::read_mshp(bytes, mesh.position_count(), "input");
  } else {
    mesh.shapes = {cli::read_target(bytes, mesh.position_count(), "input")};
    mesh.shapes[0].name = "target";
    // As `mien author` does: no list at all would stand for all positions.
    if (mesh.shapes[0].vertices.empty()) mesh.shapes[0] = {"target", {0}, {0, 0, 0}};
  }
  return mesh;
}

bool is_small(const MeshFile& file) {
  size_t displacements = 0;
  for (const MeshShape& shape : file.shapes) displacements += shape.displacements.size();
  return file.position_count() <= kLargestMesh && file.corners.size() <= 8 * kLargestMesh &&
         displacements <= kMaxDisplacements && file.shapes.size() <= 60;
}

/// All controls at 1, every LOD: numbers have to stay finite.
void exercise(const MienDna* dna) {
  MienRig* rig = nullptr;
  MienDeformer* deformer = nullptr;
  MienInstance* face = nullptr;
  MienDeformerInstance* pose = nullptr;
  require(mien_rig_create(dna, nullptr, &rig, nullptr) == MIEN_OK, "the rig compiles");
  require(mien_deformer_create(dna, rig, nullptr, &deformer, nullptr) == MIEN_OK, "meshes compile");
  require(mien_instance_create(rig, nullptr, &face, nullptr) == MIEN_OK, "an instance");
  require(mien_deformer_instance_create(deformer, nullptr, &pose, nullptr) == MIEN_OK, "a pose");
  MienMutableFloatView controls;
  require(mien_instance_raw_controls(face, &controls) == MIEN_OK, "controls");
  for (size_t i = 0; i < controls.count; ++i) controls.data[i] = 1;
  MienRigInfo info = {};
  info.struct_size = sizeof(info);
  require(mien_rig_info(rig, &info) == MIEN_OK, "info");
  for (uint32_t lod = 0; lod < info.lod_count; ++lod) {
    require(mien_rig_evaluate(rig, face, lod) == MIEN_OK, "evaluation");
    MienFloatView joints;
    require(mien_instance_joints(face, &joints) == MIEN_OK, "joints");
    for (size_t i = 0; i < joints.count; ++i)
      require(std::isfinite(joints.data[i]), "joint values");
    require(mien_deformer_instance_update(pose, face) == MIEN_OK, "matrices");
    MienIndex16View meshes;
    require(mien_rig_lod_indices(rig, MIEN_KIND_MESH, lod, &meshes) == MIEN_OK, "meshes");
    for (size_t m = 0; m < meshes.count; ++m) {
      MienFloatView positions;
      const uint32_t mesh = meshes.data[m];
      require(mien_deformer_instance_deform(pose, mesh, MIEN_NORMALS_DEFAULT, nullptr) == MIEN_OK,
              "deformation");
      require(mien_deformer_instance_positions(pose, mesh, &positions) == MIEN_OK, "positions");
      for (size_t i = 0; i < positions.count; ++i) {
        require(std::isfinite(positions.data[i]), "finite positions");
      }
    }
  }
  mien_deformer_instance_destroy(pose);
  mien_instance_destroy(face);
  mien_deformer_destroy(deformer);
  mien_rig_destroy(rig);
}

void rig_mesh(const MeshFile& file, uint8_t options, uint8_t more) {
  const cli::MeshView view(file);
  CountingAllocator heap;
  heap.limit = kMaxMemory;
  if (options >= 240) heap.fail_at = 1 + size_t{more} * 3;
  const MienAllocator allocator = heap.get();
  MienAuthorDesc desc = mien_author_desc_default();
  desc.facial_joints = 1 + more % 16;
  desc.lods = 1 + (more >> 4) % 3;
  desc.influences = 1 + (more >> 6) * 3;
  desc.groups = options & 1 ? 2 : 0;
  desc.symmetry = (options >> 1) % 3;
  desc.flags = (options >> 3) % 32;
  desc.allocator = &allocator;
  std::vector<MienAuthorLod> lods;
  if (options % 3 == 1) {
    const size_t corners = view.mesh.corner_count;
    for (uint32_t l = 1; l < desc.lods; ++l) {
      MienAuthorLod lod = {};
      const size_t first = std::min<size_t>(corners, more % 5 * l);
      lod.corners = view.mesh.corners + first;
      lod.corner_count = (corners - first) / 3 / l * 3;
      if (options & 4 && view.mesh.corner_uvs) lod.corner_uvs = view.mesh.corner_uvs + first;
      lods.push_back(lod);
    }
    desc.lod_meshes = lods.data();
    desc.lod_mesh_count = lods.size();
  }
  MienDna* dna = nullptr;
  MienAuthorReport* report = nullptr;
  MienError error = mien_error_default();
  const MienStatus status = mien_author_rig(&view.mesh, &desc, &dna, &report, &error);
  if (status == MIEN_OK) {
    MienStringView json;
    require(mien_author_report_json(report, &json) == MIEN_OK, "a report");
    require(nlohmann::json::accept(json.data, json.data + json.count), "JSON");
    exercise(dna);
    mien_author_report_close(report);
    mien_dna_close(dna);
  } else {
    require(error.message[0] != 0 && !dna && !report, "an error says why");
    const bool told = status == MIEN_ERROR_MEMORY && heap.fail_at != 0 && heap.over_limit == 0;
    require(status == MIEN_ERROR_AUTHOR_MESH || status == MIEN_ERROR_AUTHOR_REFUSED || told,
            error.message);
  }
  require(heap.clean(), "all memory comes back");
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***);
extern "C" int LLVMFuzzerInitialize(int*, char***) { return 0; }

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size,
                                          unsigned int seed) {
  Random random(seed);
  if (size < 8 || random() % 200 == 0) {
    const std::string& file = seeds()[random() % seeds().size()];
    if (file.size() + 2 > max_size) return size;
    data[0] = static_cast<uint8_t>(random());
    data[1] = static_cast<uint8_t>(random());
    memcpy(data + 2, file.data(), file.size());
    return file.size() + 2;
  }
  static const char* const kWords[] = {"\nv ",
                                       "\nf ",
                                       "\no x\n",
                                       "\ng y\n",
                                       "1e999",
                                       "-1",
                                       "nan ",
                                       "/",
                                       "\nvt 0 0\n",
                                       "\\\n",
                                       "\nv 0 0 0\n",
                                       "1e38 ",
                                       "1e-320 ",
                                       "\nf 1 2 3\n",
                                       "\nf -1 -2 -3\n",
                                       "\"count\":",
                                       "\"byteOffset\":",
                                       "\"sparse\":{",
                                       "4294967295",
                                       "\"mesh\":0",
                                       "\"normalized\":true",
                                       "\"matrix\":[",
                                       "5123"};
  if (random() % 3 == 0) {
    const char* word = kWords[random() % std::size(kWords)];
    const size_t length = strlen(word), at = 2 + random() % (size - 2);
    if (size + length > max_size) return size;
    memmove(data + at + length, data + at, size - at);
    memcpy(data + at, word, length);
    size += length;
  } else if (random() % 3 == 0) {
    // A line is there again, or another one's place.
    const size_t from = 2 + random() % (size - 2), to = 2 + random() % (size - 2);
    const size_t length = std::min({size_t{1} + random() % 40, size - from, size - to});
    memmove(data + to, data + from, length);
  } else {
    size = 2 + LLVMFuzzerMutate(data + 2, size - 2, max_size - 2);
  }
  // The JSON of a GLB ends where its bytes do.
  if (size > 30 && memcmp(data + 2, "glTF", 4) == 0) {
    for (size_t at = 22; at + 8 <= size; ++at) {
      if (memcmp(data + at + 4, "BIN", 4) != 0) continue;
      const auto text = static_cast<uint32_t>(at - 22), rest = static_cast<uint32_t>(size - at - 8);
      memcpy(data + 14, &text, 4);
      if (random() % 8 != 0) memcpy(data + at, &rest, 4);
      break;
    }
  }
  return size;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size < 2) return 0;
  const double start = cpu_seconds();
  std::string broken;
  const auto seconds = [&] { return cpu_seconds() - start; };
  const std::string bytes(reinterpret_cast<const char*>(data + 2), size - 2);
  try {
    const MeshFile mesh = read_any(bytes);
    check_time(seconds(), size, broken);
    if (is_small(mesh)) rig_mesh(mesh, data[0], data[1]);
  } catch (const cli::Failure& failure) {
    require(failure.exit_code == cli::kInvalid && strlen(failure.what()) > 20, "an error says why");
    require(!strchr(failure.what(), '\n'), "an error is a line");
  }
  check_time(seconds() / 5, size, broken);  // half a second for a rig
  require(broken.empty(), broken.c_str());
  return 0;
}
