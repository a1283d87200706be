#pragma once

#include <utility>

namespace rayengine::test {

/// Puts another function in a variable until the end of the scope. The library that loads OpenGL keeps its functions in
/// such variables, each in place once it has been called.
template <class Function>
class Instead {
 public:
  Instead(Function& variable, Function other) : variable_(variable), old_(std::exchange(variable, other)) {}
  ~Instead() { variable_ = old_; }
  Instead(const Instead&) = delete;
  Instead& operator=(const Instead&) = delete;

 private:
  Function& variable_;
  Function old_;
};

}  // namespace rayengine::test
