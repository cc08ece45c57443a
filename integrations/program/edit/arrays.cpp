// SPDX-License-Identifier: MIT
#include "integrations/program/edit/arrays.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "integrations/program/io/dna_fields.h"
#include "integrations/program/io/input.h"
#include "integrations/program/io/json_check.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/npy_reader.h"
#include "integrations/program/mesh/mesh_file.h"

namespace mien::cli {

namespace {

using Json = nlohmann::json;

std::string ending_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 'a' - 'A') : c;
  return ending;
}

[[noreturn]] void fail_ending(const Document& document, const std::string& path,
                              const char* endings) {
  fail_edit(document, path + " is not of a kind that is read here",
            std::string("give a file that ends with ") + endings);
}

[[noreturn]] void fail_array(const std::string& path, const std::string& where,
                             const std::string& why, const std::string& what_to_do) {
  fail(kInvalid, "invalid array", where.empty() ? path : path + ", " + where, why, what_to_do);
}

Json read_json_array(const std::string& path, const char* example) {
  return parse_json<Json>(read_text(path, "cannot read array"), "invalid array", path, example);
}

float finite_number(const Json& value, const std::string& path, size_t row) {
  const bool is_number = value.is_number();
  const float number = is_number ? value.get<float>() : 0;
  if (is_number && std::isfinite(number)) return number;
  fail_array(path, "row " + std::to_string(row), "holds a value that is not a finite float",
             "give finite numbers");
}

std::vector<float> read_table(const Document& document, const std::string& path, size_t rows) {
  const std::string ending = ending_of(path);
  std::vector<float> numbers;
  size_t found = 0;
  if (ending == ".npy") {
    NpyArray array = read_npy(read_any_bytes(path, "cannot read array"), path);
    if (array.shape.size() != 2 || array.shape[1] != 3) {
      fail_array(path, "", "the shape is not (positions, 3)", "save it so");
    }
    found = array.shape[0];
    numbers = std::move(array.numbers);
  } else if (ending == ".json") {
    const char* const example = "write [[x, y, z], ...]";
    const Json table = read_json_array(path, example);
    if (!table.is_array()) fail_array(path, "", "this is not a list of rows", example);
    for (const Json& row : table) {
      if (!row.is_array() || row.size() != 3) {
        fail_array(path, "row " + std::to_string(found), "not 3 numbers", example);
      }
      for (const Json& value : row) numbers.push_back(finite_number(value, path, found));
      ++found;
    }
  } else {
    fail_ending(document, path, ".obj, .npy or .json");
  }
  if (found != rows) {
    fail_array(path, "",
               "it has " + std::to_string(found) + " rows and the mesh " + std::to_string(rows) +
                   " positions",
               "give one row for each position, in the order of the file");
  }
  return numbers;
}

std::vector<float> read_obj_positions(const std::string& path, size_t count) {
  const MeshFile mesh = read_mesh_file(path);
  if (mesh.position_count() != count) {
    fail_mesh(path, "",
              "it has " + std::to_string(mesh.position_count()) + " positions and the mesh " +
                  std::to_string(count),
              "give the vertices of the mesh alone, in their order");
  }
  return std::vector<float>(mesh.positions.begin(), mesh.positions.end());
}

/// One row after the other, each with its own number of influences, then as rows of one length.
struct SparseRows {
  std::vector<std::vector<std::pair<uint16_t, float>>> rows;

  WeightRows packed() const {
    WeightRows packed;
    for (const auto& row : rows) {
      packed.influences = std::max(packed.influences, static_cast<uint32_t>(row.size()));
    }
    packed.influences = std::max(packed.influences, 1u);
    for (const auto& row : rows) {
      for (uint32_t i = 0; i < packed.influences; ++i) {
        packed.joints.push_back(i < row.size() ? row[i].first : uint16_t{0});
        packed.weights.push_back(i < row.size() ? row[i].second : 0.0f);
      }
    }
    return packed;
  }
};

SparseRows weights_from_npy(const std::string& path, uint64_t joint_count) {
  const NpyArray array = read_npy(read_any_bytes(path, "cannot read array"), path);
  if (array.shape.size() != 2 || array.shape[1] != joint_count) {
    fail_array(path, "", "the shape is not (positions, " + std::to_string(joint_count) + " joints)",
               "give a column for each joint of the file");
  }
  SparseRows sparse;
  sparse.rows.resize(array.shape[0]);
  for (size_t i = 0; i < array.numbers.size(); ++i) {
    if (array.numbers[i] == 0) continue;
    sparse.rows[i / joint_count].emplace_back(static_cast<uint16_t>(i % joint_count),
                                              array.numbers[i]);
  }
  return sparse;
}

SparseRows weights_from_json(const Document& document, const std::string& path,
                             uint64_t joint_count) {
  const char* const example = "write [[[\"FACIAL_C_Jaw\", 0.5], [\"head\", 0.5]], ...]";
  const Json table = read_json_array(path, example);
  if (!table.is_array()) fail_array(path, "", "this is not a list of rows", example);
  SparseRows sparse;
  for (const Json& row : table) {
    const size_t number = sparse.rows.size();
    sparse.rows.emplace_back();
    bool valid = row.is_array();
    for (size_t i = 0; valid && i < row.size(); ++i) {
      const Json& pair = row[i];
      valid = pair.is_array() && pair.size() == 2 &&
              (pair[0].is_string() || (pair[0].is_number_unsigned() && pair[0] < joint_count));
      if (!valid) break;
      const uint32_t joint = pair[0].is_string() ? find_element(document, MIEN_KIND_JOINT, pair[0])
                                                 : pair[0].get<uint32_t>();
      sparse.rows.back().emplace_back(static_cast<uint16_t>(joint),
                                      finite_number(pair[1], path, number));
    }
    if (!valid) {
      fail_array(path, "row " + std::to_string(number), "not a list of joints and weights",
                 example);
    }
  }
  return sparse;
}

}  // namespace

std::vector<float> read_positions(const Document& document, const std::string& path,
                                  const std::vector<float>& current) {
  const size_t count = current.size() / 3;
  return ending_of(path) == ".obj" ? read_obj_positions(path, count)
                                   : read_table(document, path, count);
}

std::vector<float> read_deltas(const Document& document, const std::string& path,
                               const std::vector<float>& current) {
  if (ending_of(path) != ".obj") return read_table(document, path, current.size() / 3);
  std::vector<float> deltas = read_obj_positions(path, current.size() / 3);
  for (size_t i = 0; i < deltas.size(); ++i) deltas[i] -= current[i];
  return deltas;
}

WeightRows read_weight_rows(const Document& document, const std::string& path,
                            size_t position_count) {
  const uint64_t joint_count = field_count(document, "defn.jointNames");
  const std::string ending = ending_of(path);
  if (ending != ".npy" && ending != ".json") fail_ending(document, path, ".npy or .json");
  const SparseRows sparse = ending == ".npy" ? weights_from_npy(path, joint_count)
                                             : weights_from_json(document, path, joint_count);
  if (sparse.rows.size() != position_count) {
    fail_array(path, "",
               "it has " + std::to_string(sparse.rows.size()) + " rows and the mesh " +
                   std::to_string(position_count) + " positions",
               "give one row for each position");
  }
  return sparse.packed();
}

}  // namespace mien::cli
