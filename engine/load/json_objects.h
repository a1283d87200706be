#pragma once

#include <map>
#include <optional>

#include "accel/geometry.h"
#include "engine/load/json_view.h"

namespace rayengine {

/// Makes geometry of the lists of objects in a scene file and in its groups.
class JsonObjects {
 public:
  using MaterialIndices = std::map<std::string, std::uint32_t, std::less<>>;

  /// `groups` is the scene's object of groups, if it has one. Repairs to meshes go to `notes`.
  JsonObjects(std::filesystem::path folder, const MaterialIndices& materials, const std::optional<JsonView>& groups,
              std::vector<std::string>& notes);

  /// Throws Error, with the line, on all that is wrong in the list and in the groups that it places.
  std::shared_ptr<const Geometry> build(const JsonView& list);
  /// Builds the groups that nobody placed, so that what is wrong in them is found as well.
  void build_groups();

 private:
  struct Group {
    JsonView value;
    std::shared_ptr<const Geometry> geometry;
    bool is_open = false;  ///< is being built
  };

  void check_size(const std::vector<JsonView>& objects);
  void add(GeometryBuilder& builder, const JsonView& object);
  void add_quadric(GeometryBuilder& builder, JsonFields& fields, QuadricType type) const;
  void add_mesh(GeometryBuilder& builder, JsonFields& fields, const Mesh& mesh) const;
  void add_instance(GeometryBuilder& builder, JsonFields& fields);
  std::uint32_t material(JsonFields& fields) const;
  const Mesh& read_mesh(JsonFields& fields);
  std::shared_ptr<const Geometry> group(const JsonView& value);
  void build(Group& group);

  std::filesystem::path folder_;
  const MaterialIndices& materials_;
  std::map<std::string, Group, std::less<>> groups_;
  std::map<std::filesystem::path, Mesh> meshes_;  // by file: several objects may be of one
  std::vector<std::string>& notes_;
  int depth_ = 0;
};

}  // namespace rayengine
