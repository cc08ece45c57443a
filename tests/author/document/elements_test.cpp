// SPDX-License-Identifier: MIT
// Removing, renaming and clearing against models made of what the public functions read.
#include "author/document/elements.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "author/base/random.h"
#include "tests/support/bytes.h"
#include "tests/support/dna_bytes.h"
#include "tests/support/documents.h"

namespace mien {
namespace {

using Indices = std::vector<uint32_t>;

MienStatus remove(const DocumentHandle& document, uint32_t kind, const Indices& indices,
                  MienError* error = nullptr) {
  return mien_document_remove(document.get(), kind, indices.data(), indices.size(), error);
}

/// Everything that evaluation gives for random raw controls, by name.
struct Evaluated {
  std::vector<std::string> joint_names, channel_names, map_names;
  std::vector<std::vector<float>> joints, channels, maps;  // [frame]
};
Evaluated evaluate(const DnaHandle& dna, uint32_t lod, uint64_t seed = 1, bool sparse = false) {
  const RigHandle rig = create_rig(dna.get());
  Character character(rig);
  Evaluated result{names_of(rig, MIEN_KIND_JOINT),
                   names_of(rig, MIEN_KIND_BLEND_SHAPE_CHANNEL),
                   names_of(rig, MIEN_KIND_ANIMATED_MAP),
                   {},
                   {},
                   {}};
  Random random(seed, 2);
  for (int frame = 0; frame < 4; ++frame) {
    for (float& value : character.raw)
      value = sparse && random.below(8) ? 0 : static_cast<float>(random.below(1024)) / 1024;
    character.evaluate(lod);
    result.joints.emplace_back(character.joints.begin(), character.joints.end());
    result.channels.emplace_back(character.channels.begin(), character.channels.end());
    result.maps.emplace_back(character.maps.begin(), character.maps.end());
  }
  return result;
}

/// What has the same name on both sides has the same values; quaternion joints within 1e-2 degrees.
void expect_same(const Evaluated& before, const Evaluated& after,
                 const std::set<std::string>& quaternions = {}) {
  const auto compare =
      [](const std::vector<std::string>& old_names, const std::vector<std::string>& new_names,
         const std::vector<std::vector<float>>& olds, const std::vector<std::vector<float>>& news,
         size_t width, const std::set<std::string>& loose) {
        for (size_t k = 0; k < new_names.size(); ++k) {
          const size_t o = static_cast<size_t>(
              std::find(old_names.begin(), old_names.end(), new_names[k]) - old_names.begin());
          ASSERT_LT(o, old_names.size()) << new_names[k];
          for (size_t frame = 0; frame < olds.size(); ++frame) {
            for (size_t a = 0; a < width; ++a) {
              const float x = olds[frame][o * width + a], y = news[frame][k * width + a];
              if (loose.count(new_names[k]) && a >= 3 && a < 6) {
                EXPECT_NEAR(std::remainder(x - y, 360), 0, 1e-2) << new_names[k];
              } else {
                EXPECT_EQ(x, y) << new_names[k] << " " << a;
              }
            }
          }
        }
      };
  compare(before.joint_names, after.joint_names, before.joints, after.joints, 9, quaternions);
  compare(before.channel_names, after.channel_names, before.channels, after.channels, 1, {});
  compare(before.map_names, after.map_names, before.maps, after.maps, 1, {});
}

std::set<std::string> quaternion_joints(const DocumentHandle& document) {
  std::set<std::string> names;
  const size_t count = field_of(document, "jbmd.jointRepresentations").count;
  for (size_t j = 0; j < count; ++j) {
    if (integers_of(document, "jbmd.jointRepresentations[" + std::to_string(j) + "].rotation")[0] ==
        1) {
      names.insert(string_of(document, "defn.jointNames[" + std::to_string(j) + "]"));
    }
  }
  return names;
}

/// Layers by their code, for comparing which bytes changed.
std::map<std::string, Bytes> layers_by_code(const Bytes& bytes) {
  std::map<std::string, Bytes> layers;
  for (const dna::Layer& layer : dna::layers_of(bytes)) layers[layer.code] = layer.bytes;
  return layers;
}
void expect_untouched(const Bytes& before, const Bytes& after,
                      const std::set<std::string>& touched) {
  const auto old_layers = layers_by_code(before), new_layers = layers_by_code(after);
  ASSERT_EQ(old_layers.size(), new_layers.size());
  for (const auto& [code, bytes] : old_layers) {
    if (touched.count(code)) continue;
    EXPECT_EQ(bytes, new_layers.at(code)) << code;
  }
}

const char* kRigs[] = {"tiny", "small", "body", "ml", "ml_ext"};

TEST(Rename, ChangesOneNameAndNothingElse) {
  for (const char* rig : kRigs) {
    const Bytes before = golden::read_rig(rig);
    const DocumentHandle document = document_of(before);
    const auto names = strings_of(document, "defn.jointNames");
    uint32_t found = 0;
    ASSERT_EQ(
        mien_document_find(document.get(), MIEN_KIND_JOINT, names[1].c_str(), &found, nullptr),
        MIEN_OK);
    ASSERT_EQ(mien_document_rename(document.get(), MIEN_KIND_JOINT, found, "head_bone", nullptr),
              MIEN_OK);
    auto wanted = names;
    wanted[1] = "head_bone";
    EXPECT_EQ(strings_of(document, "defn.jointNames"), wanted);
    expect_untouched(before, bytes_of(document), {"defn"});
    ASSERT_EQ(
        mien_document_rename(document.get(), MIEN_KIND_JOINT, found, names[1].c_str(), nullptr),
        MIEN_OK);
    EXPECT_EQ(bytes_of(document), before) << rig;
  }
}

TEST(Rename, RefusesWhatIsNotThereOrTaken) {
  const DocumentHandle document = document_of(golden::read_rig("small"));
  MienError error = sized<MienError>();
  const auto names = strings_of(document, "defn.jointNames");
  EXPECT_EQ(mien_document_rename(document.get(), MIEN_KIND_JOINT, 1, names[0].c_str(), &error),
            MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(std::string(error.message).find("already named"), std::string::npos) << error.message;
  EXPECT_EQ(mien_document_rename(document.get(), MIEN_KIND_JOINT, 60000, "a", &error),
            MIEN_ERROR_INDEX);
  EXPECT_EQ(mien_document_rename(document.get(), MIEN_KIND_PSD_CONTROL, 0, "a", &error),
            MIEN_ERROR_INVALID_ARGUMENT);
  uint32_t index = 1;
  EXPECT_EQ(mien_document_find(document.get(), MIEN_KIND_MESH, "no such mesh", &index, &error),
            MIEN_ERROR_NAME);
  EXPECT_EQ(index, 0u);
}

// Which joint takes over, by walking up the names.
TEST(RemoveJoints, HandsInfluenceToTheNearestKeptAncestor) {
  for (const char* rig : kRigs) {
    const Bytes bytes = golden::read_rig(rig);
    const DocumentHandle before = document_of(bytes), after = document_of(bytes);
    const auto names = strings_of(before, "defn.jointNames");
    const auto parents = integers_of(before, "defn.jointHierarchy");
    Random random(7, 1);
    std::set<size_t> gone;
    Indices indices;
    for (uint32_t j = 0; j < names.size(); ++j) {
      if (parents[j] != j && random.below(3) == 0) {
        gone.insert(j);
        indices.push_back(j);
      }
    }
    if (indices.empty())
      indices.push_back(static_cast<uint32_t>(names.size() - 1)), gone.insert(names.size() - 1);
    MienError error = sized<MienError>();
    ASSERT_EQ(remove(after, MIEN_KIND_JOINT, indices, &error), MIEN_OK) << error.message;
    std::vector<std::string> kept;
    for (size_t j = 0; j < names.size(); ++j) {
      if (!gone.count(j)) kept.push_back(names[j]);
    }
    EXPECT_EQ(strings_of(after, "defn.jointNames"), kept);
    const auto heir = [&](size_t j) {
      while (gone.count(j) && parents[j] != static_cast<int64_t>(j))
        j = static_cast<size_t>(parents[j]);
      return gone.count(j) ? kept[0] : names[j];
    };
    const auto new_parents = integers_of(after, "defn.jointHierarchy");
    for (size_t k = 0, j = 0; k < kept.size(); ++k, ++j) {
      while (gone.count(j)) ++j;
      if (parents[j] != static_cast<int64_t>(j)) {
        EXPECT_EQ(kept[static_cast<size_t>(new_parents[k])], heir(static_cast<size_t>(parents[j])))
            << kept[k];
      }
    }
    const size_t meshes = field_of(before, "geom.meshes").count;
    for (size_t m = 0; m < meshes; ++m) {
      const std::string list = "geom.meshes[" + std::to_string(m) + "].skinWeights";
      const size_t vertices = field_of(before, list).count;
      for (size_t v = 0; v < vertices; ++v) {
        const std::string vertex = list + "[" + std::to_string(v) + "]";
        const auto joints = integers_of(before, vertex + ".jointIndices");
        const auto weights = floats_of(before, vertex + ".weights");
        std::map<std::string, double> wanted, found;
        for (size_t i = 0; i < joints.size(); ++i)
          wanted[heir(static_cast<size_t>(joints[i]))] += weights[i];
        const auto new_joints = integers_of(after, vertex + ".jointIndices");
        const auto new_weights = floats_of(after, vertex + ".weights");
        for (size_t i = 0; i < new_joints.size(); ++i) {
          EXPECT_TRUE(
              found.emplace(kept[static_cast<size_t>(new_joints[i])], new_weights[i]).second)
              << vertex;
        }
        ASSERT_EQ(found.size(), wanted.size()) << vertex;
        for (const auto& [name, weight] : wanted)
          ASSERT_NEAR(found[name], weight, 1e-6) << vertex << name;
      }
    }
    ASSERT_EQ(mien_document_undo(after.get(), 0, nullptr), MIEN_OK);
    EXPECT_EQ(bytes_of(after), bytes) << rig;
  }
}

TEST(RemoveJoints, LeavesWhatTheOthersDo) {
  for (const char* rig : kRigs) {
    const Bytes bytes = golden::read_rig(rig);
    const DocumentHandle document = document_of(bytes);
    const auto parents = integers_of(document, "defn.jointHierarchy");
    const auto quaternions = quaternion_joints(document);
    Indices indices;
    for (uint32_t j = 1; j < parents.size(); j += 3) {
      if (parents[j] != j) indices.push_back(j);
    }
    ASSERT_EQ(remove(document, MIEN_KIND_JOINT, indices), MIEN_OK);
    const DnaHandle before = open_dna(bytes), after = dna_of(document);
    MienDnaInfo info = sized<MienDnaInfo>();
    ASSERT_EQ(mien_dna_info(before.get(), &info), MIEN_OK);
    for (uint32_t lod = 0; lod < info.lod_count; ++lod) {
      SCOPED_TRACE(std::string(rig) + " LOD " + std::to_string(lod));
      expect_same(evaluate(before, lod), evaluate(after, lod), quaternions);
    }
  }
}

/// Row-vector matrices by the formulas of docs/rig-evaluation.md, for xyz with degrees or radians.
struct Place {
  double m[3][3];
  double t[3];
};
Place local_place(const DocumentHandle& d, size_t j) {
  double a[3];
  Place p = {};
  const char* axes[] = {"xs", "ys", "zs"};
  const bool radians = integers_of(d, "desc.rotationUnit")[0] == 1;
  for (int k = 0; k < 3; ++k) {
    float value = 0;
    EXPECT_EQ(mien_document_read_floats(
                  d.get(), (std::string("defn.neutralJointRotations.") + axes[k]).c_str(), j, 1,
                  &value, nullptr),
              MIEN_OK);
    a[k] = value * (radians ? 1 : 3.14159265358979323846 / 180);
    EXPECT_EQ(mien_document_read_floats(
                  d.get(), (std::string("defn.neutralJointTranslations.") + axes[k]).c_str(), j, 1,
                  &value, nullptr),
              MIEN_OK);
    p.t[k] = value;
  }
  const double sx = std::sin(a[0]), cx = std::cos(a[0]), sy = std::sin(a[1]), cy = std::cos(a[1]),
               sz = std::sin(a[2]), cz = std::cos(a[2]);
  const double m[3][3] = {{cy * cz, cy * sz, -sy},
                          {sx * sy * cz - cx * sz, sx * sy * sz + cx * cz, sx * cy},
                          {cx * sy * cz + sx * sz, cx * sy * sz - sx * cz, cx * cy}};
  memcpy(p.m, m, sizeof(m));
  return p;
}
Place times(const Place& a, const Place& b) {
  Place out = {};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      for (int k = 0; k < 3; ++k) out.m[r][c] += a.m[r][k] * b.m[k][c];
    }
  }
  for (int c = 0; c < 3; ++c) {
    out.t[c] = b.t[c];
    for (int k = 0; k < 3; ++k) out.t[c] += a.t[k] * b.m[k][c];
  }
  return out;
}
std::map<std::string, Place> world_places(const DocumentHandle& d) {
  std::map<std::string, Place> places;
  const auto names = strings_of(d, "defn.jointNames");
  const auto parents = integers_of(d, "defn.jointHierarchy");
  for (size_t j = 0; j < names.size(); ++j) {
    Place p = local_place(d, j);
    for (size_t up = j; parents[up] != static_cast<int64_t>(up);) {
      up = static_cast<size_t>(parents[up]);
      p = times(p, local_place(d, up));
    }
    places[names[j]] = p;
  }
  return places;
}

TEST(RemoveJoints, KeepsTheOthersWhereTheyAre) {
  for (const char* rig : {"tiny", "small", "body"}) {
    const Bytes bytes = golden::read_rig(rig);
    const DocumentHandle before = document_of(bytes), after = document_of(bytes);
    if (integers_of(before, "dsce.rotationSequence")[0] != 0 ||
        integers_of(before, "dsce.rotationSign.y")[0] != 1)
      continue;
    const auto parents = integers_of(before, "defn.jointHierarchy");
    std::set<int64_t> inner(parents.begin(), parents.end());  // that have children; also the root
    Indices indices;
    for (int64_t j : inner) {
      if (indices.size() < inner.size() / 2 + 1) indices.push_back(static_cast<uint32_t>(j));
    }
    ASSERT_EQ(remove(after, MIEN_KIND_JOINT, indices), MIEN_OK) << rig;
    const auto old_places = world_places(before), new_places = world_places(after);
    for (const auto& [name, place] : new_places) {
      const Place& old = old_places.at(name);
      for (int r = 0; r < 3; ++r) {
        EXPECT_NEAR(place.t[r], old.t[r], 1e-4 * (1 + std::abs(old.t[r]))) << rig << name;
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(place.m[r][c], old.m[r][c], 2e-5) << rig << name;
      }
    }
    EXPECT_TRUE(dna_of(after));
  }
}

TEST(Remove, ChannelsMapsAndMeshesTakeWhatRefersToThem) {
  for (const char* rig : kRigs) {
    const Bytes bytes = golden::read_rig(rig);
    const struct {
      uint32_t kind;
      const char* names;
    } kinds[] = {{MIEN_KIND_BLEND_SHAPE_CHANNEL, "defn.blendShapeChannelNames"},
                 {MIEN_KIND_ANIMATED_MAP, "defn.animatedMapNames"},
                 {MIEN_KIND_MESH, "defn.meshNames"}};
    for (const auto& [kind, path] : kinds) {
      const DocumentHandle document = document_of(bytes);
      const auto names = strings_of(document, path);
      if (names.empty()) continue;
      std::map<std::string, std::set<std::string>> targets;  // [mesh] channels
      const auto collect = [](const DocumentHandle& d) {
        std::map<std::string, std::set<std::string>> found;
        const auto channels = strings_of(d, "defn.blendShapeChannelNames");
        const auto meshes = strings_of(d, "defn.meshNames");
        for (size_t m = 0; m < meshes.size(); ++m) {
          const std::string list = "geom.meshes[" + std::to_string(m) + "].blendShapeTargets";
          for (size_t t = 0; t < field_of(d, list).count; ++t) {
            const auto channel =
                integers_of(d, list + "[" + std::to_string(t) + "].blendShapeChannelIndex")[0];
            found[meshes[m]].insert(channels[static_cast<size_t>(channel)]);
          }
        }
        return found;
      };
      const auto before_targets = collect(document);
      Indices indices;
      std::set<std::string> gone;
      for (uint32_t i = 0; i < names.size(); i += 2) {
        indices.push_back(i);
        gone.insert(names[i]);
      }
      MienError error = sized<MienError>();
      ASSERT_EQ(remove(document, kind, indices, &error), MIEN_OK) << rig << error.message;
      std::vector<std::string> kept;
      for (const std::string& name : names) {
        if (!gone.count(name)) kept.push_back(name);
      }
      EXPECT_EQ(strings_of(document, path), kept) << rig;
      auto wanted = before_targets;
      for (auto it = wanted.begin(); it != wanted.end();) {
        for (const std::string& name : gone) {
          if (kind == MIEN_KIND_BLEND_SHAPE_CHANNEL) it->second.erase(name);
        }
        it = it->second.empty() || (kind == MIEN_KIND_MESH && gone.count(it->first))
                 ? wanted.erase(it)
                 : std::next(it);
      }
      EXPECT_EQ(collect(document), wanted) << rig;
      const Bytes after = bytes_of(document);
      if (kind != MIEN_KIND_MESH) expect_untouched(bytes, after, {"defn", "bhvr", "geom"});
      const DnaHandle old_dna = open_dna(bytes), new_dna = open_dna(after);
      expect_same(evaluate(old_dna, 0), evaluate(new_dna, 0));
      EXPECT_EQ(evaluate(old_dna, 0).joints, evaluate(new_dna, 0).joints) << rig;
      ASSERT_EQ(mien_document_undo(document.get(), 0, nullptr), MIEN_OK);
      EXPECT_EQ(bytes_of(document), bytes);
    }
  }
}

TEST(Clear, RemovesTargetsMapsAndJointAnimation) {
  for (const char* rig : kRigs) {
    const Bytes bytes = golden::read_rig(rig);
    const DocumentHandle document = document_of(bytes);
    ASSERT_EQ(mien_document_clear(document.get(), MIEN_KIND_BLEND_SHAPE_CHANNEL, nullptr), MIEN_OK);
    ASSERT_EQ(mien_document_clear(document.get(), MIEN_KIND_ANIMATED_MAP, nullptr), MIEN_OK);
    EXPECT_EQ(field_of(document, "defn.blendShapeChannelNames").count, 0u);
    EXPECT_EQ(field_of(document, "bhvr.blendShapeChannels.outputIndices").count, 0u);
    EXPECT_EQ(field_of(document, "defn.meshBlendShapeChannelMapping.from").count, 0u);
    EXPECT_EQ(field_of(document, "bhvr.animatedMaps.conditionals.cutValues").count, 0u);
    const Evaluated before = evaluate(open_dna(bytes), 0), after = evaluate(dna_of(document), 0);
    EXPECT_EQ(before.joints, after.joints) << rig;

    // One joint, then all.
    const uint32_t joint = 1;
    ASSERT_EQ(mien_document_clear_joints(document.get(), &joint, 1, nullptr), MIEN_OK);
    const Evaluated without = evaluate(dna_of(document), 0);
    const bool all_euler = quaternion_joints(document).empty();
    for (size_t frame = 0; frame < before.joints.size(); ++frame) {
      for (size_t i = 0; i < before.joints[frame].size(); ++i) {
        if (i / 9 == joint) {
          EXPECT_EQ(without.joints[frame][i], 0);
        } else if (all_euler) {
          EXPECT_EQ(without.joints[frame][i], before.joints[frame][i]);
        }
      }
    }
    ASSERT_EQ(mien_document_clear(document.get(), MIEN_KIND_JOINT, nullptr), MIEN_OK);
    for (const auto& frame : evaluate(dna_of(document), 0).joints) {
      for (float value : frame) EXPECT_EQ(value, 0);
    }
  }
}

TEST(Remove, RefusesWhatCannotGo) {
  const Bytes bytes = golden::read_rig("small");
  const DocumentHandle document = document_of(bytes);
  MienError error = sized<MienError>();
  EXPECT_EQ(remove(document, MIEN_KIND_ML_CONTROL, {0}, &error), MIEN_ERROR_INDEX);
  EXPECT_EQ(remove(document, MIEN_KIND_JOINT, {60000}, &error), MIEN_ERROR_INDEX);
  Indices all;
  for (uint32_t j = 0; j < field_of(document, "defn.jointNames").count; ++j) all.push_back(j);
  EXPECT_EQ(remove(document, MIEN_KIND_JOINT, all, &error), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(std::string(error.message).find("every joint"), std::string::npos) << error.message;
  EXPECT_EQ(mien_document_clear(document.get(), MIEN_KIND_MESH, &error),
            MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(bytes_of(document), bytes);
  // A document that is not valid.
  ASSERT_EQ(write_integers(document, "defn.jointHierarchy", {5000}), MIEN_OK);
  EXPECT_EQ(remove(document, MIEN_KIND_JOINT, {1}, &error), MIEN_ERROR_DNA_REFERENCE);
  EXPECT_NE(std::string(error.message).find("jointHierarchy"), std::string::npos) << error.message;
}

}  // namespace
}  // namespace mien
