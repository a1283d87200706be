#include "engine/load/place.h"

#include <cerrno>
#include <cstring>
#include <fstream>

namespace rayengine {

namespace fs = std::filesystem;

void fail(const Place& place, std::string message) {
  const std::size_t advice = message.find(": ");
  message.insert(advice == std::string::npos ? message.size() : advice,
                 ", " + place.file.string() + ":" + std::to_string(place.line));
  throw Error(message);
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string result = "'";
  for (const unsigned char c : text.substr(0, longest)) result += c < ' ' || c == 127 ? '?' : static_cast<char>(c);
  return result + (text.size() > longest ? "...'" : "'");
}

std::string read_text(const fs::path& file) {
  std::error_code ignored;
  const fs::file_status status = fs::status(file, ignored);
  if (!fs::exists(status)) throw Error("there is no file " + file.string());
  if (!fs::is_regular_file(status)) throw Error(file.string() + " is not a file: name the scene itself");
  std::ifstream in(file, std::ios::binary);
  std::string text(fs::file_size(file, ignored), '\0');
  if (!in || !in.read(text.data(), static_cast<std::streamsize>(text.size())))
    throw Error("cannot read " + file.string() + ": " + std::strerror(errno));
  return text;
}

}  // namespace rayengine
