#include "viewer/file_dialog.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include "core/error.h"

extern char** environ;

namespace whit::view {

namespace {

#define WHIT_SCENE_FILES "*.json *.gltf *.glb *.obj *.ply"
#define WHIT_SKY_FILES "*.hdr *.exr"

using CommandWords = std::array<const char*, 7>;  // null at the end

constexpr CommandWords kZenity[] = {
    {"zenity", "--file-selection", "--title=whit: open a scene, a model or a sky",
     "--file-filter=Scenes, models and skies | " WHIT_SCENE_FILES " " WHIT_SKY_FILES,
     "--file-filter=All files | *", nullptr},
    {"zenity", "--file-selection", "--title=whit: the image of a sky",
     "--file-filter=Skies | " WHIT_SKY_FILES, "--file-filter=All files | *", nullptr}};
constexpr CommandWords kKdialog[] = {
    {"kdialog", "--title", "whit: open a scene, a model or a sky", "--getopenfilename", ".",
     WHIT_SCENE_FILES " " WHIT_SKY_FILES "|Scenes, models and skies", nullptr},
    {"kdialog", "--title", "whit: the image of a sky", "--getopenfilename", ".",
     WHIT_SKY_FILES "|Skies", nullptr}};

#undef WHIT_SCENE_FILES
#undef WHIT_SKY_FILES

// What a process begins with: nothing to read, its output into a pipe, its complaints nowhere.
class Streams {
 public:
  explicit Streams(int output) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions_, output, STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  }
  ~Streams() { posix_spawn_file_actions_destroy(&actions_); }
  Streams(const Streams&) = delete;
  Streams& operator=(const Streams&) = delete;

  const posix_spawn_file_actions_t* actions() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

}  // namespace

FileDialog::~FileDialog() {
  if (!isOpen()) return;
  ::kill(child_, SIGTERM);
  ::waitpid(child_, nullptr, 0);
  close();
}

// False: this program is not there.
bool FileDialog::start(const char* const* words) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    throwIo(std::string("cannot open a file dialog: ") + std::strerror(errno));
  }
  ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
  const Streams streams(ends[1]);
  pid_t child = -1;
  // execve() changes none of the words.
  const int error = ::posix_spawnp(&child, words[0], streams.actions(), nullptr,
                                   const_cast<char* const*>(words), environ);
  ::close(ends[1]);
  if (error != 0) {
    ::close(ends[0]);
    return false;
  }
  child_ = child;
  output_ = ends[0];
  text_.clear();
  return true;
}

void FileDialog::open(Wanted wanted) {
  if (isOpen()) return;
  wanted_ = wanted;
  const auto which = static_cast<std::size_t>(wanted);
  if (start(kZenity[which].data()) || start(kKdialog[which].data())) return;
  throwUsage(
      "there is no dialog to choose a file with: install zenity or kdialog (apt-get install "
      "zenity), or drop a file on the window");
}

void FileDialog::readOn() {
  constexpr std::size_t kMost = std::size_t{1} << 16;  // of a path
  std::array<char, 4096> block;
  for (;;) {
    const ssize_t n = ::read(output_, block.data(), block.size());
    if (n <= 0 || text_.size() > kMost) return;
    text_.append(block.data(), static_cast<std::size_t>(n));
  }
}

void FileDialog::close() {
  ::close(output_);
  child_ = output_ = -1;
}

std::optional<std::string> FileDialog::takeChosen() {
  if (!isOpen()) return std::nullopt;
  readOn();
  int status = 0;
  if (::waitpid(child_, &status, WNOHANG) != child_) return std::nullopt;
  readOn();  // what came before its end
  close();
  constexpr int kCancelled = 1;
  if (WIFEXITED(status) && WEXITSTATUS(status) == kCancelled) return std::nullopt;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throwIo("the dialog to choose a file has failed; files dropped on the window open as well");
  }
  std::string file = std::exchange(text_, std::string());
  if (file.ends_with('\n')) file.pop_back();
  if (file.empty()) return std::nullopt;
  return file;
}

}  // namespace whit::view
