#include "validation/deposit.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace grainray::validation {
namespace {

constexpr double pi = 3.14159265358979323846, nan = std::numeric_limits<double>::quiet_NaN();

/// A least-squares line through (x, h): its slope as an angle downwards in degrees, and r2.
struct Line {
    double angle, r2;
};

double degrees(double radians) { return radians * 180 / pi; }

Line fit(const std::vector<double>& x, const std::vector<double>& h) {
    const double n = static_cast<double>(x.size());
    if (x.size() < 3) return {nan, nan};
    const double mx = std::reduce(x.begin(), x.end()) / n, mh = std::reduce(h.begin(), h.end()) / n;
    double xx = 0, xh = 0, hh = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += (x[i] - mx) * (x[i] - mx);
        xh += (x[i] - mx) * (h[i] - mh);
        hh += (h[i] - mh) * (h[i] - mh);
    }
    return {degrees(std::atan(-xh / xx)), xh * xh / (xx * hh)};
}

/// Where the centred mean of h over 5 bins falls below `height`, between two bins.
double edge(const Profile& p, double height, double bin) {
    const std::size_t n = p.x.size();
    const auto smooth = [&](std::size_t i) {
        const std::size_t first = i < 2 ? 0 : i - 2, last = std::min(n, i + 3);
        return std::accumulate(p.mass.begin() + static_cast<std::ptrdiff_t>(first), p.mass.begin() + static_cast<std::ptrdiff_t>(last), 0.0) /
               static_cast<double>(last - first);
    };
    for (std::size_t k = 1; k < n; ++k) {
        const double before = smooth(k - 1), here = smooth(k);
        if (here < height) return p.x[k - 1] + bin * (before - height) / (before - here);
    }
    return p.x.back();
}

/// The line through 20 to 80 % of the greatest height of the bed (the first `bins`), behind the place of that height.
Line flank(const std::vector<double>& x, const std::vector<double>& h, std::size_t bins) {
    const auto begin = h.begin(), end = begin + static_cast<std::ptrdiff_t>(bins), highest = std::max_element(begin, end);
    std::vector<double> fx, fh;
    for (auto i = static_cast<std::size_t>(highest - begin); i < bins; ++i)
        if (h[i] >= 0.2 * *highest && h[i] <= 0.8 * *highest) {
            fx.push_back(x[i]);
            fh.push_back(h[i]);
        }
    return fit(fx, fh);
}

double steepest(const Profile& p, std::size_t bins, const Channel& c) {
    const auto wide = static_cast<std::size_t>(std::max(4l, std::lround(0.4 * c.length / (2 * c.radius))));
    double most = nan;
    for (std::size_t i = 1; i + wide <= bins; ++i) {
        const auto part = [&](const std::vector<double>& v) {
            return std::vector<double>(v.begin() + static_cast<std::ptrdiff_t>(i), v.begin() + static_cast<std::ptrdiff_t>(i + wide));
        };
        most = std::fmax(most, fit(part(p.x), part(p.top)).angle);  // fmax passes over NaN
    }
    return most;
}

}  // namespace

Profile profile(const std::vector<Vec3d>& centres, const Channel& c) {
    const double bin = 2 * c.radius, volume = 4.0 / 3.0 * pi * c.radius * c.radius * c.radius;
    Profile p;
    for (const Vec3d& q : centres) {
        const auto i = static_cast<std::size_t>(std::max(0.0, std::floor(q.x / bin)));
        if (i >= p.x.size()) {
            p.top.resize(i + 1, 0);
            p.mass.resize(i + 1, 0);
            for (std::size_t k = p.x.size(); k <= i; ++k) p.x.push_back((static_cast<double>(k) + 0.5) * bin);
        }
        p.top[i] = std::max(p.top[i], q.z + c.radius);
        ++p.mass[i];
    }
    for (double& m : p.mass) m = m * volume / (bin * c.width * 0.6);  // counts until here
    return p;
}

Deposit measure(const std::vector<Vec3d>& centres, const Channel& c) {
    if (centres.empty()) throw Error("deposit: there are no spheres to measure");
    const Profile p = profile(centres, c);
    const std::size_t n = centres.size();
    std::vector<double> x(n);
    std::transform(centres.begin(), centres.end(), x.begin(), [](const Vec3d& q) { return q.x; });
    std::sort(x.begin(), x.end());
    const auto share = [&](double q) { return x[static_cast<std::size_t>(q * static_cast<double>(n))]; };

    Deposit d{};
    d.x_edge = edge(p, 4 * c.radius, 2 * c.radius);
    d.x_toe = edge(p, 2 * c.radius, 2 * c.radius);
    d.x_50 = share(0.5);
    d.x_95 = share(0.95);
    d.x_99 = share(0.99);
    d.x_max = x.back();
    d.z_mean = std::accumulate(centres.begin(), centres.end(), 0.0, [](double s, const Vec3d& q) { return s + q.z; }) / static_cast<double>(n);
    const std::size_t first = std::min<std::size_t>(5, p.top.size());
    d.h_wall = std::accumulate(p.top.begin(), p.top.begin() + static_cast<std::ptrdiff_t>(first), 0.0) / static_cast<double>(first);
    d.angle_secant = degrees(std::atan(d.h_wall / d.x_edge));
    const auto bins = static_cast<std::size_t>(std::count_if(p.x.begin(), p.x.end(), [&](double mid) { return mid < d.x_edge; }));
    const Line top = flank(p.x, p.top, bins), mass = flank(p.x, p.mass, bins);
    d.angle_top = top.angle;
    d.r2_top = top.r2;
    d.angle_mass = mass.angle;
    d.r2_mass = mass.r2;
    d.angle_steep = steepest(p, bins, c);
    return d;
}

}  // namespace grainray::validation
