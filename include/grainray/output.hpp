// What leaves a simulation: frames, checkpoints, history rows, the summary. Files are written whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "grainray/core.hpp"

namespace grainray {

/// Host snapshot of the particles, ascending id. SI units; vectors of one length each.
struct Frame {
    std::uint64_t step = 0;
    double time = 0;
    std::vector<std::uint32_t> id, material, coordination;
    std::vector<Vec3d> position;
    std::vector<float> radius, mass, contact_force;  ///< contact_force: sum of |f| over the contacts, N
    std::vector<Vec3f> velocity, angular_velocity;
    std::size_t size() const { return position.size(); }
};

/// Names of the frame fields a scene may select besides position: radius velocity angular_velocity id material
/// coordination contact_force mass.
const std::vector<std::string>& frame_fields();

/// Writes frames of one format. Throws SimulationError naming the file and the reason (disk full, no permission).
class Writer {
public:
    virtual ~Writer() = default;
    /// path has the format's extension; fields empty means all.
    virtual void write(const std::filesystem::path& path, const Frame&, const std::vector<std::string>& fields) const = 0;
};

/// Writer for an extension without the dot ("vtp", "csv"); throws InputError that lists the known ones.
const Writer& writer_for(const std::string& extension);
std::vector<std::string> writer_extensions();

/// Reads a frame this program wrote (.vtp or .csv); missing fields stay empty. Throws InputError.
Frame read_frame(const std::filesystem::path&);

/// Everything an exact restart needs, host side, canonical order (ascending id; contacts ascending (a, b)).
struct Checkpoint {
    std::uint64_t step = 0;
    double time = 0, dt = 0;
    double unit = 0;                          ///< metres per fixed-point position unit
    Vec3d origin;                             ///< world position of fixed-point zero, m
    double largest_radius = 0;                ///< of all particles there ever were or may come, m
    std::uint64_t placed = 0;                 ///< particles at the start of the run: their ids come first
    std::uint64_t next_id = 0;                ///< of the next particle to come
    std::uint64_t state_hash = 0;
    std::vector<std::uint32_t> id, material;
    std::vector<Vec3l> position;              ///< fixed point
    std::vector<float> radius, mass;
    std::vector<std::int32_t> radius_units;
    std::vector<Vec3f> velocity, velocity_remainder, angular_velocity;  ///< remainder: particles.hpp
    std::vector<std::uint32_t> contact_a, contact_b;  ///< particle ids a > b of every contact with history
    std::vector<Vec3f> contact_history;               ///< tangential elastic force on a, N
    std::vector<std::uint32_t> wall_particle, wall_plane;
    std::vector<Vec3f> wall_history;
    std::vector<std::uint32_t> facet_particle, facet; ///< particle ids, ascending, and facets they touch (boundary/facets.hpp)
    std::vector<float> facet_side;
    std::vector<Vec3f> facet_history;
    /// A stream: its name as a number, the step at which it began, particles due, looked at, places tried, inserted (insertion/feeder.hpp).
    std::vector<std::uint64_t> stream_key, stream_since, stream_drawn, stream_tried, stream_attempts, stream_inserted;
    std::vector<double> stream_drawn_mass, stream_inserted_mass;        ///< kg
    std::vector<std::uint32_t> waiting_stream;                          ///< place of a stream above, ascending
    std::vector<std::uint64_t> waiting_number;                          ///< particles of it that wait for a place
    std::vector<std::uint64_t> removal_key, removal_particles;          ///< name as a number; taken out so far
    std::vector<double> removal_mass;                                   ///< kg
    std::string scene;                        ///< text of the scene it belongs to
};

/// Writes to a temporary file beside `path`, syncs, renames: `path` is always the old or the new one, whole.
void write_checkpoint(const std::filesystem::path&, const Checkpoint&);
/// Throws InputError: missing, not a checkpoint, truncated or damaged (checksum), another format version.
Checkpoint read_checkpoint(const std::filesystem::path&);

/// Writes text to `path` by way of a temporary file and rename. Throws SimulationError (disk full, ...).
void write_text_atomically(const std::filesystem::path&, const std::string&);

/// Appends rows to a CSV file; every row is flushed, failures throw SimulationError.
class HistoryFile {
public:
    /// Starts a new file, or (append) keeps the rows whose first column, the time, is <= keep_until.
    HistoryFile(std::filesystem::path, const std::vector<std::string>& columns, bool append, double keep_until);
    ~HistoryFile();
    /// name: of the last column, where that is a text.
    void row(const std::vector<double>& values, const std::string& name = "");

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace grainray
