#include "io/scene/json_text.h"

#include <algorithm>
#include <unordered_set>
#include <vector>

#include "core/error.h"

namespace whit {
namespace {

using Event = Json::parse_event_t;

// Refuses texts that the parser itself would accept: repeated keys, deep nesting, too many members.
class Watcher {
 public:
  explicit Watcher(std::string file) : file_(std::move(file)) {}

  bool operator()(int, Event event, Json& parsed) {
    switch (event) {
      case Event::object_start:
      case Event::array_start:
        push(event == Event::array_start);
        break;
      case Event::object_end:
      case Event::array_end:
        levels_.pop_back();
        valueEnds();
        break;
      case Event::key:
        key(parsed.get<std::string>());
        break;
      case Event::value:
        valueEnds();
        break;
    }
    return true;
  }

  // The value that is being parsed, as file#/pointer.
  std::string where() const {
    std::string pointer = file_ + "#";
    for (const Level& level : levels_) {
      pointer += '/' + (level.isArray ? std::to_string(level.index) : escapePointer(level.key));
    }
    return pointer;
  }

 private:
  struct Level {
    bool isArray = false;
    std::size_t index = 0;  // arrays
    std::string key;        // objects
    std::unordered_set<std::string> keys;
  };

  void push(bool isArray) {
    if (levels_.size() >= kJsonDepthLimit) {
      throwBadScene(where(), "nested deeper than " + std::to_string(kJsonDepthLimit) + " levels");
    }
    levels_.emplace_back();
    levels_.back().isArray = isArray;
  }
  void valueEnds() {
    if (!levels_.empty()) ++levels_.back().index;
  }
  void key(const std::string& name) {
    Level& level = levels_.back();
    level.key = name;
    if (!level.keys.insert(name).second) throwBadScene(where(), "this key is given twice");
    if (level.keys.size() > kJsonMembersLimit) {
      throwBadScene(where(), "more than " + std::to_string(kJsonMembersLimit) + " members");
    }
  }

  std::string file_;
  std::vector<Level> levels_;
};

std::string placeOfByte(const std::string& text, const std::string& file, std::size_t byte) {
  const std::size_t end = std::min(byte > 0 ? byte - 1 : 0, text.size());
  const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), '\n');
  const std::size_t lineStart = end == 0 ? std::string::npos : text.rfind('\n', end - 1);
  const std::size_t column = lineStart == std::string::npos ? end + 1 : end - lineStart;
  return file + ":" + std::to_string(line + 1) + ":" + std::to_string(column);
}

// Without the library's own "[json.exception...] parse error at line ...: ".
std::string reason(const std::string& message) {
  const std::size_t column = message.find(", column ");
  const std::size_t colon = message.find(": ", column == std::string::npos ? 0 : column);
  return colon == std::string::npos ? message : message.substr(colon + 2);
}

}  // namespace

Json parseJson(const std::string& text, const std::string& file) {
  Watcher watcher(file);
  const auto watch = [&](int depth, Event event, Json& parsed) {
    return watcher(depth, event, parsed);
  };
  try {
    return Json::parse(text, watch, /*allow_exceptions=*/true, /*ignore_comments=*/true);
  } catch (const Json::parse_error& error) {
    throwBadScene(placeOfByte(text, file, error.byte), reason(error.what()));
  } catch (const Json::out_of_range&) {  // thrown by the parser for such a number alone
    throwBadScene(watcher.where(), "expected a number that a double can hold");
  }
}

std::string escapePointer(const std::string& token) {
  std::string result;
  for (const char c : token) {
    if (c == '~') {
      result += "~0";
    } else if (c == '/') {
      result += "~1";
    } else {
      result += c;
    }
  }
  return result;
}

}  // namespace whit
