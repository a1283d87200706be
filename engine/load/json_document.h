#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace rayengine {

struct JsonMember;

/// A value of a JSON file that knows its line, as every message about it needs.
struct JsonValue {
  using List = std::vector<JsonValue>;
  using Object = std::vector<JsonMember>;  ///< in file order; no name twice

  std::uint64_t line = 1;
  std::variant<std::nullptr_t, bool, double, std::string, List, Object> data;
};

struct JsonMember {
  std::string name;
  JsonValue value;
};

/// Reads a JSON file. Throws Error, with the line, on what is not valid JSON, on numbers beyond double precision, on a
/// name twice in one object, and on values nested more than 64 deep.
JsonValue read_json(const std::filesystem::path& file);

}  // namespace rayengine
