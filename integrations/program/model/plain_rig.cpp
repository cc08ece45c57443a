// SPDX-License-Identifier: MIT
#include "integrations/program/model/plain_rig.h"

#include <algorithm>
#include <cmath>

namespace mien::model {

namespace {

double clamp01(double value) { return std::fmin(std::fmax(value, 0), 1); }

bool fires(const PlainRow& row, double value) {
  return std::fmin(row.from, row.to) <= value && value <= std::fmax(row.from, row.to);
}

uint16_t at_lod(const std::vector<uint16_t>& lods, uint32_t lod) {
  return lod < lods.size() ? lods[lod] : uint16_t{0};
}

bool is_zero_row(const PlainGroup& group, size_t row) {
  const size_t columns = group.inputs.size();
  for (size_t c = 0; c < columns; ++c) {
    if (group.values[row * columns + c] != 0) return false;
  }
  return true;
}

}  // namespace

std::vector<double> forward_plain(const PlainTable& table, size_t row_count,
                                  const std::vector<double>& inputs, size_t output_count) {
  std::vector<double> outputs(output_count, 0.0);
  bool skipping = false;
  for (size_t r = 0; r < row_count; ++r) {
    const PlainRow& row = table[r];
    const bool goes_on =
        r > 0 && row.input == table[r - 1].input && row.output == table[r - 1].output;
    if (!goes_on) skipping = false;
    if (skipping || !fires(row, inputs[row.input])) continue;
    outputs[row.output] += double{row.slope} * inputs[row.input] + double{row.cut};
    skipping = true;
  }
  for (double& output : outputs) output = clamp01(output);
  return outputs;
}

std::vector<float> backward_plain(const PlainTable& table, const std::vector<float>& raw,
                                  size_t gui_count) {
  std::vector<float> gui(gui_count, 0.0f);
  for (size_t i = 0; i < gui_count; ++i) {
    // Rows of this input, in groups of equal intervals.
    std::vector<PlainTable> groups;
    for (const PlainRow& row : table) {
      if (row.input != i) continue;
      const auto same = std::find_if(groups.begin(), groups.end(), [&](const PlainTable& group) {
        return std::min(group[0].from, group[0].to) == std::min(row.from, row.to) &&
               std::max(group[0].from, group[0].to) == std::max(row.from, row.to);
      });
      if (same == groups.end()) {
        groups.push_back({row});
      } else {
        same->push_back(row);
      }
    }
    const auto solve = [&](const PlainRow& row) { return (raw[row.output] - row.cut) / row.slope; };
    const auto solved = [&](const PlainRow& row) {
      return row.slope != 0 && fires(row, solve(row));
    };

    long most = -1;
    const PlainTable* best = nullptr;
    for (const PlainTable& group : groups) {
      const long consistent = std::count_if(group.begin(), group.end(), [&](const PlainRow& row) {
        return raw[row.output] != 0 && solved(row);
      });
      if (consistent <= most) continue;
      most = consistent;
      best = &group;
    }
    if (!best) continue;
    const auto row = std::find_if(best->begin(), best->end(), solved);
    if (row != best->end()) gui[i] = solve(*row);
  }
  return gui;
}

std::vector<uint8_t> needed_psds(const PlainRig& plain, uint32_t lod) {
  std::vector<uint8_t> read(65536, 0);  // inputs may also be controls of other layers
  for (const PlainGroup& group : plain.groups) {
    const size_t columns = group.inputs.size();
    for (size_t i = 0; i < at_lod(group.lods, lod) * columns; ++i) {
      if (group.values[i] != 0) read[group.inputs[i % columns]] = 1;
    }
  }
  for (size_t r = 0; r < at_lod(plain.channel_lods, lod); ++r) read[plain.channel_inputs[r]] = 1;
  for (size_t r = 0; r < at_lod(plain.map_lods, lod); ++r) read[plain.maps[r].input] = 1;
  for (bool changed = true; changed;) {
    changed = false;
    for (const PlainPsd& triple : plain.psds) {
      if (!read[triple.row] || read[triple.column]) continue;
      read[triple.column] = 1;
      changed = true;
    }
  }
  return {read.begin() + plain.raw_count, read.begin() + plain.raw_count + plain.psd_count};
}

namespace {

/// Triples of each corrective.
using PsdTriples = std::vector<std::vector<PlainPsd>>;

PsdTriples triples_of(const PlainRig& plain) {
  PsdTriples triples(plain.psd_count);
  for (const PlainPsd& triple : plain.psds) {
    triples[triple.row - plain.raw_count].push_back(triple);
  }
  return triples;
}

double psd_value(const PlainRig& plain, const PsdTriples& triples, size_t psd,
                 const std::vector<double>& controls) {
  double product = 1;
  for (const PlainPsd& triple : triples[psd]) {
    const size_t other = size_t{triple.column} - plain.raw_count;  // huge for a raw control
    const double input = other < plain.psd_count ? psd_value(plain, triples, other, controls)
                                                 : controls[triple.column];
    product *= double{triple.value} * clamp01(input);
  }
  return triples[psd].empty() ? 0.0 : std::fmin(product, 1.0);
}

}  // namespace

void model_psds(const PlainRig& plain, std::vector<double>& controls) {
  const PsdTriples triples = triples_of(plain);
  for (size_t p = 0; p < plain.psd_count; ++p) {
    controls[plain.raw_count + p] = psd_value(plain, triples, p, controls);
  }
}

std::vector<double> plain_channels(const PlainRig& plain, const std::vector<double>& controls,
                                   uint32_t lod) {
  std::vector<double> channels(plain.channel_count, 0.0);
  for (size_t r = 0; r < at_lod(plain.channel_lods, lod); ++r) {
    channels[plain.channel_outputs[r]] = controls[plain.channel_inputs[r]];
  }
  return channels;
}

std::vector<double> plain_maps(const PlainRig& plain, const std::vector<double>& controls,
                               uint32_t lod) {
  return forward_plain(plain.maps, at_lod(plain.map_lods, lod), controls, plain.map_count);
}

PlainResults evaluate_plain(const PlainRig& plain, const std::vector<float>& raw, uint32_t lod) {
  PlainResults out;
  out.controls.assign(raw.begin(), raw.end());
  out.controls.resize(size_t{plain.raw_count} + plain.psd_count, 0.0);
  const std::vector<uint8_t> needed = needed_psds(plain, lod);
  const PsdTriples triples = triples_of(plain);
  for (size_t p = 0; p < plain.psd_count; ++p) {
    if (needed[p]) out.controls[plain.raw_count + p] = psd_value(plain, triples, p, out.controls);
  }

  out.joints.assign(9 * size_t{plain.joint_count}, 0.0);
  out.joint_products = out.joints;
  for (const PlainGroup& group : plain.groups) {
    const size_t columns = group.inputs.size();
    for (size_t r = 0; r < at_lod(group.lods, lod); ++r) {
      if (is_zero_row(group, r)) continue;
      double sum = 0, products = 0;
      for (size_t c = 0; c < columns; ++c) {
        const double product =
            double{group.values[r * columns + c]} * out.controls[group.inputs[c]];
        sum += product;
        products += std::fabs(product);
      }
      out.joints[group.outputs[r]] = sum;
      out.joint_products[group.outputs[r]] = products;
    }
  }

  out.channels = plain_channels(plain, out.controls, lod);
  out.maps = plain_maps(plain, out.controls, lod);
  return out;
}

}  // namespace mien::model
