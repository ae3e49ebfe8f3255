#include <hdf5.h>

#include <limits>

#include "common.hpp"

namespace grainray::test {

namespace {

Checkpoint sample(std::size_t particles, std::size_t contacts, std::size_t walls) {
    std::mt19937_64 random(11);
    // Any bit pattern must survive, those of not-a-number and of subnormals too.
    const auto fill = [&](auto& array, std::size_t n) {
        array.resize(n);
        auto* bytes = reinterpret_cast<unsigned char*>(array.data());
        std::generate_n(bytes, n * sizeof array[0], [&] { return static_cast<unsigned char>(random()); });
    };
    Checkpoint c;
    c.step = std::numeric_limits<std::uint64_t>::max();
    c.time = 0.1 + 0.2;
    c.dt = 5e-324;
    c.unit = 1.0 / 3;
    c.origin = {2e5, -0.0, 1e-300};
    c.state_hash = 0xfedcba9876543210u;
    fill(c.id, particles);
    fill(c.material, particles);
    fill(c.position, particles);
    fill(c.radius, particles);
    fill(c.mass, particles);
    fill(c.radius_units, particles);
    fill(c.velocity, particles);
    fill(c.velocity_remainder, particles);
    fill(c.angular_velocity, particles);
    fill(c.contact_a, contacts);
    fill(c.contact_b, contacts);
    fill(c.contact_history, contacts);
    fill(c.wall_particle, walls);
    fill(c.wall_plane, walls);
    fill(c.wall_history, walls);
    c.placed = 77;
    c.next_id = 0x123456789;
    for (auto* array : {&c.stream_key, &c.stream_since, &c.stream_drawn, &c.stream_tried, &c.stream_attempts, &c.stream_inserted}) fill(*array, 3);
    for (auto* array : {&c.stream_drawn_mass, &c.stream_inserted_mass}) fill(*array, 3);
    fill(c.waiting_stream, walls);
    fill(c.waiting_number, walls);
    fill(c.removal_key, 2);
    fill(c.removal_particles, 2);
    fill(c.removal_mass, 2);
    c.scene = "title = \"Gr\xc3\xb6\xc3\x9f" "e \xe7\xb2\x92 \xf0\x9f\xaa\xa8\"\n# end\n";
    return c;
}

void expect_same(const Checkpoint& a, const Checkpoint& b) {
    EXPECT_EQ(a.step, b.step);
    EXPECT_EQ(a.time, b.time);
    EXPECT_EQ(a.dt, b.dt);
    EXPECT_EQ(a.unit, b.unit);
    EXPECT_EQ(std::memcmp(&a.origin, &b.origin, sizeof a.origin), 0);
    EXPECT_EQ(a.state_hash, b.state_hash);
    EXPECT_TRUE(same_bits(a.id, b.id) && same_bits(a.material, b.material) && same_bits(a.position, b.position));
    EXPECT_TRUE(same_bits(a.radius, b.radius) && same_bits(a.mass, b.mass) && same_bits(a.radius_units, b.radius_units));
    EXPECT_TRUE(same_bits(a.velocity, b.velocity) && same_bits(a.velocity_remainder, b.velocity_remainder) && same_bits(a.angular_velocity, b.angular_velocity));
    EXPECT_TRUE(same_bits(a.contact_a, b.contact_a) && same_bits(a.contact_b, b.contact_b));
    EXPECT_TRUE(same_bits(a.contact_history, b.contact_history) && same_bits(a.wall_history, b.wall_history));
    EXPECT_TRUE(same_bits(a.wall_particle, b.wall_particle) && same_bits(a.wall_plane, b.wall_plane));
    EXPECT_EQ(a.placed, b.placed);
    EXPECT_EQ(a.next_id, b.next_id);
    EXPECT_TRUE(same_bits(a.stream_key, b.stream_key) && same_bits(a.stream_since, b.stream_since) && same_bits(a.stream_drawn, b.stream_drawn));
    EXPECT_TRUE(same_bits(a.stream_tried, b.stream_tried) && same_bits(a.stream_attempts, b.stream_attempts) && same_bits(a.stream_inserted, b.stream_inserted));
    EXPECT_TRUE(same_bits(a.stream_drawn_mass, b.stream_drawn_mass) && same_bits(a.stream_inserted_mass, b.stream_inserted_mass));
    EXPECT_TRUE(same_bits(a.waiting_stream, b.waiting_stream) && same_bits(a.waiting_number, b.waiting_number));
    EXPECT_TRUE(same_bits(a.removal_key, b.removal_key) && same_bits(a.removal_particles, b.removal_particles) && same_bits(a.removal_mass, b.removal_mass));
    EXPECT_EQ(a.scene, b.scene);
}

}  // namespace

class CheckpointFile : public OutputTest {
protected:
    fs::path path() const { return folder / "checkpoint.h5"; }
    std::string error() const {
        return message_of<InputError>([&] { read_checkpoint(path()); });
    }
};

TEST_F(CheckpointFile, IsExactToTheBit) {
    for (const auto& c : {sample(1000, 3000, 70), sample(1, 0, 1), sample(0, 0, 0), Checkpoint{}}) {
        write_checkpoint(path(), c);
        expect_same(read_checkpoint(path()), c);
        EXPECT_EQ(files_in(folder), 1u);
    }
}

TEST_F(CheckpointFile, SaysWhatItIsNot) {
    EXPECT_TRUE(has(error(), "no such file"));
    spill(path(), "hello");
    EXPECT_TRUE(has(error(), "not an HDF5 file"));
    spill(path(), "");
    EXPECT_TRUE(has(error(), "not an HDF5 file"));
    H5Fclose(H5Fcreate(path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
    EXPECT_TRUE(has(error(), "not a grainray checkpoint"));
    fs::remove(path());
    fs::create_directory(path());
    EXPECT_TRUE(has(error(), "folder"));
}

TEST_F(CheckpointFile, OfAnotherVersionSaysBoth) {
    write_checkpoint(path(), sample(5, 5, 5));
    const hid_t file = H5Fopen(path().c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const hid_t attribute = H5Aopen(file, "version", H5P_DEFAULT);
    const std::uint32_t version = 77;
    H5Awrite(attribute, H5T_NATIVE_UINT32, &version);
    H5Aclose(attribute);
    H5Fclose(file);
    EXPECT_TRUE(has(error(), "version 77, this program reads version 3")) << error();
}

TEST_F(CheckpointFile, CutAnywhereIsAnError) {
    write_checkpoint(path(), sample(100, 200, 10));
    const std::string whole = slurp(path());
    for (std::size_t size = 0; size < whole.size() - 16; size += 1 + whole.size() / 101) {
        spill(path(), whole.substr(0, size));
        ASSERT_TRUE(has(error(), size < 48 ? "HDF5" : "cut short")) << size << ": " << error();
    }
}

TEST_F(CheckpointFile, AChangedByteIsAnError) {
    const Checkpoint c = sample(20, 30, 5);
    write_checkpoint(path(), c);
    const std::string whole = slurp(path());
    constexpr std::size_t seal = 16;
    for (std::size_t i = 0; i < whole.size() - seal; i += 7) {
        std::string damaged = whole;
        damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
        spill(path(), damaged);
        ASSERT_TRUE(has(error(), i < 8 ? "not an HDF5 file" : "damaged")) << "byte " << i << ": " << error();
    }
}

TEST_F(CheckpointFile, WithoutItsSealThePayloadIsChecked) {
    const Checkpoint c = sample(20, 30, 5);
    write_checkpoint(path(), c);
    std::string bare = slurp(path());
    bare.resize(bare.size() - 16);
    spill(path(), bare);
    expect_same(read_checkpoint(path()), c);
    const auto* first = reinterpret_cast<const char*>(c.contact_history.data());
    const std::size_t at = bare.find(std::string(first, 40));
    ASSERT_NE(at, std::string::npos);
    bare[at] = static_cast<char>(bare[at] ^ 1);
    spill(path(), bare);
    EXPECT_TRUE(has(error(), "checksum")) << error();
}

TEST_F(CheckpointFile, FullDiskKeepsTheOldOne) {
    const Checkpoint old = sample(10, 10, 10);
    write_checkpoint(path(), old);
    {
        const FileSizeLimit limit(20000);
        const std::string message = message_of<SimulationError>([&] { write_checkpoint(path(), sample(10000, 10, 10)); });
        EXPECT_TRUE(has(message, path().string()) && has(message, "limit")) << message;
    }
    expect_same(read_checkpoint(path()), old);
    EXPECT_EQ(files_in(folder), 1u);
    EXPECT_NE(message_of<SimulationError>([&] { write_checkpoint(folder / "none" / "c.h5", old); }), "");
}

}  // namespace grainray::test
