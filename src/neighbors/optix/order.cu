#include "neighbors/optix/order.hpp"

#include "exec/exec.hpp"
#include "neighbors/morton.hpp"

namespace grainray::cuda {
namespace {

struct Largest {
    GR_HD std::uint32_t operator()(std::uint32_t a, std::uint32_t b) const { return a > b ? a : b; }
};

/// Cells of the curve along each axis: about 8 a point, so that neighbours on it are neighbours in space.
int bits_of_axis(std::size_t n) {
    int bits = 4;
    while (bits < 21 && (std::size_t{1} << (3 * (bits - 1))) < n) ++bits;
    return bits;
}

void number(const neighbors::Packed& p, int bits, View<std::uint64_t> keys, View<std::uint32_t> order) {
    const Vec3f lower = p.lower;
    float extent = 1e-30f;
    for (int a = 0; a < 3; ++a) extent = fmaxf(extent, 0.5f * p.upper[a] - 0.5f * p.lower[a]);
    const float cells = static_cast<float>((1 << bits) - 1), scale = 0.5f * cells / extent;
    const auto spheres = p.spheres;
    for_each(p.size(), [=] GR_HD(std::size_t i) {
        const neighbors::Sphere s = spheres[i];
        const auto cell = [=](float v, float lo) { return static_cast<std::uint64_t>(fminf(fmaxf((v - lo) * scale, 0.0f), cells)); };
        keys[i] = neighbors::morton(cell(s.x, lower.x), cell(s.y, lower.y), cell(s.z, lower.z));
        order[i] = static_cast<std::uint32_t>(i);
    });
}

void sort_along_curve(const neighbors::Packed& p, Array<std::uint64_t>& keys, Array<std::uint64_t>& keys2, Array<std::uint32_t>& order,
                      Array<std::uint32_t>& order2) {
    const int bits = bits_of_axis(p.size());
    keys.resize_discard(p.size());
    order.resize_discard(p.size());
    number(p, bits, keys.view(), order.view());
    sort_by_key(keys, order, keys2, order2, 3 * bits);
}

void gather_ids(View<const std::uint32_t> ids, View<const std::uint32_t> order, View<std::uint32_t> sorted) {
    for_each(order.size, [=] GR_HD(std::size_t p) { sorted[p] = ids[order[p]]; });
}

/// order[p] becomes where point ids[p] is stored now; wrong is set where it is not stored.
void follow_ids(View<const std::uint32_t> now, View<std::uint32_t> place, View<const std::uint32_t> ids, View<std::uint32_t> order,
                View<std::uint32_t> wrong) {
    const std::size_t n = now.size;
    for_each(n, [=] GR_HD(std::size_t j) {
        if (now[j] < place.size) place[now[j]] = static_cast<std::uint32_t>(j);
        else wrong[0] = 1;
    });
    for_each(n, [=] GR_HD(std::size_t p) {
        const std::uint32_t j = place[ids[p]];  // may be left from an earlier call, or never written: so it is checked
        if (j < n && now[j] == ids[p]) order[p] = j;
        else wrong[0] = 1;
    });
}

}  // namespace

void BoxOrder::sort(const neighbors::Packed& p) {
    const std::size_t n = p.size();
    sort_along_curve(p, keys_, keys2_, order_, order2_);
    ids_.resize_discard(n);
    gather_ids(p.ids, order_.view(), ids_.view());
    const auto ids = p.ids;
    const std::size_t largest = reduce(n, std::uint32_t{0}, [=] GR_HD(std::size_t i) { return ids[i]; }, Largest{});
    // A table of places by id, unless ids are so far apart that it would outgrow the points; then every tree is a new one.
    place_.resize_discard(largest < 4 * n + 1024 ? largest + 1 : 0);
    place_.clear_bytes();
}

bool BoxOrder::follow(const neighbors::Packed& p) {
    if (p.size() != ids_.size() || place_.size() == 0) return false;
    wrong_.clear_bytes();
    follow_ids(p.ids, place_.view(), ids_.view(), order_.view(), wrong_.view());
    return wrong_.to_host()[0] == 0;
}

}  // namespace grainray::cuda
