// Reports: the page that draws itself from JSON, and tables as CSV.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace whit {

using Json = nlohmann::ordered_json;

// Returns an array of objects with equal keys as CSV, with the keys of the first object as header.
// Null is an empty field, true is "yes", and a number has seven digits.
std::string csvOf(const Json& rows);

// Returns the page report.html with `data` in it; "report" of the data is "accuracy", "effects" or
// "verify". The page loads nothing from elsewhere.
std::string reportPage(const Json& data);

// Returns a page with `data` in place of its "{{data}}", which is the text of a script element.
std::string pageWith(std::string_view html, const Json& data);

std::string base64(std::string_view bytes);

}  // namespace whit
