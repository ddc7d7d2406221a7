/// \file
/// Builds the Voronoi cells of a block of neighbouring sites.
#ifndef TAFONI_DECOMPOSITION_DETAIL_CELL_BUILDER_HPP
#define TAFONI_DECOMPOSITION_DETAIL_CELL_BUILDER_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/decomposition/detail/cell_block.hpp>
#include <tafoni/decomposition/detail/near_planes.hpp>
#include <tafoni/decomposition/detail/near_sites.hpp>
#include <tafoni/decomposition/detail/site_tree.hpp>
#include <tafoni/decomposition/detail/voronoi_cell.hpp>
#include <tafoni/decomposition/detail/wrapped_cell.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace tafoni::detail {

#if defined(__AVX__)
inline namespace avx {
#else
inline namespace baseline {
#endif

/// Builds the cells of blocks of leaves of a site tree, with scratch memory of its own.
///
/// A vertex that one cell of the block has found is handed to the later ones that it belongs to, so
/// most cells begin with most of their vertices, and sites whose cells are done meet no new ones.
/// Cells for which that does not do are cut out of the box. Decisions are exact, so both give the same.
class cell_builder {
public:
    cell_builder(std::span<ivec3 const> sites, site_tree const& tree, lattice_box const& box)
        : sites_(sites), tree_(tree), box_(box), planes_{sites, box},
          wrapped_(std::make_unique<wrapped_cell>()), candidates_(std::make_unique<near_planes>()),
          small_(std::make_unique<voronoi_cell<64>>()) {}

    /// Appends the cells of some leaves that follow each other.
    void build(std::span<std::uint32_t const> leaves, cell_block& out) {
        first_ = tree_.nodes[leaves.front()].begin;
        end_ = tree_.nodes[leaves.back()].end;
        known_.clear();
        latest_.assign(end_ - first_, no_more);
        for (auto const leaf : leaves) build_leaf(leaf, out);
    }

private:
    static constexpr double reach_factor = 3.2;
    static constexpr float near_factor = 2.6F;
    static constexpr std::array<double, 2> wrap_factors{2.8, 4.0};
    static constexpr std::uint32_t no_more = 0xffffffffU;

    /// A vertex that an earlier cell of the block hands to a later one.
    struct known_vertex {
        std::array<std::uint32_t, 3> planes{};  ///< as in `wrapped_cell::triple`
        std::uint32_t place = 0;                ///< as in `cell_block::vertex`
        std::uint32_t next = no_more;
        std::array<double, 3> at{};  ///< relative to the first site of the block
    };

    /// A vertex that the cell at work is the first of its block to see.
    struct fresh_vertex {
        std::uint32_t vertex = 0;
        std::array<std::uint32_t, 3> planes{};
        vertex_estimate at{};
        vertex_key key{};
    };

    void build_leaf(std::uint32_t leaf, cell_block& out) {
        site_tree::node const& home = tree_.nodes[leaf];
        double const reach = reach_factor * static_cast<double>(home.spacing);
        reach2_ = reach * reach;
        std::size_t gathered = 0;
        bool all_gathered = false;
        for (std::uint32_t i = home.begin; i < home.end; ++i) {
            bool done = false;
            for (std::size_t k = 0; k < wrap_factors.size() && !done && latest_[i - first_] != no_more; ++k) {
                double const wrap_reach = wrap_factors[k] * static_cast<double>(home.spacing);
                if (gathered == k) {
                    unbuilt_[k].gather(sites_, tree_, home, wrap_reach * wrap_reach, first_, home.begin);
                    ++gathered;
                }
                done = wrap(unbuilt_[k], wrap_reach, home, i);
            }
            if (done) {
                finish(*wrapped_, out);
                continue;
            }
            if (!all_gathered) all_.gather(sites_, tree_, home, reach2_, 0, 0);
            all_gathered = true;
            if (build(*small_, home, i)) {
                sort_out(*small_);
                finish(*small_, out);
            } else {
                if (!large_) large_ = std::make_unique<voronoi_cell<0>>();
                (void)build(*large_, home, i);
                sort_out(*large_);
                finish(*large_, out);
            }
        }
    }

    // The cell from the vertices that earlier cells have found.
    [[nodiscard]] bool wrap(near_sites const& sites, double wrap_reach, site_tree::node const& home, std::uint32_t i) {
        place_.clear();
        fresh_.clear();
        double const scale = sites.scale();
        auto const reach = static_cast<float>(0.9999 * wrap_reach * scale);
        float extent = reach;
        for (std::size_t a = 0; a < 3; ++a) extent += static_cast<float>(static_cast<double>(home.hi[a] - home.lo[a]) * scale);
        // Single precision sees all sites from the leaf's corner.
        float const margin = 2e-6F * extent * extent;
        if (!(8 * margin < 0.04F * reach * reach)) return false;
        ivec3 const& at = sites_[i];
        std::size_t const here = sites.home();
        if (!candidates_->fill(sites, here, here + (i - home.begin) + 1, at, reach, 8 * margin, box_,
                               static_cast<std::uint32_t>(sites_.size()))) {
            return false;
        }
        wrapped_->start({at, i}, first_, scale, reach, margin);
        auto const place = [&](std::uint32_t id) { return wrapped_->plane(id, planes_); };
        ivec3 const& origin = sites_[first_];
        std::array<double, 3> shift{};
        for (std::size_t a = 0; a < 3; ++a) shift[a] = static_cast<double>(at[a] - origin[a]);
        for (std::uint32_t k = latest_[i - first_]; k != no_more; k = known_[k].next) {
            known_vertex const& v = known_[k];
            place_.push_back(v.place);
            auto const a = place(v.planes[0]);
            auto const b = place(v.planes[1]);
            auto const c = place(v.planes[2]);
            if (!wrapped_->insert({a, b, c}, {static_cast<float>((v.at[0] - shift[0]) * scale),
                                              static_cast<float>((v.at[1] - shift[1]) * scale),
                                              static_cast<float>((v.at[2] - shift[2]) * scale)})) {
                return false;
            }
        }
        return wrapped_->complete(*candidates_, planes_, [&](std::uint32_t v, vertex_estimate const& e) {
            auto const& t = wrapped_->vertex(v);
            fresh_.push_back({v, {wrapped_->id_of(t[0]), wrapped_->id_of(t[1]), wrapped_->id_of(t[2])}, e, {}});
        });
    }

    [[nodiscard]] static vertex_key key_of(std::uint32_t i, std::array<std::uint32_t, 3> t) noexcept {
        if (t[0] > t[1]) std::swap(t[0], t[1]);
        if (t[1] > t[2]) std::swap(t[1], t[2]);
        if (t[0] > t[1]) std::swap(t[0], t[1]);
        return {std::min(i, t[0]), std::max(std::min(i, t[1]), t[0]), std::max(std::min(i, t[2]), t[1]), std::max(i, t[2])};
    }

    // Parts the vertices of a cell that was cut into those known and fresh ones.
    template <class Cell>
    void sort_out(Cell const& cell) {
        std::uint32_t const i = cell.site().rank;
        fresh_.clear();
        place_.resize(cell.vertex_count());
        lookup_.clear();
        for (std::uint32_t k = latest_[i - first_]; k != no_more; k = known_[k].next) {
            lookup_.push_back({key_of(i, known_[k].planes), known_[k].place});
        }
        std::sort(lookup_.begin(), lookup_.end());
        for (std::uint32_t v = 0; v < cell.vertex_count(); ++v) {
            auto const& p = cell.vertex(v);
            std::array const t{cell.id_of(p[0]), cell.id_of(p[1]), cell.id_of(p[2])};
            vertex_key const key = key_of(i, t);
            if (std::any_of(t.begin(), t.end(), [&](std::uint32_t id) { return id >= first_ && id < i; })) {
                auto const found = std::lower_bound(lookup_.begin(), lookup_.end(), std::pair{key, std::uint32_t{0}});
                TAFONI_ASSERT(found != lookup_.end() && found->first == key, "cells agree on their vertices");
                place_[v] = found->second;
            } else {
                std::array<std::uint32_t, 3> ids{};
                std::copy_if(key.begin(), key.end(), ids.begin(), [i](std::uint32_t id) { return id != i; });
                fresh_.push_back({v, t, solve(sites_[i], planes_(ids[0]), planes_(ids[1]), planes_(ids[2])), key});
            }
        }
    }

    template <class Cell>
    void finish(Cell& cell, cell_block& out) {
        std::uint32_t const own = add_fresh(cell.site().rank, out);
        write_(cell, place_, own, out);
    }

    // Of keys with the same first id.
    [[nodiscard]] static bool before(vertex_key const& a, vertex_key const& b) noexcept {
        std::uint64_t const l = std::uint64_t{a[1]} << 32 | a[2];
        std::uint64_t const r = std::uint64_t{b[1]} << 32 | b[2];
        return l < r || (l == r && a[3] < b[3]);
    }

    // Gives the fresh vertices their places and hands them on to the later cells of the block.
    // Returns how many are the cell's own.
    [[nodiscard]] std::uint32_t add_fresh(std::uint32_t i, cell_block& out) {
        if (!fresh_.empty()) place_.resize(std::max<std::size_t>(place_.size(), fresh_.back().vertex + 1));
        own_.clear();
        for (std::uint32_t f = 0; f < fresh_.size(); ++f) {
            fresh_vertex& v = fresh_[f];
            v.key = key_of(i, v.planes);
            if (v.key[0] == i) {
                own_.push_back(f);
            } else {
                place_[v.vertex] = cell_block::elsewhere | static_cast<std::uint32_t>(out.borrowed.size());
                out.borrowed.push_back(v.key);
            }
        }
        if (own_.size() > 48) {
            std::sort(own_.begin(), own_.end(), [this](std::uint32_t l, std::uint32_t r) { return before(fresh_[l].key, fresh_[r].key); });
        } else {
            for (std::size_t k = 1; k < own_.size(); ++k) {
                std::uint32_t const f = own_[k];
                std::size_t h = k;
                for (; h > 0 && before(fresh_[f].key, fresh_[own_[h - 1]].key); --h) own_[h] = own_[h - 1];
                own_[h] = f;
            }
        }
        for (std::uint32_t const f : own_) {
            fresh_vertex const& v = fresh_[f];
            place_[v.vertex] = static_cast<std::uint32_t>(out.own_key.size());
            out.own_key.push_back(v.key);
            out.own_position.push_back(planes_.position(v.key, v.at));
        }
        std::array<double, 3> shift{};
        for (std::size_t a = 0; a < 3; ++a) shift[a] = static_cast<double>(sites_[i][a] - sites_[first_][a]);
        for (auto const& v : fresh_) {
            // Seen from x, the planes (i, z, y) meet with the orientation that (x, y, z) have seen from i.
            for (std::size_t k = 0; k < 3; ++k) {
                std::uint32_t const to = v.planes[k];
                if (to < first_ || to >= end_) continue;
                auto& last = latest_[to - first_];
                known_.push_back({{i, v.planes[(k + 2) % 3], v.planes[(k + 1) % 3]}, place_[v.vertex], last,
                                  {v.at.x + shift[0], v.at.y + shift[1], v.at.z + shift[2]}});
                last = static_cast<std::uint32_t>(known_.size() - 1);
            }
        }
        return static_cast<std::uint32_t>(own_.size());
    }

    // Cuts by the gathered sites with lo < distance^2 <= hi, near ones first: sorted into shells up to
    // `usual`, which is as good as exact order and needs no comparisons.
    template <class Cell>
    [[nodiscard]] bool cut_between(Cell& cell, std::uint32_t self, float lo, float hi, float usual) {
        std::size_t const n = all_.size();
        std::size_t count = 0;
        for (std::size_t k = 0; k < n; ++k) {
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
            std::uint32_t const id = all_.id(s);
            if (id != self && !cell.cut(sites_[id], id)) return false;
        }
        return true;
    }

    template <class Cell>
    [[nodiscard]] bool build(Cell& cell, site_tree::node const& home, std::uint32_t i) {
        cell.start({sites_[i], i}, box_, static_cast<std::uint32_t>(sites_.size()));
        std::size_t const n = all_.size();
        if (distance2_.size() < n) {
            distance2_.resize(2 * n);
            queue_.resize(2 * n);
            sorted_.resize(2 * n);
        }
        auto const [ox, oy, oz] = all_.relative(sites_[i]);
        float const* const x = all_.x();
        float const* const y = all_.y();
        float const* const z = all_.z();
        auto const unit2 = static_cast<float>(1 / (all_.scale() * all_.scale()));
        float* const d2 = distance2_.data();
        for (std::size_t k = 0; k < n; ++k) {
            float const dx = x[k] - ox;
            float const dy = y[k] - oy;
            float const dz = z[k] - oz;
            d2[k] = (dx * dx + dy * dy + dz * dz) * unit2;
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
                (leaf && (near2 <= done2 || near_sites::distance2(home, v) <= reach2_)) ||
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

    std::span<ivec3 const> sites_;
    site_tree const& tree_;
    lattice_box box_;
    plane_source planes_;
    cell_writer write_;
    std::unique_ptr<wrapped_cell> wrapped_;
    std::unique_ptr<near_planes> candidates_;
    std::unique_ptr<voronoi_cell<64>> small_;
    std::unique_ptr<voronoi_cell<0>> large_;
    std::uint32_t first_ = 0;
    std::uint32_t end_ = 0;
    std::vector<known_vertex> known_;
    std::vector<std::uint32_t> latest_;  ///< cell -> the last of its vertices in `known_`
    std::vector<fresh_vertex> fresh_;
    std::vector<std::uint32_t> own_;    ///< places in `fresh_`
    std::vector<std::uint32_t> place_;  ///< vertex of the cell at work -> as in `cell_block::vertex`
    std::vector<std::pair<vertex_key, std::uint32_t>> lookup_;
    std::array<near_sites, wrap_factors.size()> unbuilt_;
    near_sites all_;
    double reach2_ = 0;
    double slack_ = 0;
    std::vector<float> distance2_;
    std::vector<std::uint32_t> queue_;
    std::vector<std::uint32_t> sorted_;
};

}  // namespace baseline or avx
}  // namespace tafoni::detail

#endif
