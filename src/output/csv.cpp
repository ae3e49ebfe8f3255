// Frames as CSV. Line 1 is a comment with count, step and time, line 2 the column names, then a row a particle:
//   # grainray frame: 2 particles, step 10, time 0.01 s, SI units (m, kg, s, N, rad)
//   id,x,y,z,radius,vx,vy,vz,wx,wy,wz,material,coordination,contact_force,mass
// Numbers are the shortest text that reads back to the same bits. Any CSV with x, y and z can be read.
#include <algorithm>
#include <charconv>
#include <limits>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "output/fields.hpp"
#include "output/files.hpp"
#include "output/formats.hpp"

namespace grainray {

namespace {

enum class Kind { real64, real32, integer };

/// Where the values of a column lie in a frame.
template <class Byte>
struct ColumnAt {
    std::string name;
    Kind kind;
    Byte* first;
    std::size_t stride;
    Byte* at(std::size_t i) const { return first + i * stride; }
};

template <class Byte>
void add_columns(std::vector<ColumnAt<Byte>>& columns, const Field& field, Byte* first) {
    for (std::size_t k = 0; k < field.components(); ++k)
        columns.push_back({field.columns[k], field.is_integer() ? Kind::integer : Kind::real32, first + 4 * k, 4 * field.components()});
}

template <class Byte>
void add_position(std::vector<ColumnAt<Byte>>& columns, Byte* first) {
    for (std::size_t k = 0; k < 3; ++k) columns.push_back({std::string(1, static_cast<char>('x' + k)), Kind::real64, first + 8 * k, 24});
}

template <class T>
char* print(char* out, char* end, const std::byte* value) {
    return std::to_chars(out, end, *reinterpret_cast<const T*>(value)).ptr;
}

std::string format_rows(const std::vector<ColumnAt<const std::byte>>& columns, std::size_t first, std::size_t last) {
    constexpr std::size_t widest = 32;  // "-2.2250738585072014e-308" and a comma fit
    std::string text((last - first) * columns.size() * widest, '\0');
    char *out = text.data(), *const end = out + text.size();
    for (std::size_t i = first; i < last; ++i) {
        for (const auto& column : columns) {
            if (column.kind == Kind::real64) out = print<double>(out, end, column.at(i));
            else if (column.kind == Kind::real32) out = print<float>(out, end, column.at(i));
            else out = print<std::uint32_t>(out, end, column.at(i));
            *out++ = ',';
        }
        out[-1] = '\n';
    }
    text.resize(static_cast<std::size_t>(out - text.data()));
    return text;
}

class CsvWriter : public Writer {
public:
    void write(const std::filesystem::path& path, const Frame& frame, const std::vector<std::string>& names) const override {
        std::vector<ColumnAt<const std::byte>> columns;
        const auto fields = selected_fields(frame, names);
        for (const Field* field : fields)
            if (field->name == "id") add_columns(columns, *field, field->bytes(frame).data());
        add_position(columns, std::as_bytes(std::span(frame.position)).data());
        for (const Field* field : fields)
            if (field->name != "id") add_columns(columns, *field, field->bytes(frame).data());

        AtomicFile file(path);
        file.write(head(frame, columns));
        write_rows(file, columns, frame.size());
        file.commit();
    }

private:
    static std::string head(const Frame& frame, const std::vector<ColumnAt<const std::byte>>& columns) {
        std::string text = fmt::format("# grainray frame: {} particles, step {}, time {} s, SI units (m, kg, s, N, rad)\n", frame.size(),
                                       frame.step, frame.time);
        for (const auto& column : columns) text += column.name + ',';
        text.back() = '\n';
        return text;
    }

    /// Formats blocks of rows in parallel, a few at a time so that memory stays small.
    static void write_rows(AtomicFile& file, const std::vector<ColumnAt<const std::byte>>& columns, std::size_t count) {
        constexpr std::size_t rows = 8192, batch = 32;
        for (std::size_t start = 0; start < count; start += rows * batch) {
            std::vector<std::string> blocks(std::min(batch, (count - start + rows - 1) / rows));
            tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t b) {
                blocks[b] = format_rows(columns, start + b * rows, std::min(count, start + (b + 1) * rows));
            });
            for (const std::string& block : blocks) file.write(block);
        }
    }
};

std::string_view trimmed(std::string_view text) {
    const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    while (!text.empty() && blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && blank(text.back())) text.remove_suffix(1);
    return text;
}

/// Cuts the part up to `separator` off the front of text.
std::string_view take(std::string_view& text, char separator) {
    const auto end = std::min(text.find(separator), text.size());
    const auto part = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return trimmed(part);
}

template <class T>
bool parse(std::string_view text, T& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

/// The number that follows `label` in the comment line.
template <class T>
bool parse_after(std::string_view line, std::string_view label, T& value) {
    const auto start = line.find(label);
    if (start == std::string_view::npos) return false;
    line.remove_prefix(start + label.size());
    return parse(line.substr(0, line.find_first_of(" ,")), value);
}

class CsvReader {
public:
    explicit CsvReader(const std::filesystem::path& path) : path_(path), file_(read_text(path)), rest_(file_) {}

    Frame read() {
        constexpr std::size_t unknown = std::numeric_limits<std::size_t>::max();
        std::size_t promised = unknown;
        std::string_view line = next_line();
        for (; line.starts_with('#'); line = next_line()) {
            if (!line.starts_with("# grainray frame:")) continue;
            if (!parse_after(line, "frame: ", promised) || !parse_after(line, "step ", frame_.step) || !parse_after(line, "time ", frame_.time))
                throw_read_error(path_, "its first line is damaged");
        }
        if (promised != unknown && !file_.ends_with('\n')) throw_read_error(path_, "it is cut short");
        const auto names = read_header(line);
        const auto rows = static_cast<std::size_t>(std::ranges::count(rest_, '\n')) + 1;  // an upper limit
        const auto columns = allocate(names, rows);
        const std::size_t count = read_rows(columns);
        if (promised != unknown && promised != count)
            throw_read_error(path_, fmt::format("it is cut short or edited: {} rows where its first line says {}", count, promised));
        allocate(names, count);
        return std::move(frame_);
    }

private:
    std::string_view next_line() {
        ++line_;
        return take(rest_, '\n');
    }

    std::vector<std::string> read_header(std::string_view line) const {
        std::vector<std::string> names;
        while (!line.empty()) names.emplace_back(take(line, ','));
        for (const char* needed : {"x", "y", "z"})
            if (std::ranges::count(names, needed) != 1)
                throw_read_error(path_, fmt::format("it is not a CSV file of particles: line {} should name the columns, one of them '{}'", line_, needed));
        return names;
    }

    /// Makes room for `count` particles in the fields named; other columns of the file are skipped.
    std::vector<ColumnAt<std::byte>> allocate(const std::vector<std::string>& names, std::size_t count) {
        std::vector<ColumnAt<std::byte>> known, columns;
        frame_.position.resize(count);
        add_position(known, std::as_writable_bytes(std::span(frame_.position)).data());
        for (const Field& field : field_table())
            if (std::ranges::find_first_of(names, field.columns) != names.end())
                add_columns(known, field, field.resized_bytes(frame_, count).data());
        for (const std::string& name : names) {
            const auto found = std::ranges::find(known, name, &ColumnAt<std::byte>::name);
            columns.push_back(found == known.end() ? ColumnAt<std::byte>{name, Kind::real64, nullptr, 0} : *found);
        }
        return columns;
    }

    std::size_t read_rows(const std::vector<ColumnAt<std::byte>>& columns) {
        std::size_t row = 0;
        while (!rest_.empty()) {
            std::string_view line = next_line();
            if (line.empty() || line.starts_with('#')) continue;
            if (static_cast<std::size_t>(std::ranges::count(line, ',')) + 1 != columns.size())
                throw_read_error(path_, fmt::format("line {} has not the {} values of its header", line_, columns.size()));
            for (const auto& column : columns) read_value(take(line, ','), column, row);
            ++row;
        }
        return row;
    }

    void read_value(std::string_view text, const ColumnAt<std::byte>& column, std::size_t row) const {
        if (!column.first) return;
        std::byte* const value = column.at(row);
        const bool good = column.kind == Kind::real64   ? parse(text, *reinterpret_cast<double*>(value))
                          : column.kind == Kind::real32 ? parse(text, *reinterpret_cast<float*>(value))
                                                        : parse(text, *reinterpret_cast<std::uint32_t*>(value));
        if (!good)
            throw_read_error(path_, fmt::format("line {}: '{}' in column '{}' is not a {}", line_, text.substr(0, 40), column.name,
                                                column.kind == Kind::integer ? "whole number from 0 to 4294967295" : "number"));
    }

    const std::filesystem::path& path_;
    std::string file_;
    std::string_view rest_;
    std::size_t line_ = 0;
    Frame frame_;
};

}  // namespace

const Writer& csv_writer() {
    static const CsvWriter writer;
    return writer;
}

Frame read_csv(const std::filesystem::path& path) { return CsvReader(path).read(); }

}  // namespace grainray
