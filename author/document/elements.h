// SPDX-License-Identifier: MIT
// Operations on elements with names: finding, renaming, removing, and clearing their animation.
#pragma once

#include "author/document/document.h"

namespace mien::author {

enum class Kind : uint32_t {
  kGuiControl,
  kRawControl,
  kPsdControl,  // without a list of names: "psd0", "psd1", ...
  kMlControl,
  kRbfControl,
  kJoint,
  kChannel,
  kMap,
  kMesh
};

/// Names of a kind but PSD controls, and the path of their list.
const dna::List<dna::String>& names_of(const dna::DnaView& view, Kind kind);
const char* path_of(Kind kind);
/// "joint", for messages.
const char* word_of(Kind kind);

uint32_t count_of(const dna::DnaView& view, Kind kind);

/// Of equal names the first. kName if there is none.
Status find_element(const Document& document, Kind kind, const char* name, size_t count,
                    uint32_t& out_index, Error& error);

/// kInvalidArgument if another element of the kind has the name, and for PSD controls.
Status rename_element(Document& document, Kind kind, uint32_t index, const char* name, size_t count,
                      Error& error);

/// Removes GUI, raw or PSD controls, joints, channels, maps or meshes, and everything that refers to them; the
/// others are renumbered. Children of a joint go to its nearest kept ancestor and keep their place in the world,
/// or become roots; its influence on vertices goes to the same joint, or to the first one left.
/// kInvalidArgument for other kinds, and if no joint would be left for the weights.
Status remove_elements(Document& document, Kind kind, Span<const uint32_t> indices, Error& error);

/// Removes everything that moves a joint: its rows of joint groups, twists, swings and ML joints. It stays
/// where it is relative to its parent.
Status clear_joint_animation(Document& document, Span<const uint32_t> joints, Error& error);

/// All channels with their targets, all maps, or the animation of all joints. kInvalidArgument for other
/// kinds.
Status clear_all(Document& document, Kind kind, Error& error);

}  // namespace mien::author
