// The output folder of a run: which files are this program's, and what may be replaced.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace grainray::cli {

class RunFolder {
public:
    /// extension: that of the frames. Looks, changes nothing.
    RunFolder(std::filesystem::path folder, std::string extension);

    const std::filesystem::path& path() const { return folder_; }
    std::filesystem::path scene() const { return folder_ / "scene.toml"; }
    std::filesystem::path history() const { return folder_ / "history.csv"; }
    std::filesystem::path lost() const { return folder_ / "lost.csv"; }
    std::filesystem::path removed() const { return folder_ / "removed.csv"; }
    std::filesystem::path checkpoint() const { return folder_ / "checkpoint.h5"; }
    std::filesystem::path summary() const { return folder_ / "summary.json"; }
    std::filesystem::path frame(std::uint64_t index) const;

    /// True where `restart` is a file in this folder: the run then goes on in it.
    bool goes_on_from(const std::filesystem::path& restart) const;
    /// Throws InputError where the folder holds files and neither --force nor a restart from it allows writing there.
    void check(bool force, bool goes_on) const;
    /// Makes the folders. Throws InputError where that is not possible.
    void create() const;
    /// After create(): throws InputError where another run has written there since check() found no folder.
    void check_still_empty() const;
    /// Removes what an earlier run left: frames, history, checkpoint, summary, scene. Nothing else.
    void clear() const;
    /// Removes frames with a number above `last`.
    void remove_frames_after(std::uint64_t last) const;

private:
    bool is_of_a_run() const;
    std::filesystem::path first_to_replace() const;

    std::filesystem::path folder_;
    std::string extension_;
};

/// DIR/.lock, held by the run that writes to DIR; a run that was killed holds none. Gone when the run is over.
class FolderLock {
public:
    /// Throws InputError where another run holds it.
    explicit FolderLock(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

private:
    std::string path_;
    int file_ = -1;
};

/// The number of a frame file NNNNNN.EXTENSION, or -1.
std::int64_t frame_number(const std::filesystem::path&);

}  // namespace grainray::cli
