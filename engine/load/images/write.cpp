#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

#include "accel/tracer.h"
#include "engine/load/images/formats.h"
#include "engine/load/images/memory_file.h"

namespace rayengine::images {
namespace {

float encode_srgb(float v) { return v <= 0.0031308f ? v * 12.92f : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f; }

/// The first channels of an image as a file is to hold them.
struct Selection {
  OIIO::ImageSpec spec;
  bool quantised = false;  ///< to 8 bits
  bool srgb = false;
};

std::size_t colour_channels(const Image& image) {
  const auto is_rgba = [](const std::string& c) { return is_colour(c) || c == "A"; };
  const auto end = std::ranges::find_if_not(image.channels, is_rgba);
  return static_cast<std::size_t>(end - image.channels.begin());
}

// An alpha of one everywhere says nothing, and some programs read such files the worse for it.
bool is_opaque(const Image& image, std::size_t alpha) {
  for (std::size_t i = alpha; i < image.pixels.size(); i += image.channels.size())
    if (image.pixels[i] != 1) return false;
  return true;
}

// OpenEXR holds every channel under its name, as float. Others get the colour, in float where they can.
Selection select(const Image& image, const OIIO::ImageOutput& output, Encoding encoding) {
  const std::string format = output.format_name();
  std::size_t count = image.channels.size();
  if (format != "openexr") {
    count = colour_channels(image);
    const bool has_alpha = count > 0 && image.channels[count - 1] == "A";
    if (has_alpha && (!output.supports("alpha") || is_opaque(image, count - 1))) --count;
  }
  Selection selection;
  selection.quantised = format != "openexr" && format != "hdr";
  selection.srgb = selection.quantised && encoding == Encoding::automatic;
  selection.spec = OIIO::ImageSpec(image.width, image.height, static_cast<int>(count),
                                   selection.quantised ? OIIO::TypeUInt8 : OIIO::TypeFloat);
  selection.spec.channelnames.assign(image.channels.begin(),
                                     image.channels.begin() + static_cast<std::ptrdiff_t>(count));
  // sRGB is what all take integers for; to say it costs TIFF an Exif directory, which OpenImageIO damages in memory.
  if (!selection.srgb) selection.spec.attribute("oiio:ColorSpace", "Linear");
  if (selection.quantised) selection.spec.attribute("oiio:UnassociatedAlpha", 1);  // colours go out as they are
  return selection;
}

std::uint8_t to_byte(float value, bool srgb) {
  const float clamped = value > 0 ? std::min(value, 1.0f) : 0.0f;  // NaN becomes 0
  return static_cast<std::uint8_t>(std::lround(255 * (srgb ? encode_srgb(clamped) : clamped)));
}

std::vector<std::uint8_t> quantise(const Image& image, const Selection& selection) {
  const auto count = static_cast<std::size_t>(selection.spec.nchannels);
  const std::size_t pixels = image.pixels.size() / image.channels.size();
  std::vector<std::uint8_t> bytes(pixels * count);
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t c = 0; c < count; ++c)
      bytes[i * count + c] =
          to_byte(image.pixels[i * image.channels.size() + c], selection.srgb && is_colour(image.channels[c]));
  return bytes;
}

bool write_pixels(OIIO::ImageOutput& output, const Image& image, const Selection& selection) {
  if (selection.quantised) return output.write_image(OIIO::TypeUInt8, quantise(image, selection).data());
  const auto stride = static_cast<OIIO::stride_t>(image.channels.size() * sizeof(float));
  return output.write_image(OIIO::TypeFloat, image.pixels.data(), stride);
}

/// The sides that a format, or the library behind it, really holds; beyond them some write damaged files, and libjpeg
/// ends the process. Others take all that a picture of ours can have.
struct Sides {
  std::string_view format;
  int least, most;
};
constexpr Sides limited[] = {{"gif", 1, 65535},   {"heif", 1, 65535},      {"ico", 1, 256},   {"iff", 1, 65535},
                             {"jpeg", 1, 65500},  {"jpeg2000", 32, 65536}, {"rla", 1, 65535}, {"sgi", 1, 65535},
                             {"targa", 1, 65535}, {"webp", 1, 16383}};

/// What OpenImageIO writes too, but is no picture: nothing at all, text for the terminal, depth alone.
constexpr std::string_view no_pictures[] = {"null", "term", "zfile"};

std::unique_ptr<OIIO::ImageOutput> make_output(const std::filesystem::path& file) {
  auto output = OIIO::ImageOutput::create(file.string());
  if (!output || std::ranges::find(no_pictures, output->format_name()) != std::end(no_pictures)) {
    OIIO::geterror();  // forgets it, since OpenImageIO would print it at exit
    throw Error(file.string() + ": its extension names no image format that can be written; use .png or .exr");
  }
  return output;
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
  throw Error(file.string() + ": the image does not fit this format (" + why + "); use .exr");
}

void check_sides(const OIIO::ImageOutput& output, const std::filesystem::path& file, int width, int height) {
  const auto limits = std::ranges::find(limited, std::string_view(output.format_name()), &Sides::format);
  if (limits == std::end(limited)) return;
  const auto [shorter, longer] = std::minmax(width, height);
  if (shorter < limits->least || longer > limits->most)
    refuse(file, "it takes " + std::to_string(limits->least) + " to " + std::to_string(limits->most) +
                     " pixels a side, not " + std::to_string(width) + "x" + std::to_string(height));
}

/// The bytes of the file. They are made in memory first: what libraries do when the disk is full is between silence
/// (libpng) and ending the process (libjpeg). Formats that must have a file get one in memory.
std::vector<unsigned char> bytes_of(OIIO::ImageOutput& output, const std::filesystem::path& file, const Image& image,
                                    const Selection& selection) {
  OIIO::Filesystem::IOVecOutput memory;
  std::optional<MemoryFile> memory_file;
  if (!output.set_ioproxy(&memory)) memory_file.emplace(2 * selection.spec.image_bytes() + 65536);
  const bool written = output.open(memory_file ? memory_file->name() : file.string(), selection.spec) &&
                       write_pixels(output, image, selection) && output.close();
  if (!written) refuse(file, first_line(output.geterror()));
  return memory_file ? memory_file->content() : memory.buffer();
}

}  // namespace

void check_format(const std::filesystem::path& file) { make_output(file); }

void check_sides(const std::filesystem::path& file, int width, int height) {
  check_sides(*make_output(file), file, width, height);
}

std::vector<unsigned char> encode(const std::filesystem::path& file, const Image& image, Encoding encoding) {
  const auto output = make_output(file);
  check_sides(*output, file, image.width, image.height);
  const Selection selection = select(image, *output, encoding);
  if (selection.spec.nchannels == 0) throw Error(file.string() + ": the image has no colour; write it as .exr");
  return bytes_of(*output, file, image, selection);
}

}  // namespace rayengine::images
