// One row of the field table: key, unit, default, range and meaning of a struct member. The same row reads the member
// from TOML, checks it, explains it in messages and documents it.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "grainray/scene.hpp"
#include "scene/suggest.hpp"
#include "scene/units.hpp"
#include "scene/value.hpp"

namespace grainray::scene {

/// Interval of allowed numbers; an open end excludes its bound.
struct Range {
    double lower = -std::numeric_limits<double>::infinity(), upper = std::numeric_limits<double>::infinity();
    bool open_lower = false, open_upper = false;
    bool contains(double) const;
    std::string text(const Unit&) const;  ///< "greater than 0 s"
};

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr Range positive{0, infinity, true, false};
inline constexpr Range non_negative{0, infinity, false, false};

struct FieldInfo {
    std::string_view key;
    std::string_view text;               ///< meaning, for the docs
    Unit unit{};
    Range range{};
    std::string_view typical{};          ///< a good value, for messages
    std::vector<std::string_view> choices{};  ///< of a string or an enum (in the order of its values)
    bool required = false;
    std::string fallback{};              ///< the default as text; empty: what a default-constructed struct holds
    std::string type{};                  ///< filled in from the member
};

// Readers: throw InputError where the value has the wrong type, unit or range.
void read(const Node&, const FieldInfo&, double&);
void read(const Node&, const FieldInfo&, std::int64_t&);
void read(const Node&, const FieldInfo&, std::uint64_t&);
void read(const Node&, const FieldInfo&, bool&);
void read(const Node&, const FieldInfo&, std::string&);
void read(const Node&, const FieldInfo&, Vec3d&);
void read(const Node&, const FieldInfo&, std::vector<double>&);  ///< one number or an array
/// A number of particles, or a mass where the text has its unit; both a time where the field's unit is 1/s.
void read(const Node&, const FieldInfo&, Amount&);
std::size_t read_choice(const Node&, const FieldInfo&);
/// The elements of an array of `count` (0: any number of) values; throws where it is none.
std::vector<Node> elements(const Node&, std::size_t count, const std::string& what);

template <class E>
    requires std::is_enum_v<E>
void read(const Node& node, const FieldInfo& field, E& out) {
    out = static_cast<E>(read_choice(node, field));
}
template <class T>
void read(const Node& node, const FieldInfo& field, std::optional<T>& out) {
    read(node, field, out.emplace());
}

// Names of types and defaults, as the docs show them.
template <class T>
struct TypeText {
    static std::string name(const FieldInfo&) { return "choice"; }
    static std::string show(const T& value, const FieldInfo& field) {
        return std::string("\"").append(field.choices[static_cast<std::size_t>(value)]).append("\"");
    }
};
#define GRAINRAY_TYPE_TEXT(T)                            \
    template <>                                          \
    struct TypeText<T> {                                 \
        static std::string name(const FieldInfo&);       \
        static std::string show(const T&, const FieldInfo&); \
    }
GRAINRAY_TYPE_TEXT(double);
GRAINRAY_TYPE_TEXT(std::int64_t);
GRAINRAY_TYPE_TEXT(std::uint64_t);
GRAINRAY_TYPE_TEXT(bool);
GRAINRAY_TYPE_TEXT(std::string);
GRAINRAY_TYPE_TEXT(Vec3d);
GRAINRAY_TYPE_TEXT(Amount);
#undef GRAINRAY_TYPE_TEXT
template <class T>
struct TypeText<std::optional<T>> {
    static std::string name(const FieldInfo& f) { return TypeText<T>::name(f); }
    static std::string show(const std::optional<T>&, const FieldInfo&) { return "none"; }
};
template <class T>
struct TypeText<std::vector<T>> {
    static std::string name(const FieldInfo& f) { return "list of " + TypeText<T>::name(f); }
    static std::string show(const std::vector<T>&, const FieldInfo&) { return "[]"; }
};
template <class T, std::size_t N>
struct TypeText<std::array<T, N>> {
    static std::string name(const FieldInfo& f) { return std::to_string(N) + " x " + TypeText<T>::name(f); }
    static std::string show(const std::array<T, N>& values, const FieldInfo& f) {
        std::string out;
        for (const T& value : values) out.append(out.empty() ? "[" : ", ").append(TypeText<T>::show(value, f));
        return out.append("]");
    }
};

template <class T, std::size_t N>
void read(const Node& node, const FieldInfo& field, std::array<T, N>& out) {
    const auto items = elements(node, N, TypeText<T>::name(field));
    for (std::size_t i = 0; i < N; ++i) read(items[i], field, out[i]);
}
template <class T>
void read(const Node& node, const FieldInfo& field, std::vector<T>& out) {
    out.clear();
    for (const Node& item : elements(node, 0, TypeText<T>::name(field))) read(item, field, out.emplace_back());
}

template <class Row>
struct Field : FieldInfo {
    std::function<void(Row&, const Node&, const FieldInfo&)> assign;
};

template <class Row, class T>
Field<Row> field(T Row::* member, FieldInfo info) {
    info.type = TypeText<T>::name(info);
    if (info.fallback.empty()) info.fallback = TypeText<T>::show(Row{}.*member, info);
    return {std::move(info), [member](Row& row, const Node& node, const FieldInfo& f) { read(node, f, row.*member); }};
}

/// The fields of one table of the scene, "materials.NAME".
template <class Row>
struct Section {
    std::string_view name, text;
    std::vector<Field<Row>> fields;
};

template <class Row>
void append_keys(std::vector<std::string_view>& keys, const Section<Row>& section) {
    for (const auto& f : section.fields) keys.push_back(f.key);
}

[[noreturn]] void fail_missing(const Node& table, const FieldInfo&);
/// Throws for a node that is no table, and for a key that is not in `known`; `of` says what the keys belong to.
void check_keys(const Node& table, std::vector<std::string_view> known, const std::string& of = "");

/// Reads the fields of a section that the table holds into `row`. Keys of the table are checked elsewhere.
template <class Row>
void read_fields(const Node& table, const Section<Row>& section, Row& row) {
    for (const auto& f : section.fields) {
        if (table.has(f.key)) f.assign(row, table.child(f.key), f);
        else if (f.required) fail_missing(table, f);
    }
}

/// Reads a whole table: the fields of a section and, for the caller, the tables named in `subtables`.
template <class Row>
void read_table(const Node& table, const Section<Row>& section, Row& row, std::vector<std::string_view> subtables = {}) {
    append_keys(subtables, section);
    check_keys(table, std::move(subtables));
    read_fields(table, section, row);
}

}  // namespace grainray::scene
