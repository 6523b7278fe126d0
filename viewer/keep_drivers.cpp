// For LeakSanitizer only: OpenGL's drivers stay loaded. Unloading one takes the roots along of what
// it keeps for the life of the program, which is then reported as leaked by nobody.
#include <dlfcn.h>

// Seen by the libraries that call it, unlike the program's other symbols.
extern "C" __attribute__((visibility("default"))) int dlclose(void*) noexcept { return 0; }
