#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/load/image_io.h"

namespace rayengine {

/// What the module that links OpenImageIO offers to image_io.cpp, which loads it when an image is first read or
/// written: OpenImageIO brings some 200 shared libraries along, and programs that need none start a quarter second
/// sooner.
struct ImageCodec {
  /// Reads an image as linear floats. Throws Error.
  Image (*read)(const std::filesystem::path& file);
  /// Throws Error when the extension of `file` names no format that can be written.
  void (*check_format)(const std::filesystem::path& file);
  /// Throws Error when that format holds no image of so many pixels.
  void (*check_sides)(const std::filesystem::path& file, int width, int height);
  /// The bytes of an image file named `file`, which is not touched. Throws Error.
  std::vector<unsigned char> (*encode)(const std::filesystem::path& file, const Image& image, Encoding encoding);
};

/// The module's file, and the name in it of its one ImageCodec.
inline constexpr const char* image_module = "rayengine_images.so";
inline constexpr const char* image_codec_symbol = "rayengine_image_codec";

}  // namespace rayengine
