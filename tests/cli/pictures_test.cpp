// grainray render as film and sheet, grainray deposit: files that appear, what is said, mistakes.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "grainray/output.hpp"
#include "process.hpp"

namespace grainray::cli_test {
namespace {

/// PATH for the time of a test.
class SearchPath {
public:
    explicit SearchPath(const std::string& path) : before_(std::getenv("PATH")) { setenv("PATH", path.c_str(), 1); }
    ~SearchPath() { setenv("PATH", before_.c_str(), 1); }

private:
    std::string before_;
};

/// Writes what it was told and what it was given to files beside it.
void write_fake_ffmpeg(const Folder& folder, const std::string& last_line) {
    folder.write("ffmpeg", "#!/bin/sh\nhere=" + (folder / "").string() + "\necho \"$@\" > ${here}arguments\n/bin/cat > ${here}pixels\nfor last; do :; done\n" + last_line + "\n");
    fs::permissions(folder / "ffmpeg", fs::perms::owner_all);
}

void run_pair(const Folder& folder) {
    folder.write("pair.toml", two_spheres());
    ASSERT_EQ(folder.grainray({"run", "pair.toml", "--out", "out"}).status, 0);
}

bool says(const Result& r, const std::string& words) { return (r.out + r.err).find(words) != std::string::npos; }

TEST(Movie, WithoutFfmpegLeavesPictures) {
    const Folder folder;
    run_pair(folder);
    const SearchPath nowhere("/nowhere");
    const Result r = folder.grainray({"render", "out", "--movie", "film/pair.mp4", "--size", "64x48", "--fps", "10"});
    ASSERT_EQ(r.status, 0) << r.err;
    for (const char* name : {"000000.png", "000005.png"}) EXPECT_EQ(folder.read(fs::path("film/pair") / name).substr(1, 3), "PNG") << name;
    EXPECT_FALSE(fs::exists(folder / "film/pair.mp4"));
    EXPECT_TRUE(says(r, "ffmpeg -framerate 10 -i film/pair/%06d.png")) << r.out;
    EXPECT_TRUE(says(r, "coloured from 0 to")) << r.out;
}

TEST(Movie, GivesFfmpegEveryPicture) {
    const Folder folder;
    run_pair(folder);
    write_fake_ffmpeg(folder, "echo film > $last");
    const SearchPath path((folder / "").string());
    const Result r = folder.grainray({"render", "out", "--movie", "pair.mp4", "--size", "64x48", "--fps", "10"});
    ASSERT_EQ(r.status, 0) << r.err;
    EXPECT_EQ(folder.read("pair.mp4"), "film\n");
    EXPECT_EQ(fs::file_size(folder / "pixels"), 6u * 64 * 48 * 3);
    const std::string arguments = folder.read("arguments");
    for (const char* word : {"-video_size 64x48", "-framerate 10", "-pixel_format rgb24", "-pix_fmt yuv420p"}) EXPECT_NE(arguments.find(word), std::string::npos) << arguments;
    EXPECT_TRUE(says(r, "pair.mp4: 6 frames, 10 a second, one camera")) << r.out;
}

TEST(Movie, ThatFfmpegCannotMakeIsAFailure) {
    const Folder folder;
    run_pair(folder);
    write_fake_ffmpeg(folder, "echo no such encoder >&2; exit 3");
    const SearchPath path((folder / "").string());
    const Result r = folder.grainray({"render", "out", "--movie", "pair.mp4", "--size", "64x48"});
    EXPECT_EQ(r.status, 1);
    EXPECT_TRUE(says(r, "no such encoder")) << r.err;
    EXPECT_FALSE(fs::exists(folder / "pair.mp4"));
    EXPECT_FALSE(fs::exists(folder / "pair.part.mp4"));
}

TEST(Sheet, OfTimesAndByDefault) {
    const Folder folder;
    run_pair(folder);
    const Result r = folder.grainray({"render", "out", "--sheet", "two.png", "--times", "0,0.02", "--size", "320x200"});
    ASSERT_EQ(r.status, 0) << r.err;
    EXPECT_TRUE(says(r, "two.png: 2 snapshots, one camera")) << r.out;
    EXPECT_EQ(folder.read("two.png").substr(1, 3), "PNG");
    EXPECT_TRUE(says(folder.grainray({"render", "out", "--sheet", "six.png", "--size", "64x48"}), "6 snapshots"));
}

TEST(Sheet, MistakesAreOneSentence) {
    const Folder folder;
    run_pair(folder);
    struct Case {
        Arguments arguments;
        std::string word;
    };
    for (const Case& c : std::vector<Case>{{{"out", "--sheet", "a.png", "--times", "0,99"}, "99 s is outside of the run"},
                                           {{"out", "--sheet", "a.png", "--times", "nan"}, "outside of the run"},
                                           {{"out", "--times", "0"}, "--sheet"},
                                           {{"out", "--fps", "5"}, "--movie"},
                                           {{"out", "--movie", "a.txt"}, ".mp4"},
                                           {{"out", "--movie", "a.mp4", "--fps", "0"}, "frames a second"},
                                           {{"out", "--movie", "a.mp4", "--out", "b"}, "--out"},
                                           {{"out/frames/000001.vtp", "--movie", "a.mp4"}, "folder of a run"},
                                           {{"absent", "--sheet", "a.png"}, "absent"},
                                           {{"out", "--sheet", "a.jpg"}, ".png"},
                                           {{"out", "--mesh-opacity", "2"}, "--mesh-opacity"},
                                           {{"out", "--cut", "0,0,0"}, "--cut"},
                                           {{"out", "--color-by", "depth", "--set-nothing"}, "--set-nothing"}}) {
        Arguments arguments{"render"};
        arguments.insert(arguments.end(), c.arguments.begin(), c.arguments.end());
        const Result r = folder.grainray(arguments);
        EXPECT_EQ(r.status, 2) << c.word;
        EXPECT_TRUE(says(r, c.word)) << r.err;
        EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
    }
}

/// A slide of 200 particles on the synthetic flume; 2 s.
void run_slide(const Folder& folder) {
    ASSERT_EQ(folder.grainray({"terrain", "flume", "--out", "flume", "--cell", "10"}).status, 0);
    fs::copy(fs::path(GRAINRAY_SOURCE_DIR) / "examples/debris_flow.toml", folder / "slide.toml");
    const Result r = folder.grainray({"run", "slide.toml", "--out", "slide", "--device", "cpu", "--set", "particles.slide.count=200", "--set", "simulation.duration=2"});
    ASSERT_EQ(r.status, 0) << r.err;
}

TEST(Deposit, MapsOfARunAndItsProfile) {
    const Folder folder;
    run_slide(folder);
    const Result r = folder.grainray({"deposit", "slide", "--out", "maps/slide", "--profile", "maps/profile.csv", "--times", "0,1,2"});
    ASSERT_EQ(r.status, 0) << r.err;
    const auto json = nlohmann::json::parse(folder.read("maps/slide.json"));
    EXPECT_EQ(json["time"], 2.0);
    EXPECT_GT(json["runout"], 0);
    EXPECT_GT(json["axis"]["direction"][0], 0.99);  // the channel runs along x

    // The depth map holds the volume of the grains, in the cells of the terrain.
    const Frame last = read_frame(folder / "slide/frames/000002.vtp");
    double volume = 0;
    for (const float radius : last.radius) volume += 4.0 / 3 * M_PI * std::pow(static_cast<double>(radius), 3);
    std::istringstream in(folder.read("maps/slide_depth.asc")), ground(folder.read("flume_after.asc"));
    std::string word, same;
    for (int k = 0; k < 12; ++k) {
        in >> word;
        ground >> same;
        EXPECT_EQ(word, same);  // the header
    }
    double depth = 0;
    for (double v; in >> v;) depth += v;
    EXPECT_NEAR(depth * 100 * 0.6, volume, 1e-4 * volume);
    EXPECT_NEAR(json["solid_volume"], volume, 1e-6 * volume);
    for (const char* name : {"maps/slide_top.asc", "maps/slide_speed.asc"}) EXPECT_TRUE(fs::exists(folder / name)) << name;
    const std::string profile = folder.read("maps/profile.csv");
    for (const char* start : {"time,distance,depth", "\n0,", "\n1,", "\n2,"}) EXPECT_NE(profile.find(start), std::string::npos) << start;
    EXPECT_EQ(folder.grainray({"render", "slide", "--sheet", "slide.png", "--size", "160x96", "--color-by", "depth"}).status, 0);
}

TEST(Deposit, MistakesAreOneSentence) {
    const Folder folder;
    run_slide(folder);
    run_pair(folder);
    for (const auto& [arguments, word] : std::vector<std::pair<Arguments, std::string>>{{{"absent"}, "absent"},
                                                                                       {{"out"}, "no terrain"},
                                                                                       {{"slide", "--terrain", "absent.asc"}, "absent.asc"},
                                                                                       {{"slide", "--times", "1"}, "--profile"},
                                                                                       {{"slide", "--profile", "p.csv", "--times", "7"}, "7 s is outside"},
                                                                                       {{"slide", "--solid-fraction", "0"}, "solid fraction"},
                                                                                       {{"slide", "--cell", "1e9"}, "1000000000"},
                                                                                       {{"slide", "--profile", "p.csv", "--bin", "0"}, "bins of 0"},
                                                                                       {{"slide", "--axis", "0,0,0"}, "direction"}}) {
        Arguments all{"deposit"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        const Result r = folder.grainray(all);
        EXPECT_EQ(r.status, 2) << word;
        EXPECT_TRUE(says(r, word)) << r.err;
        EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
    }
    fs::remove(folder / "flume_after.asc");
    const Result r = folder.grainray({"render", "slide/frames/000000.vtp", "--size", "64x48"});
    EXPECT_EQ(r.status, 2);
    EXPECT_TRUE(says(r, "flume_after.asc")) << r.err;
}

}  // namespace
}  // namespace grainray::cli_test
