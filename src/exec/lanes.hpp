// Vectors of L lanes, and the turn between structs and lanes: four fields of L structs become four vectors. Vector
// extensions, so that one source serves every width of register; results go out by reference, as the width of what a
// function returns would be part of its ABI.
#pragma once

#include <cstdint>
#include <type_traits>
#include <utility>

namespace grainray::cpu::lanes {

template <class T, int L>
struct Make {
    using type [[gnu::vector_size(sizeof(T) * L)]] = T;
    struct [[gnu::packed, gnu::may_alias]] Anywhere { type lanes; };  ///< in memory, aligned as may be
};
template <class T, int L>
using Vector = typename Make<T, L>::type;

template <int L, class T>
[[gnu::always_inline]] inline void load(Vector<T, L>& v, const T* from) { v = reinterpret_cast<const typename Make<T, L>::Anywhere*>(from)->lanes; }
template <int L, class T>
[[gnu::always_inline]] inline void store(const Vector<T, L>& v, T* to) { reinterpret_cast<typename Make<T, L>::Anywhere*>(to)->lanes = v; }

/// a's lanes, then b's.
template <class V, class W, std::size_t... k>
[[gnu::always_inline]] inline void join(const V& a, const V& b, W& ab, std::index_sequence<k...>) { ab = __builtin_shufflevector(a, b, k...); }
template <class T>
[[gnu::always_inline]] inline void join(const Vector<T, 4> (&q)[1], Vector<T, 4>& v) { v = q[0]; }
template <class T>
[[gnu::always_inline]] inline void join(const Vector<T, 4> (&q)[2], Vector<T, 8>& v) { join(q[0], q[1], v, std::make_index_sequence<8>()); }
template <class T>
[[gnu::always_inline]] inline void join(const Vector<T, 4> (&q)[4], Vector<T, 16>& v) {
    Vector<T, 8> low, high;
    join(q[0], q[1], low, std::make_index_sequence<8>());
    join(q[2], q[3], high, std::make_index_sequence<8>());
    join(low, high, v, std::make_index_sequence<16>());
}

template <int offset, class V, std::size_t... k>
[[gnu::always_inline]] inline void unpack(const V& a, const V& b, V& to, std::index_sequence<k...>) {
    to = __builtin_shufflevector(a, b, ((k & ~3) + (k & 3) / 2 + (k & 1) * sizeof...(k) + offset)...);
}
template <int offset, class V, std::size_t... k>
[[gnu::always_inline]] inline void halves(const V& a, const V& b, V& to, std::index_sequence<k...>) {
    to = __builtin_shufflevector(a, b, ((k & ~3) + (k & 1) + (k & 2) / 2 * sizeof...(k) + offset)...);
}
/// In each quad of lanes, the 4 x 4 matrix of the rows r is transposed.
template <class V>
[[gnu::always_inline]] inline void transpose(V (&r)[4]) {
    constexpr auto all = std::make_index_sequence<sizeof(V) / 4>();
    V a, b, c, d;
    unpack<0>(r[0], r[1], a, all);
    unpack<0>(r[2], r[3], b, all);
    unpack<2>(r[0], r[1], c, all);
    unpack<2>(r[2], r[3], d, all);
    halves<0>(a, b, r[0], all);
    halves<2>(a, b, r[1], all);
    halves<0>(c, d, r[2], all);
    halves<2>(c, d, r[3], all);
}

/// Field f of the four at where(l) becomes lane l of field[f].
template <int L, class T, class Where>
[[gnu::always_inline]] inline void gather(Vector<T, L> (&field)[4], const Where& where) {
    for (int m = 0; m < 4; ++m) {
        Vector<T, 4> quad[L / 4];
        for (int q = 0; q < L / 4; ++q) load<4>(quad[q], where(4 * q + m));
        join<T>(quad, field[m]);
    }
    transpose(field);
}

template <int quad, class V, class Q, std::size_t... k>
[[gnu::always_inline]] inline void part(const V& v, Q& to, std::index_sequence<k...>) { to = __builtin_shufflevector(v, v, (4 * quad + k)...); }
/// The way back: lane l of field[f] becomes field f of the four at where(l).
template <int L, class T, class Where, std::size_t... q>
[[gnu::always_inline]] inline void scatter(Vector<T, L> (&field)[4], const Where& where, std::index_sequence<q...>) {
    transpose(field);
    for (int m = 0; m < 4; ++m) {
        Vector<T, 4> quad[L / 4];
        (part<q>(field[m], quad[q], std::make_index_sequence<4>()), ...);
        (store<4>(quad[q], where(static_cast<int>(4 * q) + m)), ...);
    }
}
template <int L, class T, class Where>
[[gnu::always_inline]] inline void scatter(Vector<T, L> (&field)[4], const Where& where) {
    scatter<L, T>(field, where, std::make_index_sequence<L / 4>());
}

}  // namespace grainray::cpu::lanes
