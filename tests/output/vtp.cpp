#include "common.hpp"

namespace grainray::test {

class Vtp : public OutputTest, public testing::WithParamInterface<const char*> {
protected:
    fs::path write(const Frame& frame, const std::vector<std::string>& fields = {}) const {
        const fs::path path = folder / (std::string("000001.") + GetParam());
        writer_for(GetParam()).write(path, frame, fields);
        return path;
    }
};
INSTANTIATE_TEST_SUITE_P(Formats, Vtp, testing::Values("vtp", "zlib.vtp"),
                         [](const auto& format) { return std::string(format.param) == "vtp" ? "plain" : "compressed"; });

TEST_P(Vtp, ReadsBackToTheSameBits) {
    for (const std::size_t n : {0, 1, 2, 3, 1000, 100000}) {
        SCOPED_TRACE(n);
        const Frame frame = sample_frame(n);
        expect_same(read_frame(write(frame)), frame);
        EXPECT_EQ(files_in(folder), 1u) << "no temporary file stays";
    }
}

TEST_P(Vtp, WritesTheFieldsSelected) {
    const Frame frame = sample_frame(10), read = read_frame(write(frame, {"velocity", "id"}));
    EXPECT_TRUE(same_bits(read.velocity, frame.velocity));
    EXPECT_TRUE(same_bits(read.id, frame.id));
    EXPECT_TRUE(same_bits(read.position, frame.position));
    EXPECT_TRUE(read.radius.empty() && read.mass.empty() && read.coordination.empty());
}

TEST_P(Vtp, LeavesOutFieldsTheFrameLacks) {
    Frame frame = sample_frame(10);
    frame.coordination.clear();
    EXPECT_TRUE(read_frame(write(frame)).coordination.empty());
    EXPECT_TRUE(has(message_of<InputError>([&] { write(frame, {"coordination"}); }), "'coordination'"));
}

TEST_P(Vtp, HasAVertexCellAParticle) {
    const std::string text = slurp(write(sample_frame(5)));
    EXPECT_TRUE(has(text, "NumberOfPoints=\"5\" NumberOfVerts=\"5\""));
    EXPECT_TRUE(has(text, "Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">0.30000000000000004<"));
}

TEST_P(Vtp, UnknownFieldIsNamedAndTheLikelyOneToo) {
    const std::string message = message_of<InputError>([&] { write(sample_frame(1), {"velocty"}); });
    EXPECT_TRUE(has(message, "'velocty'; did you mean 'velocity'?")) << message;
    EXPECT_TRUE(has(message, "contact_force")) << message;
    EXPECT_EQ(files_in(folder), 0u);
}

TEST_P(Vtp, CutAnywhereIsAnErrorOfOneSentence) {
    const fs::path path = write(sample_frame(200));
    const std::string whole = slurp(path);
    for (std::size_t size = 0; size + 1 < whole.size(); size += 1 + whole.size() / 97) {
        spill(path, whole.substr(0, size));
        const std::string message = message_of<InputError>([&] { read_frame(path); });
        ASSERT_TRUE(has(message, path.string())) << size << ": " << message;
    }
}

TEST_P(Vtp, AChangedByteIsAnError) {
    const fs::path path = write(sample_frame(50));
    const std::string whole = slurp(path);
    for (std::size_t i = 0; i + 5 < whole.size(); i += 13) {  // the last bytes close a comment
        std::string damaged = whole;
        damaged[i] = static_cast<char>(damaged[i] ^ 1);
        spill(path, damaged);
        ASSERT_NE(message_of<InputError>([&] { read_frame(path); }), "") << "byte " << i;
    }
}

TEST_P(Vtp, FullDiskKeepsTheOldFile) {
    const Frame old = sample_frame(100);
    const fs::path path = write(old);
    {
        const FileSizeLimit limit(20000);
        const std::string message = message_of<SimulationError>([&] { write(sample_frame(5000)); });
        EXPECT_TRUE(has(message, path.string()) && has(message, "limit")) << message;
    }
    expect_same(read_frame(path), old);
    EXPECT_EQ(files_in(folder), 1u);
}

TEST_F(OutputTest, OtherFilesAreNotFrames) {
    EXPECT_TRUE(has(message_of<InputError>([&] { read_frame(folder / "none.vtp"); }), "no such file"));
    EXPECT_TRUE(has(message_of<InputError>([&] { read_frame(folder / "frame.png"); }), "vtp"));
    fs::create_directory(folder / "folder.vtp");
    EXPECT_TRUE(has(message_of<InputError>([&] { read_frame(folder / "folder.vtp"); }), "folder"));
    for (const std::string text : {"", "hello", "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\"></VTKFile>"}) {
        spill(folder / "other.vtp", text);
        EXPECT_TRUE(has(message_of<InputError>([&] { read_frame(folder / "other.vtp"); }), "not a VTK PolyData")) << text;
    }
}

TEST_F(OutputTest, RegistryListsWhatItKnows) {
    EXPECT_EQ(writer_extensions().front(), "vtp");
    const std::string message = message_of<InputError>([] { writer_for("vtk"); });
    EXPECT_TRUE(has(message, "did you mean 'vtp'?") && has(message, "csv")) << message;
    EXPECT_EQ(frame_fields().size(), 8u);
}

TEST_F(OutputTest, EveryFormatReadsBackWhatItWrites) {
    const Frame frame = sample_frame(20);
    for (const std::string& extension : writer_extensions()) {
        SCOPED_TRACE(extension);
        const fs::path path = folder / ("frame." + extension);
        writer_for(extension).write(path, frame, {});
        expect_same(read_frame(path), frame);
    }
}

}  // namespace grainray::test
