// --set key.path=value: changes the document before it is read, so that one set of checks serves both.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "scene/convert.hpp"

namespace grainray::scene {
namespace {

[[noreturn]] void reject(const Origin& origin, const std::string& why) {
    throw InputError(fmt::format("{}: {}", *origin, why));
}

/// The parts of a dotted key, quoted parts included; empty where it is not one key.
std::vector<std::string> split_key(const std::string& key) {
    std::vector<std::string> path;
    try {
        const toml::table parsed = toml::parse(key + "=0");
        const toml::node* node = &parsed;
        while (const toml::table* table = node->as_table()) {
            if (table->size() != 1) return {};
            path.emplace_back(table->begin()->first.str());
            node = &table->begin()->second;
        }
    } catch (const toml::parse_error&) {
        return {};
    }
    return path;
}

std::optional<Value> parse_value(const std::string& text, const Origin& origin) {
    try {
        const toml::table parsed = toml::parse("v=" + text);
        if (parsed.size() == 1) return convert(*parsed.get("v"), origin, false);
    } catch (const toml::parse_error&) {}
    return std::nullopt;
}

Value value_of(const std::string& text, const Origin& origin) {
    if (text.empty()) reject(origin, "no value after '='; write key=value, or key='\"\"' for an empty string");
    if (auto value = parse_value(text, origin)) return *value;
    if (std::string_view("[{\"'").find(text[0]) != std::string_view::npos)
        reject(origin, fmt::format("'{}' is not a TOML value; check its brackets and quotes", text));
    return {text, {origin, 0, 0}};
}

Value& element(Value& list, const std::string& part, const Origin& origin) {
    auto& items = std::get<List>(list.data);
    const bool digits = !part.empty() && part.size() < 10 &&
                        std::all_of(part.begin(), part.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (!digits || std::stoul(part) >= items.size())
        reject(origin,
               fmt::format("'{}' is no element of an array of {}; elements are numbered from 0", part, items.size()));
    return items[std::stoul(part)];
}

Value& entry(Value& parent, const std::string& part, const Origin& origin) {
    auto& entries = std::get<Table>(parent.data);
    for (Entry& e : entries)
        if (e.key == part) return e.value;
    entries.push_back({part, {origin, 0, 0}, Value{Table{}, {origin, 0, 0}}});
    return entries.back().value;
}

}  // namespace

void apply_override(Value& document, const std::string& setting) {
    const auto origin = std::make_shared<const std::string>("--set " + setting);
    const auto equals = setting.find('=');
    if (equals == std::string::npos) reject(origin, "expected key=value, for example --set simulation.dt=5e-4");
    const auto path = split_key(setting.substr(0, equals));
    if (path.empty())
        reject(origin, fmt::format("'{}' is not a key; write it as in the scene, for example simulation.dt",
                                   setting.substr(0, equals)));

    Value* target = &document;
    std::string walked;
    for (const std::string& part : path) {
        if (target->list()) target = &element(*target, part, origin);
        else if (target->table()) target = &entry(*target, part, origin);
        else
            reject(origin, fmt::format("key '{}' is {}, not a table, so it has no '{}'", walked, target->type(), part));
        walked += (walked.empty() ? "" : ".") + part;
    }
    const auto begin = setting.find_first_not_of(" \t", equals + 1);
    *target = value_of(begin == std::string::npos ? "" : setting.substr(begin), origin);
}

}  // namespace grainray::scene
