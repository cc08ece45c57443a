// SPDX-License-Identifier: MIT
// Channels of a clip on a rig: by the user's names first, then by those that the rig and the library know.
#pragma once

#include <string>
#include <vector>

#include "integrations/program/io/handles.h"
#include "integrations/program/io/matched_names.h"
#include "integrations/program/io/terminal.h"

namespace mien::cli {

using ClipBinding =
    std::unique_ptr<MienClipBinding, Destroy<MienClipBinding, mien_clip_binding_destroy>>;

/// Binds a clip, with the matrix of ARKit. A note lists the channels that drive controls of other names, as the
/// binding drives them. Fails if the rig lacks a control of `names`. `what` and `shown` are for messages.
ClipBinding bind_clip(const MienClip* clip, const MienRig* rig, const NamesFile& names,
                      const char* what, const std::string& shown, const Session& session);

MienClipBindingInfo binding_info(const MienClipBinding* binding);

}  // namespace mien::cli
