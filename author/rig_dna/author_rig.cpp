// SPDX-License-Identifier: MIT
#include "author/rig_dna/author_rig.h"

#include <algorithm>

#include "author/base/dna_making.h"
#include "author/fit/lod_weights.h"
#include "author/fit/stacked_lods.h"
#include "author/rig_dna/rig_model.h"

namespace mien::author {

namespace {

constexpr uint32_t kMaxControls = 65535;  // as their numbers have 16 bits

void measure_groups(const dna::Joints& joints, GroupReport& report) {
  constexpr uint32_t kBlocks[3] = {4, 8, 16};
  uint64_t padded[3] = {};
  report.groups = joints.groups.count;
  for (const dna::JointGroup& group : joints.groups) {
    const uint64_t rows = group.output_indices.count, columns = group.input_indices.count;
    report.stored += rows * columns;
    for (size_t i = 0; i < group.values.count; ++i) report.nonzeros += group.values[i] != 0;
    for (int b = 0; b < 3; ++b) {
      padded[b] += (rows + kBlocks[b] - 1) / kBlocks[b] * kBlocks[b] * columns;
    }
  }
  if (report.stored == 0) return;
  for (int b = 0; b < 3; ++b) {
    report.padding[b] = static_cast<double>(padded[b]) / static_cast<double>(report.stored) - 1;
  }
}

/// Diagonal of the box of the mask, so that other parts of the mesh, such as a body, do not change which
/// offsets count as small on the face.
double size_of_face(const AuthorMesh& mesh, const Placement& placement) {
  if (placement.mask.empty()) return mesh.diagonal;
  Vec3 low = mesh.positions[placement.mask[0]], high = low;
  for (const uint32_t v : placement.mask) {
    const Vec3 p = mesh.positions[v];
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return length(high - low);
}

/// Initial weights of a LOD after LOD 0.
struct LodStarts {
  SkinWeights made;       // new ones for the bones that it keeps
  SkinWeights collapsed;  // those of LOD 0; dropped bones' weights on the nearest remaining bone
  SkinWeights other;      // fitted, of the variant that is not taken
  bool has_new = false;
  enum : uint8_t { kUndecided, kNew, kCollapsed } better = kUndecided;
};

class RigMaker {
 public:
  RigMaker(const AuthorMesh& mesh, const Placement& placement, const RigOptions& options,
           Arena& arena, const Allocator& allocator, RigReport& report)
      : mesh_(mesh), placement_(placement), options_(options), arena_(arena), scratch_(allocator),
        allocator_(allocator),
        report_(report), model_{mesh_, placement, options.name, {}, {}, {}, {}, {}, {}},
        face_size_(size_of_face(mesh, placement)) {}

  bool make(Span<SkinWeights> weights, dna::DnaView& out) {
    return find_controls() && make_deltas() && take_lods(weights) &&
           (options_.own_motions.empty() ? fit(weights[0]) : take_motions(weights[0])) &&
           make_lods() && write(out);
  }

 private:
  bool starts(const char* step) {
    if (!options_.go_on || options_.go_on(options_.user, step)) return true;
    report_.stopped = true;
    return false;
  }

  bool measure(const SkinWeights& weights, Span<const Target> targets, FitError& out) {
    return measure(mesh_, weights, targets, out);
  }
  bool measure(const AuthorMesh& mesh, const SkinWeights& weights, Span<const Target> targets,
               FitError& out) {
    return measure_fit(mesh, weights, motions_, targets, options_.parallel, arena_, out);
  }

  /// The joint of the head, which does not move, and that of the jaw may influence every vertex.
  bool refit(const AuthorMesh& mesh, const SkinWeights& from, SkinWeights& out) {
    uint16_t shared[kMaxSharedBones];
    uint32_t count = 0;
    for (uint32_t j = 0; j < placement_.bones.count && count < kMaxSharedBones; ++j) {
      const BoneKind kind = placement_.bones[j].kind;
      if (kind != BoneKind::kHead && kind != BoneKind::kJaw) continue;
      shared[count++] = static_cast<uint16_t>(j);
    }
    return &mesh == &mesh_ ? refit_finest(mesh, placement_, motions_, {shared, count}, options_.fit,
                                          options_.parallel, allocator_, out)
                           : refit_lod(mesh, placement_, motions_, {shared, count}, options_.fit,
                                       options_.parallel, allocator_, from, out);
  }

  /// From here on the shapes of `mesh_` are the expressions.
  bool find_controls() {
    Span<Shape> expressions;
    Span<Combination> combinations;
    if (!find_combinations(mesh_.shapes, scratch_, expressions, combinations)) return false;
    mesh_.shapes = expressions;
    if (options_.overlap_correctives > 0) {
      Arena for_pairs(allocator_);
      const uint32_t room = kMaxControls - static_cast<uint32_t>(expressions.count) -
                            static_cast<uint32_t>(combinations.count);
      if (!add_overlaps(mesh_, std::min(options_.overlap_correctives, room), options_.parallel,
                        scratch_, for_pairs, combinations)) {
        return false;
      }
    }
    model_.combinations = combinations;
    return true;
  }

  bool make_deltas() {
    const size_t bones = placement_.bones.count;
    model_.deltas.joint_count = static_cast<uint32_t>(bones);
    return author::make(scratch_, model_.control_count() * bones, model_.deltas.items) &&
           make_motions(mesh_.shapes.count, bones, scratch_, motions_);
  }

  /// Meshes of the LODs with the displacements of their vertices, and the weights that they have
  /// before any fit.
  bool take_lods(Span<SkinWeights> weights) {
    const size_t count = placement_.lod_facial_counts.count;
    if (!author::make(scratch_, count, lods_) || !author::make(scratch_, count, starts_) ||
        !author::make(arena_, count, report_.lods)) {
      return false;
    }
    for (uint32_t l = 0; l < count; ++l) {
      if (!take_mesh(l, lods_[l], report_.lods[l])) return false;
      lods_[l].weights = weights[0];
      if (l > 0 && !make_starts(l, weights)) return false;
    }
    return true;
  }

  bool take_mesh(uint32_t l, FittedLod& lod, LodReport& report) {
    lod.mesh = mesh_;
    if (l < options_.lod_meshes.count) {
      const LodMesh& own = options_.lod_meshes[l];
      report.surface_rms = own.rms;
      report.surface_max = own.max;
      if (!own.vertices.empty()) {
        lod.vertices = own.vertices;
        lod.mesh = own.mesh;
        if (!take_shapes(mesh_.shapes, own.vertices, scratch_, lod.mesh.shapes)) return false;
      }
    }
    report.vertices = lod.mesh.positions.count;
    report.triangles = lod.mesh.triangles.count / 3;
    report.joints = static_cast<uint32_t>(placement_.bones.count) - placement_.facial_count +
                    placement_.lod_facial_counts[l];
    return true;
  }

  bool make_starts(uint32_t l, Span<SkinWeights> weights) {
    FittedLod& lod = lods_[l];
    LodStarts& starts = starts_[l];
    starts.has_new = l < weights.count;
    if (!make_rows(lod, weights[0].m, lod.weights) ||
        !make_rows(lod, weights[0].m, starts.collapsed) ||
        !make_rows(lod, weights[0].m, starts.other) ||
        (starts.has_new && !make_rows(lod, weights[l].m, starts.made))) {
      return false;
    }
    if (starts.has_new) take_rows(weights[l], lod, starts.made);
    return true;
  }

  bool make_rows(const FittedLod& lod, uint32_t m, SkinWeights& out) {
    out.m = m;
    return author::make(scratch_, lod.mesh.positions.count * m, out.joints) &&
           author::make(scratch_, lod.mesh.positions.count * m, out.weights);
  }

  /// Those of the LOD's vertices.
  static void take_rows(const SkinWeights& all, const FittedLod& lod, SkinWeights& out) {
    const size_t m = all.m;
    for (size_t v = 0; v < lod.mesh.positions.count; ++v) {
      const size_t from = lod.vertices.empty() ? v : lod.vertices[v];
      for (size_t i = 0; i < m; ++i) {
        out.joints[v * m + i] = all.joints[from * m + i];
        out.weights[v * m + i] = all.weights[from * m + i];
      }
    }
  }

  bool fit(SkinWeights& weights) {
    if (!starts("fit")) return false;
    if (mesh_.shapes.empty()) return true;
    Arena for_fit(allocator_);
    Fitter fitter;
    if (!make_fitter(mesh_.positions, placement_, weights.m, options_.fit, for_fit, fitter)) {
      return false;
    }
    const auto fit_again = [&](FitError& error) {
      fit_all(fitter, mesh_, weights, false, options_.parallel, motions_);
      return measure(weights, {}, error);
    };
    fitter.options.rotations = false;
    if (!fit_again(report_.translations)) return false;
    report_.rotations = report_.translations;
    if (options_.fit.rotations) {
      fitter.options.rotations = true;
      if (!fit_again(report_.rotations)) return false;
    }
    GroupReport& groups = report_.groups;
    groups.before = report_.rotations;
    for (uint32_t i = 0; i < options_.fit.alternations && !options_.keep_weights; ++i) {
      if (!starts("weights")) return false;
      if (!refit(mesh_, weights, weights) || !fit_again(groups.before)) return false;
    }

    if (!starts("groups") || !group_bones(fitter.footprints)) return false;
    for (size_t s = 0; s < mesh_.shapes.count; ++s) {
      const PruneReport pruned =
          prune(placement_, fitter.footprints, model_.regions, options_.least_effect * face_size_,
                options_.full_groups, s, motions_);
      groups.pruned.outliers += pruned.outliers;
      groups.pruned.faint += pruned.faint;
    }
    // Weights are fitted once more to the remaining bones.
    if (!measure(weights, {}, groups.removed)) return false;
    fit_all(fitter, mesh_, weights, true, options_.parallel, motions_);
    if (!options_.keep_weights && options_.fit.alternations > 0) {
      if (!refit(mesh_, weights, weights)) return false;
      fit_all(fitter, mesh_, weights, true, options_.parallel, motions_);
    }
    if (lods_.count > 1 && !options_.keep_weights && !share_motions(weights)) return false;
    // From here on motions are those that the numbers in the file give.
    deltas_of_motions(placement_, mesh_.frame, motions_, model_.deltas);
    return measure(weights, {}, groups.refitted);
  }

  bool group_bones(const Footprints& footprints) {
    return options_.own_regions.empty()
               ? find_regions(placement_, footprints, motions_, options_.regions, scratch_,
                              allocator_, model_.regions)
               : take_regions(placement_, options_.own_regions, scratch_, model_.regions);
  }

  /// The caller's motions do not change; weights are fitted to them.
  bool take_motions(SkinWeights& weights) {
    const size_t bones = placement_.bones.count;
    for (uint32_t s = 0; s < mesh_.shapes.count; ++s) {
      const Span<const JointDelta> given =
          options_.own_motions.slice(mesh_.shapes[s].number * bones, bones);
      for (uint32_t j = 0; j < bones; ++j) {
        model_.deltas.at(s, j) = given[j];
        motions_.active_in(s)[j] = !given[j].is_zero();
      }
      pose_bones(placement_, mesh_.frame, model_.deltas, {&s, 1}, motions_.of(s));
    }
    if (!starts("weights") || !measure(weights, {}, report_.translations)) return false;
    report_.rotations = report_.translations;
    if (!options_.keep_weights && !refit(mesh_, weights, weights)) return false;
    Arena for_regions(allocator_);
    Footprints footprints;
    if (!starts("groups") ||
        !make_footprints(mesh_.positions.count, placement_, weights.m, for_regions, footprints)) {
      return false;
    }
    fill_footprints(mesh_.positions, weights, options_.parallel, footprints);
    GroupReport& groups = report_.groups;
    if (!group_bones(footprints) || !measure(weights, {}, groups.before)) return false;
    groups.removed = groups.refitted = groups.before;
    return true;
  }

  /// Fits motions to all LODs, and weights to the motions.
  bool share_motions(SkinWeights& weights) {
    if (!starts("all levels of detail")) return false;
    Arena for_fit(allocator_);
    StackedLods stacked;
    Fitter fitter;
    if (!stack_lods(lods_, for_fit, stacked) ||
        !make_fitter(stacked.positions, placement_, weights.m, options_.fit, for_fit, fitter)) {
      return false;
    }
    fitter.vertices = stacked.vertices;
    fitter.scales = stacked.scales;
    for (uint32_t round = 0; round < options_.fit.shared_rounds; ++round) {
      for (uint32_t l = 1; l < lods_.count; ++l) {
        if (!fit_lod_weights(l)) return false;
      }
      fill_weights(lods_, stacked);
      fit_all(fitter, mesh_, stacked.weights, true, options_.parallel, motions_);
      if (!refit(mesh_, weights, weights)) return false;
    }
    return true;
  }

  bool collapse(uint32_t l) {
    Arena for_heirs(allocator_);
    SkinWeights& out = starts_[l].collapsed;
    take_rows(lods_[0].weights, lods_[l], out);
    return collapse_weights(placement_, placement_.lod_facial_counts[l], out, for_heirs, out);
  }

  /// New weights, and those that result from dropping bones, are fitted to the motions. The variant that
  /// fits better the first time is used from then on.
  bool fit_lod_weights(uint32_t l) {
    FittedLod& lod = lods_[l];
    LodStarts& starts = starts_[l];
    const bool try_new = starts.has_new && starts.better != LodStarts::kCollapsed;
    const bool try_collapsed = !starts.has_new || starts.better != LodStarts::kNew;
    if (try_new && !refit(lod.mesh, starts.made, lod.weights)) return false;
    if (!try_collapsed) return true;
    if (!collapse(l) || !refit(lod.mesh, starts.collapsed, starts.other)) return false;
    FitError with_new, with_collapsed;
    if (try_new && (!measure(lod.mesh, lod.weights, {}, with_new) ||
                    !measure(lod.mesh, starts.other, {}, with_collapsed))) {
      return false;
    }
    const bool is_better = !try_new || with_collapsed.error < with_new.error;
    if (is_better) std::swap(lod.weights, starts.other);
    starts.better = is_better ? LodStarts::kCollapsed : LodStarts::kNew;
    return true;
  }

  bool make_lods() {
    if (!starts("levels of detail")) return false;
    model_.lods = lods_;
    for (uint32_t l = 0; l < lods_.count; ++l) {
      if ((l > 0 && !weigh_lod(l, report_.lods[l])) || !make_lod(l, lods_[l])) return false;
      report_.lods[l].channels = model_.channels_in_lod(l);
    }
    return true;
  }

  /// Weights of a LOD after LOD 0 for the motions as they are written.
  bool weigh_lod(uint32_t l, LodReport& report) {
    FittedLod& lod = lods_[l];
    const LodStarts& starts = starts_[l];
    FitError error;
    if (!collapse(l) || !measure(lod.mesh, starts.collapsed, {}, error)) return false;
    report.collapsed_error = report.new_error = error.error;
    if (starts.has_new) {
      if (!measure(lod.mesh, starts.made, {}, error)) return false;
      report.new_error = error.error;
    }
    starts_[l].better = LodStarts::kUndecided;
    if (!options_.keep_weights) return fit_lod_weights(l);
    lod.weights = starts.has_new ? starts.made : starts.collapsed;
    return true;
  }

  bool make_lod(uint32_t l, FittedLod& lod) {
    LodReport& report = report_.lods[l];
    FitError error;
    if (!measure(lod.mesh, lod.weights, {}, error)) return false;
    report.joints_error = error.error;
    if (l == 0) {
      report.new_error = error.error;
      report_.joints = error;
    }
    if (l < 2 && options_.residual_targets && !make_shape_targets(l, lod)) return false;
    if (l == 0 && (!add_correctives(lod.weights) || !list_channels())) return false;
    if (!measure(lod.mesh, lod.weights, lod.targets, error)) return false;
    report.error = error.error;
    if (l == 0) report_.rig = error;
    return true;
  }

  /// LOD 0 has targets for all controls, LOD 1 only for the expressions that need them most.
  bool make_shape_targets(uint32_t l, FittedLod& lod) {
    Span<Target> targets, all;
    if (!make_targets(lod.mesh, lod.weights, motions_, options_.residual_threshold * face_size_,
                      options_.parallel, scratch_, targets)) {
      return false;
    }
    if (l == 0) {
      report_.target_threshold = options_.residual_threshold * face_size_;
      size_t moving = 0;
      for (uint32_t s = 0; s < targets.count; ++s) {
        moving += mesh_.shapes[s].moving.count;
        report_.target_vertices += static_cast<uint32_t>(targets[s].vertices.count);
        report_.target_count += !targets[s].vertices.empty();
      }
      if (moving > 0) {
        report_.target_share =
            static_cast<double>(report_.target_vertices) / static_cast<double>(moving);
      }
    }
    if (!author::make(scratch_, model_.control_count(), all)) return false;
    std::copy(targets.begin(), targets.end(), all.begin());
    if (l == 1) {
      Span<uint8_t> used;
      if (!author::make(scratch_, all.count, used)) return false;
      for (uint32_t c = 0; c < model_.channels_in_lod(1); ++c) used[model_.channels[c]] = 1;
      for (size_t c = 0; c < all.count; ++c) {
        if (!used[c]) all[c] = Target();
      }
    }
    lod.targets = all;
    targets_ = l == 0 ? all : targets_;
    return true;
  }

  /// Channels of expressions come first, the strongest before the others; LOD 1 keeps half of them.
  bool list_channels() {
    Span<uint32_t> channels;
    if (!author::make(scratch_, targets_.count, channels)) return false;
    uint32_t count = 0, expressions = 0;
    for (uint32_t c = 0; c < targets_.count; ++c) {
      if (targets_[c].vertices.empty()) continue;
      channels[count++] = c;
      expressions += c < model_.expression_count();
    }
    const auto stronger = [this](uint32_t a, uint32_t b) {
      const double x = targets_[a].energy, y = targets_[b].energy;
      return x != y ? x > y : a < b;
    };
    std::sort(channels.begin(), channels.begin() + expressions, stronger);
    std::sort(channels.begin() + expressions, channels.begin() + count, stronger);
    model_.channels = channels.first(count);
    model_.shape_channels[0] = count;
    model_.shape_channels[1] = (expressions + 1) / 2;
    return true;
  }

  bool add_correctives(const SkinWeights& weights) {
    if (model_.combinations.empty()) return true;
    if (!starts("correctives")) return false;
    Arena for_fit(allocator_);
    Fitter fitter;
    Span<Target> targets = targets_;
    if (!make_fitter(mesh_.positions, placement_, weights.m, options_.fit, for_fit, fitter) ||
        (targets.empty() && !author::make(for_fit, model_.control_count(), targets))) {
      return false;
    }
    fill_footprints(mesh_.positions, weights, options_.parallel, fitter.footprints);
    CorrectiveInput input = {fitter, mesh_, placement_, weights, model_.regions, {}, 0, -1, {}};
    input.combinations = model_.combinations;
    input.least_effect = options_.least_effect * face_size_;
    if (options_.residual_targets) input.threshold = options_.residual_threshold * face_size_;
    input.parallel = options_.parallel;
    return fit_correctives(input, scratch_, allocator_, model_.deltas, targets,
                           report_.correctives);
  }

  bool write(dna::DnaView& out) {
    if (!starts("write") || !fill_index(8, arena_, out) || !fill_descriptor(model_, arena_, out) ||
        !fill_controls(model_, arena_, scratch_, out) ||
        !fill_joints(model_, arena_, scratch_, out) ||
        !fill_meshes(model_, arena_, allocator_, out)) {
      return false;
    }
    measure_groups(out.bhvr.joints, report_.groups);
    for (const Bone& bone : placement_.bones) {
      if (is_fitted(bone)) report_.groups.full += uint64_t{6} * model_.control_count();
    }
    return true;
  }

  AuthorMesh mesh_;
  const Placement& placement_;
  const RigOptions& options_;
  Arena& arena_;
  Arena scratch_;
  const Allocator& allocator_;
  RigReport& report_;
  RigModel model_;
  double face_size_;
  Motions motions_;
  Span<FittedLod> lods_;
  Span<LodStarts> starts_;  // of lods_; the first has none
  Span<Target> targets_;    // of LOD 0, by control
};

}  // namespace

bool author_rig(const AuthorMesh& mesh, const Placement& placement, Span<SkinWeights> weights,
                const RigOptions& options, Arena& arena, const Allocator& allocator,
                RigReport& report, dna::DnaView& out) {
  report = {};
  out = dna::DnaView();
  RigMaker maker(mesh, placement, options, arena, allocator, report);
  if (maker.make(weights, out)) return true;
  out = dna::DnaView();
  return false;
}

}  // namespace mien::author
