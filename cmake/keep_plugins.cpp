// Linked into programs of sanitizer builds: MPI's plugins stay loaded, so that the leak report can name them,
// and cmake/lsan.supp can tell theirs from ours.
extern "C" int dlclose(void*) noexcept { return 0; }
