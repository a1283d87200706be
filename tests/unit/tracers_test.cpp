#include "engine/tracers.h"

#include <gtest/gtest.h>

#include "render_scenes.h"

namespace rayengine::test {
namespace {

std::shared_ptr<const Geometry> a_sphere() {
  GeometryBuilder builder;
  builder.add(unit_sphere);
  return builder.build();
}

std::string refusal(std::string_view name, Precision precision) {
  try {
    make_tracer(name, a_sphere(), {.precision = precision});
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Tracers, TheListNamesEachOnce) {
  const auto list = tracer_list();
  for (const TracerInfo& info : list) {
    EXPECT_FALSE(info.summary.empty());
    EXPECT_EQ(std::count_if(list.begin(), list.end(), [&](const TracerInfo& i) { return i.name == info.name; }), 1);
  }
}

TEST(Tracers, AutoIsOneOfThem) {
  const auto tracer = make_tracer("auto", a_sphere());
  EXPECT_TRUE(tracer->name() == "embree" || tracer->name() == "hybrid");  // where there is a GPU
  EXPECT_EQ(tracer->precision(), Precision::robust);
}

TEST(Tracers, UnknownNamesAreToldTheKnownOnes) {
  const std::string message = refusal("embre", Precision::robust);
  EXPECT_NE(message.find("'embre'"), std::string::npos);
  for (const TracerInfo& info : tracer_list()) EXPECT_NE(message.find(info.name), std::string::npos) << info.name;
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

TEST(Tracers, ImpossiblePrecisionsAreToldThePossible) {
  const std::string message = refusal("embree", Precision::half);
  EXPECT_NE(message.find("half"), std::string::npos);
  EXPECT_NE(message.find("robust"), std::string::npos);
  EXPECT_NE(message.find("fast"), std::string::npos);
}

TEST(Tracers, TheOracleHoldsEveryPrecision) {
  for (const Precision precision : {Precision::half, Precision::fast, Precision::robust, Precision::certified})
    EXPECT_EQ(make_tracer("reference", a_sphere(), {.precision = precision})->precision(), Precision::certified);
}

}  // namespace
}  // namespace rayengine::test
