// Which points of some runs a sphere finds: those it owns the pair with, or all near it. 16 are tested at once where the processor can.
#pragma once

#include "exec/widest.hpp"
#include "neighbors/pair_test.hpp"

#ifdef GRAINRAY_X86_LEVELS
#include <immintrin.h>
#endif

namespace grainray::cpu::runs {

/// Places of points in the order of a search.
struct Run {
    std::uint32_t first, last;
};

struct Points {
    const neighbors::Sphere* spheres;
    const std::uint32_t* ids;    ///< where owners are asked for
    const std::uint32_t* order;  ///< index of the point at each place
    Vec3f period;                ///< 0 along an axis: none
};

/// Writes the partners of a to `out`, which has room for every point of the runs and 16 more; returns where it stopped.
using Append = std::uint32_t* (*)(const Points&, const Run* begin, const Run* end, const neighbors::Sphere& a, std::uint32_t id, std::uint32_t* out);

template <bool periodic, bool owners>
std::uint32_t* append(const Points& points, const Run* begin, const Run* end, const neighbors::Sphere& a, std::uint32_t id, std::uint32_t* out) {
    for (const Run* run = begin; run != end; ++run)
        for (std::uint32_t p = run->first; p < run->last; ++p) {
            const neighbors::Sphere& b = points.spheres[p];
            *out = points.order[p];  // always written: no branch to guess
            bool near;
            if constexpr (periodic) near = neighbors::pair_test(a, b, points.period);
            else near = neighbors::pair_test(a, b);
            if constexpr (owners) near &= neighbors::owns(a, id, b, points.ids[p]);
            out += near;
        }
    return out;
}

#ifdef GRAINRAY_X86_LEVELS
#pragma GCC push_options
#pragma GCC target("arch=x86-64-v4")
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // GCC 12 sees one in its own intrinsics

/// neighbors::nearest_image, lane by lane.
inline __m512 nearest(__m512 d, float period) {
    const __m512 box = _mm512_set1_ps(period), half = _mm512_set1_ps(0.5f * period);
    const __mmask16 above = _mm512_cmp_ps_mask(d, half, _CMP_GT_OQ), below = _mm512_cmp_ps_mask(d, _mm512_sub_ps(_mm512_setzero_ps(), half), _CMP_LT_OQ);
    return _mm512_mask_add_ps(_mm512_mask_sub_ps(d, above, d, box), below & ~above, d, box);
}

template <bool periodic, bool owners>
std::uint32_t* append_v4(const Points& points, const Run* begin, const Run* end, const neighbors::Sphere& a, std::uint32_t id, std::uint32_t* out) {
    const __m512 ax = _mm512_set1_ps(a.x), ay = _mm512_set1_ps(a.y), az = _mm512_set1_ps(a.z), a_reach = _mm512_set1_ps(a.reach);
    // Four spheres a register become a field a register: lane l has point 4 (l % 4) + l / 4 of the sixteen.
    const __m512i turned = _mm512_setr_epi32(0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15);
    for (const Run* run = begin; run != end; ++run)
        for (std::uint32_t p = run->first; p < run->last; p += 16) {
            const std::uint32_t count = run->last - p < 16 ? run->last - p : 16;
            const auto valid = static_cast<__mmask16>((1u << count) - 1);
            const std::uint64_t fields = count == 16 ? ~std::uint64_t{0} : (std::uint64_t{1} << 4 * count) - 1;
            const float* const from = &points.spheres[p].x;
            const __m512 r0 = _mm512_maskz_loadu_ps(static_cast<__mmask16>(fields), from), r1 = _mm512_maskz_loadu_ps(static_cast<__mmask16>(fields >> 16), from + 16);
            const __m512 r2 = _mm512_maskz_loadu_ps(static_cast<__mmask16>(fields >> 32), from + 32), r3 = _mm512_maskz_loadu_ps(static_cast<__mmask16>(fields >> 48), from + 48);
            const __m512 xy01 = _mm512_unpacklo_ps(r0, r1), xy23 = _mm512_unpacklo_ps(r2, r3), zr01 = _mm512_unpackhi_ps(r0, r1), zr23 = _mm512_unpackhi_ps(r2, r3);
            __m512 dx = _mm512_sub_ps(ax, _mm512_shuffle_ps(xy01, xy23, 0x44)), dy = _mm512_sub_ps(ay, _mm512_shuffle_ps(xy01, xy23, 0xee));
            __m512 dz = _mm512_sub_ps(az, _mm512_shuffle_ps(zr01, zr23, 0x44));
            const __m512 b_reach = _mm512_shuffle_ps(zr01, zr23, 0xee);
            if constexpr (periodic) {
                dx = nearest(dx, points.period.x);
                dy = nearest(dy, points.period.y);
                dz = nearest(dz, points.period.z);
            }
            const __m512 reach = _mm512_add_ps(a_reach, b_reach);
            const __m512 square = _mm512_add_ps(_mm512_add_ps(_mm512_mul_ps(dx, dx), _mm512_mul_ps(dy, dy)), _mm512_mul_ps(dz, dz));
            const __mmask16 here = _mm512_cmplt_epu32_mask(turned, _mm512_set1_epi32(static_cast<int>(count)));
            __mmask16 hit = _mm512_mask_cmp_ps_mask(here, square, _mm512_mul_ps(reach, reach), _CMP_LT_OQ);
            if (!hit) continue;
            if constexpr (owners) {
                const __mmask16 equal = _mm512_mask_cmp_ps_mask(hit, a_reach, b_reach, _CMP_EQ_OQ);
                hit = _mm512_mask_cmp_ps_mask(hit, a_reach, b_reach, _CMP_GT_OQ);
                if (equal) {
                    const __m512i ids = _mm512_permutexvar_epi32(turned, _mm512_maskz_loadu_epi32(valid, &points.ids[p]));
                    hit |= _mm512_mask_cmpgt_epu32_mask(equal, _mm512_set1_epi32(static_cast<int>(id)), ids);
                }
            }
            const __m512i partners = _mm512_permutexvar_epi32(turned, _mm512_maskz_loadu_epi32(valid, &points.order[p]));
            _mm512_storeu_si512(out, _mm512_maskz_compress_epi32(hit, partners));
            out += __builtin_popcount(hit);
        }
    return out;
}
#pragma GCC diagnostic pop
#pragma GCC pop_options
#endif

template <bool periodic, bool owners>
Append best() {
#ifdef GRAINRAY_X86_LEVELS
    if (__builtin_cpu_supports("x86-64-v4")) return append_v4<periodic, owners>;
#endif
    return append<periodic, owners>;
}

}  // namespace grainray::cpu::runs
