#include "engine/load/npy.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <string>
#include <string_view>

#include "accel/tracer.h"
#include "engine/load/atomic_file.h"
#include "engine/load/text.h"

// The format is described in NumPy's numpy/lib/format.py: a magic string, a version, the length of a header, and the
// header, a Python dictionary, padded with spaces so that the data begin at a multiple of 64 bytes.
namespace rayengine {
namespace {

static_assert(std::endian::native == std::endian::little, "data are written as they lie in memory, and called '<'");

constexpr std::string_view magic = "\x93NUMPY";
constexpr std::size_t ray_columns = 8;

class NpyReader {
 public:
  NpyReader(std::string_view data, const std::filesystem::path& file) : data_(data), file_(file) {}

  std::vector<Ray> rays() {
    const std::string_view header = split_header();
    const std::size_t value_size = float_size(value_of(header, "descr"));
    if (!value_of(header, "fortran_order").starts_with("False"))
      fail("is in Fortran order; save numpy.ascontiguousarray(rays)");
    const std::size_t count = row_count(value_of(header, "shape"));
    if (count > data_.size() / (ray_columns * value_size))
      fail("ends before its " + std::to_string(count) + " rows do; is it complete?");
    return value_size == sizeof(double) ? rows<double>(count) : rows<float>(count);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw Error(file_.string() + ": " + what); }

  // Gives the header and leaves the array in data_.
  std::string_view split_header() {
    if (!data_.starts_with(magic)) fail("is not a NumPy file; save rays with numpy.save");
    if (data_.size() < 12) fail("ends within its header; is it complete?");
    const unsigned version = static_cast<unsigned char>(data_[6]);
    if (version < 1 || version > 3) fail("is of NumPy format " + std::to_string(version) + "; 1 to 3 are read");
    const std::size_t length_size = version == 1 ? 2 : 4;
    std::uint32_t length = 0;
    std::memcpy(&length, data_.data() + 8, length_size);
    data_.remove_prefix(8 + length_size);
    if (length > data_.size()) fail("ends within its header; is it complete?");
    const std::string_view header = data_.substr(0, length);
    data_.remove_prefix(length);
    return header;
  }

  // What follows `key` and its colon.
  std::string_view value_of(std::string_view header, const std::string& key) const {
    std::size_t at = std::min(header.find(fmt::format("'{}'", key)), header.find(fmt::format("\"{}\"", key)));
    if (at != header.npos) at = header.find(':', at);
    if (at != header.npos) at = header.find_first_not_of(" \t", at + 1);
    if (at == header.npos) fail("has a NumPy header without '" + key + "'");
    return header.substr(at);
  }

  std::size_t float_size(std::string_view descr) const {
    const std::string_view type = descr.substr(0, std::min(descr.find(descr[0], 1), descr.size() - 1) + 1);
    const bool is_string = (type[0] == '\'' || type[0] == '"') && type.size() >= 4;
    std::string_view name = is_string ? type.substr(1, type.size() - 2) : std::string_view{};
    if (!name.empty() && (name[0] == '<' || name[0] == '=' || name[0] == '|')) name.remove_prefix(1);
    if (name == "f4") return 4;
    if (name == "f8") return 8;
    fail("has dtype " + quoted(is_string ? type.substr(1, type.size() - 2) : "structured") +
         "; rays are float32 or float64, little-endian: save rays.astype('<f8')");
  }

  // Of a shape "(N, 8)".
  std::size_t row_count(std::string_view shape) const {
    const std::string_view text = shape.substr(0, std::min(shape.find(')'), shape.size() - 1) + 1);
    std::string compact(text);
    std::erase(compact, ' ');
    std::size_t rows = 0;
    const char* const last = compact.data() + compact.size();
    const auto [end, error] = std::from_chars(compact.data() + std::min<std::size_t>(1, compact.size()), last, rows);
    const std::string_view rest(end, last);
    if (compact[0] != '(' || error != std::errc{} || (rest != ",8)" && rest != ",8,)"))
      fail("has shape " + quoted(text) + "; rays have shape (N, 8): ox oy oz tmin dx dy dz tmax");
    return rows;
  }

  template <class T>
  std::vector<Ray> rows(std::size_t count) const {
    std::vector<Ray> rays(count);
    for (std::size_t i = 0; i < count; ++i) {
      std::array<T, ray_columns> v;
      std::memcpy(v.data(), data_.data() + i * sizeof v, sizeof v);
      rays[i] = {{v[0], v[1], v[2]}, v[3], {v[4], v[5], v[6]}, v[7]};
    }
    return rays;
  }

  std::string_view data_;
  std::filesystem::path file_;
};

std::string header_of(const std::string& descr, const std::string& shape) {
  std::string text = fmt::format("{{'descr': {}, 'fortran_order': False, 'shape': {}, }}", descr, shape);
  const std::size_t unpadded = magic.size() + 4 + text.size() + 1;
  text.append((64 - unpadded % 64) % 64, ' ');
  text += '\n';
  const auto length = static_cast<std::uint16_t>(text.size());
  std::string header(magic);
  header += {'\x01', '\x00', static_cast<char>(length & 0xFF), static_cast<char>(length >> 8)};
  return header + text;
}

void write_array(const std::filesystem::path& file, const std::string& header, const void* data, std::size_t size) {
  AtomicFile output(file);
  output.write(header);
  output.write(data, size);
  output.commit();
}

// One record of the file, without the gaps and in the order of the file rather than of Hit.
void append(std::vector<char>& records, const Hit& hit) {
  const auto put = [&](const auto& value) {
    const char* const bytes = reinterpret_cast<const char*>(&value);
    records.insert(records.end(), bytes, bytes + sizeof value);
  };
  put(hit.t), put(hit.object), put(hit.primitive), put(hit.u), put(hit.v), put(hit.normal), put(hit.error),
      put(hit.status);
}

std::string one_dimension(std::size_t count) { return fmt::format("({},)", count); }

}  // namespace

std::vector<Ray> read_rays(const std::filesystem::path& file) { return NpyReader(read_file(file), file).rays(); }

void write_rays(const std::filesystem::path& file, std::span<const Ray> rays) {
  write_array(file, header_of("'<f8'", fmt::format("({}, 8)", rays.size())), rays.data(), rays.size_bytes());
}

void write_hits(const std::filesystem::path& file, std::span<const Hit> hits) {
  constexpr std::size_t chunk = 65536;  // hits are packed some at a time, so that memory stays small
  AtomicFile output(file);
  output.write(
      header_of("[('t', '<f8'), ('object', '<u4'), ('primitive', '<u4'), ('u', '<f4'), ('v', '<f4'), "
                "('nx', '<f4'), ('ny', '<f4'), ('nz', '<f4'), ('error', '<f8'), ('status', '<u4')]",
                one_dimension(hits.size())));
  std::vector<char> records;
  for (std::size_t first = 0; first < hits.size(); first += chunk) {
    records.clear();
    for (const Hit& hit : hits.subspan(first, std::min(chunk, hits.size() - first))) append(records, hit);
    output.write(records.data(), records.size());
  }
  output.commit();
}

void write_offsets(const std::filesystem::path& file, std::span<const std::uint64_t> offsets) {
  write_array(file, header_of("'<u8'", one_dimension(offsets.size())), offsets.data(), offsets.size_bytes());
}

}  // namespace rayengine
