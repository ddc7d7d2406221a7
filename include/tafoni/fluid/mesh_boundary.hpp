/// \file
/// Triangles as the walls of a fluid, found through a grid.
#ifndef TAFONI_FLUID_MESH_BOUNDARY_HPP
#define TAFONI_FLUID_MESH_BOUNDARY_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/executor.hpp>
#include <tafoni/core/index.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/fluid/concepts.hpp>
#include <tafoni/fluid/detail/face_balls.hpp>
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
/// A particle's question costs one cell. Cells are about as long as the larger of four times the reach and the mean
/// edge; there are at most about 8 million of 4 bytes, and 28 bytes for every face in a cell. Faces are also in cells
/// that they come to when vertices move by a quarter of the larger of reach and mean edge; until one moves farther
/// the cells stay. Answers depend on the mesh alone, never on when the cells were filled.
class mesh_boundary {
public:
    /// O(faces + cells). \throws invalid_input  `bad_parameter` for a reach that is not positive and finite,
    /// `size_overflow` beyond 32 bits. Positions must be finite and corners in range.
    mesh_boundary(std::span<vec3 const> positions, std::span<std::array<std::uint32_t, 3> const> triangles, double reach)
        : reach_(reach) {
        detail::require_range("mesh_boundary: reach", reach, std::numeric_limits<double>::min(), 1e100);
        detail::require_indexable("mesh_boundary: faces", triangles.size());
        positions_ = positions;
        triangles_ = triangles;
        fill();
    }

    /// Follows vertices that moved and faces that changed. O(vertices + faces); O(cells) more where the faces are
    /// others or a vertex has gone far.
    void refit(std::span<vec3 const> positions, std::span<std::array<std::uint32_t, 3> const> triangles) {
        positions_ = positions;
        triangles_ = triangles;
        if (positions.size() != last_.size() || !std::equal(triangles.begin(), triangles.end(), faces_then_.begin(), faces_then_.end())) {
            return fill();
        }
        moved_.resize(positions.size());
        double farthest = 0;
        for (std::size_t v = 0; v < positions.size(); ++v) {
            vec3 const& p = positions[v];
            vec3 const& q = last_[v];
            moved_[v] = p[0] == q[0] && p[1] == q[1] && p[2] == q[2] ? 0 : 1;
            if (moved_[v] == 0) continue;
            farthest = std::max(farthest, squared_length(p - base_[v]));
            last_[v] = p;
        }
        if (!(farthest <= slack_ * slack_)) return fill();
        for (std::size_t f = 0; f < triangles.size(); ++f) {
            auto const& t = triangles[f];
            if ((moved_[t[0]] | moved_[t[1]] | moved_[t[2]]) != 0) discs_[f] = disc_of(t);
        }
    }

    [[nodiscard]] double reach() const noexcept { return reach_; }
    [[nodiscard]] std::span<vec3 const> positions() const noexcept { return positions_; }
    [[nodiscard]] std::span<std::array<std::uint32_t, 3> const> triangles() const noexcept { return triangles_; }
    [[nodiscard]] std::size_t bytes() const noexcept {
        return (begin_.capacity() + at_.capacity() + faces_.capacity()) * sizeof(std::uint32_t) + balls_.capacity() * sizeof(detail::face_ball) + entries_.capacity() * sizeof(entry) + discs_.capacity() * sizeof(disc) +
               (last_.capacity() + base_.capacity()) * sizeof(vec3) + faces_then_.capacity() * sizeof(std::array<std::uint32_t, 3>) +
               moved_.capacity();
    }

    /// Blocks of 4 x 4 x 4 cells, and one for all outside: particles are asked about fastest block by block.
    [[nodiscard]] std::size_t block_count() const noexcept { return blocks(0) * blocks(1) * blocks(2) + 1; }
    [[nodiscard]] std::size_t block_of(vec3 const& p) const noexcept {
        std::size_t const c = cell_of(p);
        if (c == outside) return block_count() - 1;
        std::size_t const y = c / size_[0] % size_[1];
        std::size_t const z = c / size_[0] / size_[1];
        return c % size_[0] / 4 + blocks(0) * (y / 4 + blocks(1) * (z / 4));
    }

    /// As the concept asks; `radius` at most `reach()`. O(faces in a cell).
    template <class Visit>
    void for_each_contact(vec3 const& p, double radius, Visit const& visit) const {
        std::size_t const c = cell_of(p);
        if (c == outside || begin_[c] == begin_[c + 1]) return;
        bool found = false;
        seen const at = see(p);
        float const most = static_cast<float>(radius * inverse_) + blur_;
        float nearest = std::numeric_limits<float>::max();  // square of the way to some point of a face
        for_each_face(c, at, most, [&](std::uint32_t f) {
            disc const& d = discs_[f];
            auto const [square, over] = at.from(d);
            nearest = square < nearest ? square : nearest;
            if (over > most || over < -most || square - over * over > d.square + 1e-5F * square) return;
            found = visit_over(f, p, radius, visit) || found;
        });
        if (found || nearest == std::numeric_limits<float>::max()) return;
        visit_nearest(p, radius, c, std::min(most, std::sqrt(nearest) + blur_) * (1 + 1e-5F), visit);
    }

private:
    static constexpr std::size_t outside = ~std::size_t{0};
    static constexpr double most_cells = 8e6;

    /// A circle that holds a face, rounded outwards: what most faces of a cell are told apart from contacts by.
    struct disc {
        float x, y, z;     ///< from the corner of the grid, in cells, as all of it
        float nx, ny, nz;  ///< normal, zero where the face has none
        float radius;
        float square;      ///< of the radius
    };
    struct seen {
        float x, y, z;
        struct sight {
            float square;  ///< distance from the middle of the disc
            float over;    ///< height over its plane
        };
        [[nodiscard]] sight from(disc const& d) const noexcept {
            float const a = x - d.x;
            float const b = y - d.y;
            float const c = z - d.z;
            return {a * a + b * b + c * c, a * d.nx + b * d.ny + c * d.nz};
        }
    };
    [[nodiscard]] seen see(vec3 const& p) const noexcept {
        return {static_cast<float>((p[0] - lo_[0]) * inverse_), static_cast<float>((p[1] - lo_[1]) * inverse_),
                static_cast<float>((p[2] - lo_[2]) * inverse_)};
    }
    [[nodiscard]] disc disc_of(std::array<std::uint32_t, 3> const& t) const noexcept {
        vec3 const& a = positions_[t[0]];
        vec3 const& b = positions_[t[1]];
        vec3 const& c = positions_[t[2]];
        vec3 const m{(a[0] + b[0] + c[0]) / 3, (a[1] + b[1] + c[1]) / 3, (a[2] + b[2] + c[2]) / 3};
        vec3 const n = normalized(cross(vec3{b - a}, vec3{c - a}));
        double const r = std::sqrt(std::max({squared_length(a - m), squared_length(b - m), squared_length(c - m)}));
        seen const at = see(m);
        float const wide = static_cast<float>(r * inverse_) + blur_;
        return {at.x, at.y, at.z, static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2]), wide, wide * wide};
    }

    /// Whether the foot of the normal meets the face.
    template <class Visit>
    bool visit_over(std::uint32_t f, vec3 const& p, double radius, Visit const& visit) const {
        auto const& t = triangles_[f];
        vec3 const& a = positions_[t[0]];
        vec3 const u{positions_[t[1]] - a};
        vec3 const v{positions_[t[2]] - a};
        vec3 const w{p - a};
        vec3 const n = cross(u, v);
        double const nn = dot(n, n);
        double const over = dot(w, n);
        if (!(nn > 0) || over * over > radius * radius * nn) return false;
        double const y = dot(cross(w, v), n);
        double const z = dot(cross(u, w), n);
        if (!(y >= 0 && z >= 0 && y + z <= nn)) return false;
        double const l = std::sqrt(nn);
        visit(boundary_contact{.face = f, .normal = vec3{n[0] / l, n[1] / l, n[2] / l}, .distance = over / l});
        return true;
    }

    /// Faces of a cell that may be within `radius`, in cells, ascending.
    template <class F>
    void for_each_face(std::size_t c, seen const& at, float radius, F const& visit) const {
        auto const middle = [](float a, std::size_t i) { return a - (static_cast<float>(i) + 0.5F); };
        detail::face_ball const ball = detail::face_ball::around(
            middle(at.x, c % size_[0]), middle(at.y, c / size_[0] % size_[1]), middle(at.z, c / size_[0] / size_[1]), radius);
        constexpr std::uint32_t most = 128;
        std::array<std::uint32_t, most + 4> around;
        for (std::uint32_t from = begin_[c]; from < begin_[c + 1]; from += most) {
            std::size_t const n = detail::touched_balls(balls_.data() + from, std::min(most, begin_[c + 1] - from), ball, around.data());
            for (std::size_t k = 0; k < n; ++k) visit(faces_[from + around[k]]);
        }
    }

    /// Over an edge or a corner, where no face has the foot. The nearest is no farther than `limit`, in cells.
    template <class Visit>
    void visit_nearest(vec3 const& p, double radius, std::size_t c, float limit, Visit const& visit) const {
        double nearest = radius * radius;
        std::uint32_t best = face_index::none;
        vec3 way{0, 0, 0};
        seen const at = see(p);
        for_each_face(c, at, limit, [&](std::uint32_t f) {
            disc const& d = discs_[f];
            auto const [square, over] = at.from(d);
            float const wide = d.radius + limit;
            if (over > limit || over < -limit || square > wide * wide * (1 + 1e-5F)) return;
            auto const& t = triangles_[f];
            vec3 const foot = detail::nearest_on_triangle(positions_[t[0]], positions_[t[1]], positions_[t[2]], p);
            vec3 const away{p - foot};
            double const length_squared = squared_length(away);
            if (!(length_squared < nearest)) return;
            nearest = length_squared;
            best = f;
            way = away;
        });
        double const l = std::sqrt(nearest);
        if (best == face_index::none || !(l > 0)) return;
        auto const& t = triangles_[best];
        vec3 const& a = positions_[t[0]];
        bool const behind = dot(p - a, cross(positions_[t[1]] - a, positions_[t[2]] - a)) < 0;
        double const s = behind ? -1 / l : 1 / l;
        visit(boundary_contact{.face = best, .normal = vec3{s * way[0], s * way[1], s * way[2]}, .distance = behind ? -l : l});
    }

    [[nodiscard]] std::size_t blocks(std::size_t d) const noexcept { return (size_[d] + 3) / 4; }
    [[nodiscard]] std::size_t cells() const noexcept { return size_[0] * size_[1] * size_[2]; }

    void fill() {
        lay_out();
        last_.assign(positions_.begin(), positions_.end());
        base_ = last_;
        faces_then_.assign(triangles_.begin(), triangles_.end());
        discs_.resize(triangles_.size());
        begin_.assign(cells() + 1, 0);
        entries_.clear();
        float const further = static_cast<float>(slack_ * inverse_) + 2 * blur_;
        for (std::uint32_t f = 0; f < triangles_.size(); ++f) {
            discs_[f] = disc_of(triangles_[f]);
            float const radius = discs_[f].radius + further;
            for_each_cell(discs_[f], span_of(triangles_[f]), [&](std::size_t c, float x, float y, float z) {
                ++begin_[c + 1];
                entries_.push_back({static_cast<std::uint32_t>(c), f, detail::face_ball::around(x, y, z, radius)});
            });
        }
        detail::require_indexable("mesh_boundary: faces in cells", entries_.size());
        for (std::size_t c = 0; c < cells(); ++c) begin_[c + 1] += begin_[c];
        faces_.resize(entries_.size());
        balls_.resize(entries_.size());
        at_.assign(begin_.begin(), begin_.end() - 1);
        for (entry const& e : entries_) {
            std::uint32_t const to = at_[e.cell]++;
            faces_[to] = e.face;
            balls_[to] = e.ball;
        }
    }

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
        double const edge = edges / (3 * static_cast<double>(triangles_.size()));
        cell_ = std::max(4 * reach_, edge);
        slack_ = 0.25 * std::max(reach_, edge);
        double const rim = reach_ + slack_;
        vec3 const e = box.extent();
        lo_ = vec3{box.lo[0] - rim, box.lo[1] - rim, box.lo[2] - rim};
        auto const along = [&](int d) { return std::floor((e[d] + 2 * rim) / cell_) + 1; };
        while (along(0) * along(1) * along(2) > most_cells) cell_ *= 1.25;
        inverse_ = 1 / cell_;
        for (int d = 0; d < 3; ++d) size_[static_cast<std::size_t>(d)] = static_cast<std::size_t>(along(d));
        // What rounding to float may move a point or a height by.
        blur_ = static_cast<float>(1e-6 * (std::max({e[0], e[1], e[2]}) + 2 * rim) * inverse_);
    }

    [[nodiscard]] std::uint32_t place(int d, double x) const noexcept {
        auto const n = static_cast<double>(size_[static_cast<std::size_t>(d)] - 1);
        return static_cast<std::uint32_t>(std::clamp((x - lo_[d]) * inverse_, 0.0, n));
    }
    [[nodiscard]] std::size_t cell_of(vec3 const& p) const noexcept {
        std::array<std::size_t, 3> c{};
        for (int d = 0; d < 3; ++d) {
            double const x = (p[d] - lo_[d]) * inverse_;
            auto const e = static_cast<std::size_t>(d);
            if (!(x >= 0 && x < static_cast<double>(size_[e]))) return outside;
            c[e] = static_cast<std::size_t>(x);
        }
        return c[0] + size_[0] * (c[1] + size_[1] * c[2]);
    }

    struct entry {
        std::uint32_t cell = 0;
        std::uint32_t face = 0;
        detail::face_ball ball{};
    };
    /// Cells around a face.
    struct cell_span {
        std::array<std::uint32_t, 3> low{};
        std::array<std::uint32_t, 3> high{};
    };
    [[nodiscard]] cell_span span_of(std::array<std::uint32_t, 3> const& t) const noexcept {
        cell_span s;
        vec3 const& a = positions_[t[0]];
        vec3 const& b = positions_[t[1]];
        vec3 const& c = positions_[t[2]];
        double const rim = reach_ + slack_;
        for (int d = 0; d < 3; ++d) {
            s.low[static_cast<std::size_t>(d)] = place(d, std::min({a[d], b[d], c[d]}) - rim);
            s.high[static_cast<std::size_t>(d)] = place(d, std::max({a[d], b[d], c[d]}) + rim);
        }
        return s;
    }
    /// Those of the cells around a face that its plane comes near: what is within reach of a face whose corners have
    /// moved by the slack is within the sum of both of the face as it was.
    template <class F>
    void for_each_cell(disc const& d, cell_span const& s, F const& visit) const {
        float const rim = static_cast<float>((reach_ + slack_) * inverse_) + 2 * blur_ +
                          0.5001F * (std::fabs(d.nx) + std::fabs(d.ny) + std::fabs(d.nz));
        for (std::size_t z = s.low[2]; z <= s.high[2]; ++z) {
            float const over_z = (static_cast<float>(z) + 0.5F - d.z) * d.nz - d.x * d.nx;
            for (std::size_t y = s.low[1]; y <= s.high[1]; ++y) {
                std::size_t const row = size_[0] * (y + size_[1] * z);
                float const over_y = over_z + (static_cast<float>(y) + 0.5F - d.y) * d.ny;
                for (std::size_t x = s.low[0]; x <= s.high[0]; ++x) {
                    float const over = over_y + (static_cast<float>(x) + 0.5F) * d.nx;
                    if (!(over <= rim && over >= -rim)) continue;
                    visit(row + x, d.x - (static_cast<float>(x) + 0.5F), d.y - (static_cast<float>(y) + 0.5F),
                          d.z - (static_cast<float>(z) + 0.5F));
                }
            }
        }
    }

    std::span<vec3 const> positions_{};
    std::span<std::array<std::uint32_t, 3> const> triangles_{};
    double reach_;
    double slack_ = 0;
    double cell_ = 1;
    double inverse_ = 1;
    float blur_ = 0;
    vec3 lo_{0, 0, 0};
    std::array<std::size_t, 3> size_{};
    std::vector<std::uint32_t> begin_{};  ///< cell -> its first place in `faces_`
    std::vector<std::uint32_t> faces_{};  ///< by cell, ascending in each
    std::vector<detail::face_ball> balls_{};  ///< beside `faces_`: those that hold the face wherever the slack lets it go
    std::vector<std::uint32_t> at_{};
    std::vector<entry> entries_{};            ///< by face, while cells are filled
    std::vector<disc> discs_{};           ///< by face
    std::vector<vec3> base_{};            ///< positions that the cells were filled for
    std::vector<vec3> last_{};            ///< positions that the discs are of
    std::vector<std::array<std::uint32_t, 3>> faces_then_{};
    std::vector<unsigned char> moved_{};
};

static_assert(fluid_boundary<mesh_boundary>);

}  // namespace tafoni

#endif
