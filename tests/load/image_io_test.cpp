#include "engine/load/image_io.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/load/text.h"
#include "tests/load/expect_error.h"
#include "tests/load/file_limit.h"
#include "tests/temporary.h"

namespace rayengine {
namespace {

namespace fs = std::filesystem;
using test::expect_error;
using Channels = std::vector<std::string>;

/// Colours of all brightnesses, and whatever `channels` there are beyond.
Image gradient(int width, int height, const Channels& channels) {
  Image image(width, height, channels);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (std::size_t c = 0; c < channels.size(); ++c)
        image.pixel(x, y)[c] = channels[c] == "A" ? 1.0f : float(x * height + y) / float(width * height) / float(c + 1);
  return image;
}

class ImageFile : public testing::Test {
 protected:
  Image round_trip(const std::string& name, const Image& image, Encoding encoding = Encoding::automatic) {
    const fs::path file = folder.path() / name;
    check_writable(file);
    write_image(file, image, encoding);
    return read_image(file);
  }

  void expect_near(const Image& image, const Image& expected, float error) {
    ASSERT_EQ(image.width, expected.width);
    ASSERT_EQ(image.height, expected.height);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        for (std::size_t c = 0; c < image.channels.size(); ++c)
          ASSERT_NEAR(image.pixel(x, y)[c], expected.pixel(x, y)[c], error) << x << " " << y << " " << c;
  }

  test::TemporaryFolder folder;
};

TEST_F(ImageFile, ExrKeepsEveryChannelExactly) {
  const Channels channels = {"R", "G", "B", "A", "Z", "N.X", "N.Y", "N.Z", "object", "P.X", "error"};
  Image image = gradient(7, 5, channels);
  image.pixel(0, 0)[4] = INFINITY;
  image.pixel(1, 0)[8] = 16777215;
  image.pixel(2, 0)[10] = 1e-30f;
  image.pixel(3, 0)[3] = 0.25f;
  image.pixel(4, 0)[0] = 1000;
  const Image back = round_trip("a.exr", image);
  ASSERT_EQ(back.channels.size(), channels.size());
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const auto found = std::find(back.channels.begin(), back.channels.end(), channels[c]);
    ASSERT_NE(found, back.channels.end()) << channels[c];
    const auto b = static_cast<std::size_t>(found - back.channels.begin());
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < 7; ++x) EXPECT_EQ(back.pixel(x, y)[b], image.pixel(x, y)[c]) << channels[c];
  }
}

TEST_F(ImageFile, PngIsSrgbUnlessLinear) {
  const Image image = gradient(64, 64, {"R", "G", "B", "A", "Z"});
  for (const Encoding encoding : {Encoding::automatic, Encoding::linear}) {
    const Image back = round_trip("a.png", image, encoding);
    EXPECT_EQ(back.channels, (Channels{"R", "G", "B"}));
    // Half a step of 8 bits, times the steepest slope of the decoding curve.
    expect_near(back, image, encoding == Encoding::linear ? 0.501f / 255 : 0.501f / 255 * 2.3f);
  }
}

TEST_F(ImageFile, PngRoundsToTheNearestStep) {
  Image image(4, 1, {"R", "G", "B"});
  const float reds[] = {-1, NAN, 2, 127.6f / 255};
  for (int x = 0; x < 4; ++x) image.pixel(x, 0)[0] = reds[x];
  const Image back = round_trip("a.png", image, Encoding::linear);
  const float expected[] = {0, 0, 1, 128.0f / 255};
  for (int x = 0; x < 4; ++x) EXPECT_FLOAT_EQ(back.pixel(x, 0)[0], expected[x]);
  image.pixel(0, 0)[0] = 0.5f;  // 187.516 in sRGB
  EXPECT_NEAR(round_trip("b.png", image).pixel(0, 0)[0], 0.50289f, 1e-5);
}

TEST_F(ImageFile, KeepsAlphaThatSaysSomething) {
  Image image = gradient(8, 8, {"R", "G", "B", "A"});
  image.pixel(3, 3)[3] = 0;
  image.pixel(5, 5)[3] = 0.5f;
  const std::string png = read_file((round_trip("a.png", image, Encoding::linear), folder.path() / "a.png"));
  EXPECT_EQ(png[25], 6) << "colour type with alpha";
  const std::string opaque =
      read_file((round_trip("b.png", gradient(8, 8, {"R", "G", "B", "A"})), folder.path() / "b.png"));
  EXPECT_EQ(opaque[25], 2) << "colour type without alpha";
  const Image back = read_image(folder.path() / "a.png");
  ASSERT_EQ(back.channels.size(), 4u);
  EXPECT_EQ(back.pixel(3, 3)[3], 0);
  expect_near(back, image, 0.51f / 255);  // colours are kept, and not multiplied by alpha
}

TEST_F(ImageFile, WritesOtherFormats) {
  Image image = gradient(32, 32, {"R", "G", "B", "A", "Z", "object"});
  for (const char* name : {"a.tif", "a.bmp", "a.tga", "a.ppm", "a.dpx", "a.jp2", "a.iff", "a.sgi", "a.rla", "a.fits"}) {
    const Image back = round_trip(name, image);
    EXPECT_EQ(back.channels.size(), 3u) << name;
    expect_near(back, image, 0.501f / 255 * 2.3f);
  }
  EXPECT_EQ(round_trip("linear.tif", image, Encoding::linear).channels.size(),
            3u);  // TIFF cannot say that it is linear
  for (const char* name : {"a.jpg", "a.webp", "a.gif"}) expect_near(round_trip(name, image), image, 0.1f);
  expect_near(round_trip("a.ico", image), image, 0.501f / 255 * 2.3f);
  image.pixel(1, 1)[0] = 100;
  expect_near(round_trip("a.hdr", image), image, 0.5f);
  EXPECT_NEAR(read_image(folder.path() / "a.hdr").pixel(1, 1)[0], 100, 0.5);
}

TEST_F(ImageFile, ChecksBeforeTheWork) {
  expect_error([&] { check_writable(folder.path() / "a.xyz"); }, "a.xyz", "names no image format");
  expect_error([&] { check_writable(folder.path() / "noextension"); }, "noextension", "names no image format");
  for (const char* name : {"a.null", "a.term", "a.zfile", "a.psd"})
    expect_error([&] { check_writable(folder.path() / name); }, name, "names no image format");
  expect_error([&] { check_holds(folder.path() / "a.ico", 100, 257); }, "a.ico", "1 to 256 pixels a side");
  expect_error([&] { check_holds(folder.path() / "a.jpg", 65501, 1); }, "a.jpg", "1 to 65500 pixels a side");
  expect_error([&] { check_holds(folder.path() / "a.jp2", 31, 64); }, "a.jp2", "32 to 65536 pixels a side");
  EXPECT_NO_THROW(check_holds(folder.path() / "a.png", 65536, 1));
  expect_error([&] { check_writable(folder.path() / "none" / "a.png"); }, "a.png", "No such file or directory");
  expect_error([&] { check_writable(folder.path()); }, folder.path().string(), "Is a directory");
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST_F(ImageFile, LeavesNothingOnAFullDisk) {
  Image image(200, 200, {"R", "G", "B"});
  unsigned state = 1;
  for (float& value : image.pixels) value = float((state = state * 1664525u + 1013904223u) >> 8) / float(1 << 24);
  for (const char* name : {"a.png", "a.exr", "a.tif", "a.jpg", "a.hdr", "a.bmp", "a.tga", "a.ppm"}) {
    expect_error(
        [&] {
          const test::FileLimit limit(16384);
          write_image(folder.path() / name, image);
        },
        name, "cannot write");
    EXPECT_TRUE(fs::is_empty(folder.path())) << name;
  }
  const test::FileLimit limit(16384);
  EXPECT_THROW(write_image(folder.path() / "a.sgi", image), Error);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST_F(ImageFile, RejectsWhatIsNoImage) {
  expect_error([&] { read_image(folder.path() / "none.png"); }, "none.png", "no such file");
  expect_error([&] { read_image(folder.path()); }, folder.path().string(), "no such file");
  expect_error([&] { read_image(folder.write("a.png", "no picture")); }, "a.png", "cannot be read as an image");
  expect_error([&] { read_image(folder.write("a.exr", "")); }, "a.exr", "cannot be read as an image");
  write_image(folder.path() / "b.png", gradient(64, 64, {"R", "G", "B"}));
  const std::string whole = read_file(folder.path() / "b.png");
  expect_error([&] { read_image(folder.write("c.png", whole.substr(0, whole.size() / 2))); }, "c.png", "is damaged");
  expect_error([&] { write_image(folder.path() / "d.png", Image()); }, "d.png", "without pixels");
  expect_error([&] { write_image(folder.path() / "d.png", gradient(2, 2, {"Z"})); }, "d.png", "no colour");
}

}  // namespace
}  // namespace rayengine
