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
#include <string>
#include <utility>
#include <vector>

namespace tafoni::detail {

using vertex_key = std::array<std::uint32_t, 4>;

/// What a block of cells hands to the assembly. Of each cell in turn: its neighbours, ascending; per
/// face a degree and its corners as indices of the cell's vertices; per vertex the three neighbours
/// (their places in the list, ascending) that meet there. `own` are the vertices of which the cell is the lowest site.
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

    void clear() noexcept {
        cells.clear();
        neighbour.clear();
        degree.clear();
        corner_small.clear();
        corner_large.clear();
        own_key.clear();
        own_position.clear();
    }
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
    static constexpr double reach_factor = 3.2;
    static constexpr float near_factor = 2.6F;

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
        gathered_ = 0;
        for (std::uint32_t k = 0; k < tree_.nodes.size();) {
            site_tree::node const& v = tree_.nodes[k];
            if (distance2(home, v) > reach2_) {
                k = v.skip;
                continue;
            }
            if (tree_.is_leaf(k)) {
                if (id_.size() < gathered_ + site_tree::leaf_size) {
                    std::size_t const n = 2 * (gathered_ + site_tree::leaf_size);
                    id_.resize(n);
                    distance2_.resize(n);
                    queue_.resize(n);
                    sorted_.resize(n);
                    for (auto& c : near_) c.resize(n);
                }
                for (std::uint32_t s = v.begin; s < v.end; ++s, ++gathered_) {
                    id_[gathered_] = s;
                    for (std::size_t a = 0; a < 3; ++a) {
                        near_[a][gathered_] = static_cast<float>(sites_[s][a] - home.lo[a]);
                    }
                }
            }
            ++k;
        }
    }

    // Cuts by the gathered sites with lo < distance^2 <= hi, near ones first: sorted into shells up to
    // `usual`, which is as good as exact order and needs no comparisons.
    template <class Cell>
    [[nodiscard]] bool cut_between(Cell& cell, std::uint32_t self, float lo, float hi, float usual) {
        std::size_t count = 0;
        for (std::size_t k = 0; k < gathered_; ++k) {
            queue_[count] = static_cast<std::uint32_t>(k);
            count += static_cast<std::size_t>(distance2_[k] > lo) & static_cast<std::size_t>(distance2_[k] <= hi);
        }
        if (count == 0) return true;
        constexpr std::size_t shells = 64;
        std::array<std::uint32_t, shells + 1> begin{};
        float const base = lo > 0 ? lo : 0;
        float const span = std::min(hi, usual) - base;
        float const scale = span > 0 ? static_cast<float>(shells) / span : 0;
        auto const shell = [&](std::uint32_t k) {
            float const s = std::min((distance2_[k] - base) * scale, static_cast<float>(shells - 1));
            return static_cast<std::size_t>(static_cast<std::int32_t>(s));
        };
        for (std::size_t k = 0; k < count; ++k) ++begin[shell(queue_[k]) + 1];
        for (std::size_t k = 0; k < shells; ++k) begin[k + 1] += begin[k];
        for (std::size_t k = 0; k < count; ++k) sorted_[begin[shell(queue_[k])]++] = queue_[k];
        for (std::size_t k = 0; k < count; ++k) {
            std::uint32_t const s = sorted_[k];
            if (static_cast<double>(distance2_[s]) > 4 * cell.radius2() + slack_) continue;
            if (id_[s] != self && !cell.cut(sites_[id_[s]], id_[s])) return false;
        }
        return true;
    }

    template <class Cell>
    [[nodiscard]] bool build(Cell& cell, site_tree::node const& home, std::uint32_t i) {
        cell.start({sites_[i], i}, box_, static_cast<std::uint32_t>(sites_.size()));
        float const ox = static_cast<float>(sites_[i][0] - home.lo[0]);
        float const oy = static_cast<float>(sites_[i][1] - home.lo[1]);
        float const oz = static_cast<float>(sites_[i][2] - home.lo[2]);
        float const* const x = near_[0].data();
        float const* const y = near_[1].data();
        float const* const z = near_[2].data();
        float* const d2 = distance2_.data();
        for (std::size_t k = 0; k < gathered_; ++k) {
            float const dx = x[k] - ox;
            float const dy = y[k] - oy;
            float const dz = z[k] - oz;
            d2[k] = dx * dx + dy * dy + dz * dz;
        }
        float const inner = near_factor * home.spacing;
        float const inner2 = inner * inner;
        // Single precision sees all sites from the leaf's corner; the slack is far above its error.
        double size2 = reach2_;
        for (std::size_t a = 0; a < 3; ++a) {
            auto const side = static_cast<double>(home.hi[a] - home.lo[a]);
            size2 += side * side;
        }
        slack_ = 1e-5 * (size2 + 4 * cell.radius2());
        if (!cut_between(cell, i, -1, inner2, inner2)) return false;
        slack_ = 1e-5 * (size2 + 4 * cell.radius2());
        double const bound = 4 * cell.radius2() + slack_;
        if (bound > static_cast<double>(inner2) &&
            !cut_between(cell, i, inner2, static_cast<float>(bound), static_cast<float>(4 * size2))) {
            return false;
        }
        return 4 * cell.radius2() <= reach2_ || search(cell, home, i);
    }

    // Looks wherever a vertex of the cell still has a site that might be nearer, in rounds of twice the
    // distance, so that near sites cut first.
    template <class Cell>
    [[nodiscard]] bool search(Cell& cell, site_tree::node const& home, std::uint32_t i) {
        double done2 = -1;
        for (double limit2 = std::max(4 * reach2_, 1.0);; limit2 *= 4) {
            bool const last = !(4 * cell.radius2() > limit2);
            if (!search_between(cell, home, i, done2, limit2)) return false;
            if (last || !(4 * cell.radius2() > limit2)) return true;
            done2 = limit2;
        }
    }

    template <class Cell>
    [[nodiscard]] bool search_between(Cell& cell, site_tree::node const& home, std::uint32_t i, double done2,
                                      double limit2) {
        ivec3 const& at = sites_[i];
        for (std::uint32_t k = 0; k < tree_.nodes.size();) {
            site_tree::node const& v = tree_.nodes[k];
            std::array<double, 3> lo{};
            std::array<double, 3> hi{};
            double near2 = 0;
            for (std::size_t a = 0; a < 3; ++a) {
                lo[a] = static_cast<double>(v.lo[a] - at[a]);
                hi[a] = static_cast<double>(v.hi[a] - at[a]);
                double const gap = std::max(0.0, std::max(lo[a], -hi[a]));
                near2 += gap * gap;
            }
            // Cheapest first: too far for now or for any vertex, seen already, out of every vertex' reach.
            bool const leaf = tree_.is_leaf(k);
            if (near2 > limit2 || near2 > 4 * cell.radius2() ||
                (leaf && (near2 <= done2 || distance2(home, v) <= reach2_)) ||
                (near2 > 0.25 * reach2_ && !cell.reachable(lo, hi))) {
                k = v.skip;
                continue;
            }
            if (leaf) {
                for (std::uint32_t s = v.begin; s < v.end; ++s) {
                    if (!cell.cut(sites_[s], s)) return false;
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
            if (cell.alive(p)) order_.push_back(std::uint64_t{cell.id_of(p)} << 32 | p);
        }
        sort_few(order_);
        place_.resize(cell.plane_count());
        first_.resize(cell.plane_count());
        cell_block::cell c{.faces = static_cast<std::uint32_t>(order_.size()), .vertices = cell.vertex_count()};
        std::size_t const face = out.neighbour.size();
        out.neighbour.resize(face + order_.size());
        out.degree.resize(face + order_.size());
        for (std::uint32_t k = 0; k < c.faces; ++k) {
            auto const p = static_cast<std::uint32_t>(order_[k]);
            place_[p] = k;
            out.neighbour[face + k] = cell.id_of(p);
            out.degree[face + k] = cell.degree(p);
            c.corners += cell.degree(p);
        }
        std::uint32_t const* const ids = out.neighbour.data() + face;
        // Sites of higher rank than this one, and the walls, come last.
        auto const above = static_cast<std::uint32_t>(std::lower_bound(ids, ids + c.faces, self) - ids);
        own_.clear();
        auto const write = [&]<class T>(std::vector<T>& list) {
            std::size_t const old = list.size();
            list.resize(old + c.corners + 3 * std::size_t{c.vertices});
            T* triple = list.data() + old + c.corners;
            for (std::uint32_t v = 0; v < c.vertices; ++v) {
                auto const& t = cell.vertex(v);
                std::uint64_t i = place_[t[0]];
                std::uint64_t j = place_[t[1]];
                std::uint64_t k = place_[t[2]];
                first_[t[0]] = first_[t[1]] = first_[t[2]] = v;
                if (i > j) std::swap(i, j);
                if (j > k) std::swap(j, k);
                if (i > j) std::swap(i, j);
                if (i >= above) own_.push_back(i << 42 | j << 21 | k);
                *triple++ = static_cast<T>(i);
                *triple++ = static_cast<T>(j);
                *triple++ = static_cast<T>(k);
            }
            T* corner = list.data() + old;
            for (auto const o : order_) {
                auto const p = static_cast<std::uint32_t>(o);
                cell.walk(p, first_[p], [&](std::uint32_t v) { *corner++ = static_cast<T>(v); });
            }
        };
        if (c.vertices <= 255) {
            write(out.corner_small);
        } else {
            if (c.faces >> 21 != 0) {
                fail<invalid_input>(errc::size_overflow, "make_voronoi_diagram: a cell has " + std::to_string(c.faces) + " faces");
            }
            write(out.corner_large);
        }
        sort_few(own_);
        constexpr std::uint64_t mask = (1U << 21) - 1;
        for (auto const o : own_) {
            vertex_key const key{self, ids[o >> 42], ids[o >> 21 & mask], ids[o & mask]};
            out.own_key.push_back(key);
            out.own_position.push_back(position(key));
        }
        c.own = static_cast<std::uint32_t>(own_.size());
        out.cells.push_back(c);
    }

    // Insertion for the usual handful.
    static void sort_few(std::vector<std::uint64_t>& list) {
        if (list.size() > 48) {
            std::sort(list.begin(), list.end());
            return;
        }
        for (std::size_t k = 1; k < list.size(); ++k) {
            std::uint64_t const v = list[k];
            std::size_t h = k;
            for (; h > 0 && list[h - 1] > v; --h) list[h] = list[h - 1];
            list[h] = v;
        }
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
    double slack_ = 0;
    std::vector<std::uint32_t> id_;
    std::array<std::vector<float>, 3> near_;
    std::vector<float> distance2_;
    std::vector<std::uint32_t> queue_;
    std::vector<std::uint32_t> sorted_;
    std::size_t gathered_ = 0;
    std::vector<std::uint64_t> order_;
    std::vector<std::uint32_t> place_;
    std::vector<std::uint32_t> first_;
    std::vector<std::uint64_t> own_;
};

}  // namespace baseline or avx
}  // namespace tafoni::detail

#endif
