// SPDX-License-Identifier: MIT
#include "integrations/program/live/live_input.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <thread>

#include "integrations/program/io/controls.h"
#include "integrations/program/io/failure.h"
#include "integrations/program/io/rig_file.h"
#include "integrations/program/io/text.h"
#include "integrations/program/live/live_link_face.h"

namespace mien::live {

namespace {

constexpr const char* kCannot = "cannot listen";
constexpr int64_t kSecond = MIEN_TICKS_PER_SECOND;
// Of VMC senders: names that mean something on the rig, and all that are remembered.
constexpr size_t kMostOtherNames = 128, kMostNewNames = 1024;
constexpr size_t kMostNotes = 8;

std::string lower_case(std::string_view name) {
  std::string lower(name);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower;
}

int64_t ticks_of(double seconds) { return std::llround(seconds * static_cast<double>(kSecond)); }

}  // namespace

LiveInput::LiveInput(const Address& address, int64_t delay, const std::string& device,
                     const MienRig* rig, const cli::NamesFile& names, const cli::Session& session)
    : rig_(rig), session_(session), address_(address), socket_(address), play_out_(delay, kSecond),
      wanted_(device) {
  channels_.assign(kLiveLinkNames, kLiveLinkNames + kLiveLinkValues);
  if (address.protocol == Protocol::kVmc) {
    // Senders name what they have; that may be the controls of the rig itself.
    for (const std::string& name : channels_) {
      numbers_.emplace(lower_case(name), static_cast<int>(numbers_.size()));
    }
    for (uint32_t i = 0; i < cli::rig_count(rig, MIEN_KIND_RAW_CONTROL); ++i) {
      const std::string name(cli::short_name(cli::rig_name(rig, MIEN_KIND_RAW_CONTROL, i)));
      if (!numbers_.emplace(lower_case(name), static_cast<int>(channels_.size())).second) continue;
      channels_.push_back(name);
    }
    add_given_names(names);
    vmc_ =
        std::make_unique<VmcDecoder>(channels_.size() + kMostOtherNames,
                                     [this](std::string_view name) { return find_channel(name); });
  }
  // For VMC the names of the file are not among the channels.
  bind(address.protocol == Protocol::kVmc ? cli::NamesFile() : names);
  address_.port = socket_.port();
  cli::note(session, "listening on " + to_text(address_));
  start();
}

LiveInput::LiveInput(const Address& address, int64_t delay, LandmarkSolver solver,
                     const MienRig* rig, const cli::Session& session)
    : rig_(rig), session_(session), address_(address), socket_(address), play_out_(delay, kSecond),
      curves_(solver.curves), raw_(cli::rig_count(rig, MIEN_KIND_RAW_CONTROL)),
      solver_(std::move(solver)), landmarks_(std::make_unique<LandmarkDecoder>(solver_.names)) {
  address_.port = socket_.port();
  cli::note(session, "listening on " + to_text(address_));
  start();
}

/// Instead of channels of these names.
void LiveInput::add_given_names(const cli::NamesFile& names) {
  cli::MatchedNames matched(rig_, names, kCannot);
  for (const auto& [name, match] : matched.given()) {
    if (others_.size() == kMostOtherNames) {
      cli::fail(cli::kInvalid, kCannot, names.shown(),
                "there are more than " + std::to_string(kMostOtherNames) + " names",
                "leave out those that are not sent");
    }
    numbers_[lower_case(name)] = static_cast<int>(channels_.size() + others_.size());
    others_.push_back({true, match.shares});
    matched.find(name);
  }
  matched.note_matched(to_text(address_), session_);
}

/// -1 for a name that means nothing on the rig.
int LiveInput::find_channel(std::string_view name) {
  const auto found = numbers_.find(lower_case(name));
  if (found != numbers_.end()) return found->second;
  if (numbers_.size() >= channels_.size() + kMostNewNames || others_.size() == kMostOtherNames) {
    return -1;
  }
  int number = -1;
  cli::MatchedNames matched(rig_, {}, kCannot);
  const cli::MatchedName match = matched.find(std::string(name));
  if (match.found()) {
    number = static_cast<int>(channels_.size() + others_.size());
    others_.push_back({match.how == MIEN_NAME_MATCH_EXPRESSION, match.shares});
    matched.note_matched(to_text(address_), session_);
  }
  numbers_.emplace(lower_case(name), number);
  return number;
}

/// By a clip of one frame with the names of the source.
void LiveInput::bind(const cli::NamesFile& names) {
  std::vector<MienStringView> views;
  for (const std::string& name : channels_) views.push_back({name.data(), name.size()});
  const std::vector<float> zeros(views.size());
  auto desc = cli::sized<MienClipDesc>();
  desc.rate_numerator = 60;
  desc.rate_denominator = 1;
  desc.frame_count = 1;
  desc.channel_count = static_cast<uint32_t>(views.size());
  desc.names = views.data();
  desc.values = zeros.data();
  desc.frame_stride = zeros.size();
  auto error = cli::sized<MienError>();
  MienClip* built = nullptr;
  cli::check(mien_clip_build(&desc, &built, &error), &error, kCannot, to_text(address_));
  const cli::Clip clip(built);

  binding_ = cli::bind_clip(built, rig_, names, kCannot, to_text(address_), session_);
  const MienClipBindingInfo info = cli::binding_info(binding_.get());
  curves_.assign(info.controls.data, info.controls.data + info.controls.count);
  raw_.resize(info.raw_control_count);
  if (curves_.empty()) {
    cli::fail(cli::kInvalid, kCannot, to_text(address_), "the rig has none of the controls",
              "see docs/face-capture.md for the names");
  }
  if (info.missing_channels.count != 0) {
    cli::note(session_, "the rig has no controls for " +
                            std::to_string(info.missing_channels.count) + " of " +
                            std::to_string(channels_.size()) + " channels, the first is " +
                            cli::one_line(channels_[info.missing_channels.data[0]]));
  }
}

void LiveInput::start() { start_ = std::chrono::steady_clock::now(); }

int64_t LiveInput::now() const {
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start_;
  return ticks_of(passed.count());
}

void LiveInput::receive_until(int64_t tick) {
  solving_ = 0;
  const std::chrono::duration<double> seconds(static_cast<double>(tick) /
                                              static_cast<double>(kSecond));
  const auto end =
      start_ + std::chrono::duration_cast<std::chrono::steady_clock::duration>(seconds);
  socket_.receive_until(end, [&](const uint8_t* bytes, size_t size) { use_datagram(bytes, size); });
}

void LiveInput::use_datagram(const uint8_t* bytes, size_t size) {
  ++packets_;
  if (landmarks_) {
    use_landmarks(bytes, size);
    return;
  }
  if (!vmc_) {
    use_live_link(bytes, size);
    return;
  }
  const bool good = vmc_->decode(bytes, size, [&](double sent, const std::vector<float>& values) {
    const int64_t arrived = now();
    double seconds = sent;
    if (seconds < 0) {
      const auto since = static_cast<double>(arrived - said_at_) / static_cast<double>(kSecond);
      seconds = said_ < 0 ? since : said_ + since;
    } else {
      said_ = sent;
      said_at_ = arrived;
    }
    use_row(seconds, values.data());
  });
  if (!good) ++damaged_;
}

void LiveInput::use_live_link(const uint8_t* bytes, size_t size) {
  LiveLinkPacket packet;
  if (decode_live_link(bytes, size, packet) != nullptr) {
    ++damaged_;
    return;
  }
  const int64_t arrived = now();
  if (!wanted_.empty() && packet.device != wanted_ && packet.subject != wanted_) {
    ++foreign_;
    return;
  }
  if (packet.device != device_ && !device_.empty() && arrived - device_seen_ < kSecond) {
    ++foreign_;
    return;
  }
  device_ = std::string(packet.device);
  device_seen_ = arrived;
  use_row(packet.seconds, packet.values);
}

/// Says a problem when it comes up first, so that a stream of wrong packets is no stream of lines.
void LiveInput::note_once(const std::string& what) {
  if (noted_.size() < kMostNotes && noted_.insert(what).second) {
    cli::note(session_, to_text(address_) + ": " + what);
  }
}

void LiveInput::use_landmarks(const uint8_t* bytes, size_t size) {
  LandmarkPacket packet;
  const std::string why = landmarks_->decode(bytes, size, packet);
  if (!why.empty()) {
    ++damaged_;
    note_once("a packet is left out: " + why);
    return;
  }
  if (packet.unknown != 0) {
    note_once("the rig has no places for " + std::to_string(packet.unknown) +
              " landmarks of a packet");
  }
  if (solving_ >= solver_.seconds) {
    ++unsolved_;
    return;
  }
  const int64_t arrived = now();
  const bool anew = solved_at_ < 0 || arrived - solved_at_ > kSecond;
  const std::clock_t cpu = std::clock();
  const auto begin = std::chrono::steady_clock::now();
  const LandmarkSolver::Outcome outcome =
      solver_.solve(packet, solver_.seconds - solving_, anew, raw_.data());
  solving_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (outcome == LandmarkSolver::Outcome::kNoFace) {
    ++faceless_;
    return;
  }
  if (outcome == LandmarkSolver::Outcome::kNeutral) {
    ++neutral_;
    solved_at_ = arrived;
    return;
  }
  const double used = static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
  cpu_sum_ += used;
  cpu_most_ = std::max(cpu_most_, used);
  ++solved_;
  if (outcome == LandmarkSolver::Outcome::kCutShort) ++cut_short_;
  solved_at_ = arrived;
  play(packet.seconds < 0 ? static_cast<double>(arrived) / static_cast<double>(kSecond)
                          : packet.seconds);
}

void LiveInput::use_row(double seconds, const float* values) {
  cli::check(
      mien_clip_binding_apply(binding_.get(), values, channels_.size(), raw_.data(), raw_.size()),
      nullptr, kCannot, to_text(address_));
  for (size_t i = 0; i < others_.size(); ++i) {
    const float value = values[channels_.size() + i];
    for (const MienControlShare& share : others_[i].shares) {
      float& control = raw_[share.control];
      const float part = share.weight * value;
      control = others_[i].adds_up ? control + part : std::max(control, part);
    }
  }
  play(seconds);
}

/// The row of `raw_`, at that time of the sender.
void LiveInput::play(double seconds) {
  std::vector<float> row;
  for (const uint16_t curve : curves_) {
    if (!std::isfinite(raw_[curve])) {
      ++damaged_;
      return;
    }
    row.push_back(raw_[curve]);
  }
  switch (play_out_.add(ticks_of(seconds), now(), row.data(), row.size())) {
    case PlayOut::Arrival::kKept: break;
    case PlayOut::Arrival::kTwice: ++twice_; break;
    case PlayOut::Arrival::kLate: ++late_; break;
    case PlayOut::Arrival::kStrange:
    case PlayOut::Arrival::kNoRoom: ++strange_; break;
  }
}

bool LiveInput::take(int64_t tick, int64_t& time, std::vector<float>& row) {
  return play_out_.take(tick, time, row);
}

std::string LiveInput::summary() const {
  std::string text = "received " + std::to_string(packets_) + " packets";
  const char* between = "; ";
  const auto add = [&](uint64_t count, const char* what) {
    if (count == 0) return;
    text += between + std::to_string(count) + " " + what;
    between = ", ";
  };
  add(damaged_, "damaged");
  add(late_, "too late");
  add(twice_, "repeated");
  add(foreign_, "of another device");
  add(strange_, "of another time");
  add(neutral_, "of the neutral face");
  add(faceless_, "without the face");
  add(unsolved_, "not solved for lack of time");
  add(cut_short_, "solved in part for lack of time");
  if (solved_ != 0) {
    char times[80];
    std::snprintf(times, sizeof(times), "; solving took %.2f ms of CPU time each, at most %.2f ms",
                  1e3 * cpu_sum_ / static_cast<double>(solved_), 1e3 * cpu_most_);
    text += times;
  }
  return text;
}

}  // namespace mien::live
