#pragma once

#include <memory>

#include "accel/tracer.h"

namespace rayengine {

/// Precision `certified` by two: `proposer`, of any precision, says where rays end, and `certifier`, which holds
/// `certified`, proves or corrects it, with the rays cut behind what was proposed. So answers are the certifier's to
/// the bit, whoever proposed. Any-hit and all-hits queries are the certifier's alone: nothing that is proposed shortens
/// those.
std::unique_ptr<Tracer> make_certifying(std::unique_ptr<Tracer> proposer, std::unique_ptr<Tracer> certifier);

}  // namespace rayengine
