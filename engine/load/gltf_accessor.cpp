#include "engine/load/gltf_accessor.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "accel/tracer.h"

namespace rayengine {
namespace {

constexpr std::size_t max_zeros = std::size_t{1} << 24;  // elements of an accessor that no buffer backs

template <class T>
double load(const unsigned char* bytes, bool normalised) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  if (!normalised || std::is_floating_point_v<T>) return static_cast<double>(value);
  return std::max(static_cast<double>(value) / std::numeric_limits<T>::max(), -1.0);
}

double load(const unsigned char* bytes, int type, bool normalised) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return load<std::int8_t>(bytes, normalised);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return load<std::uint8_t>(bytes, normalised);
    case TINYGLTF_COMPONENT_TYPE_SHORT: return load<std::int16_t>(bytes, normalised);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return load<std::uint16_t>(bytes, normalised);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return load<std::uint32_t>(bytes, normalised);
    default: return load<float>(bytes, normalised);
  }
}

bool is_unsigned(int type) {
  return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

std::size_t component_size(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT: return 4;
    default: return 0;
  }
}

class AccessorReader {
 public:
  AccessorReader(const tinygltf::Model& model, int index) : model_(model), name_("accessor " + std::to_string(index)) {
    if (index < 0 || static_cast<std::size_t>(index) >= model.accessors.size()) fail("does not exist");
    accessor_ = &model.accessors[static_cast<std::size_t>(index)];
    if (component_size(accessor_->componentType) == 0) fail("has an unknown component type");
  }

  const tinygltf::Accessor& accessor() const { return *accessor_; }

  /// All components in order, `components` to an element.
  std::vector<double> read(std::size_t components) const {
    const tinygltf::Accessor& a = *accessor_;
    std::vector<double> values;
    if (a.bufferView >= 0) {
      values = read_view(a.bufferView, a.byteOffset, a.componentType, a.count, components, true);
    } else {
      if (a.count > max_zeros) fail("has too many elements and no data");
      values.resize(a.count * components);
    }
    if (a.sparse.isSparse) substitute(values, components);
    return values;
  }

  [[noreturn]] void fail(const std::string& what) const { throw Error(name_ + " " + what + ": save the file anew"); }

 private:
  std::vector<double> read_view(int view_index, std::size_t offset, int type, std::size_t count, std::size_t components,
                                bool strided) const {
    if (view_index < 0 || static_cast<std::size_t>(view_index) >= model_.bufferViews.size())
      fail("names a buffer view that does not exist");
    const tinygltf::BufferView& view = model_.bufferViews[static_cast<std::size_t>(view_index)];
    const std::size_t element = component_size(type) * components;
    const std::size_t stride = strided && view.byteStride ? view.byteStride : element;
    const unsigned char* first = checked(view, offset, element, stride, count);
    std::vector<double> values;
    values.reserve(count * components);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t c = 0; c < components; ++c)
        values.push_back(load(first + i * stride + c * component_size(type), type, accessor_->normalized));
    return values;
  }

  // No product or sum may run over: every number comes from the file.
  const unsigned char* checked(const tinygltf::BufferView& view, std::size_t offset, std::size_t element,
                               std::size_t stride, std::size_t count) const {
    if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model_.buffers.size())
      fail("names a buffer that does not exist");
    const auto& data = model_.buffers[static_cast<std::size_t>(view.buffer)].data;
    const bool view_fits = view.byteOffset <= data.size() && view.byteLength <= data.size() - view.byteOffset;
    const std::size_t room = view_fits && offset <= view.byteLength ? view.byteLength - offset : 0;
    if (count > 0 && (room < element || stride < element || (count - 1) > (room - element) / stride))
      fail("reaches beyond its buffer");
    return data.data() + (count > 0 ? view.byteOffset + offset : 0);
  }

  void substitute(std::vector<double>& values, std::size_t components) const {
    const auto& sparse = accessor_->sparse;
    if (sparse.count < 0 || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0 ||
        !is_unsigned(sparse.indices.componentType))
      fail("has sparse values that are not sound");
    const auto count = static_cast<std::size_t>(sparse.count);
    const std::vector<double> where =
        read_view(sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset),
                  sparse.indices.componentType, count, 1, false);
    const std::vector<double> what =
        read_view(sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset),
                  accessor_->componentType, count, components, false);
    for (std::size_t i = 0; i < count; ++i) {
      if (where[i] >= double(accessor_->count)) fail("has a sparse index out of range");
      std::copy_n(what.data() + i * components, components, values.data() + std::size_t(where[i]) * components);
    }
  }

  const tinygltf::Model& model_;
  std::string name_;
  const tinygltf::Accessor* accessor_ = nullptr;
};

}  // namespace

std::vector<glm::dvec3> read_vectors(const tinygltf::Model& model, int index) {
  const AccessorReader reader(model, index);
  if (reader.accessor().type != TINYGLTF_TYPE_VEC3) reader.fail("does not hold vectors of three");
  const std::vector<double> values = reader.read(3);
  std::vector<glm::dvec3> vectors(values.size() / 3);
  for (std::size_t i = 0; i < vectors.size(); ++i) vectors[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
  return vectors;
}

std::vector<std::uint32_t> read_indices(const tinygltf::Model& model, int index) {
  const AccessorReader reader(model, index);
  const tinygltf::Accessor& accessor = reader.accessor();
  if (accessor.type != TINYGLTF_TYPE_SCALAR || !is_unsigned(accessor.componentType) || accessor.normalized)
    reader.fail("does not hold indices");
  const std::vector<double> values = reader.read(1);
  return {values.begin(), values.end()};
}

}  // namespace rayengine
