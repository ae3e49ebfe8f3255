// Where a test finds the command and the project's examples: in the build and source trees, or in a packaged folder.
#pragma once

#include <filesystem>

namespace grainray::test {

/// The folder of the running test program; the command `grainray` lies in it too.
inline std::filesystem::path program_folder() { return std::filesystem::read_symlink("/proc/self/exe").parent_path(); }

/// The folder that holds examples/ and docs/.
inline std::filesystem::path project_folder() {
    const std::filesystem::path package = program_folder().parent_path();
    return std::filesystem::exists(package / "examples" / "column_collapse.toml") ? package : std::filesystem::path(GRAINRAY_SOURCE_DIR);
}

}  // namespace grainray::test
