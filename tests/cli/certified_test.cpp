// Precision `certified` promises the same picture whichever tracer is asked.

#include <gtest/gtest.h>

#include "engine/tracers.h"
#include "tests/cli/command.h"
#include "tests/temporary.h"

namespace rayengine {
namespace {

class CliCertified : public testing::TestWithParam<const char*> {
 protected:
  /// The PNG file, whole, that a tracer makes of the scene.
  std::string picture(std::string_view tracer) const {
    const std::string scene = SOURCE_DIR "/scenes/" + std::string(GetParam()) + ".json";
    const test::Outcome outcome = test::rayengine(
        folder_.path(),
        "render '" + scene + "' -o a.png -q --size 40x40 --precision certified --tracer " + std::string(tracer));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return test::content(folder_.path() / "a.png");
  }

  test::TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Scenes, CliCertified, testing::Values("gallery", "glass", "cornell"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(CliCertified, EveryTracerDrawsTheSamePicture) {
  const std::string expected = picture("bvh");
  ASSERT_GT(expected.size(), 1000u);
  for (const TracerInfo& tracer : tracer_list()) {
    if (tracer.name == "reference") continue;  // its t is exact, rounded once: not the bits of double arithmetic
    EXPECT_TRUE(picture(tracer.name) == expected) << tracer.name;
  }
}

}  // namespace
}  // namespace rayengine
