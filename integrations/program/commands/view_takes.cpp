// SPDX-License-Identifier: MIT
#include "integrations/program/commands/view_takes.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/input.h"
#include "integrations/program/io/rig_file.h"
#include "integrations/program/io/text.h"
#include "integrations/program/play/script.h"
#include "integrations/program/speech/source.h"

namespace mien::cli {

namespace {

constexpr const char* kCannotView = "cannot view";
constexpr double kSpeechRate = 60;  // as in 'mien play'
constexpr const char* kEndings[] = {".json", ".csv", ".clip", ".mix",  ".wav", ".mp3",
                                    ".ogg",  ".oga", ".opus", ".flac", ".m4a"};
constexpr size_t kFirstSound = 4;

/// Which of the endings a name has; past the last of none.
size_t ending_of(std::string name) {
  for (char& c : name) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 'a' - 'A') : c;
  const auto* found = std::find_if(std::begin(kEndings), std::end(kEndings), [&](const char* end) {
    return std::filesystem::path(name).extension() == end;
  });
  return static_cast<size_t>(found - std::begin(kEndings));
}

/// Whether a text is a scene; then also whether one of its layers is live.
bool is_scene(const std::string& text, bool& is_live) {
  const nlohmann::json root = nlohmann::json::parse(text, nullptr, false);
  if (!root.is_object() || !root.contains("layers") || !root["layers"].is_array()) return false;
  for (const nlohmann::json& layer : root["layers"]) {
    if (layer.is_object() && layer.contains("source") && layer["source"].is_object() &&
        layer["source"].contains("live")) {
      is_live = true;
    }
  }
  return true;
}

class Takes {
 public:
  Takes(view::Files& files, const Session& session) : files_(files), session_(session) {}

  void add(const std::string& path) {
    const std::string name = std::filesystem::path(path).filename().string();
    if (ending_of(name) == std::size(kEndings)) {
      fail_usage("\"" + one_line(path) + "\"", "this is nothing that a rig plays",
                 "give scenes, poses or frames (.json), .csv, .clip, .mix, or a sound");
    }
    std::string bytes = read_any_bytes(path, kCannotView);
    bool is_live = false;
    if (ending_of(name) == 0 && is_scene(bytes, is_live)) {
      add_parts(parse_script(bytes, path, is_live), path);
    }
    serve(name, std::move(bytes));
  }

  void serve(const std::string& name, std::string bytes) {
    if (!names_.insert(name).second) return;
    has_sound_ = has_sound_ || ending_of(name) >= kFirstSound;
    files_["/rig/" + name] = {"application/octet-stream", std::move(bytes)};
    // The page decodes its query, the server the path that is in it.
    address_ += "&more=rig/" + url_encoded(url_encoded(name));
  }

  /// What is heard, unless a sound is named.
  void serve_sound() {
    if (!sound_.empty() && !has_sound_) serve(sound_name_, std::move(sound_));
  }

  const std::string& address() const { return address_; }

 private:
  /// The page finds takes of speech by the layer, and by how many this one has said before.
  void add_parts(const Script& script, const std::string& path) {
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    std::set<std::string> known;
    std::map<std::string, size_t> said;
    const auto add_part = [&](const std::string& layer, const ClipScript& clip, bool from_begin) {
      if (clip.path.empty() || !known.insert(clip.path).second) return;
      if (!clip.speech) {
        serve_clip((folder / clip.path).string());
        return;
      }
      const size_t number = ++said[layer];
      speak(*clip.speech, folder, layer + (number > 1 ? "-" + std::to_string(number) : ""),
            from_begin && clip.start == 0 && clip.speed == 1);
    };
    for (const LayerScript& layer : script.layers) {
      if (layer.source == MIEN_LAYER_SOURCE_CLIP) add_part(layer.name, layer.clip, true);
    }
    for (const EventScript& event : script.events) {
      if (event.kind == EventKind::kPlay) {
        add_part(script.layers[event.target].name, event.clip, event.time == 0);
      }
    }
  }

  /// Only a clip: a scene from elsewhere may name any file of the user.
  void serve_clip(const std::string& path) {
    std::string bytes = read_any_bytes(path, kCannotView);
    auto error = sized<MienError>();
    MienClip* opened = nullptr;
    check(mien_clip_open_memory(bytes.data(), bytes.size(), nullptr, &opened, &error), &error,
          kCannotView, shown_name(path));
    const Clip clip(opened);
    serve(std::filesystem::path(path).filename().string(), std::move(bytes));
  }

  void speak(speech::SpeechSource source, const std::filesystem::path& folder,
             const std::string& name, bool is_heard) {
    for (std::string* path : {&source.audio, &source.phonemes}) {
      if (!path->empty()) *path = (folder / *path).string();
    }
    const speech::Speech heard = speech::read_speech(source, session_);
    const Clip clip = speech::make_clip(speech::make_take(heard, kSpeechRate, session_), name);
    auto error = sized<MienError>();
    size_t size = 0;
    check(mien_clip_write_memory(clip.get(), nullptr, 0, &size, &error), &error, kCannotView, name);
    std::string bytes(size, '\0');
    check(mien_clip_write_memory(clip.get(), bytes.data(), size, &size, &error), &error,
          kCannotView, name);
    serve(name + ".speech.clip", std::move(bytes));
    if (!is_heard || !heard.sound || !sound_.empty()) return;
    sound_name_ = name + ".wav";
    sound_ = speech::wav_bytes(*heard.sound);
  }

  view::Files& files_;
  const Session& session_;
  std::set<std::string> names_;
  std::string address_, sound_name_, sound_;
  bool has_sound_ = false;
};

}  // namespace

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

std::string serve_takes(const std::vector<std::string>& paths, view::Files& files,
                        const Session& session) {
  Takes takes(files, session);
  for (const std::string& path : paths) takes.add(path);
  takes.serve_sound();
  return takes.address();
}

}  // namespace mien::cli
