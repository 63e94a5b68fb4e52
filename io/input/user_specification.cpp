#include "io/input/user_specification.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "io/input/reader.hpp"
#include "io/input/text.hpp"

namespace mpm::io {

namespace {

bool contains(const std::vector<std::string>& words, std::string_view word) {
  return std::ranges::find(words, word) != words.end();
}

/// How often the added names occur is checked against the user's Specification.
ElementSpec foreign(ElementSpec spec) {
  spec.foreign = true;
  spec.required = false;
  spec.multiple = true;
  return spec;
}

void add_words(AttributeSpec& ours, const AttributeSpec& theirs) {
  if (ours.type != ValueType::text || ours.range.words.empty()) return;
  for (const std::string& word : theirs.range.words) {
    if (contains(ours.range.words, word)) continue;
    ours.range.words.push_back(word);
    ours.foreign_words.push_back(word);
  }
}

/// `new_types`: values of the nearest type attribute further up that only the user's Specification has.
void add(ElementSpec& ours, const ElementSpec& theirs, std::vector<std::string> new_types = {}) {
  std::vector<AttributeSpec> rows;
  for (const AttributeSpec& row : theirs.attributes) {
    bool known = false;
    for (AttributeSpec& own : ours.attributes) {
      if (own.name != row.name) continue;
      known = true;
      add_words(own, row);
      if (own.name == "type") new_types = own.foreign_words;
    }
    AttributeSpec addition = row;
    addition.foreign = true;
    addition.required = false;
    if (known && addition.for_types.empty()) {
      addition.for_types = new_types;
    } else if (known) {  // for types unknown to the program
      std::erase_if(addition.for_types, [&](const std::string& t) { return !contains(new_types, t); });
    }
    if (known && addition.for_types.empty()) continue;
    rows.push_back(std::move(addition));
  }
  ours.attributes.insert(ours.attributes.end(), rows.begin(), rows.end());
  for (const ElementSpec& child : theirs.children) {
    const auto own = std::ranges::find(ours.children, child.name, &ElementSpec::name);
    if (own == ours.children.end())
      ours.children.push_back(foreign(child));
    else
      add(*own, child, new_types);
  }
}

class Finder {
 public:
  explicit Finder(const std::string& file) : file_(file) {}

  void element(const Node& node, const std::string& path) {
    for (const XmlAttribute& given : node.document().attributes(node.element())) {
      const AttributeSpec* row = node.spec().attribute(given.name, node.type());
      const bool word = row && contains(row->foreign_words, trim(given.value));
      if (row == nullptr || !(row->foreign || word)) continue;
      const std::string name = fmt::format("{}@{}={}", path, row->name, word ? given.value : "");
      found(name, {file_, given.line, std::string(node.name()), row->name, std::string(given.value), {}});
    }
    for (const ElementSpec& spec : node.spec().children) {
      for (const Node& child : node.children(spec.name)) {
        const std::string to = path + "/" + spec.name;
        if (spec.foreign)
          found(to, {file_, child.line(), spec.name, {}, {}, {}});
        else
          element(child, to);
      }
    }
  }

  std::vector<core::Diagnostic> take() { return std::move(found_); }

 private:
  void found(const std::string& name, core::Diagnostic what) {
    if (!seen_.insert(name).second) return;
    what.message = "defined in the Specification, but not in this program: mpm_run rejects the input";
    found_.push_back(std::move(what));
  }

  const std::string& file_;
  std::set<std::string> seen_;
  std::vector<core::Diagnostic> found_;
};

}  // namespace

UserSpecification read_user_specification(const std::filesystem::path& file,
                                          const core::Catalogue& catalogue) {
  UserSpecification read{file.string(), parse_specification(read_bytes(file), file.string())};
  if (read.root.name != specification().name)
    throw core::InputErrors(core::SourceLocation{read.file, 0}, read.root.name,
                            fmt::format("the root of a Specification is <{}>", specification().name));
  add_laws(read.root, catalogue);
  return read;
}

ElementSpec with_additions(ElementSpec ours, const ElementSpec& theirs) {
  add(ours, theirs);
  return ours;
}

std::vector<core::Diagnostic> foreign_names(const Node& root, const std::string& file) {
  Finder finder(file);
  finder.element(root, "");
  return finder.take();
}

}  // namespace mpm::io
