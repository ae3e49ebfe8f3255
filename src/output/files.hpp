// Files written whole or not at all, and the sentences that say why not.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace grainray {

/// A temporary file beside `target` that takes its place on commit(); removed when destroyed before that.
/// Every failure throws SimulationError and leaves `target` as it was.
class AtomicFile {
public:
    explicit AtomicFile(std::filesystem::path target);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;
    void write(std::string_view bytes);
    /// Syncs to disk, then renames.
    void commit();

private:
    std::filesystem::path target_, temporary_;
    int descriptor_ = -1;
};

/// Writes everything or sets errno and returns false.
bool write_all(int descriptor, std::string_view bytes);

/// Throws InputError where there is no plain file that may be read.
void check_readable(const std::filesystem::path&);
/// The whole file; throws InputError (missing, no permission, a folder).
std::string read_text(const std::filesystem::path&);

/// Throws SimulationError "cannot write FILE: reason; remedy" for an errno value.
[[noreturn]] void throw_write_error(const std::filesystem::path&, int error);
/// Throws InputError "cannot read FILE: reason".
[[noreturn]] void throw_read_error(const std::filesystem::path&, std::string_view reason);

}  // namespace grainray
