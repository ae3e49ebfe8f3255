#include "scene/polygon.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "scene/csv.hpp"

namespace grainray::scene {
namespace {

using Json = nlohmann::json;

void add_ring(const Json& coordinates, Polygon& polygon) {
    auto& ring = polygon.rings.emplace_back();
    for (const Json& point : coordinates) ring.push_back({point.at(0).get<double>(), point.at(1).get<double>()});
}

/// Features and collections hold geometries at any depth.
void add_geometries(const Json& json, Polygon& polygon) {
    const std::string type = json.value("type", "");
    if (type == "Polygon")
        for (const Json& ring : json.at("coordinates")) add_ring(ring, polygon);
    if (type == "MultiPolygon")
        for (const Json& part : json.at("coordinates"))
            for (const Json& ring : part) add_ring(ring, polygon);
    if (json.contains("geometry") && json["geometry"].is_object()) add_geometries(json["geometry"], polygon);
    for (const char* list : {"features", "geometries"})
        if (json.contains(list))
            for (const Json& member : json[list]) add_geometries(member, polygon);
}

void add_rows(std::istream& in, const std::string& file, Polygon& polygon) {
    std::string row;
    std::size_t line = 0;
    if (!next_csv_row(in, row, line)) reject_row(file, 1, "is empty; expected the header x,y");
    const auto header = split_row(row);
    const auto x = std::find(header.begin(), header.end(), "x") - header.begin(), y = std::find(header.begin(), header.end(), "y") - header.begin();
    const auto width = static_cast<std::ptrdiff_t>(header.size());
    if (x == width || y == width) reject_row(file, line, "the header has no columns 'x' and 'y'; give the corners of the outline under x,y");
    auto& ring = polygon.rings.emplace_back();
    while (next_csv_row(in, row, line)) {
        const auto cells = split_row(row);
        if (static_cast<std::ptrdiff_t>(cells.size()) != width) reject_row(file, line, fmt::format("has {} values, the header has {} columns", cells.size(), width));
        ring.push_back({csv_number(cells[static_cast<std::size_t>(x)], "x", file, line), csv_number(cells[static_cast<std::size_t>(y)], "y", file, line)});
    }
}

template <class Choose>
Point2 extreme(const Polygon& p, const Choose& choose) {
    Point2 most = p.rings.front().front();
    for (const auto& ring : p.rings)
        for (const Point2& q : ring) most = {choose(most.x, q.x), choose(most.y, q.y)};
    return most;
}

}  // namespace

bool Polygon::contains(double x, double y) const {
    bool inside = false;
    for (const auto& ring : rings)
        for (std::size_t k = 0, last = ring.size() - 1; k < ring.size(); last = k++) {
            const Point2 &a = ring[k], &b = ring[last];
            if ((a.y > y) != (b.y > y) && x < a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y))) inside = !inside;
        }
    return inside;
}
Point2 Polygon::lower() const { return extreme(*this, [](double a, double b) { return std::min(a, b); }); }
Point2 Polygon::upper() const { return extreme(*this, [](double a, double b) { return std::max(a, b); }); }

Polygon read_polygon(const std::filesystem::path& path, const std::string& place) {
    std::ifstream in(path);
    std::error_code ignored;
    if (!in || std::filesystem::is_directory(path, ignored))
        throw InputError(fmt::format("{}{} cannot be read; give a CSV or GeoJSON file, relative to the scene file", place, path.string()));
    Polygon polygon;
    if ((in >> std::ws).peek() == '{') {
        try {
            add_geometries(Json::parse(in), polygon);
        } catch (const Json::exception& e) {
            throw InputError(fmt::format("{}it is not valid GeoJSON: {}", place, e.what()));
        }
    } else add_rows(in, path.string(), polygon);
    std::erase_if(polygon.rings, [](const auto& ring) { return ring.size() < 3; });
    if (polygon.rings.empty()) throw InputError(place + "it holds no outline of at least three corners; give a polygon");
    return polygon;
}

}  // namespace grainray::scene
