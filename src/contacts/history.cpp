// Stage: tangential histories from one list into the next, whatever order the particles and rows are in, and the pairs
// that touch. A pair that does not touch has no history: the next evaluation would clear it.
#include "contacts/old_rows.hpp"
#include "exec/rows.hpp"
#include "stages.hpp"

namespace grainray::GRAINRAY_EXEC {
namespace {

struct Touches {
    View<const Near> near;
    View<const Far> far;
    Vec3l period;

    explicit Touches(const State& s) : near(s.particles.near.view()), far(s.particles.far.view()), period(s.period) {}
    GR_HD bool operator()(std::size_t i, std::size_t j) const {
        const bool periodic = period.x > 0 || period.y > 0 || period.z > 0;
        const Separation s = periodic ? separation(near[i], far[i], near[j], far[j], period) : separation(near[i], near[j]);
        return s.gap > 0;
    }
};

/// Which pairs of the new list touch, and with what history.
struct Carry {
    Touches touches;
    OldRows old;
    OldIndex was;

    /// It stands in one row or in both; on CUDA in that of the first particle.
    static constexpr bool kept_by_first = device == Device::cuda;
    GR_HD Vec3f history(std::size_t i, std::uint32_t j) const {
        const bool turned = kept_by_first && was[j] < was[i];
        const std::uint32_t a = turned ? was[j] : was[i], b = turned ? was[i] : was[j];
        Vec3f h{};
        if (old.look_up(a, b, h)) return turned ? -h : h;
        if (old.look_up(b, a, h)) return turned ? h : -h;
        return h;
    }
};

struct AddFigures {
    GR_HD ListFigures operator()(const ListFigures& a, const ListFigures& b) const {
        return {a.mean_neighbors + b.mean_neighbors, a.mean_margin_ratio + b.mean_margin_ratio};
    }
};

}  // namespace

void retire(State& s, ContactList& old_list) { keep_live(s.grains, old_list); }

void list_pairs(State& s, NeighborList& found, const ContactList& old_list, const Array<std::uint32_t>& old_index) {
    lay_out(found, Carry{Touches(s), OldRows(old_list), OldIndex(old_index)}, s.grains);
}

void touching(const State& s, ContactList& out) {
    const std::size_t n = s.size();
    const Rows rows(s.grains);
    const Touches touches(s);
    out.offsets.resize_discard(n + 1);
    out.offsets.clear_bytes();
    const auto offsets = out.offsets.view();
    for_each(n, [=] GR_HD(std::size_t i) {
        std::uint64_t count = 0;
        for (std::uint32_t k = 0, end = rows.size(i); k < end; ++k) count += touches(i, rows.partner(i, k));
        offsets[i] = count;
    });
    out.partners.resize_discard(starts_of_rows(offsets));
    out.history.resize_discard(out.partners.size());
    const auto partners = out.partners.view();
    const auto history = out.history.view();
    for_each(n, [=] GR_HD(std::size_t i) {
        std::uint64_t slot = offsets[i];
        for (std::uint32_t k = 0, end = rows.size(i); k < end; ++k) {
            const std::uint32_t j = rows.partner(i, k);
            if (!touches(i, j)) continue;
            partners[slot] = j;
            history[slot++] = rows.history(i, k);
        }
    });
}

ListFigures list_figures(const State& s) {
    const Rows rows(s.grains);
    const auto built = s.built.view(), near = s.particles.near.view();
    const std::uint32_t block = s.block;
    const double n = static_cast<double>(s.size());
    const ListFigures sum = reduce(s.size(), ListFigures{}, [=] GR_HD(std::size_t i) {
        double sides = 0;
        for (std::uint32_t k = 0, end = rows.size(i); k < end; ++k) sides += i / block == rows.partner(i, k) / block ? 2 : 1;
        return ListFigures{sides, static_cast<double>(built[i].radius) / near[i].radius};
    }, AddFigures{});
    return {sum.mean_neighbors / n, sum.mean_margin_ratio / n};
}

}  // namespace grainray::GRAINRAY_EXEC
