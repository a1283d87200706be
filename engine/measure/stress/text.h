#pragma once

#include <cstdio>
#include <string>

namespace rayengine::stability {

/// `label` and a number in as few digits as tell it.
inline std::string number(const char* label, double value) {
  char text[64];
  std::snprintf(text, sizeof text, "%s%.4g", label, value);
  return text;
}

}  // namespace rayengine::stability
