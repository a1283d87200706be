#pragma once

#include <filesystem>

#include "engine/scene/image.h"

namespace rayengine {

/// Reads an image as linear floats (sRGB files are decoded). Throws Error.
Image read_image(const std::filesystem::path& file);

/// How pixels are stored. sRGB encodes R, G and B for 8- and 16-bit formats; float formats stay linear always.
enum class Encoding { automatic, linear };

/// Throws Error when `file` cannot be written or its format is not known; to be called before the work.
void check_writable(const std::filesystem::path& file);

/// Throws Error when the format of `file` holds no image of so many pixels; to be called before the work.
void check_holds(const std::filesystem::path& file, int width, int height);

/// Writes through a temporary beside `file` and renames, so that nothing partial is left under its name. Throws Error.
void write_image(const std::filesystem::path& file, const Image& image, Encoding encoding = Encoding::automatic);

}  // namespace rayengine
