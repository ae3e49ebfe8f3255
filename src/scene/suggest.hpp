// Help in messages: the nearest known word, lists of words.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace grainray::scene {

/// End of a sentence: "; did you mean 'x'?" for the nearest of `known`, or "." where none is near.
std::string did_you_mean(std::string_view word, const std::vector<std::string_view>& known);
/// "a, b, c"
std::string join(const std::vector<std::string_view>& words);

}  // namespace grainray::scene
