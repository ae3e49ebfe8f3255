// The CPU's pair loop in parts: each width of register must do what the plain code beside it says, to the bit.
#include "exec/pairs_cpu.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace grainray::cpu::test {
namespace {

template <int L>
void turn_and_back() {
    std::uint32_t in[L][4], out[L][4], fields[4][L];
    for (std::uint32_t l = 0; l < L; ++l)
        for (std::uint32_t f = 0; f < 4; ++f) in[l][f] = 100 * l + f;
    Vector<std::uint32_t, L> v[4];
    lanes::gather<L, std::uint32_t>(v, [&](int l) { return in[l]; });
    for (int f = 0; f < 4; ++f) lanes::store<L>(v[f], fields[f]);
    for (std::uint32_t l = 0; l < L; ++l)
        for (std::uint32_t f = 0; f < 4; ++f) ASSERT_EQ(fields[f][l], 100 * l + f);
    lanes::scatter<L, std::uint32_t>(v, [&](int l) { return out[l]; });
    for (int l = 0; l < L; ++l)
        for (int f = 0; f < 4; ++f) ASSERT_EQ(out[l][f], in[l][f]);
}
TEST(Lanes, StructsTurnIntoLanesAndBack) {
    turn_and_back<4>();
    turn_and_back<8>();
    turn_and_back<16>();
}

TEST(NearestFloat, RoundsOnceAsTheConversionDoes) {
    std::mt19937_64 e(7);
    for (int k = 0; k < 1000000; ++k) {
        const int bits = static_cast<int>(e() % 59);
        std::int64_t v = static_cast<std::int64_t>(e() >> 6) >> (58 - bits);
        if (bits > 26 && k % 2) v = static_cast<std::int64_t>(2 * (e() >> 41) + 1) << (bits - 26) >> 1;  // halfway between two floats,
        if (k % 3 == 0) v += static_cast<std::int64_t>(e() % 3) - 1;                                      // and one beside it
        if (v < 0 || v >> 58) continue;
        ASSERT_EQ(pairs::nearest_float(v), static_cast<float>(v)) << v;
    }
}

template <int L>
void sums_are_quantized() {
    const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    const double inverse_force = 0x1p20, inverse_torque = 0x1p23;
    std::mt19937 e(3);
    std::uniform_real_distribution<float> u(-1e3f, 1e3f);
    float force[3][64], torque[3][64];
    for (int a = 0; a < 3; ++a)
        for (int l = 0; l < 64; ++l) {
            force[a][l] = l == 5 ? nan : l == 6 ? inf : l == 7 ? -1e20f : l == 8 ? 0x1.8p-21f : l == 9 ? -0x1p-21f : u(e);
            torque[a][l] = l == 5 ? -inf : l == 6 ? nan : l == 7 ? 0x1p-24f : u(e);
        }
    const Sums sums(inverse_force, inverse_torque);
    for (int l = 0; l < 64; l += L) {
        Rows<L> on_i, on_j;
        on_i.template turn<false>(sums, force, torque, l);
        on_j.template turn<true>(sums, force, torque, l);
        for (int k = 0; k < L; ++k) {
            Wrench i{{1, 2, 3}, {4, 5, 6}, {}}, j{};
            sums.add(i, on_i.at(static_cast<unsigned>(k)));
            sums.add(j, on_j.at(static_cast<unsigned>(k)));
            for (int a = 0; a < 3; ++a) {
                EXPECT_EQ(i.force[a], a + 1 + quantize(force[a][l + k], inverse_force)) << l + k;
                EXPECT_EQ(j.force[a], quantize(-force[a][l + k], inverse_force)) << l + k;
                EXPECT_EQ(i.torque[a], a + 4 + quantize(torque[a][l + k], inverse_torque)) << l + k;
                EXPECT_EQ(j.torque[a], quantize(torque[a][l + k], inverse_torque)) << l + k;
            }
        }
    }
}
TEST(Sums, QuantizeAsTheScalarCodeDoes) {
    sums_are_quantized<4>();
    sums_are_quantized<8>();
    sums_are_quantized<16>();
}

/// A list of rows of all lengths, a boulder's among them, over spheres some of which touch.
struct SomeList {
    std::vector<Near> near;
    std::vector<Far> far;
    std::vector<std::uint64_t> offsets{0};
    std::vector<std::uint32_t> partners;
    std::vector<Vec3f> history;
    std::vector<std::uint8_t> touched;
    PairLoop loop{};

    SomeList() {
        std::mt19937 e(11);
        std::uniform_int_distribution<std::int32_t> x(0, 300'000'000), r(30'000'000, 134'000'000);
        for (std::uint32_t i = 0; i < 700; ++i) {
            near.push_back({x(e), x(e), x(e), r(e)});
            const std::size_t length = i == 300 ? 1500 : i % 50 < 20 ? 0 : e() % 12;
            for (std::size_t k = 0; k < length; ++k) partners.push_back(e() % 700);
            offsets.push_back(partners.size());
        }
        far.resize(near.size());
        history.assign(partners.size(), Vec3f{1, 2, 3});
        for (std::size_t k = 0; k < partners.size(); ++k) touched.push_back(e() % 2);
        loop.near = {near.data(), near.size()};
        loop.far = {far.data(), far.size()};
        loop.offsets = {offsets.data(), offsets.size()};
        loop.partners = {partners.data(), partners.size()};
        loop.history = {history.data(), history.size()};
        loop.touched = {touched.data(), touched.size()};
    }
};

using Found = std::vector<std::array<std::int64_t, 8>>;  // entry, i, j, x, y, z, both radii

template <bool periodic, int L>
Found found_in_rows(SomeList& list, std::uint32_t first, std::uint32_t last) {
    Found all;
    pairs::Touching t{};
    pairs::Stretches s(list.loop, first);
    while (s.next(list.loop, list.offsets[last])) {
        with_widest_registers([&]<int machine>() __attribute__((always_inline)) {
            if constexpr (L <= machine) pairs::find<periodic, L>(list.loop, s, t);
            else pairs::find<periodic, machine>(list.loop, s, t);
        });
        for (int k = 0; k < t.size; ++k)
            all.push_back({static_cast<std::int64_t>(t.start + t.entry[k]), t.i[k], t.j[k], t.x[k], t.y[k], t.z[k], t.radius_i[k], t.radius_j[k]});
    }
    return all;
}

template <bool periodic, int L>
void finds_what_touches() {
    SomeList list;
    if (periodic) list.loop.period = {1 << 29, 0, 1 << 29};
    Found expected;
    std::vector<std::uint8_t> touches(list.partners.size());
    const std::uint32_t first = 21, last = 690;  // a block need not begin where a vector does
    for (std::uint32_t i = first; i < last; ++i)
        for (std::uint64_t e = list.offsets[i]; e < list.offsets[i + 1]; ++e) {
            const std::uint32_t j = list.partners[e];
            const Near &p = list.near[i], &q = list.near[j];
            const Separation s = periodic ? separation(p, list.far[i], q, list.far[j], list.loop.period) : separation(p, q);
            if ((touches[e] = s.gap > 0)) expected.push_back({static_cast<std::int64_t>(e), i, j, s.x, s.y, s.z, p.radius, q.radius});
        }
    const auto was = list.touched;
    EXPECT_EQ((found_in_rows<periodic, L>(list, first, last)), expected);
    ASSERT_GT(expected.size(), 500u);
    for (std::uint64_t e = 0; e < list.partners.size(); ++e) {
        const bool inside = e >= list.offsets[first] && e < list.offsets[last];
        EXPECT_EQ(list.touched[e], inside ? touches[e] : was[e]) << e;
        EXPECT_EQ(list.history[e] == Vec3f{}, inside && was[e] && !touches[e]) << e;
    }
}
TEST(Touching, IsFoundOnceInOrderAndForgottenWhenOver) {
    finds_what_touches<false, 4>();
    finds_what_touches<false, 16>();
    finds_what_touches<true, 16>();
}

}  // namespace
}  // namespace grainray::cpu::test
