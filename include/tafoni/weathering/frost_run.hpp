/// \file
/// Frost wedging over a network of links: the state that weathers, and the loop over the paths.
#ifndef TAFONI_WEATHERING_FROST_RUN_HPP
#define TAFONI_WEATHERING_FROST_RUN_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/graph/air_flood.hpp>
#include <tafoni/weathering/detail/frost_core.hpp>
#include <tafoni/weathering/frost_checkpoint.hpp>
#include <tafoni/weathering/frost_report.hpp>
#include <tafoni/weathering/frost_wedging.hpp>

#include <algorithm>
#include <chrono>
#include <exception>
#include <span>
#include <utility>
#include <vector>

namespace tafoni {

/// A weathering model [Mateos et al., section 5]. Refers to the network, which must outlive it.
///
/// `run` adds paths. Within a batch all paths walk one frozen state; then their effects are applied in
/// (path, step) order, and what has come loose falls. The sequential process is a batch of one. Water
/// that meets a link which broke earlier in the same batch is booked as lost. The state depends on the
/// network, the policies, the options, the marks and the batch size only, never on threads, and a
/// run of n then m paths equals one of n + m (for batches: when n is a multiple of the batch).
///
/// When anything throws (a policy, an observer, the allocator), the state is that after the last
/// complete batch and the run can go on.
template <link_network Network, class Process = frost_wedging<>, exposure_policy Exposure = air_flood>
class frost_run {
public:
    /// Every cell solid, every bond whole. O(links x Neigh + cells).
    /// \throws invalid_input  for policies or options out of range, a resistance outside [0, 1], or a
    ///                        network whose areas, centroids or volumes are not finite and positive.
    explicit frost_run(Network const& network, Process process = {}, frost_options options = {}, Exposure exposure = {})
        : core_(network, checked(std::move(process)), checked(options), checked(std::move(exposure))) {}
    explicit frost_run(Network const&&, Process = {}, frost_options = {}, Exposure = {}) = delete;

    /// Adds `schedule.paths` paths.
    ///
    /// Progress is reported under the stage "weather"; an observer that answers `stop`, there or at a
    /// snapshot, ends the run after the path just completed. Mean cost per path O(links met x Neigh); where no
    /// skin is left, O(1) for all that remain.
    /// \throws invalid_input  for a schedule out of range, or when a policy answers out of its range.
    template <executor Executor = inline_executor>
    frost_report run(frost_schedule const& schedule, run_context const& context = {}, Executor const& threads = {}) {
        schedule.validate();
        if (core_.dirty) core_.rebuild();
        auto const start = std::chrono::steady_clock::now();
        stopped_ = stop_reason::finished;
        std::uint64_t const stride = schedule.paths / 256 + 1;
        std::uint64_t next_tick = stride;
        std::uint64_t done = 0;
        bool going = !context.on_progress || context.on_progress({"weather", 0}) == step_control::proceed;
        if (!going) stopped_ = stop_reason::observer;
        if (going && schedule.paths == 0 && context.on_progress) (void)context.on_progress({"weather", 1});
        while (going && done < schedule.paths) {
            std::uint64_t const before = core_.state.count.paths;
            std::uint64_t const broken = core_.state.count.links_broken;
            std::size_t const blocks = core_.state.blocks.size();
            std::uint64_t n = schedule.batch - before % schedule.batch;
            bool const barred = core_.skin.total() == 0;  // and stays so: nothing wears, so nothing opens
            if (barred && schedule.stop == stop_when::nothing_enters) {
                stopped_ = stop_reason::nothing_enters;
                if (context.on_progress) (void)context.on_progress({"weather", 1});
                break;
            }
            if (barred) {
                std::uint64_t const last = context.on_progress ? std::min(next_tick, schedule.paths) : schedule.paths;
                n = quiet_paths(schedule, before, last - done);
            }
            if (n > schedule.paths - done) n = schedule.paths - done;
            if (barred) {
                core_.skip(n);
            } else {
                core_.step(static_cast<std::size_t>(n), threads);
            }
            done += n;
            if (schedule.stop == stop_when::first_break && core_.state.count.links_broken != broken) {
                stopped_ = stop_reason::first_break;
                going = false;
            }
            if (schedule.stop == stop_when::first_detachment && core_.state.blocks.size() != blocks) {
                stopped_ = stop_reason::first_detachment;
                going = false;
            }
            if (schedule.snapshot_every > 0 && schedule.on_snapshot &&
                before / schedule.snapshot_every != core_.state.count.paths / schedule.snapshot_every &&
                schedule.on_snapshot(core_.state.count.paths) == step_control::stop) {
                stopped_ = stop_reason::observer;
                going = false;
            }
            if (context.on_progress && (done >= next_tick || done == schedule.paths || !going)) {
                next_tick = done + stride;
                double const fraction = going && done < schedule.paths
                                            ? static_cast<double>(done) / static_cast<double>(schedule.paths)
                                            : 1.0;
                if (context.on_progress({"weather", fraction}) == step_control::stop && done < schedule.paths &&
                    going) {
                    stopped_ = stop_reason::observer;
                    going = false;
                }
            }
        }
        seconds_.run += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return report();
    }

    /// Totals since the start. O(1).
    [[nodiscard]] frost_report report() const noexcept {
        frost_report r = core_.state.report();
        r.seconds = {.run = seconds_.run, .walk = core_.walk_seconds, .detach = core_.detach_seconds};
        r.stopped = stopped_;
        return r;
    }

    [[nodiscard]] Network const& network() const noexcept { return core_.table.network(); }
    [[nodiscard]] Process const& process() const noexcept { return core_.process; }
    [[nodiscard]] frost_options const& options() const noexcept { return core_.options; }
    [[nodiscard]] link_scale const& scale() const noexcept { return core_.scale; }
    [[nodiscard]] std::uint64_t paths() const noexcept { return core_.state.count.paths; }
    [[nodiscard]] cell_state cell(cell_index c) const noexcept { return core_.state.cells[c.value]; }
    [[nodiscard]] std::span<cell_state const> cells() const noexcept { return core_.state.cells; }
    [[nodiscard]] link_state state(link_index l) const noexcept { return core_.table[l].state; }
    /// lambda in [0, 1]. A bond that was laid open keeps the life it had, to be shown; skin has none.
    [[nodiscard]] double life(link_index l) const noexcept { return core_.table[l].life; }
    /// The link as policies see it.
    [[nodiscard]] link_view view(link_index l) const { return core_.table.view(l); }
    /// What fell, in order.
    [[nodiscard]] std::span<detached_block const> blocks() const noexcept { return core_.state.blocks; }
    /// Walks path number `path` over the present state without changing it: for looking.
    [[nodiscard]] path_trace trace(std::uint64_t path, std::vector<path_visit>& visits) const {
        path_scratch memory;
        return percolate(core_.table, core_.skin, core_.policies(), core_.numbers(), path, visits, memory);
    }

    /// Marks cells by hand. Core heals nothing; nothing falls because of a mark (see `drop_loose`).
    /// Strong guarantee. O(cells + links).
    /// \throws invalid_input  for an index out of range, or after the first path for air that is to be
    ///                        anything else: what fell never returns. (A block that fell by hand counts as a path.)
    void mark(std::span<cell_index const> cells, cell_state as) {
        for (cell_index const c : cells) {
            if (c.value >= core_.state.cells.size()) {
                detail::fail<invalid_input>(errc::index_out_of_range,
                                            "frost_run::mark: cell " + std::to_string(c.value) + " of " +
                                                std::to_string(core_.state.cells.size()),
                                            {.kind = entity::cell, .index = c.value});
            }
            if (core_.has_history() && as != cell_state::air && core_.state.cells[c.value] == cell_state::air) {
                detail::fail<invalid_input>(errc::bad_parameter,
                                            "frost_run::mark: cell " + std::to_string(c.value) + " is air for good",
                                            {.kind = entity::cell, .index = c.value});
            }
        }
        auto former_cells = core_.state.cells;
        auto former_marks = core_.state.marks;
        auto former_states = core_.states;
        core_.dirty = true;
        if (!core_.has_history()) std::fill(core_.states.begin(), core_.states.end(), link_state::bonded);
        for (cell_index const c : cells) core_.state.cells[c.value] = core_.state.marks[c.value] = as;
        try {
            core_.rebuild();
        } catch (...) {  // out of memory: the next call rebuilds
            core_.state.cells.swap(former_cells);
            core_.state.marks.swap(former_marks);
            core_.states.swap(former_states);
            throw;
        }
    }
    void mark(cell_index cell, cell_state as) { mark(std::span<cell_index const>(&cell, 1), as); }

    /// Breaks a bond by hand; what comes loose falls. False when it was no bond.
    bool break_link(link_index l) {
        if (core_.dirty) core_.rebuild();
        if (!(l.value < core_.table.size())) {
            detail::fail<invalid_input>(errc::index_out_of_range,
                                        "frost_run::break_link: link " + std::to_string(l.value) + " of " +
                                            std::to_string(core_.table.size()),
                                        {.kind = entity::link, .index = l.value});
        }
        if (core_.table[l].state != link_state::bonded) return false;
        core_.transact([&] {
            core_.break_bond(l);
            core_.settle();
        });
        return true;
    }

    /// Lets fall what hangs on no core cell, when there is a core at all: loose pieces of the input, and
    /// what marks have cut off. Returns the number of blocks. O(cells + links).
    std::size_t drop_loose() {
        if (core_.dirty) core_.rebuild();
        std::size_t const before = core_.state.blocks.size();
        core_.transact([&] {
            if (std::find(core_.state.cells.begin(), core_.state.cells.end(), cell_state::core) !=
                core_.state.cells.end()) {
                core_.drop_coreless();
            }
        });
        return core_.state.blocks.size() - before;
    }

    /// Replaces the policies between paths; resistance is read again. Strong guarantee. O(links).
    void replace(Process process) {
        detail::validate_policies(process);
        auto const rho = core_.resistances(process);
        core_.process = std::move(process);
        core_.install(rho);
    }
    /// Replaces the options between paths. Strong guarantee. O(links).
    void replace(frost_options const& options) {
        options.validate();
        core_.rescale(options);
        core_.options = options;
    }

    /// Back to the first path: bonds whole, counters 0, air gone. Marks made by hand stay. O(cells + links).
    void reset() {
        core_.dirty = true;
        for (std::size_t i = 0; i < core_.table.size(); ++i) {
            link_record& r = core_.table[link_index{i}];
            r.life = r.cells[1].valid() ? 1.0 : 0.0;
        }
        core_.state.reset();
        std::fill(core_.states.begin(), core_.states.end(), link_state::bonded);
        seconds_ = {};
        core_.walk_seconds = 0;
        core_.detach_seconds = 0;
        stopped_ = stop_reason::finished;
        core_.rebuild();
    }

    /// Says at once when water can get nowhere: no link accepts the rain of the next 32 paths, or from
    /// none that does a neighbour has weight. O(32 x skin links x Neigh) at worst.
    /// \throws invalid_input  `no_entry`.
    void validate() const {
        path_scratch memory;
        auto const policy = core_.policies();
        water const w{.now = core_.options.water, .initial = core_.options.water, .step = 0};
        for (std::uint64_t path = core_.state.count.paths; path < core_.state.count.paths + 32; ++path) {
            stream rain(core_.options.seed, stage::rain, path);
            vec3 const direction = policy.rain.draw(rain);
            bool found = false;
            core_.skin.for_each([&](link_index l) {
                if (found || !(policy.infiltration.acceptance(core_.table.view(l), direction) > 0)) return;
                stream any(0, stage::flow, 0);
                found = detail::next_link(core_.table, policy.flow, l, w, any, memory).valid();
            });
            if (found) return;
        }
        detail::fail<invalid_input>(errc::no_entry,
                                    "frost_run: no water enters: no skin link accepts the rain and leads on "
                                    "(is the resistance 1 everywhere, or all skin out of the rain?)");
    }

    /// The whole state as bytes, for `resume`. Equal states give equal bytes. O(cells + links).
    [[nodiscard]] std::vector<std::byte> checkpoint() const { return detail::write_checkpoint(core_); }

    /// Goes on from a checkpoint of the same network, policies and options. Strong guarantee.
    ///
    /// Policies are told apart by their `parameters()`, else by their bytes where these alone say whether two
    /// are equal (whole numbers; not floating point), and by their `static constexpr std::string_view name`,
    /// else by their size. The exposure counts as a policy. One that holds a pointer needs `parameters()`, or
    /// its checkpoints die with the pointer. What none of these tells, the caller must know.
    /// \throws io_error  `wrong_format`, `truncated` or `bad_syntax` for bytes that are no checkpoint,
    ///                   `checkpoint_mismatch` for one of another network or other parameters.
    void resume(std::span<std::byte const> bytes) {
        detail::read_checkpoint(core_, bytes);
        seconds_ = {};
        core_.walk_seconds = 0;
        core_.detach_seconds = 0;
    }

private:
    /// At least `many` paths, in whole batches, but no further than the next snapshot.
    static std::uint64_t quiet_paths(frost_schedule const& schedule, std::uint64_t before, std::uint64_t many) noexcept {
        std::uint64_t const every = schedule.snapshot_every;
        if (every > 0 && schedule.on_snapshot && every - before % every < many) many = every - before % every;
        std::uint64_t const over = (before + many) % schedule.batch;
        return over == 0 ? many : many + (schedule.batch - over);
    }
    template <class Policy>
    static Policy checked(Policy policy) {
        detail::validate_policies(policy);
        return policy;
    }
    static frost_options checked(frost_options const& options) {
        options.validate();
        return options;
    }

    detail::frost_core<Network, Process, Exposure> core_;
    frost_report::stage_seconds seconds_{};
    stop_reason stopped_ = stop_reason::finished;
};

}  // namespace tafoni

#endif
