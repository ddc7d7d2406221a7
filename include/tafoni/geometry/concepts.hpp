/// \file
/// The one door for foreign meshes, and the concepts that algorithms ask of them.
#ifndef TAFONI_GEOMETRY_CONCEPTS_HPP
#define TAFONI_GEOMETRY_CONCEPTS_HPP

#include <tafoni/core/vector.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>

namespace tafoni {

/// Specialise this for your own mesh type; nothing else of the library has to know it.
///
/// Members, all static, none of which may modify the mesh:
///   std::size_t   vertex_count(M const&);
///   vec3          position(M const&, std::size_t vertex);          // float is converted exactly
///   std::size_t   face_count(M const&);
///   std::size_t   face_size(M const&, std::size_t face);           // corners of the face
///   std::uint64_t corner(M const&, std::size_t face, std::size_t k); // vertex, counter-clockwise from outside
/// A mesh of triangles only adds `static constexpr std::size_t corners_per_face = 3;`.
template <class M>
struct mesh_access;

/// A mesh of polygons that can be read. Laws: pure functions; equal calls give equal answers.
/// The first part makes the compiler say only that `mesh_access<M>` is missing where it is.
template <class M>
concept polygon_mesh = requires { sizeof(mesh_access<M>); } && requires(M const& m, std::size_t i) {
    { mesh_access<M>::vertex_count(m) } -> std::same_as<std::size_t>;
    { mesh_access<M>::position(m, i) } -> std::same_as<vec3>;
    { mesh_access<M>::face_count(m) } -> std::same_as<std::size_t>;
    { mesh_access<M>::face_size(m, i) } -> std::same_as<std::size_t>;
    { mesh_access<M>::corner(m, i, i) } -> std::same_as<std::uint64_t>;
};

/// A `polygon_mesh` whose faces all have three corners.
template <class M>
concept triangle_mesh = polygon_mesh<M> && requires { requires mesh_access<M>::corners_per_face == 3; };

}  // namespace tafoni

#endif
