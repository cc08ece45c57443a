// SPDX-License-Identifier: MIT
#include "integrations/program/view/server_module.h"

#include <sys/socket.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "integrations/program/view/deadline_server.h"

namespace mien::view {

namespace {

constexpr const char* kHost = "127.0.0.1";
// For a request and its answer as a whole. Clients on this machine take far less; only as many slow ones as there
// are threads can make others wait, and for no longer than that.
constexpr std::chrono::seconds kDeadline(20);
constexpr size_t kThreads = 32;
// An answer with live rows ends before the deadline; the page asks again at once.
constexpr std::chrono::seconds kLiveAnswer(10);

/// What ends the program. Blocked, so that threads inherit it and one place waits for them.
sigset_t ending_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&set, number);
  return set;
}

bool is_own_host(const std::string& host, int port) {
  const std::string suffix = ":" + std::to_string(port);
  return host == kHost + suffix || host == "localhost" + suffix;
}

void refuse(httplib::Response& response, int status, const char* why) {
  response.status = status;
  response.set_content(why, "text/plain");
}

void answer_live(LiveRows& live, httplib::Response& response) {
  response.status = 200;
  const auto end = std::chrono::steady_clock::now() + kLiveAnswer;
  live.begin_answer();
  response.set_chunked_content_provider(
      "application/x-ndjson",
      [&live, end, seen = uint64_t{0}](size_t offset, httplib::DataSink& sink) mutable {
        std::string line = live.heading();
        if (offset != 0 && live.wait_until(end, seen, line) != LiveRows::Wait::kRow) {
          sink.done();
          return true;
        }
        return sink.write(line.data(), line.size());
      },
      [&live](bool) { live.end_answer(); });
}

void answer(const Files& files, LiveRows* live, int port, const httplib::Request& request,
            httplib::Response& response) {
  if (!is_own_host(request.get_header_value("Host"), port)) {
    return refuse(response, 403, "this is another host\n");
  }
  if (request.method != "GET") {
    response.set_header("Allow", "GET");
    return refuse(response, 405, "GET only\n");
  }
  if (live && request.path == "/live") return answer_live(*live, response);
  const auto found = files.find(request.path == "/" ? "/index.html" : request.path);
  if (found == files.end()) return refuse(response, 404, "there is no such file\n");
  const std::string& bytes = found->second.bytes;
  // Whole files only, which the protocol allows: httplib passes on ranges beyond the end of the file, and
  // writes several with wrong totals. The request is a variable of its own.
  const_cast<httplib::Request&>(request).ranges.clear();
  response.status = 200;
  response.set_content_provider(bytes.size(), found->second.type.c_str(),
                                [&bytes](size_t offset, size_t size, httplib::DataSink& sink) {
                                  return sink.write(bytes.data() + offset,
                                                    std::min(size, size_t{1} << 20));
                                });
}

/// Threads of this process go on when a browser goes away.
void ignore_broken_pipes() { std::signal(SIGPIPE, SIG_IGN); }

}  // namespace

bool mien_serve_page(const Files& files, LiveRows* live, uint16_t wanted_port,
                     const std::function<void(uint16_t)>& started) {
  DeadlineServer server(kDeadline);
  server.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  server.set_payload_max_length(4096);
  // Not SO_REUSEPORT, its default: two servers would share a port.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  });
  // The page may use shared memory, and no other page may use the files.
  server.set_default_headers({{"Cache-Control", "no-store"},
                              {"Cross-Origin-Embedder-Policy", "require-corp"},
                              {"Cross-Origin-Opener-Policy", "same-origin"},
                              {"Cross-Origin-Resource-Policy", "same-origin"},
                              {"Referrer-Policy", "no-referrer"},
                              {"X-Content-Type-Options", "nosniff"}});
  int port = wanted_port;
  if (wanted_port == 0) {
    port = server.bind_to_any_port(kHost);
  } else if (!server.bind_to_port(kHost, wanted_port)) {
    port = -1;
  }
  if (port <= 0) return false;
  server.set_pre_routing_handler(
      [&files, live, port](const httplib::Request& request, httplib::Response& response) {
        answer(files, live, port, request, response);
        return httplib::Server::HandlerResponse::Handled;
      });

  const sigset_t ending = ending_signals();
  pthread_sigmask(SIG_BLOCK, &ending, nullptr);
  ignore_broken_pipes();
  std::thread listener([&server] { server.listen_after_bind(); });
  // stop() does nothing before it runs.
  while (!server.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  started(static_cast<uint16_t>(port));
  int number = 0;
  sigwait(&ending, &number);
  if (live) live->end();
  server.stop();
  listener.join();
  return true;
}

}  // namespace mien::view
