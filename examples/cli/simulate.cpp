#include "examples/cli/simulate.h"

#include <fmt/format.h>

#include <iostream>

#include "engine/load/atomic_file.h"
#include "engine/schedule/simulated_cases.h"
#include "examples/cli/report.h"

namespace rayengine::cli {
namespace {

Json to_json(const SimulatedRow& row) {
  return {{"group", row.subject.group}, {"name", row.subject.name},
          {"ratio", row.subject.ratio}, {"latency_s", row.subject.latency},
          {"rays", row.subject.rays},   {"oracle_s", row.bound_seconds},
          {"rayengine", row.ours},      {"even_split", row.even},
          {"cycles", row.cycles},       {"fewest_pending", row.fewest},
          {"gpu_share", row.gpu_share}, {"traced_twice", row.traced_twice}};
}

/// The columns are the keys of the JSON rows.
std::string to_csv(const Json& rows) {
  std::string text;
  for (const auto& column : rows.front().items()) text += (text.empty() ? "" : ",") + column.key();
  for (const Json& row : rows) {
    std::string line;
    for (const auto& field : row.items()) {
      if (!line.empty() || field.key() != "group") line += ',';
      line += field.value().is_string() ? field.value().get<std::string>() : field.value().dump();
    }
    text += '\n' + line;
  }
  return text + '\n';
}

void print(const SimulatedRow& row) {
  const SimulatedCase& c = row.subject;
  const std::string what =
      c.name.empty() ? fmt::format("1:{:g}, {:g} ms{}", c.ratio, 1e3 * c.latency, c.group == "walk" ? ", walk" : "")
                     : c.name;
  std::cout << fmt::format("{:<32} {:>9} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.3f}\n", what, c.rays,
                           1e3 * row.bound_seconds, row.ours, row.even, row.cycles, row.fewest, row.gpu_share);
}

}  // namespace

int simulate(const std::filesystem::path& json, const std::filesystem::path& csv) {
  std::cout << fmt::format(
      "oracle's time over the time under each policy; 1 is best, 0 never done\n"
      "{:<32} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n",
      "processor:GPU, latency", "rays", "oracle ms", "rayengine", "even", "cycles", "fewest", "GPU share");
  Json rows = Json::array();
  for (const SimulatedCase& subject : simulated_cases()) {
    const SimulatedRow row = run_simulated(subject);
    rows.push_back(to_json(row));
    print(row);
  }
  if (!json.empty()) write_json(json, {{"rows", rows}});
  if (!csv.empty()) {
    AtomicFile file(csv);
    file.write(to_csv(rows));
    file.commit();
  }
  return 0;
}

}  // namespace rayengine::cli
