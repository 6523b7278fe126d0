// The viewer of a scene in a browser, served by the running process.
#pragma once

#include <sys/types.h>
#include <unistd.h>

#include <atomic>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "library/whit.h"

namespace whit::python {

// Options and their values, as on the command line.
using OptionTexts = std::vector<std::pair<std::string, std::string>>;

// Its functions are called without the GIL, from any thread.
class View {
 public:
  // Serves a copy of the renderer's scene, with the options of its picture. `port` as of Server.
  View(api::Renderer& renderer, const OptionTexts& options, int port);
  ~View() { close(); }
  View(const View&) = delete;
  View& operator=(const View&) = delete;

  const std::string& url() const { return url_; }
  // Returns the picture of the page at full resolution. Throws Error once the view is closed.
  std::string png() const;
  // Ends the server and its threads; a forked process, which has no such threads, only forgets it.
  void close();

 private:
  struct Served;
  std::atomic<std::shared_ptr<Served>> served_;
  std::string url_;
  const pid_t process_ = getpid();
};

}  // namespace whit::python
