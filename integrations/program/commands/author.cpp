// SPDX-License-Identifier: MIT
// mien author: a rig from a mesh.
#include <mien_author.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "integrations/program/commands/author_images.h"
#include "integrations/program/commands/author_input.h"
#include "integrations/program/commands/author_landmarks.h"
#include "integrations/program/commands/author_materials.h"
#include "integrations/program/commands/author_metahuman.h"
#include "integrations/program/commands/mesh_view.h"
#include "integrations/program/commands/options.h"
#include "integrations/program/io/input.h"
#include "integrations/program/io/interrupt.h"
#include "integrations/program/io/json_check.h"
#include "integrations/program/io/matched_names.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/output.h"
#include "integrations/program/io/text.h"
#include "integrations/program/io/thread_pool.h"
#include "integrations/program/io/write_dna.h"
#include "integrations/program/render/png.h"

namespace mien::cli {

namespace {

using Json = nlohmann::ordered_json;
using AuthorReport =
    std::unique_ptr<MienAuthorReport, Destroy<MienAuthorReport, mien_author_report_close>>;

struct AuthorCommand {
  std::string mesh, shapes, unit, object;
  std::string joints = "240", influences = "8", lods = "8", seed = "1", groups = "3", threads = "0";
  std::string symmetry = "auto", residual = "targets", metric = "depth";
  std::string up, front;  // empty: guessed
  std::string overlaps = "0", lod_triangles = "0.5";
  std::string report, images, crop, objects, names, preset, landmarks, confidence = "0.25";
  bool copy_textures = false;
  bool paper = false, no_neck_cut = false, mask_from_shapes = false, area_density = false;
  OutputFile output;
};

uint32_t parse_count(const char* option, const std::string& word, uint32_t least, uint32_t most) {
  const uint64_t count = parse_number(option, word, most);
  if (count >= least) return static_cast<uint32_t>(count);
  fail_usage(std::string(option) + " " + word, "this is below " + std::to_string(least),
             "give " + std::to_string(least) + " to " + std::to_string(most));
}

double parse_confidence(const std::string& word) {
  char* end = nullptr;
  const double least = std::strtod(word.c_str(), &end);
  if (!word.empty() && *end == 0 && least >= 0 && least <= 1) return least;
  fail_usage("--confidence \"" + word + "\"", "this is not a number from 0 to 1",
             "give 0 to rig a mesh whatever was found on it");
}

double parse_share(const char* option, const std::string& word) {
  char* end = nullptr;
  const double share = std::strtod(word.c_str(), &end);
  if (!word.empty() && *end == 0 && share > 0 && share <= 1) return share;
  fail_usage(std::string(option) + " \"" + word + "\"",
             "this is not a number above 0 and at most 1",
             "give a share: 0.5 keeps half, 1 keeps all");
}

std::string up_of(const AuthorCommand& command) { return command.up.empty() ? "y" : command.up; }
std::string front_of(const AuthorCommand& command) {
  return command.front.empty() ? "z" : command.front;
}

void set_axes(const AuthorCommand& command, MienAuthorDesc& desc) {
  const std::string up = up_of(command), front = front_of(command);
  desc.up = MIEN_MESH_AXIS_X + static_cast<uint32_t>(parse_word("--up", up));
  desc.front = MIEN_MESH_AXIS_X + static_cast<uint32_t>(parse_word("--front", front));
  if (up.back() != front.back()) return;
  fail_usage("--up " + up + " --front " + front, "both are the same axis",
             "give two different axes");
}

/// The options, parsed before any file is opened.
MienAuthorDesc parse_options(const AuthorCommand& command) {
  auto desc = sized<MienAuthorDesc>();
  desc.facial_joints = parse_count("--joints", command.joints, 1, 7000);
  desc.influences = parse_count("--influences", command.influences, 1, 12);
  desc.lods = parse_count("--lods", command.lods, 1, 8);
  desc.lod_triangles = parse_share("--lod-triangles", command.lod_triangles);
  desc.groups = parse_count("--groups", command.groups, 2, 16);
  desc.seed = parse_number("--seed", command.seed, UINT64_MAX);
  desc.symmetry =
      MIEN_SYMMETRY_AUTO + static_cast<uint32_t>(parse_word("--symmetry", command.symmetry));
  set_axes(command, desc);
  if (!command.unit.empty()) {
    desc.unit = parse_unit(command.unit);
  }
  if (command.paper) desc.flags |= MIEN_AUTHOR_PAPER;
  if (command.no_neck_cut) desc.flags |= MIEN_AUTHOR_NO_NECK_CUT;
  if (command.mask_from_shapes) desc.flags |= MIEN_AUTHOR_MASK_FROM_SHAPES;
  if (command.area_density) desc.flags |= MIEN_AUTHOR_AREA_DENSITY;
  if (!command.preset.empty()) {
    parse_word("author --preset", command.preset);
    desc.flags |= MIEN_AUTHOR_METAHUMAN_NAMES;
  }
  if (parse_word("--residual", command.residual) == 1) desc.flags |= MIEN_AUTHOR_NO_TARGETS;
  if (parse_word("--metric", command.metric) == 1) desc.flags |= MIEN_AUTHOR_GROUP_IN_SPACE;
  desc.overlap_correctives = parse_count("--overlap-correctives", command.overlaps, 0, 10000);
  desc.face_object = {command.object.data(), command.object.size()};
  return desc;
}

/// The part of a mesh that is kept, in its unit and axes.
struct Crop {
  double low[3] = {-INFINITY, -INFINITY, -INFINITY}, high[3] = {INFINITY, INFINITY, INFINITY};

  bool holds(const double* p) const {
    for (int i = 0; i < 3; ++i) {
      if (!(p[i] >= low[i] && p[i] <= high[i])) return false;
    }
    return true;
  }
};

/// "-1,1,5,,," keeps everything within 1 of the middle and above 5.
Crop parse_crop(const std::string& text) {
  Crop crop;
  const auto wrong = [&](const std::string& why) {
    fail_usage("--crop \"" + text + "\"", why,
               "give X0,X1,Y0,Y1,Z0,Z1 in the unit of the mesh; leave a number out for no limit: "
               "-1,1,5,,,");
  };
  size_t at = 0;
  for (int i = 0; i < 6; ++i) {
    const size_t comma = text.find(',', at);
    if ((comma == std::string::npos) != (i == 5)) wrong("these are not six numbers");
    const std::string word = text.substr(at, comma - at);
    at = comma + 1;
    if (word.empty()) continue;
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (end != word.c_str() + word.size() || !std::isfinite(value)) {
      wrong("\"" + word + "\" is not a number");
    }
    (i % 2 == 0 ? crop.low : crop.high)[i / 2] = value;
  }
  for (int i = 0; i < 3; ++i) {
    if (crop.low[i] >= crop.high[i]) wrong("a lower limit is not below the upper one");
  }
  return crop;
}

/// The objects that are named, by number.
std::vector<bool> parse_objects(const std::string& names, const std::string& path,
                                const MeshFile& mesh) {
  std::vector<bool> named(mesh.objects.size());
  for (size_t at = 0, end = 0; end != std::string::npos; at = end + 1) {
    end = names.find(',', at);
    const std::string name = names.substr(at, end - at);
    bool found = false;
    std::string known;
    for (size_t o = 0; o < mesh.objects.size(); ++o) {
      if (mesh.objects[o].name == name) named[o] = found = true;
      if (o < 12) known += (o > 0 ? ", " : "") + mesh.objects[o].name;
    }
    if (mesh.objects.size() > 12) known += ", ...";
    if (!found) {
      fail_mesh(shown_name(path), "", "there is no object \"" + name + "\"",
                mesh.objects.empty() ? "leave out --objects" : "its objects are: " + known);
    }
  }
  return named;
}

/// Leaves out faces of other objects and those with a corner outside. Positions keep their numbers,
/// which shapes go by.
void keep_faces(const AuthorCommand& command, const Crop& crop, MeshFile& mesh) {
  std::vector<bool> named(mesh.objects.size(), true);
  if (!command.objects.empty()) named = parse_objects(command.objects, command.mesh, mesh);
  MeshFile kept;
  size_t corner = 0, face = 0;
  for (size_t o = 0; o < mesh.objects.size(); ++o) {
    const MeshObject& object = mesh.objects[o];
    MeshObject part = {object.name, static_cast<uint32_t>(kept.face_sizes.size()), 0,
                       object.material};
    for (uint32_t f = 0; f < object.face_count; ++f) {
      const uint32_t size = mesh.face_sizes[face++];
      const uint32_t* corners = mesh.corners.data() + corner;
      const bool inside = named[o] && std::all_of(corners, corners + size, [&](uint32_t v) {
                            return crop.holds(&mesh.positions[size_t{3} * v]);
                          });
      if (inside) {
        kept.face_sizes.push_back(size);
        kept.corners.insert(kept.corners.end(), corners, corners + size);
        if (!mesh.corner_uvs.empty()) {
          const uint32_t* uvs = mesh.corner_uvs.data() + corner;
          kept.corner_uvs.insert(kept.corner_uvs.end(), uvs, uvs + size);
        }
        ++part.face_count;
      }
      corner += size;
    }
    if (part.face_count > 0) kept.objects.push_back(part);
  }
  if (kept.face_sizes.empty()) {
    fail_mesh(shown_name(command.mesh), "", "no face lies within --crop",
              "the limits are in the unit and axes of the mesh");
  }
  mesh.face_sizes = std::move(kept.face_sizes);
  mesh.corners = std::move(kept.corners);
  mesh.corner_uvs = std::move(kept.corner_uvs);
  mesh.objects = std::move(kept.objects);
}

/// Progress on the terminal, and the time of each step.
struct Watch {
  using Clock = std::chrono::steady_clock;

  Progress progress;
  Json seconds = Json::object();
  std::string step;
  Clock::time_point since = Clock::now();

  explicit Watch(const Session& session) : progress(session, "rig", 100) {}

  void enter(const std::string& next) {
    const Clock::time_point now = Clock::now();
    if (!step.empty()) {
      const double before = seconds.contains(step) ? seconds[step].get<double>() : 0;
      seconds[step] = before + std::chrono::duration<double>(now - since).count();
    }
    step = next;
    since = now;
  }
  static int32_t MIEN_CALLBACK report(void* user, const char* step, double share) {
    Watch& watch = *static_cast<Watch*>(user);
    watch.enter(step);
    watch.progress.at_share(share);
    return 0;
  }
};

struct Made {
  Dna dna;
  Json report;
};

Made make_rig(const AuthorCommand& command, MienAuthorDesc desc, const MeshFile& file,
              const Session& session) {
  const MeshView view(file);
  ThreadPool pool(parse_count("--threads", command.threads, 0, 1024));
  const MienParallelFor parallel = pool.parallel_for();
  Watch watch(session);
  desc.parallel = &parallel;
  desc.progress = Watch::report;
  desc.progress_user = &watch;
  auto error = sized<MienError>();
  MienDna* dna = nullptr;
  MienAuthorReport* made = nullptr;
  const MienStatus status = mien_author_rig(&view.mesh, &desc, &dna, &made, &error);
  watch.enter("");
  watch.progress.finish();
  check(status, &error, "cannot rig", shown_name(command.mesh));
  const AuthorReport report(made);
  Made out = {Dna(dna), {}};
  MienStringView json = {};
  check(mien_author_report_json(report.get(), &json), nullptr, "cannot rig", command.mesh);
  out.report = parse_written_json<Json>({json.data, json.count});
  double total = 0;
  for (const Json& seconds : watch.seconds) total += seconds.get<double>();
  watch.seconds["total"] = total;
  out.report["seconds"] = watch.seconds;
  return out;
}

std::string one_decimal(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

/// Signs that the axes of the mesh are not those of --up and --front.
void note_turned(const AuthorCommand& command, const MeshFile& mesh, const Json& report,
                 const Session& session) {
  const std::string how = "; if the mesh is rotated, give its axes with --up and --front";
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (const uint32_t v : mesh.corners) {
    for (size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], mesh.positions[3 * size_t{v} + k]);
      high[k] = std::max(high[k], mesh.positions[3 * size_t{v} + k]);
    }
  }
  const size_t up = static_cast<size_t>(up_of(command).back() - 'x');
  const double height = high[up] - low[up];
  double across = 0;
  for (size_t k = 0; k < 3; ++k) across = std::max(across, high[k] - low[k]);
  if (across > 1.1 * height) {
    note(session, "the mesh is " + std::to_string(std::lround(100 * across / height)) +
                      " % as wide or deep as it is high" + how);
  }
  const Json& symmetry = report["symmetry"];
  const double apart = symmetry["error"].get<double>();
  if (command.symmetry == "auto" && !command.paper && !symmetry["enforced"].get<bool>()) {
    note(session,
         "the halves of the face differ by " + one_decimal(100 * apart) +
             " % of its size, so joints are " +
             (symmetry["paired"].get<bool>() ? "in pairs, but not mirrored" : "not mirrored") +
             how);
  }
  if (const Json& groups = report["groups"]; !report["face_only"].get<bool>()) {
    uint64_t positions = 0;
    for (const Json& count : groups["counts"]) positions += count.get<uint64_t>();
    const uint64_t mask = report["mask_positions"].get<uint64_t>();
    if (mask < positions / 5) {
      note(session, "the face mask covers only " + std::to_string(mask) + " of " +
                        std::to_string(positions) +
                        " positions, and facial joints are placed there only; to extend it, give "
                        "shapes or --groups 2 --area-density" +
                        how);
    }
  }
  if (!report["face_only"].get<bool>() && report["throat"].is_null() && !command.no_neck_cut) {
    note(session, "no throat was found below the nose, so the face mask includes the neck" + how);
  }
}

/// Notes about input that is valid but probably a mistake.
void note_oddities(const AuthorCommand& command, const MeshFile& mesh, const Json& report,
                   const Session& session) {
  const double size = report["mesh"]["diagonal"].get<double>();
  if (size < 10 || size > 300) {
    note(session, "the diagonal of the face mesh is " + one_decimal(size) +
                      " cm long; if that is wrong, give the unit with --unit");
  }
  for (const MeshShape& shape : mesh.shapes) {
    if (find_incoherence(mesh, shape) < 0.5) continue;
    note(session,
         "shape " + shape.name +
             " moves neighboring vertices in different directions; does it belong to this mesh?");
  }
  const double next = report["mesh"]["next_area"].get<double>();
  if (next > 0.5) {
    note(session,
         "another surface has " + std::to_string(std::lround(100 * next)) +
             " % of the area of the face; only one face is rigged, the rest follows it or is "
             "rigid: choose with --face-object, --objects or --crop");
  }
  const uint64_t facial = report["facial_joints"].get<uint64_t>();
  if (facial < parse_number("--joints", command.joints, 7000)) {
    note(session, "the face has room for only " + std::to_string(facial) + " facial joints");
  }
  const Json& weights = report[report["fit"].is_null() ? "weights" : "fitted_weights"];
  const uint64_t idle = weights["idle_bones"].get<uint64_t>();
  if (idle > facial / 10) {
    note(session, std::to_string(idle) + " of " + std::to_string(facial) +
                      " facial joints have the largest weight of no vertex: the mesh is too coarse "
                      "for so many; "
                      "lower --joints");
  }
  if (report["face_only"].get<bool>()) {
    note(session,
         "the head has no back, so all of the mesh is taken as the face; to use only a part of a "
         "mesh, give --crop");
  }
  note_turned(command, mesh, report, session);
}

/// Gives shapes the names of --names, and refuses two with one name.
void rename_shapes(const AuthorCommand& command, MeshFile& mesh) {
  const NamesFile names(command.names);
  const char* const what = "cannot name controls";
  std::vector<std::string> known;
  for (const MeshShape& shape : mesh.shapes) known.push_back(shape.name);
  for (const auto& [name, shares] : names.names()) {
    const auto found = std::find(known.begin(), known.end(), name);
    const std::string where = names.shown() + ", " + one_line(name);
    if (found == known.end()) {
      fail(kInvalid, what, where, "there is no shape of this name",
           nearest_question(name, known, "names are those of the shapes of MESH"));
    }
    if (shares.size() != 1 || shares[0].weight != 1) {
      fail(kInvalid, what, where, "a shape becomes one control", "give one name");
    }
    mesh.shapes[static_cast<size_t>(found - known.begin())].name = shares[0].control;
  }
  std::set<std::string> seen;
  for (const MeshShape& shape : mesh.shapes) {
    if (seen.insert(shape.name).second || names.empty()) continue;
    fail(kInvalid, what, names.shown(), "two shapes are named \"" + one_line(shape.name) + "\"",
         "give each its own name");
  }
}

/// The usual names of shapes, for the report; a note lists unknown ones.
Json usual_names(const MeshFile& mesh, const Session& session) {
  Json usual = Json::object();
  std::string unknown;
  size_t unknown_count = 0;
  for (const MeshShape& shape : mesh.shapes) {
    const std::string name = usual_name(shape.name);
    usual[shape.name] = name.empty() ? Json() : Json(name);
    // Those of MetaHuman heads that no other vocabulary has.
    if (!name.empty() || shape.name.compare(0, 17, "CTRL_expressions.") == 0) continue;
    if (++unknown_count <= 8) unknown += (unknown.empty() ? "" : ", ") + one_line(shape.name);
  }
  if (unknown_count > 8) unknown += ", ...";
  if (unknown_count > 0) {
    note(session,
         std::to_string(unknown_count) + " of " + std::to_string(mesh.shapes.size()) +
             " shapes have names that no standard has, so only the same names drive them: " +
             unknown + "; to give them others, use --names");
  }
  return usual;
}

// What the options leave open -------------------------------------------------------------------

MeshStand stand_of(const AuthorCommand& command) {
  const auto axis_of = [](const std::string& word) {
    return FileAxis{static_cast<size_t>(word.back() - 'x'), word.size() > 1 ? -1.0 : 1.0};
  };
  return {axis_of(up_of(command)), axis_of(front_of(command))};
}

/// Changes the axes if the mesh clearly has others, and refuses a head that is rotated by an angle that
/// exchanging axes cannot correct.
void settle_axes(AuthorCommand& command, const MeshFile& mesh, const Session& session) {
  const MeshStand given = stand_of(command);
  const StandGuess guess = guess_stand(mesh, given);
  const std::string differ = "the halves of the face differ by " +
                             one_decimal(100 * guess.symmetry_error) + " % of its size";
  if (guess.turned_degrees != 0 && command.symmetry == "auto") {
    fail_mesh(shown_name(command.mesh), "",
              "the head is turned by about " +
                  std::to_string(std::lround(std::abs(guess.turned_degrees))) +
                  " degrees about its axis " + std::string(1, "xyz"[guess.turned_about]) + ": " +
                  differ,
              "rotate it back in the program that made it, or rig it as it is with --up " +
                  up_of(command) + " --front " + front_of(command) + " --confidence 0");
  }
  const MeshStand& stand = guess.stand;
  if (stand.up.word() == given.up.word() && stand.front.word() == given.front.word()) return;
  std::string why = stand.up.axis == given.up.axis && stand.up.sign != given.up.sign
                        ? "the mesh stands upside down"
                        : "the mesh looks the other way";
  if (stand.left_axis() != given.left_axis()) {
    why = differ;
  } else if (stand.up.axis != given.up.axis) {
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (const uint32_t v : mesh.corners) {
      for (size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], mesh.positions[3 * size_t{v} + k]);
        high[k] = std::max(high[k], mesh.positions[3 * size_t{v} + k]);
      }
    }
    const size_t up = given.up.axis, deep = given.front.axis;
    why = "the mesh is " +
          std::to_string(std::lround(100 * (high[deep] - low[deep]) / (high[up] - low[up]))) +
          " % as wide or deep as it is high";
  }
  command.up = stand.up.word();
  command.front = stand.front.word();
  note(session, why + ", so it is rigged with --up " + command.up + " --front " + command.front +
                    "; if that is wrong, give both");
}

std::string limit(double value) {
  if (!std::isfinite(value)) return "";
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

/// Crops a whole body to head and shoulders.
void settle_crop(const AuthorCommand& command, const BodyGuess& body, MeshFile& mesh,
                 const Session& session) {
  if (!body.is_body || !command.crop.empty()) return;
  Crop crop;
  std::string text;
  for (int k = 0; k < 3; ++k) {
    crop.low[k] = body.low[k];
    crop.high[k] = body.high[k];
    text += (k > 0 ? "," : "") + limit(body.low[k]) + "," + limit(body.high[k]);
  }
  keep_faces(command, crop, mesh);
  note(session,
       "the mesh is a whole body, so only its head and shoulders are rigged, as with --crop=" +
           text + "; if that is wrong, give another box");
}

/// glTF is in meters. For other meshes, the size of the head decides.
void settle_unit(const AuthorCommand& command, const BodyGuess& body, const MeshFile& mesh,
                 MienAuthorDesc& desc, const Session& session) {
  if (!command.unit.empty()) return;
  desc.unit = mesh.in_meters ? 100 : 1;
  if (mesh.in_meters) return;
  const double height = body.head_height > 0 ? body.head_height : body.height;
  const UnitGuess unit = guess_unit(height);
  desc.unit = unit.centimeters;
  if (unit.centimeters == 1) return;
  note(session, "the head is " + limit(height) + " units high, so the unit is taken to be " +
                    unit.name + "; if that is wrong, give it with --unit");
}

std::vector<AuthorImage> draw_images(const AuthorCommand& command, const MienAuthorDesc& desc,
                                     const MeshFile& mesh, Made& made, const Session& session) {
  RigFile file = {shown_name(command.output.path), {}, std::move(made.dna), sized<MienDnaInfo>()};
  check(mien_dna_info(file.dna.get(), &file.info), nullptr, "cannot draw", file.shown);
  PosedScene scene = open_scene(std::move(file), session);
  std::vector<AuthorImage> made_images =
      draw_author_images({mesh, desc.unit, made.report, scene}, session);
  made.dna = std::move(scene.file.dna);
  return made_images;
}

void run(AuthorCommand command, const Session& session) {
  MienAuthorDesc desc = parse_options(command);
  const double least_confidence = parse_confidence(command.confidence);
  const Crop crop = command.crop.empty() ? Crop{} : parse_crop(command.crop);
  refuse_terminal(command.output.path, session, "a DNA file");
  std::vector<std::string> inputs = {command.mesh};
  if (!command.shapes.empty()) inputs.push_back(command.shapes);
  if (!command.landmarks.empty()) inputs.push_back(command.landmarks);
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
  auto interrupt = std::make_unique<EndOnInterrupt>();
  MeshFile file = read_mesh_file(command.mesh);
  const LandmarksFile landmarks(command.landmarks, file);
  const std::vector<MienAuthorLandmark> marks = landmarks.list();
  desc.landmarks = marks.data();
  desc.landmark_count = marks.size();
  if (!command.shapes.empty()) file.shapes = read_shapes(command.shapes, file);
  if (!command.names.empty()) rename_shapes(command, file);
  if (!command.crop.empty() || !command.objects.empty()) keep_faces(command, crop, file);
  if (command.up.empty() && command.front.empty()) settle_axes(command, file, session);
  set_axes(command, desc);
  Json metahuman;
  if (!command.preset.empty()) metahuman = name_as_metahuman(stand_of(command), file, session);
  const BodyGuess body = guess_body(file, stand_of(command));
  settle_crop(command, body, file, session);
  settle_unit(command, body, file, desc, session);

  Made made = make_rig(command, desc, file, session);
  refuse_uncertain(made.report, least_confidence, shown_name(command.mesh));
  made.report["names"] = usual_names(file, session);
  if (!command.preset.empty()) made.report["metahuman"] = metahuman;
  note_oddities(command, file, made.report, session);
  std::vector<AuthorImage> made_images;
  if (!command.images.empty()) made_images = draw_images(command, desc, file, made, session);
  interrupt.reset();  // files that are being written have a handler of their own
  std::unique_ptr<Output> report;
  if (!command.report.empty()) {
    report = std::make_unique<Output>(command.report);
    report->write(made.report.dump(1) + "\n");
  }
  std::unique_ptr<OutputFolder> folder;
  std::vector<std::unique_ptr<Output>> images;
  if (!made_images.empty()) folder = std::make_unique<OutputFolder>(command.images);
  for (const AuthorImage& made_image : made_images) {
    images.push_back(std::make_unique<Output>(folder->file(made_image.name)));
    images.back()->write(render::to_png(made_image.image));
  }
  AuthoredMaterials materials(file, made.dna.get(), command.output.path, command.copy_textures,
                              session);
  write_dna(made.dna.get(), sized<MienWriteDesc>(), command.output.path, session);
  materials.commit();
  if (report) report->commit();
  for (const std::unique_ptr<Output>& image : images) image->commit();
}

}  // namespace

Command add_author_command(CLI::App& app, const Session& session) {
  auto options = std::make_shared<AuthorCommand>();
  CLI::App* author =
      app.add_subcommand("author", "Make a rig from a mesh: joints, weights, motion");
  author->add_option("MESH", options->mesh, "OBJ or GLB file of a head; - is standard input")
      ->required();
  add_output_options(*author, options->output, "File to write; - is standard output", "OUT.dna")
      ->required();
  author
      ->add_option(
          "--shapes", options->shapes,
          "Expressions: a folder of OBJ or .target files, an .mshp, or a GLB\n(default: the "
          "morph targets of MESH)")
      ->type_name("PATH");
  author
      ->add_option("--preset", options->preset,
                   "metahuman: name joints and controls as in MetaHuman heads where\n"
                   "they have a counterpart, so that their animation plays")
      ->type_name("NAME");
  author
      ->add_option("--names", options->names,
                   "JSON with other names for shapes: {\"smirk\": \"mouthSmileLeft\"}; the\n"
                   "report lists what each name means in ARKit")
      ->type_name("FILE");
  author
      ->add_option("--landmarks", options->landmarks,
                   "JSON with points of the face, used instead of those that are found:\n"
                   "{\"nose\": [0, 1.2, 9], \"chin\": 1043, \"eye_l\": \"EyeBall_L\"}: a place,\n"
                   "a position of MESH by its number from 0, or an object")
      ->type_name("FILE");
  author
      ->add_option("--confidence", options->confidence,
                   "Stop if a landmark that joints need is less certain than this:\n"
                   "0 to 1 (default: 0.25)")
      ->type_name("SHARE");
  author->add_option("--joints", options->joints, "Facial joints (default: 240)")->type_name("N");
  author
      ->add_option("--influences", options->influences,
                   "Largest number of joints per vertex: 1 to 12 (default: 8)")
      ->type_name("N");
  author->add_option("--lods", options->lods, "Levels of detail: 1 to 8 (default: 8)")
      ->type_name("N");
  author
      ->add_option("--lod-triangles", options->lod_triangles,
                   "Share of the triangles that each LOD keeps of the one\nbefore; 1 keeps all "
                   "(default: 0.5)")
      ->type_name("SHARE");
  author->add_option("--seed", options->seed, "Seed of the search for joints (default: 1)")
      ->type_name("N");
  author->add_option("--symmetry", options->symmetry, "Mirror joints: auto (default), on or off")
      ->type_name("NAME");
  author
      ->add_option("--residual", options->residual,
                   "Motion beyond that of the joints: targets (default), or off to leave it out")
      ->type_name("NAME");
  author
      ->add_option("--overlap-correctives", options->overlaps,
                   "Largest number of correctives for pairs of shapes that double\ntheir motion "
                   "(default: 0)")
      ->type_name("N");
  author->add_flag("--paper", options->paper,
                   "The published method alone: no symmetry, no weights by motion");
  author
      ->add_option(
          "--unit", options->unit,
          "Unit of MESH: cm, m, mm, dm or in (default: m for GLB, else by\nthe size of the head)")
      ->type_name("NAME");
  author
      ->add_option("--up", options->up,
                   "Axis to the top of the head (default: y, or found by the shape\nof the mesh)")
      ->type_name("AXIS");
  author
      ->add_option("--front", options->front,
                   "Axis out of the face (default: z, or found likewise)")
      ->type_name("AXIS");
  author->add_option("--face-object", options->object, "Object with the face (default: found)")
      ->type_name("NAME");
  author
      ->add_option("--objects", options->objects,
                   "Keep only these objects: names, separated by commas")
      ->type_name("NAMES");
  author
      ->add_option("--groups", options->groups,
                   "Number of groups in depth; the front one is the face (default: 3)")
      ->type_name("N");
  author
      ->add_option("--metric", options->metric,
                   "Distance between groups: depth (default), or euclid3 for\ncomparison")
      ->type_name("NAME");
  author->add_flag("--no-neck-cut", options->no_neck_cut, "Leave the neck in the face mask");
  author->add_flag("--mask-from-shapes", options->mask_from_shapes,
                   "Use the parts that shapes move as face mask: for heads that are not human");
  author->add_flag("--area-density", options->area_density,
                   "Weight vertices by the area around them: for scans");
  author
      ->add_option(
          "--crop", options->crop,
          "Keep the faces within X0,X1,Y0,Y1,Z0,Z1, in the unit and\naxes of MESH; leave out "
          "numbers for no limit:\n-1,1,5,,,")
      ->type_name("BOX");
  author->add_flag(
      "--copy-textures", options->copy_textures,
      "Copy the textures of MESH beside OUT.dna; otherwise\nOUT.materials.json has paths to them");
  author
      ->add_option("--threads", options->threads,
                   "Number of threads; 0 (default): as many as the machine has")
      ->type_name("N");
  author
      ->add_option("--report", options->report,
                   "Write a report of findings and measurements as JSON")
      ->type_name("R.json");
  author
      ->add_option(
          "--pictures", options->images,
          "Draw groups, face mask, joints, weights and shapes as PNG\nfiles in this folder")
      ->type_name("DIR");
  author->footer(
      "Without shapes it places joints and weights. The rig has the axes of MESH, in centimeters;\n"
      "each expression becomes a raw control of its name. The same input, options and seed give\n"
      "the same bytes for any number of threads. See docs/authoring.md.\n\n"
      "Examples:\n"
      "  mien author head.obj -o head.dna\n"
      "  mien author head.obj --shapes expressions/ -o head.dna --report report.json\n"
      "  mien author head.obj --joints 120 -o head.dna --pictures images/\n"
      "  mien author head.glb -o head.dna\n"
      "  mien author body.obj --unit dm --objects body --crop -1,1,5,,, -o head.dna\n"
      "  mien author scan.obj --unit mm --up z --front -y -o head.dna");
  return {author, [options, &session] { run(*options, session); }};
}

}  // namespace mien::cli
