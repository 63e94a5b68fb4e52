// Job.out: what the run says, in the file and on the console; said by rank 0 alone.
#pragma once

#include <string>
#include <string_view>

#include <fmt/format.h>

#include "io/output/text_file.hpp"

namespace mpm::io {

class Log {
 public:
  enum class To { both, file };
  /// Throws FileError. Collective.
  Log(const std::string& path, bool append, bool console, core::Reductions& ranks);

  /// One line, or several. Any rank may call it; only rank 0 is heard.
  template <class... Arguments>
  void say(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    if (speaks_) put(fmt::format(format, std::forward<Arguments>(arguments)...), To::both);
  }
  /// As say(), but not on the console.
  template <class... Arguments>
  void note(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    if (speaks_) put(fmt::format(format, std::forward<Arguments>(arguments)...), To::file);
  }
  template <class... Arguments>
  void warn(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    if (speaks_) put("warning: " + fmt::format(format, std::forward<Arguments>(arguments)...), To::both);
  }

  /// Throws FileError if something could not be written. Collective.
  void flush(core::Reductions& ranks) { file_.flush(ranks); }
  /// As flush(), and to the disk itself. Collective.
  void sync(core::Reductions& ranks) { file_.sync(ranks); }
  /// What the file holds; 0 on other ranks than 0.
  std::uint64_t bytes() const { return file_.bytes(); }

 private:
  void put(const std::string& text, To to);
  TextFile file_;
  bool speaks_;
  bool console_;
};

}  // namespace mpm::io
