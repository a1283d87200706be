#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace rayengine {

/// The whole of a regular file. Throws Error when it is missing, a folder, a device or cannot be read.
std::string read_file(const std::filesystem::path& file);

/// The extension in lower case, with its dot.
std::string lower_extension(const std::filesystem::path& file);

/// Reads a text file held in memory word by word and knows which line it is on. Words are separated by white space and
/// by a backslash at the end of a line. Every failure is an Error that begins with file:line.
class Text {
 public:
  /// `comment` starts a comment that runs to the end of its line; 0 for none. `data` must outlive this.
  Text(std::string_view data, std::filesystem::path file, char comment = 0)
      : data_(data), file_(std::move(file)), comment_(comment) {}

  /// Moves to the next word of this line; false when there is none.
  bool more_on_line();
  /// Moves to the next word of this or a later line; false at the end of the file.
  bool more();
  /// The next word, on whatever line; fails at the end of the file.
  std::string_view word();
  /// The next word of this line; fails at its end.
  std::string_view word_on_line();
  /// The rest of this line, without its end; moves to the next.
  std::string_view rest_of_line();

  /// `word` as a number; fails on anything else. NaN and infinity are numbers here.
  double to_number(std::string_view word) const;
  double to_finite(std::string_view word) const;
  std::int64_t to_integer(std::string_view word) const;

  std::uint64_t line() const { return line_; }
  std::size_t offset() const { return at_; }
  std::size_t remaining() const { return data_.size() - at_; }
  [[noreturn]] void fail(const std::string& what) const { fail_at(line_, what); }
  [[noreturn]] void fail_at(std::uint64_t line, const std::string& what) const;

 private:
  bool continues() const;

  std::string_view data_;
  std::filesystem::path file_;
  char comment_;
  std::size_t at_ = 0;
  std::uint64_t line_ = 1;
};

/// `word` in quotes, short and printable, for messages about files that may hold anything.
std::string quoted(std::string_view word);

}  // namespace rayengine
