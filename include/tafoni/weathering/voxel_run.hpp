/// \file
/// Voxel weathering over a grid: the state that weathers, and the loop over the steps.
#ifndef TAFONI_WEATHERING_VOXEL_RUN_HPP
#define TAFONI_WEATHERING_VOXEL_RUN_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/weathering/detail/voxel_checkpoint.hpp>
#include <tafoni/weathering/detail/voxel_core.hpp>
#include <tafoni/weathering/voxel_options.hpp>
#include <tafoni/weathering/voxel_report.hpp>
#include <tafoni/weathering/voxel_weathering.hpp>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace tafoni {

/// A voxel of the skin, as a run sees it. To be asked about before the run goes on or its policies are replaced.
struct skin_voxel {
    voxel at{};  ///< turned axes
    voxel_state state = voxel_state::rock;
    double decimation = 100;  ///< what is left of the voxel, per cent; <= 100, falls at 0
    double durability = 0;    ///< at its centre, >= `voxel_weathering::least_durability`
    double air_share = 0;     ///< of its bubble, in [0, 1]
    std::size_t bubble = 0;   ///< which stencil of the bubble choice
};

/// Directable weathering of a grid [Jones et al., section 4]. Owns its grid, in bricks (`sparse_grid`).
///
/// A step: every voxel of the skin loses (A f(c) + B f(c')) / durability; all that are used up fall at once;
/// rock that lost its hold falls; grains settle; then counts and skin are brought up to date, so that every
/// rate is that of the grid as it is, to the bit. New skin and every grain that came to rest start at 100.
/// What a grain covers keeps its decimation and goes on when it is bare again.
/// The state depends on the grid, the policies and the options only, never on threads; n steps and then m are n + m.
///
/// When anything throws (a policy, an observer, the allocator), the state is that after the last complete step (with
/// `voxel_clock::events`: the last complete event; the next step ends that one) and the run can go on.
template <class Process = voxel_weathering<>>
class voxel_run {
public:
    /// Copies the grid. O(voxels), once. \throws invalid_input  for a grid, policies or options out of range.
    template <voxel_grid Grid, executor Executor = inline_executor>
        requires(!std::same_as<Grid, sparse_grid>)
    explicit voxel_run(Grid const& grid, Process process = {}, voxel_options const& options = {},
                       Executor const& threads = {})
        : voxel_run(sparse_grid::copy_of(grid, options.up, options.border), std::move(process), options, threads) {}
    /// Takes the grid over, with its own up and border. O(bricks + skin voxels in bubbles).
    template <executor Executor = inline_executor>
    explicit voxel_run(sparse_grid grid, Process process = {}, voxel_options const& options = {},
                       Executor const& threads = {})
        : core_(std::move(grid), checked(std::move(process)), checked(options), threads) {}

    /// Adds the steps of the schedule.
    ///
    /// Progress is reported under the stage "weather"; an observer that answers `stop`, there or at a
    /// snapshot, ends the run after the step just completed.
    /// Cost per step O(R^2 x changed x skin near them + skin) for bubbles of radius R.
    /// \throws invalid_input  for a schedule out of range, or when a policy answers out of its range.
    template <executor Executor = inline_executor>
    voxel_report run(voxel_schedule const& schedule, run_context const& context = {}, Executor const& threads = {}) {
        schedule.validate();
        auto const start = std::chrono::steady_clock::now();
        stopped_ = voxel_stop::finished;
        std::uint64_t const all = schedule.steps();
        std::uint64_t done = 0;
        bool going = !context.on_progress || context.on_progress({"weather", 0}) == step_control::proceed;
        if (!going) stopped_ = voxel_stop::observer;
        if (going && all == 0 && context.on_progress) (void)context.on_progress({"weather", 1});
        for (voxel_phase const& phase : schedule.phases) {
            core_.rates.set(phase.spheroidal, phase.cavernous);
            for (std::uint64_t k = 0; going && k < phase.steps; ++k) {
                if (schedule.clock == voxel_clock::steps) {
                    core_.step(threads);
                } else {
                    core_.step_by_events(threads);
                }
                ++done;
                if (schedule.snapshot_every > 0 && schedule.on_snapshot &&
                    core_.count.steps % schedule.snapshot_every == 0 &&
                    schedule.on_snapshot(core_.count.steps) == step_control::stop) {
                    stopped_ = voxel_stop::observer;
                    going = false;
                }
                if (!context.on_progress) continue;
                double const fraction =
                    going && done < all ? static_cast<double>(done) / static_cast<double>(all) : 1.0;
                if (context.on_progress({"weather", fraction}) == step_control::stop && done < all && going) {
                    stopped_ = voxel_stop::observer;
                    going = false;
                }
            }
        }
        seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return report();
    }

    /// Adds steps of one default phase: spheroidal weathering alone.
    template <executor Executor = inline_executor>
    voxel_report run(std::uint64_t steps, run_context const& context = {}, Executor const& threads = {}) {
        return run(voxel_schedule{.phases = {{.steps = steps}}}, context, threads);
    }

    /// Totals since the start. O(1).
    [[nodiscard]] voxel_report report() const noexcept {
        voxel_report r = core_.count;
        r.seconds = core_.taken;
        r.seconds.run = seconds_;
        r.stopped = stopped_;
        return r;
    }

    [[nodiscard]] sparse_grid const& grid() const noexcept { return core_.grid; }
    [[nodiscard]] Process const& process() const noexcept { return core_.process; }
    [[nodiscard]] voxel_options const& options() const noexcept { return core_.options; }
    [[nodiscard]] std::uint64_t steps() const noexcept { return core_.count.steps; }
    /// What fell, in order.
    [[nodiscard]] std::span<fallen_block const> blocks() const noexcept { return core_.blocks; }

    /// A voxel of the skin (turned axes), or nothing. O(log of the brick's skin).
    [[nodiscard]] std::optional<skin_voxel> at(voxel v) const noexcept {
        if (!core_.grid.contains(v)) return std::nullopt;
        std::uint32_t const slot = core_.skins.slot_of(core_.grid.brick_of(v));
        if (slot == detail::voxel_skins::none) return std::nullopt;
        detail::voxel_skin const& skin = core_.skins[slot];
        std::size_t const i = skin.find(detail::position_of(v));
        if (i == skin.size()) return std::nullopt;
        return view(skin, i, v);
    }
    /// Any voxel (turned axes), as if it were of the skin. O(log of the brick's skin), or O(voxels of the bubble)
    /// where it is not. A voxel that has never weathered has a decimation of 100.
    /// \throws invalid_input  when a policy answers out of its range.
    [[nodiscard]] skin_voxel look(voxel v) const {
        if (auto const known = at(v)) return *known;
        auto const [bubble, durability] = core_.ask(core_.grid.centre(v));
        bubble_stencil const& stencil = core_.stencils()[bubble];
        std::uint32_t solid = 0;
        for (bubble_stencil::row const& row : stencil.rows()) {
            for (int dz = -stencil.reach(); dz <= stencil.reach(); ++dz) {
                auto const k = static_cast<unsigned>(dz + bubble_stencil::widest);
                bool const inside = (row.bits[k / 64] >> (k % 64) & 1) != 0;
                if (inside && core_.grid.is_solid(v + voxel{row.dx, row.dy, dz})) ++solid;
            }
        }
        return {.at = v,
                .state = core_.grid.state(v),
                .decimation = core_.covered_left(v),
                .durability = durability,
                .air_share = (stencil.size() - solid) / static_cast<double>(stencil.size()),
                .bubble = bubble};
    }
    /// Every voxel of the skin, in voxel order. O(n log n).
    [[nodiscard]] std::vector<skin_voxel> skin() const {
        std::vector<skin_voxel> out;
        out.reserve(core_.count.surface_voxels);
        for (std::size_t s = 0; s < core_.skins.size(); ++s) {
            voxel const corner = core_.grid.brick_corner(core_.skins.brick(s));
            for (std::size_t i = 0; i < core_.skins[s].size(); ++i) {
                out.push_back(view(core_.skins[s], i, detail::at_position(corner, core_.skins[s].position[i])));
            }
        }
        std::sort(out.begin(), out.end(), [](skin_voxel const& a, skin_voxel const& b) { return a.at < b.at; });
        return out;
    }
    /// What the voxel would lose in a step of one process alone at strength 1, per cent.
    [[nodiscard]] double spheroidal_rate(skin_voxel const& v) const noexcept {
        return core_.rates.spheroidal(v.bubble, air_of(v)) / v.durability;
    }
    [[nodiscard]] double cavernous_rate(skin_voxel const& v) const noexcept {
        return core_.rates.cavernous(v.bubble, air_of(v)) / v.durability;
    }

    /// Curvature as the run measures it, in [-1, 1], > 0 on what protrudes: the share of air less that of rock; with
    /// `flat_excess` measured from flat rock, which shows 0.
    [[nodiscard]] double curvature(skin_voxel const& v) const noexcept {
        bool const flat = core_.options.measure == curvature_measure::flat_excess;
        return flat ? core_.rates.flat_excess(v.bubble, air_of(v)) : 2 * v.air_share - 1;
    }

    /// Replaces the policies between steps; decimation stays. Strong guarantee. O(bricks + skin voxels in bubbles).
    void replace(Process process) {
        process.validate();
        Process former = std::move(core_.process);
        put(std::move(process));
        try {
            auto rates = core_.rates;
            rates.read(core_.process, core_.options);
            core_.rescan(inline_executor{});
            core_.rates = std::move(rates);
        } catch (...) {
            put(std::move(former));
            throw;
        }
    }
    /// One policy of a `voxel_weathering`, likewise; of the type that the run was made with, which `any_field` keeps
    /// open for durability: `voxel_weathering{.durability = any_field(beds)}`.
    void replace(decltype(Process::bubbles) bubbles) {
        replace(Process{.bubbles = std::move(bubbles), .rate = core_.process.rate, .durability = core_.process.durability});
    }
    void replace(decltype(Process::rate) rate) {
        replace(Process{.bubbles = core_.process.bubbles, .rate = std::move(rate), .durability = core_.process.durability});
    }
    void replace(decltype(Process::durability) durability) {
        replace(Process{.bubbles = core_.process.bubbles, .rate = core_.process.rate, .durability = std::move(durability)});
    }
    /// Replaces the options between steps; `up` and `border` stay those of the grid. Strong guarantee.
    void replace(voxel_options const& options) {
        voxel_options next = checked(options);
        voxel_options former = std::exchange(core_.options, std::move(next));
        try {
            auto rates = core_.rates;
            rates.read(core_.process, core_.options);
            core_.rescan(inline_executor{});
            core_.start_rockfall();
            core_.rates = std::move(rates);
        } catch (...) {
            core_.options = std::move(former);
            throw;
        }
    }

    /// The state as bytes, the same on every machine. O(bricks + skin + voxels that fell).
    [[nodiscard]] std::vector<std::byte> checkpoint() const { return detail::write_checkpoint(core_); }
    /// Goes on from bytes of `checkpoint()`; further steps give the bits of the uninterrupted run. Strong guarantee.
    /// The predicate of `rockfall_options::ground_where` is not compared.
    /// \throws io_error  `wrong_format`, `unsupported`, `truncated`, `bad_syntax`; `checkpoint_mismatch` for another
    ///                   input grid, other options, bubbles, rates or durability.
    void resume(std::span<std::byte const> bytes) {
        detail::read_checkpoint(core_, bytes);
        seconds_ = 0;
        core_.taken = {};
        stopped_ = voxel_stop::finished;
    }

    /// Writes the states into any grid of the same size, in the user's axes. O(voxels).
    /// \throws invalid_input  `bad_parameter` for another size; nothing is written then.
    template <editable_voxel_grid Grid>
    void write_states(Grid& out) const {
        using access = grid_access<Grid>;
        auto const size = access::size(out);
        if (size != core_.grid.user_frame().size) {
            detail::fail<invalid_input>(errc::bad_parameter,
                                        "voxel_run::write_states: the grid has another size than the one that weathered");
        }
        for (std::size_t k = 0; k < size[2]; ++k) {
            for (std::size_t j = 0; j < size[1]; ++j) {
                for (std::size_t i = 0; i < size[0]; ++i) {
                    access::set(out, i, j, k, grid_access<sparse_grid>::state(core_.grid, i, j, k));
                }
            }
        }
    }

private:
    [[nodiscard]] skin_voxel view(detail::voxel_skin const& skin, std::size_t i, voxel v) const noexcept {
        double const size = core_.process.bubbles.stencils()[skin.bubble[i]].size();
        return {.at = v,
                .state = core_.grid.state(v),
                .decimation = skin.left[skin.now][i],
                .durability = skin.durability[i],
                .air_share = skin.air[i] / size,
                .bubble = skin.bubble[i]};
    }
    [[nodiscard]] std::uint32_t air_of(skin_voxel const& v) const noexcept {
        return static_cast<std::uint32_t>(v.air_share * core_.process.bubbles.stencils()[v.bubble].size() + 0.5);
    }
    /// Policies need not be assignable: lambdas that capture are not.
    void put(Process&& process) noexcept {
        static_assert(std::is_nothrow_move_constructible_v<Process>, "a policy that is replaced must be moved without a throw");
        std::destroy_at(&core_.process);
        std::construct_at(&core_.process, std::move(process));
    }
    static Process checked(Process process) {
        process.validate();
        return process;
    }
    static voxel_options const& checked(voxel_options const& options) {
        options.validate();
        return options;
    }

    detail::voxel_core<Process> core_;
    double seconds_ = 0;
    voxel_stop stopped_ = voxel_stop::finished;
};

}  // namespace tafoni

#endif
