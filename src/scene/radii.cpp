// Radii of a group, drawn from its size distribution.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/place.hpp"

namespace grainray {

double smallest_radius(const SizeDistribution& size) {
    if (size.law == SizeLaw::fixed) return size.radius;
    if (size.law == SizeLaw::table) return size.radii.empty() ? 0 : *std::min_element(size.radii.begin(), size.radii.end());
    return size.minimum;
}

double largest_radius(const SizeDistribution& size) {
    if (size.law == SizeLaw::fixed) return size.radius;
    if (size.law == SizeLaw::table) return size.radii.empty() ? 0 : *std::max_element(size.radii.begin(), size.radii.end());
    return size.maximum;
}

namespace scene {

RadiusSampler::RadiusSampler(const SizeDistribution& size, std::uint64_t seed, const std::string& source, std::string where)
    : size_(size), where_(std::move(where)), random_(seed, source, Stream::radius) {
    if (size_.law == SizeLaw::lognormal) {  // of the logarithm, from those of the radius
        const double variance = std::log1p(size_.deviation * size_.deviation / (size_.mean * size_.mean));
        log_mean_ = std::log(size_.mean) - variance / 2;
        log_deviation_ = std::sqrt(variance);
    }
    double sum = 0;
    for (const double weight : size_.weights) cumulative_.push_back(sum += weight);
    if (!(largest_radius(size_) > 0)) throw InputError(fmt::format("{}: the radii must be greater than 0 m", where_));
}

double RadiusSampler::operator()(std::uint64_t n) const {
    switch (size_.law) {
        case SizeLaw::fixed: return size_.radius;
        case SizeLaw::uniform: return size_.minimum + (size_.maximum - size_.minimum) * random_.uniform(n);
        case SizeLaw::table: return from_table(n);
        default: return truncated(n);
    }
}

double RadiusSampler::truncated(std::uint64_t n) const {
    constexpr std::uint64_t most_draws = 4096;
    for (std::uint64_t draw = 0; draw < most_draws; ++draw) {
        const double z = random_.normal(n * most_draws + draw);
        const double radius =
            size_.law == SizeLaw::normal ? size_.mean + size_.deviation * z : std::exp(log_mean_ + log_deviation_ * z);
        if (radius >= size_.minimum && radius <= size_.maximum) return radius;
    }
    throw InputError(
        fmt::format("{}: hardly any radius with mean {} m and deviation {} m lies between radius_minimum = {} m and "
                    "radius_maximum = {} m; "
                    "move the cut-offs towards the mean",
                    where_, size_.mean, size_.deviation, size_.minimum, size_.maximum));
}

double RadiusSampler::from_table(std::uint64_t n) const {
    const double u = random_.uniform(n);
    if (cumulative_.empty()) return size_.radii[static_cast<std::size_t>(u * static_cast<double>(size_.radii.size()))];
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), u * cumulative_.back());
    const auto index = static_cast<std::size_t>(found - cumulative_.begin());
    return size_.radii[std::min(index, size_.radii.size() - 1)];
}

}  // namespace scene
}  // namespace grainray
