// Does the engine compute what it says? Cases with a known answer: closed forms, the discrete scheme itself, other codes.
#pragma once

#include <string>
#include <vector>

#include "grainray/simulation.hpp"

namespace grainray {

/// One figure of one case beside what it must be.
struct ValidationResult {
    std::string name;      ///< the case
    std::string quantity;  ///< with its unit
    std::string source;    ///< where `expected` comes from
    double expected = 0, got = 0, tolerance = 0;
    bool relative = false;  ///< tolerance is a share of |expected|; else it has the unit of the quantity
    bool pass = false;      ///< |got - expected| within the tolerance
    bool gated = true;      ///< false: shown for comparison, always passes
};

struct ValidationCase {
    std::string name;
    bool quick;  ///< seconds at most; the full columns are not
    std::vector<ValidationResult> (*run)(const ValidationCase&, const SimulationOptions&);
};

/// Every case, in the order of the table.
const std::vector<ValidationCase>& validation_cases();

/// Runs the named cases, or all (quick: without the slow ones). Throws InputError for an unknown name.
std::vector<ValidationResult> validate(const std::vector<std::string>& only, bool quick, const SimulationOptions& = {});

}  // namespace grainray
