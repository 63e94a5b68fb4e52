// Linked into programs of sanitizer builds: MPI's plugins stay loaded, so that the leak report can name them
// and cmake/lsan.supp can suppress their leaks.
extern "C" int dlclose(void*) noexcept { return 0; }
