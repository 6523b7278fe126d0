// What commands print as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "run_command.h"

namespace whit::cli {

using Json = nlohmann::json;

// Runs a command with --json -, which must end with this status, and returns what it prints.
inline Json jsonOf(const Words& words, int status = 0) {
  const Outcome outcome = runWhit(joined(words, {"--json", "-"}));
  EXPECT_EQ(outcome.status, status) << testing::PrintToString(words) << outcome.err;
  Json json = Json::parse(outcome.out, nullptr, false);
  EXPECT_FALSE(json.is_discarded()) << outcome.out;
  return json;
}

}  // namespace whit::cli
