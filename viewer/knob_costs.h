// What turning a knob has done to a frame: its time and its rays, before and after.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "viewer/traced_frame.h"

namespace whit::view {

struct KnobChange {
  std::string from, to;  // values as on the command line, "none" where there is nothing to say
  FrameStats before, after;
};

class KnobCosts {
 public:
  // Takes over what was measured. Otherwise only frames at rest, with the samples that the options
  // ask for, can be compared: others are passed over. A change is noticed when nothing but options
  // differs from the last such frame.
  void learn(const TracedFrame& frame);
  // Takes over what has been measured so far.
  void learn(const UnfinishedFrame& frame);

  // The last change of each option, by its name; of several at once, "a, b".
  const std::map<std::string, KnobChange>& changes() const { return changes_; }
  const std::string& lastChanged() const { return lastChanged_; }  // empty: nothing yet
  // What was measured of the view and scene that the last frame shows; null where there is none of
  // that name.
  const KnobCost* measured(const std::string& name) const;
  const std::vector<KnobCost>& measured() const { return measured_; }

 private:
  struct Baseline {
    FrameRequest request;
    FrameStats stats;
  };
  std::optional<Baseline> baseline_;
  std::map<std::string, KnobChange> changes_;
  std::string lastChanged_;
  std::vector<KnobCost> measured_;
  FrameRequest measuredFor_;
};

}  // namespace whit::view
