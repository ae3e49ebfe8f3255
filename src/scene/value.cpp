#include "scene/value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "scene/convert.hpp"

namespace grainray::scene {
namespace {

constexpr std::size_t shown_characters = 60;

Place place_of(const toml::source_region& where, const Origin& origin, bool located) {
    if (!located) return {origin, 0, 0};
    return {origin, static_cast<std::uint32_t>(where.begin.line), static_cast<std::uint32_t>(where.begin.column)};
}

/// toml++ sorts keys by name; a scene keeps the order in which they were written.
Table convert_table(const toml::table& table, const Origin& origin, bool located) {
    Table result;
    for (auto&& [key, node] : table)
        result.push_back(
            {std::string(key.str()), place_of(key.source(), origin, located), convert(node, origin, located)});
    std::stable_sort(result.begin(), result.end(), [](const Entry& a, const Entry& b) {
        return std::tie(a.place.line, a.place.column) < std::tie(b.place.line, b.place.column);
    });
    return result;
}

List convert_list(const toml::array& array, const Origin& origin, bool located) {
    List result;
    result.reserve(array.size());
    for (auto&& node : array) result.push_back(convert(node, origin, located));
    return result;
}

void append_text(std::string& out, const Value& value) {
    if (out.size() > shown_characters) return;
    if (const List* list = value.list()) {
        out += '[';
        for (std::size_t i = 0; i < list->size() && out.size() <= shown_characters; ++i) {
            if (i) out += ", ";
            append_text(out, (*list)[i]);
        }
        out += ']';
    } else if (const auto* text = std::get_if<std::string>(&value.data)) {
        out.append("\"").append(*text).append("\"");
    } else if (const auto* number = std::get_if<double>(&value.data)) {
        out += fmt::format("{}", *number);
    } else if (const auto* integer = std::get_if<std::int64_t>(&value.data)) {
        out += fmt::format("{}", *integer);
    } else if (const auto* flag = std::get_if<bool>(&value.data)) {
        out += *flag ? "true" : "false";
    } else {
        out += value.table() ? "{...}" : "a date";
    }
}

}  // namespace

Value convert(const toml::node& node, const Origin& origin, bool located) {
    Value value{Date{}, place_of(node.source(), origin, located)};
    if (const auto* table = node.as_table()) value.data = convert_table(*table, origin, located);
    else if (const auto* array = node.as_array()) value.data = convert_list(*array, origin, located);
    else if (const auto* text = node.as_string()) value.data = text->get();
    else if (const auto* number = node.as_floating_point()) value.data = number->get();
    else if (const auto* integer = node.as_integer()) value.data = integer->get();
    else if (const auto* flag = node.as_boolean()) value.data = flag->get();
    return value;
}

std::string Place::text() const {
    const std::string name = origin ? *origin : "scene";
    return line ? fmt::format("{}:{}:{}", name, line, column) : name;
}

const Value* Value::find(std::string_view key) const {
    const Table* entries = table();
    if (!entries) return nullptr;
    const auto found = std::find_if(entries->begin(), entries->end(), [&](const Entry& e) { return e.key == key; });
    return found == entries->end() ? nullptr : &found->value;
}

std::string Value::type() const {
    static const char* const names[] = {"a table",    "an array",      "a string", "a number",
                                        "an integer", "true or false", "a date"};
    return names[data.index()];
}

std::string Value::text() const {
    std::string out;
    append_text(out, *this);
    if (out.size() <= shown_characters) return out;
    std::size_t end = shown_characters;
    while (end > 0 && (static_cast<unsigned char>(out[end]) & 0xC0) == 0x80) --end;  // not inside a UTF-8 character
    return out.substr(0, end) + "...";
}

std::string Node::key_of(std::string_view name) const {
    return key.empty() ? std::string(name) : fmt::format("{}.{}", key, name);
}

Node Node::child(std::string_view name) const {
    static const Value nothing{Table{}, {}};
    if (const Value* found = value->find(name)) return {found, found->place, key_of(name)};
    return {&nothing, place, key_of(name)};
}

void fail(const Node& node, const std::string& why) {
    if (node.value->table()) throw InputError(fmt::format("{}: key '{}': {}", node.place.text(), node.key, why));
    throw InputError(fmt::format("{}: key '{}' = {}: {}", node.place.text(), node.key, node.value->text(), why));
}

Value parse_document(const std::string& text, const std::string& name) {
    const auto origin = std::make_shared<const std::string>(name);
    try {
        const toml::table table = toml::parse(std::string_view(text), std::string_view(name));
        Value document = convert(table, origin, true);
        document.place = {origin, 1, 1};
        return document;
    } catch (const toml::parse_error& e) {
        throw InputError(
            fmt::format("{}: not valid TOML: {}", place_of(e.source(), origin, true).text(), e.description()));
    }
}

}  // namespace grainray::scene
