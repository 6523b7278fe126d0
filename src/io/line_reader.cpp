#include "io/line_reader.h"

#include <charconv>
#include <cstdlib>
#include <limits>

namespace whit {

const char* parseNumber(const char* from, const char* end, double& value) {
  if (from != end && *from == '+') ++from;
  const auto [rest, error] = std::from_chars(from, end, value);
  if (error == std::errc::invalid_argument) return nullptr;
  // from_chars() leaves the value unset beyond the range of double; strtod() gives infinity or 0.
  if (error != std::errc()) value = std::strtod(std::string(from, rest).c_str(), nullptr);
  return rest;
}

int LineReader::continuation(const char* p) const {
  if (p == end_ || *p != '\\') return 0;
  if (p[1] == '\r' && p[2] == '\n') return 3;
  return p[1] == '\n' || p[1] == '\r' ? 2 : 0;
}

bool LineReader::isWordEnd(const char* p) const {
  return isLineEnd(p) || *p == ' ' || *p == '\t' || *p == '#' || continuation(p) > 0;
}

void LineReader::skipBlanks() {
  for (;;) {
    while (*at_ == ' ' || *at_ == '\t') ++at_;

    // A backslash at the end of a line joins it with the next one.
    const int hidden = continuation(at_);
    if (hidden == 0) return;
    at_ += hidden;
    ++line_;
  }
}

void LineReader::nextLine() {
  while (!isLineEnd(at_)) ++at_;
  if (at_ == end_) return;
  at_ += *at_ == '\r' && at_[1] == '\n' ? 2 : 1;
  ++line_;
}

bool LineReader::hasMore() {
  skipBlanks();
  return !isLineEnd(at_) && *at_ != '#';
}

std::string_view LineReader::word() {
  skipBlanks();
  const char* const from = at_;
  while (!isLineEnd(at_) && *at_ != ' ' && *at_ != '\t') ++at_;
  return {from, at_};
}

std::string_view LineReader::rest() {
  skipBlanks();
  const char* const from = at_;
  while (!isLineEnd(at_)) ++at_;

  const char* to = at_;
  while (to != from && (to[-1] == ' ' || to[-1] == '\t')) --to;
  return {from, to};
}

bool LineReader::number(double& value) {
  skipBlanks();
  const char* const after = parseNumber(at_, end_, value);
  if (after == nullptr || !isWordEnd(after)) return false;
  at_ = after;
  return true;
}

std::int32_t LineReader::integer() {
  std::int32_t value = 0;
  const auto [rest, error] = std::from_chars(at_, end_, value);
  at_ = rest;
  return error == std::errc::result_out_of_range ? std::numeric_limits<std::int32_t>::max() : value;
}

bool LineReader::take(char c) {
  const bool taken = *at_ == c && at_ != end_;
  at_ += taken;
  return taken;
}

bool LineReader::finishWord() {
  const char* const from = at_;
  while (!isWordEnd(at_)) ++at_;
  return at_ == from;
}

}  // namespace whit
