// whit-view-script: whit-view with one option more, --script FILE, which plays the user; for tests
// and for the pictures of the README.
#define GLFW_INCLUDE_NONE
#include <GL/gl.h>
#include <GLFW/glfw3.h>

#include <algorithm>

#include "command_line/program.h"
#include "core/error.h"
#include "io/files.h"
#include "io/image/image_file.h"
#include "script.h"

namespace whit::view {
namespace {

DisplayImage readWindow() {
  DisplayImage image;
  glfwGetFramebufferSize(glfwGetCurrentContext(), &image.width, &image.height);
  const auto row = static_cast<std::ptrdiff_t>(image.width) * 4;
  image.rgba.resize(static_cast<std::size_t>(row * image.height));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, image.width, image.height, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());

  for (int y = 0; y < image.height / 2; ++y) {  // OpenGL begins at the bottom
    const auto top = image.rgba.begin() + y * row;
    std::swap_ranges(top, top + row, image.rgba.end() - (y + 1) * row);
  }
  return image;
}

class PlayedScript : public ScriptedUser {
 public:
  explicit PlayedScript(const std::string& file)
      : player_(parseScript(readTextFile(file, std::uint64_t{1} << 20), file)) {}

  bool act(bool sharp, Input& input, WindowState& shown) override {
    const ScriptStep step = player_.next(sharp, input);
    GLFWwindow* const window = glfwGetCurrentContext();

    if (step.resize) glfwSetWindowSize(window, step.resize->width, step.resize->height);
    if (step.minimize) glfwIconifyWindow(window);
    if (step.restore) glfwRestoreWindow(window);
    if (!step.tab.empty()) {
      shown.tab = step.tab;
      shown.over = Over::panel;
    }
    if (step.askedSamples) shown.supersample = false;
    if (step.bare) {
      shown.words = false;
      shown.over = Over::nothing;
    }
    survivesErrors_ |= step.showErrors;

    screenshot_ = step.screenshot;
    return !step.quit;
  }
  void drawn() override {
    if (!screenshot_.empty()) writePng(screenshot_, readWindow(), {});
  }
  bool survivesErrors() const override { return survivesErrors_; }

 private:
  ScriptPlayer player_;
  std::string screenshot_;
  bool survivesErrors_ = false;
};

int run(std::vector<std::string> words) {
  const auto option = std::find(words.begin(), words.end(), "--script");
  if (option == words.end()) return runViewer(words);
  if (option + 1 == words.end()) throwUsage("--script expected FILE");
  PlayedScript script(option[1]);
  words.erase(option, option + 2);
  return runViewer(words, &script);
}

}  // namespace
}  // namespace whit::view

int main(int argc, char** argv) {
  return whit::cli::runProgram("whit-view",
                               [&] { return whit::view::run(whit::cli::wordsOf(argc, argv)); });
}
