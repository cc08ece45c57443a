// SPDX-License-Identifier: MIT
// Packing: what is told of a mesh is what the file says, and what cannot be packed is refused with
// its place.
#include "runtime/load/compile/compile_deformer.h"

#include <cmath>

#include "tests/support/deform_rig.h"
#include "tests/support/tiny_rig.h"

namespace mien {
namespace {

using namespace dna;

/// The tiny rig, changed before it is written.
struct Changed {
  std::vector<uint8_t> bytes;
  DnaHandle dna;
  RigHandle rig;

  template <class Change>
  explicit Changed(Change&& change) {
    Arena arena(default_allocator());
    DnaView view = tiny_rig(arena);
    change(arena, view);
    bytes = write_view(view);
    dna = open_dna(bytes);
    rig = create_rig(dna.get());
  }
  Changed() : Changed([](Arena&, DnaView&) {}) {}

  void expect_refused(MienStatus status, const char* words, bool has_place) const {
    MienError error = sized<MienError>();
    MienDeformer* made = reinterpret_cast<MienDeformer*>(&error);
    EXPECT_EQ(mien_deformer_create(dna.get(), rig.get(), nullptr, &made, &error), status);
    EXPECT_EQ(made, nullptr);
    EXPECT_EQ(error.status, status);
    EXPECT_NE(strstr(error.message, words), nullptr) << error.message;
    EXPECT_EQ(error.byte_offset != MIEN_NO_OFFSET, has_place);
    EXPECT_TRUE(!has_place || error.byte_offset < bytes.size());
  }
};

// What is told ------------------------------------------------------------------------------------

std::vector<uint32_t> triangles_of(const Mesh& source) {
  std::vector<uint32_t> triangles;
  for (const Face& face : source.faces) {
    for (uint32_t i = 2; i < face.layout_indices.count; ++i) {
      for (uint32_t k : {0u, i - 1, i}) triangles.push_back(face.layout_indices[k]);
    }
  }
  return triangles;
}

TEST(CompileDeformer, TellsTheMeshAsTheFileHasIt) {
  DeformRigOptions options;
  options.rows = 30;
  options.columns = 40;  // three blocks
  for (uint32_t seed = 0; seed < 3; ++seed) {
    Deformed d(random_deform_rig(seed, options));
    for (uint32_t m = 0; m < options.meshes; ++m) {
      const Mesh& source = d.dna->view.geom.meshes[m];
      const MienMesh mesh = mesh_of(d.deformer.get(), m);
      ASSERT_EQ(mesh.position_count, source.positions.xs.count);
      ASSERT_EQ(mesh.vertex_count, source.layouts.positions.count);
      ASSERT_EQ(mesh.positions.count, mesh.position_count * 3);
      ASSERT_EQ(mesh.normals.count, mesh.vertex_count * 3);
      ASSERT_EQ(mesh.texture_coordinates.count, mesh.vertex_count * 2);
      ASSERT_EQ(mesh.vertex_position_indices.count, mesh.vertex_count);
      ASSERT_EQ(mesh.triangles.count, mesh.triangle_count * 3);
      EXPECT_EQ(mesh.lods, 1u);
      for (uint32_t p = 0; p < mesh.position_count; ++p) {
        EXPECT_EQ(mesh.positions.data[p * 3], source.positions.xs[p]);
        EXPECT_EQ(mesh.positions.data[p * 3 + 1], source.positions.ys[p]);
        EXPECT_EQ(mesh.positions.data[p * 3 + 2], source.positions.zs[p]);
      }
      for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
        EXPECT_EQ(mesh.vertex_position_indices.data[v], source.layouts.positions[v]);
        const uint32_t uv = source.layouts.texture_coordinates[v];
        EXPECT_EQ(mesh.texture_coordinates.data[v * 2], source.texture_coordinates.us[uv]);
        EXPECT_EQ(mesh.texture_coordinates.data[v * 2 + 1], source.texture_coordinates.vs[uv]);
        const float* n = mesh.normals.data + v * 3;
        EXPECT_NEAR(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-6);
        const uint32_t stored = source.layouts.normals[v];
        EXPECT_GT(n[0] * source.normals.xs[stored] + n[2] * source.normals.zs[stored], 0);
      }
      const std::vector<uint32_t> triangles = triangles_of(source);
      ASSERT_EQ(mesh.triangles.count, triangles.size());
      for (size_t i = 0; i < triangles.size(); ++i) EXPECT_EQ(mesh.triangles.data[i], triangles[i]);
    }
  }
}

void expect_triangles(const MienDeformer* deformer, uint32_t m, const Mesh& source) {
  const std::vector<uint32_t> expected = triangles_of(source);
  std::vector<uint32_t> written(expected.size() + 1, 12345);
  ASSERT_EQ(mesh_of(deformer, m).triangle_count * size_t{3}, expected.size());
  ASSERT_EQ(mien_deformer_triangles(deformer, m, written.data(), expected.size()), MIEN_OK);
  EXPECT_EQ(written.back(), 12345u) << "one too many";
  written.pop_back();
  EXPECT_EQ(written, expected);
}

MienDeformerDesc half_storage() {
  MienDeformerDesc desc = sized<MienDeformerDesc>();
  desc.storage = MIEN_STORAGE_16_BIT;
  return desc;
}

TEST(CompileDeformer, TellsTrianglesAndTextureCoordinatesWithAnyStorage) {
  DeformRigOptions options;
  options.rows = 30;
  options.columns = 40;
  for (uint32_t seed = 0; seed < 4; ++seed) {
    options.clockwise = seed % 2;
    Deformed d(random_deform_rig(seed, options));
    const DeformerHandle half = create_deformer(d.dna.get(), d.rig.get(), half_storage());
    for (uint32_t m = 0; m < options.meshes; ++m) {
      const Mesh& source = d.dna->view.geom.meshes[m];
      const MienMesh exact = mesh_of(d.deformer.get(), m), mesh = mesh_of(half.get(), m);
      expect_triangles(d.deformer.get(), m, source);
      expect_triangles(half.get(), m, source);
      EXPECT_EQ(mesh.texture_coordinates.count, 0u);
      std::vector<float> uvs(mesh.vertex_count * size_t{2}), own = uvs;
      ASSERT_EQ(mien_deformer_texture_coordinates(d.deformer.get(), m, own.data(), own.size()),
                MIEN_OK);
      ASSERT_EQ(mien_deformer_texture_coordinates(half.get(), m, uvs.data(), uvs.size()), MIEN_OK);
      EXPECT_EQ(memcmp(own.data(), exact.texture_coordinates.data, own.size() * sizeof(float)), 0);
      for (int k = 0; k < 2; ++k) {
        float least = INFINITY, most = -INFINITY;
        double off = 0;
        for (size_t i = k; i < own.size(); i += 2) {
          least = std::min(least, own[i]);
          most = std::max(most, own[i]);
          off = std::max(off, std::fabs(double{uvs[i]} - own[i]));
        }
        EXPECT_GT(off, 0) << "floats are left";
        EXPECT_LE(off, (double{most} - least) / 131070 + 1e-6 * std::fabs(most));
      }
    }
  }
}

// Triangles follow from faces of positions; where a position has several vertices, their corners are listed.
TEST(CompileDeformer, TellsTrianglesOfAllFacesIn16BitStorage) {
  struct {
    const char* what;
    std::vector<uint32_t> positions;           // of vertices
    std::vector<std::vector<uint32_t>> faces;  // of vertices
    bool follow;
  } const all[] = {
      {"quads and triangles", {0, 1, 2, 3, 4, 5}, {{0, 1, 4, 3}, {1, 2, 5}, {1, 5, 4}}, true},
      {"larger faces", {0, 1, 2, 3, 4, 5}, {{0, 1, 2, 5, 4}, {0, 1, 2, 5, 4, 3}}, true},
      {"lines are dropped", {0, 1, 2, 3, 4, 5}, {{0, 1}, {3}, {}, {0, 1, 4, 3}}, true},
      {"seams", {0, 1, 4, 3, 4, 1}, {{0, 1, 2, 3}, {5, 4, 3}, {1, 5, 4, 0}}, true},
      {"a position twice in a face", {0, 1, 2, 3, 4, 5}, {{0, 1, 0, 4}, {0, 0, 1, 4}}, true},
      {"a vertex that looks like a triangle", {0, 1, 2, 3, 4, 5}, {{0, 1, 4, 4}}, false},
      {"a seam that looks like a triangle", {0, 1, 4, 3, 4, 5}, {{0, 1, 2, 4}}, false},
      {"only triangles", {0, 1, 2, 3, 4, 5}, {{0, 1, 4}, {3, 4, 5}}, true},
  };
  for (const auto& one : all) {
    for (const uint16_t clockwise : {uint16_t{0}, uint16_t{1}}) {
      SCOPED_TRACE(one.what);
      Changed changed([&](Arena& arena, DnaView& view) {
        Mesh& mesh = view.geom.meshes[0];
        mesh.normals = {};
        view.dsce.face_winding_order = clockwise;
        const auto words = [&](const std::vector<uint32_t>& values) {
          const NewArray<uint32_t> array = new_array<uint32_t>(arena, values.size());
          for (size_t i = 0; i < values.size(); ++i) array.set(i, values[i]);
          return Array<uint32_t>(array);
        };
        mesh.layouts.positions = words(one.positions);
        const Span<Face> faces = arena.array<Face>(one.faces.size());
        for (size_t f = 0; f < faces.count; ++f) faces[f].layout_indices = words(one.faces[f]);
        mesh.faces = {faces.data, static_cast<uint32_t>(faces.count)};
      });
      const DeformerHandle exact = create_deformer(changed.dna.get(), changed.rig.get());
      const DeformerHandle half =
          create_deformer(changed.dna.get(), changed.rig.get(), half_storage());
      const Mesh& source = changed.dna->view.geom.meshes[0];
      expect_triangles(exact.get(), 0, source);
      expect_triangles(half.get(), 0, source);
      EXPECT_EQ(mesh_of(half.get(), 0).triangles.count == 0, one.follow);
    }
  }
}

TEST(CompileDeformer, StoresDeltasInFewerBitsWithinTheErrorThatIsAllowed) {
  Deformed d(random_deform_rig(1, {}));
  const MienMesh mesh = mesh_of(d.deformer.get(), 0);
  uint64_t most = 0, before = ~uint64_t{0};
  for (const double allowed : {0.0, 1e-3, 1.0}) {
    MienDeformerDesc desc = half_storage();
    desc.delta_error = allowed;
    const DeformerHandle half = create_deformer(d.dna.get(), d.rig.get(), desc);
    MienDeformerInfo info = sized<MienDeformerInfo>();
    ASSERT_EQ(mien_deformer_info(half.get(), &info), MIEN_OK);
    EXPECT_LE(info.deformer_bytes, before);
    if (allowed == 0) most = info.deformer_bytes;
    before = info.deformer_bytes;
    std::vector<float> wanted(mesh.position_count * size_t{3}), got = wanted;
    for (uint32_t t = 0; t < mesh.target_count; ++t) {
      ASSERT_EQ(mien_deformer_target(d.deformer.get(), 0, t, wanted.data(), wanted.size()),
                MIEN_OK);
      ASSERT_EQ(mien_deformer_target(half.get(), 0, t, got.data(), got.size()), MIEN_OK);
      for (size_t i = 0; i < got.size(); ++i) EXPECT_NEAR(got[i], wanted[i], allowed + 2e-4);
    }
  }
  EXPECT_LT(before, most) << "nothing was packed";
  for (const double wrong : {-1.0, double{INFINITY}, double{NAN}}) {
    MienDeformerDesc desc = half_storage();
    desc.delta_error = wrong;
    MienDeformer* made = nullptr;
    EXPECT_EQ(mien_deformer_create(d.dna.get(), d.rig.get(), &desc, &made, nullptr),
              MIEN_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(made, nullptr);
  }
}

TEST(CompileDeformer, TellsInfluencesWithoutThoseOfNoWeight) {
  Deformed d(random_deform_rig(1, {}));
  const Mesh& source = d.dna->view.geom.meshes[0];
  uint32_t most = 0;
  for (uint32_t p = 0; p < source.positions.xs.count; ++p) {
    MienIndex16View joints = {};
    MienFloatView weights = {};
    ASSERT_EQ(mien_deformer_influences(d.deformer.get(), 0, p, &joints, &weights), MIEN_OK);
    size_t at = 0;
    const VertexSkinWeights& skin = source.skin_weights[p];
    for (uint32_t i = 0; i < skin.weights.count; ++i) {
      if (skin.weights[i] == 0) continue;
      ASSERT_LT(at, joints.count);
      EXPECT_EQ(joints.data[at], skin.joint_indices[i]);
      EXPECT_EQ(weights.data[at++], skin.weights[i]);
    }
    EXPECT_EQ(at, joints.count);
    EXPECT_EQ(at, weights.count);
    most = std::max(most, static_cast<uint32_t>(at));
  }
  EXPECT_EQ(mesh_of(d.deformer.get(), 0).max_influences, most);
}

TEST(CompileDeformer, TellsTargets) {
  DeformRigOptions options;
  options.rows = 40;
  options.columns = 30;
  Deformed d(random_deform_rig(1, options));
  const Mesh& source = d.dna->view.geom.meshes[1];
  const MienMesh mesh = mesh_of(d.deformer.get(), 1);
  ASSERT_EQ(mesh.target_count, source.blend_shape_targets.count);
  ASSERT_EQ(mesh.target_channels.count, mesh.target_count);
  size_t deltas = 0;
  for (uint32_t t = 0; t < mesh.target_count; ++t) {
    const BlendShapeTarget& target = source.blend_shape_targets[t];
    EXPECT_EQ(mesh.target_channels.data[t], target.channel_index);
    std::vector<float> expected(mesh.position_count * 3), told(expected.size(), -1);
    for (uint32_t i = 0; i < target.vertex_indices.count; ++i) {
      float* at = expected.data() + target.vertex_indices[i] * 3;
      at[0] += target.deltas.xs[i];
      at[1] += target.deltas.ys[i];
      at[2] += target.deltas.zs[i];
      deltas += at[0] != 0 || at[1] != 0 || at[2] != 0;
    }
    ASSERT_EQ(mien_deformer_target(d.deformer.get(), 1, t, told.data(), told.size()), MIEN_OK);
    EXPECT_TRUE(same_bits(span_of(told), span_of(expected)));
  }
  EXPECT_EQ(mesh.delta_count, deltas);
}

TEST(CompileDeformer, TellsWhichLodsShowAMesh) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_SMALL, 1);
  const RigHandle rig = create_rig(dna.get());
  const DeformerHandle deformer = create_deformer(dna.get(), rig.get());
  for (uint32_t m = 0; m < count_of(rig, MIEN_KIND_MESH); ++m) {
    uint64_t expected = 0;
    for (uint32_t lod = 0; lod < info_of(rig).lod_count; ++lod) {
      MienIndex16View meshes = {};
      ASSERT_EQ(mien_rig_lod_indices(rig.get(), MIEN_KIND_MESH, lod, &meshes), MIEN_OK);
      for (size_t i = 0; i < meshes.count; ++i) {
        if (meshes.data[i] == m) expected |= uint64_t{1} << lod;
      }
    }
    EXPECT_EQ(mesh_of(deformer.get(), m).lods, expected);
  }
}

// Neighbors run the same code, and mostly read the same matrices.
TEST(CompileDeformer, PositionsOfAWindowAreInRunsOfEqualInfluences) {
  DeformRigOptions options;
  options.rows = options.columns = 70;
  Deformed d(random_deform_rig(1, options));
  const DeformMesh& mesh = capi::object(d.deformer.get())->meshes[0];
  ASSERT_GT(mesh.position_count, kWindowPositions);
  uint32_t next = 0, influences = ~0u, ascents = 0;
  for (const SkinRun& run : mesh.skin_runs) {
    EXPECT_EQ(run.first, next);
    EXPECT_GT(run.count, 0u);
    EXPECT_NE(run.influences, influences);
    if (run.first % kWindowPositions != 0) {
      EXPECT_GT(run.influences, influences);
      ++ascents;
    }
    influences = run.influences;
    next += run.count;
  }
  EXPECT_GT(ascents, 0u);
  EXPECT_EQ(next, mesh.position_count);
  std::vector<uint32_t> times(mesh.position_count);
  for (uint32_t i = 0; i < mesh.position_count; ++i) {
    const uint32_t p = mesh.position_of(i);
    ASSERT_LT(p, mesh.position_count);
    EXPECT_EQ(p / kWindowPositions, i / kWindowPositions);
    ++times[p];
  }
  EXPECT_EQ(times, std::vector<uint32_t>(mesh.position_count, 1));
}

// What is missing ---------------------------------------------------------------------------------

TEST(CompileDeformer, MeshesMayLackAnything) {
  for (int lacking = 0; lacking < 7; ++lacking) {
    SCOPED_TRACE(lacking);
    const Changed changed([&](Arena& arena, DnaView& view) {
      Mesh& mesh = view.geom.meshes[0];
      switch (lacking) {
        case 0: mesh = {}; break;
        case 1: mesh.faces = {}; break;
        case 2: mesh.skin_weights = {}; break;
        case 3: mesh.normals = {}; break;
        case 4: mesh.texture_coordinates = {}; break;
        case 5: view.geom.meshes = {}; break;
        case 6:  // positions that no face uses, and no vertices at all
          mesh.layouts = {};
          mesh.faces = list<Face>(arena, {{}});
          break;
      }
    });
    const DeformerHandle deformer = create_deformer(changed.dna.get(), changed.rig.get());
    const DeformerInstanceHandle instance = create_deformer_instance(deformer.get());
    const DeformValues values = random_values(changed.rig.get(), 1);
    Deformed::update(instance.get(), values);
    for (uint32_t normals : {MIEN_NORMALS_SKINNED, MIEN_NORMALS_RECOMPUTED}) {
      ASSERT_EQ(mien_deformer_instance_deform(instance.get(), 0, normals, nullptr), MIEN_OK);
    }
    const MienMesh mesh = mesh_of(deformer.get(), 0);
    const bool empty = lacking == 0 || lacking == 5;
    EXPECT_EQ(mesh.position_count, empty ? 0u : 6u);
    EXPECT_EQ(mesh.vertex_count, empty || lacking == 6 ? 0u : 6u);
    EXPECT_EQ(mesh.triangle_count, empty || lacking == 1 || lacking == 6 ? 0u : 4u);
    EXPECT_EQ(Deformed::positions(instance.get(), 0).count, mesh.positions.count);
    EXPECT_EQ(Deformed::normals(instance.get(), 0).count, mesh.normals.count);
    if (lacking == 4) {
      for (size_t i = 0; i < mesh.texture_coordinates.count; ++i) {
        EXPECT_EQ(mesh.texture_coordinates.data[i], 0);
      }
    }
    if (empty) continue;
    const PlainDeformer plain = {changed.dna->view};
    EXPECT_LE(largest_error(Deformed::positions(instance.get(), 0), plain.positions(0, values)),
              1e-4);
    if (lacking == 0 || lacking == 1 || lacking == 6) continue;
    EXPECT_LE(
        largest_error(Deformed::normals(instance.get(), 0), plain.recomputed_normals(0, values)),
        1e-3);
  }
}

TEST(CompileDeformer, TargetsMayBeLeftOut) {
  const Changed changed;
  MienDnaDesc desc = sized<MienDnaDesc>();
  desc.layers = MIEN_LAYER_BEHAVIOR | MIEN_LAYER_GEOMETRY;
  desc.skip_blend_shape_targets = 1;
  MienDna* opened = nullptr;
  ASSERT_EQ(
      mien_dna_open_memory(changed.bytes.data(), changed.bytes.size(), &desc, &opened, nullptr),
      MIEN_OK);
  const DnaHandle dna(opened);
  const DeformerHandle deformer = create_deformer(dna.get(), changed.rig.get());
  EXPECT_EQ(mesh_of(deformer.get(), 0).target_count, 0u);
  EXPECT_EQ(mesh_of(deformer.get(), 0).delta_count, 0u);
}

// What is refused ---------------------------------------------------------------------------------

TEST(CompileDeformer, NumbersThatAreNoneAreRefused) {
  for (float bad : {NAN, INFINITY, -INFINITY}) {
    Changed([&](Arena& arena, DnaView& view) {
      view.geom.meshes[0].positions.ys = be<float>(arena, {0, 0, 0, 1, bad, 1});
    }).expect_refused(MIEN_ERROR_DNA_VALUE, "geom.meshes[0].positions: position 4", true);
    Changed([&](Arena& arena, DnaView& view) {
      view.geom.meshes[0].skin_weights[2].weights = be<float>(arena, {0.5f, bad});
    }).expect_refused(MIEN_ERROR_DNA_VALUE, "skinWeights[2].weights: element 1", true);
    Changed([&](Arena& arena, DnaView& view) {
      view.geom.meshes[0].blend_shape_targets[0].deltas.zs = be<float>(arena, {0, bad});
    }).expect_refused(MIEN_ERROR_DNA_VALUE, "blendShapeTargets[0].deltas: element 1", true);
    // Normals that are none count as missing.
    const Changed normals([&](Arena& arena, DnaView& view) {
      view.geom.meshes[0].normals.xs = be<float>(arena, {0, bad, 0, 0, 0, 0});
    });
    const DeformerHandle deformer = create_deformer(normals.dna.get(), normals.rig.get());
    const float* n = mesh_of(deformer.get(), 0).normals.data + 3;
    EXPECT_EQ(n[0], 0);
    EXPECT_EQ(n[2], 1);
  }
}

// Opening checks indices, so a DNA with wrong ones never gets here.
TEST(CompileDeformer, IndicesPastTheEndDoNotOpen) {
  const auto expect_closed = [](auto&& change) {
    Arena arena(default_allocator());
    DnaView view = tiny_rig(arena);
    change(arena, view.geom.meshes[0]);
    const std::vector<uint8_t> bytes = write_view(view);
    open_dna(bytes, 0, MIEN_ERROR_DNA_REFERENCE);
  };
  expect_closed([](Arena& arena, Mesh& mesh) {
    mesh.faces[0].layout_indices = be<uint32_t>(arena, {0, 1, 6});
  });
  expect_closed([](Arena& arena, Mesh& mesh) {
    mesh.layouts.positions = be<uint32_t>(arena, {0, 1, 2, 3, 4, 6});
  });
  expect_closed([](Arena& arena, Mesh& mesh) {
    mesh.skin_weights[0].joint_indices = be<uint16_t>(arena, {0, 3});
  });
  expect_closed([](Arena& arena, Mesh& mesh) {
    mesh.blend_shape_targets[0].vertex_indices = be<uint32_t>(arena, {1, 6});
  });
  expect_closed([](Arena&, Mesh& mesh) { mesh.blend_shape_targets[0].channel_index = 2; });
}

TEST(CompileDeformer, TooManyInfluencesAreRefused) {
  Changed([](Arena& arena, DnaView& view) {
    const NewArray<float> weights = new_array<float>(arena, 65536);
    const NewArray<uint16_t> joints = new_array<uint16_t>(arena, 65536);
    for (size_t i = 0; i < 65536; ++i) {
      weights.set(i, 1.0f / 65536);
      joints.set(i, 0);
    }
    view.geom.meshes[0].skin_weights[1] = {weights, joints};
  }).expect_refused(MIEN_ERROR_DNA_LIMIT, "skinWeights[1]: 65536 influences", true);
}

TEST(CompileDeformer, OtherRigsAreRefused) {
  const Changed own;
  const auto expect_mismatch = [&](const MienDna* dna, const char* words) {
    MienError error = sized<MienError>();
    MienDeformer* made = nullptr;
    EXPECT_EQ(mien_deformer_create(dna, own.rig.get(), nullptr, &made, &error),
              MIEN_ERROR_MISMATCH);
    EXPECT_NE(strstr(error.message, words), nullptr) << error.message;
  };
  expect_mismatch(generate_dna(MIEN_PRESET_TINY, 1).get(), "joint names");
  expect_mismatch(open_dna(own.bytes, 2).get(), "joint names");  // only LOD 1
  const Changed renamed([](Arena& arena, DnaView& view) {
    view.defn.channel_names = list<String>(arena, {text("jawOpen"), text("frown")});
  });
  expect_mismatch(renamed.dna.get(), "blend shape channel 1 is smile, in the DNA it is frown");
  // The same file opened again is as good.
  create_deformer(open_dna(own.bytes).get(), own.rig.get());
}

TEST(CompileDeformer, GeometryIsNeeded) {
  const Changed own;
  MienDnaDesc desc = sized<MienDnaDesc>();
  desc.layers = MIEN_LAYER_BEHAVIOR;
  MienDna* opened = nullptr;
  ASSERT_EQ(mien_dna_open_memory(own.bytes.data(), own.bytes.size(), &desc, &opened, nullptr),
            MIEN_OK);
  const DnaHandle dna(opened);
  MienError error = sized<MienError>();
  MienDeformer* made = nullptr;
  EXPECT_EQ(mien_deformer_create(dna.get(), own.rig.get(), nullptr, &made, &error),
            MIEN_ERROR_DNA_LAYER);
  EXPECT_NE(strstr(error.message, "MIEN_LAYER_GEOMETRY"), nullptr);
}

}  // namespace
}  // namespace mien
