// Helpers for the command line: option values with several parts, and one sentence for every mistake.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grainray/core.hpp"

namespace grainray::cli {

/// "x,y,z" -> vector. Throws InputError that quotes the option.
Vec3d parse_vector(const std::string& option, const std::string& text);

struct PixelSize {
    std::int64_t width, height;
};
/// "1920x1080". Throws InputError that quotes the option.
PixelSize parse_size(const std::string& option, const std::string& text);

/// Throws InputError naming the nearest of `known` where `value` is none of them.
void require_choice(const std::string& option, const std::string& value, const std::vector<std::string>& known);
/// Throws InputError where the value is below the least allowed.
void require_at_least(const std::string& option, std::int64_t value, std::int64_t least);

/// Throws InputError where the number of steps is below `least` or too large to be counted.
void require_steps(const std::string& option, std::int64_t steps, std::int64_t least);
/// Throws InputError for nan and inf.
void require_finite(const std::string& option, const std::optional<double>& value);
/// Throws InputError where a file at `path` could not be written; leaves nothing behind. Empty: none is wanted.
void require_writable(const std::string& option, const std::filesystem::path&);
/// "1 particle", "2 particles"
std::string counted(std::uint64_t count, std::string_view what);
/// "1234567.8" -> "1.23 M" and the like, for people.
std::string short_number(double);
/// Seconds as "12.3 s", "4 min 5 s", "3 h 12 min".
std::string duration_text(double seconds);
/// "312 MiB"
std::string bytes_text(double bytes);

}  // namespace grainray::cli
