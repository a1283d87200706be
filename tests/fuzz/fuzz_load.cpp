// Feeds a loader with what libFuzzer makes up: no input may crash it, hang it or let anything out but an Error of one
// line. The loader is that of the extension in FUZZ_FORMAT. See tests/fuzz/run.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "accel/tracer.h"
#include "engine/load/image_io.h"
#include "engine/load/load.h"
#include "engine/load/npy.h"

namespace {

std::string format() {
  const char* name = std::getenv("FUZZ_FORMAT");
  return name ? name : "json";
}

void load(const std::filesystem::path& file) {
  using namespace rayengine;
  if (format() == "npy") return void(read_rays(file));
  if (format() == "png" || format() == "exr") return void(read_image(file));
  load_scene(file);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  static const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("rayengine-fuzz-" + std::to_string(getpid()) + "." + format());
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  try {
    load(file);
  } catch (const rayengine::Error& error) {
    if (std::string(error.what()).find('\n') != std::string::npos) {
      std::fprintf(stderr, "a message of several lines: %s\n", error.what());
      std::abort();
    }
  }
  std::filesystem::remove(file);
  return 0;
}
