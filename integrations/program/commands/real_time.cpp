// SPDX-License-Identifier: MIT
#include "integrations/program/commands/real_time.h"

#include <charconv>
#include <csignal>
#include <thread>

#include "integrations/program/io/controls.h"
#include "integrations/program/io/failure.h"
#include "integrations/program/io/rig_file.h"

namespace mien::cli {

namespace {

constexpr double kUsualDelay = 0.05;

volatile std::sig_atomic_t interrupted = 0;

extern "C" void note_interrupt(int) { interrupted = 1; }

double parse_delay(const std::string& word) {
  if (word.empty()) return kUsualDelay;
  double seconds = 0;
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, seconds);
  if (error == std::errc() && stop == end && seconds >= 0 && seconds <= 1) return seconds;
  fail_usage("--delay \"" + word + "\"", "not a number of seconds from 0 to 1", "write it as 0.05");
}

live::Address checked_address(const std::string& option, const std::string& text,
                              bool is_destination) {
  const live::Address address = live::parse_address(option, text, is_destination);
  if (address.protocol == live::Protocol::kVmc) live::require_vmc(option + " " + text);
  return address;
}

}  // namespace

bool solves_landmarks(const RealTimeOptions& options) {
  return !options.live.empty() &&
         live::has_landmarks(live::parse_address("--live", options.live, false).protocol);
}

std::unique_ptr<live::LiveInput> open_live(const RealTimeOptions& options, const LiveRig& rig,
                                           const NamesFile& names, const Session& session) {
  const auto delay =
      static_cast<int64_t>(parse_delay(options.delay) * static_cast<double>(MIEN_TICKS_PER_SECOND));
  const live::Address address = checked_address("--live", options.live, false);
  if (live::has_landmarks(address.protocol)) {
    return std::make_unique<live::LiveInput>(
        address, delay,
        open_landmark_solver(options.landmarks, address.protocol == live::Protocol::kLandmarks2,
                             rig.rig, rig.deformer, rig.shown, session),
        rig.rig, session);
  }
  return std::make_unique<live::LiveInput>(address, delay, options.device, rig.rig, names, session);
}

void RealTime::check(const RealTimeOptions& options) {
  if (!options.live.empty()) checked_address("--live", options.live, false);
  if (!options.send.empty()) checked_address("--send", options.send, true);
  parse_delay(options.delay);
  if (!options.delay.empty() && options.live.empty()) {
    fail_usage("--delay", "nothing comes in", "add --live livelink://:11111");
  }
  if (!options.device.empty() &&
      (options.live.empty() ||
       checked_address("--live", options.live, false).protocol != live::Protocol::kLiveLink)) {
    fail_usage("--device", "only packets of Live Link Face have names of devices",
               "add --live livelink://:11111");
  }
  if (solves_landmarks(options)) {
    const live::Address from = live::parse_address("--live", options.live, false);
    check_landmark_options(options.landmarks, from.protocol == live::Protocol::kLandmarks2);
  } else if (const char* option = options.landmarks.named()) {
    fail_usage(option, "no landmarks come in", "add --live landmarks3://:11112");
  }
}

RealTime::RealTime(const RealTimeOptions& options, const LiveRig& rig, const NamesFile& names,
                   const Session& session) {
  stream_.delay = parse_delay(options.delay);
  if (!options.send.empty()) {
    std::vector<std::string> sent;
    for (uint32_t i = 0; i < rig_count(rig.rig, MIEN_KIND_RAW_CONTROL); ++i) {
      sent.emplace_back(short_name(rig_name(rig.rig, MIEN_KIND_RAW_CONTROL, i)));
    }
    sender_ = std::make_unique<live::VmcSender>(checked_address("--send", options.send, true),
                                                std::move(sent));
  }
  if (!options.live.empty()) {
    input_ = open_live(options, rig, names, session);
    stream_.curves = input_->curves();
  }
  interrupted = 0;
  std::signal(SIGINT, note_interrupt);
  std::signal(SIGTERM, note_interrupt);
}

RealTime::~RealTime() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

bool RealTime::wait(int64_t tick, Performance& performance) {
  if (!started_) {
    started_ = true;
    start_ = std::chrono::steady_clock::now();
    if (input_) input_->start();
  }
  if (input_) {
    input_->receive_until(tick);
    int64_t time = 0;
    std::vector<float> row;
    while (input_->take(tick, time, row)) performance.push(time, row);
  } else {
    const std::chrono::duration<double> seconds(static_cast<double>(tick) /
                                                static_cast<double>(MIEN_TICKS_PER_SECOND));
    std::this_thread::sleep_until(
        start_ + std::chrono::duration_cast<std::chrono::steady_clock::duration>(seconds));
  }
  // There is a first frame always, so that outputs have one.
  return interrupted == 0 || tick == 0;
}

void RealTime::send(double time, const float* row) {
  if (sender_ && !sender_->send(time, row)) ++unsent_;
}

void RealTime::finish(const Session& session) {
  if (input_) note(session, input_->summary());
  if (unsent_ != 0) {
    note(session, std::to_string(unsent_) + " frames could not be sent: the address refuses them");
  }
}

}  // namespace mien::cli
