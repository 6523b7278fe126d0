// whit-view: the viewer.
#include "command_line/program.h"
#include "viewer/app.h"

int main(int argc, char** argv) {
  return whit::cli::runProgram(
      "whit-view", [&] { return whit::view::runViewer(whit::cli::wordsOf(argc, argv)); });
}
