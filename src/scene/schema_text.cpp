// The field table as text: `grainray info --schema`, and the generated part of docs/scene.md.
#include <fmt/format.h>

#include <algorithm>

#include "scene/schema.hpp"

namespace grainray {
namespace scene {
namespace {

using Line = std::array<std::string, 5>;

std::string meaning(const FieldInfo& f) {
    std::string out(f.text);
    if (!f.choices.empty()) out += "; one of " + join(f.choices);
    const std::string range = f.range.text({});
    if (!range.empty()) out += "; " + range;
    if (!f.typical.empty()) out += fmt::format("; typical {}", f.typical);
    return out;
}

Line line_of(const FieldInfo& f) {
    return {fmt::format("`{}`", f.key), f.type, std::string(f.unit.symbol), f.required ? "required" : f.fallback,
            meaning(f)};
}

/// A Markdown table whose columns line up, so that it reads well in a terminal too.
std::string table_text(const std::vector<Line>& lines) {
    std::array<std::size_t, 4> width{};
    for (const Line& line : lines)
        for (std::size_t c = 0; c < 4; ++c) width[c] = std::max(width[c], line[c].size());
    std::string out;
    for (const Line& line : lines) {
        for (std::size_t c = 0; c < 4; ++c) out += fmt::format("| {:{}} ", line[c], width[c]);
        out += fmt::format("| {} |\n", line[4]);
        if (&line == &lines.front()) {
            for (std::size_t c = 0; c < 4; ++c) out += fmt::format("|{:-<{}}", "", width[c] + 2);
            out += "|---|\n";
        }
    }
    return out;
}

}  // namespace
}  // namespace scene

std::string schema_text() {
    std::string out;
    scene::schema().each([&](const auto& section) {
        std::vector<scene::Line> lines{{"key", "type", "unit", "default", "meaning"}};
        for (const scene::FieldInfo& f : section.fields) lines.push_back(scene::line_of(f));
        const bool header = section.name.front() != '(' && section.name.front() != '[';
        const auto comma = std::min(section.name.find(','), section.name.size());
        const std::string title = header
                                      ? fmt::format("[{}]{}", section.name.substr(0, comma), section.name.substr(comma))
                                      : std::string(section.name);
        out += fmt::format("{}### {}\n", out.empty() ? "" : "\n", title);
        if (!section.text.empty()) out += fmt::format("{}\n", section.text);
        out.append("\n").append(scene::table_text(lines));
    });
    return out;
}

}  // namespace grainray
