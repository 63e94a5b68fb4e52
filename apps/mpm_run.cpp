// mpm_run JobName[.xmp|.pe] [options]: reads, checks and runs a case; also as `mpirun -np N mpm_run ...`.
#include "apps/mpm.hpp"

int main(int argc, char** argv) { return mpm::run(argc, argv, {}); }
