// Keeps OpenGL's drivers loaded under LeakSanitizer. Unloading a driver would remove the roots of
// the memory that it keeps, which would then be reported as leaked.
#include <dlfcn.h>

// Unlike the program's other symbols this one is visible to the libraries that call it.
extern "C" __attribute__((visibility("default"))) int dlclose(void*) noexcept { return 0; }
