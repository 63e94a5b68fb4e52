#include "laws.hpp"

#include "apps/mpm.hpp"
int main(int argc, char** argv) { return mpm::run_point(argc, argv, mine::laws()); }
