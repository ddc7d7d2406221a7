/// \file
/// The state of a voxel run, and one step of it.
#ifndef TAFONI_WEATHERING_DETAIL_VOXEL_CORE_HPP
#define TAFONI_WEATHERING_DETAIL_VOXEL_CORE_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/voxel/colluvium.hpp>
#include <tafoni/voxel/rockfall.hpp>
#include <tafoni/weathering/detail/voxel_count.hpp>
#include <tafoni/weathering/detail/voxel_rates.hpp>
#include <tafoni/weathering/detail/voxel_skin.hpp>
#include <tafoni/weathering/voxel_options.hpp>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// Nothing that `step` writes before its last lines, which cannot throw, belongs to the state: a throw leaves
/// the state after the last complete step.
template <class Process>
class voxel_core {
public:
    using seconds = voxel_report::stage_seconds;

    template <executor Executor>
    voxel_core(sparse_grid&& rock, Process&& policies, voxel_options const& chosen, Executor const& threads)
        : grid(std::move(rock)), process(std::move(policies)), options(chosen) {
        count.voxels_rock = grid.count(voxel_plane::rock);
        count.voxels_colluvium = grid.count(voxel_plane::colluvium);
        count.voxels_initial = count.voxels_rock + count.voxels_colluvium;
        slot_of_.assign(grid.brick_count(), none);
        stamp_.assign(grid.brick_count(), 0);
        read_bubbles();
        rates.read(process, options.measure);
        start_rockfall();
        rescan(threads);
    }

    sparse_grid grid;
    Process process;
    voxel_options options;
    voxel_report count{};
    std::vector<fallen_block> blocks{};
    voxel_rates rates{};
    std::vector<std::size_t> bricks{};  ///< of the skins
    std::vector<voxel_skin> skins{};
    unsigned now = 0;  ///< which of the two decimations holds

    [[nodiscard]] voxel_skin const* skin_of(std::size_t brick) const noexcept {
        return slot_of_[brick] == none ? nullptr : &skins[slot_of_[brick]];
    }

    /// Finds the skin anew; decimation of what was known stays. O(bricks + skin bubbles).
    template <executor Executor>
    void rescan(Executor const& threads) {
        ++stamp_now_;
        touched_.clear();
        for (std::size_t b = 0; b < grid.brick_count(); ++b) {
            bool const known = slot_of_[b] != none;
            if (known || (!grid.is_air_brick(b) && !buried(b))) touch(b);
        }
        copy_left_ = true;
        rebuild(threads);
        commit();
        copy_left_ = false;
    }

    /// One step with the rates as they are.
    template <executor Executor>
    void step(Executor const& threads) {
        auto const t0 = std::chrono::steady_clock::now();
        decay(1.0, threads);
        fall_and_rebuild(threads, t0);
        ++count.steps;
    }

    void read_bubbles() {
        auto const stencils = process.bubbles.stencils();
        if (stencils.empty()) {
            fail<invalid_input>(errc::empty_input, "voxel_weathering.bubbles: stencils() is empty, need at least 1");
        }
        reach_ = options.skin_depth;
        for (bubble_stencil const& s : stencils) reach_ = std::max(reach_, s.reach());
    }
    void start_rockfall() {
        falls_.reset();
        if (options.rockfall) falls_.emplace(*options.rockfall);
        first_fall_ = true;
    }

private:
    static constexpr std::uint32_t none = 0xFFFFFFFF;

    /// Rock all around and inside.
    [[nodiscard]] bool buried(std::size_t b) const noexcept {
        if (!grid.is_rock_brick(b)) return false;
        voxel const low = grid.brick_corner(b);
        std::array<voxel, 6> const beside{{{-1, 0, 0}, {32, 0, 0}, {0, -1, 0}, {0, 32, 0}, {0, 0, -1}, {0, 0, 32}}};
        return std::all_of(beside.begin(), beside.end(), [&](voxel d) {
            voxel const v = low + d;
            return grid.contains(v) && grid.is_rock_brick(grid.brick_of(v));
        });
    }

    void touch(std::size_t b) {
        if (stamp_[b] == stamp_now_) return;
        stamp_[b] = stamp_now_;
        if (slot_of_[b] == none) {
            bricks.push_back(b);
            skins.emplace_back();
            slot_of_[b] = static_cast<std::uint32_t>(skins.size() - 1);
        }
        touched_.push_back(slot_of_[b]);
    }

    /// Fills the other decimation and lists the voxels that fall.
    template <executor Executor>
    void decay(double time, Executor const& threads) {
        fallers_.resize(skins.size());
        unsigned const next = now ^ 1u;
        threads.for_blocks(skins.size(), 4, [&](std::size_t begin, std::size_t end) {
            for (std::size_t s = begin; s < end; ++s) {
                voxel_skin& skin = skins[s];
                std::vector<std::uint16_t>& fallen = fallers_[s];
                fallen.clear();
                for (std::size_t i = 0; i < skin.size(); ++i) {
                    double const rate = rates.at(skin.bubble[i], skin.air[i]) / skin.durability[i];
                    double const left = skin.left[now][i] - rate * time;
                    skin.left[next][i] = left;
                    if (left <= 0) fallen.push_back(skin.place[i]);
                }
            }
        });
    }

    template <executor Executor>
    void fall_and_rebuild(Executor const& threads, std::chrono::steady_clock::time_point t0) {
        seconds took{};
        auto const lap = [&t0](double& into) {
            auto const t1 = std::chrono::steady_clock::now();
            into += std::chrono::duration<double>(t1 - t0).count();
            t0 = t1;
        };
        voxel_report next = count;
        changes_.clear();
        for (std::size_t s = 0; s < fallers_.size(); ++s) {
            if (fallers_[s].empty()) continue;
            voxel const corner = grid.brick_corner(bricks[s]);
            grid.make_mixed(bricks[s]);
            for (std::uint16_t const p : fallers_[s]) {
                voxel const v = voxel_at_place(corner, p);
                changes_.push_back({v, grid.state(v), voxel_state::air});
            }
        }
        std::sort(changes_.begin(), changes_.end(), by_place);
        std::vector<fallen_block> fallen;
        if ((options.colluvium || options.rockfall) && !spare_) spare_.emplace(grid);
        try {
            for (voxel_change const& c : changes_) grid.set(c.at, c.after);
            for (voxel_change const& c : changes_) {
                if (!options.colluvium || c.before == voxel_state::colluvium) ++next.voxels_vanished;
            }
            lap(took.weather);
            if (options.rockfall && (first_fall_ || !changes_.empty())) {
                std::vector<voxel> removed;
                for (voxel_change const& c : changes_) {
                    if (c.before == voxel_state::rock) removed.push_back(c.at);
                }
                fallen = falls_->fall(grid, removed, count.steps + 1, threads, changes_);
                for (fallen_block const& b : fallen) next.voxels_fallen += b.voxels.size();
                next.blocks += fallen.size();
                first_fall_ = false;
            }
            lap(took.rockfall);
            net_changes();
            if (options.colluvium && !changes_.empty()) {
                std::vector<voxel> released;
                std::vector<voxel> opened;
                // What was rock and did not fall with a block becomes a grain.
                for (std::size_t s = 0; s < fallers_.size(); ++s) {
                    voxel const corner = grid.brick_corner(bricks[s]);
                    for (std::uint16_t const p : fallers_[s]) released.push_back(voxel_at_place(corner, p));
                }
                std::sort(released.begin(), released.end());
                std::erase_if(released, [&](voxel v) {
                    return std::lower_bound(changes_.begin(), changes_.end(), voxel_change{v, {}, {}}, by_place)
                               ->before != voxel_state::rock;
                });
                for (voxel_change const& c : changes_) opened.push_back(c.at);
                settle_report const settled = settle(grid, released, opened, *options.colluvium, options.seed,
                                                     count.steps, threads, changes_);
                next.voxels_left += settled.left;
                net_changes();
            }
            lap(took.settle);
            for (voxel_change const& c : changes_) {
                if (c.before == voxel_state::rock) --next.voxels_rock;
                if (c.before == voxel_state::colluvium) --next.voxels_colluvium;
                if (c.after == voxel_state::rock) ++next.voxels_rock;
                if (c.after == voxel_state::colluvium) ++next.voxels_colluvium;
            }
            blocks.reserve(blocks.size() + fallen.size());
            touch_changed();
            rebuild(threads);
            if (spare_) {
                for (voxel_change const& c : changes_) spare_->make_mixed(spare_->brick_of(c.at));
            }
        } catch (...) {
            undo();
            throw;
        }
        for (fallen_block& b : fallen) blocks.push_back(std::move(b));
        count = next;
        commit();
        if (spare_) {
            for (voxel_change const& c : changes_) spare_->set(c.at, c.after);
        }
        lap(took.notify);
        taken.weather += took.weather;
        taken.rockfall += took.rockfall;
        taken.settle += took.settle;
        taken.notify += took.notify;
        for (std::uint32_t const s : touched_) grid.compact(bricks[s]);
    }

    /// One entry for every voxel that anything happened to, in voxel order: first before, last after.
    void net_changes() {
        std::stable_sort(changes_.begin(), changes_.end(), by_place);
        std::size_t kept = 0;
        for (std::size_t i = 0; i < changes_.size(); ++i) {
            if (kept > 0 && changes_[kept - 1].at == changes_[i].at) {
                changes_[kept - 1].after = changes_[i].after;
            } else {
                changes_[kept++] = changes_[i];
            }
        }
        changes_.resize(kept);
    }

    void undo() noexcept {
        if (spare_) {
            std::swap(grid, *spare_);
            spare_.reset();
            if (options.rockfall) {
                falls_.reset();
                first_fall_ = true;
            }
        } else {
            for (voxel_change const& c : changes_) grid.set(c.at, c.before);
        }
    }

    /// Bricks whose skin or counts may differ by the changes.
    void touch_changed() {
        ++stamp_now_;
        touched_.clear();
        for (voxel_change const& c : changes_) {
            for_each_brick_within(c.at, options.skin_depth, [&](std::size_t b) { touch(b); });
            for_each_brick_within(c.at, reach_, [&](std::size_t b) {
                if (slot_of_[b] != none) touch(b);
            });
        }
        changed_.resize(std::max(changed_.size(), touched_.size()));
        index_.resize(skins.size());
        for (std::size_t k = 0; k < touched_.size(); ++k) {
            index_[touched_[k]] = static_cast<std::uint32_t>(k);
            changed_[k].clear();
        }
        for (voxel_change const& c : changes_) {
            changed_[index_[slot_of_[grid.brick_of(c.at)]]].push_back(place_in_brick(c.at));
        }
    }

    template <class F>
    void for_each_brick_within(voxel v, std::int32_t r, F const& f) const {
        auto const& n = grid.bricks();
        auto const low = [](std::int32_t x) { return std::max(x >> 5, 0); };
        for (std::int32_t z = low(v.z - r); z <= std::min((v.z + r) >> 5, n[2] - 1); ++z) {
            for (std::int32_t y = low(v.y - r); y <= std::min((v.y + r) >> 5, n[1] - 1); ++y) {
                for (std::int32_t x = low(v.x - r); x <= std::min((v.x + r) >> 5, n[0] - 1); ++x) {
                    f(grid.brick_of({x * 32, y * 32, z * 32}));
                }
            }
        }
    }

    template <executor Executor>
    void rebuild(Executor const& threads) {
        if (fresh_.size() < touched_.size()) fresh_.resize(touched_.size());
        if (changed_.size() < touched_.size()) changed_.resize(touched_.size());
        threads.for_blocks(touched_.size(), 1, [&](std::size_t begin, std::size_t end) {
            brick_window window;
            for (std::size_t k = begin; k < end; ++k) rebuild_brick(k, window);
        });
    }

    void rebuild_brick(std::size_t k, brick_window& window) {
        std::size_t const brick = bricks[touched_[k]];
        voxel_skin const& old = skins[touched_[k]];
        voxel_skin& fresh = fresh_[k];
        fresh.clear();
        unsigned const next = now ^ 1u;
        unsigned const from = copy_left_ ? now : next;
        skin_words skin;
        find_skin(grid, brick, options.skin_depth, window, skin);
        skin_words changed{};
        if (!copy_left_) {
            for (std::uint16_t const p : changed_[k]) changed[p >> 5] |= std::uint32_t{1} << (p & 31);
        }
        auto const cover = [&](std::uint16_t p, double left) {
            if ((changed[p >> 5] >> (p & 31) & 1) != 0 || !(left < 100)) return;
            fresh.covered.push_back(p);
            fresh.covered_left.push_back(left);
        };
        voxel const corner = grid.brick_corner(brick);
        std::size_t i = 0;
        std::size_t j = 0;
        for (std::size_t c = 0; c < 1024; ++c) {
            std::uint32_t bits = skin[c];
            auto const end = static_cast<std::uint32_t>(32 * c + 32);
            for (;;) {
                std::uint32_t const p = bits != 0 ? static_cast<std::uint32_t>(32 * c) +
                                                        static_cast<std::uint32_t>(std::countr_zero(bits))
                                                  : end;
                for (;;) {  // known before, not skin now
                    bool const a = i < old.size() && old.place[i] < p;
                    bool const b = j < old.covered.size() && old.covered[j] < p;
                    if (!a && !b) break;
                    if (a && (!b || old.place[i] < old.covered[j])) {
                        cover(old.place[i], old.left[from][i]);
                        ++i;
                    } else {
                        cover(old.covered[j], old.covered_left[j]);
                        ++j;
                    }
                }
                if (bits == 0) break;
                bits &= bits - 1;
                auto const place = static_cast<std::uint16_t>(p);
                bool const same = (changed[c] >> (p & 31) & 1) == 0;
                bool const known = i < old.size() && old.place[i] == p;
                bool const was_covered = j < old.covered.size() && old.covered[j] == p;
                fresh.place.push_back(place);
                double left = 100;
                if (known && same) {
                    left = old.left[from][i];
                } else if (was_covered && same) {
                    left = old.covered_left[j];
                }
                fresh.left[next].push_back(left);
                if (known && !copy_left_) {
                    fresh.bubble.push_back(old.bubble[i]);
                    fresh.durability.push_back(old.durability[i]);
                } else {
                    vec3 const at = grid.centre(voxel_at_place(corner, place));
                    fresh.bubble.push_back(choose_bubble(at));
                    fresh.durability.push_back(durability_at(at));
                }
                if (known) ++i;
                if (was_covered) ++j;
            }
        }
        fresh.left[now].resize(fresh.size());
        fresh.air.resize(fresh.size());
        count_skin(grid, brick, process.bubbles.stencils(), window, fresh);
    }

    /// Exchanges what was rebuilt, and the decimations. Nothing here throws.
    void commit() noexcept {
        std::uint64_t surface = count.surface_voxels;
        for (std::size_t k = 0; k < touched_.size(); ++k) {
            voxel_skin& skin = skins[touched_[k]];
            surface += fresh_[k].size();
            surface -= skin.size();
            std::swap(skin, fresh_[k]);
        }
        count.surface_voxels = surface;
        now ^= 1u;
    }

    static bool by_place(voxel_change const& a, voxel_change const& b) noexcept { return a.at < b.at; }

    [[nodiscard]] std::uint16_t choose_bubble(vec3 const& at) const {
        std::size_t const n = process.bubbles.stencils().size();
        std::size_t const chosen = process.bubbles.choose(at);
        if (chosen >= n) {
            fail<invalid_input>(errc::index_out_of_range,
                                "voxel_weathering.bubbles: choose() answered " + std::to_string(chosen) + " of " +
                                    std::to_string(n) + " stencils",
                                {.kind = entity::parameter, .value = static_cast<double>(chosen),
                                 .limit = static_cast<double>(n)});
        }
        return static_cast<std::uint16_t>(chosen);
    }
    [[nodiscard]] double durability_at(vec3 const& at) const {
        double const d = process.durability(at);
        if (!(d >= -1e300 && d <= 1e300)) {
            fail<invalid_input>(errc::bad_parameter,
                                "voxel_weathering.durability: got " + number_text(d) + " at (" + number_text(at[0]) +
                                    ", " + number_text(at[1]) + ", " + number_text(at[2]) + "), need a finite number",
                                {.kind = entity::parameter, .value = d});
        }
        return std::max(d, Process::least_durability);
    }

public:
    seconds taken{};

private:
    std::vector<std::uint32_t> slot_of_{};  ///< by brick
    std::vector<std::uint32_t> stamp_{};
    std::uint32_t stamp_now_ = 0;
    int reach_ = 0;
    std::optional<rockfall> falls_{};
    bool first_fall_ = true;
    bool copy_left_ = false;
    std::optional<sparse_grid> spare_{};  ///< the grid after the last step, where more than removal may throw
    std::vector<std::vector<std::uint16_t>> fallers_{};  ///< by skin
    std::vector<voxel_change> changes_{};
    std::vector<std::uint32_t> touched_{};  ///< skins to be rebuilt
    std::vector<std::uint32_t> index_{};
    std::vector<std::vector<std::uint16_t>> changed_{};
    std::vector<voxel_skin> fresh_{};
};

}  // namespace tafoni::detail

#endif
