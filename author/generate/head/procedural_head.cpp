// SPDX-License-Identifier: MIT
#include "author/generate/head/procedural_head.h"

#include "author/generate/head/dna.h"

namespace mien {
namespace head {
namespace {

using author::copy_text;
using author::fill_index;
using author::make;
using author::Text;

bool fill_descriptor(uint64_t seed, const Person& person, Arena& arena, dna::Descriptor& out) {
  out.archetype = 5;  // other
  out.gender = 2;     // other
  out.age = static_cast<uint16_t>(20 + 60 * person.age + 0.5);
  out.coordinate_system = {0, 2, 4};  // left, up, front: right-handed
  out.lod_count = kLodCount;
  const Text keys[] = {Text().add("generator"), Text().add("seed")};
  const Text values[] = {Text().add("mien demo-head"), Text().add(seed)};
  if (!make(arena, 2 + kMeshCount, out.metadata)) return false;
  for (size_t i = 0; i < 2; ++i) {
    if (!copy_text(arena, keys[i], out.metadata[i].key)) return false;
    if (!copy_text(arena, values[i], out.metadata[i].value)) return false;
  }
  return copy_text(arena, Text().add("mien_head"), out.name) &&
         copy_text(arena, Text().add("mien_head"), out.complexity) &&
         copy_text(arena, Text().add("mien_procedural"), out.db_name);
}

bool make_head(uint64_t seed, Arena& arena, const Allocator& allocator, dna::DnaView& out) {
  Arena scratch(allocator);
  const Form form(make_person(seed));
  const Shapes shapes;
  const Skeleton skeleton(form);
  Head head = {form, shapes, skeleton, {}};
  PartLods skin(scratch);
  Displacements displacements(shapes);
  return fill_index(8, arena, out) && fill_descriptor(seed, form.person(), arena, out.desc) &&
         make_lods(form, Part::kHead, allocator, skin) &&
         displacements.make(skin.at[0].vertices.count(), scratch) &&
         fit_joints(shapes, skeleton, skin.at[1], displacements, scratch, head.deltas) &&
         fill_controls(head, arena, out) && fill_joints(head, arena, scratch, out) &&
         fill_meshes(head, skin, displacements, arena, allocator, 2, out);
}

}  // namespace
}  // namespace head

bool make_procedural_head(uint64_t seed, Arena& arena, const Allocator& scratch,
                          dna::DnaView& out) {
  out = dna::DnaView();
  if (head::make_head(seed, arena, scratch, out)) return true;
  out = dna::DnaView();
  return false;
}

}  // namespace mien
