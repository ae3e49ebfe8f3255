#include "output/files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include <fmt/format.h>

#include "grainray/output.hpp"

namespace grainray {

namespace fs = std::filesystem;

namespace {

std::string explain(int error) {
    switch (error) {
        case ENOSPC: return "the disk is full; free some space or write to another disk";
        case EDQUOT: return "the disk quota is used up; free some space or write to another disk";
        case EFBIG: return "the file size limit is reached; raise it (ulimit -f) or write fewer fields";
        case EACCES:
        case EPERM: return "no permission; choose another folder or change its permissions";
        case EROFS: return "the file system is read-only; choose another folder";
        case ENOENT:
        case ENOTDIR: return "its folder does not exist; create it first";
        case EISDIR: return "there is a folder of that name; choose another name";
        case EEXIST: return "something that is not a plain file is in its place; choose another name";
        case EIO: return "the disk reports an input/output error; write to another disk";
        case EMFILE:
        case ENFILE: return "too many files are open; raise the limit (ulimit -n)";
        default: return fmt::format("{}; choose another folder", std::strerror(error));
    }
}

/// So that the new name survives a power failure. Best effort: some file systems cannot sync a folder.
void sync_folder(const fs::path& folder) {
    const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    (void)::fsync(descriptor);
    ::close(descriptor);
}

}  // namespace

void throw_write_error(const fs::path& path, int error) {
    throw SimulationError(fmt::format("cannot write {}: {}", path.string(), explain(error)));
}

void throw_read_error(const fs::path& path, std::string_view reason) {
    throw InputError(fmt::format("cannot read {}: {}", path.string(), reason));
}

bool write_all(int descriptor, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
}

// The temporary name is fixed: what a killed run left behind is overwritten by the next one.
AtomicFile::AtomicFile(fs::path target) : target_(std::move(target)), temporary_(target_.string() + ".tmp") {
    struct stat existing {};
    if (::stat(target_.c_str(), &existing) == 0 && !S_ISREG(existing.st_mode))
        throw_write_error(target_, S_ISDIR(existing.st_mode) ? EISDIR : EEXIST);
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor_ < 0) throw_write_error(target_, errno);
}

AtomicFile::~AtomicFile() {
    if (descriptor_ < 0) return;
    ::close(descriptor_);
    ::unlink(temporary_.c_str());
}

void AtomicFile::write(std::string_view bytes) {
    if (!write_all(descriptor_, bytes)) throw_write_error(target_, errno);
}

void AtomicFile::commit() {
    // EINVAL: the file system has no fsync. Network file systems report a full disk only here or on close.
    if (::fsync(descriptor_) != 0 && errno != EINVAL) throw_write_error(target_, errno);
    const int closed = ::close(std::exchange(descriptor_, -1));
    if (closed != 0 || ::rename(temporary_.c_str(), target_.c_str()) != 0) {
        const int error = errno;
        ::unlink(temporary_.c_str());
        throw_write_error(target_, error);
    }
    sync_folder(target_.parent_path());
}

void check_readable(const fs::path& path) {
    struct stat info {};
    if (::stat(path.c_str(), &info) != 0) throw_read_error(path, errno == ENOENT ? "there is no such file" : std::strerror(errno));
    if (!S_ISREG(info.st_mode)) throw_read_error(path, S_ISDIR(info.st_mode) ? "it is a folder" : "it is not a plain file");
    if (::access(path.c_str(), R_OK) != 0) throw_read_error(path, std::strerror(errno));
}

std::string read_text(const fs::path& path) {
    check_readable(path);
    std::ifstream file(path, std::ios::binary);
    std::string text(fs::file_size(path), '\0');
    if (!file.read(text.data(), static_cast<std::streamsize>(text.size()))) throw_read_error(path, "the disk reports an error");
    return text;
}

void write_text_atomically(const fs::path& path, const std::string& text) {
    AtomicFile file(path);
    file.write(text);
    file.commit();
}

}  // namespace grainray
