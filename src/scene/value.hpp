// A TOML document as a tree that remembers where every value was written. Only value.cpp and override.cpp know toml++.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "grainray/core.hpp"

namespace grainray::scene {

/// Where a value was written: file:line:column, or the --set that gave it (line 0).
struct Place {
    std::shared_ptr<const std::string> origin;
    std::uint32_t line = 0, column = 0;
    std::string text() const;
};

struct Value;
struct Entry;
using List = std::vector<Value>;
using Table = std::vector<Entry>;  ///< in the order written: ids follow it
struct Date {};                    ///< dates and times: TOML has them, scenes do not

struct Value {
    std::variant<Table, List, std::string, double, std::int64_t, bool, Date> data;
    Place place;

    const Value* find(std::string_view key) const;
    const Table* table() const { return std::get_if<Table>(&data); }
    const List* list() const { return std::get_if<List>(&data); }
    std::string type() const;  ///< "a table", "an integer", ...
    std::string text() const;  ///< as TOML writes it, shortened
};

struct Entry {
    std::string key;
    Place place;
    Value value;
};

/// A value and its full key, as messages name it. A table that the scene lacks is an empty one.
struct Node {
    const Value* value = nullptr;
    Place place;
    std::string key;

    Node child(std::string_view name) const;  ///< the empty table where there is none
    bool has(std::string_view name) const { return value->find(name) != nullptr; }
    std::string key_of(std::string_view name) const;
};

/// Throws InputError "place: key 'key' = value: why".
[[noreturn]] void fail(const Node&, const std::string& why);

/// Throws InputError for text that is not TOML. `name` stands for the file in places.
Value parse_document(const std::string& text, const std::string& name);
/// Applies one "key.path=value". A value that is no TOML value is taken as a string.
void apply_override(Value& document, const std::string& setting);

}  // namespace grainray::scene
