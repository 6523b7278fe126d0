// Parses JSON texts.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

namespace whit {

using Json = nlohmann::ordered_json;  // members keep the file's order

inline constexpr int kJsonDepthLimit = 64;
inline constexpr std::size_t kJsonMembersLimit = 4096;  // members are looked up one by one
inline constexpr std::uint64_t kJsonBytesLimit = 16u << 20;

// Comments are allowed. Throws badScene with "file:line:column" for a syntax error, with
// "file#/pointer" for a key that is given twice, nesting deeper than kJsonDepthLimit or a number
// beyond double.
Json parseJson(const std::string& text, const std::string& file);

// `token` as a part of a JSON pointer (RFC 6901, section 3).
std::string escapePointer(const std::string& token);

}  // namespace whit
