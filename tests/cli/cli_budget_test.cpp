// --budget and --target as users run them.
#include <gtest/gtest.h>

#include <sstream>

#include "has_text.h"
#include "run_command.h"

namespace whit::cli {
namespace {

// The last line of the receipt is a command, which makes the same pixels.
TEST(BudgetCommands, PrintTheCommandOfTheSamePicture) {
  for (const std::string option : {"--budget=80ms", "--target=1.5codes"}) {
    const TemporaryFolder folder;
    const Outcome outcome = succeed(
        {"render", writeTinyScene(folder), option, "-o", folder / "a b.exr", "--depth", "3"});

    // The command is the last line of the receipt.
    const std::string begin = "the same picture: whit ";
    const std::size_t at = outcome.err.find(begin);
    ASSERT_NE(at, std::string::npos) << outcome.err;
    const std::size_t first = at + begin.size();
    const std::string command = outcome.err.substr(first, outcome.err.find('\n', at) - first);
    EXPECT_FALSE(hasText(command, option));
    EXPECT_TRUE(hasText(command, "--depth 3"));
    EXPECT_TRUE(hasText(command, "a b.exr'"));

    // The command writes to the same file, so the first picture is kept as a copy.
    std::filesystem::copy_file(folder / "a b.exr", folder / "first.exr");
    ASSERT_EQ(std::system((WHIT_PROGRAM " " + command + " --quiet").c_str()), 0) << command;
    succeed({"compare", folder / "first.exr", folder / "a b.exr", "--tolerance", "0", "--quiet"});
    EXPECT_EQ(readFile(folder / "first.exr"), readFile(folder / "a b.exr"));
  }
}

}  // namespace
}  // namespace whit::cli
