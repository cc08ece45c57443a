// SPDX-License-Identifier: MIT
// Heads in a pak file. Each has two entries: "far" with the coarse LODs, which stays in memory, and "full" with all of
// them, which is streamed in for characters that are near.
#pragma once

#include <mien_author.hpp>

#include "pak.h"

constexpr uint32_t kFirstFarLod = 4;
constexpr uint32_t kHeadCount = 2;

struct Asset {
  Bytes bytes{nullptr, nullptr};  // outlives what is made of it, below
  mien::Baked baked;
  mien::Rig rig;
  mien::Deformer deformer;
  uint32_t first_lod = 0, lod_count = 0;             // LODs of the head that it has
  std::vector<std::vector<uint32_t>> meshes_of_lod;  // by LOD of the asset
  std::vector<uint64_t> cost_of_lod;                 // joint values and positions that are computed
};

inline std::shared_ptr<const Asset> load_asset(const Pak& pak, uint32_t head, bool is_full) {
  auto asset = std::make_shared<Asset>();
  size_t size = 0;
  asset->bytes = pak.read("head" + std::to_string(head) + (is_full ? ".full" : ".far"), size);
  mien::BakedDesc checked;
  checked.check = MIEN_BAKED_CHECK_FULL;
  asset->baked = mien::Baked::open(asset->bytes.get(), size, checked).value();
  asset->rig = asset->baked.rig().value();
  asset->deformer = asset->baked.deformer(asset->rig).value();
  asset->first_lod = is_full ? 0 : kFirstFarLod;
  asset->lod_count = asset->rig.info().value().lod_count;
  const uint32_t mesh_count = asset->deformer.info().value().mesh_count;
  for (uint32_t lod = 0; lod < asset->lod_count; ++lod) {
    asset->meshes_of_lod.emplace_back();
    uint64_t cost = asset->rig.variable_joint_values(lod).value().size();
    for (uint32_t i = 0; i < mesh_count; ++i) {
      const MienMesh mesh = asset->deformer.mesh(i).value();
      if (!(mesh.lods >> lod & 1)) continue;
      asset->meshes_of_lod.back().push_back(i);
      cost += mesh.position_count;
    }
    asset->cost_of_lod.push_back(cost);
  }
  return asset;
}

inline std::vector<unsigned char> baked_bytes(const mien::Dna& dna) {
  const mien::Rig rig = mien::Rig::create(dna).value();
  const mien::Deformer deformer = mien::Deformer::create(dna, rig).value();
  std::vector<unsigned char> bytes(mien::bake(mien::Span<unsigned char>(), rig, deformer).value());
  mien::bake(bytes, rig, deformer).value();
  return bytes;
}

// What a build step of a game does: DNA files to a pak. Here the heads are generated, from seeds.
inline void build_pak(const std::string& path, uint64_t generation, uint64_t seed) {
  std::vector<std::pair<std::string, std::vector<unsigned char>>> parts;
  for (uint32_t head = 0; head < kHeadCount; ++head) {
    mien::GenerateDesc desc;
    desc.preset = MIEN_PRESET_HEAD;
    desc.seed = seed + head;
    const mien::Dna full = mien::generate(desc).value();
    std::vector<unsigned char> file(full.write(mien::Span<unsigned char>()).value());
    full.write(file).value();
    mien::DnaDesc coarse;
    coarse.lods = ~uint64_t(0) << kFirstFarLod;
    const mien::Dna far = mien::Dna::open(file.data(), file.size(), coarse).value();
    parts.emplace_back("head" + std::to_string(head) + ".full", baked_bytes(full));
    parts.emplace_back("head" + std::to_string(head) + ".far", baked_bytes(far));
  }
  write_pak(path, generation, parts);
}
