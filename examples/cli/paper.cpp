#include "examples/cli/paper.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>

#include "engine/load/atomic_file.h"

namespace rayengine::cli {
namespace {

struct Paper {
  std::string_view name;
  int (*run)(const PaperOptions&);
};
constexpr std::array papers{Paper{"carr", run_carr}, Paper{"purcell", run_purcell}, Paper{"ralovich", run_ralovich},
                            Paper{"szecsi", run_szecsi}, Paper{"wood", run_wood}};

std::vector<std::string> names() {
  std::vector<std::string> result;
  for (const Paper& paper : papers) result.emplace_back(paper.name);
  return result;
}

int run(const PaperOptions& options) { return std::ranges::find(papers, options.name, &Paper::name)->run(options); }

}  // namespace

std::vector<std::pair<std::string, Scene>> load_scenes(const PaperOptions& options) {
  std::vector<std::pair<std::string, Scene>> scenes;
  for (const auto& file : options.scenes) scenes.emplace_back(file.stem().string(), load(file, options.common).scene);
  return scenes;
}

void prepare_folder(const PaperOptions& options, std::initializer_list<const char*> files) {
  std::filesystem::create_directories(options.output);
  for (const char* name : files) check_output(options.output / name);
}

std::string_view against(double ours, double theirs) {
  return ours > 1.25 * theirs  ? "more than in the paper"
         : ours < 0.8 * theirs ? "less than in the paper"
                               : "as in the paper";
}

void add_paper(CLI::App& app, Action& action) {
  auto options = std::make_shared<PaperOptions>();
  CLI::App* sub = add_subcommand(
      app, "paper", "Repeat a paper's experiment, as table, chart and page",
      "  rayengine paper carr -o carr\n"
      "  rayengine paper carr balls.nff dragon.ply -o carr\n"
      "  rayengine paper ralovich bunny.ply --size 256x256 -o ralovich\n\n"
      "carr: processor alone, with a GPU read back synchronously and asynchronously, and with an infinitely fast one;\n"
      "  on 8,000 made balls and a made mesh of 200,000 triangles unless scenes are named.\n"
      "purcell: passes and time in the grid tracer's states against its resolution, and ways to choose the next "
      "kernel;\n"
      "  a picture of 256x256 of the knot in a Cornell box, unless a size or a scene is named.\n"
      "ralovich: rays as points through geometry shaders, beside a fragment shader; on made scenes of the paper's "
      "sizes,\n"
      "  and the meshes that are named.\n"
      "szecsi: the hierarchical ray engine against the plain one, 10 to 10,000 triangles of glass; images of its "
      "cones.\n"
      "wood: a sphereflake of 7,381 spheres by a pass an object and by the same loop on the processor, 256x256 unless "
      "a "
      "size\n"
      "  is named; and six quadrics.",
      options->common);
  sub->add_option("PAPER", options->name, "Which: " + CLI::detail::join(names(), ", "))
      ->type_name("")
      ->required()
      ->check(CLI::IsMember(names()));
  sub->add_option("SCENE", options->scenes, "Scenes to use instead, or beside")->type_name("");
  sub->add_option("-o,--output", options->output, "Folder for what results")->type_name("DIR")->required();
  add_size(sub, options->size, "512x512");
  sub->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace rayengine::cli
