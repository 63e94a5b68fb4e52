#include "laws.hpp"

#include "apps/mpm.hpp"
int main(int argc, char** argv) { return mpm::run_check(argc, argv, mine::laws()); }
