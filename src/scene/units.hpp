// Physical units of scene values: "5 mm", "2 g/cm^3", "60 rpm". Plain numbers are in the unit the field names.
#pragma once

#include <string>
#include <string_view>

namespace grainray::scene {

/// Unit of a field: the one plain numbers have, and others that messages offer.
struct Unit {
    std::string_view symbol, others;
};

namespace unit {
inline constexpr Unit none{"", ""};
inline constexpr Unit length{"m", "mm, cm, km, um"};
inline constexpr Unit time{"s", "ms, us, min, h"};
inline constexpr Unit speed{"m/s", "mm/s, cm/s, km/h"};
inline constexpr Unit acceleration{"m/s^2", "cm/s^2, mm/s^2"};
inline constexpr Unit density{"kg/m^3", "g/cm^3, t/m^3"};
inline constexpr Unit stiffness{"N/m", "N/mm, kN/m, MN/m"};
inline constexpr Unit angle{"rad", "deg"};
inline constexpr Unit view_angle{"deg", "rad"};
inline constexpr Unit rotation{"rad/s", "deg/s, rpm"};
inline constexpr Unit frequency{"Hz", "kHz, 1/s"};
inline constexpr Unit mass{"kg", "g, mg, t"};
inline constexpr Unit per_time{"1/s", "1/min, 1/h"};
inline constexpr Unit mass_rate{"kg/s", "g/s, kg/h, t/h"};
}  // namespace unit

/// A quantity read from text in the unit of its field, or (problem not empty) why it could not be.
struct Quantity {
    double value = 0;
    std::string problem;
};
Quantity parse_quantity(std::string_view text, const Unit&);

}  // namespace grainray::scene
