// PLY, ASCII and binary of either byte order. Positions, normals and faces are kept, all other properties passed over.
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

#include "accel/tracer.h"
#include "engine/load/face_list.h"
#include "engine/load/text.h"

namespace rayengine {
namespace {

enum class Type { i8, u8, i16, u16, i32, u32, f32, f64 };
enum class Format { ascii, little, big };

struct Property {
  std::string name;
  Type type{};
  std::optional<Type> count_type;  ///< of a list
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

struct PlyHeader {
  Format format = Format::ascii;
  std::vector<Element> elements;
  std::uint64_t vertices = 0;  ///< 0 when there is no such element
};

std::size_t size_of(Type type) {
  constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<int>(type)];
}

Type parse_type(const Text& text, std::string_view word) {
  constexpr std::string_view names[][2] = {{"char", "int8"},     {"uchar", "uint8"},   {"short", "int16"},
                                           {"ushort", "uint16"}, {"int", "int32"},     {"uint", "uint32"},
                                           {"float", "float32"}, {"double", "float64"}};
  for (int i = 0; i < 8; ++i)
    if (word == names[i][0] || word == names[i][1]) return static_cast<Type>(i);
  text.fail(quoted(word) + " is not a type of the PLY format");
}

Format parse_format(const Text& text, std::string_view word) {
  if (word == "ascii") return Format::ascii;
  if (word == "binary_little_endian") return Format::little;
  if (word == "binary_big_endian") return Format::big;
  text.fail(quoted(word) + " is not a format of PLY files");
}

Element parse_element(Text& text) {
  Element element;
  element.name = text.word_on_line();
  const std::int64_t count = text.to_integer(text.word_on_line());
  if (count < 0 || static_cast<std::uint64_t>(count) > max_vertices)
    text.fail("cannot hold " + std::to_string(count) + " elements '" + element.name + "'");
  element.count = static_cast<std::uint64_t>(count);
  return element;
}

Property parse_property(Text& text) {
  Property property;
  std::string_view word = text.word_on_line();
  if (word == "list") {
    property.count_type = parse_type(text, text.word_on_line());
    word = text.word_on_line();
  }
  property.type = parse_type(text, word);
  property.name = text.word_on_line();
  return property;
}

// Every value takes two characters (the last of a file one) or its size in bytes, and a list at least its count. So no
// count can ask for more memory than the file's size warrants.
void check_size(const Text& text, Format format, const Element& element) {
  std::uint64_t least = 0;
  for (const Property& p : element.properties)
    least += format == Format::ascii ? 2 : size_of(p.count_type.value_or(p.type));
  if (element.count * least > text.remaining() + 1)
    text.fail(std::to_string(element.count) + " elements '" + element.name +
              "' do not fit into the file; is it complete?");
}

PlyHeader parse_header(Text& text) {
  PlyHeader header;
  if (text.rest_of_line() != "ply") text.fail_at(1, "is no PLY file: it does not begin with 'ply'");
  while (true) {
    const std::string_view keyword = text.word();
    if (keyword == "format") {
      header.format = parse_format(text, text.word_on_line());
    } else if (keyword == "element") {
      header.elements.push_back(parse_element(text));
      if (header.elements.back().name == "vertex") header.vertices = header.elements.back().count;
    } else if (keyword == "property") {
      if (header.elements.empty()) text.fail("a property before any element");
      header.elements.back().properties.push_back(parse_property(text));
    } else if (keyword == "end_header") {
      text.rest_of_line();
      for (const Element& element : header.elements) check_size(text, header.format, element);
      return header;
    } else if (keyword != "comment" && keyword != "obj_info") {
      text.fail("expected a line of a PLY header, found " + quoted(keyword));
    }
    text.rest_of_line();
  }
}

class AsciiValues {
 public:
  explicit AsciiValues(Text& text) : text_(text) {}
  double next(Type) { return text_.to_number(text_.word()); }
  [[noreturn]] void fail(const std::string& what) const { text_.fail(what); }

 private:
  Text& text_;
};

class BinaryValues {
 public:
  BinaryValues(std::string_view data, const std::filesystem::path& file, bool swap)
      : data_(data), file_(file), swap_(swap) {}

  double next(Type type) {
    switch (type) {
      case Type::i8: return take<std::int8_t>();
      case Type::u8: return take<std::uint8_t>();
      case Type::i16: return take<std::int16_t>();
      case Type::u16: return take<std::uint16_t>();
      case Type::i32: return take<std::int32_t>();
      case Type::u32: return take<std::uint32_t>();
      case Type::f32: return take<float>();
      case Type::f64: return take<double>();
    }
    return 0;
  }

  [[noreturn]] void fail(const std::string& what) const { throw Error(file_.string() + ": " + what); }

 private:
  template <class T>
  double take() {
    if (data_.size() < sizeof(T)) fail("the file ends too early; is it complete?");
    char bytes[sizeof(T)];
    for (std::size_t i = 0; i < sizeof(T); ++i) bytes[swap_ ? sizeof(T) - 1 - i : i] = data_[i];
    data_.remove_prefix(sizeof(T));
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
  }

  std::string_view data_;
  std::filesystem::path file_;
  bool swap_;
};

/// Reads the elements that the header promises from either kind of values.
template <class Values>
class Body {
 public:
  Body(Values values, const PlyHeader& header) : values_(std::move(values)), header_(header) {}

  FaceList read() {
    for (const Element& element : header_.elements) {
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face") {
        read_faces(element);
      } else if (!element.properties.empty()) {
        for (std::uint64_t i = 0; i < element.count; ++i)
          for (const Property& property : element.properties) skip(property);
      }
    }
    return std::move(list_);
  }

 private:
  std::uint64_t count(const Property& property) {
    const double n = values_.next(*property.count_type);
    if (!(n >= 0 && n <= double(max_vertices))) values_.fail("a list of " + std::to_string(n) + " values");
    return static_cast<std::uint64_t>(n);
  }

  void skip(const Property& property) {
    for (std::uint64_t n = property.count_type ? count(property) : 1; n > 0; --n) values_.next(property.type);
  }

  void read_vertices(const Element& element) {
    const std::vector<int> slots = vertex_slots(element);
    const bool normals = has_normals_;
    list_.positions.reserve(element.count);
    if (normals) list_.normals.reserve(element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      double values[7];
      for (std::size_t k = 0; k < slots.size(); ++k) {
        const Property& property = element.properties[k];
        if (property.count_type)
          skip(property);
        else
          values[slots[k]] = values_.next(property.type);
      }
      const glm::dvec3 p(values[0], values[1], values[2]);
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        values_.fail("vertex " + std::to_string(i) + " has a coordinate that is not finite");
      list_.positions.push_back(p);
      if (normals) list_.normals.emplace_back(values[3], values[4], values[5]);
    }
  }

  // Where each property of a vertex goes: x y z nx ny nz, and the seventh place for all that is passed over.
  std::vector<int> vertex_slots(const Element& element) {
    constexpr std::string_view names[] = {"x", "y", "z", "nx", "ny", "nz"};
    std::vector<int> slots(element.properties.size(), 6);
    int found = 0;
    for (std::size_t k = 0; k < slots.size(); ++k)
      for (int slot = 0; slot < 6; ++slot)
        if (element.properties[k].name == names[slot] && !element.properties[k].count_type && !(found >> slot & 1))
          slots[k] = slot, found |= 1 << slot;
    if ((found & 7) != 7) values_.fail("its vertices lack one of the properties x, y and z");
    has_normals_ = found == 63;
    return slots;
  }

  void read_faces(const Element& element) {
    list_.triangles.reserve(element.count);
    for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i)
      for (const Property& property : element.properties) {
        const bool is_corners = property.name == "vertex_indices" || property.name == "vertex_index";
        if (is_corners && property.count_type)
          read_face(property);
        else
          skip(property);
      }
  }

  void read_face(const Property& property) {
    Fan fan(list_);
    for (std::uint64_t n = count(property); n > 0; --n) {
      const double i = values_.next(property.type);
      if (!(i >= 0 && i < double(header_.vertices) && i == std::floor(i)))
        values_.fail("face " + std::to_string(list_.triangles.size()) + " names vertex " + std::to_string(i) + " of " +
                     std::to_string(header_.vertices));
      fan.add(static_cast<std::uint32_t>(i));
    }
  }

  Values values_;
  const PlyHeader& header_;
  FaceList list_;
  bool has_normals_ = false;
};

}  // namespace

FaceList read_ply(std::string_view data, const std::filesystem::path& file) {
  Text text(data, file);
  const PlyHeader header = parse_header(text);
  if (header.format == Format::ascii) return Body(AsciiValues(text), header).read();
  const bool swap = (header.format == Format::big) == (std::endian::native == std::endian::little);
  return Body(BinaryValues(data.substr(text.offset()), file, swap), header).read();
}

}  // namespace rayengine
