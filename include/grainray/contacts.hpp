// Contact laws and their parameters. A law is a small functor that sees one contact and returns the force; the pair loop
// (src/contacts/contacts.cpp) owns lists and memory. src/contacts/linear.hpp is the example to copy.
#pragma once

#include "grainray/core.hpp"

namespace grainray {

/// What two materials do in contact, as kernels read it.
struct PairParameters {
    float kn, kt;  ///< stiffness, N/m
    float mu;      ///< Coulomb coefficient
    float cn, ct;  ///< damping a root of mass: c = cn sqrt(m), with cn = 2 beta sqrt(k), N s/m/sqrt(kg)
};

/// One contact, seen from particle i. Every sign flips exactly when seen from j, so each side computes the same bits.
struct Contact {
    Vec3f normal;     ///< unit, from j to i
    float overlap;    ///< r_i + r_j - d, m
    Vec3f velocity;   ///< of i against j at the contact point, m/s
    float mean_mass;  ///< of the two; the particle's own against a wall, kg
};

enum class ContactLaw { linear };

/// Throws InputError that lists the laws.
ContactLaw contact_law(const std::string& name);

}  // namespace grainray
