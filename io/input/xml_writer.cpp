#include "io/input/xml_writer.hpp"

namespace mpm::io {

namespace {

std::string escaped(std::string_view value) {
  std::string text;
  for (const char c : value) {
    switch (c) {
      case '&': text += "&amp;"; break;
      case '<': text += "&lt;"; break;
      case '"': text += "&quot;"; break;
      case '\n': text += "&#10;"; break;
      case '\r': text += "&#13;"; break;
      case '\t': text += "&#9;"; break;
      default: text += c;
    }
  }
  return text;
}

}  // namespace

XmlWriter::Scope XmlWriter::element(std::string_view name) {
  if (tag_open_) out_ += ">\n";
  out_ += fmt::format("{:{}}<{}", "", 2 * depth_, name);
  ++depth_;
  tag_open_ = true;
  return Scope(*this, name);
}

void XmlWriter::text(std::string_view attribute, std::string_view value) {
  out_ += fmt::format(" {}=\"{}\"", attribute, escaped(value));
}

void XmlWriter::numbers(std::string_view a, std::string_view b, std::string_view c,
                        const core::Vec3<double>& values) {
  number(a, values[0]);
  number(b, values[1]);
  number(c, values[2]);
}

void XmlWriter::close(const std::string& name) {
  --depth_;
  if (tag_open_)
    out_ += "/>\n";
  else
    out_ += fmt::format("{:{}}</{}>\n", "", 2 * depth_, name);
  tag_open_ = false;
}

}  // namespace mpm::io
