#include "engine/load/json_document.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/load/place.h"
#include "engine/load/text.h"

namespace rayengine {
namespace {

constexpr std::size_t deepest = 64;

/// Goes through a text for the parser, which tells lines only of errors, and counts them for all that is read.
class LineCounter {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  LineCounter(const char* at, std::uint64_t* line) : at_(at), line_(line) {}
  reference operator*() const { return *at_; }
  LineCounter& operator++() {
    // A line ends when the character behind its end is read: a number's end is seen only after its line's.
    if (after_end_) ++*line_;
    after_end_ = *at_++ == '\n';
    return *this;
  }
  bool operator==(const LineCounter& other) const { return at_ == other.at_; }
  bool operator!=(const LineCounter& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  std::uint64_t* line_;
  bool after_end_ = false;
};

/// What the parser says, without its own codes and positions.
std::string detail(std::string message) {
  constexpr std::size_t longest = 160;
  message.erase(0, message.find("] ") + 2);
  if (message.starts_with("parse error at ")) message.erase(0, message.find(": ") + 2);
  if (message.size() > longest) message = message.substr(0, longest) + "...";
  return message;
}

class Builder : public nlohmann::json_sax<nlohmann::json> {
 public:
  Builder(const std::filesystem::path& file, const std::uint64_t& line) : file_(file), line_(line) {}

  JsonValue take() { return std::move(root_); }

  bool null() override { return add(nullptr), true; }
  bool boolean(bool value) override { return add(value), true; }
  bool number_integer(number_integer_t value) override { return add(static_cast<double>(value)), true; }
  bool number_unsigned(number_unsigned_t value) override { return add(static_cast<double>(value)), true; }
  bool number_float(number_float_t value, const string_t&) override { return add(value), true; }
  bool string(string_t& value) override { return add(std::move(value)), true; }
  bool binary(binary_t&) override { return false; }  // not in text
  bool start_object(std::size_t) override { return open(JsonValue::Object{}); }
  bool start_array(std::size_t) override { return open(JsonValue::List{}); }

  bool key(string_t& name) override {
    std::get<JsonValue::Object>(open_.back()->data).push_back({std::move(name), {line_, nullptr}});
    return true;
  }

  bool end_object() override {
    check_names(std::get<JsonValue::Object>(open_.back()->data));
    return end_array();
  }

  bool end_array() override {
    open_.pop_back();
    return true;
  }

  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& error) override {
    fail({file_, line_}, "not valid JSON: " + detail(error.what()));
  }

 private:
  template <class Data>
  JsonValue& add(Data data) {
    JsonValue& value = place_of_next();
    value.line = line_;
    value.data = std::move(data);
    return value;
  }

  JsonValue& place_of_next() {
    if (open_.empty()) return root_;
    if (auto* members = std::get_if<JsonValue::Object>(&open_.back()->data)) return members->back().value;
    return std::get<JsonValue::List>(open_.back()->data).emplace_back();
  }

  template <class Data>
  bool open(Data data) {
    if (open_.size() == deepest) fail({file_, line_}, "nested more than 64 deep");
    open_.push_back(&add(std::move(data)));
    return true;
  }

  void check_names(const JsonValue::Object& members) const {
    std::vector<const JsonMember*> sorted;
    for (const JsonMember& member : members) sorted.push_back(&member);
    std::stable_sort(sorted.begin(), sorted.end(), [](auto* a, auto* b) { return a->name < b->name; });
    const auto twice =
        std::adjacent_find(sorted.begin(), sorted.end(), [](auto* a, auto* b) { return a->name == b->name; });
    if (twice != sorted.end())
      fail({file_, twice[1]->value.line},
           "the key " + quoted(std::string_view(twice[1]->name)) + " comes twice; keep one");
  }

  const std::filesystem::path& file_;
  const std::uint64_t& line_;
  JsonValue root_;
  std::vector<JsonValue*> open_;  // objects and lists that have not ended; only the innermost grows, so these stay put
};

}  // namespace

JsonValue read_json(const std::filesystem::path& file) {
  const std::string text = read_file(file);
  std::uint64_t line = 1;
  Builder builder(file, line);
  nlohmann::json::sax_parse(LineCounter(text.data(), &line), LineCounter(text.data() + text.size(), &line), &builder);
  return builder.take();
}

}  // namespace rayengine
