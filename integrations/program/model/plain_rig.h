// SPDX-License-Identifier: MIT
// A rig as plain vectors, evaluated in double precision, as slowly and literally as the formulas of
// docs/rig-evaluation.md read. It shares no code with the library, so that the two can be compared: the
// tests do, and `mien accept`. T is double, or Dual, whose derivatives tests compare.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "integrations/program/model/dual.h"

namespace mien::model {

struct PlainRow {  // of a conditional table
  uint16_t input, output;
  float from, to, slope, cut;
};
using PlainTable = std::vector<PlainRow>;

struct PlainPsd {  // one triple
  uint16_t row, column;
  float value;
};

struct PlainGroup {
  std::vector<uint16_t> lods, inputs, outputs;
  std::vector<float> values;  // row-major
};

/// Joints, channels and maps exist at every LOD; only rows come and go. No layers beyond behavior.
struct PlainRig {
  uint16_t lod_count = 1;
  uint16_t gui_count = 0, raw_count = 0, psd_count = 0;
  uint16_t joint_count = 0, channel_count = 0, map_count = 0;
  PlainTable gui_to_raw;
  std::vector<PlainPsd> psds;
  std::vector<PlainGroup> groups;
  std::vector<uint16_t> channel_lods, channel_inputs, channel_outputs;
  std::vector<uint16_t> map_lods;
  PlainTable maps;
};

/// What evaluation gives, and how much it may be off: the sum of the absolute products of each
/// joint value, of which float sums lose a few units in the last place.
struct PlainResults {
  std::vector<double> controls, joints, channels, maps;
  std::vector<double> joint_products;
};

/// From an instance that has evaluated nothing at another LOD. `raw` holds the raw controls.
PlainResults evaluate_plain(const PlainRig& plain, const std::vector<float>& raw, uint32_t lod);

/// Sets all correctives, from the other controls.
template <class T>
void model_psds(const PlainRig& plain, std::vector<T>& controls);

/// Channel and map weights of a LOD, from all controls.
template <class T>
std::vector<T> plain_channels(const PlainRig& plain, const std::vector<T>& controls, uint32_t lod);
template <class T>
std::vector<T> plain_maps(const PlainRig& plain, const std::vector<T>& controls, uint32_t lod);

/// The first `row_count` rows, clamped outputs included.
template <class T>
std::vector<T> forward_plain(const PlainTable& table, size_t row_count,
                             const std::vector<T>& inputs, size_t output_count);

/// GUI controls that explain raw controls. In float: whether a value lies within an interval
/// depends on it.
std::vector<float> backward_plain(const PlainTable& table, const std::vector<float>& raw,
                                  size_t gui_count);

/// Correctives that are computed at a LOD: those that something reads, and what those read.
std::vector<uint8_t> needed_psds(const PlainRig& plain, uint32_t lod);

}  // namespace mien::model
