#include "io/output/log.hpp"

#include <cstdio>

namespace mpm::io {

Log::Log(const std::string& path, bool append, bool console, core::Reductions& ranks)
    : file_(path, append, ranks), speaks_(ranks.rank() == 0), console_(console) {}

void Log::put(const std::string& text, To to) {
  file_.add(text + '\n');
  file_.write_out();  // so that a killed run leaves its log
  if (to == To::file || !console_) return;
  fmt::print("{}\n", text);
  std::fflush(stdout);
}

}  // namespace mpm::io
