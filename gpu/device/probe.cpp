#include "gpu/device/probe.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <functional>
#include <random>

#include "accel/tracer.h"
#include "gpu/device/context.h"
#include "gpu/device/program.h"

namespace rayengine {
namespace {

constexpr int side = 64;  // answers come as a square of this many texels

struct Operands {
  float a, b, c;
  std::uint32_t unused = 0;
};
using Answers = std::vector<float>;

/// Operands of mixed signs and exponents, whose sums and products stay far from overflow and underflow.
std::vector<Operands> ordinary_operands() {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> mantissa(1, 2), offset(-4, 4);
  std::uniform_int_distribution<int> exponent(-12, 12);
  std::vector<Operands> result(side * side);
  for (Operands& o : result) {
    o.a = std::ldexp(mantissa(random), exponent(random));
    o.b = -std::ldexp(mantissa(random), exponent(random));
    o.c = -o.a * o.b * (1 + std::ldexp(offset(random), -20));  // near cancellation shows a missing rounding
  }
  return result;
}

/// Products of these are denormal.
std::vector<Operands> tiny_operands() {
  std::vector<Operands> result = ordinary_operands();
  for (Operands& o : result) o = {std::ldexp(std::abs(o.a), -70), std::ldexp(1.5f, -66), 0};
  return result;
}

/// Asks one stage questions about lists of operands.
class Questioner {
 public:
  explicit Questioner(bool compute) : compute_(compute), results_(make_texture(GL_R32UI, side, side)) {
    glNamedFramebufferTexture(frame_.id(), GL_COLOR_ATTACHMENT0, results_.object.id(), 0);
  }

  Answers ask(const std::string& question, const std::vector<Operands>& operands) {
    const BufferTexture input = make_buffer_texture(GL_RGBA32UI, operands);
    input.bind(0);
    const std::vector<std::string> defines{"QUESTION=" + question, "SIDE=" + std::to_string(side)};
    compute_ ? dispatch(defines) : draw(defines);
    Answers answers(side * side);
    glGetTextureImage(results_.object.id(), 0, GL_RED_INTEGER, GL_UNSIGNED_INT, side * side * 4, answers.data());
    return answers;
  }

 private:
  void draw(const std::vector<std::string>& defines) {
    const Program program = make_screen_program(
        "probe", {0, {"gpu/shaders/probe/arithmetic.glsl", "gpu/shaders/probe/probe.frag.glsl"}, defines});
    program.use();
    glBindFramebuffer(GL_FRAMEBUFFER, frame_.id());
    glBindVertexArray(vertices_.id());
    glViewport(0, 0, side, side);
    draw_everywhere();
  }

  void dispatch(const std::vector<std::string>& defines) {
    const Program program(
        "probe",
        {{GL_COMPUTE_SHADER, {"gpu/shaders/probe/arithmetic.glsl", "gpu/shaders/probe/probe.comp.glsl"}, defines}});
    program.use();
    glBindImageTexture(0, results_.object.id(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_R32UI);
    glDispatchCompute(side, 1, 1);
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
  }

  bool compute_;
  Framebuffer frame_ = make_framebuffer();
  VertexArray vertices_ = make_vertex_array();
  Texture results_;
};

bool all(const std::vector<Operands>& operands, const Answers& answers,
         const std::function<float(const Operands&)>& right) {
  for (std::size_t i = 0; i < operands.size(); ++i)
    if (answers[i] != right(operands[i])) return false;
  return true;
}

double largest_ulps(const std::vector<Operands>& operands, const Answers& answers,
                    const std::function<double(const Operands&)>& right) {
  double largest = 0;
  for (std::size_t i = 0; i < operands.size(); ++i) {
    const double exact = right(operands[i]);
    const double ulp = std::ldexp(1.0, std::ilogb(exact) - 23);
    largest = std::max(largest, std::abs(answers[i] - exact) / ulp);
  }
  return largest;
}

float twice_rounded(const Operands& o) { return o.a * o.b + o.c; }

ArithmeticProbe probe_stage(bool compute) {
  Questioner stage(compute);
  const std::vector<Operands> usual = ordinary_operands(), tiny = tiny_operands();
  const auto exact_product = [](const Operands& o) { return static_cast<double>(o.a) * o.b; };
  ArithmeticProbe p;
  p.stage = compute ? "compute" : "fragment";
  p.contracts = !all(usual, stage.ask("contraction", usual), twice_rounded);
  p.precise_holds = all(usual, stage.ask("precise_product_sum", usual), twice_rounded);
  p.fma_fused = all(usual, stage.ask("fused", usual), [](const Operands& o) { return std::fma(o.a, o.b, o.c); });
  p.two_sum_exact = all(usual, stage.ask("two_sum", usual), [](const Operands& o) {
    return static_cast<float>((static_cast<double>(o.a) + o.b) - (o.a + o.b));
  });
  p.dekker_exact = all(usual, stage.ask("dekker", usual),
                       [&](const Operands& o) { return static_cast<float>(exact_product(o) - o.a * o.b); });
  p.denormals_kept = all(tiny, stage.ask("tiny", tiny), [](const Operands& o) { return o.a * o.b; });
  p.division_ulps = largest_ulps(usual, stage.ask("quotient", usual),
                                 [](const Operands& o) { return static_cast<double>(o.a) / o.b; });
  p.sqrt_ulps = largest_ulps(usual, stage.ask("square_root", usual),
                             [](const Operands& o) { return std::sqrt(std::abs(static_cast<double>(o.a))); });
  return p;
}

/// Draws at a depth that differs from the buffer's, then at one that equals it, counting samples and invocations.
void probe_depth(GpuProbe& p) {
  const Program program = make_screen_program("early depth test", {0, {"gpu/shaders/probe/early.frag.glsl"}, {}});
  const Texture color = make_texture(GL_R32UI, side, side), depth = make_texture(GL_DEPTH_COMPONENT32F, side, side);
  const Framebuffer frame = make_framebuffer();
  const VertexArray vertices = make_vertex_array();
  glNamedFramebufferTexture(frame.id(), GL_COLOR_ATTACHMENT0, color.object.id(), 0);
  glNamedFramebufferTexture(frame.id(), GL_DEPTH_ATTACHMENT, depth.object.id(), 0);
  glBindFramebuffer(GL_FRAMEBUFFER, frame.id());
  glBindVertexArray(vertices.id());
  glViewport(0, 0, side, side);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  constexpr float state = 0.25f;
  glClearNamedFramebufferfv(frame.id(), GL_DEPTH, 0, &state);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_EQUAL);
  const std::array<std::uint32_t, 4> zero{};
  const Buffer counter = make_buffer(std::as_bytes(std::span(zero)));
  glBindBufferBase(GL_ATOMIC_COUNTER_BUFFER, 0, counter.object.id());
  program.use();
  const auto draw = [&](float at) {
    const Query query = make_query(GL_SAMPLES_PASSED);
    glBeginQuery(GL_SAMPLES_PASSED, query.id());
    draw_everywhere(at);
    glEndQuery(GL_SAMPLES_PASSED);
    GLuint64 samples = 0;
    glGetQueryObjectui64v(query.id(), GL_QUERY_RESULT, &samples);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    std::uint32_t invocations = 0;
    glGetNamedBufferSubData(counter.object.id(), 0, sizeof invocations, &invocations);
    return std::pair(samples, invocations);
  };
  const auto failing = draw(0.5f), passing = draw(state);
  glDisable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  p.early_depth_test = failing.second == 0 && passing.second >= side * side;
  p.query_counts = failing.first == 0 && passing.first == side * side;
}

}  // namespace

std::vector<std::string> GpuProbe::refusals() const {
  std::vector<std::string> result;
  for (const ArithmeticProbe& s : stages)
    if (s.stage == "fragment" && !s.precise_holds)
      result.push_back("fragment shaders contract a * b + c despite `precise`");
  if (!early_depth_test) result.push_back("the early depth test does not keep fragments from being shaded");
  if (!query_counts) result.push_back("occlusion queries count wrong");
  return result;
}

GpuProbe probe(Context& context) {
  GpuProbe result;
  for (const bool compute : {false, true}) result.stages.push_back(probe_stage(compute));
  probe_depth(result);
  context.check_errors("the arithmetic probe");
  return result;
}

void require_usable(Context& context) {
  GpuProbe asked;
  const std::vector<Operands> usual = ordinary_operands();
  ArithmeticProbe& fragment = asked.stages.emplace_back();
  fragment.stage = "fragment";
  fragment.precise_holds = all(usual, Questioner(false).ask("precise_product_sum", usual), twice_rounded);
  probe_depth(asked);
  context.check_errors("the arithmetic probe");
  std::string reasons;
  for (const std::string& refusal : asked.refusals()) reasons += (reasons.empty() ? "" : "; ") + refusal;
  if (!reasons.empty())
    throw Error("the GPU (" + context.info().renderer + ") cannot be used: " + reasons + "; use --tracer embree");
}

std::vector<std::pair<std::string, std::string>> describe(const GpuProbe& probe) {
  const auto yes = [](bool b) { return b ? "yes" : "no"; };
  std::vector<std::pair<std::string, std::string>> facts;
  for (const ArithmeticProbe& s : probe.stages) {
    char line[240];
    std::snprintf(line, sizeof line,
                  "fma fused %s, contracts %s, precise holds %s, TwoSum exact %s, Dekker exact %s, denormals kept %s, "
                  "division %.2f ulp, sqrt %.2f ulp",
                  yes(s.fma_fused), yes(s.contracts), yes(s.precise_holds), yes(s.two_sum_exact), yes(s.dekker_exact),
                  yes(s.denormals_kept), s.division_ulps, s.sqrt_ulps);
    facts.emplace_back(s.stage, line);
  }
  facts.emplace_back("early_depth_test",
                     std::string(yes(probe.early_depth_test)) + ", with query " + yes(probe.query_counts));
  for (const std::string& refusal : probe.refusals()) facts.emplace_back("refused", refusal);
  return facts;
}

}  // namespace rayengine
