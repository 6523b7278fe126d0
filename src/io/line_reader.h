// Text files made of lines that begin with a keyword (OBJ, MTL), read word by word.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/text.h"

namespace whit {

// Reads the decimal number at `from`: also "nan", "inf" and a leading "+". Numbers beyond double
// become infinite or 0. Returns the first character after the number, nullptr where none begins.
const char* parseNumber(const char* from, const char* end, double& value);

// Lines end with "\n", "\r\n" or "\r"; a backslash at the end of a line continues it. Errors and
// warnings name the line by place().
class LineReader {
 public:
  // Begins at the character `start`, which is in the given line. `text` and `file` must outlive the
  // reader.
  LineReader(const std::string& text, const std::string& file, std::size_t start = 0,
             std::uint64_t line = 1)
      : text_(text),
        at_(text.data() + start),
        end_(text.data() + text.size()),
        file_(file),
        line_(line) {}

  bool done() const { return at_ == end_; }
  void nextLine();
  // Goes to where another reader of this text is.
  void goTo(const LineReader& other) {
    at_ = other.at_;
    line_ = other.line_;
  }
  std::string place() const { return concat(file_, ":", line_); }
  std::uint64_t line() const { return line_; }
  std::size_t at() const { return at_ - text_.data(); }

  // All of the following read within the current line. True if there is another word before the end
  // of the line or a comment.
  bool hasMore();

  // Returns the next word, which is empty at the end of the line.
  std::string_view word();

  // Returns the rest of the line without blanks at either end; a name may contain blanks and "#".
  std::string_view rest();

  // Reads the next word if it is a number. Otherwise returns false and stays before the word.
  bool number(double& value);

  // Parts of a word, without skipping blanks. A missing integer is 0; integers beyond the range are
  // INT32_MAX.
  std::int32_t integer();
  bool take(char c);

  // Skips the rest of the word. Returns true if nothing was left of it.
  bool finishWord();

 private:
  bool isLineEnd(const char* p) const { return p == end_ || *p == '\n' || *p == '\r'; }
  // Returns the number of characters of a backslash and the line end that it hides, else 0.
  int continuation(const char* p) const;
  bool isWordEnd(const char* p) const;
  void skipBlanks();

  const std::string& text_;
  const char* at_;
  const char* end_;  // the text's final '\0'
  const std::string& file_;
  std::uint64_t line_;
};

}  // namespace whit
