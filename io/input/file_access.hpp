#pragma once

#include <filesystem>
#include <string>

namespace mpm::io {

/// Why the file cannot be opened for reading ("no such file" ...), or an empty text.
std::string why_unreadable(const std::filesystem::path& file);

}  // namespace mpm::io
