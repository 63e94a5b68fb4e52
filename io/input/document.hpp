// An XML file as a plain tree of names, values and lines, independent of libxml2.
// No network, no document type, no entities except the five of XML; gb2312 labels are read as GB18030.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "io/input/diagnostics.hpp"

namespace mpm::io {

/// All texts are UTF-8 and remain valid as long as their Document exists.
struct XmlAttribute {
  std::string_view name;
  std::string_view value;
  int line = 0;
};

struct XmlElement {
  std::string_view name;
  int line = 0;  ///< of its opening bracket
  std::uint32_t first_attribute = 0;
  std::uint32_t attribute_count = 0;
  std::uint32_t first_child = 0;   ///< 0: none (the root is not a child)
  std::uint32_t next_sibling = 0;  ///< 0: none
  bool incomplete = false;         ///< its completion failed: do not report missing parts
};

class Document {
 public:
  /// Number 0 is the root; empty when the text was not well-formed.
  const std::vector<XmlElement>& elements() const { return elements_; }
  std::span<const XmlAttribute> attributes(const XmlElement& element) const {
    return std::span(attributes_).subspan(element.first_attribute, element.attribute_count);
  }
  /// The first text where only elements are allowed, if any.
  struct StrayText {
    std::uint32_t element = 0;
    int line = 0;
    std::string text;
  };
  const std::vector<StrayText>& stray_texts() const { return stray_texts_; }

  // Library references are resolved before the document is checked. Elements keep their numbers.
  /// Replaces the value where the element has the attribute.
  void set_attribute(std::uint32_t element, std::string_view name, std::string_view value, int line);
  std::uint32_t add_child(std::uint32_t parent, std::string_view name, int line);
  void mark_incomplete(std::uint32_t element) { elements_[element].incomplete = true; }

 private:
  friend class DocumentBuilder;
  std::string_view keep(std::string_view text);
  std::string_view keep_name(std::string_view name) { return *names_.emplace(name).first; }

  std::vector<XmlElement> elements_;
  std::vector<XmlAttribute> attributes_;
  std::vector<StrayText> stray_texts_;
  std::unordered_set<std::string> names_;
  std::vector<std::unique_ptr<char[]>> blocks_;
  std::size_t block_left_ = 0;
  char* block_next_ = nullptr;
};

/// The fault of a text that is not well-formed.
struct XmlError {
  int line = 0;
  std::string message;
  std::string repeated_attribute;  ///< set if an element has an attribute twice
};

/// The largest input in bytes; larger sets of particles belong in a separate file.
inline constexpr std::size_t largest_document = std::size_t{512} << 20;

/// Never throws on the content of `bytes`. After an error the document is empty.
Document parse_document(std::string_view bytes, std::optional<XmlError>& error);

}  // namespace mpm::io
