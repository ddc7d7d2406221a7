/// \file
/// The steps of a frost run: walk, apply, settle; and the way back when a step throws.
#ifndef TAFONI_WEATHERING_DETAIL_FROST_CORE_HPP
#define TAFONI_WEATHERING_DETAIL_FROST_CORE_HPP

#include <tafoni/percolation/entry_tree.hpp>
#include <tafoni/percolation/link_table.hpp>
#include <tafoni/percolation/percolate.hpp>
#include <tafoni/weathering/detail/air_flood.hpp>
#include <tafoni/weathering/detail/bond_parts.hpp>
#include <tafoni/weathering/detail/frost_state.hpp>
#include <tafoni/weathering/frost_wedging.hpp>

#include <algorithm>
#include <chrono>
#include <span>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// The infiltration that comes with a rain, else the paper's.
template <class Rain>
[[nodiscard]] auto const& infiltration_of(Rain const& rain) noexcept {
    if constexpr (infiltration_policy<Rain>) {
        return rain;
    } else {
        static constexpr facing_infiltration facing{};
        return facing;
    }
}

/// The soaking that comes with an absorption, else the paper's.
template <class Absorb>
[[nodiscard]] auto const& soaking_of(Absorb const& absorb) noexcept {
    if constexpr (soaking_rule<Absorb>) {
        return absorb;
    } else {
        static constexpr depletion_soaking depletion{};
        return depletion;
    }
}

/// State and derived structures of `frost_run`, whose members document them.
template <class Network, class Process>
class frost_core {
public:
    frost_core(Network const& network, Process p, frost_options const& o)
        : table(network), process(std::move(p)), options(o), state(network) {
        areas_ = pairwise_sum(0, table.size(), [&](std::size_t i) { return table[link_index{i}].area; });
        install(resistances(process));
        rescale(options);
        rebuild();
    }

    link_table<Network> table;
    Process process;
    frost_options options;
    link_scale scale{};
    frost_state state;
    entry_tree skin{};
    air_flood<Network> flood{};
    bond_parts<Network> parts{};
    double detach_seconds = 0;
    bool dirty = false;  ///< derived structures do not follow the state; `rebuild` mends it

    /// rho of every link, checked.
    [[nodiscard]] std::vector<double> resistances(Process const& p) const {
        std::vector<double> rho(table.size(), constant_field{}.value);
        if constexpr (requires(vec3 const& x) { p.flow.resistance_at(x); }) {
            for (std::size_t i = 0; i < rho.size(); ++i) {
                link_record const& r = table[link_index{i}];
                if (!(r.area > 0)) continue;
                rho[i] = p.flow.resistance_at(vec3{r.x, r.y, r.z});
                if (!(rho[i] >= 0 && rho[i] <= 1)) {
                    fail<invalid_input>(errc::out_of_range,
                                        "frost_run: resistance " + std::to_string(rho[i]) + " at link " +
                                            std::to_string(i) + ", allowed [0, 1]",
                                        {.kind = entity::link, .index = i, .value = rho[i], .limit = 1});
                }
            }
        }
        return rho;
    }
    void install(std::vector<double> const& rho) noexcept {
        for (std::size_t i = 0; i < rho.size(); ++i) table[link_index{i}].resistance = rho[i];
        skin.invalidate();
    }
    void rescale(frost_options const& o) { scale.mean_area = table.mean_area(o.mean == area_mean::all); }

    /// References to the parts of the process; what it does not say is the paper's default.
    [[nodiscard]] auto policies() const noexcept {
        return path_policies{process.rain, infiltration_of(process.rain), process.flow, process.absorb,
                             soaking_of(process.absorb)};
    }
    [[nodiscard]] path_options numbers() const noexcept {
        return {.seed = options.seed,
                .inflow = water_unit::from(options.water),
                .scale = scale,
                .longest_path = options.longest_path};
    }

    /// Derives link states, entries, parts and exposure from lives and cells. O(links + cells).
    void rebuild() {
        dirty = true;
        scratch_.clear();
        flood.rebuild(table.network(), state.cells);
        entry_tree fresh(table.size());
        skin = std::move(fresh);
        for (std::size_t i = 0; i < table.size(); ++i) {
            if (table.network().has_link(link_index{i})) refresh(link_index{i});
        }
        parts.rebuild(table, state.cells, state.volumes);
        dirty = false;
    }

    /// Walks `n` paths over the frozen state, then applies them. All or nothing.
    template <class Executor>
    void step(std::size_t n, Executor const& threads) {
        if (options.water <= 0 || water_unit::from(options.water) == 0) {
            state.count.paths += n;
            return;
        }
        std::size_t const grain = n <= 16 ? n : std::max<std::size_t>(16, (n + 63) / 64);
        std::size_t const groups = (n + grain - 1) / grain;
        if (scratch_.size() < groups) scratch_.resize(groups);
        if (traces_.size() < n) traces_.resize(n);
        auto const policy = policies();
        auto const number = numbers();
        std::uint64_t const first = state.count.paths;
        auto const walk = [&](std::size_t begin, std::size_t end) {
            group& g = scratch_[begin / grain];
            g.visits.clear();
            for (std::size_t k = begin; k < end; ++k) {
                traces_[k] = percolate(table, skin, policy, number, first + k, g.visits, g.memory);
            }
        };
        if (groups == 1) {
            walk(0, n);
        } else {
            threads.for_blocks(n, grain, walk);
        }
        transact([&] {
            for (std::size_t k = 0, at = 0; k < n; ++k) {
                if (k % grain == 0) at = 0;
                apply(first + k, traces_[k], std::span(scratch_[k / grain].visits).subspan(at, traces_[k].visits));
                at += traces_[k].visits;
            }
            state.count.paths += n;
            if (!broken_.empty()) settle();
        });
    }

    /// Runs `body`; when it throws, lives, cells, counters and blocks are as before.
    template <class Body>
    void transact(Body const& body) {
        undo_.clear();
        broken_.clear();
        fallen_.clear();
        frost_counters const before = state.count;
        std::size_t const blocks = state.blocks.size();
        try {
            body();
        } catch (...) {
            for (std::size_t k = undo_.size(); k-- > 0;) table[undo_[k].link].life = undo_[k].life;
            for (auto const& [cell, was] : fallen_) state.cells[cell.value] = was;
            state.count = before;
            state.blocks.resize(blocks);
            dirty = true;
            try {
                rebuild();
            } catch (...) {  // out of memory: the next call rebuilds
            }
            throw;
        }
    }

    /// The bond holds no longer; `settle` looks later what that loosens. Call inside `transact`.
    void break_bond(link_index l) {
        undo_.push_back({l, table[l].life});
        broken_.push_back(l);
        link_record& r = table[l];
        r.life = 0;
        r.state = link_state::broken;
        ++state.count.links_broken;
    }

    /// One connectivity check for all bonds broken since; parts that the rule drops become air.
    void settle() {
        auto const start = std::chrono::steady_clock::now();
        touched_.clear();
        for (link_index const l : broken_) {
            auto const ends = table[l].cells;
            std::uint32_t made = 0;
            if (!parts.cut(table, ends[0], ends[1], state.cells, state.volumes, made)) continue;
            std::uint32_t const origin = parts[made].origin;
            if (std::find(touched_.begin(), touched_.end(), origin) == touched_.end()) touched_.push_back(origin);
            touched_.push_back(made);
        }
        // Among the pieces of one part the rule is asked pair by pair against the one that stands so far.
        for (std::size_t k = 0; k < touched_.size(); ++k) {
            std::uint32_t const origin = parts[touched_[k]].origin;
            if (touched_[k] != origin) continue;
            std::uint32_t stands = origin;
            for (std::uint32_t const other : touched_) {
                if (other == origin || parts[other].origin != origin) continue;
                if (stands == parts.none) {
                    stands = other;
                    continue;
                }
                part const a = parts.view(stands);
                part const b = parts.view(other);
                falling const verdict = process.wear.decide(a, b);
                bool const first = verdict == falling::first || verdict == falling::both;
                bool const second = verdict == falling::second || verdict == falling::both;
                if (second) parts[other].falls = true;
                if (first) parts[stands].falls = true;
                if (first) stands = second ? parts.none : other;
            }
        }
        for (std::uint32_t const id : touched_) {
            if (parts[id].falls) fall(id);
        }
        for (std::uint32_t const id : touched_) parts[id].origin = id;
        detach_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }

    /// Component `id` becomes air. Call inside `transact`.
    void fall(std::uint32_t id) {
        state.blocks.push_back({state.count.paths, parts.cells_of(table, id), 0});
        detached_block& block = state.blocks.back();
        std::int64_t volume = 0;
        fallen_.reserve(fallen_.size() + block.cells.size());
        for (cell_index const c : block.cells) {
            fallen_.push_back({c, state.cells[c.value]});
            state.cells[c.value] = cell_state::air;
            volume += state.volumes[c.value];
        }
        block.volume = from_fixed(volume, state.total_volume);
        state.count.volume_detached += volume;
        state.count.cells_detached += block.cells.size();
        parts.drop(id, block.cells);
        auto const again = [this](cell_index c) {
            table.network().for_each_cell_link(c, [this](link_index l) { refresh(l); });
        };
        flood.fell(table.network(), state.cells, block.cells, again);
        for (cell_index const c : block.cells) again(c);
    }

private:
    struct group {
        std::vector<path_visit> visits{};
        path_scratch memory{};
    };
    struct old_life {
        link_index link{};
        double life = 0;
    };

    /// Books one path and wears its bonds.
    void apply(std::uint64_t path, path_trace const& trace, std::span<path_visit const> visits) {
        frost_counters& count = state.count;
        if (!trace.entry.valid()) {
            ++count.without_entry;
            return;
        }
        count.water.inflow += trace.inflow;
        count.water.lost += trace.lost;
        count.water.drained += trace.drained;
        count.traversed += visits.size();
        stream random(options.seed, stage::breakage, path);
        for (path_visit const& v : visits) {
            link_record& r = table[v.link];
            if (v.state != link_state::bonded) {
                count.water.absorbed += v.absorbed;
                continue;
            }
            if (r.state != link_state::bonded) {
                count.water.lost += v.absorbed;
                continue;
            }
            count.water.absorbed += v.absorbed;
            link_view l = table.view(v.link);
            double const harm = process.wear.damage(l, water_unit::to(v.absorbed), scale);
            require_answer("damage", v.link, harm);
            undo_.push_back({v.link, r.life});
            double const left = r.life - harm;
            if (!(left > 0)) {
                break_bond(v.link);
                continue;
            }
            r.life = left;
            l.life = left;
            double const chance = process.wear.break_chance(l);
            if (!(chance <= 0) && random.chance(chance)) break_bond(v.link);
        }
    }

    /// State and entry weight of a link from its life, its cells and the flood.
    void refresh(link_index l) {
        link_record& r = table[l];
        bool const first = state.cells[r.cells[0].value] != cell_state::air;
        bool const inside = r.cells[1].valid();
        bool const second = inside && state.cells[r.cells[1].value] != cell_state::air;
        r.inward = !first && second;
        if (!first && !second) {
            r.state = link_state::gone;
        } else if (first && second) {
            r.state = r.life > 0 ? link_state::bonded : link_state::broken;
        } else if (!inside) {
            r.state = link_state::skin;
        } else {
            r.state = flood.open(r.cells[first ? 1 : 0]) ? link_state::skin : link_state::pocket;
        }
        skin.set(l, r.state == link_state::skin ? std::max<std::int64_t>(1, to_fixed(r.area, areas_)) : 0);
    }

    double areas_ = 1;  ///< of all links, squared length unit
    std::vector<group> scratch_{};
    std::vector<path_trace> traces_{};
    std::vector<old_life> undo_{};
    std::vector<link_index> broken_{};
    std::vector<std::pair<cell_index, cell_state>> fallen_{};
    std::vector<std::uint32_t> touched_{};
};

}  // namespace tafoni::detail

#endif
