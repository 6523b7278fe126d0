// The version of the program.
#pragma once

namespace whit {

const char* versionText();  // "0.1.0"

}  // namespace whit
