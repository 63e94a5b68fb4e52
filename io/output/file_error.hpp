// Errors of files: every rank throws the same one, or none does. The program that catches FileError prints
// what() and leaves with exit code 5.
#pragma once

#include <new>
#include <stdexcept>
#include <string>

#include "core/communication/reductions.hpp"

namespace mpm::io {

/// A file that could not be written or read; the text names the file and what went wrong.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// `cannot <doing> <path>: <the system's words for `error`>`, with a remedy where there is one.
FileError system_error(const std::string& doing, const std::string& path, int error);

/// Throws the lowest rank's fault on every rank, if any rank has one. Collective.
void throw_together(core::Reductions& ranks, const std::string& fault);

/// Run f() on this rank; if it throws on any, every rank throws a FileError with that rank's text. There must
/// be nothing collective in f. std::bad_alloc is thrown on the rank that has it alone, while the others wait:
/// the answer is to end every rank. Collective.
template <class F>
void together(core::Reductions& ranks, F f) {
  std::string fault;
  try {
    f();
  } catch (const std::bad_alloc&) { throw; } catch (const std::exception& e) {
    fault = e.what();
    if (fault.empty()) fault = "unknown error";
  }
  throw_together(ranks, fault);
}

}  // namespace mpm::io
