/// \file
/// The cells of a block of neighbouring sites, packed for assembly.
#ifndef TAFONI_DECOMPOSITION_DETAIL_CELL_BLOCK_HPP
#define TAFONI_DECOMPOSITION_DETAIL_CELL_BLOCK_HPP

#include <tafoni/decomposition/detail/site_tree.hpp>
#include <tafoni/decomposition/detail/voronoi_cell.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace tafoni::detail {

using vertex_key = std::array<std::uint32_t, 4>;

/// What a block of cells hands to the assembly. Of each cell in turn: its neighbours, ascending; per
/// face a degree and its corners as indices of the cell's vertices; per vertex the three neighbours
/// (their places in the list) that meet there. `own` are the vertices of which the cell is the lowest site.
struct cell_block {
    struct cell {
        std::uint32_t faces = 0;
        std::uint32_t vertices = 0;
        std::uint32_t own = 0;
        std::uint32_t corners = 0;
    };
    std::vector<cell> cells;
    std::vector<std::uint32_t> neighbour;
    std::vector<std::uint32_t> degree;
    std::vector<std::uint8_t> corner_small;  ///< corners, then triples, of cells with at most 255 vertices
    std::vector<std::uint32_t> corner_large;  ///< the same of all other cells
    std::vector<vertex_key> own_key;
    std::vector<vec3> own_position;
};

#if defined(__AVX__)
inline namespace avx {
#else
inline namespace baseline {
#endif

/// Builds the cells of whole leaves of a site tree, with scratch memory of its own.
class cell_builder {
public:
    cell_builder(std::span<ivec3 const> sites, site_tree const& tree, lattice_box const& box)
        : sites_(sites), tree_(tree), box_(box), small_(std::make_unique<voronoi_cell<64>>()) {}

    void build_leaf(std::uint32_t leaf, cell_block& out) {
        site_tree::node const& home = tree_.nodes[leaf];
        double const reach = reach_factor * static_cast<double>(home.spacing);
        reach2_ = reach * reach;
        gather(home);
        for (std::uint32_t i = home.begin; i < home.end; ++i) {
            if (build(*small_, home, i)) {
                emit(*small_, out);
            } else {
                if (!large_) large_ = std::make_unique<voronoi_cell<0>>();
                (void)build(*large_, home, i);
                emit(*large_, out);
            }
        }
    }

private:
    static constexpr double reach_factor = 2.2;
    static constexpr float near_factor = 1.9F;

    struct candidate {
        float distance2;
        std::uint32_t site;
        friend bool operator<(candidate const& a, candidate const& b) noexcept {
            return a.distance2 != b.distance2 ? a.distance2 < b.distance2 : a.site < b.site;
        }
    };

    [[nodiscard]] static double distance2(site_tree::node const& a, site_tree::node const& b) noexcept {
        double s = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            auto const gap = static_cast<double>(std::max({b.lo[k] - a.hi[k], a.lo[k] - b.hi[k], std::int64_t{0}}));
            s += gap * gap;
        }
        return s;
    }

    // All sites within reach of the leaf, relative to its corner: its sites share them.
    void gather(site_tree::node const& home) {
        id_.clear();
        for (auto& c : near_) c.clear();
        for (std::uint32_t k = 0; k < tree_.nodes.size();) {
            site_tree::node const& v = tree_.nodes[k];
            if (distance2(home, v) > reach2_) {
                k = v.skip;
                continue;
            }
            if (tree_.is_leaf(k)) {
                for (std::uint32_t s = v.begin; s < v.end; ++s) {
                    id_.push_back(s);
                    for (std::size_t a = 0; a < 3; ++a) {
                        near_[a].push_back(static_cast<float>(sites_[s][a] - home.lo[a]));
                    }
                }
            }
            ++k;
        }
        distance2_.resize(id_.size());
    }

    template <class Cell>
    [[nodiscard]] bool cut_all(Cell& cell, std::uint32_t self) {
        std::sort(queue_.begin(), queue_.end());
        for (auto const& c : queue_) {
            if (c.site != self && !cell.cut({sites_[c.site], c.site})) return false;
        }
        return true;
    }

    template <class Cell>
    [[nodiscard]] bool build(Cell& cell, site_tree::node const& home, std::uint32_t i) {
        cell.start({sites_[i], i}, box_, static_cast<std::uint32_t>(sites_.size()));
        float const ox = static_cast<float>(sites_[i][0] - home.lo[0]);
        float const oy = static_cast<float>(sites_[i][1] - home.lo[1]);
        float const oz = static_cast<float>(sites_[i][2] - home.lo[2]);
        std::size_t const n = id_.size();
        for (std::size_t k = 0; k < n; ++k) {
            float const dx = near_[0][k] - ox;
            float const dy = near_[1][k] - oy;
            float const dz = near_[2][k] - oz;
            distance2_[k] = dx * dx + dy * dy + dz * dz;
        }
        float const inner = near_factor * home.spacing;
        float const inner2 = inner * inner;
        queue_.clear();
        for (std::size_t k = 0; k < n; ++k) {
            if (distance2_[k] <= inner2) queue_.push_back({distance2_[k], id_[k]});
        }
        if (!cut_all(cell, i)) return false;
        // Single precision sees all sites from the leaf's corner; the slack is far above its error.
        double size2 = reach2_;
        for (std::size_t a = 0; a < 3; ++a) {
            auto const side = static_cast<double>(home.hi[a] - home.lo[a]);
            size2 += side * side;
        }
        auto const outer2 = static_cast<float>(4 * cell.radius2() + 1e-5 * (size2 + 4 * cell.radius2()));
        queue_.clear();
        for (std::size_t k = 0; k < n; ++k) {
            if (distance2_[k] > inner2 && distance2_[k] <= outer2) queue_.push_back({distance2_[k], id_[k]});
        }
        if (!cut_all(cell, i)) return false;
        return 4 * cell.radius2() <= reach2_ || search(cell, home, i);
    }

    // Looks wherever a vertex of the cell still has a site that might be nearer.
    template <class Cell>
    [[nodiscard]] bool search(Cell& cell, site_tree::node const& home, std::uint32_t i) {
        ivec3 const& at = sites_[i];
        for (std::uint32_t k = 0; k < tree_.nodes.size();) {
            site_tree::node const& v = tree_.nodes[k];
            std::array<double, 3> lo{};
            std::array<double, 3> hi{};
            for (std::size_t a = 0; a < 3; ++a) {
                lo[a] = static_cast<double>(v.lo[a] - at[a]);
                hi[a] = static_cast<double>(v.hi[a] - at[a]);
            }
            if (!cell.reachable(lo, hi)) {
                k = v.skip;
                continue;
            }
            if (tree_.is_leaf(k) && distance2(home, v) > reach2_) {
                for (std::uint32_t s = v.begin; s < v.end; ++s) {
                    if (!cell.cut({sites_[s], s})) return false;
                }
            }
            ++k;
        }
        return true;
    }

    template <class Cell>
    void emit(Cell& cell, cell_block& out) {
        cell.prepare_walks();
        auto const self = cell.site().rank;
        order_.clear();
        for (std::uint32_t p = 0; p < cell.plane_count(); ++p) {
            if (cell.alive(p)) order_.push_back(p);
        }
        std::sort(order_.begin(), order_.end(),
                  [&cell](std::uint32_t a, std::uint32_t b) { return cell.id_of(a) < cell.id_of(b); });
        place_.resize(cell.plane_count());
        first_.resize(cell.plane_count());
        for (std::size_t k = 0; k < order_.size(); ++k) place_[order_[k]] = static_cast<std::uint32_t>(k);

        cell_block::cell c{.faces = static_cast<std::uint32_t>(order_.size()), .vertices = cell.vertex_count()};
        own_.clear();
        for (std::uint32_t v = 0; v < c.vertices; ++v) {
            auto const& t = cell.vertex(v);
            for (auto p : t) first_[p] = v;
            vertex_key key{self, cell.id_of(t[0]), cell.id_of(t[1]), cell.id_of(t[2])};
            if (self < key[1] && self < key[2] && self < key[3]) {
                std::sort(key.begin() + 1, key.end());
                own_.push_back(key);
            }
        }
        std::sort(own_.begin(), own_.end());
        for (auto const& key : own_) {
            out.own_key.push_back(key);
            out.own_position.push_back(position(key));
        }
        c.own = static_cast<std::uint32_t>(own_.size());
        for (auto p : order_) {
            out.neighbour.push_back(cell.id_of(p));
            out.degree.push_back(cell.degree(p));
            c.corners += cell.degree(p);
        }
        auto const write = [&]<class T>(std::vector<T>& list) {
            for (auto p : order_) cell.walk(p, first_[p], [&](std::uint32_t v) { list.push_back(static_cast<T>(v)); });
            for (std::uint32_t v = 0; v < c.vertices; ++v) {
                for (auto p : cell.vertex(v)) list.push_back(static_cast<T>(place_[p]));
            }
        };
        if (c.vertices <= 255) {
            write(out.corner_small);
        } else {
            write(out.corner_large);
        }
        out.cells.push_back(c);
    }

    [[nodiscard]] exact::plane plane(std::uint32_t id) const noexcept {
        auto const n = static_cast<std::uint32_t>(sites_.size());
        if (id < n) return exact::site{sites_[id], id};
        std::uint32_t const w = id - n;
        auto const a = static_cast<std::size_t>(w / 2);
        return exact::wall{static_cast<int>(w / 2), w % 2 != 0, w % 2 != 0 ? box_.hi[a] : box_.lo[a]};
    }

    // A function of the key alone, on the walls and in the box to the last bit.
    [[nodiscard]] vec3 position(vertex_key const& key) const noexcept {
        ivec3 const& base = sites_[key[0]];
        std::array const planes{plane(key[1]), plane(key[2]), plane(key[3])};
        vertex_estimate const e = solve(base, planes[0], planes[1], planes[2]);
        std::array<double, 3> x{e.x, e.y, e.z};
        for (std::size_t a = 0; a < 3; ++a) {
            x[a] = std::clamp(static_cast<double>(base[a]) + x[a], static_cast<double>(box_.lo[a]),
                              static_cast<double>(box_.hi[a]));
        }
        for (auto const& p : planes) {
            if (p.axis >= 0) x[static_cast<std::size_t>(p.axis)] = static_cast<double>(p.at[static_cast<std::size_t>(p.axis)]);
        }
        return vec3{x[0], x[1], x[2]};
    }

    std::span<ivec3 const> sites_;
    site_tree const& tree_;
    lattice_box box_;
    std::unique_ptr<voronoi_cell<64>> small_;
    std::unique_ptr<voronoi_cell<0>> large_;
    double reach2_ = 0;
    std::vector<std::uint32_t> id_;
    std::array<std::vector<float>, 3> near_;
    std::vector<float> distance2_;
    std::vector<candidate> queue_;
    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> place_;
    std::vector<std::uint32_t> first_;
    std::vector<vertex_key> own_;
};

}  // namespace baseline or avx
}  // namespace tafoni::detail

#endif
