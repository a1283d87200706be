#pragma once

#include <chrono>
#include <functional>

namespace rayengine::cli {

/// Whether `work` ends by itself, in a child process that may be aborted or hang in its place. Only for processes that
/// have started no threads yet.
bool survives(const std::function<void()>& work, std::chrono::seconds patience);

}  // namespace rayengine::cli
