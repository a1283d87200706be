#include "engine/load/json_view.h"

#include <algorithm>
#include <cmath>

#include "engine/load/text.h"

namespace rayengine {
namespace {

constexpr std::string_view kinds[] = {"null", "true or false", "a number", "a string", "a list", "an object"};

}  // namespace

template <class T>
const T& JsonView::as(std::string_view wanted) const {
  if (const T* data = std::get_if<T>(&value_->data)) return *data;
  fail(place(), "expected " + std::string(wanted) + " for " + quoted(name_) + ", got " +
                    std::string(kinds[value_->data.index()]));
}

double JsonView::number() const { return as<double>("a number"); }
bool JsonView::boolean() const { return as<bool>("true or false"); }
const std::string& JsonView::string() const { return as<std::string>("a string"); }

int JsonView::integer(int lowest, int highest) const {
  const double value = number();
  if (value != std::floor(value) || value < lowest || value > highest)
    fail(place(), "expected a whole number from " + std::to_string(lowest) + " to " + std::to_string(highest) +
                      " for " + quoted(name_));
  return static_cast<int>(value);
}

float JsonView::factor() const {
  const auto value = static_cast<float>(number());
  if (!(value >= 0 && std::isfinite(value))) fail(place(), quoted(name_) + " is negative or too large");
  return value;
}

std::vector<JsonView> JsonView::list() const {
  std::vector<JsonView> elements;
  for (const JsonValue& value : as<JsonValue::List>("a list")) elements.emplace_back(*file_, value, name_);
  return elements;
}

std::vector<JsonView> JsonView::members() const {
  std::vector<JsonView> members;
  for (const JsonMember& member : as<JsonValue::Object>("an object"))
    members.emplace_back(*file_, member.value, member.name);
  return members;
}

std::vector<JsonView> JsonView::list_of(std::size_t count, std::string_view what) const {
  std::vector<JsonView> elements = list();
  if (elements.size() != count)
    fail(place(), "expected " + std::to_string(count) + " " + std::string(what) + " for " + quoted(name_) + ", got " +
                      std::to_string(elements.size()));
  return elements;
}

glm::dvec3 JsonView::vector() const {
  const auto [x, y, z] = numbers<3>();
  return {x, y, z};
}

glm::vec3 JsonView::color() const {
  const std::vector<JsonView> rgb = list_of(3, "numbers");
  return {rgb[0].factor(), rgb[1].factor(), rgb[2].factor()};
}

std::optional<JsonView> JsonFields::find(std::string_view name) {
  known_.push_back(name);
  const auto found =
      std::find_if(members_.begin(), members_.end(), [&](const JsonView& m) { return m.name() == name; });
  return found == members_.end() ? std::nullopt : std::optional(*found);
}

JsonView JsonFields::need(std::string_view name) {
  if (const auto member = find(name)) return *member;
  fail(object_.place(), quoted(object_.name()) + " lacks " + quoted(name) + "; give it one");
}

void JsonFields::finish() const {
  for (const JsonView& member : members_) {
    if (std::find(known_.begin(), known_.end(), member.name()) != known_.end()) continue;
    std::string message = "unknown key " + quoted(member.name()) + " in " + quoted(object_.name()) + "; use";
    for (const std::string_view name : known_) message += (name == known_.front() ? " " : ", ") + std::string(name);
    fail(member.place(), message);
  }
}

}  // namespace rayengine
