// SPDX-License-Identifier: MIT
// Letters of the IPA, and what the mouth does for each of them. docs/speech.md, 2 "Visemes" and 3 "Coarticulation"
// have the sources and reasons.
#pragma once

#include <cstddef>

namespace mien::speech {

enum class Closure { kNone, kLips, kLipToTeeth, kTeeth };

/// How much a sound insists on its own values against those of its neighbors, per group of controls, 0 to 1.
struct Dominance {
  float jaw, lips, rounding, spreading, tongue;
};

struct Sound {
  char32_t letter;
  const char* viseme;  // of the table visemes22, which `mien export --bake` has
  float amount;        // of its values
  bool is_vowel;
  Closure closure;
  Dominance dominance;
};

// Kinds of sounds: sibilants need the jaw up, h and k take any height; rounded vowels begin to
// round the lips during the consonants before them, which leave rounding open.
constexpr Dominance kOpenVowel = {1, 1, 0.5f, 0.4f, 0.8f};
constexpr Dominance kSpreadVowel = {0.9f, 0.9f, 0.8f, 1, 0.8f};
constexpr Dominance kRoundVowel = {0.9f, 0.9f, 1, 0.9f, 0.8f};
constexpr Dominance kSchwa = {0.5f, 0.5f, 0.2f, 0.2f, 0.5f};
constexpr Dominance kBilabial = {0.7f, 0.6f, 0.06f, 0.2f, 0.2f};
constexpr Dominance kLabiodental = {0.9f, 0.8f, 0.15f, 0.3f, 0.3f};
constexpr Dominance kDental = {1, 0.6f, 0.1f, 0.15f, 1};
constexpr Dominance kAlveolar = {0.6f, 0.5f, 0.06f, 0.1f, 0.6f};
constexpr Dominance kSibilant = {1, 0.8f, 0.1f, 0.5f, 0.8f};
constexpr Dominance kPostalveolar = {1, 0.8f, 0.8f, 0.5f, 0.8f};
constexpr Dominance kLiquid = {0.5f, 0.5f, 0.1f, 0.15f, 0.5f};
constexpr Dominance kRhotic = {0.5f, 0.5f, 0.5f, 0.2f, 0.4f};
constexpr Dominance kGlide = {0.7f, 0.6f, 0.3f, 0.7f, 0.4f};
constexpr Dominance kRoundGlide = {0.8f, 0.8f, 1, 0.7f, 0.4f};
constexpr Dominance kVelar = {0.25f, 0.3f, 0.05f, 0.06f, 0.4f};
constexpr Dominance kGlottal = {0.1f, 0.1f, 0.03f, 0.03f, 0.1f};

// clang-format off
constexpr Sound kSounds[] = {
    // Vowels
    {U'i', "viseme_6_y", 1, true, Closure::kNone, kSpreadVowel},
    {U'ɪ', "viseme_6_y", 0.9f, true, Closure::kNone, kSpreadVowel},
    {U'ɨ', "viseme_6_y", 0.6f, true, Closure::kNone, kSchwa},
    {U'ᵻ', "viseme_6_y", 0.6f, true, Closure::kNone, kSchwa},
    {U'ɯ', "viseme_6_y", 0.5f, true, Closure::kNone, kSpreadVowel},
    {U'e', "viseme_4_ey", 0.9f, true, Closure::kNone, kSpreadVowel},
    {U'ɛ', "viseme_4_ey", 1, true, Closure::kNone, kSpreadVowel},
    {U'ɤ', "viseme_4_ey", 0.6f, true, Closure::kNone, kSchwa},
    {U'æ', "viseme_1_ae", 1, true, Closure::kNone, kOpenVowel},
    {U'ʌ', "viseme_1_ae", 0.85f, true, Closure::kNone, kOpenVowel},
    {U'ɐ', "viseme_1_ae", 0.8f, true, Closure::kNone, kOpenVowel},
    {U'ə', "viseme_1_ae", 0.5f, true, Closure::kNone, kSchwa},
    {U'ɘ', "viseme_1_ae", 0.5f, true, Closure::kNone, kSchwa},
    {U'ɜ', "viseme_5_er", 1, true, Closure::kNone, kOpenVowel},
    {U'ɝ', "viseme_5_er", 1, true, Closure::kNone, kRoundVowel},
    {U'ɚ', "viseme_5_er", 0.8f, true, Closure::kNone, kSchwa},
    {U'a', "viseme_2_aa", 0.9f, true, Closure::kNone, kOpenVowel},
    {U'ɑ', "viseme_2_aa", 1, true, Closure::kNone, kOpenVowel},
    {U'ɒ', "viseme_3_ao", 0.9f, true, Closure::kNone, kRoundVowel},
    {U'ɔ', "viseme_3_ao", 0.9f, true, Closure::kNone, kRoundVowel},
    {U'o', "viseme_8_ow", 1, true, Closure::kNone, kRoundVowel},
    {U'ɵ', "viseme_8_ow", 0.7f, true, Closure::kNone, kRoundVowel},
    {U'ø', "viseme_8_ow", 0.9f, true, Closure::kNone, kRoundVowel},
    {U'œ', "viseme_9_aw", 0.8f, true, Closure::kNone, kRoundVowel},
    {U'ɶ', "viseme_9_aw", 1, true, Closure::kNone, kRoundVowel},
    {U'u', "viseme_7_w", 0.9f, true, Closure::kNone, kRoundVowel},
    {U'ʊ', "viseme_7_w", 0.6f, true, Closure::kNone, kRoundVowel},
    {U'ʉ', "viseme_7_w", 0.8f, true, Closure::kNone, kRoundVowel},
    {U'y', "viseme_7_w", 0.9f, true, Closure::kNone, kRoundVowel},
    {U'ʏ', "viseme_7_w", 0.7f, true, Closure::kNone, kRoundVowel},
    // Lips and teeth
    {U'p', "viseme_21_p", 1, false, Closure::kLips, kBilabial},
    {U'b', "viseme_21_p", 1, false, Closure::kLips, kBilabial},
    {U'm', "viseme_21_p", 1, false, Closure::kLips, kBilabial},
    {U'ʙ', "viseme_21_p", 1, false, Closure::kLips, kBilabial},
    {U'β', "viseme_21_p", 0.4f, false, Closure::kNone, kBilabial},
    {U'ɸ', "viseme_21_p", 0.4f, false, Closure::kNone, kBilabial},
    {U'f', "viseme_18_f", 1, false, Closure::kLipToTeeth, kLabiodental},
    {U'v', "viseme_18_f", 1, false, Closure::kLipToTeeth, kLabiodental},
    {U'ɱ', "viseme_18_f", 1, false, Closure::kLipToTeeth, kLabiodental},
    {U'ʋ', "viseme_18_f", 0.6f, false, Closure::kNone, kLabiodental},
    {U'w', "viseme_7_w", 1, false, Closure::kNone, kRoundGlide},
    {U'ʍ', "viseme_7_w", 1, false, Closure::kNone, kRoundGlide},
    {U'ɥ', "viseme_7_w", 0.9f, false, Closure::kNone, kRoundGlide},
    // Tongue at the teeth and behind them
    {U'θ', "viseme_17_th", 0.9f, false, Closure::kNone, kDental},
    {U'ð', "viseme_17_th", 0.85f, false, Closure::kNone, kDental},
    {U't', "viseme_19_d", 1, false, Closure::kNone, kAlveolar},
    {U'd', "viseme_19_d", 1, false, Closure::kNone, kAlveolar},
    {U'n', "viseme_19_d", 1, false, Closure::kNone, kAlveolar},
    {U'ɾ', "viseme_19_d", 0.9f, false, Closure::kNone, kAlveolar},
    {U'r', "viseme_19_d", 1, false, Closure::kNone, kAlveolar},
    {U'ʈ', "viseme_19_d", 1, false, Closure::kNone, kAlveolar},
    {U'ɖ', "viseme_19_d", 1, false, Closure::kNone, kAlveolar},
    {U'ɳ', "viseme_19_d", 1, false, Closure::kNone, kAlveolar},
    {U'ɽ', "viseme_19_d", 1, false, Closure::kNone, kAlveolar},
    {U's', "viseme_15_s", 1, false, Closure::kTeeth, kSibilant},
    {U'z', "viseme_15_s", 1, false, Closure::kTeeth, kSibilant},
    {U'ʃ', "viseme_16_sh", 1, false, Closure::kNone, kPostalveolar},
    {U'ʒ', "viseme_16_sh", 1, false, Closure::kNone, kPostalveolar},
    {U'ʂ', "viseme_16_sh", 1, false, Closure::kNone, kPostalveolar},
    {U'ʐ', "viseme_16_sh", 1, false, Closure::kNone, kPostalveolar},
    {U'ɕ', "viseme_16_sh", 0.7f, false, Closure::kNone, kPostalveolar},
    {U'ʑ', "viseme_16_sh", 0.7f, false, Closure::kNone, kPostalveolar},
    {U'l', "viseme_14_l", 1, false, Closure::kNone, kLiquid},
    {U'ɫ', "viseme_14_l", 1, false, Closure::kNone, kLiquid},
    {U'ɭ', "viseme_14_l", 1, false, Closure::kNone, kLiquid},
    {U'ɬ', "viseme_14_l", 1, false, Closure::kNone, kLiquid},
    {U'ɮ', "viseme_14_l", 1, false, Closure::kNone, kLiquid},
    {U'ɹ', "viseme_13_r", 1, false, Closure::kNone, kRhotic},
    {U'ɻ', "viseme_13_r", 1, false, Closure::kNone, kRhotic},
    // Further back
    {U'j', "viseme_6_y", 1, false, Closure::kNone, kGlide},
    {U'ʎ', "viseme_6_y", 0.9f, false, Closure::kNone, kGlide},
    {U'ɲ', "viseme_6_y", 0.9f, false, Closure::kNone, kGlide},
    {U'ʝ', "viseme_6_y", 0.9f, false, Closure::kNone, kGlide},
    {U'ç', "viseme_6_y", 0.8f, false, Closure::kNone, kGlide},
    {U'c', "viseme_20_k", 1, false, Closure::kNone, kVelar},
    {U'ɟ', "viseme_20_k", 1, false, Closure::kNone, kVelar},
    {U'k', "viseme_20_k", 1, false, Closure::kNone, kVelar},
    {U'g', "viseme_20_k", 1, false, Closure::kNone, kVelar},
    {U'ɡ', "viseme_20_k", 1, false, Closure::kNone, kVelar},
    {U'ŋ', "viseme_20_k", 1, false, Closure::kNone, kVelar},
    {U'x', "viseme_20_k", 1, false, Closure::kNone, kVelar},
    {U'ɣ', "viseme_20_k", 1, false, Closure::kNone, kVelar},
    {U'ɰ', "viseme_20_k", 1, false, Closure::kNone, kVelar},
    {U'q', "viseme_20_k", 1, false, Closure::kNone, kVelar},
    {U'ɢ', "viseme_20_k", 1, false, Closure::kNone, kVelar},
    {U'ɴ', "viseme_20_k", 1, false, Closure::kNone, kVelar},
    {U'χ', "viseme_20_k", 1, false, Closure::kNone, kVelar},
    {U'ʁ', "viseme_20_k", 1, false, Closure::kNone, kVelar},
    {U'ʀ', "viseme_20_k", 1, false, Closure::kNone, kVelar},
    {U'ħ', "viseme_12_h", 1, false, Closure::kNone, kGlottal},
    {U'ʕ', "viseme_12_h", 1, false, Closure::kNone, kGlottal},
    {U'h', "viseme_12_h", 1, false, Closure::kNone, kGlottal},
    {U'ɦ', "viseme_12_h", 1, false, Closure::kNone, kGlottal},
    {U'ʔ', "viseme_12_h", 0.6f, false, Closure::kNone, kGlottal},
};

/// Spelling in ASCII -> IPA. The longest that fits counts.
struct Spelling {
  const char *text, *ipa;
};

// ARPABET, as dictionaries of English have it; digits behind vowels are stress.
constexpr Spelling kArpabetSpellings[] = {
    {"AA", "ɑ"}, {"AE", "æ"}, {"AH", "ʌ"}, {"AO", "ɔ"}, {"AW", "aʊ"}, {"AX", "ə"}, {"AXR", "ɚ"}, {"AY", "aɪ"},
    {"B", "b"}, {"CH", "tʃ"}, {"D", "d"}, {"DH", "ð"}, {"DX", "ɾ"}, {"EH", "ɛ"}, {"EL", "əl"}, {"EM", "əm"},
    {"EN", "ən"}, {"ER", "ɝ"}, {"EY", "eɪ"}, {"F", "f"}, {"G", "ɡ"}, {"HH", "h"}, {"HV", "h"}, {"IH", "ɪ"},
    {"IX", "ɨ"}, {"IY", "i"}, {"JH", "dʒ"}, {"K", "k"}, {"L", "l"}, {"M", "m"}, {"N", "n"}, {"NG", "ŋ"},
    {"OW", "oʊ"}, {"OY", "ɔɪ"}, {"P", "p"}, {"Q", "ʔ"}, {"R", "ɹ"}, {"S", "s"}, {"SH", "ʃ"}, {"T", "t"},
    {"TH", "θ"}, {"UH", "ʊ"}, {"UW", "u"}, {"UX", "ʉ"}, {"V", "v"}, {"W", "w"}, {"WH", "ʍ"}, {"Y", "j"},
    {"Z", "z"}, {"ZH", "ʒ"}};

// Letters with marks as one character, as dictionaries and voices have them; ligatures; Greek letters in place of
// the IPA's. Marks of their own need no spelling: the mouth does not show them.
constexpr Spelling kIpaSpellings[] = {
    {"ä", "a"}, {"ã", "a"}, {"á", "a"}, {"à", "a"}, {"â", "a"}, {"ā", "a"}, {"ă", "a"}, {"å", "a"},
    {"ë", "e"}, {"ẽ", "e"}, {"é", "e"}, {"è", "e"}, {"ê", "e"}, {"ē", "e"}, {"ĕ", "e"}, {"ï", "i"},
    {"ĩ", "i"}, {"í", "i"}, {"ì", "i"}, {"î", "i"}, {"ī", "i"}, {"ĭ", "i"}, {"ö", "o"}, {"õ", "o"},
    {"ó", "o"}, {"ò", "o"}, {"ô", "o"}, {"ō", "o"}, {"ŏ", "o"}, {"ü", "u"}, {"ũ", "u"}, {"ú", "u"},
    {"ù", "u"}, {"û", "u"}, {"ū", "u"}, {"ŭ", "u"}, {"ÿ", "y"}, {"ý", "y"}, {"ỹ", "y"}, {"ñ", "ɲ"},
    {"ʦ", "ts"}, {"ʣ", "dz"}, {"ʧ", "tʃ"}, {"ʤ", "dʒ"}, {"ʨ", "tɕ"}, {"ʥ", "dʑ"}, {"ε", "ɛ"}, {"α", "ɑ"},
    {"φ", "ɸ"}, {"Φ", "ɸ"}, {"ϕ", "ɸ"}, {"ß", "β"}};

// X-SAMPA (and SAMPA), which aligners of other languages write; small letters that it shares with the IPA stay.
constexpr Spelling kSampaSpellings[] = {
    {"r\\`", "ɻ"}, {"r\\", "ɹ"}, {"h\\", "ɦ"}, {"j\\", "ʝ"}, {"p\\", "ɸ"}, {"s\\", "ɕ"}, {"z\\", "ʑ"}, {"v\\", "ʋ"},
    {"R\\", "ʀ"}, {"G\\", "ɢ"}, {"N\\", "ɴ"}, {"X\\", "ħ"}, {"M\\", "ɰ"}, {"I\\", "ᵻ"}, {"@\\", "ɘ"}, {"3\\", "ɝ"},
    {"t`", "ʈ"}, {"d`", "ɖ"}, {"n`", "ɳ"}, {"l`", "ɭ"}, {"s`", "ʂ"}, {"z`", "ʐ"}, {"r`", "ɽ"}, {"@`", "ɚ"},
    {"3`", "ɝ"}, {"A", "ɑ"}, {"B", "β"}, {"C", "ç"}, {"D", "ð"}, {"E", "ɛ"}, {"F", "ɱ"}, {"G", "ɣ"}, {"H", "ɥ"},
    {"I", "ɪ"}, {"J", "ɲ"}, {"K", "ɬ"}, {"L", "ʎ"}, {"M", "ɯ"}, {"N", "ŋ"}, {"O", "ɔ"}, {"P", "ʋ"}, {"Q", "ɒ"},
    {"R", "ʁ"}, {"S", "ʃ"}, {"T", "θ"}, {"U", "ʊ"}, {"V", "ʌ"}, {"W", "ʍ"}, {"X", "χ"}, {"Y", "ʏ"}, {"Z", "ʒ"},
    {"1", "ɨ"}, {"2", "ø"}, {"3", "ɜ"}, {"4", "ɾ"}, {"5", "ɫ"}, {"6", "ɐ"}, {"7", "ɤ"}, {"8", "ɵ"}, {"9", "œ"},
    {"@", "ə"}, {"{", "æ"}, {"}", "ʉ"}, {"&", "ɶ"}, {"?", "ʔ"}, {"\"", "ˈ"}, {"%", "ˌ"}};
// clang-format on

}  // namespace mien::speech
