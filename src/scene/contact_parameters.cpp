// What two materials do in contact: the mixing rule, then the fields that a row of the pair table gives.
#include <algorithm>

#include "grainray/scene.hpp"

namespace grainray {
namespace {

/// Two springs in series, each counted twice as stiff so that equal materials keep their own value.
double in_series(double a, double b) { return a + b > 0 ? 2 * a * b / (a + b) : 0; }

MaterialPair own_values(const Material& m) {
    return {{}, m.normal_stiffness, m.tangential_stiffness, m.friction, m.normal_damping, m.tangential_damping};
}

MaterialPair mixed(const Material& a, const Material& b) {
    return {{},
            in_series(a.normal_stiffness, b.normal_stiffness),
            in_series(a.tangential_stiffness, b.tangential_stiffness),
            std::min(a.friction, b.friction),
            (a.normal_damping + b.normal_damping) / 2,
            (a.tangential_damping + b.tangential_damping) / 2};
}

bool names(const PairRow& row, const Material& a, const Material& b) {
    return (row.materials[0] == a.name && row.materials[1] == b.name) ||
           (row.materials[0] == b.name && row.materials[1] == a.name);
}

}  // namespace

MaterialPair contact_parameters(const Scene& scene, std::size_t a, std::size_t b, bool boundary_b) {
    const Material &first = scene.materials.at(a), &second = scene.materials.at(b);
    MaterialPair pair = boundary_b && scene.contact.mixing == Mixing::wall ? own_values(second) : mixed(first, second);
    pair.materials = {first.name, second.name};
    for (const PairRow& row : scene.pairs) {
        if (!names(row, first, second)) continue;
        pair.normal_stiffness = row.normal_stiffness.value_or(pair.normal_stiffness);
        pair.tangential_stiffness = row.tangential_stiffness.value_or(pair.tangential_stiffness);
        pair.friction = row.friction.value_or(pair.friction);
        pair.normal_damping = row.normal_damping.value_or(pair.normal_damping);
        pair.tangential_damping = row.tangential_damping.value_or(pair.tangential_damping);
    }
    return pair;
}

}  // namespace grainray
