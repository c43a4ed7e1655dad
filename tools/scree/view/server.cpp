#include "view/server.hpp"

// clang-format off
#include <httplib.h>
#undef _res  // of resolv.h; Eigen has a parameter of this name
// clang-format on
#include <spdlog/fmt/fmt.h>

#include <thread>
#include <utility>

#include "commands.hpp"
#include "report/page.hpp"

namespace scree::cli {
namespace {

constexpr std::size_t kViewers = 16;  // each takes a thread
constexpr auto kSignOfLife = std::chrono::milliseconds(1000);

bool is_loopback(const std::string& address) {
  return address == "localhost" || address == "::1" || address.starts_with("127.");
}

/// The name in a request's Host, without its port.
std::string host_of(const httplib::Request& request) {
  std::string host = request.get_header_value("Host");
  const std::size_t colon = host.rfind(':');
  if (colon != std::string::npos && host.find(']', colon) == std::string::npos) host.resize(colon);
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  return host;
}

/// The same time for every wrong token.
bool are_same(const std::string& a, const std::string& b) {
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < b.size(); ++i) {
    difference |= static_cast<unsigned>(static_cast<unsigned char>(b[i]) ^
                                        static_cast<unsigned char>(i < a.size() ? a[i] : 0));
  }
  return difference == 0;
}

/// Why a request gets nothing; empty: it is served.
std::string refusal(const ServerOptions& options, const httplib::Request& request) {
  if (!options.token.empty()) {
    return are_same(request.get_param_value("token"), options.token)
               ? ""
               : "the token is missing or wrong: add ?token=... to the address\n";
  }
  // A page from elsewhere could give a name of its own this computer's address.
  if (is_loopback(options.address) && !is_loopback(host_of(request)))
    return "this page is for localhost\n";
  return {};
}

void set_up(httplib::Server& server) {
  server.new_task_queue = [] { return new httplib::ThreadPool(kViewers + 2); };
  server.set_keep_alive_max_count(1);
  // The library would share a port with another program.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
}

void set_routes(httplib::Server& server, const ServerOptions& options, Hub& hub,
                std::string first) {
  server.set_pre_routing_handler(
      [options](const httplib::Request& request, httplib::Response& response) {
        const std::string why = refusal(options, request);
        if (why.empty()) return httplib::Server::HandlerResponse::Unhandled;
        response.status = 403;
        response.set_content(why, "text/plain");
        return httplib::Server::HandlerResponse::Handled;
      });
  server.Get("/", [page = live_page()](const httplib::Request&, httplib::Response& response) {
    response.set_header("Cache-Control", "no-store");
    response.set_content(page, "text/html; charset=utf-8");
  });
  server.Get("/events", [&hub, first = std::move(first)](const httplib::Request&,
                                                         httplib::Response& response) {
    response.set_header("Cache-Control", "no-store");
    auto seen = std::make_shared<Hub::Seen>();
    auto greeting =
        std::make_shared<std::string>("retry: 500\nevent: hello\ndata: " + first + "\n\n");
    response.set_chunked_content_provider(
        "text/event-stream", [&hub, seen, greeting](std::size_t, httplib::DataSink& sink) {
          std::string text = std::exchange(*greeting, "");
          if (text.empty()) text = hub.next(*seen, kSignOfLife);
          if (hub.is_closed()) return false;
          if (text.empty()) text = ": alive\n\n";
          return sink.write(text.data(), text.size());
        });
  });
}

/// The port that it listens on. Throws Failure.
int bind(httplib::Server& server, const ServerOptions& options) {
  const char* const address = options.address.c_str();
  const bool takes_any = options.port == 0;
  const int port = takes_any ? server.bind_to_any_port(address) : options.port;
  if (port > 0 && (takes_any || server.bind_to_port(address, port))) return port;
  throw Failure(
      fmt::format("cannot listen on {} port {}: either this computer has no such address, or the "
                  "port is taken (--port chooses another one)",
                  options.address, options.port));
}

}  // namespace

struct ViewServer::Running {
  httplib::Server server;
  std::thread thread;
  Hub& hub;

  explicit Running(Hub& the_hub) : hub(the_hub) {}
  ~Running() {
    hub.close();
    server.stop();
    if (thread.joinable()) thread.join();
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
};

ViewServer::ViewServer(const ServerOptions& options, Hub& hub, std::string first)
    : running_(std::make_unique<Running>(hub)) {
  httplib::Server& server = running_->server;
  set_up(server);
  set_routes(server, options, hub, std::move(first));
  const int port = bind(server, options);
  running_->thread = std::thread([&server] { server.listen_after_bind(); });
  const bool is_ipv6 = options.address.find(':') != std::string::npos;
  url_ = fmt::format("http://{}:{}/{}", is_ipv6 ? "[" + options.address + "]" : options.address,
                     port, options.token.empty() ? "" : "?token=" + options.token);
}

ViewServer::~ViewServer() = default;

}  // namespace scree::cli
