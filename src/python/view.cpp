#ifdef WHIT_SERVE
#include "python/view.h"

#include <chrono>
#include <thread>

#include "core/option_table.h"
#include "library/internal.h"
#include "viewer/serve/server.h"

namespace whit::python {

namespace {

view::ViewOptions viewOptions(const OpenScene& open, const OptionTexts& options) {
  view::ViewOptions all;
  all.scene = open.source.name;
  cli::CommonOptions& common = all.common;
  common.quiet = true;
  common.warns = false;  // the scene has warned when it was opened

  for (const auto& [name, value] : options) {
    setOption(common.render, name, value);
    common.given.insert(name);
  }

  applyQuality(common.render, common.given);
  view::settleViewOptions(all);
  common.load = open.load;

  // The page shows the scene as it stands; it plays only on request.
  if (!open.scene.motion.empty() && !common.load.instant.seconds) {
    common.load.instant.seconds = 0;
  }
  return all;
}

}  // namespace

struct View::Served {
  Served(const std::shared_ptr<OpenScene>& open, const OptionTexts& texts, int port)
      : options(viewOptions(*open, texts)),
        session(options, open),
        server(session, {.port = port, .framed = true}),
        thread([this] { server.run(); }) {
    // Until the server runs, stop() would have no effect.
    while (!server.isRunning()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ~Served() {
    session.quit();  // a download would be waited for
    server.stop();
    thread.join();
  }
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;

  const view::ViewOptions options;
  serve::ServedSession session;
  serve::Server server;
  std::thread thread;
};

View::View(api::Renderer& renderer, const OptionTexts& options, int port)
    : served_(api::guarded(
          [&] { return std::make_shared<Served>(api::SceneCopy::of(renderer), options, port); })),
      url_(served_.load()->server.url()) {}

std::string View::png() const {
  return api::guarded([&] {
    const std::shared_ptr<Served> served = served_.load();
    if (!served || process_ != getpid()) throwUsage("the view is closed");

    std::string png = served->session.download(false).bytes;
    if (png.empty()) {
      throwIo("the picture of the view takes too long or is closed: close() it, and use render()");
    }
    return png;
  });
}

void View::close() {
  std::shared_ptr<Served> served = served_.exchange(nullptr);
  if (process_ != getpid()) {
    // The copy leaks, because a forked child does not have the threads of the server.
    new std::shared_ptr<Served>(std::move(served));
  } else if (served) {
    served->session.quit();  // png() on another thread may hold it for a little longer
    served->server.stop();
  }
}

}  // namespace whit::python
#endif
