// VTK XML PolyData: a point and a vertex cell a particle, fields as point data. ParaView and OVITO open it; OVITO only
// where arrays are inline and not compressed. Positions are Float64: worlds may lie far from zero.
#include <charconv>
#include <numeric>
#include <optional>

#include <fmt/format.h>
#include <zlib.h>

#include "output/fields.hpp"
#include "output/files.hpp"
#include "output/formats.hpp"
#include "output/vtp_data.hpp"

namespace grainray {

namespace {

constexpr std::string_view checksum_open = "<!-- crc32 of the lines above: ";

std::uint32_t crc(std::uint32_t start, std::string_view text) {
    return static_cast<std::uint32_t>(crc32_z(start, reinterpret_cast<const Bytef*>(text.data()), text.size()));
}

/// A file that ends with the checksum of what it holds.
class Sink {
public:
    explicit Sink(const std::filesystem::path& path) : file_(path) {}
    void put(std::string_view text) {
        checksum_ = crc(checksum_, text);
        file_.write(text);
    }
    void commit() {
        file_.write(fmt::format("{}{:08x} -->\n", checksum_open, checksum_));
        file_.commit();
    }

private:
    AtomicFile file_;
    std::uint32_t checksum_ = 0;
};

class VtpWriter : public Writer {
public:
    explicit VtpWriter(bool compressed) : compressed_(compressed) {}

    void write(const std::filesystem::path& path, const Frame& frame, const std::vector<std::string>& names) const override {
        const auto fields = selected_fields(frame, names);
        Sink sink(path);
        put_head(sink, frame.size());
        put_array(sink, "Points", "Float64", 3, std::as_bytes(std::span(frame.position)));
        sink.put("</Points>\n<Verts>\n");
        put_vertices(sink, frame.size());
        sink.put("</Verts>\n<PointData>\n");
        for (const Field* field : fields)
            put_array(sink, field->name, field->is_integer() ? "UInt32" : "Float32", field->components(), field->bytes(frame));
        sink.put("</PointData>\n");
        put_tail(sink, frame);
        sink.commit();
    }

private:
    void put_head(Sink& sink, std::size_t count) const {
        sink.put(fmt::format(
            "<?xml version=\"1.0\"?>\n"
            "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\"{}>\n"
            "<PolyData>\n<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n"
            "<Points>\n",
            compressed_ ? " compressor=\"vtkZLibDataCompressor\"" : "", count, count));
    }

    /// After the piece: OVITO does not recognise a file that starts with its field data.
    static void put_tail(Sink& sink, const Frame& frame) {
        sink.put(fmt::format(
            "</Piece>\n<FieldData>\n"
            "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{}</DataArray>\n"
            "<DataArray type=\"UInt64\" Name=\"Step\" NumberOfTuples=\"1\" format=\"ascii\">{}</DataArray>\n"
            "</FieldData>\n</PolyData>\n</VTKFile>\n",
            frame.time, frame.step));
    }

    void put_array(Sink& sink, std::string_view name, std::string_view type, std::size_t components,
                   std::span<const std::byte> data) const {
        sink.put(fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">\n", type, name, components));
        sink.put(encode_vtk(data, compressed_));
        sink.put("\n</DataArray>\n");
    }

    /// Vertex i is point i and ends at offset i + 1.
    void put_vertices(Sink& sink, std::size_t count) const {
        std::vector<std::int64_t> numbers(count + 1);
        std::iota(numbers.begin(), numbers.end(), std::int64_t{0});
        const auto all = std::span<const std::int64_t>(numbers);
        put_array(sink, "connectivity", "Int64", 1, std::as_bytes(all.first(count)));
        put_array(sink, "offsets", "Int64", 1, std::as_bytes(all.last(count)));
    }

    bool compressed_;
};

/// A DataArray of a file: the text between its tags, and its attributes.
struct Element {
    std::string_view tag, text;
};

std::string_view attribute(std::string_view tag, std::string_view name) {
    const auto start = tag.find(fmt::format(" {}=\"", name));
    if (start == std::string_view::npos) return {};
    tag.remove_prefix(start + name.size() + 3);
    return tag.substr(0, tag.find('"'));
}

template <class T>
bool parse(std::string_view text, T& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

/// The opening tag `<name ...>` at or after `from`, without its brackets; empty where there is none.
std::string_view find_tag(std::string_view file, std::string_view name, std::size_t from = 0) {
    const auto start = file.find(fmt::format("<{} ", name), from);
    if (start == std::string_view::npos) return {};
    const auto end = file.find('>', start);
    return end == std::string_view::npos ? std::string_view{} : file.substr(start + 1, end - start - 1);
}

std::vector<Element> data_arrays(std::string_view file) {
    std::vector<Element> result;
    for (auto tag = find_tag(file, "DataArray"); !tag.empty();) {
        const std::size_t start = static_cast<std::size_t>(tag.data() - file.data()) + tag.size() + 1;
        const std::size_t end = std::min(file.find('<', start), file.size());
        auto text = file.substr(start, end - start);
        if (text.starts_with('\n')) text.remove_prefix(1);
        if (text.ends_with('\n')) text.remove_suffix(1);
        result.push_back({tag, text});
        tag = find_tag(file, "DataArray", end);
    }
    return result;
}

/// nullopt: whole; else what is wrong with the file as such.
std::optional<std::string> find_damage(std::string_view file) {
    const auto head = file.substr(0, 512);
    if (!head.starts_with("<?xml") || attribute(find_tag(head, "VTKFile"), "type") != "PolyData")
        return "it is not a VTK PolyData (.vtp) file";
    const auto end = file.rfind("</VTKFile>");
    if (end == std::string_view::npos) return "it is cut short; write it again or use another frame";
    const auto comment = file.find(checksum_open, end);
    std::uint32_t stored = 0;
    if (comment == std::string_view::npos) return "it is cut short or was not written by this program";
    const auto digits = file.substr(comment + checksum_open.size(), 8);
    const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), stored, 16);
    if (parsed.ptr != digits.data() + 8 || stored != crc(0, file.substr(0, comment)))
        return "it is damaged (its checksum is wrong); use another frame";
    return std::nullopt;
}

void decode_into(const Element& array, bool compressed, std::string_view type, std::span<std::byte> data) {
    if (attribute(array.tag, "type") != type || attribute(array.tag, "format") != "binary" || !decode_vtk(array.text, compressed, data))
        throw std::string(attribute(array.tag, "Name"));
}

/// Throws the name of the array that is not as this program writes it.
Frame decode_frame(std::string_view file) {
    Frame frame;
    std::size_t count = 0;
    // zlib shrinks at most 1032 times: a wilder count must not make this allocate without end.
    if (!parse(attribute(find_tag(file, "Piece"), "NumberOfPoints"), count) || count > 1032 * file.size())
        throw std::string("NumberOfPoints");
    const bool compressed = !attribute(find_tag(file, "VTKFile"), "compressor").empty();
    bool points = false;
    for (const Element& array : data_arrays(file)) {
        const std::string name(attribute(array.tag, "Name"));
        if ((name == "TimeValue" && !parse(array.text, frame.time)) || (name == "Step" && !parse(array.text, frame.step))) throw name;
        if (name == "Points") {
            frame.position.resize(count);
            decode_into(array, compressed, "Float64", std::as_writable_bytes(std::span(frame.position)));
            points = true;
        } else if (const Field* field = find_field(name)) {
            decode_into(array, compressed, field->is_integer() ? "UInt32" : "Float32", field->resized_bytes(frame, count));
        }
    }
    if (!points) throw std::string("Points");
    return frame;
}

}  // namespace

const Writer& vtp_writer() {
    static const VtpWriter writer(false);
    return writer;
}

const Writer& compressed_vtp_writer() {
    static const VtpWriter writer(true);
    return writer;
}

Frame read_vtp(const std::filesystem::path& path) {
    const std::string file = read_text(path);
    if (const auto damage = find_damage(file)) throw_read_error(path, *damage);
    try {
        return decode_frame(file);
    } catch (const std::string& array) {
        throw_read_error(path, fmt::format("'{}' is not as this program writes it", array));
    }
}

}  // namespace grainray
