#include "engine/measure/contestant.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <glm/geometric.hpp>
#include <vector>

#include "accel/surface.h"
#include "cpu/bare_embree.h"
#include "engine/measure/tessellate.h"
#include "engine/query.h"
#include "engine/tracers.h"

namespace rayengine {
namespace {

constexpr unsigned char poison_byte = 0xA5;
constexpr std::uint32_t poison_word = 0xA5A5A5A5u;

template <class T>
void fill_poison(std::vector<T>& answers, std::size_t count) {
  answers.resize(count);
  std::memset(static_cast<void*>(answers.data()), poison_byte, count * sizeof(T));
}

const std::uint32_t& written(const std::uint32_t& word, const std::string& who) {
  if (word == poison_word) throw Error("the tracer '" + who + "' left an answer unwritten: its figures mean nothing");
  return word;
}

class TracerContestant : public Contestant {
 public:
  explicit TracerContestant(std::unique_ptr<Tracer> tracer) : tracer_(std::move(tracer)) {}

  std::string name() const override { return std::string(tracer_->name()); }
  Precision precision() const override { return tracer_->precision(); }
  Limits limits() const override { return tracer_->limits(); }
  double build_seconds() const override { return tracer_->build_seconds(); }
  std::size_t bytes() const override { return tracer_->bytes(); }

  void poison(std::size_t rays) override { fill_poison(hits_, rays), fill_poison(status_, rays); }
  void closest(std::span<const Ray> rays, RayClass c) override { rayengine::closest(*tracer_, rays, hits_, c); }
  void any(std::span<const Ray> rays, RayClass c) override { rayengine::any(*tracer_, rays, status_, c); }
  Hit hit(std::size_t i) const override { return written(hits_[i].status, name()), hits_[i]; }
  std::uint32_t status(std::size_t i) const override { return written(status_[i], name()); }

 private:
  std::unique_ptr<Tracer> tracer_;
  std::vector<Hit> hits_;
  std::vector<std::uint32_t> status_;
};

constexpr std::array<std::string_view, 3> yardstick_names = {"embree-bare", "embree-sphere", "embree-tess"};
constexpr int yardstick_level = 3;  // 512 triangles a sphere

class BareContestant : public Contestant {
 public:
  BareContestant(std::string name, std::shared_ptr<const Geometry> geometry, BareShape shape, Precision precision)
      : name_(std::move(name)),
        precision_(precision),
        embree_(std::move(geometry), shape, precision == Precision::robust) {}

  std::string name() const override { return name_; }
  Precision precision() const override { return precision_; }
  Limits limits() const override { return {.triangle_roundoff = 0x1p-24, .quadric_roundoff = 0x1p-24}; }
  double build_seconds() const override { return embree_.build_seconds(); }
  std::size_t bytes() const override { return embree_.bytes(); }

  void poison(std::size_t rays) override { fill_poison(hits_, rays), fill_poison(status_, rays); }
  void closest(std::span<const Ray> rays, RayClass c) override {
    for_batches(rays, [&](std::size_t first, std::size_t count) {
      embree_.closest(rays.subspan(first, count), std::span(hits_).subspan(first, count), c);
    });
  }
  void any(std::span<const Ray> rays, RayClass c) override {
    for_batches(rays, [&](std::size_t first, std::size_t count) {
      embree_.any(rays.subspan(first, count), std::span(status_).subspan(first, count), c);
    });
  }
  Hit hit(std::size_t i) const override { return written(hits_[i].geometry, name_), embree_.hit(hits_[i]); }
  std::uint32_t status(std::size_t i) const override { return written(status_[i], name_); }

 private:
  template <class Body>
  void for_batches(std::span<const Ray> rays, const Body& body) const {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rays.size(), limits().batch),
                      [&](const auto& range) { body(range.begin(), range.size()); });
  }

  std::string name_;
  Precision precision_;
  BareEmbree embree_;
  std::vector<BareHit> hits_;
  std::vector<std::uint32_t> status_;
};

class TessellatedContestant final : public BareContestant {
 public:
  TessellatedContestant(std::string name, std::shared_ptr<const Geometry> exact, Tessellation made, Precision precision)
      : BareContestant(std::move(name), made.geometry, BareShape::triangles, precision),
        exact_(std::move(exact)),
        made_(std::move(made)) {}

  Hit hit(std::size_t i) const override {
    Hit hit = BareContestant::hit(i);
    if (!hit.hit()) return hit;
    const std::uint32_t triangle = made_.geometry->objects[hit.object].first + hit.primitive;
    hit.normal = glm::vec3(glm::normalize(triangle_normal(*made_.geometry, triangle)));
    if (exact_->objects[hit.object].kind == Object::Kind::quadric)
      hit.primitive = made_.parts[triangle], hit.u = hit.v = 0;
    return hit;
  }

 private:
  std::shared_ptr<const Geometry> exact_;
  Tessellation made_;
};

bool held_by_embree(Precision precision) { return precision == Precision::fast || precision == Precision::robust; }

}  // namespace

std::span<const std::string_view> yardsticks() { return yardstick_names; }

std::unique_ptr<Contestant> make_contestant(std::unique_ptr<Tracer> tracer) {
  return std::make_unique<TracerContestant>(std::move(tracer));
}

std::unique_ptr<Contestant> make_tessellated(std::string name, std::shared_ptr<const Geometry> geometry, int level,
                                             Precision precision) {
  if (!held_by_embree(precision)) return nullptr;
  std::optional<Tessellation> made = tessellate(*geometry, level);
  if (!made) return nullptr;
  return std::make_unique<TessellatedContestant>(std::move(name), std::move(geometry), std::move(*made), precision);
}

std::unique_ptr<Contestant> make_contestant(const std::string& name, std::shared_ptr<const Geometry> geometry,
                                            Precision precision, int threads) {
  if (std::ranges::find(yardstick_names, name) == yardstick_names.end())
    return make_contestant(make_tracer(name, std::move(geometry), {precision, threads}));
  if (name == "embree-tess") return make_tessellated(name, std::move(geometry), yardstick_level, precision);
  const BareShape shape = name == "embree-bare" ? BareShape::triangles : BareShape::spheres;
  if (!held_by_embree(precision) || !BareEmbree::holds(*geometry, shape)) return nullptr;
  return std::make_unique<BareContestant>(name, std::move(geometry), shape, precision);
}

}  // namespace rayengine
