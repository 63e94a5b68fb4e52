#include "io/output/file_error.hpp"

#include <cerrno>
#include <system_error>

#include <fmt/format.h>

namespace mpm::io {

FileError system_error(const std::string& doing, const std::string& path, int error) {
  std::string text = fmt::format("cannot {} '{}': {}", doing, path, std::generic_category().message(error));
  if (error == ENOSPC || error == EDQUOT) {
    text +=
        "; free disk space or choose another folder with --output-dir, then restart from the newest .pe "
        "file, if there is one";
  } else if (error == EFBIG) {
    text += "; raise the file size limit (ulimit -f)";
  }
  return FileError(text);
}

void throw_together(core::Reductions& ranks, const std::string& fault) {
  if (!ranks.any(!fault.empty())) return;
  for (const std::string& text : ranks.gather(fault)) {
    if (!text.empty()) throw FileError(text);
  }
}

}  // namespace mpm::io
