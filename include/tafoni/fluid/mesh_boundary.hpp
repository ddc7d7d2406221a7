/// \file
/// Triangles as the walls of a fluid, found through a grid.
#ifndef TAFONI_FLUID_MESH_BOUNDARY_HPP
#define TAFONI_FLUID_MESH_BOUNDARY_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/executor.hpp>
#include <tafoni/core/index.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/fluid/concepts.hpp>
#include <tafoni/geometry/detail/triangle_queries.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace tafoni {

/// The faces of a mesh in the cells of a regular grid that they are within `reach` of [thesis, 8.1]. Views the
/// mesh, which must outlive it; `refit` after its vertices have moved. Models `fluid_boundary`.
///
/// A particle's question costs one cell. Cells are about as long as the larger of twice the reach and the mean
/// edge; there are at most about 8 million of 4 bytes, and 4 bytes for every face in a cell.
class mesh_boundary {
public:
    /// O(faces + cells). \throws invalid_input  `bad_parameter` for a reach that is not positive and finite,
    /// `size_overflow` beyond 32 bits. Positions must be finite and corners in range.
    mesh_boundary(std::span<vec3 const> positions, std::span<std::array<std::uint32_t, 3> const> triangles, double reach)
        : reach_(reach) {
        detail::require_range("mesh_boundary: reach", reach, std::numeric_limits<double>::min(), 1e100);
        detail::require_indexable("mesh_boundary: faces", triangles.size());
        refit(positions, triangles);
    }

    /// Follows vertices that moved and faces that changed. O(faces + cells).
    void refit(std::span<vec3 const> positions, std::span<std::array<std::uint32_t, 3> const> triangles) {
        positions_ = positions;
        triangles_ = triangles;
        lay_out();
        begin_.assign(cells() + 1, 0);
        for (std::uint32_t f = 0; f < triangles_.size(); ++f) {
            for_each_cell(f, [&](std::size_t c) { ++begin_[c + 1]; });
        }
        std::uint64_t total = 0;
        for (std::size_t c = 0; c < cells(); ++c) {
            total += begin_[c + 1];
            begin_[c + 1] = static_cast<std::uint32_t>(total);
        }
        detail::require_indexable("mesh_boundary: faces in cells", static_cast<std::size_t>(total));
        faces_.resize(static_cast<std::size_t>(total));
        at_.assign(begin_.begin(), begin_.end() - 1);
        for (std::uint32_t f = 0; f < triangles_.size(); ++f) {
            for_each_cell(f, [&](std::size_t c) { faces_[at_[c]++] = f; });
        }
    }

    [[nodiscard]] double reach() const noexcept { return reach_; }
    [[nodiscard]] std::span<vec3 const> positions() const noexcept { return positions_; }
    [[nodiscard]] std::span<std::array<std::uint32_t, 3> const> triangles() const noexcept { return triangles_; }
    [[nodiscard]] std::size_t bytes() const noexcept {
        return (begin_.capacity() + at_.capacity() + faces_.capacity()) * sizeof(std::uint32_t);
    }

    /// As the concept asks; `radius` at most `reach()`. O(faces in a cell).
    template <class Visit>
    void for_each_contact(vec3 const& p, double radius, Visit const& visit) const {
        std::size_t const c = cell_of(p);
        if (c == outside) return;
        bool found = false;
        for (std::uint32_t k = begin_[c]; k < begin_[c + 1]; ++k) {
            std::uint32_t const f = faces_[k];
            auto const& t = triangles_[f];
            vec3 const& a = positions_[t[0]];
            vec3 const u{positions_[t[1]] - a};
            vec3 const v{positions_[t[2]] - a};
            vec3 const w{p - a};
            vec3 const n = cross(u, v);
            double const nn = dot(n, n);
            double const over = dot(w, n);
            if (!(nn > 0) || over * over > radius * radius * nn) continue;
            double const y = dot(cross(w, v), n);
            double const z = dot(cross(u, w), n);
            if (!(y >= 0 && z >= 0 && y + z <= nn)) continue;
            double const l = std::sqrt(nn);
            found = true;
            visit(boundary_contact{.face = f, .normal = vec3{n[0] / l, n[1] / l, n[2] / l}, .distance = over / l});
        }
        if (!found) visit_nearest(p, radius, c, visit);
    }

private:
    static constexpr std::size_t outside = ~std::size_t{0};
    static constexpr double most_cells = 8e6;

    /// Over an edge or a corner, where no face has the foot.
    template <class Visit>
    void visit_nearest(vec3 const& p, double radius, std::size_t c, Visit const& visit) const {
        double nearest = radius * radius;
        std::uint32_t best = face_index::none;
        vec3 way{0, 0, 0};
        for (std::uint32_t k = begin_[c]; k < begin_[c + 1]; ++k) {
            auto const& t = triangles_[faces_[k]];
            box3 box;
            for (std::uint32_t const v : t) box.include(positions_[v]);
            if (detail::squared_distance(box, p) >= nearest) continue;
            vec3 const foot = detail::nearest_on_triangle(positions_[t[0]], positions_[t[1]], positions_[t[2]], p);
            vec3 const d{p - foot};
            double const square = squared_length(d);
            if (!(square < nearest)) continue;
            nearest = square;
            best = faces_[k];
            way = d;
        }
        double const l = std::sqrt(nearest);
        if (best == face_index::none || !(l > 0)) return;
        auto const& t = triangles_[best];
        vec3 const& a = positions_[t[0]];
        bool const behind = dot(p - a, cross(positions_[t[1]] - a, positions_[t[2]] - a)) < 0;
        double const s = behind ? -1 / l : 1 / l;
        visit(boundary_contact{.face = best, .normal = vec3{s * way[0], s * way[1], s * way[2]}, .distance = behind ? -l : l});
    }

    [[nodiscard]] std::size_t cells() const noexcept { return size_[0] * size_[1] * size_[2]; }

    void lay_out() {
        box3 box;
        double edges = 0;
        for (auto const& t : triangles_) {
            for (std::size_t k = 0; k < 3; ++k) {
                box.include(positions_[t[k]]);
                edges += length(positions_[t[k]] - positions_[t[(k + 1) % 3]]);
            }
        }
        size_ = {0, 0, 0};
        if (triangles_.empty()) return;
        double cell = std::max(2 * reach_, edges / (3 * static_cast<double>(triangles_.size())));
        vec3 const e = box.extent();
        lo_ = vec3{box.lo[0] - reach_, box.lo[1] - reach_, box.lo[2] - reach_};
        auto const along = [&](int d) { return std::floor((e[d] + 2 * reach_) / cell) + 1; };
        while (along(0) * along(1) * along(2) > most_cells) cell *= 1.25;
        inverse_ = 1 / cell;
        for (int d = 0; d < 3; ++d) size_[static_cast<std::size_t>(d)] = static_cast<std::size_t>(along(d));
    }

    [[nodiscard]] std::size_t place(int d, double x) const noexcept {
        auto const n = static_cast<double>(size_[static_cast<std::size_t>(d)] - 1);
        return static_cast<std::size_t>(std::clamp(std::floor((x - lo_[d]) * inverse_), 0.0, n));
    }
    [[nodiscard]] std::size_t cell_of(vec3 const& p) const noexcept {
        std::array<std::size_t, 3> c{};
        for (int d = 0; d < 3; ++d) {
            double const x = std::floor((p[d] - lo_[d]) * inverse_);
            auto const e = static_cast<std::size_t>(d);
            if (!(x >= 0 && x < static_cast<double>(size_[e]))) return outside;
            c[e] = static_cast<std::size_t>(x);
        }
        return c[0] + size_[0] * (c[1] + size_[1] * c[2]);
    }
    template <class F>
    void for_each_cell(std::uint32_t f, F const& visit) const {
        box3 box;
        for (std::uint32_t const v : triangles_[f]) box.include(positions_[v]);
        std::array<std::size_t, 3> low{};
        std::array<std::size_t, 3> high{};
        for (int d = 0; d < 3; ++d) {
            low[static_cast<std::size_t>(d)] = place(d, box.lo[d] - reach_);
            high[static_cast<std::size_t>(d)] = place(d, box.hi[d] + reach_);
        }
        for (std::size_t z = low[2]; z <= high[2]; ++z) {
            for (std::size_t y = low[1]; y <= high[1]; ++y) {
                for (std::size_t x = low[0]; x <= high[0]; ++x) visit(x + size_[0] * (y + size_[1] * z));
            }
        }
    }

    std::span<vec3 const> positions_{};
    std::span<std::array<std::uint32_t, 3> const> triangles_{};
    double reach_;
    double inverse_ = 1;
    vec3 lo_{0, 0, 0};
    std::array<std::size_t, 3> size_{};
    std::vector<std::uint32_t> begin_{};  ///< cell -> its first place in `faces_`
    std::vector<std::uint32_t> faces_{};  ///< by cell, ascending in each
    std::vector<std::uint32_t> at_{};
};

static_assert(fluid_boundary<mesh_boundary>);

}  // namespace tafoni

#endif
