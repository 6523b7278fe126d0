// The HTTP server of `whit serve`.
//
// A page's address holds a random token, without which no request is answered. Requests name one of
// five things, and none of them is a file. Connections that have not shown the token are few: a new
// one displaces the oldest.
#pragma once

#include <memory>
#include <string>

#include "viewer/serve/served_session.h"

namespace whit::serve {

struct ServerOptions {
  std::string bind = "127.0.0.1";
  int port = 0;               // 0: kUsualPort, or any free one if that is taken
  double requestSeconds = 5;  // time limit for the arrival of a request
  bool framed = false;  // notebooks of this machine show the page in a frame; VS Code always may
};
inline constexpr int kUsualPort = 8765;

inline constexpr int kMostPages = 16;
inline constexpr int kMostStrangers = 32;           // connections that have not shown the token
inline constexpr int kMostConnections = 128;        // at a time, with a thread each; others wait
inline constexpr std::size_t kRequestBytes = 8192;  // without the body
// A page that acknowledges nothing for this time is dropped.
inline constexpr double kDeafSeconds = 10;

// Returns 128 random bits from the system, in hexadecimal.
std::string randomToken();
// Returns whether both are the same, in a time that does not depend on where they differ.
bool sameToken(std::string_view a, std::string_view b);
// Returns true if a Host header names the machine by an address, as localhost or by the name that
// the server was bound to. A foreign DNS server can make no such name lead here.
bool isOwnHost(const std::string& host, const std::string& bind);

class Server {
 public:
  // Listens. Throws Error(io) if the address or the port cannot be had.
  Server(ServedSession& session, const ServerOptions& options);
  ~Server();  // ends all connections

  int port() const { return port_; }
  const std::string& token() const { return token_; }
  // Returns host and port as this machine's browsers and `ssh -L` take them: "[::1]:8765".
  std::string place() const;
  std::string url() const;
  void run();              // returns after stop()
  bool isRunning() const;  // until then stop() does nothing
  void stop();             // any thread may call it

 private:
  class Http;
  const ServerOptions options_;
  const std::string token_;
  std::unique_ptr<Http> http_;
  int port_ = 0;
};

}  // namespace whit::serve
