// Search by rays on a GPU with OptiX. Boxes in Morton order, built anew or refitted as measured costs say; one launch writes
// what each ray finds into slots, which grow where they were too few.
#include <vector>

#include "exec/exec.hpp"
#include "neighbors/optix/boxes.hpp"
#include "neighbors/optix/larger.hpp"
#include "neighbors/optix/order.hpp"
#include "neighbors/optix/stopwatch.hpp"
#include "neighbors/rays/common.hpp"
#include "neighbors/rays/refit.hpp"
#include "neighbors/rays/rows.hpp"

namespace grainray::cuda {
namespace {

using neighbors::Packed;
using neighbors::Request;
using neighbors::Sphere;
using optix::Search;
namespace rays = neighbors::rays;

constexpr std::size_t most_boxes = std::size_t{1} << 29;  // OptiX takes no more in one tree

/// Spheres in the order of the tree, and their boxes.
void place_spheres(const Packed& p, View<const std::uint32_t> order, View<Sphere> spheres) {
    const auto from = p.spheres;
    for_each(order.size, [=] GR_HD(std::size_t k) { spheres[k] = from[order[k]]; });
}
template <class BoxOf>
void place_boxes(View<const Sphere> spheres, View<OptixAabb> boxes, const BoxOf& box_of) {
    for_each(spheres.size, [=] GR_HD(std::size_t k) {
        const rays::Bounds b = box_of(spheres[k]);
        boxes[k] = {b.lower.x, b.lower.y, b.lower.z, b.upper.x, b.upper.y, b.upper.z};
    });
}
struct BoxForSmall {
    rays::Frame frame;
    rays::Classes classes;
    GR_HD rays::Bounds operator()(const Sphere& s) const { return rays::box_for_small(s, classes, frame); }
};
void place_boxes_of_larger(View<const Sphere> spheres, View<const std::uint32_t> larger, View<OptixAabb> boxes, const rays::Frame& frame,
                           const rays::Classes& classes) {
    const rays::Frame f = frame;
    const rays::Classes c = classes;
    for_each(larger.size, [=] GR_HD(std::size_t k) {
        const rays::Bounds b = rays::box_for_larger(spheres[larger[k]], c, f);
        boxes[k] = {b.lower.x, b.lower.y, b.lower.z, b.upper.x, b.upper.y, b.upper.z};
    });
}

struct WideBox {
    rays::Frame frame;
    float extra;
    GR_HD rays::Bounds operator()(const Sphere& s) const { return frame.box({s.x, s.y, s.z}, s.reach + extra); }
};

struct Tally {
    std::uint64_t total;
    std::uint32_t longest;
};
struct AddTally {
    GR_HD Tally operator()(const Tally& a, const Tally& b) const { return {a.total + b.total, a.longest > b.longest ? a.longest : b.longest}; }
};
Tally tally(const rays::Slots& s) {
    return reduce(s.rays(), Tally{0, 0}, [=] GR_HD(std::size_t k) { return Tally{s.found(k), s.found(k)}; }, AddTally{});
}

constexpr std::size_t samples = 4096;

std::vector<float> sample_reaches(View<const Sphere> spheres) {
    Array<float> some(device, std::min(spheres.size, samples));
    const auto reaches = some.view();
    const std::size_t step = spheres.size / reaches.size;
    for_each(reaches.size, [=] GR_HD(std::size_t i) { reaches[i] = spheres[i * step].reach; });
    return some.to_host();
}

void lengths(const rays::Slots& s, View<std::uint64_t> starts) {
    for_each(s.rays() + 1, [=] GR_HD(std::size_t k) { starts[k] = k < s.rays() ? s.found(k) : 0; });
}

/// Rows of slots for what the rays find, kept from call to call.
class SlotRows {
public:
    /// launch(slots) until everything found has its slot.
    template <class Launch>
    rays::Slots fill(std::size_t n, bool two_sided, const Launch& launch) {
        left_.resize_discard(n);
        right_.resize_discard(two_sided ? n : 0);
        entries_.resize_discard_slack(n * width_);
        rays::Slots s{entries_.view(), left_.view(), right_.view(), {}, width_};
        launch(s);
        const Tally t = tally(s);
        repeated_ = t.longest > width_;
        if (!repeated_) return s;
        const std::uint64_t wide = std::uint64_t{t.longest} + t.longest / 8;
        if (wide * n <= 16 * t.total + 1'000'000) {
            width_ = s.width = static_cast<std::uint32_t>(wide);
            entries_.resize_discard_slack(n * width_);
        } else {  // a few rays find far more than the rest: exact rows, from the counts
            starts_.resize_discard(n + 1);
            lengths(s, starts_.view());
            entries_.resize_discard_slack(exclusive_scan(starts_.view()));
            s.starts = starts_.view();
        }
        s.entries = entries_.view();
        launch(s);
        return s;
    }
    bool repeated() const { return repeated_; }
    std::size_t memory_bytes() const { return left_.bytes() + right_.bytes() + entries_.bytes() + starts_.bytes(); }

private:
    std::uint32_t width_ = 8;
    bool repeated_ = false;  ///< there were too few slots: two launches
    Array<std::uint32_t> left_{device}, right_{device}, entries_{device};
    Array<std::uint64_t> starts_{device};
};

class OptiX final : public neighbors::Backend {
public:
    explicit OptiX(bool published) : published_(published) {}

    void pairs(const Packed& p, const Request& r, NeighborList& list) override {
        const Search search = published_ ? Search::published : Search::pairs;
        const rays::Slots slots = trace(search, p, p, r);
        make_rows(rows(slots, p, p, search, r), published_ ? rays::Reported::twice : rays::Reported::once, r, memory_, list);
    }
    void queries(const Packed& q, const Packed& p, const Request& r, NeighborList& list) override {
        const rays::Slots slots = trace(Search::queries, q, p, r);
        make_rows(rows(slots, q, p, Search::queries, r), rays::Reported::queries, r, memory_, list);
    }
    std::string note() const override { return optix::Machine::get().status().reason; }
    std::size_t memory_bytes() const override {
        return order_.memory_bytes() + tree_.memory_bytes() + larger_.memory_bytes() + spheres_.bytes() + slots_.memory_bytes() + memory_.bytes();
    }

private:
    rays::Rows rows(const rays::Slots& slots, const Packed& sources, const Packed& p, Search search, const Request& r) const {
        const View<const Sphere> boxes = spheres_.view();
        return {slots, order_.order(), p.spheres, p.ids, doubtful_.view(), search == Search::queries ? sources.spheres : boxes, boxes, r.period};
    }
    rays::Slots trace(Search, const Packed& sources, const Packed& points, const Request&);
    bool update_tree(Search, const Packed& sources, const Packed& points);
    void place_pair_boxes(const Packed&, bool refit);

    const bool published_;
    BoxOrder order_;
    optix::BoxTree tree_;
    optix::Stopwatch watch_;
    rays::RefitPolicy policy_;
    SlotRows slots_;
    rays::RowsMemory memory_{device};
    Search last_search_ = Search::pairs;
    rays::Frame frame_;
    rays::Classes classes_{};
    LargerPoints larger_;
    Array<std::uint32_t> doubtful_{device, 1};
    Array<Sphere> spheres_{device};  ///< in the order of the boxes
};

void OptiX::place_pair_boxes(const Packed& p, bool refit) {
    const View<const Sphere> spheres = spheres_.view();
    if (!refit) {
        const rays::Limits limits = rays::limits(sample_reaches(spheres), p.max_reach);
        classes_ = {limits.small, limits.common, 0};
        larger_.choose(spheres, limits.small);
    }
    if (larger_.points().size) classes_.small = larger_.largest_small(spheres);
    else classes_.small = p.max_reach;
    const float scale = frame_.scale, wide = 2 * (scale * p.max_reach) + scale * frame_.period.x;
    classes_.beside = larger_.points().size ? 1.25f * ((scale * p.upper.x - scale * p.lower.x) + 2 * wide) : 0;
    const std::size_t n = spheres.size;
    tree_.boxes().resize_discard(n + larger_.points().size);
    const View<OptixAabb> boxes = tree_.boxes().view();
    place_boxes(spheres, {boxes.data, n}, BoxForSmall{frame_, classes_});
    place_boxes_of_larger(spheres, larger_.points(), {boxes.data + n, boxes.size - n}, frame_, classes_);
}

/// True where the tree was refitted.
bool OptiX::update_tree(Search search, const Packed& sources, const Packed& p) {
    const std::size_t n = p.size();
    if (n > most_boxes / 2)
        throw InputError(std::to_string(n) + " points: search by rays on a GPU takes at most " + std::to_string(most_boxes / 2) + "; search by cells");
    const bool refit = search == last_search_ && tree_.handle() && !policy_.rebuild() && order_.follow(p);
    if (!refit) order_.sort(p);
    last_search_ = search;
    spheres_.resize_discard(n);
    place_spheres(p, order_.order(), spheres_.view());
    if (search == Search::pairs) {
        place_pair_boxes(p, refit);
    } else {
        tree_.boxes().resize_discard(n);
        place_boxes(spheres_.view(), tree_.boxes().view(), WideBox{frame_, sources.max_reach});
    }
    tree_.build(refit);
    return refit;
}

rays::Slots OptiX::trace(Search search, const Packed& sources, const Packed& points, const Request& r) {
    doubtful_.clear_bytes();
    if (sources.size() == 0 || points.size() == 0)
        return slots_.fill(sources.size(), false, [&](const rays::Slots& s) {
            if (s.rays()) detail::clear(device, s.left.data, s.rays() * sizeof(std::uint32_t));
        });
    watch_.start();
    const float widest = points.max_reach + sources.max_reach;
    frame_ = rays::frame_of({{points.lower, points.upper}, {sources.lower, sources.upper}}, widest, r.period);
    const bool refit = update_tree(search, sources, points);
    watch_.lap();
    optix::Parameters q{};
    q.boxes = tree_.handle();
    q.points = spheres_.view();
    q.sources = search == Search::queries ? sources.spheres : spheres_.view();
    q.frame = frame_;
    q.bounds = {frame_.box(points.lower, widest).lower, frame_.box(points.upper, widest).upper};
    q.periodic = r.periodic();
    q.classes = search == Search::pairs ? classes_ : rays::Classes{3e38f, 3e38f, 0};
    q.larger = larger_.points();
    q.doubtful = doubtful_.view();
    const rays::Slots slots = slots_.fill(sources.size(), search == Search::published, [&](const rays::Slots& s) {
        q.slots = s;
        optix::Machine::get().launch(search, q, sources.size());
    });
    watch_.lap();
    const double tree_time = watch_.milliseconds(0), search_time = slots_.repeated() ? 0 : watch_.milliseconds(1);
    if (refit) policy_.refitted(tree_time, search_time);
    else policy_.rebuilt(tree_time, search_time);
    return slots;
}

std::unique_ptr<neighbors::Backend> make(bool published) { return std::make_unique<OptiX>(published); }

}  // namespace

neighbors::Status optix_status() { return optix::Machine::get().status(); }
std::unique_ptr<neighbors::Backend> make_optix() { return make(false); }
std::unique_ptr<neighbors::Backend> make_optix_published() { return make(true); }

}  // namespace grainray::cuda
