// Which listed pairs touch. A stretch of a block's list is tested and what touches is packed, a field an array.
#pragma once

#include <algorithm>

#include "contacts/pair.hpp"
#include "exec/widest.hpp"

#ifdef GRAINRAY_X86_LEVELS
#include <immintrin.h>
#endif

namespace grainray::cpu::pairs {

/// Touching pairs; what lies past `size` is a valid index, too.
struct alignas(64) Touching {
    static constexpr int stretch = 512;        ///< entries tested at once
    static constexpr int room = stretch + 64;  ///< vectors write and read past the end
    std::uint32_t i[room], j[room];
    std::uint32_t entry[room];                 ///< less `start`
    std::int32_t x[room], y[room], z[room];    ///< x_i - x_j, units
    std::int32_t radius_i[room], radius_j[room];
    std::uint64_t start = 0;
    int size = 0;

    void finish(std::uint64_t first_entry, int found) {
        start = first_entry;
        size = found;
        std::fill_n(&entry[found], 64, 0u);
    }
};

/// Walks the entries of rows [first, last) in stretches.
struct Stretches {
    std::uint64_t start, end;  ///< of the stretch
    std::uint32_t row;         ///< the next entry's
    alignas(64) std::uint32_t rows[Touching::room] = {};

    Stretches(const PairLoop& loop, std::uint32_t first) : start(loop.offsets[first]), end(start), row(first) {}

    /// False after the last. rows[k] is the row of entry start + k.
    [[gnu::always_inline]] bool next(const PairLoop& loop, std::uint64_t all) {
        start = end;
        end = std::min(all, start + Touching::stretch);
        for (std::uint64_t e = start; e < end; ++row) {
            const std::uint64_t until = std::min(end, loop.offsets[row + 1]);
            for (std::uint64_t k = e; k < until; k += 16)
                for (int l = 0; l < 16; ++l) rows[k - start + l] = row;
            e = until;
            if (until < loop.offsets[row + 1]) break;
        }
        return start < end;
    }
};

/// Fills `found` from a stretch; histories of pairs that have ceased to touch become zero.
template <bool periodic>
[[gnu::always_inline]] inline void find_touching(const PairLoop& loop, const Stretches& s, Touching& found) {
    int size = 0;
    for (std::uint64_t e = s.start; e < s.end; ++e) {
        const std::uint32_t i = s.rows[e - s.start], j = loop.partners[e];
        const Near &p = loop.near[i], &q = loop.near[j];
        Separation apart;
        if constexpr (periodic) apart = separation(p, loop.far[i], q, loop.far[j], loop.period);
        else apart = separation(p, q);
        const bool touching = apart.gap > 0;
        found.i[size] = i;
        found.j[size] = j;
        found.entry[size] = static_cast<std::uint32_t>(e - s.start);
        found.x[size] = apart.x;
        found.y[size] = apart.y;
        found.z[size] = apart.z;
        found.radius_i[size] = p.radius;
        found.radius_j[size] = q.radius;
        size += touching;
        if (!touching && loop.touched[e]) loop.history[e] = Vec3f{};
        loop.touched[e] = touching;
    }
    found.finish(s.start, size);
}

#ifdef GRAINRAY_X86_LEVELS
#pragma GCC push_options
#pragma GCC target("arch=x86-64-v4")
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // GCC 12 sees one in its own intrinsics
#pragma GCC diagnostic ignored "-Wpsabi"

/// Near words of 16 particles, a field a register.
struct Near16 {
    __m512i x, y, z, radius;
    Near16(const Near* near, const std::uint32_t* index) {
        __m512i r[4];
        for (int m = 0; m < 4; ++m) {
            const auto at = [&](int l) { return _mm_load_si128(reinterpret_cast<const __m128i*>(&near[index[l]])); };
            r[m] = _mm512_inserti32x4(_mm512_castsi128_si512(at(m)), at(4 + m), 1);
            r[m] = _mm512_inserti32x4(_mm512_inserti32x4(r[m], at(8 + m), 2), at(12 + m), 3);
        }
        const __m512i a = _mm512_unpacklo_epi32(r[0], r[1]), b = _mm512_unpacklo_epi32(r[2], r[3]);
        const __m512i c = _mm512_unpackhi_epi32(r[0], r[1]), d = _mm512_unpackhi_epi32(r[2], r[3]);
        x = _mm512_unpacklo_epi64(a, b);
        y = _mm512_unpackhi_epi64(a, b);
        z = _mm512_unpacklo_epi64(c, d);
        radius = _mm512_unpackhi_epi64(c, d);
    }
};

/// d^2 - R^2 of the even lanes, exact.
inline __m512i excess(__m512i x, __m512i y, __m512i z, __m512i radii) {
    const auto square = [](__m512i v) { return _mm512_mul_epi32(v, v); };
    return _mm512_sub_epi64(_mm512_add_epi64(_mm512_add_epi64(square(x), square(y)), square(z)), square(radii));
}

inline void find_touching_v4(const PairLoop& loop, const Stretches& s, Touching& found) {
    const __m512i iota = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    alignas(64) std::uint32_t index[16];
    int size = 0;
    const int count = static_cast<int>(s.end - s.start);
    for (int k = 0; k < count; k += 16) {
        const __mmask16 valid = static_cast<__mmask16>((1u << std::min(count - k, 16)) - 1);
        const __m512i i = _mm512_load_si512(&s.rows[k]), j = _mm512_maskz_loadu_epi32(valid, &loop.partners[s.start + k]);
        _mm512_store_si512(index, j);
        const Near16 p(loop.near.data, &s.rows[k]), q(loop.near.data, index);
        const __m512i x = _mm512_sub_epi32(p.x, q.x), y = _mm512_sub_epi32(p.y, q.y), z = _mm512_sub_epi32(p.z, q.z);
        const __m512i radii = _mm512_add_epi32(p.radius, q.radius);
        const auto odd = [](__m512i v) { return _mm512_srli_epi64(v, 32); };
        const __m512i even_lanes = excess(x, y, z, radii), odd_lanes = excess(odd(x), odd(y), odd(z), odd(radii));
        const __mmask16 hit = _mm512_movepi32_mask(_mm512_mask_blend_epi32(0xaaaa, odd(even_lanes), odd_lanes)) & valid;
        const auto pack = [&](auto* to, __m512i v) { _mm512_storeu_si512(to + size, _mm512_maskz_compress_epi32(hit, v)); };
        pack(found.i, i);
        pack(found.j, j);
        pack(found.entry, _mm512_add_epi32(iota, _mm512_set1_epi32(k)));
        pack(found.x, x);
        pack(found.y, y);
        pack(found.z, z);
        pack(found.radius_i, p.radius);
        pack(found.radius_j, q.radius);
        size += __builtin_popcount(hit);

        std::uint8_t* touched = &loop.touched[s.start + k];
        std::uint32_t dead = _mm_test_epi8_mask(_mm_maskz_loadu_epi8(valid, touched), _mm_set1_epi8(1)) & ~hit;
        for (; dead; dead &= dead - 1) loop.history[s.start + k + __builtin_ctz(dead)] = Vec3f{};
        _mm_mask_storeu_epi8(touched, valid, _mm_maskz_set1_epi8(hit, 1));
    }
    found.finish(s.start, size);
}
#pragma GCC diagnostic pop
#pragma GCC pop_options
#endif

/// In the way that suits registers of L floats.
template <bool periodic, int L>
[[gnu::always_inline]] inline void find(const PairLoop& loop, const Stretches& s, Touching& found) {
#ifdef GRAINRAY_X86_LEVELS
    if constexpr (L == 16 && !periodic) return find_touching_v4(loop, s, found);
#endif
    find_touching<periodic>(loop, s, found);
}

}  // namespace grainray::cpu::pairs
