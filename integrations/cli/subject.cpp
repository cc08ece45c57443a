// SPDX-License-Identifier: MIT
#include "integrations/cli/subject.h"

#include <cmath>

#include "integrations/cli/controls.h"
#include "integrations/cli/fields.h"
#include "integrations/cli/names.h"
#include "integrations/cli/options.h"

namespace mien::cli {

namespace {

using picture::Box;
using picture::Stand;
using picture::Vec3;

constexpr const char* kCannot = "cannot draw";

/// Left, up and front in the axes of the file. Axes that do not make sense together (two of them
/// up) count as the usual ones.
Stand stand_of(const MienDnaInfo& info) {
  constexpr Vec3 kAxes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Stand stand;
  bool left = false, up = false, front = false;
  for (int i = 0; i < 3; ++i) {
    switch (info.axes[i]) {
      case MIEN_DIRECTION_LEFT: stand.left = kAxes[i], left = true; break;
      case MIEN_DIRECTION_RIGHT: stand.left = -kAxes[i], left = true; break;
      case MIEN_DIRECTION_UP: stand.up = kAxes[i], up = true; break;
      case MIEN_DIRECTION_DOWN: stand.up = -kAxes[i], up = true; break;
      case MIEN_DIRECTION_FRONT: stand.front = kAxes[i], front = true; break;
      case MIEN_DIRECTION_BACK: stand.front = -kAxes[i], front = true; break;
      default: break;
    }
  }
  return left && up && front ? stand : Stand{};
}

/// Triangles of a face with more than three corners share edges that the face does not have. Faces
/// are fans about their first corner, in file order; those of fewer than three are not there.
std::vector<uint8_t> find_inner_edges(const RigFile& file, uint32_t mesh, size_t triangle_count) {
  const std::string faces = element("geom.meshes", mesh, ".faces");
  const uint64_t face_count = field_count(file, faces);
  std::vector<uint8_t> inner;
  inner.reserve(triangle_count);
  for (uint64_t face = 0; face < face_count; ++face) {
    const uint64_t corners = field_count(file, element(faces, face, ".layoutIndices"));
    for (uint64_t k = 2; k < corners; ++k) {
      // Edge 0 leaves the first corner, edge 2 comes back to it.
      inner.push_back(static_cast<uint8_t>((k > 2 ? 1 : 0) | (k + 1 < corners ? 4 : 0)));
    }
  }
  inner.resize(triangle_count);
  return inner;
}

ShownMesh show_mesh(const Subject& subject, uint32_t mesh, const SubjectOptions& options,
                    const Session& session) {
  ShownMesh shown{};
  shown.mesh = mesh;
  shown.name = rig_name(subject.rig.get(), MIEN_KIND_MESH, mesh);
  shown.kind = mesh_kind(shown.name);
  shown.neutral = sized<MienMesh>();
  check(mien_deformer_mesh(subject.deformer.get(), mesh, &shown.neutral), nullptr, kCannot,
        subject.file.shown);
  const uint32_t positions = shown.neutral.position_count;
  shown.colors = read_mesh_colours(subject.file, shown.name, positions, session);
  if (shown.colors.empty() && shown.kind == MeshKind::kEye) {
    shown.colors = paint_eye(shown.neutral.positions.data, positions, subject.stand.front);
  } else if (!shown.colors.empty() && shown.kind == MeshKind::kCover) {
    shown.kind = MeshKind::kHair;  // who gives it colors wants it seen
  }
  if (options.wireframe) {
    shown.inner_edges = find_inner_edges(subject.file, mesh, shown.neutral.triangle_count);
  }
  return shown;
}

/// Files may name meshes and leave their geometry out.
bool has_geometry(const RigFile& file) {
  auto field = sized<MienDnaField>();
  const MienStatus status = mien_dna_field(file.dna.get(), "geom.meshes", &field, nullptr);
  return status == MIEN_OK && field.count != 0;
}

void choose_meshes(Subject& subject, const SubjectOptions& options, const Session& session) {
  MienIndexView indices{};
  check(mien_rig_lod_indices(subject.rig.get(), MIEN_KIND_MESH, 0, &indices), nullptr, kCannot,
        subject.file.shown);
  NearestName nearest(options.meshes);
  bool any = false;
  for (size_t i = 0; i < indices.count; ++i) {
    ShownMesh mesh = show_mesh(subject, indices.data[i], options, session);
    if (mesh.neutral.triangle_count == 0) continue;
    any = true;
    nearest.offer(mesh.name);
    const bool chosen = options.meshes.empty() ? mesh.kind != MeshKind::kCover
                                               : matches_pattern(options.meshes, mesh.name);
    if (chosen) subject.meshes.push_back(std::move(mesh));
  }
  if (!subject.meshes.empty()) return;
  const std::string lod = "LOD " + std::to_string(subject.lod);
  if (!any && options.geometry_optional) return;
  if (!any) {
    fail(kInvalid, kCannot, subject.file.shown, "no mesh of " + lod + " has faces",
         "give a rig with geometry, or another --lod; see 'mien info'");
  }
  if (options.meshes.empty()) {
    fail(kInvalid, kCannot, subject.file.shown,
         lod + " has only meshes that cover others, as shells of eyes do",
         "name some with --meshes");
  }
  fail(kInvalid, kCannot, subject.file.shown,
       "no mesh of " + lod + " is named \"" + options.meshes + "\"",
       nearest.question("'mien info RIG --names meshes' lists the names"));
}

Box box_of_joints(const Subject& subject, const std::string& pattern) {
  MienFloatView matrices{};
  check(mien_deformer_bind_matrices(subject.deformer.get(), &matrices), nullptr, kCannot,
        subject.file.shown);
  Box box;
  const uint32_t count = rig_count(subject.rig.get(), MIEN_KIND_JOINT);
  for (uint32_t j = 0; j < count; ++j) {
    if (!matches_pattern(pattern, rig_name(subject.rig.get(), MIEN_KIND_JOINT, j))) continue;
    const float* matrix = matrices.data + size_t{j} * 16;
    box.add({matrix[12], matrix[13], matrix[14]});
  }
  return box;
}

template <class Chosen>
Box box_of_meshes(const Subject& subject, Chosen chosen) {
  Box box;
  for (const ShownMesh& mesh : subject.meshes) {
    if (!chosen(mesh)) continue;
    for (uint32_t i = 0; i < mesh.neutral.position_count; ++i) {
      box.add(picture::load3(mesh.neutral.positions.data, i));
    }
  }
  return box;
}

Box box_of_eyes(const Subject& subject) {
  const Box box =
      box_of_meshes(subject, [](const ShownMesh& m) { return m.kind == MeshKind::kEye; });
  return box.empty() ? box_of_joints(subject, "*eye*") : box;
}

Box box_of_mouth(const Subject& subject) {
  const Box box = box_of_joints(subject, "*lip*,*mouth*");
  if (!box.empty()) return box;
  return box_of_meshes(subject, [](const ShownMesh& m) {
    return m.kind == MeshKind::kTeeth || m.kind == MeshKind::kTongue;
  });
}

/// From above the brows to below an open jaw, by the distance of the eyes from the mouth.
Box find_face(const Subject& subject) {
  const Box eyes = box_of_eyes(subject), mouth = box_of_mouth(subject);
  if (eyes.empty() || mouth.empty()) return {};
  const Stand& stand = subject.stand;
  const float apart = dot(eyes.center() - mouth.center(), stand.up);
  if (!(apart > 0)) return {};
  const float across = dot(eyes.center(), stand.left), depth = dot(eyes.center(), stand.front);
  const float height = dot(eyes.center() + mouth.center(), stand.up) / 2;
  Box face;
  for (const float side : {-1.45f, 1.45f}) {
    face.add(stand.left * (across + side * apart) + stand.up * (height - 1.55f * apart) +
             stand.front * depth);
    face.add(stand.left * (across + side * apart) + stand.up * (height + 1.35f * apart) +
             stand.front * depth);
  }
  return face;
}

/// Larger on all sides by a share of its longest side.
Box widened(const Box& box, float share) {
  if (box.empty()) return box;
  const Vec3 size = box.size();
  const float by = std::max({size.x, size.y, size.z}) * share;
  Box wide = box;
  wide.add(box.least - Vec3{by, by, by});
  wide.add(box.most + Vec3{by, by, by});
  return wide;
}

}  // namespace

std::string Subject::unit() const {
  return file.info.translation_unit == MIEN_TRANSLATION_METERS ? "m" : "cm";
}

const float* Subject::positions(const ShownMesh& mesh) const {
  MienFloatView view{};
  check(mien_deformer_instance_positions(pose.get(), mesh.mesh, &view), nullptr, kCannot,
        file.shown);
  return view.data;
}

std::vector<picture::Surface> Subject::surfaces() const {
  std::vector<picture::Surface> surfaces;
  for (const ShownMesh& mesh : meshes) {
    MienFloatView normals{};
    check(mien_deformer_instance_normals(pose.get(), mesh.mesh, &normals), nullptr, kCannot,
          file.shown);
    picture::Surface surface;
    surface.positions = positions(mesh);
    surface.position_count = mesh.neutral.position_count;
    surface.normals = normals.data;
    surface.vertex_position_indices = mesh.neutral.vertex_position_indices.data;
    surface.vertex_count = mesh.neutral.vertex_count;
    surface.triangles = mesh.neutral.triangles.data;
    surface.triangle_count = mesh.neutral.triangle_count;
    if (!mesh.colors.empty()) surface.colors = mesh.colors.data();
    if (!mesh.inner_edges.empty()) surface.inner_edges = mesh.inner_edges.data();
    surface.material = mesh_material(mesh.kind);
    surfaces.push_back(surface);
  }
  return surfaces;
}

std::vector<Vec3> Subject::neutral_points() const {
  std::vector<Vec3> points;
  for (const ShownMesh& mesh : meshes) {
    for (uint32_t i = 0; i < mesh.neutral.position_count; ++i) {
      points.push_back(picture::load3(mesh.neutral.positions.data, i));
    }
  }
  return points;
}

Box Subject::neutral_box() const {
  return box_of_meshes(*this, [](const ShownMesh&) { return true; });
}

void add_subject_options(CLI::App& app, SubjectOptions& options) {
  app.add_option("RIG", options.rig, "DNA file with geometry; - reads standard input")
      ->type_name("")
      ->required();
  app.add_option("--lod", options.lod, "LOD to show (default: 0, the finest)")->type_name("N");
  app.add_option("--meshes", options.meshes,
                 "Only these, as head*,teeth*; default: all but what would cover the\n"
                 "face without its textures (shells of eyes, lashes, saliva)")
      ->type_name("PATTERN");
}

Subject open_subject(const SubjectOptions& options, const Session& session) {
  auto desc = sized<MienDnaDesc>();
  desc.layers = kEvaluationLayers | MIEN_LAYER_GEOMETRY;
  const uint64_t lod = parse_number("--lod", options.lod, kLastMaskLod);
  // Nothing of the other LODs is read.
  desc.lods = uint64_t{1} << lod;

  Subject subject;
  subject.lod = static_cast<uint32_t>(lod);
  subject.file = open_rig_file(options.rig, desc, session);
  subject.rig = create_rig(subject.file, sized<MienRigDesc>());
  subject.stand = stand_of(subject.file.info);

  auto error = sized<MienError>();
  MienInstance* instance = nullptr;
  check(mien_instance_create(subject.rig.get(), nullptr, &instance, &error), &error, kCannot,
        subject.file.shown);
  subject.instance.reset(instance);
  if (!has_geometry(subject.file)) {
    if (options.geometry_optional) return subject;
    fail(kInvalid, kCannot, subject.file.shown, "the file has no geometry",
         "give a rig with meshes; see 'mien info'");
  }

  MienDeformer* deformer = nullptr;
  check(mien_deformer_create(subject.file.dna.get(), subject.rig.get(), nullptr, &deformer, &error),
        &error, "cannot prepare meshes", subject.file.shown);
  subject.deformer.reset(deformer);
  MienDeformerInstance* pose = nullptr;
  check(mien_deformer_instance_create(deformer, nullptr, &pose, &error), &error, kCannot,
        subject.file.shown);
  subject.pose.reset(pose);
  choose_meshes(subject, options, session);
  return subject;
}

void pose_subject(Subject& subject, const Frame& frame) {
  MienInstance* instance = subject.instance.get();
  MienDeformerInstance* pose = subject.pose.get();
  const std::string& shown = subject.file.shown;
  check(mien_instance_reset(instance), nullptr, kCannot, shown);
  apply_frame(frame, subject.rig.get(), instance);
  check(mien_rig_evaluate(subject.rig.get(), instance, 0), nullptr, kCannot, shown);
  if (!pose) return;
  check(mien_deformer_instance_update(pose, instance), nullptr, kCannot, shown);
  for (const ShownMesh& mesh : subject.meshes) {
    check(mien_deformer_instance_deform(pose, mesh.mesh, MIEN_NORMALS_DEFAULT, nullptr), nullptr,
          kCannot, shown);
    const float* positions = subject.positions(mesh);
    for (size_t i = 0; i < size_t{mesh.neutral.position_count} * 3; ++i) {
      if (std::isfinite(positions[i])) continue;
      fail(kInvalid, kCannot, shown + ", " + mesh.name + ", position " + std::to_string(i / 3),
           "the result is not a finite number", "give smaller controls; they are usually in 0..1");
    }
  }
}

bool has_face(const Subject& subject) { return !find_face(subject).empty(); }

std::vector<Vec3> find_target(const Subject& subject, const std::string& target) {
  if (target.empty()) return subject.neutral_points();
  Box box;
  if (target == "face") {
    box = find_face(subject);
  } else if (target == "eyes") {
    box = widened(box_of_eyes(subject), 0.18f);
  } else if (target == "mouth") {
    box = widened(box_of_mouth(subject), 0.25f);
  } else {
    box =
        box_of_meshes(subject, [&](const ShownMesh& m) { return matches_pattern(target, m.name); });
    if (box.empty()) box = widened(box_of_joints(subject, target), 0.25f);
  }
  if (box.empty() || !(length(box.size()) > 0)) {
    const bool part = target == "face" || target == "eyes" || target == "mouth";
    fail(kInvalid, "cannot aim the camera", subject.file.shown,
         part ? "no mesh or joint is named as " + (target == "face" ? "eyes and a mouth" : target) +
                    " are"
              : "no mesh and no two joints match \"" + target + "\"",
         "give --target a pattern of mesh or joint names; 'mien info RIG --names meshes,joints' "
         "lists them");
  }
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    corners.push_back({i & 1 ? box.most.x : box.least.x, i & 2 ? box.most.y : box.least.y,
                       i & 4 ? box.most.z : box.least.z});
  }
  return corners;
}

}  // namespace mien::cli
