// Sums over the particles near places that are no particles, as smoothed particle hydrodynamics (SPH) takes them:
//   f(q) = sum_j V f_j W(|q - x_j|, h)
// in a periodic unit box. The sum of V W alone must be 1, and f = sin(2 pi x) must come back as the kernel smooths it.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <vector>

#include <grainray/neighbors.hpp>

namespace {

constexpr std::size_t side = 40;
constexpr float spacing = 1.0f / side;
constexpr float support = 4 * spacing;

/// Wendland's C2 kernel of three dimensions (Adv. Comput. Math. 4, 389, 1995), zero from `support` on.
double kernel(double distance) {
    const double q = distance / support, s = 1 - q;
    if (s <= 0) return 0;
    return 21 / (2 * std::numbers::pi * std::pow(support, 3)) * s * s * s * s * (1 + 4 * q);
}

/// What the kernel leaves of a wave sin(k x), from its moments: 1 - k^2 <x^2> / 2, <x^2> = support^2 / 15.
double damping(double k) { return 1 - k * k * support * support / 30; }

std::vector<float> lattice() {
    std::vector<float> xyz;
    for (std::size_t k = 0; k < side; ++k)
        for (std::size_t j = 0; j < side; ++j)
            for (std::size_t i = 0; i < side; ++i)
                for (const std::size_t a : {i, j, k}) xyz.push_back((static_cast<float>(a) + 0.5f) * spacing);
    return xyz;
}

double nearest(double d) { return d - std::round(d); }

double distance(const float* a, const float* b) { return std::hypot(nearest(a[0] - b[0]), nearest(a[1] - b[1]), nearest(a[2] - b[2])); }

}  // namespace

int main() {
    const std::vector<float> particles = lattice();
    std::vector<float> queries(3 * 5000);
    std::mt19937 random(1);
    for (float& x : queries) x = std::uniform_real_distribution<float>(0, 1)(random);

    grainray::SearchOptions options;
    options.period = {1, 1, 1};
    grainray::NeighborSearch search(grainray::Device::cpu, options);
    grainray::NeighborList list;
    // A query's reach and a particle's add up: the whole support belongs to the query here.
    search.find(grainray::Points::xyz(queries.data(), queries.size() / 3, support),
                grainray::Points::xyz(particles.data(), particles.size() / 3, 0), list);

    const double k = 2 * std::numbers::pi, volume = std::pow(spacing, 3);
    double worst_unity = 0, worst_wave = 0;
    for (std::size_t q = 0; q < list.rows(); ++q) {
        double unity = 0, wave = 0;
        for (std::uint64_t e = list.offsets.view()[q]; e < list.offsets.view()[q + 1]; ++e) {
            const float* x = &particles[3 * list.neighbors.view()[e]];
            const double w = volume * kernel(distance(&queries[3 * q], x));
            unity += w;
            wave += w * std::sin(k * x[0]);
        }
        worst_unity = std::max(worst_unity, std::abs(unity - 1));
        worst_wave = std::max(worst_wave, std::abs(wave - damping(k) * std::sin(k * queries[3 * q])));
    }
    std::printf("%zu queries, %.1f particles each, found by %s\n", list.rows(),
                static_cast<double>(list.neighbors.size()) / static_cast<double>(list.rows()), search.backend().c_str());
    std::printf("sum of V W: within %.1e of 1; sin(2 pi x): within %.1e of the smoothed wave\n", worst_unity, worst_wave);
    return worst_unity < 2e-3 && worst_wave < 2e-3 ? 0 : 1;
}
