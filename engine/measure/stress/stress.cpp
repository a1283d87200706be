#include "engine/measure/stress/stress.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cpu/reference_tracer.h"
#include "engine/batched.h"
#include "engine/measure/stress/ask.h"
#include "engine/measure/stress/limits.h"
#include "engine/tracers.h"

namespace rayengine {
namespace {

using stability::Case;
using stability::Family;

constexpr std::size_t fewest_rays = 10;  // in a case

struct Chosen {
  const Family* family;
  Case one;
};

bool wanted(const StressOptions& options, const Family& family) {
  return options.families.empty() || std::ranges::count(options.families, family.name) > 0;
}

/// All cases, each with its share of the rays.
std::vector<Chosen> choose(const StressOptions& options) {
  const auto make = [&](std::size_t rays) {
    std::vector<Chosen> chosen;
    for (const Family& family : stability::families())
      if (wanted(options, family))
        for (Case& one : family.make(rays, options.seed)) chosen.push_back({&family, std::move(one)});
    return chosen;
  };
  const std::size_t cases = std::max<std::size_t>(make(1).size(), 1);
  return make(std::max<std::size_t>(options.rays / cases, fewest_rays));
}

/// A tracer by name and precision. Those that cannot be made at all are named once and then passed over.
class Contender {
 public:
  Contender(std::string name, Precision precision, const StressOptions& options)
      : name_(std::move(name)), precision_(precision), options_(options) {
    aborts_ = options.aborts && options.aborts(name_, precision);
  }

  const std::string& name() const { return name_; }
  Precision precision() const { return precision_; }
  bool aborts() const { return aborts_; }

  /// Throws Error when it cannot.
  std::unique_ptr<Tracer> make(std::shared_ptr<const Geometry> geometry) const {
    return make_tracer(name_, std::move(geometry), {precision_, options_.threads, options_.gpu, {}});
  }

 private:
  std::string name_;
  Precision precision_;
  const StressOptions& options_;
  bool aborts_ = false;
};

std::vector<Contender> contenders(const StressOptions& options, std::vector<std::string>& left_out) {
  std::vector<Contender> able;
  const std::shared_ptr<const Geometry> nothing = GeometryBuilder().build();
  for (const std::string& name : options.tracers)
    for (const Precision precision : options.precisions) try {
        Contender contender(name, precision, options);
        if (!contender.aborts()) contender.make(nothing);
        able.push_back(std::move(contender));
      } catch (const Error& error) {
        left_out.push_back(error.what());
      }
  if (able.empty()) throw Error("there is nothing to test: " + (left_out.empty() ? "no tracer" : left_out.front()));
  return able;
}

StressRow row_for(const Chosen& chosen, const Contender& contender) {
  StressRow row;
  row.number = chosen.family->row;
  row.family = chosen.family->name;
  row.variant = chosen.one.variant;
  row.tracer = contender.name();
  row.precision = contender.precision();
  row.size = chosen.one.size;
  return row;
}

/// What is known of rays is held against the oracle itself.
void check_oracle(const Chosen& chosen, std::span<const Hit> exact, std::vector<std::string>& errors) {
  for (const stability::Known& known : chosen.one.known) {
    const double t = exact[known.ray].t;
    const bool same = t == known.t || std::abs(t - known.t) <= known.tolerance * std::abs(known.t);
    if (same) continue;
    char text[64];
    std::snprintf(text, sizeof text, "%.17g and not %.17g", t, known.t);
    errors.push_back(std::string(chosen.family->name) + ", " + chosen.one.variant + ": ray " +
                     std::to_string(known.ray) + " is at t = " + text);
  }
}

/// Runs all contenders on one case.
class Round {
 public:
  Round(const Chosen& chosen, StressReport& report)
      : chosen_(chosen), report_(report), reference_(make_reference_tracer(chosen.one.geometry)), oracle_(*reference_) {
    if (chosen_.one.twin) return;
    exact_ = stability::ask(oracle_, chosen_.one);
    check_oracle(chosen_, exact_.hits, report_.oracle_errors);
  }

  void run(const Contender& contender) {
    StressRow row = row_for(chosen_, contender);
    row.aborted = contender.aborts();
    try {
      const Limits limits = row.aborted ? Limits{} : judge(contender, row);
      row.broken = stability::broken_limit(row, chosen_.one, limits);
      report_.rows.push_back(std::move(row));
    } catch (const Error& error) {
      report_.refused.push_back(row.tracer + " at " + std::string(to_string(row.precision)) + ", " + row.family + ", " +
                                row.variant + ": " + error.what());
    }
  }

 private:
  Limits judge(const Contender& contender, StressRow& row) {
    const auto tracer = contender.make(chosen_.one.geometry);
    const stability::Asked asked = stability::ask(*tracer, chosen_.one);
    const bool look_into = contender.precision() == Precision::robust && !chosen_.one.twin &&
                           chosen_.one.query == stability::Query::closest;
    const stability::Asked expected = chosen_.one.twin ? ask_twin(contender) : exact_;
    row.errors = stability::judge(chosen_.one, tracer->limits(), asked, expected, look_into ? &oracle_ : nullptr);
    return tracer->limits();
  }

  stability::Asked ask_twin(const Contender& contender) const {
    const Case& twin = *chosen_.one.twin;
    return stability::ask(*contender.make(twin.geometry), twin);
  }

  const Chosen& chosen_;
  StressReport& report_;
  std::unique_ptr<Tracer> reference_;
  Batched oracle_;
  stability::Asked exact_;
};

}  // namespace

bool StressReport::good() const {
  return oracle_errors.empty() && std::ranges::all_of(rows, [](const StressRow& row) { return row.broken.empty(); });
}

StressReport stress(const StressOptions& options) {
  StressReport report;
  const std::vector<Contender> able = contenders(options, report.left_out);
  const std::vector<Chosen> cases = choose(options);
  std::size_t done = 0;
  for (const Chosen& chosen : cases) {
    Round round(chosen, report);
    for (const Contender& contender : able) {
      round.run(contender);
      if (options.progress)
        options.progress(static_cast<double>(++done) / static_cast<double>(cases.size() * able.size()));
    }
  }
  return report;
}

}  // namespace rayengine
