// SPDX-License-Identifier: MIT
#include "integrations/program/live/udp_socket.h"

#include "integrations/program/io/failure.h"

#if defined(_WIN32)

namespace mien::live {

UdpSocket::UdpSocket(const Address& address) {
  cli::fail(cli::kInvalid, "cannot listen", to_text(address),
            "this build of mien has no sockets for Windows", "use Linux, or play a clip");
}
UdpSocket::~UdpSocket() = default;
void UdpSocket::receive_until(Time, const std::function<void(const uint8_t*, size_t)>&) {}

}  // namespace mien::live

#else

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <vector>

namespace mien::live {

namespace {

constexpr size_t kLargestDatagram = 65536;
// What arrives while a frame is computed waits here: packets of landmarks are large. The system may give less.
constexpr int kWaitingBytes = 1 << 20;
// Between two looks at the clock, so that a flood cannot hold up the frames.
constexpr int kAtOnce = 64;

[[noreturn]] void fail_listen(const Address& address, const char* why) {
  cli::fail(cli::kFile, "cannot listen", to_text(address), why,
            "name an address of this machine and a port that is free");
}

}  // namespace

UdpSocket::UdpSocket(const Address& address) {
  addrinfo hints = {};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = AI_PASSIVE;
  addrinfo* list = nullptr;
  const int found = getaddrinfo(address.host.empty() ? nullptr : address.host.c_str(),
                                std::to_string(address.port).c_str(), &hints, &list);
  if (found != 0) fail_listen(address, gai_strerror(found));
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owner(list, freeaddrinfo);
  socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket_ >= 0) {
    setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &kWaitingBytes, sizeof(kWaitingBytes));
  }
  sockaddr_in bound = {};
  socklen_t size = sizeof(bound);
  if (socket_ < 0 || bind(socket_, list->ai_addr, list->ai_addrlen) != 0 ||
      getsockname(socket_, reinterpret_cast<sockaddr*>(&bound), &size) != 0) {
    const int reason = errno;
    if (socket_ >= 0) close(socket_);
    socket_ = -1;
    fail_listen(address, std::strerror(reason));
  }
  port_ = ntohs(bound.sin_port);
}

UdpSocket::~UdpSocket() {
  if (socket_ >= 0) close(socket_);
}

void UdpSocket::receive_until(Time end, const std::function<void(const uint8_t*, size_t)>& use) {
  std::vector<uint8_t> bytes(kLargestDatagram);
  while (true) {
    for (int i = 0; i < kAtOnce; ++i) {
      const ssize_t size = recv(socket_, bytes.data(), bytes.size(), 0);
      if (size < 0) break;
      use(bytes.data(), static_cast<size_t>(size));
    }
    const auto left = end - std::chrono::steady_clock::now();
    if (left <= std::chrono::nanoseconds(0)) return;
    const auto ns = std::chrono::duration_cast<std::chrono::nanoseconds>(left).count();
    const timespec time = {static_cast<time_t>(ns / 1000000000),
                           static_cast<long>(ns % 1000000000)};
    pollfd waiting = {socket_, POLLIN, 0};
    if (ppoll(&waiting, 1, &time, nullptr) < 0) return;
  }
}

}  // namespace mien::live

#endif
