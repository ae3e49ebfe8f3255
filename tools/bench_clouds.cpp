#include "bench_clouds.hpp"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "neighbors/morton.hpp"

namespace grainray::cli {
namespace {

constexpr double wanted_neighbors = 10;
constexpr double ball = 4.0 / 3.0 * std::numbers::pi;  ///< volume of a sphere of radius one
constexpr int patches = 64;                            ///< of the sparse and the clustered cloud

using Random = std::mt19937_64;
using Uniform = std::uniform_real_distribution<double>;

/// Reach of points that all have the same and lie one in a unit of volume.
double equal_reach() { return 0.5 * std::cbrt(wanted_neighbors / ball); }

void add(Cloud& cloud, const std::array<double, 3>& at) {
    for (const double x : at) cloud.xyz.push_back(static_cast<float>(x));
}

void fill_cube(Cloud& cloud, std::size_t n, Random& random) {
    Uniform place(0, std::cbrt(static_cast<double>(n)));
    for (std::size_t i = 0; i < n; ++i) add(cloud, {place(random), place(random), place(random)});
}

void make_random(Cloud& cloud, std::size_t n, Random& random) {
    fill_cube(cloud, n, random);
    cloud.reach.assign(n, static_cast<float>(equal_reach()));
}

void make_lattice(Cloud& cloud, std::size_t n, Random& random) {
    Uniform shift(0, 0.3);
    const auto side = static_cast<std::size_t>(std::ceil(std::cbrt(static_cast<double>(n))));
    for (std::size_t i = 0; i < n; ++i) {
        const auto at = [&](std::size_t k) { return static_cast<double>(k) + shift(random); };
        add(cloud, {at(i % side), at(i / side % side), at(i / side / side)});
    }
    cloud.reach.assign(n, 0.7f);
}

/// Scales reaches of any distribution so that points in a unit of volume each have the wanted neighbours on average:
/// their number is 4/3 pi <(R_i + R_j)^3>, and <(R_i + R_j)^3> = 2 <R^3> + 6 <R> <R^2>.
void scale_reaches(std::vector<double> reach, Cloud& cloud) {
    double m1 = 0, m2 = 0, m3 = 0;
    for (const double r : reach) m1 += r, m2 += r * r, m3 += r * r * r;
    const double n = static_cast<double>(reach.size());
    const double factor = std::cbrt(wanted_neighbors / (ball * (2 * m3 / n + 6 * m1 / n * m2 / n)));
    for (const double r : reach) cloud.reach.push_back(static_cast<float>(factor * r));
}

void make_lognormal(Cloud& cloud, std::size_t n, Random& random) {
    fill_cube(cloud, n, random);
    std::normal_distribution<double> normal;
    std::vector<double> reach(n);
    for (double& r : reach) {
        double z = normal(random);
        while (std::abs(z) > 2) z = normal(random);
        r = std::exp(z * std::log(cloud.ratio) / 4);
    }
    scale_reaches(std::move(reach), cloud);
}

void make_two_size(Cloud& cloud, std::size_t n, Random& random) {
    fill_cube(cloud, n, random);
    std::bernoulli_distribution large(1 / (1 + std::pow(cloud.ratio, 3)));
    std::vector<double> reach(n);
    for (double& r : reach) r = large(random) ? cloud.ratio : 1;
    scale_reaches(std::move(reach), cloud);
}

void make_sparse(Cloud& cloud, std::size_t n, Random& random) {
    constexpr double world = 3000;
    const double volume = 0.01 * world * world * world, side = std::cbrt(volume / patches);
    Uniform corner(0, world - side), inside(0, side);
    std::array<std::array<double, 3>, patches> corners;
    for (auto& c : corners) c = {corner(random), corner(random), corner(random)};
    for (std::size_t i = 0; i < n; ++i) {
        const auto& c = corners[i % patches];
        add(cloud, {c[0] + inside(random), c[1] + inside(random), c[2] + inside(random)});
    }
    cloud.reach.assign(n, static_cast<float>(equal_reach() * std::cbrt(volume / static_cast<double>(n))));
}

void make_clustered(Cloud& cloud, std::size_t n, Random& random) {
    Uniform exponent(0, std::log(4.0));
    std::array<double, patches> sigma;
    double inverse_cubes = 0;
    for (double& s : sigma) s = std::exp(exponent(random)), inverse_cubes += 1 / (s * s * s);
    // A point of a Gaussian cluster of m points sees on average a density of m / ((4 pi)^1.5 sigma^3): make that one.
    const double unit = std::cbrt(static_cast<double>(n) / patches * inverse_cubes / patches / std::pow(4 * std::numbers::pi, 1.5));
    Uniform centre(0, 40 * unit);
    std::array<std::array<double, 3>, patches> centres;
    for (auto& c : centres) c = {centre(random), centre(random), centre(random)};
    std::normal_distribution<double> normal;
    for (std::size_t i = 0; i < n; ++i) {
        const auto& c = centres[i % patches];
        const double s = unit * sigma[i % patches];
        add(cloud, {c[0] + s * normal(random), c[1] + s * normal(random), c[2] + s * normal(random)});
    }
    cloud.reach.assign(n, static_cast<float>(equal_reach()));
}

struct Maker {
    const char* name;
    bool sizes;
    void (*make)(Cloud&, std::size_t, Random&);
};
constexpr std::array makers{Maker{"random", false, make_random},       Maker{"lattice", false, make_lattice},
                            Maker{"lognormal", true, make_lognormal},  Maker{"two-size", true, make_two_size},
                            Maker{"sparse", false, make_sparse},       Maker{"clustered", false, make_clustered}};

const Maker& maker(const std::string& name) {
    for (const Maker& m : makers)
        if (name == m.name) return m;
    throw InputError("there is no cloud '" + name + "'");
}

/// The order of the points' places along a Morton curve through their bounding cube.
std::vector<std::size_t> morton_order(const Cloud& cloud) {
    const auto [low, high] = std::minmax_element(cloud.xyz.begin(), cloud.xyz.end());
    const double lower = *low, scale = 2097151 / std::max(static_cast<double>(*high) - lower, 1e-30);
    std::vector<std::pair<std::uint64_t, std::size_t>> keys(cloud.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const auto cell = [&](std::size_t a) { return static_cast<std::uint64_t>((cloud.xyz[3 * i + a] - lower) * scale); };
        keys[i] = {neighbors::morton(cell(0), cell(1), cell(2)), i};
    }
    tbb::parallel_sort(keys);
    std::vector<std::size_t> order(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i) order[i] = keys[i].second;
    return order;
}

void rearrange(Cloud& cloud) {
    std::vector<std::size_t> order;
    if (cloud.order == "morton") {
        order = morton_order(cloud);
    } else {
        order.resize(cloud.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::shuffle(order.begin(), order.end(), Random(2));
    }
    const Cloud old = cloud;
    for (std::size_t i = 0; i < order.size(); ++i) {
        cloud.reach[i] = old.reach[order[i]];
        for (std::size_t a = 0; a < 3; ++a) cloud.xyz[3 * i + a] = old.xyz[3 * order[i] + a];
    }
}

}  // namespace

const std::vector<std::string>& cloud_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const Maker& m : makers) all.push_back(m.name);
        return all;
    }();
    return names;
}

bool has_sizes(const std::string& cloud) { return maker(cloud).sizes; }

Cloud make_cloud(const std::string& name, double ratio, std::size_t points, const std::string& order) {
    const Maker& m = maker(name);
    if (!(ratio >= 1)) throw InputError("a ratio of sizes must be at least 1");
    Cloud cloud{name, m.sizes ? ratio : 1, order, {}, {}};
    cloud.xyz.reserve(3 * points);
    Random random(1);
    m.make(cloud, points, random);
    if (points) rearrange(cloud);
    return cloud;
}

std::vector<float> moved_xyz(const Cloud& cloud) {
    std::vector<float> xyz = cloud.xyz;
    Random random(3);
    std::uniform_real_distribution<float> step(-0.05f, 0.05f);
    for (std::size_t k = 0; k < xyz.size(); ++k) xyz[k] += step(random) * cloud.reach[k / 3];
    return xyz;
}

Points points_of(const Array<float>& xyz, const Array<float>& reach) {
    Points points = Points::xyz(xyz.data(), reach.size(), 0);
    points.reach = reach.data();
    return points;
}

}  // namespace grainray::cli
