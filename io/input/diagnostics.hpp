// Collects all errors in one input, to be thrown together.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/scene/errors.hpp"

namespace mpm::io {

class Diagnostics {
 public:
  explicit Diagnostics(std::string file) : file_(std::move(file)) {}

  void add(int line, std::string_view element, std::string message) {
    add(line, element, {}, {}, std::move(message));
  }
  void add(int line, std::string_view element, std::string_view attribute, std::string_view value,
           std::string message);

  /// Adds the faults of `other` at places without a fault.
  void merge(const Diagnostics& other);

  bool empty() const { return found_.empty(); }
  const std::string& file() const { return file_; }

  /// Throws core::InputErrors, sorted by line, if anything was added.
  void raise_if_any();

 private:
  std::string file_;
  std::vector<core::Diagnostic> found_;
  std::size_t left_out_ = 0;  ///< faults beyond the maximum number listed
};

}  // namespace mpm::io
