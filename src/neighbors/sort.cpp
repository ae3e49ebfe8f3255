// Stage: storage order. Neighbours in space become neighbours in memory, again when they have moved too far to be so still.
#include "exec/permute.hpp"
#include "neighbors/morton.hpp"
#include "stages.hpp"

namespace grainray::GRAINRAY_EXEC {
namespace {

struct Bounds {
    Vec3l lo, hi;
};
struct JoinBounds {
    GR_HD Bounds operator()(Bounds a, const Bounds& b) const {
        for (int k = 0; k < 3; ++k) {
            a.lo[k] = a.lo[k] < b.lo[k] ? a.lo[k] : b.lo[k];
            a.hi[k] = a.hi[k] > b.hi[k] ? a.hi[k] : b.hi[k];
        }
        return a;
    }
};

/// On CUDA particles with equally many contacts stand together within wide cells, 8 to 16 largest radii, so that the lanes
/// of a warp have equally much to do. On the CPU cells are 2 to 4 radii: fine enough for locality, few digits to sort.
constexpr bool by_contacts = device == Device::cuda;
constexpr int cell_shift = fine_bits + (by_contacts ? 30 : 28), contact_bits = by_contacts ? 4 : 0;

/// Radii that particles may have moved against each other, on average, since they were put in order. An order a little older serves
/// about as well, and on CUDA it is a seventh of the work of making a list.
constexpr double tolerated = by_contacts ? 1 : 0;

Bounds bounds_in_cells(View<const Near> near, View<const Far> far) {
    constexpr std::int64_t big = std::int64_t{1} << 62;
    return reduce(near.size, Bounds{{big, big, big}, {-big, -big, -big}}, [=] GR_HD(std::size_t i) {
        const Vec3l p = join(near[i], far[i]);
        const Vec3l c{p.x >> cell_shift, p.y >> cell_shift, p.z >> cell_shift};
        return Bounds{c, c};
    }, JoinBounds{});
}

void wrap_periodic(State& s) {
    const Vec3l lower = s.period_lower;
    const Vec3l period{s.period.x << fine_bits, s.period.y << fine_bits, s.period.z << fine_bits};
    if (period == Vec3l{}) return;
    const auto near = s.particles.near.view();
    const auto far = s.particles.far.view();
    for_each(s.size(), [=] GR_HD(std::size_t i) {
        Vec3l p = join(near[i], far[i]);
        for (int a = 0; a < 3; ++a) {
            if (period[a] <= 0) continue;
            std::int64_t r = (p[a] - lower[a]) % period[a];
            if (r < 0) r += period[a];
            p[a] = lower[a] + r;
        }
        near[i] = {near_of(p.x), near_of(p.y), near_of(p.z), near[i].radius};
        far[i] = far_of(p);
    });
}

}  // namespace

void sort(State& s, const ContactList& old_list, const Array<std::uint32_t>& rows, Array<std::uint32_t>& old_index) {
    wrap_periodic(s);
    Particles& p = s.particles;
    const std::size_t n = p.size();
    s.disorder += s.age.widening;
    if (s.disorder < tolerated && rows.size() == 0) return old_index.resize_discard(0);
    s.disorder = 0;
    old_index.resize_discard(n);
    const auto order = old_index.view();

    const auto near = p.near.view();
    const auto far = p.far.view();
    const Bounds bounds = bounds_in_cells(near, far);
    int bits = 1;
    const double cell = std::ldexp(p.scale.fine(), cell_shift);
    for (int a = 0; a < 3; ++a) {
        s.lower[a] = static_cast<float>((bounds.lo[a] - 1) * cell);
        s.upper[a] = static_cast<float>((bounds.hi[a] + 2) * cell);
        while (bits < (64 - contact_bits) / 3 && n && (bounds.hi[a] - bounds.lo[a]) >> bits) ++bits;
    }

    Array<std::uint64_t> keys(device, n), keys2(device);
    Array<std::uint32_t> order2(device);
    const auto key = keys.view();
    const Vec3l lo = bounds.lo;
    const auto contacts = old_list.offsets.view();
    const auto counts = old_list.counts.view();
    const auto row_of = rows.view();
    for_each(n, [=] GR_HD(std::size_t i) {
        const Vec3l q = join(near[i], far[i]);
        const std::uint64_t code = neighbors::morton((q.x >> cell_shift) - lo.x, (q.y >> cell_shift) - lo.y, (q.z >> cell_shift) - lo.z);
        constexpr std::uint64_t most = (1 << contact_bits) - 1;
        const std::size_t row = row_of.size ? row_of[i] : i;
        const std::uint64_t count = counts.size ? counts[row] : contacts[row + 1] - contacts[row];
        key[i] = code << contact_bits | (count < most ? count : most);
        order[i] = static_cast<std::uint32_t>(i);
    });
    sort_by_key(keys, old_index, keys2, order2, 3 * bits + contact_bits);
    permute(p.near, old_index);
    permute(p.far, old_index);
    permute(p.body, old_index);
    permute(p.remainder, old_index);
    permute(p.id, old_index);
    if (rows.size() == 0) return;
    const auto was = old_index.view();
    for_each(n, [=] GR_HD(std::size_t i) { was[i] = row_of[was[i]]; });
}

}  // namespace grainray::GRAINRAY_EXEC
