// Did-you-mean: the known name that is nearest to one that is not known.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace smokebox {

/// Number of letters to insert, delete, replace or swap with their neighbour that lead from one word to the
/// other.
int editDistance(std::string_view a, std::string_view b);

/// "did you mean `x`?", or the list of all names when none is near; empty if there is no name at all.
std::string suggestion(std::string_view wrong, const std::vector<std::string>& known);

}  // namespace smokebox
