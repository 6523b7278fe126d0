// The JSON that a report of whit has in it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace whit {

inline nlohmann::ordered_json embeddedData(const std::string& page) {
  const std::string begin = "<script type=\"application/json\" id=\"data\">";
  const std::size_t from = page.find(begin) + begin.size();
  return nlohmann::ordered_json::parse(page.substr(from, page.find("</script>", from) - from));
}

}  // namespace whit
