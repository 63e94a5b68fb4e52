// Errors of files: every rank throws the same one, or none does. The program that catches FileError prints
// what() and exits with code 5.
#pragma once

#include <new>
#include <stdexcept>
#include <string>

#include "core/communication/reductions.hpp"

namespace mpm::io {

/// A file that could not be written or read; the text names the file and the cause.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// `cannot <doing> <path>: <the system's message for `error`>`, with a remedy where there is one.
FileError system_error(const std::string& doing, const std::string& path, int error);

/// Throws the lowest rank's fault on every rank, if any rank has one. Collective.
void throw_together(core::Reductions& ranks, const std::string& fault);

/// Runs f() on this rank; if it throws on any rank, every rank throws a FileError with that rank's message. f
/// must not communicate. std::bad_alloc is thrown only on the rank where it occurs, while the others wait:
/// the caller must then abort all ranks. Collective.
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
