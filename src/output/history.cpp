// history.csv: a row an interval, on disk as soon as it is written, so that a running simulation can be watched.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "grainray/output.hpp"
#include "output/files.hpp"

namespace grainray {

namespace {

/// The rows of an earlier run up to a time. A last row without its end (the run was killed while writing) goes.
std::string kept_rows(const std::filesystem::path& path, const std::string& header, double keep_until) {
    const std::string text = read_text(path);
    if (text.empty()) return header;
    if (!text.starts_with(header))
        throw_read_error(path, "its columns are not those of this run; move it away or write to another folder");
    std::string kept = header;
    for (std::size_t start = header.size(), end; (end = text.find('\n', start)) != std::string::npos; start = end + 1) {
        double time = 0;
        const bool number = std::from_chars(text.data() + start, text.data() + end, time).ec == std::errc();
        if (number && time <= keep_until) kept.append(text, start, end + 1 - start);
    }
    return kept;
}

}  // namespace

struct HistoryFile::Impl {
    std::filesystem::path path;
    std::size_t columns;
    int descriptor = -1;

    ~Impl() {
        if (descriptor >= 0) ::close(descriptor);
    }

    /// A row that does not fit on the disk leaves nothing behind: the file ends with a whole row.
    void append(std::string_view text) const {
        struct stat before {};
        const bool regular = ::fstat(descriptor, &before) == 0 && S_ISREG(before.st_mode);
        if (write_all(descriptor, text)) return;
        const int error = errno;
        if (regular) (void)!::ftruncate(descriptor, before.st_size);
        throw_write_error(path, error);
    }
};

HistoryFile::HistoryFile(std::filesystem::path path, const std::vector<std::string>& columns, bool append, double keep_until)
    : impl_(std::make_unique<Impl>()) {
    const std::string header = fmt::format("{}\n", fmt::join(columns, ","));
    const bool goes_on = append && std::filesystem::exists(path);
    if (goes_on) write_text_atomically(path, kept_rows(path, header, keep_until));
    impl_->path = std::move(path);
    impl_->columns = columns.size();
    impl_->descriptor = ::open(impl_->path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | (goes_on ? 0 : O_TRUNC), 0666);
    if (impl_->descriptor < 0) throw_write_error(impl_->path, errno);
    if (!goes_on) impl_->append(header);
}

HistoryFile::~HistoryFile() = default;

void HistoryFile::row(const std::vector<double>& values, const std::string& name) {
    if (values.size() + !name.empty() != impl_->columns)
        throw SimulationError(fmt::format("{}: a row of {} values for {} columns", impl_->path.string(), values.size(), impl_->columns));
    impl_->append(fmt::format("{}{}{}\n", fmt::join(values, ","), name.empty() ? "" : ",", name));
}

}  // namespace grainray
