// Bad meshes and terrain: one clear sentence each, with the key, what is wrong and what to do.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "grainray/simulation.hpp"
#include "meshes.hpp"
#include "surfaces/surfaces.hpp"

namespace grainray::test {
namespace {

namespace fs = std::filesystem;

const std::string head = "[simulation]\ndt = 1e-3\nduration = 1\n[materials.rock]\n";
const std::string grid = "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 10\nNODATA_value -9999\n";
const std::string flat = grid + "1 1 1 1 1 1 1 1 1\n", bump = grid + "1 1 1 1 9 1 1 1 1\n", dent = grid + "1 1 1 1 -9 1 1 1 1\n";
const std::string square_stl = "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\nendfacet\n"
                               "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid s\n";
const std::string release = "[particles.slide]\ntype = \"release\"\nmaterial = \"rock\"\nspacing = 1\n";

struct Bad {
    std::string name;
    std::vector<std::pair<std::string, std::string>> files;
    std::string scene;  ///< below head
    std::vector<std::string> expected;
};
void PrintTo(const Bad& bad, std::ostream* out) { *out << bad.name; }

std::string terrain(const std::string& more = "") { return "[terrain]\nmaterial = \"rock\"\nafter = \"a.asc\"\n" + more; }
std::string both(const std::string& more = release) { return terrain("before = \"b.asc\"\n" + more); }
std::string mesh(const std::string& file, const std::string& more = "") { return "[meshes.m]\nmaterial = \"rock\"\nfile = \"" + file + "\"\n" + more; }

const std::vector<Bad> bads{
    {"no_grid", {}, terrain(), {"terrain.after", "a.asc", "is not there"}},
    {"not_a_grid", {{"a.asc", "hello world\n"}}, terrain(), {"terrain.after", "ESRI ASCII"}},
    {"cut_off_grid", {{"a.asc", grid + "1 1 1 1 1\n"}}, terrain(), {"a.asc:", "ends after 1 of 3 rows", "cut off"}},
    {"long_grid", {{"a.asc", flat + "7\n"}}, terrain(), {"more heights than ncols x nrows"}},
    {"decimal_comma", {{"a.asc", grid + "1 1 1 1 1,5 1 1 1 1\n"}}, terrain(), {"a.asc:7", "'1,5' is not a number", "with a point"}},
    {"no_cellsize", {{"a.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\n1 1 1 1\n"}}, terrain(), {"no 'cellsize'"}},
    {"one_column", {{"a.asc", "ncols 1\nnrows 4\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 1 1 1\n"}}, terrain(), {"1 columns by 4 rows"}},
    {"all_holes", {{"a.asc", grid + "-9999 -9999 -9999 -9999 -9999 -9999 -9999 -9999 -9999\n"}}, terrain(), {"every node is a hole"}},
    {"hole_not_marked", {{"a.asc", grid + "1 1 1 1 -3.4e38 1 1 1 1\n"}}, terrain(), {"column 2, row 2", "NODATA_value"}},
    {"other_cells", {{"a.asc", flat}, {"b.asc", "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 5\n1 1 1 1 9 1 1 1 1\n"}}, both(), {"terrain.before", "5 x 5", "10 x 10", "resample"}},
    {"other_place", {{"a.asc", flat}, {"b.asc", "ncols 3\nnrows 3\nxllcorner 10\nyllcorner 0\ncellsize 10\n1 1 1 1 9 1 1 1 1\n"}}, both(), {"terrain.before", "same nodes"}},
    {"swapped", {{"a.asc", bump}, {"b.asc", flat}}, both(), {"terrain.before", "exchange the two files"}},
    {"no_volume", {{"a.asc", flat}, {"b.asc", flat}}, both(), {"no volume to fill"}},
    {"wide_spacing", {{"a.asc", flat}, {"b.asc", bump}}, both("[particles.slide]\ntype = \"release\"\nmaterial = \"rock\"\nspacing = 500\n"), {"particles.slide", "smaller spacing"}},
    {"release_without_terrain", {}, release, {"scene.toml:", "particles.slide.type", "[terrain]"}},
    {"release_without_before", {{"a.asc", flat}}, terrain(release), {"particles.slide.type", "terrain.before"}},
    {"release_two_goals", {}, terrain(release + "count = 5\n"), {"not both"}},
    {"layer_without_thickness", {}, terrain(release + "polygon = \"p.csv\"\n"), {"add 'thickness'"}},
    {"polygon_outside", {{"a.asc", flat}, {"p.csv", "x,y\n1000,1000\n1010,1000\n1010,1010\n"}}, terrain(release + "polygon = \"p.csv\"\nthickness = 2\n"), {"particles.slide.polygon", "inside the terrain"}},
    {"polygon_of_two", {{"a.asc", flat}, {"p.csv", "x,y\n1,1\n2,2\n"}}, terrain(release + "polygon = \"p.csv\"\nthickness = 2\n"), {"at least three corners"}},
    {"polygon_not_json", {{"a.asc", flat}, {"p.csv", "{ \"type\": "}}, terrain(release + "polygon = \"p.csv\"\nthickness = 2\n"), {"not valid GeoJSON"}},
    {"jitter_too_wide", {}, terrain(release + "jitter = 2\n"), {"particles.slide.jitter", "less than the spacing"}},
    {"terrain_key", {}, terrain("befor = \"x\"\n"), {"did you mean 'before'?"}},
    {"terrain_material", {}, "[terrain]\nmaterial = \"stone\"\nafter = \"a.asc\"\n", {"unknown material 'stone'"}},
    {"terrain_periodic", {}, terrain("[domain]\nperiodic = [true, false, false]\nlower = [0, 0, 0]\nupper = [9, 9, 9]\n"), {"periodic axis", "domain.periodic"}},
    {"smooth_zero", {}, terrain("smooth = 0\n"), {"terrain.smooth", "at least 1"}},
    {"no_mesh", {}, mesh("m.stl"), {"meshes.m.file", "is not there"}},
    {"mesh_format", {{"m.step", "ISO"}}, mesh("m.step"), {"STL and OBJ"}},
    {"mesh_without_triangle", {{"m.stl", "solid empty\nendsolid empty\n"}}, mesh("m.stl"), {"holds no triangle"}},
    {"mesh_binary_empty", {{"m.stl", std::string(84, '\0')}}, mesh("m.stl"), {"holds no triangle"}},
    {"mesh_cut_off", {{"m.stl", std::string(80, ' ') + std::string("\x05\0\0\0", 4) + std::string(60, '\0')}}, mesh("m.stl"), {"cut off", "5 triangles"}},
    {"mesh_flat_triangle", {{"m.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"}}, mesh("m.obj"), {"no triangle with an area"}},
    {"mesh_scale", {}, mesh("m.stl", "scale = 0\n"), {"meshes.m.scale", "greater than 0"}},
    {"mesh_key", {}, mesh("m.stl", "sclae = 1\n"), {"did you mean 'scale'?"}},
    {"path_missing", {}, mesh("m.stl", "motion.path = \"way.csv\"\n"), {"meshes.m.motion.path", "cannot be read"}},
    {"path_columns", {{"way.csv", "time,x,y,z\n0,0,0,0\n"}}, mesh("m.stl", "motion.path = \"way.csv\"\n"), {"no column 't'"}},
    {"path_back_in_time", {{"way.csv", "t,x,y,z\n0,0,0,0\n1,0,0,1\n1,0,0,2\n"}}, mesh("m.stl", "motion.path = \"way.csv\"\n"), {"way.csv:4", "greater than in the row before"}},
};

class BadSurfaces : public ::testing::TestWithParam<Bad> {};

TEST_P(BadSurfaces, OneSentence) {
    const Bad& bad = GetParam();
    const fs::path folder = fs::temp_directory_path() / ("grainray_bad_" + bad.name + std::to_string(::getpid()));
    fs::create_directories(folder);
    for (const auto& [name, text] : bad.files) std::ofstream(folder / name, std::ios::binary) << text;
    std::string message;
    try {
        const Scene scene = parse_scene(head + bad.scene, (folder / "scene.toml").string());
        Simulation(scene, place_particles(scene));
    } catch (const InputError& e) {
        message = e.what();
    }
    EXPECT_FALSE(message.empty());
    for (const auto& part : bad.expected) EXPECT_NE(message.find(part), std::string::npos) << "no '" << part << "' in: " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    fs::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(All, BadSurfaces, ::testing::ValuesIn(bads), [](const auto& one) { return one.param.name; });

TEST(MeshFile, TextAndBinaryAndObjAreOneMesh) {
    const fs::path folder = fs::temp_directory_path() / ("grainray_mesh_" + std::to_string(::getpid()));
    fs::create_directories(folder);
    std::ofstream(folder / "t.stl") << square_stl;
    std::ofstream(folder / "o.obj") << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
    std::string binary(80, ' ');
    const auto put = [&](const auto& value) { binary.append(reinterpret_cast<const char*>(&value), sizeof value); };
    put(std::uint32_t{2});
    for (const auto& t : std::array<std::array<float, 12>, 2>{{{0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 1, 0}, {0, 0, 1, 0, 0, 0, 1, 1, 0, 0, 1, 0}}}) put(t), put(std::uint16_t{0});
    std::ofstream(folder / "b.stl", std::ios::binary) << binary;
    for (const char* name : {"t.stl", "o.obj", "b.stl"}) {
        MeshReport r;
        const TriangleMesh m = surfaces::clean(surfaces::read_mesh_file(folder / name, ""), r);
        EXPECT_EQ(r.triangles, 2u) << name;
        EXPECT_EQ(r.vertices, 4u) << name;
        EXPECT_EQ(r.free_edges, 4u) << name;
        EXPECT_EQ(r.reversed, 0u) << name;
        EXPECT_DOUBLE_EQ(r.area, 1) << name;
    }
    fs::remove_all(folder);
}

TEST(MeshReport, SaysWhatIsOdd) {
    TriangleMesh m = box({0, 0, 0}, {1, 1, 1}, 4);
    std::swap(m.triangles[5][0], m.triangles[5][1]);
    std::swap(m.triangles[60][0], m.triangles[60][1]);
    m.triangles.push_back(m.triangles[7]);
    m.triangles.push_back({m.triangles[9][0], m.triangles[9][1], m.triangles[9][1]});
    MeshReport r;
    const TriangleMesh closed = surfaces::clean(m, r);
    EXPECT_EQ(r.triangles, 192u);
    EXPECT_EQ(r.duplicates, 1u);
    EXPECT_EQ(r.degenerate, 1u);
    EXPECT_EQ(r.reversed, 2u);
    EXPECT_EQ(r.free_edges, 0u);
    EXPECT_EQ(r.parts, 1u);
    EXPECT_DOUBLE_EQ(r.area, 6);
    MeshReport again;
    surfaces::clean(closed, again);
    EXPECT_EQ(again.reversed, 0u);
    EXPECT_EQ(again.duplicates + again.degenerate, 0u);
    TriangleMesh splinter{{{0, 0, 0}, {1, 0, 0}, {0.5, 1e-5, 0}}, {{0, 1, 2}}};
    surfaces::clean(splinter, r);
    EXPECT_EQ(r.slivers, 1u);
}

}  // namespace
}  // namespace grainray::test
