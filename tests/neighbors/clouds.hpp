// Clouds of points that searches get wrong, and an oracle written on its own: all pairs, straight from the contract.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "grainray/neighbors.hpp"

namespace grainray::test {

struct Cloud {
    std::string name;
    std::vector<float> x, y, z, reach;
    Vec3f lower{}, period{};

    std::size_t size() const { return x.size(); }
    void add(float px, float py, float pz, float r) {
        x.push_back(px);
        y.push_back(py);
        z.push_back(pz);
        reach.push_back(r);
    }
};

inline Cloud random_cloud(std::string name, std::size_t n, float low, float high, float reach, unsigned seed, Vec3f shift = {}) {
    Cloud c{std::move(name), {}, {}, {}, {}, {}, {}};
    std::mt19937 e(seed);
    std::uniform_real_distribution<float> u(low, high);
    for (std::size_t i = 0; i < n; ++i) c.add(u(e) + shift.x, u(e) + shift.y, u(e) + shift.z, reach);
    return c;
}

/// Lattice whose spacing is exactly the sum of two reaches: d < R must be false for axis neighbours.
inline Cloud lattice_cloud(std::string name, int side, float spacing, float reach, Vec3f shift = {}) {
    Cloud c{std::move(name), {}, {}, {}, {}, {}, {}};
    for (int k = 0; k < side; ++k)
        for (int j = 0; j < side; ++j)
            for (int i = 0; i < side; ++i) c.add(shift.x + i * spacing, shift.y + j * spacing, shift.z + k * spacing, reach);
    return c;
}

inline std::vector<Cloud> adversarial_clouds() {
    std::vector<Cloud> all;
    all.push_back({"none", {}, {}, {}, {}, {}, {}});
    Cloud one{"one", {}, {}, {}, {}, {}, {}};
    one.add(1, 2, 3, 0.5f);
    all.push_back(one);
    Cloud two{"two", {}, {}, {}, {}, {}, {}};
    two.add(0, 0, 0, 0.5f);
    two.add(0.999f, 0, 0, 0.5f);
    all.push_back(two);
    all.push_back(random_cloud("random", 1500, -1, 1, 0.09f, 1));
    all.push_back(random_cloud("negative_far", 800, -1, 1, 0.1f, 2, {-1e6f, 3e5f, -7e5f}));
    all.push_back(lattice_cloud("on_the_radius", 9, 0.25f, 0.125f));
    all.push_back(lattice_cloud("diagonal_lattice", 9, 1.0f, 0.75f, {-4, 100, 0.5f}));
    all.push_back(random_cloud("everyone_meets_everyone", 120, 0, 1, 5.0f, 3));
    all.push_back(random_cloud("zero_reach", 300, 0, 1, 0.0f, 4));

    Cloud duplicates = random_cloud("duplicates", 150, 0, 1, 0.05f, 5);
    for (int k = 0; k < 40; ++k) duplicates.add(0.5f, 0.5f, 0.5f, 0.05f);
    all.push_back(duplicates);

    Cloud mixed = random_cloud("mixed_1_to_100", 900, 0, 1, 0.005f, 6);
    for (std::size_t i = 0; i < mixed.size(); i += 90) mixed.reach[i] = 0.5f * static_cast<float>(i + 1) / 900;
    all.push_back(mixed);

    Cloud wild = random_cloud("reach_1e-3_to_1e3", 400, -500, 500, 0, 7);
    for (std::size_t i = 0; i < wild.size(); ++i) wild.reach[i] = std::pow(10.0f, -3.0f + 6.0f * static_cast<float>(i) / 400);
    all.push_back(wild);

    Cloud line{"collinear", {}, {}, {}, {}, {}, {}};
    for (int i = 0; i < 500; ++i) line.add(0.3f * static_cast<float>(i), 0, 0, 0.2f);
    all.push_back(line);
    Cloud sheet = random_cloud("coplanar", 600, 0, 10, 0.3f, 8);
    std::fill(sheet.z.begin(), sheet.z.end(), -2.5f);
    all.push_back(sheet);

    Cloud outlier = random_cloud("one_far_outlier", 500, 0, 1, 0.06f, 9);
    outlier.add(1e9f, -1e9f, 1e9f, 0.06f);
    all.push_back(outlier);
    Cloud clusters{"clusters_in_a_wide_world", {}, {}, {}, {}, {}, {}};
    for (unsigned c = 0; c < 12; ++c) {
        const Cloud part = random_cloud("", 60, 0, 1, 0.15f, 20 + c, {250.0f * static_cast<float>(c), -90.0f * static_cast<float>(c * c), 31.0f * static_cast<float>(c)});
        for (std::size_t i = 0; i < part.size(); ++i) clusters.add(part.x[i], part.y[i], part.z[i], part.reach[i]);
    }
    all.push_back(clusters);

    Cloud heap{"all_at_one_point", {}, {}, {}, {}, {}, {}};
    for (int i = 0; i < 90; ++i) heap.add(-7, 0.1f, 1e4f, 1e-3f);
    all.push_back(heap);
    Cloud far_wild = random_cloud("reach_1e-3_to_1e3_at_1e6", 400, -1e3f, 1e3f, 0, 30, {1e6f, -1e6f, 1e6f});
    for (std::size_t i = 0; i < far_wild.size(); ++i) far_wild.reach[i] = std::pow(10.0f, -3.0f + 6.0f * static_cast<float>(i * 7 % 400) / 400);
    all.push_back(far_wild);
    all.push_back(lattice_cloud("on_the_faces_of_the_boxes", 9, 0.1f, 0.1f, {0.1f, -0.3f, 1000.0f}));
    Cloud lognormal = random_cloud("lognormal", 1200, 0, 10, 0, 31);
    std::mt19937 e(32);
    std::normal_distribution<float> normal(-1.5f, 0.7f);
    for (float& r : lognormal.reach) r = std::exp(normal(e));
    all.push_back(lognormal);
    Cloud nearly_equal = random_cloud("nearly_equal", 1500, -1, 1, 0.09f, 38);  // CUDA lets some of these find each other both
    for (std::size_t i = 0; i < nearly_equal.size(); ++i) nearly_equal.reach[i] *= 0.7f + 0.025f * static_cast<float>(i % 25);
    all.push_back(nearly_equal);
    all.push_back(random_cloud("squares_underflow", 300, -1e-22f, 1e-22f, 2e-23f, 33));
    all.push_back(random_cloud("squares_overflow", 150, -5e18f, 5e18f, 3e19f, 34));
    all.push_back(random_cloud("coordinates_past_1e18", 300, -4e18f, 4e18f, 4e17f, 35));

    const auto periodic = [&](Cloud c, Vec3f lower, Vec3f period) {
        c.lower = lower;
        c.period = period;
        all.push_back(std::move(c));
    };
    periodic(random_cloud("periodic_xyz", 700, 0, 1, 0.07f, 10), {}, {1, 1, 1});
    periodic(random_cloud("periodic_x_only", 700, -1, 1, 0.1f, 11), {-1, 0, 0}, {2, 0, 0});
    periodic(random_cloud("periodic_barely_larger_than_the_reach", 60, 0, 1, 0.49f, 12), {}, {1, 1, 1});
    periodic(random_cloud("periodic_smaller_than_the_reach", 40, 0, 1, 0.8f, 13), {}, {1, 1, 1});
    periodic(random_cloud("periodic_points_outside_the_box", 500, -3, 3, 0.08f, 14), {0, 0, 0}, {1, 0, 1.5f});
    Cloud boulders = random_cloud("periodic_boulders", 500, 0, 1, 0.02f, 36);
    for (std::size_t i = 0; i < 500; i += 125) boulders.reach[i] = 0.3f;
    periodic(boulders, {0, 0, 0}, {1, 1, 1});
    periodic(random_cloud("periodic_box_at_1e6", 600, 0, 40, 2.0f, 37, {1e6f, -1e6f, 3e5f}), {1e6f, -1e6f, 3e5f}, {40, 40, 40});
    periodic(lattice_cloud("periodic_lattice_on_the_radius", 8, 0.125f, 0.0625f), {}, {1, 1, 1});
    return all;
}

/// The contract by itself, over all pairs; own code, so that a fault of the library cannot hide in it.
struct Oracle {
    const Cloud& c;

    static float wrapped(float v, float lower, float period) {
        if (!(period > 0)) return v;
        const float w = v - period * std::floor((v - lower) / period);
        return w < lower + period ? std::max(w, lower) : lower;
    }
    static float shortest(float d, float period) {
        if (period > 0 && d > 0.5f * period) return d - period;
        if (period > 0 && d < -0.5f * period) return d + period;
        return d;
    }
    bool neighbors(std::size_t i, std::size_t j) const {
        const float dx = shortest(wrapped(c.x[i], c.lower.x, c.period.x) - wrapped(c.x[j], c.lower.x, c.period.x), c.period.x);
        const float dy = shortest(wrapped(c.y[i], c.lower.y, c.period.y) - wrapped(c.y[j], c.lower.y, c.period.y), c.period.y);
        const float dz = shortest(wrapped(c.z[i], c.lower.z, c.period.z) - wrapped(c.z[j], c.lower.z, c.period.z), c.period.z);
        const float sum = c.reach[i] + c.reach[j];
        return (dx * dx + dy * dy) + dz * dz < sum * sum;
    }
    /// Rows of the list a kind asks for.
    std::vector<std::vector<std::uint32_t>> rows(ListKind kind, std::uint32_t block) const {
        std::vector<std::vector<std::uint32_t>> out(c.size());
        for (std::uint32_t i = 0; i < c.size(); ++i)
            for (std::uint32_t j = 0; j < c.size(); ++j) {
                if (i == j || !neighbors(i, j)) continue;
                const bool owner = c.reach[i] > c.reach[j] || (c.reach[i] == c.reach[j] && i > j);
                const bool listed = kind == ListKind::full || (kind == ListKind::half && owner) ||
                                    (kind == ListKind::blocked && (owner || i / block != j / block));
                if (listed) out[i].push_back(j);
            }
        return out;
    }
};

/// Of the points where a periodic box has them.
inline Extents extents_of(const Cloud& c) {
    if (c.size() == 0) return {};
    constexpr float far = std::numeric_limits<float>::max();
    Extents e{{far, far, far}, {-far, -far, -far}, far, 0, 0};
    double sum = 0;
    for (std::size_t i = 0; i < c.size(); ++i) {
        const Vec3f x{Oracle::wrapped(c.x[i], c.lower.x, c.period.x), Oracle::wrapped(c.y[i], c.lower.y, c.period.y), Oracle::wrapped(c.z[i], c.lower.z, c.period.z)};
        for (int a = 0; a < 3; ++a) {
            e.lower[a] = std::min(e.lower[a], x[a]);
            e.upper[a] = std::max(e.upper[a], x[a]);
        }
        e.min_reach = std::min(e.min_reach, c.reach[i]);
        e.max_reach = std::max(e.max_reach, c.reach[i]);
        sum += c.reach[i];
    }
    e.mean_reach = static_cast<float>(sum / static_cast<double>(c.size()));
    return e;
}

/// A cloud on a device.
struct DeviceCloud {
    Array<float> x, y, z, reach;
    std::size_t n;

    DeviceCloud(Device d, const Cloud& c) : x(d, c.x), y(d, c.y), z(d, c.z), reach(d, c.reach), n(c.size()) {}
    Points points() const { return {x.data(), y.data(), z.data(), 1, reach.data(), 1, 0, nullptr, n}; }
};

inline std::vector<std::vector<std::uint32_t>> rows_of(const NeighborList& list) {
    const auto offsets = list.offsets.to_host();
    const auto neighbors = list.neighbors.to_host();
    std::vector<std::vector<std::uint32_t>> rows(list.rows());
    for (std::size_t i = 0; i < rows.size(); ++i)
        rows[i].assign(neighbors.begin() + static_cast<std::ptrdiff_t>(offsets[i]), neighbors.begin() + static_cast<std::ptrdiff_t>(offsets[i + 1]));
    return rows;
}

}  // namespace grainray::test
