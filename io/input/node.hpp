// An element of the input seen through its specification: typed values with defaults filled in.
// Missing and wrong values have been reported by the checker; here they read as NaN, 0, false or empty, so
// that later checks can continue without reporting them again.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/errors.hpp"
#include "core/tensor/vec3.hpp"
#include "io/input/diagnostics.hpp"
#include "io/input/document.hpp"
#include "io/input/specification.hpp"

namespace mpm::io {

/// The fault of a value, or an empty text.
std::string fault(const AttributeSpec& attribute, std::string_view value);

/// The value, trimmed; a second spelling of a word is replaced by the word.
std::string_view canonical_word(const AttributeSpec& attribute, std::string_view value);

class Node {
 public:
  /// `outer_type` is the value of the nearest `type` attribute further up.
  Node(const Document& document, std::uint32_t element, const ElementSpec& spec, std::string_view outer_type);

  const ElementSpec& spec() const { return *spec_; }
  const Document& document() const { return *document_; }
  const XmlElement& element() const { return document_->elements()[element_]; }
  std::uint32_t index() const { return element_; }
  std::string_view name() const { return element().name; }
  int line() const { return element().line; }
  /// The nearest type: of this element, or of the nearest one further up that has one. Empty when it is not
  /// valid.
  std::string_view type() const { return type_; }

  /// The attribute under its name or its second accepted spelling.
  const XmlAttribute* find(std::string_view attribute) const;

  /// NaN without value and default; 0 where an expression is given.
  double real(std::string_view attribute) const;
  /// The expression given instead of the number, if it uses variables.
  std::optional<std::string> expression(std::string_view attribute) const;
  std::int64_t integer(std::string_view attribute) const;
  int small_integer(std::string_view attribute) const { return static_cast<int>(integer(attribute)); }
  bool boolean(std::string_view attribute) const { return integer(attribute) == 1; }
  std::string word(std::string_view attribute) const;
  std::vector<std::string> words(std::string_view attribute) const;  ///< joined by |, without repetitions
  core::Vec3<double> reals(std::string_view a, std::string_view b, std::string_view c) const {
    return {real(a), real(b), real(c)};
  }
  /// The value where it was given (validly); defaults do not count.
  std::optional<double> given_real(std::string_view attribute) const;
  std::optional<std::int64_t> given_integer(std::string_view attribute) const;

  std::vector<Node> children(std::string_view child) const;
  std::optional<Node> child(std::string_view child) const;  ///< the first

  /// A fault about this element, or about one of its attributes.
  void report(Diagnostics& diagnostics, std::string message) const;
  void report(Diagnostics& diagnostics, std::string_view attribute, std::string message) const;

 private:
  /// The valid text of the attribute, its default, or nothing.
  std::optional<std::string> text(std::string_view attribute, bool with_default) const;

  const Document* document_;
  std::uint32_t element_;
  const ElementSpec* spec_;
  std::string type_;
};

}  // namespace mpm::io
