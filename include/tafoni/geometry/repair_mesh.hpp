/// \file
/// Mends a broken mesh where the caller asks for it, and says what was done.
#ifndef TAFONI_GEOMETRY_REPAIR_MESH_HPP
#define TAFONI_GEOMETRY_REPAIR_MESH_HPP

#include <tafoni/geometry/detail/checked_mesh.hpp>
#include <tafoni/geometry/detail/mesh_mending.hpp>

namespace tafoni {

/// What may be mended; nothing by default. Steps run in the order of the members.
struct repair_options {
    bool merge_vertices = false;     ///< vertices at exactly the same place become one (0 == -0)
    bool drop_degenerate = false;    ///< repeated corners go, faces left with fewer than three as well
    bool drop_duplicates = false;    ///< of faces with the same outline one stays, or none where that leaves edges even
    bool orient = false;             ///< faces are turned to agree with their neighbours, outer shells to face outwards
    bool split_nonmanifold = false;  ///< edges of more than two faces, and vertices where sheets touch, are split
    std::size_t fill_holes = 0;      ///< holes of at most so many edges are closed with one polygon each
};

/// What `repair_mesh` did. Faces and vertices are those of the input, in rising order.
struct repair_report {
    std::vector<std::uint32_t> merged_vertices{};    ///< gone into an earlier one at the same place
    std::vector<std::uint32_t> degenerate_faces{};   ///< dropped or shortened
    std::vector<std::uint32_t> duplicate_faces{};    ///< dropped
    std::vector<std::uint32_t> turned_faces{};
    std::vector<std::uint32_t> split_vertices{};     ///< once for each copy made
    std::size_t split_edges = 0;                     ///< edges of more than two faces that were taken apart
    std::size_t filled_holes = 0;
    std::size_t turned_shells = 0;                   ///< turned as a whole because they faced inwards

    /// True when the mesh came back as it was.
    [[nodiscard]] bool nothing_done() const noexcept {
        return merged_vertices.empty() && degenerate_faces.empty() && duplicate_faces.empty() &&
               turned_faces.empty() && split_vertices.empty() && split_edges == 0 && filled_holes == 0;
    }
};

/// A mended mesh and where its parts come from.
struct repaired_mesh {
    static constexpr std::uint32_t none = face_index::none;

    indexed_mesh mesh{};
    std::vector<std::uint32_t> vertex_of{};  ///< new vertex -> vertex of the input
    std::vector<std::uint32_t> face_of{};    ///< new face -> face of the input; none for filled holes
    repair_report report{};
};

namespace detail {

struct repair_mesh_fn {
    /// A mended copy of `mesh`; the input is not touched, vertices that are merged away stay as isolated ones.
    ///
    /// Mends what was asked for and nothing else; whether the result bounds a solid is for `make_solid`
    /// to say. At an edge of an even number of faces the faces around each wedge of rock stay together,
    /// so solids that touch along an edge come apart; an edge where that cannot be is left open. A mesh
    /// that needs nothing comes back bit for bit, and repairing twice changes nothing more, with
    /// two exceptions: where vertices are merged and split, the copies are merged and split again and get other
    /// numbers; and with `fill_holes` and `split_nonmanifold` a filled hole can touch other faces, which only a
    /// second pass splits.
    ///
    /// \throws invalid_input  non_finite_vertex, index_out_of_range, size_overflow; these are never mended.
    /// O(n log n), and O(triangles) per shell for `orient`.
    template <polygon_mesh M>
    [[nodiscard]] repaired_mesh operator()(M const& mesh, repair_options const& options) const {
        mesh_mender m(checked_copy("repair_mesh", mesh));
        repaired_mesh r;
        if (options.merge_vertices) r.report.merged_vertices = m.merge_vertices();
        if (options.drop_degenerate) r.report.degenerate_faces = m.drop_degenerate();
        bool const structural = options.drop_duplicates || options.orient || options.split_nonmanifold ||
                                options.fill_holes > 0;
        // Edges of faces with repeated corners mean nothing, so the rest asks for proper faces.
        if (structural) require_proper_faces("repair_mesh", m.mesh);
        if (options.drop_duplicates) r.report.duplicate_faces = m.drop_duplicates();
        if (options.orient) m.orient();
        if (options.split_nonmanifold) {
            r.report.split_edges = m.pair_crowded_edges();
            r.report.split_vertices = m.split_vertices();
        }
        if (options.fill_holes > 0) r.report.filled_holes = m.fill_holes(options.fill_holes);
        if (options.orient) r.report.turned_shells = m.turn_outwards();
        r.report.turned_faces = m.turned_faces();
        r.mesh = std::move(m.mesh);
        r.vertex_of = std::move(m.vertex_of);
        r.face_of = std::move(m.face_of);
        return r;
    }
};

}  // namespace detail

/// Mends a mesh on request; see `detail::repair_mesh_fn`.
inline constexpr detail::repair_mesh_fn repair_mesh{};

}  // namespace tafoni

#endif
