// SPDX-License-Identifier: MIT
// mien solve: the controls of a rig for captured meshes, joints, landmarks, or controls of another rig.
#include "integrations/program/commands/solve.h"

#include <mien_solve.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "integrations/program/commands/landmark_sets.h"
#include "integrations/program/commands/solve_mix.h"
#include "integrations/program/commands/solve_neutral.h"
#include "integrations/program/commands/solve_output.h"
#include "integrations/program/commands/solve_residuals.h"
#include "integrations/program/commands/solve_space.h"
#include "integrations/program/commands/solve_target.h"
#include "integrations/program/io/controls.h"
#include "integrations/program/io/dna_fields.h"
#include "integrations/program/io/interrupt.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

// The first frame starts from rest, the others from the frame before.
constexpr uint32_t kFirstIterations = 200, kMostIterations = 50;
constexpr uint32_t kMostSolvedFrames = 10000000;

/// Vertices, landmarks in space, or what another rig does.
bool is_of_places(TargetKind kind) {
  return kind == TargetKind::kVertices || kind == TargetKind::kLandmarks3 ||
         kind == TargetKind::kWeights;
}

/// The targets of one run go together.
void check_mix(const SolveCommand& command, const std::vector<TargetKind>& kinds) {
  if (kinds.size() == 1) {
    if (!command.weights.empty()) {
      fail_usage("--weights", "there is one target", "leave it out, or name another TARGET");
    }
    return;
  }
  for (const TargetKind kind :
       {TargetKind::kJoints, TargetKind::kLandmarks2, TargetKind::kSurface}) {
    if (std::count(kinds.begin(), kinds.end(), kind) > 1) {
      fail_usage("TARGET", std::string("two of them are ") + kind_word(kind),
                 "give one of this kind");
    }
  }
  if (!command.neutral.empty()) {
    fail_usage("--neutral", "it is measured with one target", "leave it out, or the other TARGET");
  }
  const bool images = std::count(kinds.begin(), kinds.end(), TargetKind::kLandmarks2) != 0;
  if (images && command.rigid && kinds[0] != TargetKind::kLandmarks2) {
    fail_usage("--rigid", "it finds the camera of landmarks2, which is not the first TARGET",
               "name landmarks2 first");
  }
  const bool joints = std::count(kinds.begin(), kinds.end(), TargetKind::kJoints) != 0;
  const bool lengths = std::any_of(kinds.begin(), kinds.end(), [](TargetKind kind) {
    return is_of_places(kind) || kind == TargetKind::kSurface;
  });
  if (images + joints + lengths > 1 && command.weights.empty()) {
    fail_usage("TARGET", "joint values, lengths and pixels are given together",
               "say what each counts: --weights 1,0.001");
  }
}

/// What each target counts.
std::vector<float> parse_target_weights(const std::string& list, size_t count) {
  std::vector<float> weights;
  if (list.empty()) return weights;
  for (const std::string& word : split_at_commas(list)) {
    weights.push_back(parse_weight("--weights", word));
    if (!(weights.back() > 0)) {
      fail_usage("--weights " + one_line(list), "a target would not count",
                 "give numbers above 0, or leave out that TARGET");
    }
  }
  if (weights.size() == count) return weights;
  fail_usage("--weights " + one_line(list), "there are " + std::to_string(count) + " targets",
             "give a number for each, in their order");
}

void check_command(const SolveCommand& command, const std::vector<TargetKind>& kinds) {
  const auto has = [&](TargetKind kind) {
    return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
  };
  const bool joints_alone = kinds.size() == 1 && has(TargetKind::kJoints);
  const bool landmarks = has(TargetKind::kLandmarks3) || has(TargetKind::kLandmarks2);
  if (has(TargetKind::kWeights) != !command.target.from.empty()) {
    fail_usage(command.target.from.empty() ? "--kind weights" : "--from",
               command.target.from.empty() ? "there is no rig that the controls are of"
                                           : "only controls are those of another rig",
               command.target.from.empty() ? "add --from OTHER.dna" : "leave it out");
  }
  if (!command.target.landmarks.empty() && !landmarks) {
    fail_usage("--landmarks", "the target has no landmarks", "leave it out");
  }
  if (joints_alone && !command.target.mesh.empty()) {
    fail_usage("--mesh", "joints have no mesh", "leave it out");
  }
  if (command.rigid && joints_alone) {
    fail_usage("--rigid", "joints cannot be moved as a whole", "leave it out");
  }
  if (command.focal && (!has(TargetKind::kLandmarks2) || !command.rigid)) {
    fail_usage("--focal", "it is found together with a camera that moves",
               "give landmarks2 and --rigid, or leave it out");
  }
  if (!command.neutral.empty() && (!landmarks || !command.rigid)) {
    fail_usage("--neutral", "it is of landmarks, and of a head that is anywhere",
               landmarks ? "add --rigid" : "leave it out");
  }
  if (!command.reach.empty() && !has(TargetKind::kSurface)) {
    fail_usage("--reach", "the target is no surface", "leave it out, or add --kind surface");
  }
  if (!command.robust.empty() && joints_alone) {
    fail_usage("--robust", "only distances of points are compared with it", "leave it out");
  }
  if (!command.target.unit.empty()) {
    if (!has(TargetKind::kVertices) && !has(TargetKind::kSurface)) {
      fail_usage("--unit", "only that of vertices and surfaces is converted", "leave it out");
    }
    parse_unit(command.target.unit);
  }
  check_mix(command, kinds);
  const std::string& path = command.output.path;
  if (path != "-" && !ends_with(path, ".clip") && !ends_with(path, ".json")) {
    fail_usage("-o " + path, "the ending of the name selects the format", "use .clip or .json");
  }
  std::vector<std::string> read = {command.rig, command.target.path};
  read.insert(read.end(), command.others.begin(), command.others.end());
  if (std::count(read.begin(), read.end(), "-") > 1) {
    fail_usage("RIG - TARGET -", "both would be read from standard input", "put one in a file");
  }
  if (command.rig == "-" && !command.images.empty()) {
    fail_usage("RIG -", "the rig is read again for images", "put it in a file");
  }
}

void check_placing(const SolveCommand& command) {
  parse_word("solve --place-landmarks", command.place);
  if (command.output.path != "-" && !ends_with(command.output.path, ".json")) {
    fail_usage("-o " + command.output.path, "places of landmarks are JSON", "use .json");
  }
  for (const auto& [option, word] :
       {std::pair<const char*, const std::string&>{"--kind", command.target.kind},
        {"--from", command.target.from},
        {"--landmarks", command.target.landmarks},
        {"--mask", command.target.mask},
        {"--unit", command.target.unit},
        {"--controls", command.controls},
        {"--first", command.first},
        {"--keys", command.keys},
        {"--weights", command.weights},
        {"--report", command.report},
        {"--neutral", command.neutral},
        {"--pictures", command.images}}) {
    if (!word.empty()) fail_usage(option, "nothing is solved", "leave it out");
  }
  if (!command.others.empty()) {
    fail_usage("TARGET " + one_line(command.others[0]), "there is one face with landmarks",
               "leave it out");
  }
  refuse_missing_folder(command.output.path);
  refuse_replacing(command.output, {command.rig, command.target.path});
}

/// Raw controls whose names match, ascending.
std::vector<uint32_t> find_moving(const std::string& list, const MienRig* rig,
                                  const std::string& shown) {
  std::vector<uint32_t> moving;
  const uint32_t count = rig_count(rig, MIEN_KIND_RAW_CONTROL);
  std::vector<std::string> names;
  for (uint32_t i = 0; i < count; ++i) names.push_back(rig_name(rig, MIEN_KIND_RAW_CONTROL, i));
  std::vector<bool> moves(count);
  for (const std::string& pattern : split_at_commas(list)) {
    bool found = false;
    for (uint32_t i = 0; i < count; ++i) {
      if (!matches_pattern(pattern, names[i])) continue;
      moves[i] = found = true;
    }
    if (found) continue;
    fail(kInvalid, "cannot solve", shown, "no raw control matches \"" + one_line(pattern) + "\"",
         nearest_question(pattern, names, "'mien info RIG --names raw' lists the names"));
  }
  for (uint32_t i = 0; i < count; ++i) {
    if (moves[i]) moving.push_back(i);
  }
  return moving;
}

Fit create_fit(const SolvedRig& rig, const FitTargets& targets,
               const std::vector<uint32_t>& moving) {
  auto desc = sized<MienFitDesc>();
  targets.describe(desc);
  desc.deformer = desc.point_count == 0 ? nullptr : rig.deformer;
  if (!moving.empty()) {
    desc.controls = moving.data();
    desc.control_count = moving.size();
  }
  auto error = sized<MienError>();
  MienFit* fit = nullptr;
  check(mien_fit_create(rig.rig, &desc, &fit, &error), &error, "cannot solve", rig.shown);
  return Fit(fit);
}

/// The target becomes that of a face like the rig's, by what --neutral says of the person.
void adapt_to_neutral(const NeutralOption& option, const SolveCommand& command,
                      const SolvedRig& rig, const Fit& fit, SolveTarget& target,
                      const Session& session) {
  const bool images = target.kind == TargetKind::kLandmarks2;
  const size_t width = images ? 2 : 3;
  std::vector<std::vector<float>> rows;
  if (option.file.empty()) {
    for (size_t f = 0; f < std::min(option.frame_count, target.frame_count); ++f) {
      target.read(f, rows.emplace_back(target.width).data());
    }
  } else {
    rows = read_neutral_rows(option.file, images, target.point_names);
  }
  const std::vector<uint32_t> used = list_used_points(target);
  std::vector<MienSolvePoint> points;
  for (const uint32_t i : used) points.push_back(target.points[i]);
  for (std::vector<float>& row : rows) keep_used(used, width, row.data());
  NeutralFinder finder(fit.get(), rig, points, images);
  const NeutralFace found =
      measure_neutral_rows(finder, rows, target.camera, command.focal,
                           shown_name(option.file.empty() ? command.target.path : option.file));
  note(session, "the neutral face is known: " + found.text());

  NeutralFace whole = found;
  whole.known.assign(target.points.size(), 0);
  whole.offsets.assign(3 * target.points.size(), 0);
  for (size_t i = 0; i < used.size(); ++i) {
    whole.known[used[i]] = found.known[i];
    std::copy_n(found.offsets.data() + 3 * i, 3, whole.offsets.data() + size_t{3} * used[i]);
  }
  target.point_offsets = whole.offsets;
  target.read = [read = target.read, whole, width](size_t frame, float* row) {
    read(frame, row);
    whole.adapt(row, width);
  };
}

/// "3 of 200 frames SAY: 7, 8 and 20", if there are any. Numbers are those of the report, from 0 on.
template <class F>
void note_frames(const SolvedTake& take, const Session& session, const std::string& say, F&& is) {
  constexpr size_t kMostNamed = 8;
  std::vector<size_t> found;
  for (size_t f = 0; f < take.frames.size(); ++f) {
    if (is(take.frames[f])) found.push_back(f);
  }
  if (found.empty()) return;
  std::string names;
  for (size_t i = 0; i < std::min(found.size(), kMostNamed); ++i) {
    names += (i == 0 ? "" : ", ") + std::to_string(found[i]);
  }
  note(session, grouped(found.size()) + " of " + grouped(take.frames.size()) + " frames " + say +
                    ": " + names + (found.size() > kMostNamed ? ", ..." : ""));
}

void note_results(const SolvedTake& take, const SolveTarget& target, const Session& session) {
  note_frames(take, session, "have no data and hold the frame before",
              [](const SolvedFrame& frame) { return frame.status == MIEN_FIT_NO_DATA; });
  note_frames(take, session, "moved farther than their targets ask for",
              [](const SolvedFrame& frame) { return frame.jumped; });
  if (target.kind == TargetKind::kSurface) return;
  uint32_t most = 0;
  for (const SolvedFrame& frame : take.frames) most = std::max(most, frame.missing);
  const bool joints = target.points.empty();
  note_frames(take, session,
              "lack some targets, at most " + grouped(most) + " of " +
                  grouped(joints ? target.width : target.points.size()) +
                  (joints ? " joint values" : " points"),
              [](const SolvedFrame& frame) { return frame.missing != 0; });
}

/// Joint values that count and have no target.
uint32_t count_missing(const SolveTarget& target, const std::vector<float>& row) {
  uint32_t count = 0;
  for (size_t i = 0; i < row.size(); ++i) {
    count += std::isnan(row[i]) && (target.weights.empty() || target.weights[i] > 0);
  }
  return count;
}

/// Adds the residuals of a frame to those of its kinds. Vertices, landmarks in space and weights are one kind.
void add_kinds(const MienFitResult& result, std::vector<SolvedKind>& kinds,
               const std::vector<SolveTarget>& targets) {
  if (targets.size() == 1 || result.status == MIEN_FIT_NO_DATA) return;
  for (const TargetKind kind : {TargetKind::kJoints, TargetKind::kVertices, TargetKind::kLandmarks2,
                                TargetKind::kSurface}) {
    const auto is = [&](const SolveTarget& target) {
      return kind == TargetKind::kVertices ? is_of_places(target.kind) : target.kind == kind;
    };
    if (std::none_of(targets.begin(), targets.end(), is)) continue;
    const char* const name = kind == TargetKind::kVertices ? "points" : kind_word(kind);
    auto found = std::find_if(kinds.begin(), kinds.end(),
                              [&](const SolvedKind& other) { return other.name == name; });
    if (found == kinds.end()) found = kinds.insert(kinds.end(), {name, 0, 0, 0});
    const KindResidual residual = residual_of(result, kind);
    found->squares += residual.rms * residual.rms;
    found->worst = std::max(found->worst, residual.worst);
    ++found->frame_count;
  }
}

SolvedTake solve_take(const SolveCommand& command, const SolvedRig& rig,
                      const std::vector<SolveTarget>& targets, FitTargets& data, const Fit& fit,
                      const Session& session) {
  const SolveTarget& target = targets[0];
  SolvedTake take;
  const uint32_t count = rig_count(rig.rig, MIEN_KIND_RAW_CONTROL);
  for (uint32_t i = 0; i < count; ++i) {
    take.controls.push_back(rig_name(rig.rig, MIEN_KIND_RAW_CONTROL, i));
  }
  take.values.resize(target.frame_count * count);
  take.rigid = command.rigid;
  auto frame = sized<MienFitFrame>();
  data.begin(frame);
  MienFitCamera camera = data.camera() ? *data.camera() : MienFitCamera{};
  if (!command.rigid && !knows_rotation(camera)) {
    for (const int k : {0, 4, 8}) camera.rotation[k] = 1;
  }
  frame.camera = frame.images ? &camera : nullptr;
  frame.focal = command.focal ? 1 : 0;
  frame.robust_scale = parse_weight("--robust", command.robust);
  frame.surface_reach = take.reach = parse_weight("--reach", command.reach);
  frame.rigid = command.rigid ? 1 : 0;
  // Weights are relative to the mean over the data, whatever its amount.
  frame.sparse_weight = parse_weight("--sparse", command.sparse) * data.amount();
  frame.max_iterations = kFirstIterations;
  std::vector<uint32_t> stages(command.first.empty() ? 0 : count, 1);
  if (!command.first.empty()) {
    for (const uint32_t c : find_moving(command.first, rig.rig, rig.shown)) stages[c] = 0;
    frame.stages = stages.data();
  }
  std::optional<ResidualTable> residuals;
  if (!command.report.empty()) residuals.emplace(rig, target);
  Progress progress(session, "frame", target.frame_count);
  for (size_t f = 0; f < target.frame_count; ++f) {
    progress.at(f);
    data.read(f, frame);
    auto result = sized<MienFitResult>();
    float* const out = take.values.data() + f * count;
    const auto begin = std::chrono::steady_clock::now();
    check(mien_fit_solve(fit.get(), &frame, out, &result), nullptr, "cannot solve", rig.shown);
    take.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const KindResidual left = residual_of(result, target.kind);
    take.frames.push_back({left.rms, left.worst, result.iterations, result.status});
    take.frames.back().jumped = f != 0 && result.jumped != 0;  // the first one begins at rest
    take.frames.back().missing =
        target.points.empty() ? count_missing(target, data.row()) : result.missing_points;
    add_kinds(result, take.kinds, targets);
    if (command.rigid) {
      std::copy_n(result.rotation, 9, take.frames.back().rotation);
      std::copy_n(result.translation, 3, take.frames.back().translation);
      // The next frame begins with the camera of this one.
      if (result.status != MIEN_FIT_NO_DATA && frame.images) {
        std::copy_n(result.rotation, 9, camera.rotation);
        std::copy_n(result.translation, 3, camera.translation);
        std::copy_n(result.focal, 2, camera.focal);
        std::copy_n(result.focal, 2, take.frames.back().focal);
      }
    }
    if (residuals) residuals->add(take, data.row().data(), data.surface());
    frame.start = out;
    frame.stages = nullptr;
    frame.smooth_weight = parse_weight("--smooth", command.smooth) * data.amount();
    frame.max_iterations = kMostIterations;
  }
  if (residuals) take.data = residuals->list();
  return take;
}

std::vector<std::string> list_unobservable(const Fit& fit, const std::vector<uint32_t>& moving,
                                           const std::vector<std::string>& names) {
  std::vector<float> observed(names.size());
  check(mien_fit_observability(fit.get(), observed.data(), observed.size()), nullptr,
        "cannot solve", "");
  std::vector<std::string> found;
  for (uint32_t i = 0; i < names.size(); ++i) {
    const bool moves = moving.empty() || std::binary_search(moving.begin(), moving.end(), i);
    if (moves && observed[i] < kUnobservable) found.push_back(names[i]);
  }
  return found;
}

}  // namespace

void solve_file(const SolveCommand& command, const Session& session) {
  auto interrupt = std::make_unique<EndOnInterrupt>();
  if (!command.place.empty()) {
    check_placing(command);
    return place_landmarks(command, session);
  }
  if (command.target.path.empty()) {
    fail_usage("TARGET", "there is nothing to solve", "name a file or a folder");
  }
  std::vector<TargetOptions> options = {command.target};
  for (const std::string& other : command.others) {
    options.push_back(command.target);
    options.back().path = other;
    options.back().kind.clear();
    options.back().mask.clear();
  }
  std::vector<TargetKind> kinds;
  for (TargetOptions& one : options) {
    split_kind(one);
    kinds.push_back(find_kind(one));
  }
  check_command(command, kinds);
  const std::vector<float> weights = parse_target_weights(command.weights, kinds.size());
  const Rate rate = command.rate.empty() ? Rate{} : parse_rate(command.rate);
  if (!command.rate.empty() && !rate.known()) {
    fail_usage("--rate \"" + command.rate + "\"", "not a number of frames per second",
               "give one such as 60, 29.97 or 30000/1001");
  }
  const float keys = parse_weight("--keys", command.keys);
  const NeutralOption neutral = parse_neutral(command.neutral);
  parse_weight("--smooth", command.smooth);
  parse_weight("--sparse", command.sparse);
  parse_weight("--robust", command.robust);
  parse_weight("--reach", command.reach);
  std::vector<std::string> inputs = {command.rig};
  for (const TargetOptions& one : options) inputs.push_back(one.path);
  for (const std::string& other :
       {command.target.from, command.target.landmarks, command.target.mask, neutral.file}) {
    if (!other.empty()) inputs.push_back(other);
  }
  if (ends_with(command.output.path, ".clip")) {
    refuse_terminal(command.output.path, session, "a clip");
  }
  // Before the work, which takes a while.
  refuse_missing_folder(command.output.path);
  refuse_replacing(command.output, inputs);
  if (!command.report.empty()) {
    refuse_missing_folder(command.report);
    refuse_replacing({command.report, command.output.force}, inputs);
    if (command.report == command.output.path) {
      fail_usage("--report " + command.report, "this is also the output", "give another name");
    }
  }

  const bool joints_alone = kinds.size() == 1 && kinds[0] == TargetKind::kJoints;
  const bool geometry = !joints_alone || !command.images.empty();
  const SolvedRig rig = open_solved_rig(command.rig, geometry, session);
  const std::vector<uint32_t> moving = command.controls.empty()
                                           ? std::vector<uint32_t>{}
                                           : find_moving(command.controls, rig.rig, rig.shown);
  std::vector<SolveTarget> targets;
  Rate own_rate;
  for (size_t t = 0; t < options.size(); ++t) {
    targets.push_back(open_target(options[t], kinds[t], rig, session));
    const size_t count = targets[t].frame_count;
    if (count > kMostSolvedFrames) {
      fail(kInvalid, "cannot solve", shown_name(options[t].path),
           "it has more than 10,000,000 frames", "solve it in parts");
    }
    if (count != targets[0].frame_count) {
      fail(kInvalid, "cannot solve", shown_name(options[t].path),
           "it has " + grouped(count) + " frames, the first target has " +
               grouped(targets[0].frame_count),
           "give the same frames of each");
    }
    watch_space(options[t], command.rigid, rig, targets[t]);
    if (!own_rate.known()) own_rate = targets[t].rate;
  }
  SolveTarget& target = targets[0];
  FitTargets data(targets, weights);
  const Fit fit = create_fit(rig, data, moving);
  if (neutral.given()) {
    adapt_to_neutral(neutral, command, rig, fit, target, session);
    data = FitTargets(targets, weights);
  }
  SolvedTake take = solve_take(command, rig, targets, data, fit, session);
  take.rig = rig.file ? read_string(*rig.file, "desc.name") : rig.shown;
  take.rate = rate.known() ? rate : own_rate.known() ? own_rate : Rate{60, 1};
  take.unobservable = list_unobservable(fit, moving, take.controls);
  note_results(take, target, session);
  std::string image;
  if (!command.images.empty()) image = draw_solve(take, target, rig, command.rig, session);
  if (keys > 0) reduce_keys(take, keys);

  interrupt.reset();  // files that are being written have a handler of their own
  Output output(command.output.path);
  if (ends_with(command.output.path, ".clip")) {
    write_solved_clip(take, output);
  } else {
    write_solved_json(take, output);
  }
  std::unique_ptr<Output> report, drawn;
  if (!command.report.empty()) {
    report = std::make_unique<Output>(command.report);
    write_solve_report(take, target, *report);
  }
  std::unique_ptr<OutputFolder> folder;
  if (!image.empty()) {
    folder = std::make_unique<OutputFolder>(command.images);
    drawn = std::make_unique<Output>(folder->file("solve.png"));
    drawn->write(image);
  }
  output.commit();
  if (report) report->commit();
  if (drawn) drawn->commit();
  note_written(session, command.output.path, output.size());
}

Command add_solve_command(CLI::App& app, const Session& session) {
  auto options = std::make_shared<SolveCommand>();
  auto targets = std::make_shared<std::vector<std::string>>();
  CLI::App* solve = app.add_subcommand(
      "solve", "Find the controls for meshes, joints, landmarks, or another rig's controls");
  solve->add_option("RIG", options->rig, "DNA file or baked rig")->type_name("")->required();
  solve
      ->add_option("TARGET", *targets,
                   "What to match: .npy, .npz, .glb, .obj, a folder of OBJ, .csv, .json, .clip.\n"
                   "Several are matched together; KIND:FILE says the kind of each")
      ->type_name("");
  add_output_options(*solve, options->output,
                     "Controls to write, as .clip or .json; - writes JSON to standard output")
      ->required();
  solve
      ->add_option(
          "--kind", options->target.kind,
          "What TARGET holds: vertices, surface, joints, landmarks3, landmarks2\nor weights "
          "(default: told by its name and by --from)")
      ->type_name("KIND");
  solve
      ->add_option("--weights", options->weights,
                   "What the mean squared distance of each of several targets counts, such\nas "
                   "1,0.001: needed where joints, lengths or pixels are mixed (default: 1)")
      ->type_name("LIST");
  solve
      ->add_option("--from", options->target.from,
                   "Rig that the controls in TARGET are of; its mesh has the topology\nof that of "
                   "RIG")
      ->type_name("OTHER");
  solve
      ->add_option("--mesh", options->target.mesh,
                   "Mesh that has the vertices or landmarks (default: the first of\nLOD 0)")
      ->type_name("NAME");
  solve
      ->add_option(
          "--unit", options->target.unit,
          "Unit of vertices or a surface: cm, m, mm, dm or in (default: m for GLB and\nOBJ "
          "of `mien export`, else that of RIG, whose size it must have)")
      ->type_name("NAME");
  solve
      ->add_option("--landmarks", options->target.landmarks,
                   "JSON that says where landmarks are on the mesh, and the camera")
      ->type_name("FILE");
  solve
      ->add_option(
          "--place-landmarks", options->place,
          "Write a file for --landmarks instead: where the landmarks of a set\nare on RIG. "
          "68, or mediapipe with its canonical face as TARGET")
      ->type_name("SET");
  solve
      ->add_option(
          "--mask", options->target.mask,
          "How much each vertex, landmark or joint counts: NPY with a number for\neach, or "
          "JSON with names and positions")
      ->type_name("FILE");
  solve
      ->add_option("--controls", options->controls,
                   "Only these raw controls may move: names or patterns such as\nmouth*,jawOpen")
      ->type_name("LIST");
  solve
      ->add_option("--first", options->first,
                   "These raw controls are found first, alone, in the first frame; then all\nmove: "
                   "jaw* helps where a mouth is far open")
      ->type_name("LIST");
  solve->add_flag("--rigid", options->rigid,
                  "The target may be rotated and moved as a whole in each frame; with\nlandmarks2, "
                  "the camera moves");
  solve->add_flag("--focal", options->focal,
                  "Find the focal length of the camera too, with --rigid");
  solve
      ->add_option(
          "--neutral", options->neutral,
          "Landmarks are of another person, whose face is at rest in the first N\nframes, or "
          "in a CSV like TARGET: what that face differs in is no\nexpression. With --rigid")
      ->type_name("N|FILE");
  solve
      ->add_option("--robust", options->robust,
                   "Points farther off than S count less, such as wrong landmarks: in the\nunit of "
                   "the rig, or pixels (default: all count)")
      ->type_name("S");
  solve
      ->add_option("--reach", options->reach,
                   "Vertices farther than R from a surface have no target, in the unit of\nthe rig "
                   "(default: no limit)")
      ->type_name("R");
  solve->add_option("--rate", options->rate, "Frames per second (default: TARGET's, otherwise 60)")
      ->type_name("R");
  solve
      ->add_option("--keys", options->keys,
                   "Keep only keys between which straight lines are within EPS of the\nvalues")
      ->type_name("EPS");
  solve
      ->add_option("--smooth", options->smooth,
                   "Weight of changes from frame to frame against the mean squared\ndistance "
                   "(default: 0)")
      ->type_name("S");
  solve
      ->add_option("--sparse", options->sparse,
                   "Weight of the sum of all controls against it: few controls explain\na frame "
                   "(default: 0)")
      ->type_name("S");
  solve
      ->add_option("--report", options->report,
                   "Write residuals of frames and of each landmark, joint or region,\nunobservable "
                   "controls, missing data, jumps and times as JSON")
      ->type_name("R.json");
  solve
      ->add_option("--pictures", options->images,
                   "Draw target, result and distance of some frames as a PNG file in\nthis folder")
      ->type_name("DIR");
  solve->footer(
      "TARGET by kind:\n"
      "  vertices    NPY of frames x vertices x 3 in the unit and order of the mesh, an OBJ or "
      "GLB\n"
      "              (each morph target is a frame), or a folder of OBJ, a frame each\n"
      "  surface     OBJ, GLB or a folder of OBJ of any topology: vertices are drawn to the "
      "nearest\n"
      "              places that face the same way\n"
      "  joints      NPY of frames x joints x 9, as `mien eval` writes joints, or a GLB whose "
      "nodes\n"
      "              have the names of joints\n"
      "  landmarks3  CSV time,NAME.x,NAME.y,NAME.z,...; empty cells are missing\n"
      "  landmarks2  CSV time,NAME.x,NAME.y,... in pixels, seen by the camera of --landmarks\n"
      "  weights     JSON of `mien play`, or a clip, for the rig --from: what its controls do to\n"
      "              the mesh is what RIG shall do\n\n"
      "--landmarks: {\"points\": {\"chin\": 1234, \"nose\": {\"positions\": [1, 2, 3], "
      "\"weights\":\n"
      "[0.2, 0.3, 0.5]}}, \"camera\": {\"focal\": [1200, 1200], \"center\": [960, 540],\n"
      "\"rotation\": [9 numbers, by rows], \"translation\": [0, 0, 100]}}. With --rigid, rotation "
      "and\n"
      "translation may be left out. Names that are numbers are positions of the mesh.\n\n"
      "--mask: {\"names\": {\"*Lip*\": 1, \"*Jaw*\": 0.5}, \"positions\": [12, [100, 200]],\n"
      "\"otherwise\": 0}, with names of landmarks or joints; a vertex counts as far as these "
      "joints\n"
      "move it. See docs/solving.md.\n\n"
      "Examples:\n"
      "  mien solve head.dna scan.npy -o take.clip --report report.json\n"
      "  mien solve head.dna scans/ -o take.json --keys 0.01 --pictures pictures/\n"
      "  mien solve head.dna scan.obj --kind surface --rigid --reach 2 -o take.json\n"
      "  mien solve head.dna animation.glb --kind joints -o take.clip\n"
      "  mien solve head.dna face.csv --landmarks points.json -o take.clip --smooth 0.01\n"
      "  mien solve head.dna face.csv --landmarks points.json --rigid --neutral 60 -o take.clip\n"
      "  mien solve head.dna surface:scan.obj face.csv --landmarks points.json --rigid -o "
      "take.json\n"
      "  mien solve other.dna scene.json --from head.dna -o other.clip\n"
      "  mien solve head.dna --place-landmarks 68 -o points.json");
  return {solve, [options, targets, &session] {
            if (!targets->empty()) {
              options->target.path = targets->front();
              options->others.assign(targets->begin() + 1, targets->end());
            }
            solve_file(*options, session);
          }};
}

}  // namespace mien::cli
