// SPDX-License-Identifier: MIT
// Deformation by instruction set: joints, skin, targets, normals, a whole frame of a head, vertex
// output, and many characters. `bytes` counts each array that is read or written once, however often and
// from wherever it is; `copy` moves as many as a frame does, so it is how fast memory allows. The head is the finest mesh of the bench rig (by default a generated
// one of 24,578 positions and 135,254 deltas), but each position has eight influences: the nearest
// joints.
#include <algorithm>
#include <cmath>
#include <random>

#include "bench/bench_support.h"
#include "bench/thread_pool.h"
#include "capi/dna_handle.h"

namespace mien::bench {
namespace {

constexpr uint32_t kInfluences = 8;

/// Model positions of the joints, from a deformer of the rig as it is.
std::vector<float> joint_positions(const MienDna* dna) {
  MienError error = sized<MienError>();
  MienRig* rig = create_rig(dna, MIEN_ISA_SCALAR);
  MienDeformer* deformer = nullptr;
  require(mien_deformer_create(dna, rig, nullptr, &deformer, &error), error);
  MienFloatView matrices = {};
  require(mien_deformer_bind_matrices(deformer, &matrices));
  std::vector<float> positions;
  for (size_t i = 0; i < matrices.count; i += 16) {
    positions.insert(positions.end(), matrices.data + i + 12, matrices.data + i + 15);
  }
  mien_deformer_destroy(deformer);
  mien_rig_destroy(rig);
  return positions;
}

MienDna* head() {
  static MienDna* const made = [] {
    MienDna* dna = open_rig(MIEN_LAYER_ALL, 0);
    const std::vector<float> joints = joint_positions(dna);
    dna::DnaFile& file = *capi::object(dna);
    dna::Mesh& mesh = file.view.geom.meshes[0];
    mesh.skin_weights.items =
        file.arena.array<dna::VertexSkinWeights>(mesh.positions.xs.count).data;
    mesh.skin_weights.count = mesh.positions.xs.count;
    std::vector<std::pair<float, uint16_t>> near(joints.size() / 3);
    for (uint32_t v = 0; v < mesh.skin_weights.count; ++v) {
      for (size_t j = 0; j < near.size(); ++j) {
        const float x = mesh.positions.xs[v] - joints[j * 3];
        const float y = mesh.positions.ys[v] - joints[j * 3 + 1];
        const float z = mesh.positions.zs[v] - joints[j * 3 + 2];
        near[j] = {x * x + y * y + z * z, static_cast<uint16_t>(j)};
      }
      std::partial_sort(near.begin(), near.begin() + kInfluences, near.end());
      const auto weights = dna::new_array<float>(file.arena, kInfluences);
      const auto indices = dna::new_array<uint16_t>(file.arena, kInfluences);
      for (uint32_t k = 0; k < kInfluences; ++k) {
        weights.set(k, 1.0f / kInfluences);
        indices.set(k, near[k].second);
      }
      mesh.skin_weights[v] = {weights, indices};
    }
    return dna;
  }();
  return made;
}

/// A deformer of the head for an instruction set, made once.
const MienDeformer* deformer_for(uint32_t isa) {
  static MienDeformer* deformers[MIEN_ISA_NEON + 1] = {};
  if (deformers[isa]) return deformers[isa];
  MienError error = sized<MienError>();
  MienRig* rig = create_rig(head(), isa);
  MienDeformerDesc desc = sized<MienDeformerDesc>();
  desc.with_tangents = 1;
  require(mien_deformer_create(head(), rig, &desc, &deformers[isa], &error), error);
  mien_rig_destroy(rig);
  return deformers[isa];
}

/// A character with small rotations and translations of all joints, and `channels` percent of the
/// channels active.
struct Character {
  MienDeformerInstance* pose = nullptr;
  std::vector<float> joints, weights;

  Character(uint32_t isa, uint32_t seed, uint32_t channels) {
    const MienDeformer* deformer = deformer_for(isa);
    MienDeformerInfo info = sized<MienDeformerInfo>();
    require(mien_deformer_info(deformer, &info));
    MienDeformerInstanceDesc desc = sized<MienDeformerInstanceDesc>();
    desc.lods = 1;
    MienError error = sized<MienError>();
    require(mien_deformer_instance_create(deformer, &desc, &pose, &error), error);
    std::mt19937 random(seed);
    const auto next = [&] { return static_cast<float>(random() >> 8) / 16777216.0f - 0.5f; };
    for (uint32_t j = 0; j < info.joint_count; ++j) {
      for (int i = 0; i < 3; ++i) joints.push_back(0.2f * next());
      for (int i = 0; i < 3; ++i) joints.push_back(10 * next());
      for (int i = 0; i < 3; ++i) joints.push_back(0);
    }
    weights.resize(info.channel_count);
    for (float& weight : weights) weight = random() % 100 < channels ? next() + 0.6f : 0;
    update();
  }
  ~Character() { mien_deformer_instance_destroy(pose); }
  Character(const Character&) = delete;

  void update() {
    require(mien_deformer_instance_update_from_values(pose, joints.data(), joints.size(),
                                                      weights.data(), weights.size()));
  }
};

double position_count() {
  MienMesh mesh = sized<MienMesh>();
  require(mien_deformer_mesh(deformer_for(MIEN_ISA_SCALAR), 0, &mesh));
  return static_cast<double>(mesh.position_count);
}

void count_vertices(benchmark::State& state, double characters = 1) {
  state.counters["vertices"] = benchmark::Counter(position_count() * characters,
                                                  benchmark::Counter::kIsIterationInvariantRate);
}

/// What a deformation reads and writes, all channels active or none.
double bytes_of(uint32_t normals, bool targets) {
  const DeformMesh& mesh = capi::object(deformer_for(MIEN_ISA_SCALAR))->meshes[0];
  const auto size = [](auto&... spans) {
    return (static_cast<double>(spans.count * sizeof(spans[0])) + ...);
  };
  double bytes =
      size(mesh.sorted_positions, mesh.weights, mesh.joints, mesh.position_indices, mesh.positions);
  if (targets) bytes += size(mesh.deltas, mesh.delta_indices);
  if (normals != MIEN_NORMALS_NONE) bytes += size(mesh.first_vertex, mesh.vertices, mesh.normals);
  if (normals == MIEN_NORMALS_SKINNED) bytes += size(mesh.sorted_normals);
  if (normals == MIEN_NORMALS_RECOMPUTED) {
    bytes += size(mesh.positions, mesh.first_adjacent_face);
    for (const IndexList* list : {&mesh.faces, &mesh.adjacent_faces}) {
      bytes += static_cast<double>(list->count) * (list->wide ? 4 : 2);
    }
    bytes += 2.0 * 4 * sizeof(float) * mesh.face_count();  // areas, written and read
  }
  return bytes;
}

void count_bytes(benchmark::State& state, double bytes) {
  state.counters["bytes"] = benchmark::Counter(bytes, benchmark::Counter::kIsIterationInvariantRate,
                                               benchmark::Counter::kIs1024);
}

void copy(benchmark::State& state) {
  const double bytes = bytes_of(MIEN_NORMALS_RECOMPUTED, true);
  std::vector<uint8_t> from(static_cast<size_t>(bytes / 2), 1), to(from.size());
  for (auto _ : state) {
    std::copy(from.begin(), from.end(), to.begin());
    benchmark::DoNotOptimize(to.data());
    benchmark::ClobberMemory();
  }
  count_bytes(state, bytes);
}

void joints(benchmark::State& state, uint32_t isa) {
  Character character(isa, 1, 0);
  for (auto _ : state) character.update();
  state.counters["joints"] = benchmark::Counter(static_cast<double>(character.joints.size() / 9),
                                                benchmark::Counter::kIsIterationInvariantRate);
}

void deform(benchmark::State& state, uint32_t isa, uint32_t normals, uint32_t channels) {
  Character character(isa, 1, channels);
  for (auto _ : state) require(mien_deformer_instance_deform(character.pose, 0, normals, nullptr));
  count_vertices(state);
  count_bytes(state, bytes_of(normals, channels == 100));
}

void frame(benchmark::State& state, uint32_t isa, uint32_t channels) {
  Character character(isa, 1, channels);
  for (auto _ : state) {
    character.update();
    require(mien_deformer_instance_deform(character.pose, 0, MIEN_NORMALS_RECOMPUTED, nullptr));
  }
  MienMesh mesh = sized<MienMesh>();
  require(mien_deformer_mesh(deformer_for(isa), 0, &mesh));
  state.counters["positions"] = mesh.position_count;
  state.counters["deltas"] = mesh.delta_count;
  state.counters["joints"] = static_cast<double>(character.joints.size() / 9);
  count_vertices(state);
}

/// Targets, skin, normals, and an interleaved vertex buffer of positions, normals and perhaps
/// tangents: as floats (12 + 12 + 16 bytes), or with packed directions (12 + 4 + 4 bytes).
void vertices(benchmark::State& state, uint32_t isa, bool packed, bool tangents) {
  Character character(isa, 1, 100);
  MienMesh mesh = sized<MienMesh>();
  require(mien_deformer_mesh(deformer_for(isa), 0, &mesh));
  const uint32_t tangent_at = packed ? 16 : 24;
  const uint32_t stride = tangent_at + (!tangents ? 0 : packed ? 4 : 16);
  std::vector<uint8_t> memory(size_t{stride} * mesh.vertex_count);
  MienVertexOutput output = sized<MienVertexOutput>();
  output.vertex_capacity = mesh.vertex_count;
  output.positions = {memory.data(), stride, MIEN_VERTEX_FORMAT_FLOAT32X3};
  const uint32_t packed_format = MIEN_VERTEX_FORMAT_SNORM10_10_10_2;
  output.normals = {memory.data() + 12, stride,
                    packed ? packed_format : uint32_t{MIEN_VERTEX_FORMAT_FLOAT32X3}};
  if (tangents) {
    output.tangents = {memory.data() + tangent_at, stride,
                       packed ? packed_format : uint32_t{MIEN_VERTEX_FORMAT_FLOAT32X4}};
  }
  for (auto _ : state) {
    require(mien_deformer_instance_write_vertices(character.pose, 0, MIEN_NORMALS_SKINNED, &output,
                                                  nullptr));
  }
  count_vertices(state);
  const DeformMesh& arrays = capi::object(deformer_for(MIEN_ISA_SCALAR))->meshes[0];
  const auto size = [](const auto& span) {
    return static_cast<double>(span.count * sizeof(span[0]));
  };
  double bytes = bytes_of(MIEN_NORMALS_SKINNED, true) + static_cast<double>(memory.size()) +
                 size(arrays.vertex_position_indices) + size(arrays.positions) +
                 size(arrays.normals);  // deformed ones, which are as large, read again
  if (tangents) bytes += 3 * size(arrays.tangents);  // neutral; skinned ones written and read
  count_bytes(state, bytes);
}

/// Eight characters: one after the other, or together.
void packet(benchmark::State& state, uint32_t isa, bool together) {
  constexpr uint32_t kCharacters = 8;
  std::vector<std::unique_ptr<Character>> characters;
  std::vector<MienDeformerInstance*> poses;
  for (uint32_t i = 0; i < kCharacters; ++i) {
    characters.push_back(std::make_unique<Character>(isa, i, 10));
    poses.push_back(characters.back()->pose);
  }
  for (auto _ : state) {
    if (together) {
      require(mien_deformer_instance_deform_batch(poses.data(), poses.size(), 0,
                                                  MIEN_NORMALS_SKINNED, nullptr));
      continue;
    }
    for (MienDeformerInstance* pose : poses)
      require(mien_deformer_instance_deform(pose, 0, MIEN_NORMALS_SKINNED, nullptr));
  }
  count_vertices(state, kCharacters);
}

/// A frame of one head.
void head_on_threads(benchmark::State& state, uint32_t isa) {
  Character character(isa, 1, 100);
  compare_two_threads(state, [&](const MienParallelFor* threads) {
    character.update();
    require(mien_deformer_instance_deform(character.pose, 0, MIEN_NORMALS_RECOMPUTED, threads));
  });
}

/// Joints of all characters, each a task of the host's, then their meshes in one call.
void pose_deform_on_threads(benchmark::State& state, uint32_t isa, uint32_t count) {
  std::vector<std::unique_ptr<Character>> characters;
  std::vector<MienDeformerInstance*> poses;
  for (uint32_t i = 0; i < count; ++i) {
    characters.push_back(std::make_unique<Character>(isa, i, 10));
    poses.push_back(characters.back()->pose);
  }
  const auto update = [](void* context, uint32_t i) {
    (*static_cast<std::vector<std::unique_ptr<Character>>*>(context))[i]->update();
  };
  compare_two_threads(state, [&](const MienParallelFor* threads) {
    if (threads) {
      threads->run(threads->user, count, update, &characters);
    } else {
      for (uint32_t i = 0; i < count; ++i) update(&characters, i);
    }
    require(mien_deformer_instance_deform_batch(poses.data(), poses.size(), 0, MIEN_NORMALS_SKINNED,
                                                threads));
  });
}

int registered = [] {
  benchmark::RegisterBenchmark("copy", copy)->Unit(benchmark::kMicrosecond)->UseRealTime();
  for (uint32_t isa = MIEN_ISA_SCALAR; isa <= MIEN_ISA_NEON; ++isa) {
    if (!mien_isa_available(isa)) continue;
    const auto add = [&](const std::string& name, auto&&... arguments) {
      benchmark::RegisterBenchmark((name + "/" + mien_isa_name(isa)).c_str(), arguments...)
          ->Unit(benchmark::kMicrosecond)
          ->UseRealTime();
    };
    add("joints", joints, isa);
    add("skin", deform, isa, MIEN_NORMALS_NONE, 0u);
    add("skin_and_normals", deform, isa, MIEN_NORMALS_SKINNED, 0u);
    add("skin_and_recomputed", deform, isa, MIEN_NORMALS_RECOMPUTED, 0u);
    add("targets_and_skin", deform, isa, MIEN_NORMALS_NONE, 100u);
    add("frame", frame, isa, 100u);
    add("frame_few_channels", frame, isa, 8u);
    add("targets_skin_and_normals", deform, isa, MIEN_NORMALS_SKINNED, 100u);
    add("vertices_float", vertices, isa, false, false);
    add("vertices_packed", vertices, isa, true, false);
    add("vertices_tangents_float", vertices, isa, false, true);
    add("vertices_tangents_packed", vertices, isa, true, true);
    add("eight_characters_one_by_one", packet, isa, false);
    add("eight_characters_together", packet, isa, true);
    const auto compare = [&](const std::string& name, auto&&... arguments) {
      benchmark::RegisterBenchmark((name + "/" + mien_isa_name(isa)).c_str(), arguments...)
          ->Unit(benchmark::kMicrosecond)
          ->UseManualTime();
    };
    compare("two_threads_head", head_on_threads, isa);
    compare("two_threads_pose_deform_64", pose_deform_on_threads, isa, 64u);
  }
  return 0;
}();

}  // namespace
}  // namespace mien::bench
