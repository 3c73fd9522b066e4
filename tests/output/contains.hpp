#pragma once
#include <string>

namespace gnomon::test {

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace gnomon::test
