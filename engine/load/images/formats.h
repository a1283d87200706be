#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/load/image_io.h"

// The module's own parts.
namespace rayengine::images {

inline bool is_colour(const std::string& channel) {
  return channel == "R" || channel == "G" || channel == "B" || channel == "Y";
}

/// OpenImageIO's messages can have several lines; ours have one.
std::string first_line(std::string text);

// See ImageCodec.
Image read(const std::filesystem::path& file);
void check_format(const std::filesystem::path& file);
void check_sides(const std::filesystem::path& file, int width, int height);
std::vector<unsigned char> encode(const std::filesystem::path& file, const Image& image, Encoding encoding);

}  // namespace rayengine::images
