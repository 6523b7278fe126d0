// The server against friends and strangers: which requests are answered, and what hostile clients
// can do.
#include "viewer/serve/server.h"
#include "output/open_and_warn.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <httplib.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <regex>
#include <thread>

#include "cli/run_program.h"
#include "has_text.h"

namespace whit::serve {
namespace {

TEST(Token, IsRandomAndCompared) {
  const std::string token = randomToken();
  EXPECT_EQ(token.size(), 32u);
  EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(token, randomToken());
  EXPECT_TRUE(sameToken(token, token));
  EXPECT_FALSE(sameToken(token, token.substr(1)));
  EXPECT_FALSE(sameToken("", token));

  for (std::size_t i = 0; i < token.size(); ++i) {
    std::string other = token;
    other[i] ^= 1;
    EXPECT_FALSE(sameToken(token, other)) << i;
  }
}

// A name that somebody else's DNS may point at this machine is not the machine's own.
TEST(Host, IsOurs) {
  for (const char* host : {"localhost", "localhost:8765", "127.0.0.1:1", "[::1]:80", "[::1]",
                           "192.168.1.7:8765", "box:8765"}) {
    EXPECT_TRUE(isOwnHost(host, "box")) << host;
  }
  for (const char* host :
       {"", "evil.example", "evil.example:8765", "localhost.evil.example", "127.0.0.1.evil.example",
        "127.0.0.1:port", "127.0.0.1:0", "[::1", "1:2:3", "localhost:99999", "box:1:2"}) {
    EXPECT_FALSE(isOwnHost(host, "box")) << host;
  }
}

// Longer than anything takes on a busy machine.
constexpr double kLongEnoughMs = 60'000;

class Serving : public testing::Test {
 protected:
  // The server does not drop slow strangers within the time of a test, unless the test asks for it.
  explicit Serving(double requestSeconds = 600, const std::string& scene = "tiny.json") {
    options_.common.quiet = true;
    options_.common.render.threads = 2;
    options_.scene = folder_ / scene;
    std::filesystem::rename(cli::writeTinyScene(folder_), options_.scene);
    session_ = std::make_unique<ServedSession>(
        options_, openAndWarn(options_.scene, options_.common, nullptr));
    server_ = std::make_unique<Server>(*session_, ServerOptions{.requestSeconds = requestSeconds});
    root_ = "/" + server_->token() + "/";

    thread_ = std::thread([this] { server_->run(); });
    for (int i = 0; i < 1000 && status(root_) != 200; ++i) pause(5);
  }

  ~Serving() override {
    server_->stop();
    thread_.join();
    server_.reset();
  }

  httplib::Client client() const {
    httplib::Client client("127.0.0.1", server_->port());
    client.set_read_timeout(60);
    return client;
  }

  int status(const std::string& path, const httplib::Headers& headers = {}) const {
    const auto answer = client().Get(path, headers);
    return answer ? answer->status : 0;
  }

  void expectRefused(const std::string& path, const httplib::Headers& headers, int status,
                     const std::string& why) const {
    const auto answer = client().Get(path, headers);
    ASSERT_TRUE(answer) << path;
    EXPECT_EQ(answer->status, status) << path;
    EXPECT_TRUE(hasText(answer->body, why)) << path;
  }

  int post(const std::string& body, const httplib::Headers& headers = {}) const {
    const auto answer = client().Post(root_ + "input", headers, body, "text/plain");
    return answer ? answer->status : 0;
  }

  // Gives the session the lines of a page.
  bool say(const std::string& lines) { return session_->post(view::readMessages(lines)); }

  static void pause(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

  // Opens a connection without httplib.
  int connection() const {
    const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(server_->port()));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);

    const timeval limit{20, 0};
    ::setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    EXPECT_EQ(::connect(socket, reinterpret_cast<sockaddr*>(&to), sizeof to), 0);
    return socket;
  }

  static bool send(int socket, const std::string& bytes) {
    return ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL) ==
           static_cast<ssize_t>(bytes.size());
  }

  // Opens a connection that asks for a page's pictures.
  int streaming() const {
    const int socket = connection();
    send(socket, "GET " + root_ + "stream HTTP/1.1\r\nHost: localhost\r\n\r\n");
    return socket;
  }

  // Reads how an answer begins.
  static std::string beginning(int socket) {
    char bytes[16] = {};
    const auto count = std::max<ssize_t>(::recv(socket, bytes, sizeof bytes, 0), 0);
    return std::string(bytes, count);
  }

  // Reads to the end of the connection, and closes it.
  static std::string rest(int socket) {
    std::string text;
    char bytes[4096];
    for (ssize_t got; (got = ::recv(socket, bytes, sizeof bytes, 0)) > 0;) text.append(bytes, got);
    ::close(socket);
    return text;
  }

  // Waits for a shot that is as wanted, and returns null if none comes.
  template <typename Wanted>
  static std::shared_ptr<const Shot> waitFor(ServedSession& session, const Wanted& wanted) {
    const Stopwatch waited;
    for (std::uint64_t newest = 0; waited.ms() < kLongEnoughMs;) {
      auto shot = session.wait(newest);
      if (shot && wanted(*shot)) return shot;
      if (shot) newest = shot->number;
    }
    return nullptr;
  }
  template <typename Wanted>
  std::shared_ptr<const Shot> waitFor(const Wanted& wanted) {
    return waitFor(*session_, wanted);
  }
  std::shared_ptr<const Shot> waitForShot() {
    return waitFor([](const Shot&) { return true; });
  }

  // Acts as a page that acknowledges its pictures. Returns when it has drawn `pictures` of them.
  int watch(int pictures, bool shakes = true) {
    const Stopwatch waited;
    std::string held;
    int drawn = 0;
    client().Get(root_ + "stream", [&](const char* data, std::size_t size) {
      held.append(data, size);
      const auto word = [&](std::size_t at) {
        std::size_t value = 0;
        for (int i = 3; i >= 0; --i) value = 256 * value + static_cast<unsigned char>(held[at + i]);
        return value;
      };
      while (held.size() >= 8 && held.size() >= 4 + word(0)) {
        const Json json = parseJson(held.substr(8, word(4)), "message");
        held.erase(0, 4 + word(0));

        // The camera turns to and fro, because in some directions a turn changes no pixel.
        std::string acts;
        if (shakes) acts = drawn % 16 < 8 ? "left 7 0" : "left -7 0";
        if (json.contains("frame")) {
          ++drawn;
          pageDraws_ = true;
          acts += "\nack " + json["page"].dump() + " " + json["frame"].dump();
        }
        post(acts);
      }
      return drawn < pictures && waited.ms() < kLongEnoughMs;
    });
    return drawn;
  }

  cli::TemporaryFolder folder_;
  view::ViewOptions options_;
  std::unique_ptr<ServedSession> session_;
  std::unique_ptr<Server> server_;
  std::string root_;
  std::thread thread_;
  // True when watch() has received a picture.
  std::atomic<bool> pageDraws_ = false;
};

// Who is refused learns what to do, and which of two things has to be changed.
TEST_F(Serving, OnlyThoseWithTheTokenAreAnswered) {
  EXPECT_EQ(status(root_), 200);

  std::string wrong = root_;
  wrong[5] ^= 1;
  for (const std::string& path :
       std::vector<std::string>{"/", wrong, root_.substr(0, 32), wrong + "stream", "/etc/passwd",
                                "/" + root_, root_.substr(0, 20) + "/", "/../../etc/passwd",
                                "/" + std::string(32, '0') + "/stream"}) {
    expectRefused(path, {}, 403,
                  "lacks the token of the server, which changes at every start: open the address "
                  "that whit serve printed last");
  }
}

// Some programs paste the address without its last slash.
TEST_F(Serving, TheAddressMayLackItsLastSlash) {
  const std::string bare = root_.substr(0, root_.size() - 1);
  const auto answer = client().Get(bare);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 302);
  EXPECT_EQ(answer->get_header_value("Location"), root_);
  EXPECT_EQ(status(bare + "0"), 403);
}

TEST_F(Serving, NoPathLeadsToAFile) {
  for (const char* path :
       {"../../etc/passwd", "..%2f..%2f..%2fetc%2fpasswd", "page.html", "stream/", "picture.png/..",
        "%00", "input", "//etc/passwd", "tiny.json"}) {
    const auto answer = client().Get(root_ + path);
    ASSERT_TRUE(answer) << path;
    EXPECT_TRUE(answer->status == 404 || answer->status == 405 || answer->status == 400) << path;
    EXPECT_FALSE(hasText(answer->body, "root:")) << path;
  }
}

TEST_F(Serving, OtherHostsAndOriginsAreRefused) {
  expectRefused(root_, {{"Host", "evil.example"}}, 421, "localhost");
  expectRefused(root_, {{"Host", "box.example:8765"}}, 421, "ssh");
  for (const char* origin : {"http://evil.example", "null"}) {
    expectRefused(root_, {{"Origin", origin}}, 403, "another site");
    EXPECT_FALSE(hasText(client().Get(root_, {{"Origin", origin}})->body, "token"));
  }

  const std::string own = "127.0.0.1:" + std::to_string(server_->port());
  EXPECT_EQ(status(root_, {{"Host", own}, {"Origin", "http://" + own}}), 200);
  EXPECT_EQ(post("fit", {{"Origin", "http://localhost:1"}}), 403);
}

TEST_F(Serving, OtherMethodsAndEncodingsAreRefused) {
  EXPECT_EQ(client().Put(root_ + "input", "fit", "text/plain")->status, 405);
  EXPECT_EQ(client().Delete(root_)->status, 405);
  EXPECT_EQ(client().Head(root_)->status, 405);
  EXPECT_EQ(client().Post(root_, "fit", "text/plain")->status, 405);
  EXPECT_EQ(post("fit", {{"Content-Encoding", "gzip"}}), 415);
  EXPECT_EQ(client().Post(root_ + "input", "x", "multipart/form-data; boundary=a")->status, 415);
}

// The token is in the URL: no answer may hand it on, be kept, or be taken for something else.
TEST_F(Serving, EveryAnswerHasItsHeaders) {
  std::thread page([&] { watch(100000, false); });
  EXPECT_TRUE(waitForShot());

  struct Row {
    const char *path, *type;
    int status;
    const char *file = "", *begin = "";  // the name of a download, and how its bytes begin
  };
  const Row rows[] = {
      {"", "text/html; charset=utf-8", 200},
      {"picture.png", "image/png", 200, "attachment; filename=\"tiny.png\"", "\x89PNG"},
      {"picture.exr", "image/x-exr", 200, "attachment; filename=\"tiny.exr\"", "\x76\x2f\x31\x01"},
      {"none", "text/plain", 404},
      {"input", "text/plain", 405},
      {"../", "text/plain", 404}};

  // Windows of VS Code may show the page in a frame, and no web site.
  const std::regex policy(
      "default-src 'none'; connect-src 'self'; img-src blob: data:; base-uri 'none'; "
      "form-action 'none'; script-src 'nonce-([0-9a-f]{32})'; style-src 'nonce-\\1'; "
      "frame-ancestors vscode-webview: vscode-file:");
  const auto expectCommon = [&](const httplib::Response& answer, const std::string& what) {
    EXPECT_EQ(answer.get_header_value("Referrer-Policy"), "no-referrer") << what;
    EXPECT_EQ(answer.get_header_value("X-Content-Type-Options"), "nosniff") << what;
    EXPECT_EQ(answer.get_header_value("Cache-Control"), "no-store") << what;
    EXPECT_TRUE(std::regex_match(answer.get_header_value("Content-Security-Policy"), policy))
        << what << answer.get_header_value("Content-Security-Policy");
    EXPECT_FALSE(answer.has_header("Access-Control-Allow-Origin")) << what;
  };

  for (const Row& row : rows) {
    const auto answer = client().Get(root_ + row.path);
    EXPECT_TRUE(answer) << row.path;
    if (!answer) continue;  // the page's thread has to be joined
    EXPECT_EQ(answer->status, row.status) << row.path;
    EXPECT_EQ(answer->get_header_value("Content-Type"), row.type) << row.path;
    EXPECT_EQ(answer->get_header_value("Content-Disposition"), row.file) << row.path;
    EXPECT_TRUE(answer->body.starts_with(row.begin)) << row.path;
    expectCommon(*answer, row.path);
  }

  const auto stranger = client().Get("/");
  const auto input = client().Post(root_ + "input", "left 1 0", "text/plain");
  const auto wrong = client().Post(root_ + "input", "left", "text/plain");
  std::string ofStream;
  client().Get(
      root_ + "stream",
      [&](const httplib::Response& answer) {
        ofStream = answer.get_header_value("Content-Type");
        expectCommon(answer, "stream");
        return false;
      },
      [](const char*, std::size_t) { return false; });
  server_->stop();
  page.join();

  ASSERT_TRUE(stranger && input && wrong);
  EXPECT_EQ(stranger->status, 403);
  EXPECT_EQ(input->status, 204);
  EXPECT_EQ(wrong->status, 400);
  for (const auto* answer : {&stranger, &input, &wrong}) expectCommon(**answer, "input");
  EXPECT_EQ(ofStream, "application/octet-stream");
}

// EveryAnswerHasItsHeaders holds the policy of the page.
TEST_F(Serving, ThePageLoadsNothing) {
  const auto page = client().Get(root_);
  ASSERT_TRUE(page);
  for (const char* elsewhere : {"http://", "https://", " src=", "@import", "url(", "NONCE"}) {
    EXPECT_FALSE(hasText(page->body, elsewhere)) << elsewhere;
  }
}

TEST_F(Serving, InputIsTakenOrRefusedWithItsReason) {
  EXPECT_EQ(post("left 3 4\nfit"), 204);
  EXPECT_EQ(post(""), 204);

  const auto answer = client().Post(root_ + "input", "left 3", "text/plain");
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 400);
  EXPECT_TRUE(hasText(answer->body, "line 1"));
  EXPECT_NE(post(std::string(view::kMessageBytes + 1, 'x')), 204);
  EXPECT_EQ(post("ack 99 1\nack 0 0"), 204) << "of a page that there is not";

  std::string many;
  for (std::size_t i = 0; i < view::kMessageLines; ++i) many += "fit\n";
  EXPECT_EQ(post(many), 204);

  // The queue takes so many messages at a time, and no more.
  constexpr std::size_t kMostMessages = 4096;
  EXPECT_FALSE(session_->post(std::vector<Message>(kMostMessages + 1)));
}

// A quotation mark in the name of a scene would end that of the file, and a line's end the header.
class ServingAnOddName : public Serving {
 protected:
  ServingAnOddName() : Serving(600, "a\"; b=\n2.json") {}
};

// No page has to be open.
TEST_F(ServingAnOddName, DownloadsAreNamedByLettersAndDigits) {
  const auto answer = client().Get(root_ + "picture.png");
  EXPECT_EQ(answer ? answer->get_header_value("Content-Disposition") : "no answer",
            "attachment; filename=\"a---b--2.png\"");
}

TEST_F(Serving, EveryVerbIsServed) {
  session_->watch(1);
  for (const view::Verb& verb : view::verbs()) {
    // The page itself does what has no action.
    if (!verb.act && verb.name != "size") continue;
    std::string line(verb.name);
    if (verb.named) line += " depth";
    for (std::size_t i = 0; i < verb.numbers.count; ++i) line += " 1";
    if (verb.text) line += " 1";

    const auto before = session_->wait(0);
    ASSERT_TRUE(say(line)) << line;
    auto shot = session_->wait(before ? before->number : 0);
    // The first picture may be older than the line.
    if (shot) shot = session_->wait(shot->number);
    ASSERT_TRUE(shot) << line;
  }
}

// What a line of the page changes in what the page is then told: a pointer into the JSON, and words
// that are there then and were not before; without them the text there is another one.
TEST_F(Serving, EveryVerbChangesWhatItSays) {
  struct Row {
    const char *line, *pointer, *value;
  };
  const Row rows[] = {{"size 64 40 1", "/window", "[64,40]"},
                      {"camera 1", "/command", "--camera=side"},
                      {"fit", "/command", nullptr},
                      {"left 30 0", "/command", nullptr},
                      {"middle 20 9", "/command", nullptr},
                      {"hold 0 0 0 1 0 0", "/command", nullptr},
                      {"expose 2", "/options/exposure", "2"},
                      {"set depth 3", "/options/depth", "3"},
                      {"effect shadows 0", "/command", "--disable=shadows"},
                      {"preset good", "/options/spp", "16"},
                      {"view depth", "/view", "depth"},
                      {"view reference", "/view", "reference"},
                      {"view difference", "/legend", "largest"},
                      {"measure", "/measured", nullptr},
                      {"view none\nclick 20 20", "/tree/pixel", "[20,20]"}};

  session_->watch(1);
  const auto textAt = [](const Shot& shot, const char* pointer) {
    for (const std::string* text : {&shot.live, &shot.settled}) {
      const Json json = parseJson(*text, "shot");
      const Json::json_pointer place(pointer);
      if (!json.contains(place)) continue;
      return json[place].is_string() ? json[place].get<std::string>() : json[place].dump();
    }
    return std::string("nothing");
  };

  for (const Row& row : rows) {
    // The command is that of the picture at rest.
    const auto rest = waitFor([](const Shot& shot) { return shot.exact; });
    ASSERT_TRUE(rest) << row.line;
    const std::string before = textAt(*rest, row.pointer);
    const auto isTold = [&](const Shot& shot) {
      const std::string now = textAt(shot, row.pointer);
      return row.value ? now.find(row.value) != std::string::npos : now != before;
    };
    EXPECT_FALSE(isTold(*rest)) << row.line << " has nothing to change";

    ASSERT_TRUE(say(row.line)) << row.line;
    EXPECT_TRUE(waitFor(isTold)) << row.line << " leaves " << before;
  }
}

// What is chosen after a pause is undone alone, also while nothing else happens.
TEST_F(Serving, ChoicesAfterAPauseAreUndoneOneByOne) {
  session_->watch(1);
  const auto chosen = [&](const char* line, const char* option, const char* value) {
    EXPECT_TRUE(say(line));
    const auto shot = waitFor([&](const Shot& shot) {
      return shot.exact && parseJson(shot.settled, "settled")["options"][option] == value;
    });
    return shot ? parseJson(shot->settled, "settled")["options"] : Json();
  };
  chosen("set depth 3", "depth", "3");
  pause(700);
  chosen("set spp 2", "spp", "2");
  EXPECT_EQ(chosen("undo", "spp", "1")["depth"], "3");
}

// Starts without a scene. The shipped ones are aa and the moving ab.
class ServingNoScene : public Serving {
 protected:
  ServingNoScene() {
    std::filesystem::create_directory(shipped_);
    std::filesystem::copy(folder_ / "tiny.json", shipped_ + "/aa.json");
    std::ofstream(shipped_ + "/ab.json") << asJson(
        "{'whit': 1, 'size': [48, 32], 'sky': {'color': 0.5},"
        "'cameras': {'front': {'eye': [0, 0, 6], 'at': [0, 0, 0]}},"
        "'scene': [{'shape': 'box', 'motion': {'loop': true, 'keys': ["
        "{'time': 0}, {'time': 10, 'rotate': [0, 1, 0, 360]}]}}]}");
    setenv("WHIT_SCENES", shipped_.c_str(), 1);
    view::settleViewOptions(none_);  // scenes play
    none_.scene.clear();
    open_ = std::make_unique<ServedSession>(none_, nullptr);
    open_->watch(1);
  }
  ~ServingNoScene() override { unsetenv("WHIT_SCENES"); }

  void post(const std::string& line) { open_->post(view::readMessages(line)); }
  // Waits until this text of a shot holds these words.
  bool isTold(const std::function<std::string(const Shot&)>& text, const std::string& words) {
    shot_ = waitFor(*open_,
                    [&](const Shot& shot) { return text(shot).find(words) != std::string::npos; });
    return shot_ != nullptr;
  }
  static std::string live(const Shot& shot) { return shot.live; }
  static std::string settled(const Shot& shot) { return shot.settled; }
  static std::string tables(const Shot& shot) { return *shot.tables; }

  const std::string shipped_ = folder_ / "shipped";
  view::ViewOptions none_ = options_;
  std::unique_ptr<ServedSession> open_;
  std::shared_ptr<const Shot> shot_;
};

// Pages choose among the shipped scenes, and can name no other file.
TEST_F(ServingNoScene, OffersTheShippedOnes) {
  EXPECT_TRUE(isTold(tables, "\"scenes\":[\"aa\"")) << "not the first of the list";
  post("scene " + options_.scene);
  EXPECT_TRUE(isTold(live, "no shipped scene has this name"));
  post("scene aa");
  ASSERT_TRUE(isTold(tables, "\"scene\":\"aa\""));
  EXPECT_EQ(shot_->tables->find("\"scenes\""), std::string::npos);
  EXPECT_TRUE(isTold(settled, "whit render aa "));
  post("scene aa");
  EXPECT_TRUE(isTold(live, "a scene is open already"));
}

// A scene that plays never rests, and nobody touches it.
TEST_F(ServingNoScene, SaysWhatASceneThatPlaysHas) {
  EXPECT_TRUE(isTold(tables, "\"scenes\""));
  post("scene ab");
  EXPECT_TRUE(isTold(settled, "ab, 12 triangles"));
}

// The rays of a pixel are listed although the picture never rests, and are never those of an
// earlier pixel.
TEST_F(ServingNoScene, AClickWhileItPlaysListsTheRaysOfItsPixel) {
  post("scene ab");
  EXPECT_TRUE(isTold(settled, "ab, 12 triangles"));
  for (const int x : {10, 12, 14, 16, 18, 20, 22, 24}) {
    post(formatted("click %d 9", x));
    EXPECT_TRUE(isTold(settled, formatted("\"pixel\":[%d,9]", x)));
  }
}

// The command is that of a picture at rest.
TEST_F(ServingNoScene, SaysWhetherThereIsACommand) {
  post("scene ab");
  EXPECT_TRUE(isTold(live, ",true]"));
  EXPECT_TRUE(hasText(shot_->live, "\"rests\":false"));
  post("play");
  EXPECT_TRUE(isTold(live, "\"rests\":true"));
  EXPECT_TRUE(hasText(shot_->settled, " --time "));
}

// Costs are measured at rest.
TEST_F(ServingNoScene, MeasuringPausesWhatPlays) {
  post("scene ab");
  EXPECT_TRUE(isTold(live, ",true]"));
  post("measure");
  EXPECT_TRUE(isTold(live, ",false]"));
}

// What the table of verbs leaves to the page is in the page's script.
TEST_F(Serving, ThePageDoesWhatTheVerbsLeaveToIt) {
  const std::string page = client().Get(root_)->body;
  std::smatch found;
  ASSERT_TRUE(std::regex_search(page, found, std::regex("const here = \\{([^}]*)\\}")));
  const std::string here = found[1];

  session_->watch(1);
  const Json lines = parseJson(*waitForShot()->tables, "tables")["lines"];

  for (const view::Verb& verb : view::verbs()) {
    if (verb.act || verb.keys.empty()) continue;
    const bool isInPage =
        std::regex_search(here, std::regex("\\b" + std::string(verb.name) + "[:,]"));
    EXPECT_EQ(isInPage, verb.onPage) << verb.name;
    EXPECT_EQ(lines.contains(verb.keys), verb.onPage) << verb.name;
  }
}

// A page that is gone cannot say that its keys are let go.
TEST_F(Serving, KeysThatNobodyHoldsAnyMoreAreLetGo) {
  session_->watch(1);
  const auto becomes = [&](bool exact) {
    return waitFor([&](const Shot& shot) { return shot.exact == exact; }) != nullptr;
  };

  EXPECT_TRUE(becomes(true));
  ASSERT_EQ(post("hold 0 0 0 1 0 0"), 204);
  EXPECT_TRUE(becomes(false));
  EXPECT_TRUE(becomes(true));
}

// Returns the number of threads of this process.
int threadsNow() {
  std::ifstream file("/proc/self/status");
  std::string word;
  while (file >> word && word != "Threads:") {
  }
  int threads = 0;
  file >> threads;
  return threads;
}

// Threads are made when connections need them, and go on to serve others.
TEST_F(Serving, FewConnectionsHaveFewThreads) {
  EXPECT_EQ(watch(3), 3);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(status(root_), 200);

  // Two tracers, the session, the listener, this thread, and one for each connection at a time.
  const int few = 20;
  EXPECT_GT(threadsNow(), 0);
  EXPECT_LT(threadsNow(), few);
}

// A view that nobody has steered fits a page that is narrower than the scene's picture.
TEST_F(Serving, AnUprightPageShowsTheWholeModel) {
  session_->watch(1);
  const auto commandAt = [&](int width, int height) {
    EXPECT_TRUE(say(formatted("size %d %d 1", width, height)));
    // The picture at rest of a page of this size.
    const auto shot = waitFor([&](const Shot& shot) {
      return shot.exact && parseJson(shot.live, "live")["window"] == Json({width, height});
    });
    if (!shot) return std::string("no picture");
    return parseJson(shot->settled, "settled")["command"].get<std::string>();
  };

  EXPECT_FALSE(hasText(commandAt(60, 40), "--eye"));
  const std::string upright = commandAt(20, 40);
  EXPECT_TRUE(hasText(upright, "--eye"));
  EXPECT_FALSE(hasText(commandAt(64, 40), "--eye"));

  // A camera that somebody has chosen stays.
  ASSERT_TRUE(say("camera 1"));
  const std::string chosen = commandAt(20, 44);
  EXPECT_TRUE(hasText(chosen, "--camera=side"));
  EXPECT_FALSE(hasText(chosen, "--eye"));
}

// Pictures of large pages have fewer pixels than these, and panning follows the pointer there, too.
TEST_F(Serving, PanningFollowsThePointer) {
  session_->watch(1);
  // Returns the point that is looked at after these lines; empty: that of the camera.
  const auto pointAfter = [&](const std::string& lines, bool isMoved) {
    EXPECT_TRUE(say(lines));
    std::smatch found;
    std::string command;
    EXPECT_TRUE(waitFor([&](const Shot& shot) {
      command = parseJson(shot.settled, "settled")["command"];
      const bool moved = std::regex_search(command, found, std::regex(" --at=\\S*"));
      return moved == isMoved && parseJson(shot.live, "live")["rests"];
    })) << lines;
    return found.str();
  };
  const auto pannedAt = [&](const std::string& size) {
    pointAfter("home\nsize " + size, false);
    return pointAfter("middle 0 10", true);
  };
  const std::string usual = pannedAt("800 100 1");
  EXPECT_EQ(pannedAt("8000 1000 10"), usual);
}

// A picture of four million pixels is the largest.
TEST_F(Serving, ALargePageGetsItsShape) {
  session_->watch(1);
  EXPECT_TRUE(say("size 4000 4000 1"));
  EXPECT_TRUE(waitFor([](const Shot& shot) {
    return parseJson(shot.live, "live")["window"] == Json({2000, 2000});
  }));
}

// Addresses are printed as browsers and ssh take them.
TEST_F(Serving, ItsPlaceCanBePasted) {
  const auto placeOf = [&](const std::string& bind) {
    const Server server(*session_, ServerOptions{.bind = bind});
    const std::string port = std::to_string(server.port()), place = server.place();
    EXPECT_EQ(server.url(), "http://" + place + "/" + server.token() + "/");
    return place.substr(0, place.size() - port.size());
  };
  EXPECT_EQ(placeOf("127.0.0.1"), "127.0.0.1:");
  EXPECT_EQ(placeOf("0.0.0.0"), "127.0.0.1:");

  // Some machines have no IPv6.
  const int six = ::socket(AF_INET6, SOCK_STREAM, 0);
  sockaddr_in6 loopback{};
  loopback.sin6_family = AF_INET6;
  loopback.sin6_addr = in6addr_loopback;
  const bool hasSix =
      six >= 0 && ::bind(six, reinterpret_cast<sockaddr*>(&loopback), sizeof loopback) == 0;
  ::close(six);
  if (!hasSix) GTEST_SKIP() << "NOT checked: IPv6 is not here";
  EXPECT_EQ(placeOf("::1"), "[::1]:");
  EXPECT_EQ(placeOf("::"), "[::1]:");
}

TEST_F(Serving, HugeRequestsEnd) {
  // Sends the beginning of a request, and then the same bytes again and again.
  const auto flood = [&](const std::string& begin, const std::string& more) {
    const int endless = connection();
    ASSERT_TRUE(send(endless, begin));
    std::size_t sent = 0;
    while (sent < (64u << 20) && send(endless, more)) sent += more.size();
    // Both sides' kernel buffers exceed the server's limit, but are bounded.
    EXPECT_LT(sent, 64u << 20);
    rest(endless);
  };
  flood("GET / HTTP/1.1\r\nHost: localhost\r\n", "X-Many: " + std::string(1000, 'x') + "\r\n");
  flood("POST " + root_ + "input HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n",
        "1000\r\n" + std::string(0x1000, 'x') + "\r\n");

  std::string ranges = "0-0";
  while (ranges.size() < 7900) ranges += ",0-0";
  for (const std::string& request :
       {"GET /" + std::string(1 << 20, 'a') + " HTTP/1.1\r\n\r\n",
        "GET " + root_ + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\nRange: bytes=" +
            ranges + "\r\n\r\n"}) {
    const int huge = connection();
    send(huge, request);
    rest(huge);
  }

  EXPECT_EQ(status(root_), 200);
}

class ServingSoon : public Serving {
 protected:
  ServingSoon() : Serving(0.2) {}
};

TEST_F(ServingSoon, HalfARequestEnds) {
  for (const char* half : {"", "G", "GET / HTTP/1.1\r\nHost: local"}) {
    const int slow = connection();
    send(slow, half);
    char byte = 0;
    ssize_t got = 0;
    while ((got = ::recv(slow, &byte, 1, 0)) > 0) {
    }
    EXPECT_EQ(got, 0) << "the connection was not closed after '" << half << "'";
    ::close(slow);
  }
}

// Connections that send half a request, or nothing, do not keep pictures from a page.
TEST_F(Serving, StrangersDoNotDisplaceAPage) {
  std::atomic<bool> done = false;
  std::atomic<int> drawn = 0;
  std::thread page([&] {
    drawn = watch(60);
    done = true;
  });

  // Before its token has been read, a page is a stranger as well.
  while (!pageDraws_ && !done) pause(1);

  std::vector<int> strangers;
  for (int i = 0; i < 200; ++i) {
    strangers.push_back(connection());
    send(strangers.back(), i % 2 == 0 ? "GET / HTTP/1.1\r\nHost: loc" : "");
  }
  EXPECT_EQ(status(root_), 200);
  page.join();
  EXPECT_EQ(drawn, 60);
  for (const int socket : strangers) ::close(socket);
}

TEST_F(Serving, GarbageEndsItsOwnConnectionOnly) {
  for (const std::string& bytes :
       std::vector<std::string>{std::string("\0\0\0\0\r\n\r\n", 8), "GET\r\n\r\n",
                                std::string(5000, '\xff'), "GET / HTTP/9.9\r\n\r\n", "\r\n\r\n\r\n",
                                "POST / HTTP/1.1\r\nContent-Length: -1\r\n\r\n",
                                "POST / HTTP/1.1\r\nContent-Length: 99999999999999999999\r\n\r\nx",
                                "GET /%zz HTTP/1.1\r\nHost: \xff\r\n\r\n"}) {
    const int socket = connection();
    send(socket, bytes);
    ::shutdown(socket, SHUT_WR);
    const std::string answer = rest(socket);
    EXPECT_FALSE(hasText(answer, "200 OK"));
  }
  EXPECT_EQ(status(root_), 200);
}

TEST_F(Serving, SoManyPagesAndNoMoreAreOpen) {
  std::vector<int> open;
  for (int i = 0; i <= kMostPages; ++i) {
    open.push_back(streaming());
    EXPECT_TRUE(hasText(beginning(open.back()), i < kMostPages ? " 200 " : " 503 ")) << i;
  }
  for (const int socket : open) ::close(socket);
}

// Pages that never read are dropped, and do not keep others from watching meanwhile.
TEST_F(Serving, DeafPagesAreDropped) {
  std::vector<int> deaf;
  for (int i = 0; i < kMostPages - 1; ++i) deaf.push_back(streaming());
  EXPECT_EQ(watch(60), 60);

  // The place of the page that has watched may become free a little later.
  std::string answer;
  for (int i = 0; i < kMostPages && answer.find(" 503 ") == std::string::npos; ++i) {
    deaf.push_back(streaming());
    answer = beginning(deaf.back());
    pause(200);
  }
  EXPECT_TRUE(hasText(answer, " 503 ")) << "there is always another place";

  int drawn = 0;
  const int tries = static_cast<int>(4 * kDeafSeconds);
  for (int i = 0; i < tries && drawn == 0; ++i) {
    pause(500);
    drawn = watch(1);
  }
  EXPECT_EQ(drawn, 1) << "no place has become free";
  for (const int socket : deaf) ::close(socket);
}

}  // namespace
}  // namespace whit::serve
