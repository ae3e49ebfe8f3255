// What stands about the particles besides planes: meshes and terrain, loaded once for any number of pictures.
#pragma once

#include <optional>

#include "grainray/scene.hpp"
#include "render/skin.hpp"

namespace grainray::picture {

class Surroundings {
public:
    /// Throws InputError where a file cannot be read.
    explicit Surroundings(const Scene&);

    const ElevationGrid* ground() const { return ground_ ? &*ground_ : nullptr; }
    bool has_meshes() const { return !meshes_.empty(); }
    /// The meshes where their motion has brought them at `time`.
    std::vector<Skin> meshes_at(double time, const Vec3d& origin) const;
    /// Of all meshes at `time`, in the world; they must not be none.
    Box mesh_bounds(double time) const;

private:
    struct Shape {
        Mesh mesh;                                   ///< its motion and translation
        std::vector<Vec3d> vertices, normals;        ///< in the mesh's own frame, three a triangle
        std::vector<std::array<Vec3d, 2>> edges;
    };
    static Shape shape_of(const Scene&, const Mesh&);

    std::vector<Shape> meshes_;
    std::optional<ElevationGrid> ground_;
};

/// The height above the ground, of terrain or else of the planes that face up. Throws InputError where there is neither.
class HeightAboveGround {
public:
    HeightAboveGround(const Scene&, const Surroundings&, double time);
    /// NaN where no ground is below.
    double operator()(const Vec3d&) const;

private:
    const ElevationGrid* grid_;
    std::vector<PlaneState> floors_;
};

}  // namespace grainray::picture
