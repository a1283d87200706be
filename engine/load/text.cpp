#include "engine/load/text.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "accel/tracer.h"

namespace rayengine {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }
bool is_space(char c) { return is_blank(c) || c == '\n'; }

std::string_view without_plus(std::string_view word) {
  return word.size() > 1 && word[0] == '+' && word[1] != '-' ? word.substr(1) : word;
}

}  // namespace

std::string read_file(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw Error(file.string() + ": there is no such file; check its name");
  if (!std::filesystem::is_regular_file(status)) throw Error(file.string() + ": is not a file; name a file to read");
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  std::string data(std::filesystem::file_size(file, error), '\0');
  if (error || !stream.read(data.data(), static_cast<std::streamsize>(data.size())))
    throw Error(file.string() + ": cannot be read (" + std::strerror(errno ? errno : EIO) + "); check its permissions");
  return data;
}

std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return extension;
}

bool Text::continues() const {
  const std::string_view next = data_.substr(at_, 3);
  return next.starts_with("\\\n") || next.starts_with("\\\r\n");
}

bool Text::more_on_line() {
  for (; at_ < data_.size(); ++at_) {
    const char c = data_[at_];
    if (is_blank(c)) continue;
    if (c == '\\' && continues()) {
      at_ = data_.find('\n', at_);
      ++line_;
      continue;
    }
    if (comment_ && c == comment_) at_ = std::min(data_.find('\n', at_), data_.size());
    break;
  }
  return at_ < data_.size() && data_[at_] != '\n';
}

bool Text::more() {
  while (!more_on_line()) {
    if (at_ == data_.size()) return false;
    ++at_;
    ++line_;
  }
  return true;
}

std::string_view Text::word() {
  if (!more()) fail("the file ends too early; is it complete?");
  return word_on_line();
}

std::string_view Text::word_on_line() {
  if (!more_on_line()) fail("the line ends too early");
  const std::size_t first = at_;
  while (at_ < data_.size() && !is_space(data_[at_]) && !(data_[at_] == '\\' && continues())) ++at_;
  return data_.substr(first, at_ - first);
}

std::string_view Text::rest_of_line() {
  const std::size_t first = at_;
  const std::size_t end = std::min(data_.find('\n', at_), data_.size());
  if (end < data_.size()) ++line_;
  at_ = std::min(end + 1, data_.size());
  std::string_view rest = data_.substr(first, end - first);
  while (!rest.empty() && is_blank(rest.back())) rest.remove_suffix(1);
  return rest;
}

double Text::to_number(std::string_view word) const {
  const std::string_view digits = without_plus(word);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (end != digits.data() + digits.size() || error == std::errc::invalid_argument)
    fail("expected a number, found " + quoted(word));
  // Out of range: strtod tells what underflows to nothing from what overflows to infinity.
  return error == std::errc{} ? value : std::strtod(std::string(digits).c_str(), nullptr);
}

double Text::to_finite(std::string_view word) const {
  const double value = to_number(word);
  if (!std::isfinite(value)) fail(quoted(word) + " is not a finite number");
  return value;
}

std::int64_t Text::to_integer(std::string_view word) const {
  const std::string_view digits = without_plus(word);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size())
    fail("expected a whole number, found " + quoted(word));
  return value;
}

void Text::fail_at(std::uint64_t line, const std::string& what) const {
  throw Error(file_.string() + ":" + std::to_string(line) + ": " + what);
}

std::string quoted(std::string_view word) {
  constexpr std::size_t longest = 24;
  std::string text = "'";
  for (const char c : word.substr(0, longest)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (word.size() > longest ? "...'" : "'");
}

}  // namespace rayengine
