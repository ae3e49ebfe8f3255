// DEM on CUDA: contacts, planes and motion as one kernel a step, so that a particle's state crosses the memory bus once.
// A batch of steps is launched without waiting. A step that sees a particle past its margin is complete, and those after it
// find State::flags[0] below their own number and return; the host reads the flag once a batch.
// A row whose histories find no column (exec/rows_cuda.hpp) leaves everything as it is, is marked and ends the batch in the
// same way; the host makes room and has the marked rows do the step.
#include "boundary/plane_contact.hpp"
#include "contacts/laws.hpp"
#include "dynamics/motion.hpp"
#include "exec/overlap.hpp"
#include "exec/pairs_cuda.hpp"
#include "stages.hpp"

namespace grainray::cuda {
namespace {

constexpr unsigned step_threads = pair_threads, step_blocks = 7;  // a multiprocessor: 72 registers a thread; with 64 its loop spills
constexpr std::uint32_t unfinished_bit = 1u << 31;       // of the length of a row

__device__ inline void add_to(Wrench& sum, const Wrench& more) {
    for (int a = 0; a < 3; ++a) {
        sum.force[a] += more.force[a];
        sum.torque[a] += more.torque[a];
    }
}

template <class Law>
struct FusedStep {
    Law law;
    PairRows pairs;
    PlaneContacts<Law> planes;
    Motion motion;
    Near* near;
    Far* far;
    Body* body;
    Vec3f* remainder;
    const Near* __restrict__ built;
    const Vec3f* __restrict__ frame;
    std::uint32_t* flags;
    const std::uint32_t* __restrict__ facet_rows;   // null without meshes and terrain
    const Wrench* facet_forces;                     // written while this kernel runs: not __restrict__
    double fine;
    std::uint32_t size, age;
    bool planes_move;

    FusedStep(State& s, const Law& contact_law, const StepConstants& constants, float trigger)
        : law(contact_law), pairs(s, s.only_parameters), planes(s, contact_law), motion(s, constants, trigger), near(s.next_near.data()),
          far(s.next_far.size() ? s.next_far.data() : s.particles.far.data()), body(s.next_body.data()),
          remainder(s.particles.remainder.data()), built(s.built.data()), frame(s.frame.data()), flags(s.flags.data()),
          facet_rows(s.facets.count() ? s.facets.list.row_of.data() : nullptr), facet_forces(s.facets.list.forces.data()),
          fine(s.particles.scale.fine()), size(static_cast<std::uint32_t>(s.size())), age(s.age.steps),
          planes_move(s.planes.size() > s.plane_count) {}

    template <bool periodic>
    __device__ void operator()(std::uint32_t i, std::uint32_t step) const {
        Near p = pairs.near[i];
        Body b = pairs.body[i];
        Far f{};  // read late where pairs do without it: registers are short
        if constexpr (periodic) f = pairs.far[i];
        Wrench sum{};
        if (pairs.add<periodic>(law, i, p, f, b, sum)) finish<periodic>(i, step, sum, p, f, b);
        else {
            pairs.rows.counts[i] |= unfinished_bit;
            atomicMin(&flags[0], step);
            wait_for_first();
        }
    }

    /// Planes, facets and motion of particle i.
    template <bool periodic>
    __device__ void finish(std::uint32_t i, std::uint32_t step, Wrench& sum, Near& p, Far& f, Body& b) const {
        if constexpr (!periodic) f = pairs.far[i];
        if (planes.offsets[i] != planes.offsets[i + 1])
            planes.add(i, convert<double>(join(p, f)) * fine, p.radius, b, planes_move ? std::size_t{step} * planes.plane_count : 0, sum);
        if (facet_rows && facet_rows[i] != ~0u) {
            wait_for_first();
            add_to(sum, facet_forces[facet_rows[i]]);
        }
        Vec3f left = remainder[i];
        const bool finite = motion.advance(sum, p, f, b, left);
        near[i] = p;
        far[i] = f;
        body[i] = b;
        remainder[i] = left;
        if (!finite) {
            atomicMin(&flags[1], i);
            atomicMin(&flags[0], step);
        } else if (motion.past_margin(p, built[i], frame[i], static_cast<float>(age + step + 1))) atomicMin(&flags[0], step);
    }
};

/// Of all rows, or of those left unfinished.
template <bool periodic, class Law>
__global__ void __launch_bounds__(step_threads, step_blocks) step_kernel(FusedStep<Law> fused, std::uint32_t step, bool unfinished) {
    if (*static_cast<const volatile std::uint32_t*>(fused.flags) < step) return wait_for_first();
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= fused.size) return;
    if (unfinished) {
        std::uint32_t& count = fused.pairs.rows.counts[i];
        if (!(count & unfinished_bit)) return;
        count &= ~unfinished_bit;
    }
    fused.template operator()<periodic>(i, step);
}

void swap_state(State& s) {
    s.particles.near.swap(s.next_near);
    s.particles.body.swap(s.next_body);
    if (s.next_far.size()) s.particles.far.swap(s.next_far);
}

using Flags = std::array<std::uint32_t, 3>;

Flags read_flags(const State& s) {
    Flags flags;
    check(cudaMemcpy(flags.data(), s.flags.data(), sizeof flags, cudaMemcpyDeviceToHost), "step");
    return flags;
}

template <bool periodic, class Law>
struct Batch {
    State& s;
    ContactLaw name;
    const Law& law;
    const StepConstants& constants;
    float trigger;

    unsigned blocks() const { return static_cast<unsigned>((s.size() + step_threads - 1) / step_threads); }

    void launch(std::uint32_t step, bool unfinished) const {
        step_kernel<periodic><<<blocks(), step_threads>>>(FusedStep<Law>(s, law, constants, trigger), step, unfinished);
        check(cudaGetLastError(), "launch of a step");
    }

    /// The rows of a step that found no column. A first look may not tell all that is missing.
    void finish(std::uint32_t step, Flags flags) const {
        swap_state(s);
        for (std::uint32_t spares = spare_columns(s.grains); flags[spares_flag] > spares; flags = read_flags(s)) {
            detail::copy(device, s.flags.data() + spares_flag, Device::cpu, &spares, sizeof spares);
            resize_spares(s.grains, 2 * std::size_t{flags[spares_flag]});
            spares = spare_columns(s.grains);
            launch(step, true);
        }
        swap_state(s);
        ++s.grains.finished;
    }

    /// Returns the steps done.
    std::uint32_t run(std::uint32_t steps) const {
        for (std::uint32_t step = 0; step < steps; ++step) {
            if (s.facets.list.rows() > 0) {
                facets(s, name, constants, step, FacetTarget::rows);
                launch_second(step_kernel<periodic, Law>, blocks(), step_threads, FusedStep<Law>(s, law, constants, trigger), step, false);
            } else launch(step, false);
            swap_state(s);
        }
        const Flags flags = read_flags(s);
        const bool stopped = flags[0] != ~0u;
        const std::uint32_t done = stopped ? flags[0] + 1 : steps;
        if ((steps - done) % 2) swap_state(s);  // the steps that returned at once wrote nothing
        if (flags[spares_flag] > spare_columns(s.grains)) finish(flags[0], flags);
        s.age.steps += done;
        s.age.outdated = stopped || s.age.steps >= s.age.limit;
        return done;
    }
};

}  // namespace

std::uint32_t fused(State& s, ContactLaw law, const StepConstants& constants, float trigger, std::uint32_t steps) {
    const bool periodic = s.period.x > 0 || s.period.y > 0 || s.period.z > 0;
    s.next_near.resize_discard(s.size());
    s.next_body.resize_discard(s.size());
    if (periodic) s.next_far.resize_discard(s.size());
    std::uint32_t done = 0;
    with_law(law, constants.dt, [&](auto functor) {
        if (periodic) done = Batch<true, decltype(functor)>{s, law, functor, constants, trigger}.run(steps);
        else done = Batch<false, decltype(functor)>{s, law, functor, constants, trigger}.run(steps);
    });
    s.next_near.release();
    s.next_body.release();
    s.next_far.release();
    return done;
}

}  // namespace grainray::cuda
