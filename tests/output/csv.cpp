#include "common.hpp"

namespace grainray::test {

class Csv : public OutputTest {
protected:
    fs::path write(const Frame& frame, const std::vector<std::string>& fields = {}) const {
        writer_for("csv").write(folder / "frame.csv", frame, fields);
        return folder / "frame.csv";
    }
    Frame read(const std::string& text) const {
        spill(folder / "frame.csv", text);
        return read_frame(folder / "frame.csv");
    }
    std::string error(const std::string& text) const {
        return message_of<InputError>([&] { read(text); });
    }
};

TEST_F(Csv, ReadsBackToTheSameBits) {
    for (const std::size_t n : {0, 1, 1000, 30000}) {
        SCOPED_TRACE(n);
        expect_same(read_frame(write(sample_frame(n))), sample_frame(n));
    }
    EXPECT_EQ(files_in(folder), 1u);
}

TEST_F(Csv, ColumnsAreAsDocumented) {
    Frame frame = sample_frame(1);
    frame.step = 10;
    frame.time = 0.01;
    frame.position[0] = {1, 2.5, -3};
    const std::string text = slurp(write(frame, {"id"}));
    EXPECT_EQ(text, "# grainray frame: 1 particles, step 10, time 0.01 s, SI units (m, kg, s, N, rad)\nid,x,y,z\n1,1,2.5,-3\n");
    EXPECT_TRUE(has(slurp(write(frame)), "\nid,x,y,z,radius,vx,vy,vz,wx,wy,wz,material,coordination,contact_force,mass\n"));
}

TEST_F(Csv, ReadsTablesOfOtherPrograms) {
    const Frame frame = read("z, y ,x,colour,radius\r\n3,2,1,red,0.5\r\n\r\n6,5,4,blue,0.25");
    ASSERT_EQ(frame.size(), 2u);
    EXPECT_EQ(frame.position[1], (Vec3d{4, 5, 6}));
    EXPECT_EQ(frame.radius, (std::vector<float>{0.5f, 0.25f}));
    EXPECT_TRUE(frame.velocity.empty() && frame.id.empty());
}

TEST_F(Csv, ErrorsNameLineAndColumn) {
    EXPECT_TRUE(has(error("x,y,z\n1,2,three\n"), "line 2: 'three' in column 'z' is not a number"));
    EXPECT_TRUE(has(error("x,y,z\n1,2,3\n1,2\n"), "line 3 has not the 3 values"));
    EXPECT_TRUE(has(error("x,y,z,id\n1,2,3,-4\n"), "'-4' in column 'id'"));
    EXPECT_TRUE(has(error("x,y,radius\n1,2,3\n"), "one of them 'z'"));
    EXPECT_TRUE(has(error(""), "not a CSV file of particles"));
}

TEST_F(Csv, CutAnywhereIsAnError) {
    const fs::path path = write(sample_frame(40));
    const std::string whole = slurp(path);
    const std::size_t first = whole.find('\n') + 1;  // without its first line it is a table as any other
    for (std::size_t size = first; size < whole.size(); size += 7) EXPECT_NE(error(whole.substr(0, size)), "") << size;
    EXPECT_NE(error(whole.substr(0, first - 40)), "");
    const std::size_t row = whole.rfind('\n', whole.size() - 2) + 1;
    EXPECT_TRUE(has(error(whole.substr(0, row)), "39 rows where its first line says 40"));
}

TEST_F(Csv, FullDiskKeepsTheOldFile) {
    const fs::path path = write(sample_frame(10));
    {
        const FileSizeLimit limit(10000);
        EXPECT_NE(message_of<SimulationError>([&] { write(sample_frame(5000)); }), "");
    }
    expect_same(read_frame(path), sample_frame(10));
    EXPECT_EQ(files_in(folder), 1u);
}

}  // namespace grainray::test
