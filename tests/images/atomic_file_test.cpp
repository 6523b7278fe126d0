// Files appear whole or not at all.
#include "io/files.h"

#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <functional>

#include "image_samples.h"

namespace whit {
namespace {

namespace fs = std::filesystem;

class AtomicFileTest : public ImageTest {
 protected:
  std::string text(const std::string& name) {
    const Bytes bytes = load(path(name));
    return {bytes.begin(), bytes.end()};
  }
  // Expects a link to lead what is written to this file.
  void expectFollowed(const std::string& target) {
    writeTextFile(path("link.txt"), "new");
    EXPECT_TRUE(fs::is_symlink(path("link.txt")));
    EXPECT_EQ(text(target), "new");
  }
};

// Every write of a file beyond `bytes` fails, as on a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    handler_ = signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST_F(AtomicFileTest, AppearsAtCommit) {
  {
    AtomicFile file(path("a.txt"));
    EXPECT_NE(file.temporaryPath(), path("a.txt"));
    EXPECT_EQ(fs::path(file.temporaryPath()).parent_path(), folder_);
    std::ofstream(file.temporaryPath()) << "text";
    EXPECT_FALSE(fs::exists(path("a.txt")));
    file.commit();
    EXPECT_EQ(text("a.txt"), "text");
  }
  EXPECT_EQ(filesInFolder(), 1u);
}

TEST_F(AtomicFileTest, WithoutCommitTheOldFileStays) {
  writeTextFile(path("a.txt"), "old");
  {
    AtomicFile file(path("a.txt"));
    std::ofstream(file.temporaryPath()) << "new";
  }
  EXPECT_EQ(text("a.txt"), "old");
  EXPECT_EQ(filesInFolder(), 1u);
}

TEST_F(AtomicFileTest, TwoAtOnceDoNotMeet) {
  AtomicFile one(path("a.txt")), two(path("a.txt"));
  EXPECT_NE(one.temporaryPath(), two.temporaryPath());
}

TEST_F(AtomicFileTest, ReplacesAndHonoursTheUmask) {
  const mode_t mask = umask(027);
  writeTextFile(path("a.txt"), "one");
  umask(mask);
  writeTextFile(path("b.txt"), std::string("two\0three", 9));
  EXPECT_EQ(fs::status(path("a.txt")).permissions(), fs::perms(0640));
  EXPECT_EQ(text("b.txt"), std::string("two\0three", 9));
}

TEST_F(AtomicFileTest, NamesAsLongAsTheFileSystemAllows) {
  const std::string name = std::string(251, 'n') + ".txt";
  writeTextFile(path(name), "x");
  EXPECT_EQ(text(name), "x");
}

TEST_F(AtomicFileTest, LinksAreFollowed) {
  writeTextFile(path("target.txt"), "old");
  fs::create_symlink(path("target.txt"), path("link.txt"));
  expectFollowed("target.txt");
}

TEST_F(AtomicFileTest, LinksToFilesThatAreNotThereAreFollowed) {
  fs::create_directory(path("sub"));
  fs::create_symlink("sub/next.txt", path("link.txt"));
  fs::create_symlink("target.txt", path("sub/next.txt"));
  expectFollowed("sub/target.txt");
}

// A rename needs no permission to write to the file.
TEST_F(AtomicFileTest, ProtectedFilesStay) {
  writeTextFile(path("a.txt"), "old");
  fs::permissions(path("a.txt"), fs::perms(0444));
  fs::permissions(folder_, fs::perms::all);
  const auto write = [&] {
    constexpr uid_t kNobody = 65534;  // root may write to all files
    if (geteuid() == 0 && setuid(kNobody) != 0) _exit(1);
    _exit(static_cast<int>(statusOf([&] { writeTextFile(path("a.txt"), "new"); })));
  };
  EXPECT_EXIT(write(), testing::ExitedWithCode(static_cast<int>(ExitStatus::io)), "");
  EXPECT_EQ(text("a.txt"), "old");
}

TEST_F(AtomicFileTest, DevicesAreWrittenStraight) {
  writeTextFile("/dev/null", "text");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_EQ(statusOf([] { writeTextFile("/dev/full", "text"); }), ExitStatus::io);
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(AtomicFileTest, FoldersThatCannotBeWrittenAreErrors) {
  // Nobody may create files in /proc, not even root.
  for (const std::string& file :
       {path("absent/a.txt"), folder_, std::string(), std::string("/proc/a.txt")}) {
    EXPECT_EQ(statusOf([&] { AtomicFile{file}; }), ExitStatus::io) << file;
  }
  EXPECT_EQ(statusOf([&] { writePng("/proc/a.png", {1, 1, {1, 2, 3, 255}}, {}); }), ExitStatus::io);
  EXPECT_EQ(statusOf([&] { writeExr("/proc/a.exr", Image(1, 1), {}); }), ExitStatus::io);
}

// The limits go from nothing to nearly everything, so that headers, pixels and the tables written
// on closing are each the first thing that no longer fits.
TEST_F(AtomicFileTest, AFullDiskLeavesNothingBehind) {
  const Image image(40, 40);
  const DisplayImage display{40, 40, Bytes(6400, 90)};

  const std::function<void()> writes[] = {[&] { writeExr(path("a"), image, {}); },
                                          [&] { writePng(path("a"), display, {}); },
                                          [&] { writeTextFile(path("a"), "more than ten"); }};
  const auto statusAt = [](rlim_t bytes, const std::function<void()>& write) {
    const FullDisk full(bytes);
    return statusOf(write);
  };

  for (const auto& write : writes) {
    write();
    const std::uintmax_t whole = fs::file_size(path("a"));
    fs::remove(path("a"));
    for (rlim_t bytes = 0; bytes < whole; bytes += whole / 64 + 1) {
      EXPECT_EQ(statusAt(bytes, write), ExitStatus::io) << bytes;
    }

    EXPECT_EQ(filesInFolder(), 0u);
    // With a limit of exactly its size the file is written.
    EXPECT_EQ(statusAt(whole, write), ExitStatus::done);
    fs::remove(path("a"));
  }
}

}  // namespace
}  // namespace whit
