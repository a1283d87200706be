#pragma once

#include <array>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "engine/load/json_document.h"
#include "engine/load/place.h"

namespace rayengine {

/// A value of a JSON file under the name that messages give it. Reading it as what it is not throws Error with its
/// line. File, value and name must outlive the view.
class JsonView {
 public:
  JsonView(const std::filesystem::path& file, const JsonValue& value, std::string_view name)
      : file_(&file), value_(&value), name_(name) {}

  Place place() const { return {*file_, value_->line}; }
  std::string_view name() const { return name_; }

  bool is_number() const { return std::holds_alternative<double>(value_->data); }
  bool is_list() const { return std::holds_alternative<JsonValue::List>(value_->data); }

  double number() const;
  int integer(int lowest, int highest) const;
  /// A number that is not negative and fits single precision.
  float factor() const;
  bool boolean() const;
  const std::string& string() const;
  /// Elements and members bear the list's, and their own, name.
  std::vector<JsonView> list() const;
  std::vector<JsonView> members() const;

  template <std::size_t N>
  std::array<double, N> numbers() const {
    const std::vector<JsonView> elements = list_of(N, "numbers");
    std::array<double, N> result;
    for (std::size_t i = 0; i < N; ++i) result[i] = elements[i].number();
    return result;
  }
  glm::dvec3 vector() const;
  glm::vec3 color() const;
  /// A list of exactly `count` elements; `what` they are, for the message.
  std::vector<JsonView> list_of(std::size_t count, std::string_view what) const;

 private:
  template <class T>
  const T& as(std::string_view wanted) const;

  const std::filesystem::path* file_;
  const JsonValue* value_;
  std::string_view name_;
};

/// The members of a JSON object, asked for by name; what nobody asked for is an error.
class JsonFields {
 public:
  explicit JsonFields(const JsonView& object) : object_(object), members_(object.members()) {}

  /// The place of the object itself.
  Place place() const { return object_.place(); }
  std::optional<JsonView> find(std::string_view name);
  /// Throws Error, with the object's line, when there is none.
  JsonView need(std::string_view name);
  /// Reads the member into `value` by `read`, a function of JsonView; without the member, `value` stays.
  template <class T, class Read>
  void read(std::string_view name, T& value, const Read& read) {
    if (const auto member = find(name)) value = std::invoke(read, *member);
  }
  /// Throws Error for the first member that was not asked for, and says which could be.
  void finish() const;

 private:
  JsonView object_;
  std::vector<JsonView> members_;
  std::vector<std::string_view> known_;
};

}  // namespace rayengine
