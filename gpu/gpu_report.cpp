#include "gpu/gpu_report.h"

#include "gpu/stream_kernels.h"

namespace rayengine {

GpuReport report_on_gpu(int device) {
  Context context(device);
  GpuReport report{context.info(), probe(context), 0};
  SceneTextures every_type;
  every_type.types.push_back(TreeletPrimitive::triangle);
  for (KernelType type = 0; type < quadric_type_count; ++type) every_type.types.push_back(type);
  report.compile_seconds = StreamKernels(every_type, StreamQuery::closest, {}).compile_seconds();
  context.check_errors("the compilation of all shaders");
  return report;
}

}  // namespace rayengine
