// The exit status and the message that each kind of exception gives.
#include "core/error.h"

#include <gtest/gtest.h>

#include <memory>
#include <new>
#include <system_error>
#include <vector>

namespace whit {
namespace {

TEST(FailureOf, GivesEachExceptionItsStatus) {
  struct Row {
    std::shared_ptr<std::exception> thrown;
    ExitStatus status;
    std::string what;
  };
  const auto system = [](std::errc code) {
    return std::make_shared<std::system_error>(std::make_error_code(code));
  };
  const Row rows[] = {
      {std::make_shared<Error>(ExitStatus::usage, "wrong word"), ExitStatus::usage, "wrong word"},
      {std::make_shared<Error>(ExitStatus::io, "no file"), ExitStatus::io, "no file"},
      {std::make_shared<std::bad_alloc>(), ExitStatus::limit, "out of memory"},
      {std::make_shared<std::bad_array_new_length>(), ExitStatus::limit, "out of memory"},
      {system(std::errc::resource_unavailable_try_again), ExitStatus::limit,
       "cannot start another thread: "},
      {system(std::errc::permission_denied), ExitStatus::checkFailed, ""},
      {std::make_shared<std::runtime_error>("odd"), ExitStatus::checkFailed, "odd"}};

  for (const Row& row : rows) {
    const Failure failure = failureOf(*row.thrown);
    EXPECT_EQ(failure.status, row.status) << row.thrown->what();
    EXPECT_TRUE(failure.what.starts_with(row.what)) << failure.what;
  }
}

// The place of an error is found in its text.
TEST(ThrowBadScene, KnowsItsPlace) {
  struct Row {
    const char *where, *file, *place;
  };
  for (const Row& row : {Row{"a#b.json#/lights/0", "a#b.json", "/lights/0"},
                         {"a.json#", "a.json", ""},
                         {"a.png: byte 12", "a.png", "byte 12"},
                         {"scene: light 'lamp'", "", "light 'lamp'"},
                         {"a.obj:12:5", "a.obj", "12:5"},
                         {"a.obj", "a.obj", ""}}) {
    try {
      throwBadScene(row.where, "expected a number, found 'x'");
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), ExitStatus::badScene);
      EXPECT_EQ(error.place().file, row.file) << row.where;
      EXPECT_EQ(error.place().place, row.place) << row.where;
      EXPECT_EQ(error.place().expected, "a number") << row.where;
      EXPECT_EQ(std::string(error.what()),
                std::string(row.where) + ": expected a number, found 'x'");
    }
  }
}

}  // namespace
}  // namespace whit
