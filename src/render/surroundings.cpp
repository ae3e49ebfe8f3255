#include "render/surroundings.hpp"

#include <limits>
#include <map>

namespace grainray::picture {

namespace {

constexpr double crease = 0.77;  // cosine of the angle between facets (40 degrees) from which their edge is seen

/// A place of the mesh's own frame in the world, or with `direction` a direction.
struct Pose {
    Vec3d at;
    const Motion& motion;
    double angle;

    Pose(const Mesh& mesh, double time) : motion(mesh.motion) {
        const MotionState now = motion_at(mesh.motion, time);
        angle = now.angle;
        at = turn(mesh.translation - motion.rotation_point) + motion.rotation_point + now.shift;
    }
    Vec3d turn(const Vec3d& v) const { return angle != 0 ? turned(v, motion.rotation_axis, angle) : v; }
    Vec3d place(const Vec3d& v) const { return at + turn(v); }
};

using Corners = std::array<std::uint32_t, 3>;

Vec3d scaled_normal(const TriangleMesh& m, const Corners& t) {
    return cross(m.vertices[t[1]] - m.vertices[t[0]], m.vertices[t[2]] - m.vertices[t[0]]);
}

/// Smooth over shallow edges, sharp over creases.
std::vector<Vec3d> corner_normals(const TriangleMesh& m, const std::vector<Vec3d>& facing) {
    std::vector<std::vector<std::uint32_t>> around(m.vertices.size());
    for (std::uint32_t t = 0; t < m.triangles.size(); ++t)
        for (const std::uint32_t v : m.triangles[t]) around[v].push_back(t);
    std::vector<Vec3d> result;
    result.reserve(3 * m.triangles.size());
    for (std::uint32_t t = 0; t < m.triangles.size(); ++t)
        for (const std::uint32_t v : m.triangles[t]) {
            Vec3d sum;
            for (const std::uint32_t other : around[v])
                if (dot(normalized(facing[t]), normalized(facing[other])) > crease) sum += facing[other];
            result.push_back(normalized(sum));
        }
    return result;
}

std::vector<std::array<Vec3d, 2>> seen_edges(const TriangleMesh& m, const std::vector<Vec3d>& facing) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> sides;
    for (std::uint32_t t = 0; t < m.triangles.size(); ++t)
        for (int e = 0; e < 3; ++e) sides[std::minmax(m.triangles[t][e], m.triangles[t][(e + 1) % 3])].push_back(t);
    std::vector<std::array<Vec3d, 2>> edges;
    for (const auto& [edge, beside] : sides)
        if (beside.size() != 2 || dot(normalized(facing[beside[0]]), normalized(facing[beside[1]])) < crease)
            edges.push_back({m.vertices[edge.first], m.vertices[edge.second]});
    return edges;
}

void include(Box& box, const Vec3d& p) {
    for (int axis = 0; axis < 3; ++axis) {
        box.lower[axis] = std::min(box.lower[axis], p[axis]);
        box.upper[axis] = std::max(box.upper[axis], p[axis]);
    }
}

}  // namespace

Surroundings::Surroundings(const Scene& scene) {
    for (const Mesh& mesh : scene.meshes) meshes_.push_back(shape_of(scene, mesh));
    if (scene.terrain) ground_ = load_ground(scene);
}

Surroundings::Shape Surroundings::shape_of(const Scene& scene, const Mesh& mesh) {
    const TriangleMesh m = load_mesh(scene, mesh);
    std::vector<Vec3d> facing;
    for (const Corners& t : m.triangles) facing.push_back(scaled_normal(m, t));
    Shape shape{mesh, {}, corner_normals(m, facing), seen_edges(m, facing)};
    shape.mesh.geometry.reset();
    for (const Corners& t : m.triangles)
        for (const std::uint32_t v : t) shape.vertices.push_back(m.vertices[v]);
    return shape;
}

std::vector<Skin> Surroundings::meshes_at(double time, const Vec3d& origin) const {
    std::vector<Skin> skins;
    for (const Shape& shape : meshes_) {
        const Pose pose(shape.mesh, time);
        const auto local = [&](const Vec3d& v) { return convert<float>(pose.place(v) - origin); };
        Skin skin;
        skin.vertices.reserve(shape.vertices.size() + 1);  // Embree reads 16 bytes of the last one
        for (const Vec3d& v : shape.vertices) skin.vertices.push_back(local(v));
        for (const Vec3d& n : shape.normals) skin.normals.push_back(convert<float>(pose.turn(n)));
        for (std::uint32_t v = 0; v < shape.vertices.size(); v += 3) skin.triangles.push_back({v, v + 1, v + 2});
        for (const auto& [a, b] : shape.edges) skin.edges.push_back({local(a), local(b)});
        skins.push_back(std::move(skin));
    }
    return skins;
}

Box Surroundings::mesh_bounds(double time) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Box box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    for (const Shape& shape : meshes_) {
        const Pose pose(shape.mesh, time);
        for (const Vec3d& v : shape.vertices) include(box, pose.place(v));
    }
    return box;
}

HeightAboveGround::HeightAboveGround(const Scene& scene, const Surroundings& surroundings, double time) : grid_(surroundings.ground()) {
    for (const Plane& plane : scene.planes)
        if (const PlaneState state = plane_at(plane, time); state.normal.z > 0.5) floors_.push_back(state);
    if (!grid_ && floors_.empty())
        throw InputError("render.color_by = \"depth\" is measured from the ground, and the scene has neither terrain nor a plane that faces up; colour by another field");
}

double HeightAboveGround::operator()(const Vec3d& p) const {
    double ground = grid_ ? grid_->height(p.x, p.y) : std::numeric_limits<double>::quiet_NaN();
    for (const PlaneState& f : floors_)
        ground = std::fmax(ground, f.point.z - (f.normal.x * (p.x - f.point.x) + f.normal.y * (p.y - f.point.y)) / f.normal.z);
    return p.z - ground;
}

}  // namespace grainray::picture
