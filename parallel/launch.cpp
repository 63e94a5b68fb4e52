#include "parallel/launch.hpp"

#include <cstdint>
#include <vector>

namespace mpm::parallel {

std::string broadcast(const Communicator& comm, std::string bytes) {
  std::uint64_t size = bytes.size();
  comm.broadcast(std::as_writable_bytes(std::span(&size, 1)));
  bytes.resize(size);
  comm.broadcast(std::as_writable_bytes(std::span(bytes)));
  return bytes;
}

namespace detail {

namespace {

void put(std::string& bytes, const std::string& text) {
  const std::uint64_t size = text.size();
  bytes += bytes_of(size) + text;
}

std::string take(const std::string& bytes, std::size_t& at) {
  std::uint64_t size = 0;
  std::memcpy(&size, bytes.data() + at, sizeof size);
  at += sizeof size;
  std::string text = bytes.substr(at, size);
  at += size;
  return text;
}

}  // namespace

std::string to_bytes(const core::InputErrors& errors) {
  std::string bytes;
  for (const core::Diagnostic& d : errors.diagnostics()) {
    for (const std::string* text : {&d.file, &d.element, &d.attribute, &d.value, &d.message})
      put(bytes, *text);
    put(bytes, bytes_of(d.line));
  }
  return bytes;
}

core::InputErrors errors_from(const std::string& bytes) {
  std::vector<core::Diagnostic> diagnostics;
  for (std::size_t at = 0; at < bytes.size();) {
    core::Diagnostic d;
    for (std::string* text : {&d.file, &d.element, &d.attribute, &d.value, &d.message})
      *text = take(bytes, at);
    d.line = value_from<int>(take(bytes, at));
    diagnostics.push_back(std::move(d));
  }
  return core::InputErrors(std::move(diagnostics));
}

}  // namespace detail

}  // namespace mpm::parallel
