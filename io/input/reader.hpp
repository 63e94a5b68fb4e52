// Reads and checks an input file. Independent of MPI: one rank reads the bytes, and all ranks parse the same
// bytes. Wrong input throws core::InputErrors, which holds every fault about the file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/catalogue.hpp"
#include "core/scene/scene.hpp"

namespace mpm::io {

struct ElementSpec;
struct UserSpecification;

struct ReadOptions {
  bool check_files = true;                         ///< check that the files named in the input can be read
  bool accept_later = false;                       ///< accept input that is known but not implemented yet
  std::vector<core::Diagnostic>* notes = nullptr;  ///< receives settings without effect (idle.hpp)
  const UserSpecification* users = nullptr;  ///< an additional Specification that the input must satisfy
  /// Receives names that `users` allows but this program does not have; without it they are errors.
  std::vector<core::Diagnostic>* foreign = nullptr;
};

/// The input of a job named with or without `.xmp`; throws if there is none.
std::filesystem::path find_input(const std::filesystem::path& job);

/// The bytes of a file; throws when it cannot be read.
std::string read_bytes(const std::filesystem::path& file);

/// `file` is for messages, for the job's name and for paths relative to it; it is not opened.
core::Scene parse_scene(std::string_view bytes, const std::filesystem::path& file,
                        const core::Catalogue& catalogue, const ReadOptions& options = {});

/// The same with a prepared language (io::language), for programs that read many inputs.
core::Scene parse_scene(std::string_view bytes, const std::filesystem::path& file,
                        const ElementSpec& language, const ReadOptions& options = {});

/// find_input, read_bytes and parse_scene.
core::Scene read_scene(const std::filesystem::path& job, const core::Catalogue& catalogue,
                       const ReadOptions& options = {});

}  // namespace mpm::io
