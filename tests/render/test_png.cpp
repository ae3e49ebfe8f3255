// PNG files: what was written is read back, and failures leave nothing behind.
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <png.h>

#include "pictures.hpp"

using namespace grainray;
namespace fs = std::filesystem;

namespace {

Image read_png(const fs::path& path) {
    png_image head{};
    head.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_file(&head, path.c_str())) throw std::runtime_error(head.message);
    head.format = PNG_FORMAT_RGB;
    Image image{static_cast<int>(head.width), static_cast<int>(head.height), std::vector<std::uint8_t>(PNG_IMAGE_SIZE(head))};
    if (!png_image_finish_read(&head, nullptr, image.rgb.data(), 0, nullptr)) throw std::runtime_error(head.message);
    return image;
}

class Png : public testing::Test {
protected:
    void SetUp() override {
        folder = fs::path(testing::TempDir()) / ("grainray_png_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
        fs::remove_all(folder);
        fs::create_directories(folder);
    }
    void TearDown() override { fs::remove_all(folder); }
    std::size_t files() const { return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), {})); }
    fs::path folder;
};

Image gradient() {
    Image image{17, 5, {}};
    for (int i = 0; i < 17 * 5 * 3; ++i) image.rgb.push_back(static_cast<std::uint8_t>(i));
    return image;
}

}  // namespace

TEST_F(Png, ReadsBack) {
    write_png(folder / "a.png", gradient());
    const Image back = read_png(folder / "a.png");
    EXPECT_EQ(back.width, 17);
    EXPECT_EQ(back.height, 5);
    EXPECT_EQ(back.rgb, gradient().rgb);
    EXPECT_EQ(files(), 1u);
}

TEST_F(Png, ReplacesAnOldFile) {
    std::ofstream(folder / "a.png") << "old";
    write_png(folder / "a.png", gradient());
    EXPECT_EQ(read_png(folder / "a.png").rgb, gradient().rgb);
    EXPECT_EQ(files(), 1u);
}

TEST_F(Png, FailureNamesTheFileAndLeavesNothing) {
    const fs::path path = folder / "missing" / "a.png";
    try {
        write_png(path, gradient());
        FAIL() << "no error";
    } catch (const SimulationError& error) {
        EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos);
    }
    fs::create_directories(folder / "taken.png");
    EXPECT_THROW(write_png(folder / "taken.png", gradient()), SimulationError);
    EXPECT_THROW(write_png(folder / "empty.png", {}), SimulationError);
    EXPECT_EQ(files(), 1u);
}
