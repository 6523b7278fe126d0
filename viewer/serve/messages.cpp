#include "viewer/serve/messages.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/option_table.h"
#include "core/text.h"

namespace whit::serve {

namespace {

[[noreturn]] void fail(std::size_t line, const std::string& expected) {
  throwUsage("line " + std::to_string(line) + " of the input: expected " + expected);
}

// Removes the first word of the line and the blank behind it.
std::string takeWord(std::string_view& line) {
  const std::size_t end = std::min(line.find(' '), line.size());
  std::string word(line.substr(0, end));
  line.remove_prefix(std::min(end + 1, line.size()));
  return word;
}

Message readMessage(std::string_view line, std::size_t number) {
  const bool plain =
      std::ranges::none_of(line, [](char c) { return c >= 0 && (c < ' ' || c > '~'); });
  if (!plain || line.size() > kMessageBytes) fail(number, "no control characters");

  const std::string word = takeWord(line);
  const auto* const verb = std::ranges::find(kVerbs, std::string_view(word), &Verb::name);
  if (verb == kVerbs.end()) fail(number, "a verb, as 'left 3 -4'");

  Message message{.verb = verb->name, .name = {}, .text = {}};
  if (verb->named) message.name = takeWord(line);
  for (std::size_t i = 0; i < verb->numbers; ++i) {
    double& value = message.numbers[i];
    const bool read =
        readNumber(takeWord(line), value) && value >= verb->low && value <= verb->high;

    if (!read) {
      fail(number, formatted("%zu numbers from %g to %g after '%s'", verb->numbers, verb->low,
                             verb->high, word.c_str()));
    }
  }

  if (verb->text) message.text = std::exchange(line, std::string_view());
  if (!line.empty()) fail(number, "nothing more after '" + word + "'");
  return message;
}

}  // namespace

std::vector<Message> readMessages(std::string_view body) {
  if (body.size() > kMessageBytes) throwUsage("the input is longer than it may be");

  std::vector<Message> messages;
  while (!body.empty()) {
    if (messages.size() == kMessageLines) throwUsage("the input has more lines than it may have");
    const std::size_t end = std::min(body.find('\n'), body.size());
    messages.push_back(readMessage(body.substr(0, end), messages.size() + 1));
    body.remove_prefix(std::min(end + 1, body.size()));
  }
  return messages;
}

}  // namespace whit::serve
