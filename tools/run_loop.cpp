#include "run_loop.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "report.hpp"

namespace grainray::cli {
namespace {

constexpr std::uint64_t health_interval = 1000;  // steps between two looks at the state, at most
constexpr double batch_seconds = 0.1;            // so long a signal or the progress line may wait
constexpr std::uint64_t default_checkpoints = 20;
constexpr std::uint64_t no_step = UINT64_MAX;

using clock = std::chrono::steady_clock;

double seconds_since(clock::time_point start) { return std::chrono::duration<double>(clock::now() - start).count(); }

bool due(std::uint64_t step, std::uint64_t every) { return every != 0 && step % every == 0; }

std::uint64_t next_multiple(std::uint64_t step, std::uint64_t every) { return every == 0 ? UINT64_MAX : (step / every + 1) * every; }

/// A run looks at its state after 1, 2, 4 ... steps, when a bad start shows, and then every health_interval.
std::uint64_t next_health(std::uint64_t first, std::uint64_t step) {
    const std::uint64_t early = std::bit_ceil(step - first + 1);
    return std::min(next_multiple(step, health_interval), first + early);
}
bool health_due(std::uint64_t first, std::uint64_t step) { return due(step, health_interval) || std::has_single_bit(step - first); }

std::uint64_t whole_steps(double interval, double dt) {
    if (!(interval > 0)) return 0;
    const double steps = std::min(interval / dt, 1e18);
    return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::llround(steps)));
}

const std::vector<std::string> lost_columns{"time", "step", "id", "x", "y", "z", "velocity_x", "velocity_y", "velocity_z", "radius"};

std::vector<std::string> removed_columns() {
    auto columns = lost_columns;
    columns.push_back("removal");
    return columns;
}

/// Names stand in rows of commas.
std::string column_name(std::string name) {
    std::replace(name.begin(), name.end(), ',', '_');
    return name;
}

/// Force and torque on each mesh and the terrain come last, before them what streams and removals have done.
std::vector<std::string> history_columns(const Scene& scene) {
    std::vector<std::string> columns{
    "time",       "kinetic_translation", "kinetic_rotation",  "potential",    "momentum_x", "momentum_y",
    "momentum_z", "max_overlap_ratio",   "coordination",      "mean_neighbors", "front_99", "max_speed",
    "angular_momentum_x", "angular_momentum_y", "angular_momentum_z", "contacts", "particles", "step"};
    if (!scene.streams.empty()) columns.insert(columns.end(), {"inserted", "waiting"});
    if (!scene.removals.empty()) columns.push_back("removed");
    std::vector<std::string> surfaces;
    for (const Mesh& mesh : scene.meshes) surfaces.push_back(mesh.name);
    if (scene.terrain) surfaces.push_back("terrain");
    for (const std::string& name : surfaces)
        for (const char* what : {"force", "torque"})
            for (const char axis : {'x', 'y', 'z'}) columns.push_back(fmt::format("{}_{}_{}", column_name(name), what, axis));
    return columns;
}

std::vector<double> history_row(const Simulation& simulation, const Scene& scene) {
    const Statistics s = simulation.statistics();
    const Exchanged exchanged = exchanged_by(simulation);
    std::vector<double> row{s.time,       s.kinetic_translation, s.kinetic_rotation, s.potential,      s.momentum.x, s.momentum.y,
            s.momentum.z, s.max_overlap_ratio,   s.coordination,     s.mean_neighbors, s.front_99,   s.max_speed,
            s.angular_momentum.x, s.angular_momentum.y, s.angular_momentum.z, static_cast<double>(s.contacts),
            static_cast<double>(simulation.size()), static_cast<double>(s.step)};
    if (!scene.streams.empty()) row.insert(row.end(), {static_cast<double>(exchanged.inserted), static_cast<double>(exchanged.waiting)});
    if (!scene.removals.empty()) row.push_back(static_cast<double>(exchanged.removed));
    for (const SurfaceLoad& load : s.surfaces)
        for (const Vec3d& v : {load.force, load.torque}) row.insert(row.end(), {v.x, v.y, v.z});
    return row;
}

}  // namespace

/// Frame k is the state after k intervals; a last state between two of them takes the next number.
std::uint64_t RunPlan::frame_index(std::uint64_t step) const {
    if (frames == 0) return step == 0 ? 0 : 1;
    return (step + frames - 1) / frames;
}

RunPlan plan_run(const Scene& scene, std::uint64_t first, std::uint64_t last, bool appends) {
    const OutputSettings& o = scene.output;
    RunPlan plan{first, last, whole_steps(o.frames, scene.dt), 0, 0, appends, false};
    plan.history = o.history > 0 ? whole_steps(o.history, scene.dt) : plan.frames;
    plan.checkpoints = o.checkpoints > 0 ? whole_steps(o.checkpoints, scene.dt) : plan.frames;
    if (plan.checkpoints == 0) plan.checkpoints = std::max<std::uint64_t>(1, (last - first) / default_checkpoints);
    return plan;
}

RunLoop::RunLoop(Simulation& simulation, const Scene& scene, const RunFolder& folder, const RunPlan& plan, bool quiet)
    : simulation_(simulation), scene_(scene), folder_(folder), plan_(plan), progress_(quiet, plan.first, plan.last),
      history_(folder.history(), history_columns(scene), plan.appends, simulation.time()),
      asked_checkpoint_(plan.has_checkpoint ? plan.first : no_step), written_checkpoint_(asked_checkpoint_) {
    if (scene.terrain && scene.terrain->edge == TerrainEdge::open) lost_.emplace(folder.lost(), lost_columns, plan.appends, simulation.time());
    if (!scene.removals.empty()) removed_.emplace(folder.removed(), removed_columns(), plan.appends, simulation.time());
}

bool RunLoop::run() {
    try {
        const bool finished = run_to_end();
        progress_.clear();
        queue_.finish();
        return finished;
    } catch (...) {
        queue_.wait();
        throw;
    }
}

bool RunLoop::run_to_end() {
    if (!plan_.appends) look(frame | history | checkpoint);
    else folder_.remove_frames_after(plan_.frames ? plan_.first / plan_.frames : 0);
    while (simulation_.step_count() < plan_.last && !signals_.asked()) {
        advance(next_stop());
        write_lost();
        queue_.check();
        look(due_now());
        progress_.update(simulation_);
    }
    if (simulation_.step_count() == plan_.last) return true;
    look(checkpoint);
    return false;
}

/// At once, so that the list is whole whenever a checkpoint is written.
void RunLoop::write_lost() {
    for (const LostParticle& p : simulation_.lost()) {
        const std::vector<double> row{p.time, static_cast<double>(p.step), static_cast<double>(p.id), p.position.x, p.position.y, p.position.z,
                                      p.velocity.x, p.velocity.y, p.velocity.z, p.radius};
        if (p.removal == LostParticle::left_terrain) lost_->row(row);
        else removed_->row(row, column_name(scene_.removals[p.removal].name));
    }
    simulation_.forget_lost();
}

std::uint64_t RunLoop::next_stop() const {
    const std::uint64_t now = simulation_.step_count();
    return std::min({plan_.last, next_multiple(now, plan_.frames), next_multiple(now, plan_.history), next_multiple(now, plan_.checkpoints),
                     next_health(plan_.first, now)});
}

/// Steps towards `limit`, for about batch_seconds.
void RunLoop::advance(std::uint64_t limit) {
    const std::uint64_t left = limit - simulation_.step_count();
    std::uint64_t batch = 1;
    if (seconds_per_step_ > 0) batch = static_cast<std::uint64_t>(std::clamp(batch_seconds / seconds_per_step_, 1.0, static_cast<double>(left)));
    batch = std::min(batch, left);
    const auto start = clock::now();
    try {
        simulation_.run(batch);
    } catch (const InputError& e) {  // a search that meets a position that is no number
        simulation_.check_health();
        throw SimulationError(fmt::format("the simulation broke at step {}: {}", simulation_.step_count(), e.what()));
    }
    const double seconds = seconds_since(start) / static_cast<double>(batch);
    seconds_per_step_ = seconds_per_step_ > 0 ? 0.5 * (seconds_per_step_ + seconds) : seconds;
}

unsigned RunLoop::due_now() const {
    const std::uint64_t step = simulation_.step_count();
    if (step == plan_.last) return frame | history | checkpoint;
    return (due(step, plan_.frames) ? frame : 0u) | (due(step, plan_.history) ? history : 0u) | (due(step, plan_.checkpoints) ? checkpoint : 0u);
}

/// The state at one instant, as far as it is to be written.
struct RunLoop::Output {
    std::uint64_t step = 0;
    std::optional<Frame> frame;
    std::optional<std::vector<double>> row;
    std::optional<Checkpoint> checkpoint;
};

std::shared_ptr<const RunLoop::Output> RunLoop::take(unsigned parts) const {
    auto output = std::make_shared<Output>();
    output->step = simulation_.step_count();
    if (parts & frame) output->frame = simulation_.frame();
    if (parts & history) output->row = history_row(simulation_, scene_);
    if (parts & checkpoint) output->checkpoint = simulation_.checkpoint();
    return output;
}

/// Nothing is written of a state that is not sound; the first one was looked at before the run.
void RunLoop::look(unsigned parts) {
    if (!parts && !health_due(plan_.first, simulation_.step_count())) return;
    const auto start = clock::now();
    if (simulation_.step_count() != plan_.first) simulation_.check_health();
    write(parts);
    simulation_.profile().output += seconds_since(start);
}

void RunLoop::write(unsigned parts) {
    if (asked_checkpoint_ == simulation_.step_count()) parts &= ~unsigned{checkpoint};
    if (!parts) return;
    const bool snapshot = parts & (frame | checkpoint);
    if (snapshot) queue_.wait_for_room();
    OutputQueue::Job job = [this, output = take(parts)] { write_out(*output); };
    if (snapshot) queue_.push_snapshot(std::move(job));
    else queue_.push(std::move(job));
    if (parts & checkpoint) asked_checkpoint_ = simulation_.step_count();
}

/// The checkpoint comes last: what it stands for has been written when it appears.
void RunLoop::write_out(const Output& output) {
    if (output.frame) writer_for(scene_.output.format).write(folder_.frame(plan_.frame_index(output.step)), *output.frame, scene_.output.fields);
    if (output.row) history_.row(*output.row);
    if (!output.checkpoint) return;
    write_checkpoint(folder_.checkpoint(), *output.checkpoint);
    written_checkpoint_ = output.step;
}

std::string RunLoop::last_checkpoint() const {
    if (written_checkpoint_ == no_step) return "no checkpoint was written";
    return fmt::format("the last good checkpoint is {} (step {}, t = {:.6g} s)", folder_.checkpoint().string(), written_checkpoint_,
                       static_cast<double>(written_checkpoint_) * scene_.dt);
}

}  // namespace grainray::cli
