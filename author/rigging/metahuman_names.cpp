// SPDX-License-Identifier: MIT
#include "author/rigging/metahuman_names.h"

namespace mien::author {

namespace {

bool name_bone(const Text& name, Arena& arena, Name& out) {
  Span<char> chars;
  if (!make(arena, name.count, chars)) return false;
  memcpy(chars.data, name.chars, name.count);
  out = {chars.data, chars.count};
  return true;
}

}  // namespace

bool name_as_metahuman(Placement& placement, Arena& arena) {
  Span<Bone> bones;
  if (!make(arena, placement.bones.count, bones)) return false;
  uint32_t necks = 0, tongues = 0, eyes[3] = {};
  for (size_t b = 0; b < bones.count; ++b) {
    Bone& bone = bones[b];
    bone = placement.bones[b];
    Text name;
    switch (bone.kind) {
      case BoneKind::kChest: name.add("spine_05"); break;
      case BoneKind::kNeck: name.add("neck_0").add(uint64_t{++necks}); break;
      case BoneKind::kHead: name.add("head"); break;
      case BoneKind::kFace: name.add("FACIAL_C_FacialRoot"); break;
      case BoneKind::kJaw: name.add("FACIAL_C_Jaw"); break;
      case BoneKind::kTongue: name.add("FACIAL_C_Tongue").add(uint64_t{++tongues}); break;
      case BoneKind::kEye: {
        const double off = bone.position.x - placement.symmetry_plane;
        const size_t side = off > 0 ? 0 : off < 0 ? 1 : 2;
        const char* const names[] = {"FACIAL_L_Eye", "FACIAL_R_Eye", "FACIAL_C_Eye"};
        name.add(names[side]);
        if (++eyes[side] > 1) name.add(uint64_t{eyes[side]});  // more balls on a side
        break;
      }
      default: continue;
    }
    if (!name_bone(name, arena, bone.name)) return false;
  }
  placement.bones = bones;
  return true;
}

}  // namespace mien::author
