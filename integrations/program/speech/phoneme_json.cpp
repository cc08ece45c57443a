// SPDX-License-Identifier: MIT
#include <cmath>
#include <nlohmann/json.hpp>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/json_check.h"
#include "integrations/program/io/json_writer.h"
#include "integrations/program/speech/phoneme_file.h"

namespace mien::speech {

namespace {

using Json = nlohmann::basic_json<cli::MemberList>;

constexpr const char* kCannot = "cannot read phonemes";
constexpr const char* kForm =
    R"(write {"phonemes": [{"label": "m", "begin": 0.1, "end": 0.2}, ...]})";
constexpr const char* kAlphabets[] = {"ipa", "arpabet", "x-sampa"};
constexpr const char* kStresses[] = {"none", "secondary", "primary"};

[[noreturn]] void wrong(const std::string& where, const std::string& why) {
  cli::fail(cli::kInvalid, kCannot, where, why, kForm);
}

double seconds_of(const Json& value, const std::string& where) {
  if (!value.is_number()) wrong(where, "it is no number of seconds");
  const auto seconds = value.get<double>();
  if (!(seconds >= 0 && seconds <= kLongestSeconds)) wrong(where, "it is not within 24 hours");
  return seconds;
}

std::string text_of(const Json& value, const std::string& where) {
  if (!value.is_string()) wrong(where, "it is no text");
  return value.get<std::string>();
}

const Json& member(const Json& object, const char* key, const std::string& where) {
  if (!object.is_object()) wrong(where, "it is no object");
  const auto found = object.find(key);
  if (found == object.end()) wrong(where, std::string("there is no \"") + key + "\"");
  return *found;
}

/// The index of a word in a list.
template <size_t kCount>
size_t word_of(const Json& value, const char* const (&words)[kCount], const std::string& where) {
  const std::string text = text_of(value, where);
  for (size_t i = 0; i < kCount; ++i) {
    if (text == words[i]) return i;
  }
  std::string list;
  for (const char* word : words) list += std::string(list.empty() ? "" : ", ") + word;
  wrong(where, "it is none of " + list);
}

void read_own(const Json& list, const std::string& shown, PhonemeFile& file) {
  if (!list.is_array()) wrong(shown + ", phonemes", "it is no list");
  for (size_t i = 0; i < list.size(); ++i) {
    const std::string where = shown + ", phonemes[" + std::to_string(i) + "]";
    Phoneme phoneme;
    phoneme.label = text_of(member(list[i], "label", where), where + ".label");
    phoneme.begin = seconds_of(member(list[i], "begin", where), where + ".begin");
    phoneme.end = seconds_of(member(list[i], "end", where), where + ".end");
    if (const auto stress = list[i].find("stress"); stress != list[i].end()) {
      phoneme.stress = static_cast<Stress>(1 + word_of(*stress, kStresses, where + ".stress"));
    }
    if (const auto loud = list[i].find("loudness"); loud != list[i].end()) {
      const double decibels = loud->is_number() ? loud->get<double>() : 1000;
      if (!(std::abs(decibels) <= 200)) wrong(where + ".loudness", "it is no number of decibels");
      phoneme.loudness = static_cast<float>(decibels);
    }
    add_interval(file.utterance, std::move(phoneme), where);
  }
}

/// The JSON of the Montreal Forced Aligner.
void read_tiers(const Json& tiers, const std::string& shown, PhonemeFile& file) {
  const std::string place = shown + ", tiers.phones";
  const Json& list = member(member(tiers, "phones", shown + ", tiers"), "entries", place);
  if (!list.is_array()) wrong(place + ".entries", "it is no list");
  for (size_t i = 0; i < list.size(); ++i) {
    const std::string where = place + ".entries[" + std::to_string(i) + "]";
    if (!list[i].is_array() || list[i].size() < 3) wrong(where, "it is not [BEGIN, END, LABEL]");
    Phoneme phoneme;
    phoneme.begin = seconds_of(list[i][0], where);
    phoneme.end = seconds_of(list[i][1], where);
    phoneme.label = text_of(list[i][2], where);
    add_interval(file.utterance, std::move(phoneme), where);
  }
}

}  // namespace

PhonemeFile parse_phoneme_json(const std::string& text, const std::string& shown) {
  const Json document = cli::parse_json<Json>(text, kCannot, shown, kForm);
  if (!document.is_object()) wrong(shown, "it is no object");
  PhonemeFile file;
  if (const auto tiers = document.find("tiers"); tiers != document.end()) {
    if (const auto end = document.find("end"); end != document.end()) {
      file.utterance.seconds = seconds_of(*end, shown + ", end");
    }
    read_tiers(*tiers, shown, file);
  } else {
    if (const auto seconds = document.find("seconds"); seconds != document.end()) {
      file.utterance.seconds = seconds_of(*seconds, shown + ", seconds");
    }
    read_own(member(document, "phonemes", shown), shown, file);
  }
  file.alphabet = find_alphabet(file.utterance.phonemes);
  if (const auto alphabet = document.find("alphabet"); alphabet != document.end()) {
    file.alphabet = static_cast<Alphabet>(word_of(*alphabet, kAlphabets, shown + ", alphabet"));
  }
  return file;
}

void write_phoneme_json(const Utterance& utterance, Alphabet alphabet, cli::Output& output) {
  cli::JsonWriter json(output);
  using Layout = cli::JsonWriter::Layout;
  json.begin_object(Layout::kLines);
  json.member("alphabet", kAlphabets[static_cast<size_t>(alphabet)]);
  json.member("source", utterance.source);
  json.key("seconds");
  json.shortest(utterance.seconds);
  json.key("phonemes");
  json.begin_array(Layout::kLines);
  for (const Phoneme& phoneme : utterance.phonemes) {
    json.begin_object();
    json.member("label", phoneme.label);
    json.key("begin");
    json.shortest(phoneme.begin);
    json.key("end");
    json.shortest(phoneme.end);
    if (phoneme.stress != Stress::kUnknown) {
      json.member("stress", kStresses[static_cast<size_t>(phoneme.stress) - 1]);
    }
    if (phoneme.loudness != 0) {
      json.key("loudness");
      json.shortest(std::round(static_cast<double>(phoneme.loudness) * 1000) / 1000);
    }
    json.end_object();
  }
  json.end_array();
  json.end_object();
  json.finish();
}

}  // namespace mien::speech
