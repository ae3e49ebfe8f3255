// Streams and removals from the command line: files, balance, restart, forecast.
#include <algorithm>
#include <map>
#include <sstream>

#include "grainray/output.hpp"
#include "process.hpp"

namespace grainray::cli_test {
namespace {

/// Rain on a floor whose edge grains roll over; 4000 steps.
std::string rain(const std::string& more = "") {
    return R"(title = "rain"
[simulation]
dt = 2.5e-4
duration = 1.0
[output]
frames = 0.1
history = 0.05
[materials.grain]
normal_stiffness = 2e3
tangential_stiffness = 1e3
[streams.rain]
type = "box"
material = "grain"
rate = 400
lower = [0, 0, 0.6]
upper = [0.4, 0.4, 0.9]
velocity = [1, 0, -1]
velocity_spread = [0.3, 0.3, 0.3]
size = "uniform"
radius_minimum = 0.03
radius_maximum = 0.05
[removals."over, the edge"]
type = "half_space"
point = [0.8, 0, 0]
normal = [1, 0, 0]
steps = 40
[planes]
floor = { material = "grain" }
)" + more;
}

/// Columns by name.
std::map<std::string, std::vector<std::string>> table(const std::string& text) {
    std::map<std::string, std::vector<std::string>> columns;
    std::vector<std::string> names;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
        std::istringstream cells(line);
        std::size_t k = 0;
        const bool header = names.empty();
        for (std::string cell; std::getline(cells, cell, ','); ++k)
            if (header) names.push_back(cell);
            else columns[names.at(k)].push_back(cell);
    }
    return columns;
}

TEST(Streams, LeaveTheirBalanceInEveryFile) {
    const Folder folder;
    folder.write("rain.toml", rain());
    const Result r = folder.grainray({"run", "rain.toml", "--out", "out"});
    ASSERT_EQ(r.status, 0) << r.err;
    const auto summary = folder.summary("out");
    const int inserted = summary["particles_inserted"], removed = summary["particles_removed"], there = summary["particles"];
    EXPECT_GT(inserted, 250);
    EXPECT_GT(removed, 30);
    EXPECT_EQ(inserted - removed, there);
    EXPECT_EQ(summary["streams"]["rain"]["inserted"], inserted);
    EXPECT_EQ(summary["removals"]["over, the edge"]["removed"], removed);
    EXPECT_GT(summary["profile"]["insertion"].get<double>(), 0);
    const auto history = table(folder.read("out/history.csv")), list = table(folder.read("out/removed.csv"));
    EXPECT_EQ(std::stoi(history.at("inserted").back()), inserted);
    EXPECT_EQ(std::stoi(history.at("removed").back()), removed);
    for (std::size_t k = 0; k < history.at("time").size(); ++k)
        EXPECT_EQ(std::stoi(history.at("inserted")[k]) - std::stoi(history.at("removed")[k]), std::stoi(history.at("particles")[k]));
    ASSERT_EQ(list.at("id").size(), static_cast<std::size_t>(removed));
    EXPECT_EQ(list.at("removal")[0], "over_ the edge");
    for (std::size_t k = 0; k < list.at("id").size(); ++k) {
        EXPECT_EQ(std::stoi(list.at("step")[k]) % 40, 0);
        EXPECT_GT(std::stod(list.at("x")[k]), 0.8);
        EXPECT_GE(std::stod(list.at("radius")[k]), 0.03 - 1e-7);
    }
    EXPECT_EQ(read_frame(folder / "out/frames/000010.vtp").size(), static_cast<std::size_t>(there));
    EXPECT_NE(r.err.find(std::to_string(inserted) + " inserted"), std::string::npos) << r.err;
}

TEST(Streams, ARestartIsExactInEveryFile) {
    const Folder folder;
    folder.write("rain.toml", rain());
    ASSERT_EQ(folder.grainray({"run", "rain.toml", "--out", "whole", "--threads", "1"}).status, 0);
    ASSERT_EQ(folder.grainray({"run", "rain.toml", "--out", "half", "--steps", "2200", "--set", "output.checkpoints=0.55"}).status, 0);
    const Result r = folder.grainray({"run", "half/scene.toml", "--restart", "half/checkpoint.h5", "--out", "half"});
    ASSERT_EQ(r.status, 0) << r.err;
    EXPECT_EQ(folder.summary("half")["state_hash"], folder.summary("whole")["state_hash"]);
    for (const char* key : {"particles_inserted", "particles_removed", "streams", "removals"}) EXPECT_EQ(folder.summary("half")[key], folder.summary("whole")[key]) << key;
    EXPECT_EQ(folder.read("half/removed.csv"), folder.read("whole/removed.csv"));
    EXPECT_EQ(table(folder.read("half/history.csv")).at("waiting"), table(folder.read("whole/history.csv")).at("waiting"));

    const auto restart = [&](const std::string& setting) {
        return folder.grainray({"run", "rain.toml", "--restart", "half/checkpoint.h5", "--out", "other", "--force", "--steps", "100", "--set", setting});
    };
    const Result rate = restart("streams.rain.rate=500");
    EXPECT_EQ(rate.status, 2);
    EXPECT_NE(rate.err.find("streams.rain.rate, which cannot change on the way"), std::string::npos) << rate.err;
    const Result stop = restart("streams.rain.stop=1.01");
    EXPECT_EQ(stop.status, 0) << stop.err;
    EXPECT_NE(stop.err.find("is another than in the checkpoint: streams.rain.stop"), std::string::npos) << stop.err;
    folder.write("more.toml", rain("[streams.more]\ntype = \"box\"\nmaterial = \"grain\"\nrate = 100\nlower = [0, 0, 2]\nupper = [0.4, 0.4, 2.2]\nvelocity = [0, 0, -2]\nradius = 0.04\n"));
    const Result more = folder.grainray({"run", "more.toml", "--restart", "half/checkpoint.h5", "--out", "more", "--steps", "2000"});
    EXPECT_EQ(more.status, 0) << more.err;
    EXPECT_GE(folder.summary("more")["streams"]["more"]["inserted"].get<int>(), 40);
    EXPECT_LE(folder.summary("more")["streams"]["more"]["inserted"].get<int>(), 50);
}

TEST(Streams, CheckForecastsWhatComes) {
    const Folder folder;
    folder.write("rain.toml", rain());
    const Result r = folder.grainray({"check", "rain.toml", "--set", "streams.rain.rate=200"});
    EXPECT_EQ(r.status, 0) << r.err;
    for (const char* words : {"stream       rain: 200 particles of material grain a second", "; 200 particles, ", "removal      over, the edge: looks every 40 steps",
                              "at the end   200 particles less those taken out", "verdict      ok"})
        EXPECT_NE(r.out.find(words), std::string::npos) << words << " not in " << r.out;
    const Result dense = folder.grainray({"check", "rain.toml", "--set", "streams.rain.rate=500 t/h", "--set", "streams.rain.interval=0.5"});
    EXPECT_NE(dense.out.find("of the inlet's volume would be solid"), std::string::npos) << dense.out;
    EXPECT_NE(dense.out.find("streams.rain inserts every 0.5 s"), std::string::npos) << dense.out;
    const Result eaten = folder.grainray({"check", "rain.toml", "--set", "removals.all={type=\"box\", lower=[-1,-1,0], upper=[1,1,1]}"});
    EXPECT_EQ(eaten.status, 2);
    EXPECT_NE(eaten.err.find("removals.all takes out everything that streams.rain inserts"), std::string::npos) << eaten.err;
    const Result fast = folder.grainray({"run", "rain.toml", "--set", "streams.rain.velocity=[0,0,-1000]"});
    EXPECT_EQ(fast.status, 2);
    EXPECT_NE(fast.err.find("streams.rain.velocity: particles come at up to 1001 m/s"), std::string::npos) << fast.err;
}

TEST(Streams, SurfacesAreReadFromFiles) {
    const Folder folder;
    folder.write("scenes/mouth.obj", "v 0 0 0.9\nv 0.4 0 0.9\nv 0.4 0.4 0.9\nv 0 0.4 0.9\nf 1 2 3\nf 1 3 4\n");
    std::string text = rain();
    const std::string box = "type = \"box\"\nmaterial = \"grain\"\nrate = 400\nlower = [0, 0, 0.6]\nupper = [0.4, 0.4, 0.9]\n";
    text.replace(text.find(box), box.size(), "type = \"surface\"\nmaterial = \"grain\"\nrate = 400\nfile = \"mouth.obj\"\ndepth = 0.3\n");
    folder.write("scenes/rain.toml", text);
    ASSERT_EQ(folder.grainray({"run", "scenes/rain.toml", "--out", "out"}).status, 0);
    EXPECT_GT(folder.summary("out")["particles_inserted"].get<int>(), 100);
    ASSERT_EQ(folder.grainray({"run", "out/scene.toml", "--out", "again"}).status, 0);  // its path leads there from anywhere
    EXPECT_EQ(folder.summary("again")["state_hash"], folder.summary("out")["state_hash"]);
    const Result missing = folder.grainray({"check", "scenes/rain.toml", "--set", "streams.rain.file=nowhere.stl"});
    EXPECT_EQ(missing.status, 2);
    EXPECT_NE(missing.err.find("key 'streams.rain.file' = \"nowhere.stl\""), std::string::npos) << missing.err;
}

}  // namespace
}  // namespace grainray::cli_test
