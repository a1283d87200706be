#include "engine/load/json_camera.h"

#include "engine/load/complete.h"
#include "engine/load/load.h"
#include "engine/load/text.h"

namespace rayengine {
namespace {

/// `key` begins as the key before left it, one step later.
void read_key(const JsonView& value, CameraKey& key) {
  JsonFields fields(value);
  fields.read("time", key.time, &JsonView::number);
  read_pose(fields, key.camera);
  fields.finish();
  at_place(value.place(), [&] { check(key.camera); });
}

}  // namespace

bool read_pose(JsonFields& fields, Camera& camera) {
  const auto from = fields.find("from"), at = fields.find("at");
  if (from) camera.from = from->vector();
  if (at) camera.at = at->vector();
  fields.read("up", camera.up, &JsonView::vector);
  fields.read("fov", camera.fov, &JsonView::number);
  return from || at;
}

std::vector<CameraKey> load_camera_path(const std::filesystem::path& file, const Camera& start) {
  const JsonValue document = read_json(file);
  const JsonView list(file, document, "path");
  std::vector<CameraKey> keys;
  CameraKey key{-1, start};
  for (const JsonView& value : list.list()) {
    const double before = key.time++;
    read_key(value, key);
    if (!keys.empty() && !(key.time > before)) fail(value.place(), "the times of a path's keys must rise");
    keys.push_back(key);
  }
  if (keys.size() < 2)
    fail(list.place(),
         "a path needs at least two keys, got " + std::to_string(keys.size()) + "; use [{\"from\": ...}, ...]");
  return keys;
}

}  // namespace rayengine
