#include "engine/load/image_io.h"

#include <dlfcn.h>

#include "accel/tracer.h"
#include "engine/load/atomic_file.h"
#include "engine/load/images/codec.h"

namespace rayengine {
namespace {

/// The module lies where it was built, beside the program or above the tests, or where it was installed.
std::filesystem::path find_module() {
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  for (const char* folder : {".", "..", "../" MODULE_FOLDER})
    if (const auto file = program / folder / image_module; std::filesystem::exists(file)) return file;
  throw Error(std::string("the image formats, ") + image_module +
              ", were not found near the program; install it again");
}

/// The module is never unloaded: the libraries behind it leave threads and memory that name their code.
const ImageCodec& load_codec() {
  void* const module = dlopen(find_module().c_str(), RTLD_LAZY | RTLD_LOCAL);
  const void* const codec = module ? dlsym(module, image_codec_symbol) : nullptr;
  if (!codec) throw Error(std::string("the image formats cannot be loaded (") + dlerror() + "); install them again");
  return *static_cast<const ImageCodec*>(codec);
}

const ImageCodec& codec() {
  static const ImageCodec& loaded = load_codec();
  return loaded;
}

}  // namespace

Image read_image(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file)) throw Error(file.string() + ": there is no such file; check its name");
  return codec().read(file);
}

void check_writable(const std::filesystem::path& file) {
  check_output(file);
  codec().check_format(file);
}

void check_holds(const std::filesystem::path& file, int width, int height) { codec().check_sides(file, width, height); }

void write_image(const std::filesystem::path& file, const Image& image, Encoding encoding) {
  if (image.width < 1 || image.height < 1 || image.channels.empty())
    throw Error(file.string() + ": an image without pixels cannot be written");
  const std::vector<unsigned char> bytes = codec().encode(file, image, encoding);
  AtomicFile target(file);
  target.write(bytes.data(), bytes.size());
  target.commit();
}

}  // namespace rayengine
