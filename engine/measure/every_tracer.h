#pragma once

#include <string>
#include <vector>

#include "engine/tracers.h"

namespace rayengine {

/// Calls body(name, precision) for every tracer of the registry but the oracle at every precision; what it throws for
/// those that there are none of is kept in `left_out`.
template <class Body>
void for_every_tracer(std::vector<std::string>& left_out, const Body& body) {
  for (const TracerInfo& info : tracer_list())
    for (const Precision precision : {Precision::half, Precision::fast, Precision::robust, Precision::certified}) try {
        if (info.name != "reference") body(std::string(info.name), precision);
      } catch (const Error& error) {
        left_out.push_back(error.what());
      }
}

}  // namespace rayengine
