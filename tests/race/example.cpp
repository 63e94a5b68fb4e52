// What the race detector has to tell apart: `barrier`, each thread reads what its neighbour wrote before a
// barrier; `none`, the same without one.
#include <cstdio>
#include <string_view>
#include <vector>

#include <omp.h>

int main(int argc, char** argv) {
  const bool barrier = argc > 1 && std::string_view(argv[1]) == "barrier";
  std::vector<int> written(64), read(64);
#pragma omp parallel num_threads(4)
  {
    const int mine = omp_get_thread_num(), next = (mine + 1) % omp_get_num_threads();
    written[static_cast<std::size_t>(mine)] = mine + 1;
    if (barrier) {
#pragma omp barrier
    }
    read[static_cast<std::size_t>(mine)] = written[static_cast<std::size_t>(next)];
  }
  std::printf("%d\n", read[0]);
}
