// Forces and torques of many contacts, a field an array, added to the sums of particles: 8 lanes, a whole sum, at once.
#pragma once

#include "contacts/wrench.hpp"
#include "exec/lanes.hpp"

namespace grainray::cpu {

using lanes::Vector;

/// Quads of low and high in turn: [low 0, high 0, low 1, high 1 ...].
template <int L, int half, class V, std::size_t... k>
[[gnu::always_inline]] inline void interleave(const V& low, const V& high, V& to, std::index_sequence<k...>) {
    to = __builtin_shufflevector(low, high, (k / 8 * 4 + k % 4 + (k & 4) / 4 * L + half * L / 2)...);
}

/// quantize() and the sums of whole particles, 8 lanes at once.
struct Sums {
    Vector<double, 8> magic;  ///< quantum_magic quanta: adding it rounds to whole quanta
    float most_force, most_torque;

    Sums(double inverse_force, double inverse_torque)
        : most_force(static_cast<float>(quantum_bound / inverse_force)), most_torque(static_cast<float>(quantum_bound / inverse_torque)) {
        const double f = quantum_magic / inverse_force, t = quantum_magic / inverse_torque;
        magic = Vector<double, 8>{f, f, f, t, t, t, t, t};
    }
    [[gnu::always_inline]] void add(Wrench& w, const float* row) const {
        using Long = Vector<std::int64_t, 8>;
        const Vector<double, 8> shifted = Vector<double, 8>{row[0], row[1], row[2], row[3], row[4], row[5], row[6], row[7]} + magic;
        Long sums;
        lanes::load<8>(sums, w.force);
        sums += (Long)shifted - (Long)magic;
        lanes::store<8>(sums, w.force);
    }
};

/// Within +-bound; NaN becomes the bound, as in quantize().
template <class V>
[[gnu::always_inline]] inline void hold(V& v, float bound) {
    const V most = V{} + bound;
    v = v < most ? v : most;
    v = v > -most ? v : -most;
}

/// Forces and torques of L pairs as rows of 8; that of pair l is at(l).
template <int L>
struct Rows {
    alignas(64) float row[L][8];
    [[gnu::always_inline]] const float* at(unsigned l) const { return row[(l & 3) * (L / 4) + l / 4]; }
    template <bool other, int width>
    [[gnu::always_inline]] void turn(const Sums& sums, const float (&force)[3][width], const float (&torque)[3][width], int l) {
        Vector<float, L> low[4], high[4];
        for (int a = 0; a < 3; ++a) {
            lanes::load<L>(low[a], &force[a][l]);
            if (other) low[a] = -low[a];
            hold(low[a], sums.most_force);
        }
        lanes::load<L>(low[3], &torque[0][l]);
        lanes::load<L>(high[0], &torque[1][l]);
        lanes::load<L>(high[1], &torque[2][l]);
        hold(low[3], sums.most_torque);
        hold(high[0], sums.most_torque);
        hold(high[1], sums.most_torque);
        high[2] = high[3] = Vector<float, L>{};
        lanes::transpose(low);
        lanes::transpose(high);
        for (int m = 0; m < 4; ++m) {
            float* to = row[m * (L / 4)];
            if constexpr (L == 4) {
                lanes::store<L>(low[m], to);
                lanes::store<L>(high[m], to + 4);
            } else {
                Vector<float, L> first, second;
                interleave<L, 0>(low[m], high[m], first, std::make_index_sequence<L>());
                interleave<L, 1>(low[m], high[m], second, std::make_index_sequence<L>());
                lanes::store<L>(first, to);
                lanes::store<L>(second, to + L);
            }
        }
    }
};

}  // namespace grainray::cpu
