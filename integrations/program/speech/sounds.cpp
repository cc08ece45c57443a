// SPDX-License-Identifier: MIT
#include "integrations/program/speech/sounds.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <set>

#include "integrations/program/io/text.h"

namespace mien::speech {

namespace {

// Pauses, noise and breath as aligners spell them.
constexpr const char* kPauses[] = {
    "sil", "sp",    "spn",   "<sil>", "pau",   "<p:>",  "<p>",   "_",       "_:",    "#", "##",
    "h#",  "<nib>", "<usb>", "nsn",   "++n++", "+nsn+", "+spn+", "+noise+", "<eps>", "|", "{sl}"};

// Vowels of a diphthong, and the parts of an affricate, share its time so.
constexpr double kVowelShare = 1, kFirstVowelShare = 1.3, kConsonantShare = 0.7;

std::string in_small(const std::string& text) {
  std::string small = text;
  for (char& c : small) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return small;
}

const Sound* sound_of(char32_t letter) {
  const auto found = std::find_if(std::begin(kSounds), std::end(kSounds),
                                  [&](const Sound& sound) { return sound.letter == letter; });
  return found == std::end(kSounds) ? nullptr : found;
}

/// The code points of valid UTF-8; others are left out.
std::u32string decode(const std::string& text) {
  std::u32string letters;
  std::string_view rest = text;
  while (!rest.empty()) {
    const size_t length = utf8_length(rest);
    if (length == 0) {
      rest.remove_prefix(1);
      continue;
    }
    const auto first = static_cast<unsigned char>(rest[0]);
    char32_t letter = length == 1 ? first : first & (0x7Fu >> length);
    for (size_t i = 1; i < length; ++i) {
      letter = (letter << 6) | (static_cast<unsigned char>(rest[i]) & 0x3Fu);
    }
    letters.push_back(letter);
    rest.remove_prefix(length);
  }
  return letters;
}

/// "AH1" -> "ʌ", with its stress; empty if it is no ARPABET.
std::string from_arpabet(const std::string& label, Stress& stress) {
  std::string word = label;
  for (char& c : word) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  if (!word.empty() && word.back() >= '0' && word.back() <= '2') {
    stress = word.back() == '1'   ? Stress::kPrimary
             : word.back() == '2' ? Stress::kSecondary
                                  : Stress::kNone;
    word.pop_back();
  }
  for (const Spelling& spelling : kArpabetSpellings) {
    if (word == spelling.text) return spelling.ipa;
  }
  return {};
}

/// Replaces the longest spelling that fits, from left to right; what none fits stays.
template <size_t N>
std::string respell(const std::string& label, const Spelling (&spellings)[N]) {
  std::string ipa;
  for (size_t at = 0; at < label.size();) {
    const Spelling* best = nullptr;
    for (const Spelling& spelling : spellings) {
      const size_t length = std::strlen(spelling.text);
      if (label.compare(at, length, spelling.text) != 0) continue;
      if (!best || length > std::strlen(best->text)) best = &spelling;
    }
    ipa += best ? std::string(best->ipa) : label.substr(at, 1);
    at += best ? std::strlen(best->text) : 1;
  }
  return ipa;
}

}  // namespace

bool is_pause(const std::string& label) {
  const std::string small = in_small(label);
  if (small.find_first_not_of(" \t\r\n") == std::string::npos) return true;
  return std::find(std::begin(kPauses), std::end(kPauses), small) != std::end(kPauses);
}

bool is_modifier(const std::string& label) {
  const std::u32string letters = decode(label);
  return !letters.empty() && std::all_of(letters.begin(), letters.end(), [](char32_t letter) {
    const bool is_stress = letter == U'ˈ' || letter == U'ˌ';
    return letter >= 0x2B0 && letter <= 0x36F && !is_stress;
  });
}

Alphabet find_alphabet(const std::vector<Phoneme>& phonemes) {
  bool is_arpabet = true, is_ascii = true, has_capitals = false, has_sampa = false;
  for (const Phoneme& phoneme : phonemes) {
    Stress stress = Stress::kUnknown;
    is_arpabet = is_arpabet && !from_arpabet(phoneme.label, stress).empty();
    for (const char c : phoneme.label) {
      is_ascii = is_ascii && static_cast<unsigned char>(c) < 128;
      has_capitals = has_capitals || std::isupper(static_cast<unsigned char>(c));
      has_sampa = has_sampa || std::strchr("@{}&?\\1234567890\"%", c);
    }
  }
  if (phonemes.empty() || !is_ascii) return Alphabet::kIpa;
  // "B" and "K" are of both; no text has only such, and of small letters only they are the same in IPA.
  if (is_arpabet && has_capitals) return Alphabet::kArpabet;
  return has_capitals || has_sampa ? Alphabet::kSampa : Alphabet::kIpa;
}

Segments find_segments(Utterance& utterance, Alphabet alphabet) {
  Segments segments;
  std::set<std::string> unknown;
  for (uint32_t p = 0; p < utterance.phonemes.size(); ++p) {
    Phoneme& phoneme = utterance.phonemes[p];
    const std::string ipa = alphabet == Alphabet::kArpabet
                                ? from_arpabet(phoneme.label, phoneme.stress)
                            : alphabet == Alphabet::kSampa ? respell(phoneme.label, kSampaSpellings)
                                                           : respell(phoneme.label, kIpaSpellings);
    std::vector<const Sound*> sounds;
    for (const char32_t letter : decode(ipa)) {
      if (letter == U'ˈ') phoneme.stress = Stress::kPrimary;
      if (letter == U'ˌ') phoneme.stress = Stress::kSecondary;
      if (const Sound* sound = sound_of(letter)) sounds.push_back(sound);
    }
    if (sounds.empty()) {
      if (unknown.insert(phoneme.label).second) segments.unknown.push_back(phoneme.label);
      continue;
    }
    double shares = 0;
    const auto share = [&](size_t s) {
      if (!sounds[s]->is_vowel) return kConsonantShare;
      return s + 1 < sounds.size() && sounds[s + 1]->is_vowel ? kFirstVowelShare : kVowelShare;
    };
    for (size_t s = 0; s < sounds.size(); ++s) shares += share(s);
    double begin = phoneme.begin;
    for (size_t s = 0; s < sounds.size(); ++s) {
      const double end = s + 1 == sounds.size()
                             ? phoneme.end
                             : begin + (phoneme.end - phoneme.begin) * share(s) / shares;
      segments.list.push_back({sounds[s], begin, end, p});
      begin = end;
    }
  }
  return segments;
}

}  // namespace mien::speech
