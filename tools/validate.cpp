// grainray validate: every case with a known answer in one table.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "commands.hpp"
#include "grainray/validation.hpp"

namespace grainray::cli {
namespace {

std::string number(double v) { return fmt::format("{:.6g}", v); }

/// The difference as the tolerance counts it.
std::string difference(const ValidationResult& r) {
    const double d = r.got - r.expected;
    return r.relative ? fmt::format("{:+.2g} %", 100 * d / std::abs(r.expected)) : fmt::format("{:+.2g}", d);
}
std::string tolerance(const ValidationResult& r) {
    if (!r.gated) return "-";
    return r.relative ? fmt::format("{:.2g} %", 100 * r.tolerance) : fmt::format("{:.2g}", r.tolerance);
}

using Row = std::array<std::string, 8>;

Row row(const ValidationResult& r) {
    return {r.name, r.quantity, number(r.expected), number(r.got), difference(r), tolerance(r), r.source, r.gated ? r.pass ? "pass" : "FAIL" : "shown"};
}

void print(const std::vector<Row>& rows) {
    std::array<std::size_t, 8> width{};
    for (const Row& r : rows)
        for (std::size_t c = 0; c < r.size(); ++c) width[c] = std::max(width[c], r[c].size());
    for (const Row& r : rows) {
        std::string line;
        for (std::size_t c = 0; c < r.size(); ++c)
            line += c >= 2 && c <= 5 ? fmt::format("{:>{}}  ", r[c], width[c]) : fmt::format("{:<{}}  ", r[c], width[c]);
        fmt::print("{}\n", line.substr(0, line.find_last_not_of(' ') + 1));
    }
}

}  // namespace

int run_validate(const std::vector<std::string>& only, bool quick) {
    const std::vector<ValidationResult> results = validate(only, quick);
    std::vector<Row> rows{{"case", "quantity", "expected", "got", "difference", "tolerance", "source", "result"}};
    std::transform(results.begin(), results.end(), std::back_inserter(rows), row);
    print(rows);
    const auto failed = std::count_if(results.begin(), results.end(), [](const auto& r) { return !r.pass; });
    const auto gated = std::count_if(results.begin(), results.end(), [](const auto& r) { return r.gated; });
    fmt::print("\n{} of {} figures within tolerance\n", gated - failed, gated);
    return failed ? simulation_failed : done;
}

}  // namespace grainray::cli
