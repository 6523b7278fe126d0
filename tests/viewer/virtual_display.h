// A display without a screen, and the viewer run on it.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "cli/run_program.h"

namespace whit::view {

// Runs Xvfb for as long as the object lives. `name` is empty when there is no Xvfb on this machine.
class VirtualDisplay {
 public:
  VirtualDisplay() {
    int ends[2];
    if (pipe(ends) != 0) return;

    child_ = fork();
    if (child_ == 0) {
      close(ends[0]);
      const int nowhere = open("/dev/null", O_WRONLY);
      dup2(nowhere, STDERR_FILENO);
      const std::string number = std::to_string(ends[1]);
      // Xvfb must not reset itself between the end of one viewer and the beginning of the next.
      execlp("Xvfb", "Xvfb", "-noreset", "-displayfd", number.c_str(), "-screen", "0", "800x600x24",
             "-nolisten", "tcp", static_cast<char*>(nullptr));
      _exit(127);
    }

    close(ends[1]);
    // Xvfb writes its number once it listens; without Xvfb the pipe just closes.
    std::string number;
    for (char c; read(ends[0], &c, 1) == 1 && c != '\n';) number += c;
    close(ends[0]);
    if (!number.empty()) name_ = ":" + number;
  }
  ~VirtualDisplay() {
    if (child_ < 0) return;  // kill(-1) would end every process of the user
    kill(child_, SIGTERM);
    cli::waitFor(child_);
  }
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;

  const std::string& name() const { return name_; }

 private:
  pid_t child_ = -1;
  std::string name_;
};

// Runs a program, words[0], in `folder` with DISPLAY set, or unset when `display` is empty. The
// program is ended after three minutes, with status -14.
inline cli::Outcome runOn(const std::string& display, const std::string& folder,
                          const std::vector<std::string>& words) {
  const auto prepare = [&] {
    alarm(180);
    unsetenv("WAYLAND_DISPLAY");
    unsetenv("DISPLAY");
    if (!display.empty()) setenv("DISPLAY", display.c_str(), 1);
    setenv("XDG_CONFIG_HOME", folder.c_str(), 1);  // not the user's settings
    if (chdir(folder.c_str()) != 0) _exit(126);
  };
  return cli::runWhit({words.begin() + 1, words.end()}, prepare, words[0].c_str());
}

// Runs a command that the viewer has printed, as a shell would, in `folder`.
inline void paste(const std::string& command, const std::string& folder) {
  ASSERT_EQ(command.rfind("whit render ", 0), 0u) << command;
  const std::string line = WHIT_PROGRAM + command.substr(4);
  const cli::Outcome outcome = runOn("", folder, {"/bin/sh", "-c", line});
  ASSERT_EQ(outcome.status, 0) << line << "\n" << outcome.err;
}

}  // namespace whit::view
