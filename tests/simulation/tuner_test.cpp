// The tuner of interval and least margin, against worlds whose best knobs are known.
#include "devices.hpp"
#include "neighbors/interval.hpp"
#include "stages.hpp"

namespace grainray::test {
namespace {

/// A stand-in for a run. Margins are N own + s, searches reach `shear` N beyond; who leaves does so at `speed`. Entries grow as
/// (1 + w)^3, making a list costs 3.4 a particle and 1 an entry, times 60; a step 1 an entry, times (1 + w)^extra for the
/// knob that is dearer than entries tell. Radii a step.
struct World {
    double own = 0.01, shear = 0, speed = 0;  // speed 0: nobody leaves early
    double by_interval = 0, by_skin = 0;      // extra
    double particles = 1000, touching = 2000;
    double facets = 0;                        // a step also costs this for each entry: candidates of facets grow as entries do

    double widening(double n, double s) const { return (own + shear) * n + s; }
    double entries(double n, double s) const { return touching * std::pow(1 + widening(n, s), 3); }
    double update(double n, double s) const { return 60 * (3.4 * particles + entries(n, s)); }
    double contact(double n, double s) const { return entries(n, s) * std::pow(1 + own * n, by_interval) * std::pow(1 + s, by_skin); }
    double boundary(double n, double s) const { return facets * entries(n, s); }
    static constexpr double speeds[] = {1.2, 0.7, 1, 0.6, 1.5};  // of those who leave one list after the other, over `speed`
    double life(double n, double s, double v) const { return v > 0 ? std::min(std::floor(n), std::ceil((own * n + s) / v)) : std::floor(n); }
    double cost(double n, double s) const {  // of a step
        double steps = 0;
        for (const double v : speeds) steps += life(n, s, v * speed) / std::size(speeds);
        return update(n, s) / steps + contact(n, s) + boundary(n, s);
    }

    double least() const {
        double best = 1e300;
        for (double n = 4; n <= 200; ++n)
            for (double s = 0.01; s <= 0.4; s += 0.01) best = std::min(best, cost(n, s));
        return best;
    }
    /// The k-th list.
    IntervalTuner::Life list(const IntervalTuner& tuner, std::size_t k = 0, double noise = 1) const {
        const double n = tuner.interval(), s = tuner.skin(), v = speed * speeds[k % std::size(speeds)], steps = life(n, s, v);
        IntervalTuner::Life l{steps, std::floor(n), entries(n, s), particles, widening(n, s), noise * update(n, s), steps * contact(n, s), steps * boundary(n, s)};
        if (l.early()) l.leaver_margin = own * n + s, l.leaver_speed = v;
        return l;
    }
};

struct Settled {
    double cost, interval, skin;
};
/// Means over 300 lists after the first hundred. Clocks are noisy.
Settled settle(const World& world) {
    IntervalTuner tuner;
    Settled mean{};
    for (std::size_t k = 0; k < 400; ++k) {
        const IntervalTuner::Life list = world.list(tuner, k, k % 3 ? 0.95 : 1.1);
        if (k >= 100) {
            mean.cost += world.cost(tuner.interval(), tuner.skin()) / 300;
            mean.interval += tuner.interval() / 300;
            mean.skin += tuner.skin() / 300;
        }
        tuner.finished(list);
    }
    return mean;
}

TEST(IntervalTuner, SettlesRoundTheOptimumWhereNobodyLeaves) {
    const World world;
    const Settled there = settle(world);
    EXPECT_LT(there.cost, 1.04 * world.least());
    EXPECT_LT(there.skin, 0.03);  // of no use
}

TEST(IntervalTuner, SettlesRoundTheOptimumWhereListsEndEarly) {
    const World world{0.004, 0, 0.02};
    const Settled there = settle(world);
    EXPECT_LT(there.cost, 1.05 * world.least());
    EXPECT_GT(there.skin, 0.1);
}

TEST(IntervalTuner, ShearMakesTheIntervalDearAndNotTheLeastMargin) {
    const World still{0.01, 0, 0.02}, sheared{0.01, 0.02, 0.02};
    const Settled a = settle(still), b = settle(sheared);
    EXPECT_LT(b.cost, 1.06 * sheared.least());
    EXPECT_LT(b.interval, 0.8 * a.interval);
    EXPECT_GT(b.skin, a.skin);
}

TEST(IntervalTuner, MeasuresWhatNoModelKnows) {  // a boulder's row grows with the least margin, that of a runaway with the interval
    const World boulder{0.01, 0, 0.02, 0, 12}, runaway{0.01, 0, 0.02, 12, 0};
    const Settled a = settle(boulder), b = settle(runaway);
    EXPECT_LT(a.cost, 1.13 * boulder.least());
    EXPECT_LT(b.cost, 1.08 * runaway.least());
    EXPECT_LT(a.skin, 0.5 * b.skin);
    EXPECT_GT(a.interval, 1.2 * b.interval);
}

TEST(IntervalTuner, CandidatesOfFacetsCostStepsToo) {
    World world{0.01, 0, 0.02};
    const Settled without = settle(world);
    world.facets = 3;
    const Settled there = settle(world);
    EXPECT_LT(there.cost, 1.04 * world.least());
    EXPECT_LT(there.interval, 0.8 * without.interval);
}

TEST(IntervalTuner, CandidatesCountForMoreWhereFewTouch) {  // at once, before it is measured
    const World world{0.01, 0, 0.02};
    const auto one_list_later = [&](double touching) {
        IntervalTuner tuner;
        IntervalTuner::Life list = world.list(tuner);
        list.touching = touching;
        tuner.finished(list);
        return tuner;
    };
    const IntervalTuner gas = one_list_later(0), packed = one_list_later(0.7), unknown = one_list_later(-1);
    EXPECT_LT(gas.interval(), 0.995 * packed.interval());
    EXPECT_LT(gas.skin(), packed.skin());
    EXPECT_EQ(unknown.interval(), packed.interval());
}

TEST(IntervalTuner, TriesEitherKnobWithoutTheOther) {
    const World world{0.004, 0, 0.02};
    IntervalTuner tuner;
    std::vector<double> intervals, skins;
    for (std::size_t k = 0; k < 200; ++k) {
        tuner.finished(world.list(tuner, k));
        intervals.push_back(std::log(tuner.interval()));
        skins.push_back(tuner.skin());
    }
    double interval_moves = 0, skin_moves = 0, together = 0;
    for (std::size_t k = 101; k < 200; ++k) {
        const double a = intervals[k] - intervals[k - 1], b = skins[k] - skins[k - 1];
        interval_moves += a * a;
        skin_moves += b * b;
        together += a * b;
    }
    EXPECT_GT(std::sqrt(interval_moves / 99), 0.1);
    EXPECT_GT(std::sqrt(skin_moves / 99), 0.04);
    EXPECT_LT(std::fabs(together), 0.5 * std::sqrt(interval_moves * skin_moves));
}

TEST(IntervalTuner, NarrowsWhereWiderMarginsAreNoUse) {  // whoever leaves has the widest margin there is
    IntervalTuner tuner;
    for (int k = 0; k < 100; ++k) {
        IntervalTuner::Life list = World{}.list(tuner);
        list.steps = 5;
        tuner.finished(list);
    }
    EXPECT_LT(tuner.interval(), 10);
    EXPECT_LT(tuner.skin(), 0.03);
}

TEST(IntervalTuner, DoesNotDriftOffWhereMotionBoundsTheLife) {
    IntervalTuner tuner;
    for (int k = 0; k < 60; ++k) {
        IntervalTuner::Life list = World{}.list(tuner);
        list.steps = list.limit = std::min(list.limit, 9.0);
        tuner.finished(list);
    }
    EXPECT_GE(tuner.interval(), 7);
    EXPECT_LT(tuner.interval(), 14);
}

TEST(IntervalTuner, WhatWasTooLongMayFitAgain) {
    IntervalTuner tuner;
    const double interval = tuner.interval(), skin = tuner.skin();
    tuner.shorten(2 * interval, 2 * skin);
    EXPECT_GT(tuner.interval(), 0.8 * interval);
    EXPECT_EQ(tuner.skin(), skin);
    tuner.shorten(6, 0.02);
    EXPECT_LE(tuner.interval(), 6.0);
    EXPECT_LT(tuner.skin(), skin);
    for (int k = 0; k < 10; ++k) tuner.finished(World{}.list(tuner));
    EXPECT_LE(tuner.interval(), 6 * std::pow(1.04, 10) + 1e-9);
    for (int k = 0; k < 100; ++k) tuner.finished(World{}.list(tuner));
    EXPECT_GT(tuner.interval(), 20);
}

TEST(IntervalTuner, IgnoresAListWhoseTimesWereTakenAway) {  // a caller may set the profile to zero
    IntervalTuner tuner;
    const double interval = tuner.interval(), skin = tuner.skin();
    tuner.finished({20, 20, 1000, 100, 0.1, -5.0, -3.0});
    tuner.finished({20, 24, 1000, 100, 0.1, -5.0, 0.1});
    tuner.finished({20, 24, 1000, 100, 0.1, 5.0, 0.1, -1.0});
    EXPECT_EQ(tuner.interval(), interval);
    EXPECT_EQ(tuner.skin(), skin);
    EXPECT_EQ(tuner.reason(), "");
}

TEST(IntervalTuner, LeavesAloneWhatIsFixed) {
    IntervalTuner both(33, 0.1), interval(33, 0), skin(0, 0.1);
    EXPECT_FALSE(both.looks());
    for (int k = 0; k < 20; ++k) {
        for (IntervalTuner* t : {&both, &interval, &skin}) t->finished({10, 33, 3000, 1000, 0.4, 10, 0.1, 0, 0.3, 0.03});
        EXPECT_EQ(both.interval(), 33);
        EXPECT_EQ(both.skin(), 0.1);
        EXPECT_EQ(interval.interval(), 33);
        EXPECT_EQ(skin.skin(), 0.1);
    }
    both.shorten(10, 0.05);
    EXPECT_EQ(both.interval(), 33);
    EXPECT_EQ(both.skin(), 0.1);
    EXPECT_GT(interval.skin(), 0.1);
    EXPECT_GT(skin.interval(), 30);
}

TEST(Slopes, AreThoseOfWhatWasTriedWhateverDrifts) {
    Slopes slopes;
    const double corners[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
    for (int k = 0; k < 200; ++k) {
        const double a = 0.2 * corners[k % 4][0], b = 0.2 * corners[k % 4][1];
        slopes.learn(0.3 * a - 0.2 * b + 0.01 * k + 5 * (k / 4), {a, b}, {0.5, 0});
        if (k % 4 == 3) slopes.interrupt();  // what follows stands elsewhere
    }
    EXPECT_NEAR(slopes.correction().a, -0.2, 0.03);
    EXPECT_NEAR(slopes.correction().b, -0.2, 0.03);
}

class ListEnd : public ::testing::TestWithParam<Device> {};

TEST_P(ListEnd, IsTheParticleFarthestForItsMargin) {
    const Device device = GetParam();
    GRAINRAY_NEEDS(device);
    State s(device);
    s.particles.scale = PositionScale::for_radius(1, {});
    const auto unit = static_cast<float>(s.particles.scale.unit);
    const std::int32_t radius = 1000000;
    // The second has moved 600 in x on top of the 5 steps of 100 its surroundings went; the third farther, in a wider margin; the first across the seam.
    s.particles.near.assign(std::vector<Near>{{-2147483000, 0, 0, radius}, {1100, 0, 0, 2 * radius}, {0, 5000, 0, radius}});
    s.built.assign(std::vector<Near>{{2147483000, 0, 0, 10000}, {0, 0, 0, 600}, {0, 0, 0, 50000}});
    s.frame.assign(std::vector<Vec3f>{{}, {100, 0, 0}, {}});
    std::vector<Body> body(3);
    body[1].velocity = {350 * unit, 20 * unit, 0};
    s.particles.body.assign(body);
    s.particles.id.assign(std::vector<std::uint32_t>{0, 1, 2});
    s.age.steps = 5;
    StepConstants constants;
    constants.dt = 1;
    const Leaver leaver = stages(device).list_end(s, constants);
    EXPECT_FLOAT_EQ(leaver.share, 1);
    EXPECT_EQ(leaver.margin, 600);
    EXPECT_EQ(leaver.radius, 2 * radius);
    EXPECT_NEAR(leaver.speed, 250, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Devices, ListEnd, all_devices, device_name);

}  // namespace
}  // namespace grainray::test
