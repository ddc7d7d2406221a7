/// \file
/// The steps of a frost run: walk, apply, settle; and the way back when a step throws.
#ifndef TAFONI_WEATHERING_DETAIL_FROST_CORE_HPP
#define TAFONI_WEATHERING_DETAIL_FROST_CORE_HPP

#include <tafoni/field/constant.hpp>
#include <tafoni/graph/connectivity.hpp>
#include <tafoni/graph/exposure.hpp>
#include <tafoni/percolation/entry_tree.hpp>
#include <tafoni/percolation/link_table.hpp>
#include <tafoni/percolation/percolate.hpp>
#include <tafoni/weathering/detail/frost_state.hpp>
#include <tafoni/weathering/detail/process_parts.hpp>
#include <tafoni/weathering/frost_wedging.hpp>

#include <algorithm>
#include <chrono>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// State and derived structures of `frost_run`, whose members document them.
template <class Network, class Process, class Exposure>
class frost_core {
public:
    frost_core(Network const& network, Process p, frost_options const& o, Exposure e)
        : table(network), process(std::move(p)), options(o), exposure(std::move(e)), state(network),
          states(network.link_count(), link_state::bonded) {
        areas_ = pairwise_sum(0, table.size(), [&](std::size_t i) { return table[link_index{i}].area; });
        install(resistances(process));
        rescale(options);
        rebuild();
    }

    link_table<Network> table;
    Process process;
    frost_options options;
    Exposure exposure;
    link_scale scale{};
    frost_state state;
    std::vector<link_state> states;  ///< per link; the table holds a copy beside what the walk reads
    entry_tree skin{};
    connectivity bonds{};
    double walk_seconds = 0;
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
                                        "frost_run: resistance " + number_text(rho[i]) + " at link " +
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

    /// Derives link states, entries, parts and exposure from lives, cells and former states. O(links + cells).
    void rebuild() {
        dirty = true;
        scratch_.clear();
        Network const& network = table.network();
        // On a copy: what history alone tells must outlast a rebuild that runs out of memory.
        std::vector<link_state> next = states;
        for (std::size_t i = 0; i < next.size(); ++i) {
            link_record const& r = table[link_index{i}];
            if (!r.cells[1].valid() || is_air(r.cells[0]) || is_air(r.cells[1])) continue;
            next[i] = r.life > 0 ? link_state::bonded : link_state::broken;
        }
        std::vector<link_state> const former = next;
        exposure_memory_.emplace(exposure.start(network, state.cells, next));
        if (has_history()) {  // what was laid open stays open, also by policies that could not find it again
            for (std::size_t i = 0; i < next.size(); ++i) {
                if (next[i] == link_state::pocket && former[i] == link_state::skin) next[i] = link_state::skin;
            }
        }
        states.swap(next);
        skin = entry_tree(table.size());
        for (std::size_t i = 0; i < table.size(); ++i) {
            if (network.has_link(link_index{i})) refresh(link_index{i});
        }
        bonds = connectivity(network, state.cells, [this](link_index l) { return states[l.value] == link_state::bonded; },
                             {.when_both_hold_core = cores_stand<decltype(process.wear)> ? two_cores::stop
                                                                                        : two_cores::search});
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
        bool const timed = n >= sample || first % sample == 0;
        auto const start = timed ? std::chrono::steady_clock::now() : std::chrono::steady_clock::time_point{};
        if (groups == 1) {
            walk(0, n);
        } else {
            threads.for_blocks(n, grain, walk);
        }
        if (timed) {
            double const taken = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
            walk_seconds += n >= sample ? taken : static_cast<double>(sample) * taken;
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

    /// Books `n` paths while no skin has weight: what `step` would do.
    void skip(std::uint64_t n) noexcept {
        state.count.paths += n;
        if (water_unit::from(options.water) > 0) state.count.without_entry += n;
    }

    /// Runs `body`; when it throws, lives, cells, counters and blocks are as before.
    template <class Body>
    void transact(Body const& body) {
        undo_.clear();
        broken_.clear();
        fallen_.clear();
        former_.clear();
        frost_counters const before = state.count;
        std::size_t const blocks = state.blocks.size();
        try {
            body();
        } catch (...) {
            for (std::size_t k = undo_.size(); k-- > 0;) table[undo_[k].link].life = undo_[k].life;
            for (auto const& [cell, was] : fallen_) state.cells[cell.value] = was;
            for (std::size_t k = former_.size(); k-- > 0;) states[former_[k].first.value] = former_[k].second;
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
        former_.push_back({l, states[l.value]});
        r.life = 0;
        r.state = states[l.value] = link_state::broken;
        ++state.count.links_broken;
    }

    /// Looks once what all bonds broken since have loosened; parts that the rule drops become air.
    ///
    /// Bond by bond, since the two ends of one bond lie close together; nothing falls until all are cut.
    void settle() {
        auto const start = std::chrono::steady_clock::now();
        for (piece const& p : pieces_) {  // left over where a throw ended the last search
            if (p.component < piece_of_.size()) piece_of_[p.component] = piece::none;
        }
        pieces_.clear();
        std::uint32_t wholes = 0;
        for (link_index const l : broken_) {
            std::uint32_t const whole = bonds.component_of(table[l].cells[0]);
            auto const parted = bonds.break_link(table.network(), l);
            if (!parted) continue;
            std::uint32_t const known = whole < piece_of_.size() ? piece_of_[whole] : piece::none;
            std::uint32_t const of = known != piece::none ? pieces_[known].whole : wholes++;
            if (known != piece::none) pieces_[known].parted = true;
            for (std::uint32_t const component : parted->components) {
                if (component >= piece_of_.size()) piece_of_.resize(component + 1, piece::none);
                auto const order = static_cast<std::uint32_t>(pieces_.size());
                pieces_.push_back({.whole = of, .order = order, .component = component});
                piece_of_[component] = order;
            }
        }
        std::erase_if(pieces_, [this](piece const& p) {
            piece_of_[p.component] = piece::none;
            return p.parted;
        });
        std::sort(pieces_.begin(), pieces_.end(), [](piece const& a, piece const& b) {
            return a.whole != b.whole ? a.whole < b.whole : a.order < b.order;
        });
        // Among the pieces of one part the rule is asked pair by pair, against the one that stands so far.
        piece* stands = nullptr;
        for (piece& p : pieces_) {
            if (stands == nullptr || stands->whole != p.whole) {
                stands = &p;
                continue;
            }
            part a = bonds.totals(stands->component);
            part b = bonds.totals(p.component);
            if (a.volume == b.volume) {
                a.lowest_cell = bonds.cells_of(stands->component).front();
                b.lowest_cell = bonds.cells_of(p.component).front();
            }
            falling const verdict = process.wear.decide(a, b);
            bool const first = verdict == falling::first || verdict == falling::both;
            bool const second = verdict == falling::second || verdict == falling::both;
            if (first) stands->falls = true;
            if (second) p.falls = true;
            if (first) stands = second ? nullptr : &p;
        }
        for (piece const& p : pieces_) {
            if (p.falls) fall(p.component);
        }
        detach_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }

    /// A component becomes air. Call inside `transact`.
    void fall(std::uint32_t component) {
        auto const cells = bonds.cells_of(component);
        state.blocks.push_back({state.count.paths, {cells.begin(), cells.end()}, 0});
        detached_block& block = state.blocks.back();
        Network const& network = table.network();
        for (cell_index const c : block.cells) {
            network.for_each_cell_link(c, [this](link_index l) { former_.push_back({l, states[l.value]}); });
        }
        std::int64_t volume = 0;
        for (cell_index const c : block.cells) {
            fallen_.push_back({c, state.cells[c.value]});
            state.cells[c.value] = cell_state::air;
            volume += state.volumes[c.value];
        }
        block.volume = from_fixed(volume, state.total_volume);
        state.count.volume_detached += volume;
        state.count.cells_detached += block.cells.size();
        bonds.remove_component(component);
        exposure.update(network, state.cells, block.cells, *exposure_memory_, states, change_);
        for (cell_index const c : block.cells) {
            network.for_each_cell_link(c, [this](link_index l) { refresh(l); });
        }
        for (link_index const l : change_.opened) {
            former_.push_back({l, table[l].state});
            refresh(l);
        }
        for (link_index const l : change_.closed) refresh(l);
    }

    /// Lets fall every part without core cells. O(cells) and what falls.
    void drop_coreless() {
        for (std::size_t c = 0; c < state.cells.size(); ++c) {
            if (is_air(cell_index{c})) continue;
            std::uint32_t const component = bonds.component_of(cell_index{c});
            if (bonds.totals(component).core_cells == 0) fall(component);
        }
    }

    /// Something has happened that marks do not undo.
    [[nodiscard]] bool has_history() const noexcept { return state.count.paths > 0 || !state.blocks.empty(); }
    [[nodiscard]] bool is_air(cell_index c) const noexcept { return state.cells[c.value] == cell_state::air; }

private:
    struct group {
        std::vector<path_visit> visits{};
        path_scratch memory{};
    };
    struct old_life {
        link_index link{};
        double life = 0;
    };

    struct piece {
        std::uint32_t whole = 0;  ///< pieces of one former part share it
        static constexpr std::uint32_t none = ~std::uint32_t{0};

        std::uint32_t order = 0;
        std::uint32_t component = 0;
        bool parted = false;  ///< came apart further within the batch
        bool falls = false;
    };

    static constexpr std::size_t ahead = 6;     ///< visits whose records are asked for before they are worn
    static constexpr std::uint64_t sample = 16;  ///< of so many small steps one is timed

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
        for (std::size_t k = 0; k < visits.size(); ++k) {
            if (k + ahead < visits.size()) __builtin_prefetch(&table[visits[k + ahead].link]);
            path_visit const& v = visits[k];
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
            double const chance = require_share("breakage", v.link, process.wear.break_chance(l));
            if (chance > 0 && random.chance(chance)) break_bond(v.link);
        }
    }

    /// Copies a link's state into the table and sets its weight as an entry.
    void refresh(link_index l) noexcept {
        link_record& r = table[l];
        r.state = states[l.value];
        r.inward = r.cells[1].valid() && is_air(r.cells[0]) && !is_air(r.cells[1]);
        skin.set(l, r.state == link_state::skin ? std::max<std::int64_t>(1, to_fixed(r.area, areas_)) : 0);
    }

    double areas_ = 1;  ///< of all links, squared length unit
    std::vector<group> scratch_{};
    std::vector<path_trace> traces_{};
    std::vector<old_life> undo_{};
    std::vector<link_index> broken_{};
    std::vector<std::pair<cell_index, cell_state>> fallen_{};
    std::vector<std::pair<link_index, link_state>> former_{};
    std::vector<piece> pieces_{};
    std::vector<std::uint32_t> piece_of_{};  ///< per component: its place in pieces_, while `settle` looks
    std::optional<typename Exposure::state> exposure_memory_{};
    exposure_change change_{};
};

}  // namespace tafoni::detail

#endif
