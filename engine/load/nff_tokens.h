#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "engine/load/place.h"

namespace rayengine {

/// The words of an NFF file: separated by any white space, with comments from '#' to the end of the line.
class NffTokens {
 public:
  /// Throws Error when the file cannot be read. `file` must outlive the tokens.
  explicit NffTokens(const std::filesystem::path& file) : file_(file), text_(read_text(file)) { advance(); }

  bool at_end() const { return next_.empty(); }
  /// The word that comes next, without taking it; empty at the end.
  std::string_view peek() const { return next_; }
  /// The place of the word taken last.
  Place last_place() const { return {file_, line_}; }
  bool next_is_on_the_same_line() const { return next_line_ == line_; }
  bool next_is_number() const;

  std::string_view take();
  /// Take a number, and fail with the line when there is none, or it is not finite; `what` names it in messages.
  double number(std::string_view what);
  int integer(std::string_view what);
  template <std::size_t N>
  std::array<double, N> numbers(std::string_view what) {
    std::array<double, N> result;
    for (double& value : result) value = number(what);
    return result;
  }

 private:
  void advance();

  const std::filesystem::path& file_;
  std::string text_;
  std::string_view next_;
  std::size_t position_ = 0;
  int line_ = 1, next_line_ = 1, line_at_position_ = 1;
};

}  // namespace rayengine
