#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>

#include "accel/tracer.h"
#include "engine/load/images/formats.h"

namespace rayengine::images {
namespace {

constexpr std::size_t max_values = std::size_t{1} << 32;  // 16 GiB of floats

float decode_srgb(float v) { return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f); }

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

}  // namespace

std::string first_line(std::string text) {
  text.resize(std::min(text.find_first_of("\r\n"), text.size()));
  return text.empty() ? "unknown format" : text;
}

Image read(const std::filesystem::path& file) {
  OIIO::ImageSpec wishes;
  wishes.attribute("oiio:UnassociatedAlpha", 1);  // colours as they are in the file
  const auto input = OIIO::ImageInput::open(file.string(), &wishes);
  if (!input) throw Error(file.string() + ": cannot be read as an image (" + first_line(OIIO::geterror()) + ")");
  OIIO::ImageSpec spec = input->spec();
  check_size(spec, file.string());
  if (spec.channelnames.size() != static_cast<std::size_t>(spec.nchannels)) spec.default_channel_names();  // FITS
  Image image(spec.width, spec.height, spec.channelnames);
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, image.pixels.data()))
    throw Error(file.string() + ": is damaged (" + first_line(input->geterror()) + "); is it complete?");
  if (holds_srgb(spec)) decode(image);
  return image;
}

}  // namespace rayengine::images
