/// \file
/// OpenMesh meshes, read where they lie.
#ifndef TAFONI_INTEROP_OPENMESH_HPP
#define TAFONI_INTEROP_OPENMESH_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/geometry/concepts.hpp>

#include <OpenMesh/Core/Mesh/PolyConnectivity.hh>
#include <OpenMesh/Core/Mesh/TriConnectivity.hh>

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>

namespace tafoni {

namespace detail {

/// Numbers are those of the handles, corners run from the vertex that `fv_begin` names. O(1), `corner` O(k).
template <class M>
struct openmesh_elements {
    static std::size_t vertex_count(M const& m) { return m.n_vertices(); }
    static vec3 position(M const& m, std::size_t v) {
        auto const h = m.vertex_handle(static_cast<unsigned int>(v));
        require_living(!m.has_vertex_status() || !m.status(h).deleted(), entity::vertex, "vertex ", v);
        auto const& p = m.point(h);
        return vec3{static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
    }
    static std::size_t face_count(M const& m) { return m.n_faces(); }
    static std::uint64_t corner(M const& m, std::size_t f, std::size_t k) {
        auto const h = m.face_handle(static_cast<unsigned int>(f));
        require_living(!m.has_face_status() || !m.status(h).deleted(), entity::face, "face ", f);
        auto at = m.halfedge_handle(h);
        for (; k > 0; --k) at = m.next_halfedge_handle(at);
        return static_cast<std::uint64_t>(m.to_vertex_handle(at).idx());
    }

protected:
    static void require_living(bool living, entity kind, char const* what, std::size_t index) {
        if (living) return;
        fail<invalid_input>(errc::unsupported,
                            std::string("openmesh: ") + what + std::to_string(index) +
                                " is marked as deleted; call garbage_collection() first",
                            {.kind = kind, .index = index});
    }
};

}  // namespace detail

/// Any `OpenMesh::TriMesh_ArrayKernelT<Traits>` and what is derived from it, with points of float or double.
///
/// Vertices and faces have the numbers of their handles. OpenMesh keeps deleted elements until
/// `garbage_collection()`; reading one throws `invalid_input` (`unsupported`), because the numbers of results
/// would otherwise silently belong to a mesh that the user does not see.
template <class M>
    requires std::derived_from<M, OpenMesh::TriConnectivity>
struct mesh_access<M> : detail::openmesh_elements<M> {
    static constexpr std::size_t corners_per_face = 3;
    static std::size_t face_size(M const&, std::size_t) { return 3; }
};

/// The same for `OpenMesh::PolyMesh_ArrayKernelT<Traits>`. `face_size` is O(corners).
template <class M>
    requires(std::derived_from<M, OpenMesh::PolyConnectivity> && !std::derived_from<M, OpenMesh::TriConnectivity>)
struct mesh_access<M> : detail::openmesh_elements<M> {
    static std::size_t face_size(M const& m, std::size_t f) {
        auto const h = m.face_handle(static_cast<unsigned int>(f));
        detail::openmesh_elements<M>::require_living(!m.has_face_status() || !m.status(h).deleted(), entity::face, "face ", f);
        return m.valence(h);
    }
};

}  // namespace tafoni

#endif
