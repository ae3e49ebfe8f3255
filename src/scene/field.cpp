#include "scene/field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grainray::scene {
namespace {

/// " (a typical value is 1e-3 s)" or nothing.
std::string typical(const FieldInfo& field) {
    return field.typical.empty() ? "" : fmt::format(" (a typical value is {})", field.typical);
}

std::string found(const Value& value) { return "found " + value.type(); }

void check_range(const Node& node, const FieldInfo& field, double value) {
    if (!std::isfinite(value)) fail(node, "must be a finite number" + typical(field));
    if (!field.range.contains(value))
        fail(node, fmt::format("must be {}{}", field.range.text(field.unit), typical(field)));
}

std::string with_unit(double value, const Unit& unit) {
    return fmt::format("{}{}{}", value, unit.symbol.empty() ? "" : " ", unit.symbol);
}

}  // namespace

bool Range::contains(double value) const {
    return (open_lower ? value > lower : value >= lower) && (open_upper ? value < upper : value <= upper);
}

std::string Range::text(const Unit& unit) const {
    std::string out;
    if (std::isfinite(lower))
        out = fmt::format("{} {}", open_lower ? "greater than" : "at least", with_unit(lower, unit));
    if (std::isfinite(upper))
        out += fmt::format("{}{} {}", out.empty() ? "" : " and ", open_upper ? "less than" : "at most",
                           with_unit(upper, unit));
    return out;
}

void read(const Node& node, const FieldInfo& field, double& out) {
    const Value& value = *node.value;
    if (const auto* number = std::get_if<double>(&value.data)) out = *number;
    else if (const auto* integer = std::get_if<std::int64_t>(&value.data)) out = static_cast<double>(*integer);
    else if (const auto* text = std::get_if<std::string>(&value.data)) {
        const Quantity quantity = parse_quantity(*text, field.unit);
        if (!quantity.problem.empty()) fail(node, quantity.problem);
        out = quantity.value;
    } else fail(node, fmt::format("expected a number, {}{}", found(value), typical(field)));
    check_range(node, field, out);
}

void read(const Node& node, const FieldInfo& field, std::int64_t& out) {
    const Value& value = *node.value;
    const auto* number = std::get_if<double>(&value.data);
    if (number && *number == std::floor(*number) && std::abs(*number) <= 0x1p53)
        out = static_cast<std::int64_t>(*number);  // 2e4
    else if (const auto* integer = std::get_if<std::int64_t>(&value.data)) out = *integer;
    else fail(node, fmt::format("expected an integer, {}{}", found(value), typical(field)));
    check_range(node, field, static_cast<double>(out));
}

void read(const Node& node, const FieldInfo& field, std::uint64_t& out) {
    std::int64_t number = 0;
    read(node, field, number);
    if (number < 0) fail(node, "must be at least 0");
    out = static_cast<std::uint64_t>(number);
}

void read(const Node& node, const FieldInfo&, bool& out) {
    const auto* flag = std::get_if<bool>(&node.value->data);
    if (!flag) fail(node, fmt::format("expected true or false, {}", found(*node.value)));
    out = *flag;
}

void read(const Node& node, const FieldInfo& field, std::string& out) {
    const auto* text = std::get_if<std::string>(&node.value->data);
    if (!text) fail(node, fmt::format("expected a string, {}{}", found(*node.value), typical(field)));
    if (!field.choices.empty()) read_choice(node, field);
    out = *text;
}

std::size_t read_choice(const Node& node, const FieldInfo& field) {
    const auto* text = std::get_if<std::string>(&node.value->data);
    if (!text) fail(node, fmt::format("expected one of {}, {}", join(field.choices), found(*node.value)));
    const auto choice = std::find(field.choices.begin(), field.choices.end(), *text);
    if (choice == field.choices.end())
        fail(node, fmt::format("unknown value{} Allowed: {}", did_you_mean(*text, field.choices), join(field.choices)));
    return static_cast<std::size_t>(choice - field.choices.begin());
}

void read(const Node& node, const FieldInfo& field, Vec3d& out) {
    const auto items = elements(node, 3, TypeText<double>::name(field));
    for (int axis = 0; axis < 3; ++axis) read(items[static_cast<std::size_t>(axis)], field, out[axis]);
}

void read(const Node& node, const FieldInfo& field, std::vector<double>& out) {
    out.clear();
    if (!node.value->list()) return read(node, field, out.emplace_back());
    for (const Node& item : elements(node, 0, TypeText<double>::name(field))) read(item, field, out.emplace_back());
}

void read(const Node& node, const FieldInfo& field, Amount& out) {
    const Unit& mass = field.unit.symbol.empty() ? unit::mass : unit::mass_rate;
    const auto* text = std::get_if<std::string>(&node.value->data);
    out = {};
    if (!text || parse_quantity(*text, field.unit).problem.empty()) return read(node, field, out.particles);
    const Quantity quantity = parse_quantity(*text, mass);
    if (!quantity.problem.empty())
        fail(node, fmt::format("expected a number of particles{}, or a mass as text in {}, {}{}", field.unit.symbol.empty() ? "" : " a second", mass.symbol, mass.others, typical(field)));
    out.mass = quantity.value;
    check_range(node, field, out.mass);
}

std::vector<Node> elements(const Node& node, std::size_t count, const std::string& what) {
    const List* list = node.value->list();
    const std::string wanted = count ? fmt::format("expected an array of {} values ({})", count, what)
                                     : fmt::format("expected an array ({})", what);
    if (!list) fail(node, fmt::format("{}, {}", wanted, found(*node.value)));
    if (count && list->size() != count) fail(node, fmt::format("{}, found {}", wanted, list->size()));
    std::vector<Node> nodes;
    nodes.reserve(list->size());
    for (const Value& value : *list)
        nodes.push_back({&value, value.place, fmt::format("{}[{}]", node.key, nodes.size())});
    return nodes;
}

void fail_missing(const Node& table, const FieldInfo& field) {
    std::string hint = field.choices.empty() ? typical(field) : " (one of " + join(field.choices) + ")";
    throw InputError(
        fmt::format("{}: key '{}' is missing: {}{}", table.place.text(), table.key_of(field.key), field.text, hint));
}

void check_keys(const Node& table, std::vector<std::string_view> known, const std::string& of) {
    if (!table.value->table()) fail(table, fmt::format("expected a table [{}], {}", table.key, found(*table.value)));
    for (const Entry& entry : *table.value->table()) {
        if (std::find(known.begin(), known.end(), entry.key) != known.end()) continue;
        const std::string guess = did_you_mean(entry.key, known);
        std::sort(known.begin(), known.end());
        throw InputError(fmt::format("{}: key '{}': {}{} Allowed: {}", entry.place.text(), table.key_of(entry.key),
                                     of.empty() ? "unknown key" : "not a key of " + of, guess, join(known)));
    }
}

std::string TypeText<double>::name(const FieldInfo&) { return "number"; }
std::string TypeText<double>::show(const double& value, const FieldInfo&) {
    return std::isfinite(value) ? fmt::format("{}", value) : "none";
}
std::string TypeText<std::int64_t>::name(const FieldInfo&) { return "integer"; }
std::string TypeText<std::int64_t>::show(const std::int64_t& value, const FieldInfo&) {
    return fmt::format("{}", value);
}
std::string TypeText<std::uint64_t>::name(const FieldInfo&) { return "integer"; }
std::string TypeText<std::uint64_t>::show(const std::uint64_t& value, const FieldInfo&) {
    return fmt::format("{}", value);
}
std::string TypeText<Amount>::name(const FieldInfo&) { return "number or mass"; }
std::string TypeText<Amount>::show(const Amount&, const FieldInfo&) { return "none"; }
std::string TypeText<bool>::name(const FieldInfo&) { return "true or false"; }
std::string TypeText<bool>::show(const bool& value, const FieldInfo&) { return value ? "true" : "false"; }
std::string TypeText<std::string>::name(const FieldInfo& f) { return f.choices.empty() ? "string" : "choice"; }
std::string TypeText<std::string>::show(const std::string& value, const FieldInfo&) {
    return fmt::format("\"{}\"", value);
}
std::string TypeText<Vec3d>::name(const FieldInfo&) { return "3 x number"; }
std::string TypeText<Vec3d>::show(const Vec3d& v, const FieldInfo&) {
    return fmt::format("[{}, {}, {}]", v.x, v.y, v.z);
}

}  // namespace grainray::scene
