// The table of frame fields: every format writes and reads through it, so that a new field is one new row.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "grainray/output.hpp"

namespace grainray {

using FieldMember = std::variant<std::vector<float> Frame::*, std::vector<Vec3f> Frame::*, std::vector<std::uint32_t> Frame::*>;

/// A value per particle. All elements are 32 bits wide: one (float, uint32) or three (Vec3f) a particle.
struct Field {
    std::string name;                  ///< in scenes and VTP files
    std::vector<std::string> columns;  ///< in CSV files
    FieldMember member;

    bool is_integer() const { return member.index() == 2; }
    std::size_t components() const { return columns.size(); }
    std::span<const std::byte> bytes(const Frame&) const;
    /// Resized to n particles, zero where new.
    std::span<std::byte> resized_bytes(Frame&, std::size_t n) const;
};

const std::vector<Field>& field_table();
/// nullptr where there is none of that name.
const Field* find_field(const std::string& name);

/// The fields to write, in table order; names empty means all the frame has. Throws InputError for an unknown name
/// and for a field the frame lacks.
std::vector<const Field*> selected_fields(const Frame&, const std::vector<std::string>& names);

/// "unknown WHAT 'x'; did you mean 'y'? Known: ..."
std::string unknown_name(const std::string& what, const std::string& name, const std::vector<std::string>& known);

}  // namespace grainray
