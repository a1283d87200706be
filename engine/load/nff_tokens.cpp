#include "engine/load/nff_tokens.h"

#include <charconv>
#include <cmath>

namespace rayengine {
namespace {

constexpr std::string_view space = " \t\r\n\v\f";

bool is_space(char c) { return space.find(c) != std::string_view::npos; }

/// A plus sign, which std::from_chars does not take, may lead a number.
std::string_view without_plus(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  return word;
}

template <class Number>
std::errc parse(std::string_view word, Number& value) {
  word = without_plus(word);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc()) return error;
  return end == word.data() + word.size() ? std::errc() : std::errc::invalid_argument;
}

}  // namespace

void NffTokens::advance() {
  bool comment = false;
  for (; position_ < text_.size() && (comment || is_space(text_[position_]) || text_[position_] == '#'); ++position_) {
    if (text_[position_] == '\n')
      ++line_at_position_, comment = false;
    else if (text_[position_] == '#')
      comment = true;
  }
  const std::size_t begin = position_;
  while (position_ < text_.size() && !is_space(text_[position_]) && text_[position_] != '#') ++position_;
  next_ = std::string_view(text_).substr(begin, position_ - begin);
  next_line_ = line_at_position_;
}

std::string_view NffTokens::take() {
  const std::string_view word = next_;
  line_ = next_line_;
  advance();
  return word;
}

bool NffTokens::next_is_number() const {
  double ignored;
  return !at_end() && parse(next_, ignored) != std::errc::invalid_argument;
}

double NffTokens::number(std::string_view what) {
  if (at_end()) fail(last_place(), "the file ends within " + std::string(what) + ": it is cut short");
  const std::string_view word = take();
  double value = 0;
  const std::errc error = parse(word, value);
  if (error == std::errc::result_out_of_range || (error == std::errc() && !std::isfinite(value)))
    fail(last_place(), "number " + in_quotes(word) + " in " + std::string(what) + " is out of range");
  if (error != std::errc())
    fail(last_place(), "expected a number in " + std::string(what) + ", got " + in_quotes(word));
  return value;
}

int NffTokens::integer(std::string_view what) {
  const double value = number(what);
  if (value != std::floor(value) || std::abs(value) > 2147483647)
    fail(last_place(), "expected a whole number in " + std::string(what));
  return static_cast<int>(value);
}

}  // namespace rayengine
