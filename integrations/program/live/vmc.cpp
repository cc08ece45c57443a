// SPDX-License-Identifier: MIT
#include "integrations/program/live/vmc.h"

#include <lo/lo.h>

#include <cmath>
#include <cstring>

#include "integrations/program/io/failure.h"

namespace mien::live {

namespace {

constexpr const char* kTime = "/VMC/Ext/T";
constexpr const char* kValue = "/VMC/Ext/Blend/Val";
constexpr const char* kApply = "/VMC/Ext/Blend/Apply";
constexpr uint8_t kBundle[8] = {'#', 'b', 'u', 'n', 'd', 'l', 'e', 0};
constexpr size_t kBundleHead = 16;     // its tag and a time
constexpr size_t kLargestSent = 1400;  // an Ethernet frame less the headers of IP and UDP, and some
constexpr double kMaxSeconds = 1e9;

struct FreeMessage {
  void operator()(void* message) const { lo_message_free(static_cast<lo_message>(message)); }
};
using Message = std::unique_ptr<void, FreeMessage>;

void free_address(void* address) {
  if (address) lo_address_free(static_cast<lo_address>(address));
}

}  // namespace

void require_vmc(const std::string&) {}

VmcDecoder::VmcDecoder(size_t count, Find find) : find_(std::move(find)), values_(count) {}

bool VmcDecoder::decode(const uint8_t* bytes, size_t size, const Use& use) {
  if (size < kBundleHead || memcmp(bytes, kBundle, sizeof(kBundle)) != 0) {
    return decode_message(bytes, size, use);
  }
  bool good = true;
  for (size_t at = kBundleHead; at < size;) {
    if (size - at < 4) return false;
    const uint32_t length = uint32_t{bytes[at]} << 24 | uint32_t{bytes[at + 1]} << 16 |
                            uint32_t{bytes[at + 2]} << 8 | uint32_t{bytes[at + 3]};
    at += 4;
    if (length == 0 || length % 4 != 0 || length > size - at) return false;
    // Bundles in bundles are not used by this protocol: decode_message() refuses them.
    good = decode_message(bytes + at, length, use) && good;
    at += length;
  }
  return good;
}

bool VmcDecoder::decode_message(const uint8_t* bytes, size_t size, const Use& use) {
  if (size == 0 || size % 4 != 0 || bytes[0] != '/') return false;
  // liblo changes the bytes that it reads.
  std::vector<uint8_t> copy(bytes, bytes + size);
  int problem = 0;
  const Message message(lo_message_deserialise(copy.data(), copy.size(), &problem));
  const char* path = reinterpret_cast<const char*>(bytes);
  if (!message || memchr(bytes, 0, size) == nullptr) return false;
  // Arguments stand at multiples of four, which is less than their type in liblo is aligned to.
  const auto number = [](const lo_arg* argument) {
    float value;
    memcpy(&value, argument, sizeof(value));
    return value;
  };
  const auto made = static_cast<lo_message>(message.get());
  const std::string_view types = lo_message_get_types(made);
  lo_arg** arguments = lo_message_get_argv(made);
  if (strcmp(path, kTime) == 0) {
    if (types != "f") return false;
    const double seconds = number(arguments[0]);
    if (!(seconds >= 0) || !(seconds < kMaxSeconds)) return false;
    seconds_ = seconds;
  } else if (strcmp(path, kValue) == 0) {
    if (types != "sf" || !std::isfinite(number(arguments[1]))) return false;
    const int index = find_(reinterpret_cast<const char*>(arguments[0]));
    if (index >= 0) values_[static_cast<size_t>(index)] = number(arguments[1]);
  } else if (strcmp(path, kApply) == 0) {
    use(seconds_, values_);
    seconds_ = -1;
  }
  return true;
}

VmcSender::VmcSender(const Address& to, std::vector<std::string> names)
    : names_(std::move(names)),
      address_(lo_address_new(to.host.c_str(), std::to_string(to.port).c_str()), free_address) {
  if (address_) return;
  cli::fail(cli::kFile, "cannot send", to_text(to), "there is no such address",
            "name a machine and a port, as vmc://127.0.0.1:39539");
}

bool VmcSender::send(double seconds, const float* values) {
  const auto to = static_cast<lo_address>(address_.get());
  bool good = true;
  lo_bundle bundle = nullptr;
  const auto flush = [&] {
    if (!bundle) return;
    good = lo_send_bundle(to, bundle) >= 0 && good;
    lo_bundle_free_recursive(bundle);
    bundle = nullptr;
  };
  const auto add = [&](const char* path, lo_message message) {
    const size_t size = 4 + lo_message_length(message, path);
    if (bundle && lo_bundle_length(bundle) + size > kLargestSent) flush();
    if (!bundle) bundle = lo_bundle_new(lo_timetag{0, 1});
    lo_bundle_add_message(bundle, path, message);
  };
  for (size_t i = 0; i < names_.size(); ++i) {
    lo_message message = lo_message_new();
    lo_message_add_string(message, names_[i].c_str());
    lo_message_add_float(message, values[i]);
    add(kValue, message);
  }
  lo_message time = lo_message_new();
  lo_message_add_float(time, static_cast<float>(seconds));
  add(kTime, time);
  add(kApply, lo_message_new());
  flush();
  return good;
}

}  // namespace mien::live
