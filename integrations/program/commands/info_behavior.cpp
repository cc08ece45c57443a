// SPDX-License-Identifier: MIT
#include "integrations/program/commands/info_behavior.h"

#include <set>

#include "integrations/program/io/dna_fields.h"

namespace mien::cli {

namespace {

/// Counts a number among the names that the format gives to 0, 1, 2, ...
void count(Tally& tally, int64_t number) {
  if (number >= 0 && static_cast<size_t>(number) < tally.kinds.size()) {
    ++tally.kinds[static_cast<size_t>(number)].second;
  }
}

/// Calls f(path) for every element of a list.
template <class F>
void for_each(const RigFile& file, const std::string& list, F&& f) {
  const uint64_t elements = field_count(file, list);
  for (uint64_t i = 0; i < elements; ++i) f(element(list, i));
}

Tally tally_rotations(const RigFile& file) {
  Tally tally = {"joint_rotations", "joints turn by", {{"euler angles", 0}, {"quaternions", 0}}};
  uint64_t listed = 0;
  for_each(file, "jbmd.jointRepresentations", [&](const std::string& joint) {
    count(tally, read_integer(file, joint + ".rotation"));
    ++listed;
  });
  if (file.info.joint_count > listed) tally.kinds[0].second += file.info.joint_count - listed;
  return tally;
}

void tally_solvers(const RigFile& file, std::vector<Tally>& tallies) {
  Tally types = {"rbf_types", "RBF solvers", {{"additive", 0}, {"interpolative", 0}}};
  Tally distances = {"rbf_distances",
                     "RBF distances",
                     {{"euclidean", 0}, {"quaternion", 0}, {"swing", 0}, {"twist", 0}}};
  Tally functions = {
      "rbf_functions",
      "RBF weights",
      {{"gaussian", 0}, {"exponential", 0}, {"linear", 0}, {"cubic", 0}, {"quintic", 0}}};
  for_each(file, "rbfb.solvers", [&](const std::string& solver) {
    count(types, read_integer(file, solver + ".solverType"));
    count(distances, read_integer(file, solver + ".distanceMethod"));
    count(functions, read_integer(file, solver + ".functionType"));
  });
  tallies.insert(tallies.end(), {types, distances, functions});
}

Tally tally_followers(const RigFile& file) {
  Tally tally = {"following_joints", "joints follow by", {{"twist", 0}, {"swing", 0}}};
  for_each(file, "twsw.twists", [&](const std::string& twist) {
    tally.kinds[0].second += field_count(file, twist + ".twistOutputJointIndices");
  });
  for_each(file, "twsw.swings", [&](const std::string& swing) {
    tally.kinds[1].second += field_count(file, swing + ".swingOutputJointIndices");
  });
  return tally;
}

void tally_networks(const RigFile& file, std::vector<Tally>& tallies) {
  Tally regions = {"ml_regions", "mesh regions", {{"with masks", 0}}};
  Tally activations = {
      "ml_activations",
      "network layers",
      {{"linear", 0}, {"relu", 0}, {"leaky relu", 0}, {"tanh", 0}, {"sigmoid", 0}}};
  Tally operations = {
      "ml_operations",
      "ML operations",
      {{"unspecified", 0}, {"gather", 0}, {"scatter", 0}, {"network", 0}, {"weighted sum", 0}}};
  for_each(file, "mlbh.neuralNetworkToMeshRegion.indices",
           [&](const std::string& mesh) { regions.kinds[0].second += field_count(file, mesh); });
  for_each(file, "mlbh.neuralNetworks", [&](const std::string& network) {
    for_each(file, network + ".layers", [&](const std::string& layer) {
      count(activations, read_integer(file, layer + ".functionId"));
    });
  });
  for_each(file, "mlbe.mlbTypeData", [&](const std::string& type) {
    for_each(file, type + ".operations", [&](const std::string& set) {
      for_each(file, set, [&](const std::string& operation) {
        count(operations, read_integer(file, operation + ".operationType"));
      });
    });
  });
  tallies.insert(tallies.end(), {regions, activations, operations});
}

/// Values per joint by the keys 0, 1, 2: translation, rotation, scale; keys from 3 on are a system.
Tally tally_ml_joints(const RigFile& file) {
  Tally tally = {"ml_joints",
                 "ML moves joints",
                 {{"by euler angles", 0}, {"by quaternions", 0}, {"without turning", 0}}};
  const std::vector<int64_t> keys = read_integers(file, "mlbe.mlbJoints.parameterKeys");
  const std::vector<int64_t> values = read_integers(file, "mlbe.mlbJoints.parameterValues");
  int64_t widths[3] = {};
  for (size_t i = 0; i < keys.size() && i < values.size(); ++i) {
    if (keys[i] < 3) widths[keys[i]] = keys[i] == 1 && values[i] == 1 ? 4 : 3;
  }
  const int64_t attributes = widths[0] + widths[1] + widths[2];
  if (attributes == 0) return tally;
  std::set<int64_t> joints;
  for (const int64_t output : read_integers(file, "mlbe.mlbJoints.outputIndices")) {
    joints.insert(output / attributes);
  }
  tally.kinds[widths[1] == 3 ? 0 : widths[1] == 4 ? 1 : 2].second = joints.size();
  return tally;
}

}  // namespace

bool Tally::empty() const {
  for (const auto& kind : kinds) {
    if (kind.second != 0) return false;
  }
  return true;
}

std::vector<Tally> tally_behavior(const RigFile& file) {
  std::vector<Tally> tallies = {tally_rotations(file)};
  tally_solvers(file, tallies);
  tallies.push_back(tally_followers(file));
  tally_networks(file, tallies);
  tallies.push_back(tally_ml_joints(file));
  return tallies;
}

}  // namespace mien::cli
