// The parts of the search by rays that need no tracer: rows from slots, the policies.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "neighbors/rays/boxes.hpp"
#include "neighbors/rays/common.hpp"
#include "neighbors/rays/refit.hpp"
#include "neighbors/rays/rows.hpp"

namespace grainray::neighbors::rays {
namespace {

/// Four points on a line, each near the next; slots as rays would fill them, with repeated entries.
struct Filled {
    std::vector<Sphere> points{{0, 0, 0, 0.6f}, {1, 0, 0, 0.6f}, {2, 0, 0, 0.6f}, {3, 0, 0, 0.6f}};
    std::vector<std::uint32_t> ids{0, 1, 2, 3}, order{0, 1, 2, 3}, doubtful{0}, left, right, entries;
    std::vector<std::uint64_t> starts;
    std::uint32_t width = 3;

    NeighborList rows(Reported reported, ListKind kind, std::uint32_t block = 1) {
        const View<const Sphere> spheres{points.data(), points.size()};
        const Slots slots{{entries.data(), entries.size()}, {left.data(), left.size()}, {right.data(), right.size()}, {starts.data(), starts.size()}, width};
        NeighborList list;
        RowsMemory memory(Device::cpu);
        cpu::make_rows({slots, {order.data(), order.size()}, spheres, {ids.data(), ids.size()}, {doubtful.data(), 1}, spheres, spheres, {}}, reported,
                       {kind, block, true, false, {}, {}}, memory, list);
        return list;
    }
};

std::vector<std::uint32_t> entries(const NeighborList& list) { return list.neighbors.to_host(); }
std::vector<std::uint64_t> offsets(const NeighborList& list) { return list.offsets.to_host(); }

TEST(Rows, PairsFoundOnceStandWhereTheKindSays) {
    Filled f;  // ray 1 found 0, ray 2 found 1 and 3 (3 twice), interleaved
    f.left = {0, 1, 3, 0};
    f.entries = {9, 0, 1, 9, 9, 9, 3, 9, 9, 9, 3, 9};
    EXPECT_EQ(entries(f.rows(Reported::once, ListKind::full)), (std::vector<std::uint32_t>{1, 0, 2, 1, 3, 2}));
    f.left = {0, 1, 3, 0};
    EXPECT_EQ(offsets(f.rows(Reported::once, ListKind::half)), (std::vector<std::uint64_t>{0, 0, 1, 2, 3}));
    f.left = {0, 1, 3, 0};
    const NeighborList blocked = f.rows(Reported::once, ListKind::blocked, 2);
    EXPECT_EQ(entries(blocked), (std::vector<std::uint32_t>{0, 2, 1, 2}));
    EXPECT_EQ(offsets(blocked), (std::vector<std::uint64_t>{0, 0, 2, 3, 4}));
}

TEST(Rows, TwoSidedRowsFoundTwice) {
    Filled f;  // later points from the left, earlier ones from the right; ray 1 met 2 twice
    f.left = {1, 2, 1, 0};
    f.right = {0, 1, 1, 1};
    f.entries = {1, 9, 9, 2, 2, 0, 3, 9, 1, 9, 9, 2};
    EXPECT_EQ(entries(f.rows(Reported::twice, ListKind::full)), (std::vector<std::uint32_t>{1, 0, 2, 1, 3, 2}));
    f.left = {1, 2, 1, 0};
    f.right = {0, 1, 1, 1};
    EXPECT_EQ(entries(f.rows(Reported::twice, ListKind::half)), (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(Rows, LongRowsFromCounts) {
    Filled f;
    f.points.assign(200, {0, 0, 0, 1});
    f.ids.resize(200);
    f.order.resize(200);
    for (std::uint32_t i = 0; i < 200; ++i) f.ids[i] = f.order[i] = i;
    f.left.assign(200, 0);
    f.left[199] = 300;
    f.starts.assign(201, 0);
    f.starts[200] = 300;
    for (std::uint32_t c = 0; c < 300; ++c) f.entries.push_back((c * 7) % 150);
    EXPECT_EQ(offsets(f.rows(Reported::once, ListKind::half)).back(), 150u);
}

TEST(Rows, DoubtfulEntriesAreTestedAgain) {
    Filled f;
    f.left = {0, 1, 2, 0};
    f.entries = {9, 0, 1, 9, 9, 9, 0, 9, 9, 9, 9, 9};  // 2 and 0 are not near
    f.doubtful = {1};
    EXPECT_EQ(entries(f.rows(Reported::once, ListKind::half)), (std::vector<std::uint32_t>{0, 1}));
}

TEST(Refit, CycleIsThatOfTheFormula) {
    RefitPolicy p;
    EXPECT_GT(p.cycle(), 0);
    p.rebuilt(2.0, 3.0);
    p.refitted(0.7, 3.1);
    EXPECT_EQ(p.cycle(), static_cast<int>(std::sqrt(1 + 2 * (2.0 - 0.7) / 0.1) - 1));
    EXPECT_FALSE(p.rebuild());
    for (int k = 0; k < 10; ++k) p.refitted(0.7, 3.1 + 0.1 * k);
    EXPECT_TRUE(p.rebuild());
}

TEST(Refit, NeverWhereItCostsAsMuchAndLongWhereSearchesStayFast) {
    RefitPolicy dear, fine;
    dear.rebuilt(1.0, 3.0);
    dear.refitted(1.1, 3.2);
    EXPECT_TRUE(dear.rebuild());
    fine.rebuilt(2.0, 3.0);
    fine.refitted(0.7, 2.9);
    EXPECT_GT(fine.cycle(), 50);
}

TEST(Limits, AllOfEqualsAreSmallAndBouldersAreNot) {
    EXPECT_EQ(limits(std::vector<float>(100, 0.5f), 0.5f).small, 0.5f);
    std::vector<float> mixed(1000, 0.1f);
    mixed[500] = 50;
    EXPECT_FLOAT_EQ(limits(mixed, 50).small, 0.1f);
    EXPECT_EQ(limits({0, 0, 0}, 0).small, 0.0f);
    EXPECT_EQ(limits({1}, 2).small, 2.0f);
}

TEST(Limits, OfWideMixturesLieBetween) {
    std::vector<float> reaches;
    for (int i = 0; i < 1000; ++i) reaches.push_back(std::exp(2.0f * static_cast<float>(i) / 1000));
    const Limits l = limits(reaches, reaches.back());
    EXPECT_GT(l.small, 1.5f);
    EXPECT_LT(l.small, 6.0f);
    EXPECT_GE(l.common, l.small);
}

bool holds(const Bounds& b, const Vec3f& c) {
    return b.lower.x <= c.x && c.x <= b.upper.x && b.lower.y <= c.y && c.y <= b.upper.y && b.lower.z <= c.z && c.z <= b.upper.z;
}

/// What rays in the two worlds of boxes.hpp find, box by box, against the predicate: each pair once, whatever the classes.
TEST(Classes, EachPairHasOneFinder) {
    std::mt19937_64 e(5);
    std::uniform_real_distribution<float> u(0, 1);
    std::vector<Sphere> points;
    for (int i = 0; i < 600; ++i) points.push_back({10 * u(e), 10 * u(e), 10 * u(e), 0.1f * std::exp(2 * u(e))});
    for (int i = 0; i < 40; ++i) points.push_back(points[static_cast<std::size_t>(i * 3)]);           // duplicates
    for (int i = 0; i < 40; ++i) points.push_back({0.5f * static_cast<float>(i % 8), 3, 0.5f * static_cast<float>(i / 8), 0.25f});  // at the reach, faces shared
    const Frame frame = frame_of({{{0, 0, 0}, {10, 10, 10}}}, 2, {});
    const float largest = 0.74f;
    for (const auto& [small, common] : {std::pair{largest, largest}, {0.25f, 0.25f}, {0.25f, 0.5f}, {0.2f, largest}, {0.4f, 0.1f}}) {
        const Classes classes{small, common, 1.25f * frame.scale * (10 + 4 * 2 * largest)};
        for (std::uint32_t i = 0; i < points.size(); ++i)
            for (std::uint32_t j = 0; j < i; ++j) {
                int found = 0;
                for (const auto& [a, b] : {std::pair{i, j}, {j, i}}) {
                    const Sphere &ray = points[a], &box = points[b];
                    Vec3f start = frame.point({ray.x, ray.y, ray.z});
                    if (ray.reach > small) start.x += classes.beside;
                    const bool met = holds(box_for_small(box, classes, frame), start) || (box.reach > small && holds(box_for_larger(box, classes, frame), start));
                    found += met && finds(box, b, ray, a, ray.x - box.x, classes) && pair_test(ray, box);
                }
                ASSERT_EQ(found, pair_test(points[i], points[j])) << i << " " << j << " small " << small << " common " << common;
            }
    }
}

}  // namespace
}  // namespace grainray::neighbors::rays
