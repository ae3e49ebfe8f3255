// grainray run: what it leaves, and what it leaves alone.
#include <signal.h>

#include <algorithm>
#include <sstream>

#include "grainray/output.hpp"
#include "grainray/scene.hpp"
#include "process.hpp"

namespace grainray::cli_test {
namespace {

std::vector<std::string> lines(const std::string& text) {
    std::vector<std::string> result;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) result.push_back(line);
    return result;
}

TEST(Run, LeavesEveryFile) {
    const Folder folder;
    folder.write("pair.toml", two_spheres());
    const Result r = folder.grainray({"run", "pair.toml"});
    ASSERT_EQ(r.status, 0) << r.err;
    const fs::path out = "pair-out";
    for (int k = 0; k <= 5; ++k) {
        const Frame frame = read_frame(folder / out / ("frames/00000" + std::to_string(k) + ".vtp"));
        EXPECT_EQ(frame.size(), 2u);
        EXPECT_NEAR(frame.time, 0.004 * k, 1e-9);
    }
    EXPECT_FALSE(fs::exists(folder / out / "frames/000006.vtp"));
    const auto rows = lines(folder.read(out / "history.csv"));
    EXPECT_EQ(rows.size(), 1u + 21u);
    EXPECT_TRUE(rows[0].starts_with("time,kinetic_translation,kinetic_rotation,potential,momentum_x"));
    EXPECT_EQ(read_checkpoint(folder / out / "checkpoint.h5").step, 200u);
    EXPECT_EQ(folder.read(out / "scene.toml"), two_spheres());
}

TEST(Run, SummaryHasEveryField) {
    const Folder folder;
    folder.write("pair.toml", two_spheres());
    ASSERT_EQ(folder.grainray({"run", "pair.toml", "--out", "a/b"}).status, 0);
    const auto s = folder.summary("a/b");
    for (const char* key : {"version", "device", "method", "particles", "steps", "wall_seconds", "steps_per_second", "particle_steps_per_second",
                            "memory_bytes", "max_overlap_ratio", "state_hash", "threads", "title", "time", "status"})
        EXPECT_TRUE(s.contains(key)) << key;
    for (const char* key : {"backend", "reason", "rebuilds", "mean_interval_steps", "mean_neighbors"}) EXPECT_TRUE(s["search"].contains(key)) << key;
    for (const char* key : {"neighbors", "contacts", "boundary", "dynamics", "output"}) EXPECT_TRUE(s["profile"][key].is_number()) << key;
    for (const char* key : {"kinetic", "potential"}) EXPECT_TRUE(s["energy"][key].is_number()) << key;
    EXPECT_EQ(s["status"], "done");
    EXPECT_EQ(s["particles"], 2);
    EXPECT_EQ(s["steps"], 200);
    EXPECT_DOUBLE_EQ(s["time"].get<double>(), 0.02);
    EXPECT_EQ(s["state_hash"].get<std::string>().size(), 18u);
    EXPECT_GT(s["max_overlap_ratio"].get<double>(), 0);
}

TEST(Run, SaysTwoLinesWhereNobodyWatches) {
    const Folder folder;
    folder.write("pair.toml", two_spheres());
    const Result r = folder.grainray({"run", "pair.toml"});
    EXPECT_EQ(r.out, "");
    EXPECT_EQ(lines(r.err).size(), 2u) << r.err;
    EXPECT_EQ(r.err.find('\r'), std::string::npos);
    EXPECT_EQ(folder.grainray({"run", "pair.toml", "--force", "--quiet"}).err, "");
}

TEST(Run, ThreadsAndSearchDoNotChangeTheState) {
    const Folder folder;
    folder.write("bed.toml", bed());
    ASSERT_EQ(folder.grainray({"run", "bed.toml", "--steps", "600", "--threads", "1", "--out", "a"}).status, 0);
    ASSERT_EQ(folder.grainray({"run", "bed.toml", "--steps", "600", "--threads", "3", "--search", "brute", "--out", "b"}).status, 0);
    EXPECT_EQ(folder.summary("a")["state_hash"], folder.summary("b")["state_hash"]);
    EXPECT_EQ(folder.summary("b")["search"]["backend"], "brute");
    EXPECT_EQ(folder.summary("b")["threads"], 3);
}

TEST(Run, ZeroAndOneParticle) {
    const Folder folder;
    folder.write("none.toml", "[simulation]\ndt = 1e-3\nduration = 5.0\n");
    const Result none = folder.grainray({"run", "none.toml"});
    EXPECT_EQ(none.status, 0) << none.err;
    EXPECT_NE(none.err.find("no particles"), std::string::npos) << none.err;
    EXPECT_EQ(folder.summary("none-out")["particles"], 0);
    EXPECT_EQ(folder.summary("none-out")["steps"], 5000);
    EXPECT_EQ(read_frame(folder / "none-out/frames/000001.vtp").size(), 0u);

    folder.write("one.toml", two_spheres());
    const Result one = folder.grainray({"run", "one.toml", "--set", "particles.pair.positions=[[0,0,1]]", "--set", "particles.pair.velocities=[]"});
    EXPECT_EQ(one.status, 0) << one.err;
    EXPECT_EQ(folder.summary("one-out")["particles"], 1);
}

TEST(Run, FolderWithFilesIsRefusedAndForceKeepsStrangers) {
    const Folder folder;
    folder.write("pair.toml", two_spheres());
    ASSERT_EQ(folder.grainray({"run", "pair.toml", "--out", "out"}).status, 0);
    folder.write("out/notes.txt", "mine");
    folder.write("out/frames/overview.txt", "mine too");
    const Result again = folder.grainray({"run", "pair.toml", "--out", "out", "--steps", "40"});
    EXPECT_EQ(again.status, 2);
    for (const char* word : {"not empty", "--out", "--force", "--restart"}) EXPECT_NE(again.err.find(word), std::string::npos) << again.err;
    EXPECT_EQ(folder.summary("out")["steps"], 200);

    ASSERT_EQ(folder.grainray({"run", "pair.toml", "--out", "out", "--steps", "40", "--force"}).status, 0);
    EXPECT_EQ(folder.summary("out")["steps"], 40);
    EXPECT_TRUE(fs::exists(folder / "out/frames/000001.vtp"));
    EXPECT_FALSE(fs::exists(folder / "out/frames/000002.vtp"));
    EXPECT_EQ(folder.read("out/notes.txt"), "mine");
    EXPECT_EQ(folder.read("out/frames/overview.txt"), "mine too");
}

TEST(Run, ForceSparesFilesThatNoRunLeft) {
    const Folder folder;
    folder.write("pair.toml", two_spheres());
    folder.write("data/notes.txt", "mine");
    EXPECT_EQ(folder.grainray({"run", "pair.toml", "--out", "data", "--steps", "2", "--force"}).status, 0);
    for (const char* name : {"a/history.csv", "b/frames/000000.csv", "c/scene.toml"}) {
        folder.write(name, "mine");
        const std::string out = fs::path(name).begin()->string();
        const Result r = folder.grainray({"run", "pair.toml", "--out", out, "--force"});
        EXPECT_EQ(r.status, 2) << r.err;
        EXPECT_NE(r.err.find(name), std::string::npos) << r.err;
        EXPECT_EQ(folder.read(name), "mine");
        EXPECT_FALSE(fs::exists(folder / out / ".lock"));
    }
}

TEST(Run, TwoRunsDoNotShareAFolder) {
    const Folder folder;
    folder.write("bed.toml", bed());
    const pid_t child = folder.start({"run", "bed.toml", "--out", "out"});
    ASSERT_TRUE(wait_for_file(folder / "out/checkpoint.h5", child));
    const Result second = folder.grainray({"run", "bed.toml", "--out", "out", "--force", "--steps", "1"});
    EXPECT_EQ(second.status, 2);
    EXPECT_NE(second.err.find("a run is writing to it"), std::string::npos) << second.err;
    kill(child, SIGKILL);
    folder.finish(child);
    EXPECT_TRUE(fs::exists(folder / "out/.lock"));
    EXPECT_EQ(folder.grainray({"run", "bed.toml", "--out", "out", "--force", "--steps", "1"}).status, 0);
    EXPECT_FALSE(fs::exists(folder / "out/.lock"));
}

TEST(Run, NamesTimesThatAreNoWholeSteps) {
    const Folder folder;
    folder.write("pair.toml", two_spheres());
    const Result r = folder.grainray({"check", "pair.toml", "--set", "simulation.duration=0.02005", "--set", "output.frames=0.00025", "--set", "output.history=1e-5"});
    EXPECT_EQ(r.status, 0) << r.err;
    for (const char* words : {"note         simulation.duration", "note         output.frames", "warning      output.history"})
        EXPECT_NE(r.out.find(words), std::string::npos) << r.out;
}

TEST(Run, SceneCopyStandsByItself) {
    const Folder folder;
    folder.write("scenes/bed.csv", "x,y,z,radius\n0,0,0.5,0.1\n1,0,0.5,0.2\n");
    folder.write("scenes/s.toml", R"(title = "a \"quoted\" title"
[simulation]
dt = 1e-4
duration = 0.01
[materials.zinc]
[materials.amber]
[particles.z]
type = "file"
material = "zinc"
path = "bed.csv"
[particles.a]
type = "list"
material = "amber"
positions = [[0, 1, 0.5]]
radii = "10 cm"
)");
    ASSERT_EQ(folder.grainray({"run", "scenes/s.toml", "--out", "out", "--set", "materials.amber.friction=0.25", "--set", "simulation.dt=0.2 ms"}).status, 0);
    const Scene copy = load_scene(folder / "out/scene.toml");
    EXPECT_EQ(copy.title, "a \"quoted\" title");
    EXPECT_EQ(copy.dt, 2e-4);
    ASSERT_EQ(copy.materials.size(), 2u);
    EXPECT_EQ(copy.materials[0].name, "zinc");
    EXPECT_EQ(copy.materials[1].friction, 0.25);
    EXPECT_EQ(place_particles(copy).size(), 3u);
    EXPECT_EQ(read_checkpoint(folder / "out/checkpoint.h5").scene, folder.read("out/scene.toml"));
    ASSERT_EQ(folder.grainray({"run", "out/scene.toml", "--out", "second"}).status, 0);
    EXPECT_EQ(folder.summary("out")["state_hash"], folder.summary("second")["state_hash"]);
}

}  // namespace
}  // namespace grainray::cli_test
