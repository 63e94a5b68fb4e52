#include "io/output/text_file.hpp"

namespace mpm::io {

namespace {
constexpr std::size_t buffer_bytes = std::size_t{1} << 16;
}

TextFile::TextFile(const std::string& path, bool append, core::Reductions& ranks) {
  together(ranks, [&] {
    if (ranks.rank() != 0) return;
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
    if (fault_.empty()) file_->write(waiting_);
  } catch (const FileError& e) { fault_ = e.what(); }
  waiting_.clear();
}

void TextFile::flush(core::Reductions& ranks) {
  write_out();
  throw_together(ranks, fault_);
}

void TextFile::sync(core::Reductions& ranks) {
  flush(ranks);
  together(ranks, [&] {
    if (file_) file_->sync();
  });
}

}  // namespace mpm::io
