#include "examples/cli/chart.h"

#include <cstdio>
#include <cstdlib>

#include "accel/tracer.h"

namespace rayengine::cli {
namespace {

bool draw(const std::filesystem::path& file, const std::string& terminal, const std::string& commands) {
  std::FILE* gnuplot = popen("gnuplot 2>/dev/null", "w");
  if (!gnuplot) return false;
  std::fprintf(gnuplot, "set terminal %s\nset output '%s'\n%s\n", terminal.c_str(), file.c_str(), commands.c_str());
  return pclose(gnuplot) == 0;
}

}  // namespace

bool draw_chart(const std::filesystem::path& file, const std::string& commands, const std::string& size) {
  if (std::system("gnuplot --version >/dev/null 2>&1") != 0) return false;
  for (const auto& [extension, terminal] :
       {std::pair{".svg", "svg font 'sans,13' background 'white'"}, std::pair{".png", "pngcairo font 'sans,11'"}}) {
    std::filesystem::path drawn = file;
    drawn += extension;
    if (!draw(drawn, std::string(terminal) + " size " + size, commands))
      throw Error("gnuplot cannot draw " + drawn.string() + ": is the folder writable, and its name without quotes?");
  }
  return true;
}

}  // namespace rayengine::cli
