// The history holds the states that undoing returns to.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/options.h"

namespace whit::view {

// A state is all that the user has chosen about scene and picture.
struct Past {
  std::vector<std::string> settings;
  std::string givenSky;
  RenderOptions options;
  bool operator==(const Past&) const = default;
};

// The states between edits. The last one is the present.
class History {
 public:
  explicit History(const Past& present) : past_{present} {}

  // Adds the present after an edit. Without a pause since the last edit both are one.
  void add(const Past& present);
  // Takes over a present that is no edit of the user's.
  void replace(const Past& present) { past_.back() = present; }
  // Takes over the present after an edit that has failed.
  void takeBack(const Past& present);
  // Returns to the state before the last edit; none: there is no such state.
  std::optional<Past> undo();

  void wait(double seconds) { sinceEdit_ += seconds; }
  // An automatic exposure was measured, and undoing does not ask for it again.
  void settleExposure(const Exposure& measured);

 private:
  std::vector<Past> past_;
  double sinceEdit_ = 0;  // seconds
};

}  // namespace whit::view
