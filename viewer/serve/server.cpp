#include "viewer/serve/server.h"

#include <arpa/inet.h>
#include <httplib.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/random.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <chrono>
#include <deque>
#include <list>
#include <map>
#include <utility>

#include "core/error.h"
#include "core/option_table.h"
#include "core/text.h"
#include "viewer/serve/picture_stream.h"

namespace whit::serve {

namespace {

constexpr const char* kPage =
#include "page_html.inc"
    ;

constexpr double kWriteSeconds = 5, kTrustedIdleSeconds = 60;
constexpr int kMostRequests = 100000;  // on one connection
constexpr double kAliveMs = 2000;      // between messages to a page that has nothing to draw

// Windows of VS Code show the page in a frame. No page of a web site has these schemes.
constexpr const char* kEditorFrames = "vscode-webview: vscode-file:";

// Threads for connections. The library's own pool would start all of them at once.
class ThreadsOnDemand : public httplib::TaskQueue {
 public:
  // Newer versions of the library want to know whether the task was taken.
  using Taken = decltype(std::declval<httplib::TaskQueue&>().enqueue(nullptr));

  Taken enqueue(std::function<void()> task) override {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
    if (idle_ < tasks_.size() && threads_.size() < kMostConnections) {
      threads_.emplace_back([this] { work(); });
    }
    fresh_.notify_one();
    return static_cast<Taken>(true);
  }

  void shutdown() override {
    {
      const std::lock_guard lock(mutex_);
      ends_ = true;
    }
    fresh_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

 private:
  void work() {
    std::unique_lock lock(mutex_);
    for (;;) {
      ++idle_;
      fresh_.wait(lock, [&] { return ends_ || !tasks_.empty(); });
      --idle_;
      if (tasks_.empty()) return;

      const std::function<void()> task = std::move(tasks_.front());
      tasks_.pop_front();
      lock.unlock();
      task();
      lock.lock();
    }
  }

  std::mutex mutex_;
  std::condition_variable fresh_;
  std::deque<std::function<void()>> tasks_;
  std::vector<std::thread> threads_;
  std::size_t idle_ = 0;  // threads that wait for a task
  bool ends_ = false;
};

// A request may be refused because another site's page sent it.
bool isOtherOrigin(const httplib::Request& request) {
  const std::string origin = request.get_header_value("Origin");
  return !origin.empty() && origin != "http://" + request.get_header_value("Host");
}

// Returns the text for a user whose request was refused with this status.
const char* adviceOn(int status, const httplib::Request& request) {
  switch (status) {
    case 403:
      if (isOtherOrigin(request)) {
        return "a page of another site sent this request, or a proxy changed its Host: open the "
               "address that whit serve printed, and forward its port over ssh";
      }
      return "this address lacks the token of the server, which changes at every start: open the "
             "address that whit serve printed last";
    case 421:
      return "whit serve answers only at the address that it was bound to, at localhost and at IP "
             "addresses: put one of them in place of this host, or forward the port over ssh, as "
             "whit serve printed";
    case 404:
      return "there is no such page: open the address that whit serve printed, with the slash at "
             "its end";
    default:
      return "refused";
  }
}

}  // namespace

// Reads and writes a connection. Each request has a limit of bytes and a limit of time.
class Connection : public httplib::Stream {
 public:
  Connection(socket_t socket, double seconds) : socket_(socket), seconds_(seconds) {}

  // Waits for a request and starts its limits anew. Returns false if none comes.
  bool begin() {
    left_ = kRequestBytes + view::kMessageBytes;
    since_ = Stopwatch();
    if (over) return false;
    if (at_ < size_) return true;
    return ready(POLLIN, trusted ? kTrustedIdleSeconds : seconds_);
  }

  bool is_readable() const override { return at_ < size_ || ready(POLLIN, 0); }
  bool is_writable() const override { return ready(POLLOUT, kWriteSeconds); }

  ssize_t read(char* to, std::size_t size) override {
    // The socket is read only when the buffer is empty, and only within the request's bytes and
    // time.
    if (at_ == size_) {
      if (left_ == 0 || !ready(POLLIN, seconds_ - since_.ms() / 1000)) return -1;

      const ssize_t got = ::recv(socket_, buffer_, std::min(left_, sizeof buffer_), 0);
      if (got <= 0) return got;
      at_ = 0;
      size_ = static_cast<std::size_t>(got);
      left_ -= size_;
    }

    const std::size_t count = std::min(size, size_ - at_);
    std::copy_n(buffer_ + at_, count, to);
    at_ += count;
    return static_cast<ssize_t>(count);
  }

  ssize_t write(const char* from, std::size_t size) override {
    const ssize_t sent =
        is_writable() ? ::send(socket_, from, size, MSG_NOSIGNAL | MSG_DONTWAIT) : -1;
    over |= sent < 0;
    return sent;
  }

  // Nothing asks who is at the other end.
  void get_remote_ip_and_port(std::string& /*ip*/, int& /*port*/) const override {}
  void get_local_ip_and_port(std::string& /*ip*/, int& /*port*/) const override {}
  socket_t socket() const override { return socket_; }

  bool over = false;                  // no further request is read
  std::atomic<bool> trusted = false;  // it has shown the token
  bool leaves = false;                // it makes room for another one

 private:
  bool ready(short events, double seconds) const {
    pollfd asked{socket_, static_cast<short>(events | POLLRDHUP), 0};
    const int ms = static_cast<int>(std::max(1000 * seconds, 0.0));
    const bool any = ::poll(&asked, 1, ms) > 0;
    return any && (asked.revents & events) != 0 && (asked.revents & (POLLERR | POLLHUP)) == 0 &&
           (events == POLLIN || (asked.revents & POLLRDHUP) == 0);
  }

  const socket_t socket_;
  const double seconds_;
  char buffer_[4096];
  std::size_t at_ = 0, size_ = 0, left_ = 0;
  Stopwatch since_;
};

namespace {

thread_local Connection* current = nullptr;  // its request is answered by this thread

// Returns a number as four bytes, the least significant one first, as the page reads it.
std::string wordOf(std::size_t value) {
  std::string bytes(4, '\0');
  for (int i = 0; i < 4; ++i) bytes[i] = static_cast<char>(value >> (8 * i));
  return bytes;
}

}  // namespace

// A page as the server sees it: what it has been sent, and what comes next.
class Page {
 public:
  Page(ServedSession& session, int number) : session_(session), number_(number) {
    session_.watch(1);
  }
  ~Page() { session_.watch(-1); }
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;

  // Sets the next message, which is empty if there is none yet. Returns false if the page no longer
  // acknowledges messages.
  bool next(std::string& message) {
    std::unique_lock lock(mutex_);
    if (pictures_.waitedMs(clock_.ms()) > 1000 * kDeafSeconds) return false;

    // Nothing is sent before the page has acknowledged enough of what is under way.
    const bool more =
        changed_.wait_for(lock, std::chrono::milliseconds(100), [&] { return pictures_.ready(); });
    if (!more) return true;

    // Wait for a newer picture without the lock, so that acknowledgements come in. While tiles of
    // the present picture are still to be sent, there is nothing to wait for.
    const bool unfinished = moreTiles_;
    lock.unlock();
    const std::shared_ptr<const Shot> shot = session_.wait(unfinished ? 0 : seen_);
    lock.lock();

    const bool news = shot && (shot->number != seen_ || unfinished);
    if (!news && clock_.ms() - sentMs_ < kAliveMs) return true;

    std::string json = "{\"page\":" + std::to_string(number_), tiles;
    if (news) {
      const bool tabled = std::exchange(tables_, shot->tables) == shot->tables;
      if (!tabled) json += ",\"tables\":" + *shot->tables;

      const Tiles next = pictures_.next(shot->picture, shot->exact, clock_.ms());
      moreTiles_ = shot->exact && !next.empty();

      json += ",\"size\":[" + std::to_string(shot->picture.width) + "," +
              std::to_string(shot->picture.height) + "],\"live\":" + shot->live +
              ",\"exact\":" + (shot->exact && next.empty() ? "true" : "false");
      if (!next.empty())
        json += ",\"frame\":" + std::to_string(next.number) + ",\"tiles\":" + next.list;
      tiles = next.bytes;
      if (!tabled || shot->settledNumber != settled_) json += ",\"settled\":" + shot->settled;
      settled_ = shot->settledNumber;
      seen_ = shot->number;
    }

    // A message is its length, the length of its JSON, the JSON, and the bytes of the tiles.
    json += "}";
    message = wordOf(4 + json.size() + tiles.size()) + wordOf(json.size()) + json + tiles;
    sentMs_ = clock_.ms();
    return true;
  }

  void acknowledge(std::uint32_t frame) {
    const std::lock_guard lock(mutex_);
    changed_.notify_one();
    pictures_.acknowledge(frame, clock_.ms());
    mostPixels_ = pictures_.mostPixels();
  }

  double mostPixels() const { return mostPixels_; }

 private:
  ServedSession& session_;
  const int number_;
  const Stopwatch clock_;
  double sentMs_ = 0;
  std::uint64_t seen_ = 0, settled_ = 0;
  std::shared_ptr<const std::string> tables_;
  bool moreTiles_ = false;
  std::atomic<double> mostPixels_ = 1e9;
  std::mutex mutex_;
  std::condition_variable changed_;
  PictureStream pictures_;
};

std::string randomToken() {
  unsigned char bits[16];
  if (::getrandom(bits, sizeof bits, 0) != sizeof bits) throwIo("the system gives no random bits");
  std::string token;
  for (const unsigned char byte : bits) token += formatted("%02x", byte);
  return token;
}

bool sameToken(std::string_view a, std::string_view b) {
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    difference |= static_cast<unsigned>(a[i] ^ b[i]);
  }
  return difference == 0;
}

bool isOwnHost(const std::string& host, const std::string& bind) {
  // The port does not count. A colon before a bracket belongs to an IPv6 address.
  std::string name = host;
  const std::size_t colon = name.rfind(':');
  if (colon != std::string::npos && name.find(']', colon) == std::string::npos) {
    int port = 0;
    if (!readNumber(name.substr(colon + 1), port) || port < 1 || port > 65535) return false;
    name.resize(colon);
  }
  if (name == "localhost" || name == bind) return true;

  if (name.size() > 2 && name.front() == '[' && name.back() == ']') {
    name = name.substr(1, name.size() - 2);
  }

  unsigned char address[sizeof(in6_addr)];
  return ::inet_pton(AF_INET, name.c_str(), address) == 1 ||
         ::inet_pton(AF_INET6, name.c_str(), address) == 1;
}

class Server::Http : public httplib::Server {
 public:
  Http(serve::Server& server, ServedSession& session) : server_(server), session_(session) {
    limitClients();
    checkRequests();
    answerRequests();
  }

  // Lets more connections wait than the library does, so that a crowd does not keep a page out.
  void widen() { ::listen(svr_sock_, kMostConnections); }

  // Ends all connections, so that their threads end.
  void hangUp() {
    const std::lock_guard lock(mutex_);
    for (const Connection* connection : connections_) ::shutdown(connection->socket(), SHUT_RDWR);
  }

 private:
  using Request = httplib::Request;
  using Response = httplib::Response;

  // Bounds what clients can take up.
  void limitClients() {
    new_task_queue = [] { return new ThreadsOnDemand(); };
    set_payload_max_length(view::kMessageBytes);
    set_tcp_nodelay(true);
    set_keep_alive_max_count(kMostRequests);
    set_keep_alive_timeout(static_cast<time_t>(kTrustedIdleSeconds));

    set_socket_options([](socket_t socket) {  // without SO_REUSEPORT: nobody else gets our port
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
  }

  // Refuses requests by their paths and headers, before their bodies are read, and says why.
  void checkRequests() {
    set_pre_routing_handler([this](const Request& request, Response& response) {
      response.status = refusalOf(request);
      if (response.status == 0) {
        response.status = -1;
        current->trusted = true;
        return HandlerResponse::Unhandled;
      }
      response.set_content(std::string(adviceOn(response.status, request)) + "\n", "text/plain");
      return HandlerResponse::Handled;
    });

    set_logger([](const Request&, const Response& response) {
      // After a refusal, what follows may be the rest of the refused request.
      current->over |= response.status >= 400;
    });

    set_exception_handler([](const Request&, Response& response, std::exception_ptr thrown) {
      response.status = 400;
      try {
        std::rethrow_exception(std::move(thrown));
      } catch (const std::exception& error) {
        response.set_content(printable(error.what()) + "\n", "text/plain");
      }
    });
  }

  // Everything that is served lies below the token.
  void answerRequests() {
    // The page runs only its own script and style, which carry a nonce, and loads nothing from
    // elsewhere.
    const std::string nonce = randomToken();
    const auto withNonce = [&](std::string text) {
      for (std::size_t at; (at = text.find("NONCE")) != std::string::npos;) {
        text.replace(at, 5, nonce);
      }
      return text;
    };

    set_default_headers(
        {{"Content-Security-Policy",
          withNonce("default-src 'none'; connect-src 'self'; img-src blob: data:; base-uri 'none'; "
                    "form-action 'none'; script-src 'nonce-NONCE'; style-src 'nonce-NONCE'; "
                    "frame-ancestors ") +
              kEditorFrames +
              (server_.options_.framed ? " http://localhost:* http://127.0.0.1:*" : "")},
         {"X-Content-Type-Options", "nosniff"},
         {"Referrer-Policy", "no-referrer"},
         {"Cache-Control", "no-store"}});

    const std::string root = "/" + server_.token_ + "/";
    Get(root, [page = withNonce(kPage)](const Request&, Response& response) {
      response.set_content(page, "text/html; charset=utf-8");
    });

    // Some programs paste the address without its last slash.
    Get("/" + server_.token_,
        [root](const Request&, Response& response) { response.set_redirect(root); });

    Get(root + "stream", [this](const Request&, Response& response) { stream(response); });
    Get(root + "picture.png", [this](const Request&, Response& r) { download(r, false); });
    Get(root + "picture.exr", [this](const Request&, Response& r) { download(r, true); });

    Post(root + "input", [this](const Request& request, Response& response) {
      std::vector<Message> messages = view::readMessages(request.body);

      // Acknowledgements go to the page's stream, everything else to the session.
      std::erase_if(messages, [this](const Message& message) {
        if (message.verb->name != "ack") return false;
        acknowledge(static_cast<int>(message.numbers[0]),
                    static_cast<std::uint32_t>(message.numbers[1]));
        return true;
      });
      response.status = messages.empty() || session_.post(std::move(messages)) ? 204 : 429;
    });
  }

  // Returns the status by which a request is refused; 0: it is not.
  int refusalOf(const httplib::Request& request) const {
    // The Host header stops DNS rebinding, and the Origin header stops requests by other sites'
    // pages.
    if (!isOwnHost(request.get_header_value("Host"), server_.options_.bind)) return 421;
    if (isOtherOrigin(request)) return 403;

    const std::string_view path = request.path;
    constexpr std::size_t kTokenEnd = 33;  // "/" and 32 digits
    const bool ends =
        path.size() == kTokenEnd || (path.size() > kTokenEnd && path[kTokenEnd] == '/');
    const bool shown =
        ends && path[0] == '/' && sameToken(path.substr(1, kTokenEnd - 1), server_.token_);
    if (!shown) return 403;

    // The page, its stream, two pictures and its input are all that there is below the token.
    const std::string_view thing = path.substr(std::min(path.size(), kTokenEnd + 1));
    const bool isInput = thing == "input";
    const bool isOther =
        thing.empty() || thing == "stream" || thing == "picture.png" || thing == "picture.exr";
    if (!isInput && !isOther) return 404;
    if (request.method != (isInput ? "POST" : "GET")) return 405;

    // An encoded body may be larger than it looks.
    const bool encoded = request.has_header("Content-Encoding") || request.is_multipart_form_data();
    return encoded ? 415 : 0;
  }

  void stream(httplib::Response& response) {
    // Pages that are gone make room for this one.
    const std::lock_guard lock(pagesMutex_);
    std::erase_if(pages_, [](const auto& page) { return page.second.expired(); });

    if (pages_.size() >= kMostPages) {
      response.status = 503;
      response.set_content("too many pages are open\n", "text/plain");
      return;
    }

    const int number = ++lastPage_;
    const auto page = std::make_shared<Page>(session_, number);
    pages_[number] = page;

    response.set_chunked_content_provider(
        "application/octet-stream", [page](std::size_t, httplib::DataSink& sink) {
          std::string message;
          return page->next(message) &&
                 (message.empty() || sink.write(message.data(), message.size()));
        });
  }

  void acknowledge(int number, std::uint32_t frame) {
    // Pages are kept alive while they are used, because their streams may end at any time.
    std::vector<std::shared_ptr<Page>> open;
    std::shared_ptr<Page> page;

    {
      const std::lock_guard lock(pagesMutex_);
      for (const auto& [known, weak] : pages_) {
        open.push_back(weak.lock());
        if (known == number) page = open.back();
      }
    }

    if (!page) return;
    page->acknowledge(frame);
    double most = 0;  // the best link decides, so that a slow one does not blur the others
    for (const auto& other : open) most = std::max(most, other ? other->mostPixels() : 0);
    session_.limitPixels(most);
  }

  void download(httplib::Response& response, bool exr) {
    // Only one download runs at a time, because each holds a thread and a frame.
    const std::unique_lock lock(downloading_, std::try_to_lock);
    const auto [scene, bytes] = lock ? session_.download(exr) : Download();
    response.status = bytes.empty() ? 503 : 200;
    if (bytes.empty()) return response.set_content("busy; try again\n", "text/plain");

    // The file is named after the scene. Only letters and digits pass, so that nothing breaks the
    // header or the path.
    std::string name;
    for (const char c : scene) name += std::isalnum(static_cast<unsigned char>(c)) ? c : '-';

    const char* const extension = exr ? ".exr" : ".png";
    response.set_header("Content-Disposition", "attachment; filename=\"" + name + extension + "\"");
    response.set_content(bytes, exr ? "image/x-exr" : "image/png");
  }

  bool process_and_close_socket(socket_t socket) override {
    Connection connection(socket, server_.options_.requestSeconds);
    {
      const std::lock_guard lock(mutex_);
      const auto isStranger = [](const Connection* known) {
        return !known->trusted && !known->leaves;
      };

      // Connections without the token are few: a new one displaces the oldest.
      if (std::ranges::count_if(connections_, isStranger) >= kMostStrangers) {
        Connection* const oldest = *std::ranges::find_if(connections_, isStranger);
        oldest->leaves = true;
        ::shutdown(oldest->socket(), SHUT_RDWR);
      }
      connections_.push_back(&connection);
    }

    // Requests are answered until the connection is closed or has reached kMostRequests.
    current = &connection;
    bool closed = false;
    for (int left = kMostRequests; left > 0 && !closed && connection.begin(); --left) {
      if (!answer(connection, left == 1, closed)) break;
    }

    current = nullptr;
    const std::lock_guard lock(mutex_);
    connections_.remove(&connection);

    ::shutdown(socket, SHUT_RDWR);
    ::close(socket);
    return true;
  }

  // Newer versions of the library want to know the addresses as well.
  template <typename Stream>
  bool answer(Stream& stream, bool last, bool& closed) {
    if constexpr (requires { this->process_request(stream, last, closed, nullptr); }) {
      return this->process_request(stream, last, closed, nullptr);
    } else {
      return this->process_request(stream, "", 0, "", 0, last, closed, nullptr);
    }
  }

  serve::Server& server_;
  ServedSession& session_;
  std::mutex mutex_;
  std::list<Connection*> connections_;  // the oldest first
  std::mutex pagesMutex_;
  std::map<int, std::weak_ptr<Page>> pages_;
  int lastPage_ = 0;
  std::mutex downloading_;
};

Server::Server(ServedSession& session, const ServerOptions& options)
    : options_(options), token_(randomToken()), http_(std::make_unique<Http>(*this, session)) {
  const int wanted = options.port > 0 ? options.port : kUsualPort;
  if (http_->bind_to_port(options.bind, wanted)) {
    port_ = wanted;
  } else if (options.port == 0) {
    // From cpp-httplib 0.16 on, a server that has failed to bind refuses to bind again.
    http_ = std::make_unique<Http>(*this, session);
    port_ = http_->bind_to_any_port(options.bind);
  }

  if (port_ <= 0) {
    throwIo(
        formatted("cannot listen on %s, port %d: the port is taken, or the address is not this "
                  "machine's",
                  printable(options.bind).c_str(), wanted));
  }

  http_->widen();
}

Server::~Server() { stop(); }

std::string Server::place() const {
  // A server that listens everywhere is reached at this machine's own address.
  std::string host = options_.bind;
  if (host == "0.0.0.0") host = "127.0.0.1";
  if (host == "::") host = "::1";

  const bool v6 = host.find(':') != std::string::npos;
  return (v6 ? "[" + host + "]" : host) + ":" + std::to_string(port_);
}

std::string Server::url() const { return "http://" + place() + "/" + token_ + "/"; }

void Server::run() { http_->listen_after_bind(); }

bool Server::isRunning() const { return http_->is_running(); }

void Server::stop() {
  http_->stop();
  http_->hangUp();
}

}  // namespace whit::serve
