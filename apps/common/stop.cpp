#include "apps/common/stop.hpp"

#include <csignal>

namespace mpm::apps {

namespace {
volatile std::sig_atomic_t noted = 0;

void note(int signal) {
  if (signal == SIGINT && noted == SIGINT) {
    std::signal(SIGINT, SIG_DFL);
    std::raise(SIGINT);
  }
  noted = signal;
}
}  // namespace

void watch_signals() {
  struct sigaction action = {};
  action.sa_handler = note;
  action.sa_flags = SA_RESTART;
  for (int signal : {SIGINT, SIGTERM, SIGUSR1}) sigaction(signal, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);  // the run continues if the reader of the console exits
  std::signal(SIGXFSZ, SIG_IGN);  // a file size limit becomes an error of the write
}

int noted_signal() { return noted; }

}  // namespace mpm::apps
