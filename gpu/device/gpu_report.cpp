#include "gpu/device/gpu_report.h"

#include "accel/stopwatch.h"
#include "gpu/stream/stream_kernels.h"

namespace rayengine {
namespace {

/// Textures of nothing that claim to hold every type of primitive.
SceneTextures every_type(const GpuInfo& gpu) {
  const FlatScene nothing = flatten(GeometryBuilder().build());
  SceneTextures textures = upload(nothing, Treelets{}, gpu);
  textures.types = {TreeletPrimitive::triangle};
  for (std::uint32_t type = 0; type < quadric_type_count; ++type) textures.types.push_back(type);
  return textures;
}

/// Drivers put off much of the work to the first time that a program is drawn with.
void draw_once(const StreamKernels& kernels, const SceneTextures& textures) {
  StreamBatch batch(4);
  for (std::size_t i = 0; i < batch.capacity(); ++i) batch.lists()[i] = {0, 0, no_id, no_id};
  batch.upload(batch.capacity());
  kernels.run(batch, textures, 2);
  glFinish();
}

}  // namespace

GpuReport report_on_gpu(int device) {
  Context context(device);
  GpuReport report{context.info(), probe(context)};
  const SceneTextures textures = every_type(context.info());
  const Stopwatch watch;
  const StreamKernels kernels(textures, StreamQuery::closest, {});
  draw_once(kernels, textures);
  report.compile_seconds = watch.seconds();
  report.cached = kernels.cached();
  context.check_errors("the compilation of all shaders");
  return report;
}

}  // namespace rayengine
