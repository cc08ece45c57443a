// SPDX-License-Identifier: MIT
// mien view: the viewer of integrations/web, served on this machine with a file in it.
#include <atomic>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "integrations/program/commands/options.h"
#include "integrations/program/commands/real_time.h"
#include "integrations/program/commands/view_takes.h"
#include "integrations/program/io/baked_file.h"
#include "integrations/program/io/input.h"
#include "integrations/program/io/materials.h"
#include "integrations/program/io/rig_file.h"
#include "integrations/program/io/text.h"
#include "integrations/program/view/page.h"

namespace mien::cli {

namespace {

struct ViewOptions {
  std::string file, port, page, names;
  std::vector<std::string> takes;
  RealTimeOptions real_time;
  bool no_open = false;
};

constexpr int64_t kLiveRate = 60;  // rows per second at most

/// Opens the file, so that a damaged one is refused here, where its place is told, and not in the page. Its
/// rig for live data, if `is_live`; null for a GLB.
Rig checked_rig(const std::string& bytes, const std::string& shown, bool is_live) {
  auto error = sized<MienError>();
  MienRig* rig = nullptr;
  if (is_baked_bytes(bytes)) {
    MienBaked* opened = nullptr;
    const MienStatus status =
        mien_baked_open_memory(bytes.data(), bytes.size(), nullptr, &opened, &error);
    check(status, &error, "cannot view", shown);
    const Baked baked(opened);
    if (is_live) {
      check(mien_rig_from_baked(opened, nullptr, &rig, &error), &error, "cannot view", shown);
    }
  } else if (bytes.compare(0, 3, "DNA") == 0) {
    MienDna* opened = nullptr;
    const MienStatus status =
        mien_dna_open_memory(bytes.data(), bytes.size(), nullptr, &opened, &error);
    check(status, &error, "cannot view", shown);
    const Dna dna(opened);
    if (is_live) {
      check(mien_rig_create(opened, nullptr, &rig, &error), &error, "cannot view", shown);
    }
  } else if (bytes.compare(0, 4, "glTF") != 0) {
    fail(kInvalid, "cannot view", shown, "it is not a DNA file, baked file or GLB",
         "name a rig first; poses and takes come after it, or are dropped on the page");
  }
  return Rig(rig);
}

/// A live source, whose rows the page gets with the names of raw controls.
class LiveView {
 public:
  LiveView(const ViewOptions& options, Rig rig, const Session& session)
      : rig_(std::move(rig)), session_(session),
        input_(open_live(options.real_time, {rig_.get(), nullptr, shown_name(options.file)},
                         NamesFile(options.names), session)),
        rows_(heading()) {}
  ~LiveView() {
    is_over_ = true;
    if (receiver_.joinable()) receiver_.join();
    note(session_, input_->summary());
  }
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  view::LiveRows& rows() { return rows_; }
  void start() {
    receiver_ = std::thread([this] { receive(); });
  }

 private:
  std::string heading() const {
    std::vector<std::string> names;
    for (const uint16_t curve : input_->curves()) {
      names.push_back(rig_name(rig_.get(), MIEN_KIND_RAW_CONTROL, curve));
    }
    const nlohmann::json line = {{"names", names}};
    return line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  }

  void receive() {
    input_->start();
    for (int64_t frame = 1; !is_over_; ++frame) {
      const int64_t tick = frame * MIEN_TICKS_PER_SECOND / kLiveRate;
      input_->receive_until(tick);
      bool is_new = false;
      int64_t time = 0;
      std::vector<float> row;
      while (input_->take(tick, time, row)) is_new = true;
      if (!is_new) continue;
      std::string line = "[";
      for (const float value : row) {
        char digits[32];
        line.append(digits, std::to_chars(digits, digits + sizeof(digits), value).ptr) += ',';
      }
      line.back() = ']';
      rows_.publish(line + "\n");
    }
  }

  Rig rig_;
  const Session& session_;
  std::unique_ptr<live::LiveInput> input_;
  view::LiveRows rows_;
  std::atomic<bool> is_over_{false};
  std::thread receiver_;
};

/// What the page calls the file; it tells GLB by the ending.
std::string name_of(const std::string& path, const std::string& bytes) {
  const std::string name =
      path == "-" ? "standard-input" : std::filesystem::path(path).filename().string();
  const bool is_glb = bytes.compare(0, 4, "glTF") == 0;
  const bool says_glb = name.size() > 4 && name.compare(name.size() - 4, 4, ".glb") == 0;
  return is_glb && !says_glb ? name + ".glb" : name;
}

/// The materials beside the rig, and their textures. Returns their part of the page's address.
std::string served_materials(const std::string& path, const std::string& name, view::Files& files,
                             const Session& session) {
  Materials materials = read_materials_beside(path);
  if (materials.list.empty()) return "";
  std::map<std::string, std::string> served;  // addresses, by path
  for (SurfaceMaterial& material : materials.list) {
    for (std::string& texture : material.textures) {
      if (texture.empty()) continue;
      if (const auto known = served.find(texture); known != served.end()) {
        texture = known->second;
        continue;
      }
      std::string& address = served[texture];
      std::error_code reason;
      if (!std::filesystem::is_regular_file(texture, reason)) {
        note(session, "the texture " + one_line(texture) + " is missing");
      } else {
        TextureFile read = read_texture(texture);
        address = "textures/" + std::to_string(served.size()) + (read.is_png ? ".png" : ".jpg");
        files["/rig/" + address] = {read.mime_type(), std::move(read.bytes)};
      }
      texture = address;
    }
  }
  const std::string file = materials_path(name);
  files["/rig/" + file] = {"application/json", materials_json(materials, "")};
  return "&materials=rig/" + url_encoded(url_encoded(file));
}

void run(const ViewOptions& options, const Session& session) {
  view::require_server();
  uint64_t port = 0;
  if (!options.port.empty()) {
    port = parse_number("--port", options.port, 65535);
    if (port == 0) fail_usage("--port 0", "no port has this number", "leave it out for a free one");
  }
  if (solves_landmarks(options.real_time)) {
    fail_usage("--live " + options.real_time.live, "landmarks are solved by 'mien play' only",
               "send its controls on: mien play SCENE RIG --live ... --send vmc://127.0.0.1:39539");
  }
  RealTime::check(options.real_time);
  const bool is_live = !options.real_time.live.empty();
  if (is_live && options.file.empty()) {
    fail_usage("--live", "there is no rig that live data move", "name a DNA file or a baked rig");
  }
  if (!options.names.empty() && !is_live) {
    fail_usage("--names", "nothing comes in", "add --live livelink://:11111");
  }
  std::string address = "/";
  std::unique_ptr<LiveView> live;
  view::Files files = view::load_page(options.page);
  if (!options.file.empty()) {
    std::string bytes = read_viewable(options.file);
    Rig rig = checked_rig(bytes, shown_name(options.file), is_live);
    if (is_live && !rig) {
      fail_usage("--live", "a GLB has no rig that live data move",
                 "name a DNA file or a baked rig");
    }
    if (is_live) live = std::make_unique<LiveView>(options, std::move(rig), session);
    const std::string name = name_of(options.file, bytes);
    const std::string of_materials = served_materials(options.file, name, files, session);
    files["/rig/" + name] = {"application/octet-stream", std::move(bytes)};
    // The page decodes its query, the server the path that is in it.
    address += "?file=rig/" + url_encoded(url_encoded(name)) + of_materials;
    address += serve_takes(options.takes, files, session);
    if (live) address += "&live=live";
  }
  view::serve(files, live ? &live->rows() : nullptr, static_cast<uint16_t>(port),
              [&](uint16_t found) {
                if (live) live->start();
                const std::string url = "http://127.0.0.1:" + std::to_string(found) + address;
                std::printf("%s\n", url.c_str());
                std::fflush(stdout);
                if (!options.no_open && !view::open_browser(url)) {
                  note(session, "no browser could be started: open this address in one");
                }
                note(session, "Ctrl+C ends it");
              });
}

}  // namespace

Command add_view_command(CLI::App& app, const Session& session) {
  auto options = std::make_shared<ViewOptions>();
  CLI::App* view = app.add_subcommand("view", "Show a rig in the browser, with sliders");
  view->add_option("FILE", options->file,
                   "DNA file, baked rig or GLB; - reads standard input. Default: an empty page")
      ->type_name("");
  view->add_option("TAKES", options->takes,
                   "What it plays: clips, Live Link Face CSV, scenes of 'mien play' with\nall that "
                   "they name, poses and frames (JSON), mixes, and a sound")
      ->type_name("");
  view->add_option("--port", options->port, "Port on 127.0.0.1 (default: a free one)")
      ->type_name("N");
  view->add_flag("--no-open", options->no_open, "Print the address without opening a browser");
  view->add_option("--page", options->page,
                   "Folder of the viewer (default: the one installed or built with the program)")
      ->type_name("FOLDER");
  view->add_option("--live", options->real_time.live,
                   "Show what arrives on a port: livelink://:11111 for the Live Link\nFace app, "
                   "vmc://:39539 for VMC; from other machines too, unless\na host is named")
      ->type_name("FROM");
  view->add_option("--delay", options->real_time.delay,
                   "Delay of live data in seconds, as for 'mien play' (default: 0.05)")
      ->type_name("S");
  view->add_option("--device", options->real_time.device,
                   "Take packets of Live Link Face only from this device")
      ->type_name("NAME");
  view->add_option("--names", options->names,
                   "With --live: JSON with meanings of names on this rig, as for\n'mien play'")
      ->type_name("FILE");
  view->footer(
      "Serves the viewer on this machine until it is interrupted, and opens the browser. The "
      "files, "
      "and head.materials.json with its textures beside head.dna, are read once and only sent to "
      "the "
      "page; nothing leaves the machine. Other users of the machine can open the address too.\n\n"
      "A scene that speaks is heard in time: its takes are made as 'mien speak' makes them.\n\n"
      "Examples:\n"
      "  mien view head.dna\n"
      "  mien view head.dna hello.clip hello.wav\n"
      "  mien view head.dna scene.json\n"
      "  mien view head.rig --port 8000 --no-open\n"
      "  mien view head.dna --live livelink://:11111\n"
      "  mien gen --preset medium -o - | mien view -");
  return {view, [options, &session] { run(*options, session); }};
}

}  // namespace mien::cli
