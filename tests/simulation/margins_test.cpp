// What a list leaves out cannot touch while the list lasts, whatever the particles do within their margins. Not motions are tried
// but the margins, frames and reaches themselves, so one list stands for every motion that it allows. Lengths in radii, times in steps.
#include <cmath>
#include <random>

#include "devices.hpp"
#include "stages.hpp"

namespace grainray::test {
namespace {

struct Cloud {
    std::vector<Vec3d> places, velocities;
    std::vector<double> radii;
    Vec3d period;
    float least = 0.01f, interval = 1000;
    std::mt19937_64 engine{5};

    double random(double low, double high) { return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53; }
    void add(Vec3d x, Vec3d v, double r = 1) {
        places.push_back(x);
        velocities.push_back(v);
        radii.push_back(r);
    }
    /// In a box, overlapping as they may: they make its frame.
    void cluster(int n, Vec3d lower, Vec3d upper, Vec3d v, double jitter = 0) {
        for (int k = 0; k < n; ++k) {
            Vec3d x, w = v;
            for (int a = 0; a < 3; ++a) {
                x[a] = random(lower[a], upper[a]);
                w[a] += random(-jitter, jitter);
            }
            add(x, w, random(0.3, 1));
        }
    }
};

/// What the stage made of a cloud.
struct Made {
    std::uint32_t limit;
    std::vector<Near> built;
    std::vector<Vec3f> frame;
    std::vector<float> points;
    double unit;
    double margin(std::size_t i) const { return built[i].radius * unit; }
    double reach(std::size_t i) const { return points[4 * i + 3]; }
};

Made make(const Cloud& c, Device device) {
    State s(device);
    const std::size_t n = c.places.size();
    s.particles.scale = PositionScale::for_radius(1, {});
    const double unit = s.particles.scale.unit;
    std::vector<Near> near;
    std::vector<Far> far;
    std::vector<Body> body;
    s.lower = s.upper = convert<float>(c.places[0]);
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3l x = s.particles.scale.fixed(c.places[i]);
        near.push_back({near_of(x.x), near_of(x.y), near_of(x.z), static_cast<std::int32_t>(std::llrint(c.radii[i] / unit))});
        far.push_back(far_of(x));
        body.push_back({convert<float>(c.velocities[i]), 1, {}, 0});
        for (int a = 0; a < 3; ++a) {
            s.lower[a] = std::min(s.lower[a], static_cast<float>(c.places[i][a]));
            s.upper[a] = std::max(s.upper[a], static_cast<float>(c.places[i][a]));
        }
    }
    for (int a = 0; a < 3; ++a) s.period[a] = std::llrint(c.period[a] / unit);
    s.particles.near.assign(near);
    s.particles.far.assign(far);
    s.particles.body.assign(body);
    MarginRule rule;
    rule.least = c.least;
    rule.interval = c.interval;
    rule.most_units = static_cast<float>(1 / unit);
    Array<float> points(device);
    stages(device).margins(s, {1, {}, 0}, rule, points);
    return {s.age.limit, s.built.to_host(), s.frame.to_host(), points.to_host(), unit};
}

/// How near x + u s comes to 0 for 0 <= s <= t.
double nearest(const Vec3d& x, const Vec3d& u, double t) {
    const double uu = dot(u, u), s = uu > 0 ? std::clamp(-dot(x, u) / uu, 0.0, t) : 0;
    return length(x + u * s);
}

struct Verdict {
    double deepest = 0;   ///< by which a pair that is not listed may overlap
    double farthest = 0;  ///< that a listed pair may come apart
    int runaways = 0;     ///< margins beyond 1.75
};

Verdict judge(const Cloud& c, const Made& m) {
    Verdict v;
    const double age = m.limit - 1.0;  // a list is used where it was made and after each step but the last
    for (std::size_t i = 0; i < c.places.size(); ++i) {
        v.runaways += m.margin(i) > 1.75;
        for (std::size_t j = 0; j < i; ++j) {
            const Vec3d u = convert<double>(m.frame[i] - m.frame[j]) * m.unit;
            const double sum = c.radii[i] + c.radii[j] + m.margin(i) + m.margin(j);
            Vec3d image = c.places[i] - c.places[j];
            for (int a = 0; a < 3; ++a)
                if (c.period[a] > 0) image[a] -= c.period[a] * std::round(image[a] / c.period[a]);
            if (length(image) < m.reach(i) + m.reach(j)) {
                v.farthest = std::max(v.farthest, length(image) + m.margin(i) + m.margin(j) + age * length(u));
                continue;
            }
            for (int k = 0; k < 27; ++k) {
                const Vec3d x = image + Vec3d{(k % 3 - 1) * c.period.x, (k / 3 % 3 - 1) * c.period.y, (k / 9 - 1) * c.period.z};
                v.deepest = std::max(v.deepest, sum - nearest(x, u, age));
            }
        }
    }
    return v;
}

// Boxes are 8 radii wide from the smallest coordinate on: a cloud's corner stands at 0.
constexpr double u = 0.02;

/// With an empty box between them.
Cloud clusters_closing_in() {
    Cloud c;
    c.add({0, 0, 0}, {u, 0, 0});
    c.cluster(80, {2, 1, 1}, {7.9, 7, 7}, {u, 0, 0});
    c.cluster(80, {16.1, 1, 1}, {22, 7, 7}, {-u, 0, 0});
    return c;
}
/// Two clusters with an empty box between them drive at each other with the widest margins of ordinary particles.
Cloud ordinary_head_on() {
    Cloud c = clusters_closing_in();
    c.least = 1.4f;
    c.add({7.99, 4, 4}, {u, 0, 0});
    c.add({16.01, 4, 4}, {-u, 0, 0});
    return c;
}
/// A runaway and, in a cluster with an empty box between, a particle with the widest margin of its kind.
Cloud runaway_against_drift(double side) {
    Cloud c = clusters_closing_in();
    c.least = 1.7f;
    c.add({7.99, 4, 4}, {20 * u * (1 - side), 0, 20 * u * side});
    c.add({16.6, 4, 4}, {-u, 0, 0});
    return c;
}
Cloud runaway_along() { return runaway_against_drift(0); }
Cloud runaway_across() { return runaway_against_drift(1); }
Cloud two_runaways() {
    Cloud c = runaway_along();
    c.add({17.5, 4, 4}, {-20 * u, 0, 0});
    return c;
}
/// Hardly runaways: margins of 2 to 2.5.
Cloud two_slow_runaways() {
    Cloud c = clusters_closing_in();
    c.add({7.99, 4, 4}, {2.3 * u, 0, 0});
    c.add({16.01, 4, 4}, {-2.3 * u, 0, 0});
    return c;
}
/// With two empty boxes between: nothing but the spread of all frames keeps them apart.
Cloud far_runaways() {
    Cloud c;
    c.add({0, 0, 0}, {u, 0, 0});
    c.cluster(80, {2, 1, 1}, {7.9, 7, 7}, {u, 0, 0});
    c.cluster(80, {24.1, 1, 1}, {30, 7, 7}, {-u, 0, 0});
    c.add({7.99, 4, 4}, {20 * u, 0, 0});
    c.add({24.01, 4, 4}, {-20 * u, 0, 0});
    c.cluster(80, {48.1, 1, 1}, {54, 7, 7}, {u, 0, 0});  // where the boxes wrap round, next to the first but one
    return c;
}
/// Boxes that touch and drift past and towards each other.
Cloud sheared() {
    Cloud c = clusters_closing_in();
    c.least = 0.3f;
    for (int k = 0; k < 40; ++k) c.add({8.1 + 0.19 * k, 4, 4}, {0, 0, 0});
    return c;
}
/// Clusters and lone ones at random, small and large, fast and slow, in a world that may be periodic.
Cloud random_world(unsigned seed, bool periodic) {
    Cloud c;
    c.engine.seed(seed);
    const double size = c.random(20, 70), speed = std::exp2(c.random(-8, 1));
    if (periodic) c.period = {size, size, size};
    const auto any = [&](double s) { return Vec3d{c.random(-s, s), c.random(-s, s), c.random(-s, s)}; };
    const int clusters = static_cast<int>(c.random(2, 6));
    for (int k = 0; k < clusters; ++k) {
        const Vec3d lower{c.random(0, size - 8), c.random(0, size - 8), c.random(0, size - 8)};
        c.cluster(static_cast<int>(c.random(10, 90)), lower, lower + Vec3d{1, 1, 1} * c.random(2, 7.9), any(speed), speed * c.random(0, 1));
    }
    for (int k = 0; k < 30; ++k) c.add({c.random(0, size), c.random(0, size), c.random(0, size)}, any(speed * c.random(1, 20)), c.random(0.05, 1));
    c.least = static_cast<float>(c.random(0, 1.7));
    return c;
}

constexpr double rounding = 1e-4;

struct Named {
    const char* name;
    Cloud (*make)();
    int runaways;
};
const Named clouds[] = {{"ordinary_head_on", ordinary_head_on, 0}, {"runaway_along", runaway_along, 1}, {"runaway_across", runaway_across, 1},
                        {"two_runaways", two_runaways, 2}, {"two_slow_runaways", two_slow_runaways, 2}, {"far_runaways", far_runaways, 2}, {"sheared", sheared, 0}};

class Margins : public ::testing::TestWithParam<std::tuple<Device, Named>> {};

TEST_P(Margins, CoverEveryMotionTheyAllow) {
    const auto [device, named] = GetParam();
    GRAINRAY_NEEDS(device);
    const Cloud c = named.make();
    const Made m = make(c, device);
    const Verdict v = judge(c, m);
    EXPECT_LT(v.deepest, rounding) << "of a pair that is not listed, in a list for " << m.limit << " steps";
    EXPECT_LT(v.farthest, 22.6) << "near words would overflow";
    EXPECT_GE(v.runaways, named.runaways) << "the cloud is not what it should be";
    EXPECT_GE(m.limit, 40u) << "the list is worth nothing here";
}

INSTANTIATE_TEST_SUITE_P(Clouds, Margins, ::testing::Combine(all_devices, ::testing::ValuesIn(clouds)), [](const auto& one) {
    return std::string(name(std::get<0>(one.param))) + "_" + std::get<1>(one.param).name;
});

class MarginsAtRandom : public ::testing::TestWithParam<Device> {};

TEST_P(MarginsAtRandom, CoverEveryMotionTheyAllow) {
    GRAINRAY_NEEDS(GetParam());
    int runaways = 0;
    for (unsigned seed = 0; seed < 400; ++seed) {
        const Cloud c = random_world(seed, seed % 2);
        const Made m = make(c, GetParam());
        const Verdict v = judge(c, m);
        runaways += v.runaways;
        ASSERT_LT(v.deepest, rounding) << "seed " << seed << ", a list for " << m.limit << " steps";
        ASSERT_LT(v.farthest, 22.6) << "seed " << seed;
    }
    EXPECT_GT(runaways, 400);
}

INSTANTIATE_TEST_SUITE_P(Devices, MarginsAtRandom, all_devices, device_name);

TEST(Margins, ALoneRunawayIsNoFrameOfItsOwn) {
    Cloud c;
    c.cluster(200, {0, 0, 0}, {8, 8, 8}, {});
    c.add({60, 4, 4}, {0.17, 0, 0});  // it will hit something: a margin for its own velocity is worth having
    c.interval = 15;
    const Made m = make(c, Device::cpu);
    EXPECT_EQ(m.limit, 15u);
    EXPECT_NEAR(m.margin(200), 0.17 * 15 * 16 / 17, 0.05);
}

TEST(Margins, OfAListForOneStepStayWithinTheNearWords) {  // however fast boxes drift apart
    Cloud c;
    c.add({0, 0, 0}, {10, 0, 0});
    c.cluster(80, {2, 1, 1}, {7.9, 7, 7}, {10, 0, 0});
    c.cluster(80, {16.1, 1, 1}, {22, 7, 7}, {-10, 0, 0});
    c.add({0.1, 4, 4}, {30, 0, 0});
    c.add({22.9, 4, 4}, {-30, 0, 0});
    const Made m = make(c, Device::cpu);
    EXPECT_EQ(m.limit, 1u);
    const Verdict v = judge(c, m);
    EXPECT_LT(v.deepest, rounding);
    EXPECT_LT(v.farthest, 22.6);
}

TEST(Margins, WhatMovesAsOneHasNone) {
    Cloud c;
    c.cluster(200, {0, 0, 0}, {8, 8, 8}, {3, 2, -1});
    c.add({60, 4, 4}, {3, 2, -1});
    const Made m = make(c, Device::cpu);
    EXPECT_EQ(m.limit, 1000u);
    for (std::size_t i = 0; i < 201; ++i) EXPECT_LT(m.margin(i), 0.1);
}

}  // namespace
}  // namespace grainray::test
