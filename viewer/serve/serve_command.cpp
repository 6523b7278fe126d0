// whit serve: the viewer in a browser.
#include <unistd.h>
#include <cstdio>

#include "command_line/progress_bar.h"
#include "core/error.h"
#include "output/open_and_warn.h"
#include "viewer/session/session.h"
#ifdef WHIT_SERVE
#include "viewer/serve/server.h"
#endif

namespace whit::serve {

namespace {

constexpr const char* kServeUsage = "whit serve [SCENE] [options]";
constexpr const char* kServeSummary =
    "Shows the viewer in a browser: prints an address to open. Where there is no browser, forward "
    "the port over ssh, as the second line says. Control-C ends it.";

struct ServeJob {
  view::ViewOptions view;
  std::vector<std::string> scenes;
  std::string bind = "127.0.0.1";
  int port = 0;
};

cli::OptionList listOptions(ServeJob& job) {
  cli::OptionList list;
  list.group("Serving");

  list.value({"port", "N", 0, 65535}, "the port; 0 is 8765, or any free one if that is taken",
             job.port);
  list.value(
      {"bind", "ADDRESS"},
      "the address to listen on; others than 127.0.0.1 and ::1 can be reached from elsewhere",
      job.bind);

  view::listViewOptions(list, job.view);
  list.operands(
      "SCENE",
      "a scene file, a model, or the name of a shipped scene (default: choose in the page)", 0, 1,
      job.scenes);
  return list;
}

#ifdef WHIT_SERVE
int serve(const ServeJob& job) {
  auto progress = cli::makeProgressBar(job.view.common);
  const std::string& name = job.view.scene;
  std::shared_ptr<OpenScene> scene;
  if (!name.empty()) scene = openAndWarn(name, job.view.common, progress.get());

  ServedSession session(job.view, scene);
  progress.reset();

  // An IPv6 address may be in brackets, as in an URL.
  std::string bind = job.bind;
  if (bind.starts_with('[') && bind.ends_with(']')) bind = bind.substr(1, bind.size() - 2);
  Server server(session, {bind, job.port});

  // Standard output gets the address only, so that scripts can read it.
  std::printf("%s\n", server.url().c_str());
  std::fflush(stdout);

  char machine[256] = "MACHINE";
  ::gethostname(machine, sizeof machine - 1);
  if (!job.view.common.quiet) {
    // Shells would expand the brackets of an IPv6 address without the quotes.
    std::fprintf(stderr,
                 "Open this address in a browser. From another machine, first: "
                 "ssh -L '%d:%s' %s\nand then open http://localhost:%d/%s/\n",
                 server.port(), server.place().c_str(), machine, server.port(),
                 server.token().c_str());
  }
  server.run();
  return 0;
}
#else
[[noreturn]] int serve(const ServeJob& /*job*/) {
  throwUsage(
      "this build of whit cannot serve, because cpp-httplib was missing when it was made: install "
      "libcpp-httplib-dev and build again");
}
#endif

// Throws if options belong to a scene and none is named, because the page would open its scene
// without them.
void checkScene(const ServeJob& job) {
  const cli::CommonOptions& common = job.view.common;
  const Instant& instant = common.load.instant;
  const bool areOfView =
      common.given.contains("camera") || common.ground || common.azimuth || common.zoom;
  const bool areOfTime = instant.seconds || !instant.animation.empty();
  refuseIf(job.scenes.empty() && (areOfView || areOfTime || !common.load.settings.empty()),
           "expected SCENE, because --animation, --azimuth, --camera, --ground, --set, --time and "
           "--zoom belong to a scene");
}

}  // namespace

int serveCommand(const std::vector<std::string>& words);

int serveCommand(const std::vector<std::string>& words) {
  ServeJob job;
  if (!cli::parseOptions(kServeUsage, kServeSummary, listOptions(job), words)) return 0;
  checkScene(job);
  view::settleViewOptions(job.view);
  if (!job.scenes.empty()) job.view.scene = job.scenes[0];
  return serve(job);
}

}  // namespace whit::serve
