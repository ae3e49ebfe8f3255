#include "output/fields.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace grainray {

static_assert(sizeof(Vec3f) == 12 && sizeof(Vec3d) == 24, "vectors are written as plain memory");

const std::vector<Field>& field_table() {
    static const std::vector<Field> table{
        {"radius", {"radius"}, &Frame::radius},
        {"velocity", {"vx", "vy", "vz"}, &Frame::velocity},
        {"angular_velocity", {"wx", "wy", "wz"}, &Frame::angular_velocity},
        {"id", {"id"}, &Frame::id},
        {"material", {"material"}, &Frame::material},
        {"coordination", {"coordination"}, &Frame::coordination},
        {"contact_force", {"contact_force"}, &Frame::contact_force},
        {"mass", {"mass"}, &Frame::mass},
    };
    return table;
}

const std::vector<std::string>& frame_fields() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> result;
        for (const Field& field : field_table()) result.push_back(field.name);
        return result;
    }();
    return names;
}

const Field* find_field(const std::string& name) {
    const auto& table = field_table();
    const auto found = std::ranges::find(table, name, &Field::name);
    return found == table.end() ? nullptr : &*found;
}

std::span<const std::byte> Field::bytes(const Frame& frame) const {
    return std::visit([&](auto m) { return std::as_bytes(std::span(frame.*m)); }, member);
}

std::span<std::byte> Field::resized_bytes(Frame& frame, std::size_t n) const {
    return std::visit(
        [&](auto m) {
            (frame.*m).resize(n);
            return std::as_writable_bytes(std::span(frame.*m));
        },
        member);
}

std::vector<const Field*> selected_fields(const Frame& frame, const std::vector<std::string>& names) {
    for (const std::string& name : names)
        if (!find_field(name)) throw InputError(unknown_name("output field", name, frame_fields()));
    std::vector<const Field*> result;
    for (const Field& field : field_table()) {
        const bool named = std::ranges::find(names, field.name) != names.end();
        if (!named && !names.empty()) continue;
        const std::size_t have = field.bytes(frame).size(), want = frame.size() * field.components() * 4;
        if (have == want) result.push_back(&field);
        else if (named || have != 0)
            throw InputError(fmt::format("output field '{}' is not known for every particle of this simulation", field.name));
    }
    return result;
}

namespace {

std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
        }
    }
    return row.back();
}

}  // namespace

std::string unknown_name(const std::string& what, const std::string& name, const std::vector<std::string>& known) {
    const auto nearest = std::ranges::min_element(known, {}, [&](const std::string& k) { return edit_distance(name, k); });
    std::string hint;
    if (nearest != known.end() && edit_distance(name, *nearest) <= std::max<std::size_t>(2, name.size() / 3))
        hint = fmt::format("; did you mean '{}'?", *nearest);
    return fmt::format("unknown {} '{}'{} Known: {}", what, name, hint.empty() ? "." : hint, fmt::join(known, ", "));
}

}  // namespace grainray
