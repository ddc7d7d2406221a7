/// \file
/// CGAL's Surface_mesh, read where it lies.
#ifndef TAFONI_INTEROP_CGAL_SURFACE_MESH_HPP
#define TAFONI_INTEROP_CGAL_SURFACE_MESH_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/geometry/concepts.hpp>

#include <CGAL/Surface_mesh.h>
#include <CGAL/number_utils.h>

#include <cstddef>
#include <cstdint>
#include <string>

namespace tafoni {

/// `CGAL::Surface_mesh<Point>` over any kernel; coordinates of exact kernels are rounded to double.
///
/// A `polygon_mesh`: its type does not say that all faces are triangles, so processes on triangles look at the
/// door and refuse the first face that is none. Vertices and faces have the numbers of their descriptors, corners
/// run from `target(halfedge(f))`. Removed elements stay until `collect_garbage()`; a mesh that holds some is
/// refused (`invalid_input`, `unsupported`), because the numbers of results would belong to no visible element.
template <class Point>
struct mesh_access<CGAL::Surface_mesh<Point>> {
    using mesh = CGAL::Surface_mesh<Point>;

    static std::size_t vertex_count(mesh const& m) {
        require_collected(m);
        return static_cast<std::size_t>(m.number_of_vertices());
    }
    static vec3 position(mesh const& m, std::size_t v) {
        Point const& p = m.point(typename mesh::Vertex_index(static_cast<typename mesh::size_type>(v)));
        return vec3{CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())};
    }
    static std::size_t face_count(mesh const& m) {
        require_collected(m);
        return static_cast<std::size_t>(m.number_of_faces());
    }
    /// O(corners).
    static std::size_t face_size(mesh const& m, std::size_t f) { return static_cast<std::size_t>(m.degree(face(f))); }
    /// O(k).
    static std::uint64_t corner(mesh const& m, std::size_t f, std::size_t k) {
        auto at = m.halfedge(face(f));
        for (; k > 0; --k) at = m.next(at);
        return static_cast<std::uint64_t>(m.target(at));
    }

private:
    static typename mesh::Face_index face(std::size_t f) {
        return typename mesh::Face_index(static_cast<typename mesh::size_type>(f));
    }
    static void require_collected(mesh const& m) {
        if (!m.has_garbage()) return;
        detail::fail<invalid_input>(errc::unsupported,
                                    "cgal_surface_mesh: got a mesh with removed elements; call collect_garbage() first",
                                    {.kind = entity::attribute});
    }
};

}  // namespace tafoni

#endif
