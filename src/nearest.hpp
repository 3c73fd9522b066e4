#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace gnomon {

/// The known word nearest to a misspelt one, or empty when none is near.
std::string nearest(std::string_view word, const std::vector<std::string>& known);

/// The word itself where there is only one, else "one of a, b, ..".
std::string choices_text(const std::vector<std::string>& choices);

}  // namespace gnomon
