// --budget and --target as users run them.
#include "run_command.h"

namespace whit::cli {
namespace {

class BudgetCommands : public TinySceneTest {};

// The last line of the receipt is a command, which makes the same pixels. Behind "--" no option is
// read.
TEST_F(BudgetCommands, PrintTheCommandOfTheSamePicture) {
  for (const std::string option : {"--budget=80ms", "--target 1.5codes"}) {
    const std::string said =
        succeed("render --depth 3 -o \"a b.exr\" " + option + " -- tiny.json").err;
    const std::string picture = bytesOf("a b.exr");

    const std::string begin = "the same picture: whit ";
    const std::size_t at = said.find(begin);
    ASSERT_NE(at, std::string::npos) << said;
    const std::size_t first = at + begin.size();
    const std::string command = said.substr(first, said.find('\n', at) - first);
    EXPECT_FALSE(hasText(command, option));
    EXPECT_TRUE(hasText(command, "--depth 3"));
    EXPECT_TRUE(command.ends_with(" 'a b.exr' -- tiny.json")) << command;

    // A shell reads the quotation marks.
    std::filesystem::remove(folder_ / "a b.exr");
    const std::string enter = "cd " + folder_.path().string() + "; ";
    ASSERT_EQ(std::system((enter + WHIT_PROGRAM " " + command + " 2> /dev/null").c_str()), 0)
        << command;
    EXPECT_EQ(bytesOf("a b.exr"), picture);
  }
}

}  // namespace
}  // namespace whit::cli
