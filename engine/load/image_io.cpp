#include "engine/load/image_io.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "accel/tracer.h"
#include "engine/load/atomic_file.h"

namespace rayengine {
namespace {

constexpr std::size_t max_values = std::size_t{1} << 32;  // 16 GiB of floats

std::string first_line(std::string text) {
  text.resize(std::min(text.find_first_of("\r\n"), text.size()));
  return text.empty() ? "unknown format" : text;
}

float decode_srgb(float v) { return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f); }
float encode_srgb(float v) { return v <= 0.0031308f ? v * 12.92f : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f; }

bool is_colour(const std::string& channel) {
  return channel == "R" || channel == "G" || channel == "B" || channel == "Y";
}

// Integer files are sRGB unless they say otherwise, as PNG files do that were written with Encoding::linear.
bool holds_srgb(const OIIO::ImageSpec& spec) {
  const std::string space = spec.get_string_attribute("oiio:ColorSpace");
  return !spec.format.is_floating_point() && !OIIO::Strutil::iequals(space, "linear");
}

void decode(Image& image) {
  const std::size_t n = image.channels.size();
  for (std::size_t c = 0; c < n; ++c)
    if (is_colour(image.channels[c]))
      for (std::size_t i = c; i < image.pixels.size(); i += n) image.pixels[i] = decode_srgb(image.pixels[i]);
}

void check_size(const OIIO::ImageSpec& spec, const std::string& file) {
  const double values = double(spec.width) * spec.height * spec.nchannels;
  if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1 || values > double(max_values))
    throw Error(file + ": an image of " + std::to_string(spec.width) + " by " + std::to_string(spec.height) +
                " pixels is not read");
}

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

// Images are made in memory first: what libraries do when the disk is full is between silence (libpng) and ending the
// process (libjpeg). The few formats that OpenImageIO cannot write into memory are refused.
std::unique_ptr<OIIO::ImageOutput> make_output(const std::filesystem::path& file) {
  auto output = OIIO::ImageOutput::create(file.string());
  if (!output || !output->supports("ioproxy")) {
    OIIO::geterror();  // forgets it, since OpenImageIO would print it at exit
    throw Error(file.string() + ": its extension names no image format that can be written; use .png or .exr");
  }
  return output;
}

}  // namespace

Image read_image(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file)) throw Error(file.string() + ": there is no such file; check its name");
  OIIO::ImageSpec wishes;
  wishes.attribute("oiio:UnassociatedAlpha", 1);  // colours as they are in the file
  const auto input = OIIO::ImageInput::open(file.string(), &wishes);
  if (!input) throw Error(file.string() + ": cannot be read as an image (" + first_line(OIIO::geterror()) + ")");
  const OIIO::ImageSpec& spec = input->spec();
  check_size(spec, file.string());
  Image image(spec.width, spec.height, spec.channelnames);
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, image.pixels.data()))
    throw Error(file.string() + ": is damaged (" + first_line(input->geterror()) + "); is it complete?");
  if (holds_srgb(spec)) decode(image);
  return image;
}

void check_writable(const std::filesystem::path& file) {
  check_output(file);
  make_output(file);
}

void write_image(const std::filesystem::path& file, const Image& image, Encoding encoding) {
  if (image.width < 1 || image.height < 1 || image.channels.empty())
    throw Error(file.string() + ": an image without pixels cannot be written");
  const auto output = make_output(file);
  const Selection selection = select(image, *output, encoding);
  if (selection.spec.nchannels == 0) throw Error(file.string() + ": the image has no colour; write it as .exr");
  OIIO::Filesystem::IOVecOutput memory;
  const bool written = output->set_ioproxy(&memory) && output->open(file.string(), selection.spec) &&
                       write_pixels(*output, image, selection) && output->close();
  if (!written)
    throw Error(file.string() + ": the image does not fit this format (" + first_line(output->geterror()) +
                "); use .exr");
  AtomicFile target(file);
  target.write(memory.buffer().data(), memory.buffer().size());
  target.commit();
}

}  // namespace rayengine
