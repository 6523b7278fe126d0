// The history holds the states that undoing returns to.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/options.h"

namespace whit::view {

// All that the user has chosen about scene and picture.
struct UserState {
  std::vector<std::string> settings;
  std::string givenSky;
  RenderOptions options;
  bool operator==(const UserState&) const = default;
};

// Holds the states between edits; the last one is the present.
class History {
 public:
  explicit History(const UserState& present) : states_{present} {}

  // Adds the present after an edit. Edits without a pause between them count as one.
  void add(const UserState& present);
  // Takes over a present that is no edit of the user's.
  void replace(const UserState& present) { states_.back() = present; }
  // Takes over the present after an edit that has failed.
  void takeBack(const UserState& present);
  // Returns to the state before the last edit; none: there is no such state.
  std::optional<UserState> undo();

  void wait(double seconds) { sinceEdit_ += seconds; }
  // Puts the measured exposure in place of an automatic one, so that undoing does not measure
  // again.
  void settleExposure(const Exposure& measured);

 private:
  std::vector<UserState> states_;
  double sinceEdit_ = 0;  // seconds
};

}  // namespace whit::view
