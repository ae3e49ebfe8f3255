// Runs the built `grainray` in a folder of its own and keeps what it said.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace grainray::cli_test {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;

struct Result {
    int status = -1;  ///< exit status; 128 + signal where it was killed
    std::string out, err;
};

/// A folder under the system's temporary one, removed at the end; processes run in it.
class Folder {
public:
    Folder();
    ~Folder();
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    fs::path operator/(const fs::path& name) const { return path_ / name; }
    void write(const fs::path& name, const std::string& text) const;
    std::string read(const fs::path& name) const;
    nlohmann::json summary(const fs::path& run) const { return nlohmann::json::parse(read(run / "summary.json")); }

    /// file_size_limit: RLIMIT_FSIZE in bytes; 0: none.
    Result grainray(const Arguments&, std::size_t file_size_limit = 0) const;
    /// Starts it and comes back; finish() waits for it.
    pid_t start(const Arguments&, std::size_t file_size_limit = 0) const;
    Result finish(pid_t) const;

private:
    fs::path path_;
};

/// True once `file` exists; false after ten seconds or when the process has ended.
bool wait_for_file(const fs::path& file, pid_t);

/// Two spheres of radius 1 cm that meet above a floor; 200 steps, 5 frames and the first.
std::string two_spheres();
/// A lattice of 216 spheres that falls on a floor between walls; as many steps as its duration of 10 s and dt of 1e-4 s give.
std::string bed();

}  // namespace grainray::cli_test
