#include "core/version.h"

namespace whit {

const char* versionText() { return WHIT_VERSION; }

}  // namespace whit
