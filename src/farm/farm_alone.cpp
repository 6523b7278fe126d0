// Built without MPI.
#include "farm/farm.h"

namespace whit {

struct Farm::Parts {};

Farm::Farm() = default;
Farm::~Farm() = default;

int Farm::run(const std::function<int(Farm&)>& command) {
  Farm farm;
  return command(farm);
}

int Farm::rank() const { return 0; }
int Farm::ranks() const { return 1; }

FrameStats Farm::render(Film& film, int, int, const Trace& trace) { return trace(film); }

void Farm::leaveOut() {}

}  // namespace whit
