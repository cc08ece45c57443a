// SPDX-License-Identifier: MIT
#include "integrations/program/speech/recognizer.h"

#ifndef _WIN32
#include <dlfcn.h>
#endif

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <set>

#include "integrations/program/io/text.h"
#include "integrations/program/speech/sound_table.h"

namespace mien::speech {

namespace {

constexpr uint32_t kRate = 16000;      // of the model
constexpr int kFramesPerSecond = 100;  // of the decoder
constexpr size_t kMostText = 10000;
constexpr const char* kModel = "/usr/share/pocketsphinx/model/en-us/";

// What is used of the library's interface: pocketsphinx.h and cmd_ln.h of version 5prealpha.
struct Library {
  void* (*make_config)(void*, const void*, int, ...) = nullptr;
  const void* (*arguments)() = nullptr;
  int (*free_config)(void*) = nullptr;
  void (*log_to)(FILE*) = nullptr;
  void* (*create)(void*) = nullptr;
  int (*destroy)(void*) = nullptr;
  int (*add_word)(void*, const char*, const char*, int) = nullptr;
  char* (*look_up)(void*, const char*) = nullptr;
  int (*set_grammar)(void*, const char*, const char*) = nullptr;
  int (*select)(void*, const char*) = nullptr;
  int (*begin)(void*) = nullptr;
  int (*process)(void*, const int16_t*, size_t, int, int) = nullptr;
  int (*end)(void*) = nullptr;
  void* (*first)(void*) = nullptr;
  void* (*next)(void*) = nullptr;
  const char* (*word)(void*) = nullptr;
  void (*frames)(void*, int*, int*) = nullptr;
};

/// Null without the library. It stays loaded.
const Library* load() {
#ifdef _WIN32
  return nullptr;
#else
  static Library library;
  static const bool loaded = [] {
    void* base = dlopen("libsphinxbase.so.3", RTLD_NOW | RTLD_GLOBAL);
    void* decoder = dlopen("libpocketsphinx.so.3", RTLD_NOW | RTLD_LOCAL);
    if (!base || !decoder) return false;
    const auto find = [](void* handle, auto& function, const char* name) {
      void* address = dlsym(handle, name);
      std::memcpy(&function, &address, sizeof function);
      return address != nullptr;
    };
    return find(base, library.make_config, "cmd_ln_init") &&
           find(base, library.free_config, "cmd_ln_free_r") &&
           find(base, library.log_to, "err_set_logfp") &&
           find(decoder, library.arguments, "ps_args") &&
           find(decoder, library.create, "ps_init") && find(decoder, library.destroy, "ps_free") &&
           find(decoder, library.add_word, "ps_add_word") &&
           find(decoder, library.look_up, "ps_lookup_word") &&
           find(decoder, library.set_grammar, "ps_set_jsgf_string") &&
           find(decoder, library.select, "ps_set_search") &&
           find(decoder, library.begin, "ps_start_utt") &&
           find(decoder, library.process, "ps_process_raw") &&
           find(decoder, library.end, "ps_end_utt") &&
           find(decoder, library.first, "ps_seg_iter") &&
           find(decoder, library.next, "ps_seg_next") &&
           find(decoder, library.word, "ps_seg_word") &&
           find(decoder, library.frames, "ps_seg_frames");
  }();
  return loaded ? &library : nullptr;
#endif
}

class Decoder {
 public:
  /// With a dictionary, for a text; else with a model of which phonemes follow each other.
  Decoder(const Library& library, bool with_dictionary) : library_(library) {
    library.log_to(nullptr);
    const std::string model = kModel, acoustic = model + "en-us",
                      dictionary = model + "cmudict-en-us.dict",
                      phones = model + "en-us-phone.lm.bin";
    config_ = with_dictionary
                  ? library.make_config(nullptr, library.arguments(), 1, "-hmm", acoustic.c_str(),
                                        "-dict", dictionary.c_str(), "-beam", "1e-200", "-wbeam",
                                        "1e-200", "-pbeam", "1e-200", "-lw", "1", "-wip", "1",
                                        "-fsgusefiller", "no", "-bestpath", "no", "-remove_silence",
                                        "no", nullptr)
                  : library.make_config(nullptr, library.arguments(), 1, "-hmm", acoustic.c_str(),
                                        "-allphone", phones.c_str(), "-beam", "1e-20", "-pbeam",
                                        "1e-20", "-lw", "2.0", "-remove_silence", "no", nullptr);
    if (config_) decoder_ = library.create(config_);
  }
  ~Decoder() {
    if (decoder_) library_.destroy(decoder_);
    if (config_) library_.free_config(config_);
  }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  bool works() const { return decoder_ != nullptr; }

  /// Pronunciations of a word, each as phonemes; empty if the dictionary lacks it.
  std::vector<std::vector<std::string>> pronunciations(const std::string& word) const {
    std::vector<std::vector<std::string>> all;
    for (int i = 1; i < 10; ++i) {
      const std::string name = i == 1 ? word : word + "(" + std::to_string(i) + ")";
      char* phones = library_.look_up(decoder_, name.c_str());
      if (!phones) break;
      all.emplace_back();
      for (std::string rest = phones; !rest.empty();) {
        const size_t space = rest.find(' ');
        if (space != 0) all.back().push_back(rest.substr(0, space));
        rest = space == std::string::npos ? "" : rest.substr(space + 1);
      }
      std::free(phones);  // NOLINT: the library allocates it with malloc()
    }
    return all;
  }

  /// Each phoneme becomes a word, so that segments of words are segments of phonemes.
  bool expect(const std::vector<std::vector<std::vector<std::string>>>& words) const {
    std::set<std::string> phones = {"SIL"};
    std::string grammar = "#JSGF V1.0;\ngrammar text;\npublic <text> = [ phoneSIL ]";
    for (const auto& alternatives : words) {
      grammar += " (";
      for (size_t a = 0; a < alternatives.size(); ++a) {
        if (a > 0) grammar += " |";
        for (const std::string& phone : alternatives[a]) {
          grammar += " phone" + phone;
          phones.insert(phone);
        }
      }
      grammar += " ) [ phoneSIL ]";  // a pause
    }
    grammar += ";\n";
    for (const std::string& phone : phones) {
      if (library_.add_word(decoder_, ("phone" + phone).c_str(), phone.c_str(), 0) < 0)
        return false;
    }
    return library_.set_grammar(decoder_, "text", grammar.c_str()) == 0 &&
           library_.select(decoder_, "text") == 0;
  }

  Utterance decode(const Sound16& sound) const {
    Utterance utterance;
    utterance.seconds = sound.seconds();
    if (library_.begin(decoder_) < 0) return utterance;
    library_.process(decoder_, sound.samples.data(), sound.samples.size(), 0, 1);
    library_.end(decoder_);
    for (void* segment = library_.first(decoder_); segment; segment = library_.next(segment)) {
      int begin = 0, end = 0;
      library_.frames(segment, &begin, &end);
      std::string word = library_.word(segment);
      if (word.rfind("phone", 0) == 0) word = word.substr(5);
      const bool is_noise =
          word.empty() || word[0] == '<' || word[0] == '+' || word[0] == '[' || word[0] == '(';
      if (is_noise || is_pause(word) || end < begin) continue;
      utterance.phonemes.push_back({word, static_cast<double>(begin) / kFramesPerSecond,
                                    static_cast<double>(end + 1) / kFramesPerSecond,
                                    Stress::kUnknown, 0});
    }
    return utterance;
  }

 private:
  const Library& library_;
  void* config_ = nullptr;
  void* decoder_ = nullptr;
};

/// "Don't go!" -> "don't", "go"
std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words(1);
  for (const char c : text) {
    const auto letter = static_cast<unsigned char>(c);
    if (std::isalpha(letter) || c == '\'' || letter >= 128) {
      words.back() += static_cast<char>(std::tolower(letter));
    } else if (!words.back().empty()) {
      words.emplace_back();
    }
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

}  // namespace

std::optional<Utterance> recognize(const Sound16& sound, const std::string& text,
                                   std::string& why) {
  const Library* library = load();
  if (!library || !std::filesystem::exists(std::string(kModel) + "en-us/mdef")) {
    why = "pocketsphinx is missing (Debian: apt-get install pocketsphinx-en-us libpocketsphinx3)";
    return std::nullopt;
  }
  const Sound16 heard = resample(sound, kRate);
  if (!text.empty() && text.size() <= kMostText) {
    const Decoder decoder(*library, true);
    std::vector<std::vector<std::vector<std::string>>> words;
    std::string unknown;
    for (const std::string& word : words_of(text)) {
      words.push_back(decoder.works() ? decoder.pronunciations(word)
                                      : std::vector<std::vector<std::string>>());
      if (words.back().empty() && unknown.empty()) unknown = word;
    }
    if (unknown.empty() && !words.empty() && decoder.expect(words)) {
      Utterance found = decoder.decode(heard);
      found.source = "pocketsphinx, aligned with the text";
      if (!found.phonemes.empty()) return found;
      why = "the text does not fit the sound";
    } else {
      why = unknown.empty() ? "the text has no words"
                            : "the English dictionary has no \"" + cli::one_line(unknown) + "\"";
    }
  } else if (!text.empty()) {
    why = "the text is longer than 10,000 bytes";
  }
  const Decoder decoder(*library, false);
  if (!decoder.works()) {
    why = "the model of pocketsphinx cannot be loaded";
    return std::nullopt;
  }
  Utterance found = decoder.decode(heard);
  found.source = "pocketsphinx, phonemes of American English";
  if (!found.phonemes.empty()) return found;
  why = "pocketsphinx hears no speech";
  return std::nullopt;
}

}  // namespace mien::speech
