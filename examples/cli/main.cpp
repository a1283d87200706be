#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <exception>
#include <iostream>
#include <new>

#include "engine/load/atomic_file.h"
#include "examples/cli/cli.h"

namespace {

enum ExitCode { good = 0, failed = 1, wrong_usage = 2 };

/// Ends as the signal would have, with no half-written file left.
void interrupted(int signal) {
  rayengine::remove_temporaries();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void catch_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, interrupted);
  // A reader that goes away must not cost us the files still to be written; a limit on files is to be told as a full
  // disk.
  for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
}

/// Messages stay on one line, whatever they quote.
std::string one_line(std::string text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  return text;
}

std::string called(const CLI::App& app) {
  for (const CLI::App* sub : app.get_subcommands()) return app.get_name() + " " + sub->get_name();
  return app.get_name();
}

int report(ExitCode code, const std::string& who, const std::string& what) {
  std::cerr << who << ": " << one_line(what) << std::endl;
  return code;
}

/// Help and version are asked for, not errors.
int answer_parse(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) return app.exit(error);
  return report(wrong_usage, called(app), one_line(error.what()) + " (see '" + called(app) + " --help')");
}

/// A reader that went away, as `head` does, knows that it did.
int answer_lost_output(const CLI::App& app) {
  pollfd out{STDOUT_FILENO, 0, 0};
  if (poll(&out, 1, 0) == 1 && (out.revents & POLLERR)) return failed;
  return report(failed, called(app), "standard output cannot be written: is the disk full?");
}

int run(const CLI::App& app, const rayengine::cli::Action& action) {
  try {
    const int code = action();
    return std::cout.flush() ? code : answer_lost_output(app);
  } catch (const CLI::Error& error) {
    return report(wrong_usage, called(app), error.what());
  } catch (const std::bad_alloc&) {
    return report(failed, called(app), "out of memory: ask for a smaller image, fewer rays or a smaller scene");
  } catch (const std::exception& error) {
    return report(failed, called(app), error.what());
  }
}

void add_subcommands(CLI::App& app, rayengine::cli::Action& action) {
  using namespace rayengine::cli;
  add_render(app, action);
  add_trace(app, action);
  add_compare(app, action);
  add_bench(app, action);
  add_chart(app, action);
  add_stress(app, action);
  add_plan(app, action);
  add_paper(app, action);
  add_info(app, action);
}

int answer(int argc, char** argv) {
  CLI::App app("Traces rays through exact quadrics and triangle meshes, to the accuracy that you ask for.",
               "rayengine");
  app.set_version_flag("--version", "rayengine " RAYENGINE_VERSION);
  app.require_subcommand(0, 1);  // one too few is told below, after what is not understood
  app.get_formatter()->column_width(36);
  app.footer(
      "Exit code: 0 good, 1 the work failed, 2 wrong usage.\n\n"
      "Examples:\n"
      "  rayengine render scenes/glass.json -o glass.png\n"
      "  rayengine compare scenes/cornell.json --tracers embree,reference\n"
      "  rayengine render --help");
  rayengine::cli::Action action;
  add_subcommands(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return answer_parse(app, error);
  }
  if (!action)
    return report(
        wrong_usage, "rayengine",
        "say what to do: render, trace, compare, bench, chart, stress, plan, paper or info (see 'rayengine --help')");
  return run(app, action);
}

}  // namespace

int main(int argc, char** argv) {
  catch_signals();
  try {
    return answer(argc, argv);
  } catch (const std::exception& error) {
    return report(failed, "rayengine", error.what());
  }
}
