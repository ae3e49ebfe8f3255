#include "arguments.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "scene/suggest.hpp"

namespace grainray::cli {
namespace {

constexpr std::int64_t most_steps = 1'000'000'000'000'000;  // as a scene's duration may have

/// The whole of text as a T, or false.
template <class T>
bool parse_number(std::string_view text, T& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (std::size_t end; (end = text.find(separator)) != std::string_view::npos; text.remove_prefix(end + 1))
        parts.push_back(text.substr(0, end));
    parts.push_back(text);
    return parts;
}

std::string nearest(std::string_view word, const std::vector<std::string>& known) {
    return scene::did_you_mean(word, {known.begin(), known.end()});
}

}  // namespace

Vec3d parse_vector(const std::string& option, const std::string& text) {
    const auto parts = split(text, ',');
    Vec3d v;
    bool good = parts.size() == 3;
    for (int a = 0; good && a < 3; ++a) good = parse_number(parts[static_cast<std::size_t>(a)], v[a]) && std::isfinite(v[a]);
    if (!good) throw InputError(fmt::format("{}: '{}' is not three numbers x,y,z; write for example {} 5,-10,3", option, text, option));
    return v;
}

PixelSize parse_size(const std::string& option, const std::string& text) {
    const auto parts = split(text, 'x');
    PixelSize size{};
    const bool good = parts.size() == 2 && parse_number(parts[0], size.width) && parse_number(parts[1], size.height) &&
                      size.width >= 16 && size.height >= 16 && size.width <= 16384 && size.height <= 16384;
    if (!good) throw InputError(fmt::format("{}: '{}' is not a size of 16 to 16384 pixels each way; write for example {} 1920x1080", option, text, option));
    return size;
}

void require_choice(const std::string& option, const std::string& value, const std::vector<std::string>& known) {
    for (const std::string& name : known)
        if (value == name) return;
    throw InputError(fmt::format("{}: '{}' is not known{} Known: {}", option, value, nearest(value, known), scene::join({known.begin(), known.end()})));
}

void require_at_least(const std::string& option, std::int64_t value, std::int64_t least) {
    if (value < least) throw InputError(fmt::format("{}: {} is too small; give {} or more", option, value, least));
}

void require_steps(const std::string& option, std::int64_t steps, std::int64_t least) {
    require_at_least(option, steps, least);
    if (steps > most_steps) throw InputError(fmt::format("{}: {} is too large; at most 1e15 steps can be counted", option, steps));
}

void require_finite(const std::string& option, const std::optional<double>& value) {
    if (value && !std::isfinite(*value)) throw InputError(fmt::format("{}: {} is not a finite number", option, *value));
}

void require_writable(const std::string& option, const std::filesystem::path& path) {
    if (path.empty()) return;
    std::error_code ignored;
    int error = std::filesystem::is_directory(path, ignored) ? EISDIR : 0;
    const std::string probe = path.string() + ".tmp";  // as the writer names it
    if (const int file = error ? -1 : open(probe.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666); file >= 0) {
        close(file);
        unlink(probe.c_str());
    } else if (!error) {
        error = errno;
    }
    if (error)
        throw InputError(fmt::format("{}: {} cannot be written: {}; give another file", option, path.string(), std::generic_category().message(error)));
}

std::string counted(std::uint64_t count, std::string_view what) { return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s"); }

std::string short_number(double value) {
    if (!std::isfinite(value)) return "-";
    for (const auto& [size, suffix] : {std::pair{1e9, " G"}, {1e6, " M"}, {1e3, " k"}})
        if (std::fabs(value) >= size) return fmt::format("{:.3g}{}", value / size, suffix);
    return fmt::format("{:.3g}", value);
}

std::string duration_text(double seconds) {
    if (!std::isfinite(seconds)) return "-";
    if (seconds < 99.5) return fmt::format("{:.3g} s", seconds);
    const auto whole = static_cast<long long>(seconds + 0.5);
    if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
    if (whole < 100 * 3600) return fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
    return fmt::format("{:.3g} days", seconds / 86400);
}

std::string bytes_text(double bytes) {
    if (bytes >= 1024.0 * 1024 * 1024) return fmt::format("{:.3g} GiB", bytes / (1024.0 * 1024 * 1024));
    if (bytes >= 1024.0 * 1024) return fmt::format("{:.3g} MiB", bytes / (1024.0 * 1024));
    return fmt::format("{:.3g} KiB", bytes / 1024);
}

}  // namespace grainray::cli
