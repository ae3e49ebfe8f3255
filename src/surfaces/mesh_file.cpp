// STL and OBJ by way of assimp.
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>

#include <fmt/format.h>

#include "surfaces/surfaces.hpp"

namespace grainray::surfaces {
namespace {

std::string lower_case(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// What a reader would stumble over without saying it well.
void check_file(const std::filesystem::path& path, const std::string& place) {
    const std::string kind = lower_case(path.extension().string());
    if (kind != ".stl" && kind != ".obj")
        throw InputError(fmt::format("{}meshes are read from STL and OBJ files; convert it to one of them", place));
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
        throw InputError(fmt::format("{}{} is not there or no file; give a path relative to the scene file", place, path.string()));
    std::ifstream in(path, std::ios::binary);
    if (!in) throw InputError(fmt::format("{}{} cannot be read; check its permissions", place, path.string()));
    if (kind != ".stl") return;
    char head[84] = {};
    in.read(head, sizeof head);
    const auto size = std::filesystem::file_size(path, error);
    if (in.gcount() == sizeof head && std::string_view(head, 5) != "solid") {
        std::uint32_t count = 0;
        for (int k = 3; k >= 0; --k) count = count << 8 | static_cast<unsigned char>(head[80 + k]);
        if (count == 0) throw InputError(place + "it holds no triangle; give a file with a surface of triangles");
        if (size < 84 + std::uint64_t{50} * count)
            throw InputError(fmt::format("{}it is cut off: its head counts {} triangles ({} bytes) and the file has {} bytes; copy it again", place, count,
                                         84 + std::uint64_t{50} * count, size));
    }
}

}  // namespace

TriangleMesh read_mesh_file(const std::filesystem::path& path, const std::string& place) {
    check_file(path, place);
    Assimp::Importer importer;
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    const aiScene* read = importer.ReadFile(path.string(), aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_PreTransformVertices);
    TriangleMesh m;
    for (unsigned k = 0; read && k < read->mNumMeshes; ++k) {
        const aiMesh& part = *read->mMeshes[k];
        const auto first = static_cast<std::uint32_t>(m.vertices.size());
        for (unsigned v = 0; v < part.mNumVertices; ++v) {
            const aiVector3D& p = part.mVertices[v];
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
                throw InputError(place + "a corner is not a finite number; export the file again");
            m.vertices.push_back({p.x, p.y, p.z});
        }
        for (unsigned f = 0; f < part.mNumFaces; ++f)
            if (part.mFaces[f].mNumIndices == 3)
                m.triangles.push_back({first + part.mFaces[f].mIndices[0], first + part.mFaces[f].mIndices[1], first + part.mFaces[f].mIndices[2]});
    }
    if (!m.triangles.empty()) return m;
    std::string why = importer.GetErrorString();
    throw InputError(place + (why.empty() || why.find("empty") != std::string::npos || why.find("No output meshes") != std::string::npos ? "it holds no triangle; give a file with a surface of triangles"
                                                                                       : "it cannot be read as a mesh (" + why + "); export it again as binary STL"));
}

}  // namespace grainray::surfaces
