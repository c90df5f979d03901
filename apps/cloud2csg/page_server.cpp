#include "page_server.hpp"

#include <fmt/format.h>
#include <httplib.h>

#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <thread>

#include "cloud2csg/error.hpp"
#include "core/base/run_program.hpp"

namespace cloud2csg::app {
namespace {

constexpr const char* k_loopback = "127.0.0.1";
constexpr std::chrono::seconds k_read_timeout{1};
constexpr int k_not_found = 404;
constexpr int k_wrong_method = 405;
constexpr int k_forbidden = 403;

bool is_own_host(const std::string& host, int port) {
  constexpr int k_not_named = 80;  // browsers leave it out
  if (port == k_not_named && (host == k_loopback || host == "localhost")) return true;
  const std::string with_port = fmt::format(":{}", port);
  return host == k_loopback + with_port || host == "localhost" + with_port;
}

/// Refuses all requests except for the page itself.
httplib::Server::HandlerResponse refuse_others(const httplib::Request& request, httplib::Response& response, int port) {
  int status = 0;
  if (!is_own_host(request.get_header_value("Host"), port)) {
    status = k_forbidden;
  } else if (request.path != "/") {
    status = k_not_found;
  } else if (request.method != "GET") {
    status = k_wrong_method;
  }
  if (status == 0) return httplib::Server::HandlerResponse::Unhandled;
  response.status = status;
  return httplib::Server::HandlerResponse::Handled;
}

void prepare(httplib::Server& server, const std::string& page) {
  // The library's default would let another program listen on the same port.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  // A silent client must not delay the end.
  server.set_read_timeout(k_read_timeout);
  server.set_keep_alive_timeout(k_read_timeout.count());
  server.set_default_headers({{"X-Content-Type-Options", "nosniff"},
                              {"X-Frame-Options", "DENY"},
                              {"Referrer-Policy", "no-referrer"},
                              {"Cross-Origin-Resource-Policy", "same-origin"},
                              {"Cache-Control", "no-store"}});
  server.Get("/", [&page](const httplib::Request& /*request*/, httplib::Response& response) {
    response.set_content(page, "text/html; charset=utf-8");
  });
}

int bind(httplib::Server& server, int port) {
  const int bound = port == 0 ? server.bind_to_any_port(k_loopback) : server.bind_to_port(k_loopback, port) ? port : -1;
  if (bound > 0) return bound;
  throw Error({.where = fmt::format("--port {}", port),
               .expected = "the port cannot be opened",
               .remedy = "choose another port, or leave out --port to use any free one"});
}

void wait_for(const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any changed;
  std::unique_lock lock(mutex);
  changed.wait(lock, stop, [] { return false; });
}

/// Fails if xdg-open fails within a second. Does not wait for longer runs, such as a browser.
constexpr const char* k_open = R"(xdg-open "$1" &
for tenth in 1 2 3 4 5 6 7 8 9 10; do kill -0 $! || break; sleep 0.1; done
kill -0 $! || wait $!)";

}  // namespace

void serve_page(const std::string& page, int port, const std::stop_token& stop,
                const std::function<void(const std::string& address)>& on_ready) {
  httplib::Server server;
  prepare(server, page);
  const int bound = bind(server, port);
  server.set_pre_routing_handler([bound](const httplib::Request& request, httplib::Response& response) {
    return refuse_others(request, response, bound);
  });
  std::thread listener([&server] { server.listen_after_bind(); });
  on_ready(fmt::format("http://{}:{}/", k_loopback, bound));
  wait_for(stop);
  // A stop before the server listens would be lost.
  while (!server.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  server.stop();
  listener.join();
}

bool open_in_browser(const std::string& address) {
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return false;
  constexpr std::chrono::seconds k_limit{5};
  return run_program({"sh", "-c", k_open, "sh", address}, "/dev/null", "/dev/null", k_limit) == RunEnd::done;
}

}  // namespace cloud2csg::app
