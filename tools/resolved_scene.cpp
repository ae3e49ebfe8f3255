#include "resolved_scene.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "scene/value.hpp"

namespace grainray::cli {
namespace {

using scene::Entry;
using scene::Value;

std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += fmt::format("\\{}", c);
        else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) out += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
        else out += c;
    }
    return out + '"';
}

std::string key_text(const std::string& key) {
    const bool bare = !key.empty() && key.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-") == std::string::npos;
    return bare ? key : quoted(key);
}

/// A TOML float has a point, an exponent, or is inf or nan.
std::string number_text(double number) {
    std::string text = fmt::format("{}", number);
    return std::isfinite(number) && text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

std::string inline_text(const Value& value) {
    std::string out;
    if (const auto* list = value.list()) {
        for (const Value& item : *list) out += (out.empty() ? "[" : ", ") + inline_text(item);
        return out.empty() ? "[]" : out + ']';
    }
    if (const auto* table = value.table()) {
        for (const Entry& e : *table) out += (out.empty() ? "{ " : ", ") + key_text(e.key) + " = " + inline_text(e.value);
        return out.empty() ? "{}" : out + " }";
    }
    if (const auto* text = std::get_if<std::string>(&value.data)) return quoted(*text);
    if (const auto* number = std::get_if<double>(&value.data)) return number_text(*number);
    if (const auto* integer = std::get_if<std::int64_t>(&value.data)) return fmt::format("{}", *integer);
    return std::get<bool>(value.data) ? "true" : "false";
}

/// Plain keys first, then a [section] for every table below: order among tables is kept, which ids depend on.
void write_table(const scene::Table& table, const std::string& path, std::string& out) {
    for (const Entry& e : table)
        if (!e.value.table()) out += fmt::format("{} = {}\n", key_text(e.key), inline_text(e.value));
    for (const Entry& e : table) {
        if (!e.value.table()) continue;
        const std::string inner = path.empty() ? key_text(e.key) : path + '.' + key_text(e.key);
        out += fmt::format("\n[{}]\n", inner);
        write_table(*e.value.table(), inner, out);
    }
}

Value* find(Value& parent, const std::string& key) { return const_cast<Value*>(std::as_const(parent).find(key)); }

/// Makes one path absolute; true where it changed.
bool make_absolute(Value* table, const char* key, const Scene& scene) {
    Value* path = table ? find(*table, key) : nullptr;
    auto* text = path ? std::get_if<std::string>(&path->data) : nullptr;
    if (!text || std::filesystem::path(*text).is_absolute()) return false;
    *text = std::filesystem::absolute(scene.file.parent_path() / *text).lexically_normal().string();
    return true;
}

/// Makes the paths of all files that the scene reads absolute; true where one changed.
bool make_paths_absolute(Value& document, const Scene& scene) {
    bool changed = false;
    for (const char* parent : {"particles", "planes", "meshes", "streams"}) {
        Value* tables = find(document, parent);
        for (const Entry& e : tables && tables->table() ? *tables->table() : scene::Table{}) {
            Value* table = find(*tables, e.key);
            for (const char* key : {"path", "file", "polygon"}) changed = make_absolute(table, key, scene) || changed;
            changed = make_absolute(find(*table, "motion"), "path", scene) || changed;
        }
    }
    for (const char* key : {"after", "before"}) changed = make_absolute(find(document, "terrain"), key, scene) || changed;
    return changed;
}

}  // namespace

std::string resolved_text(const Scene& scene, const std::vector<std::string>& overrides) {
    Value document = scene::parse_document(scene.source, scene.file.string());
    for (const std::string& setting : overrides) scene::apply_override(document, setting);
    if (!make_paths_absolute(document, scene) && overrides.empty()) return scene.source;
    std::string out = fmt::format("# {} as it was run", scene.file.string());
    for (const std::string& setting : overrides) out += "\n#   --set " + setting;
    out += '\n';
    write_table(*document.table(), "", out);
    return out;
}

}  // namespace grainray::cli
