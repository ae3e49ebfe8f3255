#include <sys/stat.h>

#include "common.hpp"

namespace grainray::test {

class Files : public OutputTest {
protected:
    std::string text_error(const fs::path& path) const {
        return message_of<SimulationError>([&] { write_text_atomically(path, std::string(100000, 'x')); });
    }
    fs::path history() const { return folder / "history.csv"; }
};

TEST_F(Files, TextIsReplacedWhole) {
    write_text_atomically(folder / "summary.json", "one");
    write_text_atomically(folder / "summary.json", "two");
    EXPECT_EQ(slurp(folder / "summary.json"), "two");
    {
        const FileSizeLimit limit(5000);
        EXPECT_TRUE(has(text_error(folder / "summary.json"), "summary.json"));
    }
    EXPECT_EQ(slurp(folder / "summary.json"), "two");
    EXPECT_EQ(files_in(folder), 1u);
}

TEST_F(Files, ReasonsAreSentences) {
    EXPECT_TRUE(has(text_error(folder / "none" / "a.json"), "folder does not exist"));
    fs::create_directory(folder / "taken");
    EXPECT_TRUE(has(text_error(folder / "taken"), "there is a folder of that name"));
    EXPECT_TRUE(has(text_error("/dev/full"), "not a plain file"));
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(Files, NoPermissionIsCalledThat) {
    if (::geteuid() == 0) GTEST_SKIP() << "permissions do not bind the superuser";
    fs::create_directory(folder / "closed");
    fs::permissions(folder / "closed", fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_TRUE(has(text_error(folder / "closed" / "a.json"), "no permission"));
}

TEST_F(Files, NewFilesFollowTheUmask) {
    const mode_t before = ::umask(027);
    write_text_atomically(folder / "a.json", "{}");
    ::umask(before);
    EXPECT_EQ(fs::status(folder / "a.json").permissions(), static_cast<fs::perms>(0640));
}

TEST_F(Files, HistoryIsThereAfterEveryRow) {
    HistoryFile file(history(), {"time", "energy"}, false, 0);
    EXPECT_EQ(slurp(history()), "time,energy\n");
    file.row({0.1, -1e300});
    EXPECT_EQ(slurp(history()), "time,energy\n0.1,-1e+300\n");
    EXPECT_NE(message_of<SimulationError>([&] { file.row({1}); }), "");
}

TEST_F(Files, HistoryStartsAnew) {
    spill(history(), "something else\n");
    HistoryFile(history(), {"time"}, false, 0);
    EXPECT_EQ(slurp(history()), "time\n");
}

TEST_F(Files, HistoryGoesOnFromTheCheckpoint) {
    const double t = 0.1 + 0.2;
    {
        HistoryFile file(history(), {"time", "n"}, false, 0);
        for (const double time : {0.0, t, t + 1e-16, 0.5}) file.row({time, 1});
    }
    spill(history(), slurp(history()) + "0.2");  // killed while writing a row
    HistoryFile file(history(), {"time", "n"}, true, t);
    file.row({0.4, 2});
    EXPECT_EQ(slurp(history()), "time,n\n0,1\n0.30000000000000004,1\n0.4,2\n");
    EXPECT_EQ(files_in(folder), 1u);
}

TEST_F(Files, HistoryAppendsToNothing) {
    HistoryFile(history(), {"time"}, true, 5);
    EXPECT_EQ(slurp(history()), "time\n");
    spill(history(), "");
    HistoryFile(history(), {"time"}, true, 5);
    EXPECT_EQ(slurp(history()), "time\n");
    EXPECT_TRUE(has(message_of<InputError>([&] { HistoryFile(history(), {"time", "n"}, true, 5); }), "columns"));
    EXPECT_EQ(slurp(history()), "time\n");
}

TEST_F(Files, HistoryEndsWithAWholeRowOnAFullDisk) {
    HistoryFile file(history(), {"time", "n"}, false, 0);
    file.row({1, 1});
    const std::string before = slurp(history());
    {
        const FileSizeLimit limit(before.size() + 3);
        EXPECT_TRUE(has(message_of<SimulationError>([&] { file.row({2, 1234567}); }), "history.csv"));
    }
    EXPECT_EQ(slurp(history()), before);
    file.row({2, 2});
    EXPECT_EQ(slurp(history()), before + "2,2\n");
}

TEST_F(Files, FullDiskIsCalledThat) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    const std::string message = message_of<SimulationError>([] { HistoryFile("/dev/full", {"time"}, false, 0); });
    EXPECT_EQ(message, "cannot write /dev/full: the disk is full; free some space or write to another disk");
}

}  // namespace grainray::test
