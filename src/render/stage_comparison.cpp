#include "render/stage_comparison.h"
namespace whit {
std::vector<StageDifference> compareStages(Renderer&, const Camera&, const Film&) { return {}; }
}
