// The machine and the build on which measurements are made.
#pragma once

#include <string>

namespace whit::cli {

struct MachineFacts {
  std::string cpu;       // model name
  int cores = 1;         // that this process may use
  std::string compiler;  // "g++ 12.2.0"
  std::string commit;    // of the sources, as git describes them; "unknown" outside a checkout
};
MachineFacts machineFacts();

double peakRssMb();  // 10^6 bytes

}  // namespace whit::cli
