// Writes elements and attributes as indented text.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "core/tensor/vec3.hpp"

namespace mpm::io {

class XmlWriter {
 public:
  /// Opens an element; it is closed when the returned object is destroyed.
  class Scope {
   public:
    explicit Scope(XmlWriter& writer, std::string_view name) : writer_(writer), name_(name) {}
    ~Scope() { writer_.close(name_); }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    XmlWriter& writer_;
    std::string name_;
  };

  [[nodiscard]] Scope element(std::string_view name);
  void text(std::string_view attribute, std::string_view value);
  /// Shortest text that reads back as the same number.
  void number(std::string_view attribute, double value) { text(attribute, fmt::format("{}", value)); }
  void integer(std::string_view attribute, long long value) { text(attribute, fmt::format("{}", value)); }
  void flag(std::string_view attribute, bool value) { text(attribute, value ? "1" : "0"); }
  void numbers(std::string_view a, std::string_view b, std::string_view c, const core::Vec3<double>& values);
  template <class T>
  void maybe(std::string_view attribute, const std::optional<T>& value) {
    if (value) text(attribute, fmt::format("{}", *value));
  }

  std::string take() && { return std::move(out_); }

 private:
  void close(const std::string& name);

  std::string out_;
  int depth_ = 0;
  bool tag_open_ = false;
};

}  // namespace mpm::io
