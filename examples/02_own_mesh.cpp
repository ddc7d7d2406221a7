// Three ways to hand over a mesh that is not tafoni's: your own type, Eigen matrices, flat arrays.
// make_solid reads them where they lie, checks them, and returns a solid that owns its data.
#include <tafoni/geometry/eigen_mesh.hpp>
#include <tafoni/geometry/make_solid.hpp>
#include <tafoni/geometry/span_mesh.hpp>

#include <array>
#include <cstdio>
#include <vector>

// A mesh as an engine might keep it: corners that know their place, faces in a list.
namespace engine {
struct point {
    float x, y, z;
};
struct model {
    std::vector<point> points;
    std::vector<std::vector<int>> polygons;
};
}  // namespace engine

// The only thing to write: how to read it.
template <>
struct tafoni::mesh_access<engine::model> {
    static std::size_t vertex_count(engine::model const& m) { return m.points.size(); }
    static vec3 position(engine::model const& m, std::size_t v) {
        auto const& p = m.points[v];
        return vec3{p.x, p.y, p.z};
    }
    static std::size_t face_count(engine::model const& m) { return m.polygons.size(); }
    static std::size_t face_size(engine::model const& m, std::size_t f) { return m.polygons[f].size(); }
    static std::uint64_t corner(engine::model const& m, std::size_t f, std::size_t k) {
        return static_cast<std::uint64_t>(m.polygons[f][k]);
    }
};
static_assert(tafoni::polygon_mesh<engine::model>);

int main() {
    engine::model const brick{
        {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {2, 1, 0}, {0, 0, 1}, {2, 0, 1}, {0, 1, 1}, {2, 1, 1}},
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    tafoni::solid const own = tafoni::make_solid(brick);
    std::printf("own type:    volume %.3f, area %.3f\n", own.volume, own.area);

    Eigen::MatrixXd V(4, 3);
    V << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
    Eigen::MatrixXi F(4, 3);
    F << 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3;
    tafoni::solid const eigen = tafoni::make_solid(tafoni::view_matrices(V, F));
    std::printf("Eigen V, F:  volume %.3f, area %.3f\n", eigen.volume, eigen.area);

    std::array<float, 12> const xyz{0, 0, 0, 3, 0, 0, 0, 3, 0, 0, 0, 3};
    std::vector<unsigned short> corners{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    tafoni::solid const flat = tafoni::make_solid(tafoni::view_triangles(xyz, corners));
    std::printf("flat arrays: volume %.3f, area %.3f\n", flat.volume, flat.area);

    corners.resize(9);  // drop a face: what the library says to an open mesh
    try {
        (void)tafoni::make_solid(tafoni::view_triangles(xyz, corners));
    } catch (tafoni::bad_topology const& error) {
        std::printf("open mesh:   %s\n", error.what());
        return error.code() == tafoni::errc::not_closed ? 0 : 1;
    }
    return 1;
}
