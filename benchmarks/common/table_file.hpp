// A file of comma-separated values; the lines at its head that start with # give the provenance.
#pragma once

#include <cstdio>
#include <stdexcept>
#include <string>

#include "benchmarks/common/machine.hpp"

namespace mpm::benchmarks {

struct TableFile {
  TableFile(const std::string& path, const Facts& facts) : handle(std::fopen(path.c_str(), "w")) {
    if (handle == nullptr) throw std::runtime_error("cannot write " + path);
    fmt::print(handle, "{}", facts_as_text(facts, "# "));
  }
  ~TableFile() { std::fclose(handle); }
  TableFile(const TableFile&) = delete;
  TableFile& operator=(const TableFile&) = delete;

  std::FILE* handle;
};

}  // namespace mpm::benchmarks
