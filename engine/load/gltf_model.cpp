#include "engine/load/gltf_model.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include "accel/tracer.h"
#include "engine/load/text.h"

namespace rayengine {
namespace {

// These change neither the shape of a mesh nor where it stands, or are read.
constexpr std::array<std::string_view, 4> known_extensions = {"KHR_lights_punctual", "KHR_mesh_quantization",
                                                              "KHR_texture_transform", "KHR_texture_basisu"};

bool is_known(std::string_view extension) {
  return extension.starts_with("KHR_materials_") ||
         std::ranges::find(known_extensions, extension) != known_extensions.end();
}

// tinygltf follows nested values by recursion, without an end.
void check_nesting(std::string_view json) {
  constexpr int deepest = 200;
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (in_string) {
      if (c == '\\')
        ++i;
      else if (c == '"')
        in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      if (++depth > deepest) throw Error("values nest more than " + std::to_string(deepest) + " deep");
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
}

// The first chunk of a binary file, whose length precedes it.
std::string_view json_chunk(std::string_view data) {
  constexpr std::size_t file_header = 12, chunk_header = 8;
  std::uint32_t length = 0;
  if (data.size() < file_header + chunk_header) return {};
  std::memcpy(&length, data.data() + file_header, sizeof length);
  return data.substr(file_header + chunk_header, length);
}

// tinygltf's messages run over several lines and name no file.
std::string one_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < ' ' || c > '~'; }, ' ');
  if (text.size() > 200) text = text.substr(0, 200) + "...";
  return text.empty() ? "unknown reason" : text;
}

bool parse(std::string_view data, const std::string& folder, tinygltf::Model& model, std::string& error) {
  tinygltf::TinyGLTF reader;
  std::string warning;
  // Pictures are not used, and decoding them would only be one more way to fail.
  const auto no_image = [](tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int,
                           void*) { return true; };
  reader.SetImageLoader(no_image, nullptr);
  const auto size = static_cast<unsigned int>(data.size());
  if (data.starts_with("glTF")) {
    check_nesting(json_chunk(data));
    return reader.LoadBinaryFromMemory(&model, &error, &warning, reinterpret_cast<const unsigned char*>(data.data()),
                                       size, folder);
  }
  check_nesting(data);
  return reader.LoadASCIIFromString(&model, &error, &warning, data.data(), size, folder);
}

}  // namespace

tinygltf::Model read_gltf_model(const std::filesystem::path& file) {
  const std::string data = read_file(file);
  if (data.size() > std::numeric_limits<unsigned int>::max()) throw Error(file.string() + ": is larger than 4 GiB");
  tinygltf::Model model;
  std::string error;
  bool read = false;
  try {
    read = parse(data, file.parent_path().string(), model, error);
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  if (!read) throw Error(file.string() + ": is not a sound glTF file (" + one_line(error) + "); save it anew");
  for (const std::string& extension : model.extensionsRequired)
    if (!is_known(extension))
      throw Error(file.string() + ": needs the extension " + rayengine::quoted(extension) +
                  ", which is not read; save it without");
  return model;
}

}  // namespace rayengine
