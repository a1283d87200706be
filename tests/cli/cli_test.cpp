#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "accel/ray.h"
#include "engine/load/image_io.h"
#include "engine/load/npy.h"
#include "tests/cli/command.h"
#include "tests/temporary.h"

namespace rayengine {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Two unit spheres on the z axis, one behind the other, and a square below them; a mirror among them.
constexpr const char* scene_nff = R"(b 0.1 0.2 0.4
v
from 0 -8 1
at 0 0 1
up 0 0 1
angle 45
hither 0
resolution 48 32
l 3 -5 8
f 1 0.5 0.25 0.7 0.3 20 0 1
s 0 0 0 1
s 0 0 5 1
p 4
-4 -4 -1
4 -4 -1
4 4 -1
-4 4 -1
)";

class Cli : public testing::Test {
 protected:
  Cli() { folder_.write("scene.nff", scene_nff); }

  test::Outcome run(const std::string& arguments) const { return test::rayengine(folder_.path(), arguments); }
  fs::path file(const std::string& name) const { return folder_.path() / name; }
  json parse(const std::string& name) const { return json::parse(test::content(file(name))); }
  std::ptrdiff_t files() const {
    return std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator());
  }

  /// Fails with this exit code and one line that says `what`, and leaves no file.
  void expect_failure(int code, const std::string& arguments, const std::string& what) const {
    const auto before = files();
    const test::Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, code) << arguments;
    EXPECT_TRUE(outcome.one_line_error()) << arguments << "\n" << outcome.err;
    EXPECT_NE(outcome.err.find(what), std::string::npos) << arguments << "\n" << outcome.err;
    EXPECT_EQ(files(), before) << arguments;
  }

  test::TemporaryFolder folder_;
};

using CliUsage = Cli;
using CliFailure = Cli;
using CliRender = Cli;
using CliTrace = Cli;
using CliCompare = Cli;
using CliBench = Cli;
using CliInfo = Cli;

TEST_F(CliUsage, HelpOnEveryLevelHasExamplesAndDefaults) {
  for (const std::string sub : {"", "render", "trace", "compare", "bench", "chart", "stress", "paper", "info"}) {
    const test::Outcome help = run(sub + " --help");
    EXPECT_EQ(help.code, 0) << sub;
    EXPECT_NE(help.out.find("Examples:"), std::string::npos) << sub;
    EXPECT_TRUE(help.err.empty()) << help.err;
  }
  EXPECT_NE(run("render --help").out.find("--precision P=robust"), std::string::npos);
}

TEST_F(CliUsage, VersionIsOneLine) {
  const test::Outcome version = run("--version");
  EXPECT_EQ(version.code, 0);
  EXPECT_TRUE(version.out.starts_with("rayengine ")) << version.out;
}

TEST_F(CliUsage, WrongArgumentsExitWith2AndSayWhatIsValid) {
  expect_failure(2, "", "render, trace, compare, bench, chart, stress, plan, paper or info");
  expect_failure(2, "frobnicate", "frobnicate");
  expect_failure(2, "render scene.nff --frobnicate", "--frobnicate");
  expect_failure(2, "render scene.nff --tracer nobody", "choose among auto, embree");
  expect_failure(2, "render scene.nff --precision perfect", "half, fast, robust, certified");
  expect_failure(2, "render scene.nff --shading flat", "full or direct");
  expect_failure(2, "render scene.nff --spp 0", "--spp");
  expect_failure(2, "render scene.nff --threads -1", "--threads");
  for (const char* size : {"0x0", "100000x100000", "12", "x", "12x", "12xab", "12x-3", "1e3x5", "99999999999x1"})
    expect_failure(2, std::string("render scene.nff --size ") + size, "WIDTHxHEIGHT");
  expect_failure(2, "render scene.nff -o a.exr --aov depth,colour",
                 "depth,normal,object,primitive,position,error,status");
  expect_failure(2, "render scene.nff -o a.png --aov depth", ".exr");
  expect_failure(2, "trace scene.nff", "--rays");
  expect_failure(2, "trace scene.nff --rays a.npy -o b.npy --query some", "--query");
  expect_failure(2, "compare scene.nff --tracers embree", "two names");
  expect_failure(2, "compare scene.nff --tracers embree,nobody", "nobody");
  expect_failure(2, "bench scene.nff --tracers embree-naked", "embree-naked");
  expect_failure(2, "bench scene.nff --precisions fast,perfect", "perfect");
  expect_failure(2, "chart scene.nff", "--output");
  expect_failure(2, "stress --tracers nobody", "nobody");
  expect_failure(2, "stress --precisions perfect", "perfect");
  expect_failure(2, "stress --rays 0", "--rays");
  for (const char* tolerance : {"-1", "nan", "inf", "1e999", "half"}) {
    expect_failure(2, std::string("render scene.nff --tolerance ") + tolerance, "--tolerance");
    expect_failure(2, std::string("plan scene.nff --tolerance ") + tolerance, "--tolerance");
  }
  expect_failure(2, "plan", "SCENE");
  expect_failure(2, "render scene.nff --verify 10", "--tolerance");
  expect_failure(2, "render scene.nff --tolerance 1 --frames 2", "one camera");
}

TEST_F(CliFailure, WorkThatCannotBeDoneExitsWith1) {
  folder_.write("bad.nff", "v\nfrom 0 0 zero\n");
  folder_.write("scene.txt", "");
  folder_.write("rays.npy", "not NumPy");
  expect_failure(1, "render none.nff", "none.nff");
  expect_failure(1, "render bad.nff -o a.png", "bad.nff:2");
  expect_failure(1, "render scene.txt", "scene.txt");
  expect_failure(1, "render scene.nff --precision half", "fast, robust");
  expect_failure(1, "trace scene.nff --rays rays.npy -o hits.npy", "rays.npy");
  expect_failure(1, "info none.nff", "none.nff");
}

TEST_F(CliFailure, UnwritableOutputIsFoundBeforeTheWork) {
  expect_failure(1, "render none.nff -o none/a.png", "none/a.png");
  expect_failure(1, "render scene.nff -o a.frob", "a.frob");
  expect_failure(1, "render scene.nff -o a.ico --size 257x16", "a.ico");
  expect_failure(1, "render none.nff -o a.png --stats none/a.json", "none/a.json");
  expect_failure(1, "trace none.nff --rays none.npy -o none/hits.npy", "none/hits.npy");
  expect_failure(1, "compare none.nff --tracers embree,reference --json none/a.json", "none/a.json");
  expect_failure(1, "bench none.nff --json none/a.json", "none/a.json");
  expect_failure(1, "info none.nff --json none/a.json", "none/a.json");
  expect_failure(1, "stress --html none/a.html", "none/a.html");
}

TEST_F(CliFailure, PicturesThatNoMemoryHoldsAreRefused) {
  expect_failure(1, "render scene.nff -o a.exr --size 65536x65536 --aov depth,normal,position", "65536x65536");
}

TEST_F(CliFailure, FullDiskLeavesNothing) {
  const auto before = files();
  for (const char* image : {"a.exr", "a.sgi"}) {
    const test::Outcome outcome = test::shell(
        folder_.path(),
        std::string("ulimit -f 16; " RAYENGINE_COMMAND " render scene.nff --quiet --size 512x512 -o ") + image);
    EXPECT_EQ(outcome.code, 1) << image;
    EXPECT_TRUE(outcome.one_line_error()) << outcome.err;
    EXPECT_EQ(files(), before) << image;
  }
}

TEST_F(CliFailure, FullStandardOutputIsTold) {
  const test::Outcome outcome = run("info > /dev/full");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_TRUE(outcome.one_line_error()) << outcome.err;
}

TEST_F(CliFailure, ClosedStandardOutputCostsNoFile) {
  const test::Outcome outcome = run("compare scene.nff --tracers embree,reference --size 16x16 --json a.json | true");
  EXPECT_TRUE(outcome.err.empty()) << outcome.err;
  EXPECT_EQ(parse("a.json")["rows"].size(), 1u);
}

TEST_F(CliRender, WritesThePictureAndItsFigures) {
  const test::Outcome outcome = run("render scene.nff -o a.png --stats a.json");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(outcome.out.empty()) << "the figures are for stderr";
  EXPECT_NE(outcome.err.find("Mrays/s"), std::string::npos);
  const Image image = read_image(file("a.png"));
  EXPECT_EQ(image.width, 48);
  EXPECT_EQ(image.height, 32);
  const json stats = parse("a.json");
  for (const char* key :
       {"scene", "tracer", "precision", "size", "rays", "rays_by_kind", "mrays_per_s", "load_s", "build_s", "render_s",
        "write_s", "bytes", "geometry_bytes", "peak_bytes", "shares", "device"})
    EXPECT_TRUE(stats.contains(key)) << key;
  EXPECT_EQ(stats["rays_by_kind"]["primary"], 48 * 32);
  EXPECT_GT(stats["rays_by_kind"]["reflected"], 0);
  EXPECT_EQ(stats["shares"][0]["share"], 1.0);
}

TEST_F(CliRender, CausticsAreAddedWhenAskedFor) {
  ASSERT_EQ(run("render scene.nff -o plain.exr").code, 0);
  ASSERT_EQ(run("render scene.nff -o lit.exr --caustics 20000 --stats stats.json").code, 0);
  EXPECT_GE(parse("stats.json")["photon_rays"], 20000);
  const Image plain = read_image(file("plain.exr")), lit = read_image(file("lit.exr"));
  std::size_t brighter = 0, darker = 0;
  for (std::size_t i = 0; i < plain.pixels.size(); ++i) {
    brighter += lit.pixels[i] > plain.pixels[i];
    darker += lit.pixels[i] < plain.pixels[i];
  }
  EXPECT_GT(brighter, 0u);  // mirrors light the square
  EXPECT_EQ(darker, 0u);
  expect_failure(2, "render scene.nff -o x.png --caustics -1", "--caustics");
  expect_failure(2, "render scene.nff -o x.png --caustics 10 --shading direct", "choose full");
}

TEST_F(CliRender, QuietSaysNothingAndDefaultsNameThePicture) {
  const test::Outcome outcome = run("render scene.nff --quiet --size 20x10");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_TRUE(outcome.err.empty()) << outcome.err;
  EXPECT_EQ(read_image(file("scene.png")).width, 20);
}

TEST_F(CliRender, SayWhatWasPutInOnce) {
  folder_.write("dark.nff", "f 1 1 1 1 0 1 0 1\ns 0 0 0 1\n");
  const std::string err = run("render dark.nff -o a.png --size 8x8").err;
  const std::size_t first = err.find("note: ");
  ASSERT_NE(first, std::string::npos) << err;
  const std::string line = err.substr(first, err.find('\n', first) - first);
  EXPECT_EQ(err.find(line, first + 1), std::string::npos) << err;
}

TEST_F(CliRender, AovsAreChannels) {
  ASSERT_EQ(run("render scene.nff -o a.exr --aov depth,object,normal").code, 0);
  const Image image = read_image(file("a.exr"));
  for (const char* name : {"R", "Z", "object", "N.X"})
    EXPECT_NE(std::ranges::find(image.channels, name), image.channels.end()) << name;
}

TEST_F(CliRender, ThreadsDoNotChangeThePicture) {
  ASSERT_EQ(run("render scene.nff -o one.exr --threads 1 --spp 4").code, 0);
  ASSERT_EQ(run("render scene.nff -o two.exr --threads 2 --spp 4").code, 0);
  EXPECT_EQ(read_image(file("one.exr")).pixels, read_image(file("two.exr")).pixels);
}

TEST_F(CliRender, MoreThreadsThanCoresAreNoTrouble) {
  ASSERT_EQ(run("render scene.nff -o one.exr --threads 1").code, 0);
  const test::Outcome outcome = test::shell(
      folder_.path(), "core=$(taskset -cp $$ | grep -oE '[0-9]+$') && taskset -c \"$core\" " RAYENGINE_COMMAND
                      " render scene.nff -o many.exr --threads 8");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(read_image(file("one.exr")).pixels, read_image(file("many.exr")).pixels);
}

/// A row of HITS.npy, as the contract has it.
struct Row {
  double t;
  std::uint32_t object, primitive;
  float u, v, nx, ny, nz;
  double error;
  std::uint32_t status;
};

template <class T>
T at(const char*& bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  bytes += sizeof value;
  return value;
}

/// What follows the header of a .npy file of version 1 or 2.
std::string payload(const fs::path& file) {
  const std::string all = test::content(file);
  const bool long_header = all.at(6) > 1;
  std::uint32_t length = 0;
  std::memcpy(&length, all.data() + 8, long_header ? 4 : 2);
  return all.substr((long_header ? 12 : 10) + length);
}

std::vector<Row> read_hits(const fs::path& file) {
  const std::string bytes = payload(file);
  constexpr std::size_t row_size = 8 + 4 + 4 + 5 * 4 + 8 + 4;
  EXPECT_EQ(bytes.size() % row_size, 0u);
  std::vector<Row> rows;
  for (const char* p = bytes.data(); p < bytes.data() + bytes.size();) {
    Row row;
    row.t = at<double>(p), row.object = at<std::uint32_t>(p), row.primitive = at<std::uint32_t>(p);
    row.u = at<float>(p), row.v = at<float>(p), row.nx = at<float>(p), row.ny = at<float>(p), row.nz = at<float>(p);
    row.error = at<double>(p), row.status = at<std::uint32_t>(p);
    rows.push_back(row);
  }
  return rows;
}

/// Along z through both spheres and the square; a miss; one without direction; one that ends before the second sphere.
class CliTraces : public Cli {
 protected:
  CliTraces() {
    const glm::dvec3 down(0, 0, -1);
    write_rays(file("rays.npy"), std::vector<Ray>{{{0.25, 0.125, 9}, 0, down, infinity},
                                                  {{50, 0, 9}, 0, down, infinity},
                                                  {{0, 0, 9}, 0, glm::dvec3(0), infinity},
                                                  {{0, 0, 9}, 4, down, 6}});
  }
};

TEST_F(CliTraces, ClosestHitsAreDoubleAccurate) {
  for (const char* tracer : {"embree", "reference"}) {
    ASSERT_EQ(run(std::string("trace scene.nff --rays rays.npy -o hits.npy --tracer ") + tracer).code, 0);
    const std::vector<Row> hits = read_hits(file("hits.npy"));
    ASSERT_EQ(hits.size(), 4u);
    EXPECT_NEAR(hits[0].t, 4 - std::sqrt(1 - 0.25 * 0.25 - 0.125 * 0.125), 1e-15) << tracer;
    EXPECT_EQ(hits[0].object, 1u);
    EXPECT_EQ(hits[0].status & status_hit, 1u);
    EXPECT_FLOAT_EQ(hits[0].nx, 0.25f);
    EXPECT_EQ(hits[1].t, infinity);
    EXPECT_EQ(hits[1].object, no_id);
    EXPECT_EQ(hits[1].status, status_miss);
    EXPECT_EQ(hits[2].status, status_invalid);
    EXPECT_DOUBLE_EQ(hits[3].t, 5) << "tmin lies inside the nearer hit";
  }
}

TEST_F(CliTraces, AllHitsAreSortedAndDelimited) {
  ASSERT_EQ(run("trace scene.nff --rays rays.npy -o hits.npy --query all").code, 0);
  const std::vector<Row> hits = read_hits(file("hits.npy"));
  const std::string bytes = payload(file("hits.offsets.npy"));
  std::vector<std::uint64_t> offsets(bytes.size() / 8);
  std::memcpy(offsets.data(), bytes.data(), bytes.size());
  EXPECT_EQ(offsets, (std::vector<std::uint64_t>{0, 5, 5, 5, 6}));
  ASSERT_EQ(hits.size(), 6u);
  for (std::size_t i = 1; i < 5; ++i) EXPECT_LE(hits[i - 1].t, hits[i].t);
  EXPECT_EQ(hits[4].object, 2u);
}

TEST_F(CliTraces, AnyHitsTellWhetherAndNoMore) {
  ASSERT_EQ(run("trace scene.nff --rays rays.npy -o hits.npy --query any --stats a.json").code, 0);
  const std::vector<Row> hits = read_hits(file("hits.npy"));
  ASSERT_EQ(hits.size(), 4u);
  EXPECT_EQ(hits[0].t, -infinity);
  EXPECT_EQ(hits[0].object, no_id);
  EXPECT_EQ(hits[0].status, status_hit);
  EXPECT_EQ(hits[1].t, infinity);
  EXPECT_EQ(hits[2].status, status_invalid);
  EXPECT_EQ(parse("a.json")["hits"], 2);
  EXPECT_EQ(parse("a.json")["invalid_rays"], 1);
}

TEST_F(CliCompare, FindsNoDifferenceBeyondBounds) {
  const test::Outcome outcome = run("compare scene.nff --tracers embree,reference --size 64x64 --json a.json");
  EXPECT_EQ(outcome.code, 0) << outcome.out;
  EXPECT_NE(outcome.out.find("ulps"), std::string::npos);
  const json report = parse("a.json");
  EXPECT_EQ(report["oracle"], "reference");
  const json& row = report["rows"][0];
  EXPECT_EQ(row["rays"], 64 * 64);
  EXPECT_GT(row["hits"], 1000);
  for (const char* key : {"wrong_ids", "false_hits", "false_misses", "beyond_bounds", "nans"})
    EXPECT_TRUE(row.contains(key)) << key;
  EXPECT_EQ(row["beyond_bounds"], 0);
}

TEST_F(CliBench, RowsHaveTheKeysOfTheContractAndAreChecked) {
  const test::Outcome outcome = run("bench scene.nff --size 64x64 --precisions robust --json a.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json report = parse("a.json");
  EXPECT_TRUE(report["device"].contains("processor"));
  EXPECT_EQ(report["rows"].size(), 3u * 4u) << "embree and both yardsticks for spheres, on four classes";
  for (const json& row : report["rows"]) {
    for (const char* key :
         {"scene", "tracer", "precision", "class", "rays", "mrays_per_s", "mrays_per_s_iqr", "build_s", "bytes",
          "wrong_ids", "false_hits", "false_misses", "max_rel_t_error", "ambiguous"})
      EXPECT_TRUE(row.contains(key)) << key;
    EXPECT_GT(row["mrays_per_s"], 0);
    if (row["tracer"] == "embree") {
      EXPECT_EQ(row["false_hits"].get<int>() + row["false_misses"].get<int>(), 0);
    }
    if (row["tracer"] == "embree-tess" && row["class"] == "primary") {
      EXPECT_GT(row["max_rel_t_error"], 1e-4);
    }
  }
}

TEST_F(Cli, StressTellsEveryCaseAsTableJsonAndPage) {
  const test::Outcome outcome = run("stress --tracers embree --rays 2000 --json s.json --html s.html --quiet");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json told = parse("s.json");
  EXPECT_TRUE(told["good"].get<bool>());
  EXPECT_GE(told["left_out"].size(), 1u) << "embree has no half";
  std::set<std::string> cases, precisions;
  for (const json& row : told["rows"]) {
    cases.insert(row["case"].get<std::string>()), precisions.insert(row["precision"].get<std::string>());
    for (const char* key : {"variant", "rays", "false_hits", "false_misses", "wrong_ids", "ambiguous", "nans",
                            "aborted", "bound_violations", "max_rel_t_error", "p999_rel_t_error", "max_point_error",
                            "p999_point_error", "max_normal_error", "p999_normal_error", "broken_limit"})
      EXPECT_TRUE(row.contains(key)) << key;
  }
  EXPECT_EQ(cases.size(), 34u);
  EXPECT_TRUE(precisions.contains("fast") && precisions.contains("robust"));
  EXPECT_NE(outcome.out.find("\nall of them"), std::string::npos);
  const std::string page = test::content(file("s.html"));
  for (const std::string& name : cases) {
    EXPECT_NE(outcome.out.find(name), std::string::npos) << name;
    EXPECT_NE(page.find(name.substr(0, name.find('\''))), std::string::npos) << name;
  }
  EXPECT_TRUE(page.ends_with("</html>\n"));
}

TEST_F(Cli, ChartShowsTracersAndTessellationsWithTheirFront) {
  const test::Outcome outcome = run("chart scene.nff -o out --quiet");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json told = parse("out/chart.json");
  std::set<std::string> methods;
  std::size_t on_front = 0;
  for (const json& row : told["rows"]) {
    methods.insert(row["method"].get<std::string>());
    EXPECT_GT(row["mrays_per_s"], 0);
    const bool exact = row["tessellation"] == 0, robust = row["precision"] == "robust";
    EXPECT_TRUE(exact || row["rmse"] > 1e-3) << row;
    EXPECT_TRUE(!exact || !robust || (row["rmse"] < 1e-6 && row["wrong_share"] == 0)) << row;
    on_front += row["pareto"].get<bool>();
  }
  EXPECT_GE(on_front, 1u);
  for (const char* method : {"embree", "bvh", "embree-tess1", "embree-tess5"}) EXPECT_TRUE(methods.contains(method));
  std::size_t broken = 0;
  for (const json& row : told["distance"])
    broken += row["method"] == "b^2-ac in float" && row["distance"] > 1e4 && row["wrong_share"] > 0.1;
  EXPECT_GE(broken, 9u);
  for (const char* name : {"chart.csv", "distance.csv", "index.html"}) EXPECT_TRUE(fs::exists(file("out") / name));
  expect_failure(2, "chart scene.nff ../scene.nff -o other", "is taken");
}

TEST_F(Cli, PlanExplainsItself) {
  const test::Outcome outcome = run("plan scene.nff --tolerance 0.5 --verify 500 --json p.json");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("tracer and precision"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.err.find("0 farther than promised"), std::string::npos) << outcome.err;
  const json plan = parse("p.json");
  EXPECT_EQ(plan["tolerance"], 0.5);
  EXPECT_EQ(plan["verified"]["rays"], 500);
  for (const json& choice : plan["choices"]) EXPECT_FALSE(choice["why"].get<std::string>().empty());
}

TEST_F(CliBench, ComparesPicturesWithAndWithoutAPlan) {
  ASSERT_EQ(run("bench scene.nff --tolerance 0.5 --json b.json").code, 0);
  const json row = parse("b.json")["plans"][0];
  EXPECT_EQ(row["tolerance"], 0.5);
  EXPECT_EQ(row["without"]["planning_s"], 0);
  for (const char* part : {"planning_s", "build_s", "render_s", "bytes"}) EXPECT_GT(row["with"][part], 0) << part;
}

TEST_F(CliRender, ToATolerance) {
  EXPECT_EQ(run("render scene.nff -o a.exr --aov object -q").code, 0);
  const test::Outcome planned =
      run("render scene.nff -o b.exr --aov object -q --tolerance 0.1 --verify 200 --stats b.json");
  EXPECT_EQ(planned.code, 0) << planned.err;
  EXPECT_EQ(parse("b.json")["plan"]["verified"]["broken"], 0);
  const test::Outcome exact = run("render scene.nff -o c.exr --aov object -q --tolerance 0 --stats c.json");
  EXPECT_EQ(exact.code, 0) << exact.err;
  EXPECT_EQ(parse("c.json")["precision"], "certified");
  EXPECT_EQ(run("render scene.nff -o d.exr --tolerance 1 --tracer bvh --stats d.json").code, 0);
  EXPECT_EQ(parse("d.json")["tracer"], "bvh");
}

TEST_F(CliInfo, CountsWhatASceneHolds) {
  ASSERT_EQ(run("info scene.nff --json a.json").code, 0);
  const json scene = parse("a.json")["scene"];
  EXPECT_EQ(scene["objects"], 3);
  EXPECT_EQ(scene["objects_by_type"]["sphere"], 2);
  EXPECT_EQ(scene["triangles"], 2);
  EXPECT_EQ(scene["lights"], 1);
  EXPECT_EQ(scene["bounds"][1], json({4, 4, 6}));
}

TEST_F(CliInfo, NamesTracersAndTheirPrecisions) {
  ASSERT_EQ(run("info --json a.json").code, 0);
  const json info = parse("a.json");
  EXPECT_TRUE(info["device"].contains("isa"));
  const auto embree = std::ranges::find_if(info["tracers"], [](const json& t) { return t["name"] == "embree"; });
  ASSERT_NE(embree, info["tracers"].end());
  EXPECT_EQ((*embree)["precisions"], json({"fast", "robust", "certified"}));
}

TEST_F(Cli, FramesTurnTheCamera) {
  const test::Outcome outcome = run("render scene.nff -o turn.png --frames 3 --size 24x16 --stats turn.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const char* name : {"turn.0000.png", "turn.0001.png", "turn.0002.png"})
    EXPECT_TRUE(fs::exists(file(name))) << name;
  EXPECT_FALSE(fs::exists(file("turn.png")));
  ASSERT_EQ(run("render scene.nff -o one.png --size 24x16").code, 0);
  EXPECT_EQ(test::content(file("turn.0000.png")), test::content(file("one.png")));
  EXPECT_NE(test::content(file("turn.0001.png")), test::content(file("one.png")));
  const json stats = parse("turn.json");
  EXPECT_EQ(stats["frames"], 3);
  EXPECT_EQ(stats["rays_by_kind"]["primary"], 3 * 24 * 16);
}

TEST_F(Cli, FramesGoAlongAPath) {
  folder_.write("path.json", R"([{}, {"from": [6, 6, 4]}, {"from": [0, 8, 3], "time": 3}])");
  const test::Outcome outcome = run("render scene.nff -o fly.png --frames 4 --path path.json --size 24x16");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  ASSERT_EQ(run("render scene.nff -o one.png --size 24x16").code, 0);
  EXPECT_EQ(test::content(file("fly.0000.png")), test::content(file("one.png")));
  EXPECT_NE(test::content(file("fly.0003.png")), test::content(file("one.png")));
}

TEST_F(Cli, APathThatCannotBeGoneLeavesNothingBehind) {
  expect_failure(2, "render scene.nff --path path.json", "give --frames");
  expect_failure(1, "render scene.nff -o fly.png --frames 3 --path none.json", "none.json");
  folder_.write("path.json", "[{},\n{\"form\": [6, 6, 4]}]");
  expect_failure(1, "render scene.nff -o fly.png --frames 3 --path path.json", "path.json:2: unknown key 'form'");
  EXPECT_FALSE(fs::exists(file("fly.0000.png")));
}

TEST_F(Cli, PaperCarrWritesItsFourRows) {
  const test::Outcome outcome = run("paper carr scene.nff -o carr");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  std::ifstream csv(file("carr/carr.csv"));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "row,rays_per_s,scene");
  std::vector<std::string> rows;
  while (std::getline(csv, line)) rows.push_back(line.substr(0, line.rfind("\",")));
  EXPECT_EQ(rows, (std::vector<std::string>{"\"CPU alone", "\"GPU, synchronous read-back",
                                            "\"GPU, asynchronous read-back", "\"infinitely fast GPU"}));
  EXPECT_TRUE(std::filesystem::exists(file("carr/carr.md")));
  const bool drawn = std::filesystem::exists(file("carr/carr.svg"));
  EXPECT_NE(drawn, outcome.err.find("gnuplot is not installed") != std::string::npos);
}

TEST_F(Cli, PaperPurcellWritesPassesAndTimeByState) {
  const test::Outcome outcome = run("paper purcell scene.nff --size 16x16 -o purcell");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  std::ifstream csv(file("purcell/purcell.csv"));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "resolution,state,passes,milliseconds");
  std::map<std::string, int> rows;
  std::map<int, int> traverse_passes;  // by resolution
  for (int resolution, passes; std::getline(csv, line);) {
    char state[16] = {};
    double milliseconds = 0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%d,%15[a-z],%d,%lf", &resolution, state, &passes, &milliseconds), 4) << line;
    EXPECT_GT(passes, 0);
    EXPECT_GT(milliseconds, 0);
    ++rows[state];
    if (state == std::string("traverse")) traverse_passes[resolution] = passes;
  }
  EXPECT_EQ(rows, (std::map<std::string, int>{{"traverse", 6}, {"intersect", 6}, {"shade", 6}}));
  EXPECT_GT(traverse_passes.rbegin()->second, 4 * traverse_passes.begin()->second) << "they go with the resolution";
  EXPECT_TRUE(fs::exists(file("purcell/purcell-policies.csv")));
  EXPECT_TRUE(fs::exists(file("purcell/purcell.md")));
}

TEST_F(Cli, PaperPurcellTakesOneScene) {
  expect_failure(2, "paper purcell scene.nff scene.nff -o purcell", "measures one scene");
}

TEST_F(Cli, PaperSzecsiHasItsOwnScenesAndSizes) {
  expect_failure(2, "paper szecsi scene.nff -o x", "its own scenes");
  expect_failure(2, "paper szecsi --size 64x64 -o x", "its own sizes");
}

TEST_F(Cli, PaperWoodWritesBothMethodsAndSixQuadrics) {
  const test::Outcome outcome = run("paper wood --size 16x16 -o wood");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  std::istringstream csv(test::content(file("wood/wood.csv")));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "method,frames_per_s");
  for (const std::string method : {"gpu", "software"}) {
    double frames = 0;
    ASSERT_TRUE(std::getline(csv, line));
    ASSERT_EQ(std::sscanf(line.c_str(), (method + ",%lf").c_str(), &frames), 1) << line;
    EXPECT_GT(frames, 0);
  }
  EXPECT_FALSE(std::getline(csv, line)) << line;
  for (const char* type : {"sphere", "cylinder", "cone", "paraboloid", "hyperboloid1", "hyperboloid2"})
    EXPECT_TRUE(fs::exists(file(std::string("wood/wood-") + type + ".png"))) << type;
  EXPECT_TRUE(fs::exists(file("wood/wood.md")));
}

TEST_F(Cli, PaperWoodHasItsOwnScene) { expect_failure(2, "paper wood scene.nff -o x", "its own scenes"); }

TEST_F(Cli, PaperRalovichWritesEveryMethodInEveryMode) {
  const test::Outcome outcome = run("paper ralovich --size 16x16 -o ralovich");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  std::istringstream csv(test::content(file("ralovich/ralovich.csv")));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "scene,triangles,mode,method,milliseconds");
  std::map<std::string, int> rows;  // by triangles, mode and method
  while (std::getline(csv, line)) {
    const auto from = line.find(',') + 1, to = line.rfind(',');
    ++rows[line.substr(from, to - from)];
    EXPECT_GT(std::stod(line.substr(to + 1)), 0) << line;
  }
  EXPECT_EQ(rows.size(), 4u * 3 * 3);
  for (const char* row : {"12,RC,points", "36,SC,points_without_gs", "646,RT,fragment", "1024,RT,points"})
    EXPECT_EQ(rows[row], 1) << row;
  const std::string page = test::content(file("ralovich/ralovich.md"));
  for (const char* said : {"of the work in room, ", "With a geometry shader rays take", "It guessed that", "at most"})
    EXPECT_NE(page.find(said), page.npos) << said;
}

TEST_F(Cli, PaperRalovichTakesMeshesAlone) {
  const test::Outcome outcome = run("paper ralovich scene.nff -o ralovich");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.err.find("triangles alone: name a mesh"), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(file("ralovich/ralovich.csv")));
}

}  // namespace
}  // namespace rayengine
