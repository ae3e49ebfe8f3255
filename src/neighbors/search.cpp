// NeighborSearch: packs the caller's points, takes the back end asked for or the one that measures fastest, and runs it.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>

#include "neighbors/choice.hpp"
#include "neighbors/registry.hpp"

namespace grainray {
namespace {

constexpr std::size_t brute_is_faster_below = 256;     ///< all pairs are tested before cells are sorted
constexpr std::size_t worth_measuring_from = 5'000;    ///< below, no choice is worth its measurement

void pack(Device device, const Points& points, const neighbors::Request& request, const char* what, neighbors::Packed& packed) {
#ifdef GRAINRAY_HAS_CUDA
    if (device == Device::cuda) return cuda::pack_points(points, request, what, packed);
#endif
    (void)device;
    cpu::pack_points(points, request, what, packed);
}

neighbors::Effort cells_effort(Device device, const neighbors::Packed& asking, const neighbors::Packed& points, bool of_queries, const neighbors::Request& request) {
#ifdef GRAINRAY_HAS_CUDA
    if (device == Device::cuda) return cuda::cells_effort(asking, points, of_queries, request);
#endif
    (void)device;
    return cpu::cells_effort(asking, points, of_queries, request);
}

std::vector<std::string> candidates() {
    std::vector<std::string> names;
    for (const neighbors::Row& row : neighbors::registry())
        if (row.automatic) names.push_back(row.name);
    return names;
}

std::string looks_text(const neighbors::Effort& e) {
    char text[96];
    std::snprintf(text, sizeof text, "cells look at %.3g points for each and at %.3g at most", e.mean, e.most);
    return text;
}

neighbors::Facts facts(const neighbors::Packed& points, std::size_t entries) {
    neighbors::Facts f;
    f.points = static_cast<double>(points.size());
    f.entries = static_cast<double>(std::max<std::size_t>(entries, 1));
    const double mean = std::max(static_cast<double>(points.mean_reach), 1e-30);
    f.spread = points.max_reach / mean;
    f.crowding = f.points;
    for (int a = 0; a < 3; ++a) f.crowding *= mean / (static_cast<double>(points.upper[a]) - points.lower[a] + mean);
    return f;
}

void order_streams([[maybe_unused]] void* first, [[maybe_unused]] void* second) {
#ifdef GRAINRAY_HAS_CUDA
    if (first != second) cuda::order_streams(first, second);
#endif
}

}  // namespace

struct NeighborSearch::Impl {
    using Run = std::function<void(neighbors::Backend&)>;

    Device device;
    SearchOptions options;
    std::map<std::string, std::unique_ptr<neighbors::Backend>> made;
    neighbors::Packed points, queries;
    std::map<bool, neighbors::Choice> choices;  ///< of pairs (false) and of queries (true)
    std::size_t entries = 0;                    ///< of the last list that was filled
    std::size_t most_entries = ~std::size_t{0};
    bool measuring = false;
    std::string backend, reason;

    Impl(Device d, SearchOptions o) : device(d), options(std::move(o)), points(d), queries(d) {
        if (device == Device::cuda && !cuda_available()) throw InputError("device 'cuda' asked for, but " + cuda_status());
        for (int a = 0; a < 3; ++a)
            if (!std::isfinite(options.period[a]) || options.period[a] < 0 || !std::isfinite(options.lower[a]))
                throw InputError("periodic box: its lower corner must be finite and its lengths finite and not negative");
        if (options.stream && device == Device::cpu) throw InputError("a stream is given, but the search is on the CPU; give none or Device::cuda");
        if (options.block == 0) throw InputError("block must be at least 1");
        if (options.backend != "auto") neighbors::require_backend(options.backend, device);
    }

    neighbors::Request request() const {
        return {options.kind, options.block, options.ascending, options.local_order, options.lower, options.period, measuring ? ~std::size_t{0} : most_entries};
    }

    neighbors::Backend& named(const std::string& name) {
        auto& instance = made[name];
        if (!instance) instance = neighbors::require_backend(name, device).make(device);
        return *instance;
    }

    void run_with(const std::string& name, const std::string& why, const Run& run) {
        neighbors::Backend& b = named(name);
        run(b);
        backend = name;
        reason = b.note().empty() ? why : why + "; " + b.note();
    }

    /// Seconds that one search takes until its list is there.
    double timed(const Run& run, const std::string& name, const NeighborList& list) {
        neighbors::Backend& b = named(name);
        const auto start = std::chrono::steady_clock::now();
        run(b);
        std::uint32_t last = 0;  // reading a result waits for the device
        if (list.neighbors.size()) detail::copy(Device::cpu, &last, device, list.neighbors.data() + list.neighbors.size() - 1, sizeof last);
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }

    /// Those of the candidates that are here and can win; for the others the choice is told why not.
    std::vector<std::size_t> field(neighbors::Choice& choice, const neighbors::Facts& now, bool of_queries) {
        const neighbors::Effort effort = cells_effort(device, of_queries ? queries : points, points, of_queries, request());
        std::vector<std::size_t> all;
        for (const std::size_t c : choice.contenders(now)) {
            const neighbors::Row& row = *neighbors::find_row(choice.candidates()[c].name);
            if (row.can_win && !row.can_win(device, effort)) choice.left_out(c, looks_text(effort));
            else if (!row.status(device).available) choice.left_out(c, {});
            else all.push_back(c);
        }
        return all;
    }

    /// Measures those that can win; the list is right in any case.
    void measure(neighbors::Choice& choice, const neighbors::Facts& now, bool of_queries, const Run& run, const NeighborList& list) {
        const auto start = std::chrono::steady_clock::now();
        measuring = true;  // whole lists
        const std::vector<std::size_t> racing = field(choice, now, of_queries);
        bool last_failed = false;
        for (const std::size_t c : racing) {
            const std::string& name = choice.candidates()[c].name;
            try {
                double seconds = timed(run, name, list);
                const bool again = racing.size() > 1 && !choice.out_of_the_race(seconds);
                if (again) seconds = timed(run, name, list);  // the first also made its memory
                choice.measured(c, seconds, now);
                last_failed = false;
            } catch (const Error&) {  // out of memory, or too many points for it: the others will do
                if (racing.size() == 1) throw;
                choice.measured(c, 1e9, now);
                last_failed = true;
            }
        }
        const double total = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        choice.finished_round(total);
        const std::string& best = choice.candidates()[choice.best()].name;
        std::erase_if(made, [&](const auto& entry) { return entry.first != best; });  // their memory is better used elsewhere
        if (last_failed) run(named(best));
        measuring = false;
        backend = best;
        reason = choice.reason();
    }

    void find(bool of_queries, const Run& run, NeighborList& list) {
        const std::size_t n = points.size();
        measuring = false;
        if (options.backend != "auto") return run_with(options.backend, "asked for", run);
        if (n < brute_is_faster_below) return run_with("brute", "fewer than " + std::to_string(brute_is_faster_below) + " points", run);
        if (n < worth_measuring_from) return run_with("cells", "fewer than " + std::to_string(worth_measuring_from) + " points, too few to measure", run);
        const auto [at, is_new] = choices.try_emplace(of_queries, candidates());
        neighbors::Choice& choice = at->second;
        const neighbors::Facts now = facts(points, entries);
        if (choice.due(now)) {
            measure(choice, now, of_queries, run, list);
        } else {
            const std::string& best = choice.candidates()[choice.best()].name;
            const auto start = std::chrono::steady_clock::now();
            run_with(best, choice.reason(), run);
            choice.searched(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        }
        if (list.rows()) entries = list.neighbors.size();
    }
};

NeighborSearch::NeighborSearch(Device device, SearchOptions options) : impl_(std::make_unique<Impl>(device, std::move(options))) {}
NeighborSearch::~NeighborSearch() = default;
NeighborSearch::NeighborSearch(NeighborSearch&&) noexcept = default;
NeighborSearch& NeighborSearch::operator=(NeighborSearch&&) noexcept = default;

void NeighborSearch::find(const Points& points, NeighborList& list) {
    const neighbors::Request request = impl_->request();
    order_streams(impl_->options.stream, nullptr);
    pack(impl_->device, points, request, "point", impl_->points);
    impl_->find(false, [&](neighbors::Backend& b) { b.pairs(impl_->points, impl_->request(), list); }, list);
    order_streams(nullptr, impl_->options.stream);
}

void NeighborSearch::find(const Points& queries, const Points& points, NeighborList& list) {
    neighbors::Request request = impl_->request();
    request.kind = ListKind::half;  // rows belong to the queries alone
    request.most_entries = ~std::size_t{0};
    order_streams(impl_->options.stream, nullptr);
    pack(impl_->device, points, request, "point", impl_->points);
    pack(impl_->device, queries, request, "query", impl_->queries);
    impl_->find(true, [&](neighbors::Backend& b) { b.queries(impl_->queries, impl_->points, request, list); }, list);
    order_streams(nullptr, impl_->options.stream);
}

const std::string& NeighborSearch::backend() const { return impl_->backend; }
const std::string& NeighborSearch::reason() const { return impl_->reason; }
const SearchOptions& NeighborSearch::options() const { return impl_->options; }
void NeighborSearch::set_block(std::uint32_t block) { impl_->options.block = block; }
void NeighborSearch::set_most_entries(std::size_t most) { impl_->most_entries = most; }

void NeighborSearch::release() {
    for (neighbors::Packed* packed : {&impl_->points, &impl_->queries}) {
        packed->copied_spheres.release();
        packed->copied_ids.release();
    }
    for (const auto& [name, backend] : impl_->made) backend->release();
}

std::size_t NeighborSearch::memory_bytes() const {
    std::size_t bytes = impl_->points.copied_spheres.bytes() + impl_->points.copied_ids.bytes();
    for (const auto& [name, backend] : impl_->made) bytes += backend->memory_bytes();
    return bytes;
}

}  // namespace grainray
