#include "io/output/text_file.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace mpm::io {

namespace {
constexpr std::size_t buffer_bytes = std::size_t{1} << 16;
}

TextFile::TextFile(const std::string& path, bool append, core::Exchange& exchange) {
  together(exchange, [&] {
    if (exchange.rank() != 0) return;
    file_ = std::make_unique<File>(path, append ? File::Mode::append : File::Mode::write_anew);
  });
}

TextFile::~TextFile() { write_out(); }

void TextFile::add(std::string_view text) noexcept {
  if (!file_) return;
  waiting_ += text;
  if (waiting_.size() >= buffer_bytes) write_out();
}

void TextFile::write_out() noexcept {
  if (!file_) return;
  try {
    if (complaint_.empty()) file_->write(waiting_);
  } catch (const FileError& e) { complaint_ = e.what(); }
  waiting_.clear();
}

void TextFile::flush(core::Exchange& exchange) {
  write_out();
  agree(exchange, complaint_);
}

bool cut_table(const std::string& path, const std::string& head, std::int64_t last_step) {
  std::ifstream in(path);
  if (!in) return false;
  std::string line, last_comment;
  std::uint64_t keep = 0;
  while (std::getline(in, line) && !in.eof()) {  // a line that ends with the file was cut short
    if (!line.empty() && line.front() == '#') {
      last_comment = line;
    } else if (last_comment != head || std::strtoll(line.c_str(), nullptr, 10) > last_step) {
      break;
    }
    keep += line.size() + 1;
  }
  in.close();
  if (last_comment != head) {
    rename_file(path, path + ".old");
    return false;
  }
  File(path, File::Mode::change).truncate(keep);
  return true;
}

}  // namespace mpm::io
