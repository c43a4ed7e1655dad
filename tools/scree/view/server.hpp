#pragma once

#include <memory>
#include <string>

#include "view/hub.hpp"

namespace scree::cli {

struct ServerOptions {
  std::string address = "127.0.0.1";
  int port = 8044;
  std::string token;  ///< without it a viewer gets nothing; empty: none is asked for
};

/// Serves the live page and what the hub says, as server-sent events. It reads nothing but the
/// path and the token of a request.
class ViewServer {
public:
  /// Listens from here on. Throws Failure.
  /// @param first sent to each viewer first: one JSON object
  ViewServer(const ServerOptions& options, Hub& hub, std::string first);
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  /// The page's address.
  const std::string& url() const { return url_; }

private:
  struct Running;
  std::string url_;
  std::unique_ptr<Running> running_;
};

}  // namespace scree::cli
