// SPDX-License-Identifier: MIT
#include "integrations/program/model/plain_rig.h"

#include <algorithm>
#include <cmath>

namespace mien::model {

namespace {

bool fires(const PlainRow& row, double value) {
  return std::fmin(row.from, row.to) <= value && value <= std::fmax(row.from, row.to);
}

uint16_t at_lod(const std::vector<uint16_t>& lods, uint32_t lod) {
  return lod < lods.size() ? lods[lod] : uint16_t{0};
}

/// Where two intervals of a run meet, the first row gives the value, and the steeper one the derivative.
double row_value(const PlainRow& row, double, double input) {
  return double{row.slope} * input + double{row.cut};
}
Dual row_value(const PlainRow& row, double steepest, const Dual& input) {
  return {row_value(row, steepest, input.value), steepest * input.slope};
}

bool is_zero_row(const PlainGroup& group, size_t row) {
  const size_t columns = group.inputs.size();
  for (size_t c = 0; c < columns; ++c) {
    if (group.values[row * columns + c] != 0) return false;
  }
  return true;
}

}  // namespace

template <class T>
std::vector<T> forward_plain(const PlainTable& table, size_t row_count,
                             const std::vector<T>& inputs, size_t output_count) {
  std::vector<T> outputs(output_count, 0.0);
  const auto same_pair = [&](size_t a, size_t b) {
    return table[a].input == table[b].input && table[a].output == table[b].output;
  };
  bool skipping = false;
  for (size_t r = 0; r < row_count; ++r) {
    const PlainRow& row = table[r];
    const T& input = inputs[row.input];
    if (r == 0 || !same_pair(r - 1, r)) skipping = false;
    if (skipping || !fires(row, value_of(input))) continue;
    double steepest = row.slope;
    for (size_t next = r + 1; next < row_count && same_pair(r, next); ++next) {
      const double slope = table[next].slope;
      if (!fires(table[next], value_of(input))) continue;
      if (std::fabs(slope) > std::fabs(steepest)) steepest = slope;
    }
    outputs[row.output] += row_value(row, steepest, input);
    skipping = true;
  }
  for (T& output : outputs) output = clamp01(output);
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

template <class T>
T psd_value(const PlainRig& plain, const PsdTriples& triples, size_t psd,
            const std::vector<T>& controls) {
  T product = 1;
  for (const PlainPsd& triple : triples[psd]) {
    const size_t other = size_t{triple.column} - plain.raw_count;  // huge for a raw control
    const T input = other < plain.psd_count ? psd_value(plain, triples, other, controls)
                                            : controls[triple.column];
    product *= double{triple.value} * clamp01(input);
  }
  if (triples[psd].empty()) return 0;
  return product > 1 ? T(1) : product;
}

}  // namespace

template <class T>
void model_psds(const PlainRig& plain, std::vector<T>& controls) {
  const PsdTriples triples = triples_of(plain);
  for (size_t p = 0; p < plain.psd_count; ++p) {
    controls[plain.raw_count + p] = psd_value(plain, triples, p, controls);
  }
}

template <class T>
std::vector<T> plain_channels(const PlainRig& plain, const std::vector<T>& controls, uint32_t lod) {
  std::vector<T> channels(plain.channel_count, 0.0);
  for (size_t r = 0; r < at_lod(plain.channel_lods, lod); ++r) {
    channels[plain.channel_outputs[r]] = controls[plain.channel_inputs[r]];
  }
  return channels;
}

template <class T>
std::vector<T> plain_maps(const PlainRig& plain, const std::vector<T>& controls, uint32_t lod) {
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

#define MIEN_MODEL_PLAIN(T)                                                                        \
  template std::vector<T> forward_plain(const PlainTable&, size_t, const std::vector<T>&, size_t); \
  template void model_psds(const PlainRig&, std::vector<T>&);                                      \
  template std::vector<T> plain_channels(const PlainRig&, const std::vector<T>&, uint32_t);        \
  template std::vector<T> plain_maps(const PlainRig&, const std::vector<T>&, uint32_t);
MIEN_MODEL_PLAIN(double)
MIEN_MODEL_PLAIN(Dual)

}  // namespace mien::model
