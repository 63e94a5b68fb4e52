// mpm_point: the response of a material along a path of strains and stresses, without a grid.
#include "apps/mpm.hpp"

int main(int argc, char** argv) { return mpm::run_point(argc, argv, {}); }
