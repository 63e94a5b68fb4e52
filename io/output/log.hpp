// Job.out: the log of the run, in the file and on the console; written by rank 0 only.
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

  /// Writes one or more lines. Any rank may call it; only rank 0 prints.
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
  /// As flush(), and syncs to disk. Collective.
  void sync(core::Reductions& ranks) { file_.sync(ranks); }
  /// Size of the file in bytes; 0 on ranks other than 0.
  std::uint64_t bytes() const { return file_.bytes(); }

 private:
  void put(const std::string& text, To to);
  TextFile file_;
  bool speaks_;
  bool console_;
};

}  // namespace mpm::io
