// mpm_check FILE...: checks input files, and the particle files that they name, without running them.
#include "apps/mpm.hpp"

int main(int argc, char** argv) { return mpm::run_check(argc, argv, {}); }
