/// \file
/// Rock that nothing holds falls, and is found without looking at the rest.
#ifndef TAFONI_VOXEL_ROCKFALL_HPP
#define TAFONI_VOXEL_ROCKFALL_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/executor.hpp>
#include <tafoni/voxel/detail/joint_cuts.hpp>
#include <tafoni/voxel/detail/rockfall_friction.hpp>
#include <tafoni/voxel/detail/rockfall_ground.hpp>
#include <tafoni/voxel/detail/rockfall_removals.hpp>
#include <tafoni/voxel/detail/rockfall_search.hpp>
#include <tafoni/voxel/fallen_block.hpp>
#include <tafoni/voxel/rockfall_options.hpp>
#include <tafoni/voxel/sparse_grid.hpp>
#include <tafoni/voxel/voxel_change.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tafoni {

/// Rock that does not hang on the ground by faces of rock falls, as whole pieces [Jones et al., sections 4 and 6;
/// joints and friction after Ito et al. 2003].
///
/// Voxels hang together by their faces only, where no joint cuts the bond; edges and corners hold nothing, and
/// colluvium neither carries nor connects rock. What stands and what falls follows from the grid alone:
///   - A piece with ground in it stands (`rockfall_options`).
///   - With a friction angle, a piece stands that rests on a piece that stands, across joints that are together no
///     steeper than the angle: the faces of its voxels that look down on rock count by the normals of their joints
///     (the steepest where several cut one face), weighted by the joints' area. Neither walls beside it nor its
///     centre of mass are asked. Pieces that rest only on one another fall.
///   - Everything else falls in the same call, and then what rested on it.
/// Pieces that are loose before the first call fall in it; `loose` tells them beforehand.
///
/// Follows one grid from call to call and keeps labels of its bricks, about 7 KiB for a brick that holds both rock
/// and air. A copy follows a copy of the grid. As nothing else is kept, a new object goes on where another stopped.
class rockfall {
public:
    rockfall() = default;
    /// \throws invalid_input  as `rockfall_options::validate`.
    explicit rockfall(rockfall_options options) : options_((options.validate(), std::move(options))) {}

    [[nodiscard]] rockfall_options const& options() const noexcept { return options_; }

    /// The next call looks at the whole grid again. For a grid that was changed in ways that `fall` was not told.
    void restart() { search_.reset(); }

    /// The pieces that would fall from a grid seen for the first time, by their lowest voxels. O(rock); works on a
    /// copy of the grid.
    template <executor Executor>
    [[nodiscard]] std::vector<fallen_block> loose(sparse_grid const& grid, Executor const& threads) const {
        sparse_grid copy = grid;
        std::vector<voxel_change> changes;
        return rockfall(options_).fall(copy, {}, 0, threads, changes);
    }

    /// Lets fall what stands no more: its voxels become air. Bricks that become empty are left to the caller to
    /// `compact`.
    ///
    /// Each removed voxel costs a look at its 26 neighbours, some at the 8^3 voxels around them. Only where that leaves
    /// it open whether rock came apart, bricks are searched: those between there and the ground, or those of the piece
    /// that falls, each labelled again (10 to 40 us) if it changed since it was last searched. At worst, all bricks at
    /// the surface once per call. The first call, and that which finds no ground any more, look at all.
    /// \param removed  voxels that were rock after the last call and are not now; in any order. Not read in the
    ///                 first call.
    /// \param changes  gets rock -> air appended, each voxel once, in voxel order.
    /// \return  the pieces by their lowest voxels; the same for every executor.
    /// \throws invalid_input  `bad_parameter`, for a removed voxel that is rock or outside the grid, or another size of
    ///         grid than before. Whatever is thrown, also by `ground_where`, by the executor or where memory runs
    ///         out: the grid and `changes` are as they were. But for `invalid_input`, the next call looks at all.
    template <executor Executor>
    std::vector<fallen_block> fall(sparse_grid& grid, std::span<voxel const> removed, std::uint64_t step,
                                   Executor const& threads, std::vector<voxel_change>& changes) {
        std::vector<voxel> const gone = search_ ? checked(grid, removed) : std::vector<voxel>{};
        std::size_t const told = changes.size();
        try {
            return let_fall_from(grid, gone, step, threads, changes);
        } catch (...) {
            // Bricks that were changed are stored, so this needs no memory.
            for (std::size_t i = told; i < changes.size(); ++i) grid.set(changes[i].at, voxel_state::rock);
            changes.resize(told);
            restart();  // what the next call finds depends on the grid alone
            throw;
        }
    }

    /// What finding it took since the object or `restart` began, to be watched: bricks labelled, faces of bricks
    /// passed, removed voxels that the voxels around them did not settle.
    struct effort_count {
        std::size_t bricks_labelled = 0;
        std::size_t faces_passed = 0;
        std::size_t voxels_searched = 0;
    };
    [[nodiscard]] effort_count effort() const noexcept {
        if (!search_) return {};
        return {search_->bricks_labelled(), search_->faces_passed(), removals_.parted()};
    }

private:
    using state = detail::rockfall_search::state;

    /// Without ground nothing is there to rest on.
    [[nodiscard]] bool friction() const noexcept { return options_.friction_angle > 0 && ground_left_ != 0; }

    [[nodiscard]] std::vector<voxel> checked(sparse_grid const& grid, std::span<voxel const> removed) const {
        if (grid.size() != size_) {
            detail::fail<invalid_input>(errc::bad_parameter, "rockfall::fall: got a grid of another size than before",
                                        {.kind = entity::parameter});
        }
        for (std::size_t i = 0; i < removed.size(); ++i) {
            voxel const v = removed[i];
            if (grid.contains(v) && !grid.is_rock(v)) continue;
            detail::fail<invalid_input>(errc::bad_parameter,
                                        "rockfall::fall: removed[" + std::to_string(i) + "]: got voxel (" +
                                            std::to_string(v.x) + ", " + std::to_string(v.y) + ", " +
                                            std::to_string(v.z) + "), which is rock or outside the grid",
                                        {.kind = entity::voxel, .index = i});
        }
        std::vector<voxel> out(removed.begin(), removed.end());
        if (!std::is_sorted(out.begin(), out.end())) std::sort(out.begin(), out.end());
        out.erase(std::unique(out.begin(), out.end()), out.end());
        return out;
    }

    template <executor Executor>
    std::vector<fallen_block> let_fall_from(sparse_grid& grid, std::vector<voxel> const& gone, std::uint64_t step,
                                            Executor const& threads, std::vector<voxel_change>& changes) {
        std::vector<std::uint32_t> loose;
        std::vector<fallen_block> out;
        std::size_t const first = changes.size();
        if (!search_) {
            detail::joint_cuts cuts(grid, options_.joints, threads);
            detail::rockfall_ground ground(grid, options_, threads);
            search_.emplace(grid, std::move(cuts), std::move(ground));
            size_ = grid.size();
            ground_left_ = search_->ground().count(grid);
            rock_left_ = grid.count(voxel_plane::rock);
            loose = look_at_all(grid, threads);
        } else {
            bool const had_ground = ground_left_ != 0;
            for (voxel const v : gone) {
                search_->touch(grid.brick_of(v));
                if (search_->ground().contains(grid, v)) --ground_left_;
            }
            rock_left_ -= gone.size();
            auto const& open =
                removals_.witnesses(grid, search_->cuts(), search_->ground(), gone, friction(), ground_left_ != 0);
            crumble(grid, removals_.crumbs(), step, changes, out);
            search_->begin_epoch();
            if (had_ground && ground_left_ == 0) {
                loose = look_at_all(grid, threads);
            } else if (!open.empty()) {
                loose = look_from(grid, open);
            }
        }
        while (!loose.empty()) {
            std::vector<voxel> const left_hanging = let_fall(grid, loose, step, changes, out);
            search_->begin_epoch();
            loose = left_hanging.empty() ? std::vector<std::uint32_t>{} : look_from(grid, left_hanging);
        }
        std::sort(changes.begin() + static_cast<std::ptrdiff_t>(first), changes.end(),
                  [](voxel_change const& a, voxel_change const& b) { return a.at < b.at; });
        std::sort(out.begin(), out.end(),
                  [](fallen_block const& a, fallen_block const& b) { return a.voxels[0] < b.voxels[0]; });
        return out;
    }

    template <executor Executor>
    std::vector<std::uint32_t> look_at_all(sparse_grid const& grid, Executor const& threads) {
        search_->begin_epoch();
        search_->label_all(grid, threads);
        std::vector<std::uint32_t> groups;
        for (std::size_t b = 0; b < grid.brick_count(); ++b) {
            std::size_t const n = search_->pieces(grid, b);
            for (std::size_t p = 0; p < n; ++p) {
                std::uint32_t const g =
                    search_->group_of(grid, {static_cast<std::uint32_t>(b), static_cast<std::uint16_t>(p)});
                groups.push_back(search_->settle(grid, g));
            }
        }
        return fallers(grid, std::move(groups));
    }

    std::vector<std::uint32_t> look_from(sparse_grid const& grid, std::vector<voxel> const& witnesses) {
        std::vector<std::uint32_t> groups;
        for (voxel const v : witnesses) groups.push_back(search_->group_of(grid, search_->node_of(grid, v)));
        if (ground_left_ != 0) {
            for (std::uint32_t& g : groups) g = search_->settle(grid, search_->root(g));
        } else {
            grow_all_but_one(grid, groups);
        }
        return fallers(grid, std::move(groups));
    }

    /// In turns, until one group at most is not whole: so the largest is never seen to its end.
    void grow_all_but_one(sparse_grid const& grid, std::vector<std::uint32_t>& groups) {
        for (;;) {
            for (std::uint32_t& g : groups) g = search_->root(g);
            std::sort(groups.begin(), groups.end());
            groups.erase(std::unique(groups.begin(), groups.end()), groups.end());
            auto const growing = std::count_if(groups.begin(), groups.end(),
                                               [&](std::uint32_t g) { return search_->at(g).is == state::growing; });
            if (growing == 0 || (growing == 1 && groups.size() == 1)) return;
            if (growing == 1) break;
            for (std::uint32_t const g : groups) {
                if (search_->root(g) == g && search_->at(g).is == state::growing) search_->grow(grid, g);
            }
        }
        // All rock but the whole groups hangs on the one that still grows.
        std::uint64_t rest = rock_left_;
        std::uint64_t most = 0;
        for (std::uint32_t const g : groups) {
            if (search_->at(g).is != state::whole) continue;
            rest -= search_->at(g).voxels;
            most = std::max(most, search_->at(g).voxels);
        }
        if (rest > most) return;
        for (std::uint32_t& g : groups) g = search_->settle(grid, g);
    }

    /// Of groups that were searched, those that stand no more, by number.
    std::vector<std::uint32_t> fallers(sparse_grid const& grid, std::vector<std::uint32_t> groups) {
        for (std::uint32_t& g : groups) g = search_->root(g);
        std::sort(groups.begin(), groups.end());
        groups.erase(std::unique(groups.begin(), groups.end()), groups.end());
        if (ground_left_ == 0) {
            if (groups.size() < 2) return {};
            auto largest = std::find_if(groups.begin(), groups.end(),
                                        [&](std::uint32_t g) { return search_->at(g).is == state::growing; });
            if (largest == groups.end()) largest = stays(grid, groups);
            groups.erase(largest);
            return groups;
        }
        std::erase_if(groups, [&](std::uint32_t g) { return search_->at(g).is == state::held; });
        if (friction() && !groups.empty()) {
            detail::rockfall_friction(options_.friction_angle).keep_standing(grid, *search_, groups);
        }
        return groups;
    }
    std::vector<std::uint32_t>::iterator stays(sparse_grid const& grid, std::vector<std::uint32_t>& groups) {
        auto best = groups.begin();
        std::optional<voxel> best_low;
        for (auto g = groups.begin() + 1; g != groups.end(); ++g) {
            std::uint64_t const a = search_->at(*g).voxels;
            std::uint64_t const b = search_->at(*best).voxels;
            if (a < b) continue;
            std::optional<voxel> low;
            if (a == b) {
                if (!best_low) best_low = lowest(grid, *best);
                low = lowest(grid, *g);
                if (*best_low < *low) continue;
            }
            best = g;
            best_low = low;
        }
        return best;
    }
    [[nodiscard]] voxel lowest(sparse_grid const& grid, std::uint32_t g) {
        std::optional<voxel> low;
        for (detail::rock_node const n : search_->at(g).nodes) {
            search_->for_voxels(grid, n, [&](voxel v) { low = low ? std::min(*low, v) : v; });
        }
        return *low;
    }

    /// Whole pieces of few voxels.
    void crumble(sparse_grid& grid, std::vector<voxel> const& crumbs, std::uint64_t step,
                 std::vector<voxel_change>& changes, std::vector<fallen_block>& out) {
        rock_left_ -= crumbs.size();
        for (voxel const v : crumbs) {
            changes.push_back({v, voxel_state::rock, voxel_state::air});
            grid.set(v, voxel_state::air);
            search_->touch(grid.brick_of(v));
        }
        std::vector<bool> seen(crumbs.size());
        for (std::size_t i = 0; i < crumbs.size(); ++i) {
            if (seen[i]) continue;
            seen[i] = true;
            fallen_block block{.step = step, .voxels = {crumbs[i]}};
            for (std::size_t at = 0; at < block.voxels.size(); ++at) {
                voxel const v = block.voxels[at];
                for (std::size_t side = 0; side < 6; ++side) {
                    voxel const d{side / 2 == 0 ? 1 : 0, side / 2 == 1 ? 1 : 0, side / 2 == 2 ? 1 : 0};
                    voxel const next = side % 2 == 0 ? v + d : v - d;
                    auto const w = std::lower_bound(crumbs.begin(), crumbs.end(), next);
                    auto const j = static_cast<std::size_t>(w - crumbs.begin());
                    if (w == crumbs.end() || *w != next || seen[j]) continue;
                    if (search_->cuts().is_cut(grid, side % 2 == 0 ? v : next, side / 2)) continue;
                    seen[j] = true;
                    block.voxels.push_back(*w);
                }
            }
            std::sort(block.voxels.begin(), block.voxels.end());
            out.push_back(std::move(block));
        }
    }

    /// \return  rock that lay on what fell.
    std::vector<voxel> let_fall(sparse_grid& grid, std::vector<std::uint32_t> const& loose, std::uint64_t step,
                                std::vector<voxel_change>& changes, std::vector<fallen_block>& out) {
        std::size_t const first = out.size();
        for (std::uint32_t const g : loose) {
            fallen_block block{.step = step};
            block.voxels.reserve(search_->at(g).voxels);
            for (detail::rock_node const n : search_->at(g).nodes) {
                search_->for_voxels(grid, n, [&](voxel v) { block.voxels.push_back(v); });
            }
            std::sort(block.voxels.begin(), block.voxels.end());
            out.push_back(std::move(block));
        }
        std::vector<voxel> above;
        bool const rests = friction() && !search_->cuts().empty();
        for (std::size_t i = first; i < out.size(); ++i) {
            rock_left_ -= out[i].voxels.size();
            for (voxel const v : out[i].voxels) {
                changes.push_back({v, voxel_state::rock, voxel_state::air});
                grid.set(v, voxel_state::air);
                search_->touch(grid.brick_of(v));
                if (rests && search_->cuts().is_cut(grid, v, 2)) above.push_back(v + voxel{0, 0, 1});
            }
        }
        std::erase_if(above, [&](voxel v) { return !grid.contains(v) || !grid.is_rock(v); });
        std::sort(above.begin(), above.end());
        above.erase(std::unique(above.begin(), above.end()), above.end());
        return above;
    }

    rockfall_options options_{};
    std::optional<detail::rockfall_search> search_{};
    detail::rockfall_removals removals_{};
    std::array<std::size_t, 3> size_{};
    std::size_t ground_left_ = 0;   ///< rock voxels that are ground
    std::uint64_t rock_left_ = 0;
};

}  // namespace tafoni

#endif
