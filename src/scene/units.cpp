#include "scene/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

namespace grainray::scene {
namespace {

/// Value in SI and the powers of metre, kilogram, second and radian.
struct Measure {
    double factor = 1;
    std::array<int, 4> powers{};
};

struct NamedUnit {
    std::string_view name;
    Measure measure;
};

constexpr double pi = std::numbers::pi;
constexpr NamedUnit known[] = {
    {"m", {1, {1, 0, 0, 0}}},     {"km", {1e3, {1, 0, 0, 0}}},   {"cm", {1e-2, {1, 0, 0, 0}}}, {"mm", {1e-3, {1, 0, 0, 0}}},
    {"um", {1e-6, {1, 0, 0, 0}}}, {"kg", {1, {0, 1, 0, 0}}},     {"g", {1e-3, {0, 1, 0, 0}}},  {"mg", {1e-6, {0, 1, 0, 0}}},
    {"t", {1e3, {0, 1, 0, 0}}},   {"s", {1, {0, 0, 1, 0}}},      {"ms", {1e-3, {0, 0, 1, 0}}}, {"us", {1e-6, {0, 0, 1, 0}}},
    {"min", {60, {0, 0, 1, 0}}},  {"h", {3600, {0, 0, 1, 0}}},   {"N", {1, {1, 1, -2, 0}}},    {"kN", {1e3, {1, 1, -2, 0}}},
    {"MN", {1e6, {1, 1, -2, 0}}}, {"rad", {1, {0, 0, 0, 1}}},    {"deg", {pi / 180, {0, 0, 0, 1}}},
    {"rpm", {2 * pi / 60, {0, 0, -1, 1}}}, {"Hz", {1, {0, 0, -1, 0}}}, {"kHz", {1e3, {0, 0, -1, 0}}},
    {"%", {1e-2, {0, 0, 0, 0}}},  {"1", {1, {0, 0, 0, 0}}},
};

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
    return text;
}

/// One factor: a name with an exponent, "s^2", "m3".
std::optional<Measure> parse_factor(std::string_view text) {
    text = trimmed(text);
    int exponent = 1;
    const auto split = text.size() > 1 ? text.find_first_of("^-0123456789", 1) : std::string_view::npos;
    if (split != std::string_view::npos) {
        const auto digits = text.substr(text[split] == '^' ? split + 1 : split);
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
        if (error != std::errc{} || end != digits.data() + digits.size() || std::abs(exponent) > 9) return std::nullopt;
        text = text.substr(0, split);
    }
    for (const auto& [name, measure] : known) {
        if (name != text) continue;
        Measure result{std::pow(measure.factor, exponent), measure.powers};
        for (int& power : result.powers) power *= exponent;
        return result;
    }
    return std::nullopt;
}

/// Factors joined by '*' and '/'. Empty text is the number one.
std::optional<Measure> parse_unit(std::string_view text) {
    Measure product;
    char joint = '*';
    while (!trimmed(text).empty()) {
        const auto end = std::min(text.find_first_of("*/"), text.size());
        const auto factor = parse_factor(text.substr(0, end));
        if (!factor) return std::nullopt;
        const int sign = joint == '/' ? -1 : 1;
        product.factor *= sign < 0 ? 1 / factor->factor : factor->factor;
        for (std::size_t i = 0; i < 4; ++i) product.powers[i] += sign * factor->powers[i];
        if (end == text.size()) return product;
        joint = text[end];
        text.remove_prefix(end + 1);
        if (trimmed(text).empty()) return std::nullopt;  // nothing after the joint
    }
    return product;
}

std::string accepted(const Unit& unit) {
    if (unit.symbol.empty()) return "this number has no unit";
    return fmt::format("accepted units: {}, {}", unit.symbol, unit.others);
}

}  // namespace

Quantity parse_quantity(std::string_view text, const Unit& unit) {
    const auto body = trimmed(text);
    double number = 0;
    const char* const end = body.data() + body.size();
    const auto [rest, error] = std::from_chars(body.data(), end, number);
    if (error != std::errc{}) return {0, fmt::format("expected a number, found no digits; {}", accepted(unit))};
    const auto symbol = trimmed(std::string_view(rest, static_cast<std::size_t>(end - rest)));
    if (symbol.empty()) return {number, ""};
    const auto wanted = parse_unit(unit.symbol), given = parse_unit(symbol);
    if (!given) return {0, fmt::format("unknown unit '{}'; {}", symbol, accepted(unit))};
    if (given->powers != wanted->powers) return {0, fmt::format("unit '{}' has the wrong dimension; {}", symbol, accepted(unit))};
    return {number * (given->factor / wanted->factor), ""};
}

}  // namespace grainray::scene
