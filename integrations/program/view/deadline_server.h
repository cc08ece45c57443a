// SPDX-License-Identifier: MIT
// A server whose connections have a deadline as a whole: however slowly a client sends or reads, its thread
// is free again after that. httplib's own timeouts begin anew with each byte.
#pragma once

#include <httplib.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>

namespace mien::view {

/// A connection that fails once its deadline is over.
class DeadlineStream : public httplib::Stream {
 public:
  using Clock = std::chrono::steady_clock;

  DeadlineStream(socket_t socket, Clock::time_point deadline)
      : socket_(socket), deadline_(deadline) {}

  bool is_readable() const override { return wait(POLLIN); }
  bool is_writable() const override { return wait(POLLOUT); }
  ssize_t read(char* bytes, size_t size) override {
    return wait(POLLIN) ? ::recv(socket_, bytes, size, 0) : -1;
  }
  ssize_t write(const char* bytes, size_t size) override {
    return wait(POLLOUT) ? ::send(socket_, bytes, size, MSG_NOSIGNAL | MSG_DONTWAIT) : -1;
  }
  void get_remote_ip_and_port(std::string& ip, int& port) const override {
    ip.clear();
    port = 0;
  }
  void get_local_ip_and_port(std::string& ip, int& port) const override {
    get_remote_ip_and_port(ip, port);
  }
  socket_t socket() const override { return socket_; }

 private:
  bool wait(short events) const {
    using std::chrono::milliseconds;
    const auto left = std::chrono::duration_cast<milliseconds>(deadline_ - Clock::now()).count();
    pollfd one = {socket_, events, 0};
    return left > 0 && ::poll(&one, 1, static_cast<int>(left)) > 0;
  }

  socket_t socket_;
  Clock::time_point deadline_;
};

/// One request per connection.
class DeadlineServer : public httplib::Server {
 public:
  explicit DeadlineServer(std::chrono::milliseconds time) : time_(time) {}

 private:
  bool process_and_close_socket(socket_t socket) override {
    DeadlineStream stream(socket, DeadlineStream::Clock::now() + time_);
    bool is_closed = false;
    const bool answered = process_request(stream, true, is_closed, nullptr);
    ::shutdown(socket, SHUT_RDWR);
    ::close(socket);
    return answered;
  }

  std::chrono::milliseconds time_;
};

}  // namespace mien::view
