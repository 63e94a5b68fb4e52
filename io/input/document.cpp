// The streaming interface of libxml2 fills the tree, which avoids a second copy of a large input.

#include "io/input/document.hpp"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <functional>
#include <initializer_list>
#include <new>
#include <utility>

#include <fmt/format.h>
#include <libxml/parser.h>
#include <libxml/xmlerror.h>

#include "io/input/text.hpp"

namespace mpm::io {

namespace {

std::string_view view(const xmlChar* text) {
  return text ? std::string_view(reinterpret_cast<const char*>(text)) : std::string_view();
}

std::string_view view(const xmlChar* begin, const xmlChar* end) {
  return {reinterpret_cast<const char*>(begin), static_cast<std::size_t>(end - begin)};
}

int newlines(const xmlChar* begin, const xmlChar* end) {
  return static_cast<int>(std::count(begin, end, '\n'));
}

}  // namespace

std::string_view Document::keep(std::string_view text) {
  constexpr std::size_t block = 1 << 16;
  if (text.size() > block_left_) {
    block_left_ = std::max(block, text.size());
    blocks_.push_back(std::make_unique_for_overwrite<char[]>(block_left_));
    block_next_ = blocks_.back().get();
  }
  char* const copy = block_next_;
  std::ranges::copy(text, copy);
  block_next_ += text.size();
  block_left_ -= text.size();
  return {copy, text.size()};
}

void Document::set_attribute(std::uint32_t element, std::string_view name, std::string_view value, int line) {
  XmlElement& e = elements_[element];
  const auto begin = attributes_.begin() + e.first_attribute, end = begin + e.attribute_count;
  const XmlAttribute made{keep_name(name), keep(value), line};
  if (const auto found = std::find_if(begin, end, [&](const XmlAttribute& a) { return a.name == name; });
      found != end) {
    *found = made;
    return;
  }
  std::vector<XmlAttribute> moved(begin, end);  // an element's attributes are neighbours
  moved.push_back(made);
  e.first_attribute = static_cast<std::uint32_t>(attributes_.size());
  e.attribute_count = static_cast<std::uint32_t>(moved.size());
  attributes_.insert(attributes_.end(), moved.begin(), moved.end());
}

std::uint32_t Document::add_child(std::uint32_t parent, std::string_view name, int line) {
  const auto index = static_cast<std::uint32_t>(elements_.size());
  XmlElement child;
  child.name = keep_name(name);
  child.line = line;
  elements_.push_back(child);
  std::uint32_t* link = &elements_[parent].first_child;
  while (*link != 0) link = &elements_[*link].next_sibling;
  *link = index;
  return index;
}

class DocumentBuilder {
 public:
  explicit DocumentBuilder(xmlParserCtxtPtr parser) : parser_(parser) {
    parser->_private = this;
    xmlSAXHandler& sax = *parser->sax;
    std::memset(&sax, 0, sizeof sax);
    sax.initialized = XML_SAX2_MAGIC;
    sax.startElementNs = [](void* p, const xmlChar* name, const xmlChar* prefix, const xmlChar*,
                            int namespaces, const xmlChar**, int count, int, const xmlChar** attributes) {
      self(p).begin(name, prefix, namespaces > 0, count, attributes);
    };
    sax.endElementNs = [](void* p, const xmlChar*, const xmlChar*, const xmlChar*) { self(p).end(); };
    sax.characters = [](void* p, const xmlChar* text, int length) { self(p).characters(text, length); };
    sax.cdataBlock = sax.characters;
    sax.internalSubset = [](void* p, const xmlChar*, const xmlChar*, const xmlChar*) {
      self(p).fail("a document type (DOCTYPE) is not accepted: the input language has no entities");
    };
    sax.serror = [](void* p, xmlErrorPtr e) { self(p).libxml_error(*e); };
  }

  Document take() && { return std::move(document_); }
  const std::optional<XmlError>& error() const { return error_; }

 private:
  static DocumentBuilder& self(void* parser) {
    return *static_cast<DocumentBuilder*>(static_cast<xmlParserCtxtPtr>(parser)->_private);
  }

  int line() const { return parser_->input ? parser_->input->line : 0; }

  void fail(std::string message) {
    if (!error_) error_ = XmlError{line(), std::move(message), {}};
    xmlStopParser(parser_);
  }

  void libxml_error(const xmlError& e) {
    if (e.level < XML_ERR_ERROR || error_) return;
    error_ = XmlError{e.line, fmt::format("not well-formed XML: {}", trim(e.message ? e.message : "")), {}};
    if (e.code == XML_ERR_ATTRIBUTE_REDEFINED && e.str1) error_->repeated_attribute = e.str1;
  }

  std::string_view name(const xmlChar* local, const xmlChar* prefix) {
    std::string full(view(local));
    if (prefix) full = fmt::format("{}:{}", view(prefix), full);
    return *document_.names_.insert(std::move(full)).first;
  }

  /// The text of the tag is still in the parser's buffer: `<` cannot occur in it again, and lines are counted
  /// in it.
  void begin(const xmlChar* local, const xmlChar* prefix, bool namespaces, int count, const xmlChar** raw) {
    const xmlChar* const base = parser_->input->base;
    const xmlChar* const cursor = parser_->input->cur;
    const xmlChar* tag = cursor;
    while (tag > base && *tag != '<') --tag;

    const auto index = static_cast<std::uint32_t>(document_.elements_.size());
    XmlElement element{name(local, prefix),
                       line() - newlines(tag, cursor),
                       static_cast<std::uint32_t>(document_.attributes_.size()),
                       0,
                       0,
                       0,
                       false};
    int at_line = element.line;
    const xmlChar* at = tag;
    for (int i = 0; i < count; ++i, raw += 5) {
      const xmlChar* const value = raw[3];
      if (std::less_equal<>{}(at, value) &&
          std::less_equal<>{}(value,
                              cursor)) {  // else: a copy, because of a character reference or a tab
        at_line += newlines(at, value);
        at = value;
      }
      document_.attributes_.push_back({name(raw[0], raw[1]), document_.keep(view(value, raw[4])), at_line});
    }
    if (namespaces) document_.attributes_.push_back({name(BAD_CAST "xmlns", nullptr), {}, element.line});
    element.attribute_count =
        static_cast<std::uint32_t>(document_.attributes_.size()) - element.first_attribute;
    document_.elements_.push_back(element);
    if (!open_.empty()) {
      Open& parent = open_.back();
      (parent.last_child ? document_.elements_[parent.last_child].next_sibling
                         : document_.elements_[parent.element].first_child) = index;
      parent.last_child = index;
    }
    open_.push_back({index, 0, false});
  }

  void end() { open_.pop_back(); }

  void characters(const xmlChar* text, int length) {
    const std::string_view stray = trim(view(text, text + length));
    if (stray.empty() || open_.empty() || open_.back().has_text) return;
    open_.back().has_text = true;
    document_.stray_texts_.push_back({open_.back().element, line(), shortened(stray, 40)});
  }

  struct Open {
    std::uint32_t element = 0;
    std::uint32_t last_child = 0;
    bool has_text = false;
  };

  xmlParserCtxtPtr parser_;
  Document document_;
  std::optional<XmlError> error_;
  std::vector<Open> open_;
};

namespace {

/// The encoding to use instead of the declared one: gb2312 files contain characters of its supersets.
const char* override_encoding(std::string_view bytes) {
  std::string head(bytes.substr(0, std::min(bytes.find("?>"), std::size_t{200})));
  std::ranges::transform(head, head.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (!head.starts_with("<?xml")) return nullptr;
  const bool chinese =
      std::ranges::any_of(std::initializer_list<std::string_view>{"gb2312", "gb_2312", "gbk", "cp936"},
                          [&](std::string_view s) { return head.find(s) != head.npos; });
  return chinese ? "GB18030" : nullptr;
}

/// Limit of attributes per element; the time of libxml2 is quadratic in their number.
constexpr int most_attributes = 2000;

/// Line of a tag with too many attributes, or 0. `unit(i)` is the i-th code unit of the text.
template <class Unit>
int overfull_tag(std::size_t count, const Unit& unit) {
  const auto follows = [&](std::size_t i, std::string_view text) {
    for (std::size_t k = 0; k < text.size(); ++k)
      if (i + k >= count || unit(i + k) != text[k]) return false;
    return true;
  };
  int line = 1, equals = 0;
  bool comment = false;
  for (std::size_t i = 0; i < count; ++i) {
    const char c = unit(i);
    if (c == '\n') ++line;
    if (comment) {
      comment = !(c == '>' && i > 1 && unit(i - 1) == '-' && unit(i - 2) == '-');
    } else if (c == '<') {
      equals = 0;
      comment = follows(i, "<!--");
    } else if (c == '=' && ++equals > most_attributes) {
      return line;
    }
  }
  return 0;
}

int overfull_tag(std::string_view bytes) {
  if (bytes.substr(0, 4).find('\0') == bytes.npos && !bytes.starts_with("\xFF\xFE") &&
      !bytes.starts_with("\xFE\xFF"))
    return overfull_tag(bytes.size(), [&](std::size_t i) { return bytes[i]; });
  const std::size_t low = bytes.starts_with("\xFE\xFF") || bytes[0] == '\0' ? 1 : 0;
  return overfull_tag(bytes.size() / 2,
                      [&](std::size_t i) { return bytes[2 * i + 1 - low] ? '?' : bytes[2 * i + low]; });
}

/// Reasons not to parse the bytes at all.
std::optional<XmlError> refusal(std::string_view bytes) {
  using namespace std::string_view_literals;
  if (bytes.size() > largest_document)
    return XmlError{0,
                    fmt::format("{} bytes exceed the limit of {} for an input; store particles in a separate "
                                "file (Geometry file=)",
                                bytes.size(), largest_document),
                    {}};
  if (trim(bytes).empty()) return XmlError{0, "the file is empty", {}};
  if (bytes.starts_with("\0\0"sv) || bytes.starts_with("\xFF\xFE\0\0"sv) || bytes.starts_with("<\0\0\0"sv))
    return XmlError{0, "UTF-32 is not supported; save the file as UTF-8", {}};
  if (const int line = overfull_tag(bytes))
    return XmlError{line, fmt::format("more than {} attributes on one element", most_attributes), {}};
  return {};
}

/// libxml2 prints failures to convert on its own, unless this thread has a handler.
class ConversionWatch {
 public:
  ConversionWatch() {
    xmlSetStructuredErrorFunc(
        this, [](void* self, xmlErrorPtr) { static_cast<ConversionWatch*>(self)->failed_ = true; });
  }
  ~ConversionWatch() { xmlSetStructuredErrorFunc(context_, handler_); }
  ConversionWatch(const ConversionWatch&) = delete;
  ConversionWatch& operator=(const ConversionWatch&) = delete;

  bool failed() const { return failed_; }

 private:
  void* context_ = xmlStructuredErrorContext;
  xmlStructuredErrorFunc handler_ = xmlStructuredError;
  bool failed_ = false;
};

}  // namespace

Document parse_document(std::string_view bytes, std::optional<XmlError>& error) {
  error = refusal(bytes);
  if (error) return {};
  const std::unique_ptr<xmlParserCtxt, void (*)(xmlParserCtxtPtr)> parser(xmlNewParserCtxt(),
                                                                          xmlFreeParserCtxt);
  if (!parser) throw std::bad_alloc();
  const ConversionWatch watch;
  DocumentBuilder builder(parser.get());
  // NOENT converts &amp; and the like to plain characters; other entities need a document type.
  xmlDocPtr unused =
      xmlCtxtReadMemory(parser.get(), bytes.data(), static_cast<int>(bytes.size()), nullptr,
                        override_encoding(bytes), XML_PARSE_NOENT | XML_PARSE_NONET | XML_PARSE_BIG_LINES);
  if (unused) xmlFreeDoc(unused);
  error = builder.error();
  if (!error && !parser->wellFormed) error = XmlError{0, "not well-formed XML", {}};
  if (error && watch.failed())
    error->message += " (some bytes are invalid in the encoding that the first line declares)";
  return error ? Document() : std::move(builder).take();
}

}  // namespace mpm::io
