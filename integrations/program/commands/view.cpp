// SPDX-License-Identifier: MIT
// mien view: the viewer of integrations/web, served on this machine with a file in it.
#include <cstdio>
#include <filesystem>
#include <map>

#include "integrations/program/commands/options.h"
#include "integrations/program/io/baked_file.h"
#include "integrations/program/io/input.h"
#include "integrations/program/io/materials.h"
#include "integrations/program/io/text.h"
#include "integrations/program/view/page.h"

namespace mien::cli {

namespace {

struct ViewOptions {
  std::string file, port, page;
  bool no_open = false;
};

/// So that a damaged file is refused here, where its place is told, and not in the page.
void check_rig(const std::string& bytes, const std::string& shown) {
  auto error = sized<MienError>();
  if (is_baked_bytes(bytes)) {
    MienBaked* baked = nullptr;
    const MienStatus status =
        mien_baked_open_memory(bytes.data(), bytes.size(), nullptr, &baked, &error);
    check(status, &error, "cannot view", shown);
    mien_baked_close(baked);
  } else if (bytes.compare(0, 3, "DNA") == 0) {
    MienDna* dna = nullptr;
    const MienStatus status =
        mien_dna_open_memory(bytes.data(), bytes.size(), nullptr, &dna, &error);
    check(status, &error, "cannot view", shown);
    mien_dna_close(dna);
  } else if (bytes.compare(0, 4, "glTF") != 0) {
    fail(kInvalid, "cannot view", shown, "it is not a DNA file, baked file or GLB",
         "check what was given; poses and takes are dropped on the page");
  }
}

/// Everything but letters, digits and - . _ ~ as %XX.
std::string url_encoded(const std::string& text) {
  std::string encoded;
  for (const char c : text) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                       c == '-' || c == '.' || c == '_' || c == '~';
    char hex[4];
    std::snprintf(hex, sizeof(hex), "%%%02X", static_cast<unsigned>(static_cast<unsigned char>(c)));
    encoded += plain ? std::string(1, c) : hex;
  }
  return encoded;
}

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
  std::string address = "/";
  view::Files files = view::load_page(options.page);
  if (!options.file.empty()) {
    std::string bytes = read_viewable(options.file);
    check_rig(bytes, shown_name(options.file));
    const std::string name = name_of(options.file, bytes);
    const std::string of_materials = served_materials(options.file, name, files, session);
    files["/rig/" + name] = {"application/octet-stream", std::move(bytes)};
    // The page decodes its query, the server the path that is in it.
    address += "?file=rig/" + url_encoded(url_encoded(name)) + of_materials;
  }
  view::serve(files, static_cast<uint16_t>(port), [&](uint16_t found) {
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
  view->add_option("--port", options->port, "Port on 127.0.0.1 (default: a free one)")
      ->type_name("N");
  view->add_flag("--no-open", options->no_open, "Print the address without opening a browser");
  view->add_option("--page", options->page,
                   "Folder of the viewer (default: the one installed or built with the program)")
      ->type_name("FOLDER");
  view->footer(
      "Serves the viewer on this machine until it is interrupted, and opens the browser. The "
      "file,\n"
      "and head.materials.json with its textures beside head.dna, are\n"
      "read once and only sent to the page; nothing leaves the machine. Other users of the "
      "machine\n"
      "can open the address too.\n\n"
      "Examples:\n"
      "  mien view head.dna\n"
      "  mien view head.rig --port 8000 --no-open\n"
      "  mien gen --preset medium -o - | mien view -");
  return {view, [options, &session] { run(*options, session); }};
}

}  // namespace mien::cli
