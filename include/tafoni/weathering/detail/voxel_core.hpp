/// \file
/// The state of a voxel run, and one step of it.
#ifndef TAFONI_WEATHERING_DETAIL_VOXEL_CORE_HPP
#define TAFONI_WEATHERING_DETAIL_VOXEL_CORE_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/voxel/colluvium.hpp>
#include <tafoni/voxel/rockfall.hpp>
#include <tafoni/weathering/detail/ask_policies.hpp>
#include <tafoni/weathering/detail/grid_hash.hpp>
#include <tafoni/weathering/detail/lap_clock.hpp>
#include <tafoni/weathering/detail/sort_changes.hpp>
#include <tafoni/weathering/detail/voxel_rates.hpp>
#include <tafoni/weathering/detail/voxel_skins.hpp>
#include <tafoni/weathering/voxel_options.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <queue>
#include <span>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// What a step changes before its last lines, which cannot throw, is undone when anything throws: the state is
/// then that after the last complete step (with events: after the last complete event).
template <class Process>
class voxel_core {
public:
    template <executor Executor>
    voxel_core(sparse_grid&& rock, Process&& policies, voxel_options const& chosen, Executor const& threads)
        : grid(std::move(rock)), process(std::move(policies)), options(chosen) {
        count.voxels_rock = grid.count(voxel_plane::rock);
        count.voxels_colluvium = grid.count(voxel_plane::colluvium);
        count.voxels_initial = count.voxels_rock + count.voxels_colluvium;
        skins.reset(grid.brick_count());
        rates.read(process, options);
        start_rockfall();
        rescan(threads);
        first_grid = grid_hash(grid);
    }

    sparse_grid grid;
    Process process;
    voxel_options options;
    voxel_report count{};
    std::vector<fallen_block> blocks{};
    voxel_rates rates{};
    voxel_skins skins{};
    std::uint64_t first_grid = 0;  ///< hash of the input
    double time = 0;  ///< within a step that was left after an event by a throw; else 0

    /// Asks for bubble and durability again, and counts. Decimation stays. Strong guarantee. O(bricks + skin bubbles).
    template <executor Executor>
    void rescan(Executor const& threads) {
        spare_.reset();  // it is brought up to date by the bricks touched last, which other bricks are from here on
        skins.touch_all(grid);
        skins.rebuild(grid, stencils(), options.skin_depth, asker(), voxel_skins::basis::replaced, threads);
        skins.commit();
        count.surface_voxels = skins.voxel_count();
    }
    /// The skin of another grid under the same process. O(bricks + skin bubbles).
    [[nodiscard]] voxel_skins skin_of(sparse_grid const& other) const {
        voxel_skins out;
        out.reset(other.brick_count());
        out.touch_all(other);
        out.rebuild(other, stencils(), options.skin_depth, asker(), voxel_skins::basis::replaced, inline_executor{});
        out.commit();
        return out;
    }
    /// Nothing here throws.
    void resume(sparse_grid&& now, voxel_skins&& skin, std::vector<fallen_block>&& fallen, voxel_report const& totals,
                double within) noexcept {
        grid = std::move(now);
        skins = std::move(skin);
        for (std::size_t s = 0; s < skins.size(); ++s) skins[s].clock = within;
        blocks = std::move(fallen);
        count = totals;
        time = within;
        spare_.reset();
        start_rockfall();
    }
    /// Rockfall looks at the whole grid in the next step.
    void start_rockfall() noexcept {
        falls_.reset();
        first_fall_ = true;
    }

    /// All that is used up within the step falls at its end.
    template <executor Executor>
    void step(Executor const& threads) {
        if (time > 0) return step_by_events(threads);
        lap_clock clock;
        fallers_.resize(skins.size());
        threads.for_blocks(skins.size(), 4, [&](std::size_t begin, std::size_t end) {
            for (std::size_t s = begin; s < end; ++s) {
                advance(skins[s], 1);
                list_fallers(s);
            }
        });
        take_fallers(threads);
        change(threads, clock, [] {});
        skins.turn();
        finish(clock);
        ++count.steps;
        compact();
    }

    /// What is used up falls at its time, all of the same instant at once, and the others go on at their new rates.
    template <executor Executor>
    void step_by_events(Executor const& threads) {
        fall_queue queue;
        for (std::size_t s = 0; s < skins.size(); ++s) enqueue(queue, s);
        try {
            while (!queue.empty() && queue.top().at <= 1) {
                lap_clock clock;
                double const at = queue.top().at;
                fallers_.assign(skins.size(), {});
                for (; !queue.empty() && queue.top().at == at; queue.pop()) {
                    fall_time const& f = queue.top();
                    if (f.born != born_[f.slot]) continue;
                    voxel_skin const& skin = skins[f.slot];
                    for (std::size_t i = 0; i < skin.size(); ++i) {
                        if (falls_at(skin, i) == at) fallers_[f.slot].push_back(skin.position[i]);
                    }
                }
                take_fallers(threads);
                if (changes_.empty()) continue;
                change(threads, clock, [&] {
                    for (std::uint32_t const s : skins.touched()) advance(skins[s], at);
                });
                for (std::uint32_t const s : skins.touched()) skins[s].now ^= 1u;
                finish(clock);
                for (std::uint32_t const s : skins.touched()) skins[s].clock = at;
                time = at;
                for (std::uint32_t const s : skins.touched()) enqueue(queue, s);
            }
        } catch (...) {
            advance_all(time);
            throw;
        }
        advance_all(1);
        for (std::size_t s = 0; s < skins.size(); ++s) skins[s].clock = 0;
        time = 0;
        ++count.steps;
        compact();
    }

    [[nodiscard]] std::span<bubble_stencil const> stencils() const { return process.bubbles.stencils(); }

    /// What the policies say of a place: the bubble and the durability.
    [[nodiscard]] std::pair<std::uint16_t, double> ask(vec3 const& at) const { return ask_policies(process, at); }
    /// What is left of a voxel that is not skin, per cent.
    [[nodiscard]] double covered_left(voxel v) const noexcept {
        if (!grid.contains(v) || skins.slot_of(grid.brick_of(v)) == voxel_skins::none) return 100;
        voxel_skin const& skin = skins[skins.slot_of(grid.brick_of(v))];
        auto const it = std::lower_bound(skin.covered.begin(), skin.covered.end(), position_of(v));
        if (it == skin.covered.end() || *it != position_of(v)) return 100;
        return skin.covered_left[static_cast<std::size_t>(it - skin.covered.begin())];
    }

    voxel_report::stage_seconds taken{};

private:
    struct fall_time {
        double at = 0;
        std::uint32_t slot = 0;
        std::uint64_t born = 0;  ///< which state of the brick it was told by

        friend bool operator<(fall_time const& a, fall_time const& b) noexcept {
            return a.at != b.at ? a.at > b.at : a.slot > b.slot;
        }
    };
    using fall_queue = std::priority_queue<fall_time>;

    [[nodiscard]] double rate(voxel_skin const& skin, std::size_t i) const noexcept {
        return rates.at(skin.bubble[i], skin.air[i]) / skin.durability[i];
    }
    [[nodiscard]] double falls_at(voxel_skin const& skin, std::size_t i) const noexcept {
        double const r = rate(skin, i);
        double const left = skin.left[skin.now][i];
        if (left <= 0) return skin.clock;
        return r > 0 ? skin.clock + left / r : std::numeric_limits<double>::infinity();
    }
    void enqueue(fall_queue& queue, std::size_t s) {
        voxel_skin const& skin = skins[s];
        double first = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < skin.size(); ++i) first = std::min(first, falls_at(skin, i));
        if (born_.size() <= s) born_.resize(skins.size(), 0);
        ++born_[s];
        if (first <= 1) queue.push({first, static_cast<std::uint32_t>(s), born_[s]});
    }

    /// Writes the other decimation: what is left at that time.
    void advance(voxel_skin& skin, double to) const noexcept {
        double const span = to - skin.clock;
        std::vector<double> const& before = skin.left[skin.now];
        std::vector<double>& after = skin.left[skin.now ^ 1u];
        for (std::size_t i = 0; i < skin.size(); ++i) after[i] = before[i] - rate(skin, i) * span;
    }
    void advance_all(double to) noexcept {
        for (std::size_t s = 0; s < skins.size(); ++s) {
            advance(skins[s], to);
            skins[s].now ^= 1u;
            skins[s].clock = to;
        }
    }
    void list_fallers(std::size_t s) {
        fallers_[s].clear();
        voxel_skin const& skin = skins[s];
        std::vector<double> const& left = skin.left[skin.now ^ 1u];
        for (std::size_t i = 0; i < skin.size(); ++i) {
            if (left[i] <= 0) fallers_[s].push_back(skin.position[i]);
        }
    }
    /// Lists the fallers as changes; in voxel order where rockfall or settling ask for it.
    template <executor Executor>
    void take_fallers(Executor const& threads) {
        first_of_.resize(fallers_.size() + 1);
        std::size_t n = 0;
        for (std::size_t s = 0; s < fallers_.size(); ++s) {
            first_of_[s] = n;
            n += fallers_[s].size();
            if (!fallers_[s].empty()) grid.make_mixed(skins.brick(s));
        }
        changes_.resize(n);
        if (n == 0) return;
        threads.for_blocks(fallers_.size(), 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t s = begin; s < end; ++s) {
                voxel const corner = grid.brick_corner(skins.brick(s));
                voxel_change* to = changes_.data() + first_of_[s];
                for (brick_position const p : fallers_[s]) {
                    bool const loose = (grid.colluvium_word(skins.brick(s), p >> 5) >> (p & 31) & 1) != 0;
                    *to++ = {at_position(corner, p), loose ? voxel_state::colluvium : voxel_state::rock, voxel_state::air};
                }
            }
        });
        if (options.colluvium || options.rockfall) sort_changes(changes_, merged_, grid.size()[2], threads);
    }
    /// Takes the fallers out of the grid.
    template <executor Executor>
    void remove_fallers(Executor const& threads) {
        threads.for_blocks(fallers_.size(), 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t s = begin; s < end; ++s) {
                if (fallers_[s].empty()) continue;
                sparse_grid::brick& brick = grid.make_mixed(skins.brick(s));  // stored already
                for (brick_position const p : fallers_[s]) {
                    std::uint32_t const others = ~(std::uint32_t{1} << (p & 31));
                    brick.solid[p >> 5] &= others;
                    brick.colluvium[p >> 5] &= others;
                }
            }
        });
    }

    /// Removes what is in `changes_`, lets rock fall and grains settle, and makes the skin anew aside.
    template <executor Executor, class Prepare>
    void change(Executor const& threads, lap_clock& clock, Prepare const& prepare) {
        next_ = count;
        fallen_.clear();
        keep_spare(threads);
        try {
            remove_fallers(threads);
            for (voxel_change const& c : changes_) {
                if (!options.colluvium || c.before == voxel_state::colluvium) ++next_.voxels_vanished;
            }
            clock.into(taken.weather);
            if (options.colluvium) {
                released_.clear();
                for (voxel_change const& c : changes_) {
                    if (c.before == voxel_state::rock) released_.push_back(c.at);
                }
            }
            let_rock_fall(threads);
            clock.into(taken.rockfall);
            let_grains_settle(threads);
            clock.into(taken.settle);
            for (voxel_change const& c : changes_) {
                if (c.before == voxel_state::rock) --next_.voxels_rock;
                if (c.before == voxel_state::colluvium) --next_.voxels_colluvium;
                if (c.after == voxel_state::rock) ++next_.voxels_rock;
                if (c.after == voxel_state::colluvium) ++next_.voxels_colluvium;
            }
            blocks.reserve(blocks.size() + fallen_.size());
            int reach = options.skin_depth;
            for (bubble_stencil const& s : stencils()) reach = std::max(reach, s.reach());
            skins.touch_changed(grid, changes_, options.skin_depth, reach);
            prepare();
            skins.rebuild(grid, stencils(), options.skin_depth, asker(), voxel_skins::basis::next, threads);
        } catch (...) {
            undo();
            throw;
        }
    }
    template <executor Executor>
    void let_rock_fall(Executor const& threads) {
        if (!options.rockfall || (!first_fall_ && changes_.empty())) return;
        removed_.clear();
        for (voxel_change const& c : changes_) {
            if (c.before == voxel_state::rock) removed_.push_back(c.at);
        }
        std::size_t const before = changes_.size();
        if (!falls_) falls_.emplace(*options.rockfall);
        fallen_ = falls_->fall(grid, removed_, count.steps + 1, threads, changes_);
        for (fallen_block const& b : fallen_) next_.voxels_fallen += b.voxels.size();
        next_.blocks += fallen_.size();
        first_fall_ = false;
        merge_changes(changes_, before, merged_);
    }
    template <executor Executor>
    void let_grains_settle(Executor const& threads) {
        if (!options.colluvium || changes_.empty()) return;
        removed_.clear();
        for (voxel_change const& c : changes_) removed_.push_back(c.at);
        settle_report const settled =
            settle(grid, released_, removed_, *options.colluvium, options.seed, count.steps, threads, changes_);
        next_.voxels_left += settled.left;
        merge_changes(changes_, removed_.size(), merged_);
    }
    /// Makes the spare grid equal to the grid, before anything else happens to that.
    template <executor Executor>
    void keep_spare(Executor const& threads) {
        if (!options.colluvium && !options.rockfall) {
            spare_.reset();
        } else if (!spare_) {
            spare_.emplace(grid);
        } else if (stale_) {
            for (std::uint32_t const s : skins.touched()) spare_->make_mixed(skins.brick(s));
            threads.for_blocks(skins.touched().size(), 16, [&](std::size_t begin, std::size_t end) {
                for (std::size_t k = begin; k < end; ++k) {
                    std::size_t const b = skins.brick(skins.touched()[k]);
                    sparse_grid::brick& to = spare_->make_mixed(b);
                    if (auto const* from = grid.stored(b)) {
                        to = *from;
                        continue;
                    }
                    for (std::size_t c = 0; c < 1024; ++c) to.solid[c] = grid.solid_word(b, c);
                    to.colluvium.fill(0);
                }
            });
            for (std::uint32_t const s : skins.touched()) spare_->compact(skins.brick(s));
        }
        stale_ = false;
    }
    void undo() noexcept {
        if (!spare_) {
            for (voxel_change const& c : changes_) grid.set(c.at, c.before);
            return;
        }
        std::swap(grid, *spare_);
        spare_.reset();
        start_rockfall();
    }
    /// What `change` has made holds from now on. Nothing here throws.
    void finish(lap_clock& clock) noexcept {
        for (fallen_block& b : fallen_) blocks.push_back(std::move(b));
        count = next_;
        count.surface_voxels += static_cast<std::uint64_t>(skins.commit());
        stale_ = true;
        clock.into(taken.notify);
    }
    void compact() {
        for (std::uint32_t const s : skins.touched()) grid.compact(skins.brick(s));
    }

    [[nodiscard]] auto asker() const {
        return [this](vec3 const& at) { return ask(at); };
    }

    std::optional<rockfall> falls_{};
    bool first_fall_ = true;
    std::optional<sparse_grid> spare_{};  ///< the grid after the last step, where more than removal may throw
    bool stale_ = false;                  ///< it lacks what happened to the bricks touched last
    std::vector<std::vector<brick_position>> fallers_{};  ///< by slot
    std::vector<std::size_t> first_of_{};                 ///< by slot: among the changes
    std::vector<voxel_change> changes_{};
    std::vector<voxel_change> merged_{};
    std::vector<voxel> released_{};
    std::vector<voxel> removed_{};
    std::vector<fallen_block> fallen_{};
    std::vector<std::uint64_t> born_{};  ///< by slot
    voxel_report next_{};
};

}  // namespace tafoni::detail

#endif
