/// \file
/// The links graph and the cells graph of a decomposition, stored.
#ifndef TAFONI_GRAPH_LINK_GRAPH_HPP
#define TAFONI_GRAPH_LINK_GRAPH_HPP

#include <tafoni/graph/concepts.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tafoni {

namespace detail {

/// What `make_link_graph` fills; offsets have one entry more than there are things.
struct link_graph_arrays {
    std::vector<double> volumes{};                       ///< per cell
    std::vector<std::array<std::uint32_t, 2>> cells{};   ///< per interior link
    std::vector<std::uint32_t> skin_cells{};             ///< per exterior link
    std::vector<vec3> centroids{};                       ///< per link
    std::vector<vec3> normals{};                         ///< per interior link: area x normal; per exterior link: unit normal
    std::vector<double> skin_areas{};                    ///< per exterior link
    std::vector<std::uint32_t> cell_begin{0};            ///< cell -> cell_links
    std::vector<link_index> cell_links{};                ///< ascending for each cell
    std::vector<std::uint32_t> neighbor_begin{0};        ///< link -> neighbors
    std::vector<link_index> neighbors{};                 ///< ascending for each link
    std::vector<std::uint32_t> skipped{};                ///< faces before the last linked interior one that are not such, ascending
    std::vector<std::uint32_t> skin_faces{};             ///< faces of the exterior links, by link, ascending for each
    std::vector<std::uint32_t> skin_face_begin{0};       ///< exterior link -> skin_faces
    std::vector<std::uint32_t> skin_face_order{};        ///< positions in skin_faces, by ascending face
};

}  // namespace detail

/// Cells joined by links, and links next to links. Models `link_network`; made by `make_link_graph`.
///
/// Interior links come first, in the order of their faces; then the exterior links, by cell and patch.
/// Nothing here changes while a model weathers: life and state belong to the run, and a broken link
/// keeps its place. All queries are O(1) but for `link_of` and `for_each_face`, O(log faces).
class link_graph {
public:
    link_graph() = default;
    explicit link_graph(detail::link_graph_arrays arrays) noexcept : a_(std::move(arrays)) {}

    [[nodiscard]] std::size_t cell_count() const noexcept { return a_.volumes.size(); }
    [[nodiscard]] double cell_volume(cell_index c) const noexcept { return a_.volumes[c.value]; }
    [[nodiscard]] std::size_t link_count() const noexcept { return a_.centroids.size(); }
    [[nodiscard]] std::size_t interior_link_count() const noexcept { return a_.cells.size(); }
    [[nodiscard]] std::size_t exterior_link_count() const noexcept { return a_.skin_cells.size(); }
    [[nodiscard]] bool is_interior(link_index l) const noexcept { return l.value < a_.cells.size(); }
    [[nodiscard]] bool has_link(link_index l) const noexcept { return l.value < link_count(); }

    /// For interior links both cells, the normal leading from the first to the second.
    [[nodiscard]] std::array<cell_index, 2> link_cells(link_index l) const noexcept {
        if (!is_interior(l)) return {cell_index{a_.skin_cells[l.value - a_.cells.size()]}, cell_index{}};
        return {cell_index{a_.cells[l.value][0]}, cell_index{a_.cells[l.value][1]}};
    }
    /// The cell across an interior link, not valid across the skin.
    [[nodiscard]] cell_index other_cell(link_index l, cell_index c) const noexcept {
        auto const cells = link_cells(l);
        return cells[0] == c ? cells[1] : cells[0];
    }
    /// Sum of the areas of the link's faces, squared length unit.
    [[nodiscard]] double link_area(link_index l) const noexcept {
        return is_interior(l) ? length(a_.normals[l.value]) : a_.skin_areas[l.value - a_.cells.size()];
    }
    [[nodiscard]] vec3 link_centroid(link_index l) const noexcept { return a_.centroids[l.value]; }
    /// Area-weighted over the link's faces.
    [[nodiscard]] vec3 link_normal(link_index l) const noexcept {
        return is_interior(l) ? normalized(a_.normals[l.value]) : a_.normals[l.value];
    }

    /// The links of a cell, interior ones first, ascending.
    [[nodiscard]] std::span<link_index const> links_of(cell_index c) const noexcept {
        return {a_.cell_links.data() + a_.cell_begin[c.value], a_.cell_begin[c.value + 1] - a_.cell_begin[c.value]};
    }
    /// The interior links of a cell, ascending. O(log links of the cell).
    [[nodiscard]] std::span<link_index const> bonds_of(cell_index c) const noexcept {
        auto const all = links_of(c);
        auto const end = std::lower_bound(all.begin(), all.end(), link_index{a_.cells.size()});
        return all.first(static_cast<std::size_t>(end - all.begin()));
    }
    /// Neigh(l), ascending.
    [[nodiscard]] std::span<link_index const> neighbors(link_index l) const noexcept {
        return {a_.neighbors.data() + a_.neighbor_begin[l.value],
                a_.neighbor_begin[l.value + 1] - a_.neighbor_begin[l.value]};
    }
    template <class Visit>
    void for_each_cell_link(cell_index c, Visit&& visit) const {
        for (link_index const l : links_of(c)) visit(l);
    }
    template <class Visit>
    void for_each_neighbor(link_index l, Visit&& visit) const {
        for (link_index const n : neighbors(l)) visit(n);
    }

    /// The link that a face belongs to; not valid for faces too small and for artificial skin.
    [[nodiscard]] link_index link_of(face_index f) const noexcept {
        auto const at = std::lower_bound(a_.skipped.begin(), a_.skipped.end(), f.value);
        if (at == a_.skipped.end() || *at != f.value) {
            auto const l = f.value - static_cast<std::uint32_t>(at - a_.skipped.begin());
            if (l < a_.cells.size()) return link_index{l};
        }
        auto const s = std::lower_bound(a_.skin_face_order.begin(), a_.skin_face_order.end(), f.value,
                                        [&](std::uint32_t i, std::uint32_t face) { return a_.skin_faces[i] < face; });
        if (s == a_.skin_face_order.end() || a_.skin_faces[*s] != f.value) return link_index{};
        auto const link = std::upper_bound(a_.skin_face_begin.begin(), a_.skin_face_begin.end(), *s);
        return link_index{a_.cells.size() + static_cast<std::size_t>(link - a_.skin_face_begin.begin()) - 1};
    }
    /// Visits the faces of a link, ascending: one for an interior link, any number for an exterior one.
    template <class Visit>
    void for_each_face(link_index l, Visit&& visit) const {
        if (!is_interior(l)) {
            std::size_t const e = l.value - a_.cells.size();
            for (std::uint32_t i = a_.skin_face_begin[e]; i < a_.skin_face_begin[e + 1]; ++i) {
                visit(face_index{a_.skin_faces[i]});
            }
            return;
        }
        // skipped[i] - i counts the linked faces before the i-th skipped one and never falls.
        std::size_t lo = 0;
        std::size_t hi = a_.skipped.size();
        while (lo < hi) {
            std::size_t const mid = lo + (hi - lo) / 2;
            if (a_.skipped[mid] - mid <= l.value) lo = mid + 1; else hi = mid;
        }
        visit(face_index{l.value + static_cast<std::uint32_t>(lo)});
    }

    /// Memory held, in bytes.
    [[nodiscard]] std::size_t bytes() const noexcept {
        auto const of = [](auto const& v) { return v.capacity() * sizeof(v[0]); };
        return of(a_.volumes) + of(a_.cells) + of(a_.skin_cells) + of(a_.centroids) + of(a_.normals) +
               of(a_.skin_areas) + of(a_.cell_begin) + of(a_.cell_links) + of(a_.neighbor_begin) + of(a_.neighbors) +
               of(a_.skipped) + of(a_.skin_faces) + of(a_.skin_face_begin) + of(a_.skin_face_order);
    }

private:
    detail::link_graph_arrays a_{};
};

static_assert(link_network<link_graph>);

}  // namespace tafoni

#endif
