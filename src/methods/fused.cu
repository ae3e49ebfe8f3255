// DEM on CUDA: contacts, planes and motion as one kernel a step, so that a particle's state crosses the memory bus once.
// A batch of steps is launched without waiting. A step that sees a particle past its margin is complete, and those after it
// find State::flags[0] below their own number and return; the host reads the flag once a batch.
#include "boundary/plane_contact.hpp"
#include "contacts/laws.hpp"
#include "dynamics/motion.hpp"
#include "exec/overlap.hpp"
#include "exec/pairs_cuda.hpp"
#include "stages.hpp"

namespace grainray::cuda {
namespace {

constexpr unsigned step_threads = 128, step_blocks = 7;  // a multiprocessor: 72 registers a thread; with 64 its loop spills

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
        pairs.add<periodic>(law, i, p, f, b, sum);
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

template <bool periodic, class Law>
__global__ void __launch_bounds__(step_threads, step_blocks) step_kernel(FusedStep<Law> fused, std::uint32_t step) {
    if (*static_cast<const volatile std::uint32_t*>(fused.flags) < step) return wait_for_first();
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < fused.size) fused.template operator()<periodic>(i, step);
}

void swap_state(State& s) {
    s.particles.near.swap(s.next_near);
    s.particles.body.swap(s.next_body);
    if (s.next_far.size()) s.particles.far.swap(s.next_far);
}

template <bool periodic, class Law>
void launch(State& s, ContactLaw name, const Law& law, const StepConstants& constants, float trigger, std::uint32_t steps) {
    const unsigned blocks = static_cast<unsigned>((s.size() + step_threads - 1) / step_threads);
    for (std::uint32_t step = 0; step < steps; ++step) {
        const FusedStep<Law> fused(s, law, constants, trigger);
        if (s.facets.list.rows() > 0) {
            facets(s, name, constants, step, FacetTarget::rows);
            launch_second(step_kernel<periodic, Law>, blocks, step_threads, fused, step);
        } else step_kernel<periodic><<<blocks, step_threads>>>(fused, step);
        swap_state(s);
    }
    check(cudaGetLastError(), "launch of a step");
}

}  // namespace

std::uint32_t fused(State& s, ContactLaw law, const StepConstants& constants, float trigger, std::uint32_t steps) {
    const bool periodic = s.period.x > 0 || s.period.y > 0 || s.period.z > 0;
    s.next_near.resize_discard(s.size());
    s.next_body.resize_discard(s.size());
    if (periodic) s.next_far.resize_discard(s.size());
    with_law(law, constants.dt, [&](auto functor) {
        if (periodic) launch<true>(s, law, functor, constants, trigger, steps);
        else launch<false>(s, law, functor, constants, trigger, steps);
    });
    std::uint32_t stop = 0;
    check(cudaMemcpy(&stop, s.flags.data(), sizeof stop, cudaMemcpyDeviceToHost), "step");
    const bool stopped = stop != ~0u;
    const std::uint32_t done = stopped ? stop + 1 : steps;
    if ((steps - done) % 2) swap_state(s);  // the steps that returned at once wrote nothing
    s.next_near.release();
    s.next_body.release();
    s.next_far.release();
    s.age.steps += done;
    s.age.outdated = stopped || s.age.steps >= s.age.limit;
    return done;
}

}  // namespace grainray::cuda
