// SPDX-License-Identifier: MIT
// mien speak: text, sound or phonemes -> a take of the face, and the sound.
#include <algorithm>
#include <memory>
#include <optional>

#include "integrations/program/commands/baked_rig.h"
#include "integrations/program/commands/options.h"
#include "integrations/program/io/dna_fields.h"
#include "integrations/program/io/failure.h"
#include "integrations/program/io/frame_rate.h"
#include "integrations/program/io/matched_names.h"
#include "integrations/program/io/output.h"
#include "integrations/program/io/rig_file.h"
#include "integrations/program/io/text.h"
#include "integrations/program/speech/phoneme_file.h"
#include "integrations/program/speech/source.h"

namespace mien::cli {

namespace {

struct SpeakOptions {
  speech::SpeechSource source;
  std::string audio_text, wav, rig, names, rate, save_phonemes;
  OutputFile output;
};

void check_sources(const SpeakOptions& options) {
  const speech::SpeechSource& from = options.source;
  const int count =
      int{!from.text.empty()} + int{!from.audio.empty()} + int{!from.phonemes.empty()};
  if (count != 1) {
    fail_usage(count == 0 ? "TEXT" : "TEXT, --audio, --phonemes",
               count == 0 ? "there is nothing to say" : "more than one of them is given",
               "give a text, --audio FILE.wav or --phonemes FILE");
  }
  if (!options.audio_text.empty() && from.audio.empty()) {
    fail_usage("--text", "it is what is said in a sound",
               "add --audio FILE.wav, or give it as TEXT");
  }
  if (!options.wav.empty() && from.text.empty()) {
    fail_usage("--wav", "only a text is turned into sound", "give a TEXT, or leave it out");
  }
  if (!options.names.empty() && options.rig.empty()) {
    fail_usage("--names", "there is no rig", "add --rig RIG");
  }
}

double speak_rate(const std::string& word) {
  if (word.empty()) return 60;
  const Rate rate = parse_rate(word);
  if (rate.known() && rate.hertz() >= 1 && rate.hertz() <= 1000) return rate.hertz();
  fail_usage("--rate \"" + word + "\"", "not a number of frames per second from 1 to 1000",
             "give one such as 60, 29.97 or 30000/1001");
}

/// Binds a take to a rig; returns the rig's name.
std::string bind_to_rig(const SpeakOptions& options, speech::SpokenTake& take,
                        const Session& session) {
  const NamesFile names(options.names);
  if (is_baked_file(options.rig)) {
    const BakedFile baked = open_baked_rig(options.rig, LoadOptions{}, RigOptions{});
    speech::bind(take, baked.rig.get(), names, baked.shown, session);
    return baked.shown;
  }
  const RigFile dna =
      open_rig_file(options.rig, parse_load_options(LoadOptions{}, kEvaluationLayers), session);
  const Rig rig = create_rig(dna, parse_rig_options(RigOptions{}));
  speech::bind(take, rig.get(), names, dna.shown, session);
  return read_string(dna, "desc.name");
}

void run_speak(const SpeakOptions& options, const Session& session) {
  check_sources(options);
  const double rate = speak_rate(options.rate);
  const std::string& path = options.output.path;
  if (path != "-" && !ends_with(path, ".clip") && !ends_with(path, ".json")) {
    fail_usage("-o " + path, "the ending of the name selects the format", "use .clip or .json");
  }
  refuse_terminal(path, session, "a clip");
  std::vector<std::string> inputs = {options.source.audio, options.source.phonemes, options.rig,
                                     options.names};
  inputs.erase(std::remove(inputs.begin(), inputs.end(), std::string()), inputs.end());
  refuse_replacing(options.output, inputs);
  for (const std::string& more : {options.wav, options.save_phonemes}) {
    if (more.empty()) continue;
    if (more == path) fail_usage("-o " + path, "two outputs have this name", "give each its own");
    refuse_replacing({more, options.output.force}, inputs);
  }

  speech::SpeechSource source = options.source;
  if (!source.audio.empty()) source.text = options.audio_text;
  const speech::Speech heard = speech::read_speech(source, session);
  speech::SpokenTake take = speech::make_take(heard, rate, session);
  std::string rig_name;
  if (!options.rig.empty()) rig_name = bind_to_rig(options, take, session);

  Output output(path);
  if (ends_with(path, ".json")) {
    speech::write_frames(take, rig_name, output);
  } else {
    const Clip clip = speech::make_clip(take, heard.shown);
    auto error = sized<MienError>();
    size_t size = 0;
    check(mien_clip_write_memory(clip.get(), nullptr, 0, &size, &error), &error,
          "cannot write clip", path);
    std::vector<char> bytes(size);
    check(mien_clip_write_memory(clip.get(), bytes.data(), size, &size, &error), &error,
          "cannot write clip", path);
    output.write(bytes.data(), size);
  }
  std::optional<Output> wav, phonemes;
  if (!options.wav.empty()) wav.emplace(options.wav).write(speech::wav_bytes(*heard.sound));
  if (!options.save_phonemes.empty()) {
    speech::write_phoneme_json(heard.utterance, heard.alphabet,
                               phonemes.emplace(options.save_phonemes));
  }
  if (wav) wav->commit();
  if (phonemes) phonemes->commit();
  output.commit();
  note_written(session, path, output.size());
}

}  // namespace

Command add_speak_command(CLI::App& app, const Session& session) {
  auto options = std::make_shared<SpeakOptions>();
  CLI::App* speak = app.add_subcommand("speak", "Turn text, sound or phonemes into a talking face");
  speak->add_option("TEXT", options->source.text, "What is said; needs espeak-ng")->type_name("");
  speak
      ->add_option("--voice", options->source.voice,
                   "Voice of espeak-ng, by language: en-us, de, es, ...\n(default: en-us)")
      ->type_name("NAME");
  speak->add_option("--audio", options->source.audio, "A WAV file with speech in place of a text")
      ->type_name("FILE.wav");
  speak->add_option("--text", options->audio_text, "What is said in --audio")->type_name("TEXT");
  speak
      ->add_option("--phonemes", options->source.phonemes,
                   "Phonemes with times in place of a text: a TextGrid of a forced\naligner, or "
                   "JSON; - reads standard input")
      ->type_name("FILE");
  add_output_options(*speak, options->output,
                     "Take to write: .clip, or .json as 'mien play' writes it; - is a clip")
      ->required();
  speak->add_option("--wav", options->wav, "Also write the sound of TEXT")->type_name("OUT.wav");
  speak
      ->add_option("--save-phonemes", options->save_phonemes,
                   "Also write the phonemes as JSON, to be edited and read again")
      ->type_name("OUT.json");
  speak
      ->add_option("--rig", options->rig,
                   "Name the raw controls of this rig (default: names of ARKit,\nwhich most rigs "
                   "match when the clip is played)")
      ->type_name("RIG");
  speak
      ->add_option("--names", options->names,
                   "JSON with meanings of names on this rig, as for 'mien play'")
      ->type_name("FILE");
  speak->add_option("--rate", options->rate, "Frames per second (default: 60)")->type_name("R");
  speak->footer(
      "Phonemes become visemes, and these curves of controls with coarticulation: lips close at "
      "every m, b and p, and touch the teeth at f and v. Stress and loudness move jaw, brows and "
      "head, pauses bring blinks. Events name the phonemes, and the closures that guards keep "
      "under emotions. docs/speech.md says how.\n\n"
      "Phonemes may be in IPA, ARPABET or X-SAMPA. JSON: {\"phonemes\": [{\"label\": \"m\", "
      "\"begin\": 0.1, \"end\": 0.2}, ...]}\n\n"
      "Examples:\n"
      "  mien speak \"Hello, my friend.\" -o hello.clip --wav hello.wav\n"
      "  mien speak \"Guten Morgen.\" --voice de -o morgen.json --rig head.dna\n"
      "  mien speak --phonemes aligned.TextGrid -o take.clip\n"
      "  mien speak --audio voice.wav --text \"What she says.\" -o take.clip");
  return {speak, [options, &session] { run_speak(*options, session); }};
}

}  // namespace mien::cli
