// info, render, bench: that they answer, and that their figures hang together.
#include <sys/wait.h>

#include <cstdlib>

#include "grainray/output.hpp"
#include "folders.hpp"
#include "process.hpp"

namespace grainray::cli_test {
namespace {

TEST(Info, NamesDevicesAndBackEnds) {
    const Folder folder;
    const Result r = folder.grainray({"info"});
    ASSERT_EQ(r.status, 0) << r.err;
    for (const char* word : {"device cpu", "threads", "device cuda", "search brute", "search cells", "search rays", "Embree", "oneTBB"})
        EXPECT_NE(r.out.find(word), std::string::npos) << "no '" << word << "' in\n" << r.out;
    EXPECT_NE(folder.grainray({"info", "--schema"}).out.find("normal_stiffness"), std::string::npos);
}

TEST(Output, ThatIsLostIsAFailure) {
    const Folder folder;
    folder.write("pair.toml", two_spheres());
    for (const std::string words : {"info", "info --schema", "check pair.toml", "--help"}) {
        const std::string command = "cd " + (folder / "").string() + " && " + (test::program_folder() / "grainray").string() + ' ' + words + " > /dev/full 2> err.txt";
        EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 1) << words;
        EXPECT_TRUE(folder.read("err.txt").starts_with("grainray: ")) << words;
    }
}

TEST(Render, FrameFolderAndMistakes) {
    const Folder folder;
    folder.write("pair.toml", two_spheres());
    ASSERT_EQ(folder.grainray({"run", "pair.toml", "--out", "out"}).status, 0);
    const Result one = folder.grainray({"render", "out/frames/000002.vtp", "--size", "64x48", "--color-by", "radius", "--out", "one.png"});
    EXPECT_EQ(one.status, 0) << one.err;
    EXPECT_EQ(folder.read("one.png").substr(1, 3), "PNG");
    const Result all = folder.grainray({"render", "out", "--size", "64x48", "--eye", "-1,-1,1", "--target", "0,0,0", "--min", "0", "--max", "1"});
    EXPECT_EQ(all.status, 0) << all.err;
    EXPECT_TRUE(fs::exists(folder / "out/pictures/000000.png"));
    EXPECT_TRUE(fs::exists(folder / "out/pictures/000005.png"));
    for (const Arguments& wrong : std::vector<Arguments>{{"--size", "64"}, {"--eye", "1,2"}, {"--min", "1", "--max", "0"}, {"--color-by", "colour"}, {"--out", "a.jpg"}, {"--fov", "190"},
                                                                {"--min", "nan"}, {"--max", "inf"}, {"--eye", "1e20,0,0"}, {"--eye", "1e300,0,0"}, {"--target", "1e300,0,0"}}) {
        Arguments arguments{"render", "out/frames/000002.vtp"};
        arguments.insert(arguments.end(), wrong.begin(), wrong.end());
        const Result r = folder.grainray(arguments);
        EXPECT_EQ(r.status, 2) << wrong[0];
        const bool vector = wrong[1].find("e") != std::string::npos && wrong[1].find(",0") != std::string::npos;
        EXPECT_NE(r.err.find(vector ? wrong[0] : wrong[1]), std::string::npos) << r.err;
    }
    fs::copy(folder / "out/frames/000002.vtp", folder / "lone.vtp");
    EXPECT_NE(folder.grainray({"render", "lone.vtp"}).err.find("--scene"), std::string::npos);
    EXPECT_EQ(folder.grainray({"render", "lone.vtp", "--scene", "pair.toml", "--size", "16x16"}).status, 0);
    EXPECT_TRUE(fs::exists(folder / "lone.png"));
}

TEST(Bench, StepsOfTheColumn) {
    const Folder folder;
    const Result r = folder.grainray({"bench", "step", "--scene", "collapse", "--steps", "20", "--warmup", "5", "--json", "step.json"});
    ASSERT_EQ(r.status, 0) << r.err;
    for (const char* word : {"neighbors", "contacts", "boundary", "dynamics", "share"}) EXPECT_NE(r.out.find(word), std::string::npos) << r.out;
    const auto json = nlohmann::json::parse(folder.read("step.json"));
    EXPECT_EQ(json["particles"], 20160);
    EXPECT_EQ(json["steps"], 20);
    EXPECT_NEAR(json["particle_steps_per_second"].get<double>(), 20160 * 20 / json["wall_seconds"].get<double>(), 1);
    for (const char* key : {"steps_per_second", "threads", "device", "profile", "search", "bytes_per_particle", "peak_rss_bytes"})
        EXPECT_TRUE(json.contains(key)) << key;
}

TEST(Bench, StepsFromAFileOfPositions) {
    const Folder folder;
    folder.write("start.csv", "x,y,z,radius\n0.5,0.5,0.1,0.1\n0.5,0.5,0.29,0.1\n0.9,0.5,0.1,0.1\n");
    const Result r = folder.grainray({"bench", "step", "--scene", "settled", "--init", "start.csv", "--steps", "10", "--json", "a.json"});
    ASSERT_EQ(r.status, 0) << r.err;
    EXPECT_EQ(nlohmann::json::parse(folder.read("a.json"))["particles"], 3);
}

TEST(Bench, BackEndsFindTheSameNumberOfNeighboursInEveryCloud) {
    const Folder folder;
    const Result r = folder.grainray({"bench", "neighbors", "--points", "1000,2000", "--cloud", "all", "--ratio", "1,16", "--backend", "all", "--kind", "full",
                                      "--seconds", "0.01", "--device", "cpu", "--machine", "mine", "--json", "n.json"});
    ASSERT_EQ(r.status, 0) << r.err;
    const auto json = nlohmann::json::parse(folder.read("n.json"));
    EXPECT_EQ(json["machine"]["name"], "mine");
    const auto& results = json["results"];
    const std::size_t backends = json["machine"]["backends"].size();
    ASSERT_EQ(results.size(), 2 * (4 + 2 * 2) * backends);  // two sizes; four clouds of one reach, two of two ratios
    for (std::size_t i = 0; i < results.size(); ++i) {
        const auto &row = results[i], &first = results[i / backends * backends];
        for (const char* key : {"cloud", "ratio", "points", "list_entries"}) EXPECT_EQ(row[key], first[key]) << row;
        EXPECT_GT(row["neighbors_per_point"].get<double>(), 4) << row;
        EXPECT_LT(row["neighbors_per_point"].get<double>(), 14) << row;
        EXPECT_GE(row["milliseconds"], row["milliseconds_min"]) << row;
        EXPECT_GT(row["milliseconds_build"].get<double>(), 0) << row;
    }
}

}  // namespace
}  // namespace grainray::cli_test
